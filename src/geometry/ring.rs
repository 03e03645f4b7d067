//! Closed polygons as lists of their corners; the first is not repeated.

use crate::geometry::Point2;

/// Area that a ring encloses, mm²; positive if it runs counter-clockwise.
pub fn signed_area(ring: &[Point2]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    let twice: f64 = ring.iter().zip(next).map(|(a, b)| a.coords.perp(&b.coords)).sum();
    twice / 2.0
}

/// Area that a ring encloses, whichever way it runs, mm².
pub fn area(ring: &[Point2]) -> f64 {
    signed_area(ring).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_that_runs_clockwise_has_a_negative_area() {
        let ring = [(0.0, 0.0), (0.0, 3.0), (2.0, 0.0)].map(|(x, y)| Point2::new(x, y));
        assert_eq!((signed_area(&ring), area(&ring)), (-3.0, 3.0));
    }
}
