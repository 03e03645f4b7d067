//! From what was typed to a draft and a template: the only place that reads files.

use crate::cli::args::{Depth, Fix, InputArgs};
use crate::design::examples;
use crate::diagnostic::{Finding, Located, Place};
use crate::geometry::{Mesh, Point3};
use crate::structure::{
    AxisRule, Draft, ObjOptions, ReadError, exchange, read_json, read_obj,
};
use crate::template::{self, Template, TemplateErrors};
use crate::tolerance::SAME_HEIGHT;
use crate::units::Unit;
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
    #[diagnostic(
        code(input::not_text),
        help("structures are JSON or OBJ text, templates TOML text; save it as UTF-8")
    )]
    NotText { path: PathBuf, byte: usize },

    #[error("{} is neither .json nor .obj", path.display())]
    #[diagnostic(
        code(input::unknown_format),
        help(
            "export the mesh as OBJ; `finwright example list` shows embedded structures"
        )
    )]
    UnknownFormat { path: PathBuf },

    #[error("there is no file and no embedded structure \"{found}\"")]
    #[diagnostic(
        code(input::unknown_structure),
        help(
            "the nearest embedded one is \"{nearest}\"; `finwright example list` shows all"
        )
    )]
    UnknownStructure { found: String, nearest: String },

    #[error("{}: {source}", path.display())]
    #[diagnostic(forward(source))]
    BadStructure { path: PathBuf, source: ReadError },

    #[error(transparent)]
    #[diagnostic(transparent)]
    BadTemplate(#[from] TemplateErrors),
}

impl InputError {
    /// What is wrong, each fault with its place.
    pub(super) fn findings(&self) -> Vec<Finding> {
        match self {
            Self::BadStructure { source, .. } => vec![Finding::new(self, source.place())],
            Self::BadTemplate(errors) => errors
                .faults
                .iter()
                .map(|fault| Finding::new(fault, fault.place()))
                .collect(),
            _ => vec![Finding::new(self, Place::default())],
        }
    }
}

/// An option that had no effect.
#[derive(Debug, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub(super) enum InputNote {
    #[error("--units was not used: {file} says its own unit")]
    #[diagnostic(
        code(input::units_ignored),
        severity(Warning),
        help("change \"units\" in the file, or use `--scale`; --units is for OBJ files")
    )]
    UnitsIgnored { file: String },
}

impl Located for InputNote {
    fn place(&self) -> Place {
        Place::default()
    }
}

/// A structure that was read, with where it came from.
pub(super) struct Input {
    /// What was read, mm at model scale.
    pub draft: Draft,
    /// Name of the file, without its folder.
    pub file: String,
    /// SHA-256 of what was read.
    pub sha256: String,
    /// Whether the format says which edges carry fins.
    pub lists_fins: bool,
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
    let reading = Reading {
        units: args.units,
        axes: args.axes,
        scale: args.scale.factor,
        depth: args.depth,
        fix: args.fix.as_ref(),
    };
    read(named, &reading)
}

/// How a structure is read.
pub(super) struct Reading<'a> {
    /// Unit of a file that names none.
    pub units: Option<Unit>,
    /// Where node axes come from.
    pub axes: AxisRule,
    /// Of the model.
    pub scale: f64,
    /// Instead of the file's.
    pub depth: Option<Depth>,
    /// Instead of the file's.
    pub fix: Option<&'a Fix>,
}

/// Reads an embedded structure or a file.
///
/// # Errors
/// [`InputError`] if there is none.
pub(super) fn read(named: &str, args: &Reading) -> Result<Input, InputError> {
    let path = Path::new(named);
    let mut input = match examples::named(named) {
        Some(example) if !path.is_file() => {
            let mut draft = (example.draft)();
            if let Some(axes) = args.axes.axes(&draft.positions, &draft.faces) {
                draft.axes = axes;
            }
            let sha256 = sha256(format!("{draft:?}").as_bytes());
            let file = named.to_owned();
            let findings = units_ignored(args, &file);
            Input { draft, file, sha256, lists_fins: true, findings }
        }
        // A name without an ending can only have been meant as an embedded one.
        None if !path.exists() && path.extension().is_none() => {
            return Err(unknown_structure(named));
        }
        _ => from_file(path, args)?,
    };
    input.draft = input.draft.scaled(args.scale);
    if let Some(depth) = args.depth {
        input.draft = input.draft.with_depth(depth.below, depth.above);
    }
    if let Some(fix) = args.fix {
        let boundary = *fix == Fix::Boundary;
        input.draft.fixed = (!boundary).then(|| nodes(fix, &input.draft));
    }
    Ok(input)
}

