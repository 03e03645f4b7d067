//! Parts in their rooms, overlapping for a while, and how badly they do.
//!
//! A *room* is a sheet inside its margin; rooms lie side by side, far enough apart that
//! parts in different rooms never meet. Parts never leave their rooms, so only the overlap
//! of pairs counts. The loss of a pair is smooth and exactly zero when the two keep their
//! spacing; each pair has a weight that grows while it overlaps (guided local search, as
//! in Gardeyn et al., arXiv 2509.13329).

use crate::geometry::Point2;
use crate::nest::pieces::{area, pieces, width};
use crate::nest::random::Random;
use crate::nest::turned::{Bounds, Turned, meet};
use crate::nest::{Placement, Shape, Turns, turn};
use crate::tolerance::NEST_SLACK_MM;

/// A shape ready for the search.
#[derive(Debug)]
pub(super) struct Prepared {
    /// At angle 0 about `middle`.
    still: Turned,
    middle: Point2,
    /// Allowed angles; empty if free.
    pub(super) angles: Vec<f64>,
    pub(super) size: f64,
    pub(super) area: f64,
    /// Share of this shape in a pair's loss: large parts count for more.
    weight: f64,
}

/// Shapes ready for the search; the error is the index of one whose rings cross.
pub(super) fn prepared(shapes: &[Shape], spacing: f64) -> Result<Vec<Prepared>, usize> {
    let slimmest = shapes.iter().map(|s| width(&s.outline)).fold(f64::INFINITY, f64::min);
    let gate = spacing + slimmest / 2.0;
    let one = |(k, shape): (usize, &Shape)| {
        let pieces = pieces(&shape.outline, &shape.holes, gate).ok_or(k)?;
        let (low, high) = crate::nest::check::bounds(&shape.outline);
        let middle = nalgebra::center(&low, &high);
        let [long, wide] = turn::least_rectangle(&shape.outline);
        let angles = match &shape.turns {
            Turns::Free => Vec::new(),
            Turns::Only(angles) => angles.iter().copied().map(turn::rounded).collect(),
        };
        let still = Turned::new(&pieces, middle);
        let size = (long * wide).max(f64::MIN_POSITIVE);
        let (area, weight) = (area(&shape.outline), size.sqrt().sqrt());
        Ok(Prepared { still, middle, angles, size, area, weight })
    };
    shapes.iter().enumerate().map(one).collect()
}

/// Where a part's middle is, and its turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pose {
    pub(super) angle: f64,
    pub(super) x: f64,
    pub(super) y: f64,
}

/// One part in the crowd.
#[derive(Debug, Clone)]
pub(super) struct Member {
    pub(super) shape: usize,
    pub(super) pose: Pose,
    pub(super) turned: Turned,
}

#[derive(Debug)]
pub(super) struct Crowd<'a> {
    pub(super) shapes: &'a [Prepared],
    pub(super) members: Vec<Member>,
    pub(super) rooms: Vec<Bounds>,
    pub(super) random: Random,
    /// Evaluations so far.
    pub(super) work: u64,
    spacing: f64,
    bounds: Vec<Bounds>,
    losses: Vec<f64>,
    weights: Vec<f64>,
}

impl<'a> Crowd<'a> {
    pub(super) fn new(
        shapes: &'a [Prepared],
        rooms: Vec<Bounds>,
        spacing: f64,
        seed: u64,
    ) -> Self {
        let count = shapes.len();
        let pose = Pose { angle: 0.0, x: 0.0, y: 0.0 };
        let member = |shape| Member { shape, pose, turned: Turned::default() };
        Self {
            shapes,
            members: (0..count).map(member).collect(),
            rooms,
            random: Random::new(seed),
            work: 0,
            spacing: spacing + NEST_SLACK_MM,
            // Nowhere, until they are put.
            bounds: vec![[f64::INFINITY, 0.0, f64::NEG_INFINITY, 0.0]; count],
            losses: vec![0.0; count * count],
            weights: vec![1.0; count * count],
        }
    }

