//! Points on a surface, and the nearest of them to a point in space.

use crate::design::planarise::shares;
use crate::design::surface::Surface;
use crate::geometry::{Point3, Vector3};

/// A point of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// The triangle.
    pub triangle: usize,
    /// Shares of its corners; their sum is 1.
    pub shares: [f64; 3],
}

impl Surface {
    /// Where a foot lies in space.
    pub fn point(&self, foot: Foot) -> Point3 {
        let corners = self.triangles[foot.triangle];
        let by = |k: usize| self.positions[corners[k]].coords * foot.shares[k];
        Point3::from(by(0) + by(1) + by(2))
    }

    /// Vectors of the vertices, interpolated at a foot, of unit length.
    pub fn between(&self, vectors: &[Vector3], foot: Foot) -> Vector3 {
        let corners = self.triangles[foot.triangle];
        let sum: Vector3 = (0..3).map(|k| vectors[corners[k]] * foot.shares[k]).sum();
        sum.try_normalize(0.0).unwrap_or(vectors[corners[0]])
    }

    /// The triangle whose middle is nearest to `p`.
    pub fn nearest_triangle(&self, p: Point3) -> usize {
        let far = |triangle: &usize| {
            let corners = self.triangles[*triangle].map(|k| self.positions[k].coords);
            (corners.iter().sum::<Vector3>() / 3.0 - p.coords).norm_squared()
        };
        let nearest = (0..self.triangles.len()).min_by(|a, b| far(a).total_cmp(&far(b)));
        nearest.unwrap_or(0)
    }

    /// The point nearest to `p`, sought from triangle to triangle as long as that leads
    /// nearer.
    pub fn foot(&self, p: Point3, start: usize) -> Foot {
        let on = |triangle: usize| {
            let corners = self.triangles[triangle].map(|k| self.positions[k]);
            let foot = Foot { triangle, shares: shares(&corners, p) };
            ((self.point(foot) - p).norm_squared(), foot)
        };
        let mut best = on(start);
        loop {
            let centre = best.1.triangle;
            let around = self.triangles[centre].into_iter();
            let near =
                around.flat_map(|vertex| self.fan(vertex)).map(|side| on(side / 3));
            let nearest = near.reduce(|a, b| if b.0 < a.0 { b } else { a });
            match nearest {
                Some(nearer) if nearer.0 < best.0 => best = nearer,
                _ => return best.1,
            }
        }
    }
}
