//! Closed curves of straight lines and circular arcs, as a laser cutter takes them.

use crate::geometry::trig;
use crate::geometry::{Point2, Vector2};

/// A corner of a [`Contour`] and the way to the next one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// Where the corner is, mm.
    pub point: Point2,
    /// Tangent of a quarter of the angle swept on the way to the next corner: 0 is a
    /// straight line, positive turns counter-clockwise (DXF's "bulge").
    pub bulge: f64,
}

impl Vertex {
    /// A corner that a straight line leaves.
    pub const fn line(point: Point2) -> Self {
        Self { point, bulge: 0.0 }
    }

    /// A corner that an arc leaves.
    pub const fn arc(point: Point2, bulge: f64) -> Self {
        Self { point, bulge }
    }
}

/// A closed curve of lines and arcs; the last corner leads back to the first.
#[derive(Debug, Clone, PartialEq)]
pub struct Contour {
    /// The corners in order; the first is not repeated.
    pub vertices: Vec<Vertex>,
}

/// One line or arc of a contour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Start, mm.
    pub from: Point2,
    /// End, mm.
    pub to: Point2,
    /// As in [`Vertex::bulge`].
    pub bulge: f64,
}

/// A circular arc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// Centre, mm.
    pub center: Point2,
    /// Radius, mm.
    pub radius: f64,
    /// Direction from the centre to the start, radians.
    pub start: f64,
    /// Angle swept, radians; positive is counter-clockwise.
    pub sweep: f64,
}

impl Segment {
    /// The circle of this segment, or `None` for a straight line.
    pub fn arc(&self) -> Option<Arc> {
        if self.bulge == 0.0 {
            return None;
        }
        let chord = self.to - self.from;
        let middle = self.from + chord / 2.0;
        let offset = (1.0 - self.bulge * self.bulge) / (4.0 * self.bulge);
        let center = middle + Vector2::new(-chord.y, chord.x) * offset;
        let arm = self.from - center;
        Some(Arc {
            center,
            radius: arm.norm(),
            start: trig::atan2(arm.y, arm.x),
            sweep: 4.0 * trig::atan(self.bulge),
        })
    }

    /// Length along the segment, mm.
    pub fn length(&self) -> f64 {
        match self.arc() {
            Some(arc) => arc.radius * arc.sweep.abs(),
            None => (self.to - self.from).norm(),
        }
    }
}

impl Contour {
    /// A contour of straight lines through the points.
    pub fn polygon(points: impl IntoIterator<Item = Point2>) -> Self {
        Self { vertices: points.into_iter().map(Vertex::line).collect() }
    }

