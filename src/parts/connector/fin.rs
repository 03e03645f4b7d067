//! A single fin: the planar quad, cut back at both ends, with notches for the rings of discs
//! or slits for eye plates.

use crate::geometry::{Contour, Point2, Vector2, Vertex, trig};
use crate::parts::connector::{Connector, Hinge, Hub, Spoke};
use crate::parts::fit::Fit;
use crate::parts::joint::End;
use crate::parts::mark::{Cell, Wish};
use crate::parts::outline::{Closure, Piece, reversed, without_doubles};
use crate::parts::part::{Mark, MarkKind};
use crate::parts::unfold::{FlatAxis, FlatStrip};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_8;

/// A fin between its two connectors.
pub(super) struct Seated<'a> {
    /// The fin in the plane: two axes.
    pub flat: &'a FlatStrip,
    /// What it is held by at its two ends; a fin that ends alone is held by nothing.
    pub ends: [Option<(&'a Connector, &'a Spoke)>; 2],
    /// What the material asks.
    pub fit: &'a Fit,
}

/// One end of a fin in its own frame: `s` from the axis into the fin, `z` along the axis.
struct EndFrame<'a> {
    axis: &'a FlatAxis,
    inward: Vector2,
}

impl EndFrame<'_> {
    fn at(&self, s: f64, z: f64) -> Point2 {
        self.axis.foot + self.inward * s + self.axis.up * z
    }
}

