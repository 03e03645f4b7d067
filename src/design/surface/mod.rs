//! The reference surface: an oriented triangle mesh of one piece, ready for fields.
//!
//! [`clean`] makes one of whatever faces a file holds, or says which of its faults have to
//! be mended first. A half-edge is a side of a triangle, counted three by three: `3 f + k`
//! runs from corner `k` of triangle `f` to the next one, counter-clockwise, and stands as
//! well for that corner.

mod clean;
mod ears;
mod faults;
mod finding;
mod foot;
mod lines;
mod measure;
mod ply;
mod stl;

pub use clean::{Polygons, clean};
pub use finding::{FormatError, SurfaceFinding};
pub use foot::Foot;
pub use lines::Line;
pub use measure::Measures;
pub use ply::read_ply;
pub use stl::read_stl;

use crate::geometry::{Point3, Vector3};
use crate::structure::area_vector;
use std::collections::BTreeSet;

/// Cosine of the angle between neighbours from which on they are folded: 150°.
const FOLDED: f64 = -0.866;

/// No half-edge.
const NONE: usize = usize::MAX;

/// A clean triangle mesh.
///
/// # Guarantees
/// Every edge has one or two triangles, directed against each other; the triangles at a
/// vertex are one fan; all hang together, and none is without area. No inner edge joins
/// two boundary vertices.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Position of each vertex, mm.
    pub positions: Vec<Point3>,
    /// Corners of each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[usize; 3]>,
    /// Wanted axes of the vertices, where the file gives them; unit vectors.
    pub axes: Option<Vec<Vector3>>,
    twins: Vec<usize>,
    /// A half-edge that leaves each vertex, on the boundary the first of its fan.
    first: Vec<usize>,
    /// Edges that fins are to follow, by their vertices.
    followed: BTreeSet<[usize; 2]>,
}

impl Surface {
    /// From triangles that keep the guarantees.
    fn new(
        positions: Vec<Point3>,
        triangles: Vec<[usize; 3]>,
        axes: Option<Vec<Vector3>>,
    ) -> Self {
        let twins = twins(&triangles);
        let mut first = vec![NONE; positions.len()];
        for (side, &twin) in twins.iter().enumerate() {
            let tail = triangles[side / 3][side % 3];
            if first[tail] == NONE || twin == NONE {
                first[tail] = side;
            }
        }
        Self { positions, triangles, axes, twins, first, followed: BTreeSet::new() }
    }

    /// The same with fins to follow these edges.
    fn with_lines(self, edges: BTreeSet<[usize; 2]>) -> Self {
        Self { followed: edges, ..self }
    }

    /// Whether fins are to follow a half-edge.
    pub(in crate::design) fn is_followed(&self, side: usize) -> bool {
        !self.followed.is_empty() && self.followed.contains(&self.ends(side))
    }

    /// Whether there are lines that fins are to follow.
    pub(in crate::design) fn has_lines(&self) -> bool {
        !self.followed.is_empty()
    }

    /// Both vertices of the edge of a half-edge, the smaller first.
    fn ends(&self, side: usize) -> [usize; 2] {
        let (a, b) = (self.tail(side), self.tip(side));
        [a.min(b), a.max(b)]
    }

    /// How many half-edges there are: three per triangle.
    pub fn side_count(&self) -> usize {
        self.twins.len()
    }

    /// The vertex that a half-edge leaves.
    pub fn tail(&self, side: usize) -> usize {
        self.triangles[side / 3][side % 3]
    }

    /// The vertex that a half-edge reaches.
    pub fn tip(&self, side: usize) -> usize {
        self.tail(next(side))
    }

    /// The half-edge on the other side of the edge; `None` on the boundary.
    pub fn twin(&self, side: usize) -> Option<usize> {
        Some(self.twins[side]).filter(|&twin| twin != NONE)
    }

    /// Whether a half-edge lies on the boundary.
    pub fn is_boundary(&self, side: usize) -> bool {
        self.twins[side] == NONE
    }

