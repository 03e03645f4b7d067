//! Values as the text of JSON, their keys in alphabetical order.

use miette::Diagnostic;
use serde::Serialize;
use thiserror::Error;

/// A value has no form as JSON.
#[derive(Debug, Error, Diagnostic)]
#[error("the result could not be written as JSON")]
#[diagnostic(code(json::unwritable))]
pub struct UnwritableJson(#[from] serde_json::Error);

/// The text of a file.
///
/// # Errors
/// [`UnwritableJson`] if a key is no text.
pub fn text(value: &impl Serialize) -> Result<String, UnwritableJson> {
    Ok(serde_json::to_string_pretty(&serde_json::to_value(value)?)? + "\n")
}

/// The same in one line.
///
/// # Errors
/// [`UnwritableJson`] if a key is no text.
pub fn line(value: &impl Serialize) -> Result<String, UnwritableJson> {
    Ok(serde_json::to_string(&serde_json::to_value(value)?)? + "\n")
}
