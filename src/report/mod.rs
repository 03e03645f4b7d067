//! What a job is, for people and for programs: the page, the manifest, the bill of parts.

mod bill;
mod connectors;
mod fins;
mod guide;
mod layout;
mod manifest;
mod node;
mod page;
mod picture;
mod steps;

pub use bill::bill;
pub use guide::guide;
pub use layout::{Lines, Nested, free_maps, layout_json, layout_sheets};
pub use manifest::{JobSource, manifest};
pub use node::node_picture;
pub use page::{Page, page};
