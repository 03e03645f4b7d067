//! Structures as other programs write and read them: a pair of OBJ meshes, a mesh with its
//! axes as line segments, COMPAS JSON; and fins as quads. (`vn` is read and written with the mesh itself.)

use crate::geometry::{Point3, Vector3};
use crate::ids::{FinId, NodeId};
use crate::structure::obj::{face_rows, logical_lines, median_fin_length, vector};
use crate::structure::{AxisRule, Draft, ReadError, ReadNote, Structure};
use crate::units::Unit;
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// Axes from a second mesh with the same faces, whose vertices lie on them.
///
/// # Errors
/// [`ReadError::OtherMesh`] if its faces are others.
pub fn axes_toward(draft: &Draft, other: &Draft) -> Result<Vec<Vector3>, ReadError> {
    if draft.positions.len() != other.positions.len() || draft.faces != other.faces {
        return Err(ReadError::OtherMesh {
            nodes: draft.positions.len(),
            other_nodes: other.positions.len(),
        });
    }
    Ok(draft.positions.iter().zip(&other.positions).map(|(from, to)| to - from).collect())
}

/// A structure between two meshes of the same faces: nodes midway, fins from one to the
/// other.
///
/// # Errors
/// [`ReadError::OtherMesh`] if the faces differ.
pub fn between(lower: Draft, upper: &Draft) -> Result<Draft, ReadError> {
    let axes = axes_toward(&lower, upper)?;
    let depth: Vec<f64> = axes.iter().map(|axis| axis.norm() / 2.0).collect();
    let middle = |(from, axis): (&Point3, &Vector3)| from + axis / 2.0;
    let positions = lower.positions.iter().zip(&axes).map(middle).collect();
    Ok(Draft { positions, axes, below: depth.clone(), above: depth, ..lower })
}

/// Axes from the line segments (`v`, `v`, `l`) of an OBJ text, one per node in order; each
/// must start at its node.
///
/// # Errors
/// [`ReadError`] if there is not one per node, or one starts elsewhere.
pub fn axes_from_lines(
    draft: &Draft,
    text: &str,
    unit: Unit,
) -> Result<Vec<Vector3>, ReadError> {
    let (mut points, mut axes) = (Vec::new(), Vec::new());
    for (line, text) in logical_lines(text) {
        let mut words = text.split_whitespace();
        match words.next() {
            Some("v") => points.push(vector(line, words)? * unit.millimetres()),
            Some("l") => {
                let end = |word: Option<&str>| {
                    let number = word.and_then(|word| word.parse::<usize>().ok());
                    let point =
                        number.and_then(|n| points.get(n.wrapping_sub(1)).copied());
                    point.ok_or_else(|| ReadError::BadObj {
                        line,
                        message: "a line needs two vertices that were given before"
                            .into(),
                    })
                };
                let (from, to) = (end(words.next())?, end(words.next())?);
                axes.push((from, to - from));
            }
            _ => {}
        }
    }
    if axes.len() != draft.positions.len() {
        let (lines, nodes) = (axes.len(), draft.positions.len());
        return Err(ReadError::AxisLineCount { lines, nodes });
    }
    let starts = axes.iter().zip(&draft.positions).enumerate();
    for (node, ((from, axis), position)) in starts {
        let off_mm = (from - position.coords).norm();
        if off_mm > 0.01 * axis.norm() {
            return Err(ReadError::AxisLineElsewhere { node, off_mm });
        }
    }
    Ok(axes.into_iter().map(|(_, axis)| axis).collect())
}

/// Whether a text is a COMPAS mesh.
pub fn is_compas(text: &str) -> bool {
    #[derive(Deserialize)]
    struct Head {
        dtype: String,
    }
    serde_json::from_str(text).is_ok_and(|head: Head| head.dtype.ends_with("/Mesh"))
}

