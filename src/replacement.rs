//! Single parts again: what broke or went missing, on a sheet of its own.

use crate::job::{Interrupted, Job, on_sheets};
use crate::nest::{Effort, Layout};
use crate::parts::{Body, steps};
use crate::template::{Template, nearest};
use crate::watch::Watch;
use miette::Diagnostic;
use std::collections::BTreeSet;
use thiserror::Error;

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

/// The names of a job's parts that are meant, whatever case they were typed in; the name of
/// a strip that was spliced means all its pieces.
///
/// # Errors
/// The first name that no part has.
pub fn named(job: &Job, names: &[String]) -> Result<Vec<String>, NoSuchPart> {
    let mut all = Vec::new();
    for found in names.iter().map(|name| name.trim()) {
        let known = || job.parts.iter().map(|part| part.id.as_str());
        let piece = |id: &str| id.trim_end_matches(char::is_lowercase).to_owned();
        let own = known().filter(|id| id.eq_ignore_ascii_case(found));
        let pieces = known().filter(|id| piece(id).eq_ignore_ascii_case(found));
        let meant: Vec<String> = own.chain(pieces).map(str::to_owned).collect();
        if meant.is_empty() {
            let nearest = nearest(found, known());
            return Err(NoSuchPart { found: found.to_owned(), nearest });
        }
        all.extend(meant);
    }
    // A part is meant once, however often and by whatever name it was typed.
    let mut known = BTreeSet::new();
    all.retain(|id| known.insert(id.clone()));
    Ok(all)
}

/// The job with these parts only, nested anew. Structure, verdict and findings stay, but
/// for those about the layout of all.
///
/// # Errors
/// [`Interrupted`] if the watch stopped the work.
pub fn only(
    mut job: Job,
    names: Vec<String>,
    template: &Template,
    effort: &Effort,
    watch: &mut dyn Watch,
) -> Result<Job, Interrupted> {
    let name = job.structure.as_ref().map(|structure| structure.name().to_owned());
    let name = format!("{}: only {}", name.unwrap_or_default(), names.join(" "));
    job.parts.retain(|part| names.contains(&part.id));
    // What connectors hold is not all here.
    job.steps = steps(&job.parts);
    job.steps.retain(|step| matches!(job.parts[step.part].body, Body::Strip(_)));
    job.findings.retain(|finding| !finding.code.starts_with("nest::"));
    job.layout = Layout::default();
    job.only = names;
    on_sheets(job, template, name, effort, watch)
}
