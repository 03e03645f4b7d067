//! Strips: families of fins that run straight on through the nodes.
//!
//! At a node inside the mesh with four fins, opposite fins continue each other. At any
//! other node the two fins that continue each other best (kink at most
//! [`Tolerance::straight_kink`]) are paired, then a second pair that lies on both sides of
//! the first; all other fins end there.

use crate::geometry::trig;
use crate::structure::finding::StructureFinding;
use crate::structure::node::{Node, across};
use crate::tolerance::Tolerance;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// A chain of fins.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Strip {
    /// The nodes in order; a closed strip does not repeat its first one.
    pub nodes: Vec<usize>,
    /// Whether a fin leads from the last node back to the first.
    pub closed: bool,
}

impl Strip {
    /// The fins in order, in the direction of travel.
    pub fn fins(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let back = self.closed.then(|| [self.nodes[self.nodes.len() - 1], self.nodes[0]]);
        self.nodes.windows(2).map(|pair| [pair[0], pair[1]]).chain(back)
    }
}

/// Signed turn at the middle one of three nodes, radians, positive toward travel × axis.
pub(super) fn fold(nodes: &[Node], [from, at, to]: [usize; 3]) -> f64 {
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
    tolerance: &Tolerance,
) -> Vec<Strip> {
    let onward: Vec<BTreeMap<usize, usize>> = nodes
        .iter()
        .zip(boundary)
        .map(|(node, &boundary)| continuations(node, boundary, tolerance))
        .collect();
    let mut used = BTreeSet::new();
    let mut strips = Vec::new();
    let starts = |ends_only: bool| {
        let nodes = nodes.iter().enumerate();
        let onward = &onward;
        nodes.flat_map(move |(at, node)| {
            node.arms
                .iter()
                .map(move |arm| (at, arm.to))
                .filter(move |&(at, to)| !(ends_only && onward[at].contains_key(&to)))
        })
    };
    for (at, to) in starts(true).chain(starts(false)) {
        if !used.contains(&[at.min(to), at.max(to)]) {
            strips.push(walk(&onward, &mut used, [at, to]));
        }
    }
    strips
}

/// For each fin of a node that runs on: the other end of the fin it comes from, and the
/// other end of the one it runs into.
fn continuations(
    node: &Node,
    boundary: bool,
    tolerance: &Tolerance,
) -> BTreeMap<usize, usize> {
    let arms = &node.arms;
    let pairs = if arms.len() == 4 && !boundary {
        vec![(0, 2), (1, 3)]
    } else {
        straightest_pairs(node, tolerance.straight_kink)
    };
    let both =
        |(p, q): (usize, usize)| [(arms[p].to, arms[q].to), (arms[q].to, arms[p].to)];
    pairs.into_iter().flat_map(both).collect()
}

/// Up to two pairs of arms that are straight to within `kink`; the second lies on both
/// sides of the first, as half-laps must.
fn straightest_pairs(node: &Node, kink: f64) -> Vec<(usize, usize)> {
    let count = node.arms.len();
    let bend =
        |p: usize, q: usize| (PI - (node.arms[q].angle - node.arms[p].angle)).abs();
    let mut candidates: Vec<(usize, usize)> = (0..count)
        .flat_map(|p| (p + 1..count).map(move |q| (p, q)))
        .filter(|&(p, q)| bend(p, q) <= kink)
        .collect();
    candidates.sort_by(|&(a, b), &(c, d)| {
        bend(a, b).total_cmp(&bend(c, d)).then((a, b).cmp(&(c, d)))
    });
    let Some(&(p, q)) = candidates.first() else { return Vec::new() };
    let inside = |k: usize| p < k && k < q;
    let second = candidates.iter().find(|&&(r, s)| {
        ![r, s].contains(&p) && ![r, s].contains(&q) && inside(r) != inside(s)
    });
    std::iter::once((p, q)).chain(second.copied()).collect()
}

fn walk(
    onward: &[BTreeMap<usize, usize>],
    used: &mut BTreeSet<[usize; 2]>,
    [start, next]: [usize; 2],
) -> Strip {
    let mut nodes = vec![start];
    let (mut from, mut at) = (start, next);
    while used.insert([from.min(at), from.max(at)]) {
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
    fins: &[[usize; 2]],
) -> (Vec<Strip>, Vec<StructureFinding>) {
    let mut uses: BTreeMap<[usize; 2], usize> =
        fins.iter().map(|&fin| (fin, 0)).collect();
    let mut findings = Vec::new();
    for (strip, chain) in chains.iter().enumerate() {
        for step in chain.windows(2) {
            match uses.get_mut(&[step[0].min(step[1]), step[0].max(step[1])]) {
                Some(count) => *count += 1,
                None => findings.push(StructureFinding::StripWithoutFin {
                    strip,
                    step: [step[0], step[1]],
                }),
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
        let nodes = chain[..chain.len() - usize::from(closed)].to_vec();
        Strip { nodes, closed }
    });
    (strips.collect(), findings)
}

/// Splits strips that come to a node twice, between the two visits, where the fold is
/// smallest.
pub(super) fn without_self_meetings(
    strips: Vec<Strip>,
    nodes: &[Node],
) -> (Vec<Strip>, Vec<StructureFinding>) {
    let mut findings = Vec::new();
    let mut whole = Vec::new();
    for strip in strips {
        let mut rest = opened_if_meeting(strip);
        while let Some((first, second)) = first_meeting(&rest.nodes) {
            let fold_at = |k: usize| {
                fold(nodes, [rest.nodes[k - 1], rest.nodes[k], rest.nodes[k + 1]]).abs()
            };
            let cut = (first + 1..second)
                .min_by(|&a, &b| fold_at(a).total_cmp(&fold_at(b)))
                .unwrap_or(second);
            findings.push(StructureFinding::StripSplit {
                strip: whole.len(),
                meets: rest.nodes[second],
                node: rest.nodes[cut],
            });
            let head = rest.nodes[..=cut].to_vec();
            whole.push(Strip { nodes: head, closed: false });
            rest.nodes.drain(..cut);
        }
        whole.push(rest);
    }
    (whole, findings)
}

/// A closed strip that meets itself is opened at its first node, so that it can be split.
fn opened_if_meeting(mut strip: Strip) -> Strip {
    if strip.closed && first_meeting(&strip.nodes).is_some() {
        strip.nodes.push(strip.nodes[0]);
        strip.closed = false;
    }
    strip
}

/// The first two places of a chain that are one node.
fn first_meeting(chain: &[usize]) -> Option<(usize, usize)> {
    let mut seen = BTreeMap::new();
    chain
        .iter()
        .enumerate()
        .find_map(|(k, node)| seen.insert(node, k).map(|first| (first, k)))
}
