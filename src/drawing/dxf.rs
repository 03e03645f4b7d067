//! DXF as our exporter and CAD programs write it: R12 to R2018, ASCII.
//!
//! Group codes by Autodesk's "DXF Reference": 0 begins an entity, 8 names its layer, 10
//! and 20 are a point, 42 a bulge, 70 flags, 230 the z of the extrusion direction (-1
//! mirrors the entity in x).

use crate::drawing::curves::{Ellipse, spline};
use crate::drawing::{Curve, Drawing, DrawingError, Pen, chain, is_cut};
use crate::drawing::{KnownLayer, layer_named};
use crate::geometry::{Point2, Vertex, trig};
use crate::units::Unit;

/// Reads the lines of a DXF file, in millimetres.
///
/// # Errors
/// [`DrawingError`] if the bytes are no ASCII DXF.
pub fn read_dxf(bytes: &[u8], known: &[KnownLayer]) -> Result<Drawing, DrawingError> {
    if bytes.starts_with(b"AutoCAD Binary DXF") {
        return Err(DrawingError::BinaryDxf);
    }
    let text = String::from_utf8_lossy(bytes);
    let tags = tags(&text)?;
    let unit = unit(&tags);
    let mut drawing = Drawing { says_unit: unit.is_some(), ..Drawing::default() };
    let scale = unit.unwrap_or(1.0);
    let mut entities = entities(&tags).into_iter().peekable();
    while let Some(entity) = entities.next() {
        let mut vertices = Vec::new();
        while entity.kind() == "POLYLINE"
            && let Some(vertex) = entities.next_if(|e| e.kind() == "VERTEX")
        {
            vertices.push(vertex);
        }
        drawing.add(&entity, &vertices, (scale, known));
    }
    Ok(chain::joined(drawing, is_cut))
}

/// A group code with its value.
type Tag<'a> = (i32, &'a str);

fn tags(text: &str) -> Result<Vec<Tag<'_>>, DrawingError> {
    let mut lines = text.lines().enumerate();
    let mut tags = Vec::new();
    while let Some((line, code)) = lines.next() {
        let Some((_, value)) = lines.next() else { break };
        let wrong = |_| DrawingError::Dxf {
            line: line + 1,
            message: format!("{:?} is no group code", code.trim()),
        };
        tags.push((code.trim().parse().map_err(wrong)?, value.trim()));
    }
    if tags.contains(&(2, "ENTITIES")) {
        Ok(tags)
    } else {
        let message = "there is no ENTITIES section".to_owned();
        Err(DrawingError::Dxf { line: text.lines().count(), message })
    }
}

/// Millimetres per drawing unit, if the header says so.
fn unit(tags: &[Tag]) -> Option<f64> {
    let variable = |name: &str| {
        let at = tags.iter().position(|tag| *tag == (9, name))?;
        tags.get(at + 1)?.1.parse::<i32>().ok()
    };
    let unit = match variable("$INSUNITS") {
        Some(1) => Unit::Inch,
        Some(2) => Unit::Foot,
        Some(4) => Unit::Millimetre,
        Some(5) => Unit::Centimetre,
        Some(6) => Unit::Metre,
        _ => return None,
    };
    Some(unit.millimetres())
}

