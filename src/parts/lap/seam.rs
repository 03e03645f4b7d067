//! Where closed strips are opened.

use crate::ids::NodeId;
use crate::parts::hub::dimensions::Hubs;
use crate::structure::{Strip, Structure};
use crate::tolerance::SAME_FOLD;

/// The nodes of each strip in order; a closed one begins and ends at its seam.
///
/// The seam lies on a hub if the strip has one, else at the smallest fold. Where many are
/// equal (rings of a dome) it goes to a node where no other strip runs through, which discs
/// would cut, then to one whose other strips cross fewest seams so far: none should lose all
/// of its joints.
pub(crate) fn opened(structure: &Structure, hubs: &Hubs) -> Vec<Vec<NodeId>> {
    let strips = structure.strips();
    let mut through = vec![Vec::new(); structure.nodes().len()];
    for (index, strip) in strips.iter().enumerate() {
        for &node in &strip.nodes {
            through[node].push(index);
        }
    }
    let mut seams = vec![0_usize; strips.len()];
    let mut chains = Vec::with_capacity(strips.len());
    for (index, strip) in strips.iter().enumerate() {
        if !strip.closed {
            chains.push(strip.nodes.clone());
            continue;
        }
        let key = |place: &usize| {
            let node = strip.nodes[*place];
            let others = || through[node].iter().filter(|&&other| other != index);
            let cut =
                others().filter(|&&other| runs_through(&strips[other], node)).count();
            let crossed: usize = others().map(|&other| seams[other]).sum();
            (cut, crossed)
        };
        let hub = strip.nodes.iter().position(|node| hubs.contains_key(node));
        let equal = hub.map_or_else(|| smallest_folds(structure, strip), |hub| vec![hub]);
        // Successive rings of one numbering are opened well apart.
        let first = index * (equal.len() * 3 / 8).max(1) % equal.len().max(1);
        let turned = equal[first..].iter().chain(&equal[..first]);
        let seam = turned.copied().min_by_key(key).unwrap_or_default();
        for &other in through[strip.nodes[seam]].iter().filter(|&&other| other != index) {
            seams[other] += 1;
        }
        let count = strip.nodes.len();
        chains.push((seam..=seam + count).map(|k| strip.nodes[k % count]).collect());
    }
    chains
}

/// Whether a strip does not end at one of its nodes.
fn runs_through(strip: &Strip, node: NodeId) -> bool {
    let ends = [strip.nodes.first(), strip.nodes.last()];
    strip.closed || !ends.contains(&Some(&node))
}

/// The places of a closed strip whose folds are the smallest.
fn smallest_folds(structure: &Structure, strip: &Strip) -> Vec<usize> {
    let count = strip.nodes.len();
    let node = |k: usize| strip.nodes[k % count];
    let fold = |k: usize| structure.fold(node(k + count - 1), node(k), node(k + 1)).abs();
    let folds: Vec<f64> = (0..count).map(fold).collect();
    let least = folds.iter().copied().fold(f64::INFINITY, f64::min);
    (0..count).filter(|&k| folds[k] <= least + SAME_FOLD).collect()
}
