//! What may be wished of a design.

use crate::geometry::Point3;

/// How cells are sized.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Size {
    /// Wanted length of a fin, mm; of two families the geometric mean.
    Cell(f64),
    /// Wanted count of nodes; fins are as long as the side of a square with that share of
    /// the area.
    Nodes(usize),
}

/// Whether fins run along the boundary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// When no axis turns far for it.
    Auto,
    /// Cells are trimmed at the boundary.
    None,
    /// When there is a valid net.
    Boundary,
}

impl Align {
    /// How far an axis may turn, degrees, before alignment is given up.
    pub(super) const fn most_turn_deg(self) -> f64 {
        match self {
            Self::Auto => 15.0,
            Self::None | Self::Boundary => 45.0,
        }
    }
}

/// Where nodes inside have other than four fins.
#[derive(Debug, Clone, PartialEq)]
pub enum SingularWish {
    /// Where the directions ask for it.
    Auto,
    /// Nearest to these places (mm), with that many fins, and nowhere else.
    At(Vec<(Point3, usize)>),
}

/// What is wished.
#[derive(Debug, Clone, PartialEq)]
pub struct Wishes {
    /// How large cells are.
    pub size: Size,
    /// How many times as long fins of family 1 are as those of family 2.
    pub aspect: f64,
    /// Whether fins run along the boundary.
    pub align: Align,
    /// How far fins reach below and above, mm; `None`: 0.35 of the wanted fin length.
    pub depth: Option<[f64; 2]>,
    /// Whether boundary edges carry fins.
    pub boundary_fins: bool,
    /// Where nodes of three, five or other numbers of fins are.
    pub singular: SingularWish,
    /// Whether axes may turn for cells of even size.
    pub even: bool,
    /// Whether a surface that is its own mirror image gets a mesh that is.
    pub symmetry: bool,
}

impl Default for Wishes {
    /// About 700 nodes, cells trimmed at the boundary.
    fn default() -> Self {
        Self {
            size: Size::Nodes(700),
            aspect: 1.0,
            align: Align::None,
            depth: None,
            boundary_fins: false,
            singular: SingularWish::Auto,
            even: false,
            symmetry: false,
        }
    }
}
