//! The drawings of a group of files, format by format.

use crate::drawing::{Drawing, DrawingError, Reading, read_dxf, read_pdf, read_svg};
use crate::export::LAYERS;
use crate::files::{FileFormat, SHEETS};
use crate::manifest::{Manifest, SheetEntry};
use crate::proof::JobFiles;
use crate::proof::finding::{ProofFinding, Spot};
use crate::proof::sheets::Files;

type Reader = fn(&[u8], &Reading) -> Result<Drawing, DrawingError>;

/// Formats with a file for each sheet.
const SINGLE: [(FileFormat, Reader); 2] =
    [(FileFormat::Dxf, read_dxf), (FileFormat::Svg, read_svg)];

/// The drawings of all formats that the manifest names; what is missing or unreadable is
/// noted.
pub(super) fn formats(
    manifest: &Manifest,
    pdf: Option<&str>,
    files: &JobFiles,
    facts: &mut Vec<ProofFinding>,
) -> Vec<Files> {
    let mut formats = Vec::new();
    for (format, reader) in SINGLE {
        let format = format.name();
        let named = |sheet: &SheetEntry| sheet.files.get(format).cloned().flatten();
        if manifest.sheets.iter().all(|sheet| named(sheet).is_none()) {
            continue;
        }
        let sheets = manifest.sheets.iter().map(|sheet| {
            let named = named(sheet).unwrap_or_default();
            let inside = named.contains('/');
            let path = if inside { named } else { format!("{SHEETS}/{named}") };
            let drawing = read(&path, files, reader, facts);
            (path, drawing)
        });
        formats.push(Files { format, sheets: sheets.collect() });
    }
    if let Some(pdf) = pdf {
        let mut pages = read(pdf, files, read_pdf, facts).unwrap_or_default().into_iter();
        let named = |sheet: &SheetEntry| format!("{pdf}, page of {}", sheet.id);
        let sheets = manifest.sheets.iter().map(|sheet| (named(sheet), pages.next()));
        formats.push(Files { format: FileFormat::Pdf.name(), sheets: sheets.collect() });
    }
    formats
}

/// What a file holds; that it is missing or unreadable is noted.
fn read<T>(
    path: &str,
    files: &JobFiles,
    reader: fn(&[u8], &Reading) -> Result<T, DrawingError>,
    facts: &mut Vec<ProofFinding>,
) -> Option<T> {
    let spot = Spot::file(path);
    match files
        .get(path)
        .map(|bytes| reader(bytes, &Reading::of(&LAYERS.map(|layer| layer.known()))))
    {
        Some(Ok(read)) => return Some(read),
        Some(Err(error)) => {
            let reason = error.to_string();
            facts.push(ProofFinding::Unreadable { spot, reason });
        }
        None => facts.push(ProofFinding::FileMissing { spot }),
    }
    None
}
