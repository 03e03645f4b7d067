//! Designing structures: the embedded examples, and planar fins from any mesh.

pub mod examples;
pub mod planarise;
