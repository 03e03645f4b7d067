//! What `job.json` says of single fins, connectors, rods and their assembly.

use crate::parts::{Body, Connector, ConnectorBody, Copy, FinBody, Part, Step};
use crate::report::manifest::{axis, degrees, mm};
use serde_json::{Value, json};
use std::collections::BTreeMap;

pub(super) fn fin(body: &FinBody) -> Value {
    json!({
        "nodes": body.nodes,
        "axes": body.axes.iter().map(axis).collect::<Vec<_>>(),
        "setbacks": body.setbacks.map(mm),
    })
}

pub(super) fn connector(body: &ConnectorBody) -> Value {
    let connector = &body.connector;
    let named = || body.fins.iter().zip(&connector.around().spokes);
    let (kind, width, length, hole) = match connector {
        Connector::Hub(hub) => ("hub", hub.width, hub.slot, hub.hole),
        Connector::Hinge(hinge) => {
            ("hinge", hinge.width, hinge.tail() - hinge.floor, hinge.hole)
        }
    };
    let slots = named().map(|(fin, spoke)| {
        json!({
            "fin": fin,
            "to": spoke.to,
            "angle_deg": degrees(spoke.bearing),
            "width": mm(width),
            "length": mm(length),
        })
    });
    let copy = |copy: &Copy| {
        json!({
            "height": mm(copy.height),
            "angle_deg": degrees(copy.bearing),
            "fins": copy.holds.iter().map(|&place| &body.fins[place]).collect::<Vec<_>>(),
        })
    };
    json!({
        "kind": kind,
        "node": body.node(),
        "fins": named().map(|(fin, s)| json!([fin, degrees(s.bearing)])).collect::<Vec<_>>(),
        "slots": slots.collect::<Vec<_>>(),
        "radius": mm(connector.radius()),
        "hole": mm(2.0 * hole),
        "thickness": mm(connector.thickness()),
        "copies": body.copies.iter().map(copy).collect::<Vec<_>>(),
    })
}

/// A fin, a disc, or eyes with their rod; the lower disc of a hub comes from below.
pub(super) fn step(part: &Part, step: &Step) -> Value {
    let from = match (&part.body, step.copies) {
        (Body::Connector(_), [1, 1]) => "below",
        _ => "above",
    };
    json!({"copies": step.copies, "from": from})
}

/// Something that is bought.
pub(super) struct Hardware {
    pub kind: &'static str,
    pub diameter: f64,
    /// Whole mm; `None` of what comes as it is.
    pub length: Option<u64>,
    pub quantity: usize,
    pub nodes: Vec<usize>,
}

impl Hardware {
    /// Such as `M3 x 40`.
    pub(super) fn name(&self) -> String {
        let length = self.length.map(|mm| format!(" x {mm}")).unwrap_or_default();
        format!("M{}{length}", self.diameter)
    }
}

/// What is bought: a rod through each connector by length, and on each a nut and a washer
/// at both ends, which take as much again as the rod is thick (nut 0.8 d, washer 0.2 d).
pub(super) fn hardware(parts: &[Part]) -> Vec<Hardware> {
    let connectors = || {
        parts.iter().filter_map(|part| match &part.body {
            Body::Connector(body) => Some(body),
            _ => None,
        })
    };
    let mut rods: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
    for body in connectors() {
        let (Some(low), Some(high)) = (body.copies.first(), body.copies.last()) else {
            continue;
        };
        let length =
            high.height - low.height + body.connector.thickness() + 2.0 * body.rod;
        rods.entry(length.max(0.0).ceil() as u64).or_default().push(body.node());
    }
    let Some(diameter) = connectors().map(|body| body.rod).next() else {
        return Vec::new();
    };
    let rods = rods.into_iter().map(|(length, nodes)| Hardware {
        kind: "rod",
        diameter,
        length: Some(length),
        quantity: nodes.len(),
        nodes,
    });
    let ends = 2 * connectors().count();
    let ends = ["nut", "washer"].map(|kind| Hardware {
        kind,
        diameter,
        length: None,
        quantity: ends,
        nodes: Vec::new(),
    });
    rods.chain(ends).collect()
}

/// The same for `job.json`.
pub(super) fn bought(parts: &[Part]) -> Vec<Value> {
    let item = |item: Hardware| {
        json!({
            "kind": item.kind,
            "diameter": item.diameter,
            "length": item.length,
            "quantity": item.quantity,
            "nodes": item.nodes,
        })
    };
    hardware(parts).into_iter().map(item).collect()
}
