//! What the laser does on one sheet, independent of any file format.

use crate::geometry::{Contour, Point2};
use crate::ids::PartId;

/// What the laser does along a stroke; the order of the variants is the order of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Operation {
    /// Marks the surface: lettering, fold marks.
    Engrave,
    /// Cuts part of the way through, for folding.
    Score,
    /// Cuts a hole; before the outline, or the part may have dropped and shifted.
    CutInner,
    /// Cuts a part free.
    CutOuter,
}

impl Operation {
    /// All operations in the order of work.
    pub const ALL: [Self; 4] =
        [Self::Engrave, Self::Score, Self::CutInner, Self::CutOuter];

    /// The layer this operation is drawn on.
    pub const fn layer(self) -> &'static str {
        match self {
            Self::Engrave => "ENGRAVE",
            Self::Score => "SCORE",
            Self::CutInner => "CUT_INNER",
            Self::CutOuter => "CUT_OUTER",
        }
    }
}

/// A line the laser follows, in sheet coordinates: mm, y up, origin lower left.
#[derive(Debug, Clone, PartialEq)]
pub enum Path {
    /// An open chain of straight lines.
    Open(Vec<Point2>),
    /// A closed curve of lines and arcs.
    Closed(Contour),
}

impl Path {
    /// The path after `map` moved every corner; `map` must keep lengths and turning.
    pub fn moved(&self, map: impl Fn(Point2) -> Point2) -> Self {
        match self {
            Self::Open(points) => Self::Open(points.iter().map(|&p| map(p)).collect()),
            Self::Closed(contour) => Self::Closed(contour.moved(map)),
        }
    }
}

/// One operation along one path.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    /// What the laser does.
    pub operation: Operation,
    /// The part that the path belongs to.
    pub part: PartId,
    /// Where it goes.
    pub path: Path,
}

/// One sheet of stock with all that is to be done on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// File stem, such as `sheet-01`.
    pub id: String,
    /// Width, mm.
    pub width: f64,
    /// Height, mm.
    pub height: f64,
    /// In cutting order.
    pub strokes: Vec<Stroke>,
    /// The sheet's edge and its lettering, on layer `SHEET`, never cut.
    pub frame: Vec<Path>,
}
