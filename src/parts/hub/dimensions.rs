//! How large the discs of one node are and where they sit.
//!
//! Seen along the axis, a disc has from the inside out: a hole for the rod; the middle, up
//! to `inner`; a closed window for each fin, `slot` long; a ring around all windows. The
//! tenon of a fin stands in the window; beside it the fin is notched from its edge to take
//! in the ring.

use crate::geometry::trig;
use crate::ids::NodeId;
use crate::parts::fit::Fit;
use crate::parts::star::Star;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// The two discs of a node. Lengths in mm, heights along the axis from the base mesh.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Hub {
    /// What it holds.
    pub star: Star,
    /// From the axis to where windows begin.
    pub inner: f64,
    /// Length of a window along its fin, without the rounding of its ends.
    pub slot: f64,
    /// Width of a window.
    pub width: f64,
    /// Radius of the disc.
    pub radius: f64,
    /// Radius of the hole for the rod.
    pub hole: f64,
    /// Thickness of a disc.
    pub thickness: f64,
    /// Height of the lower disc's lower face and of the upper disc's upper face.
    pub faces: [f64; 2],
    /// From the axis to the near and far wall of the notch that takes in the ring.
    pub notch: [f64; 2],
    /// Where fins stop, from the axis.
    pub setback: f64,
}

/// The hubs of a structure, by node.
pub(crate) type Hubs = BTreeMap<NodeId, Hub>;

impl Hub {
    /// The hub of a node. Its windows are as long as asked, or as the shortest of its fins
    /// allows, but not shorter than the sheet is thick.
    pub(crate) fn new(star: Star, fit: &Fit) -> Self {
        let gap = fit.gap();
        let hole = fit.rod_diameter / 2.0 + gap.max(EASY_MM);
        let width = fit.thickness + fit.clearance;
        let sectors = star.sectors().into_iter();
        let least = sectors.map(|angle| fit.relief + inner_radius(angle, width, fit.web));
        let clear = star.fins.iter().map(|fin| fin.clear);
        let inner = least.chain(clear).fold(hole + fit.web + fit.relief, f64::max);
        let room = (star.shortest - fit.web_least) / 2.0 - gap;
        let corner = Corner::new(width, fit);
        let slot = corner.reach(room) - inner;
        let slot = slot.clamp(fit.thickness.min(fit.disc_slot), fit.disc_slot);
        let radius = corner.radius(inner + slot);
        let thickness = fit.connector_thickness;
        let faces = star.shared_span(radius + gap);
        // A tenon's corners touch the rounded end of the window where it has narrowed by
        // half the clearance; it may reach so far, less the gap.
        let notch = [inner + slot + fit.bite() - gap, radius + gap];
        let setback = inner + gap;
        Self { star, inner, slot, width, radius, hole, thickness, faces, notch, setback }
    }

    /// Heights between which no disc is: upper face of the lower, lower face of the upper.
    pub(crate) fn between(&self) -> [f64; 2] {
        [self.faces[0] + self.thickness, self.faces[1] - self.thickness]
    }
}

/// The rounded corner at the outer end of a window: the circle of radius `relief` around the
/// point where the walls end, `aside` of the fin's middle.
struct Corner {
    aside: f64,
    relief: f64,
    web: f64,
}

impl Corner {
    fn new(width: f64, fit: &Fit) -> Self {
        let relief = fit.relief.min(width / 2.0);
        Self { aside: width / 2.0 - relief, relief, web: fit.web }
    }

    /// Radius of a disc that leaves the web outside windows whose walls end at `far`.
    fn radius(&self, far: f64) -> f64 {
        (far * far + self.aside * self.aside).sqrt() + self.relief + self.web
    }

    /// Where walls may end in a disc of this radius.
    fn reach(&self, radius: f64) -> f64 {
        let to = (radius - self.relief - self.web).max(self.aside);
        (to * to - self.aside * self.aside).sqrt()
    }
}

/// What a rod has around it in a hole that it should slip through, mm.
const EASY_MM: f64 = 0.1;

/// Least distance from the axis at which two windows of this `width`, their fins at the
/// angle `between`, leave a `web`: their near corners are 2 ρ sin(b/2) - w cos(b/2) apart.
pub fn inner_radius(between: f64, width: f64, web: f64) -> f64 {
    if between >= PI {
        return 0.0;
    }
    let (sin, cos) = (trig::sin(between / 2.0), trig::cos(between / 2.0));
    (web + width * cos) / (2.0 * sin)
}
