//! How the faces of a mesh hang together: half-edges, without positions.
//!
//! A [`HalfEdge`] is a side of a face, directed as the face is, counter-clockwise. All
//! half-edges of the mesh along the same two nodes are one edge, in whatever direction and
//! however many they are, so that a mesh that is no surface can be looked at as well and
//! its faults be named. [`twin`](Mesh::twin) leads over an edge only where that is a step
//! on an oriented surface; walks made of it end on any input.
//!
//! Names follow geometry-central's `SurfaceMesh` (Sharp, Crane and others, 2019); nodes,
//! faces and edges are what others call vertices, faces and edges.

mod orientation;
mod walk;

pub use orientation::OneSided;

use crate::ids::{EdgeId, FaceId, HalfEdge, NodeId};
use thiserror::Error;

/// Faces of any number of corners over nodes of any kind.
///
/// Tables are flat and as long as the mesh has half-edges; making one takes time in
/// proportion to that. Half-edges are numbered face by face, edges as they first appear.
///
/// ```
/// use finwright::geometry::Mesh;
/// use finwright::ids::NodeId;
/// // Two quads side by side.
/// let mesh = Mesh::new(6, &[[0, 1, 4, 3], [1, 2, 5, 4]]).unwrap();
/// assert_eq!((mesh.node_count(), mesh.edge_count(), mesh.face_count()), (6, 7, 2));
/// assert_eq!(mesh.euler_characteristic(), 1);
/// let middle = mesh.half_edge(NodeId::new(1), NodeId::new(4)).unwrap();
/// let over = mesh.twin(middle).unwrap();
/// assert_eq!(mesh.face(over).index(), 1);
/// assert_eq!(mesh.tip(mesh.next(over)), NodeId::new(2));
/// assert_eq!(mesh.boundary_loops()[0].len(), 6);
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mesh {
    /// First half-edge of each face, and one more.
    starts: Vec<usize>,
    tails: Vec<NodeId>,
    faces: Vec<FaceId>,
    edges: Vec<EdgeId>,
    /// Of a half-edge without a twin: itself.
    twins: Vec<HalfEdge>,
    outgoing: Lists,
    sides: Lists,
}

/// A face names a node that is not there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("face {face} names node {node}, but there are {nodes} nodes")]
pub struct NoSuchNode {
    /// The face.
    pub face: FaceId,
    /// What it names.
    pub node: NodeId,
    /// How many there are.
    pub nodes: usize,
}

impl Mesh {
    /// The mesh of faces, given by their corners in counter-clockwise order.
    ///
    /// # Errors
    /// [`NoSuchNode`] if a corner is none of `nodes` nodes.
    pub fn new<F, N>(nodes: usize, faces: &[F]) -> Result<Self, NoSuchNode>
    where
        F: AsRef<[N]>,
        N: Copy + Into<NodeId>,
    {
        let mut mesh = Self::without_edges(nodes, faces)?;
        let count = mesh.tails.len();
        mesh.outgoing = Lists::by(nodes, count, |side| mesh.tail(side).index());
        let mut edges = 0;
        for (side, first) in mesh.half_edges().zip(mesh.first_along()) {
            if first == side {
                mesh.edges.push(EdgeId::new(edges));
                edges += 1;
            } else {
                mesh.edges.push(mesh.edges[first]);
            }
        }
        mesh.sides = Lists::by(edges, count, |side| mesh.edge(side).index());
        mesh.twins = mesh.half_edges().collect();
        for edge in mesh.edges() {
            if let &[a, b] = mesh.half_edges_of(edge)
                && mesh.tail(a) != mesh.tail(b)
            {
                (mesh.twins[a], mesh.twins[b]) = (b, a);
            }
        }
        Ok(mesh)
    }

    fn without_edges<F, N>(nodes: usize, faces: &[F]) -> Result<Self, NoSuchNode>
    where
        F: AsRef<[N]>,
        N: Copy + Into<NodeId>,
    {
        let mut mesh = Self {
            starts: vec![0],
            tails: Vec::new(),
            faces: Vec::new(),
            edges: Vec::new(),
            twins: Vec::new(),
            outgoing: Lists::default(),
            sides: Lists::default(),
        };
        for (face, corners) in faces.iter().enumerate() {
            let face = FaceId::new(face);
            for &node in corners.as_ref() {
                let node = node.into();
                if node.index() >= nodes {
                    return Err(NoSuchNode { face, node, nodes });
                }
                mesh.tails.push(node);
                mesh.faces.push(face);
            }
            mesh.starts.push(mesh.tails.len());
        }
        Ok(mesh)
    }

