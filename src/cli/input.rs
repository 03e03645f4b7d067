//! From what was typed to a draft and a template: the only place that reads files.

use crate::cli::args::{Fix, InputArgs};
use crate::design::examples;
use crate::diagnostic::Finding;
use crate::structure::{
    Draft, ObjOptions, ReadError, StructureFinding, read_json, read_obj,
};
use crate::template::{self, Template, TemplateErrors};
use crate::tolerance::SAME_HEIGHT;
use miette::Diagnostic;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a job could not begin.
#[derive(Debug, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub(super) enum InputError {
    #[error("{} could not be read: {source}", path.display())]
    #[diagnostic(code(input::unreadable), help("give the path of a file that exists"))]
    Unreadable { path: PathBuf, source: std::io::Error },

    #[error("{} is no text file: byte {byte} is no UTF-8", path.display())]
    #[diagnostic(code(input::not_text), help("structures are JSON or OBJ text files"))]
    NotText { path: PathBuf, byte: usize },

    #[error("{} is neither .json nor .obj", path.display())]
    #[diagnostic(
        code(input::unknown_format),
        help(
            "export the mesh as OBJ, or name an embedded structure (`finwright example list`)"
        )
    )]
    UnknownFormat { path: PathBuf },

    #[error("{}: {source}", path.display())]
    #[diagnostic(forward(source))]
    BadStructure { path: PathBuf, source: ReadError },

    #[error(transparent)]
    #[diagnostic(transparent)]
    BadTemplate(#[from] TemplateErrors),
}

/// A structure that was read, with where it came from.
pub(super) struct Input {
    /// What was read, mm at model scale.
    pub draft: Draft,
    /// Name of the file, without its folder.
    pub file: String,
    /// SHA-256 of what was read.
    pub sha256: String,
    /// Found while reading.
    pub findings: Vec<Finding>,
}

/// SHA-256 as hexadecimal digits.
pub(super) fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Reads the structure that the arguments name.
///
/// # Errors
/// [`InputError`] if there is none.
pub(super) fn structure(args: &InputArgs) -> Result<Input, InputError> {
    let named = args.structure.as_deref().unwrap_or(examples::ALL[0].name);
    let path = Path::new(named);
    let mut input = match examples::named(named) {
        Some(example) if !path.exists() => {
            let mut draft = (example.draft)();
            if let Some(axes) = args.axes.axes(&draft.positions, &draft.faces) {
                draft.axes = axes;
            }
            let sha256 = sha256(format!("{draft:?}").as_bytes());
            Input { draft, file: named.to_owned(), sha256, findings: Vec::new() }
        }
        _ => from_file(path, args)?,
    };
    input.draft = input.draft.scaled(args.scale.factor);
    if let Some(depth) = args.depth {
        input.draft = input.draft.with_depth(depth.below, depth.above);
    }
    if let Some(fix) = &args.fix {
        input.draft.fixed = fixed(fix, &input.draft);
    }
    Ok(input)
}

fn from_file(path: &Path, args: &InputArgs) -> Result<Input, InputError> {
    let text = text(path)?;
    let bad = |source| InputError::BadStructure { path: path.to_owned(), source };
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let (mut draft, facts) = match ending.as_str() {
        "json" => (read_json(&text, args.axes).map_err(bad)?, Vec::new()),
        "obj" => {
            let options = ObjOptions { unit: args.units, axes: args.axes };
            read_obj(&text, &options).map_err(bad)?
        }
        _ => return Err(InputError::UnknownFormat { path: path.to_owned() }),
    };
    if draft.name.trim().is_empty() {
        draft.name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    }
    let findings = facts.into_iter().map(|fact: StructureFinding| fact.into()).collect();
    let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Input { draft, file, sha256: sha256(text.as_bytes()), findings })
}

/// The text of a file.
pub(super) fn text(path: &Path) -> Result<String, InputError> {
    let bytes = std::fs::read(path)
        .map_err(|source| InputError::Unreadable { path: path.to_owned(), source })?;
    String::from_utf8(bytes).map_err(|error| InputError::NotText {
        path: path.to_owned(),
        byte: error.utf8_error().valid_up_to(),
    })
}

/// The nodes to hold; `None` leaves it to the structure: its boundary.
fn fixed(fix: &Fix, draft: &Draft) -> Option<Vec<usize>> {
    match fix {
        Fix::None => Some(Vec::new()),
        Fix::Boundary => None,
        Fix::Nodes(nodes) => Some(nodes.clone()),
        Fix::Lowest => {
            let height = |p: &crate::geometry::Point3| p.z;
            let all = || draft.positions.iter().map(height);
            let low = all().fold(f64::INFINITY, f64::min);
            let high = all().fold(f64::NEG_INFINITY, f64::max);
            let limit = low + SAME_HEIGHT * (high - low);
            Some(
                (0..draft.positions.len())
                    .filter(|&k| draft.positions[k].z <= limit)
                    .collect(),
            )
        }
    }
}

/// The template of this name, or from this file.
///
/// # Errors
/// [`InputError`] if there is none, or it has faults.
pub(super) fn template(named: &str) -> Result<Template, InputError> {
    let path = Path::new(named);
    if let Some(source) = template::embedded(named) {
        return Ok(template::read(source, named)?);
    }
    if named.ends_with(".toml") || path.exists() {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        return Ok(template::read(&text(path)?, &name)?);
    }
    Err(InputError::BadTemplate(template::unknown_name(named)))
}
