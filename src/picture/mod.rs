//! What all pictures share: a camera, scales of colours, and their form as PNG. Each is
//! painted where its subject is known.

mod camera;
mod colour;

pub use camera::Camera;
pub use colour::{BLUE_TO_RED, ColourScale, HEAT, TINTS};

use tiny_skia::Pixmap;

/// Why there is no picture.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum PngError {
    /// The subject, at the asked scale, has no pixels.
    #[error("a picture of {width} x {height} mm at {px_per_mm} pixels per mm is empty")]
    #[diagnostic(
        code(export::empty_picture),
        help("sheet and scale must be larger than zero")
    )]
    Empty {
        /// Width of the sheet, mm.
        width: f64,
        /// Height of the sheet, mm.
        height: f64,
        /// The asked scale.
        px_per_mm: f64,
    },
    /// The picture could not be packed.
    #[error("the picture could not be written as PNG")]
    #[diagnostic(code(export::png))]
    Encoding(#[source] Box<dyn std::error::Error + Send + Sync>),
}

/// A picture as the bytes of a PNG file.
///
/// # Errors
/// [`PngError::Encoding`] if it cannot be packed.
pub fn png(pixels: &Pixmap) -> Result<Vec<u8>, PngError> {
    pixels.encode_png().map_err(|error| PngError::Encoding(error.into()))
}
