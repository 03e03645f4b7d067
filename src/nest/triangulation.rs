//! A triangulation (`spade`) by numbers, with what lies inside its closed lines.

use crate::geometry::Point2;
use spade::{ConstrainedDelaunayTriangulation, Triangulation as _};
use std::collections::BTreeMap;

/// An edge of the triangulation, the face to its left and the one to its right.
pub(super) struct Edge {
    pub(super) ends: [usize; 2],
    pub(super) faces: [usize; 2],
    pub(super) fixed: bool,
    pub(super) length: f64,
}

/// A triangulation by numbers; face 0 is all that lies outside the hull.
pub(super) struct Triangulation {
    pub(super) points: Vec<Point2>,
    pub(super) edges: Vec<Edge>,
    /// Corners of each face, counter-clockwise.
    pub(super) faces: Vec<Vec<usize>>,
    pub(super) inside: Vec<bool>,
}

impl Triangulation {
    /// `None` if the rings cross each other or themselves.
    pub(super) fn new(rings: &[Vec<Point2>]) -> Option<Self> {
        let links = rings.iter().flat_map(|ring| {
            ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| [a, b])
        });
        Self::linked(&links.collect::<Vec<_>>())
    }

    /// `None` if the links cross each other.
    pub(super) fn linked(links: &[[Point2; 2]]) -> Option<Self> {
        let mut known: BTreeMap<[u64; 2], usize> = BTreeMap::new();
        let mut corners = Vec::new();
        let mut index = |p: Point2| {
            let key = [p.x + 0.0, p.y + 0.0].map(f64::to_bits);
            let index = *known.entry(key).or_insert(corners.len());
            if index == corners.len() {
                corners.push(spade::Point2::new(p.x, p.y));
            }
            index
        };
        let mut links: Vec<[usize; 2]> =
            links.iter().map(|link| link.map(&mut index)).collect();
        links.retain(|link| link[0] != link[1]);
        let mut crossed = false;
        let cdt = ConstrainedDelaunayTriangulation::<_>::try_bulk_load_cdt(
            corners,
            links,
            |_| crossed = true,
        );
        cdt.ok().filter(|_| !crossed).map(|cdt| Self::numbered(&cdt))
    }

    fn numbered(cdt: &ConstrainedDelaunayTriangulation<spade::Point2<f64>>) -> Self {
        let position = |p: spade::Point2<f64>| Point2::new(p.x, p.y);
        let points: Vec<Point2> =
            cdt.vertices().map(|v| position(v.position())).collect();
        let edges: Vec<Edge> = cdt
            .undirected_edges()
            .map(|edge| {
                let directed = edge.as_directed();
                Edge {
                    ends: [directed.from().index(), directed.to().index()],
                    faces: [directed.face().index(), directed.rev().face().index()],
                    fixed: edge.is_constraint_edge(),
                    length: edge.length_2().sqrt(),
                }
            })
            .collect();
        let mut faces = vec![Vec::new(); cdt.num_all_faces()];
        for face in cdt.inner_faces() {
            faces[face.index()] = face.vertices().iter().map(|v| v.index()).collect();
        }
        let mut triangulation = Self { points, edges, faces, inside: Vec::new() };
        triangulation.inside =
            triangulation.flooded(|edge, inside| Some(inside ^ edge.fixed)).1;
        triangulation
    }

    /// Goes from outside over edges as long as `over` gives the new face a mark: which
    /// faces were reached, and their marks.
    pub(super) fn flooded(
        &self,
        over: impl Fn(&Edge, bool) -> Option<bool>,
    ) -> (Vec<bool>, Vec<bool>) {
        let mut around = vec![Vec::new(); self.faces.len()];
        for edge in &self.edges {
            for k in 0..2 {
                around[edge.faces[k]].push((edge, edge.faces[1 - k]));
            }
        }
        let mut reached = vec![false; self.faces.len()];
        let mut marks = vec![false; self.faces.len()];
        let mut open = vec![0];
        reached[0] = true;
        while let Some(face) = open.pop() {
            for &(edge, next) in &around[face] {
                if reached[next] {
                    continue;
                }
                if let Some(mark) = over(edge, marks[face]) {
                    (reached[next], marks[next]) = (true, mark);
                    open.push(next);
                }
            }
        }
        (reached, marks)
    }

    /// The closed lines around some faces, which lie to their left.
    pub(super) fn rings(&self, solid: impl Fn(usize) -> bool) -> Vec<Vec<Point2>> {
        let mut way: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for edge in &self.edges {
            let [left, right] = edge.faces.map(&solid);
            let [a, b] = edge.ends;
            match (left, right) {
                (true, false) => way.entry(a).or_default().push(b),
                (false, true) => way.entry(b).or_default().push(a),
                _ => {}
            }
        }
        let mut rings = Vec::new();
        while let Some((start, mut next)) = way.pop_first() {
            let mut ring = vec![self.points[start]];
            let mut at = next.pop();
            if !next.is_empty() {
                way.insert(start, next);
            }
            while let Some(corner) = at.filter(|&corner| corner != start) {
                ring.push(self.points[corner]);
                at = way.get_mut(&corner).and_then(Vec::pop);
                if way.get(&corner).is_some_and(Vec::is_empty) {
                    way.remove(&corner);
                }
            }
            rings.push(ring);
        }
        rings
    }
}
