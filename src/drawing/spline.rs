//! Splines: by control points, weighted or not, and through points.

use crate::drawing::Pen;
use crate::drawing::bezier;
use crate::drawing::curves::raised;
use crate::geometry::{Point2, Vector2, Vector3};
use crate::tolerance::NO_LENGTH_MM;
use nalgebra::SVector;

/// Highest degree that is drawn; programs write up to 11.
const HIGHEST: usize = 25;

/// A spline by control points ("The NURBS Book", chapter 4).
pub(super) struct Nurbs<'a> {
    pub(super) degree: usize,
    pub(super) knots: &'a [f64],
    pub(super) points: &'a [Point2],
    /// One for each point; none if all count the same.
    pub(super) weights: &'a [f64],
}

impl Nurbs<'_> {
    /// Draws the spline; false if it is none.
    pub(super) fn draw(&self, pen: &mut Pen) -> bool {
        let Self { degree, knots, points, weights } = *self;
        let fits = knots.len() == points.len() + degree + 1 && points.len() > degree;
        let weighted = weights.len() == points.len() && weights.iter().all(|w| *w > 0.0);
        let is_fine = weighted || weights.is_empty();
        if !(1..=HIGHEST).contains(&degree) || !fits || !knots.is_sorted() || !is_fine {
            return false;
        }
        let is_plain = weights.windows(2).all(|pair| pair[0].total_cmp(&pair[1]).is_eq());
        if is_plain && degree <= 3 {
            spline(pen, degree, knots, points);
        } else {
            self.rational(pen);
        }
        true
    }

    fn rational(&self, pen: &mut Pen) {
        let Self { degree, knots, points, weights } = *self;
        let weight = |k: usize| weights.get(k).copied().unwrap_or(1.0);
        let lifted = |k: usize| {
            let w = weight(k);
            Vector3::new(points[k].x * w, points[k].y * w, w)
        };
        let lifted: Vec<Vector3> = (0..points.len()).map(lifted).collect();
        let mut begun = false;
        for span in degree..points.len() {
            let (a, b) = (knots[span], knots[span + 1]);
            if a >= b {
                continue;
            }
            let at = |t: f64| {
                let p = blossom((degree, knots, &lifted), span, |_| a + (b - a) * t);
                Point2::new(p.x / p.z, p.y / p.z)
            };
            if !std::mem::replace(&mut begun, true) {
                pen.move_to(at(0.0));
            }
            for (point, bulge) in bezier::arcs_along(&at, pen.tolerance) {
                pen.line_to(point, bulge);
            }
        }
        pen.end();
    }
}

/// Draws a B-spline of degree 1 to 3.
fn spline(pen: &mut Pen, degree: usize, knots: &[f64], points: &[Point2]) {
    let vectors: Vec<Vector2> = points.iter().map(|p| p.coords).collect();
    let mut begun = false;
    for span in degree..points.len() {
        let (a, b) = (knots[span], knots[span + 1]);
        if a >= b {
            continue;
        }
        // The corner k of its Bézier curve takes the later knot k times.
        let corner = |k: usize| {
            let argument = |r| if r <= k { b } else { a };
            Point2::from(blossom((degree, knots, &vectors), span, argument))
        };
        if !std::mem::replace(&mut begun, true) {
            pen.move_to(corner(0));
        }
        match degree {
            1 => pen.line_to(corner(1), 0.0),
            2 => pen.curve_to(raised(pen.at(), corner(1), corner(2))),
            _ => pen.curve_to([corner(1), corner(2), corner(3)]),
        }
    }
    pen.end();
}

/// De Boor's scheme with an argument of its own in each of its steps.
fn blossom<const N: usize>(
    (degree, knots, points): (usize, &[f64], &[SVector<f64, N>]),
    span: usize,
    argument: impl Fn(usize) -> f64,
) -> SVector<f64, N> {
    let mut row = points[span - degree..=span].to_vec();
    for r in 1..=degree {
        for j in (r..=degree).rev() {
            let (low, high) = (knots[span - degree + j], knots[span + 1 + j - r]);
            let share = (argument(r) - low) / (high - low);
            row[j] = row[j - 1] + (row[j] - row[j - 1]) * share;
        }
    }
    row[degree]
}

/// Draws the cubic with continuous curvature through points, parametrised by the lengths of
/// its chords; false if there are too few. Without directions at the ends it ends straight.
pub(super) fn through(
    pen: &mut Pen,
    points: &[Point2],
    directions: [Option<Vector2>; 2],
    closed: bool,
) -> bool {
    let mut points = points.to_vec();
    points.dedup_by(|b, a| (*b - *a).norm() < NO_LENGTH_MM);
    let back =
        points.len() > 3 && (points[points.len() - 1] - points[0]).norm() < NO_LENGTH_MM;
    if closed && !back && points.len() > 2 {
        points.push(points[0]);
    }
    if points.len() < 2 {
        return false;
    }
    let slopes = slopes(&points, directions, closed && points.len() > 3);
    pen.move_to(points[0]);
    for (k, pair) in points.windows(2).enumerate() {
        let length = (pair[1] - pair[0]).norm();
        let [a, b] = [slopes[k], slopes[k + 1]].map(|slope| slope * length / 3.0);
        pen.curve_to([pair[0] + a, pair[1] - b, pair[1]]);
    }
    pen.end();
    true
}

