//! What a service would refuse, or a maker should know before ordering.

use crate::diagnostic::{Located, Place};
use crate::ids::NodeId;
use miette::Diagnostic;
use thiserror::Error;

/// A rule of a profile that is not kept, or what follows from one.
#[derive(Debug, Clone, PartialEq, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum VendorFinding {
    #[error(
        "{file} is {width_mm:.0} x {height_mm:.0} mm; {profile} takes {wide_mm:.0} x {high_mm:.0} mm"
    )]
    #[diagnostic(
        code(order::too_large),
        severity(Error),
        help("give the template a [[sheet]] of that size or smaller")
    )]
    TooLarge {
        file: String,
        part: Option<String>,
        width_mm: f64,
        height_mm: f64,
        profile: &'static str,
        wide_mm: f64,
        high_mm: f64,
    },

    #[error("{count} names, node numbers and angles are not in the files for {profile}")]
    #[diagnostic(
        code(order::unmarked),
        severity(Advice),
        help(
            "it takes cut lines only: parts come without names; tell them by their file names and label them as you unpack"
        )
    )]
    Unmarked { count: usize, profile: &'static str },

    #[error(
        "parts lie {spacing_mm} mm apart; for {profile} lines within {least_mm} mm burn together"
    )]
    #[diagnostic(
        code(order::lines_too_near),
        severity(Error),
        help("raise `spacing_mm` of the [[sheet]]")
    )]
    LinesTooNear { spacing_mm: f64, profile: &'static str, least_mm: f64 },

    #[error(
        "the slit of {part} at node {node} is {width_mm:.2} mm wide as drawn; for {profile} lines \
         within {least_mm} mm burn together"
    )]
    #[diagnostic(
        code(order::slit_too_narrow),
        severity(Error),
        help("take a thicker sheet, or a template with less kerf")
    )]
    SlitTooNarrow {
        part: String,
        node: NodeId,
        width_mm: f64,
        profile: &'static str,
        least_mm: f64,
    },
}

impl Located for VendorFinding {
    fn place(&self) -> Place {
        match self {
            Self::TooLarge { part: Some(part), .. } => Place::part(part),
            Self::SlitTooNarrow { part, node, .. } => Place::part(part).at(*node),
            Self::TooLarge { .. } | Self::Unmarked { .. } | Self::LinesTooNear { .. } => {
                Place::default()
            }
        }
    }
}
