//! Outlines that no layout could be checked with, and what can be made of some.
//!
//! Programs draw small loops at inner corners so that the laser burns those out: lines that
//! cross or touch themselves, of which only the edge around them matters.

use crate::geometry::predicates::{contains, in_segment, is_simple, segments_meet};
use crate::geometry::ring::area;
use crate::geometry::{Point2, Rect};
use crate::nest::triangulation::Triangulation;
use crate::nest::{Layout, NestError, NestedSheet, Shape, Stock, check};
use crate::tolerance::NEST_LOOPS;

/// Largest coordinate, mm: beyond, rounding to 1e-6 mm means nothing.
const FARTHEST: f64 = 1e6;

/// Why a shape cannot be nested, if it cannot.
pub fn outline_fault(shape: &Shape) -> Option<NestError> {
    fault(&shape.outline, &shape.holes)
        .map(|why| NestError::BadOutline { name: shape.name.clone(), why })
}

/// Why no layout could be checked with such an outline and its holes, if none could.
pub(super) fn fault(outline: &Vec<Point2>, holes: &[Vec<Point2>]) -> Option<String> {
    let rings = || std::iter::once(outline).chain(holes);
    let mut corners = rings().flatten();
    if corners.any(|p| !(p.x.abs() <= FARTHEST && p.y.abs() <= FARTHEST)) {
        return Some("a coordinate is beyond 1,000,000 mm".into());
    }
    if rings().any(|ring| ring.len() < 3) {
        return Some("it has fewer than three corners".into());
    }
    if rings().any(|ring| area(ring) <= 0.0) {
        return Some("it has no area".into());
    }
    if !rings().all(|ring| is_simple(ring)) {
        return Some("a line crosses or touches itself".into());
    }
    let rings: Vec<_> = rings().collect();
    let edges = |k: usize| rings[k].iter().zip(rings[k].iter().cycle().skip(1));
    for hole in 1..rings.len() {
        let p = rings[hole][0];
        let at = format!("hole {hole} at ({:.3}, {:.3})", p.x, p.y);
        if !contains(rings[0], p) {
            return Some(format!("{at} is outside of it"));
        }
        let others = (1..rings.len()).filter(|&other| other != hole);
        if let Some(other) = others.into_iter().find(|&k| contains(rings[k], p)) {
            return Some(format!("{at} is inside of hole {other}"));
        }
        let bounds = Rect::around(rings[hole]);
        for other in 0..hole {
            let near =
                edges(other).filter(|(a, b)| Rect::around([*a, *b]).touches(&bounds));
            if near
                .into_iter()
                .any(|(a, b)| edges(hole).any(|(c, d)| segments_meet(*a, *b, *c, *d)))
            {
                return Some(format!("{at} crosses or touches another line"));
            }
        }
    }
    None
}

/// What keeps the stock from being used: a remnant with impossible edges, or locked parts
/// that overlap or lie outside.
pub fn stock_fault(shapes: &[Shape], stock: &[Stock]) -> Option<NestError> {
    let bad_remnant = |(k, stock): (usize, &Stock)| {
        let remnant = stock.remnant.as_ref()?;
        let why = fault(&remnant.outline, &remnant.holes).or_else(|| {
            let Rect { min: low, max: high } = Rect::around(&remnant.outline);
            let fits = low.x >= 0.0 && low.y >= 0.0;
            let fits = fits && high.x <= stock.width && high.y <= stock.height;
            (!fits).then(|| "it reaches beyond its width and height".into())
        });
        why.map(|why| NestError::BadRemnant { sheet: k + 1, why })
    };
    let bad = stock.iter().enumerate().find_map(bad_remnant);
    bad.or_else(|| {
        let sheet = |(stock, s): (usize, &Stock)| NestedSheet {
            stock,
            placements: s.locked.clone(),
        };
        let sheets = stock.iter().enumerate().map(sheet).collect();
        let fault = check(&Layout { sheets }, shapes, stock).into_iter().next()?;
        Some(NestError::BadPlacement { fault: fault.to_string() })
    })
}

/// Cut points are rounded, so lines that were cut may cross anew.
const ROUNDS: usize = 3;

/// The edge of all that a closed line runs around, if it is one closed line but for small
/// loops; as it is if it neither crosses nor touches itself. Of an outline all loops must
/// lie inside of that edge; those of a hole may lie outside, in the material.
pub fn without_loops(ring: &[Point2], is_hole: bool) -> Option<Vec<Point2>> {
    if is_simple(ring) {
        return Some(ring.to_vec());
    }
    let mut links = links(ring);
    for _ in 0..ROUNDS {
        links = cut(&links);
        if let Some(triangulation) = Triangulation::linked(&links) {
            return edge(&triangulation, area(ring), is_hole);
        }
    }
    None
}

/// Edges from corner to corner, none of them twice.
fn links(ring: &[Point2]) -> Vec<[Point2; 2]> {
    let next = ring.iter().cycle().skip(1);
    let links = ring.iter().zip(next).map(|(&a, &b)| [a, b]);
    links.filter(|[a, b]| a != b).collect()
}

