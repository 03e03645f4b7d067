//! The star of a node: its fins as what holds them there sees them.

use crate::geometry::{Point3, Vector2};
use crate::ids::{FinId, NodeId};
use crate::parts::fit::Fit;
use crate::parts::setback::setback;
use crate::parts::unfold::unfold;
use crate::structure::Structure;
use crate::tolerance::UPON_EACH_OTHER;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// A fin at one of its nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IncidentFin {
    /// Index of the fin in the structure.
    pub index: usize,
    /// The node at the fin's other end.
    pub to: NodeId,
    /// Counter-clockwise from the first fin seen from above, radians in [0, 2π).
    pub bearing: f64,
    /// Rise of the fin's bottom and top edge per length across the axis.
    pub rise: [f64; 2],
    /// Where the fin stops if only the other fins count, from the axis, mm.
    pub clear: f64,
}

/// A node with the fins that meet there (its star, as complexes of cells have it).
#[derive(Debug, Clone, PartialEq)]
pub struct Star {
    /// The node.
    pub node: NodeId,
    /// How far its axis reaches below and above the base mesh, mm.
    pub reach: [f64; 2],
    /// Its fins, counter-clockwise seen from above.
    pub fins: Vec<IncidentFin>,
    /// The least length across the axes of its fins, mm.
    pub shortest: f64,
}

impl Star {
    /// All stars of a structure with two fins or more, in the order of nodes.
    pub(crate) fn all(structure: &Structure, fit: &Fit) -> impl Iterator<Item = Self> {
        let index = indices(structure);
        let star = move |node| Self::of(structure, &index, node, fit);
        structure.mesh().nodes().filter_map(star)
    }

    /// The star of a node; `None` if fewer than two fins meet there.
    pub(crate) fn of(
        structure: &Structure,
        fins: &FinIndices,
        node: NodeId,
        fit: &Fit,
    ) -> Option<Self> {
        let fins = incident(structure, fins, node, fit);
        let at = &structure.nodes()[node];
        let lengths = fins.iter().map(|fin| shortest(structure, [node, fin.to]));
        let shortest = lengths.fold(f64::INFINITY, f64::min);
        let reach = [at.below, at.above];
        (fins.len() > 1).then_some(Self { node, reach, fins, shortest })
    }

    /// Lowest and highest level that all fins reach from the axis up to `out` from it.
    pub(crate) fn shared_span(&self, out: f64) -> [f64; 2] {
        let sunk = |rise: f64| (rise * out).max(0.0);
        let fins = || self.fins.iter();
        let lowest = fins().map(|fin| sunk(fin.rise[0])).fold(0.0, f64::max);
        let highest = fins().map(|fin| sunk(-fin.rise[1])).fold(0.0, f64::max);
        [lowest - self.reach[0], self.reach[1] - highest]
    }

    /// A fin by its index in the structure.
    pub(crate) fn fin(&self, index: usize) -> Option<&IncidentFin> {
        self.fins.iter().find(|fin| fin.index == index)
    }

    /// Whether all its fins go their own ways, so that plates can hold them.
    pub(crate) fn has_room(&self) -> bool {
        self.sectors().into_iter().all(|angle| angle >= UPON_EACH_OTHER)
    }

    /// Angle from each fin to the next, counter-clockwise, radians.
    pub(crate) fn sectors(&self) -> Vec<f64> {
        let next = self.fins.iter().cycle().skip(1);
        let pairs = self.fins.iter().zip(next);
        pairs.map(|(a, b)| (b.bearing - a.bearing).rem_euclid(2.0 * PI)).collect()
    }
}

/// The fins of a structure by their nodes.
pub(crate) type FinIndices = BTreeMap<FinId, usize>;

/// The index of each fin.
pub(crate) fn indices(structure: &Structure) -> FinIndices {
    structure.fins().iter().enumerate().map(|(k, fin)| (*fin, k)).collect()
}

fn incident(
    structure: &Structure,
    fins: &FinIndices,
    node: NodeId,
    fit: &Fit,
) -> Vec<IncidentFin> {
    let around = &structure.nodes()[node];
    let angles: Vec<f64> = around.arms.iter().map(|arm| arm.angle).collect();
    let arms = around.arms.iter().enumerate();
    let incident = arms.filter_map(|(place, arm)| {
        let pair = FinId::between(node, arm.to);
        let index = *fins.get(&pair)?;
        Some(IncidentFin {
            index,
            to: arm.to,
            bearing: (arm.angle - angles[0]).rem_euclid(2.0 * PI),
            rise: rise(structure, node, arm.to),
            clear: setback(&angles, place, fit.thickness),
        })
    });
    incident.collect()
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
