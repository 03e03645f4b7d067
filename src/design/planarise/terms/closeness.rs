//! Nodes keep to the given surface: their distance along its normal.

use crate::design::planarise::given::{At, Slope, slope};
use crate::design::planarise::options::Wish;
use crate::design::planarise::terms::Term;
use crate::geometry::Vector3;

pub(super) const WISH: Wish = Wish {
    name: "closeness",
    weight: 0.5,
    sentence: "Closeness: higher, and nodes keep to the given surface, at the price of \
               axes that turn further",
};

pub(super) struct Closeness {
    pub weight: f64,
}

impl Term for Closeness {
    fn on_node(&self, node: usize, at: &At, row: &mut dyn FnMut(f64, Slope)) {
        let Some(foot) = at.feet[node].surface else { return };
        let off = foot.normal.dot(&(at.now.positions[node] - foot.point));
        row(self.weight * off, slope(foot.normal * self.weight, Vector3::zeros()));
    }

    fn needs_feet(&self) -> bool {
        self.weight > 0.0
    }

    fn silence(&mut self) {
        self.weight = 0.0;
    }
}
