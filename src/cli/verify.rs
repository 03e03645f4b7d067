//! `verify`: a job directory read back and proved.

use crate::cli::console::Console;
use crate::cli::flags::verify::VerifyArgs;
use crate::cli::outcome::{End, Failure, print};
use crate::diagnostic::passes;
use crate::files::{FileFormat, ORDER, PREVIEW, SHEETS};
use crate::json;
use crate::proof::{JobFiles, Proof, ProofError, prove};
use miette::Diagnostic;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a directory could not be verified.
#[derive(Debug, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub(super) enum VerifyError {
    #[error("{} could not be read: {source}", path.display())]
    #[diagnostic(code(job::unreadable), help("give the path of a job's folder"))]
    Unreadable { path: PathBuf, source: std::io::Error },

    #[error("{}: {source}", path.display())]
    #[diagnostic(forward(source))]
    NoProof { path: PathBuf, source: ProofError },
}

/// Verifies a job and says what was found.
///
/// # Errors
/// [`Failure`] if there is no job.
pub(super) fn run(args: &VerifyArgs, console: Console) -> Result<End, Failure> {
    let proof = verify(&args.job).map_err(Failure::of)?;
    console.findings(&proof.findings);
    if args.json {
        print(&json::line(&proof.report()).map_err(Failure::of)?);
    }
    console.say(&summary(&proof));
    Ok(End::of(&proof.findings))
}

/// Reads a job directory and proves it.
///
/// # Errors
/// [`VerifyError`] if there is no job.
fn verify(dir: &Path) -> Result<Proof, VerifyError> {
    let unreadable = |path: &Path| {
        let path = path.to_owned();
        move |source| VerifyError::Unreadable { path, source }
    };
    let mut files = JobFiles::new();
    let below = [SHEETS, ORDER].map(|name| (dir.join(name), format!("{name}/")));
    for (folder, prefix) in std::iter::once((dir.to_owned(), String::new())).chain(below)
    {
        if !prefix.is_empty() && !folder.is_dir() {
            continue;
        }
        for entry in std::fs::read_dir(&folder).map_err(unreadable(&folder))? {
            let path = entry.map_err(unreadable(&folder))?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let read = name.ends_with(".json") || FileFormat::is_cut(&name);
            if read && path.is_file() {
                let bytes = std::fs::read(&path).map_err(unreadable(&path))?;
                files.insert(format!("{prefix}{name}"), bytes);
            }
        }
    }
    if dir.join(PREVIEW).is_dir() {
        files.insert(format!("{PREVIEW}/"), Vec::new());
    }
    let path = dir.to_owned();
    prove(&files).map_err(|source| VerifyError::NoProof { path, source })
}

/// What is said at the end.
fn summary(proof: &Proof) -> String {
    let fine = passes(&proof.findings);
    if proof.nodes.is_empty() {
        let parts = proof.parts.len();
        let end = if fine { "are drawn as listed" } else { "are not what the job says" };
        return format!("{parts} parts {end}; none of them goes back into a structure");
    }
    let Some(worst) = proof.worst.first() else { return "nothing to prove".to_owned() };
    let slits = match proof.slits.is_empty() {
        true => format!("slots are turned by {:.4}° at most", worst.slot_deg),
        false => format!(
            "slits are placed to {:.4} mm with {:.3} to {:.3} mm of play",
            worst.slit_off_mm, worst.slit_play_least_mm, worst.slit_play_most_mm,
        ),
    };
    let figures = format!(
        "{} parts; axes meet to {:.4} mm, {slits}",
        worst.parts, worst.node_gap_mm
    );
    let end =
        if fine { "it folds into the structure" } else { "it is not what the job says" };
    format!("{figures}: {end}")
}
