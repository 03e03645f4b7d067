//! Designing structures: from a reference surface to planar fins, planar fins from any
//! mesh, and the embedded examples.

mod attempt;
mod axes;
mod chain;
mod directions;
pub mod examples;
mod families;
mod figures;
mod finding;
mod improve;
mod map;
mod picture;
pub mod planarise;
mod quads;
pub mod surface;
mod surfaces;
mod symmetry;
mod wishes;

pub use chain::{Designed, design};
pub use figures::{
    DesignFigures, FinAngles, Lengths, Middle, PlanarityPercent, SingularNode, Upper,
};
pub use finding::ChainFinding;
pub use picture::design_picture;
pub use surfaces::{ReferenceSurface, SURFACES, surface_named};
pub use wishes::{Align, SingularWish, Size, Wishes};
