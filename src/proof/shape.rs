//! Rigid motions of the plane, and how far points are from a shape's edge.

use crate::geometry::{Point2, Vector2, trig};
use crate::tolerance::PROOF_REACH_MM;

/// A turn about the origin followed by a move: from part to sheet coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Motion {
    turn: Vector2,
    shift: Vector2,
}

impl Motion {
    pub(super) fn new(angle: f64, shift: Vector2) -> Self {
        Self { turn: Vector2::new(trig::cos(angle), trig::sin(angle)), shift }
    }

    /// The motion that takes the segment `from` onto the direction of `to`, middle on
    /// middle.
    pub(super) fn between(from: [Point2; 2], to: [Point2; 2]) -> Self {
        let (a, b) = (from[1] - from[0], to[1] - to[0]);
        let turn = Vector2::new(a.dot(&b), a.perp(&b)).normalize();
        let still = Self { turn, shift: Vector2::zeros() };
        let middle = still.apply(nalgebra::center(&from[0], &from[1]));
        Self { turn, shift: nalgebra::center(&to[0], &to[1]) - middle }
    }

    /// The motion that best takes the first points onto the second ones (least squares).
    pub(super) fn fitted(pairs: &[(Point2, Point2)]) -> Option<Self> {
        if pairs.len() < 2 {
            return None;
        }
        let count = pairs.len() as f64;
        let mean = |of: fn(&(Point2, Point2)) -> Vector2| {
            pairs.iter().map(of).sum::<Vector2>() / count
        };
        let (from, to) = (mean(|pair| pair.0.coords), mean(|pair| pair.1.coords));
        let turn: Vector2 = pairs
            .iter()
            .map(|(p, q)| (p.coords - from, q.coords - to))
            .map(|(p, q)| Vector2::new(p.dot(&q), p.perp(&q)))
            .sum();
        let turn = turn.try_normalize(0.0)?;
        let still = Self { turn, shift: Vector2::zeros() };
        Some(Self { turn, shift: to - still.apply(Point2::from(from)).coords })
    }

    pub(super) fn apply(&self, p: Point2) -> Point2 {
        let (cos, sin) = (self.turn.x, self.turn.y);
        Point2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y) + self.shift
    }

    pub(super) fn back(&self, p: Point2) -> Point2 {
        let (cos, sin) = (self.turn.x, self.turn.y);
        let p = p - self.shift;
        Point2::new(cos * p.x + sin * p.y, -sin * p.x + cos * p.y)
    }

    /// How far the two motions bring these points apart at most.
    pub(super) fn apart(&self, other: &Self, points: &[Point2]) -> f64 {
        let off = |p: &Point2| (self.apply(*p) - other.apply(*p)).norm();
        points.iter().map(off).fold(0.0, f64::max)
    }
}

/// Least and greatest coordinates.
pub(super) fn bounds(points: impl IntoIterator<Item = Point2>) -> [Point2; 2] {
    let empty = [Point2::new(f64::MAX, f64::MAX), Point2::new(f64::MIN, f64::MIN)];
    points.into_iter().fold(empty, |[low, high], p| [low.inf(&p), high.sup(&p)])
}

/// An edge is entered into so many cells at most: none in a real part is metres long.
const MOST_STEPS: f64 = 1024.0;

/// Edges of polygons, sorted into cells so that those near a point are found at once.
pub(super) struct Edges {
    list: Vec<[Point2; 2]>,
    cell: f64,
    cells: Vec<([i32; 2], u32)>,
}

impl Edges {
    pub(super) fn new(rings: impl IntoIterator<Item = impl AsRef<[Point2]>>) -> Self {
        Self::for_reach(rings, PROOF_REACH_MM)
    }

    /// Edges that are asked for within another reach, mm.
    pub(super) fn for_reach(
        rings: impl IntoIterator<Item = impl AsRef<[Point2]>>,
        reach: f64,
    ) -> Self {
        let mut list = Vec::new();
        for ring in rings {
            let ring = ring.as_ref();
            let next = ring.iter().cycle().skip(1);
            list.extend(ring.iter().zip(next).map(|(a, b)| [*a, *b]));
        }
        Self::sorted(list, reach)
    }

    /// Single points instead of edges.
    pub(super) fn of_points(points: impl IntoIterator<Item = Point2>) -> Self {
        Self::sorted(points.into_iter().map(|p| [p, p]).collect(), PROOF_REACH_MM)
    }

