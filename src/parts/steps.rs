//! In which order fins and discs go together.

use crate::ids::{NodeId, PartId};
use crate::parts::part::{Body, Part};
use std::collections::BTreeMap;

/// One step of an assembly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// The part.
    pub part: PartId,
    /// Which copies of it, from 1 upward as they lie on the axis.
    pub copies: [usize; 2],
}

/// Strips go in as they are ranked, one that no slit holds after the lower discs at its ends;
/// the discs that are left follow, each from its side.
///
/// The lower disc of a hub comes before its first fin, the upper disc after its last, and so
/// do all eyes of a hinge with their rod; fins follow in the order of a walk over the
/// structure, so that what stands hangs together.
pub fn steps(parts: &[Part]) -> Vec<Step> {
    let mut sequence = Sequence::new(parts);
    for (id, part) in (0..).map(PartId::new).zip(parts) {
        let Body::Strip(strip) = &part.body else { continue };
        if strip.slits.is_empty() {
            let nodes = part.body.tips().into_iter().map(|tip| tip.axis.node);
            sequence.lay_below(nodes);
        }
        sequence.steps.push(Step { part: id, copies: [1, 1] });
    }
    for fin in walk(parts, &sequence.at) {
        let Body::Fin(body) = &parts[fin].body else { continue };
        sequence.lay_below(body.nodes.into_iter());
        sequence.steps.push(Step { part: fin, copies: [1, 1] });
        for node in body.nodes {
            sequence.stand(node);
        }
    }
    sequence.close();
    sequence.steps
}

/// Steps as they are put together.
struct Sequence<'a> {
    parts: &'a [Part],
    steps: Vec<Step>,
    /// Fins by their nodes.
    at: BTreeMap<NodeId, Vec<PartId>>,
    /// Fins that are still to come, by node.
    left: BTreeMap<NodeId, usize>,
    /// Connectors that are not finished, by node.
    open: BTreeMap<NodeId, PartId>,
    /// Connectors whose lower plates are still to come, by node.
    lower: BTreeMap<NodeId, PartId>,
}

impl<'a> Sequence<'a> {
    fn new(parts: &'a [Part]) -> Self {
        let mut at: BTreeMap<NodeId, Vec<PartId>> = BTreeMap::new();
        let (mut open, mut lower) = (BTreeMap::new(), BTreeMap::new());
        for (id, part) in (0..).map(PartId::new).zip(parts) {
            match &part.body {
                Body::Fin(fin) => {
                    fin.nodes
                        .iter()
                        .for_each(|node| at.entry(*node).or_default().push(id));
                }
                Body::Connector(connector) => {
                    open.insert(connector.node(), id);
                    if connector.plates.laid_first > 0 {
                        lower.insert(connector.node(), id);
                    }
                }
                Body::Strip(_) | Body::Coupon => {}
            }
        }
        let left = at.iter().map(|(node, fins)| (*node, fins.len())).collect();
        Self { parts, steps: Vec::new(), at, left, open, lower }
    }

    /// Lays lower plates that are still to come.
    fn lay_below(&mut self, nodes: impl Iterator<Item = NodeId>) {
        for node in nodes {
            let laid = self.lower.remove(&node);
            let copies = |part: PartId| [1, laid_first(&self.parts[part])];
            self.steps.extend(laid.map(|part| Step { part, copies: copies(part) }));
        }
    }

    /// A fin stands at a node; the last one brings the rest of its connector.
    fn stand(&mut self, node: NodeId) {
        let left = self.left.entry(node).or_default();
        *left -= 1;
        if *left == 0 {
            self.finish(node);
        }
    }

    /// The plates of a node that are still to come.
    fn finish(&mut self, node: NodeId) {
        let Some(part) = self.open.remove(&node) else { return };
        self.lay_below(std::iter::once(node));
        let copies = [laid_first(&self.parts[part]) + 1, self.parts[part].quantity];
        self.steps.push(Step { part, copies });
    }

    /// The connectors that no fin finished: those of strips.
    fn close(&mut self) {
        let nodes: Vec<NodeId> = self.open.keys().copied().collect();
        nodes.into_iter().for_each(|node| self.finish(node));
    }
}

/// How many plates of a connector must lie there before its fins come.
fn laid_first(part: &Part) -> usize {
    match &part.body {
        Body::Connector(connector) => connector.plates.laid_first,
        _ => 0,
    }
}

/// All fins, each beside one that came before if there is one.
fn walk(parts: &[Part], at: &BTreeMap<NodeId, Vec<PartId>>) -> Vec<PartId> {
    let mut seen = vec![false; parts.len()];
    let mut order: Vec<PartId> = Vec::new();
    for start in (0..parts.len()).map(PartId::new) {
        let mut next = order.len();
        let is_fin = matches!(parts[start].body, Body::Fin(_));
        if is_fin && !std::mem::replace(&mut seen[start], true) {
            order.push(start);
        }
        while let Some(&fin) = order.get(next) {
            next += 1;
            let Body::Fin(body) = &parts[fin].body else { continue };
            for &beside in body.nodes.iter().filter_map(|node| at.get(node)).flatten() {
                if !std::mem::replace(&mut seen[beside], true) {
                    order.push(beside);
                }
            }
        }
    }
    order
}
