//! Chains of corners: runs of lines and arcs that outlines are put together from.

use crate::geometry::{Contour, Point2, Vector2, Vertex, trig};
use std::f64::consts::FRAC_PI_8;

/// A chain of corners walked the other way.
pub(crate) fn reversed(chain: &[Vertex]) -> Vec<Vertex> {
    let count = chain.len();
    let bulge = |k: usize| if k > 0 { -chain[k - 1].bulge } else { 0.0 };
    (0..count).rev().map(|k| Vertex::arc(chain[k].point, bulge(k))).collect()
}

/// Takes out corners that lie on the one before, as where a relief has no radius.
pub(crate) fn without_doubles(chain: &mut Vec<Vertex>) {
    chain.dedup_by(|after, before| {
        let same = after.point == before.point;
        if same {
            before.bulge = after.bulge;
        }
        same
    });
}

/// A circle, counter-clockwise from the right.
pub(crate) fn circle(center: Point2, radius: f64) -> Contour {
    let quarter = trig::tan(FRAC_PI_8);
    let ways = [Vector2::x(), Vector2::y(), -Vector2::x(), -Vector2::y()];
    let vertices = ways.map(|way| Vertex::arc(center + way * radius, quarter));
    Contour { vertices: vertices.to_vec() }
}

/// Bulge of a quarter circle, if there is one.
pub(crate) fn quarter(radius: f64) -> f64 {
    if radius > 0.0 { trig::tan(FRAC_PI_8) } else { 0.0 }
}
