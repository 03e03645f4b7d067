//! Points, motions, rectangles, contours, meshes and the exact questions asked about
//! them.
//!
//! Everything is in millimetres and radians. Constructions are ordinary `f64`;
//! questions of side and crossing go through exact predicates ([`predicates`]).

pub mod contour;
mod disjoint;
pub mod mesh;
mod motion;
pub mod offset;
pub mod predicates;
mod rect;
pub mod ring;
pub mod trig;

pub use contour::{Arc, Contour, Region, Segment, Vertex};
pub use disjoint::DisjointSets;
pub use mesh::Mesh;
pub use motion::Motion;
pub use rect::Rect;

/// A point in the plane, mm.
pub type Point2 = nalgebra::Point2<f64>;
/// A point in space, mm.
pub type Point3 = nalgebra::Point3<f64>;
/// A vector in the plane, mm.
pub type Vector2 = nalgebra::Vector2<f64>;
/// A vector in space, mm.
pub type Vector3 = nalgebra::Vector3<f64>;
