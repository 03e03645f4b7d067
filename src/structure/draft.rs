//! A structure as somebody wrote it down: nothing has been checked yet.

use crate::geometry::{Point3, Vector3};
use crate::ids::{FinId, NodeId};
use serde_json::Value;
use std::collections::BTreeMap;

/// What the readers make and [`Structure::new`](super::Structure::new) judges.
/// Lengths are already millimetres at model scale.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Draft {
    /// Name of the job.
    pub name: String,
    /// One per node.
    pub positions: Vec<Point3>,
    /// Direction of the node axis, one per node, of any length.
    pub axes: Vec<Vector3>,
    /// The base mesh: corners counter-clockwise seen from the `above` end.
    pub faces: Vec<Vec<usize>>,
    /// How far a fin reaches against its axes, one per node.
    pub below: Vec<f64>,
    /// How far a fin reaches along its axes, one per node.
    pub above: Vec<f64>,
    /// Pairs of nodes; `None`: every edge of the faces.
    pub fins: Option<Vec<[usize; 2]>>,
    /// Chains of nodes; `None`: straight on through the nodes.
    pub strips: Option<Vec<Vec<usize>>>,
    /// Nodes held by the ground; `None`: those on the boundary.
    pub fixed: Option<Vec<usize>>,
    /// Family of the base mesh, 1 or 2, of each fin, in their order, where it can be told.
    pub families: Option<Vec<Option<u8>>>,
    /// Where it comes from, for the record.
    pub design: Option<DesignRecord>,
}

/// Where a structure comes from: what its design was asked for, by name.
pub type DesignRecord = serde_json::Map<String, Value>;

/// What under [`Draft::design`] is a length, or a list of lengths.
const LENGTHS: [&str; 2] = ["cell", "depth"];

impl Draft {
    /// Sets one depth for all nodes.
    #[must_use]
    pub fn with_depth(mut self, below: f64, above: f64) -> Self {
        self.below = vec![below; self.positions.len()];
        self.above = vec![above; self.positions.len()];
        self
    }

    /// The same with every length multiplied by `factor`.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        for position in &mut self.positions {
            *position *= factor;
        }
        for depth in self.below.iter_mut().chain(&mut self.above) {
            *depth *= factor;
        }
        for (_, length) in self.design.iter_mut().flatten().filter(is_length) {
            scale(length, factor);
        }
        self
    }

    /// The same with other fins, each still of its family.
    #[must_use]
    pub fn with_fins(mut self, fins: &[FinId]) -> Self {
        let of: BTreeMap<FinId, Option<u8>> = self
            .fin_ids()
            .into_iter()
            .zip(self.families.iter().flatten().copied())
            .collect();
        let family = |fin: &FinId| of.get(fin).copied().flatten();
        self.families = self.families.map(|_| fins.iter().map(family).collect());
        self.fins = Some(fins.iter().map(|fin| fin.ends().map(NodeId::index)).collect());
        self
    }

    /// The fins asked for, or every edge of the faces, each once with the smaller
    /// node first, in order of first appearance.
    pub fn fin_ids(&self) -> Vec<FinId> {
        let fin = |i: usize, j: usize| FinId::between(i.into(), j.into());
        if let Some(fins) = &self.fins {
            return fins.iter().map(|&[i, j]| fin(i, j)).collect();
        }
        let mut seen = std::collections::BTreeSet::new();
        let edges = self.faces.iter().flat_map(|face| face_edges(face));
        edges
            .filter(|(i, j)| i != j)
            .map(|(i, j)| fin(i, j))
            .filter(|&fin| seen.insert(fin))
            .collect()
    }
}

fn is_length((name, _): &(&String, &mut Value)) -> bool {
    LENGTHS.contains(&name.as_str())
}

fn scale(length: &mut Value, factor: f64) {
    match length {
        Value::Array(list) => list.iter_mut().for_each(|length| scale(length, factor)),
        other => {
            if let Some(number) = other.as_f64() {
                *other = (number * factor).into();
            }
        }
    }
}

/// The directed edges around a face.
fn face_edges<N: Copy>(face: &[N]) -> impl Iterator<Item = (N, N)> + '_ {
    face.iter().zip(face.iter().cycle().skip(1)).map(|(&i, &j)| (i, j))
}

/// The vector area of a polygon (Newell): its normal, as long as the area.
pub fn area_vector<N: Copy + Into<NodeId>>(positions: &[Point3], face: &[N]) -> Vector3 {
    // From a corner of the face: far from the origin the products would drown the area.
    let Some(&first) = face.first() else { return Vector3::zeros() };
    let arm = |node: N| positions[node.into()] - positions[first.into()];
    let twice: Vector3 = face_edges(face).map(|(i, j)| arm(i).cross(&arm(j))).sum();
    twice / 2.0
}
