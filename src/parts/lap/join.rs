//! Which strips lap at a node, how wide their slits are, and which strip goes first.
//!
//! Two strips that cross on a node axis are half-lapped. A strip that ends on another one
//! laps too if it can run on past the axis (the *overhang*); where another fin is in the
//! way, its end is set back, and stands in discs if they have room.

use crate::parts::fit::Fit;
use crate::parts::hub::dimensions::Hubs;
use crate::parts::lap::finding::LapFinding;
use crate::parts::lap::meeting::{Lap, Meeting};
use crate::parts::lap::passage::{Passage, passages, turn};
use crate::parts::lap::rank::ranks;
use crate::parts::outline::End;
use crate::parts::slit::{Opening, Slit};
use crate::parts::unfold::FlatStrip;
use crate::structure::{FinTree, Structure};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// The joints of one strip.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Joints {
    /// By place on the strip.
    pub slits: BTreeMap<usize, Slit>,
    /// Its first and last end.
    pub ends: [End; 2],
}

/// How strips go together.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Joinery {
    /// Strips by rank: in this order they go in, each from above onto those before.
    pub order: Vec<usize>,
    /// Names of the strips, `S01` the first to go in.
    pub names: Vec<String>,
    /// One per strip.
    pub joints: Vec<Joints>,
}

/// Joins the strips at all nodes; at nodes with `hubs` all of them end in discs.
pub(crate) fn join(
    structure: &Structure,
    strips: &[FlatStrip],
    fit: &Fit,
    hubs: &Hubs,
) -> (Joinery, Vec<LapFinding>) {
    let tree = FinTree::new(structure);
    let at = passages(structure, strips);
    let meetings: Vec<Meeting> = at
        .iter()
        .filter(|(node, _)| !hubs.contains_key(node))
        .map(|(&node, passages)| Meeting { structure, tree: &tree, fit, node, passages })
        .collect();
    let laps: Vec<Option<Lap>> = meetings.iter().map(Meeting::lap).collect();
    let (order, rank) = ranks(strips, laps.iter().flatten().map(Lap::strips));
    let names: Vec<String> =
        rank.iter().map(|rank| strip_name(*rank, strips.len())).collect();
    let free = Joints { slits: BTreeMap::new(), ends: [End::Free; 2] };
    let mut joints = vec![free; strips.len()];
    let held = at.iter().filter_map(|(node, passages)| Some((passages, hubs.get(node)?)));
    for (passage, hub) in held.flat_map(|(all, hub)| all.iter().map(move |p| (p, hub))) {
        passage.end.into_iter().for_each(|end| {
            joints[passage.strip].ends[end] = End::Held(hub.setback);
        });
    }
    let mut findings = Vec::new();
    for (meeting, lap) in meetings.iter().zip(&laps) {
        for (passage, end, setback_mm) in meeting.set_back(lap.as_ref()) {
            joints[passage.strip].ends[end] = End::SetBack(setback_mm);
            let others = structure.nodes()[meeting.node].arms.len() - 1;
            let part = names[passage.strip].clone();
            let (node, why) = (meeting.node, None);
            findings.push(LapFinding::StripEndUnheld {
                part,
                node,
                others,
                setback_mm,
                why,
            });
        }
        findings.extend(meeting.clash(lap.as_ref(), &names));
        if let Some(lap) = lap {
            cut(structure, lap, &rank, fit, &mut joints);
            findings.extend(crossing_finding(lap, fit, &joints, &names));
        }
    }
    (Joinery { order, names, joints }, findings)
}

/// Names count from 1 in the order of assembly and sort as text.
fn strip_name(rank: usize, count: usize) -> String {
    let digits = count.to_string().len().max(2);
    format!("S{:0digits$}", rank + 1)
}

/// Cuts the two slits of a lap: the strip that goes in first is open at the top.
fn cut(
    structure: &Structure,
    lap: &Lap,
    rank: &[usize],
    fit: &Fit,
    joints: &mut [Joints],
) {
    let height = structure.nodes()[lap.node].height();
    for (me, other) in [(0, 1), (1, 0)] {
        let (me, other) = (lap.passages[me], lap.passages[other]);
        let first = rank[me.strip] < rank[other.strip];
        let share = if first { fit.lap_split } else { 1.0 - fit.lap_split };
        let half = |arm: f64| half_width(arm, &other, fit) + fit.clearance / 2.0;
        let slit = Slit {
            node: lap.node,
            partner: other.strip,
            from: if first { Opening::Top } else { Opening::Bottom },
            before: half(me.before),
            after: half(me.after),
            depth: share * height + fit.depth_allowance,
            crossing: lap.crossing,
        };
        let joint = &mut joints[me.strip];
        joint.slits.insert(me.place, slit);
        if let Some(end) = me.end {
            let wall = if end == 0 { slit.before } else { slit.after };
            joint.ends[end] = End::Overhang(wall + fit.overhang);
        }
    }
}

/// From the axis to the slit's wall along `arm`, without clearance (`docs/strips.md`).
fn half_width(arm: f64, other: &Passage, fit: &Fit) -> f64 {
    let beside = [other.before, other.after].map(|neighbour| {
        let between = turn(arm, neighbour);
        fit.clear_distance(between.min(2.0 * PI - between))
    });
    beside.into_iter().fold(fit.kinked_half(other.kink()), f64::max)
}

fn crossing_finding(
    lap: &Lap,
    fit: &Fit,
    joints: &[Joints],
    names: &[String],
) -> Option<LapFinding> {
    let [first, second] = lap.passages.map(|passage| names[passage.strip].clone());
    let (node, angle_deg) = (lap.node, lap.crossing.to_degrees());
    if lap.crossing < fit.crossing_least {
        let [a, _] = lap.passages;
        let width_mm = joints[a.strip].slits.get(&a.place).map_or(0.0, Slit::width);
        let least_deg = fit.crossing_least.to_degrees();
        Some(LapFinding::CrossingTooSharp {
            first,
            second,
            node,
            angle_deg,
            width_mm,
            least_deg,
        })
    } else if lap.crossing < fit.crossing_warn {
        let play_deg = 180.0 - 2.0 * angle_deg;
        Some(LapFinding::CrossingOblique { first, second, node, angle_deg, play_deg })
    } else {
        None
    }
}
