//! What may be chosen, and what it does.

use crate::tolerance::PLANAR_ENOUGH;
use std::collections::BTreeMap;

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

/// What the energy may be asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wish {
    /// As the command line names it.
    pub name: &'static str,
    /// How much it counts, unless chosen otherwise.
    pub weight: f64,
    /// What a higher weight does.
    pub sentence: &'static str,
}

/// How much each wish counts. A residual of one is a fin out of plane by its own height,
/// or a node one median fin length away from where it should be.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Weights {
    chosen: BTreeMap<&'static str, f64>,
}

impl Weights {
    /// The same with a weight chosen.
    #[must_use]
    pub fn with(mut self, wish: &Wish, weight: f64) -> Self {
        self.chosen.insert(wish.name, weight);
        self
    }

    /// The weight of a wish: as chosen, else its own.
    pub fn of(&self, wish: &Wish) -> f64 {
        self.chosen.get(wish.name).copied().unwrap_or(wish.weight)
    }
}
