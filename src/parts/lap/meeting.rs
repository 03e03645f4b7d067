//! Which of the strips at a node lap, and what becomes of the others.

use crate::geometry::Vector3;
use crate::ids::NodeId;
use crate::parts::fit::Fit;
use crate::parts::lap::finding::LapFinding;
use crate::parts::lap::passage::{Passage, crossing, turn};
use crate::structure::{FinTree, Structure};
use std::f64::consts::PI;

/// Two passages that lap, and the smallest of the four angles between their arms.
pub(super) struct Lap {
    pub node: NodeId,
    pub passages: [Passage; 2],
    pub crossing: f64,
}

impl Lap {
    pub(super) fn strips(&self) -> [usize; 2] {
        self.passages.map(|passage| passage.strip)
    }
}

/// The strips at one node.
pub(super) struct Meeting<'a> {
    pub structure: &'a Structure,
    pub tree: &'a FinTree,
    pub fit: &'a Fit,
    pub node: NodeId,
    pub passages: &'a [Passage],
}

impl Meeting<'_> {
    /// The two strips that lap here: two alone, or the two that run through.
    pub(super) fn lap(&self) -> Option<Lap> {
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
    pub(super) fn set_back(&self, lap: Option<&Lap>) -> Vec<(Passage, usize, f64)> {
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
    pub(super) fn clash(
        &self,
        lap: Option<&Lap>,
        names: &[String],
    ) -> Option<LapFinding> {
        let through: Vec<&Passage> =
            self.passages.iter().filter(|passage| passage.end.is_none()).collect();
        match through.as_slice() {
            [a, b] if lap.is_none() => Some(LapFinding::StripsTouch {
                first: names[a.strip].clone(),
                second: names[b.strip].clone(),
                node: self.node,
            }),
            [_, _, _, ..] => {
                Some(LapFinding::TooManyStrips { node: self.node, count: through.len() })
            }
            _ => None,
        }
    }
}
