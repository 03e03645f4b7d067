//! Rotations worth trying, and whether a shape fits a sheet at all.

use crate::geometry::{Point2, Vector2, trig};
use crate::nest::{Rotations, Stock};
use crate::tolerance::EXACT_FIT_MM;
use std::f64::consts::{FRAC_PI_2, PI};

/// A rotation by which the outline fits the sheet inside its margin, if there is one.
pub fn fits(outline: &[Point2], rotations: &Rotations, stock: &Stock) -> Option<f64> {
    let hull = hull(outline);
    let bin = [stock.width - 2.0 * stock.margin, stock.height - 2.0 * stock.margin];
    let inside = |angle: &f64| {
        let size = extent(&hull, *angle);
        size[0] <= bin[0] + EXACT_FIT_MM && size[1] <= bin[1] + EXACT_FIT_MM
    };
    candidates(&hull, rotations).into_iter().find(inside)
}

/// Rotations for a first try: the hull's least rectangle lying, head to tail, and upright.
pub(super) fn good(outline: &[Point2], rotations: &Rotations, stock: &Stock) -> Vec<f64> {
    if let Rotations::Only(angles) = rotations {
        return angles.iter().copied().map(rounded).collect();
    }
    let lying = lying(outline);
    let mut angles = vec![lying, lying + PI, lying + FRAC_PI_2, lying - FRAC_PI_2];
    angles.extend(fits(outline, freely_rotated(), stock));
    angles.into_iter().map(rounded).collect()
}

const fn freely_rotated() -> &'static Rotations {
    &Rotations::Free
}

/// To 1e-7 degrees, as written in files.
pub(super) fn rounded(angle: f64) -> f64 {
    ((angle.to_degrees() * 1e7).round() / 1e7).to_radians()
}

/// Every rotation that may make the difference: each hull edge along x and along y, and steps
/// of one degree.
fn candidates(hull: &[Point2], rotations: &Rotations) -> Vec<f64> {
    match rotations {
        Rotations::Only(angles) => angles.clone(),
        Rotations::Free => {
            let first = lying_of(hull);
            let edges = edge_rotations(hull).flat_map(|angle| [angle, angle + FRAC_PI_2]);
            let steps = (0..180).map(|degree| f64::from(degree).to_radians());
            [first, first + FRAC_PI_2].into_iter().chain(edges).chain(steps).collect()
        }
    }
}

fn edge_rotations(hull: &[Point2]) -> impl Iterator<Item = f64> + '_ {
    let next = hull.iter().cycle().skip(1);
    hull.iter().zip(next).map(|(a, b)| -trig::atan2(b.y - a.y, b.x - a.x))
}

/// The rotation that lays the smallest rectangle around an outline along x.
pub(super) fn lying(outline: &[Point2]) -> f64 {
    lying_of(&hull(outline))
}

fn lying_of(hull: &[Point2]) -> f64 {
    let area = |angle: f64| {
        let [w, h] = extent(hull, angle);
        w * h
    };
    let best =
        edge_rotations(hull).min_by(|&a, &b| area(a).total_cmp(&area(b))).unwrap_or(0.0);
    let [w, h] = extent(hull, best);
    if w >= h { best } else { best + FRAC_PI_2 }
}

/// Length and height of the smallest rectangle around an outline.
pub(super) fn least_rectangle(outline: &[Point2]) -> [f64; 2] {
    let hull = hull(outline);
    extent(&hull, lying_of(&hull))
}

/// Length of the smallest rectangle around an outline.
pub(super) fn longest(outline: &[Point2]) -> f64 {
    least_rectangle(outline)[0]
}

fn extent(points: &[Point2], angle: f64) -> [f64; 2] {
    let (sin, cos) = (trig::sin(angle), trig::cos(angle));
    [Vector2::new(cos, -sin), Vector2::new(sin, cos)].map(|way| {
        let along = || points.iter().map(|p| p.coords.dot(&way));
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    })
}

/// Convex hull, counter-clockwise (Andrew's monotone chain).
fn hull(points: &[Point2]) -> Vec<Point2> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |points: &mut dyn Iterator<Item = &Point2>| {
        let mut chain: Vec<Point2> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                if (b - a).perp(&(p - b)) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(*p);
        }
        chain.pop();
        chain
    };
    let mut lower = half(&mut sorted.iter());
    lower.extend(half(&mut sorted.iter().rev()));
    if lower.is_empty() { points.to_vec() } else { lower }
}
