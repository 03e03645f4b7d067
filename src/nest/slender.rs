//! Slender parts, and places beside one another.
//!
//! Curved strips lie densest in one another's hollows. A place at random seldom is one of
//! these; one beside another strip, both bent the same way, often is.

use crate::geometry::Point2;
use crate::nest::check::bounds;
use crate::nest::crowd::{Crowd, Pose};
use crate::nest::prepared::turned;
use crate::nest::turn;
use crate::nest::turned::Turned;
use std::f64::consts::PI;

/// Length over thickness from which a part is slender.
const SLENDER: f64 = 3.0;
/// Where it is looked at to see how thick it is, as shares of its length.
const STATIONS: [f64; 5] = [0.4, 0.45, 0.5, 0.55, 0.6];
/// How far a part is shifted along the other, as a share of the longer one.
const SHIFT: f64 = 0.25;

/// The line along the middle of a slender part.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spine {
    /// The turn that lays the part along x.
    lying: f64,
    /// The line's point half way along, seen from the part's middle, while it lies so.
    half_way: Point2,
    length: f64,
    thickness: f64,
    /// How far the line rises from its ends to half way; 0 if that is hardly seen.
    bend: f64,
}

impl Spine {
    /// `None` if the part is not slender.
    pub(super) fn of(outline: &[Point2], middle: Point2) -> Option<Self> {
        let lying = turn::lying(outline);
        let about = |p: &Point2| Point2::from(turned(p - middle.coords, lying));
        let ring: Vec<Point2> = outline.iter().map(about).collect();
        let (low, high) = bounds(&ring);
        let length = high.x - low.x;
        let across = |share: f64| across(&ring, low.x + share * length);
        let height = |share| across(share).map(|[low, high]| low.midpoint(high));
        // A slit makes the part look thinner where it is.
        let thick = STATIONS.iter().filter_map(|&share| across(share));
        let thickness = thick.map(|[low, high]| high - low).fold(0.0, f64::max);
        let half_way = Point2::new(low.x.midpoint(high.x), height(0.5)?);
        let bend = half_way.y - height(0.05)?.midpoint(height(0.95)?);
        let bend = if bend.abs() > thickness / 2.0 { bend } else { 0.0 };
        let spine = Self { lying, half_way, length, thickness, bend };
        (length > SLENDER * thickness).then_some(spine)
    }
}

/// Where the outline is lowest and highest at `x`.
fn across(ring: &[Point2], x: f64) -> Option<[f64; 2]> {
    let sides = ring.iter().zip(ring.iter().cycle().skip(1));
    let meets = |(a, b): &(&Point2, &Point2)| (a.x <= x) != (b.x <= x);
    let heights = sides.filter(meets).map(|(a, b)| {
        let share = (x - a.x) / (b.x - a.x);
        a.y + share * (b.y - a.y)
    });
    heights.fold(None, |ends: Option<[f64; 2]>, y| {
        Some(ends.map_or([y; 2], |[low, high]| [low.min(y), high.max(y)]))
    })
}

impl Crowd<'_> {
    /// A place beside a random other part, if both are slender.
    pub(super) fn beside(&mut self, part: usize, scratch: &mut Turned) -> Option<Pose> {
        let other = self.random.below(self.members.len());
        let there = &self.members[other];
        if other == part || there.pose.is_nowhere() {
            return None;
        }
        let [own, its] = [part, other].map(|k| self.shapes[self.members[k].shape].spine);
        let (own, its, pose) = (own?, its?, there.pose);
        let along = SHIFT * own.length.max(its.length) * self.random.normal();
        let apart = (own.thickness + its.thickness) / 2.0 + self.spacing();
        let across = if self.random.unit() < 0.5 { apart } else { -apart };
        // Both bent the same way; if one is straight, either end may be ahead.
        let bent = own.bend * its.bend;
        let ahead = bent > 0.0 || (bent >= 0.0 && self.random.unit() < 0.5);
        let way = pose.angle - its.lying;
        let own_way = if ahead { way } else { way + PI };
        let [dx, dy] = turned(its.half_way, way);
        let [ax, ay] = turned(Point2::new(along, across), way);
        let [ox, oy] = turned(own.half_way, own_way);
        let angle = own_way + own.lying;
        self.turn(part, angle, scratch);
        let (x, y) = (pose.x + dx + ax - ox, pose.y + dy + ay - oy);
        self.inside(scratch, Pose { angle, x, y })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::trig;

    /// A strip of thickness 10 around an arc of radius 100, from `from` to `to`.
    fn bow(from: f64, to: f64) -> Vec<Point2> {
        let at = |radius: f64, k: i32| {
            let angle = from + (to - from) * f64::from(k) / 20.0;
            Point2::new(radius * trig::cos(angle), radius * trig::sin(angle))
        };
        let outer = (0..=20).map(|k| at(105.0, k));
        outer.chain((0..=20).rev().map(|k| at(95.0, k))).collect()
    }

    #[test]
    fn the_spine_of_a_bow_is_its_middle_line() {
        let ring = bow(0.5, 1.7);
        let spine = Spine::of(&ring, Point2::origin()).unwrap();
        assert!((spine.thickness - 10.0).abs() < 0.2, "{spine:?}");
        assert!((spine.half_way.coords.norm() - 100.0).abs() < 0.2, "{spine:?}");
        assert!(spine.bend.abs() > 10.0, "{spine:?}");
    }

    #[test]
    fn a_square_is_not_slender() {
        let square = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
        let square = square.map(|(x, y)| Point2::new(x, y));
        assert!(Spine::of(&square, Point2::new(5.0, 5.0)).is_none());
    }
}
