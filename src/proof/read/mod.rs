//! The written files back into curves on layers: DXF, SVG and PDF.
//!
//! Tolerant of what CAD programs make of a file when they save it: other kinds of
//! polylines, single lines and arcs, other units, moved layers of the same name. What
//! cannot be taken for a cut line (splines, blocks, text) is counted, never guessed at.

mod bezier;
mod chain;
mod curves;
mod dxf;
mod pdf;
mod svg;

use crate::export::LAYERS;
use crate::geometry::{Contour, Point2, Vertex};
use miette::Diagnostic;
use std::collections::BTreeMap;
use thiserror::Error;

pub(super) use chain::joined;
pub(super) use dxf::read_dxf;
pub(super) use pdf::read_pdf;
pub(super) use svg::read_svg;

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

/// A line on a layer, mm, y up.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Curve {
    /// Name of the layer; empty if it has none of ours.
    pub layer: &'static str,
    /// Its corners.
    pub vertices: Vec<Vertex>,
    /// Whether the last corner leads back to the first.
    pub closed: bool,
}

impl Curve {
    /// The curve as a closed one.
    pub(super) fn contour(&self) -> Contour {
        Contour { vertices: self.vertices.clone() }
    }

    /// Length of the line, mm.
    pub(super) fn length(&self) -> f64 {
        let steps = self.vertices.len() - usize::from(!self.closed);
        self.contour().segments().take(steps).map(|segment| segment.length()).sum()
    }
}

/// One sheet as it was drawn.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Drawing {
    /// All lines; those on cut layers are joined where their ends meet.
    pub curves: Vec<Curve>,
    /// Single lines that lay on another one; they are not among the curves.
    pub doubled: Vec<Curve>,
    /// What could not be read as lines, by kind and layer, with its count.
    pub unread: BTreeMap<(String, &'static str), usize>,
    /// Whether the file says in which unit it is.
    pub says_unit: bool,
}

/// Our layer of this name, whatever its case.
fn layer_named(name: &str) -> Option<&'static str> {
    LAYERS.iter().map(|layer| layer.name).find(|known| known.eq_ignore_ascii_case(name))
}

/// Our layer of this colour.
fn layer_coloured(rgb: [u8; 3]) -> Option<&'static str> {
    LAYERS.iter().find(|layer| layer.rgb == rgb).map(|layer| layer.name)
}

/// Whether lines on the layer are cut.
pub(super) fn is_cut(layer: &str) -> bool {
    layer.starts_with("CUT_")
}

/// A pen that collects curves as drawing programs describe them.
#[derive(Default)]
struct Pen {
    vertices: Vec<Vertex>,
    curves: Vec<(Vec<Vertex>, bool)>,
}

impl Pen {
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
        for (point, bulge) in bezier::arcs([self.at(), a, b, to]) {
            self.line_to(point, bulge);
        }
    }

    /// Back to the start, where the pen stays.
    fn close(&mut self) {
        let start = self.start();
        let back = |v: &Vertex| (v.point - start).norm() < crate::tolerance::NO_LENGTH_MM;
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
        let back = (self.at() - self.start()).norm() < crate::tolerance::NO_LENGTH_MM;
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
