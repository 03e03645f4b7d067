//! One entity: its tags, and what lines it draws in its own coordinates.

use crate::drawing::Pen;
use crate::drawing::curves::Ellipse;
use crate::drawing::dxf::tags::Tag;
use crate::drawing::spline::{Nurbs, through};
use crate::geometry::{Point2, Vector2, Vector3, Vertex, trig};
use crate::tolerance::{NO_LENGTH_MM, UPRIGHT};

/// The tags of one entity, the first one its kind.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entity<'a>(pub(super) &'a [Tag<'a>]);

/// What an entity draws.
pub(super) enum Drawn {
    /// Corners, and whether the last leads back to the first.
    Line(Vec<Vertex>, bool),
    /// Nothing that is a line in the plane.
    Nothing,
    /// Lines that cannot be read.
    Unread,
    /// Lines in a plane that is not the drawing's.
    Tilted,
}

/// The entities in some tags.
pub(super) fn entities<'a>(tags: &'a [Tag<'a>]) -> Vec<Entity<'a>> {
    let begins: Vec<usize> = (0..tags.len()).filter(|&k| tags[k].0 == 0).collect();
    let ends = begins.iter().copied().skip(1).chain([tags.len()]);
    begins.iter().zip(ends).map(|(&from, to)| Entity(&tags[from..to])).collect()
}

impl<'a> Entity<'a> {
    pub(super) fn kind(&self) -> &'a str {
        &self.0[0].1
    }

    /// The first value of a group code.
    pub(super) fn text(&self, code: i32) -> Option<&'a str> {
        self.0.iter().find(|tag| tag.0 == code).map(|tag| tag.1.as_ref())
    }

    /// The first value of a group code, if it is a number.
    pub(super) fn given(&self, code: i32) -> Option<f64> {
        let number = self.text(code)?.parse::<f64>().ok();
        number.filter(|number| number.is_finite())
    }

    /// The first value of a group code; 0 if it is missing or no number.
    pub(super) fn number(&self, code: i32) -> f64 {
        self.given(code).unwrap_or(0.0)
    }

    /// All values of a group code that are numbers.
    fn numbers(&self, code: i32) -> Vec<f64> {
        let values = self.0.iter().filter(|tag| tag.0 == code);
        let numbers = values.filter_map(|tag| tag.1.parse::<f64>().ok());
        numbers.filter(|number| number.is_finite()).collect()
    }

    pub(super) fn flags(&self) -> i32 {
        self.number(70) as i32
    }

    pub(super) fn point(&self, x: i32, y: i32) -> Point2 {
        Point2::new(self.number(x), self.number(y))
    }

    fn points(&self, x: i32, y: i32) -> Vec<Point2> {
        let points = self.numbers(x).into_iter().zip(self.numbers(y));
        points.map(|(x, y)| Point2::new(x, y)).collect()
    }

    fn vertex(&self) -> Vertex {
        Vertex::arc(self.point(10, 20), self.number(42))
    }

    /// Whether its points are in the coordinates of its plane, which the extrusion direction
    /// gives; others are in the drawing's own.
    pub(super) fn has_plane(&self) -> bool {
        let is_3d = self.kind() == "POLYLINE" && self.flags() & 8 != 0;
        !is_3d && !matches!(self.kind(), "LINE" | "ELLIPSE" | "SPLINE")
    }

    /// 1 if its plane is the drawing's, -1 if it is that seen from behind, mirrored in x.
    pub(super) fn facing(&self) -> Option<f64> {
        let direction = [210, 220, 230].map(|code| self.number(code));
        let direction = Vector3::from(direction).try_normalize(0.0);
        let z = direction.map_or(1.0, |direction| direction.z);
        (z.abs() > 1.0 - UPRIGHT).then_some(z.signum())
    }

    /// The lines of an entity; `vertices` are those of a POLYLINE. Curves stay within
    /// `tolerance`, in units of the drawing.
    pub(super) fn drawn(&self, vertices: &[Self], tolerance: f64) -> Drawn {
        let kind = self.kind();
        let is_upright = kind == "LINE" && {
            let run = (self.point(11, 21) - self.point(10, 20)).norm();
            (self.number(31) - self.number(30)).abs() > UPRIGHT * run
        };
        let is_flat = matches!(kind, "LINE" | "SPLINE") || self.facing().is_some();
        match kind {
            "SEQEND" | "VERTEX" | "ATTRIB" | "POINT" | "VIEWPORT" => Drawn::Nothing,
            _ if is_upright || !is_flat => Drawn::Tilted,
            "LINE" => {
                let ends = [self.point(10, 20), self.point(11, 21)];
                Drawn::Line(ends.map(Vertex::line).to_vec(), false)
            }
            "ARC" => Drawn::Line(self.arc(), false),
            "CIRCLE" => {
                let (center, r) = (self.point(10, 20), self.number(40));
                let at = |x: f64| Vertex::arc(Point2::new(center.x + x, center.y), 1.0);
                Drawn::Line(vec![at(r), at(-r)], true)
            }
            "LWPOLYLINE" => Drawn::Line(self.corners(), self.flags() & 1 == 1),
            // Flags beyond 8 are meshes; those of the vertices, control points of splines.
            "POLYLINE" if self.flags() & !0b1000_1111 == 0 => {
                let drawn = vertices.iter().filter(|vertex| vertex.flags() & 16 == 0);
                Drawn::Line(drawn.map(Entity::vertex).collect(), self.flags() & 1 == 1)
            }
            "ELLIPSE" | "SPLINE" => {
                let mut pen = Pen::with_tolerance(tolerance);
                let is_drawn = self.curved(&mut pen);
                match pen.curves.pop() {
                    Some((corners, closed)) if is_drawn => Drawn::Line(corners, closed),
                    _ => Drawn::Unread,
                }
            }
            _ => Drawn::Unread,
        }
    }

    fn curved(&self, pen: &mut Pen) -> bool {
        if self.kind() == "ELLIPSE" {
            let center = self.point(10, 20);
            let major = self.point(11, 21).coords;
            let ratio = self.number(40) * self.facing().unwrap_or(1.0);
            let minor = Vector2::new(-major.y, major.x) * ratio;
            let ellipse = Ellipse { center, major, minor };
            ellipse.draw(pen, self.number(41), self.number(42));
            return true;
        }
        let points = self.points(10, 20);
        if points.is_empty() {
            let ends = [(12, 22), (13, 23)].map(|(x, y)| {
                let given = self.given(x).is_some().then(|| self.point(x, y).coords);
                given.filter(|direction| direction.norm() > NO_LENGTH_MM)
            });
            return through(pen, &self.points(11, 21), ends, self.flags() & 1 == 1);
        }
        let (knots, weights) = (self.numbers(40), self.numbers(41));
        let degree = self.number(71) as usize;
        Nurbs { degree, knots: &knots, points: &points, weights: &weights }.draw(pen)
    }

    /// The corners of an LWPOLYLINE: each begins with its x.
    fn corners(&self) -> Vec<Vertex> {
        let begins: Vec<usize> =
            (0..self.0.len()).filter(|&k| self.0[k].0 == 10).collect();
        let ends = begins.iter().copied().skip(1).chain([self.0.len()]);
        let corner = |(&from, to): (&usize, usize)| Entity(&self.0[from..to]).vertex();
        begins.iter().zip(ends).map(corner).collect()
    }

    /// An arc counter-clockwise from one angle to another, degrees.
    fn arc(&self) -> Vec<Vertex> {
        let (from, to) = (self.number(50), self.number(51));
        let sweep = (to - from).rem_euclid(360.0);
        let sweep = if sweep == 0.0 { 360.0 } else { sweep };
        let (center, radius) = (self.point(10, 20), self.number(40));
        let at = |degrees: f64| {
            let angle = degrees.to_radians();
            center + Vector2::new(trig::cos(angle), trig::sin(angle)) * radius
        };
        let bulge = trig::tan(sweep.to_radians() / 8.0);
        let middle = Vertex::arc(at(from + sweep / 2.0), bulge);
        vec![Vertex::arc(at(from), bulge), middle, Vertex::line(at(to))]
    }
}