impl Seated<'_> {
    /// The outline, counter-clockwise: bottom edge, right end, top edge, left end.
    pub(super) fn outline(&self) -> Contour {
        let [left, right] = [0, 1].map(|end| self.end(end));
        let mut vertices = reversed(&left);
        vertices.extend(right);
        without_doubles(&mut vertices);
        Contour { vertices }
    }

    /// One end from the bottom edge over the end edge to the top edge, with its cuts.
    fn end(&self, end: usize) -> Vec<Vertex> {
        let frame = self.frame(end);
        // At the right end the way up runs counter-clockwise; the left is turned round.
        let turn = if end == 1 { 1.0 } else { -1.0 };
        let axis = frame.axis;
        match self.ends[end] {
            None => [axis.bottom(), axis.top()].map(Vertex::line).to_vec(),
            Some((Connector::Hub(hub), spoke)) => {
                let mut chain = self.notch(&frame, (hub, spoke), false, turn);
                chain.extend(reversed(&self.notch(&frame, (hub, spoke), true, turn)));
                chain
            }
            Some((Connector::Hinge(hinge), spoke)) => {
                self.slits(&frame, (hinge, spoke), turn)
            }
        }
    }

    /// A notch for a ring and the corner beyond it, toward the axis.
    fn notch(
        &self,
        frame: &EndFrame,
        (hub, spoke): (&Hub, &Spoke),
        top: bool,
        turn: f64,
    ) -> Vec<Vertex> {
        let edge = usize::from(top);
        let on_edge = |s: f64| frame.at(s, edge_height(frame.axis, spoke, top, s));
        let [near, far] = hub.notch;
        let floor = hub.between()[edge];
        let radius = self.fit.relief.min((far - near) / 2.0).max(0.0);
        let beyond = if top { floor - radius } else { floor + radius };
        // The same corner on the other edge turns the other way; so does a chain reversed.
        let turn = if top { turn } else { -turn };
        let bulge = turn * quarter(radius);
        vec![
            Vertex::line(on_edge(far)),
            Vertex::arc(frame.at(far, floor), bulge),
            Vertex::line(frame.at(far - radius, beyond)),
            Vertex::arc(frame.at(near + radius, beyond), bulge),
            Vertex::line(frame.at(near, floor)),
            Vertex::line(on_edge(near)),
            Vertex::line(on_edge(hub.setback)),
        ]
    }

    /// The end edge with its slits for eye plates, from below.
    fn slits(
        &self,
        frame: &EndFrame,
        (hinge, spoke): (&Hinge, &Spoke),
        turn: f64,
    ) -> Vec<Vertex> {
        let start = hinge.setback;
        let corner = |top| {
            Vertex::line(frame.at(start, edge_height(frame.axis, spoke, top, start)))
        };
        let place = hinge.around.spokes.iter().position(|other| other.fin == spoke.fin);
        let levels = place.map_or([0.0; 2], |place| hinge.levels[place]);
        let half = (hinge.thickness + self.fit.clearance) / 2.0;
        let radius = self.fit.relief.min(half).max(0.0);
        let (floor, bulge) = (start + hinge.lap, -turn * quarter(radius));
        let slits = levels.into_iter().flat_map(|level| {
            let (low, high) = (level - half, level + half);
            [
                Vertex::line(frame.at(start, low)),
                Vertex::arc(frame.at(floor, low), bulge),
                Vertex::line(frame.at(floor + radius, low + radius)),
                Vertex::arc(frame.at(floor + radius, high - radius), bulge),
                Vertex::line(frame.at(floor, high)),
                Vertex::line(frame.at(start, high)),
            ]
        });
        std::iter::once(corner(false)).chain(slits).chain([corner(true)]).collect()
    }

    fn frame(&self, end: usize) -> EndFrame<'_> {
        let axis = &self.flat.axes[end];
        let inward = if end == 0 { axis.right() } else { -axis.right() };
        EndFrame { axis, inward }
    }

    /// Its name with an arrow up, and at both ends the name of the node; the second value
    /// counts texts that found no room.
    pub(super) fn marks(&self, name: &str, height: f64) -> (Vec<Mark>, usize) {
        let mut cell = Cell::new(&self.writable(), 0);
        let node = |end: usize| format!("N{}", self.flat.axes[end].node);
        let texts = [
            (format!("{name}\u{2191}"), Wish { along: 0.5, up: 0.5 }),
            (node(0), Wish { along: 0.0, up: 0.0 }),
            (node(1), Wish { along: 1.0, up: 0.0 }),
        ];
        let strokes = texts.map(|(text, wish)| cell.write(&text, wish, height));
        let mark = |strokes| Mark { kind: MarkKind::Engrave, strokes };
        let marks: Vec<Mark> = strokes.into_iter().flatten().map(mark).collect();
        let missing = 3 - marks.len();
        (marks, missing)
    }

    /// The fin between the floors of its cuts, as a piece of a strip to write on.
    fn writable(&self) -> Piece {
        let mut axes = self.flat.axes.clone();
        let mut closures = [End::Free; 2];
        for (end, held) in self.ends.iter().enumerate() {
            let Some((connector, spoke)) = held else { continue };
            closures[end] = End::SetBack(match connector {
                Connector::Hinge(hinge) => hinge.setback + hinge.lap + self.fit.relief,
                Connector::Hub(hub) => hub.setback,
            });
            let Connector::Hub(hub) = connector else { continue };
            let [low, high] = hub.between();
            // The line to the other end must stay clear of the notch however it slopes.
            let spare =
                |edge: usize| self.fit.relief + spoke.rise[edge].abs() * hub.radius;
            axes[end].below = -(low + spare(0));
            axes[end].above = high - spare(1);
        }
        Piece {
            axes,
            slits: BTreeMap::new(),
            closures: closures.map(Closure::End),
            beyond: [None, None],
        }
    }
}

/// Height of a fin's edge at `s` from the axis.
fn edge_height(axis: &FlatAxis, spoke: &Spoke, top: bool, s: f64) -> f64 {
    let start = if top { axis.above } else { -axis.below };
    start + spoke.rise[usize::from(top)] * s
}

/// Bulge of a quarter circle, if there is one.
fn quarter(radius: f64) -> f64 {
    if radius > 0.0 { trig::tan(FRAC_PI_8) } else { 0.0 }
}
