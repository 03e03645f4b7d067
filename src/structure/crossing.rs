//! What lies near what in space: fins that cut through each other away from their nodes.

use crate::geometry::{Point3, Vector3};
use crate::structure::Structure;
use crate::structure::finding::StructureFinding;
use std::collections::BTreeSet;

/// All pairs of fins without a common node that share a point.
pub(super) fn fins_that_cross(structure: &Structure) -> Vec<StructureFinding> {
    let grid = FinGrid::new(structure);
    let fins = structure.fins();
    let apart = |a: usize, b: usize| !fins[a].iter().any(|node| fins[b].contains(node));
    let mut findings = Vec::new();
    for (a, quad) in grid.quads.iter().enumerate() {
        let near = grid.near(quad).into_iter().filter(|&b| a < b && apart(a, b));
        let crossed = near.filter(|&b| quads_meet(quad, &grid.quads[b]));
        findings.extend(
            crossed
                .map(|b| StructureFinding::FinsCross { first: fins[a], second: fins[b] }),
        );
    }
    findings
}

/// The fins of a structure, sorted into cells of about one fin's size.
#[derive(Debug, Clone)]
pub struct FinGrid {
    quads: Vec<[Point3; 4]>,
    cell: f64,
    entries: Vec<([i64; 3], usize)>,
}

impl FinGrid {
    /// Sorts the fins in.
    pub fn new(structure: &Structure) -> Self {
        let quads: Vec<[Point3; 4]> =
            structure.fins().iter().map(|&fin| structure.corners(fin)).collect();
        let size = |quad: &[Point3; 4]| {
            let (low, high) = bounds(quad);
            (high - low).max()
        };
        let mut sizes: Vec<f64> = quads.iter().map(size).collect();
        sizes.sort_by(f64::total_cmp);
        let median = sizes.get(sizes.len() / 2).copied().unwrap_or(1.0);
        // A few huge fins among small ones would touch too many cells.
        let cell = median.max(sizes.last().copied().unwrap_or(1.0) / 16.0);
        let mut grid = Self { quads, cell, entries: Vec::new() };
        for index in 0..grid.quads.len() {
            let cells = grid.cells(&grid.quads[index]);
            grid.entries.extend(cells.map(|cell| (cell, index)));
        }
        grid.entries.sort_unstable();
        grid
    }

    /// The fins, by index, whose boxes overlap that of `quad`.
    fn near(&self, quad: &[Point3; 4]) -> BTreeSet<usize> {
        let (low, high) = bounds(quad);
        let overlaps = |&index: &usize| {
            let (l, h) = bounds(&self.quads[index]);
            (0..3).all(|k| l[k] <= high[k] && low[k] <= h[k])
        };
        self.cells(quad)
            .flat_map(|cell| {
                let start = self.entries.partition_point(|entry| entry.0 < cell);
                self.entries[start..].iter().take_while(move |entry| entry.0 == cell)
            })
            .map(|entry| entry.1)
            .filter(overlaps)
            .collect()
    }

    fn cells(&self, quad: &[Point3; 4]) -> impl Iterator<Item = [i64; 3]> + use<> {
        let (low, high) = bounds(quad);
        let at = |x: f64| (x / self.cell).floor() as i64;
        let [x, y, z] = [0, 1, 2].map(|k| at(low[k])..=at(high[k]));
        x.flat_map(move |x| {
            let z = z.clone();
            y.clone().flat_map(move |y| z.clone().map(move |z| [x, y, z]))
        })
    }

    /// Whether a quad, given by a segment and its copy `reach` further, meets a fin that
    /// does not end at `node`.
    pub fn blocks(
        &self,
        structure: &Structure,
        node: usize,
        segment: [Point3; 2],
        reach: Vector3,
    ) -> bool {
        let quad = [segment[0], segment[0] + reach, segment[1] + reach, segment[1]];
        self.near(&quad)
            .into_iter()
            .filter(|&index| !structure.fins()[index].contains(&node))
            .any(|index| quads_meet(&quad, &self.quads[index]))
    }
}

fn bounds(quad: &[Point3; 4]) -> (Point3, Point3) {
    quad.iter().fold((quad[0], quad[0]), |(low, high), p| (low.inf(p), high.sup(p)))
}

/// Whether two planar quads share a point: a side of one goes through the other.
pub(super) fn quads_meet(a: &[Point3; 4], b: &[Point3; 4]) -> bool {
    sides_pierce(a, b) || sides_pierce(b, a)
}

fn sides_pierce(sides: &[Point3; 4], quad: &[Point3; 4]) -> bool {
    let [p, q, r, s] = *quad;
    (0..4).any(|k| {
        let (from, to) = (sides[k], sides[(k + 1) % 4]);
        segment_meets_triangle(from, to, [p, q, r])
            || segment_meets_triangle(from, to, [p, r, s])
    })
}

/// Exact for points in general position; a side that lies in the triangle's plane is left
/// to the other sides.
fn segment_meets_triangle(from: Point3, to: Point3, [a, b, c]: [Point3; 3]) -> bool {
    let (above, below) = (orient(a, b, c, from), orient(a, b, c, to));
    if above == 0.0 || below == 0.0 || (above > 0.0) == (below > 0.0) {
        return false;
    }
    let around = [orient(from, to, a, b), orient(from, to, b, c), orient(from, to, c, a)];
    around.iter().all(|&side| side >= 0.0) || around.iter().all(|&side| side <= 0.0)
}

fn orient(a: Point3, b: Point3, c: Point3, d: Point3) -> f64 {
    let coord = |p: Point3| robust::Coord3D { x: p.x, y: p.y, z: p.z };
    robust::orient3d(coord(a), coord(b), coord(c), coord(d))
}
