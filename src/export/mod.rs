//! A sheet as the bytes of a file: DXF, SVG, PDF for the laser, PNG for the eye.
//!
//! Each exporter is one pure function; the same sheet gives the same bytes. DXF, SVG and
//! PDF hold the same lines on the same layers in the same order ([`LAYERS`]). Whether a
//! sheet may go to the laser is decided elsewhere, and nothing here touches a disk.

mod arcs;
mod dxf;
mod layer;
mod number;
mod pdf;
mod png;
#[cfg(test)]
mod sample;
mod svg;

pub use dxf::dxf;
pub use layer::{LAYERS, Layer};
pub use pdf::pdf;
pub use png::{PngError, PngLook, png};
pub use svg::svg;

/// Width of a drawn line in SVG and PDF, mm: thin enough to be a cut for every driver.
const LINE_WIDTH: f64 = 0.025;
