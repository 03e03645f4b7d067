//! Rigid motions of the plane.

use crate::geometry::{Point2, Vector2, trig};

/// A rotation about the origin, then a translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    cos: f64,
    sin: f64,
    translation: Vector2,
}

impl Motion {
    /// By an angle counter-clockwise, radians, then by `translation`, mm.
    pub fn new(angle: f64, translation: Vector2) -> Self {
        Self { cos: trig::cos(angle), sin: trig::sin(angle), translation }
    }

    /// A rotation about the origin by an angle counter-clockwise, radians.
    pub fn rotation(angle: f64) -> Self {
        Self::new(angle, Vector2::zeros())
    }

    /// The rotation about the origin that takes the x axis to a unit vector.
    pub fn x_to(direction: Vector2) -> Self {
        Self { cos: direction.x, sin: direction.y, translation: Vector2::zeros() }
    }

    /// The motion with its translation replaced.
    #[must_use]
    pub fn then_translated(self, translation: Vector2) -> Self {
        Self { translation, ..self }
    }

    /// Where a point comes to lie.
    pub fn apply(&self, p: Point2) -> Point2 {
        Point2::from(self.rotate(p.coords) + self.translation)
    }

    /// A direction after the rotation.
    pub fn rotate(&self, v: Vector2) -> Vector2 {
        let Self { cos, sin, .. } = *self;
        Vector2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
    }

    /// The point that comes to lie at `p`.
    pub fn apply_inverse(&self, p: Point2) -> Point2 {
        let (Self { cos, sin, .. }, p) = (*self, p - self.translation);
        Point2::new(cos * p.x + sin * p.y, -sin * p.x + cos * p.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_motion_turns_first_and_its_inverse_leads_back() {
        let motion = Motion::new(FRAC_PI_2, Vector2::new(10.0, 0.0));
        let p = motion.apply(Point2::new(2.0, 1.0));
        assert!((p - Point2::new(9.0, 2.0)).norm() < 1e-15);
        assert!((motion.apply_inverse(p) - Point2::new(2.0, 1.0)).norm() < 1e-15);
    }
}