    /// The lines and arcs in order.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        let next = self.vertices.iter().cycle().skip(1);
        self.vertices.iter().zip(next).map(|(a, b)| Segment {
            from: a.point,
            to: b.point,
            bulge: a.bulge,
        })
    }

    /// The corners as a polygon, arcs replaced by chords that stay within `sagitta` mm.
    pub fn flattened(&self, sagitta: f64) -> Vec<Point2> {
        let mut points = Vec::with_capacity(self.vertices.len());
        for segment in self.segments() {
            points.push(segment.from);
            if let Some(arc) = segment.arc() {
                let pieces = chord_count(&arc, sagitta);
                points.extend((1..pieces).map(|k| {
                    let angle = arc.start + arc.sweep * f64::from(k) / f64::from(pieces);
                    arc.center
                        + Vector2::new(trig::cos(angle), trig::sin(angle)) * arc.radius
                }));
            }
        }
        points
    }

    /// The corners as a polygon that encloses a counter-clockwise contour: arcs that bulge
    /// outward are replaced by their tangents, all others as in [`Contour::flattened`].
    pub fn enclosing_polygon(&self, sagitta: f64) -> Vec<Point2> {
        let mut points = Vec::with_capacity(self.vertices.len());
        for segment in self.segments() {
            points.push(segment.from);
            let Some(arc) = segment.arc() else { continue };
            let pieces = chord_count(&arc, sagitta);
            let step = arc.sweep / f64::from(pieces);
            let (count, first, radius) = if arc.sweep > 0.0 {
                (pieces, 0.5, arc.radius / trig::cos(step / 2.0))
            } else {
                (pieces - 1, 1.0, arc.radius)
            };
            points.extend((0..count).map(|k| {
                let angle = arc.start + step * (f64::from(k) + first);
                arc.center + Vector2::new(trig::cos(angle), trig::sin(angle)) * radius
            }));
        }
        points
    }

    /// Length around, mm.
    pub fn length(&self) -> f64 {
        self.segments().map(|segment| segment.length()).sum()
    }

    /// Enclosed area, mm²; positive if counter-clockwise.
    pub fn signed_area(&self) -> f64 {
        self.segments()
            .map(|s| {
                let chord = s.from.x * s.to.y - s.to.x * s.from.y;
                let cap = s.arc().map_or(0.0, |arc| {
                    arc.radius * arc.radius * (arc.sweep - trig::sin(arc.sweep))
                });
                (chord + cap) / 2.0
            })
            .sum()
    }

    /// The same curve walked the other way.
    pub fn reversed(&self) -> Self {
        let mut vertices: Vec<Vertex> = Vec::with_capacity(self.vertices.len());
        let count = self.vertices.len();
        for k in (0..count).rev() {
            let before = self.vertices[(k + count - 1) % count];
            vertices.push(Vertex { point: self.vertices[k].point, bulge: -before.bulge });
        }
        Self { vertices }
    }

    /// The curve after `map` moved every corner; `map` must keep lengths and turning.
    pub fn moved(&self, map: impl Fn(Point2) -> Point2) -> Self {
        let vertices = self.vertices.iter();
        Self {
            vertices: vertices
                .map(|v| Vertex { point: map(v.point), bulge: v.bulge })
                .collect(),
        }
    }
}

/// How many chords follow an arc within `sagitta`.
fn chord_count(arc: &Arc, sagitta: f64) -> u32 {
    // A chord over the angle a leaves r (1 - cos(a/2)) ≈ r a²/8.
    let step = (8.0 * sagitta / arc.radius.max(sagitta)).sqrt();
    ((arc.sweep.abs() / step).ceil() as u32).clamp(1, 10_000)
}

/// A flat shape: one outer curve and the holes in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// The outer curve, counter-clockwise.
    pub outline: Contour,
    /// The holes, clockwise.
    pub holes: Vec<Contour>,
}

impl Region {
    /// Area of material, mm².
    pub fn area(&self) -> f64 {
        let holes: f64 = self.holes.iter().map(|hole| hole.signed_area().abs()).sum();
        self.outline.signed_area().abs() - holes
    }

    /// All curves, the outline first.
    pub fn contours(&self) -> impl Iterator<Item = &Contour> {
        std::iter::once(&self.outline).chain(&self.holes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc() -> Contour {
        let quarter = trig::tan(std::f64::consts::FRAC_PI_8);
        Contour {
            vertices: [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]
                .map(|(x, y)| Vertex::arc(Point2::new(x, y), quarter))
                .to_vec(),
        }
    }

    #[test]
    fn four_quarter_arcs_make_a_disc() {
        let pi = std::f64::consts::PI;
        assert!((disc().signed_area() - pi).abs() < 1e-12);
        assert!((disc().length() - 2.0 * pi).abs() < 1e-12);
        assert!((disc().reversed().signed_area() + pi).abs() < 1e-12);
    }

    #[test]
    fn the_enclosing_polygon_of_a_disc_touches_it_from_outside() {
        let points = disc().enclosing_polygon(1e-3);
        for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
            let apart = nalgebra::center(a, b).coords.norm();
            assert!((1.0 - 1e-12..1.001).contains(&apart), "{apart}");
        }
    }

    #[test]
    fn flattening_keeps_the_promised_distance() {
        let points = disc().flattened(1e-3);
        for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
            let sagitta = 1.0 - nalgebra::center(a, b).coords.norm();
            assert!(sagitta < 1.001e-3, "{sagitta}");
        }
    }
}
