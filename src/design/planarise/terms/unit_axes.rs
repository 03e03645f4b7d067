//! Axes have length one.

use crate::design::planarise::given::{At, Slope, slope};
use crate::design::planarise::terms::Term;
use crate::geometry::Vector3;

pub(super) struct UnitAxes;

impl Term for UnitAxes {
    fn on_node(&self, node: usize, at: &At, row: &mut dyn FnMut(f64, Slope)) {
        let axis = at.now.axes[node];
        row(axis.norm_squared() - 1.0, slope(Vector3::zeros(), axis * 2.0));
    }
}
