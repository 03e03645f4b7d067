//! Cubic Bézier curves as arcs and lines.

use crate::geometry::{Point2, Vector2};

/// Halvings at most: a curve across the largest sheet comes out finer than needed.
const DEEPEST: u32 = 12;

/// The curve as a chain of arcs or lines (end and bulge of each) that stay near it
/// within the tolerance.
pub(super) fn arcs(curve: [Point2; 4], tolerance: f64) -> Vec<(Point2, f64)> {
    let mut pieces = Vec::new();
    split(curve, tolerance, DEEPEST, &mut pieces);
    pieces
}

fn split(
    curve: [Point2; 4],
    tolerance: f64,
    depth: u32,
    pieces: &mut Vec<(Point2, f64)>,
) {
    let bulge = bulge(curve, tolerance);
    match bulge {
        Some(bulge) => pieces.push((curve[3], bulge)),
        None if depth == 0 => pieces.push((curve[3], 0.0)),
        None => {
            for half in halves(curve) {
                split(half, tolerance, depth - 1, pieces);
            }
        }
    }
}

/// The bulge of the arc that a Bézier curve is, if it is one.
fn bulge(curve: [Point2; 4], tolerance: f64) -> Option<f64> {
    if curve[0] == curve[3] {
        return curve.iter().all(|p| *p == curve[0]).then_some(0.0);
    }
    fitted([curve[0], curve[3]], &|share| at(curve, share), tolerance)
}

/// The bulge of the arc through a curve's ends and middle, if the curve is that arc.
fn fitted(
    [from, to]: [Point2; 2],
    at: &dyn Fn(f64) -> Point2,
    tolerance: f64,
) -> Option<f64> {
    let chord = to - from;
    let length = chord.norm();
    if length == 0.0 {
        return (at(0.5) == from).then_some(0.0);
    }
    let right = Vector2::new(chord.y, -chord.x) / length;
    let middle = from + chord / 2.0;
    let sagitta = (at(0.5) - middle).dot(&right);
    let bulge = 2.0 * sagitta / length;
    if bulge.abs() > 1.0 {
        return None;
    }
    let off = |share: f64| {
        let p = at(share) - middle;
        if sagitta.abs() < tolerance / 10.0 {
            return p.dot(&right).abs();
        }
        let radius = (length * length / 4.0 + sagitta * sagitta) / (2.0 * sagitta);
        ((p - right * (sagitta - radius)).norm() - radius.abs()).abs()
    };
    let near = [0.2, 0.35, 0.65, 0.8].into_iter().all(|share| off(share) < tolerance);
    near.then_some(bulge)
}

/// A smooth curve over 0 to 1 as a chain of arcs or lines that stay near it.
pub(super) fn arcs_along(
    at: &dyn Fn(f64) -> Point2,
    tolerance: f64,
) -> Vec<(Point2, f64)> {
    let mut pieces = Vec::new();
    // Last part first: they are taken from the end.
    let mut open: Vec<([f64; 2], u32)> = (0..4)
        .rev()
        .map(|k| [k, k + 1].map(|k| f64::from(k) / 4.0))
        .map(|ends| (ends, DEEPEST))
        .collect();
    while let Some(([a, b], depth)) = open.pop() {
        let point = |share: f64| at(a + (b - a) * share);
        match fitted([point(0.0), point(1.0)], &point, tolerance) {
            Some(bulge) => pieces.push((point(1.0), bulge)),
            None if depth == 0 => pieces.push((point(1.0), 0.0)),
            None => {
                let middle = a.midpoint(b);
                open.extend([([middle, b], depth - 1), ([a, middle], depth - 1)]);
            }
        }
    }
    pieces
}

fn at(curve: [Point2; 4], t: f64) -> Point2 {
    let s = 1.0 - t;
    let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
    Point2::from(curve.iter().zip(weights).map(|(p, w)| p.coords * w).sum::<Vector2>())
}

fn halves([a, b, c, d]: [Point2; 4]) -> [[Point2; 4]; 2] {
    let mid = |p: &Point2, q: &Point2| nalgebra::center(p, q);
    let (ab, bc, cd) = (mid(&a, &b), mid(&b, &c), mid(&c, &d));
    let (abc, bcd) = (mid(&ab, &bc), mid(&bc, &cd));
    let middle = mid(&abc, &bcd);
    [[a, ab, abc, middle], [middle, bcd, cd, d]]
}
