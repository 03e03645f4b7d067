//! What the readers of structures say: why a text is none, and what in it was not read.

use crate::diagnostic::{Located, Place};
use miette::Diagnostic;
use thiserror::Error;

/// Why a file is no structure at all.
#[derive(Debug, Clone, PartialEq, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum ReadError {
    #[error("the file is empty")]
    #[diagnostic(
        code(read::empty_file),
        help("export the mesh again; `finwright example write vault` gives a sample")
    )]
    EmptyFile,

    #[error("line {line}, column {column}: {message}")]
    #[diagnostic(
        code(read::bad_json),
        help(
            "the format is described in docs/structure.md; `finwright example write vault` \
              gives a sample"
        )
    )]
    BadJson { line: usize, column: usize, message: String },

    #[error("the file says \"format\": {format}, \"version\": {version}")]
    #[diagnostic(
        code(read::other_format),
        help("\"format\": \"finwright-structure\", \"version\": 1 can be read here")
    )]
    OtherFormat { format: String, version: String },

    #[error("line {line}: {message}")]
    #[diagnostic(
        code(read::bad_obj),
        help("export the mesh again as plain OBJ with `v`, `vn` and `f` lines")
    )]
    BadObj { line: usize, message: String },

    #[error(
        "there is no face (`f` line); vertices: {vertices}, curves, lines and points: {other}"
    )]
    #[diagnostic(
        code(read::no_faces),
        help(
            "export the mesh itself, as polygons; polylines, curves and NURBS surfaces have \
             no faces (in Rhino: QuadRemesh or Mesh first)"
        )
    )]
    NoFaces { vertices: usize, other: usize },

    #[error("line {line}: vertex {} of the file has two different axes", node + 1)]
    #[diagnostic(
        code(read::conflicting_axes),
        help("every corner of a vertex must name the same `vn`; or use `--axes normal`")
    )]
    ConflictingAxes { line: usize, node: usize },

    #[error("vertex {} of the file has another axis than one it would be joined to", node + 1)]
    #[diagnostic(
        code(read::axes_of_welded),
        help("give both the same `vn`, or use `--axes normal` with `--weld`")
    )]
    AxesOfWelded { node: usize },

    #[error(
        "vertices without an axis: {missing} of {nodes}, the first is vertex {} of the file",
        node + 1
    )]
    #[diagnostic(
        code(read::missing_axes),
        help("give every corner a `vn`, or use `--axes normal`")
    )]
    MissingAxes { missing: usize, nodes: usize, node: usize },

    #[error("the depth lists {count} numbers for {nodes} nodes")]
    #[diagnostic(code(read::depth_count), help("give one number, or one per node"))]
    DepthCount { count: usize, nodes: usize },

    #[error(
        "the second mesh has {other_nodes} vertices or other faces; the first has {nodes}"
    )]
    #[diagnostic(
        code(read::other_mesh),
        help(
            "both meshes must have the same faces in the same order; export them together"
        )
    )]
    OtherMesh { nodes: usize, other_nodes: usize },

    #[error("{lines} lines are given for {nodes} nodes")]
    #[diagnostic(
        code(read::axis_line_count),
        help(
            "one line segment per vertex is needed, in the order of the mesh's vertices"
        )
    )]
    AxisLineCount { lines: usize, nodes: usize },

    #[error("the axis line of vertex {} of the file starts {off_mm:.3} mm away from it", node + 1)]
    #[diagnostic(
        code(read::axis_line_elsewhere),
        help(
            "each segment must start at its vertex, in the order of the mesh's vertices"
        )
    )]
    AxisLineElsewhere { node: usize, off_mm: f64 },

    #[error("the COMPAS mesh lacks {what}")]
    #[diagnostic(
        code(read::bad_compas),
        help(
            "write it with `Mesh.to_json`; every vertex needs x, y, z and, if any, an `axis`"
        )
    )]
    BadCompas { what: String },
}

impl Located for ReadError {
    fn place(&self) -> Place {
        match *self {
            Self::BadJson { line, .. } | Self::BadObj { line, .. } => Place::line(line),
            Self::ConflictingAxes { line, node } => Place::line(line).at(node),
            Self::MissingAxes { node, .. } | Self::AxesOfWelded { node } => {
                Place::nodes([node])
            }
            _ => Place::default(),
        }
    }
}

/// Something in a file that its maker may have meant otherwise.
#[derive(Debug, Clone, PartialEq, Eq, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum ReadNote {
    #[error("no node axes were given; {nodes} axes were taken from vertex normals")]
    #[diagnostic(
        code(structure::axes_from_normals),
        severity(Warning),
        help(
            "fins may not be planar: give axes as `vn`, or `--axes X,Y,Z` or \
             `--axes point:X,Y,Z`, which make every fin planar"
        )
    )]
    AxesFromNormals { nodes: usize },

    #[error("there is no key \"{found}\"; it was not read")]
    #[diagnostic(
        code(read::misspelt_key),
        severity(Warning),
        help("the nearest known key is \"{nearest}\"")
    )]
    MisspeltKey { found: String, nearest: String },

    #[error("the key \"{found}\" means nothing to finwright and was not read")]
    #[diagnostic(
        code(read::unknown_key),
        severity(Advice),
        help(
            "notes of your own may stand in a structure; docs/structure.md lists the keys"
        )
    )]
    UnknownKey { found: String },

    #[error("curves, lines and points not read: {count}, the first in line {line}")]
    #[diagnostic(
        code(read::not_a_face),
        severity(Advice),
        help("only `v`, `vn` and `f` count; a strip or a fin needs faces beside it")
    )]
    NotAFace { count: usize, line: usize },

    #[error("{vertices} vertices of the file became {nodes} nodes, numbered anew")]
    #[diagnostic(
        code(read::welded),
        severity(Advice),
        help("those nearer than `--weld` to an earlier one were joined to it")
    )]
    Welded { vertices: usize, nodes: usize },
}

impl Located for ReadNote {
    fn place(&self) -> Place {
        match *self {
            Self::NotAFace { line, .. } => Place::line(line),
            _ => Place::default(),
        }
    }
}