/// The tags of one entity, the first one its kind.
struct Entity<'a>(&'a [Tag<'a>]);

fn entities<'a>(tags: &'a [Tag<'a>]) -> Vec<Entity<'a>> {
    let start = tags.iter().position(|tag| *tag == (2, "ENTITIES")).unwrap_or(0) + 1;
    let end = tags[start..].iter().position(|tag| *tag == (0, "ENDSEC"));
    let tags = &tags[start..end.map_or(tags.len(), |end| start + end)];
    let begins: Vec<usize> = (0..tags.len()).filter(|&k| tags[k].0 == 0).collect();
    let ends = begins.iter().copied().skip(1).chain([tags.len()]);
    begins.iter().zip(ends).map(|(&from, to)| Entity(&tags[from..to])).collect()
}

impl Entity<'_> {
    fn kind(&self) -> &str {
        self.0[0].1
    }

    fn layer(&self, known: &[KnownLayer]) -> &'static str {
        let name = self.0.iter().find(|tag| tag.0 == 8).map(|tag| tag.1);
        name.and_then(|name| layer_named(known, name)).unwrap_or("")
    }

    /// The first value of a group code; 0 if it is missing or no number.
    fn number(&self, code: i32) -> f64 {
        let value = self.0.iter().find(|tag| tag.0 == code);
        let number = value.and_then(|tag| tag.1.parse::<f64>().ok());
        number.filter(|number| number.is_finite()).unwrap_or(0.0)
    }

    /// All values of a group code that are numbers.
    fn numbers(&self, code: i32) -> Vec<f64> {
        let values = self.0.iter().filter(|tag| tag.0 == code);
        let numbers = values.filter_map(|tag| tag.1.parse::<f64>().ok());
        numbers.filter(|number| number.is_finite()).collect()
    }

    /// An ellipse or a spline without weights, in millimetres.
    fn curved(&self, scale: f64) -> Option<(Vec<Vertex>, bool)> {
        let mut pen = Pen::default();
        match self.kind() {
            "ELLIPSE" => {
                let center = self.point(10, 20) * scale;
                let major = self.point(11, 21).coords * scale;
                let ratio =
                    self.number(40) * if self.is_turned_over() { -1.0 } else { 1.0 };
                let minor = crate::geometry::Vector2::new(-major.y, major.x) * ratio;
                let ellipse = Ellipse { center, major, minor };
                ellipse.draw(&mut pen, self.number(41), self.number(42));
            }
            "SPLINE" if self.is_unweighted() => {
                let points = self.numbers(10).into_iter().zip(self.numbers(20));
                let points = points.map(|(x, y)| Point2::new(x, y) * scale);
                let (degree, points) =
                    (self.number(71) as usize, points.collect::<Vec<_>>());
                spline(&mut pen, degree, &self.numbers(40), &points);
            }
            _ => {}
        }
        pen.curves.pop()
    }

    /// Whether all control points of a spline count the same.
    fn is_unweighted(&self) -> bool {
        self.numbers(41).windows(2).all(|pair| pair[0].total_cmp(&pair[1]).is_eq())
    }

    fn is_turned_over(&self) -> bool {
        self.number(230) < 0.0
    }

    fn flags(&self) -> i32 {
        self.number(70) as i32
    }

    fn point(&self, x: i32, y: i32) -> Point2 {
        Point2::new(self.number(x), self.number(y))
    }

    fn vertex(&self) -> Vertex {
        Vertex::arc(self.point(10, 20), self.number(42))
    }

    /// The corners of an LWPOLYLINE: each begins with its x.
    fn corners(&self) -> Vec<Vertex> {
        let begins: Vec<usize> =
            (0..self.0.len()).filter(|&k| self.0[k].0 == 10).collect();
        let ends = begins.iter().copied().skip(1).chain([self.0.len()]);
        begins
            .iter()
            .zip(ends)
            .map(|(&from, to)| Entity(&self.0[from..to]).vertex())
            .collect()
    }

    /// An arc counter-clockwise from one angle to another, degrees.
    fn arc(&self) -> Vec<Vertex> {
        let (from, to) = (self.number(50), self.number(51));
        let sweep = (to - from).rem_euclid(360.0);
        let sweep = if sweep == 0.0 { 360.0 } else { sweep };
        let (center, radius) = (self.point(10, 20), self.number(40));
        let at = |degrees: f64| {
            let angle = degrees.to_radians();
            center
                + crate::geometry::Vector2::new(trig::cos(angle), trig::sin(angle))
                    * radius
        };
        let bulge = trig::tan(sweep.to_radians() / 8.0);
        let middle = Vertex::arc(at(from + sweep / 2.0), bulge);
        vec![Vertex::arc(at(from), bulge), middle, Vertex::line(at(to))]
    }
}

impl Drawing {
    fn add(
        &mut self,
        entity: &Entity,
        vertices: &[Entity],
        (scale, known): (f64, &[KnownLayer]),
    ) {
        let layer = entity.layer(known);
        if let Some((corners, closed)) = entity.curved(scale) {
            self.curves.extend(plain(layer, corners, closed));
            return;
        }
        let (mut corners, closed) = match entity.kind() {
            "LINE" => {
                let ends = [entity.point(10, 20), entity.point(11, 21)];
                (ends.map(Vertex::line).to_vec(), false)
            }
            "ARC" => (entity.arc(), false),
            "CIRCLE" => {
                let (center, r) = (entity.point(10, 20), entity.number(40));
                let at = |x: f64| Vertex::arc(Point2::new(center.x + x, center.y), 1.0);
                (vec![at(r), at(-r)], true)
            }
            "LWPOLYLINE" => (entity.corners(), entity.flags() & 1 == 1),
            // Flags beyond 8 are meshes; those of the vertices, control points of splines.
            "POLYLINE" if entity.flags() & !0b1000_1001 == 0 => {
                let drawn = vertices.iter().filter(|vertex| vertex.flags() & 16 == 0);
                (drawn.map(Entity::vertex).collect(), entity.flags() & 1 == 1)
            }
            "SEQEND" | "VERTEX" | "ATTRIB" | "POINT" => return,
            other => {
                *self.unread.entry((other.to_owned(), layer)).or_default() += 1;
                return;
            }
        };
        let mirrored = if entity.is_turned_over() { -1.0 } else { 1.0 };
        for vertex in &mut corners {
            let p = vertex.point * scale;
            *vertex =
                Vertex::arc(Point2::new(p.x * mirrored, p.y), vertex.bulge * mirrored);
        }
        self.curves.extend(plain(layer, corners, closed));
    }
}

