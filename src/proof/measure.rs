//! Measured on the drawn outline of a strip: where its axes lie and what its slits are.
//!
//! An axis end without a slit is a corner of the outline. One that a slit took away is
//! found from the other end of its axis, for the corner moves with it; the walls are then
//! measured from that axis.

use crate::geometry::{Contour, Point2, Vector2};
use crate::manifest::{OpenEdge, RunEntry, SlitEntry};
use crate::proof::shape::Edges;
use crate::tolerance::{NO_LENGTH_MM, PROOF_REACH_MM, SAME_SHAPE_MM};

/// A node axis on the flat part: bottom and top.
pub(super) type FlatAxis = [Point2; 2];

/// A slit as it was drawn, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Notch {
    /// From the axis to the wall on the side of the previous node: the tightest place.
    pub before: f64,
    /// The same on the side of the next node.
    pub after: f64,
    /// From the edge to where the first wall ends.
    pub depth: f64,
    /// Middle of the mouth, in part coordinates.
    pub at: Point2,
}

/// A strip as it was drawn.
pub(super) struct Measured {
    /// By place along the strip; `None` where the outline has no such corner.
    pub axes: Vec<Option<FlatAxis>>,
    /// By place; `None` where a listed slit is not there.
    pub slits: Vec<(usize, Option<Notch>)>,
}

/// Measures a strip on its outline in part coordinates. `listed` is the outline as listed.
pub(super) fn measure(
    strip: &RunEntry,
    listed: &[Point2],
    outline: &Contour,
) -> Measured {
    let tape = Tape {
        listed: Edges::of_points(listed.iter().copied()),
        corners: Edges::of_points(outline.vertices.iter().map(|vertex| vertex.point)),
        outline,
    };
    let places = 0..strip.nodes.len();
    let axes: Vec<_> = places.clone().map(|place| tape.axis(strip, place)).collect();
    let slits = places.filter_map(|place| Some((place, strip.slit_at(place)?)));
    let slits = slits.map(|(place, slit)| {
        let listed = [strip.axes[place].bottom, strip.axes[place].top];
        (place, tape.notch(slit, axes[place].unwrap_or(listed)))
    });
    Measured { slits: slits.collect(), axes }
}

struct Tape<'a> {
    /// Corners as listed.
    listed: Edges,
    /// Corners as drawn.
    corners: Edges,
    outline: &'a Contour,
}

impl Tape<'_> {
    fn axis(&self, strip: &RunEntry, place: usize) -> Option<FlatAxis> {
        let axis = strip.axes[place];
        let bottom = || self.end(axis.bottom);
        let top = || self.end(axis.top);
        match strip.slit_at(place).map(|slit| slit.from) {
            Some(OpenEdge::Top) => {
                bottom().map(|off| [axis.bottom + off, axis.top + off])
            }
            Some(OpenEdge::Bottom) => {
                top().map(|off| [axis.bottom + off, axis.top + off])
            }
            None => Some([axis.bottom + bottom()?, axis.top + top()?]),
        }
    }

    /// How far the corner at an axis end is from where it is listed. An end that is set
    /// back has its corner before the axis.
    fn end(&self, end: Point2) -> Option<Vector2> {
        let corner = match self.listed.nearest(end) {
            Some((_, corner)) => corner,
            None => self.nearest_listed(end)?,
        };
        let drawn = self.corners.nearest(corner);
        let same = drawn.filter(|(off, _)| *off <= SAME_SHAPE_MM).map(|(_, drawn)| drawn);
        // A program that tidies up may have dropped a corner between two straight edges.
        let drawn =
            same.or_else(|| self.on_an_edge(corner)).or(drawn.map(|(_, drawn)| drawn))?;
        Some(drawn - corner)
    }

    fn nearest_listed(&self, end: Point2) -> Option<Point2> {
        let off = |p: &&Point2| (**p - end).norm();
        self.listed.points().min_by(|a, b| off(a).total_cmp(&off(b))).copied()
    }

    fn on_an_edge(&self, p: Point2) -> Option<Point2> {
        let lines = self.outline.segments().filter(|segment| segment.bulge == 0.0);
        let feet = lines.map(|segment| super::shape::foot(p, segment.from, segment.to));
        let off = |q: &Point2| (q - p).norm();
        feet.min_by(|a, b| off(a).total_cmp(&off(b))).filter(|q| off(q) <= SAME_SHAPE_MM)
    }

    /// The walls of a slit, by their distance from the axis.
    fn notch(&self, slit: &SlitEntry, [bottom, top]: FlatAxis) -> Option<Notch> {
        let up = (top - bottom).try_normalize(0.0)?;
        let right = Vector2::new(up.y, -up.x);
        let (edge, inward) = match slit.from {
            OpenEdge::Top => (top, -up),
            OpenEdge::Bottom => (bottom, up),
        };
        let half = slit.width / 2.0;
        let reach = PROOF_REACH_MM.min(half);
        let left =
            self.wall([edge, edge + inward, edge + right], slit.offset - half, reach)?;
        let right_wall =
            self.wall([edge, edge + inward, edge + right], slit.offset + half, reach)?;
        let before = -left.iter().map(|p| p[0]).fold(f64::NEG_INFINITY, f64::max);
        let after = right_wall.iter().map(|p| p[0]).fold(f64::INFINITY, f64::min);
        let end = |wall: &[[f64; 2]]| wall.iter().map(|p| p[1]).fold(0.0, f64::max);
        let depth = end(&left).min(end(&right_wall));
        let at = edge + right * ((after - before) / 2.0);
        Some(Notch { before, after, depth, at })
    }

    /// Ends of the straight lines that make up the wall expected at `lateral`, as
    /// coordinates across and along the axis from its end at the mouth. The frame is given
    /// by its origin and the ends of its two unit vectors.
    fn wall(
        &self,
        [origin, inward, right]: [Point2; 3],
        lateral: f64,
        reach: f64,
    ) -> Option<Vec<[f64; 2]>> {
        let (inward, right) = (inward - origin, right - origin);
        let place = |p: Point2| [(p - origin).dot(&right), (p - origin).dot(&inward)];
        let lines = self.outline.segments().filter(|s| s.bulge == 0.0).map(|s| {
            let (a, b) = (place(s.from), place(s.to));
            ((b[0] - a[0]).abs(), (b[1] - a[1]).abs(), [a, b])
        });
        let lines = lines.filter(|(across, along, [a, b])| {
            let near = |p: &[f64; 2]| (p[0] - lateral).abs() <= reach && p[1] > -reach;
            *along > NO_LENGTH_MM && across / along < STEEP && near(a) && near(b)
        });
        let walls: Vec<[[f64; 2]; 2]> = lines.map(|(_, _, ends)| ends).collect();
        let length = |ends: &[[f64; 2]; 2]| (ends[1][1] - ends[0][1]).abs();
        let longest = walls.iter().max_by(|a, b| length(a).total_cmp(&length(b)))?;
        let at = (longest[0][0] + longest[1][0]) / 2.0;
        // A wall may have been cut into several lines.
        let same = |ends: &&[[f64; 2]; 2]| {
            ends.iter().all(|p| (p[0] - at).abs() <= longest_slack(longest))
        };
        Some(walls.iter().filter(same).flatten().copied().collect())
    }
}

/// How far a line may lean from the axis and still be a wall: the flare of a mouth leans
/// more.
const STEEP: f64 = 0.05;

/// How far pieces of one wall may be off its middle.
fn longest_slack(wall: &[[f64; 2]; 2]) -> f64 {
    (wall[1][0] - wall[0][0]).abs() + SAME_SHAPE_MM
}
