//! The digital assembly: parts as plates of their thickness, placed in space.
//!
//! Made from the flat parts and the structure alone, not from what the parts were made
//! from. Fins and plates that do not belong together are convex and must be apart in space.
//! A plate and the fins it holds are looked at in the plane across the axis, where a fin is
//! a row of bars: they must stand inside the plate's cuts or beyond its rim, with the
//! clearance on both sides. A fin contains its axis, so this is exact; it is asked just
//! inside both faces of a plate and in its middle.

use crate::geometry::{Point2, Point3, Vector2, predicates, trig};
use crate::parts::connector::finding::ConnectorFinding;
use crate::parts::connector::solid::Plate;
use crate::parts::connector::{Connector, Copy};
use crate::parts::fit::Fit;
use crate::parts::part::{Body, ConnectorBody, FinBody, Part};
use crate::structure::Structure;
use crate::tolerance::{ARC_SAGITTA_MM, PLATES_TOUCH_MM};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::collections::{BTreeMap, BTreeSet};

/// A plate of the assembly.
struct Solid<'a> {
    part: &'a Part,
    plate: Plate,
    /// Which copy it is, of a connector.
    copy: Option<&'a Copy>,
}

/// All pairs of parts that would run into each other.
pub fn collisions(
    structure: &Structure,
    parts: &[Part],
    fit: &Fit,
) -> Vec<ConnectorFinding> {
    let solids: Vec<Solid> =
        parts.iter().flat_map(|part| solids(structure, part, fit)).collect();
    let boxes = solids.iter().enumerate().map(|(k, solid)| {
        GeomWithData::new(Rectangle::from_aabb(around(&solid.plate)), k)
    });
    let tree: RTree<GeomWithData<Rectangle<[f64; 3]>, usize>> =
        RTree::bulk_load(boxes.collect());
    let mut found = Vec::new();
    for (k, solid) in solids.iter().enumerate() {
        let near = tree.locate_in_envelope_intersecting(around(&solid.plate));
        let mut near: Vec<usize> =
            near.map(|entry| entry.data).filter(|&n| n > k).collect();
        near.sort_unstable();
        let others = near.into_iter().map(|n| &solids[n]);
        let strangers =
            others.filter(|other| !holds(solid, other) && !holds(other, solid));
        found.extend(strangers.filter_map(|other| collision(solid, other)));
    }
    found.extend(in_cuts(structure, parts, fit));
    // The plates of two nodes meet more than once; once is enough to say.
    let mut told = BTreeSet::new();
    found.retain(|finding| match finding {
        ConnectorFinding::Collide { first, second, .. } => {
            told.insert((first.clone(), second.clone()))
        }
        _ => true,
    });
    found
}

fn around(plate: &Plate) -> AABB<[f64; 3]> {
    let [low, high] = plate.bounds();
    AABB::from_corners(low.into(), high.into())
}

/// Whether a plate holds a fin.
fn holds(plate: &Solid, fin: &Solid) -> bool {
    let (Body::Connector(body), Some(copy)) = (&plate.part.body, plate.copy) else {
        return false;
    };
    copy.holds.iter().any(|&place| body.fins[place] == fin.part.id)
}

fn collision(a: &Solid, b: &Solid) -> Option<ConnectorFinding> {
    let depth_mm = a.plate.overlap(&b.plate);
    (depth_mm > PLATES_TOUCH_MM).then(|| ConnectorFinding::Collide {
        first: a.part.id.clone(),
        second: b.part.id.clone(),
        nodes: shared(a.part, b.part),
        depth_mm,
    })
}

/// Nodes that both parts reach; all of theirs if there is none.
fn shared(a: &Part, b: &Part) -> Vec<usize> {
    let (mut a, b) = (a.body.nodes(), b.body.nodes());
    if a.iter().any(|node| b.contains(node)) {
        a.retain(|node| b.contains(node));
        a
    } else {
        a.into_iter().chain(b).collect()
    }
}

