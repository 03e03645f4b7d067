//! From nested parts to what the laser does, independent of any file format.

pub mod sheet;

pub use sheet::{Operation, Path, Sheet, Stroke};
