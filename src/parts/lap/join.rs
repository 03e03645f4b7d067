//! Which strips lap at a node, how wide their slits are, and which strip goes first.
//!
//! Two strips that cross on a node axis are half-lapped. A strip that ends on another one
//! laps too if it can run on past the axis (the *overhang*); where another fin is in the
//! way, its end is set back, and stands in discs if they have room.

use crate::geometry::Vector3;
use crate::ids::NodeId;
use crate::parts::fit::Fit;
use crate::parts::lap::finding::PartFinding;
use crate::parts::lap::placement::Hubs;
use crate::parts::lap::rank::ranks;
use crate::parts::unfold::FlatStrip;
use crate::structure::{FinTree, Structure};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Which edge of a strip a slit is open to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Opening {
    /// The edge at the axes' upper ends.
    Top,
    /// The edge at the axes' lower ends.
    Bottom,
}

/// A slit on a node axis of a strip. Lengths in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slit {
    /// The node.
    pub node: NodeId,
    /// The strip that the slit receives, by its index.
    pub partner: usize,
    /// Which edge it is open to.
    pub from: Opening,
    /// From the axis to the wall on the side of the previous node.
    pub before: f64,
    /// From the axis to the wall on the side of the next node.
    pub after: f64,
    /// From the edge along the axis to where the full-width walls end.
    pub depth: f64,
    /// Smallest of the four angles between the fins, radians.
    pub crossing: f64,
}

impl Slit {
    /// Distance between the walls.
    pub fn width(&self) -> f64 {
        self.before + self.after
    }

    /// From the axis to the middle of the slit, positive toward the next node.
    pub fn offset(&self) -> f64 {
        (self.after - self.before) / 2.0
    }
}

/// What becomes of one end of a strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// It stops on the axis; no other strip is there.
    Free,
    /// It runs past the axis by this much and laps.
    Overhang(f64),
    /// It stops this far before the axis and is not held.
    SetBack(f64),
    /// It stops this far before the axis and stands in discs.
    Held(f64),
}

/// The joints of one strip.
#[derive(Debug, Clone, PartialEq)]
pub struct Joints {
    /// By place on the strip.
    pub slits: BTreeMap<usize, Slit>,
    /// Its first and last end.
    pub ends: [End; 2],
}

/// How strips go together.
#[derive(Debug, Clone, PartialEq)]
pub struct Joinery {
    /// Strips by rank: in this order they go in, each from above onto those before.
    pub order: Vec<usize>,
    /// Names of the strips, `S01` the first to go in.
    pub names: Vec<String>,
    /// One per strip.
    pub joints: Vec<Joints>,
}

/// A strip at one of its nodes.
#[derive(Debug, Clone, Copy)]
struct Passage {
    strip: usize,
    place: usize,
    /// Bearings of its two arms: toward the previous and toward the next node. At an end
    /// one of them is the overhang.
    before: f64,
    after: f64,
    end: Option<usize>,
}

impl Passage {
    fn kink(&self) -> f64 {
        (PI - turn(self.before, self.after)).abs()
    }

    fn real_arms(&self) -> impl Iterator<Item = f64> {
        let arms = [(self.before, Some(0)), (self.after, Some(1))];
        let end = self.end;
        arms.into_iter().filter(move |arm| arm.1 != end || end.is_none()).map(|arm| arm.0)
    }
}

/// Counter-clockwise angle from one bearing to another, in [0, 2π).
fn turn(from: f64, to: f64) -> f64 {
    let turn = (to - from) % (2.0 * PI);
    if turn < 0.0 { turn + 2.0 * PI } else { turn }
}

/// Two passages that lap, and the smallest of the four angles between their arms.
struct Lap {
    node: NodeId,
    passages: [Passage; 2],
    crossing: f64,
}

impl Lap {
    fn strips(&self) -> [usize; 2] {
        self.passages.map(|passage| passage.strip)
    }
}

