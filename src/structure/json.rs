//! Structures as JSON (docs/structure.md).

use crate::geometry::{Point3, Vector3};
use crate::ids::NodeId;
use crate::structure::{AxisRule, DesignRecord, Draft, ReadError, ReadNote, Structure};
use crate::units::Unit;
use serde::de::{Deserializer, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::fmt;

/// The keys of a structure (docs/structure.md).
const KEYS: [&str; 13] = [
    "format",
    "version",
    "name",
    "units",
    "positions",
    "axes",
    "faces",
    "depth",
    "fins",
    "strips",
    "fixed",
    "families",
    "design",
];

#[derive(Deserialize, Serialize)]
struct File {
    format: String,
    version: u64,
    #[serde(default)]
    name: String,
    units: Unit,
    positions: Vec<Row<f64, 3>>,
    axes: Vec<Row<f64, 3>>,
    #[serde(default)]
    faces: Vec<Vec<usize>>,
    depth: Depth,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    fins: Option<Vec<Row<usize, 2>>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    strips: Option<Vec<Vec<usize>>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    fixed: Option<Vec<usize>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    families: Option<Vec<Option<u8>>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    design: Option<DesignRecord>,
}

#[derive(Deserialize, Serialize)]
struct Depth {
    below: Reach,
    above: Reach,
}

/// `N` numbers; another count is an error that says so.
#[derive(Clone, Deserialize, Serialize)]
#[serde(try_from = "Vec<T>", into = "Vec<T>")]
#[serde(bound(deserialize = "T: Deserialize<'de>", serialize = "T: Clone + Serialize"))]
struct Row<T, const N: usize>([T; N]);

impl<T, const N: usize> TryFrom<Vec<T>> for Row<T, N> {
    type Error = String;

    fn try_from(list: Vec<T>) -> Result<Self, String> {
        let count = list.len();
        let row = <[T; N]>::try_from(list);
        row.map(Self).map_err(|_| format!("{count} numbers where {N} are needed"))
    }
}

impl<T, const N: usize> From<Row<T, N>> for Vec<T> {
    fn from(row: Row<T, N>) -> Self {
        row.0.into()
    }
}

#[derive(Serialize)]
#[serde(untagged)]
enum Reach {
    Same(f64),
    Each(Vec<f64>),
}

impl<'de> Deserialize<'de> for Reach {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ReachVisitor)
    }
}

/// By hand, for serde's own reader of two kinds does not say what is wrong, nor where.
struct ReachVisitor;

