//! Writing on a fin.
//!
//! Everything stays inside the *cell* of a fin, the quadrilateral between the walls of
//! its slits and the strip's edges, so that no letter lies across a cut. What does not
//! fit is written smaller, then upright, then left out.

use crate::geometry::{Point2, Vector2};
use crate::lettering::{letter, width};
use crate::parts::mark::GAP;
use crate::parts::outline::Piece;
use crate::parts::slit::Slit;

/// Where in its cell a text would best stand: shares of the cell along the fin and up.
#[derive(Clone, Copy)]
pub(crate) struct Wish {
    pub along: f64,
    pub up: f64,
}

/// The part of a fin that can be written on, in the fin's own frame.
pub(crate) struct Cell {
    origin: Point2,
    along: Vector2,
    up: Vector2,
    /// Half-planes that the cell is the intersection of: inward normal and least value.
    sides: Vec<(Vector2, f64)>,
    corners: [Point2; 4],
    taken: Vec<[f64; 4]>,
}

impl Cell {
    pub(crate) fn new(piece: &Piece, fin: usize) -> Self {
        let (a, b) = (&piece.axes[fin], &piece.axes[fin + 1]);
        let last = piece.axes.len() - 1;
        let left = clear(piece, fin, fin == 0, 0, |slit| slit.after);
        let right = clear(piece, fin + 1, fin + 1 == last, 1, |slit| slit.before);
        let along = (b.foot - a.foot).normalize();
        let up = Vector2::new(-along.y, along.x);
        let line = |p: Point2, inward: Vector2, gap: f64| {
            let inward = inward.normalize();
            (inward, inward.dot(&p.coords) + gap)
        };
        let left_of = |way: Vector2| Vector2::new(-way.y, way.x);
        let sides = vec![
            line(a.foot, a.right(), left + GAP),
            line(b.foot, -b.right(), right + GAP),
            line(a.bottom(), left_of(b.bottom() - a.bottom()), GAP),
            line(a.top(), -left_of(b.top() - a.top()), GAP),
        ];
        let corners = [a.bottom(), b.bottom(), b.top(), a.top()];
        Self { origin: a.foot, along, up, sides, corners, taken: Vec::new() }
    }

    /// Strokes of a text as near as can be to its wished place, if it fits at all.
    pub(crate) fn write(
        &mut self,
        text: &str,
        wish: Wish,
        height: f64,
    ) -> Option<Vec<Vec<Point2>>> {
        [(1.0, false), (1.0, true), (0.8, false), (0.8, true), (0.6, false), (0.6, true)]
            .into_iter()
            .find_map(|(share, upright)| self.place(text, wish, height * share, upright))
    }

    fn place(
        &mut self,
        text: &str,
        wish: Wish,
        height: f64,
        upright: bool,
    ) -> Option<Vec<Vec<Point2>>> {
        let long = width(text, height).ok()?;
        let (w, h) = if upright { (height, long) } else { (long, height) };
        let [x, y] = self.free_place(wish, w, h)?;
        self.taken.push([x, y, x + w, y + h]);
        let at = |u: f64, v: f64| self.origin + self.along * (x + u) + self.up * (y + v);
        let lettering = letter(text, height).ok()?;
        let map = |p: &Point2| if upright { at(w - p.y, p.x) } else { at(p.x, p.y) };
        Some(lettering.strokes.iter().map(|s| s.iter().map(map).collect()).collect())
    }

    /// Lower left corner, in the fin's frame, of a free box of this size.
    fn free_place(&self, wish: Wish, w: f64, h: f64) -> Option<[f64; 2]> {
        const STEPS: usize = 8;
        let frame = self.corners.map(|p| {
            let way = p - self.origin;
            [way.dot(&self.along), way.dot(&self.up)]
        });
        let range = |k: usize, size: f64| {
            let values = frame.map(|p| p[k]);
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            (low, (high - low - size).max(0.0))
        };
        let (x, y) = (range(0, w), range(1, h));
        let share = |k: usize| k as f64 / STEPS as f64;
        let mut places: Vec<[usize; 2]> =
            (0..=STEPS).flat_map(|i| (0..=STEPS).map(move |j| [i, j])).collect();
        let off = |&[i, j]: &[usize; 2]| {
            let (dx, dy) = (share(i) - wish.along, share(j) - wish.up);
            dx * dx + dy * dy
        };
        places.sort_by(|a, b| off(a).total_cmp(&off(b)));
        let corner = |[i, j]: [usize; 2]| [x.0 + x.1 * share(i), y.0 + y.1 * share(j)];
        places.into_iter().map(corner).find(|&[u, v]| self.is_free([u, v, u + w, v + h]))
    }

    fn is_free(&self, [x0, y0, x1, y1]: [f64; 4]) -> bool {
        let apart = |t: &[f64; 4]| {
            x1 + GAP < t[0] || t[2] + GAP < x0 || y1 + GAP < t[1] || t[3] + GAP < y0
        };
        let inside = |u: f64, v: f64| {
            let p = self.origin + self.along * u + self.up * v;
            self.sides.iter().all(|(inward, least)| inward.dot(&p.coords) >= *least)
        };
        let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)];
        self.taken.iter().all(apart) && corners.into_iter().all(|(u, v)| inside(u, v))
    }
}

/// How far from the axis at a place the fin beside it is free of cuts.
fn clear(
    piece: &Piece,
    place: usize,
    at_end: bool,
    side: usize,
    wall: impl Fn(&Slit) -> f64,
) -> f64 {
    let slit = piece.slits.get(&place).map_or(0.0, wall);
    if at_end { slit.max(piece.closures[side].setback()) } else { slit }
}
