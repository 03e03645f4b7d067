//! A part: one flat shape to be cut, with its marks and its way back into space.

use crate::geometry::{Point2, Region};
use crate::parts::joint::Slit;
use crate::parts::unfold::{FlatAxis, Fold};

/// A flat shape of sheet material, nominal: kerf is not in it yet. Its labelled face
/// looks at the reader.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Name, engraved on it.
    pub id: String,
    /// How many are cut.
    pub quantity: usize,
    /// Its shape.
    pub region: Region,
    /// Marks on its labelled face.
    pub marks: Vec<Mark>,
    /// What it is in the structure.
    pub body: Body,
}

impl Part {
    /// Length and height of its shape, mm.
    pub fn extent(&self) -> [f64; 2] {
        let points = || self.region.outline.vertices.iter().map(|vertex| vertex.point);
        let low = points().reduce(|a, b| a.inf(&b)).unwrap_or_default();
        let high = points().fold(low, |a, b| a.sup(&b));
        [high.x - low.x, high.y - low.y]
    }
}

/// What a part is in the structure.
#[derive(Debug, Clone, PartialEq)]
pub enum Body {
    /// A run of fins.
    Strip(StripBody),
    /// A piece to try a material with, no part of a structure.
    Coupon,
}

/// A run of fins, flat.
#[derive(Debug, Clone, PartialEq)]
pub struct StripBody {
    /// Index of the strip in the structure.
    pub strip: usize,
    /// Where the node axes lie.
    pub axes: Vec<FlatAxis>,
    /// One per node between two fins of the strip.
    pub folds: Vec<Fold>,
    /// Slits with the part that each receives.
    pub slits: Vec<(Slit, String)>,
    /// Fins that are cut in two here, by their nodes in the direction of travel.
    pub splices: Vec<[usize; 2]>,
    /// Whether first and last axis are one in space.
    pub closed: bool,
    /// Place in the order of assembly, from 0; pieces of one strip share it.
    pub rank: usize,
}

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
