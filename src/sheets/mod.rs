//! From nested parts to what the laser does, independent of any file format.
//!
//! Here the kerf comes in: outlines grow by half of it, holes shrink, so that the part
//! left over has its nominal size. Nothing else in the crate knows the kerf.

mod frame;
mod kerf;
mod sheet;

pub use frame::Frame;
pub use kerf::Kerf;
pub use sheet::{Operation, Path, Sheet, Stroke};

use crate::geometry::{Contour, Point2, Vector2, trig};
use crate::ids::PartId;
use crate::nest::{Layout, NestedSheet, Placement, Stock};
use crate::parts::{MarkKind, Part};

/// What goes onto sheets.
pub struct Laying<'a> {
    /// The parts, as the layout counts them.
    pub parts: &'a [Part],
    /// Where they lie.
    pub layout: &'a Layout,
    /// The stock that the layout chose from.
    pub stock: &'a [Stock],
    /// What the laser burns away.
    pub kerf: Kerf,
    /// What is written on the sheet's edge; `None` leaves the sheet bare.
    pub frame: Option<&'a Frame>,
}

/// All sheets with their strokes in cutting order.
pub fn sheets(laying: &Laying) -> Vec<Sheet> {
    let count = laying.layout.sheets.len();
    let nested = laying.layout.sheets.iter().enumerate();
    nested.map(|(index, sheet)| laying.sheet(index, count, sheet)).collect()
}

impl Laying<'_> {
    fn sheet(&self, index: usize, count: usize, nested: &NestedSheet) -> Sheet {
        let stock = &self.stock[nested.stock];
        let mut strokes: Vec<Stroke> =
            near_first(nested).into_iter().flat_map(|p| self.strokes(p)).collect();
        // Stable: within an operation parts stay in their order.
        strokes.sort_by_key(|stroke| stroke.operation);
        let frame =
            self.frame.map_or_else(Vec::new, |frame| frame.paths(stock, index, count));
        Sheet {
            id: format!("sheet-{:02}", index + 1),
            width: stock.width,
            height: stock.height,
            strokes,
            frame,
        }
    }

    fn strokes(&self, placement: &Placement) -> Vec<Stroke> {
        let part = &self.parts[placement.shape];
        let id = PartId::new(placement.shape);
        let stroke = |operation, path| Stroke { operation, part: id, path };
        let cut = |operation, contour: &Contour| {
            let contour = self.kerf.compensated(contour);
            stroke(operation, Path::Closed(contour.moved(|p| placed(placement, p))))
        };
        let marks = part.marks.iter().flat_map(|mark| {
            let operation = match mark.kind {
                MarkKind::Engrave => Operation::Engrave,
                MarkKind::Score => Operation::Score,
            };
            mark.strokes.iter().map(move |line| {
                let line = line.iter().map(|&p| placed(placement, p)).collect();
                stroke(operation, Path::Open(line))
            })
        });
        let holes = part.region.holes.iter().map(|hole| cut(Operation::CutInner, hole));
        let outline = cut(Operation::CutOuter, &part.region.outline);
        marks.chain(holes).chain([outline]).collect()
    }
}

/// Where a point of a part lies on the sheet.
pub fn placed(placement: &Placement, p: Point2) -> Point2 {
    let (sin, cos) = (trig::sin(placement.angle), trig::cos(placement.angle));
    Point2::new(cos * p.x - sin * p.y + placement.x, sin * p.x + cos * p.y + placement.y)
}

/// Parts in the order of cutting: from the sheet's origin always on to the nearest.
fn near_first(sheet: &NestedSheet) -> Vec<&Placement> {
    let mut left: Vec<&Placement> = sheet.placements.iter().collect();
    let mut order = Vec::with_capacity(left.len());
    let mut at = Vector2::zeros();
    while !left.is_empty() {
        let off = |p: &Placement| (Vector2::new(p.x, p.y) - at).norm_squared();
        let nearest =
            (0..left.len()).min_by(|&a, &b| off(left[a]).total_cmp(&off(left[b])));
        let next = left.remove(nearest.unwrap_or(0));
        at = Vector2::new(next.x, next.y);
        order.push(next);
    }
    order
}
