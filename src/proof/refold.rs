//! Flat axes folded up and placed in space, and where the axes of parts that meet differ.

use crate::geometry::{Point3, Vector3, trig};
use crate::manifest::RunEntry;
use crate::proof::measure::FlatAxis;
use crate::structure::Structure;
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion};
use std::collections::BTreeMap;

/// A node axis in space: bottom and top.
pub(super) type Axis = [Point3; 2];

/// The axes of a strip folded at each axis by the listed angle, the first fin in z = 0
/// with its labelled face up.
pub(super) fn folded(strip: &RunEntry, flat: &[FlatAxis]) -> Vec<Axis> {
    let lifted = |axis: &FlatAxis| axis.map(|p| Point3::new(p.x, p.y, 0.0));
    let mut motion = Isometry3::identity();
    let mut axes = Vec::with_capacity(flat.len());
    for (place, axis) in flat.iter().enumerate() {
        let [bottom, top] = lifted(axis).map(|p| motion * p);
        axes.push([bottom, top]);
        let inner = place > 0 && place + 1 < flat.len();
        let fold = strip.folds().iter().find(|fold| fold.node == strip.nodes[place]);
        if let Some(fold) = fold.filter(|_| inner) {
            // The next fin, toward +x, turns toward the face, +z: about +y by minus the angle.
            motion = turn_about([bottom, top], -fold.angle_deg.to_radians()) * motion;
        }
    }
    axes
}

fn turn_about([bottom, top]: Axis, angle: f64) -> Isometry3<f64> {
    let Some(way) = (top - bottom).try_normalize(0.0) else {
        return Isometry3::identity();
    };
    let half = angle / 2.0;
    let imaginary = way * trig::sin(half);
    let quaternion = nalgebra::Quaternion::from_parts(trig::cos(half), imaginary);
    let turn = UnitQuaternion::from_quaternion(quaternion);
    let there = Translation3::from(bottom.coords);
    there * turn * there.inverse()
}

/// The axes moved rigidly onto those of the structure, by least squares (Kabsch).
pub(super) fn placed(axes: &[Axis], targets: &[Axis]) -> Vec<Axis> {
    let points = || axes.iter().flatten();
    let aims = || targets.iter().flatten();
    let count = (2 * axes.len()).max(1) as f64;
    let from: Vector3 = points().map(|p| p.coords).sum::<Vector3>() / count;
    let to: Vector3 = aims().map(|p| p.coords).sum::<Vector3>() / count;
    let spread: Matrix3<f64> = points()
        .zip(aims())
        .map(|(p, q)| (q.coords - to) * (p.coords - from).transpose())
        .sum();
    let svd = spread.svd(true, true);
    let (Some(u), Some(v_t)) = (svd.u, svd.v_t) else { return axes.to_vec() };
    let upright = (u * v_t).determinant().signum();
    let turn = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, upright)) * v_t;
    let turn = Rotation3::from_matrix_unchecked(turn);
    let moved = |p: Point3| Point3::from(turn * (p.coords - from) + to);
    axes.iter().map(|axis| axis.map(moved)).collect()
}

/// The axes of the nodes of a strip in the structure.
pub(super) fn targets(structure: &Structure, strip: &RunEntry) -> Vec<Axis> {
    let node = |node: &usize| &structure.nodes()[*node];
    strip.nodes.iter().map(node).map(|node| [node.bottom(), node.top()]).collect()
}

/// Where the axes of parts at one node came to lie.
#[derive(Default)]
pub(super) struct Meeting {
    /// By part.
    pub parts: Vec<(String, Axis)>,
}

impl Meeting {
    /// Largest distance between the ends of two parts' axes, mm.
    pub(super) fn gap(&self) -> f64 {
        let pairs = self.parts.iter().enumerate().flat_map(|(k, (_, a))| {
            self.parts[..k].iter().map(move |(_, b)| apart(a, b))
        });
        pairs.fold(0.0, f64::max)
    }

    /// Largest distance from the structure's axis, mm.
    pub(super) fn off(&self, axis: &Axis) -> f64 {
        self.parts.iter().map(|(_, placed)| apart(placed, axis)).fold(0.0, f64::max)
    }
}

pub(super) type Meetings = BTreeMap<usize, Meeting>;

fn apart(a: &Axis, b: &Axis) -> f64 {
    (a[0] - b[0]).norm().max((a[1] - b[1]).norm())
}
