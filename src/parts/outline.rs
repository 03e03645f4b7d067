//! The outline of a flat strip: its edges with slits cut into them, its two ends.

use crate::geometry::{Contour, Point2, Vector2, Vertex, trig};
use crate::parts::chain::reversed;
use crate::parts::fit::Fit;
use crate::parts::slit::{Opening, Slit};
use crate::parts::unfold::FlatAxis;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_8;

/// What becomes of one end of a strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum End {
    /// It stops on the axis; no other strip is there.
    Free,
    /// It runs past the axis by this much and laps.
    Overhang(f64),
    /// It stops this far before the axis and is not held.
    SetBack(f64),
    /// It stops this far before the axis and stands in discs.
    Held(f64),
}

/// What closes a strip (or a piece of one) at its left or right.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Closure {
    /// One of the strip's own ends.
    End(End),
    /// A cut through the fin beyond, from the bottom edge to the top edge; its first and
    /// last corners are left and reached straight.
    Splice(Vec<Vertex>),
    /// An end that stands in discs.
    Held(HeldEnd),
}

/// An end of a strip that stands in discs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct HeldEnd {
    /// From the bottom edge over the end edge to the top edge.
    pub cut: Vec<Vertex>,
    /// Where the end edge is, from the axis, mm.
    pub setback: f64,
    /// Heights on the axis whose lines to the far corners pass between the notches.
    pub heights: [f64; 2],
}

impl Closure {
    /// The cut through the part, if it is not made of the axis's own corners.
    fn cut(&self) -> Option<&[Vertex]> {
        match self {
            Self::Splice(cut) => Some(cut),
            Self::Held(held) => Some(&held.cut),
            Self::End(_) => None,
        }
    }

    /// How far from its axis the part stops, mm.
    pub(crate) const fn setback(&self) -> f64 {
        match self {
            Self::End(End::SetBack(distance) | End::Held(distance)) => *distance,
            Self::Held(held) => held.setback,
            Self::End(_) | Self::Splice(_) => 0.0,
        }
    }
}

/// A run of node axes with its slits (by place in `axes`) and closures.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Piece {
    /// The node axes.
    pub axes: Vec<FlatAxis>,
    /// Slits by place.
    pub slits: BTreeMap<usize, Slit>,
    /// Left and right closure.
    pub closures: [Closure; 2],
    /// The axes at the far ends of the fins that splices cut through, left and right.
    pub beyond: [Option<FlatAxis>; 2],
}

/// Which way along the strip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    Left,
    Right,
}

/// A corner of an edge, with the slit to be cut there.
struct Corner {
    point: Point2,
    notch: Option<Notch>,
}

/// A slit in the frame of its edge corner: `along` the edge as the outline runs
/// (counter-clockwise), `inward` along the node axis.
struct Notch {
    along: Vector2,
    inward: Vector2,
    first: f64,
    second: f64,
    depth: f64,
}

/// The outline of a piece, counter-clockwise: bottom edge, right end, top edge, left end.
pub(crate) fn outline(piece: &Piece, fit: &Fit) -> Contour {
    let [left, right] = [Way::Left, Way::Right].map(|way| ends(piece, way));
    let bottom = edge(piece, Opening::Bottom, &left, &right);
    let mut top = edge(piece, Opening::Top, &left, &right);
    top.reverse();
    let mut vertices = notched(&bottom, fit);
    if let Some(cut) = piece.closures[1].cut() {
        vertices.extend(inner(cut));
    }
    vertices.extend(notched(&top, fit));
    if let Some(cut) = piece.closures[0].cut() {
        vertices.extend(inner(&reversed(cut)));
    }
    Contour { vertices }
}

/// A cut without its two ends, which belong to the edges.
fn inner(cut: &[Vertex]) -> Vec<Vertex> {
    cut.get(1..cut.len().saturating_sub(1)).unwrap_or_default().to_vec()
}

/// Where the edges stop at one end of a piece.
struct Ends {
    /// Corner of the bottom edge and of the top edge; `None` if a cut makes them.
    corners: Option<[Point2; 2]>,
    /// Whether the last axis lies inside the outline.
    keeps_axis: bool,
}

fn ends(piece: &Piece, way: Way) -> Ends {
    let last = piece.axes.len() - 1;
    let axis = &piece.axes[if way == Way::Left { 0 } else { last }];
    // The next axis inward; beyond the splice, if a piece has one node only.
    let next = match (way, last) {
        (Way::Left, 0) => piece.beyond[1].as_ref().unwrap_or(axis),
        (Way::Right, 0) => piece.beyond[0].as_ref().unwrap_or(axis),
        (Way::Left, _) => &piece.axes[1],
        (Way::Right, _) => &piece.axes[last - 1],
    };
    match &piece.closures[way as usize] {
        Closure::Splice(_) => Ends { corners: None, keeps_axis: true },
        Closure::Held(_) => Ends { corners: None, keeps_axis: false },
        Closure::End(End::Free) => {
            Ends { corners: Some([axis.bottom(), axis.top()]), keeps_axis: false }
        }
        Closure::End(End::SetBack(distance) | End::Held(distance)) => {
            let toward = |from: Point2, to: Point2| {
                let run = (to - from).dot(&axis.right()).abs();
                from + (to - from) * (distance / run.max(*distance)).min(0.9)
            };
            let corners =
                [toward(axis.bottom(), next.bottom()), toward(axis.top(), next.top())];
            Ends { corners: Some(corners), keeps_axis: false }
        }
        Closure::End(End::Overhang(distance)) => {
            let reach = overhang(axis, next) * *distance;
            let corners = [axis.bottom() + reach, axis.top() + reach];
            Ends { corners: Some(corners), keeps_axis: true }
        }
    }
}

