//! Where strips end in discs.
//!
//! A node on which ends of strips cannot lap gets a hub, if its discs have room: then all
//! strips end there, those that ran through are cut. The others are asked again, for a
//! closed strip that was cut has no seam any more.

use crate::ids::{FinId, NodeId, StripId};
use crate::parts::clearance::hub_lacks;
use crate::parts::fit::Fit;
use crate::parts::hub::dimensions::Hub;
use crate::parts::lap::finding::PartFinding;
use crate::parts::lap::join::{End, Joinery, join};
use crate::parts::lap::seam::opened;
use crate::parts::star::Around;
use crate::parts::unfold::{FlatStrip, unfold_without_overlap};
use crate::structure::{Strip, Structure};
use std::collections::{BTreeMap, BTreeSet};

/// What holds the strips that end on a node, by node.
pub type Hubs = BTreeMap<NodeId, Hub>;

/// A structure of strips as they will be cut and joined.
pub(crate) struct Plan {
    /// The structure with its strips as they are cut.
    pub structure: Structure,
    /// The strips in the plane.
    pub flat: Vec<FlatStrip>,
    /// Their joints.
    pub joinery: Joinery,
    /// What holds ends that do not lap.
    pub hubs: Hubs,
    /// Everything found on the way.
    pub findings: Vec<PartFinding>,
}

/// Cuts and joins the strips of a structure; the nodes `asked` get hubs whatever meets there.
pub(crate) fn plan(structure: &Structure, asked: &[NodeId], fit: &Fit) -> Plan {
    let fins = structure.fins().iter().enumerate();
    let index: BTreeMap<FinId, usize> = fins.map(|(k, fin)| (*fin, k)).collect();
    let hub =
        |node: NodeId| Some(Hub::new(Around::new(structure, &index, node, fit)?, fit));
    let nodes = asked.iter().filter(|node| node.index() < structure.nodes().len());
    let mut hubs: Hubs = nodes.filter_map(|&node| Some((node, hub(node)?))).collect();
    let mut refused: BTreeMap<NodeId, String> = BTreeMap::new();
    let mut split: BTreeSet<NodeId> = BTreeSet::new();
    loop {
        let mut plan = joined(structure, hubs, fit, &mut split);
        let loose: BTreeSet<NodeId> = plan.findings.iter().filter_map(loose_at).collect();
        let mut grown = false;
        for node in loose {
            let Some(hub) = hub(node).filter(|_| !refused.contains_key(&node)) else {
                continue;
            };
            match plan.lacks(&hub, fit) {
                Some(why) => drop(refused.insert(node, why)),
                None => {
                    plan.hubs.insert(node, hub);
                    grown = true;
                }
            }
        }
        if !grown {
            plan.say_why(&refused);
            return plan;
        }
        hubs = plan.hubs;
    }
}

/// The node of a finding that says that strips do not hold each other.
fn loose_at(finding: &PartFinding) -> Option<NodeId> {
    match finding {
        PartFinding::StripEndUnheld { node, .. }
        | PartFinding::StripsTouch { node, .. }
        | PartFinding::TooManyStrips { node, .. } => Some(*node),
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
) -> Plan {
    let strips = structure.strips().iter().flat_map(|strip| cut(strip, &hubs));
    let structure = structure.clone().with_strips(strips.collect());
    let flat = flat_strips(&structure, &hubs, split);
    let structure = structure.with_strips(flat.iter().map(chain).collect());
    let (joinery, found) = join(&structure, &flat, fit, &hubs);
    let overlaps = split.iter().filter_map(|&node| {
        let last = |flat: &FlatStrip| flat.axes.last().map(|axis| axis.node);
        let strip = flat.iter().position(|flat| last(flat) == Some(node))?;
        let part = joinery.names[strip].clone();
        Some(PartFinding::OverlapsItself { part, node })
    });
    let findings = overlaps.chain(found).collect();
    Plan { structure, flat, joinery, hubs, findings }
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

impl Plan {
    /// What slits take of each fin at its nodes, by node and the one at the other end, mm.
    pub(crate) fn slits(&self) -> BTreeMap<[NodeId; 2], f64> {
        let mut taken = BTreeMap::new();
        for (flat, joints) in self.flat.iter().zip(&self.joinery.joints) {
            for (&place, slit) in &joints.slits {
                let node = |place: usize| flat.axes.get(place).map(|axis| axis.node);
                let sides = [
                    (place.checked_sub(1).and_then(node), slit.before),
                    (node(place + 1), slit.after),
                ];
                for (to, wall) in sides {
                    taken.extend(to.map(|to| ([slit.node, to], wall)));
                }
            }
        }
        taken
    }

    /// Why a hub has no room beside what holds the other ends of its fins.
    fn lacks(&self, hub: &Hub, fit: &Fit) -> Option<String> {
        let slits = self.slits();
        let node = hub.around.node;
        let taken = |to: NodeId| match self.hubs.get(&to) {
            Some(other) => other.notch[1],
            None => slits.get(&[to, node]).copied().unwrap_or_default(),
        };
        hub_lacks(&self.structure, hub, &taken, fit).map(|finding| finding.to_string())
    }

    /// Tells of ends that nothing holds why discs do not.
    fn say_why(&mut self, refused: &BTreeMap<NodeId, String>) {
        for finding in &mut self.findings {
            if let PartFinding::StripEndUnheld { node, why, .. } = finding {
                *why = refused.get(node).cloned();
            }
        }
    }

    /// The ends, as strip and node, that nothing holds.
    fn unheld(&self) -> BTreeSet<(StripId, NodeId)> {
        let mut unheld = BTreeSet::new();
        let mut held = BTreeSet::new();
        for (strip, (flat, joints)) in
            self.flat.iter().zip(&self.joinery.joints).enumerate()
        {
            let last = flat.axes.len() - 1;
            for (place, axis) in flat.axes.iter().enumerate() {
                let end = match place {
                    0 => Some(joints.ends[0]),
                    k if k == last => Some(joints.ends[1]),
                    _ => None,
                };
                let loose = matches!(end, Some(End::SetBack(_)));
                let into = if loose { &mut unheld } else { &mut held };
                into.insert((StripId::new(strip), axis.node));
            }
        }
        // A closed strip comes to its seam twice; one visit that holds is enough.
        unheld.difference(&held).copied().collect()
    }
}

/// Strips as a mechanism sees them.
#[derive(Debug, Clone, PartialEq)]
pub struct Lapped {
    /// The structure with its strips as they will be cut.
    pub structure: Structure,
    /// The ends, as strip and node, that lap with nothing and stand in no disc.
    pub unheld: BTreeSet<(StripId, NodeId)>,
    /// How far from the axis each hub holds ends against turning, by node, mm.
    pub levers: BTreeMap<NodeId, f64>,
}

/// How the strips of a structure hold each other; the nodes `asked` get hubs.
pub fn lapped(structure: &Structure, asked: &[NodeId], fit: &Fit) -> Lapped {
    let plan = plan(structure, asked, fit);
    Lapped {
        unheld: plan.unheld(),
        levers: plan.hubs.iter().map(|(&node, hub)| (node, hub.slot)).collect(),
        structure: plan.structure,
    }
}
