//! Which parts of an assembly run into each other.
//!
//! Made from the flat parts and the structure alone, not from what the parts were made
//! from. Fins and plates that do not belong together are convex and must be apart in space.
//! A plate and the fins it holds are looked at in the plane across the axis, where a fin is
//! a row of bars: they must stand inside the plate's cuts or beyond its rim, with the
//! clearance on both sides. A fin contains its axis, so this is exact; it is asked just
//! inside both faces of a plate and in its middle.

use crate::geometry::{Point2, Point3, Vector2, Vector3, predicates, trig};
use crate::ids::NodeId;
use crate::parts::assembly::assembled::{
    AssembledPart, Collision, Member, NodePlates, SlotFit,
};
use crate::parts::assembly::solid::Plate;
use crate::parts::part::Tip;
use crate::parts::plate::{PlacedPlate, PlateForm};
use crate::parts::star::shortest;
use crate::structure::Structure;
use crate::tolerance::{NO_LENGTH_MM, PLATES_TOUCH_MM};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::collections::{BTreeMap, BTreeSet};

/// A plate of the assembly.
struct Solid<'a> {
    part: &'a AssembledPart<'a>,
    plate: Plate,
    what: What<'a>,
}

/// What a plate is.
#[derive(Clone, Copy)]
enum What<'a> {
    /// A fin, by its nodes, and whether it may lap.
    Fin { nodes: [NodeId; 2], is_strip: bool },
    /// A copy of a connector.
    Copy(&'a NodePlates<'a>, &'a PlacedPlate),
}

/// All pairs of parts that would run into each other.
pub fn collide(
    structure: &Structure,
    parts: &[AssembledPart],
    slot_fit: &SlotFit,
) -> Vec<Collision> {
    let joined = parts.iter().filter_map(|part| match &part.member {
        Member::Plates(plates) => Some(plates.node),
        Member::Fins { .. } => None,
    });
    let joined: BTreeSet<NodeId> = joined.collect();
    let solids: Vec<Solid> = parts
        .iter()
        .flat_map(|part| solids(structure, part, slot_fit.thickness))
        .collect();
    let boxes = solids.iter().enumerate().map(|(k, solid)| {
        GeomWithData::new(Rectangle::from_aabb(around(&solid.plate)), k)
    });
    let tree: RTree<GeomWithData<Rectangle<[f64; 3]>, usize>> =
        RTree::bulk_load(boxes.collect());
    let mut collisions = Vec::new();
    for (k, solid) in solids.iter().enumerate() {
        let near = tree.locate_in_envelope_intersecting(around(&solid.plate));
        let mut near: Vec<usize> =
            near.map(|entry| entry.data).filter(|&n| n > k).collect();
        near.sort_unstable();
        let others = near.into_iter().map(|n| &solids[n]);
        let strangers = others.filter(|other| !may_touch(solid, other, &joined));
        collisions.extend(strangers.filter_map(|other| collision(solid, other)));
    }
    collisions.extend(in_cuts(structure, parts, slot_fit));
    // The plates of two nodes meet more than once; once is enough to say.
    let mut told = BTreeSet::new();
    collisions.retain(|found| told.insert(found.parts.clone()));
    collisions
}

fn around(plate: &Plate) -> AABB<[f64; 3]> {
    let [low, high] = plate.bounds();
    AABB::from_corners(low.into(), high.into())
}

/// Whether a plate holds a fin.
fn holds(plate: &Solid, fin: &Solid) -> bool {
    let (What::Copy(plates, copy), What::Fin { nodes, .. }) = (plate.what, fin.what)
    else {
        return false;
    };
    copy.holds.iter().any(|&place| {
        let (name, to) = plates.stands[place];
        name == fin.part.name && [plates.node, to].iter().all(|node| nodes.contains(node))
    })
}

/// Whether two plates may touch: fins of strips meet on axes where no plates part them.
fn may_touch(a: &Solid, b: &Solid, joined: &BTreeSet<NodeId>) -> bool {
    let (
        What::Fin { nodes: first, is_strip },
        What::Fin { nodes: second, is_strip: other },
    ) = (a.what, b.what)
    else {
        return holds(a, b) || holds(b, a);
    };
    let shared = first.into_iter().find(|node| second.contains(node));
    (is_strip || other) && shared.is_none_or(|node| !joined.contains(&node))
}

