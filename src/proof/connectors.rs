//! The connectors of one format's files: do their slots stand as the fins do in space?
//!
//! Asked of the list in `job.json`, where a name may be wrong, and of the windows as drawn,
//! which may be turned.

use crate::geometry::{Contour, Point2, Vector2, predicates, trig};
use crate::manifest::{ConnectorEntry, ConnectorKind, Manifest, RunEntry, Worst};
use crate::proof::figures::micro;
use crate::proof::finding::{ProofFinding, Spot};
use crate::proof::fit;
use crate::proof::matching::Found;
use crate::proof::sheets::Read;
use crate::structure::Structure;
use crate::tolerance::{ARC_SAGITTA_MM, SLOT_TURN_DEG};
use std::collections::{BTreeMap, BTreeSet};

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
        let Some(stands) = known.stands(connector) else {
            // Made again alone, without its fins, it is proved by its shape.
            if read.manifest.only.is_some() {
                continue;
            }
            let spot = Spot::file("job.json").part(&part.id).node(connector.node);
            findings.push(ProofFinding::BadList { spot });
            continue;
        };
        let slots = connector.slots.iter().zip(&stands);
        let slots = slots.map(|(slot, stand)| (stand, slot.angle_deg));
        let fins = connector.fins.iter().filter_map(|(fin, angle)| {
            let of_it = stands.iter().filter(|stand| stand.fin == fin);
            Some((nearest(of_it, *angle, |stand| stand.angle_deg)?, *angle))
        });
        let listed = slots.chain(fins).map(|(stand, angle)| {
            let spot = Spot::file("job.json").part(&part.id).node(connector.node);
            (spot, stand, angle)
        });
        let drawn = drawn(read, found, connector, &stands);
        for (spot, stand, found_deg) in listed.chain(drawn) {
            let needed_deg = stand.angle_deg;
            let off = apart(found_deg, needed_deg);
            worst.slot_deg = worst.slot_deg.max(micro(off));
            if off > SLOT_TURN_DEG {
                let fin = stand.fin.to_owned();
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

/// How far two directions differ, degrees.
fn apart(a: f64, b: f64) -> f64 {
    ((a - b + 180.0).rem_euclid(360.0) - 180.0).abs()
}

/// The one whose direction is nearest.
fn nearest<T>(
    all: impl Iterator<Item = T>,
    wanted_deg: f64,
    angle_deg: impl Fn(&T) -> f64,
) -> Option<T> {
    let off = |one: &T| apart(angle_deg(one), wanted_deg);
    all.min_by(|a, b| off(a).total_cmp(&off(b)))
}

/// The windows of a hub as drawn, each with the fin whose place it is nearest to.
fn drawn<'a>(
    read: &Read,
    found: &Found,
    connector: &ConnectorEntry,
    stands: &'a [Stand<'a>],
) -> Vec<(Spot, &'a Stand<'a>, f64)> {
    if connector.kind != ConnectorKind::Hub {
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
    let slots = stands.iter().filter_map(|stand| {
        let (hole, angle) = nearest(windows.iter(), stand.angle_deg, |window| window.1)?;
        let spot = read.spot(found).node(connector.node).at(hole.vertices[0].point);
        Some((spot, stand, *angle))
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

/// A part in a connector.
pub(super) struct Stand<'a> {
    pub fin: &'a str,
    /// The node at the other end of its fin.
    pub to: usize,
    /// Its direction in the structure from that of the first, degrees.
    pub angle_deg: f64,
}

/// What is known of fins and strips by name.
pub(super) struct Known<'a> {
    structure: &'a Structure,
    strips: BTreeMap<&'a str, &'a RunEntry>,
}

impl<'a> Known<'a> {
    pub(super) fn new(manifest: &'a Manifest, structure: &'a Structure) -> Self {
        let strips = manifest.parts.iter();
        let strips = strips.filter_map(|part| {
            let sound = |strip: &&RunEntry| strip.is_sound(structure.nodes().len());
            Some((part.id.as_str(), part.run().filter(sound)?))
        });
        Self { structure, strips: strips.collect() }
    }

    /// What stands in the slots, in their order; `None` if that is not each fin of the node
    /// once.
    pub(super) fn stands(&self, connector: &'a ConnectorEntry) -> Option<Vec<Stand<'a>>> {
        let arms = &self.structure.nodes().get(connector.node)?.arms;
        let bearing = |to: usize| {
            let known = arms.iter().any(|arm| arm.to.index() == to);
            known.then(|| fit::bearing(self.structure, connector.node, to))
        };
        let mut stands: Vec<Stand> = Vec::new();
        for slot in &connector.slots {
            let ends = self.strips.get(slot.fin.as_str())?.ends_at(connector.node);
            // A ring ends at its seam twice.
            let meant = ends.iter().find(|&&to| Some(to) == slot.to);
            let to = *meant.or(ends.first())?;
            let from = stands.first().map_or(bearing(to), |first| bearing(first.to))?;
            let angle_deg = (bearing(to)? - from).to_degrees().rem_euclid(360.0);
            stands.push(Stand { fin: &slot.fin, to, angle_deg });
        }
        let all: BTreeSet<usize> = stands.iter().map(|stand| stand.to).collect();
        let known = |fin: &str| stands.iter().any(|stand| stand.fin == fin);
        let complete = all.len() == arms.len() && stands.len() == arms.len();
        let listed = connector.fins.iter().all(|(fin, _)| known(fin));
        (complete && listed).then_some(stands)
    }
}
