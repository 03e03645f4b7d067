//! Cubic Bézier curves as arcs and lines.

use crate::geometry::{Point2, Vector2};
use crate::tolerance::ARC_SAGITTA_MM;

/// Halvings at most: a curve across the largest sheet comes out finer than needed.
const DEEPEST: u32 = 12;

/// The curve as a chain of arcs or lines (end and bulge of each) that stay near it.
pub(super) fn arcs(curve: [Point2; 4]) -> Vec<(Point2, f64)> {
    let mut pieces = Vec::new();
    split(curve, DEEPEST, &mut pieces);
    pieces
}

fn split(curve: [Point2; 4], depth: u32, pieces: &mut Vec<(Point2, f64)>) {
    let bulge = bulge(curve);
    match bulge {
        Some(bulge) => pieces.push((curve[3], bulge)),
        None if depth == 0 => pieces.push((curve[3], 0.0)),
        None => {
            for half in halves(curve) {
                split(half, depth - 1, pieces);
            }
        }
    }
}

/// The bulge of the arc through the curve's ends and middle, if the curve is that arc.
fn bulge(curve: [Point2; 4]) -> Option<f64> {
    let chord = curve[3] - curve[0];
    let length = chord.norm();
    if length == 0.0 {
        return curve.iter().all(|p| *p == curve[0]).then_some(0.0);
    }
    let right = Vector2::new(chord.y, -chord.x) / length;
    let middle = curve[0] + chord / 2.0;
    let sagitta = (at(curve, 0.5) - middle).dot(&right);
    let bulge = 2.0 * sagitta / length;
    if bulge.abs() > 1.0 {
        return None;
    }
    let off = |share: f64| {
        let p = at(curve, share) - middle;
        if sagitta.abs() < ARC_SAGITTA_MM / 10.0 {
            return p.dot(&right).abs();
        }
        let radius = (length * length / 4.0 + sagitta * sagitta) / (2.0 * sagitta);
        ((p - right * (sagitta - radius)).norm() - radius.abs()).abs()
    };
    let near =
        [0.2, 0.35, 0.65, 0.8].into_iter().all(|share| off(share) < ARC_SAGITTA_MM);
    near.then_some(bulge)
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
