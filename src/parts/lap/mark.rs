//! What is written on a strip: its name, an arrow up, node numbers beside the slits, folds.

use crate::ids::NodeId;
use crate::parts::cell::{Cell, Wish};
use crate::parts::mark::{GAP, Mark, MarkKind, Marking};
use crate::parts::outline::{Closure, Piece};
use crate::parts::slit::Opening;
use crate::parts::unfold::{FlatAxis, Fold};

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
    kind: Option<MarkKind>,
) -> impl Iterator<Item = Mark> + 'a {
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
