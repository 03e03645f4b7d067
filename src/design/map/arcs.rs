//! Pieces of the boundary, and of lines inside, along which one coordinate is a whole number.

use crate::design::directions::Directions;
use crate::design::map::cut::Cut;
use crate::design::surface::{Line, Measures, Surface, next, previous};
use std::f64::consts::FRAC_PI_2;

/// A piece of a line in one chart: corners with the coordinate that is the same whole
/// number at all of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Arc {
    pub corners: Vec<(usize, usize)>,
}

/// A line that misses the directions by more than this, radians, is not followed.
const MOST_MISFIT: f64 = 20.0 * std::f64::consts::PI / 180.0;

/// An edge with the direction in which it runs, in quarters of its chart, and how
/// far it misses that.
struct Edge {
    side: usize,
    quarters: i32,
    misfit: f64,
    /// How it goes on: the same way, and without a cut between.
    straight: bool,
    same_chart: bool,
}

/// The pieces of lines; the surface is to the left of boundary loops.
pub(super) fn arcs(
    surface: &Surface,
    measures: &Measures,
    directions: &Directions,
    cut: &Cut,
    lines: &[Line],
) -> Vec<Arc> {
    let mut arcs = Vec::new();
    for line in lines {
        let edges = edges(surface, measures, directions, cut, line);
        let count = edges.len();
        // Begin where a piece does.
        let first = (0..count).find(|&k| !edges[(k + count - 1) % count].straight);
        let order: Vec<usize> =
            (0..count).map(|k| (first.unwrap_or(0) + k) % count).collect();
        let ends = |k: usize| !edges[k].straight;
        for piece in order.split_inclusive(|&k| ends(k)) {
            let weigh = |k: &usize| {
                let length = surface.length(edges[*k].side);
                [length, length * edges[*k].misfit]
            };
            let sums =
                piece.iter().map(weigh).fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
            if sums[1] > MOST_MISFIT * sums[0] {
                continue;
            }
            for run in piece.split_inclusive(|&k| !edges[k].same_chart) {
                let corners = run.iter().flat_map(|&k| {
                    let component = usize::from(edges[k].quarters % 2 == 0);
                    [edges[k].side, next(edges[k].side)].map(|side| (side, component))
                });
                arcs.push(Arc { corners: corners.collect() });
            }
        }
    }
    arcs
}

fn edges(
    surface: &Surface,
    measures: &Measures,
    directions: &Directions,
    cut: &Cut,
    line: &Line,
) -> Vec<Edge> {
    let run = |side: usize| {
        let triangle = side / 3;
        let theta =
            directions.theta[triangle] + f64::from(cut.turns[triangle]) * FRAC_PI_2;
        let turn = (measures.directions[side] - theta) / FRAC_PI_2;
        let nearest = turn.round();
        ((nearest as i32).rem_euclid(4), (turn - nearest).abs() * FRAC_PI_2)
    };
    let onward = line.sides.iter().cycle().skip(1);
    line.sides
        .iter()
        .zip(onward)
        .enumerate()
        .map(|(k, (&side, &after))| {
            let (quarters, misfit) = run(side);
            if k + 1 == line.sides.len() && !line.closed {
                return Edge {
                    side,
                    quarters,
                    misfit,
                    straight: false,
                    same_chart: true,
                };
            }
            // Counter-clockwise around the vertex between, from the edge after.
            let over: Vec<usize> = surface
                .fan_from(after)
                .map(previous)
                .take_while(|&over| over != side)
                .collect();
            let turn: i32 = over.iter().map(|&over| cut.quarters[over]).sum();
            let straight = (run(after).0 + turn - quarters).rem_euclid(4) == 0;
            let same_chart = over.iter().all(|&over| cut.segments[over].is_none());
            Edge { side, quarters, misfit, straight, same_chart }
        })
        .collect()
}
