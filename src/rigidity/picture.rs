//! The paper's Figure 8: fins coloured by the discrepancy of their hinges, and the motion
//! that the hinges resist least as a displaced ghost.

use crate::geometry::{Point2, Point3};
use crate::ids::{FinId, NodeId};
use crate::picture::{self, Camera, HEAT, PngError};
use crate::rigidity::model::{Model, RigidBody};
use crate::rigidity::paper::{Paper, velocity};
use crate::structure::Structure;
use std::collections::BTreeMap;
use tiny_skia::{Color, FillRule, Paint, PathBuilder, Pixmap, Stroke, Transform};

/// How a picture is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// Width of the picture, pixels.
    pub width: u32,
    /// Direction from which it is seen: radians around, radians up.
    pub from: [f64; 2],
    /// Which of the least resisted motions, the first is 0.
    pub motion: usize,
    /// The discrepancy drawn in full red; the largest there is if `None`.
    pub red: Option<f64>,
}

impl Default for Look {
    fn default() -> Self {
        Self { width: 900, from: [-1.1, 0.55], motion: 0, red: None }
    }
}

/// A fin with its colour, at rest and displaced, in picture coordinates.
struct Panel {
    depth: f64,
    rest: [Point2; 4],
    ghost: [Point2; 4],
    heat: f64,
}

/// How far the ghost's fastest node goes, as a share of the picture's width.
const GHOST: f64 = 0.07;

/// The structure in one of its least resisted motions as PNG. `None` if there is no such
/// motion or nothing to draw.
///
/// # Errors
/// [`PngError`] if it cannot be packed.
pub fn picture(
    structure: &Structure,
    model: &Model,
    paper: &Paper,
    look: &Look,
) -> Result<Option<Vec<u8>>, PngError> {
    let panels = panels(structure, model, paper, look);
    let pixels = panels.and_then(|panels| painted(&panels, look));
    pixels.map(|pixels| picture::png(&pixels)).transpose()
}

fn painted(panels: &[Panel], look: &Look) -> Option<Pixmap> {
    let ends = || panels.iter().flat_map(|p| p.rest.iter().chain(&p.ghost));
    let span = |k: usize| {
        let low = ends().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        (low, ends().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max) - low)
    };
    let ((left, wide), (low, high)) = (span(0), span(1));
    let edge = f64::from(look.width) / 40.0;
    let scale = (f64::from(look.width) - 2.0 * edge) / wide.max(high);
    let height = (high * scale + 2.0 * edge).ceil() as u32;
    let mut pixels = Pixmap::new(look.width, height)?;
    pixels.fill(Color::WHITE);
    let at = |p: Point2| {
        let x = (p.x - left) * scale + edge;
        let y = f64::from(height) - (p.y - low) * scale - edge;
        [x as f32, y as f32]
    };
    for panel in panels {
        let [r, g, b] = HEAT.at(panel.heat).map(|light| light as u8);
        draw(&mut pixels, panel.rest.map(at), [r, g, b, 235], true);
        draw(&mut pixels, panel.rest.map(at), [70, 70, 70, 255], false);
    }
    for panel in panels {
        draw(&mut pixels, panel.ghost.map(at), [60, 100, 190, 26], true);
        draw(&mut pixels, panel.ghost.map(at), [60, 100, 190, 150], false);
    }
    Some(pixels)
}

fn panels(
    structure: &Structure,
    model: &Model,
    paper: &Paper,
    look: &Look,
) -> Option<Vec<Panel>> {
    let motion = paper.motions.get(look.motion)?;
    let bodies = bodies_of_fins(structure, model);
    let heats = heats(model, paper, look.motion);
    let most = heats.values().copied().fold(f64::MIN_POSITIVE, f64::max);
    let red = look.red.unwrap_or(most);
    let moved =
        |body: usize, q: &Point3| velocity(&motion.twists[body], *q * paper.scale);
    let fins =
        || structure.fins().iter().zip(&bodies).filter_map(|(f, b)| Some((*f, (*b)?)));
    let corners = || fins().map(|(fin, body)| (structure.corners(fin.ends()), body));
    let speeds = corners().flat_map(|(c, body)| c.map(|q| moved(body, &q).norm()));
    let fastest = speeds.fold(f64::MIN_POSITIVE, f64::max);
    let camera = Camera::level(look.from);
    let size = corners()
        .flat_map(|(c, _)| c.map(|q| camera.flat(&q.coords).x))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
    let reach = GHOST * (size.1 - size.0) / fastest;
    let mut panels: Vec<Panel> = fins()
        .map(|(fin, body)| {
            let [i, j] = fin.ends();
            let corners = structure.corners([i, j]);
            let heat = |node: NodeId| heats.get(&(node, body)).copied().unwrap_or(0.0);
            Panel {
                depth: corners.iter().map(|q| camera.nearness(&q.coords)).sum(),
                rest: corners.map(|q| camera.flat(&q.coords)),
                ghost: corners
                    .map(|q| camera.flat(&(q.coords + moved(body, &q) * reach))),
                heat: (heat(i) + heat(j)) / 2.0 / red,
            }
        })
        .collect();
    panels.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    (!panels.is_empty()).then_some(panels)
}

/// The body that each fin of the structure belongs to.
fn bodies_of_fins(structure: &Structure, model: &Model) -> Vec<Option<usize>> {
    let mut of = BTreeMap::new();
    for (index, body) in model.bodies.iter().enumerate() {
        match body {
            RigidBody::Fin(fin) => {
                of.insert(*fin, index);
            }
            RigidBody::Strip(strip) => {
                let fins = structure.strips()[*strip].steps();
                of.extend(fins.map(|step| (FinId::from(step), index)));
            }
            RigidBody::Hub(_) | RigidBody::Link(_) => {}
        }
    }
    structure.fins().iter().map(|fin| of.get(fin).copied()).collect()
}

/// The largest discrepancy of each body at each node, in a motion.
fn heats(model: &Model, paper: &Paper, motion: usize) -> BTreeMap<(NodeId, usize), f64> {
    let mut heats: BTreeMap<(NodeId, usize), f64> = BTreeMap::new();
    for d in paper.discrepancies_in(model, motion) {
        for body in d.bodies {
            let heat = heats.entry((d.node, body)).or_default();
            *heat = heat.max(d.value);
        }
    }
    heats
}

fn draw(pixels: &mut Pixmap, corners: [[f32; 2]; 4], [r, g, b, a]: [u8; 4], fill: bool) {
    let mut builder = PathBuilder::new();
    builder.move_to(corners[0][0], corners[0][1]);
    corners[1..].iter().for_each(|p| builder.line_to(p[0], p[1]));
    builder.close();
    let Some(path) = builder.finish() else { return };
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(r, g, b, a);
    let still = Transform::identity();
    if fill {
        pixels.fill_path(&path, &paint, FillRule::Winding, still, None);
    } else {
        let stroke = Stroke { width: 0.8, ..Stroke::default() };
        pixels.stroke_path(&path, &paint, &stroke, still, None);
    }
}
