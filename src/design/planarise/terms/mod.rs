//! The terms of the energy, one wish in each file: residuals with exact derivatives.
//!
//! A new wish is a file here and a line in [`wishes`]; if it can be weighed, a line in
//! [`WISHES`] as well, and the command line has its option from there. Terms may couple
//! the ends of fins and of edges, for which the matrix has room.

mod boundary;
mod closeness;
mod fairness;
mod limits;
mod planarity;
mod stay;
mod unit_axes;

pub(super) use planarity::Planarity;

use crate::design::planarise::given::{At, Fin, Given, Slope};
use crate::design::planarise::options::{Options, Wish};

/// All that can be weighed, in the order of help texts.
pub const WISHES: [Wish; 7] = [
    planarity::WISH,
    closeness::WISH,
    boundary::WISH,
    fairness::WISH,
    stay::WISH,
    stay::AXES,
    limits::WISH,
];

/// Rows of residuals at fins and nodes; the sum of their squares is minimised.
pub(super) trait Term {
    /// Rows of a fin, with their derivatives by its ends.
    fn on_fin(&self, _fin: &Fin, _at: &At, _row: &mut dyn FnMut(f64, [Slope; 2])) {}

    /// Rows of one node alone, with their derivatives.
    fn on_node(&self, _node: usize, _at: &At, _row: &mut dyn FnMut(f64, Slope)) {}

    /// Rows that are linear in the changes, so that their part of the matrix never changes.
    fn stencils(&self) -> &[Stencil] {
        &[]
    }

    /// Whether it asks where nodes come down on the given surface.
    fn needs_feet(&self) -> bool {
        false
    }

    /// Counts no more, so that the way to planarity is the shortest.
    fn silence(&mut self) {}
}

/// Nodes whose changes belong together: their weighted sum is to vanish, that of positions
/// (three rows) and that of axes (three more).
#[derive(Debug, Clone)]
pub(super) struct Stencil {
    /// Nodes with their shares in the sum.
    pub shares: Vec<(usize, f64)>,
    /// Weights of positions and of axes.
    pub weights: [f64; 2],
}

/// All terms but planarity, in the order in which their squares are added.
pub(super) fn wishes(given: &Given, options: &Options) -> Vec<Box<dyn Term>> {
    let weights = &options.weights;
    vec![
        Box::new(unit_axes::UnitAxes),
        Box::new(closeness::Closeness { weight: weights.of(&closeness::WISH) }),
        Box::new(boundary::Boundary { weight: weights.of(&boundary::WISH) }),
        Box::new(limits::TiltLimit::new(given, options)),
        Box::new(limits::MoveLimit { weight: weights.of(&limits::WISH) }),
        Box::new(fairness::Fairness::new(given, weights)),
        Box::new(stay::Stay::new(given, weights)),
    ]
}
