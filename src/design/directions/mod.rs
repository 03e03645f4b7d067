//! Directions of the two families of fins on a surface: torsal ones where the axes say so,
//! smooth everywhere.
//!
//! In a triangle the two directions are a cross with a skew: `t1 = theta + delta`,
//! `t2 = theta + 90° − delta`, `sin 2 delta = skew`. A quarter turn of the cross swaps the
//! families and the sign of the skew, so that the skew vanishes by itself at nodes of three
//! and five fins. Where the pair of directions turns by quarters from one triangle to the
//! next stands in [`Directions::quarters`]; vertices around which it does not come back to
//! itself are singular.

mod congruence;
mod cross;
mod prescribed;
mod singular;
mod skew;

pub(super) use congruence::Congruence;
pub(super) use cross::boundary_turn;
pub(super) use singular::{Singular, singular};

use crate::design::surface::{Measures, Surface};
use crate::geometry::{Vector2, Vector3, trig};
use crate::sparse::NotPositiveDefinite;
use std::f64::consts::FRAC_PI_2;

/// How directions are sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Wish<'a> {
    /// Wanted length of a fin, mm.
    pub cell: f64,
    /// Weight of the torsal directions beside smoothness; where it is 0.65 smoothing
    /// reaches 1.2 cells.
    pub torsal: f64,
    /// Whether directions follow the boundary.
    pub align: bool,
    /// Whether they follow the lines inside.
    pub follow: bool,
    /// Where singular vertices have to be; `None`: where they come.
    pub singular: Option<&'a [Singular]>,
}

/// A pair of directions in each triangle.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Directions {
    /// Angle of the cross in the frame of the triangle, radians.
    pub theta: Vec<f64>,
    /// Sine of twice the angle by which the pair closes up.
    pub skew: Vec<f64>,
    /// For each inner half-edge: by how many quarter turns the cross beyond is behind this
    /// one, when carried over the edge; 0 on the boundary.
    pub quarters: Vec<i32>,
}

impl Directions {
    /// Smooth directions near the torsal ones of `axes`.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] if a system cannot be factored.
    pub(super) fn of(
        surface: &Surface,
        measures: &Measures,
        axes: &[Vector3],
        wish: &Wish,
    ) -> Result<Self, NotPositiveDefinite> {
        let congruence = Congruence::of(surface, measures, axes);
        let theta = match wish.singular {
            Some(given) => {
                prescribed::field(surface, measures, &congruence, given, wish.align)?
            }
            None => cross::field(surface, measures, &congruence, wish)?,
        };
        let quarters = (0..surface.side_count())
            .map(|side| {
                let Some(twin) = surface.twin(side) else { return 0 };
                // Rounded once for both half-edges, so that they agree.
                let (from, sign) = if side < twin { (side, 1) } else { (twin, -1) };
                let to = side.max(twin);
                let turn = theta[from / 3] + measures.transports[from] - theta[to / 3];
                sign * (turn / FRAC_PI_2).round() as i32
            })
            .collect();
        let mut directions = Self { theta, skew: Vec::new(), quarters };
        directions.skew = skew::field(surface, measures, &congruence, &directions, wish)?;
        Ok(directions)
    }

    /// The two directions of a triangle, turned by `quarters`, in its frame.
    pub(super) fn pair(&self, triangle: usize, quarters: i32) -> [Vector2; 2] {
        let sign = if quarters.rem_euclid(2) == 1 { -1.0 } else { 1.0 };
        let delta = libm::asin(sign * self.skew[triangle]) / 2.0;
        let theta = self.theta[triangle] + f64::from(quarters) * FRAC_PI_2;
        [theta + delta, theta + FRAC_PI_2 - delta]
            .map(|angle| Vector2::new(trig::cos(angle), trig::sin(angle)))
    }
}
