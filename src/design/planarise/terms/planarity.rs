//! Fins are plane: height × [u, eᵢ, eⱼ], u the edge's unit vector, eᵢ and eⱼ the axes
//! ("Freeform Shading and Lighting Systems from Planar Quads", on torsion-free support
//! structures). Its weight is raised until the target is met.

use crate::design::planarise::given::{At, Fin, Slope, slope};
use crate::design::planarise::options::{Weights, Wish};
use crate::design::planarise::terms::Term;

pub(super) const WISH: Wish = Wish {
    name: "planarity",
    weight: 10.0,
    sentence: "Planarity: raised on its own until the target is met; lower, and nodes and \
               axes are led more gently",
};

pub(in crate::design::planarise) struct Planarity {
    pub weight: f64,
}

impl Planarity {
    pub(in crate::design::planarise) fn new(weights: &Weights) -> Self {
        Self { weight: weights.of(&WISH) }
    }
}

impl Term for Planarity {
    fn on_fin(&self, fin: &Fin, at: &At, row: &mut dyn FnMut(f64, [Slope; 2])) {
        let [i, j] = fin.ends;
        let (a, b) = (at.now.axes[i], at.now.axes[j]);
        let edge = at.now.positions[j] - at.now.positions[i];
        let length = edge.norm();
        let u = edge / length;
        let height = fin.reach.iter().flatten().sum::<f64>() / 2.0;
        let weight = self.weight * height;
        let across = a.cross(&b);
        let value = u.dot(&across);
        let by_position = (across - u * value) * (weight / length);
        let by_a = b.cross(&u) * weight;
        let by_b = u.cross(&a) * weight;
        row(weight * value, [slope(-by_position, by_a), slope(by_position, by_b)]);
    }
}
