//! Single lines and arcs joined into closed contours where their ends meet.

use crate::drawing::{Curve, Drawing};
use crate::geometry::{Point2, Vertex};
use crate::tolerance::{JOINED_MM, NO_LENGTH_MM};
use std::collections::BTreeMap;

/// Joins the open curves of some layers; others stay as they were drawn.
pub fn joined(mut drawing: Drawing, which: impl Fn(&str) -> bool) -> Drawing {
    let is_finite = |v: &Vertex| (v.point.coords.sum() + v.bulge).is_finite();
    let all = drawing.curves.len();
    drawing.curves.retain(|curve| curve.vertices.iter().all(is_finite));
    if drawing.curves.len() < all {
        let kind = "lines to infinity".to_owned();
        drawing.unread.insert((kind, ""), all - drawing.curves.len());
    }
    let (open, whole): (Vec<Curve>, Vec<Curve>) = drawing
        .curves
        .into_iter()
        .filter(|curve| curve.vertices.len() > 1)
        .partition(|curve| which(curve.layer) && !curve.closed);
    drawing.curves = whole;
    let mut layers: BTreeMap<&'static str, Vec<Curve>> = BTreeMap::new();
    for curve in open {
        layers.entry(curve.layer).or_default().push(curve);
    }
    for (layer, curves) in layers {
        let (single, doubled) = without_doubles(curves);
        drawing.doubled.extend(doubled);
        drawing.curves.extend(chains(layer, single));
    }
    drawing
}

/// A cell of the plane as large as ends may be apart.
fn cell(p: Point2) -> [i64; 2] {
    [(p.x / JOINED_MM).floor() as i64, (p.y / JOINED_MM).floor() as i64]
}

/// Single lines that are drawn twice, in either direction, would lead a chain astray.
fn without_doubles(curves: Vec<Curve>) -> (Vec<Curve>, Vec<Curve>) {
    let mut seen: BTreeMap<[[i64; 2]; 2], Vec<f64>> = BTreeMap::new();
    let (mut single, mut doubled) = (Vec::new(), Vec::new());
    for curve in curves {
        let [a, b] = ends(&curve);
        let [from, to] = [cell(a), cell(b)];
        let bulge = curve.vertices[0].bulge;
        let (key, bulge) =
            if from <= to { ([from, to], bulge) } else { ([to, from], -bulge) };
        let known = seen.entry(key).or_default();
        let same = |other: &f64| (other - bulge).abs() < NO_LENGTH_MM;
        if curve.vertices.len() == 2 && known.iter().any(same) {
            doubled.push(curve);
        } else {
            known.push(if curve.vertices.len() == 2 { bulge } else { f64::NAN });
            single.push(curve);
        }
    }
    (single, doubled)
}

fn ends(curve: &Curve) -> [Point2; 2] {
    let last = curve.vertices.len() - 1;
    [curve.vertices[0].point, curve.vertices[last].point]
}

/// Where curves end: sorted cells with the curve and which end it is.
struct Ends(Vec<([i64; 2], usize, usize)>);

impl Ends {
    fn new(curves: &[Curve]) -> Self {
        let all = curves.iter().enumerate();
        let mut list: Vec<_> = all
            .flat_map(|(k, curve)| {
                ends(curve).into_iter().enumerate().map(move |(e, p)| (cell(p), k, e))
            })
            .collect();
        list.sort_unstable();
        Self(list)
    }

    /// An end near `p` of a curve that is still free.
    fn near(&self, p: Point2, curves: &[Curve], used: &[bool]) -> Option<(usize, usize)> {
        let [x, y] = cell(p);
        let cells = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| [x, y]));
        let all = cells.flat_map(|cell| {
            let start = self.0.partition_point(|entry| entry.0 < cell);
            self.0[start..].iter().take_while(move |entry| entry.0 == cell)
        });
        let apart =
            |&&(_, k, e): &&([i64; 2], usize, usize)| (ends(&curves[k])[e] - p).norm();
        all.filter(|(_, k, _)| !used[*k])
            .filter(|entry| apart(entry) <= JOINED_MM)
            .min_by(|a, b| apart(a).total_cmp(&apart(b)))
            .map(|&(_, k, e)| (k, e))
    }
}

fn chains(layer: &'static str, curves: Vec<Curve>) -> Vec<Curve> {
    let ends = Ends::new(&curves);
    let mut used = vec![false; curves.len()];
    let mut chains = Vec::new();
    for start in 0..curves.len() {
        if used[start] {
            continue;
        }
        used[start] = true;
        let mut chain = curves[start].vertices.clone();
        let mut turned = false;
        while !is_home(&chain) {
            let tail = chain[chain.len() - 1].point;
            match ends.near(tail, &curves, &used) {
                Some((next, end)) => {
                    used[next] = true;
                    append(&mut chain, &curves[next].vertices, end == 1);
                }
                // Once more from the other end: a chain may have begun in its middle.
                None if !turned => {
                    turned = true;
                    chain = reversed(&chain);
                }
                None => break,
            }
        }
        let closed = is_home(&chain);
        if closed {
            chain.pop();
        }
        chains.push(Curve { layer, vertices: chain, closed });
    }
    chains
}

fn is_home(chain: &[Vertex]) -> bool {
    chain.len() > 2 && (chain[chain.len() - 1].point - chain[0].point).norm() <= JOINED_MM
}

/// Adds a chain at the tail; the corner they share is kept once.
fn append(chain: &mut Vec<Vertex>, more: &[Vertex], backward: bool) {
    let more = if backward { reversed(more) } else { more.to_vec() };
    if let (Some(last), Some(first)) = (chain.last_mut(), more.first()) {
        last.bulge = first.bulge;
    }
    chain.extend(more.into_iter().skip(1));
}

fn reversed(chain: &[Vertex]) -> Vec<Vertex> {
    let bulge = |k: usize| if k > 0 { -chain[k - 1].bulge } else { 0.0 };
    (0..chain.len()).rev().map(|k| Vertex::arc(chain[k].point, bulge(k))).collect()
}
