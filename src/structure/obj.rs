//! Structures as OBJ: `v` node positions, `vn` node axes, polygons as faces.
//!
//! Read by our own few lines: `tobj` renumbers vertices in order of use, drops those
//! without a face and has no line numbers, while node numbers are engraved on our parts
//! (docs/decisions/0003). A test holds the two readers against each other.

use crate::geometry::{Point3, Vector3};
use crate::structure::Structure;
use crate::structure::draft::{Draft, area_vector};
use crate::structure::read::{ReadError, ReadNote};
use crate::structure::weld;
use crate::tolerance::SAME_AXIS;
use crate::units::Unit;

/// Where node axes come from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AxisRule {
    /// From the file's `vn`; from vertex normals if there is none.
    File,
    /// From vertex normals, weighted by area.
    Normal,
    /// All parallel to this direction.
    Parallel(Vector3),
    /// All through this point (in the file's units), pointing away from it.
    Through(Point3),
}

/// How to read an OBJ file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ObjOptions {
    /// Unit of its numbers.
    pub unit: Unit,
    /// Where node axes come from.
    pub axes: AxisRule,
    /// Vertices within this of an earlier one become that one, mm of the file's size; 0
    /// joins none.
    pub weld_mm: f64,
}

/// Faces and vertices as the file has them.
#[derive(Default)]
struct Mesh {
    positions: Vec<Point3>,
    normals: Vec<Vector3>,
    faces: Vec<Vec<usize>>,
    axes: Vec<Option<Vector3>>,
    /// Lines with curves, lines and points.
    other: Vec<usize>,
}

/// Reads a mesh as a structure in millimetres, each side of a fin 0.35 of the median
/// fin length deep (docs/structure.md).
///
/// # Errors
/// [`ReadError`] with the line at fault.
pub fn read_obj(
    text: &str,
    options: &ObjOptions,
) -> Result<(Draft, Vec<ReadNote>), ReadError> {
    if text.trim().is_empty() {
        return Err(ReadError::EmptyFile);
    }
    let mut mesh = Mesh::default();
    // Line ends of old Macs are alone on a line.
    let text = if text.contains('\n') { text } else { &text.replace('\r', "\n") };
    for (number, line) in logical_lines(text) {
        mesh.take(number, &line, options.axes)?;
    }
    if mesh.faces.is_empty() {
        let (vertices, other) = (mesh.positions.len(), mesh.other.len());
        return Err(ReadError::NoFaces { vertices, other });
    }
    let welded = mesh.welded(options.weld_mm / options.unit.millimetres())?;
    let (axes, mut notes) = axes(&mesh, options.axes)?;
    notes.extend(welded);
    let count = mesh.other.len();
    notes.extend(mesh.other.first().map(|&line| ReadNote::NotAFace { count, line }));
    let draft =
        Draft { positions: mesh.positions, axes, faces: mesh.faces, ..Draft::default() };
    let mut draft = draft.scaled(options.unit.millimetres());
    let depth = 0.35 * median_fin_length(&draft);
    draft = draft.with_depth(depth, depth);
    Ok((draft, notes))
}

/// Lines without comments, `\` at the end joining the next, numbered from 1.
pub(super) fn logical_lines(text: &str) -> impl Iterator<Item = (usize, String)> + '_ {
    let mut lines = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (index, first) = lines.next()?;
        let mut line = without_comment(first).trim_end().to_owned();
        while line.ends_with('\\') {
            line.pop();
            line.push(' ');
            line.push_str(lines.next().map_or("", |(_, more)| more.trim_end()));
        }
        Some((index + 1, line))
    })
}

/// What stands before `#`; in `1.#IND`, as old libraries wrote what was no number, it begins
/// no comment.
fn without_comment(line: &str) -> &str {
    let comment =
        line.char_indices().find(|&(at, c)| c == '#' && !line[..at].ends_with('.'));
    comment.map_or(line, |(at, _)| &line[..at])
}

impl Mesh {
    fn take(&mut self, line: usize, text: &str, rule: AxisRule) -> Result<(), ReadError> {
        let mut words = text.split_whitespace();
        match words.next() {
            Some("v") => self.positions.push(Point3::from(vector(line, words)?)),
            Some("vn") => self.normals.push(vector(line, words)?),
            Some("f") => self.face(line, words, rule)?,
            Some("l" | "p" | "curv" | "curv2" | "surf") => self.other.push(line),
            _ => {}
        }
        Ok(())
    }

