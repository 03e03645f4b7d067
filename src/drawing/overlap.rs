//! Cuts of one part that touch or run over each other: the laser would go there twice, or
//! leave nothing between them.

use crate::drawing::Curve;
use crate::drawing::ring::off;
use crate::geometry::{Contour, Point2, Rect, Vertex};
use crate::tolerance::{ARC_SAGITTA_MM, JOINED_MM};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// A straight piece of a line that is cut.
struct Edge {
    ends: [Point2; 2],
    /// The line it is of; a mark is none of the part's edges.
    line: usize,
    is_mark: bool,
}

/// Edges near one that are looked at: where thousands lie in one place, some are enough.
const MOST_NEAR: usize = 1000;

/// Where edges (outline and holes) and cuts of a part run over each other, and where its edges
/// touch one another.
pub(super) fn meetings(
    (outline, holes): (&Contour, &[Contour]),
    cuts: &[&Curve],
) -> [Vec<Point2>; 2] {
    let rings = std::iter::once(outline).chain(holes);
    let rings = rings.map(|ring| (ring.clone(), true, false));
    let cuts = cuts.iter().map(|cut| {
        let mut line = cut.contour();
        if !cut.closed
            && let Some(last) = line.vertices.last_mut()
        {
            *last = Vertex::line(last.point);
        }
        (line, cut.closed, true)
    });
    let edges = edges(rings.chain(cuts));
    let boxed = |(k, edge): (usize, &Edge)| {
        GeomWithData::new(Rectangle::from_aabb(around(&edge.ends)), k)
    };
    let tree = RTree::bulk_load(edges.iter().enumerate().map(boxed).collect());
    let (mut over, mut touching) = (Vec::new(), Vec::new());
    for (k, edge) in edges.iter().enumerate() {
        let near = tree.locate_in_envelope_intersecting(around(&edge.ends));
        let near = near.into_iter().take(MOST_NEAR).filter(|near| near.data < k);
        let near: Vec<&Edge> = near.map(|near| &edges[near.data]).collect();
        if near.iter().any(|other| common(edge.ends, other.ends) > JOINED_MM) {
            over.push(edge.ends[0]);
        }
        let touches = |other: &&Edge| {
            let are_edges = !edge.is_mark && !other.is_mark && edge.line != other.line;
            are_edges && apart(edge.ends, other.ends) <= JOINED_MM
        };
        if near.into_iter().any(|other| touches(&other)) {
            touching.push((edge.line, edge.ends[0]));
        }
    }
    // One place for each line.
    touching.dedup_by_key(|(line, _)| *line);
    [over, touching.into_iter().map(|(_, at)| at).collect()]
}

/// The edges of some lines: each with whether it is closed, and whether it is a mark.
fn edges(lines: impl Iterator<Item = (Contour, bool, bool)>) -> Vec<Edge> {
    let mut edges = Vec::new();
    for (line, (contour, closed, is_mark)) in lines.enumerate() {
        let points = Contour::flattened(&contour, ARC_SAGITTA_MM);
        let count = points.len() - usize::from(!closed);
        let next = points.iter().cycle().skip(1);
        let pairs = points.iter().zip(next).take(count);
        edges.extend(pairs.map(|(&a, &b)| Edge { ends: [a, b], line, is_mark }));
    }
    edges
}

fn around(edge: &[Point2; 2]) -> AABB<[f64; 2]> {
    let Rect { min, max } = Rect::around(edge).inflated(JOINED_MM);
    AABB::from_corners(min.into(), max.into())
}

/// Distance of two edges that do not cross, mm.
fn apart(a: [Point2; 2], b: [Point2; 2]) -> f64 {
    let [to_a, to_b] = [b.map(|p| off(p, a)), a.map(|p| off(p, b))];
    to_a.into_iter().chain(to_b).fold(f64::INFINITY, f64::min)
}

/// Length that two edges have in common, mm.
fn common(a: [Point2; 2], b: [Point2; 2]) -> f64 {
    let run = a[1] - a[0];
    let length = run.norm();
    if length <= JOINED_MM {
        return 0.0;
    }
    let way = run / length;
    let [from, to] = b.map(|p| (p - a[0]).dot(&way));
    let (low, high) = (from.min(to).max(0.0), from.max(to).min(length));
    let apart = |along: f64| {
        let share = ((along - from) / (to - from)).clamp(0.0, 1.0);
        (b[0] + (b[1] - b[0]) * share - (a[0] + way * along)).norm()
    };
    let is_along = high - low > JOINED_MM && apart(low).max(apart(high)) <= JOINED_MM;
    if is_along { high - low } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_edges_along_each_other_have_length_in_common() {
        let edge = |x1: f64, y1: f64, x2: f64, y2: f64| {
            [Point2::new(x1, y1), Point2::new(x2, y2)]
        };
        let base = edge(0.0, 0.0, 80.0, 0.0);
        for (other, wanted) in [
            (edge(100.0, 0.0, 50.0, 0.0), 30.0),
            (edge(20.0, 0.005, 30.0, 0.0), 10.0),
            (edge(80.0, 0.0, 90.0, 0.0), 0.0),
            (edge(20.0, 0.1, 30.0, 0.1), 0.0),
            (edge(40.0, -9.0, 40.0, 9.0), 0.0),
            (edge(40.0, 0.0, 40.0, 0.0), 0.0),
        ] {
            assert!((common(base, other) - wanted).abs() < 1e-9, "{other:?}");
        }
    }
}
