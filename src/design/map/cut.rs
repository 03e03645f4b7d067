//! Where the surface is cut open, and crosses turned to agree everywhere else.
//!
//! Triangles are joined along a tree of shortest ways from the triangle farthest from all
//! singular vertices; the edges between that are not crossed, without their loose ends, are
//! the cut. Roots and ways are chosen by length, not by number.

use crate::design::directions::{Directions, Singular};
use crate::design::surface::{Measures, Surface, sides_of};
use crate::geometry::{Point3, Vector3};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A cut with what changes across it.
#[derive(Debug, Clone)]
pub(in crate::design) struct Cut {
    /// By how many quarters the cross of each triangle is turned.
    pub turns: Vec<i32>,
    /// By how many quarters, 0 to 3, coordinates turn over each half-edge.
    pub quarters: Vec<i32>,
    /// The segment of the cut on which each half-edge lies, and whether it runs the
    /// segment's way.
    pub segments: Vec<Option<(usize, bool)>>,
    /// How many segments there are.
    pub count: usize,
}

impl Cut {
    pub(super) fn of(
        surface: &Surface,
        measures: &Measures,
        directions: &Directions,
        singular: &[Singular],
    ) -> Self {
        let centres: Vec<Point3> = surface
            .triangles
            .iter()
            .map(|corners| {
                let sum: Vector3 =
                    corners.iter().map(|&k| surface.positions[k].coords).sum();
                Point3::from(sum / 3.0)
            })
            .collect();
        let root = root(surface, measures, singular, &centres);
        let (order, parents) = ways(surface, &centres, &[root]);
        let mut turns = vec![0; surface.triangles.len()];
        for &triangle in &order {
            if let Some(over) = parents[triangle] {
                turns[triangle] = turns[over / 3] + directions.quarters[over];
            }
        }
        let quarters: Vec<i32> = (0..surface.side_count())
            .map(|side| {
                let beyond = surface.twin(side).map_or(side / 3, |twin| twin / 3);
                let turn = directions.quarters[side] + turns[side / 3] - turns[beyond];
                if surface.is_boundary(side) { 0 } else { turn.rem_euclid(4) }
            })
            .collect();
        let mut is_cut: Vec<bool> =
            (0..surface.side_count()).map(|side| !surface.is_boundary(side)).collect();
        for over in parents.iter().flatten() {
            is_cut[*over] = false;
            surface.twin(*over).into_iter().for_each(|twin| is_cut[twin] = false);
        }
        let mut is_singular = vec![false; surface.positions.len()];
        singular.iter().for_each(|s| is_singular[s.vertex] = true);
        prune(surface, &is_singular, &mut is_cut);
        let (segments, count) = segments(surface, &is_singular, &is_cut);
        Self { turns, quarters, segments, count }
    }
}

/// The triangle where the tree begins: farthest from all singular vertices, or in the
/// middle of a surface that has none.
fn root(
    surface: &Surface,
    measures: &Measures,
    singular: &[Singular],
    centres: &[Point3],
) -> usize {
    if singular.is_empty() {
        let weighted = centres.iter().zip(&measures.areas).map(|(c, a)| c.coords * *a);
        let middle = Point3::from(weighted.sum::<Vector3>() / measures.area());
        let near = |&a: &usize, &b: &usize| {
            (centres[a] - middle).norm().total_cmp(&(centres[b] - middle).norm())
        };
        return (0..centres.len()).min_by(near).unwrap_or(0);
    }
    let at: Vec<usize> = singular
        .iter()
        .flat_map(|s| surface.fan(s.vertex).map(|side| side / 3))
        .collect();
    let (order, _) = ways(surface, centres, &at);
    order.last().copied().unwrap_or(0)
}

