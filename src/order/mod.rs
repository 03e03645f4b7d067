//! The sheets once more, as one service or machine wants them: its colours, its kinds of
//! files, with or without marks and kerf, a file per sheet or per part.
//!
//! The sheets that every job has stay as they are; these files stand beside them.

mod finding;
mod profile;

pub use finding::OrderFinding;
pub use profile::{Format, PROFILES, Profile};

use crate::export::{self, File};
use crate::gate::Approved;
use crate::geometry::Point2;
use crate::nest::{Layout, NestedSheet, Placement, Stock};
use crate::parts::{Body, Part};
use crate::sheets::{Kerf, Laying, Operation, Sheet, sheets};
use crate::tolerance::WRITTEN_MM;

/// Files for one service.
#[derive(Debug, Clone, PartialEq)]
pub struct Order {
    /// What the service takes.
    pub profile: &'static Profile,
    /// Whether each part is in a file of its own.
    pub per_part: bool,
    /// The kerf in the lines, mm.
    pub kerf_mm: f64,
    /// Where parts lie.
    pub layout: Layout,
    /// What the laser does.
    pub sheets: Vec<Sheet>,
}

/// What an order is made from.
#[derive(Clone, Copy)]
pub struct Wanted<'a> {
    /// What the service takes.
    pub profile: &'static Profile,
    /// Whether each part is to be in a file of its own even if the service takes sheets.
    pub per_part: bool,
    /// The parts.
    pub parts: &'a [Part],
    /// Where they lie on the sheets of the job.
    pub layout: &'a Layout,
    /// The stock of that layout.
    pub stock: &'a [Stock],
    /// Full width of the kerf, mm.
    pub kerf_mm: f64,
}

/// The sheets of an order.
pub fn order(wanted: &Wanted) -> Order {
    let profile = wanted.profile;
    let per_part = wanted.per_part || profile.per_part;
    let kerf_mm = if profile.kerf { wanted.kerf_mm } else { 0.0 };
    let kerf = Kerf::from_width_mm(kerf_mm);
    let single = per_part.then(|| each_alone(wanted.parts, kerf));
    let (layout, stock) = match &single {
        Some((layout, stock)) => (layout, stock.as_slice()),
        None => (wanted.layout, wanted.stock),
    };
    let laying = Laying { parts: wanted.parts, layout, stock, kerf, frame: None };
    let mut sheets = sheets(&laying);
    for (sheet, nested) in sheets.iter_mut().zip(&layout.sheets) {
        if !profile.marks {
            sheet.strokes.retain(|stroke| stroke.operation >= Operation::CutInner);
        }
        if let (true, [placement]) = (per_part, nested.placements.as_slice()) {
            sheet.id = file_name(&wanted.parts[placement.shape]);
        }
    }
    Order { profile, per_part, kerf_mm, layout: layout.clone(), sheets }
}

/// The name of a part's own file says how many to cut.
fn file_name(part: &Part) -> String {
    match part.quantity {
        1 => part.id.clone(),
        count => format!("{}_x{count}", part.id),
    }
}

/// Each part on a sheet as large as its line, its lower left corner in the origin.
fn each_alone(parts: &[Part], kerf: Kerf) -> (Layout, Vec<Stock>) {
    let mut stock = Vec::new();
    let mut sheets = Vec::new();
    for (shape, part) in parts.iter().enumerate() {
        let drawn = kerf.compensated(&part.region.outline);
        // An arc may reach beyond the corners; its polygon does not lie inside it.
        let ring = drawn.enclosing_polygon(crate::tolerance::ARC_SAGITTA_MM);
        let low = ring.iter().copied().reduce(|a, b| a.inf(&b)).unwrap_or_default();
        let high = ring.iter().fold(low, |a, b| a.sup(b));
        let up = |mm: f64| (mm / WRITTEN_MM).ceil() * WRITTEN_MM;
        let size = Point2::new(up(high.x - low.x), up(high.y - low.y));
        let placement = Placement { shape, angle: 0.0, x: up(-low.x), y: up(-low.y) };
        sheets.push(NestedSheet { stock: stock.len(), placements: vec![placement] });
        stock.push(Stock { count: Some(1), ..Stock::new([size.x, size.y], 0.0, 0.0) });
    }
    (Layout { sheets }, stock)
}

