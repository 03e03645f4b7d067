//! A design as in Figure 2 of the paper: axes and directions on the surface, the mesh with
//! its families and singular nodes, planarity before and after.

use crate::design::Designed;
use crate::design::families::families;
use crate::design::planarise::PictureError;
use crate::design::planarise::picture::{
    MARGIN, PANEL, Panel, paper, planarities, write,
};
use crate::design::surface::{Foot, Surface};
use crate::geometry::{Point3, Vector3};
use std::f64::consts::TAU;
use tiny_skia::{FillRule, Paint, PathBuilder, Pixmap, Stroke, Transform};

const BLUE: [u8; 3] = [30, 90, 200];
const RED: [u8; 3] = [200, 40, 30];
const ORANGE: [u8; 3] = [225, 130, 20];
const DARK: [u8; 3] = [50, 50, 50];

/// Crosses that are shown at most.
const CROSSES: usize = 900;

/// Draws a design as PNG.
///
/// # Errors
/// [`PictureError`] if there is nothing to draw.
pub fn design_picture(
    surface: &Surface,
    designed: &Designed,
) -> Result<Vec<u8>, PictureError> {
    let mut pixels = paper(4)?;
    let view = Panel::onto(&designed.before);
    directions(surface, designed, &view, &mut pixels);
    mesh(designed, &view, &mut pixels);
    planarities([&designed.before, &designed.draft], 2.0 * PANEL[0], &mut pixels);
    pixels.encode_png().map_err(|_| PictureError)
}

/// Axes in red and both directions in blue, where there is room for them.
fn directions(surface: &Surface, designed: &Designed, view: &Panel, pixels: &mut Pixmap) {
    let wanted = designed.figures.edge.wanted;
    for ring in surface.boundary() {
        for side in ring {
            let ends = [surface.tail(side), surface.tip(side)];
            line(pixels, ends.map(|k| view.pixel(&surface.positions[k], 0.0)), DARK, 1.5);
        }
    }
    let step = surface.triangles.len().div_ceil(CROSSES);
    for triangle in (0..surface.triangles.len()).step_by(step) {
        let foot = Foot { triangle, shares: [1.0 / 3.0; 3] };
        let at = surface.point(foot);
        let mut stroke = |from: Point3, to: Point3, colour| {
            line(pixels, [from, to].map(|p| view.pixel(&p, 0.0)), colour, 1.2);
        };
        for direction in designed.directions[triangle] {
            let reach: Vector3 = direction * wanted * 0.3;
            stroke(at - reach, at + reach, BLUE);
        }
        let axis = surface.between(&designed.axes, foot) * wanted * 0.6;
        stroke(at, at + axis, RED);
    }
    write(pixels, "axes (red) and directions (blue)", [MARGIN, 20.0], 22.0);
}

/// The mesh in the colours of its families, grey where they cannot be told; nodes of three
/// fins as red discs, of five and more as blue ones.
fn mesh(designed: &Designed, view: &Panel, pixels: &mut Pixmap) {
    let left = PANEL[0];
    let draft = &designed.draft;
    for ([a, b], family) in families(draft, 1.0) {
        let colour = match family {
            Some(1) => BLUE,
            Some(_) => ORANGE,
            None => DARK,
        };
        let ends = [a, b].map(|k| view.pixel(&draft.positions[k], left));
        line(pixels, ends, colour, 1.6);
    }
    for node in &designed.figures.singular {
        let at = view.pixel(&draft.positions[node.node], left);
        disc(pixels, at, if node.valence < 4 { RED } else { BLUE });
    }
    let figures = &designed.figures;
    let text = format!(
        "{} nodes, {} fins, {} singular",
        figures.nodes,
        figures.fins,
        figures.singular.len()
    );
    write(pixels, &text, [left + MARGIN, 20.0], 22.0);
}

fn line(pixels: &mut Pixmap, ends: [[f64; 2]; 2], [r, g, b]: [u8; 3], width: f32) {
    let mut builder = PathBuilder::new();
    builder.move_to(ends[0][0] as f32, ends[0][1] as f32);
    builder.line_to(ends[1][0] as f32, ends[1][1] as f32);
    let Some(path) = builder.finish() else { return };
    let mut ink = Paint { anti_alias: true, ..Paint::default() };
    ink.set_color_rgba8(r, g, b, 255);
    let pen = Stroke { width, ..Stroke::default() };
    pixels.stroke_path(&path, &ink, &pen, Transform::identity(), None);
}

fn disc(pixels: &mut Pixmap, at: [f64; 2], [r, g, b]: [u8; 3]) {
    const CORNERS: usize = 24;
    const RADIUS: f64 = 9.0;
    let mut builder = PathBuilder::new();
    for k in 0..CORNERS {
        let turn = TAU * k as f64 / CORNERS as f64;
        let x = at[0] + RADIUS * crate::geometry::trig::cos(turn);
        let y = at[1] + RADIUS * crate::geometry::trig::sin(turn);
        if k == 0 {
            builder.move_to(x as f32, y as f32);
        } else {
            builder.line_to(x as f32, y as f32);
        }
    }
    builder.close();
    let Some(path) = builder.finish() else { return };
    let mut ink = Paint { anti_alias: true, ..Paint::default() };
    ink.set_color_rgba8(r, g, b, 255);
    pixels.fill_path(&path, &ink, FillRule::Winding, Transform::identity(), None);
}
