//! What a design reached, in numbers.

use crate::design::planarise::Figures;
use crate::design::quads::sides;
use crate::design::surface::Surface;
use crate::geometry::{Vector3, trig};
use crate::ids::NodeId;
use crate::structure::Draft;
use serde::Serialize;
use std::collections::BTreeMap;

/// An inner node with other than four fins.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SingularNode {
    /// Its number.
    pub node: usize,
    /// How many fins meet there.
    pub valence: usize,
    /// Where it is, mm.
    pub position: [f64; 3],
}

/// Lengths of fins between two inner nodes; those that end at the boundary are cut as they
/// come.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Lengths {
    /// The wanted length, mm.
    pub wanted: f64,
    /// Nineteen of twenty are longer, mm.
    pub p5: f64,
    /// The median, mm.
    pub median: f64,
    /// Nineteen of twenty are shorter, mm.
    pub p95: f64,
    /// Share of those within 0.7 to 1.4 of the wanted length.
    pub in_band: f64,
}

/// Angles between neighbouring fins about their node, degrees.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FinAngles {
    /// The least.
    pub least: f64,
    /// Nineteen of twenty nodes have none that is smaller.
    pub p5: f64,
}

/// Nineteen of twenty are no larger than the first, none than the second.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Upper {
    /// Nineteen of twenty.
    pub p95: f64,
    /// All.
    pub max: f64,
}

/// Half are no larger than the first, none than the second.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Middle {
    /// Half.
    pub median: f64,
    /// All.
    pub max: f64,
}

/// Planarity of fins, percent of their diameter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PlanarityPercent {
    /// Of the mesh on the surface.
    pub before: Upper,
    /// Of the structure.
    pub after: Upper,
}

/// What was reached, lengths in mm.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DesignFigures {
    /// How many nodes.
    pub nodes: usize,
    /// How many fins.
    pub fins: usize,
    /// How many faces.
    pub faces: usize,
    /// Nodes − edges + faces.
    pub euler: i64,
    /// Inner nodes with other than four fins.
    pub singular: Vec<SingularNode>,
    /// Triangles turned over in the map: always none.
    pub flipped: usize,
    /// Lengths of inner fins.
    pub edge: Lengths,
    /// Angles between fins.
    pub fin_angle_deg: FinAngles,
    /// Planarity of fins.
    pub planarity_percent: PlanarityPercent,
    /// Angles between axes and those wanted at their foot on the surface, degrees.
    pub axis_turn_deg: Middle,
    /// Distances of nodes from the surface, mm.
    pub surface_distance: Upper,
    /// Faces turned over when fins were made planar.
    pub reversed: usize,
}

/// Shares of the wanted length within which a fin counts as even.
const BAND: [f64; 2] = [0.7, 1.4];

/// A structure beside what was wanted.
pub(super) struct Judged<'a> {
    pub surface: &'a Surface,
    /// Wanted axes of the surface's vertices.
    pub axes: &'a [Vector3],
    /// For each node a triangle near it.
    pub starts: Vec<usize>,
    pub draft: &'a Draft,
    /// Wanted lengths of fins in both families.
    pub wanted: [f64; 2],
    /// The family of each edge that has one.
    pub families: &'a BTreeMap<[usize; 2], Option<u8>>,
}