fn collision(a: &Solid, b: &Solid) -> Option<Collision> {
    let depth_mm = a.plate.overlap(&b.plate);
    (depth_mm > PLATES_TOUCH_MM).then(|| Collision {
        parts: [a, b].map(|solid| solid.part.name.to_owned()),
        nodes: shared(a.part, b.part),
        depth_mm,
    })
}

/// Nodes that both parts reach; all of theirs if there is none.
fn shared(a: &AssembledPart, b: &AssembledPart) -> Vec<NodeId> {
    let (mut a, b) = (a.nodes(), b.nodes());
    if a.iter().any(|node| b.contains(node)) {
        a.retain(|node| b.contains(node));
        a
    } else {
        a.into_iter().chain(b).collect()
    }
}

fn solids<'a>(
    structure: &Structure,
    part: &'a AssembledPart<'a>,
    thickness: f64,
) -> Vec<Solid<'a>> {
    let (nodes, tips, is_strip) = match &part.member {
        Member::Fins { nodes, tips, is_strip } => (nodes, tips, *is_strip),
        Member::Plates(plates) => {
            let solid = |copy: &'a PlacedPlate| {
                let plate = connector_plate(structure, plates, copy);
                Solid { part, plate, what: What::Copy(plates, copy) }
            };
            return plates.copies.iter().map(solid).collect();
        }
    };
    let setback = |node: NodeId, to: NodeId| {
        let tip = tips.iter().find(|tip| (tip.axis.node, tip.to) == (node, to));
        tip.map_or(0.0, |tip| tip.setback)
    };
    let solid = |fin: &[NodeId]| {
        let nodes = [fin[0], fin[1]];
        let setbacks = [setback(nodes[0], nodes[1]), setback(nodes[1], nodes[0])];
        let plate = fin_plate(structure, nodes, setbacks, thickness)?;
        Some(Solid { part, plate, what: What::Fin { nodes, is_strip } })
    };
    nodes.windows(2).filter_map(solid).collect()
}

/// A plate without its cuts.
fn connector_plate(
    structure: &Structure,
    plates: &NodePlates,
    copy: &PlacedPlate,
) -> Plate {
    let node = &structure.nodes()[plates.node];
    let center = node.position + node.axis * copy.height;
    let frame = Frame::new(structure, plates).map(|frame| frame.turned(copy.bearing));
    match (plates.form, frame) {
        (PlateForm::Eye { radius, tail }, Some(frame)) => {
            let side = frame.axis.cross(&frame.first);
            let eye = Plate::arc(center, [-frame.first, side], radius);
            let tail = [1.0, -1.0]
                .map(|way| center + frame.first * tail + side * (way * radius));
            let outline: Vec<Point3> = eye.into_iter().chain(tail).collect();
            Plate::new(&outline, frame.axis, plates.thickness)
        }
        (PlateForm::Eye { radius, .. } | PlateForm::Disc { radius }, _) => {
            Plate::round(center, node.axis, radius, plates.thickness)
        }
    }
}

/// The fin cut back at both ends, without its cuts; `None` for one twisted so that its axes
/// span no plane, which is said elsewhere.
fn fin_plate(
    structure: &Structure,
    [i, j]: [NodeId; 2],
    [first, second]: [f64; 2],
    thickness: f64,
) -> Option<Plate> {
    let [a, b, c, d] = structure.corners([i, j]);
    let cut = |from: Point3, to: Point3, at: NodeId, toward: NodeId, setback: f64| {
        let run = (to - from).dot(&structure.direction(at, toward));
        from + (to - from) * (setback / run)
    };
    let outline = [
        cut(a, b, i, j, first),
        cut(b, a, j, i, second),
        cut(c, d, j, i, second),
        cut(d, c, i, j, first),
    ];
    let normal = (c - a).cross(&(d - b)).try_normalize(NO_LENGTH_MM)?;
    let is_flat = outline.iter().all(|p| p.coords.iter().all(|x| x.is_finite()));
    is_flat.then(|| Plate::new(&outline, normal, thickness))
}

/// Directions at a node: its axis, and across it that of what stands first.
struct Frame {
    axis: Vector3,
    first: Vector3,
}

impl Frame {
    fn new(structure: &Structure, plates: &NodePlates) -> Option<Self> {
        let first = structure.direction(plates.node, plates.stands.first()?.1);
        Some(Self { axis: structure.nodes()[plates.node].axis, first })
    }

    fn turned(self, bearing: f64) -> Self {
        let side = self.axis.cross(&self.first);
        let first = self.first * trig::cos(bearing) + side * trig::sin(bearing);
        Self { first, ..self }
    }
}

