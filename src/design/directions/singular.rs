//! Vertices around which the crosses do not come back to themselves.

use crate::design::directions::Directions;
use crate::design::surface::{Measures, Surface, previous};
use std::f64::consts::FRAC_PI_2;

/// A singular vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::design) struct Singular {
    pub vertex: usize,
    /// In quarter turns: 1 becomes a node of three fins, −1 one of five.
    pub index: i32,
}

/// All inner vertices whose index is not 0.
pub(in crate::design) fn singular(
    surface: &Surface,
    measures: &Measures,
    directions: &Directions,
) -> Vec<Singular> {
    let inner = (0..surface.positions.len()).filter(|&v| !surface.on_boundary(v));
    inner
        .filter_map(|vertex| {
            // Counter-clockwise around the vertex, over the side that comes to it.
            let jumps = surface.fan(vertex).map(|side| {
                let over = previous(side);
                let beyond = surface.twin(over).map_or(0, |twin| twin / 3);
                directions.theta[over / 3] + measures.transports[over]
                    - directions.theta[beyond]
                    - f64::from(directions.quarters[over]) * FRAC_PI_2
            });
            let turn = measures.defects[vertex] - jumps.sum::<f64>();
            let index = (turn / FRAC_PI_2).round() as i32;
            (index != 0).then_some(Singular { vertex, index })
        })
        .collect()
}
