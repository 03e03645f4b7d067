//! Where closed strips are opened.

use crate::structure::{Strip, Structure};
use crate::tolerance::SAME_FOLD;

/// The nodes of each strip in order; a closed one begins and ends at its seam.
///
/// The seam lies at the smallest fold. Where many are equal (rings of a dome) it goes to a
/// node whose other strips cross fewest seams so far: at a seam a crossing strip has no
/// joint, and none should lose all of its joints.
pub(super) fn opened(structure: &Structure) -> Vec<Vec<usize>> {
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
        let crossed = |place: &usize| -> usize {
            through[strip.nodes[*place]].iter().map(|&other| seams[other]).sum()
        };
        let equal = smallest_folds(structure, strip);
        // Successive rings of one numbering are opened well apart.
        let first = index * (equal.len() * 3 / 8).max(1) % equal.len().max(1);
        let turned = equal[first..].iter().chain(&equal[..first]);
        let seam = turned.copied().min_by_key(crossed).unwrap_or_default();
        for &other in through[strip.nodes[seam]].iter().filter(|&&other| other != index) {
            seams[other] += 1;
        }
        let count = strip.nodes.len();
        chains.push((seam..=seam + count).map(|k| strip.nodes[k % count]).collect());
    }
    chains
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
