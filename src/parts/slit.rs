//! A slit on a node axis, into which another part comes.

use crate::ids::NodeId;
/// Which edge of a strip a slit is open to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Opening {
    /// The edge at the axes' upper ends.
    Top,
    /// The edge at the axes' lower ends.
    Bottom,
}

/// A slit on a node axis of a strip. Lengths in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slit {
    /// The node.
    pub node: NodeId,
    /// The strip that the slit receives, by its index.
    pub partner: usize,
    /// Which edge it is open to.
    pub from: Opening,
    /// From the axis to the wall on the side of the previous node.
    pub before: f64,
    /// From the axis to the wall on the side of the next node.
    pub after: f64,
    /// From the edge along the axis to where the full-width walls end.
    pub depth: f64,
    /// Smallest of the four angles between the fins, radians.
    pub crossing: f64,
}

impl Slit {
    /// Distance between the walls.
    pub fn width(&self) -> f64 {
        self.before + self.after
    }

    /// From the axis to the middle of the slit, positive toward the next node.
    pub fn offset(&self) -> f64 {
        (self.after - self.before) / 2.0
    }
}
