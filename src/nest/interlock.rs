//! Slender parts that interlock: places beside one another.
//!
//! Curved strips lie densest in one another's hollows. A place at random seldom is one of
//! these; one beside another strip, both bent the same way, often is.

use crate::geometry::{Motion, Point2, Rect, Vector2};
use crate::nest::rotation;
use std::f64::consts::PI;

/// Length over thickness from which a part is slender.
const SLENDER: f64 = 3.0;
/// Where it is looked at to see how thick it is, as shares of its length.
const STATIONS: [f64; 5] = [0.4, 0.45, 0.5, 0.55, 0.6];
/// How far a part is shifted along the other, as a share of the longer one.
const SHIFT: f64 = 0.25;

/// The line along the middle of a slender part.
#[derive(Debug, Clone, Copy)]
pub(super) struct Centerline {
    /// The rotation that lays the part along x.
    lying: f64,
    /// The line's point half way along, seen from the part's middle, while it lies so.
    half_way: Point2,
    length: f64,
    thickness: f64,
    /// How far the line rises from its ends to half way; 0 if that is hardly seen.
    bend: f64,
}

impl Centerline {
    /// `None` if the part is not slender.
    pub(super) fn of(outline: &[Point2], middle: Point2) -> Option<Self> {
        let lying = rotation::lying(outline);
        let rotation = Motion::rotation(lying);
        let about = |p: &Point2| rotation.apply(p - middle.coords);
        let ring: Vec<Point2> = outline.iter().map(about).collect();
        let Rect { min: low, max: high } = Rect::around(&ring);
        let length = high.x - low.x;
        let across = |share: f64| across(&ring, low.x + share * length);
        let height = |share| across(share).map(|[low, high]| low.midpoint(high));
        // A slit makes the part look thinner where it is.
        let thick = STATIONS.iter().filter_map(|&share| across(share));
        let thickness = thick.map(|[low, high]| high - low).fold(0.0, f64::max);
        let half_way = Point2::new(low.x.midpoint(high.x), height(0.5)?);
        let bend = half_way.y - height(0.05)?.midpoint(height(0.95)?);
        let bend = if bend.abs() > thickness / 2.0 { bend } else { 0.0 };
        let centerline = Self { lying, half_way, length, thickness, bend };
        (length > SLENDER * thickness).then_some(centerline)
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

impl Centerline {
    /// Angle and middle of a part that lies beside another, `along` and `across` the
    /// other's line, heading the same way or the opposite one.
    pub(super) fn beside(
        &self,
        other: &Self,
        (angle, middle): (f64, Vector2),
        [along, across]: [f64; 2],
        is_opposite: bool,
    ) -> (f64, Vector2) {
        let way = angle - other.lying;
        let own_way = if is_opposite { way + PI } else { way };
        let rotation = Motion::rotation(way);
        let half_way = rotation.rotate(other.half_way.coords);
        let aside = rotation.rotate(Vector2::new(along, across));
        let own = Motion::rotation(own_way).rotate(self.half_way.coords);
        (own_way + self.lying, middle + half_way + aside - own)
    }

    /// How far apart the lines of two parts are that lie side by side.
    pub(super) fn apart(&self, other: &Self) -> f64 {
        (self.thickness + other.thickness) / 2.0
    }

    /// How far along one another they are shifted at random.
    pub(super) fn shift(&self, other: &Self) -> f64 {
        SHIFT * self.length.max(other.length)
    }

    /// Positive if both are bent the same way, 0 if one is straight.
    pub(super) fn agreement(&self, other: &Self) -> f64 {
        self.bend * other.bend
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
        let centerline = Centerline::of(&ring, Point2::origin()).unwrap();
        assert!((centerline.thickness - 10.0).abs() < 0.2, "{centerline:?}");
        assert!(
            (centerline.half_way.coords.norm() - 100.0).abs() < 0.2,
            "{centerline:?}"
        );
        assert!(centerline.bend.abs() > 10.0, "{centerline:?}");
    }

    #[test]
    fn a_square_is_not_slender() {
        let square = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
        let square = square.map(|(x, y)| Point2::new(x, y));
        assert!(Centerline::of(&square, Point2::new(5.0, 5.0)).is_none());
    }
}
