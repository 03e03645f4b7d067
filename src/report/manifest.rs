//! `job.json`: everything an outside program needs to predict each cut line and to fold
//! each part back onto the structure (contract §3).

use crate::fabrication::Fabrication;
use crate::geometry::{Contour, Point2};
use crate::joint::Joint;
use crate::nest::{NestedSheet, Stock};
use crate::parts::{self, Body, FlatAxis, Opening, Part, Slit, Step, StripBody};
use crate::proof::Limits;
use crate::report::connectors;
use crate::sheets::{Operation, Path, Sheet};
use crate::template::Template;
use crate::tolerance::ARC_SAGITTA_MM;
use crate::vendor::{Format, VendorSheets};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Where a job came from.
#[derive(Debug, Clone, PartialEq)]
pub struct Source<'a> {
    /// Name of the input file, without its folder.
    pub input: &'a str,
    /// SHA-256 of the input, hexadecimal.
    pub input_sha256: &'a str,
    /// The template.
    pub template: &'a Template,
    /// SHA-256 of the template, hexadecimal.
    pub template_sha256: &'a str,
    /// Seed of the nesting.
    pub seed: u64,
    /// Such as `1:50`.
    pub scale: &'a str,
    /// How fins are joined.
    pub joint: Joint,
}

/// The manifest of a job.
pub fn manifest(job: &Fabrication, source: &Source) -> Value {
    let material = &source.template.material;
    json!({
        "format": "finwright-job",
        "version": 1,
        "kind": if job.structure.is_some() { "structure" } else { "coupon" },
        "generator": concat!("finwright ", env!("CARGO_PKG_VERSION")),
        "input": {"name": source.input, "sha256": source.input_sha256},
        "template": {"name": source.template.name, "sha256": source.template_sha256},
        "seed": source.seed,
        "scale": source.scale,
        "joint": source.joint.name(),
        "material": {
            "name": material.name,
            "thickness": material.thickness_mm,
            "kerf": material.kerf_mm,
            "clearance": material.clearance_mm,
        },
        "sheet_stock": job.settings.stock.iter().map(stock).collect::<Vec<_>>(),
        "verdict": job.verdict.as_ref().map(|verdict| verdict.json(source.joint, false)),
        "only": if job.only.is_empty() { Value::Null } else { json!(job.only) },
        "accepted_flexible": job.settings.accepted_flexible,
        "findings": job.findings,
        "proof": {"limits": limits(source.template)},
        "parts": job.parts.iter().map(part).collect::<Vec<_>>(),
        "sheets": sheets(job),
        "order": job.vendor.as_ref().map(|vendor| for_vendor(job, vendor)),
        "assembly": assembly(job, source.template),
        "hardware": connectors::bought(&job.parts),
        "totals": totals(job, source.template),
    })
}

fn limits(template: &Template) -> Limits {
    let gate = &template.gate;
    Limits { axes_and_slits_mm: gate.proof_mm, folds_deg: gate.proof_deg }
}

/// Lengths and degrees as written: to 1e-6 mm and 1e-7 degrees, never `-0`.
fn rounded(value: f64, places: f64) -> f64 {
    (value * places).round() / places + 0.0
}

pub(super) fn mm(value: f64) -> f64 {
    rounded(value, 1e6)
}

pub(super) fn degrees(radians: f64) -> f64 {
    rounded(radians.to_degrees(), 1e7)
}

fn point(p: Point2) -> Value {
    json!([mm(p.x), mm(p.y)])
}

fn ring(contour: &Contour) -> Vec<Value> {
    contour.flattened(ARC_SAGITTA_MM).into_iter().map(point).collect()
}

fn stock(stock: &Stock) -> Value {
    json!({
        "width": stock.width,
        "height": stock.height,
        "margin": stock.margin,
        "spacing": stock.spacing,
        "count": stock.count,
    })
}