/// Reads a COMPAS mesh: `axis` of its vertices are node axes, edges whose `fin` is false
/// carry no fin. Keys of vertices become node numbers in their order. The file does not
/// name its unit.
///
/// # Errors
/// [`ReadError`] if the text is none.
pub fn read_compas(
    text: &str,
    unit: Unit,
    rule: AxisRule,
) -> Result<(Draft, Vec<ReadNote>), ReadError> {
    let value: Value = serde_json::from_str(text).unwrap_or_default();
    let (mut draft, given) = compas_mesh(&value)?;
    let from_normals = given.is_none() && rule == AxisRule::File;
    let rule = if from_normals { AxisRule::Normal } else { rule };
    let nodes = draft.positions.len();
    let notes = from_normals.then_some(ReadNote::AxesFromNormals { nodes });
    let ruled = rule.axes(&draft.positions, &draft.faces);
    draft.axes = ruled.or(given).unwrap_or_default();
    Ok((draft.scaled(unit.millimetres()), notes.into_iter().collect()))
}

/// The mesh, and its axes if there are any.
fn compas_mesh(value: &Value) -> Result<(Draft, Option<Vec<Vector3>>), ReadError> {
    let data = &value["data"];
    let missing = |what: &str| ReadError::BadCompas { what: what.into() };
    let vertices =
        keyed(data["vertex"].as_object().ok_or_else(|| missing("data.vertex"))?);
    let node: BTreeMap<i64, usize> =
        vertices.keys().enumerate().map(|(node, &key)| (key, node)).collect();
    let mut draft = Draft { name: name(value), ..Draft::default() };
    let mut axes = Vec::new();
    for (key, vertex) in &vertices {
        let part = |axis: &str| vertex[axis].as_f64();
        let point = (part("x"), part("y"), part("z"));
        let (Some(x), Some(y), Some(z)) = point else {
            return Err(missing(&format!("x, y, z of vertex {key}")));
        };
        draft.positions.push(Point3::new(x, y, z));
        axes.extend(triple(&vertex["axis"]).map(Vector3::from));
    }
    for (key, face) in
        &keyed(data["face"].as_object().ok_or_else(|| missing("data.face"))?)
    {
        let corners = face.as_array().into_iter().flatten();
        let corners = corners.map(|k| k.as_i64().and_then(|k| node.get(&k)).copied());
        let corners: Option<Vec<usize>> = corners.collect();
        draft
            .faces
            .push(corners.ok_or_else(|| missing(&format!("corners of face {key}")))?);
    }
    let nodes = draft.positions.len();
    let axes = match axes.len() {
        0 => None,
        count if count == nodes => Some(axes),
        count => return Err(missing(&format!("`axis` of {} vertices", nodes - count))),
    };
    draft.fins = fins_of_edges(&data["edgedata"], &node, &draft);
    let depth = 0.35 * median_fin_length(&draft);
    Ok((draft.with_depth(depth, depth), axes))
}

fn name(value: &Value) -> String {
    value["data"]["attributes"]["name"].as_str().unwrap_or_default().to_owned()
}

fn keyed(map: &serde_json::Map<String, Value>) -> BTreeMap<i64, &Value> {
    map.iter().filter_map(|(key, value)| Some((key.parse().ok()?, value))).collect()
}

fn triple(value: &Value) -> Option<[f64; 3]> {
    let list = value.as_array()?;
    let at = |k: usize| list.get(k).and_then(Value::as_f64);
    Some([at(0)?, at(1)?, at(2)?])
}

/// Edges that are not said to carry no fin; `None` if nothing is said.
fn fins_of_edges(
    edges: &Value,
    node: &BTreeMap<i64, usize>,
    draft: &Draft,
) -> Option<Vec<[usize; 2]>> {
    let said = edges.as_object().into_iter().flatten().filter_map(|(key, data)| {
        let mut keys = key.trim_matches(['(', ')']).split(',');
        let mut next = || node.get(&keys.next()?.trim().parse().ok()?).copied();
        let (i, j) = (next()?, next()?);
        Some((FinId::between(i.into(), j.into()), data["fin"].as_bool()?))
    });
    let said: BTreeMap<FinId, bool> = said.collect();
    let carries = |fin: &FinId| said.get(fin).copied().unwrap_or(true);
    let fins = || draft.fin_ids().into_iter().filter(carries);
    (!said.is_empty()).then(|| fins().map(|fin| fin.ends().map(NodeId::index)).collect())
}

