//! Points, contours, meshes and the exact questions asked about them.
//!
//! Everything is in millimetres and radians. Constructions are ordinary `f64`;
//! questions of side and crossing go through exact predicates ([`predicates`]).

pub mod contour;
mod disjoint;
pub mod mesh;
pub mod offset;
pub mod predicates;
pub mod trig;

pub use contour::{Arc, Contour, Region, Segment, Vertex};
pub use disjoint::DisjointSets;
pub use mesh::Mesh;

/// A point in the plane, mm.
pub type Point2 = nalgebra::Point2<f64>;
/// A point in space, mm.
pub type Point3 = nalgebra::Point3<f64>;
/// A vector in the plane, mm.
pub type Vector2 = nalgebra::Vector2<f64>;
/// A vector in space, mm.
pub type Vector3 = nalgebra::Vector3<f64>;
