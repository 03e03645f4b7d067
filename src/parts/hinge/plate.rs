//! An eye plate and the end of the fin that laps with it.

use crate::geometry::{Contour, Point2, Region, Vertex, trig};
use crate::lettering::{letter, width};
use crate::parts::chain::{circle, quarter, without_doubles};
use crate::parts::connector::PlateText;
use crate::parts::end::EndFrame;
use crate::parts::fit::Fit;
use crate::parts::hinge::dimensions::Hinge;
use crate::parts::mark::{GAP, Mark, MarkKind};
use crate::parts::star::IncidentFin;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_8};

/// Shape of a plate: its origin on the axis, its tail along x, labelled face up.
pub(super) fn region(hinge: &Hinge, fit: &Fit) -> Region {
    let quarter = trig::tan(FRAC_PI_8);
    let (r, tail, half) = (hinge.radius, hinge.tail(), hinge.width / 2.0);
    let relief = fit.relief.min(half);
    let (floor, beyond) = (hinge.floor, hinge.floor - relief);
    let inner = if relief > 0.0 { -quarter } else { 0.0 };
    let at = |x: f64, y: f64| Point2::new(x, y);
    let mut vertices = vec![
        Vertex::line(at(tail, half)),
        Vertex::line(at(tail, r)),
        Vertex::arc(at(0.0, r), quarter),
        Vertex::arc(at(-r, 0.0), quarter),
        Vertex::line(at(0.0, -r)),
        Vertex::line(at(tail, -r)),
        Vertex::line(at(tail, -half)),
        Vertex::arc(at(floor, -half), inner),
        Vertex::line(at(beyond, relief - half)),
        Vertex::arc(at(beyond, half - relief), inner),
        Vertex::line(at(floor, half)),
    ];
    without_doubles(&mut vertices);
    let rod = circle(Point2::origin(), hinge.hole).reversed();
    Region { outline: Contour { vertices }, holes: vec![rod] }
}

/// The end edge of a fin with its slits for plates, from below.
pub(super) fn slits(
    hinge: &Hinge,
    frame: &EndFrame,
    fin: &IncidentFin,
    fit: &Fit,
) -> Vec<Vertex> {
    let start = hinge.setback;
    let corner = |edge| Vertex::line(frame.on_edge(start, edge));
    let place = hinge.star.fins.iter().position(|other| other.index == fin.index);
    let levels = place.map_or([0.0; 2], |place| hinge.levels[place]);
    let half = (hinge.thickness + fit.clearance) / 2.0;
    let radius = fit.relief.min(half).max(0.0);
    let (floor, bulge) = (start + hinge.lap, -frame.turn() * quarter(radius));
    let slits = levels.into_iter().flat_map(|level| {
        let (low, high) = (level - half, level + half);
        [
            Vertex::line(frame.at(start, low)),
            Vertex::arc(frame.at(floor, low), bulge),
            Vertex::line(frame.at(floor + radius, low + radius)),
            Vertex::arc(frame.at(floor + radius, high - radius), bulge),
            Vertex::line(frame.at(floor, high)),
            Vertex::line(frame.at(start, high)),
        ]
    });
    std::iter::once(corner(0)).chain(slits).chain([corner(1)]).collect()
}

/// The node's name, across the plate between eye and slit or along the tail.
pub(super) fn mark(hinge: &Hinge, text: &PlateText) -> Option<Mark> {
    let room = |size: f64| Some((width(text.name, size).ok()?, size));
    let sizes = [1.0, 0.8, 0.65, 0.5].map(|share| text.height * share);
    let [from, to] = [hinge.hole + GAP, hinge.floor - 2.0 * GAP];
    let across = |(long, size): (f64, f64)| {
        let fits = long + 2.0 * GAP <= 2.0 * hinge.radius && from + size <= to;
        fits.then(|| (Point2::new(from + size, -long / 2.0), FRAC_PI_2, size))
    };
    let beside = |(long, size): (f64, f64)| {
        let fits = hinge.width / 2.0 + size + 2.0 * GAP <= hinge.radius;
        let x = hinge.tail() - GAP - long;
        let at = Point2::new(x, hinge.width / 2.0 + GAP);
        (fits && x > hinge.hole).then_some((at, 0.0, size))
    };
    let rooms = || sizes.iter().filter_map(|size| room(*size));
    let (at, turn, size) = rooms().find_map(across).or(rooms().find_map(beside))?;
    let (sin, cos) = (trig::sin(turn), trig::cos(turn));
    let place = |p: &Point2| {
        Point2::new(at.x + p.x * cos - p.y * sin, at.y + p.x * sin + p.y * cos)
    };
    let strokes = letter(text.name, size).ok()?.strokes;
    let strokes = strokes.iter().map(|s| s.iter().map(place).collect()).collect();
    Some(Mark { kind: MarkKind::Engrave, strokes })
}