    /// For each half-edge the first one along the same two nodes.
    fn first_along(&self) -> Vec<HalfEdge> {
        let count = self.tails.len();
        let by_lower =
            Lists::by(self.node_count(), count, |h| self.ends_of(h)[0].index());
        let mut first: Vec<HalfEdge> = self.half_edges().collect();
        let mut around = Vec::new();
        for node in self.nodes() {
            around.clear();
            let list = by_lower.list(node.index()).iter();
            around.extend(list.map(|&side| (self.ends_of(side)[1], side)));
            around.sort_unstable();
            for along in around.chunk_by(|a, b| a.0 == b.0) {
                along.iter().for_each(|&(_, side)| first[side] = along[0].1);
            }
        }
        first
    }

    /// Both nodes of a half-edge, the smaller number first.
    fn ends_of(&self, side: HalfEdge) -> [NodeId; 2] {
        let (a, b) = (self.tail(side), self.tip(side));
        [a.min(b), a.max(b)]
    }

    /// How many nodes there are, with a face or without.
    pub fn node_count(&self) -> usize {
        self.outgoing.starts.len() - 1
    }

    /// How many faces there are.
    pub fn face_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// How many edges there are.
    pub fn edge_count(&self) -> usize {
        self.sides.starts.len() - 1
    }

    /// All nodes.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = NodeId> + use<> {
        (0..self.node_count()).map(NodeId::new)
    }

    /// All faces.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = FaceId> + use<> {
        (0..self.face_count()).map(FaceId::new)
    }

    /// All edges, in order of first appearance.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = EdgeId> + use<> {
        (0..self.edge_count()).map(EdgeId::new)
    }

    /// All half-edges, face by face.
    pub fn half_edges(&self) -> impl ExactSizeIterator<Item = HalfEdge> + use<> {
        (0..self.tails.len()).map(HalfEdge::new)
    }

    /// The corners of a face, counter-clockwise.
    pub fn corners(&self, face: FaceId) -> &[NodeId] {
        &self.tails[self.starts[face]..self.starts[face.index() + 1]]
    }

    /// The half-edges of a face, counter-clockwise; the first leaves its first corner.
    pub fn half_edges_around(
        &self,
        face: FaceId,
    ) -> impl DoubleEndedIterator<Item = HalfEdge> + use<> {
        (self.starts[face]..self.starts[face.index() + 1]).map(HalfEdge::new)
    }

    /// The node that a half-edge leaves.
    pub fn tail(&self, side: HalfEdge) -> NodeId {
        self.tails[side]
    }

    /// The node that a half-edge leads to.
    pub fn tip(&self, side: HalfEdge) -> NodeId {
        self.tails[self.next(side)]
    }

    /// The face of a half-edge.
    pub fn face(&self, side: HalfEdge) -> FaceId {
        self.faces[side]
    }

    /// The edge of a half-edge.
    pub fn edge(&self, side: HalfEdge) -> EdgeId {
        self.edges[side]
    }

    /// The half-edge after this one around their face.
    pub fn next(&self, side: HalfEdge) -> HalfEdge {
        let (face, next) = (self.faces[side], side.index() + 1);
        HalfEdge::new(if next == self.starts[face.index() + 1] {
            self.starts[face]
        } else {
            next
        })
    }

    /// The half-edge before this one around their face.
    pub fn prev(&self, side: HalfEdge) -> HalfEdge {
        let face = self.faces[side];
        HalfEdge::new(if side.index() == self.starts[face] {
            self.starts[face.index() + 1] - 1
        } else {
            side.index() - 1
        })
    }

    /// The half-edge that runs along the same edge the other way; none on the boundary,
    /// where more than two faces meet, and where the neighbour is turned round.
    pub fn twin(&self, side: HalfEdge) -> Option<HalfEdge> {
        Some(self.twins[side]).filter(|&twin| twin != side)
    }

    /// The half-edges that leave a node, one for each corner there, in order of faces.
    pub fn outgoing(&self, node: NodeId) -> &[HalfEdge] {
        self.outgoing.list(node.index())
    }

    /// The faces at a node, in their order.
    pub fn faces_at(&self, node: NodeId) -> impl ExactSizeIterator<Item = FaceId> + '_ {
        self.outgoing(node).iter().map(|&side| self.face(side))
    }

    /// The half-edge from one node to another, the first if there are more.
    pub fn half_edge(&self, from: NodeId, to: NodeId) -> Option<HalfEdge> {
        self.outgoing(from).iter().copied().find(|&side| self.tip(side) == to)
    }

    /// The half-edges along an edge: one on the boundary, two inside, more where the mesh
    /// is no surface.
    pub fn half_edges_of(&self, edge: EdgeId) -> &[HalfEdge] {
        self.sides.list(edge.index())
    }

    /// The nodes of an edge, the smaller number first.
    pub fn ends(&self, edge: EdgeId) -> [NodeId; 2] {
        self.ends_of(self.half_edges_of(edge)[0])
    }

    /// Whether an edge has one face only.
    pub fn is_boundary_edge(&self, edge: EdgeId) -> bool {
        self.half_edges_of(edge).len() == 1
    }

    /// Whether each node is an end of an edge with one face only.
    pub fn boundary_nodes(&self) -> Vec<bool> {
        let mut boundary = vec![false; self.node_count()];
        for edge in self.edges().filter(|&edge| self.is_boundary_edge(edge)) {
            self.ends(edge).into_iter().for_each(|node| boundary[node] = true);
        }
        boundary
    }

    /// Edges in which more than two faces meet, in order of first appearance.
    pub fn non_manifold_edges(&self) -> impl Iterator<Item = EdgeId> + '_ {
        self.edges().filter(|&edge| self.half_edges_of(edge).len() > 2)
    }
}

