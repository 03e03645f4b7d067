//! From a part's true outline to the convex pieces that the search works on.
//!
//! The Delaunay triangulation (`spade`) of outline and holes is flooded from outside,
//! through edges longer than a *gate*: slits and pockets that nothing could enter are
//! filled. That only ever enlarges the part, so it is always safe. What is solid is
//! simplified outward and cut into convex pieces: triangles merged greedily while they
//! stay convex (Hertel and Mehlhorn 1983).

use crate::geometry::predicates::{Side, side};
use crate::geometry::ring::area;
use crate::geometry::{Point2, Rect};
use crate::nest::triangulation::{Edge, Triangulation};
use crate::tolerance::NEST_SIMPLIFY;

/// Convex pieces, counter-clockwise, that cover the region; `None` if its rings cross.
pub(super) fn convex_decomposition(
    outline: &[Point2],
    holes: &[Vec<Point2>],
    gate: f64,
) -> Option<Vec<Vec<Point2>>> {
    let mut rings = vec![outline.to_vec()];
    rings.extend(open_holes(holes, gate).cloned());
    let closed = Triangulation::new(&rings)?.closed(gate);
    let simpler: Vec<Vec<Point2>> = closed.iter().map(|ring| simplified(ring)).collect();
    let triangulation =
        Triangulation::new(&simpler).or_else(|| Triangulation::new(&closed))?;
    let pieces = triangulation.convex();
    (!pieces.is_empty()).then_some(pieces)
}

/// The holes that a part might lie in.
pub(super) fn open_holes(
    holes: &[Vec<Point2>],
    gate: f64,
) -> impl Iterator<Item = &Vec<Point2>> {
    holes.iter().filter(move |hole| mean_width(hole) > gate)
}

/// Twice the area over half the length around: the width of a long thin shape.
pub(super) fn mean_width(ring: &[Point2]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    let around: f64 = ring.iter().zip(next).map(|(a, b)| (b - a).norm()).sum();
    if around > 0.0 { 2.0 * area(ring) / around } else { 0.0 }
}

impl Triangulation {
    /// The rings of the region with pockets behind gates filled.
    fn closed(&self, gate: f64) -> Vec<Vec<Point2>> {
        let enter = |edge: &Edge, _| (!edge.fixed && edge.length > gate).then_some(false);
        let reached = self.flooded(enter).0;
        let touched = self.beside_outline();
        let solid = |face: usize| {
            face != 0 && (self.inside[face] || (!reached[face] && touched[face]))
        };
        self.rings(solid)
    }

    /// Faces outside the region that hang together with the hull's outside; the others are
    /// open holes.
    fn beside_outline(&self) -> Vec<bool> {
        self.flooded(|edge, _| (!edge.fixed).then_some(false)).0
    }

    fn convex(&self) -> Vec<Vec<Point2>> {
        let mut polygons: Vec<Vec<usize>> = self.faces.clone();
        let mut owner: Vec<usize> = (0..polygons.len()).collect();
        let mut edges: Vec<&Edge> = self.edges.iter().collect();
        edges.sort_by(|a, b| b.length.total_cmp(&a.length));
        for edge in edges {
            let [left, right] = edge.faces.map(|face| root(&owner, face));
            let solid = edge.faces.iter().all(|&face| self.inside[face]);
            if !solid || left == right {
                continue;
            }
            let merged = self.merged(&polygons[left], &polygons[right], edge.ends);
            if let Some(merged) = merged {
                polygons[left] = merged;
                polygons[right].clear();
                owner[right] = left;
            }
        }
        let kept = (1..polygons.len()).filter(|&face| self.inside[face]);
        let kept = kept.filter(|&face| owner[face] == face);
        kept.map(|face| polygons[face].iter().map(|&k| self.points[k]).collect())
            .collect()
    }

