//! General linkages as JSON: bodies and pins without a structure.

use crate::geometry::{Point3, Vector3};
use crate::rigidity::finding::RigidityFinding;
use crate::rigidity::model::{Coupling, Model, RigidBody};
use serde::Deserialize;
use std::collections::BTreeSet;

/// Place, axis and bodies of a pin.
type Given = ([f64; 3], [f64; 3], Vec<usize>);

#[derive(Deserialize)]
struct File {
    bodies: usize,
    r: f64,
    pins: Vec<Given>,
}

/// More bodies than this are taken for a mistake.
const MOST_BODIES: usize = 10_000_000;

/// Reads bodies and pins; lengths are taken as they are.
///
/// # Errors
/// Everything that is wrong with the text.
pub fn read_linkage(text: &str) -> Result<Model, Vec<RigidityFinding>> {
    let file: File = serde_json::from_str(text).map_err(|error| {
        vec![RigidityFinding::BadLinkage {
            line: error.line(),
            message: error.to_string(),
        }]
    })?;
    let mut findings = Vec::new();
    if file.bodies == 0 || file.bodies > MOST_BODIES {
        findings.push(RigidityFinding::BodyCount { bodies: file.bodies });
    }
    if !(file.r > 0.0 && file.r.is_finite()) {
        findings.push(RigidityFinding::NoReach { r: file.r });
    }
    let pins = file.pins.iter().enumerate();
    findings.extend(pins.filter_map(|(pin, given)| fault(pin, given, file.bodies)));
    if !findings.is_empty() {
        return Err(findings);
    }
    let coupling = |(pin, (place, axis, bodies)): (usize, Given)| {
        let half = Vector3::from(axis).normalize() * file.r;
        let place = Point3::from(place);
        let mut bodies = bodies;
        bodies.sort_unstable();
        let points = vec![place - half, place + half];
        Coupling { node: pin.into(), points, bodies, held: false, share: 0.5 }
    };
    let couplings = file.pins.into_iter().enumerate().map(coupling).collect();
    Ok(Model::new((0..file.bodies).map(RigidBody::Link).collect(), couplings))
}

fn fault(
    pin: usize,
    (place, axis, on): &Given,
    bodies: usize,
) -> Option<RigidityFinding> {
    if place.iter().chain(axis).any(|x| !x.is_finite()) {
        return Some(RigidityFinding::NotFinite { pin });
    }
    let length = Vector3::from(*axis).norm();
    if !(length > 0.0 && length.is_finite()) {
        return Some(RigidityFinding::ZeroAxis { pin });
    }
    if let Some(&body) = on.iter().find(|&&body| body >= bodies) {
        return Some(RigidityFinding::NoSuchBody { pin, body, bodies });
    }
    let count = on.iter().collect::<BTreeSet<_>>().len();
    (count < 2 || count < on.len())
        .then(|| RigidityFinding::PinBodies { pin, bodies: on.clone() })
}
