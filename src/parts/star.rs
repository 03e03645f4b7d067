//! The fins of a node as its connector sees them.

use crate::geometry::{Point3, Vector2};
use crate::ids::{FinId, NodeId};
use crate::parts::fit::Fit;
use crate::parts::setback::setback;
use crate::parts::unfold::unfold;
use crate::structure::Structure;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// A fin as its connector sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spoke {
    /// Index of the fin in the structure.
    pub fin: usize,
    /// The node at the fin's other end.
    pub to: NodeId,
    /// Counter-clockwise from the first spoke seen from above, radians in [0, 2π).
    pub bearing: f64,
    /// Rise of the fin's bottom and top edge per length across the axis.
    pub rise: [f64; 2],
    /// Where the fin stops if only the other fins count, from the axis, mm.
    pub clear: f64,
}

/// A node with the fins that meet there.
#[derive(Debug, Clone, PartialEq)]
pub struct Around {
    /// The node.
    pub node: NodeId,
    /// How far its axis reaches below and above the base mesh, mm.
    pub reach: [f64; 2],
    /// Its fins, counter-clockwise seen from above.
    pub spokes: Vec<Spoke>,
    /// The least length across the axes of its fins, mm.
    pub shortest: f64,
}

impl Around {
    /// The fins around a node; `None` if fewer than two meet there.
    pub fn new(
        structure: &Structure,
        fins: &BTreeMap<FinId, usize>,
        node: NodeId,
        fit: &Fit,
    ) -> Option<Self> {
        let spokes = spokes(structure, fins, node, fit);
        let at = &structure.nodes()[node];
        let lengths = spokes.iter().map(|spoke| shortest(structure, [node, spoke.to]));
        let shortest = lengths.fold(f64::INFINITY, f64::min);
        let reach = [at.below, at.above];
        (spokes.len() > 1).then_some(Self { node, reach, spokes, shortest })
    }

    /// Lowest and highest level that all fins reach from the axis up to `out` from it.
    pub fn sunk(&self, out: f64) -> [f64; 2] {
        let sunk = |rise: f64| (rise * out).max(0.0);
        let spokes = || self.spokes.iter();
        let lowest = spokes().map(|spoke| sunk(spoke.rise[0])).fold(0.0, f64::max);
        let highest = spokes().map(|spoke| sunk(-spoke.rise[1])).fold(0.0, f64::max);
        [lowest - self.reach[0], self.reach[1] - highest]
    }

    /// The spoke of a fin.
    pub fn spoke(&self, fin: usize) -> Option<&Spoke> {
        self.spokes.iter().find(|spoke| spoke.fin == fin)
    }
}

/// Angle from each fin to the next, counter-clockwise, radians.
pub(crate) fn sectors(spokes: &[Spoke]) -> Vec<f64> {
    let next = spokes.iter().cycle().skip(1);
    let pairs = spokes.iter().zip(next);
    pairs.map(|(a, b)| (b.bearing - a.bearing).rem_euclid(2.0 * PI)).collect()
}

fn spokes(
    structure: &Structure,
    fins: &BTreeMap<FinId, usize>,
    node: NodeId,
    fit: &Fit,
) -> Vec<Spoke> {
    let around = &structure.nodes()[node];
    let angles: Vec<f64> = around.arms.iter().map(|arm| arm.angle).collect();
    let arms = around.arms.iter().enumerate();
    let spokes = arms.filter_map(|(place, arm)| {
        let pair = FinId::between(node, arm.to);
        let fin = *fins.get(&pair)?;
        Some(Spoke {
            fin,
            to: arm.to,
            bearing: (arm.angle - angles[0]).rem_euclid(2.0 * PI),
            rise: rise(structure, node, arm.to),
            clear: setback(&angles, place, fit.thickness),
        })
    });
    spokes.collect()
}

/// Rise of a fin's edges in its plane, as it is cut.
fn rise(structure: &Structure, node: NodeId, to: NodeId) -> [f64; 2] {
    let flat = unfold(structure, &[node, to], false);
    let [own, far] = [&flat.axes[0], &flat.axes[1]];
    let rise = |way: Vector2| way.dot(&own.up) / way.dot(&own.right());
    [rise(far.bottom() - own.bottom()), rise(far.top() - own.top())]
}

/// Shortest way across a fin between its axes, at the heights of its corners: axes that lean
/// toward each other bring their connectors together.
pub(crate) fn shortest(structure: &Structure, [i, j]: [NodeId; 2]) -> f64 {
    let (a, b) = (&structure.nodes()[i], &structure.nodes()[j]);
    let pairs = [(a.bottom(), b.bottom()), (a.top(), b.top())];
    let across = pairs.map(|(p, q): (Point3, Point3)| {
        let out = structure.direction(i, j);
        let back = structure.direction(j, i);
        (q - p).dot(&out).min((p - q).dot(&back))
    });
    across[0].min(across[1])
}