    /// The half-edges that leave a vertex, counter-clockwise; on the boundary from the one
    /// along it.
    pub fn fan(&self, vertex: usize) -> impl Iterator<Item = usize> + '_ {
        self.fan_from(self.first[vertex])
    }

    /// The half-edges that leave the same vertex, counter-clockwise from one of them: once
    /// around, or up to the boundary.
    pub fn fan_from(&self, first: usize) -> impl Iterator<Item = usize> + '_ {
        let mut at = Some(first).filter(|&side| side != NONE);
        std::iter::from_fn(move || {
            let side = at?;
            at = self.twin(previous(side)).filter(|&side| side != first);
            Some(side)
        })
    }

    /// Whether a vertex lies on the boundary.
    pub fn on_boundary(&self, vertex: usize) -> bool {
        self.is_boundary(self.first[vertex])
    }

    /// The boundary, loop by loop, each as half-edges with the surface on their left.
    pub fn boundary(&self) -> Vec<Vec<usize>> {
        let mut seen = vec![false; self.side_count()];
        let mut loops = Vec::new();
        for start in 0..self.side_count() {
            if seen[start] || !self.is_boundary(start) {
                continue;
            }
            let (mut ring, mut side) = (Vec::new(), start);
            while !seen[side] {
                seen[side] = true;
                ring.push(side);
                side = self.first[self.tip(side)];
            }
            loops.push(ring);
        }
        loops
    }

    /// Vertices − edges + triangles.
    pub fn euler(&self) -> i64 {
        let rim = (0..self.side_count()).filter(|&side| self.is_boundary(side)).count();
        let edges = (self.side_count() + rim) / 2;
        self.positions.len() as i64 - edges as i64 + self.triangles.len() as i64
    }

    /// Inner edges, by one half-edge each, at which the surface is folded back on itself.
    fn folds(&self) -> impl Iterator<Item = usize> + '_ {
        let normal = |side: usize| {
            let area = area_vector(&self.positions, &self.triangles[side / 3]);
            area.try_normalize(0.0).unwrap_or_default()
        };
        (0..self.side_count()).filter(move |&side| {
            let twin = self.twin(side).filter(|&twin| side < twin);
            twin.is_some_and(|twin| normal(side).dot(&normal(twin)) < FOLDED)
        })
    }

    /// Area of the whole, mm².
    pub fn area(&self) -> f64 {
        self.triangles.iter().map(|t| area_vector(&self.positions, t).norm()).sum()
    }

    /// Length of the edge of a half-edge.
    pub fn length(&self, side: usize) -> f64 {
        (self.positions[self.tip(side)] - self.positions[self.tail(side)]).norm()
    }
}

/// The half-edge after this one around its triangle.
pub(super) const fn next(side: usize) -> usize {
    if side % 3 == 2 { side - 2 } else { side + 1 }
}

/// The half-edge before this one around its triangle.
pub(super) const fn previous(side: usize) -> usize {
    if side.is_multiple_of(3) { side + 2 } else { side - 1 }
}

/// The half-edges of a triangle.
pub(super) const fn sides_of(triangle: usize) -> [usize; 3] {
    [3 * triangle, 3 * triangle + 1, 3 * triangle + 2]
}

/// The other half-edge along each edge of two triangles that run against each other.
fn twins(triangles: &[[usize; 3]]) -> Vec<usize> {
    let mut sides = sides_by_edge(triangles);
    let mut twins = vec![NONE; 3 * triangles.len()];
    sides.dedup_by(|b, a| {
        if a.0 == b.0 {
            (twins[a.1], twins[b.1]) = (b.1, a.1);
        }
        a.0 == b.0
    });
    twins
}

/// All half-edges with the two vertices of their edge, the smaller first, in that order.
fn sides_by_edge(triangles: &[[usize; 3]]) -> Vec<([usize; 2], usize)> {
    let ends = |side: usize| {
        let (a, b) = (triangles[side / 3][side % 3], triangles[side / 3][next(side) % 3]);
        [a.min(b), a.max(b)]
    };
    let mut sides: Vec<_> =
        (0..3 * triangles.len()).map(|side| (ends(side), side)).collect();
    sides.sort_unstable();
    sides
}
