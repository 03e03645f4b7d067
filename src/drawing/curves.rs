//! Ellipses and elliptical arcs, drawn as cubic Bézier curves.

use crate::drawing::Pen;
use crate::geometry::{Point2, Segment, Vector2, trig};
use crate::tolerance::NO_LENGTH_MM;
use std::f64::consts::TAU;

/// Curves in a whole ellipse: with eight they are off by 4e-6 of the radius.
const PIECES: f64 = 8.0;

/// The image of the unit circle: x along `major`, y along `minor`.
pub(super) struct Ellipse {
    pub(super) center: Point2,
    pub(super) major: Vector2,
    pub(super) minor: Vector2,
}

impl Ellipse {
    fn at(&self, x: f64, y: f64) -> Point2 {
        self.center + self.major * x + self.minor * y
    }

    /// Draws on from where the pen is, at the angle `start` of the circle, by `sweep`.
    pub(super) fn draw_on(&self, pen: &mut Pen, start: f64, sweep: f64) {
        let count = (sweep.abs() / TAU * PIECES).ceil().max(1.0);
        let step = sweep / count;
        let handle = 4.0 / 3.0 * trig::tan(step / 4.0);
        for piece in 0..count as usize {
            let angles = [piece, piece + 1].map(|k| start + step * k as f64);
            let [(a, b), (c, d)] = angles.map(|t| (trig::cos(t), trig::sin(t)));
            pen.curve_to([
                self.at(a - handle * b, b + handle * a),
                self.at(c + handle * d, d - handle * c),
                self.at(c, d),
            ]);
        }
    }

    /// Draws the part from an angle of the circle to another; the whole if they are the same.
    pub(super) fn draw(&self, pen: &mut Pen, from: f64, to: f64) {
        let sweep = (to - from).rem_euclid(TAU);
        pen.move_to(self.at(trig::cos(from), trig::sin(from)));
        let is_whole = sweep < FULL || TAU - sweep < FULL;
        self.draw_on(pen, from, if is_whole { TAU } else { sweep });
        if is_whole { pen.close() } else { pen.lift() }
    }
}

/// Radians by which a whole turn may be missed as written.
const FULL: f64 = NO_LENGTH_MM;

/// The bulge of an arc by half its chord, its radius and flags (SVG 1.1, F.6.5): the tangent
/// of a quarter of the angle is h / (r ± sqrt(r² - h²)). A positive sweep is a positive bulge.
fn bulge(half: f64, radius: f64, (large, sweep): (bool, bool)) -> f64 {
    let radius = radius.abs().max(half);
    let rise = (radius * radius - half * half).max(0.0).sqrt();
    let bulge = half / (radius + if large { -rise } else { rise });
    if sweep { bulge } else { -bulge }
}

/// An elliptical arc by radii, the turn of the first in degrees, and flags; of a circle it
/// stays one. Where y runs downward a positive sweep is a positive bulge all the same.
pub(super) fn arc_to(
    pen: &mut Pen,
    (radii, degrees): ([f64; 2], f64),
    flags: (bool, bool),
    to: Point2,
) {
    let [rx, ry] = radii.map(f64::abs);
    let from = pen.at();
    if rx == 0.0 || ry == 0.0 || from == to {
        return pen.line_to(to, 0.0);
    }
    if (rx - ry).abs() < NO_LENGTH_MM {
        return pen.line_to(to, bulge((to - from).norm() / 2.0, rx, flags));
    }
    let angle = degrees.to_radians();
    let (u, v) = (
        Vector2::new(trig::cos(angle), trig::sin(angle)),
        Vector2::new(-trig::sin(angle), trig::cos(angle)),
    );
    // Where it is an arc of the unit circle.
    let flat = |p: Point2| Point2::new(p.coords.dot(&u) / rx, p.coords.dot(&v) / ry);
    let (a, b) = (flat(from), flat(to));
    let bulge = bulge((b - a).norm() / 2.0, 1.0, flags);
    let Some(arc) = (Segment { from: a, to: b, bulge }).arc() else { return };
    let center = Point2::from(u * (rx * arc.center.x) + v * (ry * arc.center.y));
    let (major, minor) = (u * (rx * arc.radius), v * (ry * arc.radius));
    Ellipse { center, major, minor }.draw_on(pen, arc.start, arc.sweep);
}

/// The handles of a cubic that is the quadratic with this one.
pub(super) fn raised(from: Point2, handle: Point2, to: Point2) -> [Point2; 3] {
    let toward = |p: Point2| p + (handle - p) * (2.0 / 3.0);
    [toward(from), toward(to), to]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Contour;
    use std::f64::consts::PI;

    fn area(pen: Pen) -> f64 {
        let [(vertices, true)] = pen.curves.as_slice() else {
            panic!("{:?}", pen.curves)
        };
        Contour { vertices: vertices.clone() }.signed_area()
    }

    #[test]
    fn two_halves_of_a_leaning_ellipse_are_the_whole() {
        let mut pen = Pen::default();
        let (c, s) = (trig::cos(0.5), trig::sin(0.5));
        let end = Point2::new(30.0 * c, 30.0 * s);
        pen.move_to(end);
        let radii = ([30.0, 15.0], 0.5_f64.to_degrees());
        arc_to(&mut pen, radii, (false, true), -end);
        arc_to(&mut pen, radii, (true, true), end);
        pen.close();
        assert!((area(pen) / (PI * 30.0 * 15.0) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_quadratic_keeps_its_middle() {
        let [from, handle, to] =
            [(0.0, 0.0), (3.0, 8.0), (9.0, 1.0)].map(|(x, y)| Point2::new(x, y));
        let [a, b, _] = raised(from, handle, to);
        let middle =
            |p: &[(Point2, f64)]| p.iter().map(|(p, w)| p.coords * *w).sum::<Vector2>();
        let cubic = middle(&[(from, 0.125), (a, 0.375), (b, 0.375), (to, 0.125)]);
        let quadratic = middle(&[(from, 0.25), (handle, 0.5), (to, 0.25)]);
        assert!((cubic - quadratic).norm() < 1e-12);
    }
}
