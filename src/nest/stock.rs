//! What parts are laid on: sheets one can buy, remnants from the rack, and what already
//! lies on them.

use crate::geometry::Point2;
use crate::geometry::ring::area;
use crate::nest::Placement;

/// A size of sheet one can buy or has in the rack, or a remnant.
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
    /// What one costs, in any unit; [`Stock::new`] takes the area in m².
    pub cost: f64,
    /// What there is of the rectangle, if not all of it.
    pub remnant: Option<Remnant>,
    /// Parts that lie on it and stay where they are. There is only one of it then.
    pub locked: Vec<Placement>,
}

/// A piece of stock of any shape, in the coordinates of the rectangle around it.
#[derive(Debug, Clone, PartialEq)]
pub struct Remnant {
    /// Its edge, counter-clockwise; the rectangle around it begins at the origin.
    pub outline: Vec<Point2>,
    /// What is missing inside: holes, or places where a clamp sits.
    pub holes: Vec<Vec<Point2>>,
}

impl Stock {
    /// A whole rectangle, as many as needed.
    pub const fn new([width, height]: [f64; 2], margin: f64, spacing: f64) -> Self {
        Self {
            width,
            height,
            margin,
            spacing,
            count: None,
            cost: width * height / 1e6,
            remnant: None,
            locked: Vec::new(),
        }
    }

    /// Area of the material, mm².
    pub fn area(&self) -> f64 {
        match &self.remnant {
            None => self.width * self.height,
            Some(Remnant { outline, holes }) => {
                area(outline) - holes.iter().map(|hole| area(hole)).sum::<f64>()
            }
        }
    }

    /// Whether it is a bare rectangle.
    pub(super) const fn is_plain(&self) -> bool {
        self.remnant.is_none() && self.locked.is_empty()
    }

    /// How many there are.
    pub(super) fn most(&self) -> usize {
        let most = self.count.unwrap_or(usize::MAX);
        if self.locked.is_empty() { most } else { most.min(1) }
    }

    /// The edges of a remnant, the outer one first.
    pub fn edges(&self) -> impl Iterator<Item = &Vec<Point2>> {
        let remnant = self.remnant.iter();
        remnant.flat_map(|r| std::iter::once(&r.outline).chain(&r.holes))
    }
}