fn part(part: &Part) -> Value {
    let cut_length: f64 = part.region.contours().map(Contour::length).sum();
    let mut value = json!({
        "id": part.id,
        "kind": part.body.kind(),
        "quantity": part.quantity,
        "label": part.id,
        "outline": ring(&part.region.outline),
        "holes": part.region.holes.iter().map(ring).collect::<Vec<_>>(),
        "area": mm(part.region.area()),
        "cut_length": mm(cut_length),
    });
    match &part.body {
        Body::Strip(body) => value["strip"] = strip(body),
        Body::Fin(body) => {
            value["shape"] = json!(body.shape);
            value["fin"] = connectors::fin(body);
        }
        Body::Connector(body) => value["connector"] = connectors::connector(body),
        Body::Coupon => value["strip"] = Value::Null,
    }
    value
}

fn strip(body: &StripBody) -> Value {
    let folds = body.folds.iter();
    let folds = folds.map(|f| json!({"node": f.node, "angle_deg": degrees(f.angle)}));
    json!({
        "nodes": body.axes.iter().map(|axis| axis.node).collect::<Vec<_>>(),
        "closed": body.closed,
        "axes": body.axes.iter().map(axis).collect::<Vec<_>>(),
        "folds": folds.collect::<Vec<_>>(),
        "slits": body.slits.iter().map(|(s, partner)| slit(s, partner)).collect::<Vec<_>>(),
        "splices": body.splices.iter().map(|fin| json!({"fin": fin})).collect::<Vec<_>>(),
        "setbacks": body.setbacks.map(mm),
    })
}

pub(super) fn axis(axis: &FlatAxis) -> Value {
    json!({"node": axis.node, "bottom": point(axis.bottom()), "top": point(axis.top())})
}

fn slit(slit: &Slit, partner: &str) -> Value {
    json!({
        "node": slit.node,
        "from": match slit.from { Opening::Top => "top", Opening::Bottom => "bottom" },
        "width": mm(slit.width()),
        "depth": mm(slit.depth),
        "offset": mm(slit.offset()),
        "crossing_deg": degrees(slit.crossing),
        "partner": partner,
    })
}

fn sheets(job: &Fabrication) -> Vec<Value> {
    let pairs = job.sheets.iter().zip(&job.layout.sheets);
    let mut copies = Copies::default();
    pairs.map(|(sheet, nested)| sheet_entry(job, sheet, nested, &mut copies)).collect()
}

/// How many copies of each part have been met.
type Copies = BTreeMap<usize, usize>;

fn sheet_entry(
    job: &Fabrication,
    sheet: &Sheet,
    nested: &NestedSheet,
    copies: &mut Copies,
) -> Value {
    let area =
        |placement: &crate::nest::Placement| job.parts[placement.shape].region.area();
    let used: f64 = nested.placements.iter().map(area).sum();
    let file = |ending: &str| format!("sheets/{}.{ending}", sheet.id);
    json!({
        "id": sheet.id,
        "width": sheet.width,
        "height": sheet.height,
        "files": {"dxf": file("dxf"), "svg": file("svg"), "png": file("png")},
        "utilisation": mm(used / (sheet.width * sheet.height)),
        "placements": placements(job, nested, copies),
    })
}

fn placements(
    job: &Fabrication,
    nested: &NestedSheet,
    copies: &mut Copies,
) -> Vec<Value> {
    let placements = nested.placements.iter().map(|p| {
        let copy = copies.entry(p.shape).or_default();
        *copy += 1;
        json!({
            "part": job.parts[p.shape].id,
            "copy": copy,
            "x": mm(p.x),
            "y": mm(p.y),
            "angle_deg": degrees(p.angle),
        })
    });
    placements.collect()
}

/// The files for a service, with where parts lie in them.
fn for_vendor(job: &Fabrication, vendor: &VendorSheets) -> Value {
    let mut copies = Copies::default();
    let sheets =
        vendor.sheets.iter().zip(&vendor.layout.sheets).map(|(sheet, nested)| {
            json!({
                "id": sheet.id,
                "width": sheet.width,
                "height": sheet.height,
                "files": {
                    "dxf": vendor.path(sheet, Format::Dxf),
                    "svg": vendor.path(sheet, Format::Svg),
                },
                "placements": placements(job, nested, &mut copies),
            })
        });
    json!({
        "profile": vendor.profile.name,
        "kerf": vendor.kerf_mm,
        "pdf": vendor.pdf_path(),
        "sheets": sheets.collect::<Vec<_>>(),
    })
}