    /// Joins vertices that lie together; a face loses the corners that become one.
    fn welded(&mut self, within: f64) -> Result<Option<ReadNote>, ReadError> {
        let vertices = self.positions.len();
        let numbers = if within > 0.0 {
            weld::numbers(&self.positions, within)
        } else {
            (0..vertices).collect()
        };
        let nodes = numbers.iter().max().map_or(0, |last| last + 1);
        if nodes == vertices {
            return Ok(None);
        }
        let (positions, axes) = (self.positions.clone(), self.axes.clone());
        self.axes = vec![None; nodes];
        for (vertex, &node) in numbers.iter().enumerate().rev() {
            self.positions[node] = positions[vertex];
            let Some(axis) = axes.get(vertex).copied().flatten() else { continue };
            match self.axes[node] {
                Some(other) if !parallel(other, axis) => {
                    return Err(ReadError::AxesOfWelded { node: vertex });
                }
                _ => self.axes[node] = Some(axis),
            }
        }
        self.positions.truncate(nodes);
        for face in &mut self.faces {
            face.iter_mut().for_each(|corner| *corner = numbers[*corner]);
            let mut merged = face.clone();
            merged.dedup();
            while merged.len() > 1 && merged.first() == merged.last() {
                merged.pop();
            }
            // What is no face any more is said to be none.
            if merged.len() >= 3 {
                *face = merged;
            }
        }
        Ok(Some(ReadNote::Welded { vertices, nodes }))
    }

    fn face<'a>(
        &mut self,
        line: usize,
        words: impl Iterator<Item = &'a str>,
        rule: AxisRule,
    ) -> Result<(), ReadError> {
        let mut face = Vec::new();
        for word in words {
            let mut fields = word.split('/');
            let node = index(line, fields.next(), self.positions.len())?;
            let normal = fields.nth(1).filter(|field| !field.is_empty());
            if let (AxisRule::File, Some(normal)) = (rule, normal) {
                let axis = self.normals[index(line, Some(normal), self.normals.len())?];
                self.axes.resize(self.positions.len(), None);
                match self.axes[node] {
                    Some(other) if !parallel(other, axis) => {
                        return Err(ReadError::ConflictingAxes { line, node });
                    }
                    _ => self.axes[node] = Some(axis),
                }
            }
            face.push(node);
        }
        self.faces.push(face);
        Ok(())
    }
}

pub(super) fn vector<'a>(
    line: usize,
    mut words: impl Iterator<Item = &'a str>,
) -> Result<Vector3, ReadError> {
    let mut number = || {
        let Some(word) = words.next() else {
            let message = "three numbers are needed, found fewer".to_owned();
            return Err(ReadError::BadObj { line, message });
        };
        let number = word.parse::<f64>();
        if number.as_ref().map_or(word.contains('#'), |number| !number.is_finite()) {
            let message = format!(
                "{} is what a program writes where it could not compute a number",
                quoted(word)
            );
            return Err(ReadError::BadObj { line, message });
        }
        number.map_err(|_| {
            let comma = if word.contains(',') { " (write 1.5, not 1,5)" } else { "" };
            let message = format!("{} is no number{comma}", quoted(word));
            ReadError::BadObj { line, message }
        })
    };
    Ok(Vector3::new(number()?, number()?, number()?))
}

/// The beginning of a word that could not be read.
fn quoted(word: &str) -> String {
    const SHOWN: usize = 20;
    let more = if word.chars().nth(SHOWN).is_some() { "..." } else { "" };
    format!("{:?}{more}", word.chars().take(SHOWN).collect::<String>())
}

/// An index as OBJ counts: from 1, or backward from the newest if negative.
fn index(line: usize, word: Option<&str>, count: usize) -> Result<usize, ReadError> {
    let word = word.unwrap_or_default();
    let bad = |message: String| ReadError::BadObj { line, message };
    let number: i64 =
        word.parse().map_err(|_| bad(format!("{} is no vertex number", quoted(word))))?;
    let from_start = if number < 0 { count as i64 + number } else { number - 1 };
    usize::try_from(from_start).ok().filter(|&index| index < count).ok_or_else(|| {
        bad(format!("number {number} is used, but only {count} were given before"))
    })
}

