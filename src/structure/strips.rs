//! Strips: families of fins that run straight on through the nodes.
//!
//! At a node inside the mesh with four fins, opposite fins continue each other. At any
//! other node the two fins that continue each other best (kink at most
//! [`Tolerance::straight_kink`]) are paired, then a second pair that lies on both sides of
//! the first; all other fins end there. Fins of two families never continue each other. Of pairs that are equally straight the longer goes
//! first, then the one whose far ends have the smaller numbers.

use crate::geometry::trig;
use crate::ids::{FinId, NodeId, StripId};
use crate::structure::finding::StructureFinding;
use crate::structure::node::{Arm, Node, across};
use crate::tolerance::{SAME_FOLD, SAME_LENGTH_MM, Tolerance};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// A chain of fins.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Strip {
    /// The nodes in order; a closed strip does not repeat its first one.
    pub nodes: Vec<NodeId>,
    /// Whether a fin leads from the last node back to the first.
    pub closed: bool,
}

impl Strip {
    /// Its fins in order, each from the node where one comes to it to the next.
    pub fn steps(&self) -> impl Iterator<Item = [NodeId; 2]> + '_ {
        let back = self.closed.then(|| [self.nodes[self.nodes.len() - 1], self.nodes[0]]);
        self.nodes.windows(2).map(|pair| [pair[0], pair[1]]).chain(back)
    }
}

/// Signed turn at the middle one of three nodes, radians, positive toward travel × axis.
pub(super) fn fold(nodes: &[Node], [from, at, to]: [NodeId; 3]) -> f64 {
    let node = &nodes[at];
    let incoming = -across(node, nodes[from].position);
    let outgoing = across(node, nodes[to].position);
    let normal = incoming.cross(&node.axis);
    trig::atan2(outgoing.dot(&normal), outgoing.dot(&incoming))
}

/// The strips of a structure whose maker did not name any.
pub(super) fn traced(
    nodes: &[Node],
    boundary: &[bool],
    families: &BTreeMap<FinId, Option<u8>>,
    tolerance: &Tolerance,
) -> Vec<Strip> {
    let onward: Vec<BTreeMap<NodeId, NodeId>> = nodes
        .iter()
        .enumerate()
        .map(|(at, node)| {
            let along = |arm: &Arm| Along {
                length: (nodes[arm.to].position - node.position).norm(),
                family: families
                    .get(&FinId::between(at.into(), arm.to))
                    .copied()
                    .flatten(),
            };
            let fins: Vec<Along> = node.arms.iter().map(along).collect();
            continuations(node, &fins, boundary[at], tolerance)
        })
        .collect();
    let mut used = BTreeSet::new();
    let mut strips = Vec::new();
    let starts = |ends_only: bool| {
        let nodes = nodes.iter().enumerate();
        let onward = &onward;
        nodes.flat_map(move |(at, node)| {
            let at = NodeId::new(at);
            node.arms
                .iter()
                .map(move |arm| (at, arm.to))
                .filter(move |&(at, to)| !(ends_only && onward[at].contains_key(&to)))
        })
    };
    for (at, to) in starts(true).chain(starts(false)) {
        if !used.contains(&FinId::between(at, to)) {
            strips.push(walk(&onward, &mut used, [at, to]));
        }
    }
    strips
}

/// A fin of a node: how long it is, mm, and of which family, if that can be told.
struct Along {
    length: f64,
    family: Option<u8>,
}

/// For each fin of a node that runs on: the other end of the fin it comes from, and the
/// other end of the one it runs into.
fn continuations(
    node: &Node,
    fins: &[Along],
    boundary: bool,
    tolerance: &Tolerance,
) -> BTreeMap<NodeId, NodeId> {
    let arms = &node.arms;
    let pairs = if arms.len() == 4 && !boundary {
        vec![(0, 2), (1, 3)]
    } else {
        straightest_pairs(node, fins, tolerance)
    };
    let both =
        |(p, q): (usize, usize)| [(arms[p].to, arms[q].to), (arms[q].to, arms[p].to)];
    pairs.into_iter().flat_map(both).collect()
}

