//! The shapes of SVG (1.1 §8, §9) as curves in user units.

use crate::drawing::Pen;
use crate::drawing::curves::{Ellipse, arc_to, raised};
use crate::drawing::svg::viewport::Lengths;
use crate::geometry::{Point2, Vector2, Vertex};
use crate::tolerance::NO_LENGTH_MM;
use roxmltree::Node;
use svgtypes::{PathParser, PathSegment};

/// Whether an element of this name draws lines.
pub(super) fn is_shape(name: &str) -> bool {
    let shapes = ["path", "line", "polyline", "polygon", "circle", "rect", "ellipse"];
    shapes.contains(&name)
}

/// Draws a shape; false if there is something in it that cannot be read.
pub(super) fn draw(node: Node, lengths: &Lengths, pen: &mut Pen) -> bool {
    match node.tag_name().name() {
        "path" => return path(node.attribute("d").unwrap_or(""), pen),
        "rect" => rectangle(lengths, pen),
        "ellipse" => ellipse(lengths, pen),
        _ => simple(node, lengths, pen),
    }
    true
}

fn ellipse(lengths: &Lengths, pen: &mut Pen) {
    let number = |name: &str| lengths.of(name).unwrap_or(0.0);
    let (major, minor) =
        (Vector2::new(number("rx"), 0.0), Vector2::new(0.0, number("ry")));
    Ellipse { center: Point2::new(number("cx"), number("cy")), major, minor }
        .draw(pen, 0.0, 0.0);
}

/// A rectangle, its corners round or not (SVG 1.1 §9.2).
fn rectangle(lengths: &Lengths, pen: &mut Pen) {
    let number = |name: &str| lengths.of(name);
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

fn simple(node: Node, lengths: &Lengths, pen: &mut Pen) {
    let number = |name: &str| lengths.of(name).unwrap_or(0.0);
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
