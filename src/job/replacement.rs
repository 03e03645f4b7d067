//! Single parts again: what broke or went missing, on a sheet of its own.

use crate::fabrication::Fabrication;
use crate::job::error::NoSuchPart;
use crate::nest::Layout;
use crate::parts::{Body, steps};
use crate::template::nearest;
use crate::watch::{Stopped, Watch};
use std::collections::BTreeSet;

/// The names of a job's parts that are meant, whatever case they were typed in; the name of
/// a strip that was spliced means all its pieces.
///
/// # Errors
/// The first name that no part has.
pub(super) fn named(
    job: &Fabrication,
    names: &[String],
) -> Result<Vec<String>, NoSuchPart> {
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

/// Keeps these parts only and nests them anew. Structure, verdict and findings stay, but for
/// those about the layout of all.
///
/// # Errors
/// [`Stopped`] if the watch stopped the work.
pub(super) fn keep(
    job: &mut Fabrication,
    names: Vec<String>,
    watch: &mut dyn Watch,
) -> Result<(), Stopped> {
    let name = job.structure.as_ref().map(|structure| structure.name().to_owned());
    let name = format!("{}: only {}", name.unwrap_or_default(), names.join(" "));
    job.parts.retain(|part| names.contains(&part.id));
    // What connectors hold is not all here.
    job.steps = steps(&job.parts);
    job.steps.retain(|step| matches!(job.parts[step.part].body, Body::Strip(_)));
    job.findings.retain(|finding| !finding.code.starts_with("nest::"));
    job.layout = Layout::default();
    job.only = names;
    job.lay_on_sheets(name, watch)
}
