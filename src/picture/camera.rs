//! A parallel projection: what all pictures of things in space are seen with.

use crate::geometry::{Point2, Vector3, trig};

/// Where one looks from: three unit vectors at right angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// To the right in the picture.
    pub right: Vector3,
    /// Upwards in the picture.
    pub up: Vector3,
    /// Out of the picture, toward the eye.
    pub toward: Vector3,
}

impl Camera {
    /// From an angle around the z axis and one up from the ground, radians.
    pub fn level([around, up]: [f64; 2]) -> Self {
        let (sin, cos) = (trig::sin(around), trig::cos(around));
        let right = Vector3::new(-sin, cos, 0.0);
        let flat = Vector3::new(cos, sin, 0.0) * trig::cos(up);
        let toward = flat + Vector3::z() * trig::sin(up);
        Self { right, up: toward.cross(&right), toward }
    }

    /// From an angle around a unit axis, which stands upright, and one up from its plane,
    /// radians.
    pub fn about(axis: &Vector3, [around, up]: [f64; 2]) -> Self {
        let away = if axis.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
        let east = axis.cross(&away).normalize();
        let north = axis.cross(&east);
        let flat = east * trig::cos(around) + north * trig::sin(around);
        let toward = flat * trig::cos(up) + axis * trig::sin(up);
        let right = axis.cross(&toward).normalize();
        Self { right, up: toward.cross(&right), toward }
    }

    /// Fifty degrees off a unit normal: what stands along it shows its faces, what lies
    /// between stays open.
    pub fn slanted(normal: &Vector3) -> Self {
        let aside = if normal.y.abs() < 0.9 { Vector3::y() } else { Vector3::z() };
        let right = aside.cross(normal).normalize();
        let toward = (normal * 0.64 - normal.cross(&right) * 0.77).normalize();
        Self { right, up: toward.cross(&right), toward }
    }

    /// Where a place appears, x to the right and y up.
    pub fn flat(&self, place: &Vector3) -> Point2 {
        Point2::new(place.dot(&self.right), place.dot(&self.up))
    }

    /// How near a place is to the eye.
    pub fn nearness(&self, place: &Vector3) -> f64 {
        place.dot(&self.toward)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_camera_stands_square_and_sees_its_axis_upright() {
        let axis = Vector3::new(0.3, -0.2, 0.9).normalize();
        let from = [-1.0, 0.7];
        let cameras = [
            (Camera::level(from), Vector3::z()),
            (Camera::about(&axis, from), axis),
            (Camera::slanted(&axis), axis),
        ];
        for (Camera { right, up, toward }, upright) in cameras {
            assert!((right.cross(&up) - toward).norm() < 1e-12);
            assert!(
                (right.norm() - 1.0).abs() < 1e-12 && (up.norm() - 1.0).abs() < 1e-12
            );
            assert!(right.dot(&upright).abs() < 1e-12 && up.dot(&upright) > 0.0);
        }
    }
}
