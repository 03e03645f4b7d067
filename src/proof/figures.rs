//! What was measured, as it is written into reports.

use serde::Serialize;

/// A node axis, from the parts that meet there.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NodeFigure {
    /// The node.
    pub node: usize,
    /// The parts that have its axis.
    pub parts: Vec<String>,
    /// Largest distance between two of their axes, mm.
    pub gap_mm: f64,
    /// Largest distance from the structure's axis, mm.
    pub off_mm: f64,
}

/// A slit as it was drawn.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SlitFigure {
    /// The part it is cut into.
    pub part: String,
    /// The node on whose axis it lies.
    pub node: usize,
    /// The part that comes in.
    pub partner: String,
    /// Between its walls, across the axis, mm.
    pub width_mm: f64,
    /// From the edge to where the walls end, mm.
    pub depth_mm: f64,
    /// Its middle from where the structure needs it, mm.
    pub off_mm: f64,
    /// Room beside what comes in, mm.
    pub play_mm: f64,
    /// How much farther the pair reaches than the axis is long, mm; `None` if its partner
    /// has no slit.
    pub reach_mm: Option<f64>,
}

/// A part as it was drawn.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PartFigure {
    /// Its name.
    pub part: String,
    /// Which of its copies.
    pub copy: usize,
    /// The file it was found in.
    pub file: String,
    /// From where it is listed, mm.
    pub moved_mm: f64,
    /// Kerf in its line, mm.
    pub kerf_mm: f64,
    /// Largest distance of its outline from its shape, mm.
    pub outline_mm: f64,
}

/// To a millionth, as files carry lengths.
pub(super) fn micro(value: f64) -> f64 {
    (value * 1e6).round() / 1e6 + 0.0
}