fn solids<'a>(structure: &Structure, part: &'a Part, fit: &Fit) -> Vec<Solid<'a>> {
    match &part.body {
        Body::Fin(fin) => {
            vec![Solid { part, plate: fin_plate(structure, fin, fit), copy: None }]
        }
        Body::Connector(body) => {
            let solid = |copy: &'a Copy| Solid {
                part,
                plate: connector_plate(structure, body, copy),
                copy: Some(copy),
            };
            body.copies.iter().map(solid).collect()
        }
        Body::Strip(_) | Body::Coupon => Vec::new(),
    }
}

/// A plate without its cuts.
fn connector_plate(structure: &Structure, body: &ConnectorBody, copy: &Copy) -> Plate {
    let node = &structure.nodes()[body.node()];
    let center = node.position + node.axis * copy.height;
    let frame = Frame::new(structure, body).map(|frame| frame.turned(copy.bearing));
    let thickness = body.connector.thickness();
    match (&body.connector, frame) {
        (Connector::Hinge(hinge), Some(frame)) => {
            let side = frame.axis.cross(&frame.first);
            let eye = Plate::arc(center, [-frame.first, side], hinge.radius);
            let tail = [1.0, -1.0].map(|way| {
                center + frame.first * hinge.tail() + side * (way * hinge.radius)
            });
            let outline: Vec<Point3> = eye.into_iter().chain(tail).collect();
            Plate::new(&outline, frame.axis, thickness)
        }
        (connector, _) => Plate::round(center, node.axis, connector.radius(), thickness),
    }
}

/// The fin cut back at both ends, without its cuts.
fn fin_plate(structure: &Structure, fin: &FinBody, fit: &Fit) -> Plate {
    let [i, j] = fin.nodes;
    let corners = structure.corners(fin.nodes);
    let [a, b, c, d] = corners;
    let cut = |from: Point3, to: Point3, at: usize, toward: usize, setback: f64| {
        let run = (to - from).dot(&structure.direction(at, toward));
        from + (to - from) * (setback / run)
    };
    let [first, second] = fin.setbacks;
    let outline = [
        cut(a, b, i, j, first),
        cut(b, a, j, i, second),
        cut(c, d, j, i, second),
        cut(d, c, i, j, first),
    ];
    Plate::new(&outline, (c - a).cross(&(d - b)).normalize(), fit.thickness)
}

/// Directions at a node: its axis, and across it that of the connector's first fin.
struct Frame {
    axis: crate::geometry::Vector3,
    first: crate::geometry::Vector3,
}

impl Frame {
    fn new(structure: &Structure, body: &ConnectorBody) -> Option<Self> {
        let node = body.node();
        let first = structure.direction(node, body.connector.around().spokes.first()?.to);
        Some(Self { axis: structure.nodes()[node].axis, first })
    }

    fn turned(self, bearing: f64) -> Self {
        let side = self.axis.cross(&self.first);
        let first = self.first * trig::cos(bearing) + side * trig::sin(bearing);
        Self { first, ..self }
    }
}

/// Fins that do not pass through the cuts of the plates that hold them.
fn in_cuts(structure: &Structure, parts: &[Part], fit: &Fit) -> Vec<ConnectorFinding> {
    let fins: BTreeMap<&str, &Part> =
        parts.iter().map(|part| (part.id.as_str(), part)).collect();
    let mut found = Vec::new();
    for part in parts {
        let Body::Connector(body) = &part.body else { continue };
        for copy in &body.copies {
            let held = copy
                .holds
                .iter()
                .filter_map(|&place| fins.get(body.fins[place].as_str()).copied());
            let cut = Cut { structure, part, body, copy, fit };
            found.extend(held.filter(|fin| cut.stuck(fin)).map(|fin| {
                ConnectorFinding::Collide {
                    first: fin.id.clone(),
                    second: part.id.clone(),
                    nodes: vec![body.node()],
                    depth_mm: fit.thickness,
                }
            }));
        }
    }
    found
}

