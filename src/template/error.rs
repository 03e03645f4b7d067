//! What can be wrong with a template.

use crate::diagnostic::{Located, Place, short};
use miette::Diagnostic;
use std::fmt;
use thiserror::Error;

/// One thing wrong with a template.
#[derive(Debug, Clone, PartialEq, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum TemplateFault {
    #[error("{}{message}", at(*line))]
    #[diagnostic(
        code(template::bad_toml),
        help("compare with `finwright template show pmma-cast-3`")
    )]
    BadToml { line: usize, message: String },

    #[error("{}there is no key \"{found}\" in {table}", at(*line))]
    #[diagnostic(
        code(template::unknown_key),
        help("the nearest known key is \"{nearest}\"; templates/README.md lists all")
    )]
    UnknownKey { line: usize, table: String, found: String, nearest: String },

    #[error("[{table}] has no \"{key}\"")]
    #[diagnostic(
        code(template::missing_key),
        help(
            "copy the line from `finwright template show pmma-cast-3` and measure its value"
        )
    )]
    MissingKey { table: String, key: String },

    #[error("{}{key} is {found}, but {wanted} is needed", at(*line))]
    #[diagnostic(
        code(template::wrong_type),
        help("write the value as in the other templates")
    )]
    WrongType { line: usize, key: String, found: String, wanted: &'static str },

    #[error("{}{key} is {}, outside {least} to {most}", at(*line), short(*value))]
    #[diagnostic(
        code(template::out_of_range),
        help("check the unit at the end of the key: _mm, _deg, _percent, ...")
    )]
    OutOfRange { line: usize, key: String, value: f64, least: f64, most: f64 },

    #[error("{message}")]
    #[diagnostic(code(template::contradiction), help("change one of the two values"))]
    Contradiction { message: String },

    #[error("there is no template \"{found}\"")]
    #[diagnostic(
        code(template::unknown_name),
        help(
            "the nearest is \"{nearest}\"; `finwright template list` shows all, and a path \
             to a .toml file is read too"
        )
    )]
    UnknownName { found: String, nearest: String },
}

impl Located for TemplateFault {
    fn place(&self) -> Place {
        match *self {
            Self::BadToml { line, .. }
            | Self::UnknownKey { line, .. }
            | Self::WrongType { line, .. }
            | Self::OutOfRange { line, .. } => Place::line(line),
            Self::MissingKey { .. }
            | Self::Contradiction { .. }
            | Self::UnknownName { .. } => Place::default(),
        }
    }
}

/// Where something stands; nothing if the line could not be found (0).
fn at(line: usize) -> String {
    if line == 0 { String::new() } else { format!("line {line}: ") }
}

/// Everything wrong with a template.
#[derive(Debug, Clone, PartialEq)]
pub struct TemplateErrors {
    /// Name of the template.
    pub name: String,
    /// At least one fault.
    pub faults: Vec<TemplateFault>,
}

impl fmt::Display for TemplateErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "template \"{}\" cannot be used", self.name)?;
        for fault in &self.faults {
            let code = fault.code().map(|code| code.to_string()).unwrap_or_default();
            let help = fault.help().map(|help| help.to_string()).unwrap_or_default();
            write!(f, "\n  {fault}\n    {code}: {help}")?;
        }
        Ok(())
    }
}

impl std::error::Error for TemplateErrors {}

impl Diagnostic for TemplateErrors {}
