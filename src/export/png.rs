//! PNG: a picture of a sheet for people, never for a laser.

use std::collections::BTreeMap;

use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path as Outline, PathBuilder, Pixmap,
    Stroke, Transform,
};

use super::arcs::{Step, steps};
use super::{LAYERS, Layer};
use crate::geometry::Point2;
use crate::ids::PartId;
use crate::picture::{self, PngError, TINTS};
use crate::sheets::{Operation, Path, Sheet};

/// More pixels than this are not drawn; the scale goes down instead.
const MOST_PIXELS: f64 = 8e6;

/// How a picture is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PngLook<'a> {
    /// Pixels per millimetre, less if the picture would grow too large.
    pub px_per_mm: f64,
    /// Lines drawn broad, red and translucent over everything, in sheet coordinates (mm):
    /// the letters of a warning. Empty for none.
    pub stamp: &'a [Vec<Point2>],
}

impl Default for PngLook<'_> {
    fn default() -> Self {
        Self { px_per_mm: 3.0, stamp: &[] }
    }
}

/// The sheet as a picture: parts tinted, lines in colours a person can read.
///
/// # Errors
///
/// If sheet or scale are not larger than zero, or the picture cannot be packed.
pub fn png(sheet: &Sheet, look: &PngLook<'_>) -> Result<Vec<u8>, PngError> {
    let mut picture = Picture::new(sheet, look).ok_or(PngError::Empty {
        width: sheet.width,
        height: sheet.height,
        px_per_mm: look.px_per_mm,
    })?;
    picture.tint_parts(sheet);
    for layer in LAYERS.iter().rev() {
        picture.draw_layer(sheet, layer);
    }
    picture.stamp(look.stamp);
    picture::png(&picture.pixels)
}

struct Picture {
    pixels: Pixmap,
    /// Pixels per mm.
    scale: f64,
    /// Height of the sheet, mm.
    height: f64,
}

impl Picture {
    fn new(sheet: &Sheet, look: &PngLook<'_>) -> Option<Self> {
        let &Sheet { width, height, .. } = sheet;
        let scale = look.px_per_mm.min((MOST_PIXELS / (width * height)).sqrt());
        let mut pixels =
            Pixmap::new((width * scale).ceil() as u32, (height * scale).ceil() as u32)?;
        pixels.fill(Color::WHITE);
        Some(Self { pixels, scale, height })
    }

    /// Fills each part but not its holes.
    fn tint_parts(&mut self, sheet: &Sheet) {
        let mut parts: BTreeMap<PartId, PathBuilder> = BTreeMap::new();
        for stroke in &sheet.strokes {
            let is_cut = stroke.operation >= Operation::CutInner;
            if is_cut && matches!(stroke.path, Path::Closed(_)) {
                self.trace(&stroke.path, parts.entry(stroke.part).or_default());
            }
        }
        for (part, builder) in parts {
            if let Some(outline) = builder.finish() {
                let paint = paint(TINTS[part.index() % TINTS.len()], 255);
                let (rule, still) = (FillRule::EvenOdd, Transform::identity());
                self.pixels.fill_path(&outline, &paint, rule, still, None);
            }
        }
    }

    fn draw_layer(&mut self, sheet: &Sheet, layer: &Layer) {
        let width = (0.3 * self.scale).max(1.0);
        let mut builder = PathBuilder::new();
        for path in layer.paths(sheet) {
            self.trace(path, &mut builder);
        }
        if let Some(lines) = builder.finish() {
            self.stroke(&lines, &paint(legible(layer), 255), width);
        }
    }

    /// One path for all letters, so that crossings are no darker.
    fn stamp(&mut self, lines: &[Vec<Point2>]) {
        let mut builder = PathBuilder::new();
        for line in lines {
            self.trace(&Path::Open(line.clone()), &mut builder);
        }
        if let Some(letters) = builder.finish() {
            let (width, height) = (self.pixels.width(), self.pixels.height());
            let broad = f64::from(width + height) / 200.0;
            self.stroke(&letters, &paint([220, 0, 0], 110), broad);
        }
    }

    fn stroke(&mut self, lines: &Outline, paint: &Paint<'_>, width: f64) {
        let pen = Stroke {
            width: width as f32,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        self.pixels.stroke_path(lines, paint, &pen, Transform::identity(), None);
    }

    fn trace(&self, path: &Path, builder: &mut PathBuilder) {
        let at = |p: Point2| {
            ((p.x * self.scale) as f32, ((self.height - p.y) * self.scale) as f32)
        };
        for step in steps(path, 0.02 / self.scale) {
            match step {
                Step::Move(p) => {
                    let (x, y) = at(p);
                    builder.move_to(x, y);
                }
                Step::Line(p) => {
                    let (x, y) = at(p);
                    builder.line_to(x, y);
                }
                Step::Cubic(a, b, p) => {
                    let ((ax, ay), (bx, by), (x, y)) = (at(a), at(b), at(p));
                    builder.cubic_to(ax, ay, bx, by, x, y);
                }
                Step::Close => builder.close(),
            }
        }
    }
}

/// The layer's colour, darker where the laser's primaries are hard to see on white.
fn legible(layer: &Layer) -> [u8; 3] {
    match layer.operation {
        Some(Operation::Engrave) => [0, 105, 110],
        Some(Operation::Score) => [0, 150, 40],
        _ => layer.rgb,
    }
}

fn paint([r, g, b]: [u8; 3], alpha: u8) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(r, g, b, alpha);
    paint
}

#[cfg(test)]
mod tests {
    use super::super::sample::sample;
    use super::*;

    fn pixel(picture: &Pixmap, x: u32, y: u32) -> [u8; 3] {
        let colour = picture.pixel(x, y).unwrap();
        [colour.red(), colour.green(), colour.blue()]
    }

    #[test]
    fn parts_are_tinted_and_their_holes_are_not() {
        let look = PngLook { px_per_mm: 1.0, ..PngLook::default() };
        let bytes = png(&sample(), &look).unwrap();
        let picture = Pixmap::decode_png(&bytes).unwrap();
        assert_eq!((picture.width(), picture.height()), (300, 200));
        assert_eq!(pixel(&picture, 60, 150), TINTS[0]);
        assert_eq!(pixel(&picture, 180, 90), TINTS[1]);
        assert_eq!(pixel(&picture, 230, 125), [255, 255, 255]);
        assert_eq!(pixel(&picture, 220, 80), TINTS[2]);
        assert_eq!(pixel(&picture, 99, 130), [255, 255, 255]);
    }

    #[test]
    fn huge_sheets_are_scaled_down_and_empty_ones_refused() {
        let huge = Sheet { width: 30_000.0, height: 20_000.0, ..sample() };
        let picture =
            Pixmap::decode_png(&png(&huge, &PngLook::default()).unwrap()).unwrap();
        assert!(
            f64::from(picture.width()) * f64::from(picture.height()) < 1.01 * MOST_PIXELS
        );
        let empty = Sheet { width: 0.0, ..sample() };
        assert!(matches!(png(&empty, &PngLook::default()), Err(PngError::Empty { .. })));
    }

    #[test]
    fn the_stamp_goes_over_the_picture() {
        let stamp = [vec![Point2::new(0.0, 160.0), Point2::new(150.0, 160.0)]];
        let look = PngLook { px_per_mm: 1.0, stamp: &stamp };
        let picture = Pixmap::decode_png(&png(&sample(), &look).unwrap()).unwrap();
        let [red, green, _] = pixel(&picture, 50, 40);
        assert!(red > 230 && green < 160, "{red} {green}");
    }
}