    /// The shape of a part turned, in `turned`.
    pub(super) fn turn(&self, part: usize, angle: f64, turned: &mut Turned) {
        #[allow(clippy::float_cmp, reason = "the very same angle needs no work")]
        if turned.angle != angle || turned.is_empty() {
            turned.turn(&self.shapes[self.members[part].shape].still, angle);
        }
    }

    /// Where the middle of a part may be in a room; `None` if it is too large.
    pub(super) fn range(&self, turned: &Turned, room: usize) -> Option<Bounds> {
        let (r, b) = (self.rooms[room], turned.bounds);
        let range = [r[0] - b[0], r[1] - b[1], r[2] - b[2], r[3] - b[3]];
        (range[0] <= range[2] && range[1] <= range[3]).then_some(range)
    }

    /// The room over whose columns `x` lies, or the nearest.
    pub(super) fn room_at(&self, x: f64) -> usize {
        let off = |r: &Bounds| (r[0] - x).max(x - r[2]).max(0.0);
        let rooms = 0..self.rooms.len();
        rooms
            .min_by(|&a, &b| off(&self.rooms[a]).total_cmp(&off(&self.rooms[b])))
            .unwrap_or(0)
    }

    /// The pose moved into its room; `None` if the part is too large for it.
    pub(super) fn inside(&self, turned: &Turned, pose: Pose) -> Option<Pose> {
        let range = self.range(turned, self.room_at(pose.x))?;
        let x = pose.x.clamp(range[0], range[2]);
        Some(Pose { x, y: pose.y.clamp(range[1], range[3]), ..pose })
    }

    /// Puts a part somewhere and sums up its losses.
    pub(super) fn put(&mut self, part: usize, pose: Pose) {
        let mut turned = std::mem::take(&mut self.members[part].turned);
        self.turn(part, pose.angle, &mut turned);
        self.bounds[part] = moved(&turned.bounds, &pose);
        self.members[part].pose = pose;
        self.members[part].turned = turned;
        let count = self.members.len();
        for other in 0..count {
            let loss = self.pair_loss(part, other);
            self.losses[part * count + other] = loss;
            self.losses[other * count + part] = loss;
        }
    }

    fn pair_loss(&self, part: usize, other: usize) -> f64 {
        if part == other || !meet(&self.reach(part), &self.bounds[other]) {
            return 0.0;
        }
        let Member { pose, turned, .. } = &self.members[part];
        self.loss_at(part, other, (turned, *pose), f64::INFINITY)
    }

    pub(super) const fn spacing(&self) -> f64 {
        self.spacing
    }

    fn reach(&self, part: usize) -> Bounds {
        grown(&self.bounds[part], self.spacing)
    }

    /// Loss of a pair; if it is more than `enough`, anything more than that.
    fn loss_at(
        &self,
        part: usize,
        other: usize,
        (turned, pose): (&Turned, Pose),
        enough: f64,
    ) -> f64 {
        let there = &self.members[other];
        let by = [there.pose.x - pose.x, there.pose.y - pose.y];
        let weight = |k: usize| self.shapes[self.members[k].shape].weight;
        let weight = weight(part) * weight(other);
        let enough = (enough / weight).powi(2);
        let overlap = turned.overlap(&there.turned, by, self.spacing, enough);
        if overlap <= 0.0 { 0.0 } else { overlap.sqrt() * weight }
    }

    /// Weighted loss of a part if it lay at `pose`; infinite once it reaches `bound`.
    pub(super) fn cost(
        &mut self,
        part: usize,
        turned: &Turned,
        pose: Pose,
        bound: f64,
    ) -> f64 {
        self.work += 1;
        let reach = grown(&moved(&turned.bounds, &pose), self.spacing);
        let row = part * self.members.len();
        let mut cost = 0.0;
        for (other, bounds) in self.bounds.iter().enumerate() {
            if !meet(&reach, bounds) || other == part {
                continue;
            }
            let weight = self.weights[row + other];
            let enough = (bound - cost) / weight * (1.0 + 1e-9);
            cost += weight * self.loss_at(part, other, (turned, pose), enough);
            if cost >= bound {
                return f64::INFINITY;
            }
        }
        cost
    }

