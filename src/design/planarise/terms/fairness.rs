//! Neighbours change alike, along every edge, whether it carries a fin or not: spacing and
//! sweep stay as given.

use crate::design::planarise::given::Given;
use crate::design::planarise::options::{Weights, Wish};
use crate::design::planarise::terms::{Stencil, Term};

pub(super) const WISH: Wish = Wish {
    name: "fairness",
    weight: 0.05,
    sentence: "Fairness: higher, and changes spread evenly along strips",
};

pub(super) struct Fairness {
    stencils: Vec<Stencil>,
}

impl Fairness {
    pub(super) fn new(given: &Given, weights: &Weights) -> Self {
        let weights = [weights.of(&WISH); 2];
        let alike = |&[i, j]: &[usize; 2]| {
            let shares = vec![(i, 1.0), (j, -1.0)];
            Stencil { shares, weights }
        };
        Self { stencils: given.edges.iter().map(alike).collect() }
    }
}

impl Term for Fairness {
    fn stencils(&self) -> &[Stencil] {
        &self.stencils
    }

    fn silence(&mut self) {
        self.stencils.iter_mut().for_each(|stencil| stencil.weights = [0.0; 2]);
    }
}
