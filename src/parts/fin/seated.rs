//! The planar quad of a fin, cut back at both ends as its connectors ask.

use crate::geometry::{Contour, Vertex};
use crate::parts::cell::{Cell, Wish};
use crate::parts::chain::{reversed, without_doubles};
use crate::parts::connector::Connector;
use crate::parts::end::EndFrame;
use crate::parts::fit::Fit;
use crate::parts::mark::{Mark, MarkKind};
use crate::parts::outline::{Closure, End, Piece};
use crate::parts::star::IncidentFin;
use crate::parts::unfold::FlatStrip;
use std::collections::BTreeMap;

/// A fin between its two connectors.
pub(super) struct SeatedFin<'a> {
    /// The fin in the plane: two axes.
    pub flat: &'a FlatStrip,
    /// What it is held by at its two ends; a fin that ends alone is held by nothing.
    pub ends: [Option<(&'a dyn Connector, &'a IncidentFin)>; 2],
    /// What the material asks.
    pub fit: &'a Fit,
}

impl SeatedFin<'_> {
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
        let axis = &self.flat.axes[end];
        let Some((connector, fin)) = self.ends[end] else {
            return [axis.bottom(), axis.top()].map(Vertex::line).to_vec();
        };
        connector.fin_end(&EndFrame::new(axis, end, fin.rise), fin, self.fit)
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
            let Some((connector, fin)) = held else { continue };
            let writable = connector.writable(fin, self.fit);
            closures[end] = End::SetBack(writable.from);
            if let Some([low, high]) = writable.heights {
                (axes[end].below, axes[end].above) = (-low, high);
            }
        }
        Piece {
            axes,
            slits: BTreeMap::new(),
            closures: closures.map(Closure::End),
            beyond: [None, None],
        }
    }
}