/// The curve without corners that repeat the one before; `None` if nothing is left.
fn plain(layer: &'static str, mut corners: Vec<Vertex>, closed: bool) -> Option<Curve> {
    corners.dedup_by(|b, a| {
        let repeats = a.point == b.point;
        if repeats {
            a.bulge = b.bulge;
        }
        repeats
    });
    let (first, last) = (corners.first()?.point, corners.last()?.point);
    let is_circle = corners.len() == 2 && closed;
    let mut closed = closed;
    if corners.len() > 2 && first == last {
        corners.pop();
        closed = true;
    }
    (corners.len() > 2 || is_circle || (corners.len() == 2 && !closed)).then_some(Curve {
        layer,
        vertices: corners,
        closed,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::LAYERS;

    fn file(header: &str, entities: &str) -> Vec<u8> {
        let spaced = format!(
            "0 SECTION 2 HEADER {header} 0 ENDSEC 0 SECTION 2 ENTITIES {entities} 0 ENDSEC 0 EOF"
        );
        spaced.split_whitespace().collect::<Vec<_>>().join("\r\n").into_bytes()
    }

    #[test]
    fn lines_and_arcs_become_one_contour_in_any_order_and_direction() {
        let entities = "0 LINE 8 cut_outer 10 0 20 0 11 10 21 0 \
                        0 LINE 8 CUT_OUTER 10 0 20 4 11 10 21 4 \
                        0 ARC 8 CUT_OUTER 10 10 20 2 40 2 50 270 51 90 \
                        0 LINE 8 CUT_OUTER 10 0 20 4 11 0 21 0";
        let drawing = read_dxf(&file("9 $INSUNITS 70 4", entities), &LAYERS).unwrap();
        let [curve] = drawing.curves.as_slice() else { panic!("{drawing:?}") };
        assert!(curve.closed && curve.layer == "CUT_OUTER" && drawing.says_unit);
        let area = 40.0 + 2.0 * std::f64::consts::PI;
        assert!((curve.contour().signed_area().abs() - area).abs() < 1e-9);
    }

    #[test]
    fn a_line_drawn_twice_is_kept_once_and_told() {
        let entities = "0 LINE 8 CUT_OUTER 10 0 20 0 11 10 21 0 \
                        0 LINE 8 CUT_OUTER 10 10 20 0 11 0 21 0 \
                        0 LINE 8 CUT_OUTER 10 10 20 0 11 0 21 9 \
                        0 LINE 8 CUT_OUTER 10 0 20 9 11 0 21 0";
        let drawing = read_dxf(&file("", entities), &LAYERS).unwrap();
        assert_eq!((drawing.curves.len(), drawing.doubled.len()), (1, 1));
        assert!(drawing.curves[0].closed && !drawing.says_unit);
    }

    #[test]
    fn inches_become_millimetres_and_a_turned_over_polyline_is_mirrored() {
        let entities = "0 LWPOLYLINE 8 CUT_OUTER 90 3 70 1 \
                        10 1 20 0 42 0.5 10 2 20 0 10 2 20 1 230 -1";
        let drawing = read_dxf(&file("9 $INSUNITS 70 1", entities), &LAYERS).unwrap();
        let first = drawing.curves[0].vertices[0];
        assert!(
            (first.point.x + 25.4).abs() < 1e-12 && (first.bulge + 0.5).abs() < 1e-12
        );
    }

    #[test]
    fn half_an_ellipse_and_a_spline_become_one_contour() {
        // The spline is the straight line back, as a cubic.
        let entities = "0 ELLIPSE 8 CUT_OUTER 10 5 20 0 11 3 21 0 40 0.5 41 0 42 3.141592653589793 \
                        0 SPLINE 8 CUT_OUTER 70 8 71 3 40 0 40 0 40 0 40 0 40 1 40 1 40 1 40 1 \
                        10 2 20 0 10 4 20 0 10 6 20 0 10 8 20 0";
        let drawing = read_dxf(&file("9 $INSUNITS 70 1", entities), &LAYERS).unwrap();
        let [curve] = drawing.curves.as_slice() else { panic!("{drawing:?}") };
        assert!(curve.closed && drawing.unread.is_empty());
        let area = std::f64::consts::PI * 3.0 * 1.5 / 2.0 * 25.4 * 25.4;
        assert!((curve.contour().signed_area().abs() / area - 1.0).abs() < 1e-3);
    }

    #[test]
    fn what_is_no_dxf_is_an_error_with_its_line() {
        let error = read_dxf(b"0\nSECTION\nhello\nworld\n", &LAYERS).unwrap_err();
        assert!(matches!(error, DrawingError::Dxf { line: 3, .. }), "{error}");
        assert_eq!(
            read_dxf(b"AutoCAD Binary DXF\r\n", &LAYERS),
            Err(DrawingError::BinaryDxf)
        );
        assert!(read_dxf(b"", &LAYERS).is_err());
    }
}
