//! Steps from triangle to triangle in exact coordinates.

use crate::design::map::{Map, UNIT, cross, side, turned};
use crate::design::surface::{Surface, next};

/// A surface with its map.
pub(super) struct Charts<'a> {
    pub surface: &'a Surface,
    pub map: &'a Map,
}

/// The direction of this many quarter turns, one step long.
pub(super) fn way(quarters: i32) -> [i64; 2] {
    turned([1, 0], quarters)
}

pub(super) fn minus(a: [i64; 2], b: [i64; 2]) -> [i64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

/// Whether a point is where two lines cross.
pub(super) fn is_crossing(at: [i64; 2]) -> bool {
    at.iter().all(|x| x % UNIT == 0)
}

impl Charts<'_> {
    /// Where a corner lies.
    pub(super) fn at(&self, corner: usize) -> [i64; 2] {
        self.map.corners[corner]
    }

    /// The corners of a triangle.
    pub(super) fn corners(&self, triangle: usize) -> [[i64; 2]; 3] {
        [0, 1, 2].map(|k| self.at(3 * triangle + k))
    }

    /// The vector of a half-edge.
    pub(super) fn along(&self, side: usize) -> [i64; 2] {
        minus(self.at(next(side)), self.at(side))
    }

    /// How far a point is to the left of each side of a triangle, each by another measure.
    pub(super) fn sides(&self, triangle: usize, point: [i64; 2]) -> [i128; 3] {
        let [a, b, c] = self.corners(triangle);
        [side(a, b, point), side(b, c, point), side(c, a, point)]
    }

    /// The triangle beyond a half-edge, and by how many quarters directions turn on the way.
    pub(super) fn over(&self, side: usize) -> Option<(usize, i32)> {
        Some((self.surface.twin(side)? / 3, self.map.cut.quarters[side]))
    }

    /// A point in the coordinates of the triangle beyond an inner half-edge.
    pub(super) fn beyond(&self, side: usize, point: [i64; 2]) -> [i64; 2] {
        let Some(twin) = self.surface.twin(side) else { return point };
        let to = self.at(next(twin));
        let by = turned(minus(point, self.at(side)), self.map.cut.quarters[side]);
        [to[0] + by[0], to[1] + by[1]]
    }

    /// Shares of a triangle's corners in a point.
    pub(super) fn shares(&self, triangle: usize, point: [i64; 2]) -> [f64; 3] {
        let [ab, bc, ca] = self.sides(triangle, point);
        let [a, b, c] = self.corners(triangle);
        let whole = side(a, b, c) as f64;
        [bc as f64 / whole, ca as f64 / whole, ab as f64 / whole]
    }

    /// Whether a direction points strictly to the left of a half-edge.
    pub(super) fn is_left(&self, side: usize, quarters: i32) -> bool {
        cross(self.along(side), way(quarters)) > 0
    }
}
