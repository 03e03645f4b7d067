//! A node, its axis, and the fins around it.

use crate::geometry::{Point3, Vector3, trig};
use crate::ids::{FinId, NodeId};
use crate::structure::draft::Draft;
use crate::tolerance::UNIT_LENGTH;

/// A vertex of the base mesh with its axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// Where the axis meets the base mesh, mm.
    pub position: Point3,
    /// Direction of the axis, unit length, from `below` to `above`.
    pub axis: Vector3,
    /// How far fins reach against the axis, mm.
    pub below: f64,
    /// How far fins reach along the axis, mm.
    pub above: f64,
    /// The fins of this node, counter-clockwise seen from the `above` end.
    pub arms: Vec<Arm>,
}

/// A fin as its node sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arm {
    /// The node at the fin's other end.
    pub to: NodeId,
    /// Direction in the plane across the axis, radians in (-π, π], from a reference
    /// direction of the node.
    pub angle: f64,
}

impl Node {
    /// Lower end of the axis segment that the fins share.
    pub fn bottom(&self) -> Point3 {
        self.position - self.axis * self.below
    }

    /// Upper end of the axis segment that the fins share.
    pub fn top(&self) -> Point3 {
        self.position + self.axis * self.above
    }

    /// Length of the axis segment that the fins share, mm.
    pub fn height(&self) -> f64 {
        self.below + self.above
    }

    /// Two unit vectors that make a right-handed frame with the axis.
    fn frame(&self) -> (Vector3, Vector3) {
        let a = self.axis;
        let away = match (a.x.abs(), a.y.abs(), a.z.abs()) {
            (x, y, z) if x <= y && x <= z => Vector3::x(),
            (_, y, z) if y <= z => Vector3::y(),
            _ => Vector3::z(),
        };
        let u = away.cross(&a).normalize();
        (u, a.cross(&u))
    }

    /// Direction toward a point, seen along the axis, radians from the reference.
    fn bearing(&self, point: Point3) -> f64 {
        let (u, v) = self.frame();
        let d = point - self.position;
        trig::atan2(d.dot(&v), d.dot(&u))
    }

    /// The place of the fin toward `to` among the arms.
    pub fn arm(&self, to: NodeId) -> Option<usize> {
        self.arms.iter().position(|arm| arm.to == to)
    }
}

/// Unit vector across the axis of `node`, toward `point`.
pub(super) fn across(node: &Node, point: Point3) -> Vector3 {
    let d = point - node.position;
    (d - node.axis * d.dot(&node.axis)).normalize()
}

/// The direction as a unit vector; one that is a unit vector already stays the same to the
/// last bit, so that a structure written and read is the same structure.
fn unit(direction: Vector3) -> Vector3 {
    let off = direction.norm_squared() - 1.0;
    if off.abs() <= UNIT_LENGTH { direction } else { direction.normalize() }
}

/// The nodes of a checked draft with their fins around them.
pub(super) fn join(draft: &Draft, fins: &[FinId]) -> Vec<Node> {
    let mut nodes: Vec<Node> = (0..draft.positions.len())
        .map(|k| Node {
            position: draft.positions[k],
            axis: unit(draft.axes[k]),
            below: draft.below[k],
            above: draft.above[k],
            arms: Vec::new(),
        })
        .collect();
    for fin in fins {
        let [i, j] = fin.ends();
        for (at, to) in [(i, j), (j, i)] {
            let angle = nodes[at].bearing(nodes[to].position);
            nodes[at].arms.push(Arm { to, angle });
        }
    }
    for node in &mut nodes {
        node.arms.sort_by(|a, b| a.angle.total_cmp(&b.angle).then(a.to.cmp(&b.to)));
    }
    nodes
}
