//! `verify`: a job directory read back and proved.

use crate::cli::jobdir::JobFile;
use crate::cli::run::{End, Failure, print};
use crate::cli::show::Voice;
use crate::diagnostic::{Finding, passes};
use crate::proof::{JobFiles, Proof, ProofError, ProofFinding, Spot, prove};
use clap::Args;
use miette::Diagnostic;
use serde_json::Value;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Arguments of `verify`.
#[derive(Debug, Args)]
pub struct VerifyArgs {
    /// Folder that `finwright make` wrote, its files edited or not
    #[arg(value_name = "JOBDIR")]
    pub job: PathBuf,

    /// Print one JSON object on standard output
    #[arg(long)]
    pub json: bool,
}

/// Help after the options.
pub(super) const HELP: &str = "\
Example:
  finwright make dome && finwright verify out/dome
      reads the DXF, SVG and PDF files back, folds the parts and compares with the structure";

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
pub(super) fn run(args: &VerifyArgs, voice: Voice) -> Result<End, Failure> {
    let proof = verify(&args.job)?;
    voice.findings(&proof.findings);
    if args.json {
        print(&format!("{}\n", proof.report()));
    }
    voice.say(&summary(&proof));
    Ok(if passes(&proof.findings) { End::Done } else { End::Refused })
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
    let below = [("sheets", "sheets/"), ("order", "order/")];
    let below = below.map(|(folder, prefix)| (dir.join(folder), prefix));
    for (folder, prefix) in std::iter::once((dir.to_owned(), "")).chain(below) {
        if !prefix.is_empty() && !folder.is_dir() {
            continue;
        }
        for entry in std::fs::read_dir(&folder).map_err(unreadable(&folder))? {
            let path = entry.map_err(unreadable(&folder))?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let read =
                [".json", ".dxf", ".svg", ".pdf"].iter().any(|end| name.ends_with(end));
            if read && path.is_file() {
                let bytes = std::fs::read(&path).map_err(unreadable(&path))?;
                files.insert(format!("{prefix}{name}"), bytes);
            }
        }
    }
    if dir.join("preview").is_dir() {
        files.insert("preview/".to_owned(), Vec::new());
    }
    let path = dir.to_owned();
    prove(&files).map_err(|source| VerifyError::NoProof { path, source })
}

/// Proves files before they are written; the worst figures and what was found go into
/// their manifest.
pub(super) fn prove_before_writing(
    files: &mut [JobFile],
    manifest: &mut Value,
) -> (Option<Proof>, Vec<Finding>) {
    let read = files.iter().filter(|file| !file.path.ends_with(".png"));
    let all = read.map(|file| (file.path.clone(), file.bytes.clone()));
    let (proof, findings) = match prove(&all.collect()) {
        Ok(proof) => {
            manifest["proof"] = proof.summary();
            let findings = proof.findings.clone();
            (Some(proof), findings)
        }
        Err(error) => {
            let (spot, reason) = (Spot::file("job.json"), error.to_string());
            (None, vec![ProofFinding::Unreadable { spot, reason }.into()])
        }
    };
    if let Some(listed) = manifest["findings"].as_array_mut() {
        listed.extend(findings.iter().map(|finding| serde_json::json!(finding)));
    }
    if let Some(file) = files.iter_mut().find(|file| file.path == "job.json") {
        let pretty = serde_json::to_string_pretty(manifest).unwrap_or_default() + "\n";
        file.bytes = pretty.into_bytes();
    }
    (proof, findings)
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
