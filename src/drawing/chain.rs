//! Single lines and arcs joined into closed contours where their ends meet.

use crate::drawing::{Curve, Drawing};
use crate::geometry::{Point2, Vertex};
use crate::tolerance::{JOINED_MM, NO_LENGTH_MM};
use std::collections::BTreeMap;

/// Joins open curves of the same group whose ends are at most `within` mm apart; those of no
/// group stay as they were drawn.
pub fn joined<G: Ord>(
    mut drawing: Drawing,
    within: f64,
    group: impl Fn(&Curve) -> Option<G>,
) -> Drawing {
    let is_finite = |v: &Vertex| (v.point.coords.sum() + v.bulge).is_finite();
    let all = drawing.curves.len();
    drawing.curves.retain(|curve| curve.vertices.iter().all(is_finite));
    if drawing.curves.len() < all {
        let kind = "lines to infinity".to_owned();
        drawing.unread.insert((kind, ""), all - drawing.curves.len());
    }
    let curves = drawing.curves.into_iter().filter(|curve| curve.vertices.len() > 1);
    let (mut whole, mut groups) = (Vec::new(), BTreeMap::<G, Vec<Curve>>::new());
    for curve in curves {
        match group(&curve).filter(|_| !curve.closed) {
            Some(group) => groups.entry(group).or_default().push(curve),
            None => whole.push(curve),
        }
    }
    drawing.curves = whole;
    for curves in groups.into_values() {
        let (single, doubled) = without_doubles(curves);
        drawing.doubled.extend(doubled);
        drawing.curves.extend(chains(single, within));
    }
    drawing
}

/// A cell of the plane as large as ends may be apart.
fn cell(p: Point2, within: f64) -> [i64; 2] {
    [(p.x / within).floor() as i64, (p.y / within).floor() as i64]
}

/// Single lines that are drawn twice, in either direction, would lead a chain astray.
fn without_doubles(curves: Vec<Curve>) -> (Vec<Curve>, Vec<Curve>) {
    let mut seen: BTreeMap<[[i64; 2]; 2], Vec<f64>> = BTreeMap::new();
    let (mut single, mut doubled) = (Vec::new(), Vec::new());
    for curve in curves {
        let [a, b] = ends(&curve);
        let [from, to] = [a, b].map(|p| cell(p, JOINED_MM));
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

/// Both ends of a line.
pub(super) fn ends(curve: &Curve) -> [Point2; 2] {
    let last = curve.vertices.len() - 1;
    [curve.vertices[0].point, curve.vertices[last].point]
}

/// Where curves end: sorted cells with the curve and which end it is.
struct Ends {
    list: Vec<([i64; 2], usize, usize)>,
    within: f64,
}

impl Ends {
    fn new(curves: &[Curve], within: f64) -> Self {
        let all = curves.iter().enumerate();
        let mut list: Vec<_> = all
            .flat_map(|(k, curve)| {
                let ends = ends(curve).into_iter().enumerate();
                ends.map(move |(e, p)| (cell(p, within), k, e))
            })
            .collect();
        list.sort_unstable();
        Self { list, within }
    }

    /// An end near `p` of a curve that is still free, and how far it is.
    fn near(&self, p: Point2, curves: &[Curve], used: &[bool]) -> Option<Near> {
        let [x, y] = cell(p, self.within);
        let around = |k: i64| k.saturating_sub(1)..=k.saturating_add(1);
        let cells = around(x).flat_map(|x| around(y).map(move |y| [x, y]));
        let all = cells.flat_map(|cell| {
            let start = self.list.partition_point(|entry| entry.0 < cell);
            self.list[start..].iter().take_while(move |entry| entry.0 == cell)
        });
        let near = |&(_, curve, end): &([i64; 2], usize, usize)| {
            let apart = (ends(&curves[curve])[end] - p).norm();
            Near { curve, end, apart }
        };
        all.filter(|(_, k, _)| !used[*k])
            .map(near)
            .filter(|near| near.apart <= self.within)
            .min_by(|a, b| a.apart.total_cmp(&b.apart))
    }
}

/// The end of a curve that a chain may go on with.
struct Near {
    curve: usize,
    end: usize,
    apart: f64,
}

fn chains(curves: Vec<Curve>, within: f64) -> Vec<Curve> {
    let ends = Ends::new(&curves, within);
    let mut used = vec![false; curves.len()];
    let mut chains = Vec::new();
    for start in 0..curves.len() {
        if used[start] {
            continue;
        }
        used[start] = true;
        let mut chain = curves[start].vertices.clone();
        let mut turned = false;
        while home(&chain) > JOINED_MM {
            let tail = chain[chain.len() - 1].point;
            let next = ends.near(tail, &curves, &used);
            match next.filter(|next| next.apart <= home(&chain)) {
                Some(next) => {
                    used[next.curve] = true;
                    append(&mut chain, &curves[next.curve].vertices, next.end == 1);
                }
                None if home(&chain) <= within => break,
                // Once more from the other end: a chain may have begun in its middle.
                None if !turned => {
                    turned = true;
                    chain = reversed(&chain);
                }
                None => break,
            }
        }
        let closed = home(&chain) <= within;
        if home(&chain) <= JOINED_MM {
            chain.pop();
        }
        chains.push(Curve { vertices: chain, closed, ..curves[start].clone() });
    }
    chains
}

/// How far a chain's end is from its start; no chain of two corners can be closed.
fn home(chain: &[Vertex]) -> f64 {
    let ends = [chain[0].point, chain[chain.len() - 1].point];
    if chain.len() > 2 { (ends[1] - ends[0]).norm() } else { f64::INFINITY }
}

/// Adds a chain at the tail; the corner they share is kept once, a gap becomes a line.
fn append(chain: &mut Vec<Vertex>, more: &[Vertex], backward: bool) {
    let more = if backward { reversed(more) } else { more.to_vec() };
    let (Some(last), Some(first)) = (chain.last_mut(), more.first()) else { return };
    let is_joined = (first.point - last.point).norm() <= JOINED_MM;
    if is_joined {
        last.bulge = first.bulge;
    }
    chain.extend(more.into_iter().skip(usize::from(is_joined)));
}

fn reversed(chain: &[Vertex]) -> Vec<Vertex> {
    let bulge = |k: usize| if k > 0 { -chain[k - 1].bulge } else { 0.0 };
    (0..chain.len()).rev().map(|k| Vertex::arc(chain[k].point, bulge(k))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Source;

    fn line(points: &[(f64, f64)]) -> Curve {
        let vertices = points.iter().map(|&(x, y)| Vertex::line(Point2::new(x, y)));
        let (layer, source) = ("", Source::default());
        Curve { layer, source, vertices: vertices.collect(), closed: false }
    }

    #[test]
    fn gaps_are_bridged_only_as_far_as_asked() {
        let drawing = Drawing {
            curves: vec![
                line(&[(0.0, 0.0), (0.3, 0.0), (80.0, 0.0), (80.0, 30.0)]),
                line(&[(0.0, 30.0), (0.0, 0.2)]),
                line(&[(0.1, 30.0), (79.9, 30.0)]),
            ],
            ..Drawing::default()
        };
        let closed = |within| joined(drawing.clone(), within, |_| Some(())).curves;
        assert_eq!(closed(0.01).len(), 3);
        let [ring] = &closed(0.5)[..] else { panic!("{:?}", closed(0.5)) };
        assert!(ring.closed);
        assert!((ring.contour().signed_area().abs() - 2400.0).abs() < 1e-9);
    }
}