/// Derivatives at the points by arc length, so that second derivatives agree: the rows of a
/// tridiagonal system; where the ring closes, of one more lap at both ends, whose influence
/// falls by a factor of about four from point to point.
fn slopes(
    points: &[Point2],
    directions: [Option<Vector2>; 2],
    closed: bool,
) -> Vec<Vector2> {
    let count = points.len();
    if closed {
        let lap = &points[..count - 1];
        let laps: Vec<Point2> =
            lap.iter().cycle().take(3 * lap.len() + 1).copied().collect();
        let all = slopes(&laps, [None; 2], false);
        return all[lap.len()..=2 * lap.len()].to_vec();
    }
    let chord = |k: usize| points[k + 1] - points[k];
    let length = |k: usize| chord(k).norm();
    let mut rows: Vec<([f64; 3], Vector2)> = (1..count - 1)
        .map(|k| {
            let (a, b) = (length(k - 1), length(k));
            let right = chord(k - 1) * (b / a) + chord(k) * (a / b);
            ([b, 2.0 * (a + b), a], right * 3.0)
        })
        .collect();
    let end = |k: usize, direction: Option<Vector2>, row: [f64; 3]| match direction {
        Some(direction) => ([0.0, 1.0, 0.0], direction.normalize()),
        None => (row, chord(k) * (3.0 / length(k))),
    };
    rows.insert(0, end(0, directions[0], [0.0, 2.0, 1.0]));
    rows.push(end(count - 2, directions[1], [1.0, 2.0, 0.0]));
    for k in 1..count {
        let (above, right) = rows[k - 1];
        let share = rows[k].0[0] / above[1];
        rows[k].0[1] -= share * above[2];
        rows[k].1 -= right * share;
    }
    let mut slopes = vec![Vector2::zeros(); count];
    for k in (0..count).rev() {
        let next = slopes.get(k + 1).copied().unwrap_or_default();
        slopes[k] = (rows[k].1 - next * rows[k].0[2]) / rows[k].0[1];
    }
    slopes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Contour, trig};
    use std::f64::consts::{FRAC_1_SQRT_2, PI};

    fn area(pen: &Pen) -> f64 {
        let [(vertices, true)] = pen.curves.as_slice() else {
            panic!("{:?}", pen.curves)
        };
        Contour { vertices: vertices.clone() }.signed_area()
    }

    #[test]
    fn splines_of_each_degree_close_around_their_area() {
        let ring = [(0.0, 0.0), (6.0, 0.0), (6.0, 6.0), (0.0, 6.0)];
        let points: Vec<Point2> =
            (0..7).map(|k| ring[k % 4]).map(|(x, y)| Point2::new(x, y)).collect();
        // Closed uniform splines over a square of 6: areas by integration of the pieces.
        for (degree, wanted) in [(1, 36.0), (2, 30.0), (3, 24.4)] {
            let points = &points[..4 + degree];
            let knots: Vec<f64> =
                (0..points.len() + degree + 1).map(|k| k as f64).collect();
            let mut pen = Pen::default();
            let weights = &[];
            assert!(Nurbs { degree, knots: &knots, points, weights }.draw(&mut pen));
            let area = area(&pen);
            assert!((area - wanted).abs() < 0.02, "degree {degree}: {area}");
        }
        let none = |degree, knots: &[f64], points: &[Point2]| {
            !Nurbs { degree, knots, points, weights: &[] }.draw(&mut Pen::default())
        };
        assert!(none(3, &[0.0, 1.0], &points));
        assert!(none(1, &[0.0, 2.0, 1.0, 3.0], &points[..2]));
    }

    #[test]
    fn a_circle_by_weights_keeps_its_area() {
        let corners = [
            (1, 0),
            (1, 1),
            (0, 1),
            (-1, 1),
            (-1, 0),
            (-1, -1),
            (0, -1),
            (1, -1),
            (1, 0),
        ];
        let points =
            corners.map(|(x, y)| Point2::new(20.0 * f64::from(x), 20.0 * f64::from(y)));
        let weights: Vec<f64> =
            (0..9).map(|k| if k % 2 == 0 { 1.0 } else { FRAC_1_SQRT_2 }).collect();
        let knots = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4].map(f64::from);
        let mut pen = Pen::default();
        let circle =
            Nurbs { degree: 2, knots: &knots, points: &points, weights: &weights };
        assert!(circle.draw(&mut pen));
        assert!((area(&pen) / (400.0 * PI) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn a_closed_curve_through_points_of_a_circle_is_nearly_that_circle() {
        let points: Vec<Point2> = (0..13)
            .map(|k| f64::from(k % 12) * PI / 6.0)
            .map(|a| Point2::new(trig::cos(a), trig::sin(a)) * 50.0)
            .collect();
        let mut pen = Pen::default();
        assert!(through(&mut pen, &points, [None; 2], true));
        assert!((area(&pen) / (2500.0 * PI) - 1.0).abs() < 2e-3, "{}", area(&pen));
        assert!(!through(&mut pen, &points[..1], [None; 2], false));
    }
}
