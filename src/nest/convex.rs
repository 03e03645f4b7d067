//! A part's convex pieces at some angle, and how deep two parts overlap.

use crate::geometry::{Motion, Point2, Rect, Vector2};

/// A corner of a piece and the edge that leaves it.
#[derive(Debug, Clone, Copy)]
struct Edge {
    at: Vector2,
    /// Outward, of length 1.
    normal: Vector2,
    /// How far the piece reaches along the normal.
    reach: f64,
}

impl Edge {
    /// How far the edge lies beyond a point.
    fn beyond(&self, p: Vector2) -> f64 {
        self.reach - (self.normal.x * p.x + self.normal.y * p.y)
    }
}

#[derive(Debug, Clone, Copy)]
struct Piece {
    start: usize,
    end: usize,
    bounds: Rect,
    /// A point inside, and the radius of a circle around it that is inside, too.
    middle: Vector2,
    inner: f64,
    /// About the radius of the largest circle inside.
    girth: f64,
}

/// Convex pieces about the part's own middle.
#[derive(Debug, Clone, Default)]
pub(super) struct ConvexPieces {
    pub(super) angle: f64,
    pub(super) bounds: Rect,
    edges: Vec<Edge>,
    pieces: Vec<Piece>,
}

impl ConvexPieces {
    /// Pieces as given, moved so that `middle` is the origin.
    pub(super) fn new(pieces: &[Vec<Point2>], middle: Point2) -> Self {
        let mut rotated = Self::default();
        for piece in pieces {
            let start = rotated.edges.len();
            let next = piece.iter().cycle().skip(1);
            for (a, b) in piece.iter().zip(next) {
                let way = (b - a).normalize();
                let p = a - middle;
                let reach = p.x * way.y - p.y * way.x;
                let normal = Vector2::new(way.y, -way.x);
                rotated.edges.push(Edge { at: p, normal, reach });
            }
            let girth = super::convex_decomposition::mean_width(piece) / 2.0;
            let end = rotated.edges.len();
            let count = piece.len() as f64;
            let sum = piece.iter().fold(Vector2::zeros(), |sum, p| sum + (p - middle));
            let middle = sum / count;
            let inner = rotated.edges[start..].iter().map(|e| e.beyond(middle));
            let inner = inner.fold(f64::INFINITY, f64::min).max(0.0);
            let bounds = Rect::EMPTY;
            rotated.pieces.push(Piece { start, end, bounds, middle, inner, girth });
        }
        rotated.bound();
        rotated
    }

    /// Becomes `still` rotated by an angle; allocates nothing once it has been used.
    pub(super) fn rotate(&mut self, still: &Self, angle: f64) {
        let rotation = Motion::rotation(angle);
        self.angle = angle;
        self.edges.clear();
        self.edges.extend(still.edges.iter().map(|e| Edge {
            at: rotation.rotate(e.at),
            normal: rotation.rotate(e.normal),
            reach: e.reach,
        }));
        self.pieces.clear();
        self.pieces.extend(
            still
                .pieces
                .iter()
                .map(|piece| Piece { middle: rotation.rotate(piece.middle), ..*piece }),
        );
        self.bound();
    }

    /// Whether it has not been rotated yet.
    pub(super) const fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }

    fn bound(&mut self) {
        self.bounds = Rect::EMPTY;
        for piece in &mut self.pieces {
            let corners = self.edges[piece.start..piece.end].iter();
            piece.bounds =
                corners.fold(Rect::EMPTY, |b, e| b.union_point(Point2::from(e.at)));
            self.bounds = self.bounds.union(piece.bounds);
        }
    }

    /// Sum over all pairs of pieces of how far they must be moved apart to keep the
    /// spacing, times the smaller girth; 0 exactly if all keep it. `other` lies by `by` from here. Once the sum passes `enough` it is returned as it is.
    pub(super) fn overlap(
        &self,
        other: &Self,
        by: Vector2,
        spacing: f64,
        enough: f64,
    ) -> f64 {
        let mut sum = 0.0;
        for p in &self.pieces {
            // In the other's own coordinates.
            let reach = p.bounds.translated(-by).inflated(spacing);
            if !reach.overlaps(&other.bounds) {
                continue;
            }
            for q in other.pieces.iter().filter(|q| reach.overlaps(&q.bounds)) {
                let a = (&self.edges[p.start..p.end], p);
                let b = (&other.edges[q.start..q.end], q);
                sum += depth(a, b, by, spacing) * p.girth.min(q.girth);
            }
            if sum > enough {
                break;
            }
        }
        sum
    }
}

/// A convex piece and its edges.
type Convex<'a> = (&'a [Edge], &'a Piece);

/// Least way along an edge's normal that brings two convex pieces apart by the spacing.
fn depth(a: Convex, b: Convex, by: Vector2, spacing: f64) -> f64 {
    let mut least = f64::INFINITY;
    for ((edges, _), (corners, other), sign) in [(a, b, 1.0), (b, a, -1.0)] {
        for e in edges {
            let off = spacing + e.reach - sign * (e.normal.x * by.x + e.normal.y * by.y);
            // Some corner is at least as far back as the inner circle: mostly there is
            // nothing to gain.
            let m = other.middle;
            if off - (e.normal.x * m.x + e.normal.y * m.y) + other.inner >= least {
                continue;
            }
            let mut near = f64::INFINITY;
            for c in corners {
                let along = e.normal.x * c.at.x + e.normal.y * c.at.y;
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
        let a = ConvexPieces::new(&[square], Point2::new(2.0, 2.0));
        let girth = 1.0;
        assert!(
            (a.overlap(&a, Vector2::new(3.0, 0.0), 0.0, f64::INFINITY) - girth).abs()
                < 1e-12
        );
        assert!(
            (a.overlap(&a, Vector2::new(4.5, 0.0), 1.0, f64::INFINITY) - 0.5 * girth)
                .abs()
                < 1e-12
        );
        assert!(a.overlap(&a, Vector2::new(5.0, 0.0), 1.0, f64::INFINITY).abs() < 1e-12);
        let mut b = ConvexPieces::default();
        b.rotate(&a, std::f64::consts::FRAC_PI_4);
        assert!(a.overlap(&b, Vector2::new(4.9, 0.0), 0.0, f64::INFINITY).abs() < 1e-12);
        assert!(a.overlap(&b, Vector2::new(4.7, 0.0), 0.0, f64::INFINITY) > 0.0);
    }
}
