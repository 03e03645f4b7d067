//! What is wrong with a surface or its file, with its place.

use crate::diagnostic::{Located, Place};
use miette::Diagnostic;
use thiserror::Error;

/// Why a file is no surface.
#[derive(Debug, Clone, PartialEq, Eq, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum FormatError {
    #[error("line {line} is no line of an STL file: `{text}`")]
    #[diagnostic(
        code(surface::bad_stl),
        help(
            "export the mesh again; corners are written `vertex X Y Z`, three in a loop"
        )
    )]
    StlLine { line: usize, text: String },

    #[error(
        "the file has {bytes} bytes; as binary STL of {triangles} triangles it would have \
         {needed}"
    )]
    #[diagnostic(
        code(surface::bad_stl),
        help("it was cut short, or is no STL file: export the mesh again")
    )]
    StlLength { bytes: usize, triangles: usize, needed: usize },

    #[error("line {line} of the PLY header cannot be read: `{text}`")]
    #[diagnostic(code(surface::bad_ply), help("export the mesh again as PLY 1.0"))]
    PlyHeader { line: usize, text: String },

    #[error(
        "PLY: the row of {element} {number} is cut short, or has something that is no number"
    )]
    #[diagnostic(code(surface::bad_ply), help("export the mesh again"))]
    PlyRow { element: String, number: usize },

    #[error("PLY: there is no {what}")]
    #[diagnostic(
        code(surface::bad_ply),
        help("vertices need x, y, z; faces need vertex_indices")
    )]
    PlyWithout { what: &'static str },
}

/// What [`clean`](super::clean) finds.
#[derive(Debug, Clone, PartialEq, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum SurfaceFinding {
    #[error("the surface has no face with an area")]
    #[diagnostic(
        code(surface::no_area),
        help("give a mesh of triangles or polygons; curves and points are not read")
    )]
    NoArea,

    #[error("vertex {vertex} has coordinates that are no numbers")]
    #[diagnostic(code(surface::no_number), help("export the mesh again"))]
    NoNumber { vertex: usize },

    #[error("face {face} names vertex {vertex}, but there are {vertices} vertices")]
    #[diagnostic(code(surface::no_such_vertex), help("export the mesh again"))]
    NoSuchVertex { face: usize, vertex: usize, vertices: usize },

    #[error(
        "{edges} edges have more than two faces; the first joins vertices {} and {}, near \
         ({:.1}, {:.1}, {:.1})",
        ends[0],
        ends[1],
        at[0],
        at[1],
        at[2]
    )]
    #[diagnostic(
        code(surface::not_manifold),
        help("keep one skin of the surface: no walls between, no doubled faces")
    )]
    NotManifold { edges: usize, ends: [usize; 2], at: [f64; 3] },

    #[error(
        "the surface has one side only: it closes on itself at face {face}, near ({:.1}, \
         {:.1}, {:.1})",
        at[0],
        at[1],
        at[2]
    )]
    #[diagnostic(
        code(surface::one_sided),
        help("cut it open along a line; fins need an upper and a lower side")
    )]
    OneSided { face: usize, at: [f64; 3] },

    #[error(
        "the surface is in {pieces} pieces; the largest has {percent:.1} % of the area, \
         another is near ({:.1}, {:.1}, {:.1})",
        at[0],
        at[1],
        at[2]
    )]
    #[diagnostic(
        code(surface::several_pieces),
        help(
            "keep one piece per file; if the pieces touch, their edges must share vertices \
             (weld them)"
        )
    )]
    SeveralPieces { pieces: usize, percent: f64, at: [f64; 3] },

    #[error(
        "{count} faces were turned to agree with the others; the first is face {face}"
    )]
    #[diagnostic(
        code(surface::faces_turned),
        severity(Advice),
        help("nothing has to be done")
    )]
    FacesTurned { count: usize, face: usize },

    #[error(
        "the surface is folded back on itself at {edges} edges, the first near ({:.1}, \
         {:.1}, {:.1})",
        at[0],
        at[1],
        at[2]
    )]
    #[diagnostic(
        code(surface::folded),
        severity(Warning),
        help(
            "faces that look against their neighbours are most often doubled or turned in; mend the mesh there"
        )
    )]
    Folded { edges: usize, at: [f64; 3] },

    #[error("{count} faces without area were left out; the first is face {face}")]
    #[diagnostic(
        code(surface::faces_without_area),
        severity(Advice),
        help("nothing has to be done")
    )]
    FacesWithoutArea { count: usize, face: usize },

    #[error("{count} vertices lay on others and were joined with them")]
    #[diagnostic(
        code(surface::vertices_joined),
        severity(Advice),
        help("nothing has to be done")
    )]
    VerticesJoined { count: usize },

    #[error("{count} vertices where only corners of faces met were split in two or more")]
    #[diagnostic(
        code(surface::fans_split),
        severity(Warning),
        help("faces that belong together must share an edge")
    )]
    FansSplit { count: usize },
}

impl Located for SurfaceFinding {
    fn place(&self) -> Place {
        match *self {
            Self::NoNumber { vertex } => Place::nodes([vertex]),
            Self::NotManifold { ends, .. } => Place::nodes(ends),
            Self::OneSided { face, .. }
            | Self::NoSuchVertex { face, .. }
            | Self::FacesTurned { face, .. }
            | Self::FacesWithoutArea { face, .. } => {
                Place { faces: vec![face], ..Place::default() }
            }
            _ => Place::default(),
        }
    }
}
