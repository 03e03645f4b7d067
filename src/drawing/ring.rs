//! Closed lines that are cut, and how they lie to each other.

use crate::drawing::Curve;
use crate::geometry::predicates::contains;
use crate::geometry::{Contour, Point2, Rect};
use crate::tolerance::{ARC_SAGITTA_MM, JOINED_MM};

/// A closed line that is cut.
pub(super) struct Ring {
    pub(super) contour: Contour,
    polygon: Vec<Point2>,
    pub(super) bounds: Rect,
    pub(super) area: f64,
}

/// Corners of a ring that are asked where they lie, at most: one may touch another ring.
const WITNESSES: usize = 9;

impl Ring {
    pub(super) fn new(curve: &Curve) -> Self {
        let contour = curve.contour();
        let (polygon, area) =
            (contour.flattened(ARC_SAGITTA_MM), contour.signed_area().abs());
        let bounds = Rect::around(&polygon);
        Self { contour, polygon, bounds, area }
    }

    /// The line as it runs around material, or around a hole.
    pub(super) fn turned(&self, counter_clockwise: bool) -> Contour {
        if (self.contour.signed_area() > 0.0) == counter_clockwise {
            self.contour.clone()
        } else {
            self.contour.reversed()
        }
    }

    pub(super) fn contains(&self, p: Point2) -> bool {
        self.bounds.contains(p) && contains(&self.polygon, p)
    }

    /// Whether most of another ring lies in this one.
    pub(super) fn surrounds(&self, other: &Self) -> bool {
        if self.area <= other.area || !self.bounds.touches(&other.bounds) {
            return false;
        }
        let step = other.polygon.len().div_ceil(WITNESSES);
        let witnesses = || other.polygon.iter().step_by(step);
        let inside = witnesses().filter(|p| self.contains(**p)).count();
        2 * inside > witnesses().count()
    }

    /// Whether a point lies on its line.
    pub(super) fn is_under(&self, p: Point2) -> bool {
        let next = self.polygon.iter().cycle().skip(1);
        let mut edges = self.polygon.iter().zip(next);
        self.bounds.inflated(JOINED_MM).contains(p)
            && edges.any(|(&a, &b)| off(p, [a, b]) <= JOINED_MM)
    }

    /// Whether another ring is the same line.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        let [a, b] = [self.bounds, other.bounds];
        (a.min - b.min).amax() <= JOINED_MM
            && (a.max - b.max).amax() <= JOINED_MM
            && other.polygon.iter().all(|p| self.is_under(*p))
            && self.polygon.iter().all(|p| other.is_under(*p))
    }
}

/// Distance of a point from an edge, mm.
pub(super) fn off(p: Point2, [a, b]: [Point2; 2]) -> f64 {
    let (way, off) = (b - a, p - a);
    let share = off.dot(&way) / way.norm_squared().max(f64::MIN_POSITIVE);
    (off - way * share.clamp(0.0, 1.0)).norm()
}
