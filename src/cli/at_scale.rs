//! `design --for`: what `check` says of a structure at a model scale and in a material.

use crate::cli::console::Terminal;
use crate::cli::flags::value::ForScale;
use crate::cli::input;
use crate::cli::outcome::Failure;
use crate::diagnostic::{Finding, Located, Place, Severity};
use crate::job::{self, Input, InputOptions, Specification};
use crate::settings::Settings;
use crate::structure::{Structure, write_json};
use miette::Diagnostic;
use thiserror::Error;

#[derive(Debug, Error, Diagnostic)]
enum ScaleFinding {
    #[error("at {scale} in {template} it can be cut")]
    #[diagnostic(
        code(design::fits_scale),
        severity(Advice),
        help("give `make` that scale and template")
    )]
    Fits { scale: String, template: String },

    #[error(
        "at {scale} in {template} it cannot be cut: {count} {}, the first: {first}",
        if *count == 1 { "error" } else { "errors" }
    )]
    #[diagnostic(
        code(design::not_at_scale),
        severity(Warning),
        help("{first_help}; `finwright check --advise` names scales that pass")
    )]
    Unfit {
        scale: String,
        template: String,
        count: usize,
        first: String,
        first_help: String,
    },
}

impl Located for ScaleFinding {
    fn place(&self) -> Place {
        Place::default()
    }
}

/// What is to be said of a structure at this scale.
pub(super) fn judged(
    structure: &Structure,
    wanted: &ForScale,
    terminal: &mut Terminal,
) -> Result<Finding, Failure> {
    let settings = Settings::new(input::template(&wanted.template)?);
    let options = InputOptions { scale: wanted.scale.clone(), ..InputOptions::default() };
    let text = write_json(structure);
    let input = Input::json("design.json", &text, &options).map_err(Failure::of)?;
    let specification = Specification {
        settings,
        input,
        planarise: false,
        apply_remedies: false,
        only: Vec::new(),
    };
    let findings = job::check(specification, terminal)?.findings;
    let mut errors = findings.into_iter().filter(|f| f.severity == Severity::Error);
    let (scale, template) = (wanted.scale.text.clone(), wanted.template.clone());
    Ok(Finding::from(match errors.next() {
        None => ScaleFinding::Fits { scale, template },
        Some(first) => ScaleFinding::Unfit {
            scale,
            template,
            count: 1 + errors.count(),
            first: first.message,
            first_help: first.help,
        },
    }))
}
