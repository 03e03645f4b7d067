//! Arcs for formats that have no bulges: halved until they suit, or as Bézier curves.

use crate::geometry::{Point2, Segment, Vector2};
use crate::sheets::Path;
use crate::tolerance::WRITTEN_MM;

/// A step along a path of lines and cubic Bézier curves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Step {
    Move(Point2),
    Line(Point2),
    Cubic(Point2, Point2, Point2),
    /// Straight back to the start.
    Close,
}

/// The steps along a path, its arcs as Bézier curves that stay within `tolerance` mm.
pub(super) fn steps(path: &Path, tolerance: f64) -> Vec<Step> {
    match path {
        Path::Open(points) => {
            let first = points.first().map(|&p| Step::Move(p));
            let rest = points.iter().skip(1).map(|&p| Step::Line(p));
            first.into_iter().chain(rest).collect()
        }
        Path::Closed(contour) => {
            let mut steps = Vec::with_capacity(contour.vertices.len() + 2);
            steps.extend(contour.vertices.first().map(|v| Step::Move(v.point)));
            for segment in contour.segments() {
                if is_arc(&segment) {
                    let fine = |s: &Segment| bezier_error(s) <= tolerance;
                    steps.extend(halved_until(segment, &fine).iter().map(cubic));
                } else {
                    steps.push(Step::Line(segment.to));
                }
            }
            if let Some(Step::Line(_)) = steps.last() {
                steps.pop();
            }
            steps.push(Step::Close);
            steps
        }
    }
}

/// An arc cut in halves, and those again, until each piece is `fine`.
pub(super) fn halved_until(
    segment: Segment,
    fine: &impl Fn(&Segment) -> bool,
) -> Vec<Segment> {
    if fine(&segment) {
        return vec![segment];
    }
    let mut pieces = Vec::new();
    for half in halves(&segment) {
        pieces.extend(halved_until(half, fine));
    }
    pieces
}

/// Whether the segment can be told from its chord at the digits that files carry. Flatter
/// ones are written as lines: some readers lose themselves in radii beyond 1e9 mm.
pub(super) fn is_arc(segment: &Segment) -> bool {
    let sagitta = (segment.to - segment.from).norm() * segment.bulge.abs() / 2.0;
    sagitta >= WRITTEN_MM / 2.0
}

fn halves(segment: &Segment) -> [Segment; 2] {
    let &Segment { from, to, bulge } = segment;
    let chord = to - from;
    // A counter-clockwise arc lies to the right of its chord.
    let middle = from + chord / 2.0 + right(chord) * (bulge / 2.0);
    let bulge = bulge / (1.0 + (1.0 + bulge * bulge).sqrt()); // tan(atan(b) / 2)
    [Segment { from, to: middle, bulge }, Segment { from: middle, to, bulge }]
}

/// The usual cubic: tangent at both ends, through the middle of the arc. Its arms are
/// `4/3 r tan(sweep / 4)` long; with bulges this needs no trigonometry.
fn cubic(segment: &Segment) -> Step {
    let &Segment { from, to, bulge } = segment;
    let chord = to - from;
    let along = chord * ((1.0 - bulge * bulge) / 3.0);
    let aside = right(chord) * (2.0 * bulge / 3.0);
    Step::Cubic(from + along + aside, to - along + aside, to)
}

/// Largest distance of that cubic from the arc: `2/27 r sin⁶(sweep/4) / cos²(sweep/4)`.
fn bezier_error(segment: &Segment) -> f64 {
    let bulge = segment.bulge.abs();
    let squared = bulge * bulge;
    let chord = (segment.to - segment.from).norm();
    chord * squared * squared * bulge / (54.0 * (1.0 + squared))
}

fn right(v: Vector2) -> Vector2 {
    Vector2::new(v.y, -v.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Contour, Vertex};

    #[test]
    fn bezier_curves_stay_as_near_to_the_circle_as_promised() {
        for (radius, tolerance) in [(0.5, 1e-5), (100.0, 1e-5), (3000.0, 1e-3)] {
            let ends = [radius, -radius].map(|x| Vertex::arc(Point2::new(x, 0.0), 1.0));
            let circle = Path::Closed(Contour { vertices: ends.to_vec() });
            let mut at = Point2::origin();
            for step in steps(&circle, tolerance) {
                match step {
                    Step::Move(p) => at = p,
                    Step::Cubic(a, b, p) => {
                        for k in 0..=20 {
                            let off =
                                point_of([at, a, b, p], f64::from(k) / 20.0) - radius;
                            assert!(off.abs() < 1.01 * tolerance, "{radius} {off}");
                        }
                        at = p;
                    }
                    Step::Line(_) => panic!("a circle has no straight lines"),
                    Step::Close => {}
                }
            }
        }
    }

    /// Distance from the origin of a point on a cubic.
    fn point_of(p: [Point2; 4], t: f64) -> f64 {
        let s = 1.0 - t;
        let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        p.iter().zip(weights).map(|(p, w)| p.coords * w).sum::<Vector2>().norm()
    }

    #[test]
    fn halves_lie_on_the_same_circle() {
        for bulge in [-2.5, -0.3, 0.01, 1.0, 7.0] {
            let whole = Segment {
                from: Point2::new(1.0, 2.0),
                to: Point2::new(4.0, -2.0),
                bulge,
            };
            let circle = whole.arc().unwrap();
            for half in halves(&whole) {
                let arc = half.arc().unwrap();
                assert!((arc.center - circle.center).norm() < 1e-9);
                assert!((arc.sweep - circle.sweep / 2.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_straight_way_home_is_left_to_the_closing() {
        let corners =
            [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| Point2::new(x, y));
        let steps = steps(&Path::Closed(Contour::polygon(corners)), 1e-5);
        assert_eq!(steps.len(), 4);
        assert_eq!(steps[3], Step::Close);
    }
}
