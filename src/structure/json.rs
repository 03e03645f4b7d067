//! Structures as JSON (contract §2).

use crate::geometry::{Point3, Vector3};
use crate::structure::{AxisRule, Draft, Structure};
use crate::units::Unit;
use miette::Diagnostic;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Why a file is no structure at all.
#[derive(Debug, Clone, PartialEq, Eq, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum ReadError {
    #[error("line {line}, column {column}: {message}")]
    #[diagnostic(
        code(read::bad_json),
        help(
            "the format is described in docs/structure.md; `finwright example write vault` \
              gives a sample"
        )
    )]
    BadJson { line: usize, column: usize, message: String },

    #[error("the file says format \"{found}\", version {version}")]
    #[diagnostic(
        code(read::other_format),
        help("\"finwright-structure\" version 1 can be read here")
    )]
    OtherFormat { found: String, version: u64 },

    #[error("line {line}: {message}")]
    #[diagnostic(
        code(read::bad_obj),
        help("export the mesh again as plain OBJ with `v`, `vn` and `f` lines")
    )]
    BadObj { line: usize, message: String },

    #[error("line {line}: node {node} has two different axes")]
    #[diagnostic(
        code(read::conflicting_axes),
        help("every corner of a vertex must name the same `vn`; or use `--axes normal`")
    )]
    ConflictingAxes { line: usize, node: usize },

    #[error("{missing} of {nodes} nodes have no axis, the first is node {node}")]
    #[diagnostic(
        code(read::missing_axes),
        help("give every corner a `vn`, or use `--axes normal`")
    )]
    MissingAxes { missing: usize, nodes: usize, node: usize },

    #[error("the depth lists {count} numbers for {nodes} nodes")]
    #[diagnostic(code(read::depth_count), help("give one number, or one per node"))]
    DepthCount { count: usize, nodes: usize },
}

#[derive(Deserialize, Serialize)]
struct File {
    format: String,
    version: u64,
    #[serde(default)]
    name: String,
    units: Unit,
    positions: Vec<[f64; 3]>,
    axes: Vec<[f64; 3]>,
    #[serde(default)]
    faces: Vec<Vec<usize>>,
    depth: Depth,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    fins: Option<Vec<[usize; 2]>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    strips: Option<Vec<Vec<usize>>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    fixed: Option<Vec<usize>>,
}

#[derive(Deserialize, Serialize)]
struct Depth {
    below: Reach,
    above: Reach,
}

#[derive(Deserialize, Serialize)]
#[serde(untagged)]
enum Reach {
    Same(f64),
    Each(Vec<f64>),
}

impl Reach {
    fn per_node(self, nodes: usize) -> Result<Vec<f64>, ReadError> {
        match self {
            Self::Same(depth) => Ok(vec![depth; nodes]),
            Self::Each(depths) if depths.len() == nodes => Ok(depths),
            Self::Each(depths) => {
                Err(ReadError::DepthCount { count: depths.len(), nodes })
            }
        }
    }

    fn shortest(depths: Vec<f64>) -> Self {
        match depths.first() {
            Some(&first) if depths.iter().all(|&d| d.to_bits() == first.to_bits()) => {
                Self::Same(first)
            }
            _ => Self::Each(depths),
        }
    }
}

/// Reads a structure and turns its lengths into millimetres.
///
/// `axes` may replace the file's axes; a point is in the file's units.
///
/// # Errors
/// [`ReadError`] if the text is no structure of this format.
pub fn read_json(text: &str, axes: AxisRule) -> Result<Draft, ReadError> {
    let bad = |error: serde_json::Error| ReadError::BadJson {
        line: error.line(),
        column: error.column(),
        message: error.to_string().split(" at line ").next().unwrap_or_default().into(),
    };
    let value: serde_json::Value = serde_json::from_str(text).map_err(bad)?;
    let found = value["format"].as_str().unwrap_or("(none)");
    let version = value["version"].as_u64().unwrap_or(0);
    if found != "finwright-structure" || version != 1 {
        return Err(ReadError::OtherFormat { found: found.into(), version });
    }
    // Read from the text again: only then do errors have a line.
    let file: File = serde_json::from_str(text).map_err(bad)?;
    let nodes = file.positions.len();
    let mut draft = Draft {
        name: file.name,
        positions: file.positions.into_iter().map(Point3::from).collect(),
        axes: file.axes.into_iter().map(Vector3::from).collect(),
        faces: file.faces,
        below: file.depth.below.per_node(nodes)?,
        above: file.depth.above.per_node(nodes)?,
        fins: file.fins,
        strips: file.strips,
        fixed: file.fixed,
    };
    if let Some(axes) = axes.axes(&draft.positions, &draft.faces) {
        draft.axes = axes;
    }
    Ok(draft.scaled(file.units.millimetres()))
}

/// Writes a structure in millimetres, with its fins and strips spelled out.
pub fn write_json(structure: &Structure) -> String {
    let nodes = structure.nodes();
    let strips = structure.strips().iter().map(|strip| {
        let seam = strip.closed.then_some(strip.nodes[0]);
        strip.nodes.iter().copied().chain(seam).collect()
    });
    let file = File {
        format: "finwright-structure".into(),
        version: 1,
        name: structure.name().into(),
        units: Unit::Millimetre,
        positions: nodes.iter().map(|node| node.position.coords.into()).collect(),
        axes: nodes.iter().map(|node| node.axis.into()).collect(),
        faces: structure.faces().to_vec(),
        depth: Depth {
            below: Reach::shortest(nodes.iter().map(|node| node.below).collect()),
            above: Reach::shortest(nodes.iter().map(|node| node.above).collect()),
        },
        fins: Some(structure.fins().to_vec()),
        strips: Some(strips.collect()),
        fixed: Some(structure.fixed().to_vec()),
    };
    rows(&file)
}

/// JSON with a line per key, and per entry of a list.
fn rows(file: &File) -> String {
    let value = serde_json::to_value(file).unwrap_or_default();
    let entries = value.as_object().into_iter().flatten().map(|(key, value)| {
        let text = match value {
            serde_json::Value::Array(list) if list.iter().any(|item| item.is_array()) => {
                let items: Vec<String> =
                    list.iter().map(|item| format!("    {item}")).collect();
                format!("[\n{}\n  ]", items.join(",\n"))
            }
            other => other.to_string(),
        };
        format!("  \"{key}\": {text}")
    });
    let entries: Vec<String> = entries.collect();
    format!("{{\n{}\n}}\n", entries.join(",\n"))
}
