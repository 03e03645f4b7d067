//! SVG as our exporter and drawing programs write it: shapes in groups, transformed or not.
//!
//! Lengths by SVG 1.1 §7: `width` and `height` carry the unit, `viewBox` says how many
//! user units they are; without a unit a user unit is 1/96 inch.

use crate::geometry::{Point2, Vertex};
use crate::proof::read::{Curve, Drawing, DrawingError, Pen, chain, is_cut};
use crate::proof::read::{layer_coloured, layer_named};
use crate::tolerance::NO_LENGTH_MM;
use nalgebra::Matrix3;
use roxmltree::{Document, Node};
use svgtypes::{Length, LengthUnit, PathParser, PathSegment, Transform, ViewBox};

/// Reads the lines of an SVG file, in millimetres with y upward.
///
/// # Errors
/// [`DrawingError`] if the bytes are no SVG.
pub(in crate::proof) fn read_svg(bytes: &[u8]) -> Result<Drawing, DrawingError> {
    let text = String::from_utf8_lossy(bytes);
    let other = |message: String| DrawingError::Other { message };
    let document = Document::parse(&text).map_err(|error| other(error.to_string()))?;
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        return Err(other(format!("its root is <{}>", root.tag_name().name())));
    }
    let (page, says_unit) = page(root);
    let mut drawing = Drawing { says_unit, ..Drawing::default() };
    for child in root.children() {
        drawing.walk(child, page, "", 0);
    }
    Ok(chain::joined(drawing, is_cut))
}

/// From user units to millimetres with y upward, and whether the file gives a unit.
fn page(root: Node) -> (Matrix3<f64>, bool) {
    let length = |name: &str| root.attribute(name)?.parse::<Length>().ok();
    let (width, height) = (length("width"), length("height"));
    let view = root.attribute("viewBox").and_then(|text| text.parse::<ViewBox>().ok());
    let mm = |length: Option<Length>, user: f64| {
        let Some(length) = length else { return user * 25.4 / 96.0 };
        length.number
            * match length.unit {
                LengthUnit::Mm => 1.0,
                LengthUnit::Cm => 10.0,
                LengthUnit::In => 25.4,
                LengthUnit::Pt => 25.4 / 72.0,
                LengthUnit::Pc => 25.4 / 6.0,
                LengthUnit::Percent => user / 100.0 * 25.4 / 96.0,
                _ => 25.4 / 96.0,
            }
    };
    let says_unit = width.is_some_and(|width| {
        !matches!(width.unit, LengthUnit::None | LengthUnit::Percent | LengthUnit::Px)
    });
    let user = |length: Option<Length>| length.map_or(100.0, |length| length.number);
    let view =
        view.unwrap_or(ViewBox { x: 0.0, y: 0.0, w: user(width), h: user(height) });
    let (across, up) = (mm(width, view.w), mm(height, view.h));
    let (x, y) = (across / view.w, up / view.h);
    let page = Matrix3::new(x, 0.0, -x * view.x, 0.0, -y, up + y * view.y, 0.0, 0.0, 1.0);
    (page, says_unit)
}

/// Groups in groups are followed so far; no drawing program goes as deep.
const DEEPEST: usize = 100;

impl Drawing {
    fn walk(
        &mut self,
        node: Node,
        outer: Matrix3<f64>,
        layer: &'static str,
        depth: usize,
    ) {
        if !node.is_element() || depth > DEEPEST {
            return;
        }
        let own = node.attribute("transform").and_then(|text| text.parse().ok());
        let matrix = own.map_or(outer, |own| outer * matrix(own));
        let layer = layer_of(node).unwrap_or(layer);
        let mut pen = Pen::default();
        let mut exact = true;
        match node.tag_name().name() {
            "g" | "svg" | "a" => {
                for child in node.children() {
                    self.walk(child, matrix, layer, depth + 1);
                }
            }
            "path" => exact = path(node.attribute("d").unwrap_or(""), &mut pen),
            "line" | "polyline" | "polygon" | "rect" | "circle" => shape(node, &mut pen),
            "ellipse" | "text" | "use" | "image" => exact = false,
            _ => {}
        }
        pen.lift();
        for (vertices, closed) in pen.curves {
            match moved(&vertices, matrix) {
                Some(vertices) => self.curves.push(Curve { layer, vertices, closed }),
                None => exact = false,
            }
        }
        if !exact {
            let kind = format!("<{}>", node.tag_name().name());
            *self.unread.entry((kind, layer)).or_default() += 1;
        }
    }
}

