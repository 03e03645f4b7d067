//! Boundary nodes keep to the given boundary: their distance inside the surface.

use crate::design::planarise::given::{At, Slope, slope};
use crate::design::planarise::options::Wish;
use crate::design::planarise::terms::Term;
use crate::geometry::Vector3;

pub(super) const WISH: Wish = Wish {
    name: "rim",
    weight: 1.0,
    sentence: "Rim: higher, and boundary nodes keep to the given boundary",
};

pub(super) struct Boundary {
    pub weight: f64,
}

impl Term for Boundary {
    fn on_node(&self, node: usize, at: &At, row: &mut dyn FnMut(f64, Slope)) {
        let Some((point, out)) = at.feet[node].boundary else { return };
        let off = out.dot(&(at.now.positions[node] - point));
        row(self.weight * off, slope(out * self.weight, Vector3::zeros()));
    }

    fn needs_feet(&self) -> bool {
        self.weight > 0.0
    }

    fn silence(&mut self) {
        self.weight = 0.0;
    }
}
