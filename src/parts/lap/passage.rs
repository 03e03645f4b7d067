//! How strips run through or end at a node.

use crate::ids::NodeId;
use crate::parts::unfold::FlatStrip;
use crate::structure::Structure;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// A strip at one of its nodes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Passage {
    pub strip: usize,
    pub place: usize,
    /// Bearings of its two arms: toward the previous and toward the next node. At an end
    /// one of them is the overhang.
    pub before: f64,
    pub after: f64,
    /// Which end of the strip it is, if it is one.
    pub end: Option<usize>,
}

impl Passage {
    pub(super) fn kink(&self) -> f64 {
        (PI - turn(self.before, self.after)).abs()
    }

    pub(super) fn real_arms(&self) -> impl Iterator<Item = f64> {
        let arms = [(self.before, Some(0)), (self.after, Some(1))];
        let end = self.end;
        arms.into_iter().filter(move |arm| arm.1 != end || end.is_none()).map(|arm| arm.0)
    }
}

/// Counter-clockwise angle from one bearing to another, in [0, 2π).
pub(super) fn turn(from: f64, to: f64) -> f64 {
    let turn = (to - from) % (2.0 * PI);
    if turn < 0.0 { turn + 2.0 * PI } else { turn }
}

/// All strips at each node, in the order of the strips.
pub(super) fn passages(
    structure: &Structure,
    strips: &[FlatStrip],
) -> BTreeMap<NodeId, Vec<Passage>> {
    let mut at: BTreeMap<NodeId, Vec<Passage>> = BTreeMap::new();
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

/// Smallest angle between the arms of two passages if they cross: one arm of the second
/// on each side of the first.
pub(super) fn crossing(a: Passage, b: Passage) -> Option<f64> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_counter_clockwise() {
        assert!((turn(0.0, PI / 2.0) - PI / 2.0).abs() < 1e-15);
        assert!((turn(PI / 2.0, 0.0) - 1.5 * PI).abs() < 1e-15);
    }
}