/// The largest ring around what cannot be reached from outside.
fn edge(triangulation: &Triangulation, drawn: f64, is_hole: bool) -> Option<Vec<Point2>> {
    let outside = triangulation.flooded(|edge, _| (!edge.fixed).then_some(false)).0;
    let rings = triangulation.rings(|face| !outside[face]);
    let mut rings: Vec<Vec<Point2>> = rings.into_iter().flat_map(parted).collect();
    rings.sort_by(|a, b| area(b).total_cmp(&area(a)));
    let is_one = rings.len() == 1 || is_hole;
    let largest = rings.into_iter().next()?;
    let is_small = (area(&largest) - drawn).abs() <= NEST_LOOPS * drawn;
    (is_one && is_small && is_simple(&largest)).then_some(largest)
}

/// A closed line in parts that visit each corner once.
fn parted(ring: Vec<Point2>) -> Vec<Vec<Point2>> {
    let (mut way, mut parts): (Vec<Point2>, Vec<Vec<Point2>>) = (Vec::new(), Vec::new());
    for p in ring {
        if let Some(at) = way.iter().position(|q| *q == p) {
            parts.push(way.split_off(at));
        }
        way.push(p);
    }
    parts.push(way);
    parts.retain(|part| part.len() > 2);
    parts
}

/// All edges cut where they meet others.
fn cut(links: &[[Point2; 2]]) -> Vec<[Point2; 2]> {
    let meets = |&[a, b]: &[Point2; 2], &[c, d]: &[Point2; 2]| {
        let near = Rect::around(&[a, b]).touches(&Rect::around(&[c, d]));
        near && segments_meet(a, b, c, d)
    };
    let mut all = Vec::new();
    for link in links {
        let [a, b] = *link;
        let others = links.iter().filter(|other| *other != link && meets(link, other));
        let mut on: Vec<Point2> =
            others.flat_map(|other| common(*link, *other)).collect();
        on.extend([a, b]);
        on.sort_by(|p, q| (p - a).norm_squared().total_cmp(&(q - a).norm_squared()));
        on.dedup();
        all.extend(on.windows(2).map(|pair| [pair[0], pair[1]]));
    }
    all
}

/// Points of an edge at which another that meets it touches or crosses it.
fn common([a, b]: [Point2; 2], [c, d]: [Point2; 2]) -> Vec<Point2> {
    let touching: Vec<Point2> =
        [c, d].into_iter().filter(|p| in_segment(a, b, *p)).collect();
    if !touching.is_empty() || [a, b].iter().any(|p| in_segment(c, d, *p)) {
        return touching;
    }
    // The same point for both, whichever is asked.
    let key = |p: Point2, q: Point2| [p.x, p.y, q.x, q.y];
    let ([a, b], [c, d]) =
        if key(a, b) < key(c, d) { ([a, b], [c, d]) } else { ([c, d], [a, b]) };
    let (way, other) = (b - a, d - c);
    let share = (c - a).perp(&other) / way.perp(&other);
    if share.is_finite() { vec![a + way * share.clamp(0.0, 1.0)] } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::trig;

    fn ring(corners: &[(f64, f64)]) -> Vec<Point2> {
        corners.iter().map(|&(x, y)| Point2::new(x, y)).collect()
    }

    /// A notch whose inner corners are burnt out by loops, one of which crosses the line.
    const NOTCHED: [(f64, f64); 15] = [
        (0.0, 0.0),
        (100.0, 0.0),
        (100.0, 50.0),
        (60.0, 50.0),
        (60.0, 30.0),
        (60.1, 29.9),
        (60.0, 29.9),
        (60.0, 30.0),
        (40.0, 30.0),
        (39.9, 30.0),
        (39.9, 29.9),
        (40.0, 29.9),
        (40.0, 50.0),
        (0.0, 50.0),
        (0.0, 25.0),
    ];

    #[test]
    fn loops_at_inner_corners_are_left_out_of_an_outline() {
        let drawn = ring(&NOTCHED);
        assert!(!is_simple(&drawn));
        let outline = without_loops(&drawn, false).expect("only small loops");
        assert!(is_simple(&outline));
        assert!((area(&outline) - 4600.0).abs() < 0.02, "{}", area(&outline));
    }

    #[test]
    fn loops_of_a_hole_stay_in_the_material_and_large_ones_are_refused() {
        // Around the notch as a hole the same loops lie outside of it.
        let hole = ring(&[
            (10.0, 10.0),
            (30.0, 10.0),
            (30.1, 10.0),
            (30.1, 9.9),
            (30.0, 10.0),
            (30.0, 20.0),
            (10.0, 20.0),
        ]);
        let free = without_loops(&hole, true).expect("only small loops");
        assert!((area(&free) - 200.0).abs() < 0.01);
        assert!(without_loops(&hole, false).is_none(), "a loop outside of an outline");
        let bow_tie = ring(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]);
        assert!(
            without_loops(&bow_tie, false).is_none()
                && without_loops(&bow_tie, true).is_none()
        );
        let turns = (0..5).map(|k| f64::from(k) * 4.0 * std::f64::consts::PI / 5.0);
        let star: Vec<Point2> =
            turns.map(|angle| Point2::new(trig::cos(angle), trig::sin(angle))).collect();
        assert!(without_loops(&star, false).is_none());
    }
}
