//! The width that the laser burns away.

use crate::geometry::Contour;
use crate::geometry::offset::offset;

/// Width of the slot the laser burns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kerf {
    width: f64,
}

impl Kerf {
    /// A kerf of this full width, mm.
    pub const fn from_width_mm(width: f64) -> Self {
        Self { width }
    }

    /// The path to cut so that the material to the left of `contour` keeps its size:
    /// counter-clockwise outlines grow, clockwise holes shrink.
    pub fn compensated(self, contour: &Contour) -> Contour {
        offset(contour, self.width / 2.0)
    }
}
