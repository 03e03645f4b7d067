//! The manifest of a job, made from what the stages left.

use crate::fabrication::Fabrication;
use crate::files::{FileFormat, SHEETS};
use crate::geometry::{Contour, Point2};
use crate::ids::NodeId;
use crate::joint::Joint;
use crate::manifest::{
    AxisEntry, BendEntry, FORMAT, FoldEntry, InsertionEntry, Limits, Manifest,
    MaterialEntry, OntoEntry, OpenEdge, PartEntry, PlacementEntry, ProofEntry, RunEntry,
    SheetEntry, SlitEntry, SourceEntry, SpliceEntry, StepEntry, StockEntry,
    StripStepEntry, Totals, VERSION, VendorEntry, Whence, degrees, mm, rounded,
};
use crate::nest::{NestedSheet, Stock};
use crate::parts::{self, Body, FlatAxis, Opening, Part, Slit, Step, StripBody};
use crate::report::connectors;
use crate::sheets::{Operation, Path, Sheet};
use crate::template::Template;
use crate::tolerance::ARC_SAGITTA_MM;
use crate::vendor::VendorSheets;
use std::collections::BTreeMap;

/// Where a job came from.
#[derive(Debug, Clone, PartialEq)]
pub struct JobSource<'a> {
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
pub fn manifest(job: &Fabrication, source: &JobSource) -> Manifest {
    let template = source.template;
    let material = &template.material;
    let entry = |name: &str, sha256: &str| SourceEntry {
        name: name.to_owned(),
        sha256: sha256.to_owned(),
    };
    let kind = if job.structure.is_some() { "structure" } else { "coupon" };
    let proof = ProofEntry { limits: limits(template), ..ProofEntry::default() };
    Manifest {
        format: FORMAT.to_owned(),
        version: VERSION,
        kind: kind.to_owned(),
        generator: concat!("finwright ", env!("CARGO_PKG_VERSION")).to_owned(),
        input: entry(source.input, source.input_sha256),
        template: entry(&template.name, source.template_sha256),
        seed: source.seed,
        scale: source.scale.to_owned(),
        joint: source.joint,
        material: MaterialEntry {
            name: material.name.clone(),
            thickness: material.thickness_mm,
            kerf: material.kerf_mm,
            clearance: material.clearance_mm,
        },
        sheet_stock: job.settings.stock.iter().map(stock).collect(),
        verdict: job.verdict.as_ref().map(|verdict| verdict.entry(source.joint, false)),
        only: (!job.only.is_empty()).then(|| job.only.clone()),
        accepted_flexible: job.settings.accepted_flexible.clone(),
        findings: job.findings.clone(),
        proof,
        parts: job.parts.iter().map(part).collect(),
        sheets: sheets(job),
        order: job.vendor.as_ref().map(|vendor| for_vendor(job, vendor)),
        assembly: assembly(job, template),
        hardware: connectors::bought(&job.parts),
        totals: totals(job, template),
    }
}

fn limits(template: &Template) -> Limits {
    let gate = &template.gate;
    Limits { axes_and_slits_mm: gate.proof_mm, folds_deg: gate.proof_deg }
}

fn point(p: Point2) -> Point2 {
    Point2::new(mm(p.x), mm(p.y))
}

fn ring(contour: &Contour) -> Vec<Point2> {
    contour.flattened(ARC_SAGITTA_MM).into_iter().map(point).collect()
}

fn stock(stock: &Stock) -> StockEntry {
    let &Stock { width, height, margin, spacing, count, .. } = stock;
    StockEntry { width, height, margin, spacing, count }
}

fn part(part: &Part) -> PartEntry {
    let cut_length: f64 = part.region.contours().map(Contour::length).sum();
    let entry = PartEntry {
        id: part.id.clone(),
        kind: part.body.kind().to_owned(),
        quantity: part.quantity,
        label: part.id.clone(),
        outline: ring(&part.region.outline),
        holes: part.region.holes.iter().map(ring).collect(),
        area: mm(part.region.area()),
        cut_length: mm(cut_length),
        shape: None,
        strip: None,
        fin: None,
        connector: None,
    };
    match &part.body {
        Body::Strip(body) => PartEntry { strip: Some(Some(strip(body))), ..entry },
        Body::Fin(body) => {
            let shape = Some(body.shape.clone());
            PartEntry { shape, fin: Some(connectors::fin(body)), ..entry }
        }
        Body::Connector(body) => {
            PartEntry { connector: Some(connectors::connector(body)), ..entry }
        }
        Body::Coupon => PartEntry { strip: Some(None), ..entry },
    }
}

fn strip(body: &StripBody) -> RunEntry {
    let folds = body.folds.iter();
    let folds =
        folds.map(|f| FoldEntry { node: f.node.index(), angle_deg: degrees(f.angle) });
    let splices =
        body.splices.iter().map(|&fin| SpliceEntry { fin: fin.map(NodeId::index) });
    RunEntry {
        nodes: body.axes.iter().map(|axis| axis.node.index()).collect(),
        axes: body.axes.iter().map(axis).collect(),
        setbacks: body.setbacks.map(mm),
        closed: Some(body.closed),
        folds: Some(folds.collect()),
        slits: Some(body.slits.iter().map(slit).collect()),
        splices: Some(splices.collect()),
    }
}

pub(super) fn axis(axis: &FlatAxis) -> AxisEntry {
    let (bottom, top) = (point(axis.bottom()), point(axis.top()));
    AxisEntry { node: axis.node.index(), bottom, top }
}

