//! What may be chosen, and what it does.

use crate::tolerance::PLANAR_ENOUGH;

/// How much each wish counts. A residual of one is a fin out of plane by its own height,
/// or a node one median fin length away from where it should be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// Planarity of fins. It is raised on its own until the target is met.
    pub planarity: f64,
    /// Distance of nodes to the given surface.
    pub closeness: f64,
    /// Distance of boundary nodes to the given boundary, measured inside the surface.
    pub rim: f64,
    /// Even change along lines of the mesh: keeps spacing and sweep as given.
    pub fairness: f64,
    /// Nodes stay where they are.
    pub stay: f64,
    /// Axes stay as they start.
    pub stay_axes: f64,
    /// Walls: how hard the limits of move and tilt are.
    pub walls: f64,
}

impl Weights {
    /// Nothing counts, but that axes have length one.
    pub(super) const fn none() -> Self {
        Self {
            planarity: 0.0,
            closeness: 0.0,
            rim: 0.0,
            fairness: 0.0,
            stay: 0.0,
            stay_axes: 0.0,
            walls: 0.0,
        }
    }
}

impl Default for Weights {
    fn default() -> Self {
        Self {
            planarity: 10.0,
            closeness: 0.5,
            rim: 1.0,
            fairness: 0.05,
            stay: 0.002,
            stay_axes: 0.05,
            walls: 3.0,
        }
    }
}

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
    /// Worst planarity that is good enough, as a share of a fin's diameter (contract §2).
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
