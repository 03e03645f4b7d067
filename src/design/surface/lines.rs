//! Lines inside a surface that fins are to follow: creases, or curves that are given.

use crate::design::surface::{Measures, Surface, previous};
use crate::geometry::{Point3, trig};
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// Neighbours that meet at this angle or more, radians, have a crease between them.
const CREASE: f64 = 25.0 * std::f64::consts::PI / 180.0;
/// How much farther a way seems that is off its curve, beside how far off it is.
const OFF: f64 = 8.0;
/// Least area that a triangle keeps when its corner is moved onto a curve.
const LEAST_SHARE: f64 = 0.2;

/// Half-edges one after another.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// Each begins where the one before ends.
    pub sides: Vec<usize>,
    /// Whether the last leads to the first.
    pub closed: bool,
}

impl Surface {
    /// The same with fins to follow all creases that hang together over `least` mm or more.
    #[must_use]
    pub fn following_creases(self, least: f64) -> Self {
        let measures = Measures::of(&self);
        let normal = |side: usize| measures.frames[side / 3][2];
        let is_crease = |&side: &usize| {
            self.twin(side).filter(|&twin| side < twin).is_some_and(|twin| {
                let (a, b) = (normal(side), normal(twin));
                trig::atan2(a.cross(&b).norm(), a.dot(&b)) >= CREASE
            })
        };
        let creases = (0..self.side_count()).filter(is_crease);
        let edges: BTreeSet<[usize; 2]> = creases.map(|side| self.ends(side)).collect();
        let surface = self.with_lines(edges);
        let long = surface.lines().into_iter().filter(|line| {
            line.sides.iter().map(|&side| surface.length(side)).sum::<f64>() >= least
        });
        let kept = long.flat_map(|line| line.sides).map(|side| surface.ends(side));
        let kept = kept.collect();
        surface.with_lines(kept).without_ears()
    }

    /// The same with fins to follow the boundary where both ends of an edge are `on` it.
    pub(in crate::design) fn following_boundary(
        self,
        on: impl Fn(Point3) -> bool,
    ) -> Self {
        let rim = (0..self.side_count()).filter(|&side| self.is_boundary(side));
        let ends = rim.map(|side| self.ends(side));
        let on = |ends: &[usize; 2]| ends.iter().all(|&k| on(self.positions[k]));
        let edges = ends.filter(on).collect();
        self.with_lines(edges)
    }

    /// The same with fins to follow these polylines, each along edges near it whose
    /// vertices are moved onto it. Returns also which of them were not found on the surface.
    #[must_use]
    pub fn following(mut self, curves: &[Vec<Point3>]) -> (Self, Vec<usize>) {
        let (mut edges, mut missed) = (BTreeSet::new(), Vec::new());
        for (number, curve) in curves.iter().enumerate() {
            let path = self.path(curve);
            if path.len() < 2 {
                missed.push(number);
            }
            for &vertex in &path {
                self.attract(vertex, curve);
            }
            edges.extend(path.windows(2).map(|w| [w[0].min(w[1]), w[0].max(w[1])]));
        }
        (self.with_lines(edges).without_ears(), missed)
    }

    /// Vertices along a polyline, from edge to edge.
    fn path(&self, curve: &[Point3]) -> Vec<usize> {
        let nearest = |p: &Point3| {
            let far = |vertex: &usize| (self.positions[*vertex] - p).norm_squared();
            (0..self.positions.len()).min_by(|a, b| far(a).total_cmp(&far(b)))
        };
        let mut stops: Vec<usize> = curve.iter().filter_map(nearest).collect();
        stops.dedup();
        let mut path: Vec<usize> = stops.first().copied().into_iter().collect();
        for pair in stops.windows(2) {
            path.extend(self.way([pair[0], pair[1]], curve));
        }
        path
    }