    fn sorted(list: Vec<[Point2; 2]>, reach: f64) -> Self {
        // A point of an edge is within half a cell of where the edge is entered; another
        // half is left for the reach.
        let cell = (2.0 * reach).max(4.0);
        let mut edges = Self { list, cell, cells: Vec::new() };
        for k in 0..edges.list.len() {
            let entries = edges.samples(k, 1.0).map(|p| (edges.cell_of(p), k as u32));
            let entries: Vec<_> = entries.collect();
            edges.cells.extend(entries);
        }
        edges.cells.sort_unstable();
        edges.cells.dedup();
        edges
    }

    fn cell_of(&self, p: Point2) -> [i32; 2] {
        [(p.x / self.cell).floor() as i32, (p.y / self.cell).floor() as i32]
    }

    /// Points along an edge, `share` of a cell apart at most.
    pub(super) fn samples(
        &self,
        k: usize,
        share: f64,
    ) -> impl Iterator<Item = Point2> + use<> {
        let [a, b] = self.list[k];
        let steps =
            ((b - a).norm() / (self.cell * share)).ceil().clamp(1.0, MOST_STEPS) as u32;
        (0..=steps).map(move |step| a + (b - a) * (f64::from(step) / f64::from(steps)))
    }

    /// The edges near a point, by index; all within reach are among them, some repeated.
    pub(super) fn around(&self, p: Point2) -> impl Iterator<Item = usize> + '_ {
        let [x, y] = self.cell_of(p);
        (x - 1..=x + 1).flat_map(move |column| {
            let start = self.cells.partition_point(|entry| entry.0 < [column, y - 1]);
            let near = self.cells[start..].iter();
            near.take_while(move |entry| entry.0 <= [column, y + 1]).map(|e| e.1 as usize)
        })
    }

    /// An edge by its index: edges count on from ring to ring.
    pub(super) fn edge(&self, k: usize) -> [Point2; 2] {
        self.list[k]
    }

    /// The first ends of all edges.
    pub(super) fn points(&self) -> impl Iterator<Item = &Point2> {
        self.list.iter().map(|edge| &edge[0])
    }

    /// Distance of a point from the nearest edge and the point there; `None` beyond reach.
    pub(super) fn nearest(&self, p: Point2) -> Option<(f64, Point2)> {
        let feet = self.around(p).map(|k| foot(p, self.list[k][0], self.list[k][1]));
        let off = feet.map(|foot| ((p - foot).norm(), foot));
        off.filter(|(off, _)| *off <= PROOF_REACH_MM).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Distance from the nearest edge, or infinity beyond reach.
    pub(super) fn distance(&self, p: Point2) -> f64 {
        self.nearest(p).map_or(f64::INFINITY, |(off, _)| off)
    }
}

/// The point of a segment nearest to `p`.
pub(super) fn foot(p: Point2, a: Point2, b: Point2) -> Point2 {
    let way = b - a;
    let length = way.norm_squared();
    if length == 0.0 {
        return a;
    }
    a + way * ((p - a).dot(&way) / length).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fitted_motion_is_the_one_that_was_made() {
        let made = Motion::new(0.7, Vector2::new(3.0, -200.0));
        let points =
            [(0.0, 0.0), (500.0, 1.0), (30.0, 40.0)].map(|(x, y)| Point2::new(x, y));
        let pairs = points.map(|p| (p, made.apply(p)));
        let found = Motion::fitted(&pairs).unwrap();
        assert!(found.apart(&made, &points) < 1e-10);
        assert!(points.iter().all(|&p| (found.back(made.apply(p)) - p).norm() < 1e-10));
        let segment = Motion::between([points[0], points[1]], [pairs[0].1, pairs[1].1]);
        assert!(segment.apart(&made, &points) < 1e-10);
    }

    #[test]
    fn distances_within_reach_are_exact_and_beyond_it_unknown() {
        let square = [(0.0, 0.0), (50.0, 0.0), (50.0, 50.0), (0.0, 50.0)];
        let edges = Edges::new([square.map(|(x, y)| Point2::new(x, y))]);
        assert!((edges.distance(Point2::new(25.0, 1.2)) - 1.2).abs() < 1e-12);
        assert!((edges.distance(Point2::new(51.0, 51.0)) - 2_f64.sqrt()).abs() < 1e-12);
        assert!(edges.distance(Point2::new(25.0, 25.0)).is_infinite());
    }
}
