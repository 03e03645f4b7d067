//! How a strip goes in: pushed straight, or zipped in one node after the other.
//!
//! Node axes are not parallel, slits are. Pushed straight along one direction, a slit as
//! deep as d on an axis that leans from it by an angle a runs sideways by d tan a; if that
//! is more than the clearance, the strip is zipped in, and between two neighbouring nodes
//! whose axes differ by b the plates have to give way by d tan b (`docs/strips.md`).
//! The bend that takes is that of a cantilever as long as the fin: radius = L² / (3 δ).

use crate::geometry::Vector3;
use crate::ids::NodeId;
use crate::parts::fit::Fit;
use crate::parts::lap::finding::LapFinding;
use crate::parts::part::{Body, Part, StripBody};
use crate::parts::slit::{Opening, Slit};
use crate::structure::Structure;

/// How a strip goes in from above, onto the strips that stand already.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Insertion {
    /// Largest angle of a node axis from the direction of the push, radians.
    pub spread: f64,
    /// How far that takes a slit sideways, mm.
    pub sideways: f64,
    /// Whether the clearance takes it up, so that the strip can be pushed in rigidly.
    pub is_rigid: bool,
    /// Tightest bend of zipping it in, mm, and the node after which it is; `None` if rigid
    /// or if nothing bends.
    pub bend: Option<(f64, NodeId)>,
}

/// How a strip goes in; `None` if it is the first to stand at all its nodes.
pub fn insertion(
    structure: &Structure,
    strip: &StripBody,
    clearance: f64,
) -> Option<Insertion> {
    let slits = strip.slits.iter().map(|(slit, _)| slit);
    let onto: Vec<&Slit> = slits.filter(|slit| slit.from == Opening::Bottom).collect();
    let axis = |slit: &Slit| structure.nodes()[slit.node].axis;
    let axes: Vec<Vector3> = onto.iter().map(|slit| axis(slit)).collect();
    let push = middle(&axes)?;
    let sideways = |slit: &Slit, from: Vector3| slit.depth * tangent(axis(slit), from);
    let spread = axes.iter().map(|&a| tangent(a, push)).fold(0.0, f64::max);
    let worst = onto.iter().map(|slit| sideways(slit, push)).fold(0.0, f64::max);
    let room = clearance.max(0.0);
    let is_rigid = worst <= room;
    let bends = onto.windows(2).filter_map(|pair| {
        let length = (structure.nodes()[pair[1].node].position
            - structure.nodes()[pair[0].node].position)
            .norm();
        let give = sideways(pair[1], axis(pair[0])) - room;
        (give > 0.0).then(|| (length * length / (3.0 * give), pair[0].node))
    });
    let tightest = bends.min_by(|a, b| a.0.total_cmp(&b.0));
    Some(Insertion {
        spread: crate::geometry::trig::atan(spread),
        sideways: worst,
        is_rigid,
        bend: tightest.filter(|_| !is_rigid),
    })
}

/// Strips that bend more tightly while they are put in than a model should.
pub fn tight_insertions(
    structure: &Structure,
    parts: &[Part],
    fit: &Fit,
) -> Vec<LapFinding> {
    let tight = parts.iter().filter_map(|part| {
        let Body::Strip(strip) = &part.body else { return None };
        let (radius_mm, node) = insertion(structure, strip, fit.clearance)?.bend?;
        let ratio = radius_mm / fit.thickness;
        let (part, limit) = (part.id.clone(), fit.bend_model);
        (ratio < limit).then_some(LapFinding::InsertionTight {
            part,
            node,
            radius_mm,
            ratio,
            limit,
        })
    });
    tight.collect()
}

/// Tangent of the angle between two unit vectors less than a right angle apart.
fn tangent(a: Vector3, b: Vector3) -> f64 {
    let along = a.dot(&b);
    if along <= 0.0 { f64::INFINITY } else { a.cross(&b).norm() / along }
}

/// Steps toward the middle: the distance from it falls as one over their number.
const STEPS: u32 = 200;

/// The direction whose largest angle to all axes is smallest, nearly: the middle of the
/// smallest ball about their tips, approached step by step toward the farthest tip (Bădoiu
/// and Clarkson, "Smaller core-sets for balls", 2003).
fn middle(axes: &[Vector3]) -> Option<Vector3> {
    let mut middle = *axes.first()?;
    for step in 1..=STEPS {
        let off = |a: &&Vector3| (**a - middle).norm_squared();
        let farthest = axes.iter().max_by(|a, b| off(a).total_cmp(&off(b)))?;
        middle += (farthest - middle) / f64::from(step + 1);
    }
    middle.try_normalize(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_a_fan_is_its_bisector_however_many_axes_crowd_one_side() {
        let lean = |x: f64| Vector3::new(x, 0.0, 1.0).normalize();
        let fan = [lean(-0.2), lean(-0.19), lean(-0.18), lean(-0.17), lean(0.2)];
        let middle = middle(&fan).unwrap();
        assert!(tangent(middle, Vector3::z()) < 0.005, "{middle}");
    }
}
