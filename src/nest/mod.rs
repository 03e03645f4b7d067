//! Parts on sheets of stock.

use crate::geometry::Point2;

/// A part as the nester sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Name for messages.
    pub name: String,
    /// The curve that must keep its distance (the drawn cut line, arcs flattened),
    /// counter-clockwise, mm.
    pub outline: Vec<Point2>,
    /// Which turns are allowed.
    pub turns: Turns,
}

/// How a part may be turned on the sheet.
#[derive(Debug, Clone, PartialEq)]
pub enum Turns {
    /// By any angle.
    Free,
    /// Only by these angles, radians.
    Only(Vec<f64>),
}

/// A size of sheet one can buy or has in the rack.
#[derive(Debug, Clone, PartialEq)]
pub struct Stock {
    /// Width, mm.
    pub width: f64,
    /// Height, mm.
    pub height: f64,
    /// Strip along the sheet's edge that stays free, mm.
    pub margin: f64,
    /// Least distance between two parts, mm.
    pub spacing: f64,
    /// How many there are; `None` is as many as needed.
    pub count: Option<usize>,
}

/// Where a part lies: turned about its origin, then moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Index into the shapes given.
    pub shape: usize,
    /// Counter-clockwise turn, radians.
    pub angle: f64,
    /// Then moved right, mm.
    pub x: f64,
    /// Then moved up, mm.
    pub y: f64,
}

/// One sheet of a layout.
#[derive(Debug, Clone, PartialEq)]
pub struct NestedSheet {
    /// Index into the stock given.
    pub stock: usize,
    /// What lies on it.
    pub placements: Vec<Placement>,
}

/// All parts on sheets.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// In order of cutting.
    pub sheets: Vec<NestedSheet>,
}