fn matrix(t: Transform) -> Matrix3<f64> {
    Matrix3::new(t.a, t.c, t.e, t.b, t.d, t.f, 0.0, 0.0, 1.0)
}

/// The layer that an element itself names: by id, by Inkscape's label, or by its colour.
fn layer_of(node: Node) -> Option<&'static str> {
    let names = node.attributes().filter(|a| ["id", "label"].contains(&a.name()));
    let named = names.filter_map(|attribute| layer_named(attribute.value())).next();
    let style = node.attribute("style").unwrap_or("");
    let styled = style.split(';').find_map(|rule| rule.trim().strip_prefix("stroke:"));
    let colour = styled.or(node.attribute("stroke")).and_then(|text| {
        let colour: svgtypes::Color = text.trim().parse().ok()?;
        layer_coloured([colour.red, colour.green, colour.blue])
    });
    named.or(colour)
}

/// Corners where the matrix brings them; arcs must stay arcs.
fn moved(vertices: &[Vertex], matrix: Matrix3<f64>) -> Option<Vec<Vertex>> {
    let linear = matrix.fixed_view::<2, 2>(0, 0);
    let (x, y) = (linear.column(0), linear.column(1));
    let keeps_circles = (x.norm() - y.norm()).abs() < NO_LENGTH_MM * x.norm()
        && x.dot(&y).abs() < NO_LENGTH_MM * x.norm_squared();
    let curved = vertices.iter().any(|vertex| vertex.bulge.abs() > 0.0);
    let turn = linear.determinant().signum();
    (keeps_circles || !curved).then(|| {
        let corner =
            |v: &Vertex| Vertex::arc(matrix.transform_point(&v.point), v.bulge * turn);
        vertices.iter().map(corner).collect()
    })
}

fn shape(node: Node, pen: &mut Pen) {
    let number = |name: &str| {
        let length = node.attribute(name).and_then(|text| text.parse::<Length>().ok());
        length.map_or(0.0, |length| length.number)
    };
    let (x, y) = (number("x"), number("y"));
    let mut corners: Vec<Vertex> = match node.tag_name().name() {
        "line" => [("x1", "y1"), ("x2", "y2")]
            .map(|(x, y)| Vertex::line(Point2::new(number(x), number(y))))
            .to_vec(),
        "rect" => {
            let (w, h) = (number("width"), number("height"));
            [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)]
                .map(|(u, v)| Vertex::line(Point2::new(x + u, y + v)))
                .to_vec()
        }
        "circle" => [number("r"), -number("r")]
            .map(|r| Vertex::arc(Point2::new(number("cx") + r, number("cy")), 1.0))
            .to_vec(),
        _ => {
            let points =
                svgtypes::PointsParser::from(node.attribute("points").unwrap_or(""));
            points.map(|(x, y)| Vertex::line(Point2::new(x, y))).collect()
        }
    };
    let closed = !matches!(node.tag_name().name(), "line" | "polyline");
    if !corners.is_empty() {
        pen.curves.push((std::mem::take(&mut corners), closed));
    }
}

