//! The sheets as drawings inside the page: each part is a group of its own.

use crate::fabrication::Fabrication;
use crate::geometry::Point2;
use crate::ids::PartId;
use crate::report::page::html;
use crate::sheets::{Operation, Path, Sheet};
use std::fmt::Write;

/// How far a drawn arc may be off, mm: a screen shows no less.
const SEEN_MM: f64 = 0.02;

/// All sheets, each with a caption.
pub(super) fn sheets(job: &Fabrication) -> String {
    let sheets = job.sheets.iter().enumerate();
    sheets.map(|(index, sheet)| figure(job, index, sheet)).collect()
}

fn figure(job: &Fabrication, index: usize, sheet: &Sheet) -> String {
    let parts = job.layout.sheets.get(index).map_or(0, |nested| nested.placements.len());
    let (width, height) = (sheet.width, sheet.height);
    let id = html::text(&sheet.id);
    format!(
        "<figure class=\"sheet\"><figcaption>{id}: {parts} parts on {width} × {height} mm\
         </figcaption>\n<svg viewBox=\"0 0 {width} {height}\" role=\"group\" \
         aria-label=\"{id} with {parts} parts\">\n<g id=\"{id}\">\
         <rect class=\"edge\" width=\"{width}\" height=\"{height}\"/>\n{}</g></svg></figure>\n",
        groups(job, sheet)
    )
}

/// One group per part: its marks, holes and outline.
fn groups(job: &Fabrication, sheet: &Sheet) -> String {
    let mut text = String::new();
    let mut parts: Vec<PartId> = sheet.strokes.iter().map(|stroke| stroke.part).collect();
    parts.sort_unstable();
    parts.dedup();
    for part in parts {
        let strokes = || sheet.strokes.iter().filter(|stroke| stroke.part == part);
        let data = |is_cut: bool| -> String {
            let cuts = [Operation::CutInner, Operation::CutOuter];
            let wanted = strokes().filter(|s| cuts.contains(&s.operation) == is_cut);
            wanted.map(|stroke| commands(&stroke.path, sheet.height)).collect()
        };
        let id = html::text(&job.parts[part].id);
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "<g class=\"part\" data-part=\"{id}\" tabindex=\"0\" role=\"button\" \
             aria-label=\"part {id}\"><path class=\"cut\" d=\"{}\"/><path class=\"mark\" \
             d=\"{}\"/></g>",
            data(true),
            data(false)
        );
    }
    text
}

fn commands(path: &Path, height: f64) -> String {
    let (points, end) = match path {
        Path::Open(points) => (points.clone(), ""),
        Path::Closed(contour) => (contour.flattened(SEEN_MM), "Z"),
    };
    let at = |p: &Point2| format!("{} {}", hundredths(p.x), hundredths(height - p.y));
    let points: Vec<String> = points.iter().map(at).collect();
    format!("M{}{end}", points.join("L"))
}

fn hundredths(mm: f64) -> f64 {
    (mm * 100.0).round() / 100.0 + 0.0
}