    /// Weighted loss of a part where it lies.
    pub(super) fn cost_now(&self, part: usize) -> f64 {
        let row = part * self.members.len()..(part + 1) * self.members.len();
        self.losses[row.clone()].iter().zip(&self.weights[row]).map(|(l, w)| l * w).sum()
    }

    /// Unweighted loss of a part.
    pub(super) fn loss(&self, part: usize) -> f64 {
        let count = self.members.len();
        self.losses[part * count..(part + 1) * count].iter().sum()
    }

    /// Unweighted loss of all; 0 exactly if nothing overlaps.
    pub(super) fn total(&self) -> f64 {
        self.losses.iter().sum()
    }

    /// Pairs that overlap become heavier, the others slowly lighter again.
    pub(super) fn reweigh(&mut self) {
        let most = self.losses.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        for (weight, loss) in self.weights.iter_mut().zip(&self.losses) {
            let by = if *loss > 0.0 { 1.2 + 0.8 * loss / most } else { 0.95 };
            *weight = (*weight * by).max(1.0);
        }
    }

    /// All pairs weigh the same again.
    pub(super) fn forget(&mut self) {
        self.weights.fill(1.0);
    }

    pub(super) fn poses(&self) -> Vec<Pose> {
        self.members.iter().map(|member| member.pose).collect()
    }

    /// Puts all parts, as far as they fit their rooms by being moved.
    pub(super) fn restore(&mut self, poses: &[Pose]) {
        for (part, &pose) in poses.iter().enumerate() {
            let mut turned = std::mem::take(&mut self.members[part].turned);
            self.turn(part, pose.angle, &mut turned);
            let pose = self.inside(&turned, pose).unwrap_or(pose);
            self.members[part].turned = turned;
            self.put(part, pose);
        }
    }

    /// The placement of a part in the coordinates of its room's sheet, whose lower left
    /// inner corner is at `corner`.
    pub(super) fn placement(
        &self,
        part: usize,
        pose: Pose,
        corner: [f64; 2],
    ) -> Placement {
        let room = self.rooms[self.room_at(pose.x)];
        placement(
            &self.shapes[self.members[part].shape],
            part,
            pose,
            [corner[0] - room[0], corner[1] - room[1]],
        )
    }

    /// The pose of a placement on the sheet of a room.
    pub(super) fn pose(
        &self,
        placement: &Placement,
        room: usize,
        corner: [f64; 2],
    ) -> Pose {
        let middle = self.shapes[placement.shape].middle;
        let (x, y) = turned_point(middle, placement.angle);
        let room = self.rooms[room];
        Pose {
            angle: placement.angle,
            x: placement.x + x + room[0] - corner[0],
            y: placement.y + y + room[1] - corner[1],
        }
    }
}

fn placement(shape: &Prepared, part: usize, pose: Pose, by: [f64; 2]) -> Placement {
    let angle = turn::rounded(pose.angle);
    let (x, y) = turned_point(shape.middle, angle);
    let rounded = |mm: f64| (mm * 1e6).round() / 1e6;
    let (x, y) = (rounded(pose.x + by[0] - x), rounded(pose.y + by[1] - y));
    Placement { shape: part, angle, x, y }
}

fn turned_point(p: Point2, angle: f64) -> (f64, f64) {
    use crate::geometry::trig;
    let (sin, cos) = (trig::sin(angle), trig::cos(angle));
    (cos * p.x - sin * p.y, sin * p.x + cos * p.y)
}

fn moved(bounds: &Bounds, by: &Pose) -> Bounds {
    [bounds[0] + by.x, bounds[1] + by.y, bounds[2] + by.x, bounds[3] + by.y]
}

fn grown(bounds: &Bounds, by: f64) -> Bounds {
    [bounds[0] - by, bounds[1] - by, bounds[2] + by, bounds[3] + by]
}
