//! Crosses with given singular vertices: a trivial connection (Crane, Desbrun and Schröder
//! 2010, Trivial connections on discrete surfaces).
//!
//! The jumps `r` over edges, least in `Σ w r²`, add up around each inner vertex to its
//! defect less a quarter turn for each of its index: one Laplace equation. Where the
//! boundary is followed, the same is asked of its vertices, with whole quarter turns in its
//! corners.

use crate::design::directions::{Congruence, Singular};
use crate::design::surface::{Measures, Surface, sides_of};
use crate::geometry::trig;
use crate::sparse::{Cholesky, NotPositiveDefinite, Triplets};
use crate::tolerance::LEAST_GOAL;
use std::collections::VecDeque;
use std::f64::consts::FRAC_PI_2;

/// Weight of the boundary beside torsal directions where the crosses follow it.
const FOLLOWED: f64 = 1_000_000.0;

/// Angles of the crosses, radians, turned as a whole to fit the torsal ones best.
pub(super) fn field(
    surface: &Surface,
    measures: &Measures,
    congruence: &Congruence,
    singular: &[Singular],
    align: bool,
) -> Result<Vec<f64>, NotPositiveDefinite> {
    let follows = align && may_follow(surface, measures, singular);
    let jumps = jumps(surface, measures, singular, follows)?;
    let mut theta = vec![None; surface.triangles.len()];
    let mut open = VecDeque::from([0]);
    theta[0] = Some(0.0);
    while let Some(triangle) = open.pop_front() {
        for side in sides_of(triangle) {
            let Some(beyond) = surface.twin(side).map(|twin| twin / 3) else { continue };
            if theta[beyond].is_none() {
                let turn = measures.transports[side] - jumps[side];
                theta[beyond] = theta[triangle].map(|theta| theta + turn);
                open.push_back(beyond);
            }
        }
    }
    let theta: Vec<f64> = theta.into_iter().map(|theta| theta.unwrap_or(0.0)).collect();
    let (mut x, mut y) = (0.0, 0.0);
    let rim = (0..surface.side_count()).filter(|&side| surface.is_boundary(side));
    for side in rim.filter(|_| follows) {
        let off = 4.0 * (measures.directions[side] - theta[side / 3]);
        x += FOLLOWED * surface.length(side) * trig::cos(off);
        y += FOLLOWED * surface.length(side) * trig::sin(off);
    }
    for (triangle, theta) in theta.iter().enumerate() {
        let weight = measures.areas[triangle] * congruence.confidence[triangle];
        let off = 4.0 * (congruence.theta[triangle] - theta);
        x += weight * trig::cos(off);
        y += weight * trig::sin(off);
    }
    let turn = trig::atan2(y, x) / 4.0;
    Ok(theta.into_iter().map(|theta| theta + turn).collect())
}

/// How many quarter turns the boundary makes in a vertex.
fn corner(measures: &Measures, vertex: usize) -> f64 {
    (measures.defects[vertex] / FRAC_PI_2).round()
}

/// Whether crosses with these singular vertices can follow the whole boundary.
fn may_follow(surface: &Surface, measures: &Measures, singular: &[Singular]) -> bool {
    let inside: i32 = singular.iter().map(|s| s.index).sum();
    let rim = (0..surface.positions.len()).filter(|&vertex| surface.on_boundary(vertex));
    let corners: f64 = rim.map(|vertex| corner(measures, vertex)).sum();
    surface.boundary().len() == 1
        && i64::from(inside) + corners as i64 == 4 * surface.euler()
}

/// By how much the cross turns over each half-edge beside being carried.
fn jumps(
    surface: &Surface,
    measures: &Measures,
    singular: &[Singular],
    follows: bool,
) -> Result<Vec<f64>, NotPositiveDefinite> {
    let count = surface.positions.len();
    let mut system = Triplets::new(count);
    let mut potential: Vec<f64> = measures.defects.clone();
    for s in singular {
        potential[s.vertex] -= f64::from(s.index) * FRAC_PI_2;
    }
    let on_rim = |vertex: usize| surface.on_boundary(vertex);
    let loose: Vec<bool> = (0..count).map(|vertex| !follows && on_rim(vertex)).collect();
    for vertex in 0..count {
        if follows && on_rim(vertex) {
            potential[vertex] -= corner(measures, vertex) * FRAC_PI_2;
        }
        // Nothing is asked of a loose boundary; what none holds is held a little.
        system.add([vertex, vertex], if loose[vertex] { 1.0 } else { LEAST_GOAL });
        if loose[vertex] {
            potential[vertex] = 0.0;
        }
    }
    for side in 0..surface.side_count() {
        let Some(twin) = surface.twin(side).filter(|&twin| side < twin) else { continue };
        let weight = 1.0 / measures.couplings[side];
        let (a, b) = (surface.tail(side), surface.tail(twin));
        match (loose[a], loose[b]) {
            (false, false) => system.add_difference([a, b], [1.0, 1.0], weight),
            (false, true) => system.add([a, a], weight),
            (true, false) => system.add([b, b], weight),
            (true, true) => {}
        }
    }
    Cholesky::of(&system.matrix())?.solve(&mut potential);
    let jump = |side: usize| {
        let rise = potential[surface.tip(side)] - potential[surface.tail(side)];
        if surface.is_boundary(side) { 0.0 } else { rise / measures.couplings[side] }
    };
    Ok((0..surface.side_count()).map(jump).collect())
}
