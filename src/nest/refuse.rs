//! Shapes that no layout could be checked with.

use crate::geometry::Point2;
use crate::geometry::predicates::{contains, is_simple, segments_meet};
use crate::nest::check::bounds;
use crate::nest::pieces::area;
use crate::nest::{NestError, Shape};

/// Largest coordinate, mm: beyond, rounding to 1e-6 mm means nothing.
const FARTHEST: f64 = 1e6;

/// Why a shape cannot be nested, if it cannot.
pub fn refused(shape: &Shape) -> Option<NestError> {
    why(&shape.outline, &shape.holes)
        .map(|why| NestError::BadOutline { name: shape.name.clone(), why })
}

/// Why no layout could be checked with such an outline and its holes, if none could.
pub(super) fn why(outline: &Vec<Point2>, holes: &[Vec<Point2>]) -> Option<&'static str> {
    let rings = || std::iter::once(outline).chain(holes);
    let mut corners = rings().flatten();
    if corners.any(|p| !(p.x.abs() <= FARTHEST && p.y.abs() <= FARTHEST)) {
        return Some("a coordinate is beyond 1,000,000 mm");
    }
    if rings().any(|ring| ring.len() < 3) {
        return Some("it has fewer than three corners");
    }
    if rings().any(|ring| area(ring) <= 0.0) {
        return Some("it has no area");
    }
    if !rings().all(|ring| is_simple(ring)) {
        return Some("a line crosses or touches itself");
    }
    let rings: Vec<_> = rings().collect();
    let edges = |k: usize| rings[k].iter().zip(rings[k].iter().cycle().skip(1));
    for hole in 1..rings.len() {
        if !contains(rings[0], rings[hole][0]) {
            return Some("a hole is outside of it");
        }
        let (low, high) = bounds(rings[hole]);
        for other in 0..hole {
            let near = edges(other).filter(|(a, b)| {
                let (l, h) = (a.inf(b), a.sup(b));
                l.x <= high.x && low.x <= h.x && l.y <= high.y && low.y <= h.y
            });
            if near
                .into_iter()
                .any(|(a, b)| edges(hole).any(|(c, d)| segments_meet(*a, *b, *c, *d)))
            {
                return Some("a hole crosses or touches another line");
            }
        }
    }
    None
}
