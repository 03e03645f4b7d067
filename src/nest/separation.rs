//! Parts that overlap are moved, one after another, to where they overlap least, until
//! none does. The scheme is that of Gardeyn et al. (arXiv 2509.13329): samples over all
//! bins and around the place, then coordinate descent on the best of them.

use crate::geometry::{Rect, Vector2};
use crate::nest::budget::Budget;
use crate::nest::collision_shape::Pose;
use crate::nest::convex::ConvexPieces;
use crate::nest::state::OverlapState;
use std::f64::consts::TAU;

const SAMPLES_ANYWHERE: usize = 50;
const SAMPLES_NEAR: usize = 25;
/// So many of the samples anywhere lie beside another part, where both are slender and
/// there is one bin.
const SAMPLES_INTERLOCKED: usize = 25;
/// Best samples that are followed down.
const FOLLOWED: usize = 3;
/// Rounds without 2 % less loss before an attempt starts again from its best state.
const PATIENCE: usize = 200;
const STRIKES: usize = 3;
/// Size of the steps of a descent, as shares of the part's smaller side, and radians.
struct Steps {
    first: f64,
    last: f64,
    turn: f64,
    turn_last: f64,
}

const COARSE: Steps = Steps { first: 0.25, last: 0.02, turn: 0.087, turn_last: 0.017 };
const FINE: Steps = Steps { first: 0.01, last: 0.001, turn: 0.0087, turn_last: 0.00087 };

impl OverlapState<'_> {
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
            (0..self.items.len()).filter(|&part| self.loss(part) > 0.0).collect();
        bad.retain(|&part| !self.items[part].fixed);
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
        let here = self.items[part].pose;
        let mut scratch = self.items[part].rotated.clone();
        let mut best = [(f64::INFINITY, here); FOLLOWED];
        best[0] = (now, here);
        let is_slender = self.shapes[self.items[part].shape].centerline.is_some();
        let interlocked =
            if is_slender && self.bins.len() == 1 { SAMPLES_INTERLOCKED } else { 0 };
        for k in 0..SAMPLES_NEAR + SAMPLES_ANYWHERE {
            let sample = if k < SAMPLES_NEAR {
                self.near(part, &mut scratch)
            } else {
                let beside = k < SAMPLES_NEAR + interlocked;
                let pose = beside.then(|| self.interlocked(part, &mut scratch)).flatten();
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
    fn near(&mut self, part: usize, scratch: &mut ConvexPieces) -> Option<Pose> {
        let here = self.items[part].pose;
        let angle = self.any_angle(part, Some(here.angle));
        self.rotate(part, angle, scratch);
        let size = scratch.bounds.size();
        let x = here.x + 0.25 * size.x * self.random.normal();
        let y = here.y + 0.25 * size.y * self.random.normal();
        let range = self.range(scratch, self.bin_at(here.x))?;
        let (low, high) = (range.min, range.max);
        Some(Pose { angle, x: x.clamp(low.x, high.x), y: y.clamp(low.y, high.y) })
    }

    /// A random place in a random bin.
    pub(super) fn anywhere(
        &mut self,
        part: usize,
        scratch: &mut ConvexPieces,
    ) -> Option<Pose> {
        let angle = self.any_angle(part, None);
        self.rotate(part, angle, scratch);
        let area = |bin: &Rect| bin.size().x * bin.size().y;
        let mut left = self.random.unit() * self.bins.iter().map(area).sum::<f64>();
        let bin = self.bins.iter().position(|bin| {
            left -= area(bin);
            left < 0.0
        });
        let range = self.range(scratch, bin.unwrap_or(0))?;
        let x = self.random.between(range.min.x, range.max.x);
        Some(Pose { angle, x, y: self.random.between(range.min.y, range.max.y) })
    }

    /// A place beside a random other part, if both are slender.
    fn interlocked(&mut self, part: usize, scratch: &mut ConvexPieces) -> Option<Pose> {
        let other = self.random.below(self.items.len());
        let there = &self.items[other];
        if other == part || there.pose.is_nowhere() {
            return None;
        }
        let line = |k: usize| self.shapes[self.items[k].shape].centerline;
        let (own, its, pose) = (line(part)?, line(other)?, there.pose);
        let along = own.shift(&its) * self.random.normal();
        let apart = own.apart(&its) + self.spacing();
        let across = if self.random.unit() < 0.5 { apart } else { -apart };
        // Both bent the same way; if one is straight, either end may be ahead.
        let agreement = own.agreement(&its);
        let ahead = agreement > 0.0 || (agreement >= 0.0 && self.random.unit() < 0.5);
        let there = (pose.angle, Vector2::new(pose.x, pose.y));
        let (angle, middle) = own.beside(&its, there, [along, across], !ahead);
        self.rotate(part, angle, scratch);
        self.inside(scratch, Pose { angle, x: middle.x, y: middle.y })
    }

    /// An allowed angle: any one, or one a little off the given one if it rotates freely.
    fn any_angle(&mut self, part: usize, around: Option<f64>) -> f64 {
        let angles = &self.shapes[self.items[part].shape].angles;
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
        scratch: &mut ConvexPieces,
    ) -> (f64, Pose) {
        let mut best = start;
        self.rotate(part, best.1.angle, scratch);
        let size = scratch.bounds.size();
        let side = size.x.min(size.y);
        let mut step = [steps.first * side; 2];
        let last = steps.last * side;
        let is_free = self.shapes[self.items[part].shape].angles.is_empty();
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
        scratch: &mut ConvexPieces,
    ) -> bool {
        let from = *best;
        for sign in [1.0, -1.0] {
            let angle = from.1.angle + sign * by[2];
            self.rotate(part, angle, scratch);
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
