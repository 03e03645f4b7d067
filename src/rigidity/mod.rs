//! Rigid or flexible.
mod factor;
mod finding;
mod lanczos;
mod linkage;
mod mobility;
mod model;
mod motions;
mod paper;
mod spectrum;
mod symbolic;
mod system;
#[cfg(test)]
mod tests;

pub use finding::RigidityFinding;
pub use linkage::read_linkage;
pub use model::{Body, Knot, Model};
pub use paper::{Discrepancy, Motion, Paper, Pairing};
