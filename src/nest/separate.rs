//! Parts that overlap are moved, one after another, to where they overlap least, until
//! none does. The scheme is that of Gardeyn et al. (arXiv 2509.13329): samples over all
//! rooms and around the place, then coordinate descent on the best of them.

use crate::nest::crowd::{Crowd, Pose};
use crate::nest::turned::Turned;
use crate::nest::{Layout, Shape, Stock, check, pieces};
use crate::watch::Watch;
use std::f64::consts::TAU;

const SAMPLES_ANYWHERE: usize = 50;
const SAMPLES_NEAR: usize = 25;
/// So many of the samples anywhere lie beside another part, where both are slender and
/// there is one room.
const SAMPLES_BESIDE: usize = 25;
/// Best samples that are followed down.
const FOLLOWED: usize = 3;
/// Rounds without 2 % less loss before an attempt starts again from its best state.
const PATIENCE: usize = 200;
const STRIKES: usize = 3;
/// Evaluations in one unit of work.
pub(super) const UNIT: u64 = 20_000;

/// How much work may be done. The watch is asked only when a unit is full, so a search
/// that was cut short can be repeated by its units.
pub(super) struct Budget<'a> {
    pub(super) units: u64,
    pub(super) done: u64,
    /// No act may go on beyond this.
    cap: u64,
    pub(super) watch: &'a mut dyn Watch,
    stopped: bool,
    pub(super) over: bool,
    /// Whether the watch sees what is found.
    pub(super) shows: bool,
}

impl<'a> Budget<'a> {
    /// As many units as given, `u64::MAX` until the watch has enough.
    pub(super) fn new(units: u64, watch: &'a mut dyn Watch) -> Self {
        Self {
            units,
            done: 0,
            cap: units,
            watch,
            stopped: false,
            over: false,
            shows: true,
        }
    }

    /// Whether the search goes on until the watch has enough.
    pub(super) const fn is_endless(&self) -> bool {
        self.units == u64::MAX
    }

    /// Shows the watch a layout and the share of the stock that parts cover, if it is sound.
    pub(super) fn show(&mut self, layout: Layout, shapes: &[Shape], stock: &[Stock]) {
        if self.shows && check(&layout, shapes, stock).is_empty() {
            let area: f64 = layout.sheets.iter().map(|s| stock[s.stock].area()).sum();
            let parts = layout.sheets.iter().flat_map(|sheet| &sheet.placements);
            let filled: f64 = parts.map(|p| pieces::area(&shapes[p.shape].outline)).sum();
            self.watch.better(&(layout, filled / area));
        }
    }

    /// Acts with some of the units; and whether it was cut short by that.
    pub(super) fn within<T>(
        &mut self,
        units: u64,
        act: impl FnOnce(&mut Self) -> T,
    ) -> (T, bool) {
        let whole = self.cap;
        self.cap = whole.min(self.done.saturating_add(units));
        let result = act(self);
        let was_over =
            std::mem::replace(&mut self.over, self.stopped || self.done >= whole);
        self.cap = whole;
        (result, was_over && !self.over)
    }

    /// Whether to stop, given the evaluations so far.
    pub(super) fn is_spent(&mut self, work: u64) -> bool {
        let done = work / UNIT;
        if done > self.done && !self.over {
            self.done = done;
            self.watch.progress("nest", done as usize, self.units.min(1 << 40) as usize);
            // One unit means no search, so what was searched has two at least.
            self.stopped |= done > 1 && (self.watch.enough() || self.watch.stopped());
            self.over = done >= self.cap || self.stopped;
        }
        self.over
    }
}

/// Size of the steps of a descent, as shares of the part's smaller side, and radians.
struct Steps {
    first: f64,
    last: f64,
    turn: f64,
    turn_last: f64,
}

const COARSE: Steps = Steps { first: 0.25, last: 0.02, turn: 0.087, turn_last: 0.017 };
const FINE: Steps = Steps { first: 0.01, last: 0.001, turn: 0.0087, turn_last: 0.00087 };

