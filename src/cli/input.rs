//! From what was typed to a draft and a template: the only place that reads files.

use crate::cli::flags::planarise::PlanariseWhen;
use crate::cli::flags::structure::InputArgs;
use crate::cli::flags::value::EffortLevel;
use crate::design::examples;
use crate::diagnostic::{Finding, Located, Place};
use crate::job::{Input, InputOptions, Specification};
use crate::nest::{Effort, Stock};
use crate::settings::Settings;
use crate::structure::ReadError;
use crate::template::{self, Template, TemplateErrors};
use miette::Diagnostic;
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

/// What the arguments ask for.
///
/// # Errors
/// [`InputError`] if there is no such template or structure.
pub(super) fn specification(args: &InputArgs) -> Result<Specification, InputError> {
    Ok(Specification {
        settings: settings(args)?,
        input: structure(args)?,
        planarise: args.planarise == PlanariseWhen::Auto,
        apply_remedies: false,
        only: Vec::new(),
    })
}

/// What the arguments say about how it is made.
///
/// # Errors
/// [`InputError`] if there is no such template.
pub(super) fn settings(args: &InputArgs) -> Result<Settings, InputError> {
    let trials = match args.effort {
        _ if args.time_limit.is_some() => u32::MAX,
        EffortLevel::Quick => 1,
        EffortLevel::Normal => 8,
        EffortLevel::Thorough => 64,
    };
    let mut settings =
        Settings::new(template(&args.template)?).with_hubs(args.hubs.iter().copied());
    if !args.sheet.is_empty() {
        // Margin and spacing belong to the machine.
        let [margin, spacing] = settings
            .stock
            .first()
            .map_or([5.0, 2.0], |sheet| [sheet.margin, sheet.spacing]);
        let stock =
            |&(size, count): &_| Stock { count, ..Stock::new(size, margin, spacing) };
        settings.stock = args.sheet.iter().map(stock).collect();
    }
    let effort = Effort { trials, seed: args.seed };
    Ok(Settings { joint: args.joint, effort, ..settings })
}

/// Reads the structure that the arguments name.
///
/// # Errors
/// [`InputError`] if there is none.
pub(super) fn structure(args: &InputArgs) -> Result<Input, InputError> {
    let named = args.structure.as_deref().unwrap_or(examples::ALL[0].name);
    let reading = InputOptions {
        units: args.units,
        axes: args.axes,
        scale: args.scale.clone(),
        depth: args.depth,
        fix: args.fix.clone(),
        weld_mm: args.weld,
    };
    read(named, &reading)
}

/// Reads an embedded structure or a file.
///
/// # Errors
/// [`InputError`] if there is none.
pub(super) fn read(named: &str, reading: &InputOptions) -> Result<Input, InputError> {
    let path = Path::new(named);
    match examples::named(named) {
        Some(example) if !path.is_file() => Ok(Input::embedded(example, reading)),
        // A name without an ending can only have been meant as an embedded one.
        None if !path.exists() && path.extension().is_none() => {
            Err(unknown_structure(named))
        }
        _ => from_file(path, reading),
    }
}

/// The error for a structure that is not there, with the nearest name that is.
pub(super) fn unknown_structure(found: &str) -> InputError {
    let names = examples::ALL.iter().map(|example| example.name);
    let nearest = template::nearest(found, names);
    InputError::UnknownStructure { found: found.to_owned(), nearest }
}

fn from_file(path: &Path, reading: &InputOptions) -> Result<Input, InputError> {
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let bytes = bytes(path, |path| match ending.as_str() {
        "json" | "obj" => Ok(()),
        _ => Err(InputError::UnknownFormat { path: path.to_owned() }),
    })?;
    let read = match ending.as_str() {
        "json" => Input::json(&file, &text(path, bytes)?, reading),
        _ => Input::obj(&file, &bytes, reading),
    };
    read.map_err(|source| InputError::BadStructure { path: path.to_owned(), source })
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

/// The bytes of a file of any kind.
pub(super) fn raw_bytes_of(path: &Path) -> Result<Vec<u8>, InputError> {
    let unreadable = |source| InputError::Unreadable { path: path.to_owned(), source };
    std::fs::read(path).map_err(unreadable)
}

/// The text of a file.
pub(super) fn text_of(path: &Path) -> Result<String, InputError> {
    text(path, bytes(path, |_| Ok(()))?)
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
