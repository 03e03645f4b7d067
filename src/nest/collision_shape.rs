//! Shapes and edges of remnants, ready for the search.

use crate::geometry::ring::area;
use crate::geometry::{Motion, Point2, Rect, Vector2};
use crate::nest::convex::ConvexPieces;
use crate::nest::convex_decomposition::{convex_decomposition, mean_width, open_holes};
use crate::nest::interlock::Centerline;
use crate::nest::{Placement, Remnant, Rotations, Shape, rotation};

/// How far the wall around a remnant reaches beyond the rectangle around it, mm.
pub(super) const WALL: f64 = 1.0;

/// Where a part's middle is, and its angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pose {
    pub(super) angle: f64,
    pub(super) x: f64,
    pub(super) y: f64,
}

impl Pose {
    /// Of a part that is in no bin.
    pub(super) const NOWHERE: Self = Self { angle: 0.0, x: f64::NAN, y: f64::NAN };

    pub(super) const fn is_nowhere(&self) -> bool {
        self.x.is_nan()
    }

    pub(super) fn translation(&self) -> Vector2 {
        Vector2::new(self.x, self.y)
    }
}

/// A shape ready for the search.
#[derive(Debug)]
pub(super) struct CollisionShape {
    /// At angle 0 about `middle`.
    pub(super) still: ConvexPieces,
    middle: Point2,
    /// Allowed angles; empty if free.
    pub(super) angles: Vec<f64>,
    pub(super) size: f64,
    /// Without the holes that parts may lie in, mm².
    pub(super) area: f64,
    /// Share of this shape in a pair's loss: large parts count for more.
    pub(super) weight: f64,
    /// If it is slender and rotates freely.
    pub(super) centerline: Option<Centerline>,
}

/// Shapes ready for the search, and which of them each shape is: neighbours that are
/// alike share one. `None` if rings cross.
pub(super) fn collision_shapes(
    shapes: &[Shape],
    spacing: f64,
) -> Option<(Vec<CollisionShape>, Vec<usize>)> {
    let gate = gate(shapes, spacing);
    let (mut all, mut which): (Vec<CollisionShape>, Vec<usize>) =
        (Vec::new(), Vec::new());
    for (k, shape) in shapes.iter().enumerate() {
        if k == 0 || shapes[k - 1] != *shape {
            all.push(CollisionShape::new(shape, gate)?);
        }
        which.push(all.len() - 1);
    }
    Some((all, which))
}

/// Narrower pockets and holes are of no use: no part would fit.
pub(super) fn gate(shapes: &[Shape], spacing: f64) -> f64 {
    let widths = shapes.iter().map(|s| mean_width(&s.outline));
    spacing + widths.fold(f64::INFINITY, f64::min) / 2.0
}

impl CollisionShape {
    fn new(shape: &Shape, gate: f64) -> Option<Self> {
        let pieces = convex_decomposition(&shape.outline, &shape.holes, gate)?;
        let middle = Rect::around(&shape.outline).center();
        let [long, wide] = rotation::least_rectangle(&shape.outline);
        let angles = match &shape.rotations {
            Rotations::Free => Vec::new(),
            Rotations::Only(angles) => {
                angles.iter().copied().map(rotation::rounded).collect()
            }
        };
        let still = ConvexPieces::new(&pieces, middle);
        let size = (long * wide).max(f64::MIN_POSITIVE);
        let open: f64 = open_holes(&shape.holes, gate).map(|hole| area(hole)).sum();
        let (area, weight) = (area(&shape.outline) - open, size.sqrt().sqrt());
        let is_free = shape.rotations == Rotations::Free;
        let centerline = Centerline::of(&shape.outline, middle).filter(|_| is_free);
        Some(Self { still, middle, angles, size, area, weight, centerline })
    }

    /// All that a remnant lacks of the rectangle around it, and a frame.
    pub(super) fn wall(remnant: &Remnant) -> Option<Self> {
        let Rect { min: low, max: high } = Rect::around(&remnant.outline);
        let [l, b, r, t] = [low.x - WALL, low.y - WALL, high.x + WALL, high.y + WALL];
        let frame = [(l, b), (r, b), (r, t), (l, t)].map(|(x, y)| Point2::new(x, y));
        let mut all =
            convex_decomposition(&frame, std::slice::from_ref(&remnant.outline), 0.0)?;
        for hole in &remnant.holes {
            all.extend(convex_decomposition(hole, &[], 0.0)?);
        }
        let size = (high.x - low.x) * (high.y - low.y);
        let (angles, middle) = (vec![0.0], Point2::origin());
        let still = ConvexPieces::new(&all, middle);
        let (area, weight, centerline) = (0.0, size.sqrt().sqrt(), None);
        Some(Self { still, middle, angles, size, area, weight, centerline })
    }

    /// The placement that a pose means, seen from `by` beside the pose's origin.
    pub(super) fn placement(&self, shape: usize, pose: Pose, by: [f64; 2]) -> Placement {
        let angle = rotation::rounded(pose.angle);
        let middle = Motion::rotation(angle).apply(self.middle);
        let rounded = |mm: f64| (mm * 1e6).round() / 1e6;
        let (x, y) =
            (rounded(pose.x + by[0] - middle.x), rounded(pose.y + by[1] - middle.y));
        Placement { shape, angle, x, y }
    }

    /// The pose that a placement means.
    pub(super) fn pose(&self, placement: &Placement, by: [f64; 2]) -> Pose {
        let &Placement { angle, x, y, .. } = placement;
        let middle = Motion::rotation(angle).apply(self.middle);
        Pose { angle, x: x + middle.x + by[0], y: y + middle.y + by[1] }
    }
}
