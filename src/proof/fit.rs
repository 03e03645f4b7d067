//! What a slit must be, from the structure alone: which fins stand about the node, at
//! which angles, and how thick they are.

use crate::geometry::{Vector3, trig};
use crate::structure::Structure;
use std::f64::consts::{PI, TAU};

/// Direction of a node as seen from another along that one's axis: radians,
/// counter-clockwise from a direction that is the same for all around it. Worked out from
/// places and axes; what the structure lists as angles of its arms is what parts are made
/// from.
pub(super) fn bearing(structure: &Structure, node: usize, to: usize) -> f64 {
    let at = &structure.nodes()[node];
    let way = structure.nodes()[to].position - at.position;
    let mut reference = Vector3::zeros();
    reference[at.axis.iamin()] = 1.0;
    let across = reference - at.axis * at.axis.dot(&reference);
    trig::atan2(at.axis.dot(&across.cross(&way)), across.dot(&way))
}

/// Bearings of a strip's two arms at a node, as seen along the axis: toward the previous
/// and the next node; past an end the fin goes straight on.
pub(super) fn arms(
    structure: &Structure,
    node: usize,
    [before, after]: [Option<usize>; 2],
) -> Option<[f64; 2]> {
    let bearing = |to: usize| {
        structure.nodes()[node].arm(to.into()).map(|_| bearing(structure, node, to))
    };
    match (before, after) {
        (Some(before), Some(after)) => Some([bearing(before)?, bearing(after)?]),
        (Some(before), None) => bearing(before).map(|angle| [angle, angle + PI]),
        (None, Some(after)) => bearing(after).map(|angle| [angle + PI, angle]),
        (None, None) => None,
    }
}

/// Half-widths that a slit needs beside its two arms to take a strip with the arms
/// `other`, without clearance, mm.
pub(super) fn needed(own: [f64; 2], other: [f64; 2], thickness: f64) -> [f64; 2] {
    let kink = (PI - between(other[0], other[1])).abs();
    let kinked = thickness / (2.0 * trig::cos(kink / 2.0));
    own.map(|arm| {
        let beside = other.map(|neighbour| reach(between(arm, neighbour), thickness));
        beside.into_iter().fold(kinked, f64::max)
    })
}

/// How far from the axis two plates at an angle in (0, π) are free of each other:
/// `t (1 + cos b) / (2 sin b)`.
pub(super) fn reach(angle: f64, thickness: f64) -> f64 {
    let sin = trig::sin(angle);
    if sin <= 0.0 { 0.0 } else { thickness * (1.0 + trig::cos(angle)) / (2.0 * sin) }
}

/// Angle between two bearings, in [0, π].
pub(super) fn between(a: f64, b: f64) -> f64 {
    let turn = (b - a).rem_euclid(TAU);
    turn.min(TAU - turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn square_and_oblique_crossings_need_what_the_notes_say() {
        let crossing = |degrees: f64| {
            let angle = degrees.to_radians();
            let [a, b] = needed([0.0, PI], [angle, angle + PI], 3.0);
            a + b
        };
        assert!((crossing(90.0) - 3.0).abs() < 1e-12);
        assert!((crossing(60.0) - 3.0 * 3_f64.sqrt()).abs() < 1e-12);
        assert!((crossing(45.0) - 3.0 * (1.0 + 2_f64.sqrt())).abs() < 1e-12);
    }
}
