//! Around nodes, along the boundary, and over whole components.

use crate::geometry::DisjointSets;
use crate::geometry::mesh::Mesh;
use crate::ids::{EdgeId, FaceId, HalfEdge, NodeId};
use std::iter::successors;

impl Mesh {
    /// How many fans the faces around a node make: one on a surface, none at a loose node.
    /// Faces that share an edge at the node are in the same fan.
    pub fn fan_count(&self, node: NodeId) -> usize {
        let corners = self.outgoing(node);
        if corners.len() < 2 {
            return corners.len();
        }
        let spokes = corners.iter().enumerate().flat_map(|(corner, &side)| {
            [(self.edge(side), corner), (self.edge(self.prev(side)), corner)]
        });
        let mut spokes: Vec<(EdgeId, usize)> = spokes.collect();
        spokes.sort_unstable();
        let mut fans = DisjointSets::new(corners.len());
        for pair in spokes.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            fans.join(pair[0].1, pair[1].1);
        }
        fans.firsts().len()
    }

    /// Nodes around which the faces are not one fan, with how many fans they are.
    pub fn non_manifold_nodes(&self) -> impl Iterator<Item = (NodeId, usize)> + '_ {
        let fans = self.nodes().map(|node| (node, self.fan_count(node)));
        fans.filter(|&(_, fans)| fans > 1)
    }

    /// Half-edges that leave the same node as `start`, counter-clockwise from it: around
    /// the node, or up to the boundary.
    pub fn fan(&self, start: HalfEdge) -> impl Iterator<Item = HalfEdge> + '_ {
        let onward = move |&side: &HalfEdge| {
            self.twin(self.prev(side)).filter(|&next| next != start)
        };
        successors(Some(start), onward)
    }

    /// Neighbours of a node of an oriented surface, counter-clockwise: on the boundary from
    /// end to end, inside from the one with the smallest number on.
    pub fn ring(&self, node: NodeId) -> Vec<NodeId> {
        let sides = || self.outgoing(node).iter().copied();
        let open = sides().find(|&side| self.twin(side).is_none());
        let Some(start) = open.or(sides().min_by_key(|&side| self.tip(side))) else {
            return Vec::new();
        };
        let mut ring = vec![self.tip(start)];
        ring.extend(self.fan(start).map(|side| self.tail(self.prev(side))));
        if open.is_none() {
            ring.pop();
        }
        ring
    }

    /// The boundary half-edges that leave a node of an oriented surface and lead to it.
    pub fn boundary_at(&self, node: NodeId) -> Option<[HalfEdge; 2]> {
        let alone = |&side: &HalfEdge| self.is_boundary_edge(self.edge(side));
        let out = self.outgoing(node).iter().copied().find(alone)?;
        let back = self.outgoing(node).iter().map(|&side| self.prev(side)).find(alone)?;
        Some([out, back])
    }

    /// The closed lines of the boundary of an oriented mesh, faces to their left; where
    /// several pass through a node, each keeps to its fan. Faults of orientation leave
    /// lines that are not closed.
    pub fn boundary_loops(&self) -> Vec<Vec<HalfEdge>> {
        let alone = |side: HalfEdge| self.is_boundary_edge(self.edge(side));
        let onward = |side: HalfEdge| {
            let mut next = self.next(side);
            while let Some(twin) = self.twin(next) {
                next = self.next(twin);
            }
            next
        };
        let mut seen = vec![false; self.tails.len()];
        let mut loops = Vec::new();
        for start in self.half_edges().filter(|&side| alone(side)) {
            let mut along = Vec::new();
            let mut at = start;
            while alone(at) && !seen[at] {
                seen[at] = true;
                along.push(at);
                at = onward(at);
            }
            if !along.is_empty() {
                loops.push(along);
            }
        }
        loops
    }

    /// Faces that hang together by edges, each set in order, in order of their first faces.
    pub fn components(&self) -> Vec<Vec<FaceId>> {
        let mut sets = DisjointSets::new(self.face_count());
        for edge in self.edges() {
            for pair in self.half_edges_of(edge).windows(2) {
                sets.join(self.face(pair[0]).index(), self.face(pair[1]).index());
            }
        }
        let mut place = vec![0; self.face_count()];
        let firsts = sets.firsts();
        firsts.iter().enumerate().for_each(|(k, &first)| place[first] = k);
        let mut components = vec![Vec::new(); firsts.len()];
        for face in self.faces() {
            components[place[sets.first_of(face.index())]].push(face);
        }
        components
    }

    /// Nodes that have a face, less edges, plus faces (Euler and Poincaré): 2 of a sphere,
    /// 1 of a disc, 0 of a ring or a torus.
    pub fn euler_characteristic(&self) -> isize {
        let used = self.nodes().filter(|&node| !self.outgoing(node).is_empty()).count();
        (used + self.face_count()) as isize - self.edge_count() as isize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nodes(nodes: &[usize]) -> Vec<NodeId> {
        nodes.iter().copied().map(NodeId::new).collect()
    }

    #[test]
    fn rings_run_from_end_to_end_of_the_boundary() {
        let faces = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]];
        let mesh = Mesh::new(9, &faces).unwrap();
        assert_eq!(mesh.ring(NodeId::new(4)), nodes(&[1, 5, 7, 3]));
        assert_eq!(mesh.ring(NodeId::new(1)), nodes(&[2, 4, 0]));
        let [out, back] = mesh.boundary_at(NodeId::new(1)).unwrap();
        assert_eq!([mesh.tip(out), mesh.tail(back)], [2, 0].map(NodeId::new));
        assert_eq!(mesh.boundary_at(NodeId::new(4)), None);
    }

    #[test]
    fn two_fans_at_one_node_are_found_and_the_boundary_keeps_to_each() {
        let mesh = Mesh::new(7, &[[0, 1, 2, 3], [2, 4, 5, 6]]).unwrap();
        let found: Vec<(NodeId, usize)> = mesh.non_manifold_nodes().collect();
        assert_eq!(found, [(NodeId::new(2), 2)]);
        let loops = mesh.boundary_loops();
        assert_eq!(loops.iter().map(Vec::len).collect::<Vec<_>>(), [4, 4]);
        assert_eq!(mesh.components().len(), 2);
    }

    #[test]
    fn a_closed_sphere_has_no_boundary() {
        let octahedron = [
            [0, 2, 4],
            [2, 1, 4],
            [1, 3, 4],
            [3, 0, 4],
            [2, 0, 5],
            [1, 2, 5],
            [3, 1, 5],
            [0, 3, 5],
        ];
        let mesh = Mesh::new(6, &octahedron).unwrap();
        assert_eq!(mesh.euler_characteristic(), 2);
        assert!(mesh.boundary_loops().is_empty());
        assert_eq!(mesh.non_manifold_nodes().count(), 0);
        assert_eq!(mesh.turned_faces().unwrap(), []);
        assert_eq!(mesh.ring(NodeId::new(4)), nodes(&[0, 2, 1, 3]));
    }

    #[test]
    fn an_annulus_has_two_boundary_loops_and_a_loose_node_no_part() {
        let count = 6;
        let quad = |k: usize| {
            let next = (k + 1) % count;
            [k, next, count + next, count + k]
        };
        let faces: Vec<[usize; 4]> = (0..count).map(quad).collect();
        let mesh = Mesh::new(2 * count + 1, &faces).unwrap();
        let loops = mesh.boundary_loops();
        assert_eq!(loops.iter().map(Vec::len).collect::<Vec<_>>(), [count, count]);
        for line in &loops {
            let after = line.iter().cycle().skip(1);
            assert!(line.iter().zip(after).all(|(&a, &b)| mesh.tip(a) == mesh.tail(b)));
        }
        assert_eq!(mesh.euler_characteristic(), 0);
        assert_eq!(mesh.components().len(), 1);
        let loose = NodeId::new(2 * count);
        assert_eq!((mesh.fan_count(loose), mesh.ring(loose).len()), (0, 0));
    }
}
