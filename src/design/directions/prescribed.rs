//! Crosses with given singular vertices: a trivial connection (Crane, Desbrun and Schröder
//! 2010, Trivial connections on discrete surfaces).
//!
//! The jumps `r` over edges, least in `Σ w r²`, add up around each inner vertex to its
//! defect less a quarter turn for each of its index: one Laplace equation.

use crate::design::directions::{Congruence, Singular};
use crate::design::spd::{Entries, Factor, NotDefinite};
use crate::design::surface::{Measures, Surface, sides_of};
use crate::geometry::trig;
use crate::tolerance::LEAST_GOAL;
use std::collections::VecDeque;
use std::f64::consts::FRAC_PI_2;

/// Angles of the crosses, radians, turned as a whole to fit the torsal ones best.
pub(super) fn field(
    surface: &Surface,
    measures: &Measures,
    congruence: &Congruence,
    singular: &[Singular],
) -> Result<Vec<f64>, NotDefinite> {
    let jumps = jumps(surface, measures, singular)?;
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
    for (triangle, theta) in theta.iter().enumerate() {
        let weight = measures.areas[triangle] * congruence.confidence[triangle];
        let off = 4.0 * (congruence.theta[triangle] - theta);
        x += weight * trig::cos(off);
        y += weight * trig::sin(off);
    }
    let turn = trig::atan2(y, x) / 4.0;
    Ok(theta.into_iter().map(|theta| theta + turn).collect())
}

/// By how much the cross turns over each half-edge beside being carried.
fn jumps(
    surface: &Surface,
    measures: &Measures,
    singular: &[Singular],
) -> Result<Vec<f64>, NotDefinite> {
    let count = surface.positions.len();
    let mut system = Entries::new(count);
    let mut potential: Vec<f64> = measures.defects.clone();
    for s in singular {
        potential[s.vertex] -= f64::from(s.index) * FRAC_PI_2;
    }
    let loose: Vec<bool> = (0..count).map(|vertex| surface.on_boundary(vertex)).collect();
    for vertex in 0..count {
        // Nothing is asked of the boundary; a closed surface is held a little.
        system.add(vertex, vertex, if loose[vertex] { 1.0 } else { LEAST_GOAL });
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
            (false, true) => system.add(a, a, weight),
            (true, false) => system.add(b, b, weight),
            (true, true) => {}
        }
    }
    Factor::new(&system)?.solve(&mut potential);
    let jump = |side: usize| {
        let rise = potential[surface.tip(side)] - potential[surface.tail(side)];
        if surface.is_boundary(side) { 0.0 } else { rise / measures.couplings[side] }
    };
    Ok((0..surface.side_count()).map(jump).collect())
}
