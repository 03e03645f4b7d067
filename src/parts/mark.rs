//! What is written on a strip: its name, an arrow up, node numbers beside the slits, folds.
//!
//! Everything stays inside the *cell* of a fin, the quadrilateral between the walls of
//! its slits and the strip's edges, so that no letter lies across a cut. What does not
//! fit is written smaller, then upright, then left out.

use crate::geometry::{Point2, Vector2};
use crate::ids::NodeId;
use crate::lettering::{letter, width};
use crate::parts::lap::join::{Opening, Slit};
use crate::parts::outline::{Closure, Piece};
use crate::parts::part::{Mark, MarkKind};
use crate::parts::unfold::{FlatAxis, Fold};

/// What becomes of the lines along which a strip folds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FoldMarks {
    /// Nothing is drawn.
    None,
    /// A line is engraved.
    Engrave,
    /// A line is scored, to fold along.
    Score,
}

/// How parts are marked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marking {
    /// Height of capital letters, mm.
    pub height: f64,
    /// Fold lines.
    pub folds: FoldMarks,
}

/// Least distance between a mark and a cut, mm.
pub(crate) const GAP: f64 = 1.0;

/// The name is repeated after this many fins.
const NAME_EVERY: usize = 6;

/// All marks of one piece of a strip.
pub(crate) fn marks(
    piece: &Piece,
    name: &str,
    folds: &[Fold],
    marking: Marking,
) -> Vec<Mark> {
    let mut marks = Vec::new();
    let whole = piece;
    let piece = &between_notches(with_a_fin(piece));
    let last = piece.axes.len() - 1;
    for fin in 0..last {
        let mut cell = Cell::new(piece, fin);
        let mut write = |text: &str, wish: Wish| {
            if let Some(strokes) = cell.write(text, wish, marking.height) {
                marks.push(Mark { kind: MarkKind::Engrave, strokes });
            }
        };
        write(&node_text(piece.axes[fin].node), beside(piece, fin, Side::Left));
        if fin + 1 == last && piece.axes[fin].node != piece.axes[last].node {
            write(&node_text(piece.axes[last].node), beside(piece, last, Side::Right));
            // Only beside a splice does a piece end on a fold.
            if let Some(text) = fold_at(piece, folds, last) {
                write(&text, across_from(beside(piece, last, Side::Right)));
            }
        }
        if fin % NAME_EVERY == 0 || fin + 1 == last {
            write(&format!("{name}\u{2191}"), Wish { along: 0.5, up: 0.5 });
        }
        if let Some(text) = fold_at(piece, folds, fin) {
            write(&text, across_from(beside(piece, fin, Side::Left)));
        }
    }
    marks.extend(fold_lines(whole, folds, marking.folds));
    marks
}

/// A piece of one node between splices has no whole fin to write on: it gets the rest of
/// one, a short way from its axis toward the next, where no dovetail reaches.
fn with_a_fin(piece: &Piece) -> Piece {
    const WAY: f64 = 0.2;
    let [axis] = piece.axes[..] else { return piece.clone() };
    let toward = |next: &FlatAxis| {
        let between = |from: f64, to: f64| from + (to - from) * WAY;
        FlatAxis {
            node: axis.node,
            foot: axis.foot + (next.foot - axis.foot) * WAY,
            up: (axis.up + (next.up - axis.up) * WAY).normalize(),
            below: between(axis.below, next.below),
            above: between(axis.above, next.above),
        }
    };
    let mut piece = piece.clone();
    match piece.beyond {
        [_, Some(right)] => piece.axes.push(toward(&right)),
        [Some(left), None] => {
            piece.axes.insert(0, toward(&left));
            piece.slits = piece.slits.into_values().map(|slit| (1, slit)).collect();
        }
        [None, None] => {}
    }
    piece
}

/// A piece whose held ends are only as high as their notches leave.
fn between_notches(mut piece: Piece) -> Piece {
    let last = piece.axes.len() - 1;
    for (closure, place) in piece.closures.iter().zip([0, last]) {
        let Closure::Held(held) = closure else { continue };
        let ([low, high], axis) = (held.heights, &mut piece.axes[place]);
        (axis.below, axis.above) = (axis.below.min(-low), axis.above.min(high));
    }
    piece
}

/// A node number; one that reads as another upside down ends in a full stop.
fn node_text(node: NodeId) -> String {
    let text = node.to_string();
    let turns_over =
        text.contains(['6', '9']) && text.chars().all(|c| "01689".contains(c));
    if turns_over { text + "." } else { text }
}

/// The fold at a place, as text.
fn fold_at(piece: &Piece, folds: &[Fold], place: usize) -> Option<String> {
    let node = piece.axes[place].node;
    folds.iter().find(|fold| fold.node == node).and_then(fold_text)
}

/// A fold in degrees with its sign, unless it is none.
fn fold_text(fold: &Fold) -> Option<String> {
    let degrees = fold.angle.to_degrees();
    (degrees.abs() >= 0.05).then(|| format!("{degrees:+.1}\u{b0}"))
}

#[derive(Clone, Copy)]
enum Side {
    Left,
    Right,
}

/// Where in its cell a text would best stand: shares of the cell along the fin and up.
#[derive(Clone, Copy)]
pub(crate) struct Wish {
    pub along: f64,
    pub up: f64,
}

/// At the other edge.
const fn across_from(wish: Wish) -> Wish {
    Wish { along: wish.along, up: 1.0 - wish.up }
}

/// Beside the mouth of the slit at a place.
fn beside(piece: &Piece, place: usize, side: Side) -> Wish {
    let from_top = piece.slits.get(&place).is_some_and(|slit| slit.from == Opening::Top);
    Wish {
        along: match side {
            Side::Left => 0.0,
            Side::Right => 1.0,
        },
        up: if from_top { 1.0 } else { 0.0 },
    }
}

/// Lines along the axes at which the strip folds, where no slit is.
fn fold_lines<'a>(
    piece: &'a Piece,
    folds: &'a [Fold],
    how: FoldMarks,
) -> impl Iterator<Item = Mark> + 'a {
    let kind = match how {
        FoldMarks::None => None,
        FoldMarks::Engrave => Some(MarkKind::Engrave),
        FoldMarks::Score => Some(MarkKind::Score),
    };
    let inset = GAP / 2.0;
    piece.axes.iter().enumerate().filter_map(move |(place, axis)| {
        let kind = kind?;
        folds.iter().find(|fold| fold.node == axis.node).and_then(fold_text)?;
        let (mut low, mut high) = (-axis.below + inset, axis.above - inset);
        if let Some(slit) = piece.slits.get(&place) {
            // The relief lies beyond the slit's depth.
            let depth = slit.depth + slit.width().min(2.0) / 2.0 + inset;
            match slit.from {
                Opening::Top => high = axis.above - depth,
                Opening::Bottom => low = depth - axis.below,
            }
        }
        let line = vec![axis.foot + axis.up * low, axis.foot + axis.up * high];
        (high > low).then_some(Mark { kind, strokes: vec![line] })
    })
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