impl Judged<'_> {
    pub(super) fn figures(&self, planarised: &Figures) -> DesignFigures {
        let draft = self.draft;
        let edges = self.edges();
        let on_boundary = self.on_boundary(&edges);
        let feet = (0..draft.positions.len()).map(|node| {
            let foot = self.surface.foot(draft.positions[node], self.starts[node]);
            let turn = angle(draft.axes[node], self.surface.between(self.axes, foot));
            (turn.to_degrees(), (self.surface.point(foot) - draft.positions[node]).norm())
        });
        let (turns, distances): (Vec<f64>, Vec<f64>) = feet.unzip();
        let euler =
            draft.positions.len() as i64 - edges.len() as i64 + draft.faces.len() as i64;
        let spread = |s: &crate::design::planarise::Spread| Upper {
            p95: s.p95 * 100.0,
            max: s.worst * 100.0,
        };
        DesignFigures {
            nodes: draft.positions.len(),
            fins: planarised.fins,
            faces: draft.faces.len(),
            euler,
            singular: self.singular(&edges, &on_boundary),
            flipped: 0,
            edge: self.lengths(&edges, &on_boundary),
            fin_angle_deg: self.angles(),
            planarity_percent: PlanarityPercent {
                before: spread(&planarised.before),
                after: spread(&planarised.after),
            },
            axis_turn_deg: Middle { median: at(&turns, 0.5), max: at(&turns, 1.0) },
            surface_distance: Upper {
                p95: at(&distances, 0.95),
                max: at(&distances, 1.0),
            },
            reversed: planarised.reversed_faces,
        }
    }

    /// All edges with how many faces they have.
    fn edges(&self) -> BTreeMap<[usize; 2], usize> {
        let mut edges = BTreeMap::new();
        for (a, b) in self.draft.faces.iter().flat_map(|face| sides(face)) {
            *edges.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
        edges
    }

    /// Whether each node is an end of an edge with one face.
    fn on_boundary(&self, edges: &BTreeMap<[usize; 2], usize>) -> Vec<bool> {
        let mut on_boundary = vec![false; self.draft.positions.len()];
        let rim = edges.iter().filter(|edge| *edge.1 == 1);
        rim.flat_map(|edge| edge.0).for_each(|&node| on_boundary[node] = true);
        on_boundary
    }

    fn singular(
        &self,
        edges: &BTreeMap<[usize; 2], usize>,
        on_boundary: &[bool],
    ) -> Vec<SingularNode> {
        let mut valence = vec![0; self.draft.positions.len()];
        edges.keys().flatten().for_each(|&node| valence[node] += 1);
        let nodes = (0..valence.len()).filter(|&k| !on_boundary[k] && valence[k] != 4);
        nodes
            .map(|node| SingularNode {
                node,
                valence: valence[node],
                position: self.draft.positions[node].coords.into(),
            })
            .collect()
    }

    fn lengths(
        &self,
        edges: &BTreeMap<[usize; 2], usize>,
        on_boundary: &[bool],
    ) -> Lengths {
        let inside = |edge: &&[usize; 2]| edge.iter().all(|&k| !on_boundary[k]);
        let [wanted, second] = self.wanted;
        // Lengths of the second family count as if they were of the first.
        let length = |&[a, b]: &[usize; 2]| {
            let is_second = self.families.get(&[a, b]) == Some(&Some(2));
            let by = if is_second { wanted / second } else { 1.0 };
            (self.draft.positions[a] - self.draft.positions[b]).norm() * by
        };
        let lengths: Vec<f64> = edges.keys().filter(inside).map(length).collect();
        let [least, most] = BAND.map(|share| share * wanted);
        let even =
            lengths.iter().filter(|length| (least..=most).contains(*length)).count();
        Lengths {
            wanted,
            p5: at(&lengths, 0.05),
            median: at(&lengths, 0.5),
            p95: at(&lengths, 0.95),
            in_band: even as f64 / lengths.len().max(1) as f64,
        }
    }

    fn angles(&self) -> FinAngles {
        let mut around = vec![Vec::new(); self.draft.positions.len()];
        for fin in self.draft.fin_ids() {
            let [a, b] = fin.ends().map(NodeId::index);
            around[a].push(b);
            around[b].push(a);
        }
        let least = |(node, ends): (usize, &Vec<usize>)| {
            let axis = self.draft.axes[node];
            let first = across(
                self.draft.positions[*ends.first()?] - self.draft.positions[node],
                axis,
            );
            let other = axis.cross(&first);
            let mut turns: Vec<f64> = ends
                .iter()
                .map(|&end| {
                    let to = self.draft.positions[end] - self.draft.positions[node];
                    trig::atan2(to.dot(&other), to.dot(&first)).to_degrees()
                })
                .collect();
            turns.sort_by(f64::total_cmp);
            let last = turns.first()? + 360.0;
            let next = turns.iter().skip(1).chain([&last]);
            let gaps = turns.iter().zip(next).map(|(a, b)| b - a);
            (ends.len() > 1).then(|| gaps.fold(360.0, f64::min))
        };
        let least: Vec<f64> = around.iter().enumerate().filter_map(least).collect();
        FinAngles { least: at(&least, 0.0), p5: at(&least, 0.05) }
    }
}

fn across(v: Vector3, axis: Vector3) -> Vector3 {
    let axis = axis.normalize();
    (v - axis * v.dot(&axis)).try_normalize(0.0).unwrap_or(v)
}

/// Angle between two vectors, radians.
fn angle(a: Vector3, b: Vector3) -> f64 {
    trig::atan2(a.cross(&b).norm(), a.dot(&b))
}

/// The number below which this share of them lies.
fn at(numbers: &[f64], share: f64) -> f64 {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = (share * sorted.len() as f64) as usize;
    sorted.get(place.min(sorted.len().saturating_sub(1))).copied().unwrap_or(0.0)
}
