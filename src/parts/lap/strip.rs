//! One strip, whole or in pieces, as parts.

use crate::geometry::Region;
use crate::parts::Making;
use crate::parts::lap::mark;
use crate::parts::outline::{Piece, outline};
use crate::parts::part::{Body, Part, StripBody};
use crate::parts::unfold::{FlatStrip, Fold};

/// A strip on its way to parts.
pub(super) struct Pieces<'a> {
    /// Its index in the structure.
    pub strip: usize,
    /// Its place in the order of assembly.
    pub rank: usize,
    pub flat: &'a FlatStrip,
    pub making: &'a Making<'a>,
    pub name: &'a str,
}

impl Pieces<'_> {
    /// One part for each piece; several get letters.
    pub(super) fn parts(&self, pieces: Vec<Piece>) -> Vec<Part> {
        let count = pieces.len();
        let mut first = 0;
        let mut parts = Vec::new();
        for (k, piece) in pieces.into_iter().enumerate() {
            let id = match count {
                1 => self.name.to_owned(),
                _ => format!("{}{}", self.name, piece_letter(k)),
            };
            let axes = piece.axes.len();
            parts.push(self.part(id, piece, first));
            first += axes;
        }
        parts
    }

    fn part(&self, id: String, piece: Piece, first: usize) -> Part {
        let all = &self.flat.axes;
        let after = first + piece.axes.len();
        let inner = (first.max(1)..after.min(all.len() - 1)).map(|k| k - 1);
        let folds: Vec<Fold> = inner.map(|k| self.flat.folds[k]).collect();
        let splice = |k: usize| [all[k - 1].node, all[k].node];
        let left = (first > 0).then(|| splice(first));
        let right = (after < all.len()).then(|| splice(after));
        let marks = mark::marks(&piece, &id, &folds, self.making.marking);
        let outline = outline(&piece, self.making.fit);
        let body = StripBody {
            strip: self.strip,
            folds,
            slits: piece.slits.values().map(|slit| (*slit, String::new())).collect(),
            splices: left.into_iter().chain(right).collect(),
            closed: self.flat.closed && left.is_none() && right.is_none(),
            rank: self.rank,
            setbacks: [0, 1].map(|end| piece.closures[end].setback()),
            axes: piece.axes,
        };
        let region = Region { outline, holes: Vec::new() };
        Part { id, quantity: 1, region, marks, body: Body::Strip(body) }
    }
}

/// a, b, ... z, aa, ab, ...
fn piece_letter(k: usize) -> String {
    let letter = char::from(b'a' + (k % 26) as u8);
    if k < 26 {
        letter.to_string()
    } else {
        format!("{}{letter}", piece_letter(k / 26 - 1))
    }
}
