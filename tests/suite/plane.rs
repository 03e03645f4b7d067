//! Plane geometry of our own for the laws: slow, plain, and nothing of the crate's checks.

use finwright::geometry::{Point2, Vector2};

/// Area of a polygon, positive if counter-clockwise.
pub(crate) fn area(ring: &[Point2]) -> f64 {
    sides(ring).map(|(a, b)| a.x * b.y - b.x * a.y).sum::<f64>() / 2.0
}

/// The sides of a closed polygon.
pub(crate) fn sides(ring: &[Point2]) -> impl Iterator<Item = (Point2, Point2)> + '_ {
    ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| (*a, *b))
}

/// Whether a point lies in a polygon: crossings of a ray to the right.
pub(crate) fn contains(ring: &[Point2], p: Point2) -> bool {
    let crossed = sides(ring).filter(|(a, b)| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossed.count() % 2 == 1
}

/// Least distance between the sides of two polygons; far ones are not looked at.
pub(crate) fn apart(first: &[Point2], second: &[Point2]) -> f64 {
    let mut least = f64::INFINITY;
    for (a, b) in sides(first) {
        for (c, d) in sides(second) {
            let gap_x = a.x.min(b.x) - c.x.max(d.x);
            let gap_x = gap_x.max(c.x.min(d.x) - a.x.max(b.x));
            let gap_y = a.y.min(b.y) - c.y.max(d.y);
            let gap_y = gap_y.max(c.y.min(d.y) - a.y.max(b.y));
            if gap_x.max(gap_y) < least {
                let ends = [to_side(a, c, d), to_side(b, c, d), to_side(c, a, b)];
                least = ends.into_iter().fold(least.min(to_side(d, a, b)), f64::min);
            }
        }
    }
    least
}

fn to_side(p: Point2, a: Point2, b: Point2) -> f64 {
    let way = b - a;
    let share = ((p - a).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
    (p - (a + way * share)).norm()
}

/// Where a line through `at` along `way` meets a polygon, as distances along `way`.
pub(crate) fn cuts(ring: &[Point2], at: Point2, way: Vector2) -> Vec<f64> {
    let across = |p: Point2| way.perp(&(p - at));
    let along = |p: Point2| way.dot(&(p - at));
    let crossing = |(a, b): (Point2, Point2)| {
        let (u, v) = (across(a), across(b));
        ((u > 0.0) != (v > 0.0)).then(|| along(a) + (along(b) - along(a)) * u / (u - v))
    };
    sides(ring).filter_map(crossing).collect()
}