/// Two OBJ meshes with the same faces, through the lower and the upper ends of the axes.
pub fn write_pair(structure: &Structure) -> [String; 2] {
    let mesh = |title: &str, ends: Vec<Point3>| {
        let mut text = format!("# {}, {title} ends of the axes (mm)\n", structure.name());
        text.extend(ends.iter().map(vertex_row));
        text + &face_rows(structure, |number| number.to_string())
    };
    let nodes = || structure.nodes().iter();
    [
        mesh("lower", nodes().map(|node| node.bottom()).collect()),
        mesh("upper", nodes().map(|node| node.top()).collect()),
    ]
}

/// The base mesh as OBJ, and its axes as line segments in the order of its vertices.
pub fn write_lines(structure: &Structure) -> [String; 2] {
    let name = structure.name();
    let mut mesh = format!("# {name}, base mesh (mm)\n");
    let mut lines = format!("# {name}, node axes in vertex order (mm)\n");
    for (k, node) in structure.nodes().iter().enumerate() {
        mesh += &vertex_row(&node.position);
        lines += &vertex_row(&node.position);
        lines += &vertex_row(&node.top());
        lines += &format!("l {} {}\n", 2 * k + 1, 2 * k + 2);
    }
    [mesh + &face_rows(structure, |number| number.to_string()), lines]
}

/// Fins as separate quads in one OBJ.
pub fn write_fins(structure: &Structure) -> String {
    let mut text = format!("# {}, fins (mm)\n", structure.name());
    for (k, &fin) in structure.fins().iter().enumerate() {
        text.extend(structure.corners(fin.ends()).iter().map(vertex_row));
        text += &format!("f {} {} {} {}\n", 4 * k + 1, 4 * k + 2, 4 * k + 3, 4 * k + 4);
    }
    text
}

/// COMPAS mesh JSON with `axis` on vertices and `fin` on edges.
pub fn write_compas(structure: &Structure) -> String {
    let vertices = structure.nodes().iter().enumerate().map(|(k, node)| {
        let [x, y, z]: [f64; 3] = node.position.coords.into();
        let axis: [f64; 3] = node.axis.into();
        (k.to_string(), json!({"x": x, "y": y, "z": z, "axis": axis}))
    });
    let mesh = structure.mesh();
    let faces = mesh.faces();
    let faces = faces.map(|face| (face.to_string(), json!(mesh.corners(face))));
    let fins: BTreeSet<FinId> = structure.fins().iter().copied().collect();
    let edges = mesh.edges().map(|edge| {
        let [i, j] = mesh.ends(edge);
        let fin = fins.contains(&FinId::between(i, j));
        (format!("({i}, {j})"), json!({"fin": fin}))
    });
    let value = json!({
        "dtype": "compas.datastructures/Mesh",
        "data": {
            "attributes": {"name": structure.name(), "units": "mm"},
            "default_vertex_attributes": {"x": 0.0, "y": 0.0, "z": 0.0, "axis": null},
            "default_edge_attributes": {"fin": true},
            "default_face_attributes": {},
            "vertex": vertices.collect::<serde_json::Map<_, _>>(),
            "face": faces.collect::<serde_json::Map<_, _>>(),
            "facedata": {},
            "edgedata": edges.collect::<serde_json::Map<_, _>>(),
            "max_vertex": structure.nodes().len() as i64 - 1,
            "max_face": mesh.face_count() as i64 - 1,
        },
    });
    format!("{value}\n")
}

fn vertex_row(p: &Point3) -> String {
    format!("v {} {} {}\n", p.x, p.y, p.z)
}
