//! The lines along the axes as a discrete line congruence, triangle by triangle.
//!
//! Within a triangle positions and axes change linearly. A direction `d` is torsal if it,
//! the axis `e` and the change of the axis along it lie in one plane; with
//! `S = sym(b_a · (e × D_b e))` in the frame `b` of the triangle this is
//! `m + r cos 2(t − phi) = 0` for the angle `t` of `d`, where `m = tr S / 2` and
//! `r e^{2 i phi} = (S11 − S22) / 2 + i S12` (after Wang, Jiang, Bompas, Wallner and
//! Pottmann 2013, Discrete line congruences for shading and lighting).

use crate::design::surface::{Measures, Surface};
use crate::geometry::{Vector3, trig};
use std::f64::consts::FRAC_PI_4;

/// Torsal directions of each triangle, as far as there are any.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::design) struct Congruence {
    /// Angle of the cross between them, radians.
    pub theta: Vec<f64>,
    /// Sine of twice the angle by which they close up.
    pub skew: Vec<f64>,
    /// How much they mean, from 0 (every direction is torsal) to 1.
    pub confidence: Vec<f64>,
    /// Area share without real directions, or with a pair clamped to [`MOST_SKEW`].
    pub clamped: f64,
    /// Whether the axes are parallel, so that nothing tells one direction from another.
    pub parallel: bool,
}

/// Largest skew: families cross at 45° and more.
pub(super) const MOST_SKEW: f64 = 0.7;
/// Shear of the axes below this share of their whole change means little.
const LEAST_SHEAR: f64 = 0.1;

impl Congruence {
    pub(in crate::design) fn of(
        surface: &Surface,
        measures: &Measures,
        axes: &[Vector3],
    ) -> Self {
        let count = surface.triangles.len();
        let (mut theta, mut skew) =
            (Vec::with_capacity(count), Vec::with_capacity(count));
        let (mut shears, mut changes) = (Vec::with_capacity(count), 0.0);
        let mut clamped = 0.0;
        for (triangle, corners) in surface.triangles.iter().enumerate() {
            let slopes = measures.slopes(triangle);
            let change = |a: usize| -> Vector3 {
                (0..3).map(|k| axes[corners[k]] * slopes[k][a]).sum()
            };
            let axis: Vector3 = corners.iter().map(|&k| axes[k]).sum::<Vector3>() / 3.0;
            let by = [change(0), change(1)];
            let frame = &measures.frames[triangle];
            let s = |a: usize, b: usize| frame[a].dot(&axis.cross(&by[b]));
            let mean = (s(0, 0) + s(1, 1)) / 2.0;
            let shear = [(s(0, 0) - s(1, 1)) / 2.0, (s(0, 1) + s(1, 0)) / 2.0];
            let r = libm::hypot(shear[0], shear[1]);
            let closes = if r > 0.0 { -mean / r } else { 0.0 };
            if closes.abs() > MOST_SKEW {
                clamped += measures.areas[triangle];
            }
            theta.push(trig::atan2(shear[1], shear[0]) / 2.0 - FRAC_PI_4);
            skew.push(closes.clamp(-MOST_SKEW, MOST_SKEW));
            shears.push(r);
            changes += by[0].norm_squared() + by[1].norm_squared();
        }
        let mut sorted = shears.clone();
        sorted.sort_by(f64::total_cmp);
        let median = sorted.get(count / 2).copied().unwrap_or(0.0);
        let rms = (changes / count.max(1) as f64).sqrt();
        let enough = median.max(LEAST_SHEAR * rms);
        let parallel = rms * measures.area().sqrt() < crate::tolerance::PARALLEL_AXES;
        let confidence =
            |r: f64| if parallel { 0.0 } else { (r / enough).min(1.0).powi(2) };
        Self {
            theta,
            skew,
            confidence: shears.into_iter().map(confidence).collect(),
            clamped: clamped / measures.area(),
            parallel,
        }
    }
}
