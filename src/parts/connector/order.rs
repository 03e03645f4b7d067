//! In which order fins and discs go together.

use crate::parts::connector::Connector;
use crate::parts::part::{Body, Part};
use std::collections::BTreeMap;

/// One step of an assembly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Step {
    /// Index of the part.
    pub part: usize,
    /// Which copies of it, from 1 upward as they lie on the axis.
    pub copies: [usize; 2],
}

/// Strips go in as they are ranked, then the discs at their ends, each from its side.
///
/// The lower disc of a hub comes before its first fin, the upper disc after its last, and so
/// do all eyes of a hinge with their rod; fins follow in the order of a walk over the
/// structure, so that what stands hangs together.
pub fn steps(parts: &[Part]) -> Vec<Step> {
    let mut discs: BTreeMap<usize, usize> = BTreeMap::new();
    let mut left: BTreeMap<usize, usize> = BTreeMap::new();
    let mut at: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut steps = Vec::new();
    for (index, part) in parts.iter().enumerate() {
        match &part.body {
            Body::Fin(fin) => {
                for node in fin.nodes {
                    at.entry(node).or_default().push(index);
                    *left.entry(node).or_default() += 1;
                }
            }
            Body::Connector(connector) => {
                discs.insert(connector.node(), index);
            }
            Body::Strip(_) => steps.push(Step { part: index, copies: [1, 1] }),
            Body::Coupon => {}
        }
    }
    let is_hub = |part: &usize| match &parts[*part].body {
        Body::Connector(body) => matches!(body.connector, Connector::Hub(_)),
        _ => false,
    };
    let mut lower = discs.clone();
    lower.retain(|_, part| is_hub(part));
    for fin in walk(parts, &at) {
        let Body::Fin(body) = &parts[fin].body else { continue };
        let below = body.nodes.iter().filter_map(|node| lower.remove(node));
        steps.extend(below.map(|part| Step { part, copies: [1, 1] }));
        steps.push(Step { part: fin, copies: [1, 1] });
        for node in body.nodes {
            let left = left.entry(node).or_default();
            *left -= 1;
            if let (0, Some(&part)) = (*left, discs.get(&node)) {
                let first = if is_hub(&part) { 2 } else { 1 };
                steps.push(Step { part, copies: [first, parts[part].quantity] });
            }
        }
    }
    let at_strips = lower.into_values().flat_map(|part| {
        [[1, 1], [2, parts[part].quantity]].map(|copies| Step { part, copies })
    });
    steps.extend(at_strips);
    steps
}

/// All fins, each beside one that came before if there is one.
fn walk(parts: &[Part], at: &BTreeMap<usize, Vec<usize>>) -> Vec<usize> {
    let mut seen = vec![false; parts.len()];
    let mut order: Vec<usize> = Vec::new();
    for start in 0..parts.len() {
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