/// The error for a structure that is not there, with the nearest name that is.
pub(super) fn unknown_structure(found: &str) -> InputError {
    let names = examples::ALL.iter().map(|example| example.name);
    let nearest = template::nearest(found, names);
    InputError::UnknownStructure { found: found.to_owned(), nearest }
}

fn units_ignored(args: &Reading, file: &str) -> Vec<Finding> {
    let note = args.units.map(|_| InputNote::UnitsIgnored { file: file.to_owned() });
    note.into_iter().map(Finding::from).collect()
}

fn from_file(path: &Path, args: &Reading) -> Result<Input, InputError> {
    let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let bad = |source| InputError::BadStructure { path: path.to_owned(), source };
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let bytes = bytes(path, |path| match ending.as_str() {
        "json" | "obj" => Ok(()),
        _ => Err(InputError::UnknownFormat { path: path.to_owned() }),
    })?;
    let sha256 = sha256(&bytes);
    let unit = args.units.unwrap_or(Unit::Millimetre);
    let (mut draft, notes, mut findings) = if ending == "json" {
        let text = text(path, bytes)?;
        if exchange::is_compas(&text) {
            let (draft, notes) =
                exchange::read_compas(&text, unit, args.axes).map_err(bad)?;
            (draft, notes, Vec::new())
        } else {
            let (draft, notes) = read_json(&text, args.axes).map_err(bad)?;
            (draft, notes, units_ignored(args, &file))
        }
    } else {
        // Names and comments may be in any alphabet; what counts in an OBJ file is ASCII.
        let text = String::from_utf8_lossy(&bytes);
        let options = ObjOptions { unit, axes: args.axes };
        let (draft, notes) = read_obj(&text, &options).map_err(bad)?;
        (draft, notes, Vec::new())
    };
    if draft.name.trim().is_empty() {
        draft.name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    }
    findings.extend(notes.into_iter().map(Finding::from));
    Ok(Input { draft, file, sha256, lists_fins: ending == "json", findings })
}

/// What is in a file that is there and may be read, without a byte order mark.
fn bytes(
    path: &Path,
    may_be_read: impl Fn(&Path) -> Result<(), InputError>,
) -> Result<Vec<u8>, InputError> {
    let unreadable = |source| InputError::Unreadable { path: path.to_owned(), source };
    std::fs::metadata(path).map_err(unreadable)?;
    may_be_read(path)?;
    let mut bytes = std::fs::read(path).map_err(unreadable)?;
    if bytes.starts_with(b"\xEF\xBB\xBF") {
        bytes.drain(..3);
    }
    // UTF-16, or no text at all.
    match bytes.iter().position(|&byte| byte == 0) {
        Some(byte) => Err(InputError::NotText { path: path.to_owned(), byte }),
        None => Ok(bytes),
    }
}

fn text(path: &Path, bytes: Vec<u8>) -> Result<String, InputError> {
    String::from_utf8(bytes).map_err(|error| InputError::NotText {
        path: path.to_owned(),
        byte: error.utf8_error().valid_up_to(),
    })
}

/// The bytes of a text file in any encoding but UTF-16.
pub(super) fn bytes_of(path: &Path) -> Result<Vec<u8>, InputError> {
    bytes(path, |_| Ok(()))
}

/// The text of a file.
pub(super) fn text_of(path: &Path) -> Result<String, InputError> {
    text(path, bytes(path, |_| Ok(()))?)
}

/// The nodes that a choice names.
pub(super) fn nodes(fix: &Fix, draft: &Draft) -> Vec<usize> {
    let count = draft.positions.len();
    match fix {
        Fix::None => Vec::new(),
        Fix::Boundary => boundary(draft)
            .into_iter()
            .enumerate()
            .filter_map(|(node, boundary)| boundary.then_some(node))
            .collect(),
        Fix::Nodes(nodes) => nodes.clone(),
        Fix::Lowest => {
            let height = |p: &Point3| p.z;
            let all = || draft.positions.iter().map(height);
            let low = all().fold(f64::INFINITY, f64::min);
            let high = all().fold(f64::NEG_INFINITY, f64::max);
            let limit = low + SAME_HEIGHT * (high - low);
            (0..count).filter(|&k| draft.positions[k].z <= limit).collect()
        }
    }
}

/// Whether each node is on the boundary; of a mesh whose faces name nodes that are not there,
/// which is refused later, none is.
fn boundary(draft: &Draft) -> Vec<bool> {
    Mesh::new(draft.positions.len(), &draft.faces)
        .map_or_else(|_| Vec::new(), |mesh| mesh.boundary_nodes())
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
        return Ok(template::read(&text_of(path)?, &name)?);
    }
    Err(InputError::BadTemplate(template::unknown_name(named)))
}