/// Fins that do not pass through the cuts of the plates that hold them.
fn in_cuts(
    structure: &Structure,
    parts: &[AssembledPart],
    slot_fit: &SlotFit,
) -> Vec<Collision> {
    let known: BTreeMap<&str, &AssembledPart> =
        parts.iter().map(|part| (part.name, part)).collect();
    let mut collisions = Vec::new();
    for part in parts {
        let Member::Plates(plates) = &part.member else { continue };
        for copy in &plates.copies {
            let cut = Cut { structure, part, plates, copy, slot_fit };
            let stuck = copy.holds.iter().filter_map(|&place| {
                let fin = known.get(plates.stands[place].0)?;
                cut.stuck(fin, place).then(|| fin.name.to_owned())
            });
            collisions.extend(stuck.map(|first| Collision {
                parts: [first, part.name.to_owned()],
                nodes: vec![plates.node],
                depth_mm: slot_fit.thickness,
            }));
        }
    }
    collisions
}

/// One plate and what it is cut from.
struct Cut<'a> {
    structure: &'a Structure,
    part: &'a AssembledPart<'a>,
    plates: &'a NodePlates<'a>,
    copy: &'a PlacedPlate,
    slot_fit: &'a SlotFit,
}

/// Just inside a plate's face, as a share of its thickness: edges may lie in the face itself.
const SKIN: f64 = 0.01;

impl Cut<'_> {
    /// Whether what stands at a place meets the material of the plate, or comes nearer than
    /// the clearance.
    fn stuck(&self, part: &AssembledPart, place: usize) -> bool {
        let (node, to) = (self.plates.node, self.plates.stands[place].1);
        let Member::Fins { tips, .. } = &part.member else { return true };
        let tip = tips.iter().find(|tip| (tip.axis.node, tip.to) == (node, to));
        let (Some(tip), Some(out)) = (tip, self.bearing(to)) else { return true };
        let SlotFit { thickness, clearance, relief } = *self.slot_fit;
        let thickness = thickness - PLATES_TOUCH_MM;
        // A strip folds at its next axis; what lies behind is not in this plane.
        let length = shortest(self.structure, [node, to]);
        [SKIN - 0.5, 0.0, 0.5 - SKIN].into_iter().any(|share| {
            let height = self.copy.height + share * self.plates.thickness;
            let spans = part.rings.iter().flat_map(|ring| spans(tip, ring, height));
            let own = spans.filter(|[from, _]| *from < length);
            let inside = own.map(|[from, to]| {
                [from + PLATES_TOUCH_MM, to.min(length) - PLATES_TOUCH_MM]
            });
            inside.filter(|[from, to]| from < to).any(|[from, to]| {
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
    fn bearing(&self, to: NodeId) -> Option<Vector2> {
        let frame = Frame::new(self.structure, self.plates)?.turned(self.copy.bearing);
        let out = self.structure.direction(self.plates.node, to);
        let side = frame.axis.cross(&frame.first);
        Some(Vector2::new(out.dot(&frame.first), out.dot(&side)))
    }

    /// Whether a bar along `out` between two distances from the axis meets material.
    fn meets(&self, out: Vector2, [from, to]: [f64; 2], thickness: f64) -> bool {
        let left = Vector2::new(-out.y, out.x) * (thickness / 2.0);
        let at = |s: f64, side: f64| Point2::from(out * s + left * side);
        let bar = [at(from, -1.0), at(to, -1.0), at(to, 1.0), at(from, 1.0)];
        let rings = &self.part.rings;
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

/// Where a part has material at a height along the axis of an end: from and to, by the
/// distance from that axis.
fn spans(tip: &Tip, ring: &[Point2], height: f64) -> Vec<[f64; 2]> {
    let local = |p: &Point2| {
        let way = p - tip.axis.foot;
        [way.dot(&tip.inward), way.dot(&tip.axis.up) - height]
    };
    let next = ring.iter().cycle().skip(1);
    let mut met: Vec<f64> = ring
        .iter()
        .zip(next)
        .filter_map(|(p, q)| {
            let ([s, z], [t, w]) = (local(p), local(q));
            ((z < 0.0) != (w < 0.0)).then(|| s + (t - s) * z / (z - w))
        })
        .collect();
    met.sort_by(f64::total_cmp);
    let pairs = met.chunks_exact(2).map(|pair| [pair[0], pair[1]]);
    // A strip that winds back may have material before the axis.
    pairs.filter(|[_, to]| *to > 0.0).collect()
}
