//! One end of a fin in its own frame: what it stands in is cut there.
//!
//! Seen in the fin's plane, `s` runs from the axis into the fin and `z` along the axis.

use crate::geometry::{Point2, Vector2};
use crate::parts::unfold::FlatAxis;

/// One end of a fin in its own frame.
pub(crate) struct EndFrame<'a> {
    pub axis: &'a FlatAxis,
    /// Unit vector across the axis, into the fin.
    pub inward: Vector2,
    /// Rise of the bottom and top edge per length across the axis.
    pub rise: [f64; 2],
}

impl<'a> EndFrame<'a> {
    /// At a left (0) or right (1) end.
    pub(crate) fn new(axis: &'a FlatAxis, end: usize, rise: [f64; 2]) -> Self {
        let inward = if end == 0 { axis.right() } else { -axis.right() };
        Self { axis, inward, rise }
    }

    pub(crate) fn at(&self, s: f64, z: f64) -> Point2 {
        self.axis.foot + self.inward * s + self.axis.up * z
    }

    /// On the bottom (0) or top (1) edge.
    pub(crate) fn on_edge(&self, s: f64, edge: usize) -> Point2 {
        let start = [-self.axis.below, self.axis.above][edge];
        self.at(s, start + self.rise[edge] * s)
    }

    /// 1 at a right end, where the way up runs counter-clockwise, -1 at a left one.
    pub(crate) fn turn(&self) -> f64 {
        -self.inward.dot(&self.axis.right()).signum()
    }
}
