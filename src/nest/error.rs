//! Why parts could not be nested.

use crate::diagnostic::{Located, Place};
use crate::nest::{Shape, Stock, rotation};
use crate::watch::Stopped;
use miette::Diagnostic;
use thiserror::Error;

/// Why there is no layout.
#[derive(Debug, Clone, PartialEq, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say what the fields are")]
pub enum NestError {
    #[error(
        "{name} is {length:.0} x {height:.0} mm and fits no sheet; the largest takes \
         {sheet_width:.0} x {sheet_height:.0} mm inside its margin"
    )]
    #[diagnostic(
        code(nest::part_too_large),
        help("add a larger [[sheet]] to the template, or reduce the scale")
    )]
    PartTooLarge {
        name: String,
        length: f64,
        height: f64,
        sheet_width: f64,
        sheet_height: f64,
    },

    #[error("the stock is used up; {name} found no place")]
    #[diagnostic(
        code(nest::stock_used_up),
        help("raise `count` of a [[sheet]], or leave it out for as many as needed")
    )]
    StockUsedUp { name: String },

    #[error("the outline of {name} cannot be cut: {why}")]
    #[diagnostic(
        code(nest::bad_outline),
        severity(Warning),
        help("draw it as one closed line that neither crosses nor touches itself")
    )]
    BadOutline { name: String, why: String },

    #[error("sheet {sheet} of the stock cannot be used: {why}")]
    #[diagnostic(
        code(read::bad_remnant),
        help(
            "give the edge of the remnant, and holes in it, each as one closed line that \
             neither crosses nor touches another"
        )
    )]
    BadRemnant { sheet: usize, why: String },

    #[error("the parts that are to stay where they are cannot: {fault}")]
    #[diagnostic(
        code(read::bad_placement),
        help("move the part, or take its placement out and let it be nested")
    )]
    BadPlacement { fault: String },

    #[error("no sound layout was found: {fault}")]
    #[diagnostic(
        code(nest::unsound),
        help("nothing was written; please report the structure that led here")
    )]
    Unsound { fault: String },

    #[error("the search was stopped")]
    #[diagnostic(code(nest::stopped), help("run it again and let it finish"))]
    Stopped(#[from] Stopped),
}

impl NestError {
    pub(super) fn too_large(shape: &Shape, stock: &[Stock]) -> Self {
        let [length, height] = rotation::least_rectangle(&shape.outline);
        let inner = |s: &Stock| [s.width - 2.0 * s.margin, s.height - 2.0 * s.margin];
        let largest = stock.iter().map(inner).max_by(|a, b| {
            let area = |s: &[f64; 2]| s[0] * s[1];
            area(a).total_cmp(&area(b))
        });
        let [sheet_width, sheet_height] = largest.unwrap_or_default();
        let name = shape.name.clone();
        Self::PartTooLarge { name, length, height, sheet_width, sheet_height }
    }

    pub(super) fn used_up(shape: &Shape) -> Self {
        Self::StockUsedUp { name: shape.name.clone() }
    }
}

impl Located for NestError {
    fn place(&self) -> Place {
        match self {
            Self::PartTooLarge { name, .. }
            | Self::BadOutline { name, .. }
            | Self::StockUsedUp { name } => Place::part(name.clone()),
            Self::BadRemnant { .. }
            | Self::BadPlacement { .. }
            | Self::Unsound { .. }
            | Self::Stopped(_) => Place::default(),
        }
    }
}
