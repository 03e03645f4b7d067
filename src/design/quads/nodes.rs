//! Nodes where lines cross, and the ports by which lines leave them.

use crate::design::map::{UNIT, cross};
use crate::design::quads::chart::{Charts, is_crossing, minus, way};
use crate::design::quads::{Node, Rank};
use crate::design::surface::previous;

/// A line that leaves a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Port {
    pub node: usize,
    /// The triangle in whose coordinates the rest is said.
    pub triangle: usize,
    pub at: [i64; 2],
    /// Direction in quarters.
    pub way: i32,
    /// The port at the other end of the line.
    pub other: usize,
}

/// A node with its ports, counter-clockwise, on the boundary from the boundary ahead.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Knot {
    pub place: Node,
    pub ports: Vec<usize>,
    /// For a node on a boundary edge: the edge, and how far along it, as a fraction.
    pub on_side: Option<(usize, [i128; 2])>,
}

/// Nodes and lines.
pub(super) struct Net {
    pub nodes: Vec<Knot>,
    pub ports: Vec<Port>,
    /// Nodes inside each triangle or on a side that it owns, with their coordinates.
    pub inside: Vec<Vec<([i64; 2], usize)>>,
    pub at_vertex: Vec<Option<usize>>,
}

/// No port yet.
pub(super) const NONE: usize = usize::MAX;

impl Net {
    pub(super) fn add(&mut self, place: Node, ways: &[(usize, [i64; 2], i32)]) -> usize {
        let node = self.nodes.len();
        let first = self.ports.len();
        self.ports.extend(ways.iter().map(|&(triangle, at, way)| {
            let way = way.rem_euclid(4);
            Port { node, triangle, at, way, other: NONE }
        }));
        let ports = (first..self.ports.len()).collect();
        self.nodes.push(Knot { place, ports, on_side: None });
        node
    }

    /// The port of a node in this direction, as said in this triangle.
    pub(super) fn port(&self, node: usize, triangle: usize, way: i32) -> Option<usize> {
        let ports = self.nodes[node].ports.iter().copied();
        let mut ports = ports.filter(|&port| self.ports[port].triangle == triangle);
        ports.find(|&port| self.ports[port].way == way.rem_euclid(4))
    }
}

/// All nodes but those where lines end at the boundary.
pub(super) fn net(charts: &Charts) -> Net {
    let surface = charts.surface;
    let mut net = Net {
        nodes: Vec::new(),
        ports: Vec::new(),
        inside: vec![Vec::new(); surface.triangles.len()],
        at_vertex: vec![None; surface.positions.len()],
    };
    for vertex in 0..surface.positions.len() {
        if surface.fan(vertex).next().is_some_and(|side| is_crossing(charts.at(side))) {
            let rank =
                if surface.on_boundary(vertex) { Rank::Corner } else { Rank::Inner };
            let place = on_vertex(charts, vertex, rank);
            net.at_vertex[vertex] = Some(net.add(place, &vertex_ways(charts, vertex)));
        }
    }
    for triangle in 0..surface.triangles.len() {
        crossings(charts, triangle, &mut net);
    }
    net
}

/// A node in a vertex.
pub(super) fn on_vertex(charts: &Charts, vertex: usize, rank: Rank) -> Node {
    let corner = charts.surface.fan(vertex).next().unwrap_or(0);
    let mut shares = [0.0; 3];
    shares[corner % 3] = 1.0;
    Node { triangle: corner / 3, shares, vertex: Some(vertex), rank }
}

/// Lines that leave a vertex, sector by sector: from a sector's first side, that one
/// included, to its last. On the boundary strictly between both sides of it.
fn vertex_ways(charts: &Charts, vertex: usize) -> Vec<(usize, [i64; 2], i32)> {
    let mut ways = Vec::new();
    for corner in charts.surface.fan(vertex) {
        let from = charts.along(corner);
        let to = minus(charts.at(previous(corner)), charts.at(corner));
        let along = charts.surface.is_boundary(corner);
        let inside = |quarters: &i32| {
            let d = way(*quarters);
            let dot = i128::from(from[0]) * i128::from(d[0])
                + i128::from(from[1]) * i128::from(d[1]);
            let after = cross(from, d);
            (after > 0 || (after == 0 && dot > 0 && !along)) && cross(d, to) > 0
        };
        let mut own: Vec<i32> = (0..4).filter(inside).collect();
        // Fewer than a half turn: of two neighbours the one a quarter before comes first.
        if let [a, b] = own[..]
            && (a + 1) % 4 != b
        {
            own = vec![b, a];
        }
        ways.extend(own.iter().map(|&way| (corner / 3, charts.at(corner), way)));
    }
    ways
}

/// Nodes within a triangle. One on a side belongs to the triangle with the lower number.
fn crossings(charts: &Charts, triangle: usize, net: &mut Net) {
    let corners = charts.corners(triangle);
    let range = |k: usize| {
        let low = corners.iter().map(|at| at[k]).min().unwrap_or(0);
        let high = corners.iter().map(|at| at[k]).max().unwrap_or(-1);
        -((-low).div_euclid(UNIT))..=high.div_euclid(UNIT)
    };
    for i in range(0) {
        for j in range(1) {
            let at = [i * UNIT, j * UNIT];
            let sides = charts.sides(triangle, at);
            let on: Vec<usize> = (0..3).filter(|&k| sides[k] == 0).collect();
            if sides.iter().any(|&side| side < 0) || on.len() > 1 {
                continue;
            }
            let on = on.first().map(|k| 3 * triangle + k);
            let twin = on.and_then(|side| charts.surface.twin(side));
            if twin.is_some_and(|twin| twin / 3 < triangle) {
                continue;
            }
            let boundary = on.filter(|_| twin.is_none());
            let rank = match boundary {
                Some(side) if charts.surface.is_followed(side) => Rank::Corner,
                Some(_) => Rank::Boundary,
                None => Rank::Inner,
            };
            let shares = charts.shares(triangle, at);
            let place = Node { triangle, shares, vertex: None, rank };
            let ways = match boundary {
                None => (0..4).map(|way| (triangle, at, way)).collect(),
                Some(side) => inward(charts, side, at),
            };
            let node = net.add(place, &ways);
            net.inside[triangle].push((at, node));
            net.nodes[node].on_side =
                boundary.map(|side| (side, share(charts, side, at)));
        }
    }
}

/// Lines that leave a point of a boundary edge to its left, counter-clockwise.
fn inward(charts: &Charts, side: usize, at: [i64; 2]) -> Vec<(usize, [i64; 2], i32)> {
    let mut ways: Vec<i32> = (0..4).filter(|&way| charts.is_left(side, way)).collect();
    if let [a, b] = ways[..]
        && (a + 1) % 4 != b
    {
        ways = vec![b, a];
    }
    ways.into_iter().map(|way| (side / 3, at, way)).collect()
}

/// How far along a half-edge a point of it is.
fn share(charts: &Charts, side: usize, at: [i64; 2]) -> [i128; 2] {
    let (along, by) = (charts.along(side), minus(at, charts.at(side)));
    let dot = |a: [i64; 2], b: [i64; 2]| {
        i128::from(a[0]) * i128::from(b[0]) + i128::from(a[1]) * i128::from(b[1])
    };
    [dot(by, along), dot(along, along)]
}
