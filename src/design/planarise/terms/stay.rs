//! Nodes stay where they are, axes as they start.

use crate::design::planarise::given::Given;
use crate::design::planarise::options::{Weights, Wish};
use crate::design::planarise::terms::{Stencil, Term};

pub(super) const WISH: Wish = Wish {
    name: "stay",
    weight: 0.002,
    sentence: "Stay: higher, and nodes slide less within the surface",
};

pub(super) const AXES: Wish = Wish {
    name: "stay-axes",
    weight: 0.05,
    sentence: "Stay of axes: higher, and axes turn less, nodes move more",
};

pub(super) struct Stay {
    stencils: Vec<Stencil>,
}

impl Stay {
    pub(super) fn new(given: &Given, weights: &Weights) -> Self {
        let weights = [weights.of(&WISH), weights.of(&AXES)];
        let stays = |&node: &usize| Stencil { shares: vec![(node, 1.0)], weights };
        Self { stencils: given.place.iter().map(stays).collect() }
    }
}

impl Term for Stay {
    fn stencils(&self) -> &[Stencil] {
        &self.stencils
    }

    fn silence(&mut self) {
        self.stencils.iter_mut().for_each(|stencil| stencil.weights = [0.0; 2]);
    }
}
