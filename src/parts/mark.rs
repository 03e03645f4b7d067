//! Marks on parts: what they are and how they are wished for.

use crate::geometry::Point2;

/// Something drawn on a part.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// How it is made.
    pub kind: MarkKind,
    /// Chains of straight lines in part coordinates.
    pub strokes: Vec<Vec<Point2>>,
}

/// How a mark is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MarkKind {
    /// Burnt into the surface.
    Engrave,
    /// Cut part of the way through.
    Score,
}

/// How parts are marked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marking {
    /// Height of capital letters, mm.
    pub height: f64,
    /// How lines are drawn along which a strip folds, if at all.
    pub folds: Option<MarkKind>,
}

/// Least distance between a mark and a cut, mm.
pub(crate) const GAP: f64 = 1.0;
