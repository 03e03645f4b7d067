//! A part's convex pieces at some turn, and how deep two parts overlap.

use crate::geometry::{Point2, Vector2, trig};

/// A box `[left, low, right, high]`.
pub(super) type Bounds = [f64; 4];

/// A corner of a piece and the edge that leaves it.
#[derive(Debug, Clone, Copy)]
struct Edge {
    x: f64,
    y: f64,
    /// Outward unit normal.
    nx: f64,
    ny: f64,
    /// How far the piece reaches along the normal.
    reach: f64,
}

impl Edge {
    /// How far the edge lies beyond a point.
    fn beyond(&self, [x, y]: [f64; 2]) -> f64 {
        self.reach - (self.nx * x + self.ny * y)
    }
}

#[derive(Debug, Clone, Copy)]
struct Piece {
    start: usize,
    end: usize,
    bounds: Bounds,
    /// A point inside, and the radius of a circle around it that is inside, too.
    middle: [f64; 2],
    inner: f64,
    /// About the radius of the largest circle inside.
    girth: f64,
}

/// Convex pieces about the part's own middle.
#[derive(Debug, Clone, Default)]
pub(super) struct Turned {
    pub(super) angle: f64,
    pub(super) bounds: Bounds,
    edges: Vec<Edge>,
    pieces: Vec<Piece>,
}

impl Turned {
    /// Pieces as given, moved so that `middle` is the origin.
    pub(super) fn new(pieces: &[Vec<Point2>], middle: Point2) -> Self {
        let mut turned = Self::default();
        for piece in pieces {
            let start = turned.edges.len();
            let next = piece.iter().cycle().skip(1);
            for (a, b) in piece.iter().zip(next) {
                let way = (b - a).normalize();
                let p = a - middle;
                let reach = p.x * way.y - p.y * way.x;
                turned.edges.push(Edge { x: p.x, y: p.y, nx: way.y, ny: -way.x, reach });
            }
            let girth = super::pieces::width(piece) / 2.0;
            let end = turned.edges.len();
            let count = piece.len() as f64;
            let sum = piece.iter().fold(Vector2::zeros(), |sum, p| sum + (p - middle));
            let middle = [sum.x / count, sum.y / count];
            let inner = turned.edges[start..].iter().map(|e| e.beyond(middle));
            let inner = inner.fold(f64::INFINITY, f64::min).max(0.0);
            let bounds = [0.0; 4];
            turned.pieces.push(Piece { start, end, bounds, middle, inner, girth });
        }
        turned.bound();
        turned
    }

    /// Becomes `still` turned by an angle; allocates nothing once it has been used.
    pub(super) fn turn(&mut self, still: &Self, angle: f64) {
        let (sin, cos) = (trig::sin(angle), trig::cos(angle));
        self.angle = angle;
        self.edges.clear();
        self.edges.extend(still.edges.iter().map(|e| Edge {
            x: cos * e.x - sin * e.y,
            y: sin * e.x + cos * e.y,
            nx: cos * e.nx - sin * e.ny,
            ny: sin * e.nx + cos * e.ny,
            reach: e.reach,
        }));
        self.pieces.clear();
        self.pieces.extend(still.pieces.iter().map(|piece| {
            let [x, y] = piece.middle;
            Piece { middle: [cos * x - sin * y, sin * x + cos * y], ..*piece }
        }));
        self.bound();
    }

    /// Whether it has not been turned yet.
    pub(super) const fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }

    fn bound(&mut self) {
        let nowhere =
            [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        self.bounds = nowhere;
        for piece in &mut self.pieces {
            let corners = self.edges[piece.start..piece.end].iter();
            piece.bounds = corners.fold(nowhere, |b, e| {
                [b[0].min(e.x), b[1].min(e.y), b[2].max(e.x), b[3].max(e.y)]
            });
            let (a, b) = (self.bounds, piece.bounds);
            self.bounds =
                [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])];
        }
    }

    /// Sum over all pairs of pieces of how far they must be moved apart to keep the
    /// spacing, times the smaller girth; 0 exactly if all keep it. `other` lies by `(dx,
    /// dy)` from here. Once the sum passes `enough` it is returned as it is.
    pub(super) fn overlap(
        &self,
        other: &Self,
        [dx, dy]: [f64; 2],
        spacing: f64,
        enough: f64,
    ) -> f64 {
        let mut sum = 0.0;
        for p in &self.pieces {
            // In the other's own coordinates.
            let reach = [
                p.bounds[0] - dx - spacing,
                p.bounds[1] - dy - spacing,
                p.bounds[2] - dx + spacing,
                p.bounds[3] - dy + spacing,
            ];
            if !meet(&reach, &other.bounds) {
                continue;
            }
            for q in other.pieces.iter().filter(|q| meet(&reach, &q.bounds)) {
                let a = (&self.edges[p.start..p.end], p);
                let b = (&other.edges[q.start..q.end], q);
                sum += depth(a, b, [dx, dy], spacing) * p.girth.min(q.girth);
            }
            if sum > enough {
                break;
            }
        }
        sum
    }
}

/// Whether two boxes meet.
pub(super) fn meet(a: &Bounds, b: &Bounds) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// A convex piece and its edges.
type Convex<'a> = (&'a [Edge], &'a Piece);

/// Least way along an edge's normal that brings two convex pieces apart by the spacing.
fn depth(a: Convex, b: Convex, [dx, dy]: [f64; 2], spacing: f64) -> f64 {
    let mut least = f64::INFINITY;
    for ((edges, _), (corners, other), sign) in [(a, b, 1.0), (b, a, -1.0)] {
        for e in edges {
            let off = spacing + e.reach - sign * (e.nx * dx + e.ny * dy);
            // Some corner is at least as far back as the inner circle: mostly there is
            // nothing to gain.
            let [x, y] = other.middle;
            if off - (e.nx * x + e.ny * y) + other.inner >= least {
                continue;
            }
            let mut near = f64::INFINITY;
            for c in corners {
                let along = e.nx * c.x + e.ny * c.y;
                // `min` would look for numbers that are none, too.
                if along < near {
                    near = along;
                }
            }
            if off <= near {
                return 0.0;
            }
            least = least.min(off - near);
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_overlap_by_the_way_apart_and_not_beyond_the_spacing() {
        let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
        let square = square.map(|(x, y)| Point2::new(x, y)).to_vec();
        let a = Turned::new(&[square], Point2::new(2.0, 2.0));
        let girth = 1.0;
        assert!((a.overlap(&a, [3.0, 0.0], 0.0, f64::INFINITY) - girth).abs() < 1e-12);
        assert!(
            (a.overlap(&a, [4.5, 0.0], 1.0, f64::INFINITY) - 0.5 * girth).abs() < 1e-12
        );
        assert!(a.overlap(&a, [5.0, 0.0], 1.0, f64::INFINITY).abs() < 1e-12);
        let mut b = Turned::default();
        b.turn(&a, std::f64::consts::FRAC_PI_4);
        assert!(a.overlap(&b, [4.9, 0.0], 0.0, f64::INFINITY).abs() < 1e-12);
        assert!(a.overlap(&b, [4.7, 0.0], 0.0, f64::INFINITY) > 0.0);
    }
}
