//! A picture of planarity before and after, as in Figure 2c: fins in colours from blue
//! (plane) to red (out of plane), seen from above at a slant.

use crate::geometry::{Point2, Point3, Vector3};
use crate::ids::{FinId, NodeId};
use crate::lettering::letter;
use crate::picture::{BLUE_TO_RED, Camera};
use crate::structure::{Draft, planarity};
use crate::tolerance::PLANAR;
use miette::Diagnostic;
use thiserror::Error;
use tiny_skia::{Color, FillRule, Paint, Path, PathBuilder, Pixmap, Stroke, Transform};

/// Width and height of one of the two panels, pixels.
pub(in crate::design) const PANEL: [f64; 2] = [1100.0, 900.0];
/// Room below for the scale of colours, pixels.
pub(in crate::design) const FOOT: f64 = 110.0;
pub(in crate::design) const MARGIN: f64 = 60.0;
/// The scale of colours runs between these shares of a fin's diameter, in powers of ten.
const LOW_POWER: f64 = -7.0;
const HIGH_POWER: f64 = -2.0;

/// Why there is no picture.
#[derive(Debug, Clone, PartialEq, Eq, Error, Diagnostic)]
#[error("the picture of planarity could not be made")]
#[diagnostic(code(design::picture), help("leave `--picture` out"))]
pub struct PictureError;

/// Draws the fins of two drafts of the same mesh side by side, as PNG. Both drafts must
/// be sound ([`SoundDraft`](crate::structure::SoundDraft)).
///
/// # Errors
/// [`PictureError`] if there is nothing to draw.
pub fn picture(before: &Draft, after: &Draft) -> Result<Vec<u8>, PictureError> {
    let mut pixels = paper(2)?;
    planarities([before, after], 0.0, &mut pixels);
    pixels.encode_png().map_err(|_| PictureError)
}

/// White paper for this many panels side by side.
pub(in crate::design) fn paper(panels: usize) -> Result<Pixmap, PictureError> {
    let size = [panels as f64 * PANEL[0], PANEL[1] + FOOT];
    let mut pixels = Pixmap::new(size[0] as u32, size[1] as u32).ok_or(PictureError)?;
    pixels.fill(Color::WHITE);
    Ok(pixels)
}

/// Draws planarity before and after in two panels, the first one at `left`.
pub(in crate::design) fn planarities(
    drafts: [&Draft; 2],
    left: f64,
    pixels: &mut Pixmap,
) {
    let view = Panel::onto(drafts[0]);
    for (panel, (title, draft)) in ["before", "after"].iter().zip(drafts).enumerate() {
        let left = left + panel as f64 * PANEL[0];
        let worst = view.fins(draft, left, pixels);
        let text = format!("{title}: worst fin {:.5} %", worst * 100.0);
        write(pixels, &text, [left + MARGIN, 20.0], 22.0);
    }
    legend(left, pixels);
}

/// A camera with what is in the middle of its panel, and how large that is.
pub(in crate::design) struct Panel {
    camera: Camera,
    centre: Vector3,
    scale: f64,
}

impl Panel {
    /// Slanted onto the mesh, so that it fills a panel.
    pub(in crate::design) fn onto(draft: &Draft) -> Self {
        let sum: Vector3 = draft.axes.iter().map(|axis| axis.normalize()).sum();
        let above = if sum.norm() > 0.1 * draft.axes.len() as f64 {
            sum.normalize()
        } else {
            Vector3::z()
        };
        let camera = Camera::slanted(&above);
        let mut view = Self { camera, centre: Vector3::zeros(), scale: 1.0 };
        let places: Vec<Point2> = draft.positions.iter().map(|p| view.at(p)).collect();
        let low = places.iter().fold(places[0], |low, p| low.inf(p));
        let high = places.iter().fold(places[0], |high, p| high.sup(p));
        let span = high - low;
        view.scale = ((PANEL[0] - 2.0 * MARGIN) / span.x.abs())
            .min((PANEL[1] - 3.0 * MARGIN) / span.y.abs())
            .min(f64::MAX);
        let middle = nalgebra::center(&low, &high);
        view.centre = camera.right * middle.x + camera.up * middle.y;
        view
    }

    fn at(&self, p: &Point3) -> Point2 {
        self.camera.flat(&(p.coords - self.centre)) * self.scale
    }

    /// Where a point is drawn in the panel at `left`.
    pub(in crate::design) fn pixel(&self, p: &Point3, left: f64) -> [f64; 2] {
        let p = self.at(p);
        [left + PANEL[0] / 2.0 + p.x, PANEL[1] / 2.0 + MARGIN / 2.0 - p.y]
    }