    /// The shortest way between two vertices, the first left out, where distance from the
    /// curve counts as length.
    fn way(&self, [from, to]: [usize; 2], curve: &[Point3]) -> Vec<usize> {
        let mut distance = vec![f64::INFINITY; self.positions.len()];
        let mut before = vec![from; self.positions.len()];
        let mut open = BinaryHeap::from([Reverse((0, from))]);
        distance[from] = 0.0;
        while let Some(Reverse((_, vertex))) = open.pop() {
            if vertex == to {
                break;
            }
            let last = self.fan(vertex).last().map(previous);
            let around = self.fan(vertex).map(|side| self.tip(side));
            for other in around.chain(last.map(|side| self.tail(side))) {
                let p = self.positions[other];
                let off = (on_curve(curve, p) - p).norm();
                let step = (p - self.positions[vertex]).norm() + OFF * off;
                let far = distance[vertex] + step;
                if far < distance[other] {
                    distance[other] = far;
                    before[other] = vertex;
                    // Not negative, so that bits are in order.
                    open.push(Reverse((far.to_bits(), other)));
                }
            }
        }
        let mut way = vec![to];
        while let Some(&at) = way.last().filter(|&&at| at != from) {
            way.push(before[at]);
        }
        way.pop();
        way.reverse();
        way
    }

    /// Moves a vertex inside onto a curve, or as far towards it as its triangles allow.
    fn attract(&mut self, vertex: usize, curve: &[Point3]) {
        if self.on_boundary(vertex) {
            return;
        }
        let fan: Vec<usize> = self.fan(vertex).map(|side| side / 3).collect();
        let areas = |surface: &Self| -> Vec<_> {
            let corners = fan.iter().map(|&triangle| &surface.triangles[triangle]);
            corners
                .map(|t| crate::structure::area_vector(&surface.positions, t))
                .collect()
        };
        let (from, before) = (self.positions[vertex], areas(self));
        let to = on_curve(curve, from);
        for share in [1.0, 0.75, 0.5, 0.25, 0.0] {
            self.positions[vertex] = from + (to - from) * share;
            let kept = areas(self);
            let keeps = kept
                .iter()
                .zip(&before)
                .all(|(now, then)| now.dot(then) >= LEAST_SHARE * then.norm_squared());
            if keeps {
                break;
            }
        }
    }

    /// The lines to be followed, each between two ends or branches, or closed.
    pub(in crate::design) fn lines(&self) -> Vec<Line> {
        let mut degree = vec![0; self.positions.len()];
        let followed = |&side: &usize| self.is_followed(side);
        let sides = || (0..self.side_count()).filter(followed);
        self.followed.iter().flatten().for_each(|&vertex| degree[vertex] += 1);
        let mut seen = vec![false; self.side_count()];
        let mut lines = Vec::new();
        for round in 0..2 {
            for start in sides() {
                if seen[start] || (round == 0 && degree[self.tail(start)] == 2) {
                    continue;
                }
                let (mut line, mut side) = (Vec::new(), Some(start));
                while let Some(at) = side.filter(|&side| !seen[side]) {
                    seen[at] = true;
                    self.twin(at).into_iter().for_each(|twin| seen[twin] = true);
                    line.push(at);
                    let tip = self.tip(at);
                    let onward = |&k: &usize| self.is_followed(k) && !seen[k];
                    side = self.fan(tip).find(onward).filter(|_| degree[tip] == 2);
                }
                lines.push(Line { sides: line, closed: round == 1 });
            }
        }
        lines
    }
}

/// The point of a polyline nearest to another.
fn on_curve(curve: &[Point3], p: Point3) -> Point3 {
    let feet = curve.windows(2).map(|ends| {
        let along = ends[1] - ends[0];
        let share = (p - ends[0]).dot(&along) / along.norm_squared();
        // A piece without length has no share.
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
        ends[0] + along * share
    });
    let far = |foot: &Point3| (foot - p).norm_squared();
    feet.min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(p)
}
