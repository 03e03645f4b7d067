//! The sheets once more, as one service or machine wants them: its colours, its kinds of
//! files, with or without marks and kerf, a file per sheet or per part.
//!
//! The sheets that every job has stay as they are; these files stand beside them.

mod finding;
mod profile;

pub use finding::VendorFinding;
pub use profile::{PROFILES, Profile};

use crate::export::{self, File};
use crate::files::{FileFormat, ORDER};
use crate::gate::Approved;
use crate::geometry::Point2;
use crate::nest::{Layout, NestedSheet, Placement, Stock};
use crate::parts::{Body, Part};
use crate::sheets::{Kerf, Laying, Operation, Sheet, sheets};
use crate::tolerance::WRITTEN_MM;

/// Sheets for one service or machine.
#[derive(Debug, Clone, PartialEq)]
pub struct VendorSheets {
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

/// What the sheets of a vendor are made from.
#[derive(Clone, Copy)]
pub struct Request<'a> {
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

/// The sheets as the vendor wants them.
pub fn vendor_sheets(request: &Request) -> VendorSheets {
    let profile = request.profile;
    let per_part = request.per_part || profile.per_part;
    let kerf_mm = if profile.kerf { request.kerf_mm } else { 0.0 };
    let kerf = Kerf::from_width_mm(kerf_mm);
    let single = per_part.then(|| each_alone(request.parts, kerf));
    let (layout, stock) = match &single {
        Some((layout, stock)) => (layout, stock.as_slice()),
        None => (request.layout, request.stock),
    };
    let laying = Laying { parts: request.parts, layout, stock, kerf, frame: None };
    let mut sheets = sheets(&laying);
    for (sheet, nested) in sheets.iter_mut().zip(&layout.sheets) {
        if !profile.marks {
            sheet.strokes.retain(|stroke| stroke.operation >= Operation::CutInner);
        }
        if let (true, [placement]) = (per_part, nested.placements.as_slice()) {
            sheet.id = file_name(&request.parts[placement.shape]);
        }
    }
    VendorSheets { profile, per_part, kerf_mm, layout: layout.clone(), sheets }
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

impl VendorSheets {
    /// Path of a sheet's file, or of that of all, if the service takes the format.
    pub fn path(&self, sheet: &str, format: FileFormat) -> Option<String> {
        self.profile.formats.contains(&format).then(|| format.path(ORDER, sheet))
    }
}

/// The files of approved sheets.
pub fn files(approved: &Approved<&VendorSheets>) -> Vec<File> {
    let vendor = approved.get();
    let layers = vendor.profile.layers();
    let taken = FileFormat::CUT.iter().filter(|f| vendor.profile.formats.contains(f));
    taken
        .flat_map(|&format| export::drawings(&vendor.sheets, (ORDER, format), &layers))
        .collect()
}

/// The rules of the service that the sheets do not keep.
pub fn check(vendor: &VendorSheets, request: &Request) -> Vec<VendorFinding> {
    let profile = vendor.profile;
    let marks = request.parts.iter().map(|part| part.marks.len()).sum();
    let unmarked = VendorFinding::Unmarked { count: marks, profile: profile.name };
    let unmarked = (!profile.marks && marks > 0).then_some(unmarked);
    let sizes =
        vendor.sheets.iter().filter_map(|sheet| too_large(vendor, request, sheet));
    let used = request.layout.sheets.iter().map(|sheet| sheet.stock);
    let spacing =
        used.map(|stock| request.stock[stock].spacing).fold(f64::INFINITY, f64::min);
    let least_mm = profile.least_gap_mm;
    let near = VendorFinding::LinesTooNear {
        spacing_mm: spacing,
        profile: profile.name,
        least_mm,
    };
    let near = (!vendor.per_part && spacing <= least_mm).then_some(near);
    sizes.chain(unmarked).chain(near).chain(narrow(vendor, request)).collect()
}

fn too_large(
    vendor: &VendorSheets,
    request: &Request,
    sheet: &Sheet,
) -> Option<VendorFinding> {
    let [wide_mm, high_mm] = vendor.profile.largest_mm?;
    let (width_mm, height_mm) = (sheet.width, sheet.height);
    let fits = |w: f64, h: f64| w <= wide_mm && h <= high_mm;
    let part = request.parts.iter().map(file_name).position(|name| name == sheet.id);
    let too_large = VendorFinding::TooLarge {
        file: sheet.id.clone(),
        part: part.map(|part| request.parts[part].id.clone()),
        width_mm,
        height_mm,
        profile: vendor.profile.name,
        wide_mm,
        high_mm,
    };
    (!fits(width_mm, height_mm) && !fits(height_mm, width_mm)).then_some(too_large)
}

/// Slits whose two lines are as near as burns together.
fn narrow(vendor: &VendorSheets, request: &Request) -> Vec<VendorFinding> {
    let least_mm = vendor.profile.least_gap_mm;
    let mut all = Vec::new();
    for part in request.parts {
        let Body::Strip(body) = &part.body else { continue };
        for (slit, _) in &body.slits {
            let width_mm = slit.width() - vendor.kerf_mm;
            if width_mm <= least_mm {
                all.push(VendorFinding::SlitTooNarrow {
                    part: part.id.clone(),
                    node: slit.node,
                    width_mm,
                    profile: vendor.profile.name,
                    least_mm,
                });
            }
        }
    }
    all
}
