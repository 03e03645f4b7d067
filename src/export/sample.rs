//! A made-up sheet with everything an exporter can meet: arcs both ways, full-round
//! slits, circles, a nearly flat arc, open engravings, a part inside another's hole.

use crate::geometry::{Contour, Point2, Vertex, trig};
use crate::sheets::{Operation, Path, Sheet, Stroke};

pub(super) fn sample() -> Sheet {
    let stroke =
        |operation, part: usize, path| Stroke { operation, part: part.into(), path };
    let strokes = vec![
        stroke(Operation::Engrave, 0, open(&[(30.0, 60.0), (33.0, 66.0), (36.0, 60.0)])),
        stroke(Operation::Engrave, 1, open(&[(210.1, 55.5), (217.3, 55.5)])),
        stroke(Operation::Score, 0, open(&[(80.0, 22.0), (84.0, 78.0)])),
        stroke(Operation::CutInner, 0, closed(ring(40.0, 45.0, 1.6, -1.0))),
        stroke(Operation::CutOuter, 0, closed(slitted_strip())),
        stroke(Operation::CutInner, 1, closed(ring(230.0, 110.0, 40.0, -1.0))),
        stroke(Operation::CutOuter, 1, closed(ring(230.0, 110.0, 60.0, 1.0))),
        stroke(Operation::CutOuter, 2, closed(four_arcs(230.0, 110.0))),
    ];
    Sheet {
        id: "sheet-01".to_owned(),
        width: 300.0,
        height: 200.0,
        strokes,
        frame: vec![
            Path::Closed(Contour::polygon(
                [(0.0, 0.0), (300.0, 0.0), (300.0, 200.0), (0.0, 200.0)].map(point),
            )),
            open(&[(5.0, 190.0), (8.0, 196.0), (11.0, 190.0)]),
        ],
    }
}

fn point((x, y): (f64, f64)) -> Point2 {
    Point2::new(x, y)
}

fn open(points: &[(f64, f64)]) -> Path {
    Path::Open(points.iter().copied().map(point).collect())
}

fn closed(vertices: Vec<Vertex>) -> Path {
    Path::Closed(Contour { vertices })
}

/// A circle of two half turns, placed askew.
fn ring(x: f64, y: f64, radius: f64, bulge: f64) -> Vec<Vertex> {
    let (c, s) = (radius * trig::cos(0.7), radius * trig::sin(0.7));
    [(x + c, y + s), (x - c, y - s)].map(|p| Vertex::arc(point(p), bulge)).to_vec()
}

/// A strip, counter-clockwise, with a full-round slit from the top, a rounded corner, a
/// nearly flat lower edge and an upper edge that only pretends to be an arc.
fn slitted_strip() -> Vec<Vertex> {
    vec![
        Vertex::arc(Point2::new(12.345_678_9, 20.0), -0.002),
        Vertex::arc(Point2::new(140.0, 20.0), trig::tan(std::f64::consts::PI / 8.0)),
        Vertex::line(Point2::new(150.0, 30.0)),
        Vertex::line(Point2::new(150.0, 80.0)),
        Vertex::line(Point2::new(101.5, 80.0)),
        Vertex::arc(Point2::new(100.5, 50.0), -1.0),
        Vertex::line(Point2::new(97.5, 50.1)),
        Vertex::arc(Point2::new(98.5, 80.0), 1e-9),
        Vertex::line(Point2::new(12.0, 80.0)),
    ]
}

/// Three quarters of a circle around the middle, closed by smaller arcs bent inwards.
fn four_arcs(x: f64, y: f64) -> Vec<Vertex> {
    vec![
        Vertex::arc(Point2::new(x + 20.0, y), trig::tan(0.375 * std::f64::consts::PI)),
        Vertex::arc(Point2::new(x, y - 20.0), -0.3),
        Vertex::arc(Point2::new(x + 8.0, y - 9.0), -0.25),
    ]
}
