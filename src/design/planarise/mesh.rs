//! How nodes, edges and faces of the base mesh hang together; no coordinates.

use crate::structure::face_edges;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// A base mesh with its edges and the rings of neighbours around its nodes.
#[derive(Debug, Clone)]
pub(super) struct Mesh {
    /// Faces, corners counter-clockwise.
    pub faces: Vec<Vec<usize>>,
    /// Each edge once, the smaller node first, in order of first appearance.
    pub edges: Vec<[usize; 2]>,
    /// Whether each edge has one face only.
    pub on_rim: Vec<bool>,
    /// Neighbours of each node, counter-clockwise; on the boundary from rim to rim.
    pub ring: Vec<Vec<usize>>,
    /// Whether each node lies on the boundary.
    pub boundary: Vec<bool>,
    /// Faces at each node.
    pub faces_at: Vec<Vec<usize>>,
}

/// Why faces are no surface.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Fault {
    /// These faces must be turned round to agree with the rest.
    Turned(Vec<usize>),
    /// Going round through these faces ends on the other side.
    OneSided([usize; 2]),
    /// Faces meet at these nodes in more than one fan.
    Fans(Vec<usize>),
}

impl Mesh {
    /// Finds edges and rings; the faces' corners must be in range and no edge may have
    /// more than two faces.
    ///
    /// # Errors
    /// [`Fault`] if the faces are not one oriented surface around every node.
    pub(super) fn new(nodes: usize, faces: &[Vec<usize>]) -> Result<Self, Fault> {
        oriented(faces)?;
        let mut uses: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        let mut edges = Vec::new();
        let mut faces_at = vec![Vec::new(); nodes];
        for (face, corners) in faces.iter().enumerate() {
            corners.iter().for_each(|&node| faces_at[node].push(face));
            for (i, j) in face_edges(corners) {
                let edge = [i.min(j), i.max(j)];
                let count = uses.entry(edge).or_default();
                if *count == 0 {
                    edges.push(edge);
                }
                *count += 1;
            }
        }
        let on_rim: Vec<bool> = edges.iter().map(|edge| uses[edge] == 1).collect();
        let mut boundary = vec![false; nodes];
        for (edge, _) in edges.iter().zip(&on_rim).filter(|(_, on_rim)| **on_rim) {
            edge.iter().for_each(|&node| boundary[node] = true);
        }
        let ring = rings(nodes, faces)?;
        Ok(Self { faces: faces.to_vec(), edges, on_rim, ring, boundary, faces_at })
    }

    /// The two neighbours of a boundary node on the boundary.
    pub(super) fn rim(&self, node: usize) -> Option<[usize; 2]> {
        let ring = &self.ring[node];
        self.boundary[node].then(|| Some([*ring.first()?, *ring.last()?])).flatten()
    }
}

