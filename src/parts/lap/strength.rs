//! Whether a strip holds: material behind and between its slits, and how tightly it bends.

use crate::geometry::{Point2, Vector2};
use crate::parts::fit::Fit;
use crate::parts::lap::bend;
use crate::parts::lap::finding::LapFinding;
use crate::parts::slit::{Opening, Slit};
use crate::parts::unfold::{FlatAxis, FlatStrip};
use std::collections::BTreeMap;

/// A strip with the slits cut into it, by place.
pub(crate) struct Slitted<'a> {
    /// Name for messages.
    pub name: &'a str,
    /// The flat strip.
    pub strip: &'a FlatStrip,
    /// Its slits by place.
    pub slits: &'a BTreeMap<usize, Slit>,
    /// What material and joint ask.
    pub fit: &'a Fit,
}

/// Everything weak about a strip.
pub(crate) fn weaknesses(slitted: &Slitted) -> Vec<LapFinding> {
    let places = slitted.slits.iter();
    let behind = places.filter_map(|(&place, slit)| slitted.behind(place, slit));
    let fins = 0..slitted.strip.axes.len() - 1;
    let between = fins.filter_map(|fin| slitted.between(fin));
    let folds = 1..slitted.strip.axes.len() - 1;
    let bends = folds.filter_map(|place| slitted.bend(place));
    behind.chain(between).chain(bends).collect()
}

impl Slitted<'_> {
    /// The web between a slit's end and the opposite edge.
    fn behind(&self, place: usize, slit: &Slit) -> Option<LapFinding> {
        let axis = &self.strip.axes[place];
        let web_mm = axis.below + axis.above - slit.depth - self.fit.relief;
        let (part, node) = (self.name.to_owned(), axis.node);
        if web_mm < self.fit.web_least {
            let least_mm = self.fit.web_least;
            Some(LapFinding::WebTooThin { part, node, web_mm, least_mm })
        } else if web_mm < self.fit.web {
            let wanted_mm = self.fit.web;
            Some(LapFinding::WebThin { part, node, web_mm, wanted_mm })
        } else {
            None
        }
    }

    /// The web between the slits at both ends of a fin.
    fn between(&self, fin: usize) -> Option<LapFinding> {
        let [left, right] = [fin, fin + 1].map(|place| self.slits.get(&place));
        let (left, right) = (left?, right?);
        let axes = &self.strip.axes;
        let first = wall(&axes[fin], left, left.after);
        let second = wall(&axes[fin + 1], right, -right.before);
        let run = (axes[fin + 1].foot - axes[fin].foot).norm();
        let overlap = left.after + right.before > run;
        let web_mm = if overlap { 0.0 } else { segment_distance(first, second) };
        let part = self.name.to_owned();
        let fin = [axes[fin].node, axes[fin + 1].node];
        if web_mm < self.fit.web_least {
            let least_mm = self.fit.web_least;
            Some(LapFinding::SlitsTooNear { part, fin, web_mm, least_mm })
        } else if web_mm < self.fit.web {
            let wanted_mm = self.fit.web;
            Some(LapFinding::SlitsNear { part, fin, web_mm, wanted_mm })
        } else {
            None
        }
    }

    /// The bend at an inner node: its fold spread over the fins beside it.
    fn bend(&self, place: usize) -> Option<LapFinding> {
        let axes = &self.strip.axes;
        let length = |fin: usize| (axes[fin + 1].foot - axes[fin].foot).norm();
        let slit = self.slits.get(&place).map_or(0.0, Slit::width);
        let fold = self.strip.folds[place - 1].angle;
        let radius_mm = bend::radius(&[length(place - 1), length(place)], slit, fold);
        let ratio = radius_mm / self.fit.thickness;
        let (part, node) = (self.name.to_owned(), axes[place].node);
        let fold_deg = fold.to_degrees();
        if ratio < self.fit.bend_crack {
            let limit = self.fit.bend_crack;
            let (grow, thinner_mm) = (limit / ratio, radius_mm / limit);
            Some(LapFinding::BendBreaks {
                part,
                node,
                fold_deg,
                radius_mm,
                ratio,
                limit,
                grow,
                thinner_mm,
            })
        } else if ratio < self.fit.bend_model {
            let limit = self.fit.bend_model;
            let grow = limit / ratio;
            Some(LapFinding::BendTight {
                part,
                node,
                fold_deg,
                radius_mm,
                ratio,
                limit,
                grow,
            })
        } else {
            None
        }
    }
}

/// The wall of a slit at `offset` from its axis, from the edge to its end.
fn wall(axis: &FlatAxis, slit: &Slit, offset: f64) -> [Point2; 2] {
    let (edge, inward) = match slit.from {
        Opening::Top => (axis.top(), -axis.up),
        Opening::Bottom => (axis.bottom(), axis.up),
    };
    let start = edge + axis.right() * offset;
    [start, start + inward * slit.depth]
}

/// Least distance between two segments that do not cross.
fn segment_distance(a: [Point2; 2], b: [Point2; 2]) -> f64 {
    let to = |p: Point2, [from, end]: [Point2; 2]| {
        let way: Vector2 = end - from;
        let share = ((p - from).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
        (p - (from + way * share)).norm()
    };
    [to(a[0], b), to(a[1], b), to(b[0], a), to(b[1], a)]
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}
