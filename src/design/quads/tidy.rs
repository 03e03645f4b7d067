//! Short edges at the boundary are joined: cells there are cut as they come.

use crate::design::quads::{Quads, Rank, sides};
use crate::geometry::Point3;
use std::collections::{BTreeMap, BTreeSet};

/// Joins the ends of edges that touch the boundary and are shorter than `least`, shortest
/// first. Corners keep their place before other boundary nodes, these before inner ones;
/// nothing is joined that would leave the mesh no surface.
pub(in crate::design) fn tidy(
    mut quads: Quads,
    positions: &[Point3],
    least: f64,
) -> Quads {
    let mut at: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); quads.nodes.len()];
    for (face, corners) in quads.faces.iter().enumerate() {
        corners.iter().for_each(|&node| {
            at[node].insert(face);
        });
    }
    let length = |a: usize, b: usize| (positions[a] - positions[b]).norm();
    let mut edges: BTreeMap<(u64, usize, usize), ()> = BTreeMap::new();
    for face in &quads.faces {
        for (a, b) in sides(face) {
            let rank = quads.nodes[a].rank.max(quads.nodes[b].rank);
            if rank > Rank::Inner && length(a, b) < least {
                edges.insert((length(a, b).to_bits(), a.min(b), a.max(b)), ());
            }
        }
    }
    while let Some(((_, a, b), ())) = edges.pop_first() {
        let rank = |node: usize| quads.nodes[node].rank;
        let (keep, drop) = if rank(a) >= rank(b) { (a, b) } else { (b, a) };
        if !may_join(&quads, &at, keep, drop) {
            continue;
        }
        for face in std::mem::take(&mut at[drop]) {
            let corners = &mut quads.faces[face];
            corners
                .iter_mut()
                .filter(|node| **node == drop)
                .for_each(|node| *node = keep);
            corners.dedup();
            while corners.len() > 1 && corners.first() == corners.last() {
                corners.pop();
            }
            at[keep].insert(face);
            if corners.len() < 3 {
                for node in std::mem::take(&mut quads.faces[face]) {
                    at[node].remove(&face);
                }
            }
        }
        for face in at[keep].clone() {
            let corners = quads.faces[face].clone();
            for (a, b) in sides(&corners) {
                if (a == keep || b == keep) && length(a, b) < least {
                    edges.insert((length(a, b).to_bits(), a.min(b), a.max(b)), ());
                }
            }
        }
    }
    compact(quads)
}

/// Whether an edge is there and its ends may become one node.
fn may_join(quads: &Quads, at: &[BTreeSet<usize>], keep: usize, drop: usize) -> bool {
    let shared: Vec<usize> = at[keep].intersection(&at[drop]).copied().collect();
    let beside = |face: &usize| {
        let edge = [keep.min(drop), keep.max(drop)];
        sides(&quads.faces[*face]).any(|(a, b)| [a.min(b), a.max(b)] == edge)
    };
    if shared.is_empty() || !shared.iter().all(beside) || shared.len() > 2 {
        return false;
    }
    // Away from the boundary all faces stay quads.
    let on_rim = |face: &usize| {
        sides(&quads.faces[*face]).any(|(a, b)| at[a].intersection(&at[b]).count() == 1)
    };
    if shared.iter().any(|face| quads.faces[*face].len() == 4 && !on_rim(face)) {
        return false;
    }
    let inner = |node: usize| quads.nodes[node].rank == Rank::Inner;
    // An inner edge from boundary to boundary holds two parts together.
    if shared.len() == 2 && !inner(keep) && !inner(drop) {
        return false;
    }
    // What both know may only be the corners of triangles that vanish.
    let around = |node: usize| -> BTreeSet<usize> {
        let faces = at[node].iter().flat_map(|&face| {
            sides(&quads.faces[face]).filter_map(move |(a, b)| {
                [(a, b), (b, a)]
                    .into_iter()
                    .find(|edge| edge.0 == node)
                    .map(|edge| edge.1)
            })
        });
        faces.collect()
    };
    let vanishing: BTreeSet<usize> = shared
        .iter()
        .filter(|&&face| quads.faces[face].len() == 3)
        .flat_map(|&face| quads.faces[face].iter().copied())
        .collect();
    around(keep).intersection(&around(drop)).all(|node| vanishing.contains(node))
}

/// Drops nodes and faces that are gone.
fn compact(quads: Quads) -> Quads {
    let mut number = vec![None; quads.nodes.len()];
    quads.faces.iter().flatten().for_each(|&node| number[node] = Some(0));
    let mut nodes = Vec::new();
    for (node, number) in number.iter_mut().enumerate() {
        if number.is_some() {
            *number = Some(nodes.len());
            nodes.push(quads.nodes[node]);
        }
    }
    let faces = quads.faces.into_iter().filter(|face| !face.is_empty());
    let renumbered = |face: Vec<usize>| face.iter().filter_map(|&k| number[k]).collect();
    Quads { nodes, faces: faces.map(renumbered).collect() }
}
