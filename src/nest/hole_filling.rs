//! Parts in the holes of larger ones, before anything is laid on a sheet.
//!
//! A hole is filled like a remnant of stock whose margin is the spacing. What lies in it
//! moves with the part around it, which is then laid as if it had no hole. Small parts are
//! filled first, so that a filled ring can lie in a larger one.

use crate::geometry::ring::area;
use crate::geometry::{Motion, Point2, Rect, Vector2};
use crate::nest::collision_shape::gate;
use crate::nest::convex_decomposition::open_holes;
use crate::nest::initial::fill_irregular;
use crate::nest::rotation::{fits, good, longest, rounded};
use crate::nest::{Layout, Placement, Remnant, Rotations, Shape, Stock};
use crate::tolerance::WRITTEN_MM;
use std::collections::{BTreeMap, BTreeSet};

/// Parts that are tried in one hole, at most.
const MOST_TRIED: usize = 200;

/// What lies in the holes of a part while that is turned by `angle` about its origin.
#[derive(Debug)]
struct Content {
    angle: f64,
    placements: Vec<Placement>,
}

/// Shapes as they are laid, and what lies in their holes.
#[derive(Debug)]
pub(super) struct FilledHoles {
    /// Where something lies in a part's holes, it has none.
    pub(super) shapes: Vec<Shape>,
    contents: BTreeMap<usize, Content>,
}

impl FilledHoles {
    /// Nothing in any hole.
    pub(super) fn none(shapes: &[Shape]) -> Self {
        Self { shapes: shapes.to_vec(), contents: BTreeMap::new() }
    }

    /// Fills holes with parts of `order`, large ones first.
    pub(super) fn fill(
        shapes: &[Shape],
        stock: &[Stock],
        order: &[usize],
        seed: u64,
    ) -> Self {
        let mut filled = Self::none(shapes);
        let spacing = stock.iter().map(|s| s.spacing).fold(0.0, f64::max);
        let gate = gate(shapes, spacing);
        let is_open =
            |&&part: &&usize| open_holes(&shapes[part].holes, gate).next().is_some();
        let hosts: Vec<usize> = order.iter().rev().filter(is_open).copied().collect();
        if hosts.is_empty() {
            return filled;
        }
        // Few angles: along the sides of the hole, as a rule.
        let solid = shapes.iter().map(|shape| Shape {
            holes: Vec::new(),
            rotations: Rotations::Only(good(&shape.outline, &shape.rotations, &stock[0])),
            ..shape.clone()
        });
        let mut solid: Vec<Shape> = solid.collect();
        let mut taken = BTreeSet::new();
        for host in hosts {
            let Shape { outline, rotations, .. } = &solid[host];
            let angle = stock.iter().find_map(|sheet| fits(outline, rotations, sheet));
            let Some(angle) = angle else { continue };
            let mut content = Content { angle, placements: Vec::new() };
            for hole in open_holes(&shapes[host].holes, gate) {
                let (hole, corner) = as_remnant(hole, content.angle, spacing);
                let tried = order.iter().copied().filter(|&part| {
                    let is_free = part != host && !taken.contains(&part);
                    is_free && may_lie_in(&shapes[part], &shapes[host], &hole)
                });
                let tried = tried.take(MOST_TRIED).collect();
                let (sheets, _) = fill_irregular(&solid, &[hole], &[0], tried, seed);
                let inside = sheets.into_iter().flat_map(|sheet| sheet.placements);
                content.placements.extend(inside.map(|p| {
                    taken.insert(p.shape);
                    Placement { x: p.x + corner.x, y: p.y + corner.y, ..p }
                }));
            }
            if content.placements.is_empty() {
                continue;
            }
            let is_bound =
                |p: &Placement| filled.shapes[p.shape].rotations != Rotations::Free;
            if content.placements.iter().any(is_bound) {
                let only = Rotations::Only(vec![content.angle]);
                (filled.shapes[host].rotations, solid[host].rotations) =
                    (only.clone(), only);
            }
            filled.shapes[host].holes = Vec::new();
            filled.contents.insert(host, content);
        }
        filled
    }

    /// Whether something lies in a hole.
    pub(super) fn is_empty(&self) -> bool {
        self.contents.is_empty()
    }

    /// What lies directly in the holes of these parts.
    pub(super) fn within(&self, hosts: &[usize]) -> impl Iterator<Item = usize> {
        let contents = hosts.iter().filter_map(|host| self.contents.get(host));
        contents.flat_map(|content| &content.placements).map(|p| p.shape)
    }

    /// The layout with what lies in the holes of its parts; each part is laid once.
    pub(super) fn with_contents(&self, mut layout: Layout) -> Layout {
        let laid = layout.sheets.iter().flat_map(|sheet| &sheet.placements);
        let mut laid: BTreeSet<usize> = laid.map(|p| p.shape).collect();
        for sheet in &mut layout.sheets {
            let mut k = 0;
            while let Some(&host) = sheet.placements.get(k) {
                let inside = self.contents.get(&host.shape);
                let inside = inside.into_iter().flat_map(|content| content.moved(&host));
                sheet.placements.extend(inside.filter(|p| laid.insert(p.shape)));
                k += 1;
            }
        }
        layout
    }
}

impl Content {
    /// Where it lies when the part around it lies somewhere.
    fn moved(&self, host: &Placement) -> impl Iterator<Item = Placement> {
        let turn = host.angle - self.angle;
        let (rotation, by) = (Motion::rotation(turn), Vector2::new(host.x, host.y));
        self.placements.iter().map(move |p| {
            let at = rotation.rotate(Vector2::new(p.x, p.y)) + by;
            let [x, y] = [at.x, at.y].map(|mm| (mm / WRITTEN_MM).round() * WRITTEN_MM);
            Placement { angle: rounded(p.angle + turn), x, y, ..*p }
        })
    }
}

/// A turned hole as a piece of stock, and its lower left corner.
fn as_remnant(hole: &[Point2], angle: f64, spacing: f64) -> (Stock, Vector2) {
    let rotation = Motion::rotation(angle);
    let turned: Vec<Point2> = hole.iter().rev().map(|&p| rotation.apply(p)).collect();
    let bounds = Rect::around(&turned);
    let (size, corner) = (bounds.size(), bounds.min.coords);
    let outline = turned.iter().map(|p| p - corner).collect();
    let remnant = Some(Remnant { outline, holes: Vec::new() });
    let whole = Stock::new([size.x, size.y], spacing, spacing);
    (Stock { remnant, count: Some(1), ..whole }, corner)
}

/// Whether there is a chance, and no part has to stay out that is less important.
fn may_lie_in(part: &Shape, host: &Shape, hole: &Stock) -> bool {
    let fits = longest(&part.outline) <= Vector2::new(hole.width, hole.height).norm();
    part.priority <= host.priority && area(&part.outline) < hole.area() && fits
}
