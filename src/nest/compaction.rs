//! One bin made narrower and narrower while everything still finds its place: strip
//! packing, and the offcut of the last sheet.

use crate::nest::budget::Budget;
use crate::nest::collision_shape::Pose;
use crate::nest::convex::ConvexPieces;
use crate::nest::state::{Item, OverlapState};

/// Share by which the bin shrinks while exploring.
const STEP: f64 = 0.001;
/// Steps of the last squeeze: from, down to, and the factor on failure.
const SQUEEZE: [f64; 3] = [0.0005, 0.00001, 0.6];
/// Failed attempts at one width before the best layout is squeezed.
const ATTEMPTS: usize = 4;
/// Candidates for each part of the first layout.
const FILL_SAMPLES: usize = 200;

impl OverlapState<'_> {
    /// Lays the parts one after another, large ones first, where they reach least far to
    /// the right. Room 0 is made as wide as it needs.
    pub(super) fn fill(&mut self) {
        let mut order: Vec<usize> = (0..self.items.len()).collect();
        let size = |part: &usize| self.shapes[self.items[*part].shape].size;
        order.sort_by(|a, b| size(b).total_cmp(&size(a)).then(a.cmp(b)));
        let mut scratch = ConvexPieces::default();
        for part in order {
            scratch.angle = f64::NAN;
            self.bins[0].max.x = self.used(0) + self.reach_of(part, &mut scratch);
            let pose = self.free_place(part, &mut scratch);
            let pose = pose.or_else(|| self.beyond(part, &mut scratch));
            if let Some(pose) = pose {
                self.put(part, pose);
            }
        }
        self.bins[0].max.x = self.used(0);
    }

    /// Where a part overlaps nothing and reaches least far to the right, of some random
    /// places.
    pub(super) fn free_place(
        &mut self,
        part: usize,
        scratch: &mut ConvexPieces,
    ) -> Option<Pose> {
        let mut best: Option<(f64, Pose)> = None;
        for _ in 0..FILL_SAMPLES {
            let Some(pose) = self.anywhere(part, scratch) else { continue };
            let far = |pose: &Pose| pose.x + scratch.bounds.max.x + 0.05 * pose.y;
            if best.is_some_and(|(least, _)| far(&pose) >= least) {
                continue;
            }
            if self.cost(part, scratch, pose, f64::MIN_POSITIVE) <= 0.0 {
                let pose = self.slid(part, scratch, pose);
                best = Some((far(&pose), pose));
            }
        }
        best.map(|(_, pose)| pose)
    }

    /// A length within which the part surely finds room.
    fn reach_of(&self, part: usize, scratch: &mut ConvexPieces) -> f64 {
        self.rotate(part, 0.0, scratch);
        let size = scratch.bounds.size();
        2.0 * (size.x + size.y) + 100.0 * crate::tolerance::NEST_SLACK_MM
    }

    /// To the right of everything, in a turn that fits the height.
    fn beyond(&mut self, part: usize, scratch: &mut ConvexPieces) -> Option<Pose> {
        let end = self.used(0);
        (0..1000).find_map(|_| {
            let pose = self.anywhere(part, scratch)?;
            let x = end - scratch.bounds.min.x + 2.0 * self.spacing();
            self.bins[0].max.x = self.bins[0].max.x.max(x + scratch.bounds.max.x);
            Some(Pose { x, ..pose })
        })
    }

    /// Moved left and down as far as nothing is touched, by halving steps.
    fn slid(&mut self, part: usize, rotated: &ConvexPieces, mut pose: Pose) -> Pose {
        let size = rotated.bounds.size();
        let mut step = size.x.max(size.y);
        let last = step / 500.0;
        while step > last {
            let mut moved = false;
            for (dx, dy) in [(step, 0.0), (0.0, step)] {
                let next = Pose { x: pose.x - dx, y: pose.y - dy, ..pose };
                let Some(next) = self.inside(rotated, next) else { continue };
                let is_move = next != pose;
                if is_move && self.cost(part, rotated, next, f64::MIN_POSITIVE) <= 0.0 {
                    pose = next;
                    moved = true;
                }
            }
            if !moved {
                step /= 2.0;
            }
        }
        pose
    }

    /// The right end of what lies in a bin.
    pub(super) fn used(&self, bin: usize) -> f64 {
        let items = self.items.iter().filter(|m| !m.pose.is_nowhere());
        let inside = items.filter(|m| self.bin_at(m.pose.x) == bin);
        inside
            .map(|m| m.pose.x + m.rotated.bounds.max.x)
            .fold(self.bins[bin].min.x, f64::max)
    }

    /// Narrows a bin as far as the budget goes; ends with the narrowest layout found
    /// without overlap. The layout must have none to begin with.
    /// It goes on for ever if told to, else until nothing is gained; what each round has
    /// found is shown.
    pub(super) fn compact(
        &mut self,
        bin: usize,
        endless: bool,
        budget: &mut Budget,
        shown: &mut dyn FnMut(&Self, &mut Budget),
    ) {
        let mut best = (self.used(bin), self.poses());
        loop {
            let work = self.work;
            let explored = self.explore(bin, &mut best, budget);
            let squeezed = self.squeeze(bin, &mut best, budget);
            self.bins[bin].max.x = best.0;
            self.restore(&best.1);
            shown(self, budget);
            // Without an evaluation nothing can come of another round.
            if budget.over || self.work == work || !(explored || squeezed || endless) {
                break;
            }
        }
    }

    /// Shrinks in large steps.
    fn explore(
        &mut self,
        bin: usize,
        best: &mut (f64, Vec<Pose>),
        budget: &mut Budget,
    ) -> bool {
        let mut improved = false;
        while !budget.over {
            let fits = self.narrow(bin, best, STEP * self.bins.len() as f64);
            if !fits || !self.settle(budget) || self.used(bin) >= best.0 {
                break;
            }
            *best = (self.used(bin), self.poses());
            improved = true;
        }
        improved
    }

    /// Separates; failed attempts are disrupted and tried again.
    pub(super) fn settle(&mut self, budget: &mut Budget) -> bool {
        let mut pool: Vec<(f64, Vec<Pose>)> = Vec::new();
        while !self.separate(budget) {
            pool.push((self.total(), self.poses()));
            if budget.over || pool.len() == ATTEMPTS {
                return false;
            }
            pool.sort_by(|a, b| a.0.total_cmp(&b.0));
            let pick = (self.random.normal().abs() * 0.25 * pool.len() as f64) as usize;
            let poses = pool[pick.min(pool.len() - 1)].1.clone();
            self.restore(&poses);
            self.disrupt();
        }
        true
    }

    /// Shrinks in small steps from the best layout.
    fn squeeze(
        &mut self,
        bin: usize,
        best: &mut (f64, Vec<Pose>),
        budget: &mut Budget,
    ) -> bool {
        let [mut step, last, factor] = SQUEEZE;
        let mut improved = false;
        while step > last && !budget.over {
            let fits = self.narrow(bin, best, step);
            if fits && self.separate(budget) && self.used(bin) < best.0 {
                *best = (self.used(bin), self.poses());
                improved = true;
            } else {
                step *= factor;
            }
        }
        improved
    }

    /// The best layout cut somewhere and pushed together; `false` if a part is too large
    /// for the bin now and found no other: it would stick out of it without overlapping.
    fn narrow(&mut self, bin: usize, best: &(f64, Vec<Pose>), share: f64) -> bool {
        let left = self.bins[bin].min.x;
        let by = (best.0 - left) * share;
        self.bins[bin].max.x = best.0;
        let cut = self.random.between(left, best.0);
        let bins: Vec<usize> = best.1.iter().map(|pose| self.bin_at(pose.x)).collect();
        self.bins[bin].max.x = best.0 - by;
        let pushed = best.1.iter().zip(bins).map(|(&pose, at)| {
            let moves = at == bin && pose.x > cut;
            Pose { x: if moves { (pose.x - by).max(left) } else { pose.x }, ..pose }
        });
        let pushed: Vec<Pose> = pushed.collect();
        self.restore(&pushed);
        let right = self.bins[bin].max.x;
        for part in 0..self.items.len() {
            let Item { pose, rotated, .. } = &self.items[part];
            let is_there = !pose.is_nowhere() && self.bin_at(pose.x) == bin;
            if is_there && pose.x + rotated.bounds.max.x > right {
                self.insert_overlapping(part);
            }
        }
        self.items.iter().all(|Item { pose, rotated, fixed, .. }| {
            let stays = *fixed || pose.is_nowhere();
            stays || self.range(rotated, self.bin_at(pose.x)).is_some()
        })
    }

    /// Swaps two large parts of different shape.
    pub(super) fn disrupt(&mut self) {
        let mut order: Vec<usize> = (0..self.items.len()).collect();
        order.retain(|&k| !self.items[k].fixed && !self.items[k].pose.is_nowhere());
        let size = |part: usize| self.shapes[self.items[part].shape].size;
        order.sort_by(|&a, &b| size(b).total_cmp(&size(a)).then(a.cmp(&b)));
        let all: f64 = order.iter().map(|&part| size(part)).sum();
        let mut sum = 0.0;
        let large = order.iter().take_while(|&&part| {
            sum += size(part);
            sum - size(part) < 0.75 * all
        });
        let large = large.count().max(2).min(order.len());
        if large < 2 {
            return;
        }
        let a = order[self.random.below(large)];
        let b = (0..20).map(|_| order[self.random.below(large)]);
        let b: Vec<usize> = b.collect();
        let differs = |&&b: &&usize| (size(a) - size(b)).abs() > 0.01 * size(a);
        let Some(&b) = b.iter().find(differs).or(b.iter().find(|&&b| b != a)) else {
            return;
        };
        let (pa, pb) = (self.items[a].pose, self.items[b].pose);
        for (part, to) in [(a, pb), (b, pa)] {
            let angle = self.items[part].pose.angle;
            let pose = Pose { angle, ..to };
            let inside = self.inside(&self.items[part].rotated, pose);
            if let Some(pose) = inside {
                self.put(part, pose);
            }
        }
    }
}
