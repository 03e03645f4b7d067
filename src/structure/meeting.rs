//! Strips that come to a node twice cannot be put together: they are split in between.

use crate::geometry::Point3;
use crate::ids::{NodeId, StripId};
use crate::structure::finding::StructureFinding;
use crate::structure::node::Node;
use crate::structure::strips::{Strip, fold};
use crate::tolerance::{SAME_FOLD, SAME_LENGTH_MM};
use std::collections::BTreeMap;

/// Splits strips that come to a node twice, between the visits: where most such loops are
/// opened at once, and there at the smallest fold.
pub(super) fn without_self_meetings(
    strips: Vec<Strip>,
    nodes: &[Node],
) -> (Vec<Strip>, Vec<StructureFinding>) {
    let mut findings = Vec::new();
    let mut whole = Vec::new();
    for strip in strips {
        let mut rest = vec![opened_if_meeting(strip, nodes)];
        while let Some(strip) = rest.pop() {
            let loops = loops(&strip.nodes);
            let Some(cut) = best_cut(&strip.nodes, &loops, nodes) else {
                whole.push(strip);
                continue;
            };
            let opened = loops.iter().find(|[a, b]| (a + 1..*b).contains(&cut));
            findings.push(StructureFinding::StripSplit {
                strip: StripId::new(whole.len()),
                meets: strip.nodes[opened.map_or(cut, |[a, _]| *a)],
                node: strip.nodes[cut],
            });
            for piece in [&strip.nodes[cut..], &strip.nodes[..=cut]] {
                rest.push(Strip { nodes: piece.to_vec(), closed: false });
            }
        }
    }
    (whole, findings)
}

/// Places of a chain between which it comes back to a node.
fn loops(chain: &[NodeId]) -> Vec<[usize; 2]> {
    let mut seen = BTreeMap::new();
    let visits = chain.iter().enumerate();
    visits.filter_map(|(k, node)| seen.insert(node, k).map(|first| [first, k])).collect()
}

/// The place that opens most loops; of those the smallest fold, then the nearest to the
/// middle of the chain, whichever end it is walked from.
fn best_cut(chain: &[NodeId], loops: &[[usize; 2]], nodes: &[Node]) -> Option<usize> {
    let opened =
        |k: usize| loops.iter().filter(|[a, b]| (a + 1..*b).contains(&k)).count();
    let counts: Vec<usize> = (0..chain.len()).map(opened).collect();
    let most = *counts.iter().max().filter(|&&most| most > 0)?;
    let mut places: Vec<usize> =
        (0..chain.len()).filter(|&k| counts[k] == most).collect();
    let folds = |k: usize| fold(nodes, [chain[k - 1], chain[k], chain[k + 1]]).abs();
    let least = places.iter().map(|&k| folds(k)).reduce(f64::min)?;
    places.retain(|&k| folds(k) <= least + SAME_FOLD);
    let points: Vec<Point3> = chain.iter().map(|&node| nodes[node].position).collect();
    let length = |points: &[Point3]| -> f64 {
        points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
    };
    let off = |k: usize| (length(&points[..=k]) - length(&points[k..])).abs();
    let nearest = places.iter().map(|&k| off(k)).reduce(f64::min)?;
    places.retain(|&k| off(k) <= nearest + SAME_LENGTH_MM);
    places.into_iter().min_by_key(|&k| chain[k])
}

/// A closed strip that meets itself is opened at its smallest fold, so that it can be
/// split.
fn opened_if_meeting(mut strip: Strip, nodes: &[Node]) -> Strip {
    if !strip.closed || loops(&strip.nodes).is_empty() {
        return strip;
    }
    let ring = &strip.nodes;
    let count = ring.len();
    let at = |k: usize| ring[k % count];
    let bend = |k: usize| fold(nodes, [at(k + count - 1), at(k), at(k + 1)]).abs();
    let least = (0..count).map(bend).fold(f64::INFINITY, f64::min);
    let equal = (0..count).filter(|&k| bend(k) <= least + SAME_FOLD);
    let seam = equal.min_by_key(|&k| ring[k]).unwrap_or_default();
    strip.nodes = (seam..=seam + count).map(at).collect();
    strip.closed = false;
    strip
}
