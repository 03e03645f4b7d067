//! The kerf taken out of a drawn line.
//!
//! Not by the offset that put it in (`geometry::offset`), which would take its own mistakes
//! out again: every side is moved as the line that it lies on, and two lines meet where
//! both equations hold.

use crate::geometry::{Contour, Segment, Vector2, Vertex};
use crate::tolerance::SMOOTH_CORNER;

/// The contour whose path to cut is `path`, material to its left: each side comes half a
/// kerf, mm, nearer to the material. Arcs must meet their neighbours without a corner.
pub(super) fn without_kerf(path: &Contour, kerf: f64) -> Contour {
    let sides: Vec<Segment> = path.segments().collect();
    let normals: Vec<[Vector2; 2]> = sides.iter().map(normals).collect();
    let vertex = |k: usize| {
        let [_, before] = normals[(k + sides.len() - 1) % sides.len()];
        let [after, _] = normals[k];
        let point = sides[k].from + shift(before, after, kerf / 2.0);
        Vertex { point, bulge: sides[k].bulge }
    };
    Contour { vertices: (0..sides.len()).map(vertex).collect() }
}

/// Unit vectors to the left at the start and at the end of a side. The tangent of an arc of
/// bulge `b = tan(sweep / 4)` is its chord turned by half its sweep, whose cosine is
/// `(1 - b²) / (1 + b²)` and whose sine is `2 b / (1 + b²)`.
fn normals(side: &Segment) -> [Vector2; 2] {
    let Some(chord) = (side.to - side.from).try_normalize(0.0) else {
        return [Vector2::zeros(); 2];
    };
    let left = Vector2::new(-chord.y, chord.x);
    let square = side.bulge * side.bulge;
    let (cos, sin) = ((1.0 - square) / (1.0 + square), 2.0 * side.bulge / (1.0 + square));
    [left * cos + chord * sin, left * cos - chord * sin]
}

/// The `x` of `before · x = after · x = by`.
fn shift(before: Vector2, after: Vector2, by: f64) -> Vector2 {
    let determinant = before.perp(&after);
    if determinant.abs() > SMOOTH_CORNER {
        let across = before - after;
        Vector2::new(-across.y, across.x) * (by / determinant)
    } else if before.dot(&after) > 0.0 {
        after * by
    } else {
        // A line that runs back on itself has no inside.
        Vector2::zeros()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point2;
    use crate::sheets::Kerf;

    #[test]
    fn what_the_offset_put_in_comes_out_another_way() {
        let corner = |x, y| Vertex::line(Point2::new(x, y));
        let quarter = |x, y, bulge| Vertex::arc(Point2::new(x, y), bulge);
        let bulge = std::f64::consts::SQRT_2 - 1.0;
        // A slit with round ends, an oblique corner, an arc outwards.
        let part = Contour {
            vertices: vec![
                corner(0.0, 0.0),
                corner(40.0, -3.0),
                corner(40.0, 10.0),
                quarter(40.0, 28.0, bulge),
                corner(38.0, 30.0),
                corner(23.0, 30.0),
                corner(23.0, 11.0),
                quarter(23.0, 10.5, -bulge),
                quarter(22.5, 10.0, -bulge),
                corner(22.0, 10.5),
                corner(22.0, 30.0),
                corner(5.0, 30.0),
            ],
        };
        for kerf in [0.2, -0.3] {
            let path = Kerf::from_width_mm(kerf).compensated(&part);
            let back = without_kerf(&path, kerf);
            assert_eq!(back.vertices.len(), part.vertices.len());
            for (a, b) in back.vertices.iter().zip(&part.vertices) {
                assert!((a.point - b.point).norm() < 1e-9, "{a:?} {b:?}");
            }
        }
    }
}
