//! From a chain of planar fins in space to one flat strip.
//!
//! Successive fins share the segment of a node axis; turning each about that axis into
//! the plane of the one before is a rigid motion, so every length and angle within a fin
//! is kept. The labelled face looks at the reader: travel runs to +x, axes to +y, and the
//! face's normal in space is travel × axis.

use crate::geometry::{Point2, Vector2, Vector3, predicates, trig};
use crate::ids::NodeId;
use crate::structure::Structure;
use crate::tolerance::SAME_FOLD;

/// Where a node axis lies on a flat strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatAxis {
    /// The node.
    pub node: NodeId,
    /// Where the axis meets the base mesh.
    pub foot: Point2,
    /// Direction from bottom to top, unit length.
    pub up: Vector2,
    /// From the foot down to the strip's bottom edge, mm.
    pub below: f64,
    /// From the foot up to the strip's top edge, mm.
    pub above: f64,
}

impl FlatAxis {
    /// Where the axis meets the bottom edge.
    pub fn bottom(&self) -> Point2 {
        self.foot - self.up * self.below
    }

    /// Where the axis meets the top edge.
    pub fn top(&self) -> Point2 {
        self.foot + self.up * self.above
    }

    /// Unit vector across the axis, toward the next node.
    pub fn right(&self) -> Vector2 {
        Vector2::new(self.up.y, -self.up.x)
    }

    fn moved(&self, motion: &Motion) -> Self {
        Self { foot: motion.point(self.foot), up: motion.vector(self.up), ..*self }
    }
}

/// The fold of a strip at an inner node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fold {
    /// The node.
    pub node: NodeId,
    /// Radians, positive turns the next fin toward the labelled face.
    pub angle: f64,
}

/// A chain of fins in the plane.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FlatStrip {
    /// The node axes in order of travel; the seam of a closed strip is first and last.
    pub axes: Vec<FlatAxis>,
    /// One per inner node.
    pub folds: Vec<Fold>,
    /// Whether first and last axis are one axis in space.
    pub closed: bool,
}

/// Unfolds the fins between successive nodes of `chain`.
pub(crate) fn unfold(structure: &Structure, chain: &[NodeId], closed: bool) -> FlatStrip {
    let node = |k: usize| &structure.nodes()[chain[k]];
    let flat = |k: usize, foot, up| {
        let (below, above) = (node(k).below, node(k).above);
        FlatAxis { node: chain[k], foot, up, below, above }
    };
    let mut axes = vec![flat(0, Point2::origin(), Vector2::y())];
    for k in 1..chain.len() {
        let before = axes[k - 1];
        let edge = node(k).position - node(k - 1).position;
        let travel = turned(before.up, -angle(edge, node(k - 1).axis));
        let foot = before.foot + travel * edge.norm();
        axes.push(flat(k, foot, turned(travel, angle(edge, node(k).axis))));
    }
    let folds = chain.windows(3).map(|three| Fold {
        node: three[1],
        angle: structure.fold(three[0], three[1], three[2]),
    });
    let mut strip = FlatStrip { axes, folds: folds.collect(), closed };
    strip.turn_along_x();
    strip
}

/// Length from the first foot over all others to the last.
fn run(axes: &[FlatAxis]) -> f64 {
    axes.windows(2).map(|pair| (pair[1].foot - pair[0].foot).norm()).sum()
}

/// Angle between two vectors, in [0, π].
fn angle(a: Vector3, b: Vector3) -> f64 {
    trig::atan2(a.cross(&b).norm(), a.dot(&b))
}

fn turned(v: Vector2, angle: f64) -> Vector2 {
    let (sin, cos) = (trig::sin(angle), trig::cos(angle));
    Vector2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}

/// A turn about the origin followed by a move.
struct Motion {
    cos: f64,
    sin: f64,
    shift: Vector2,
}

impl Motion {
    fn vector(&self, v: Vector2) -> Vector2 {
        Vector2::new(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y)
    }

    fn point(&self, p: Point2) -> Point2 {
        Point2::from(self.vector(p.coords) + self.shift)
    }
}

impl FlatStrip {
    /// Turns the strip so that it runs along x with its axes upward, and moves its lower
    /// left corner to the origin.
    pub(crate) fn turn_along_x(&mut self) {
        let (first, last) = (self.axes[0], self.axes[self.axes.len() - 1]);
        let chord = last.foot - first.foot;
        let upright: Vector2 = self.axes.iter().map(|axis| axis.right()).sum();
        // A strip that comes back to where it began has no chord to speak of.
        let along = if chord.norm() > 0.2 * self.length() && chord.dot(&upright) > 0.0 {
            chord.normalize()
        } else if upright.norm() > 0.0 {
            upright.normalize()
        } else {
            Vector2::x()
        };
        let turn = Motion { cos: along.x, sin: -along.y, shift: Vector2::zeros() };
        self.axes = self.axes.iter().map(|axis| axis.moved(&turn)).collect();
        let ends = self.axes.iter().flat_map(|axis| [axis.bottom(), axis.top()]);
        let low = ends.fold(Point2::new(f64::MAX, f64::MAX), |low, p| low.inf(&p));
        let shift = Motion { cos: 1.0, sin: 0.0, shift: -low.coords };
        self.axes = self.axes.iter().map(|axis| axis.moved(&shift)).collect();
    }

    /// The strip's edge without slits: along the bottom, back along the top.
    pub(crate) fn body(&self) -> Vec<Point2> {
        let bottom = self.axes.iter().map(|axis| axis.bottom());
        bottom.chain(self.axes.iter().rev().map(|axis| axis.top())).collect()
    }

    /// Length along the base mesh, mm.
    pub(crate) fn length(&self) -> f64 {
        run(&self.axes)
    }

    /// The place of the smallest fold; of equal ones the nearest to the middle.
    fn smallest_fold(&self) -> Option<usize> {
        let least = self.folds.iter().map(|fold| fold.angle.abs()).reduce(f64::min)?;
        let equal = |k: &usize| self.folds[*k].angle.abs() <= least + SAME_FOLD;
        let off = |k: usize| (run(&self.axes[..=k + 1]) - run(&self.axes[k + 1..])).abs();
        let equal = (0..self.folds.len()).filter(equal);
        equal.min_by(|&a, &b| off(a).total_cmp(&off(b)))
    }

    /// Whether the flat strip lies over itself, exactly.
    pub(crate) fn overlaps_itself(&self) -> bool {
        !predicates::is_simple(&self.body())
    }
}

/// Unfolds a chain, split at the smallest fold as often as it takes that no piece lies
/// over itself. The second value names the nodes of the cuts.
pub(crate) fn unfold_without_overlap(
    structure: &Structure,
    chain: &[NodeId],
    closed: bool,
) -> (Vec<FlatStrip>, Vec<NodeId>) {
    let strip = unfold(structure, chain, closed);
    match strip.smallest_fold() {
        Some(cut) if strip.overlaps_itself() => {
            let (mut pieces, mut cuts) =
                unfold_without_overlap(structure, &chain[..=cut + 1], false);
            let (more, more_cuts) =
                unfold_without_overlap(structure, &chain[cut + 1..], false);
            pieces.extend(more);
            cuts.push(chain[cut + 1]);
            cuts.extend(more_cuts);
            (pieces, cuts)
        }
        _ => (vec![strip], Vec::new()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_between_vectors_are_those_of_school() {
        let right = angle(Vector3::x(), Vector3::y());
        assert!((right - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
        assert!((turned(Vector2::x(), right) - Vector2::y()).norm() < 1e-15);
    }
}
