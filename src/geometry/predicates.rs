//! Which side, and do they cross: exact answers on `f64` coordinates.

use crate::geometry::Point2;

/// Side of `c` as seen walking from `a` to `b`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// To the left: the three points turn counter-clockwise.
    Left,
    /// To the right.
    Right,
    /// Exactly on the line.
    On,
}

/// On which side of the line `a`–`b` the point `c` lies, exactly.
pub fn side(a: Point2, b: Point2, c: Point2) -> Side {
    let coord = |p: Point2| robust::Coord { x: p.x, y: p.y };
    let turn = robust::orient2d(coord(a), coord(b), coord(c));
    if turn > 0.0 {
        Side::Left
    } else if turn < 0.0 {
        Side::Right
    } else {
        Side::On
    }
}

/// Whether a polygon contains a point, exactly (crossings of a ray to the right).
pub fn contains(ring: &[Point2], p: Point2) -> bool {
    let edges = ring.iter().zip(ring.iter().cycle().skip(1));
    let crossed = edges.filter(|(a, b)| {
        let upward = a.y <= p.y && p.y < b.y;
        let downward = b.y <= p.y && p.y < a.y;
        (upward && side(**a, **b, p) == Side::Left)
            || (downward && side(**a, **b, p) == Side::Right)
    });
    crossed.count() % 2 == 1
}

/// Whether the closed segments `a`–`b` and `c`–`d` share a point, exactly.
pub fn segments_meet(a: Point2, b: Point2, c: Point2, d: Point2) -> bool {
    let (sc, sd) = (side(a, b, c), side(a, b, d));
    let (sa, sb) = (side(c, d, a), side(c, d, b));
    let on_cd = |p, s| s == Side::On && in_box(c, d, p);
    let on_ab = |p, s| s == Side::On && in_box(a, b, p);
    if on_cd(a, sa) || on_cd(b, sb) || on_ab(c, sc) || on_ab(d, sd) {
        return true;
    }
    let apart = |p: Side, q: Side| {
        matches!((p, q), (Side::Left, Side::Right) | (Side::Right, Side::Left))
    };
    apart(sc, sd) && apart(sa, sb)
}

/// Whether a closed polygon neither crosses nor touches itself, exactly; one with a corner
/// that is no number is none.
pub fn is_simple(polygon: &[Point2]) -> bool {
    let count = polygon.len();
    let end = |k: usize| polygon[(k + 1) % count];
    let is_number = |p: &Point2| p.x.is_finite() && p.y.is_finite();
    if count < 3
        || !polygon.iter().all(is_number)
        || (0..count).any(|k| polygon[k] == end(k))
    {
        return false;
    }
    let mut order: Vec<usize> = (0..count).collect();
    let left = |k: usize| polygon[k].x.min(end(k).x);
    order.sort_by(|&a, &b| left(a).total_cmp(&left(b)));
    let mut open: Vec<usize> = Vec::new();
    for &k in &order {
        open.retain(|&other| polygon[other].x.max(end(other).x) >= left(k));
        let clashes = open.iter().any(|&other| match () {
            () if (other + 1) % count == k => {
                folds_back(polygon[other], polygon[k], end(k))
            }
            () if (k + 1) % count == other => {
                folds_back(polygon[k], polygon[other], end(other))
            }
            () => segments_meet(polygon[k], end(k), polygon[other], end(other)),
        });
        if clashes {
            return false;
        }
        open.push(k);
    }
    true
}

/// Whether the way from `a` over `b` to `c` runs back over itself.
fn folds_back(a: Point2, b: Point2, c: Point2) -> bool {
    side(a, b, c) == Side::On && (b - a).dot(&(c - b)) < 0.0
}

/// Whether `p` lies on the closed segment `a`–`b`, exactly.
pub fn in_segment(a: Point2, b: Point2, p: Point2) -> bool {
    side(a, b, p) == Side::On && in_box(a, b, p)
}

fn in_box(a: Point2, b: Point2, p: Point2) -> bool {
    a.x.min(b.x) <= p.x
        && p.x <= a.x.max(b.x)
        && a.y.min(b.y) <= p.y
        && p.y <= a.y.max(b.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn touching_segments_meet_and_parallel_ones_do_not() {
        let p = Point2::new;
        assert!(segments_meet(p(0.0, 0.0), p(2.0, 0.0), p(1.0, 0.0), p(1.0, 5.0)));
        assert!(segments_meet(p(0.0, 0.0), p(2.0, 2.0), p(0.0, 2.0), p(2.0, 0.0)));
        assert!(!segments_meet(p(0.0, 0.0), p(2.0, 0.0), p(0.0, 1.0), p(2.0, 1.0)));
        assert!(!segments_meet(p(0.0, 0.0), p(1.0, 0.0), p(2.0, 0.0), p(3.0, 0.0)));
    }

    #[test]
    fn a_square_is_simple_and_a_bow_tie_is_not() {
        let p = Point2::new;
        let square = [p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)];
        let bow_tie = [p(0.0, 0.0), p(1.0, 1.0), p(1.0, 0.0), p(0.0, 1.0)];
        assert!(is_simple(&square));
        assert!(!is_simple(&bow_tie));
    }
}
