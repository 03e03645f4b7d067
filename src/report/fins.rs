//! Which part, step and sheet each fin of a job belongs to, for those who draw it.

use crate::fabrication::Fabrication;
use crate::geometry::Point3;
use crate::ids::{FinId, PartId};
use crate::parts::{Body, Part, PlacedPlate};
use crate::structure::Structure;
use std::collections::BTreeMap;

/// The fins of a part by their nodes, the smaller one first; a fin that is spliced is on
/// both of its parts.
pub(super) fn of_part(part: &Part) -> Vec<FinId> {
    let body = match &part.body {
        Body::Strip(body) => body,
        Body::Fin(fin) => return vec![fin.nodes.into()],
        Body::Connector(_) | Body::Coupon => return Vec::new(),
    };
    let run = body.axes.windows(2).map(|pair| [pair[0].node, pair[1].node]);
    let spliced = body.splices.iter().copied();
    run.chain(spliced).map(FinId::from).collect()
}

/// The plates of a connector as squares across the axis.
pub(super) fn plates(structure: &Structure, part: &Part) -> Vec<[Point3; 4]> {
    let Body::Connector(body) = &part.body else { return Vec::new() };
    let node = &structure.nodes()[body.node()];
    let first = body.star.fins.first();
    let Some(out) = first.map(|fin| structure.direction(body.node(), fin.to)) else {
        return Vec::new();
    };
    let (radius, side) = (body.plates.form.radius(), node.axis.cross(&out));
    let plate = |copy: &PlacedPlate| {
        let center = node.position + node.axis * copy.height;
        [out, side, -out, -side].map(|way| center + way * radius)
    };
    body.plates.copies.iter().map(plate).collect()
}

/// The part of each fin of the structure, if it is on one.
pub(super) fn parts(job: &Fabrication) -> BTreeMap<FinId, PartId> {
    let mut of = BTreeMap::new();
    for (id, part) in job.parts_with_ids() {
        for fin in of_part(part) {
            of.entry(fin).or_insert(id);
        }
    }
    of
}

/// Where a part lies: number of its sheet, from 0.
pub(super) fn sheets(job: &Fabrication) -> BTreeMap<PartId, usize> {
    let sheets = job.layout.sheets.iter().enumerate();
    sheets
        .flat_map(|(sheet, nested)| {
            nested.placements.iter().map(move |p| (PartId::new(p.shape), sheet))
        })
        .collect()
}
