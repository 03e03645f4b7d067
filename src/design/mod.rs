//! Designing structures: the embedded examples, each torsion-free by construction.

pub mod examples;