    /// Both polygons as one if that is convex; the first has the edge `a` to `b`.
    fn merged(
        &self,
        left: &[usize],
        right: &[usize],
        [a, b]: [usize; 2],
    ) -> Option<Vec<usize>> {
        let at = left.iter().position(|&k| k == b)?;
        let from = right.iter().position(|&k| k == a)?;
        let mut whole: Vec<usize> =
            left[at..].iter().chain(&left[..at]).copied().collect();
        let seam = whole.len() - 1;
        let rest = right[from..].iter().chain(&right[..from]).copied();
        let rest: Vec<usize> = rest.skip(1).collect();
        if whole[seam] != a || rest.last() != Some(&b) {
            return None;
        }
        whole.extend(&rest[..rest.len() - 1]);
        let count = whole.len();
        let bends_left = |k: usize| {
            let [p, q, r] =
                [k + count - 1, k, k + 1].map(|k| self.points[whole[k % count]]);
            match side(p, q, r) {
                Side::Left => true,
                Side::On => (q - p).dot(&(r - q)) > 0.0,
                Side::Right => false,
            }
        };
        (bends_left(0) && bends_left(seam)).then_some(whole)
    }
}

fn root(owner: &[usize], mut face: usize) -> usize {
    while owner[face] != face {
        face = owner[face];
    }
    face
}

/// A ring with fewer corners that covers at least as much: small dents are filled, and
/// two blunt corners become the one in which their outer edges meet.
fn simplified(ring: &[Point2]) -> Vec<Point2> {
    let diagonal = Rect::around(ring).size().norm();
    let slack = (NEST_SIMPLIFY * diagonal).min(crate::tolerance::NEST_SIMPLIFY_MM);
    let mut ring = ring.to_vec();
    let mut k = 0;
    let mut unchanged = 0;
    while unchanged < ring.len() && ring.len() > 4 {
        let count = ring.len();
        let [i, j] = [(k + 1) % count, (k + 2) % count];
        let [a, b, c, d] = [ring[k % count], ring[i], ring[j], ring[(k + 3) % count]];
        if is_small_dent(a, b, c, slack) {
            ring.remove(i);
            unchanged = 0;
        } else if let Some(tip) = joined(a, b, c, d, slack) {
            ring[i] = tip;
            ring.remove(j);
            unchanged = 0;
        } else {
            unchanged += 1;
        }
        k = (k + 1) % ring.len();
    }
    ring
}

fn is_small_dent(a: Point2, b: Point2, c: Point2, slack: f64) -> bool {
    let chord = c - a;
    let bend = (b - a).perp(&(c - b));
    bend <= 0.0 && -bend <= slack * chord.norm() && (b - a).dot(&(c - b)) > 0.0
}

/// Where the edges before and after `b`-`c` meet, if that is near.
fn joined(a: Point2, b: Point2, c: Point2, d: Point2, slack: f64) -> Option<Point2> {
    let (before, edge, after) = (b - a, c - b, d - c);
    if before.perp(&edge) <= 0.0 || edge.perp(&after) <= 0.0 {
        return None;
    }
    let share = edge.perp(&after) / before.perp(&after);
    let reach = before * share;
    let height = reach.perp(&edge) / edge.norm();
    (share.is_finite() && share > 0.0 && height.abs() <= slack).then(|| b + reach)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Vec<Point2> {
        points.iter().map(|&(x, y)| Point2::new(x, y)).collect()
    }

    fn covered(pieces: &[Vec<Point2>]) -> f64 {
        pieces.iter().map(|piece| area(piece)).sum()
    }

    #[test]
    fn a_slit_is_closed_and_a_wide_pocket_stays_open() {
        let notched = |w: f64| {
            ring(&[
                (0.0, 0.0),
                (100.0, 0.0),
                (100.0, 40.0),
                (50.0 + w, 40.0),
                (50.0 + w, 20.0),
                (50.0, 20.0),
                (50.0, 40.0),
                (0.0, 40.0),
            ])
        };
        assert!(
            (covered(&convex_decomposition(&notched(3.0), &[], 5.0).unwrap()) - 4000.0)
                .abs()
                < 1e-9
        );
        assert!(
            (covered(&convex_decomposition(&notched(30.0), &[], 5.0).unwrap()) - 3400.0)
                .abs()
                < 1e-9
        );
    }

    #[test]
    fn a_wide_hole_stays_open_and_a_bore_is_closed() {
        let square = |a: f64, b: f64| ring(&[(a, a), (b, a), (b, b), (a, b)]);
        let outline = square(0.0, 100.0);
        let open = convex_decomposition(&outline, &[square(20.0, 80.0)], 5.0).unwrap();
        assert!((covered(&open) - 6400.0).abs() < 1e-9);
        let closed = convex_decomposition(&outline, &[square(49.0, 51.0)], 5.0).unwrap();
        assert_eq!(closed.len(), 1);
    }
}