    /// Draws all fins, the farthest first; returns the worst planarity.
    fn fins(&self, draft: &Draft, left: f64, pixels: &mut Pixmap) -> f64 {
        let quad = |fin: &FinId| {
            let [i, j] = fin.ends();
            let end = |k: NodeId, reach: f64| {
                draft.positions[k] + draft.axes[k].normalize() * reach
            };
            let (below, above) = (&draft.below, &draft.above);
            [end(i, -below[i]), end(j, -below[j]), end(j, above[j]), end(i, above[i])]
        };
        let mut quads: Vec<[Point3; 4]> = draft.fin_ids().iter().map(quad).collect();
        let near = |quad: &[Point3; 4]| -> f64 {
            quad.iter().map(|p| self.camera.nearness(&p.coords)).sum()
        };
        quads.sort_by(|a, b| near(a).total_cmp(&near(b)));
        let mut worst = 0.0_f64;
        for quad in &quads {
            let (off, diameter) = planarity(quad);
            let share = if diameter > 0.0 { off / diameter } else { 0.0 };
            worst = worst.max(share);
            let place = |p: &Point3| self.pixel(p, left);
            if let Some(path) = polygon(&quad.each_ref().map(place)) {
                paint(pixels, &path, colour(share));
            }
        }
        worst
    }
}

fn polygon(corners: &[[f64; 2]]) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for (k, [x, y]) in corners.iter().enumerate() {
        let (x, y) = (*x as f32, *y as f32);
        if k == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
    }
    builder.close();
    builder.finish()
}

fn paint(pixels: &mut Pixmap, path: &Path, [r, g, b]: [u8; 3]) {
    let mut ink = Paint { anti_alias: true, ..Paint::default() };
    ink.set_color_rgba8(r, g, b, 255);
    pixels.fill_path(path, &ink, FillRule::Winding, Transform::identity(), None);
    ink.set_color_rgba8(40, 40, 40, 255);
    let pen = Stroke { width: 0.6, ..Stroke::default() };
    pixels.stroke_path(path, &ink, &pen, Transform::identity(), None);
}

/// The colour of a fin off its plane by a share of its diameter.
fn colour(share: f64) -> [u8; 3] {
    let power = libm::log10(share.max(PLANAR)).clamp(LOW_POWER, HIGH_POWER);
    let place = (power - LOW_POWER) / (HIGH_POWER - LOW_POWER);
    BLUE_TO_RED.at(place).map(|light| light.round() as u8)
}

/// The scale of colours, with the percentages at its powers of ten, below two panels.
fn legend(left: f64, pixels: &mut Pixmap) {
    let (left, width, top) = (left + PANEL[0] - 500.0, 1000.0, PANEL[1] + 20.0);
    let steps = 100;
    for step in 0..steps {
        let at = |k: usize| left + width * k as f64 / f64::from(steps as u8);
        let (a, b) = (at(step), at(step + 1));
        let power = (step as f64 + 0.5) / f64::from(steps as u8);
        let share = libm::pow(10.0, LOW_POWER + power * (HIGH_POWER - LOW_POWER));
        let corners = [[a, top], [b, top], [b, top + 24.0], [a, top + 24.0]];
        if let Some(path) = polygon(&corners) {
            let mut ink = Paint::default();
            let [r, g, b] = colour(share);
            ink.set_color_rgba8(r, g, b, 255);
            let rule = FillRule::Winding;
            pixels.fill_path(&path, &ink, rule, Transform::identity(), None);
        }
    }
    let labels = ["0.00001 %", "0.0001 %", "0.001 %", "0.01 %", "0.1 %", "1 %"];
    for (k, label) in labels.iter().enumerate() {
        let x = left + width * k as f64 / (labels.len() - 1) as f64;
        write(pixels, label, [x - 40.0, top + 38.0], 16.0);
    }
}

/// Writes a line with its upper left corner here, this many pixels high.
pub(in crate::design) fn write(
    pixels: &mut Pixmap,
    text: &str,
    [x, y]: [f64; 2],
    height: f64,
) {
    let Ok(lettering) = letter(text, height) else { return };
    let mut builder = PathBuilder::new();
    for stroke in &lettering.strokes {
        for (k, p) in stroke.iter().enumerate() {
            let (x, y) = ((x + p.x) as f32, (y + height - p.y) as f32);
            if k == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
        }
    }
    let Some(path) = builder.finish() else { return };
    let mut ink = Paint { anti_alias: true, ..Paint::default() };
    ink.set_color_rgba8(30, 30, 30, 255);
    let pen = Stroke { width: (height / 11.0) as f32, ..Stroke::default() };
    pixels.stroke_path(&path, &ink, &pen, Transform::identity(), None);
}
