//! A single fin: the planar quad, cut back at both ends, with notches for the rings of discs
//! or slits for eye plates.

use crate::geometry::{Contour, Vertex};
use crate::parts::connector::Connector;
use crate::parts::fit::Fit;
use crate::parts::hinge::plate::Hinge;
use crate::parts::hub::tenon::{EndFrame, quarter, tongue, writable};
use crate::parts::lap::join::End;
use crate::parts::mark::{Cell, Wish};
use crate::parts::outline::{Closure, Piece, reversed, without_doubles};
use crate::parts::part::{Mark, MarkKind};
use crate::parts::star::Spoke;
use crate::parts::unfold::FlatStrip;
use std::collections::BTreeMap;

/// A fin between its two connectors.
pub(crate) struct Seated<'a> {
    /// The fin in the plane: two axes.
    pub flat: &'a FlatStrip,
    /// What it is held by at its two ends; a fin that ends alone is held by nothing.
    pub ends: [Option<(&'a Connector, &'a Spoke)>; 2],
    /// What the material asks.
    pub fit: &'a Fit,
}

impl Seated<'_> {
    /// The outline, counter-clockwise: bottom edge, right end, top edge, left end.
    pub(crate) fn outline(&self) -> Contour {
        let [left, right] = [0, 1].map(|end| self.end(end));
        let mut vertices = reversed(&left);
        vertices.extend(right);
        without_doubles(&mut vertices);
        Contour { vertices }
    }

    /// One end from the bottom edge over the end edge to the top edge, with its cuts.
    fn end(&self, end: usize) -> Vec<Vertex> {
        let axis = &self.flat.axes[end];
        let Some((connector, spoke)) = self.ends[end] else {
            return [axis.bottom(), axis.top()].map(Vertex::line).to_vec();
        };
        let frame = EndFrame::new(axis, end, spoke.rise);
        match connector {
            Connector::Hub(hub) => tongue(&frame, hub, self.fit.relief),
            Connector::Hinge(hinge) => self.slits(&frame, (hinge, spoke)),
        }
    }

    /// The end edge with its slits for eye plates, from below.
    fn slits(&self, frame: &EndFrame, (hinge, spoke): (&Hinge, &Spoke)) -> Vec<Vertex> {
        let start = hinge.setback;
        let corner = |edge| Vertex::line(frame.on_edge(start, edge));
        let place = hinge.around.spokes.iter().position(|other| other.fin == spoke.fin);
        let levels = place.map_or([0.0; 2], |place| hinge.levels[place]);
        let half = (hinge.thickness + self.fit.clearance) / 2.0;
        let radius = self.fit.relief.min(half).max(0.0);
        let (floor, bulge) = (start + hinge.lap, -frame.turn() * quarter(radius));
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
        std::iter::once(corner(0)).chain(slits).chain([corner(1)]).collect()
    }

    /// Its name with an arrow up, and at both ends the name of the node; the second value
    /// counts texts that found no room.
    pub(crate) fn marks(&self, name: &str, height: f64) -> (Vec<Mark>, usize) {
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
            // The line to the other end must stay clear of the notch however it slopes.
            let [low, high] = writable(hub, spoke, self.fit.relief);
            (axes[end].below, axes[end].above) = (-low, high);
        }
        Piece {
            axes,
            slits: BTreeMap::new(),
            closures: closures.map(Closure::End),
            beyond: [None, None],
        }
    }
}
