//! Where strips get hubs.
//!
//! A node on which ends of strips cannot lap gets a hub, if its discs have room: then all
//! strips end there, those that ran through are cut. The others are asked again, for a
//! closed strip that was cut has no seam any more.

use crate::ids::NodeId;
use crate::parts::fit::Fit;
use crate::parts::hub::checks::obstacle;
use crate::parts::hub::dimensions::{Hub, Hubs};
use crate::parts::lap::finding::LapFinding;
use crate::parts::lap::join::join;
use crate::parts::lap::seam::opened;
use crate::parts::lap::strips::Strips;
use crate::parts::star::{Star, indices};
use crate::parts::unfold::{FlatStrip, unfold_without_overlap};
use crate::structure::{Strip, Structure};
use std::collections::{BTreeMap, BTreeSet};

/// Strips cut and joined, with the structure that has them.
pub(super) struct Joined {
    /// The structure with its strips as they are cut.
    pub structure: Structure,
    /// Its strips.
    pub strips: Strips,
    /// Everything found on the way.
    pub findings: Vec<LapFinding>,
}

/// Cuts and joins the strips of a structure; the nodes `asked` get hubs whatever meets there.
pub(super) fn placed(structure: &Structure, asked: &[NodeId], fit: &Fit) -> Joined {
    let index = indices(structure);
    let hub = |node: NodeId| Some(Hub::new(Star::of(structure, &index, node, fit)?, fit));
    let nodes = asked.iter().filter(|node| node.index() < structure.nodes().len());
    let mut hubs: Hubs = nodes.filter_map(|&node| Some((node, hub(node)?))).collect();
    let mut refused: BTreeMap<NodeId, String> = BTreeMap::new();
    let mut split: BTreeSet<NodeId> = BTreeSet::new();
    loop {
        let mut joined = joined(structure, hubs, fit, &mut split);
        let loose: BTreeSet<NodeId> =
            joined.findings.iter().filter_map(loose_at).collect();
        let mut grown = false;
        for node in loose {
            let Some(hub) = hub(node).filter(|_| !refused.contains_key(&node)) else {
                continue;
            };
            match joined.obstacle(&hub, fit) {
                Some(why) => drop(refused.insert(node, why)),
                None => {
                    joined.strips.hubs.insert(node, hub);
                    grown = true;
                }
            }
        }
        if !grown {
            joined.say_why(&refused);
            return joined;
        }
        hubs = joined.strips.hubs;
    }
}

/// The node of a finding that says that strips do not hold each other.
fn loose_at(finding: &LapFinding) -> Option<NodeId> {
    match finding {
        LapFinding::StripEndUnheld { node, .. }
        | LapFinding::StripsTouch { node, .. }
        | LapFinding::TooManyStrips { node, .. } => Some(*node),
        _ => None,
    }
}

/// The strips cut at all hubs, unfolded and joined. `split` gets the nodes at which one was
/// split that would lie over itself; once split, it ends there in discs.
fn joined(
    structure: &Structure,
    hubs: Hubs,
    fit: &Fit,
    split: &mut BTreeSet<NodeId>,
) -> Joined {
    let strips = structure.strips().iter().flat_map(|strip| cut(strip, &hubs));
    let structure = structure.clone().with_strips(strips.collect());
    let flat = flat_strips(&structure, &hubs, split);
    let structure = structure.with_strips(flat.iter().map(chain).collect());
    let (joinery, found) = join(&structure, &flat, fit, &hubs);
    let overlaps = split.iter().filter_map(|&node| {
        let last = |flat: &FlatStrip| flat.axes.last().map(|axis| axis.node);
        let strip = flat.iter().position(|flat| last(flat) == Some(node))?;
        let part = joinery.names[strip].clone();
        Some(LapFinding::OverlapsItself { part, node })
    });
    let findings = overlaps.chain(found).collect();
    let strips = Strips { flat, joinery, hubs };
    Joined { structure, strips, findings }
}

/// A strip cut at every hub that it runs through; a closed one with one hub stays closed.
fn cut(strip: &Strip, hubs: &Hubs) -> Vec<Strip> {
    let is_hub = |node: &NodeId| hubs.contains_key(node);
    let mut nodes = strip.nodes.clone();
    if let Some(first) = nodes.iter().position(is_hub).filter(|_| strip.closed) {
        nodes.rotate_left(first);
        if nodes.iter().filter(|node| is_hub(node)).count() == 1 {
            return vec![Strip { nodes, closed: true }];
        }
        nodes.push(nodes[0]);
    } else if strip.closed {
        return vec![strip.clone()];
    }
    let last = nodes.len() - 1;
    let inner = (1..last).filter(|&place| is_hub(&nodes[place]));
    let cuts: Vec<usize> = std::iter::once(0).chain(inner).chain([last]).collect();
    let piece = |ends: &[usize]| Strip {
        nodes: nodes[ends[0]..=ends[1]].to_vec(),
        closed: false,
    };
    cuts.windows(2).map(piece).collect()
}

/// All strips unfolded; the nodes at which one had to be split go into `split`.
fn flat_strips(
    structure: &Structure,
    hubs: &Hubs,
    split: &mut BTreeSet<NodeId>,
) -> Vec<FlatStrip> {
    let mut flat = Vec::new();
    let chains = opened(structure, hubs);
    for (strip, chain) in structure.strips().iter().zip(chains) {
        let (pieces, cuts) = unfold_without_overlap(structure, &chain, strip.closed);
        split.extend(cuts);
        flat.extend(pieces);
    }
    flat
}

fn chain(flat: &FlatStrip) -> Strip {
    let nodes = flat.axes.iter().map(|axis| axis.node);
    let count = flat.axes.len() - usize::from(flat.closed);
    Strip { nodes: nodes.take(count).collect(), closed: flat.closed }
}

impl Joined {
    /// Why a hub has no room beside what holds the other ends of its fins.
    fn obstacle(&self, hub: &Hub, fit: &Fit) -> Option<String> {
        let slits = self.strips.slits();
        let node = hub.star.node;
        let taken = |to: NodeId| match self.strips.hubs.get(&to) {
            Some(other) => other.notch[1],
            None => slits.get(&[to, node]).copied().unwrap_or_default(),
        };
        obstacle(&self.structure, hub, &taken, fit).map(|finding| finding.to_string())
    }

    /// Tells of ends that nothing holds why discs do not.
    fn say_why(&mut self, refused: &BTreeMap<NodeId, String>) {
        for finding in &mut self.findings {
            if let LapFinding::StripEndUnheld { node, why, .. } = finding {
                *why = refused.get(node).cloned();
            }
        }
    }
}
