//! Soft walls: axes stand up from the surface, and nodes go no farther than they may.

use crate::design::planarise::given::{At, Given, Slope, slope};
use crate::design::planarise::options::{Options, Wish};
use crate::design::planarise::surface::unit;
use crate::design::planarise::terms::Term;
use crate::geometry::{Vector3, trig};

pub(super) const WISH: Wish = Wish {
    name: "walls",
    weight: 3.0,
    sentence: "Walls: how hard `--move-limit` and `--tilt-limit` are",
};

/// The angle between an axis and the surface normal.
pub(super) struct TiltLimit {
    weight: f64,
    /// Normal of the surface at each node, on the side of its axis, and the least cosine
    /// between the two.
    upright: Vec<(Vector3, f64)>,
}

impl TiltLimit {
    /// An axis that starts beyond the limit was meant to and may stay.
    pub(super) fn new(given: &Given, options: &Options) -> Self {
        let upright = |(node, axis): (usize, &Vector3)| {
            let normal = given.surface.normal(node);
            let normal = if normal.dot(axis) < 0.0 { -normal } else { normal };
            (normal, trig::cos(options.tilt_limit).min(normal.dot(axis)))
        };
        let upright = given.start.axes.iter().enumerate().map(upright).collect();
        Self { weight: options.weights.of(&WISH), upright }
    }
}

impl Term for TiltLimit {
    fn on_node(&self, node: usize, at: &At, row: &mut dyn FnMut(f64, Slope)) {
        let (normal, least) = self.upright[node];
        let short = at.now.axes[node].dot(&normal) - least;
        if short < 0.0 {
            row(self.weight * short, slope(Vector3::zeros(), normal * self.weight));
        }
    }

    fn silence(&mut self) {
        self.weight = 0.0;
    }
}

/// How far a node has moved.
pub(super) struct MoveLimit {
    pub weight: f64,
}

impl Term for MoveLimit {
    fn on_node(&self, node: usize, at: &At, row: &mut dyn FnMut(f64, Slope)) {
        let moved = at.now.positions[node] - at.given.start.positions[node];
        let far = moved.norm() - at.given.reach[node];
        if far > 0.0 {
            row(self.weight * far, slope(unit(moved) * self.weight, Vector3::zeros()));
        }
    }

    fn silence(&mut self) {
        self.weight = 0.0;
    }
}