/// The steps in order.
fn assembly(job: &Fabrication, template: &Template) -> Vec<Value> {
    let steps = job.steps.iter().enumerate();
    let value = |(k, step): (usize, &Step)| {
        let part = &job.parts[step.part];
        let mut value = match &part.body {
            Body::Strip(body) => strip_step(job, body, template),
            _ => connectors::step(part, step),
        };
        value["step"] = json!(k + 1);
        value["part"] = json!(part.id);
        value
    };
    steps.map(value).collect()
}

/// A strip goes in from above, its slits open at the bottom onto the strips that stand.
fn strip_step(job: &Fabrication, body: &StripBody, template: &Template) -> Value {
    let onto = body.slits.iter().filter(|(slit, _)| slit.from == Opening::Bottom);
    let onto = onto.map(|(slit, partner)| json!({"node": slit.node, "part": partner}));
    json!({
        "rank": body.rank + 1,
        "from": "above",
        "onto": onto.collect::<Vec<_>>(),
        "insertion": insertion(job, body, template),
    })
}

/// How a strip goes in, by numbers; `None` for one that goes onto nothing.
fn insertion(job: &Fabrication, body: &StripBody, template: &Template) -> Option<Value> {
    let material = &template.material;
    let way = parts::insertion(job.structure.as_ref()?, body, material.clearance_mm)?;
    Some(json!({
        "mode": if way.is_rigid { "push" } else { "zip" },
        "spread_deg": degrees(way.spread),
        "sideways_mm": mm(way.sideways),
        "clearance_mm": material.clearance_mm,
        "bend": way.bend.map(|(radius, node)| json!({
            "after_node": node,
            "radius_mm": rounded(radius, 10.0),
            "over_thickness": rounded(radius / material.thickness_mm, 10.0),
        })),
    }))
}

/// Lengths, time, mass and cost of a whole job.
fn totals(job: &Fabrication, template: &Template) -> Value {
    let length = |operations: &[Operation]| -> f64 {
        let strokes = job.sheets.iter().flat_map(|sheet| &sheet.strokes);
        let wanted = strokes.filter(|stroke| operations.contains(&stroke.operation));
        wanted.map(|stroke| path_length(&stroke.path)).sum()
    };
    let cut = length(&[Operation::CutInner, Operation::CutOuter]);
    let marked = length(&[Operation::Engrave, Operation::Score]);
    let material = &template.material;
    let seconds = cut / material.cut_speed_mm_s + marked / material.engrave_speed_mm_s;
    let area: f64 = job.parts.iter().map(|p| p.region.area() * p.quantity as f64).sum();
    // mm² × mm × kg/m³: 1e9 mm³ are a cubic metre.
    let mass = area * material.thickness_mm * material.density_kg_m3 / 1e9;
    json!({
        "parts": job.parts.iter().map(|part| part.quantity).sum::<usize>(),
        "sheets": job.sheets.len(),
        "cut_length": mm(cut),
        "engrave_length": mm(marked),
        "seconds": rounded(seconds, 10.0),
        "mass": mm(mass),
        "cost": cost(job, template),
    })
}

/// Price of the sheets used, if the template prices all of them.
fn cost(job: &Fabrication, template: &Template) -> Option<f64> {
    let price = |nested: &NestedSheet| {
        let sheet = template.sheet.get(nested.stock)?;
        let by_area = template.material.price_per_m2;
        sheet.price.or(by_area.map(|p| p * sheet.width_mm * sheet.height_mm / 1e6))
    };
    job.layout
        .sheets
        .iter()
        .map(price)
        .sum::<Option<f64>>()
        .map(|cost| rounded(cost, 100.0))
}

fn path_length(path: &Path) -> f64 {
    match path {
        Path::Open(points) => points.windows(2).map(|w| (w[1] - w[0]).norm()).sum(),
        Path::Closed(contour) => contour.length(),
    }
}
