//! The skew of each cross: how far its two directions are from a right angle.

use crate::design::directions::congruence::MOST_SKEW;
use crate::design::directions::{Congruence, Directions, Wish};
use crate::design::surface::{Measures, Surface};
use crate::geometry::trig;
use crate::sparse::{Cholesky, NotPositiveDefinite, Triplets};
use std::f64::consts::FRAC_PI_2;

/// Weight of a right angle where no torsal directions speak, beside their full weight.
const RIGHT_ANGLE: f64 = 0.001;

/// Smooth skews near those of the torsal directions, one per triangle.
pub(super) fn field(
    surface: &Surface,
    measures: &Measures,
    congruence: &Congruence,
    directions: &Directions,
    wish: &Wish,
) -> Result<Vec<f64>, NotPositiveDefinite> {
    let count = surface.triangles.len();
    let torsal = wish.torsal / (wish.cell * wish.cell);
    let mut system = Triplets::new(count);
    let mut right = vec![0.0; count];
    for (triangle, right) in right.iter_mut().enumerate() {
        let turn = directions.theta[triangle] - congruence.theta[triangle];
        let agree = trig::cos(2.0 * turn).powi(2);
        let share = torsal * measures.areas[triangle];
        let weight = share * congruence.confidence[triangle] * agree;
        let sign = 1.0 - 2.0 * (turn / FRAC_PI_2).round().rem_euclid(2.0);
        system.add([triangle, triangle], weight + share * RIGHT_ANGLE);
        *right = weight * sign * congruence.skew[triangle];
    }
    for side in 0..surface.side_count() {
        let Some(twin) = surface.twin(side).filter(|&twin| side < twin) else { continue };
        let odd = directions.quarters[side].rem_euclid(2) == 1;
        let sign = if odd { -1.0 } else { 1.0 };
        let pair = [side / 3, twin / 3];
        system.add_difference(pair, [sign, 1.0], measures.couplings[side]);
    }
    Cholesky::of(&system.matrix())?.solve(&mut right);
    Ok(right.into_iter().map(|skew| skew.clamp(-MOST_SKEW, MOST_SKEW)).collect())
}