/// Up to two pairs of arms that are straight to within `kink`; the second lies on both
/// sides of the first, as half-laps must.
fn straightest_pairs(
    node: &Node,
    fins: &[Along],
    tolerance: &Tolerance,
) -> Vec<(usize, usize)> {
    let count = node.arms.len();
    let candidates: Vec<Pair> = (0..count)
        .flat_map(|p| (p + 1..count).map(move |q| [p, q]))
        .filter(|arms| {
            let [a, b] = arms.map(|arm| fins[arm].family);
            a.is_none() || b.is_none() || a == b
        })
        .map(|arms| Pair::new(node, fins, arms))
        .filter(|pair| pair.bend <= tolerance.straight_kink + SAME_FOLD)
        .collect();
    let Some(first) = straightest(candidates.iter().collect()) else { return Vec::new() };
    let crossing = candidates.iter().filter(|pair| pair.crosses(first)).collect();
    let second = straightest(crossing);
    std::iter::once(first)
        .chain(second)
        .map(|pair| (pair.arms[0], pair.arms[1]))
        .collect()
}

/// Two arms of a node that may run on as one strip.
struct Pair {
    arms: [usize; 2],
    /// How far from straight, radians.
    bend: f64,
    /// Of both fins, mm.
    length: f64,
    /// Between the far ends.
    ends: FinId,
}

impl Pair {
    fn new(node: &Node, fins: &[Along], arms: [usize; 2]) -> Self {
        let [p, q] = arms.map(|arm| node.arms[arm]);
        Self {
            arms,
            bend: (PI - (q.angle - p.angle)).abs(),
            length: arms.iter().map(|&arm| fins[arm].length).sum(),
            ends: FinId::between(p.to, q.to),
        }
    }

    /// Whether one arm of the other pair lies on each side.
    fn crosses(&self, other: &Self) -> bool {
        let [p, q] = other.arms;
        let inside = |k: usize| p < k && k < q;
        let apart = self.arms.iter().all(|arm| !other.arms.contains(arm));
        apart && inside(self.arms[0]) != inside(self.arms[1])
    }
}

/// The pair that bends least; of equal ones the longest, then the one to the smallest node
/// numbers. Rounding, and how the structure lies in space, decide nothing.
fn straightest(mut pairs: Vec<&Pair>) -> Option<&Pair> {
    let least = pairs.iter().map(|pair| pair.bend).reduce(f64::min)?;
    pairs.retain(|pair| pair.bend <= least + SAME_FOLD);
    let longest = pairs.iter().map(|pair| pair.length).reduce(f64::max)?;
    pairs.retain(|pair| pair.length >= longest - SAME_LENGTH_MM);
    pairs.into_iter().min_by_key(|pair| pair.ends)
}

fn walk(
    onward: &[BTreeMap<NodeId, NodeId>],
    used: &mut BTreeSet<FinId>,
    [start, next]: [NodeId; 2],
) -> Strip {
    let mut nodes = vec![start];
    let (mut from, mut at) = (start, next);
    while used.insert(FinId::between(from, at)) {
        nodes.push(at);
        match onward[at].get(&from) {
            Some(&to) => (from, at) = (at, to),
            None => return Strip { nodes, closed: false },
        }
    }
    nodes.pop();
    Strip { nodes, closed: true }
}

/// The strips a file lists: every step a fin, every fin on one strip.
pub(super) fn given(
    chains: &[Vec<usize>],
    fins: &[FinId],
) -> (Vec<Strip>, Vec<StructureFinding>) {
    let mut uses: BTreeMap<FinId, usize> = fins.iter().map(|&fin| (fin, 0)).collect();
    let mut findings = Vec::new();
    for (strip, chain) in chains.iter().enumerate() {
        for step in chain.windows(2) {
            let (strip, step) = (StripId::new(strip), [step[0].into(), step[1].into()]);
            match uses.get_mut(&step.into()) {
                Some(count) => *count += 1,
                None => findings.push(StructureFinding::StripWithoutFin { strip, step }),
            }
        }
    }
    findings.extend(
        uses.into_iter()
            .filter(|&(_, count)| count != 1)
            .map(|(fin, count)| StructureFinding::FinNotOnOneStrip { fin, count }),
    );
    let strips = chains.iter().filter(|chain| chain.len() > 1).map(|chain| {
        let closed = chain.len() > 3 && chain.first() == chain.last();
        let nodes = chain[..chain.len() - usize::from(closed)].iter();
        let nodes = nodes.copied().map(NodeId::new).collect();
        Strip { nodes, closed }
    });
    (strips.collect(), findings)
}