impl Crowd<'_> {
    /// Moves parts until nothing overlaps: `true`; or until patience or budget end, with
    /// the least bad state found.
    pub(super) fn separate(&mut self, budget: &mut Budget) -> bool {
        self.forget();
        let mut least = self.total();
        let mut best = self.poses();
        let mut strikes = 0;
        while strikes < STRIKES && least > 0.0 {
            let before = least;
            let mut waited = 0;
            while waited < PATIENCE {
                self.round();
                let total = self.total();
                waited = if total < 0.98 * least { 0 } else { waited + 1 };
                if total < least {
                    (least, best) = (total, self.poses());
                }
                if total <= 0.0 {
                    return true;
                }
                if budget.is_spent(self.work) {
                    strikes = STRIKES;
                    break;
                }
            }
            strikes = if least < 0.98 * before { 0 } else { strikes + 1 };
            self.restore(&best);
            if budget.over {
                break;
            }
        }
        least <= 0.0
    }

    /// Every part that overlaps is moved once.
    fn round(&mut self) {
        let mut bad: Vec<usize> =
            (0..self.members.len()).filter(|&part| self.loss(part) > 0.0).collect();
        bad.retain(|&part| !self.members[part].fixed);
        self.random.shuffle(&mut bad);
        for part in bad {
            let now = self.cost_now(part);
            if now > 0.0
                && let Some((_, pose)) = self.better(part, now)
            {
                self.put(part, pose);
            }
        }
        self.reweigh();
    }

    /// The best pose found for a part that costs `now` where it lies.
    fn better(&mut self, part: usize, now: f64) -> Option<(f64, Pose)> {
        let here = self.members[part].pose;
        let mut scratch = self.members[part].turned.clone();
        let mut best = [(f64::INFINITY, here); FOLLOWED];
        best[0] = (now, here);
        let is_slender = self.shapes[self.members[part].shape].spine.is_some();
        let beside = if is_slender && self.rooms.len() == 1 { SAMPLES_BESIDE } else { 0 };
        for k in 0..SAMPLES_NEAR + SAMPLES_ANYWHERE {
            let sample = if k < SAMPLES_NEAR {
                self.near(part, &mut scratch)
            } else {
                let is_beside = k < SAMPLES_NEAR + beside;
                let pose = is_beside.then(|| self.beside(part, &mut scratch)).flatten();
                pose.or_else(|| self.anywhere(part, &mut scratch))
            };
            let Some(pose) = sample else { continue };
            let cost = self.cost(part, &scratch, pose, best[FOLLOWED - 1].0);
            if cost < best[FOLLOWED - 1].0 {
                let at = best.partition_point(|(other, _)| *other <= cost);
                best[at..].rotate_right(1);
                best[at] = (cost, pose);
            }
        }
        let followed = best.into_iter().filter(|(cost, _)| cost.is_finite());
        let mut least = (f64::INFINITY, here);
        for start in followed {
            let end = self.descend(part, start, &COARSE, &mut scratch);
            if end.0 < least.0 {
                least = end;
            }
        }
        let least = self.descend(part, least, &FINE, &mut scratch);
        (least.0 < now).then_some(least)
    }

    /// A random place around where the part lies.
    fn near(&mut self, part: usize, scratch: &mut Turned) -> Option<Pose> {
        let here = self.members[part].pose;
        let angle = self.any_angle(part, Some(here.angle));
        self.turn(part, angle, scratch);
        let b = scratch.bounds;
        let x = here.x + 0.25 * (b[2] - b[0]) * self.random.normal();
        let y = here.y + 0.25 * (b[3] - b[1]) * self.random.normal();
        let range = self.range(scratch, self.room_at(here.x))?;
        let (x, y) = (x.clamp(range[0], range[2]), y.clamp(range[1], range[3]));
        Some(Pose { angle, x, y })
    }

    /// A random place in a random room.
    pub(super) fn anywhere(&mut self, part: usize, scratch: &mut Turned) -> Option<Pose> {
        let angle = self.any_angle(part, None);
        self.turn(part, angle, scratch);
        let area = |r: &[f64; 4]| (r[2] - r[0]) * (r[3] - r[1]);
        let mut left = self.random.unit() * self.rooms.iter().map(area).sum::<f64>();
        let room = self.rooms.iter().position(|room| {
            left -= area(room);
            left < 0.0
        });
        let range = self.range(scratch, room.unwrap_or(0))?;
        let x = self.random.between(range[0], range[2]);
        Some(Pose { angle, x, y: self.random.between(range[1], range[3]) })
    }

    /// An allowed turn: any one, or one a little off the given one if turns are free.
    fn any_angle(&mut self, part: usize, around: Option<f64>) -> f64 {
        let angles = &self.shapes[self.members[part].shape].angles;
        match (angles.len(), around) {
            (0, Some(angle)) => angle + 0.1 * self.random.normal(),
            (0, None) => self.random.between(0.0, TAU),
            (count, _) => angles[self.random.below(count)],
        }
    }

    /// Coordinate descent: along one axis, a diagonal or the turn at a time; steps grow on
    /// success and are halved on failure.
    fn descend(
        &mut self,
        part: usize,
        start: (f64, Pose),
        steps: &Steps,
        scratch: &mut Turned,
    ) -> (f64, Pose) {
        let mut best = start;
        self.turn(part, best.1.angle, scratch);
        let b = scratch.bounds;
        let side = (b[2] - b[0]).min(b[3] - b[1]);
        let mut step = [steps.first * side; 2];
        let last = steps.last * side;
        let is_free = self.shapes[self.members[part].shape].angles.is_empty();
        let mut turn = if is_free { steps.turn } else { 0.0 };
        while best.0 > 0.0 {
            let turns = turn >= steps.turn_last;
            if step[0] < last && step[1] < last && !turns {
                break;
            }
            let axis = self.random.below(if turns { 5 } else { 4 });
            let by = match axis {
                0 => [step[0], 0.0, 0.0],
                1 => [0.0, step[1], 0.0],
                2 => [step[0], step[1], 0.0],
                3 => [step[0], -step[1], 0.0],
                _ => [0.0, 0.0, turn],
            };
            let won = self.try_both_ways(part, &mut best, by, scratch);
            let grow = if won { 1.1 } else { 0.5 };
            match axis {
                0 => step[0] *= grow,
                1 => step[1] *= grow,
                2 | 3 => step = step.map(|s| s * if won { 1.1 } else { 0.7 }),
                _ => turn *= grow,
            }
        }
        best
    }

    fn try_both_ways(
        &mut self,
        part: usize,
        best: &mut (f64, Pose),
        by: [f64; 3],
        scratch: &mut Turned,
    ) -> bool {
        let from = *best;
        for sign in [1.0, -1.0] {
            let angle = from.1.angle + sign * by[2];
            self.turn(part, angle, scratch);
            let pose =
                Pose { angle, x: from.1.x + sign * by[0], y: from.1.y + sign * by[1] };
            let Some(pose) = self.inside(scratch, pose) else { continue };
            let cost = self.cost(part, scratch, pose, best.0);
            if cost < best.0 {
                *best = (cost, pose);
            }
        }
        best.0 < from.0
    }
}
