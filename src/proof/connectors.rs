//! The connectors of one format's files: do their slots stand as the fins do in space?
//!
//! Asked of the list in `job.json`, where a name may be wrong, and of the windows as drawn,
//! which may be turned.

use crate::geometry::{Contour, Point2, Vector2, predicates, trig};
use crate::proof::figures::{Worst, micro};
use crate::proof::finding::{ProofFinding, Spot};
use crate::proof::manifest::{Connector, Kind, Manifest};
use crate::proof::matching::Found;
use crate::proof::sheets::Read;
use crate::structure::Structure;
use crate::tolerance::{ARC_SAGITTA_MM, SLOT_TURN_DEG};
use std::collections::BTreeMap;

/// What is wrong with the connectors that were found; the worst angle goes into `worst`.
pub(super) fn check(
    read: &Read,
    structure: &Structure,
    worst: &mut Worst,
) -> Vec<ProofFinding> {
    let known = Known::new(read.manifest, structure);
    let mut findings = Vec::new();
    for found in &read.found {
        let place = &read.matching.places[found.place];
        let part = read.matching.shapes[place.shape].part;
        let Some(connector) = &part.connector else { continue };
        let Some(needed) = known.angles(connector) else {
            // Made again alone, without its fins, it is proved by its shape.
            if read.manifest.only.is_some() {
                continue;
            }
            let spot = Spot::file("job.json").part(&part.id).node(connector.node);
            findings.push(ProofFinding::BadList { spot });
            continue;
        };
        let slots =
            connector.slots.iter().map(|slot| (slot.fin.as_str(), slot.angle_deg));
        let fins = connector.fins.iter().map(|(fin, angle)| (fin.as_str(), *angle));
        let listed = slots.chain(fins).map(|(fin, angle)| {
            let spot = Spot::file("job.json").part(&part.id).node(connector.node);
            (spot, fin, angle)
        });
        let drawn = drawn(read, found, connector, &needed);
        for (spot, fin, found_deg) in listed.chain(drawn) {
            let needed_deg = needed[fin];
            let off = (found_deg - needed_deg + 180.0).rem_euclid(360.0) - 180.0;
            worst.slot_deg = worst.slot_deg.max(micro(off.abs()));
            if off.abs() > SLOT_TURN_DEG {
                let fin = fin.to_owned();
                findings.push(ProofFinding::SlotTurned {
                    spot,
                    fin,
                    found_deg,
                    needed_deg,
                });
            }
        }
    }
    findings
}

/// The windows of a hub as drawn, each with the fin whose place it is nearest to.
fn drawn<'a>(
    read: &Read,
    found: &Found,
    connector: &'a Connector,
    needed: &BTreeMap<&str, f64>,
) -> Vec<(Spot, &'a str, f64)> {
    if connector.kind != Kind::Hub {
        return Vec::new();
    }
    let windows: Vec<(Contour, f64)> = read
        .holes_of(found)
        .into_iter()
        .filter_map(|hole| {
            let angle = direction(&hole.moved(|p| found.motion.back(p)))?;
            Some((hole, angle))
        })
        .collect();
    let slots = connector.slots.iter().filter_map(|slot| {
        let wanted = *needed.get(slot.fin.as_str())?;
        let off = |angle: f64| ((angle - wanted + 180.0).rem_euclid(360.0) - 180.0).abs();
        let (hole, angle) =
            windows.iter().min_by(|a, b| off(a.1).total_cmp(&off(b.1)))?;
        let spot = read.spot(found).node(connector.node).at(hole.vertices[0].point);
        Some((spot, slot.fin.as_str(), *angle))
    });
    slots.collect()
}

/// Direction from the origin to a hole's centre of area, degrees; the hole for the rod lies
/// around the origin and has none.
fn direction(hole: &Contour) -> Option<f64> {
    let ring = hole.flattened(ARC_SAGITTA_MM);
    let around_rod = predicates::contains(&ring, Point2::origin());
    let sides = ring.iter().zip(ring.iter().cycle().skip(1));
    let moment: Vector2 =
        sides.map(|(a, b)| (a.coords + b.coords) * a.coords.perp(&b.coords)).sum();
    let center = moment * hole.signed_area().signum();
    (!around_rod).then(|| trig::atan2(center.y, center.x).to_degrees())
}

/// What is known of fins by name.
struct Known<'a> {
    structure: &'a Structure,
    nodes: BTreeMap<&'a str, [usize; 2]>,
}

impl<'a> Known<'a> {
    fn new(manifest: &'a Manifest, structure: &'a Structure) -> Self {
        let fins = manifest.parts.iter().filter_map(|part| {
            let nodes = part.strip.as_ref()?.nodes.as_slice();
            let [i, j] = *nodes else { return None };
            Some((part.id.as_str(), [i, j]))
        });
        Self { structure, nodes: fins.collect() }
    }

    /// Angle of each listed fin about its node in the structure, degrees from the first; `None`
    /// if they are not the fins of that node, each once.
    fn angles(&self, connector: &'a Connector) -> Option<BTreeMap<&'a str, f64>> {
        let arms = &self.structure.nodes().get(connector.node)?.arms;
        let bearing = |fin: &str| {
            let [i, j] = *self.nodes.get(fin)?;
            let to = if i == connector.node { j } else { i };
            arms.iter().find(|arm| arm.to == to).map(|arm| arm.angle)
        };
        let first = bearing(&connector.slots.first()?.fin)?;
        let names = connector.slots.iter().map(|slot| slot.fin.as_str());
        let angle = |fin: &'a str| Some((fin, (bearing(fin)? - first).to_degrees()));
        let angles: BTreeMap<&str, f64> = names.map(angle).collect::<Option<_>>()?;
        let known =
            connector.fins.iter().all(|(fin, _)| angles.contains_key(fin.as_str()));
        (angles.len() == arms.len() && known).then_some(angles)
    }
}
