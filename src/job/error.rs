//! Why there is no job.

use crate::json::UnwritableJson;
use crate::picture::PngError;
use crate::watch::Stopped;
use miette::Diagnostic;
use thiserror::Error;

/// Why there is no job.
#[derive(Debug, Error, Diagnostic)]
pub enum JobError {
    /// The watch stopped the work.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// A part that is to be made again is not there.
    #[error(transparent)]
    #[diagnostic(transparent)]
    NoSuchPart(#[from] NoSuchPart),
    /// A sheet could not be drawn.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Picture(#[from] PngError),
    /// `job.json` could not be written.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Json(#[from] UnwritableJson),
}

/// A part that was asked for and is not there.
#[derive(Debug, Clone, PartialEq, Eq, Error, Diagnostic)]
#[error("there is no part {found}")]
#[diagnostic(
    code(job::no_such_part),
    help("the nearest name is {nearest}; parts.csv lists them all")
)]
pub struct NoSuchPart {
    /// As typed.
    pub found: String,
    /// The name most like it.
    pub nearest: String,
}
