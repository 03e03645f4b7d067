//! How large the eye plates of one node are and where they sit.

use crate::parts::fit::Fit;
use crate::parts::setback::clear_of;
use crate::parts::star::Star;
use std::f64::consts::{FRAC_PI_2, PI};

/// The eye plates of a node. Lengths in mm, heights along the axis from the base mesh.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Hinge {
    /// What it holds.
    pub star: Star,
    /// Radius of an eye, half the width of its tail.
    pub radius: f64,
    /// Radius of the hole for the rod.
    pub hole: f64,
    /// Thickness of a plate.
    pub thickness: f64,
    /// Length of the slits in fin and plate, where they lap.
    pub lap: f64,
    /// Width of the slit in a plate.
    pub width: f64,
    /// Where fins stop, from the axis.
    pub setback: f64,
    /// Middle heights of each fin's two plates, in the order of the fins.
    pub levels: Vec<[f64; 2]>,
    /// From one plate of a stack to the next.
    pub pitch: f64,
    /// Where the slit of a plate ends, from the axis: its rounded corners meet those of the
    /// fin's slit half a clearance before the fin touches the plate.
    pub floor: f64,
}

impl Hinge {
    /// The hinge of a node. Plates lap as far as asked, or as the shortest fin allows, but
    /// not less than the sheet is thick.
    pub(crate) fn new(star: Star, fit: &Fit) -> Self {
        let gap = fit.gap();
        let hole = fit.rod_diameter / 2.0 + gap;
        let width = fit.thickness + fit.clearance;
        let radius = (hole + fit.web).max(width / 2.0 + fit.web);
        let setback = setback(&star, radius, fit.thickness) + gap;
        let room = ((star.shortest - fit.web_least) / 2.0 - setback) / 2.0;
        let lap = room.clamp(fit.thickness, fit.disc_slot.max(fit.thickness));
        let thickness = fit.connector_thickness;
        let pitch = thickness + fit.clearance.max(0.0);
        let stack = star.fins.len();
        let plates = 2.0 * stack as f64 * pitch;
        let [low, high] = Self::levels_between(&star, (setback + lap, plates), fit);
        let levels = (0..stack).map(|k| {
            let lower = low + pitch * (k as f64 + 0.5);
            [lower, high - pitch * ((stack - k) as f64 - 0.5)]
        });
        Self {
            levels: levels.collect(),
            radius,
            hole,
            thickness,
            lap,
            width,
            setback,
            pitch,
            floor: setback + lap + 2.0 * fit.bite() - gap,
            star,
        }
    }

    /// Heights between which plates may lie: every fin keeps a web beyond them, as wide as
    /// there is room.
    fn levels_between(star: &Star, (out, plates): (f64, f64), fit: &Fit) -> [f64; 2] {
        let [low, high] = star.shared_span(out);
        let web = ((high - low - plates) / 2.0).clamp(fit.web_least, fit.web);
        [low + web, high - web]
    }

    /// How much of the axis the plates take, webs included.
    pub(crate) fn needed(&self, fit: &Fit) -> f64 {
        let plates = 2.0 * self.star.fins.len() as f64;
        let [low, high] = self.star.shared_span(self.setback + self.lap);
        let lost = self.star.reach[0] + self.star.reach[1] - (high - low);
        plates * self.pitch + 2.0 * fit.web_least + lost
    }

    /// How far the tail reaches from the axis.
    pub(crate) fn tail(&self) -> f64 {
        self.setback + 2.0 * self.lap
    }
}

/// Where fins stop so that they clear each other, all eyes, and the tails of plates whose
/// fins leave at less than a right angle.
fn setback(star: &Star, radius: f64, thickness: f64) -> f64 {
    let fins = &star.fins;
    let pairs = fins.iter().flat_map(|a| fins.iter().map(move |b| (a, b)));
    let tails = pairs.filter(|(a, b)| a.index != b.index).map(|(a, b)| {
        let between = (b.bearing - a.bearing).rem_euclid(2.0 * PI);
        let between = between.min(2.0 * PI - between);
        if between < FRAC_PI_2 { clear_of(thickness, 2.0 * radius, between) } else { 0.0 }
    });
    let clear = fins.iter().map(|fin| fin.clear);
    tails.chain(clear).fold(radius, f64::max)
}