/// Draws path data; false if there is something in it that is no line, arc or cubic.
fn path(data: &str, pen: &mut Pen) -> bool {
    let mut exact = true;
    let mut handle: Option<Point2> = None;
    for segment in PathParser::from(data) {
        let Ok(segment) = segment else { return false };
        let at = pen.at();
        let to = |abs: bool, x: f64, y: f64| {
            if abs { Point2::new(x, y) } else { Point2::new(at.x + x, at.y + y) }
        };
        let last_handle = handle.take();
        match segment {
            PathSegment::MoveTo { abs, x, y } => pen.move_to(to(abs, x, y)),
            PathSegment::LineTo { abs, x, y } => pen.line_to(to(abs, x, y), 0.0),
            PathSegment::HorizontalLineTo { abs, x } => {
                pen.line_to(Point2::new(to(abs, x, 0.0).x, at.y), 0.0);
            }
            PathSegment::VerticalLineTo { abs, y } => {
                pen.line_to(Point2::new(at.x, to(abs, 0.0, y).y), 0.0);
            }
            PathSegment::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                handle = Some(to(abs, x2, y2));
                pen.curve_to([to(abs, x1, y1), to(abs, x2, y2), to(abs, x, y)]);
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                let first = last_handle.map_or(at, |handle| at + (at - handle));
                handle = Some(to(abs, x2, y2));
                pen.curve_to([first, to(abs, x2, y2), to(abs, x, y)]);
            }
            PathSegment::EllipticalArc {
                abs, rx, ry, large_arc, sweep, x, y, ..
            } if (rx - ry).abs() < NO_LENGTH_MM => {
                arc(pen, rx, (large_arc, sweep), to(abs, x, y));
            }
            PathSegment::ClosePath { .. } => pen.close(),
            PathSegment::EllipticalArc { abs, x, y, .. }
            | PathSegment::Quadratic { abs, x, y, .. }
            | PathSegment::SmoothQuadratic { abs, x, y } => {
                pen.line_to(to(abs, x, y), 0.0);
                exact = false;
            }
        }
    }
    exact
}

/// An arc by radius and flags (SVG 1.1, F.6.5) as a bulge: with half the chord h and the
/// radius r, the tangent of a quarter of the angle is h / (r ± sqrt(r² - h²)).
fn arc(pen: &mut Pen, radius: f64, (large, sweep): (bool, bool), to: Point2) {
    let half = (to - pen.at()).norm() / 2.0;
    if half == 0.0 || radius == 0.0 {
        return pen.line_to(to, 0.0);
    }
    let radius = radius.abs().max(half);
    let rise = (radius * radius - half * half).max(0.0).sqrt();
    let bulge = half / (radius + if large { -rise } else { rise });
    // In the file y runs downward: there a positive sweep is a positive bulge.
    pen.line_to(to, if sweep { bulge } else { -bulge });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_inkscape_makes_of_a_circle_is_read_in_its_place() {
        let text = r##"<svg xmlns="http://www.w3.org/2000/svg" width="2in" height="1in"
            viewBox="0 0 20 10"><g transform="translate(1,2)" style="stroke:#ff0000">
            <path d="m 5,3 a 2,2 0 0 1 -4,0 2,2 0 0 1 4,0 z"/></g>
            <text>SPAM</text></svg>"##;
        let drawing = read_svg(text.as_bytes()).unwrap();
        let [curve] = drawing.curves.as_slice() else { panic!("{drawing:?}") };
        assert!(curve.closed && curve.layer == "CUT_OUTER" && drawing.says_unit);
        let area = std::f64::consts::PI * 5.08 * 5.08;
        assert!((curve.contour().signed_area().abs() - area).abs() < 1e-9);
        assert!((curve.vertices[0].point - Point2::new(15.24, 12.7)).norm() < 1e-9);
        assert_eq!(drawing.unread.len(), 1);
    }

    #[test]
    fn what_is_no_svg_is_an_error() {
        assert!(read_svg(b"<html/>").is_err());
        assert!(read_svg(b"\xff\xfe").is_err());
        assert!(
            read_svg(b"<svg width='0' viewBox='0 0 0 0'><path d='M0 0zz'/></svg>")
                .is_ok()
        );
    }
}
