//! Rectangles along the axes.

use crate::geometry::{Point2, Vector2};

/// A rectangle along the axes, mm; it contains its edges.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rect {
    /// The lower left corner.
    pub min: Point2,
    /// The upper right corner.
    pub max: Point2,
}

impl Rect {
    /// Contains nothing: any point united with it is the rectangle of that point.
    pub const EMPTY: Self = Self {
        min: Point2::new(f64::INFINITY, f64::INFINITY),
        max: Point2::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// The smallest rectangle around points; [`Rect::EMPTY`] around none.
    pub fn around<'a>(points: impl IntoIterator<Item = &'a Point2>) -> Self {
        points.into_iter().fold(Self::EMPTY, |rect, p| rect.union_point(*p))
    }

    /// The smallest rectangle that contains it and a point.
    #[must_use]
    pub fn union_point(self, p: Point2) -> Self {
        Self { min: self.min.inf(&p), max: self.max.sup(&p) }
    }

    /// The smallest rectangle that contains both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.inf(&other.min), max: self.max.sup(&other.max) }
    }

    /// Width and height.
    pub fn size(&self) -> Vector2 {
        self.max - self.min
    }

    /// The point in the middle.
    pub fn center(&self) -> Point2 {
        nalgebra::center(&self.min, &self.max)
    }

    /// Moved.
    #[must_use]
    pub fn translated(self, by: Vector2) -> Self {
        Self { min: self.min + by, max: self.max + by }
    }

    /// Larger by the same length on all sides.
    #[must_use]
    pub fn inflated(self, by: f64) -> Self {
        let by = Vector2::new(by, by);
        Self { min: self.min - by, max: self.max + by }
    }

    /// Whether a point lies in it or on its edge.
    pub fn contains(&self, p: Point2) -> bool {
        self.min.x <= p.x && p.x <= self.max.x && self.min.y <= p.y && p.y <= self.max.y
    }

    /// Whether they have a point in common, an edge or a corner included.
    pub fn touches(&self, other: &Self) -> bool {
        self.min.x <= other.max.x
            && other.min.x <= self.max.x
            && self.min.y <= other.max.y
            && other.min.y <= self.max.y
    }

    /// Whether they have more than edges and corners in common.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.x < other.max.x
            && other.min.x < self.max.x
            && self.min.y < other.max.y
            && other.min.y < self.max.y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_that_share_an_edge_touch_and_do_not_overlap() {
        let [a, b] = [0.0, 2.0]
            .map(|x| Rect::around(&[Point2::new(x, 0.0), Point2::new(x + 2.0, 1.0)]));
        assert!(a.touches(&b) && !a.overlaps(&b));
        assert!(a.inflated(0.1).overlaps(&b) && !Rect::EMPTY.touches(&a));
        assert_eq!(a.union(b).center(), Point2::new(2.0, 0.5));
    }
}
