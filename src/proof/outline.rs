//! A drawn outline against the part's shape: where it is off, slits apart.

use crate::geometry::Point2;
use crate::proof::finding::{ProofFinding, Spot};
use crate::proof::matching::Found;
use crate::proof::shape::Edges;
use crate::proof::sheets::{Read, finite};
use crate::tolerance::{ARC_SAGITTA_MM, SAME_SHAPE_MM};

/// Places this near to each other, mm, are told of once.
const ONE_PLACE: f64 = 15.0;

/// Places told of per part.
const FEW: usize = 4;

/// Largest distance of an outline from its part's shape, and what is to be said about it.
/// `told` are places on the sheet that other findings speak of already.
pub(super) fn deviations(
    read: &Read,
    found: &Found,
    told: &[Point2],
) -> (f64, Vec<ProofFinding>) {
    let shape = &read.matching.shapes[read.matching.places[found.place].shape];
    let drawn = Edges::new([found.outline.flattened(ARC_SAGITTA_MM)]);
    let corners = found.outline.vertices.iter().map(|vertex| vertex.point);
    let out = corners.map(|p| (finite(shape.edges.distance(p)), p));
    let back = shape.part.outline.iter().map(|&p| (finite(drawn.distance(p)), p));
    let mut off: Vec<(f64, Point2)> = out.chain(back).collect();
    off.sort_by(|a, b| b.0.total_cmp(&a.0));
    let worst = off.first().map_or(0.0, |first| first.0);
    let limit_mm = SAME_SHAPE_MM.max(read.manifest.proof.limits.axes_and_slits_mm);
    let mut said: Vec<Point2> = told.to_vec();
    let mut findings = Vec::new();
    for (by_mm, p) in off {
        let at = found.motion.apply(p);
        if by_mm <= limit_mm || findings.len() == FEW {
            break;
        }
        if said.iter().all(|known| (known - at).norm() > ONE_PLACE) {
            said.push(at);
            let spot = Spot::file(read.file(found)).part(read.id(found)).at(at);
            findings.push(ProofFinding::OutlineDiffers { spot, by_mm });
        }
    }
    (worst, findings)
}
