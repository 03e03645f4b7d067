//! DXF, SVG and PDF as curves on layers: read, never judged.
//!
//! Tolerant of what CAD programs make of a file when they save it: other kinds of
//! polylines, single lines and arcs, other units, moved layers of the same name. What
//! cannot be taken for a cut line (splines, blocks, text) is counted, never guessed at.

mod bezier;
mod chain;
mod curves;
mod dxf;
mod gaps;
mod overlap;
mod parts;
mod pdf;
mod ring;
mod spline;
mod svg;
mod text;
mod transform;

use crate::geometry::{Contour, Point2, Vertex};
use crate::tolerance::{ARC_SAGITTA_MM, NO_LENGTH_MM};
use miette::Diagnostic;
use std::collections::BTreeMap;
use thiserror::Error;

pub use chain::joined;
pub use dxf::read_dxf;
pub use gaps::Gap;
pub use parts::{Drawn, DrawnPart, Purpose, Rules, drawn_parts};
pub use pdf::read_pdf;
pub use svg::read_svg;

/// Why a file is no drawing.
#[derive(Debug, Clone, PartialEq, Eq, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub enum DrawingError {
    #[error("it is a binary DXF")]
    #[diagnostic(code(proof::unreadable_file), help("save it as ASCII DXF"))]
    BinaryDxf,

    #[error("line {line}: {message}")]
    #[diagnostic(
        code(proof::unreadable_file),
        help("make the job again, or save the file again from the CAD program")
    )]
    Dxf { line: usize, message: String },

    #[error("{message}")]
    #[diagnostic(
        code(proof::unreadable_file),
        help("make the job again, or save the file again from the drawing program")
    )]
    Other { message: String },
}

/// A layer that the reader of a drawing looks for, by name or by colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KnownLayer {
    /// Its name; case does not count.
    pub name: &'static str,
    /// The colour of its lines where layers have no names.
    pub rgb: [u8; 3],
}

/// How a drawing is to be read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading<'a> {
    /// The layers to look for.
    pub known: &'a [KnownLayer],
    /// Millimetres in a unit of the drawing, whatever the file says.
    pub millimetres: Option<f64>,
    /// User units of SVG in an inch; 96 as in browsers.
    pub dpi: f64,
}

impl<'a> Reading<'a> {
    /// As the file says, looking for these layers.
    pub const fn of(known: &'a [KnownLayer]) -> Self {
        Self { known, millimetres: None, dpi: 96.0 }
    }
}

/// Where a line stands in the drawing, in the drawing's own words.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Source {
    /// Name of its layer or labelled group; empty if there is none.
    pub name: String,
    /// Colour of its stroke, or else of its fill.
    pub rgb: Option<[u8; 3]>,
}

/// A line on a layer, mm, y up.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Name of the known layer; empty if it is on none.
    pub layer: &'static str,
    /// Its own layer and colour.
    pub source: Source,
    /// Its corners.
    pub vertices: Vec<Vertex>,
    /// Whether the last corner leads back to the first.
    pub closed: bool,
}

impl Curve {
    /// The curve as a closed one.
    pub fn contour(&self) -> Contour {
        Contour { vertices: self.vertices.clone() }
    }

    /// Length of the line, mm.
    pub fn length(&self) -> f64 {
        let steps = self.vertices.len() - usize::from(!self.closed);
        self.contour().segments().take(steps).map(|segment| segment.length()).sum()
    }
}

/// One sheet as it was drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drawing {
    /// All lines; those on cut layers are joined where their ends meet.
    pub curves: Vec<Curve>,
    /// Single lines that lay on another one; they are not among the curves.
    pub doubled: Vec<Curve>,
    /// What could not be read as lines, by kind and layer, with its count.
    pub unread: BTreeMap<(String, &'static str), usize>,
    /// Lines on what is switched off, by the name of their layer, with their count; they
    /// are not among the curves.
    pub hidden: BTreeMap<String, usize>,
    /// Lines in paper space; they are not among the curves.
    pub paper: usize,
    /// Whether the file says in which unit it is.
    pub says_unit: bool,
}

/// The known layer of this name, whatever its case.
fn layer_named(known: &[KnownLayer], name: &str) -> Option<&'static str> {
    let mut names = known.iter().map(|layer| layer.name);
    names.find(|known| known.eq_ignore_ascii_case(name))
}

/// The known layer of this colour.
fn layer_coloured(known: &[KnownLayer], rgb: [u8; 3]) -> Option<&'static str> {
    known.iter().find(|layer| layer.rgb == rgb).map(|layer| layer.name)
}

/// Whether lines on the layer are cut.
pub fn is_cut(layer: &str) -> bool {
    layer.starts_with("CUT_")
}

/// A pen that collects curves as drawing programs describe them.
struct Pen {
    /// How far curves may be off, in its units.
    tolerance: f64,
    vertices: Vec<Vertex>,
    curves: Vec<(Vec<Vertex>, bool)>,
}

impl Default for Pen {
    fn default() -> Self {
        Self::with_tolerance(ARC_SAGITTA_MM)
    }
}

impl Pen {
    const fn with_tolerance(tolerance: f64) -> Self {
        Self { tolerance, vertices: Vec::new(), curves: Vec::new() }
    }

    fn at(&self) -> Point2 {
        self.vertices.last().map_or_else(Point2::origin, |vertex| vertex.point)
    }

    fn start(&self) -> Point2 {
        self.vertices.first().map_or_else(Point2::origin, |vertex| vertex.point)
    }

    fn move_to(&mut self, point: Point2) {
        self.lift();
        self.vertices.push(Vertex::line(point));
    }

    /// A line, or an arc if there is a bulge.
    fn line_to(&mut self, point: Point2, bulge: f64) {
        if let Some(last) = self.vertices.last_mut() {
            last.bulge = bulge;
        }
        self.vertices.push(Vertex::line(point));
    }

    fn curve_to(&mut self, [a, b, to]: [Point2; 3]) {
        for (point, bulge) in bezier::arcs([self.at(), a, b, to], self.tolerance) {
            self.line_to(point, bulge);
        }
    }

    /// Back to the start, where the pen stays.
    fn close(&mut self) {
        let start = self.start();
        let back = |v: &Vertex| (v.point - start).norm() < NO_LENGTH_MM;
        if self.vertices.len() > 2 && self.vertices.last().is_some_and(back) {
            self.vertices.pop();
        }
        if !self.vertices.is_empty() {
            self.curves.push((std::mem::take(&mut self.vertices), true));
            self.vertices.push(Vertex::line(start));
        }
    }

    /// Ends a line: closed if it has come back to its start.
    fn end(&mut self) {
        let back = (self.at() - self.start()).norm() < NO_LENGTH_MM;
        if self.vertices.len() > 2 && back { self.close() } else { self.lift() }
    }

    /// Ends an open line; a single point is none.
    fn lift(&mut self) {
        let vertices = std::mem::take(&mut self.vertices);
        if vertices.len() > 1 {
            self.curves.push((vertices, false));
        }
    }
}

/// Layers for the tests of the readers.
#[cfg(test)]
const LAYERS: [KnownLayer; 4] = [
    KnownLayer { name: "ENGRAVE", rgb: [0, 255, 255] },
    KnownLayer { name: "CUT_INNER", rgb: [0, 0, 255] },
    KnownLayer { name: "CUT_OUTER", rgb: [255, 0, 0] },
    KnownLayer { name: "SHEET", rgb: [128, 128, 128] },
];
