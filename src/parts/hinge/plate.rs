//! Hinges: eye plates across the node axis, two for each fin, on one rod.
//!
//! A plate laps with its fin: the fin has a slit in its end edge, the plate one in its tail,
//! and they are pushed into each other across the axis. Around the rod the plates of all
//! fins lie on each other in two stacks, one near each end of the axis, in the order of the
//! fins: no two meet, no fin slides along the rod, and each turns about it (the joint of the
//! paper's Figure 6).

use crate::geometry::{Contour, Point2, Region, Vertex, trig};
use crate::lettering::{letter, width};
use crate::parts::fit::Fit;
use crate::parts::hub::disc::circle;
use crate::parts::mark::GAP;
use crate::parts::outline::without_doubles;
use crate::parts::part::{Mark, MarkKind};
use crate::parts::setback::clear_of;
use crate::parts::star::Around;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_8, PI};

/// The eye plates of a node. Lengths in mm, heights along the axis from the base mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Hinge {
    /// What it holds.
    pub around: Around,
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
    pub fn new(around: Around, fit: &Fit) -> Self {
        let gap = fit.gap();
        let hole = fit.rod_diameter / 2.0 + gap;
        let width = fit.thickness + fit.clearance;
        let radius = (hole + fit.web).max(width / 2.0 + fit.web);
        let setback = setback(&around, radius, fit.thickness) + gap;
        let room = ((around.shortest - fit.web_least) / 2.0 - setback) / 2.0;
        let lap = room.clamp(fit.thickness, fit.disc_slot.max(fit.thickness));
        let thickness = fit.connector_thickness;
        let pitch = thickness + fit.clearance.max(0.0);
        let stack = around.spokes.len();
        let plates = 2.0 * stack as f64 * pitch;
        let [low, high] = Self::room(&around, (setback + lap, plates), fit);
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
            around,
        }
    }

    /// Heights between which plates may lie: every fin keeps a web beyond them, as wide as
    /// there is room.
    fn room(around: &Around, (out, plates): (f64, f64), fit: &Fit) -> [f64; 2] {
        let [low, high] = around.sunk(out);
        let web = ((high - low - plates) / 2.0).clamp(fit.web_least, fit.web);
        [low + web, high - web]
    }

    /// How much of the axis the plates take, webs included.
    pub fn needed(&self, fit: &Fit) -> f64 {
        let plates = 2.0 * self.around.spokes.len() as f64;
        let [low, high] = self.around.sunk(self.setback + self.lap);
        let lost = self.around.reach[0] + self.around.reach[1] - (high - low);
        plates * self.pitch + 2.0 * fit.web_least + lost
    }

    /// How far the tail reaches from the axis.
    pub fn tail(&self) -> f64 {
        self.setback + 2.0 * self.lap
    }

    /// Shape of a plate: its origin on the axis, its tail along x, labelled face up.
    pub(crate) fn region(&self, fit: &Fit) -> Region {
        let quarter = trig::tan(FRAC_PI_8);
        let (r, tail, half) = (self.radius, self.tail(), self.width / 2.0);
        let relief = fit.relief.min(half);
        let (floor, beyond) = (self.floor, self.floor - relief);
        let inner = if relief > 0.0 { -quarter } else { 0.0 };
        let at = |x: f64, y: f64| Point2::new(x, y);
        let mut vertices = vec![
            Vertex::line(at(tail, half)),
            Vertex::line(at(tail, r)),
            Vertex::arc(at(0.0, r), quarter),
            Vertex::arc(at(-r, 0.0), quarter),
            Vertex::line(at(0.0, -r)),
            Vertex::line(at(tail, -r)),
            Vertex::line(at(tail, -half)),
            Vertex::arc(at(floor, -half), inner),
            Vertex::line(at(beyond, relief - half)),
            Vertex::arc(at(beyond, half - relief), inner),
            Vertex::line(at(floor, half)),
        ];
        without_doubles(&mut vertices);
        let rod = circle(Point2::origin(), self.hole).reversed();
        Region { outline: Contour { vertices }, holes: vec![rod] }
    }

    /// The node's name, across the plate between eye and slit or along the tail.
    pub(crate) fn marks(&self, name: &str, height: f64) -> Option<Mark> {
        let room = |size: f64| Some((width(name, size).ok()?, size));
        let sizes = [1.0, 0.8, 0.65, 0.5].map(|share| height * share);
        let [from, to] = [self.hole + GAP, self.floor - 2.0 * GAP];
        let across = |(long, size): (f64, f64)| {
            let fits = long + 2.0 * GAP <= 2.0 * self.radius && from + size <= to;
            fits.then(|| (Point2::new(from + size, -long / 2.0), FRAC_PI_2, size))
        };
        let beside = |(long, size): (f64, f64)| {
            let fits = self.width / 2.0 + size + 2.0 * GAP <= self.radius;
            let x = self.tail() - GAP - long;
            let at = Point2::new(x, self.width / 2.0 + GAP);
            (fits && x > self.hole).then_some((at, 0.0, size))
        };
        let rooms = || sizes.iter().filter_map(|size| room(*size));
        let (at, turn, size) = rooms().find_map(across).or(rooms().find_map(beside))?;
        let (sin, cos) = (trig::sin(turn), trig::cos(turn));
        let place = |p: &Point2| {
            Point2::new(at.x + p.x * cos - p.y * sin, at.y + p.x * sin + p.y * cos)
        };
        let strokes = letter(name, size).ok()?.strokes;
        let strokes = strokes.iter().map(|s| s.iter().map(place).collect()).collect();
        Some(Mark { kind: MarkKind::Engrave, strokes })
    }
}

/// Where fins stop so that they clear each other, all eyes, and the tails of plates whose
/// fins leave at less than a right angle.
fn setback(around: &Around, radius: f64, thickness: f64) -> f64 {
    let spokes = &around.spokes;
    let pairs = spokes.iter().flat_map(|a| spokes.iter().map(move |b| (a, b)));
    let tails = pairs.filter(|(a, b)| a.fin != b.fin).map(|(a, b)| {
        let between = (b.bearing - a.bearing).rem_euclid(2.0 * PI);
        let between = between.min(2.0 * PI - between);
        if between < FRAC_PI_2 { clear_of(thickness, 2.0 * radius, between) } else { 0.0 }
    });
    let clear = spokes.iter().map(|spoke| spoke.clear);
    tails.chain(clear).fold(radius, f64::max)
}
