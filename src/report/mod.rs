//! What a job says about itself: the manifest and the bill of parts.

mod bill;
mod manifest;

pub use bill::bill;
pub use manifest::{Source, manifest};