/// The way past an axis, one unit across it: straight on along the base mesh, but not
/// steeper than 45°.
fn overhang(axis: &FlatAxis, next: &FlatAxis) -> Vector2 {
    let onward = axis.foot - next.foot;
    let across = axis.right() * onward.dot(&axis.right()).signum();
    let slope = onward.dot(&axis.up) / onward.dot(&across);
    across + axis.up * slope.clamp(-1.0, 1.0)
}

/// One edge from left to right, its ends included.
fn edge(piece: &Piece, edge: Opening, left: &Ends, right: &Ends) -> Vec<Corner> {
    let pick = |corners: &Option<[Point2; 2]>| match (corners, edge) {
        (Some([bottom, _]), Opening::Bottom) => Some(*bottom),
        (Some([_, top]), Opening::Top) => Some(*top),
        (None, _) => None,
    };
    let last = piece.axes.len() - 1;
    let skip = |place: usize| {
        (place == 0 && !left.keeps_axis) || (place == last && !right.keeps_axis)
    };
    let inner = piece.axes.iter().enumerate().filter(|&(place, _)| !skip(place));
    let inner = inner.map(|(place, axis)| Corner {
        point: if edge == Opening::Top { axis.top() } else { axis.bottom() },
        notch: piece
            .slits
            .get(&place)
            .filter(|slit| slit.from == edge)
            .map(|slit| notch(axis, slit)),
    });
    let plain = |point| Corner { point, notch: None };
    let first = pick(&left.corners).or_else(|| cut_corner(piece, Way::Left, edge));
    let end = pick(&right.corners).or_else(|| cut_corner(piece, Way::Right, edge));
    first.map(plain).into_iter().chain(inner).chain(end.map(plain)).collect()
}

/// Where the cut of a splice or held end meets an edge.
fn cut_corner(piece: &Piece, way: Way, edge: Opening) -> Option<Point2> {
    let cut = piece.closures[way as usize].cut()?;
    let end = if edge == Opening::Bottom { cut.first() } else { cut.last() };
    end.map(|vertex| vertex.point)
}

fn notch(axis: &FlatAxis, slit: &Slit) -> Notch {
    let depth = slit.depth;
    match slit.from {
        Opening::Bottom => Notch {
            along: axis.right(),
            inward: axis.up,
            first: slit.before,
            second: slit.after,
            depth,
        },
        Opening::Top => Notch {
            along: -axis.right(),
            inward: -axis.up,
            first: slit.after,
            second: slit.before,
            depth,
        },
    }
}

/// The corners of an edge with its notches cut.
fn notched(edge: &[Corner], fit: &Fit) -> Vec<Vertex> {
    let mut vertices = Vec::new();
    for (k, corner) in edge.iter().enumerate() {
        let Some(notch) = &corner.notch else {
            vertices.push(Vertex::line(corner.point));
            continue;
        };
        let slope = |other: Option<&Corner>| {
            let way = other.map_or(Vector2::zeros(), |other| other.point - corner.point);
            let run = way.dot(&notch.along);
            if run == 0.0 { 0.0 } else { way.dot(&notch.inward) / run }
        };
        let before = slope(k.checked_sub(1).and_then(|k| edge.get(k)));
        let after = slope(edge.get(k + 1));
        let place = |along: f64, inward: f64| {
            corner.point + notch.along * along + notch.inward * inward
        };
        let mouth = |slope: f64, wall: f64| flare(fit, slope, wall);
        let entry = mouth(before, -notch.first);
        let exit = mouth(after, notch.second);
        vertices.extend(entry.iter().map(|&(s, q)| Vertex::line(place(s, q))));
        vertices.extend(floor(notch, fit, place));
        vertices.extend(exit.iter().rev().map(|&(s, q)| Vertex::line(place(s, q))));
    }
    vertices
}

/// The flared mouth at the wall at `wall` along the edge: from the edge to the wall.
fn flare(fit: &Fit, slope: f64, wall: f64) -> Vec<(f64, f64)> {
    let edge = slope * wall;
    let outward = wall.signum();
    let (sin, cos) = (trig::sin(fit.chamfer_angle), trig::cos(fit.chamfer_angle));
    let fall = cos + slope * outward * sin;
    if fit.chamfer <= 0.0 || fall < 0.2 {
        return vec![(wall, edge)];
    }
    let run = fit.chamfer / fall;
    let mouth = wall + outward * run * sin;
    vec![(mouth, slope * mouth), (wall, edge + fit.chamfer)]
}

/// The end of a slit: full-width walls to its depth, rounded corners beyond.
fn floor(notch: &Notch, fit: &Fit, place: impl Fn(f64, f64) -> Point2) -> Vec<Vertex> {
    let (left, right, depth) = (-notch.first, notch.second, notch.depth);
    let radius = fit.relief.min((right - left) / 2.0);
    if radius <= 0.0 {
        return vec![Vertex::line(place(left, depth)), Vertex::line(place(right, depth))];
    }
    let quarter = -trig::tan(FRAC_PI_8);
    let mut vertices = vec![Vertex::arc(place(left, depth), quarter)];
    if right - left > 2.0 * radius {
        vertices.push(Vertex::line(place(left + radius, depth + radius)));
    }
    vertices.push(Vertex::arc(place(right - radius, depth + radius), quarter));
    vertices.push(Vertex::line(place(right, depth)));
    vertices
}