/// Whether neighbouring faces run opposite ways along their common edges.
fn oriented(faces: &[Vec<usize>]) -> Result<(), Fault> {
    let mut sides: BTreeMap<[usize; 2], Vec<(usize, bool)>> = BTreeMap::new();
    for (face, corners) in faces.iter().enumerate() {
        for (i, j) in face_edges(corners) {
            sides.entry([i.min(j), i.max(j)]).or_default().push((face, i < j));
        }
    }
    let mut next: Vec<Vec<(usize, bool)>> = vec![Vec::new(); faces.len()];
    for pair in sides.into_values() {
        if let [(a, up), (b, down)] = pair[..] {
            next[a].push((b, up == down));
            next[b].push((a, up == down));
        }
    }
    let mut turned: Vec<Option<bool>> = vec![None; faces.len()];
    let mut wrong = Vec::new();
    for start in 0..faces.len() {
        if turned[start].is_none() {
            wrong.extend(turned_in_piece(start, &next, &mut turned)?);
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(Fault::Turned(wrong)) }
}

/// The smaller share of a piece's faces that must be turned so that all agree.
fn turned_in_piece(
    start: usize,
    next: &[Vec<(usize, bool)>],
    turned: &mut [Option<bool>],
) -> Result<Vec<usize>, Fault> {
    let mut piece = Vec::new();
    let mut queue = VecDeque::from([start]);
    turned[start] = Some(false);
    while let Some(face) = queue.pop_front() {
        piece.push(face);
        for &(other, against) in &next[face] {
            let wanted = turned[face].map(|turned| turned != against);
            if turned[other].is_none() {
                turned[other] = wanted;
                queue.push_back(other);
            } else if turned[other] != wanted {
                return Err(Fault::OneSided([face, other]));
            }
        }
    }
    let (mut with, mut against): (Vec<usize>, Vec<usize>) =
        piece.into_iter().partition(|&face| turned[face] == Some(false));
    with.sort_unstable();
    against.sort_unstable();
    Ok(if against.len() <= with.len() { against } else { with })
}

/// Neighbours around each node, by stepping over its faces.
fn rings(nodes: usize, faces: &[Vec<usize>]) -> Result<Vec<Vec<usize>>, Fault> {
    let mut onward: Vec<Vec<(usize, usize)>> = vec![Vec::new(); nodes];
    for face in faces {
        for k in 0..face.len() {
            let (before, after) =
                (face[(k + face.len() - 1) % face.len()], face[(k + 1) % face.len()]);
            onward[face[k]].push((after, before));
        }
    }
    let mut fans = Vec::new();
    let rings = onward.iter().enumerate().map(|(node, steps)| {
        let ring = around(steps);
        let neighbours: BTreeSet<usize> =
            steps.iter().flat_map(|&(a, b)| [a, b]).collect();
        if ring.len() < neighbours.len() {
            fans.push(node);
        }
        ring
    });
    let rings = rings.collect();
    if fans.is_empty() { Ok(rings) } else { Err(Fault::Fans(fans)) }
}

fn around(steps: &[(usize, usize)]) -> Vec<usize> {
    let reached = |node: usize| steps.iter().any(|&(_, to)| to == node);
    let open = steps.iter().map(|&(from, _)| from).find(|&from| !reached(from));
    let Some(start) = open.or(steps.iter().map(|&(from, _)| from).min()) else {
        return Vec::new();
    };
    let mut ring = vec![start];
    let mut at = start;
    while let Some(&(_, to)) = steps.iter().find(|&&(from, _)| from == at) {
        if to == start || ring.len() > steps.len() {
            break;
        }
        ring.push(to);
        at = to;
    }
    ring
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strip_joined_with_a_half_turn_has_one_side() {
        let count = 8;
        let mut faces: Vec<Vec<usize>> = (0..count - 1)
            .map(|k| vec![2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1])
            .collect();
        faces.push(vec![2 * count - 2, 1, 0, 2 * count - 1]);
        assert!(matches!(Mesh::new(2 * count, &faces), Err(Fault::OneSided(_))));
    }

    #[test]
    fn the_odd_face_out_is_the_one_to_turn() {
        let faces =
            [vec![0, 1, 4, 3], vec![1, 4, 5, 2], vec![3, 4, 7, 6], vec![4, 5, 8, 7]];
        assert_eq!(Mesh::new(9, &faces).unwrap_err(), Fault::Turned(vec![1]));
    }

    #[test]
    fn two_fans_at_one_node_are_found() {
        let faces = [vec![0, 1, 2, 3], vec![2, 4, 5, 6]];
        assert_eq!(Mesh::new(7, &faces).unwrap_err(), Fault::Fans(vec![2]));
    }

    #[test]
    fn rings_run_from_rim_to_rim() {
        let faces =
            [vec![0, 1, 4, 3], vec![1, 2, 5, 4], vec![3, 4, 7, 6], vec![4, 5, 8, 7]];
        let mesh = Mesh::new(9, &faces).unwrap();
        assert_eq!(mesh.ring[4], [1, 5, 7, 3]);
        assert_eq!(mesh.rim(1), Some([2, 0]));
        assert_eq!(mesh.on_rim.iter().filter(|on_rim| **on_rim).count(), 8);
    }
}
