//! The parts of one format's files put together as plates of their thickness: nothing may
//! run into anything else.
//!
//! What was measured on its own lies where it should; this finds what is wrong between
//! parts, such as discs at a height where no fin is notched.

use crate::geometry::{Point2, Vector2};
use crate::ids::NodeId;
use crate::manifest::{ConnectorEntry, ConnectorKind, PartEntry, RunEntry};
use crate::parts::{
    AssembledPart, Collision, FlatAxis, Member, NodePlates, PlacedPlate, PlateForm,
    SlotFit, Tip, collide,
};
use crate::proof::connectors::Known;
use crate::proof::finding::{ProofFinding, Spot};
use crate::proof::matching::Found;
use crate::proof::sheets::Read;
use crate::structure::Structure;
use crate::tolerance::ARC_SAGITTA_MM;

/// Parts that run into each other, if none of them is blamed for something already.
pub(super) fn check(
    read: &Read,
    structure: &Structure,
    told: &[ProofFinding],
) -> Vec<ProofFinding> {
    let manifest = read.manifest;
    if manifest.only.is_some() || manifest.parts.iter().all(|p| p.connector.is_none()) {
        return Vec::new();
    }
    let known = Known::new(manifest, structure);
    let of = |found: &Found| {
        let place = &read.matching.places[found.place];
        let part = read.matching.shapes[place.shape].part;
        let member = match (&part.connector, part.run()) {
            (Some(connector), _) => plates(&known, connector, found, place.copy)?,
            (None, Some(strip)) => fins(structure, part, strip)?,
            (None, None) => return None,
        };
        Some(AssembledPart { name: &part.id, rings: rings(read, found), member })
    };
    let built: Vec<AssembledPart> = read.found.iter().filter_map(of).collect();
    let (thickness, clearance) =
        (manifest.material.thickness, manifest.material.clearance);
    // What is wider was measured slot by slot; what counts here is material.
    let slot_fit = SlotFit { thickness, clearance: clearance.min(0.0), relief: 0.0 };
    let blamed = |part: &String| told.iter().any(|fact| fact.spot().parts.contains(part));
    let hits = collide(structure, &built, &slot_fit).into_iter();
    let news = hits.filter(|hit| !hit.parts.iter().any(blamed));
    news.map(|Collision { parts, nodes, depth_mm }| {
        let spot = Spot { parts: parts.to_vec(), ..Spot::file("job.json") };
        let spot =
            nodes.first().map_or_else(|| spot.clone(), |n| spot.clone().node(n.index()));
        ProofFinding::PartsCollide { spot, depth_mm }
    })
    .collect()
}

/// Outline and holes as drawn, kerf undone, in part coordinates.
fn rings(read: &Read, found: &Found) -> Vec<Vec<Point2>> {
    let holes = read.holes_of(found).into_iter();
    let holes = holes.map(|hole| hole.moved(|p| found.motion.back(p)));
    std::iter::once(found.outline.clone())
        .chain(holes)
        .map(|contour| contour.flattened(ARC_SAGITTA_MM))
        .collect()
}

/// A fin or strip; `None` if its lists do not fit, which is said elsewhere.
fn fins<'a>(
    structure: &Structure,
    part: &PartEntry,
    strip: &RunEntry,
) -> Option<Member<'a>> {
    if !strip.is_sound(structure.nodes().len()) || strip.nodes.len() < 2 {
        return None;
    }
    let last = strip.nodes.len() - 1;
    let ends = [(0, 1, 1.0), (last, last - 1, -1.0)].into_iter().zip(strip.setbacks);
    let own = ends.filter(|((place, ..), _)| strip.beside(*place).contains(&None));
    let tip = |((place, next, way), setback): ((usize, usize, f64), f64)| {
        let (node, listed) = (strip.nodes[place], strip.axes[place]);
        let up = (listed.top - listed.bottom).try_normalize(0.0)?;
        let at = &structure.nodes()[node];
        let foot = listed.bottom + up * at.below;
        let (node, to) = (node.into(), strip.nodes[next].into());
        let axis = FlatAxis { node, foot, up, below: at.below, above: at.above };
        let inward = Vector2::new(up.y, -up.x) * way;
        Some(Tip { axis, inward, to, setback })
    };
    let tips = own.map(tip).collect::<Option<Vec<Tip>>>()?;
    let nodes = strip.nodes.iter().copied().map(NodeId::new).collect();
    Some(Member::Fins { nodes, tips, is_strip: part.kind == "strip" })
}

/// One drawn copy of a connector's plates.
fn plates<'a>(
    known: &Known<'a>,
    connector: &'a ConnectorEntry,
    found: &Found,
    copy: usize,
) -> Option<Member<'a>> {
    let stands = known.stands(connector)?;
    let stands = stands.iter().map(|s| (s.fin, s.to.into()));
    let stands: Vec<(&str, NodeId)> = stands.collect();
    let listed = connector.copies.get(copy.checked_sub(1)?)?;
    let holds =
        (0..stands.len()).filter(|&k| listed.fins.iter().any(|f| f == stands[k].0));
    let copy = PlacedPlate {
        height: listed.height,
        bearing: listed.angle_deg.to_radians(),
        holds: holds.collect(),
    };
    let points = || found.outline.vertices.iter().map(|vertex| vertex.point.coords);
    let far = |of: fn(&Vector2) -> f64| points().map(|p| of(&p)).fold(0.0, f64::max);
    let form = match connector.kind {
        ConnectorKind::Hub => PlateForm::Disc { radius: far(|p| p.norm()) },
        ConnectorKind::Hinge => {
            PlateForm::Eye { radius: far(|p| p.y), tail: far(|p| p.x) }
        }
    };
    let (node, thickness) = (connector.node.into(), connector.thickness);
    let copies = vec![copy];
    Some(Member::Plates(NodePlates { node, form, thickness, stands, copies }))
}
