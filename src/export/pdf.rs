//! PDF: a page per sheet, of the size of the sheet, with a layer per operation.
//!
//! Layers are optional content groups (PDF 1.5, ISO 32000-1 §8.11).

use pdf_writer::{Content, Finish, Name, Pdf, Rect, Ref, TextStr};

use super::arcs::{Step, steps};
use super::{LAYERS, LINE_WIDTH, Layer};
use crate::geometry::Point2;
use crate::sheets::Sheet;
use crate::tolerance::BEZIER_MM;

const CATALOG: Ref = Ref::new(1);
const PAGES: Ref = Ref::new(2);
const FIRST_LAYER: i32 = 3;
const FIRST_PAGE: i32 = FIRST_LAYER + LAYERS.len() as i32;

const POINTS_PER_MM: f64 = 72.0 / 25.4;

/// All sheets as one PDF, a page each.
pub fn pdf(sheets: &[Sheet]) -> Vec<u8> {
    pdf_in(sheets, &LAYERS)
}

/// The same in other colours.
pub fn pdf_in(sheets: &[Sheet], layers: &[Layer; 5]) -> Vec<u8> {
    let mut pdf = Pdf::new();
    pdf.set_version(1, 5);
    catalog(&mut pdf);
    for (layer, id) in LAYERS.iter().zip(layer_ids()) {
        let mut group = pdf.indirect(id).dict();
        group.pair(Name(b"Type"), Name(b"OCG"));
        group.pair(Name(b"Name"), TextStr(layer.name));
    }
    let page_ids = (FIRST_PAGE..).step_by(2).map(Ref::new).take(sheets.len());
    pdf.pages(PAGES).kids(page_ids.clone()).count(sheets.len() as i32);
    for (sheet, id) in sheets.iter().zip(page_ids) {
        page(&mut pdf, sheet, (id, layers));
    }
    pdf.finish()
}

fn layer_ids() -> impl Iterator<Item = Ref> {
    (FIRST_LAYER..FIRST_PAGE).map(Ref::new)
}

fn catalog(pdf: &mut Pdf) {
    let mut catalog = pdf.catalog(CATALOG);
    catalog.pages(PAGES);
    let mut layers = catalog.insert(Name(b"OCProperties")).dict();
    layers.insert(Name(b"OCGs")).array().items(layer_ids());
    let mut shown = layers.insert(Name(b"D")).dict();
    shown.insert(Name(b"Order")).array().items(layer_ids());
    shown.insert(Name(b"ON")).array().items(layer_ids());
}

fn page(pdf: &mut Pdf, sheet: &Sheet, (id, layers): (Ref, &[Layer; 5])) {
    let contents = Ref::new(id.get() + 1);
    let mut page = pdf.page(id);
    page.parent(PAGES).contents(contents);
    page.media_box(Rect::new(0.0, 0.0, points(sheet.width), points(sheet.height)));
    let mut resources = page.resources();
    let mut names = resources.insert(Name(b"Properties")).dict();
    for (layer, id) in LAYERS.iter().zip(layer_ids()) {
        names.pair(Name(layer.name.as_bytes()), id);
    }
    names.finish();
    resources.finish();
    page.finish();
    pdf.stream(contents, &drawing(sheet, layers).finish());
}

/// The strokes of a sheet, layer by layer.
fn drawing(sheet: &Sheet, layers: &[Layer; 5]) -> Content {
    let mut content = Content::new();
    // Rounded down, as no line may be broader.
    content.set_line_width((LINE_WIDTH * POINTS_PER_MM * 1e4).floor() as f32 / 1e4);
    for layer in layers {
        content
            .begin_marked_content_with_properties(Name(b"OC"))
            .properties_named(Name(layer.name.as_bytes()));
        let [r, g, b] = layer.rgb.map(|byte| f32::from(byte) / 255.0);
        content.set_stroke_rgb(r, g, b);
        for path in layer.paths(sheet) {
            for step in steps(path, BEZIER_MM) {
                draw(&mut content, step);
            }
            content.stroke();
        }
        content.end_marked_content();
    }
    content
}

fn draw(content: &mut Content, step: Step) {
    let at = |p: Point2| (points(p.x), points(p.y));
    match step {
        Step::Move(p) => {
            let (x, y) = at(p);
            content.move_to(x, y);
        }
        Step::Line(p) => {
            let (x, y) = at(p);
            content.line_to(x, y);
        }
        Step::Cubic(a, b, p) => {
            let ((ax, ay), (bx, by), (x, y)) = (at(a), at(b), at(p));
            content.cubic_to(ax, ay, bx, by, x, y);
        }
        Step::Close => {
            content.close_path();
        }
    }
}

/// Millimetres as PDF points, to 1e-5: smaller values would be written with exponents,
/// which PDF does not know.
fn points(mm: f64) -> f32 {
    let tens_of_microns = (mm * POINTS_PER_MM * 1e5).round();
    // Adding zero turns a negative zero into a plain one.
    (tens_of_microns / 1e5 + 0.0) as f32
}

#[cfg(test)]
mod tests {
    use super::super::sample::sample;
    use super::*;
    use crate::sheets::Path;

    fn text(sheets: &[Sheet]) -> String {
        String::from_utf8_lossy(&pdf(sheets)).into_owned()
    }

    #[test]
    fn a_page_is_as_large_as_its_sheet() {
        let mut small = sample();
        small.width = 25.4;
        let text = text(&[sample(), small]);
        assert!(text.contains("/Count 2"));
        assert!(text.contains("/MediaBox [0 0 850.3937 566.92914]"));
        assert!(text.contains("/MediaBox [0 0 72 566.92914]"));
    }

    #[test]
    fn every_stroke_is_stroked_once_and_nothing_is_filled() {
        let sheet = sample();
        let paths = LAYERS.iter().flat_map(|layer| layer.paths(&sheet)).count();
        let content = drawing(&sheet, &LAYERS).finish();
        let content = String::from_utf8(content.into_vec()).unwrap();
        assert_eq!(content.lines().filter(|&line| line == "S").count(), paths);
        assert_eq!(content.lines().filter(|line| line.ends_with(" BDC")).count(), 5);
        assert!(
            !content.lines().any(|line| ["f", "f*", "B", "B*", "BT"].contains(&line))
        );
    }

    #[test]
    fn numbers_have_no_exponents() {
        let tiny = [1e-9, -1e-9, 3e-6, -4.1e-6, 1e-5, 0.1].map(|x| Point2::new(x, -x));
        let sheet = Sheet { frame: vec![Path::Open(tiny.to_vec())], ..sample() };
        let content = drawing(&sheet, &LAYERS).finish();
        let content = String::from_utf8(content.into_vec()).unwrap();
        let numbers = content.split_whitespace().filter(|w| w.parse::<f64>().is_ok());
        assert!(numbers.clone().count() > 100);
        assert!(
            numbers.clone().all(|n| !n.contains(['e', 'E']) && n != "-0"),
            "{content}"
        );
    }
}