/// Half-edges in lists, one after another in one table.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
struct Lists {
    /// Where each list begins, and where the last one ends.
    starts: Vec<usize>,
    entries: Vec<HalfEdge>,
}

impl Lists {
    /// The first `count` half-edges, each in the list of this number, in their order.
    fn by(lists: usize, count: usize, list: impl Fn(HalfEdge) -> usize) -> Self {
        let half_edges = || (0..count).map(HalfEdge::new);
        let mut starts = vec![0; lists + 1];
        half_edges().for_each(|side| starts[list(side) + 1] += 1);
        for k in 0..lists {
            starts[k + 1] += starts[k];
        }
        let mut free = starts.clone();
        let mut entries: Vec<HalfEdge> = half_edges().collect();
        for side in half_edges() {
            let free = &mut free[list(side)];
            entries[*free] = side;
            *free += 1;
        }
        Self { starts, entries }
    }

    fn list(&self, list: usize) -> &[HalfEdge] {
        &self.entries[self.starts[list]..self.starts[list + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Faces of a grid of `n` by `n` nodes in rows.
    fn grid(n: usize) -> Vec<[usize; 4]> {
        let cells = (0..n * (n - 1)).filter(|k| k % n < n - 1);
        cells.map(|k| [k, k + 1, k + n + 1, k + n]).collect()
    }

    #[test]
    fn steps_around_a_face_and_over_edges_come_back() {
        let mesh = Mesh::new(16, &grid(4)).unwrap();
        for side in mesh.half_edges() {
            assert_eq!(mesh.prev(mesh.next(side)), side);
            assert_eq!(mesh.tail(mesh.next(side)), mesh.tip(side));
            assert!(mesh.half_edges_of(mesh.edge(side)).contains(&side));
            let twin = mesh.twin(side);
            assert!(twin.is_none_or(|twin| mesh.twin(twin) == Some(side)));
            assert!(twin.is_none_or(|twin| mesh.tail(twin) == mesh.tip(side)));
            assert_eq!(twin.is_none(), mesh.is_boundary_edge(mesh.edge(side)));
        }
        assert_eq!(mesh.boundary_nodes().iter().filter(|&&b| !b).count(), 4);
    }

    #[test]
    fn edges_are_numbered_as_they_first_appear() {
        let mesh = Mesh::new(9, &grid(3)).unwrap();
        let ends: Vec<[usize; 2]> =
            mesh.edges().map(|edge| mesh.ends(edge).map(NodeId::index)).collect();
        assert_eq!(ends[..6], [[0, 1], [1, 4], [3, 4], [0, 3], [1, 2], [2, 5]]);
        assert_eq!(ends.len(), 12);
    }

    #[test]
    fn an_edge_of_three_faces_is_named() {
        let mesh = Mesh::new(5, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]).unwrap();
        let edges: Vec<EdgeId> = mesh.non_manifold_edges().collect();
        assert_eq!(edges, [EdgeId::new(0)]);
        assert_eq!(mesh.half_edges_of(edges[0]).len(), 3);
        assert_eq!(mesh.twin(HalfEdge::new(0)), None);
    }

    #[test]
    fn a_corner_that_is_not_there_is_named() {
        let wrong = Mesh::new(3, &[vec![0, 1, 2], vec![2, 1, 3]]).unwrap_err();
        let (face, node) = (FaceId::new(1), NodeId::new(3));
        assert_eq!(wrong, NoSuchNode { face, node, nodes: 3 });
    }

    #[test]
    fn faces_without_sense_do_no_harm() {
        let faces: Vec<Vec<usize>> =
            vec![vec![], vec![0], vec![0, 1], vec![1, 1, 1], vec![0, 1, 0, 2]];
        let mesh = Mesh::new(3, &faces).unwrap();
        assert_eq!(mesh.corners(FaceId::new(0)), []);
        mesh.nodes().for_each(|node| assert!(mesh.ring(node).len() <= 9));
        assert!(mesh.boundary_loops().len() <= 4 && mesh.turned_faces().is_ok());
        assert_eq!(mesh.components().len(), 4);
    }
}