/// One plate and what it is cut from.
struct Cut<'a> {
    structure: &'a Structure,
    part: &'a Part,
    body: &'a ConnectorBody,
    copy: &'a Copy,
    fit: &'a Fit,
}

/// Just inside a plate's face, as a share of its thickness: edges may lie in the face itself.
const SKIN: f64 = 0.01;

impl Cut<'_> {
    /// Whether a fin meets the material of the plate, or comes nearer than the clearance.
    fn stuck(&self, fin: &Part) -> bool {
        let Body::Fin(body) = &fin.body else { return false };
        let node = self.body.node();
        let Some(end) = body.nodes.iter().position(|&n| n == node) else { return true };
        let Some(out) = self.bearing(body.nodes[1 - end]) else { return true };
        let outline = fin.region.outline.flattened(ARC_SAGITTA_MM);
        let (thickness, clearance) = (self.fit.thickness, self.fit.clearance);
        let thickness = thickness - PLATES_TOUCH_MM;
        let relief = self.fit.relief;
        [SKIN - 0.5, 0.0, 0.5 - SKIN].into_iter().any(|share| {
            let height = self.copy.height + share * self.body.connector.thickness();
            spans(body, end, &outline, height).into_iter().any(|[from, to]| {
                // Into rounded corners the plate itself reaches, but not its clearance.
                self.meets(out, [from, to], thickness + clearance.min(0.0))
                    || from + relief < to - relief
                        && self.meets(
                            out,
                            [from + relief, to - relief],
                            thickness + clearance,
                        )
            })
        })
    }

    /// Direction of a fin on the plate, from the structure.
    fn bearing(&self, to: usize) -> Option<Vector2> {
        let frame = Frame::new(self.structure, self.body)?.turned(self.copy.bearing);
        let out = self.structure.direction(self.body.node(), to);
        let side = frame.axis.cross(&frame.first);
        Some(Vector2::new(out.dot(&frame.first), out.dot(&side)))
    }

    /// Whether a bar along `out` between two distances from the axis meets material.
    fn meets(&self, out: Vector2, [from, to]: [f64; 2], thickness: f64) -> bool {
        let left = Vector2::new(-out.y, out.x) * (thickness / 2.0);
        let at = |s: f64, side: f64| Point2::from(out * s + left * side);
        let bar = [at(from, -1.0), at(to, -1.0), at(to, 1.0), at(from, 1.0)];
        let contours = self.part.region.contours();
        let rings: Vec<Vec<Point2>> =
            contours.map(|c| c.flattened(ARC_SAGITTA_MM)).collect();
        let crosses = rings.iter().any(|ring| {
            let sides = ring.iter().zip(ring.iter().cycle().skip(1));
            sides.into_iter().any(|(a, b)| {
                (0..4)
                    .any(|k| predicates::segments_meet(bar[k], bar[(k + 1) % 4], *a, *b))
            })
        });
        // Without a crossing, one corner speaks for all: an odd number of rings around it
        // is material.
        let around = rings.iter().filter(|ring| predicates::contains(ring, bar[0]));
        crosses || around.count() % 2 == 1
    }
}

/// Where a fin has material at a height along the axis of one end: from and to, by the
/// distance from that axis.
fn spans(fin: &FinBody, end: usize, outline: &[Point2], height: f64) -> Vec<[f64; 2]> {
    let axis = &fin.axes[end];
    let inward = if end == 0 { axis.right() } else { -axis.right() };
    let local = |p: &Point2| {
        let way = p - axis.foot;
        [way.dot(&inward), way.dot(&axis.up) - height]
    };
    let next = outline.iter().cycle().skip(1);
    let mut met: Vec<f64> = outline
        .iter()
        .zip(next)
        .filter_map(|(p, q)| {
            let ([s, z], [t, w]) = (local(p), local(q));
            ((z < 0.0) != (w < 0.0)).then(|| s + (t - s) * z / (z - w))
        })
        .collect();
    met.sort_by(f64::total_cmp);
    met.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect()
}
