//! Rigid strips, half-lapped where they cross; ends that cannot lap stand in discs.

pub(super) mod bend;
pub(super) mod finding;
pub(super) mod insertion;
pub(super) mod join;
pub(super) mod placement;
mod rank;
mod seam;
pub(super) mod splice;
pub(super) mod strength;
