//! Contours moved sideways: true offsets, never loops.

use crate::geometry::contour::{Contour, Segment, Vertex};
use crate::geometry::{Point2, Vector2, trig};

/// A corner may move this many times the offset before it is cut off square.
const MITRE_LIMIT: f64 = 5.0;

/// The contour moved to its right by `distance` (outward if it runs counter-clockwise),
/// corners mitred. Arcs that would vanish become corners first.
///
/// Arcs must meet their neighbours without a corner, or the corner is only approximate.
/// The result may cross itself where the contour is narrower than twice the distance; ask
/// [`is_simple`](super::predicates::is_simple).
/// ```
/// use finwright::geometry::{Contour, Point2, offset::offset};
///
/// let square = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
/// let square = Contour::polygon(square.map(|(x, y)| Point2::new(x, y)));
/// assert_eq!(offset(&square, 0.5).signed_area(), 121.0);
/// ```
pub fn offset(contour: &Contour, distance: f64) -> Contour {
    let contour = without_vanishing_arcs(contour, distance);
    let segments: Vec<Segment> = contour.segments().collect();
    let count = segments.len();
    let mut vertices = Vec::with_capacity(count);
    for k in 0..count {
        let (before, after) = (&segments[(k + count - 1) % count], &segments[k]);
        let corner =
            offset_corner(after.from, tangents(before).1, tangents(after).0, distance);
        vertices.extend(corner.into_iter().map(Vertex::line));
        if let Some(last) = vertices.last_mut() {
            last.bulge = after.bulge;
        }
    }
    Contour { vertices }
}

/// An open chain of straight lines moved to its right by `distance`, corners mitred.
pub fn offset_chain(chain: &[Point2], distance: f64) -> Vec<Point2> {
    let ways: Vec<Vector2> =
        chain.windows(2).map(|w| (w[1] - w[0]).normalize()).collect();
    let corner = |k: usize| {
        let before = ways[k.saturating_sub(1)];
        let after = ways[k.min(ways.len() - 1)];
        offset_corner(chain[k], before, after, distance)
    };
    (0..chain.len()).flat_map(corner).collect()
}

/// A chain of straight lines with its inner corners rounded.
pub fn rounded(chain: &[Point2], radii: &[f64]) -> Vec<Vertex> {
    let mut vertices = Vec::new();
    for k in 0..chain.len() {
        if k == 0 || k + 1 == chain.len() || radii[k] <= 0.0 {
            vertices.push(Vertex::line(chain[k]));
            continue;
        }
        let (before, after) = (chain[k] - chain[k - 1], chain[k + 1] - chain[k]);
        let turn = trig::atan2(before.perp(&after), before.dot(&after));
        let half = trig::tan(turn.abs() / 2.0);
        let reach = (radii[k] * half).min(before.norm() / 2.0).min(after.norm() / 2.0);
        let start = chain[k] - before.normalize() * reach;
        vertices.push(Vertex::arc(start, trig::tan(turn / 4.0)));
        vertices.push(Vertex::line(chain[k] + after.normalize() * reach));
    }
    vertices
}

/// Unit directions in which a segment starts and ends.
fn tangents(segment: &Segment) -> (Vector2, Vector2) {
    let chord = (segment.to - segment.from).normalize();
    let half = 2.0 * trig::atan(segment.bulge);
    (turned(chord, -half), turned(chord, half))
}

fn turned(v: Vector2, angle: f64) -> Vector2 {
    let (sin, cos) = (trig::sin(angle), trig::cos(angle));
    Vector2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}

fn offset_corner(
    at: Point2,
    before: Vector2,
    after: Vector2,
    distance: f64,
) -> Vec<Point2> {
    let right = |way: Vector2| Vector2::new(way.y, -way.x);
    let (a, b) = (right(before), right(after));
    let share = 1.0 + a.dot(&b);
    let outer = before.perp(&after) * distance > 0.0;
    if share * MITRE_LIMIT * MITRE_LIMIT < 2.0 && (outer || share <= 0.0) {
        return vec![at + a * distance, at + b * distance];
    }
    vec![at + (a + b) * (distance / share)]
}

/// Replaces arcs that the offset would turn inside out by the corner of their tangents. Their
/// ends go too: the offset corner may lie beyond them, and the line would run back.
fn without_vanishing_arcs(contour: &Contour, distance: f64) -> Contour {
    let vanishes = |segment: &Segment| {
        let shrinks = segment.bulge * distance < 0.0;
        let arc = segment.arc().filter(|_| shrinks)?;
        let reach = arc.radius * trig::tan(arc.sweep.abs() / 2.0);
        let corner = segment.from + tangents(segment).0 * reach;
        (arc.radius <= distance.abs() * 1.001).then_some(corner)
    };
    let segments: Vec<Segment> = contour.segments().collect();
    let corners: Vec<Option<Point2>> = segments.iter().map(vanishes).collect();
    let count = segments.len();
    let mut vertices = Vec::with_capacity(count);
    for (k, segment) in segments.iter().enumerate() {
        let before = (k + count - 1) % count;
        let is_kept = match (corners[before], corners[k]) {
            (None, None) => true,
            (Some(_), Some(_)) => false,
            (None, Some(_)) => segments[before].bulge != 0.0,
            (Some(_), None) => segment.bulge != 0.0,
        };
        if is_kept {
            let bulge = if corners[k].is_some() { 0.0 } else { segment.bulge };
            vertices.push(Vertex::arc(segment.from, bulge));
        }
        vertices.extend(corners[k].map(Vertex::line));
    }
    Contour { vertices }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Contour {
        Contour::polygon(
            [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]
                .map(|(x, y)| Point2::new(x, y)),
        )
    }

    #[test]
    fn a_square_grows_by_the_offset_on_each_side() {
        assert!((offset(&square(), 0.5).signed_area() - 25.0).abs() < 1e-12);
        assert!((offset(&square().reversed(), 0.5).signed_area() + 9.0).abs() < 1e-12);
    }

    #[test]
    fn a_hole_with_corners_rounder_than_the_offset_gets_sharp_ones() {
        // Found by fuzzing: a relief smaller than half the kerf made the line run back.
        let ring =
            [(0.0, 0.0), (0.0, 4.0), (4.0, 4.0), (4.0, 0.0), (0.0, 0.0), (0.0, 2.0)];
        let ring = ring.map(|(x, y)| Point2::new(x, y));
        let mut vertices = rounded(&ring, &[0.0, 0.1, 0.1, 0.1, 0.1, 0.0]);
        vertices.remove(0);
        vertices.pop();
        let shrunk = offset(&Contour { vertices }, 0.5);
        assert!(crate::geometry::predicates::is_simple(&shrunk.flattened(0.01)));
        assert!((shrunk.signed_area() + 9.0).abs() < 1e-12, "{}", shrunk.signed_area());
    }

    #[test]
    fn a_rounded_corner_keeps_its_centre() {
        let chain = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0)].map(|(x, y)| Point2::new(x, y));
        let corner = rounded(&chain, &[0.0, 1.0, 0.0]);
        let mut vertices = corner;
        vertices.push(Vertex::line(Point2::new(0.0, 4.0)));
        let contour = Contour { vertices };
        let grown = offset(&contour, 0.5);
        let arc = |c: &Contour| c.segments().find_map(|s| s.arc());
        let (before, after) = (arc(&contour).unwrap(), arc(&grown).unwrap());
        assert!((before.center - after.center).norm() < 1e-12);
        assert!((after.radius - 1.5).abs() < 1e-12);
    }
}
