//! Structures as they come: embedded ones, and the bytes of JSON and OBJ files.

use crate::design::examples::Example;
use crate::diagnostic::{Finding, Located, Place};
use crate::files::sha256;
use crate::geometry::{Mesh, Vector3};
use crate::structure::{
    AxisRule, Draft, ObjOptions, ReadError, area_vector, interop, read_json, read_obj,
};
use crate::tolerance::SAME_HEIGHT;
use crate::units::Unit;
use miette::Diagnostic;
use thiserror::Error;

/// A structure as read.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// What was read, mm at model scale.
    pub draft: Draft,
    /// Where from.
    pub origin: Origin,
    /// Whether the format says which edges carry fins.
    pub lists_fins: bool,
    /// Found while reading.
    pub findings: Vec<Finding>,
}

/// Where a structure comes from, for the record.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// Name of the file, without its folder.
    pub name: String,
    /// SHA-256 of what was read, hexadecimal.
    pub sha256: String,
    /// Such as `1:50`.
    pub scale: String,
}

/// How a structure is read.
#[derive(Debug, Clone, PartialEq)]
pub struct InputOptions {
    /// Unit of a file that names none.
    pub units: Option<Unit>,
    /// Where node axes come from.
    pub axes: AxisRule,
    /// Of the model.
    pub scale: Scale,
    /// Instead of the file's.
    pub depth: Option<Depth>,
    /// Instead of the file's.
    pub fix: Option<Fix>,
    /// Vertices of an OBJ file within this of each other become one node, mm of its size.
    pub weld_mm: f64,
}

impl Default for InputOptions {
    /// As the file says, at full size.
    fn default() -> Self {
        let scale = Scale { text: "1:1".to_owned(), factor: 1.0 };
        Self {
            units: None,
            axes: AxisRule::File,
            scale,
            depth: None,
            fix: None,
            weld_mm: 0.0,
        }
    }
}

/// A model scale with the text it was given as.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    /// Such as `1:50`.
    pub text: String,
    /// Such as 0.02.
    pub factor: f64,
}

/// Depth of all fins, mm of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Depth {
    /// Against the axes.
    pub below: f64,
    /// Along the axes.
    pub above: f64,
}

/// Nodes held by the ground.
#[derive(Debug, Clone, PartialEq)]
pub enum Fix {
    /// No node.
    None,
    /// All nodes on the boundary of the mesh.
    Boundary,
    /// The lowest nodes.
    Lowest,
    /// These.
    Nodes(Vec<usize>),
}

impl Fix {
    /// The nodes that are meant.
    pub fn nodes(&self, draft: &Draft) -> Vec<usize> {
        let count = draft.positions.len();
        match self {
            Self::None => Vec::new(),
            Self::Boundary => boundary(draft)
                .into_iter()
                .enumerate()
                .filter_map(|(node, boundary)| boundary.then_some(node))
                .collect(),
            Self::Nodes(nodes) => nodes.clone(),
            Self::Lowest => {
                let heights = || draft.positions.iter().map(|p| p.z);
                let low = heights().fold(f64::INFINITY, f64::min);
                let high = heights().fold(f64::NEG_INFINITY, f64::max);
                let limit = low + SAME_HEIGHT * (high - low);
                (0..count).filter(|&k| draft.positions[k].z <= limit).collect()
            }
        }
    }
}

/// An option that had no effect.
#[derive(Debug, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
enum InputNote {
    #[error("--units was not used: {file} says its own unit")]
    #[diagnostic(
        code(input::units_ignored),
        severity(Warning),
        help("change \"units\" in the file, or use `--scale`; --units is for OBJ files")
    )]
    UnitsIgnored { file: String },

    #[error("the mesh lies along the axes {axes} and across y: it may have y upward")]
    #[diagnostic(
        code(input::y_up),
        severity(Warning),
        help("try `--axes 0,1,0`, or export the mesh with z upward")
    )]
    YUp { axes: String },
}

impl Located for InputNote {
    fn place(&self) -> Place {
        Place::default()
    }
}

impl Input {
    /// An embedded structure.
    pub fn embedded(example: &Example, reading: &InputOptions) -> Self {
        let mut draft = (example.draft)();
        if let Some(axes) = reading.axes.axes(&draft.positions, &draft.faces) {
            draft.axes = axes;
        }
        // What was read is what it is made of.
        let bytes = format!("{draft:?}").into_bytes();
        let findings = units_ignored(example.name, reading);
        Self::new(draft, (example.name, &bytes, true), findings, reading)
    }

