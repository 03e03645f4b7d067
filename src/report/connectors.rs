//! What `job.json` says of single fins, connectors and what is bought.

use crate::ids::NodeId;
use crate::manifest::{
    ConnectorEntry, CopyEntry, HardwareEntry, RunEntry, SlotEntry, degrees, mm,
};
use crate::parts::{Body, ConnectorBody, FinBody, Part, PlacedPlate};
use crate::report::manifest::axis;
use std::collections::BTreeMap;

pub(super) fn fin(body: &FinBody) -> RunEntry {
    RunEntry {
        nodes: body.nodes.map(NodeId::index).to_vec(),
        axes: body.axes.iter().map(axis).collect(),
        setbacks: body.setbacks.map(mm),
        closed: None,
        folds: None,
        slits: None,
        splices: None,
    }
}

pub(super) fn connector(body: &ConnectorBody) -> ConnectorEntry {
    let plates = &body.plates;
    let named = || body.fins.iter().zip(&body.star.fins);
    let [width, length] = plates.slot.map(mm);
    let slots = named().map(|(name, fin)| SlotEntry {
        fin: name.clone(),
        to: Some(fin.to.index()),
        angle_deg: degrees(fin.bearing),
        width,
        length,
    });
    let copy = |copy: &PlacedPlate| CopyEntry {
        height: mm(copy.height),
        angle_deg: degrees(copy.bearing),
        fins: copy.holds.iter().map(|&place| body.fins[place].clone()).collect(),
    };
    ConnectorEntry {
        kind: plates.form.into(),
        node: body.node().index(),
        fins: named().map(|(name, fin)| (name.clone(), degrees(fin.bearing))).collect(),
        slots: slots.collect(),
        radius: mm(plates.form.radius()),
        hole: mm(2.0 * plates.hole),
        thickness: mm(plates.thickness),
        copies: plates.copies.iter().map(copy).collect(),
    }
}

/// Something that is bought.
pub(super) struct Hardware {
    pub kind: &'static str,
    pub diameter: f64,
    /// Whole mm; `None` of what comes as it is.
    pub length: Option<u64>,
    pub quantity: usize,
    pub nodes: Vec<NodeId>,
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
    let mut rods: BTreeMap<u64, Vec<NodeId>> = BTreeMap::new();
    for body in connectors() {
        let plates = &body.plates;
        let (Some(low), Some(high)) = (plates.copies.first(), plates.copies.last())
        else {
            continue;
        };
        let length = high.height - low.height + plates.thickness + 2.0 * body.rod;
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
pub(super) fn bought(parts: &[Part]) -> Vec<HardwareEntry> {
    let item = |item: Hardware| HardwareEntry {
        kind: item.kind.to_owned(),
        diameter: item.diameter,
        length: item.length,
        quantity: item.quantity,
        nodes: item.nodes.into_iter().map(NodeId::index).collect(),
    };
    hardware(parts).into_iter().map(item).collect()
}
