//! The plates of a connector, whatever its kind: what they measure and where they sit.

/// The plates of a connector: one shape, cut as often as it has copies. Lengths in mm.
#[derive(Debug, Clone, PartialEq)]
pub struct Plates {
    /// Outer shape.
    pub form: PlateForm,
    /// Thickness of one.
    pub thickness: f64,
    /// Radius of the hole for the rod.
    pub hole: f64,
    /// Width and length of the slot that a fin stands in.
    pub slot: [f64; 2],
    /// Where they sit, from below.
    pub copies: Vec<PlacedPlate>,
    /// How many of them, from below, must lie there before the first fin comes.
    pub laid_first: usize,
}

/// The outer shape of a plate, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PlateForm {
    /// A disc around the axis.
    Disc {
        /// Its radius.
        radius: f64,
    },
    /// An eye around the axis with a tail along its fin.
    Eye {
        /// Radius of the eye, half the width of the tail.
        radius: f64,
        /// How far the tail reaches from the axis.
        tail: f64,
    },
}

impl PlateForm {
    /// Radius of the disc or the eye, mm.
    pub const fn radius(self) -> f64 {
        match self {
            Self::Disc { radius } | Self::Eye { radius, .. } => radius,
        }
    }
}

/// One plate of a node, placed across its axis.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedPlate {
    /// Height of its middle along the axis, from the base mesh, mm.
    pub height: f64,
    /// Turn of the part about the axis, counter-clockwise from the first fin, radians.
    pub bearing: f64,
    /// The fins it holds, by their place around the node.
    pub holds: Vec<usize>,
}
