//! What lies near what in space: fins that cut through each other away from their nodes.

use crate::geometry::{Point3, Vector3};
use crate::ids::NodeId;
use crate::structure::Structure;
use crate::structure::finding::StructureFinding;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// Pairs of crossing fins that are listed; then the search stops, for a structure with so
/// many has one cause, and all pairs would be as many as the square of the fins.
const CROSSINGS_LISTED: usize = 1000;

/// Pairs of fins without a common node that share a point.
pub(super) fn fins_that_cross(structure: &Structure) -> Vec<StructureFinding> {
    let tree = FinTree::new(structure);
    let fins = structure.fins();
    let mut findings = Vec::new();
    for (a, quad) in tree.quads.iter().enumerate() {
        let apart = |b: usize| !fins[a].ends().iter().any(|&node| fins[b].ends_at(node));
        for b in tree.near(quad).into_iter().filter(|&b| a < b && apart(b)) {
            if !quads_meet(quad, &tree.quads[b]) {
                continue;
            }
            if findings.len() == CROSSINGS_LISTED {
                let listed = CROSSINGS_LISTED;
                findings.push(StructureFinding::FinsCrossOften { listed });
                return findings;
            }
            let (first, second) = (fins[a], fins[b]);
            findings.push(StructureFinding::FinsCross { first, second });
        }
    }
    findings
}

/// The fins of a structure in an R*-tree of their boxes, whose size does not depend on how
/// far apart or how unlike in size they are.
#[derive(Debug, Clone)]
pub struct FinTree {
    quads: Vec<[Point3; 4]>,
    boxes: RTree<GeomWithData<Rectangle<[f64; 3]>, usize>>,
}

impl FinTree {
    /// Sorts the fins in.
    pub fn new(structure: &Structure) -> Self {
        let quads: Vec<[Point3; 4]> =
            structure.fins().iter().map(|&fin| structure.corners(fin.ends())).collect();
        let entry = |(index, quad)| GeomWithData::new(around(quad).into(), index);
        let boxes = RTree::bulk_load(quads.iter().enumerate().map(entry).collect());
        Self { quads, boxes }
    }

    /// The fins, by index, whose boxes overlap that of `quad`, in their order.
    fn near(&self, quad: &[Point3; 4]) -> Vec<usize> {
        let found = self.boxes.locate_in_envelope_intersecting(around(quad));
        let mut near: Vec<usize> = found.map(|entry| entry.data).collect();
        near.sort_unstable();
        near
    }

    /// Whether a quad, given by a segment and its copy `reach` further, meets a fin that
    /// does not end at `node`.
    pub fn blocks(
        &self,
        structure: &Structure,
        node: NodeId,
        segment: [Point3; 2],
        reach: Vector3,
    ) -> bool {
        let quad = [segment[0], segment[0] + reach, segment[1] + reach, segment[1]];
        self.near(&quad)
            .into_iter()
            .filter(|&index| !structure.fins()[index].ends_at(node))
            .any(|index| quads_meet(&quad, &self.quads[index]))
    }
}

fn around(quad: &[Point3; 4]) -> AABB<[f64; 3]> {
    AABB::from_points(&quad.map(|p| [p.x, p.y, p.z]))
}

/// Whether two planar quads share a point: a side of one goes through the other.
pub(super) fn quads_meet(a: &[Point3; 4], b: &[Point3; 4]) -> bool {
    sides_pierce(a, b) || sides_pierce(b, a)
}

fn sides_pierce(sides: &[Point3; 4], quad: &[Point3; 4]) -> bool {
    let [p, q, r, s] = *quad;
    (0..4).any(|k| {
        let (from, to) = (sides[k], sides[(k + 1) % 4]);
        segment_meets_triangle(from, to, [p, q, r])
            || segment_meets_triangle(from, to, [p, r, s])
    })
}

/// Exact for points in general position; a side that lies in the triangle's plane is left
/// to the other sides.
fn segment_meets_triangle(from: Point3, to: Point3, [a, b, c]: [Point3; 3]) -> bool {
    let (above, below) = (orient(a, b, c, from), orient(a, b, c, to));
    if above == 0.0 || below == 0.0 || (above > 0.0) == (below > 0.0) {
        return false;
    }
    let around = [orient(from, to, a, b), orient(from, to, b, c), orient(from, to, c, a)];
    around.iter().all(|&side| side >= 0.0) || around.iter().all(|&side| side <= 0.0)
}

fn orient(a: Point3, b: Point3, c: Point3, d: Point3) -> f64 {
    let coord = |p: Point3| robust::Coord3D { x: p.x, y: p.y, z: p.z };
    robust::orient3d(coord(a), coord(b), coord(c), coord(d))
}
