//! SVG as our exporter and drawing programs write it: shapes in groups, transformed or not.
//!
//! Lengths by SVG 1.1 §7: `width` and `height` carry the unit, `viewBox` says how many
//! user units they are; without a unit a user unit is 1/96 inch.

use crate::drawing::curves::{Ellipse, arc_to, raised};
use crate::drawing::{Curve, Drawing, DrawingError, Pen, chain, is_cut};
use crate::drawing::{KnownLayer, layer_coloured, layer_named};
use crate::geometry::{Point2, Vector2, Vertex};
use crate::tolerance::NO_LENGTH_MM;
use nalgebra::Matrix3;
use roxmltree::{Document, Node};
use svgtypes::{Length, LengthUnit, PathParser, PathSegment, Transform, ViewBox};

/// Reads the lines of an SVG file, in millimetres with y upward.
///
/// # Errors
/// [`DrawingError`] if the bytes are no SVG.
pub fn read_svg(bytes: &[u8], known: &[KnownLayer]) -> Result<Drawing, DrawingError> {
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
        drawing.walk(child, known, (page, ""), 0);
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
        known: &[KnownLayer],
        (outer, layer): (Matrix3<f64>, &'static str),
        depth: usize,
    ) {
        if !node.is_element() || depth > DEEPEST {
            return;
        }
        let own = node.attribute("transform").and_then(|text| text.parse().ok());
        let matrix = own.map_or(outer, |own| outer * matrix(own));
        let layer = layer_of(node, known).unwrap_or(layer);
        let mut pen = Pen::default();
        let mut exact = true;
        match node.tag_name().name() {
            "g" | "svg" | "a" => {
                for child in node.children() {
                    self.walk(child, known, (matrix, layer), depth + 1);
                }
            }
            "path" => exact = path(node.attribute("d").unwrap_or(""), &mut pen),
            "line" | "polyline" | "polygon" | "circle" => shape(node, &mut pen),
            "rect" => rectangle(node, &mut pen),
            "ellipse" => ellipse(node, &mut pen),
            "text" | "use" | "image" => exact = false,
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
fn layer_of(node: Node, known: &[KnownLayer]) -> Option<&'static str> {
    let names = node.attributes().filter(|a| ["id", "label"].contains(&a.name()));
    let named =
        names.filter_map(|attribute| layer_named(known, attribute.value())).next();
    let style = node.attribute("style").unwrap_or("");
    let styled = style.split(';').find_map(|rule| rule.trim().strip_prefix("stroke:"));
    let colour = styled.or(node.attribute("stroke")).and_then(|text| {
        let colour: svgtypes::Color = text.trim().parse().ok()?;
        layer_coloured(known, [colour.red, colour.green, colour.blue])
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

fn number(node: Node, name: &str) -> Option<f64> {
    let length = node.attribute(name).and_then(|text| text.parse::<Length>().ok());
    length.map(|length| length.number)
}

fn ellipse(node: Node, pen: &mut Pen) {
    let number = |name| number(node, name).unwrap_or(0.0);
    let (major, minor) =
        (Vector2::new(number("rx"), 0.0), Vector2::new(0.0, number("ry")));
    Ellipse { center: Point2::new(number("cx"), number("cy")), major, minor }
        .draw(pen, 0.0, 0.0);
}

/// A rectangle, its corners round or not (SVG 1.1 §9.2).
fn rectangle(node: Node, pen: &mut Pen) {
    let number = |name| number(node, name);
    let [x, y, w, h] = ["x", "y", "width", "height"].map(|n| number(n).unwrap_or(0.0));
    let (rx, ry) = (number("rx").or(number("ry")), number("ry").or(number("rx")));
    let (rx, ry) = (rx.unwrap_or(0.0).min(w / 2.0), ry.unwrap_or(0.0).min(h / 2.0));
    if rx <= 0.0 || ry <= 0.0 {
        let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)];
        let corner = |(u, v)| Vertex::line(Point2::new(x + u, y + v));
        return pen.curves.push((corners.map(corner).to_vec(), true));
    }
    let (right, low) = (x + w, y + h);
    let sides = [
        [(x + rx, y), (right - rx, y)],
        [(right, y + ry), (right, low - ry)],
        [(right - rx, low), (x + rx, low)],
        [(x, low - ry), (x, y + ry)],
    ];
    let turn = |pen: &mut Pen, to| arc_to(pen, ([rx, ry], 0.0), (false, true), to);
    let sides = sides.map(|side| side.map(|(x, y)| Point2::new(x, y)));
    pen.move_to(sides[0][0]);
    for (k, [from, to]) in sides.into_iter().enumerate() {
        if k > 0 {
            turn(pen, from);
        }
        if (to - pen.at()).norm() > NO_LENGTH_MM {
            pen.line_to(to, 0.0);
        }
    }
    turn(pen, sides[0][0]);
    pen.close();
}

fn shape(node: Node, pen: &mut Pen) {
    let number = |name: &str| number(node, name).unwrap_or(0.0);
    let mut corners: Vec<Vertex> = match node.tag_name().name() {
        "line" => [("x1", "y1"), ("x2", "y2")]
            .map(|(x, y)| Vertex::line(Point2::new(number(x), number(y))))
            .to_vec(),
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

fn arc_of(segment: PathSegment, pen: &mut Pen, to: Point2) {
    if let PathSegment::EllipticalArc {
        rx, ry, x_axis_rotation, large_arc, sweep, ..
    } = segment
    {
        arc_to(pen, ([rx, ry], x_axis_rotation), (large_arc, sweep), to);
    }
}

/// Draws path data; false if there is something in it that cannot be read.
fn path(data: &str, pen: &mut Pen) -> bool {
    let (mut handle, mut quadratic): (Option<Point2>, Option<Point2>) = (None, None);
    for segment in PathParser::from(data) {
        let Ok(segment) = segment else { return false };
        let at = pen.at();
        let to = |abs: bool, x: f64, y: f64| {
            if abs { Point2::new(x, y) } else { Point2::new(at.x + x, at.y + y) }
        };
        let (last_handle, last_quadratic) = (handle.take(), quadratic.take());
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
            PathSegment::EllipticalArc { abs, x, y, .. } => {
                arc_of(segment, pen, to(abs, x, y));
            }
            PathSegment::ClosePath { .. } => pen.close(),
            PathSegment::Quadratic { abs, x1, y1, x, y } => {
                let handle = quadratic.insert(to(abs, x1, y1));
                pen.curve_to(raised(at, *handle, to(abs, x, y)));
            }
            PathSegment::SmoothQuadratic { abs, x, y } => {
                let handle = last_quadratic.map_or(at, |handle| at + (at - handle));
                pen.curve_to(raised(at, *quadratic.insert(handle), to(abs, x, y)));
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::LAYERS;

    #[test]
    fn what_inkscape_makes_of_a_circle_is_read_in_its_place() {
        let text = r##"<svg xmlns="http://www.w3.org/2000/svg" width="2in" height="1in"
            viewBox="0 0 20 10"><g transform="translate(1,2)" style="stroke:#ff0000">
            <path d="m 5,3 a 2,2 0 0 1 -4,0 2,2 0 0 1 4,0 z"/></g>
            <text>SPAM</text></svg>"##;
        let drawing = read_svg(text.as_bytes(), &LAYERS).unwrap();
        let [curve] = drawing.curves.as_slice() else { panic!("{drawing:?}") };
        assert!(curve.closed && curve.layer == "CUT_OUTER" && drawing.says_unit);
        let area = std::f64::consts::PI * 5.08 * 5.08;
        assert!((curve.contour().signed_area().abs() - area).abs() < 1e-9);
        assert!((curve.vertices[0].point - Point2::new(15.24, 12.7)).norm() < 1e-9);
        assert_eq!(drawing.unread.len(), 1);
    }

    #[test]
    fn round_corners_ellipses_and_quadratics_keep_their_area() {
        let read = |shape: &str| {
            let text = format!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="200mm" height="200mm"
                viewBox="0 0 200 200"><g transform="rotate(10)">{shape}</g></svg>"#
            );
            let drawing = read_svg(text.as_bytes(), &LAYERS).unwrap();
            let [curve] = drawing.curves.as_slice() else { panic!("{drawing:?}") };
            assert!(curve.closed && drawing.unread.is_empty(), "{drawing:?}");
            curve.contour().signed_area().abs()
        };
        let pi = std::f64::consts::PI;
        let rounded = 60.0 * 40.0 - (4.0 - pi) * 36.0;
        let uneven = 60.0 * 40.0 - (4.0 - pi) * 18.0;
        let ellipse = pi * 450.0;
        for (shape, wanted) in [
            (r#"<rect x="9" y="9" width="60" height="40" rx="6"/>"#, rounded),
            (r#"<rect x="9" y="9" width="60" height="40" rx="6" ry="3"/>"#, uneven),
            (r#"<rect width="60" height="12" ry="99"/>"#, pi * 180.0),
            (r#"<ellipse cx="90" cy="50" rx="30" ry="15"/>"#, ellipse),
            (r#"<path d="M60 50 a30 15 0 0 1 60 0 30 15 0 0 1 -60 0z"/>"#, ellipse),
            (r#"<path d="M0 0 q 30 30 60 0 t 60 0 V 60 H 0 z"/>"#, 7200.0),
        ] {
            let area = read(shape);
            assert!((area / wanted - 1.0).abs() < 1e-3, "{shape}: {area}, {wanted}");
        }
    }

    #[test]
    fn what_is_no_svg_is_an_error() {
        assert!(read_svg(b"<html/>", &LAYERS).is_err());
        assert!(read_svg(b"\xff\xfe", &LAYERS).is_err());
        assert!(
            read_svg(
                b"<svg width='0' viewBox='0 0 0 0'><path d='M0 0zz'/></svg>",
                &LAYERS
            )
            .is_ok()
        );
    }
}
