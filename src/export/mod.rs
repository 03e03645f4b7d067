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
pub use png::{PngLook, png};
pub use svg::{svg, svg_in};

/// Width of a drawn line in SVG and PDF, mm: thin enough to be a cut for every driver.
const LINE_WIDTH: f64 = 0.025;

use crate::files::{FileFormat, PREVIEW, SHEETS};
use crate::gate::Approved;
use crate::geometry::Point2;
use crate::lettering::letter;
use crate::picture::PngError;
use crate::sheets::Sheet;
use std::panic::resume_unwind;

/// A file by its path inside the job directory.
pub type File = (String, Vec<u8>);

/// The lines of sheets in a format, in the colours of these layers: files by their paths in
/// a folder.
pub fn drawings(
    sheets: &[Sheet],
    (folder, format): (&str, FileFormat),
    layers: &[Layer; 5],
) -> Vec<File> {
    let each = |write: &dyn Fn(&Sheet) -> Vec<u8>| {
        sheets
            .iter()
            .map(|sheet| (format.path(folder, &sheet.id), write(sheet)))
            .collect()
    };
    match format {
        FileFormat::Dxf => each(&dxf),
        FileFormat::Svg => each(&|sheet| svg_in(sheet, layers)),
        FileFormat::Pdf => vec![(format.path(folder, ""), pdf_in(sheets, layers))],
        FileFormat::Png => Vec::new(),
    }
}

/// All files of approved sheets: DXF, SVG and a picture of each, and one PDF of all.
///
/// # Errors
/// [`PngError`] if a sheet cannot be drawn.
pub fn cut_files(
    approved: &Approved<&Vec<Sheet>>,
    threads: usize,
) -> Result<Vec<File>, PngError> {
    let sheets = approved.get();
    let mut files = side_by_side(sheets, threads, |sheet| {
        let picture = png(sheet, &PngLook::default())?;
        let picture = (FileFormat::Png.path(SHEETS, &sheet.id), picture);
        Ok(drawn(std::slice::from_ref(sheet), false).chain([picture]).collect())
    })?;
    files.extend(drawn(sheets, true));
    Ok(files)
}

/// The sheets in all formats that hold all sheets in one file, or in all others.
fn drawn(sheets: &[Sheet], in_one: bool) -> impl Iterator<Item = File> {
    let formats = FileFormat::CUT.into_iter();
    let formats = formats.filter(move |format| format.holds_all_sheets() == in_one);
    formats.flat_map(move |format| drawings(sheets, (SHEETS, format), &LAYERS))
}

/// Pictures of sheets that were refused, stamped across.
///
/// # Errors
/// [`PngError`] if a sheet cannot be drawn.
pub fn stamped_previews(sheets: &[Sheet], threads: usize) -> Result<Vec<File>, PngError> {
    side_by_side(sheets, threads, |sheet| {
        let stamp = stamp(sheet, "NOT FOR CUTTING");
        let look = PngLook { stamp: &stamp, ..PngLook::default() };
        Ok(vec![(FileFormat::Png.path(PREVIEW, &sheet.id), png(sheet, &look)?)])
    })
}

/// The files of all sheets in order, made on so many threads: pictures take long.
fn side_by_side(
    sheets: &[Sheet],
    threads: usize,
    files: impl Fn(&Sheet) -> Result<Vec<File>, PngError> + Sync,
) -> Result<Vec<File>, PngError> {
    let mut all = Vec::new();
    for batch in sheets.chunks(threads.max(1)) {
        std::thread::scope(|scope| -> Result<(), PngError> {
            // The first of a batch is made here: one thread needs no other.
            let others = batch[1..].iter().map(|sheet| scope.spawn(|| files(sheet)));
            let others: Vec<_> = others.collect();
            all.extend(files(&batch[0])?);
            for other in others {
                all.extend(other.join().unwrap_or_else(|panic| resume_unwind(panic))?);
            }
            Ok(())
        })?;
    }
    Ok(all)
}

/// Letters from the lower left to the upper right corner of a sheet.
fn stamp(sheet: &Sheet, text: &str) -> Vec<Vec<Point2>> {
    let lettering = letter(text, 1.0).expect("the font has all capitals");
    let along = crate::geometry::Vector2::new(sheet.width, sheet.height) * 0.8;
    let size = along.norm() / lettering.width;
    let (along, start) = (along.normalize(), along / 8.0);
    let up = crate::geometry::Vector2::new(-along.y, along.x);
    let place = |p: &Point2| {
        Point2::from(start + along * (p.x * size) + up * ((p.y - 0.5) * size))
    };
    lettering.strokes.iter().map(|s| s.iter().map(place).collect()).collect()
}
