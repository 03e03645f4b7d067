//! A sheet as the bytes of a file: DXF, SVG, PDF for the laser, PNG for the eye.
//!
//! Each exporter is one pure function; the same sheet gives the same bytes. DXF, SVG and
//! PDF hold the same lines on the same layers in the same order ([`LAYERS`]). Whether a
//! sheet may go to the laser is decided elsewhere, and nothing here touches a disk.

mod arcs;
mod dxf;
mod layer;
mod number;
mod pdf;
mod png;
#[cfg(test)]
mod sample;
mod svg;

pub use dxf::dxf;
pub use layer::{LAYERS, Layer};
pub use pdf::{pdf, pdf_in};
pub use png::{PngError, PngLook, png};
pub use svg::{svg, svg_in};

/// Width of a drawn line in SVG and PDF, mm: thin enough to be a cut for every driver.
const LINE_WIDTH: f64 = 0.025;

use crate::gate::Approved;
use crate::geometry::Point2;
use crate::lettering::letter;
use crate::sheets::Sheet;

/// A file by its path inside the job directory.
pub type File = (String, Vec<u8>);

/// All files of approved sheets: DXF, SVG and a picture of each, and one PDF of all.
pub fn cut_files(approved: &Approved<&Vec<Sheet>>) -> Vec<File> {
    let sheets = approved.get();
    let mut files = side_by_side(sheets, |sheet| {
        let path = |ending: &str| format!("sheets/{}.{ending}", sheet.id);
        let picture = png(sheet, &PngLook::default()).ok();
        let drawings = [(path("dxf"), dxf(sheet)), (path("svg"), svg(sheet))];
        drawings.into_iter().chain(picture.map(|bytes| (path("png"), bytes))).collect()
    });
    files.push(("sheets/sheets.pdf".to_owned(), pdf(sheets)));
    files
}

/// Pictures of sheets that were refused, stamped across.
pub fn stamped_previews(sheets: &[Sheet]) -> Vec<File> {
    side_by_side(sheets, |sheet| {
        let stamp = stamp(sheet, "NOT FOR CUTTING");
        let look = PngLook { stamp: &stamp, ..PngLook::default() };
        let picture = png(sheet, &look).ok();
        let file = picture.map(|bytes| (format!("preview/{}.png", sheet.id), bytes));
        file.into_iter().collect()
    })
}

/// The files of all sheets in order, made on all cores: pictures take long.
fn side_by_side(
    sheets: &[Sheet],
    files: impl Fn(&Sheet) -> Vec<File> + Sync,
) -> Vec<File> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let mut all = Vec::new();
    for batch in sheets.chunks(cores) {
        std::thread::scope(|scope| {
            let work = batch.iter().map(|sheet| scope.spawn(|| files(sheet)));
            let work: Vec<_> = work.collect();
            // A thread that panicked has no files; its panic was printed.
            all.extend(work.into_iter().flat_map(|work| work.join().unwrap_or_default()));
        });
    }
    all
}

/// Letters from the lower left to the upper right corner of a sheet.
fn stamp(sheet: &Sheet, text: &str) -> Vec<Vec<Point2>> {
    let Ok(lettering) = letter(text, 1.0) else { return Vec::new() };
    let along = crate::geometry::Vector2::new(sheet.width, sheet.height) * 0.8;
    let size = along.norm() / lettering.width;
    let (along, start) = (along.normalize(), along / 8.0);
    let up = crate::geometry::Vector2::new(-along.y, along.x);
    let place = |p: &Point2| {
        Point2::from(start + along * (p.x * size) + up * ((p.y - 0.5) * size))
    };
    lettering.strokes.iter().map(|s| s.iter().map(place).collect()).collect()
}