    /// A structure as JSON, ours or a mesh of COMPAS; `file` is the file's name.
    ///
    /// # Errors
    /// [`ReadError`] if it is neither.
    pub fn json(
        file: &str,
        text: &str,
        reading: &InputOptions,
    ) -> Result<Self, ReadError> {
        let (draft, notes, mut findings) = if interop::is_compas(text) {
            let unit = reading.units.unwrap_or(Unit::Millimetre);
            let (draft, notes) = interop::read_compas(text, unit, reading.axes)?;
            (draft, notes, Vec::new())
        } else {
            let (draft, notes) = read_json(text, reading.axes)?;
            (draft, notes, units_ignored(file, reading))
        };
        findings.extend(notes.into_iter().map(Finding::from));
        let draft = named(draft, file);
        Ok(Self::new(draft, (file, text.as_bytes(), true), findings, reading))
    }

    /// A mesh as OBJ; `file` is the file's name.
    ///
    /// # Errors
    /// [`ReadError`] if it is none.
    pub fn obj(
        file: &str,
        bytes: &[u8],
        reading: &InputOptions,
    ) -> Result<Self, ReadError> {
        // Names and comments may be in any alphabet; what counts in an OBJ file is ASCII.
        let text = String::from_utf8_lossy(bytes);
        let unit = reading.units.unwrap_or(Unit::Millimetre);
        let options = ObjOptions { unit, axes: reading.axes, weld_mm: reading.weld_mm };
        let (draft, notes) = read_obj(&text, &options)?;
        let mut findings: Vec<Finding> = notes.into_iter().map(Finding::from).collect();
        findings.extend(y_up(&draft, reading.axes).map(Finding::from));
        let draft = named(draft, file);
        Ok(Self::new(draft, (file, bytes, false), findings, reading))
    }

    /// At the scale, depth and supports that were asked for.
    fn new(
        draft: Draft,
        (name, bytes, lists_fins): (&str, &[u8], bool),
        findings: Vec<Finding>,
        reading: &InputOptions,
    ) -> Self {
        let mut draft = draft.scaled(reading.scale.factor);
        if let Some(depth) = reading.depth {
            draft = draft.with_depth(depth.below, depth.above);
        }
        if let Some(fix) = &reading.fix {
            draft.fixed = (*fix != Fix::Boundary).then(|| fix.nodes(&draft));
        }
        let (name, scale) = (name.to_owned(), reading.scale.text.clone());
        Self {
            draft,
            origin: Origin { name, sha256: sha256(bytes), scale },
            lists_fins,
            findings,
        }
    }
}

/// Whether each node is on the boundary; of a mesh whose faces name nodes that are not there,
/// which is refused later, none is.
fn boundary(draft: &Draft) -> Vec<bool> {
    Mesh::new(draft.positions.len(), &draft.faces)
        .map_or_else(|_| Vec::new(), |mesh| mesh.boundary_nodes())
}

/// Named after its file, if it has no name.
fn named(mut draft: Draft, file: &str) -> Draft {
    if draft.name.trim().is_empty() {
        draft.name = file.rsplit_once('.').map_or(file, |(name, _)| name).to_owned();
    }
    draft
}

/// Whether parallel axes along z run through a mesh that is spread out across y.
fn y_up(draft: &Draft, rule: AxisRule) -> Option<InputNote> {
    let AxisRule::Parallel(axis) = rule else { return None };
    let sound = |face: &&Vec<usize>| face.iter().all(|&k| k < draft.positions.len());
    let areas = draft.faces.iter().filter(sound);
    let areas = areas.map(|face| area_vector(&draft.positions, face).abs());
    let [x, y, z]: [f64; 3] = areas.sum::<Vector3>().into();
    let along_z = axis.z.abs() > axis.x.abs().max(axis.y.abs());
    (along_z && y > x && y > 2.0 * z).then(|| {
        let axes = [axis.x, axis.y, axis.z].map(|part| part.to_string()).join(",");
        InputNote::YUp { axes }
    })
}

fn units_ignored(file: &str, reading: &InputOptions) -> Vec<Finding> {
    let note = reading.units.map(|_| InputNote::UnitsIgnored { file: file.to_owned() });
    note.into_iter().map(Finding::from).collect()
}
