//! Curves where a matrix brings them.

use crate::drawing::Pen;
use crate::drawing::curves::Ellipse;
use crate::geometry::{Contour, Vector2, Vertex};
use crate::tolerance::NO_LENGTH_MM;
use nalgebra::Matrix3;

/// The corners of a curve moved; where circles become ellipses, arcs become several.
pub(super) fn transformed(
    vertices: &[Vertex],
    closed: bool,
    matrix: Matrix3<f64>,
) -> Vec<Vertex> {
    let linear = matrix.fixed_view::<2, 2>(0, 0).into_owned();
    let (x, y) = (linear.column(0), linear.column(1));
    let keeps_circles = (x.norm() - y.norm()).abs() < NO_LENGTH_MM * x.norm()
        && x.dot(&y).abs() < NO_LENGTH_MM * x.norm_squared();
    let curved = vertices.iter().any(|vertex| vertex.bulge.abs() > 0.0);
    let turn = linear.determinant().signum();
    if keeps_circles || !curved {
        let corner =
            |v: &Vertex| Vertex::arc(matrix.transform_point(&v.point), v.bulge * turn);
        return vertices.iter().map(corner).collect();
    }
    let steps = vertices.len() - usize::from(!closed);
    let mut pen = Pen::default();
    pen.move_to(matrix.transform_point(&vertices[0].point));
    for segment in (Contour { vertices: vertices.to_vec() }).segments().take(steps) {
        match segment.arc() {
            None => pen.line_to(matrix.transform_point(&segment.to), 0.0),
            Some(arc) => Ellipse {
                center: matrix.transform_point(&arc.center),
                major: linear * Vector2::new(arc.radius, 0.0),
                minor: linear * Vector2::new(0.0, arc.radius),
            }
            .draw_on(&mut pen, arc.start, arc.sweep),
        }
    }
    let mut corners = pen.vertices;
    if closed {
        corners.pop();
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point2;
    use std::f64::consts::PI;

    #[test]
    fn a_circle_sheared_and_stretched_is_an_ellipse_of_its_area() {
        let circle =
            [10.0, -10.0].map(|x| Vertex::arc(Point2::new(x, 0.0), 1.0)).to_vec();
        let matrix = Matrix3::new(2.0, 0.7, 5.0, 0.0, 0.5, 1.0, 0.0, 0.0, 1.0);
        let ellipse = Contour { vertices: transformed(&circle, true, matrix) };
        assert!((ellipse.signed_area() / (100.0 * PI) - 1.0).abs() < 1e-3);
    }
}