impl<'de> Visitor<'de> for ReachVisitor {
    type Value = Reach;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("a number, or a list of one number per node")
    }

    fn visit_f64<E>(self, depth: f64) -> Result<Reach, E> {
        Ok(Reach::Same(depth))
    }

    fn visit_i64<E>(self, depth: i64) -> Result<Reach, E> {
        Ok(Reach::Same(depth as f64))
    }

    fn visit_u64<E>(self, depth: u64) -> Result<Reach, E> {
        Ok(Reach::Same(depth as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Reach, A::Error> {
        let mut depths = Vec::new();
        while let Some(depth) = list.next_element()? {
            depths.push(depth);
        }
        Ok(Reach::Each(depths))
    }
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
/// ```
/// use finwright::{structure::{AxisRule, Structure, read_json}, tolerance::Tolerance};
///
/// let text = r#"{"format": "finwright-structure", "version": 1, "name": "tile", "units": "mm",
///     "positions": [[0,0,0], [90,0,0], [90,90,0], [0,90,0]],
///     "axes": [[0,0,1], [0,0,1], [0,0,1], [0,0,1]],
///     "faces": [[0,1,2,3]], "depth": {"below": 20, "above": 20}}"#;
/// let (draft, _notes) = read_json(text, AxisRule::File).unwrap();
/// let (structure, _findings) = Structure::new(draft, &Tolerance::default()).unwrap();
/// assert_eq!((structure.nodes().len(), structure.fins().len()), (4, 4));
/// ```
pub fn read_json(
    text: &str,
    axes: AxisRule,
) -> Result<(Draft, Vec<ReadNote>), ReadError> {
    if text.trim().is_empty() {
        return Err(ReadError::EmptyFile);
    }
    let value: Value = serde_json::from_str(text).map_err(|error| bad(&error, &[]))?;
    let shown = |key: &str| value.get(key).map_or("(nothing)".into(), excerpt);
    let (format, version) = (shown("format"), shown("version"));
    if format != "\"finwright-structure\"" || version != "1" {
        return Err(ReadError::OtherFormat { format, version });
    }
    let notes = unknown_keys(&value);
    // Read from the text again: only then do errors have a line.
    let file: File = serde_json::from_str(text).map_err(|error| bad(&error, &notes))?;
    let nodes = file.positions.len();
    let mut draft = Draft {
        name: file.name,
        positions: file.positions.into_iter().map(|row| Point3::from(row.0)).collect(),
        axes: file.axes.into_iter().map(|row| Vector3::from(row.0)).collect(),
        faces: file.faces,
        below: file.depth.below.per_node(nodes)?,
        above: file.depth.above.per_node(nodes)?,
        fins: file.fins.map(|fins| fins.into_iter().map(|row| row.0).collect()),
        strips: file.strips,
        fixed: file.fixed,
        families: file.families,
        design: file.design,
    };
    if let Some(axes) = axes.axes(&draft.positions, &draft.faces) {
        draft.axes = axes;
    }
    Ok((draft.scaled(file.units.millimetres()), notes))
}

/// The beginning of a value as JSON.
fn excerpt(value: &Value) -> String {
    const SHOWN: usize = 40;
    let text = value.to_string();
    let cut = text.char_indices().nth(SHOWN).map(|(at, _)| at);
    cut.map_or(text.clone(), |at| format!("{}...", &text[..at]))
}

/// Keys that were not read. One that is nearly a key which is not there was meant as it.
fn unknown_keys(value: &Value) -> Vec<ReadNote> {
    let found = value.as_object().into_iter().flatten().map(|(key, _)| key.as_str());
    let unknown = found.filter(|key| !KEYS.contains(key));
    let missing = KEYS.iter().filter(|key| value.get(key).is_none());
    unknown
        .map(|found| {
            let off = |key: &str| strsim::damerau_levenshtein(&found.to_lowercase(), key);
            let near = |key: &&&str| off(key) <= (key.len() / 3).max(1);
            match missing.clone().filter(near).min_by_key(|key| off(key)) {
                Some(key) => ReadNote::MisspeltKey {
                    found: found.to_owned(),
                    nearest: (*key).to_owned(),
                },
                None => ReadNote::UnknownKey { found: found.to_owned() },
            }
        })
        .collect()
}

/// serde's message in words for people who do not know Rust.
fn bad(error: &serde_json::Error, notes: &[ReadNote]) -> ReadError {
    const PLAIN: [(&str, &str); 11] = [
        ("a sequence", "a list [...]"),
        ("sequence", "a list"),
        ("a map", "an object {...}"),
        ("expected map", "expected an object {...}"),
        ("expected usize", "expected a whole number from 0"),
        ("expected u8", "expected 1, 2 or null"),
        ("expected f64", "expected a number"),
        ("struct File", "an object {...}"),
        ("struct Depth", "{\"below\": ..., \"above\": ...}"),
        ("floating point", "number"),
        ("EOF while parsing", "the file ends within"),
    ];
    let message = error.to_string();
    let mut message = message.split(" at line ").next().unwrap_or_default().to_owned();
    if let Some((jargon, plain)) = PLAIN.iter().find(|pair| message.contains(pair.0)) {
        message = message.replace(jargon, plain);
    }
    for note in notes {
        if let ReadNote::MisspeltKey { found, nearest } = note
            && message.contains(&format!("`{nearest}`"))
        {
            message += &format!(" (there is \"{found}\")");
        }
    }
    ReadError::BadJson { line: error.line(), column: error.column(), message }
}

/// Writes a structure in millimetres, with its fins and strips spelled out.
pub fn write_json(structure: &Structure) -> String {
    let nodes = structure.nodes();
    let strips = structure.strips().iter().map(|strip| {
        let seam = strip.closed.then_some(strip.nodes[0]);
        indices(strip.nodes.iter().chain(&seam))
    });
    let fins = structure.fins().iter().map(|fin| Row(fin.ends().map(NodeId::index)));
    let mesh = structure.mesh();
    let file = File {
        format: "finwright-structure".into(),
        version: 1,
        name: structure.name().into(),
        units: Unit::Millimetre,
        positions: nodes.iter().map(|node| Row(node.position.coords.into())).collect(),
        axes: nodes.iter().map(|node| Row(node.axis.into())).collect(),
        faces: mesh.faces().map(|face| indices(mesh.corners(face))).collect(),
        depth: Depth {
            below: Reach::shortest(nodes.iter().map(|node| node.below).collect()),
            above: Reach::shortest(nodes.iter().map(|node| node.above).collect()),
        },
        fins: Some(fins.collect()),
        strips: Some(strips.collect()),
        fixed: Some(indices(structure.fixed())),
        families: structure.families().map(<[_]>::to_vec),
        design: structure.design().cloned(),
    };
    rows(&file)
}

fn indices<'a>(nodes: impl IntoIterator<Item = &'a NodeId>) -> Vec<usize> {
    nodes.into_iter().map(|node| node.index()).collect()
}

/// JSON with a line per key, and per entry of a list.
fn rows(file: &File) -> String {
    let value = serde_json::to_value(file).unwrap_or_default();
    let entries = value.as_object().into_iter().flatten().map(|(key, value)| {
        let text = match value {
            Value::Array(list) if list.iter().any(|item| item.is_array()) => {
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