fn slit((slit, partner): &(Slit, String)) -> SlitEntry {
    SlitEntry {
        node: slit.node.index(),
        from: match slit.from {
            Opening::Top => OpenEdge::Top,
            Opening::Bottom => OpenEdge::Bottom,
        },
        width: mm(slit.width()),
        depth: mm(slit.depth),
        offset: mm(slit.offset()),
        crossing_deg: degrees(slit.crossing),
        partner: partner.clone(),
    }
}

fn sheets(job: &Fabrication) -> Vec<SheetEntry> {
    let pairs = job.sheets.iter().zip(&job.layout.sheets);
    let mut copies = Copies::default();
    let entry = |(sheet, nested): (&Sheet, &NestedSheet)| {
        let area =
            |placement: &crate::nest::Placement| job.parts[placement.shape].region.area();
        let used: f64 = nested.placements.iter().map(area).sum();
        let formats = [FileFormat::Dxf, FileFormat::Svg, FileFormat::Png];
        SheetEntry {
            id: sheet.id.clone(),
            width: sheet.width,
            height: sheet.height,
            files: paths(&formats, |format| Some(format.path(SHEETS, &sheet.id))),
            utilisation: Some(mm(used / (sheet.width * sheet.height))),
            placements: placements(job, nested, &mut copies),
        }
    };
    pairs.map(entry).collect()
}

/// Paths of a sheet's files by format.
fn paths(
    formats: &[FileFormat],
    path: impl Fn(FileFormat) -> Option<String>,
) -> BTreeMap<String, Option<String>> {
    formats.iter().map(|&format| (format.name().to_owned(), path(format))).collect()
}

/// How many copies of each part have been met.
type Copies = BTreeMap<usize, usize>;

fn placements(
    job: &Fabrication,
    nested: &NestedSheet,
    copies: &mut Copies,
) -> Vec<PlacementEntry> {
    let placements = nested.placements.iter().map(|p| {
        let copy = copies.entry(p.shape).or_default();
        *copy += 1;
        PlacementEntry {
            part: job.parts[p.shape].id.clone(),
            copy: *copy,
            x: mm(p.x),
            y: mm(p.y),
            angle_deg: degrees(p.angle),
        }
    });
    placements.collect()
}

/// The files for a service, with where parts lie in them.
fn for_vendor(job: &Fabrication, vendor: &VendorSheets) -> VendorEntry {
    let mut copies = Copies::default();
    let sheets = vendor.sheets.iter().zip(&vendor.layout.sheets);
    let sheets = sheets.map(|(sheet, nested)| SheetEntry {
        id: sheet.id.clone(),
        width: sheet.width,
        height: sheet.height,
        files: paths(&[FileFormat::Dxf, FileFormat::Svg], |f| vendor.path(&sheet.id, f)),
        utilisation: None,
        placements: placements(job, nested, &mut copies),
    });
    VendorEntry {
        profile: vendor.profile.name.to_owned(),
        kerf: vendor.kerf_mm,
        pdf: vendor.path("", FileFormat::Pdf),
        sheets: sheets.collect(),
    }
}

/// The steps in order.
fn assembly(job: &Fabrication, template: &Template) -> Vec<StepEntry> {
    let steps = job.steps.iter().enumerate();
    let entry = |(k, step): (usize, &Step)| {
        let part = &job.parts[step.part];
        let is_strip = matches!(part.body, Body::Strip(_));
        // The lower disc of a hub comes from below.
        let from = match (&part.body, step.copies) {
            (Body::Connector(_), [1, 1]) => Whence::Below,
            _ => Whence::Above,
        };
        let strip = match &part.body {
            Body::Strip(body) => Some(strip_step(job, body, template)),
            _ => None,
        };
        let copies = (!is_strip).then_some(step.copies);
        StepEntry { step: k + 1, part: part.id.clone(), from, copies, strip }
    };
    steps.map(entry).collect()
}

/// A strip goes in with its slits open at the bottom onto the strips that stand.
fn strip_step(
    job: &Fabrication,
    body: &StripBody,
    template: &Template,
) -> StripStepEntry {
    let onto = body.slits.iter().filter(|(slit, _)| slit.from == Opening::Bottom);
    let onto =
        onto.map(|(s, part)| OntoEntry { node: s.node.index(), part: part.clone() });
    StripStepEntry {
        rank: body.rank + 1,
        onto: onto.collect(),
        insertion: insertion(job, body, template),
    }
}

/// How a strip goes in, by numbers; `None` for one that goes onto nothing.
fn insertion(
    job: &Fabrication,
    body: &StripBody,
    template: &Template,
) -> Option<InsertionEntry> {
    let material = &template.material;
    let way = parts::insertion(job.structure.as_ref()?, body, material.clearance_mm)?;
    let bend = way.bend.map(|(radius, node)| BendEntry {
        after_node: node.index(),
        radius_mm: rounded(radius, 10.0),
        over_thickness: rounded(radius / material.thickness_mm, 10.0),
    });
    Some(InsertionEntry {
        mode: if way.is_rigid { "push" } else { "zip" }.to_owned(),
        spread_deg: degrees(way.spread),
        sideways_mm: mm(way.sideways),
        clearance_mm: material.clearance_mm,
        bend,
    })
}

/// Lengths, time, mass and cost of a whole job.
fn totals(job: &Fabrication, template: &Template) -> Totals {
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
    Totals {
        parts: job.parts.iter().map(|part| part.quantity).sum::<usize>(),
        sheets: job.sheets.len(),
        cut_length: mm(cut),
        engrave_length: mm(marked),
        seconds: rounded(seconds, 10.0),
        mass: mm(mass),
        cost: cost(job, template),
    }
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