/// Shortest ways from some triangles to all others, from centre to centre: the triangles by
/// distance, and the half-edge over which each is reached.
fn ways(
    surface: &Surface,
    centres: &[Point3],
    from: &[usize],
) -> (Vec<usize>, Vec<Option<usize>>) {
    let mut distance = vec![f64::INFINITY; centres.len()];
    let mut parents = vec![None; centres.len()];
    let mut order = Vec::with_capacity(centres.len());
    let mut done = vec![false; centres.len()];
    // Distances are not negative, so that their bits are in their order.
    let mut open: BinaryHeap<Reverse<(u64, usize)>> = BinaryHeap::new();
    for &triangle in from {
        distance[triangle] = 0.0;
        open.push(Reverse((0, triangle)));
    }
    while let Some(Reverse((_, triangle))) = open.pop() {
        if std::mem::replace(&mut done[triangle], true) {
            continue;
        }
        order.push(triangle);
        for side in sides_of(triangle) {
            let Some(twin) = surface.twin(side) else { continue };
            let way = distance[triangle] + (centres[twin / 3] - centres[triangle]).norm();
            if way < distance[twin / 3] {
                distance[twin / 3] = way;
                parents[twin / 3] = Some(side);
                open.push(Reverse((way.to_bits(), twin / 3)));
            }
        }
    }
    (order, parents)
}

/// How many cut edges meet in each vertex.
fn degrees(surface: &Surface, is_cut: &[bool]) -> Vec<usize> {
    let mut degrees = vec![0; surface.positions.len()];
    for side in (0..is_cut.len()).filter(|&side| is_cut[side]) {
        degrees[surface.tail(side)] += 1;
    }
    degrees
}

/// Takes loose ends of the cut away: those that end in a regular vertex inside.
fn prune(surface: &Surface, is_singular: &[bool], is_cut: &mut [bool]) {
    let mut degrees = degrees(surface, is_cut);
    let loose = |degrees: &[usize], vertex: usize| {
        degrees[vertex] == 1 && !is_singular[vertex] && !surface.on_boundary(vertex)
    };
    let mut open: Vec<usize> =
        (0..degrees.len()).filter(|&vertex| loose(&degrees, vertex)).collect();
    while let Some(vertex) = open.pop() {
        let Some(side) = surface.fan(vertex).find(|&side| is_cut[side]) else { continue };
        is_cut[side] = false;
        surface.twin(side).into_iter().for_each(|twin| is_cut[twin] = false);
        degrees[vertex] -= 1;
        let other = surface.tip(side);
        degrees[other] -= 1;
        if loose(&degrees, other) {
            open.push(other);
        }
    }
}

/// Splits the cut at singular and boundary vertices and where it branches.
fn segments(
    surface: &Surface,
    is_singular: &[bool],
    is_cut: &[bool],
) -> (Vec<Option<(usize, bool)>>, usize) {
    let degrees = degrees(surface, is_cut);
    let mut ends: Vec<bool> = (0..degrees.len())
        .map(|vertex| {
            degrees[vertex] > 0
                && (degrees[vertex] != 2
                    || is_singular[vertex]
                    || surface.on_boundary(vertex))
        })
        .collect();
    let mut segments = vec![None; is_cut.len()];
    let mut count = 0;
    // Segments between ends first; what is left are loops without one.
    for round in 0..2 {
        for start in (0..is_cut.len()).filter(|&side| is_cut[side]) {
            if segments[start].is_some() || (round == 0 && !ends[surface.tail(start)]) {
                continue;
            }
            ends[surface.tail(start)] = true;
            let mut side = start;
            loop {
                segments[side] = Some((count, true));
                let twin = surface.twin(side);
                twin.into_iter().for_each(|twin| segments[twin] = Some((count, false)));
                let at = surface.tip(side);
                let onward =
                    surface.fan(at).find(|&k| is_cut[k] && segments[k].is_none());
                match onward {
                    Some(onward) if !ends[at] => side = onward,
                    _ => break,
                }
            }
            count += 1;
        }
    }
    (segments, count)
}
