//! What may be chosen, and what it does.

use crate::design::planarise::terms::Weights;
use crate::tolerance::PLANAR_ENOUGH;

/// How to planarise.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Whether edges on the boundary carry fins, where the draft does not list its fins.
    pub boundary_fins: bool,
    /// Nodes that may not move; their axes may turn.
    pub fixed_nodes: Vec<usize>,
    /// Nodes whose axes may not turn.
    pub fixed_axes: Vec<usize>,
    /// How much each wish counts.
    pub weights: Weights,
    /// Worst planarity that is good enough, as a share of a fin's diameter.
    pub target: f64,
    /// Largest angle between an axis and the surface normal, radians.
    pub tilt_limit: f64,
    /// How far a node may move, as a share of its shortest edge.
    pub move_limit: f64,
    /// Systems of equations that may be solved before it ends with what it has.
    pub steps: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            boundary_fins: false,
            fixed_nodes: Vec::new(),
            fixed_axes: Vec::new(),
            weights: Weights::default(),
            target: PLANAR_ENOUGH,
            tilt_limit: 60_f64.to_radians(),
            move_limit: 0.2,
            steps: 120,
        }
    }
}