/// Joins the strips at all nodes; at nodes with `hubs` all of them end in discs.
pub fn join(
    structure: &Structure,
    strips: &[FlatStrip],
    fit: &Fit,
    hubs: &Hubs,
) -> (Joinery, Vec<PartFinding>) {
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
            findings.push(PartFinding::StripEndUnheld {
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

/// All strips at each node, in the order of the strips.
type Passages = BTreeMap<NodeId, Vec<Passage>>;

fn passages(structure: &Structure, strips: &[FlatStrip]) -> Passages {
    let mut at = Passages::new();
    for (strip, flat) in strips.iter().enumerate() {
        let last = flat.axes.len() - 1;
        for place in 0..=last {
            let node = flat.axes[place].node;
            let bearing = |other: usize| {
                let around = &structure.nodes()[node];
                let arm = around.arm(flat.axes[other].node);
                arm.map_or(0.0, |arm| around.arms[arm].angle)
            };
            let (before, after, end) = match place {
                0 => (bearing(1) + PI, bearing(1), Some(0)),
                k if k == last => (bearing(k - 1), bearing(k - 1) + PI, Some(1)),
                k => (bearing(k - 1), bearing(k + 1), None),
            };
            let passage = Passage { strip, place, before, after, end };
            at.entry(node).or_default().push(passage);
        }
    }
    at
}

/// The strips at one node.
struct Meeting<'a> {
    structure: &'a Structure,
    tree: &'a FinTree,
    fit: &'a Fit,
    node: NodeId,
    passages: &'a [Passage],
}

impl Meeting<'_> {
    /// The two strips that lap here: two alone, or the two that run through.
    fn lap(&self) -> Option<Lap> {
        let through: Vec<&Passage> =
            self.passages.iter().filter(|passage| passage.end.is_none()).collect();
        let (a, b) = match (self.passages, through.as_slice()) {
            ([a, b], _) => (*a, *b),
            (_, [a, b]) => (**a, **b),
            _ => return None,
        };
        let crossing = crossing(a, b)?;
        let forced = a.end.is_none() && b.end.is_none();
        let room = || {
            crossing >= self.fit.crossing_least
                && [a, b].iter().all(|passage| self.has_room(passage))
        };
        (a.strip != b.strip && (forced || room())).then_some(Lap {
            node: self.node,
            passages: [a, b],
            crossing,
        })
    }

    /// Whether a strip that ends here can run on past the axis.
    fn has_room(&self, passage: &Passage) -> bool {
        if passage.end.is_none() {
            return true;
        }
        let node = &self.structure.nodes()[self.node];
        let arm = passage.real_arms().next().unwrap_or_default();
        let from = node.arms.iter().find(|a| turn(a.angle, arm) == 0.0).map(|a| a.to);
        let Some(from) = from else { return false };
        let onward: Vector3 = -self.structure.direction(self.node, from);
        let reach = onward * (2.0 * self.fit.overhang + self.fit.thickness);
        let axis = [node.bottom(), node.top()];
        !self.tree.blocks(self.structure, self.node, axis, reach)
    }

    /// Ends that do not lap, and how far each must stay from the axis.
    fn set_back(&self, lap: Option<&Lap>) -> Vec<(Passage, usize, f64)> {
        let laps = |p: &Passage| {
            lap.is_some_and(|lap| {
                lap.passages.iter().any(|q| (q.strip, q.place) == (p.strip, p.place))
            })
        };
        if self.passages.len() < 2 {
            return Vec::new();
        }
        let loose = self.passages.iter().filter(|passage| !laps(passage));
        let ends = loose.filter_map(|passage| Some((passage, passage.end?)));
        ends.map(|(passage, end)| {
            let arm = passage.real_arms().next().unwrap_or_default();
            let arms = &self.structure.nodes()[self.node].arms;
            let others = arms.iter().map(|other| turn(arm, other.angle));
            let others = others.filter(|&between| between > 0.0);
            let clear = others
                .map(|between| self.fit.clear_distance(between.min(2.0 * PI - between)))
                .fold(0.0, f64::max);
            let gap = self.fit.clearance.max(0.0) / 2.0 + self.fit.setback;
            (*passage, end, clear + gap)
        })
        .collect()
    }

    /// Strips that run through without being able to lap.
    fn clash(&self, lap: Option<&Lap>, names: &[String]) -> Option<PartFinding> {
        let through: Vec<&Passage> =
            self.passages.iter().filter(|passage| passage.end.is_none()).collect();
        match through.as_slice() {
            [a, b] if lap.is_none() => Some(PartFinding::StripsTouch {
                first: names[a.strip].clone(),
                second: names[b.strip].clone(),
                node: self.node,
            }),
            [_, _, _, ..] => {
                Some(PartFinding::TooManyStrips { node: self.node, count: through.len() })
            }
            _ => None,
        }
    }
}

/// Smallest angle between the arms of two passages if they cross: one arm of the second
/// on each side of the first.
fn crossing(a: Passage, b: Passage) -> Option<f64> {
    let span = turn(a.before, a.after);
    let left = |arm: f64| turn(a.before, arm) < span;
    if left(b.before) == left(b.after) {
        return None;
    }
    let pairs = [a.before, a.after].into_iter();
    pairs
        .flat_map(|p| [b.before, b.after].map(|q| turn(p, q).min(turn(q, p))))
        .reduce(f64::min)
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

/// From the axis to the slit's wall along `arm`, without clearance
/// (docs/formulas.md §2.1, §2.2).
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
) -> Option<PartFinding> {
    let [first, second] = lap.passages.map(|passage| names[passage.strip].clone());
    let (node, angle_deg) = (lap.node, lap.crossing.to_degrees());
    if lap.crossing < fit.crossing_least {
        let [a, _] = lap.passages;
        let width_mm = joints[a.strip].slits.get(&a.place).map_or(0.0, Slit::width);
        let least_deg = fit.crossing_least.to_degrees();
        Some(PartFinding::CrossingTooSharp {
            first,
            second,
            node,
            angle_deg,
            width_mm,
            least_deg,
        })
    } else if lap.crossing < fit.crossing_warn {
        let play_deg = 180.0 - 2.0 * angle_deg;
        Some(PartFinding::CrossingOblique { first, second, node, angle_deg, play_deg })
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_counter_clockwise() {
        assert!((turn(0.0, PI / 2.0) - PI / 2.0).abs() < 1e-15);
        assert!((turn(PI / 2.0, 0.0) - 1.5 * PI).abs() < 1e-15);
    }
}