/// The folder of an order inside a job.
pub const FOLDER: &str = "order";

impl Order {
    /// Path of a sheet's file, if the service takes that kind.
    pub fn path(&self, sheet: &Sheet, format: Format) -> Option<String> {
        let ending = match format {
            Format::Dxf => "dxf",
            Format::Svg => "svg",
            Format::Pdf => return None,
        };
        let taken = self.profile.formats.contains(&format);
        taken.then(|| format!("{FOLDER}/{}.{ending}", sheet.id))
    }

    /// Path of the PDF of all sheets, if the service takes one.
    pub fn pdf_path(&self) -> Option<String> {
        let taken = self.profile.formats.contains(&Format::Pdf);
        taken.then(|| format!("{FOLDER}/sheets.pdf"))
    }
}

/// The files of an approved order.
pub fn files(approved: &Approved<&Order>) -> Vec<File> {
    let order = approved.get();
    let layers = order.profile.layers();
    let mut files = Vec::new();
    for sheet in &order.sheets {
        let dxf = order.path(sheet, Format::Dxf).map(|path| (path, export::dxf(sheet)));
        let svg = order.path(sheet, Format::Svg);
        let svg = svg.map(|path| (path, export::svg_in(sheet, &layers)));
        files.extend(dxf.into_iter().chain(svg));
    }
    let pdf = order.pdf_path().map(|path| (path, export::pdf_in(&order.sheets, &layers)));
    files.extend(pdf);
    files
}

/// The rules of the service that the order does not keep.
pub fn check(order: &Order, wanted: &Wanted) -> Vec<OrderFinding> {
    let profile = order.profile;
    let marks = wanted.parts.iter().map(|part| part.marks.len()).sum();
    let unmarked = OrderFinding::Unmarked { count: marks, profile: profile.name };
    let unmarked = (!profile.marks && marks > 0).then_some(unmarked);
    let sizes = order.sheets.iter().filter_map(|sheet| too_large(order, wanted, sheet));
    let used = wanted.layout.sheets.iter().map(|sheet| sheet.stock);
    let spacing =
        used.map(|stock| wanted.stock[stock].spacing).fold(f64::INFINITY, f64::min);
    let least_mm = profile.least_gap_mm;
    let near = OrderFinding::LinesTooNear {
        spacing_mm: spacing,
        profile: profile.name,
        least_mm,
    };
    let near = (!order.per_part && spacing <= least_mm).then_some(near);
    sizes.chain(unmarked).chain(near).chain(narrow(order, wanted)).collect()
}

fn too_large(order: &Order, wanted: &Wanted, sheet: &Sheet) -> Option<OrderFinding> {
    let [wide_mm, high_mm] = order.profile.largest_mm?;
    let (width_mm, height_mm) = (sheet.width, sheet.height);
    let fits = |w: f64, h: f64| w <= wide_mm && h <= high_mm;
    let part = wanted.parts.iter().map(file_name).position(|name| name == sheet.id);
    let too_large = OrderFinding::TooLarge {
        file: sheet.id.clone(),
        part: part.map(|part| wanted.parts[part].id.clone()),
        width_mm,
        height_mm,
        profile: order.profile.name,
        wide_mm,
        high_mm,
    };
    (!fits(width_mm, height_mm) && !fits(height_mm, width_mm)).then_some(too_large)
}

/// Slits whose two lines are as near as burns together.
fn narrow(order: &Order, wanted: &Wanted) -> Vec<OrderFinding> {
    let least_mm = order.profile.least_gap_mm;
    let mut all = Vec::new();
    for part in wanted.parts {
        let Body::Strip(body) = &part.body else { continue };
        for (slit, _) in &body.slits {
            let width_mm = slit.width() - order.kerf_mm;
            if width_mm <= least_mm {
                all.push(OrderFinding::SlitTooNarrow {
                    part: part.id.clone(),
                    node: slit.node,
                    width_mm,
                    profile: order.profile.name,
                    least_mm,
                });
            }
        }
    }
    all
}