/// Whether two `vn` mean the same axis; exporters round them differently.
fn parallel(a: Vector3, b: Vector3) -> bool {
    let lengths = a.norm() * b.norm();
    a.dot(&b) > 0.0 && a.cross(&b).norm() <= SAME_AXIS * lengths || a == b
}

fn axes(mesh: &Mesh, rule: AxisRule) -> Result<(Vec<Vector3>, Vec<ReadNote>), ReadError> {
    let nodes = mesh.positions.len();
    match rule.axes(&mesh.positions, &mesh.faces) {
        Some(axes) => Ok((axes, Vec::new())),
        None if mesh.axes.iter().any(Option::is_some) => given_axes(mesh),
        None => Ok((
            normals(&mesh.positions, &mesh.faces),
            vec![ReadNote::AxesFromNormals { nodes }],
        )),
    }
}

impl AxisRule {
    /// The axes that this rule gives the nodes of a mesh; `None` leaves them to the file.
    pub fn axes(
        self,
        positions: &[Point3],
        faces: &[Vec<usize>],
    ) -> Option<Vec<Vector3>> {
        match self {
            Self::File => None,
            Self::Normal => Some(normals(positions, faces)),
            Self::Parallel(direction) => Some(vec![direction; positions.len()]),
            Self::Through(point) => Some(positions.iter().map(|p| p - point).collect()),
        }
    }
}

/// The file's axes; every node of a face must have one.
fn given_axes(mesh: &Mesh) -> Result<(Vec<Vector3>, Vec<ReadNote>), ReadError> {
    let nodes = mesh.positions.len();
    let axis = |node: usize| mesh.axes.get(node).copied().flatten();
    let corners: std::collections::BTreeSet<usize> =
        mesh.faces.iter().flatten().copied().collect();
    let mut missing = corners.iter().copied().filter(|&node| axis(node).is_none());
    if let Some(node) = missing.next() {
        let missing = 1 + missing.count();
        return Err(ReadError::MissingAxes { missing, nodes, node });
    }
    // A vertex without a face takes no part; any direction will do.
    Ok(((0..nodes).map(|node| axis(node).unwrap_or(Vector3::z())).collect(), Vec::new()))
}

/// Vertex normals weighted by area; a vertex without a face points up. Corners out of
/// range are left for the check of the draft.
fn normals(positions: &[Point3], faces: &[Vec<usize>]) -> Vec<Vector3> {
    let mut normals = vec![Vector3::zeros(); positions.len()];
    let mut in_a_face = vec![false; normals.len()];
    for face in faces.iter().filter(|f| f.iter().all(|&node| node < positions.len())) {
        let area = area_vector(positions, face);
        for &node in face {
            normals[node] += area;
            in_a_face[node] = true;
        }
    }
    let loose = |(normal, in_a_face): (Vector3, bool)| {
        if in_a_face { normal } else { Vector3::z() }
    };
    normals.into_iter().zip(in_a_face).map(loose).collect()
}

pub(super) fn median_fin_length(draft: &Draft) -> f64 {
    let mut lengths: Vec<f64> = draft
        .fin_ids()
        .iter()
        .map(|fin| fin.ends().map(|node| draft.positions[node]))
        .map(|[a, b]| (a - b).norm())
        // What is no number is found later, and once.
        .filter(|length| length.is_finite())
        .collect();
    lengths.sort_by(f64::total_cmp);
    lengths.get(lengths.len() / 2).copied().unwrap_or(1.0)
}

/// Writes nodes, axes and faces as OBJ in millimetres.
pub fn write_obj(structure: &Structure) -> String {
    let mut text = format!("# {} (mm), vn = node axis\n", structure.name());
    let mut row = |key: &str, [x, y, z]: [f64; 3]| {
        text.push_str(&format!("{key} {x} {y} {z}\n"));
    };
    for node in structure.nodes() {
        row("v", node.position.coords.into());
    }
    for node in structure.nodes() {
        row("vn", node.axis.into());
    }
    text + &face_rows(structure, |number| format!("{number}//{number}"))
}

/// The faces, each corner as written for its number, counted from 1.
pub(super) fn face_rows(
    structure: &Structure,
    corner: impl Fn(usize) -> String,
) -> String {
    let mesh = structure.mesh();
    let row = |face| {
        let corners = mesh.corners(face).iter().map(|node| corner(node.index() + 1));
        format!("f {}\n", corners.collect::<Vec<_>>().join(" "))
    };
    mesh.faces().map(row).collect()
}
