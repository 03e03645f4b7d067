//! Parts in their rooms, overlapping for a while, and how badly they do.
//!
//! A *room* is a sheet inside its margin; rooms lie side by side, far enough apart that
//! parts in different rooms never meet. Parts never leave their rooms, so only the overlap
//! of pairs counts. The loss of a pair is smooth and exactly zero when the two keep their
//! spacing; each pair has a weight that grows while it overlaps (guided local search, as
//! in Gardeyn et al., arXiv 2509.13329).

use crate::nest::prepared::Prepared;
use crate::nest::random::Random;
use crate::nest::turned::{Bounds, Turned, meet};
use crate::tolerance::{NEST_BOUND, NEST_SLACK_MM};

/// Where a part's middle is, and its turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pose {
    pub(super) angle: f64,
    pub(super) x: f64,
    pub(super) y: f64,
}

impl Pose {
    /// Of a part that is in no room.
    pub(super) const NOWHERE: Self = Self { angle: 0.0, x: f64::NAN, y: f64::NAN };

    pub(super) const fn is_nowhere(&self) -> bool {
        self.x.is_nan()
    }
}

/// One part in the crowd, or the wall around a remnant.
#[derive(Debug, Clone)]
pub(super) struct Member {
    pub(super) shape: usize,
    pub(super) pose: Pose,
    pub(super) turned: Turned,
    /// It stays where it is.
    pub(super) fixed: bool,
    /// Distance that parts keep from it, mm.
    gap: f64,
}

impl Member {
    /// A part that is in no room yet.
    pub(super) fn part(shape: usize, spacing: f64) -> Self {
        let (pose, turned, gap) =
            (Pose::NOWHERE, Turned::default(), spacing + NEST_SLACK_MM);
        Self { shape, pose, turned, fixed: false, gap }
    }

    /// The wall around a remnant.
    pub(super) fn wall(shape: usize, margin: f64) -> Self {
        Self { fixed: true, ..Self::part(shape, margin) }
    }
}

/// Box of what is in no room.
const NO_BOUNDS: Bounds = [f64::INFINITY, 0.0, f64::NEG_INFINITY, 0.0];

#[derive(Debug)]
pub(super) struct Crowd<'a> {
    pub(super) shapes: &'a [Prepared],
    /// Parts, then walls.
    pub(super) members: Vec<Member>,
    pub(super) rooms: Vec<Bounds>,
    pub(super) random: Random,
    /// Evaluations so far.
    pub(super) work: u64,
    /// The largest gap.
    spacing: f64,
    bounds: Vec<Bounds>,
    losses: Vec<f64>,
    weights: Vec<f64>,
}

impl<'a> Crowd<'a> {
    /// All in no room.
    pub(super) fn new(
        shapes: &'a [Prepared],
        members: Vec<Member>,
        rooms: Vec<Bounds>,
        random: Random,
    ) -> Self {
        let count = members.len();
        Self {
            shapes,
            rooms,
            random,
            work: 0,
            spacing: members.iter().map(|member| member.gap).fold(0.0, f64::max),
            bounds: vec![NO_BOUNDS; count],
            losses: vec![0.0; count * count],
            weights: vec![1.0; count * count],
            members,
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

    /// Takes a part out of its room.
    pub(super) fn take_out(&mut self, part: usize) {
        let member = &mut self.members[part];
        (member.turned, member.pose) = (Turned::default(), Pose::NOWHERE);
        self.bounds[part] = NO_BOUNDS;
        let count = self.members.len();
        for other in 0..count {
            self.losses[part * count + other] = 0.0;
            self.losses[other * count + part] = 0.0;
        }
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
        let Member { pose, turned, fixed, .. } = &self.members[part];
        // What may not move is as it is.
        let cannot = part == other || (*fixed && self.members[other].fixed);
        if cannot || !meet(&self.reach(part), &self.bounds[other]) {
            return 0.0;
        }
        self.loss_at(part, other, (turned, *pose), f64::INFINITY)
    }

    pub(super) const fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Distance that two must keep: walls have their own.
    fn gap(&self, part: usize, other: usize) -> f64 {
        let [a, b] = [part, other].map(|k| &self.members[k]);
        if b.fixed { b.gap } else { a.gap }
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
        let gap = self.gap(part, other);
        let overlap = turned.overlap(&there.turned, by, gap, enough);
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
            let enough = (bound - cost) / weight * (1.0 + NEST_BOUND);
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
            if pose.is_nowhere() {
                self.take_out(part);
                continue;
            }
            let mut turned = std::mem::take(&mut self.members[part].turned);
            self.turn(part, pose.angle, &mut turned);
            let fixed = self.members[part].fixed;
            let inside = if fixed { None } else { self.inside(&turned, pose) };
            self.members[part].turned = turned;
            self.put(part, inside.unwrap_or(pose));
        }
    }
}

fn moved(bounds: &Bounds, by: &Pose) -> Bounds {
    [bounds[0] + by.x, bounds[1] + by.y, bounds[2] + by.x, bounds[3] + by.y]
}

fn grown(bounds: &Bounds, by: f64) -> Bounds {
    [bounds[0] - by, bounds[1] - by, bounds[2] + by, bounds[3] + by]
}
