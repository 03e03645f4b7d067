//! Plates as convex solids in space, and whether two of them share a point.

use crate::geometry::{Point3, Vector3, trig};
use crate::tolerance::NO_LENGTH_MM;
use std::f64::consts::PI;

/// A convex flat outline, as thick on both sides of its plane as it is said.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Plate {
    /// The corners of both faces.
    corners: Vec<Point3>,
    /// Directions of the outline's sides, none twice, and across the plane.
    edges: Vec<Vector3>,
    normal: Vector3,
}

impl Plate {
    /// From the outline in its middle plane; `normal` of unit length.
    pub(crate) fn new(outline: &[Point3], normal: Vector3, thickness: f64) -> Self {
        let half = normal * (thickness / 2.0);
        let corners = outline.iter().flat_map(|p| [p - half, p + half]).collect();
        let next = outline.iter().cycle().skip(1);
        let sides = outline.iter().zip(next).map(|(a, b)| b - a);
        let mut edges: Vec<Vector3> = vec![normal];
        for side in sides.filter(|side| side.norm() > NO_LENGTH_MM) {
            let side = side.normalize();
            if edges.iter().all(|edge| edge.cross(&side).norm() > NO_LENGTH_MM) {
                edges.push(side);
            }
        }
        Self { corners, edges, normal }
    }

    /// A round plate, replaced by a polygon around it.
    pub(crate) fn round(
        center: Point3,
        axis: Vector3,
        radius: f64,
        thickness: f64,
    ) -> Self {
        let across = if axis.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
        let u = axis.cross(&across).normalize();
        let halves = [u, -u].map(|u| Self::arc(center, [u, axis.cross(&u)], radius));
        Self::new(&halves.concat(), axis, thickness)
    }

    /// The corners of a polygon around half a circle, the half toward the first direction:
    /// from the second direction over the first.
    pub(crate) fn arc(center: Point3, [u, v]: [Vector3; 2], radius: f64) -> Vec<Point3> {
        const SIDES: u32 = 12;
        let step = PI / f64::from(SIDES);
        let around = radius / trig::cos(step / 2.0);
        let corner = |k: u32| {
            let angle = step * (f64::from(k) + 0.5) - PI / 2.0;
            center + (u * trig::cos(angle) + v * trig::sin(angle)) * around
        };
        (0..SIDES).map(corner).collect()
    }

    /// Lowest and highest corner of the box around it.
    pub(crate) fn bounds(&self) -> [Point3; 2] {
        let first = self.corners.first().copied().unwrap_or_else(Point3::origin);
        let low = self.corners.iter().fold(first, |low, p| low.inf(p));
        let high = self.corners.iter().fold(first, |high, p| high.sup(p));
        [low, high]
    }

    /// How far two plates reach into each other: the least way that would part them; 0 or
    /// less if they are apart. Exact, by all axes that can separate two convex polyhedra.
    pub(crate) fn overlap(&self, other: &Self) -> f64 {
        let faces = |plate: &Self| {
            let sides = plate.edges.iter().skip(1).map(|edge| edge.cross(&plate.normal));
            sides.chain([plate.normal]).collect::<Vec<_>>()
        };
        let crossed =
            self.edges.iter().flat_map(|a| other.edges.iter().map(move |b| a.cross(b)));
        let axes = faces(self).into_iter().chain(faces(other)).chain(crossed);
        let mut least = f64::INFINITY;
        for axis in axes.filter(|axis| axis.norm() > NO_LENGTH_MM) {
            let axis = axis.normalize();
            let [low, high] = self.span(axis);
            let [other_low, other_high] = other.span(axis);
            least = least.min((high - other_low).min(other_high - low));
            if least <= 0.0 {
                return least;
            }
        }
        least
    }

    fn span(&self, axis: Vector3) -> [f64; 2] {
        let along = || self.corners.iter().map(|p| p.coords.dot(&axis));
        [along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(at: Point3, u: Vector3, v: Vector3) -> Plate {
        let outline = [(-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)];
        let outline = outline.map(|(x, y)| at + u * x + v * y);
        Plate::new(&outline, u.cross(&v), 2.0)
    }

    #[test]
    fn plates_overlap_by_the_least_way_that_parts_them() {
        let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
        let flat = square(Point3::origin(), x, y);
        let above = square(Point3::new(0.0, 0.0, 1.5), x, y);
        assert!((flat.overlap(&above) - 0.5).abs() < 1e-12);
        let upright = square(Point3::new(6.5, 0.0, 0.0), y, z);
        assert!((flat.overlap(&upright) + 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_round_plate_lies_inside_its_polygon() {
        let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
        let flat = square(Point3::origin(), x, y);
        let above = Plate::round(Point3::new(0.0, 0.0, 3.0), z, 4.0, 2.0);
        assert!((flat.overlap(&above) + 1.0).abs() < 1e-12);
        let beside = Plate::round(Point3::new(9.1, 0.0, 0.0), z, 4.0, 2.0);
        assert!(flat.overlap(&beside) < 0.0);
        let touching = Plate::round(Point3::new(8.9, 0.0, 0.0), z, 4.0, 2.0);
        assert!(flat.overlap(&touching) > 0.0);
    }

    #[test]
    fn only_two_edges_crossed_part_these() {
        // Two sticks on edge, one over the other crosswise: no face of either parts them.
        let diagonal = |u: Vector3, v: Vector3| (u + v).normalize();
        let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
        let stick = |at: Point3, along: Vector3, across: Vector3| {
            let outline = [(-9.0, -1.0), (9.0, -1.0), (9.0, 1.0), (-9.0, 1.0)]
                .map(|(s, w)| at + along * s + across * w);
            Plate::new(&outline, along.cross(&across), 2.0)
        };
        let low = stick(Point3::origin(), x, diagonal(y, z));
        let high = |z| stick(Point3::new(0.0, 0.0, z), y, diagonal(x, Vector3::z()));
        let root = 2.0_f64.sqrt();
        assert!((low.overlap(&high(2.0 * root + 0.1)) + 0.1).abs() < 1e-9);
        assert!(low.overlap(&high(2.0 * root - 0.1)) > 0.0);
    }
}
