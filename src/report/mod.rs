//! What a job says about itself: the manifest and the bill of parts.

mod bill;
mod layout;
mod manifest;

pub use bill::bill;
pub use layout::{Lines, Nested, layout_json, layout_sheets};
pub use manifest::{Source, manifest};
