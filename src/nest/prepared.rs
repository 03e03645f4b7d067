//! Shapes and edges of remnants, ready for the search.

use crate::geometry::{Point2, trig};
use crate::nest::check::bounds;
use crate::nest::crowd::Pose;
use crate::nest::pieces::{area, pieces, width};
use crate::nest::slender::Spine;
use crate::nest::turned::Turned;
use crate::nest::{Placement, Remnant, Shape, Turns, turn};

/// How far the wall around a remnant reaches beyond the rectangle around it, mm.
pub(super) const WALL: f64 = 1.0;

/// A shape ready for the search.
#[derive(Debug)]
pub(super) struct Prepared {
    /// At angle 0 about `middle`.
    pub(super) still: Turned,
    middle: Point2,
    /// Allowed angles; empty if free.
    pub(super) angles: Vec<f64>,
    pub(super) size: f64,
    pub(super) area: f64,
    /// Share of this shape in a pair's loss: large parts count for more.
    pub(super) weight: f64,
    /// If it is slender and turns freely.
    pub(super) spine: Option<Spine>,
}

/// Shapes ready for the search, and which of them each shape is: neighbours that are
/// alike share one. `None` if rings cross.
pub(super) fn prepared(
    shapes: &[Shape],
    spacing: f64,
) -> Option<(Vec<Prepared>, Vec<usize>)> {
    let slimmest = shapes.iter().map(|s| width(&s.outline)).fold(f64::INFINITY, f64::min);
    let gate = spacing + slimmest / 2.0;
    let (mut all, mut which): (Vec<Prepared>, Vec<usize>) = (Vec::new(), Vec::new());
    for (k, shape) in shapes.iter().enumerate() {
        if k == 0 || shapes[k - 1] != *shape {
            all.push(Prepared::new(shape, gate)?);
        }
        which.push(all.len() - 1);
    }
    Some((all, which))
}

impl Prepared {
    fn new(shape: &Shape, gate: f64) -> Option<Self> {
        let pieces = pieces(&shape.outline, &shape.holes, gate)?;
        let (low, high) = bounds(&shape.outline);
        let middle = nalgebra::center(&low, &high);
        let [long, wide] = turn::least_rectangle(&shape.outline);
        let angles = match &shape.turns {
            Turns::Free => Vec::new(),
            Turns::Only(angles) => angles.iter().copied().map(turn::rounded).collect(),
        };
        let still = Turned::new(&pieces, middle);
        let size = (long * wide).max(f64::MIN_POSITIVE);
        let (area, weight) = (area(&shape.outline), size.sqrt().sqrt());
        let is_free = shape.turns == Turns::Free;
        let spine = Spine::of(&shape.outline, middle).filter(|_| is_free);
        Some(Self { still, middle, angles, size, area, weight, spine })
    }

    /// All that a remnant lacks of the rectangle around it, and a frame.
    pub(super) fn wall(remnant: &Remnant) -> Option<Self> {
        let (low, high) = bounds(&remnant.outline);
        let [l, b, r, t] = [low.x - WALL, low.y - WALL, high.x + WALL, high.y + WALL];
        let frame = [(l, b), (r, b), (r, t), (l, t)].map(|(x, y)| Point2::new(x, y));
        let mut all = pieces(&frame, std::slice::from_ref(&remnant.outline), 0.0)?;
        for hole in &remnant.holes {
            all.extend(pieces(hole, &[], 0.0)?);
        }
        let size = (high.x - low.x) * (high.y - low.y);
        let (angles, middle) = (vec![0.0], Point2::origin());
        let still = Turned::new(&all, middle);
        let (area, weight, spine) = (0.0, size.sqrt().sqrt(), None);
        Some(Self { still, middle, angles, size, area, weight, spine })
    }

    /// The placement that a pose means, seen from `by` beside the pose's origin.
    pub(super) fn placement(&self, shape: usize, pose: Pose, by: [f64; 2]) -> Placement {
        let angle = turn::rounded(pose.angle);
        let [x, y] = turned(self.middle, angle);
        let rounded = |mm: f64| (mm * 1e6).round() / 1e6;
        let (x, y) = (rounded(pose.x + by[0] - x), rounded(pose.y + by[1] - y));
        Placement { shape, angle, x, y }
    }

    /// The pose that a placement means.
    pub(super) fn pose(&self, placement: &Placement, by: [f64; 2]) -> Pose {
        let &Placement { angle, x, y, .. } = placement;
        let middle = turned(self.middle, angle);
        Pose { angle, x: x + middle[0] + by[0], y: y + middle[1] + by[1] }
    }
}

/// A point turned about the origin.
pub(super) fn turned(p: Point2, angle: f64) -> [f64; 2] {
    let (sin, cos) = (trig::sin(angle), trig::cos(angle));
    [cos * p.x - sin * p.y, sin * p.x + cos * p.y]
}
