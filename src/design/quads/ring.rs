//! Nodes along the boundary, in their order.

use crate::design::quads::chart::Charts;
use crate::design::quads::nodes::{Net, on_vertex};
use crate::design::quads::trace::Stop;
use crate::design::quads::{Node, Rank};
use crate::design::surface::next;
use std::collections::{BTreeMap, BTreeSet};

/// Fewest nodes of a boundary loop that is to stay open.
const FEWEST: usize = 3;

/// Makes nodes where lines end at the boundary and in its corners, and returns the nodes of
/// each boundary loop, with the surface on their left.
pub(super) fn rings(
    charts: &Charts,
    net: &mut Net,
    stops: Vec<Stop>,
    corners: &BTreeSet<usize>,
) -> Vec<Vec<usize>> {
    for stop in stops {
        stopped(charts, net, &stop);
    }
    let mut on_side: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (node, knot) in net.nodes.iter().enumerate() {
        knot.on_side.iter().for_each(|on| on_side.entry(on.0).or_default().push(node));
    }
    for nodes in on_side.values_mut() {
        nodes.sort_by(|&a, &b| {
            let share = |node: usize| net.nodes[node].on_side.map_or([0, 1], |on| on.1);
            let ([a, of_a], [b, of_b]) = (share(a), share(b));
            (a * of_b).cmp(&(b * of_a))
        });
    }
    let mut rings = Vec::new();
    for ring in charts.surface.boundary() {
        for &side in &ring {
            let vertex = charts.surface.tail(side);
            if corners.contains(&vertex) && net.at_vertex[vertex].is_none() {
                cornered(charts, net, vertex);
            }
        }
        let mut nodes = around(charts, net, &on_side, &ring);
        if nodes.len() < FEWEST {
            for k in 0..FEWEST {
                let vertex = charts.surface.tail(ring[k * ring.len() / FEWEST]);
                if net.at_vertex[vertex].is_none() {
                    cornered(charts, net, vertex);
                }
            }
            nodes = around(charts, net, &on_side, &ring);
        }
        rings.push(nodes);
    }
    rings
}

fn around(
    charts: &Charts,
    net: &Net,
    on_side: &BTreeMap<usize, Vec<usize>>,
    ring: &[usize],
) -> Vec<usize> {
    let along = |&side: &usize| {
        let first = net.at_vertex[charts.surface.tail(side)];
        let rest = on_side.get(&side).into_iter().flatten().copied();
        first.into_iter().chain(rest).collect::<Vec<_>>()
    };
    ring.iter().flat_map(along).collect()
}

/// A node where a line ends.
fn stopped(charts: &Charts, net: &mut Net, stop: &Stop) {
    let share = stop.share[0] as f64 / stop.share[1] as f64;
    let mut shares = [0.0; 3];
    shares[stop.side % 3] = 1.0 - share;
    shares[next(stop.side) % 3] = share;
    let triangle = stop.side / 3;
    let place = Node { triangle, shares, vertex: None, rank: Rank::Boundary };
    let from = net.ports[stop.port];
    let node = net.add(place, &[(triangle, charts.at(stop.side), from.way + 2)]);
    net.nodes[node].on_side = Some((stop.side, stop.share));
    let port = net.nodes[node].ports[0];
    net.ports[port].other = stop.port;
    net.ports[stop.port].other = port;
}

/// A node without a line, where the boundary turns.
fn cornered(charts: &Charts, net: &mut Net, vertex: usize) {
    let place = on_vertex(charts, vertex, Rank::Corner);
    net.at_vertex[vertex] = Some(net.add(place, &[]));
}
