//! Parts in their bins, overlapping for a while, and how badly they do.
//!
//! A *bin* is a sheet inside its margin; bins lie side by side, far enough apart that
//! parts in different bins never meet. Parts never leave their bins, so only the overlap
//! of pairs counts. The loss of a pair is smooth and exactly zero when the two keep their
//! spacing; each pair has a weight that grows while it overlaps (guided local search, as
//! in Gardeyn et al., arXiv 2509.13329).

use crate::geometry::{Point2, Rect};
use crate::nest::collision_shape::{CollisionShape, Pose};
use crate::nest::convex::ConvexPieces;
use crate::nest::random::Random;
use crate::tolerance::{EXACT_FIT_MM, NEST_BOUND, NEST_SLACK_MM};

/// One part in the state, or the wall around a remnant.
#[derive(Debug, Clone)]
pub(super) struct Item {
    pub(super) shape: usize,
    pub(super) pose: Pose,
    pub(super) rotated: ConvexPieces,
    /// It stays where it is.
    pub(super) fixed: bool,
    /// Distance that parts keep from it, mm.
    gap: f64,
}

impl Item {
    /// A part that is in no bin yet.
    pub(super) fn part(shape: usize, spacing: f64) -> Self {
        let (pose, rotated, gap) =
            (Pose::NOWHERE, ConvexPieces::default(), spacing + NEST_SLACK_MM);
        Self { shape, pose, rotated, fixed: false, gap }
    }

    /// The wall around a remnant.
    pub(super) fn wall(shape: usize, margin: f64) -> Self {
        Self { fixed: true, ..Self::part(shape, margin) }
    }
}

#[derive(Debug)]
pub(super) struct OverlapState<'a> {
    pub(super) shapes: &'a [CollisionShape],
    /// Parts, then walls.
    pub(super) items: Vec<Item>,
    pub(super) bins: Vec<Rect>,
    pub(super) random: Random,
    /// Evaluations so far.
    pub(super) work: u64,
    /// The largest gap.
    spacing: f64,
    bounds: Vec<Rect>,
    losses: Vec<f64>,
    weights: Vec<f64>,
}

impl<'a> OverlapState<'a> {
    /// All in no bin.
    pub(super) fn new(
        shapes: &'a [CollisionShape],
        items: Vec<Item>,
        bins: Vec<Rect>,
        random: Random,
    ) -> Self {
        let count = items.len();
        Self {
            shapes,
            bins,
            random,
            work: 0,
            spacing: items.iter().map(|item| item.gap).fold(0.0, f64::max),
            bounds: vec![Rect::EMPTY; count],
            losses: vec![0.0; count * count],
            weights: vec![1.0; count * count],
            items,
        }
    }

    /// The shape of a part rotated, in `rotated`.
    pub(super) fn rotate(&self, part: usize, angle: f64, rotated: &mut ConvexPieces) {
        #[allow(clippy::float_cmp, reason = "the very same angle needs no work")]
        if rotated.angle != angle || rotated.is_empty() {
            rotated.rotate(&self.shapes[self.items[part].shape].still, angle);
        }
    }

    /// Where the middle of a part may be in a bin; `None` if it is too large.
    pub(super) fn range(&self, rotated: &ConvexPieces, bin: usize) -> Option<Rect> {
        let (bin, part) = (self.bins[bin], rotated.bounds);
        let (min, max) = (bin.min - part.min.coords, bin.max - part.max.coords);
        let fits = min.x <= max.x + EXACT_FIT_MM && min.y <= max.y + EXACT_FIT_MM;
        let max = Point2::new(max.x.max(min.x), max.y.max(min.y));
        fits.then_some(Rect { min, max })
    }

    /// The bin over whose columns `x` lies, or the nearest.
    pub(super) fn bin_at(&self, x: f64) -> usize {
        let off = |bin: &Rect| (bin.min.x - x).max(x - bin.max.x).max(0.0);
        let bins = 0..self.bins.len();
        bins.min_by(|&a, &b| off(&self.bins[a]).total_cmp(&off(&self.bins[b])))
            .unwrap_or(0)
    }

    /// The pose moved into its bin; `None` if the part is too large for it.
    pub(super) fn inside(&self, rotated: &ConvexPieces, pose: Pose) -> Option<Pose> {
        let range = self.range(rotated, self.bin_at(pose.x))?;
        let x = pose.x.clamp(range.min.x, range.max.x);
        Some(Pose { x, y: pose.y.clamp(range.min.y, range.max.y), ..pose })
    }

    /// Takes a part out of its bin.
    pub(super) fn remove(&mut self, part: usize) {
        let item = &mut self.items[part];
        (item.rotated, item.pose) = (ConvexPieces::default(), Pose::NOWHERE);
        self.bounds[part] = Rect::EMPTY;
        let count = self.items.len();
        for other in 0..count {
            self.losses[part * count + other] = 0.0;
            self.losses[other * count + part] = 0.0;
        }
    }

    /// Puts a part somewhere and sums up its losses.
    pub(super) fn put(&mut self, part: usize, pose: Pose) {
        let mut rotated = std::mem::take(&mut self.items[part].rotated);
        self.rotate(part, pose.angle, &mut rotated);
        self.bounds[part] = rotated.bounds.translated(pose.translation());
        self.items[part].pose = pose;
        self.items[part].rotated = rotated;
        let count = self.items.len();
        for other in 0..count {
            let loss = self.pair_loss(part, other);
            self.losses[part * count + other] = loss;
            self.losses[other * count + part] = loss;
        }
    }

    fn pair_loss(&self, part: usize, other: usize) -> f64 {
        let Item { pose, rotated, fixed, .. } = &self.items[part];
        // What may not move is as it is.
        let cannot = part == other || (*fixed && self.items[other].fixed);
        if cannot || !self.reach(part).overlaps(&self.bounds[other]) {
            return 0.0;
        }
        self.loss_at(part, other, (rotated, *pose), f64::INFINITY)
    }

    pub(super) const fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Distance that two must keep: walls have their own.
    fn gap(&self, part: usize, other: usize) -> f64 {
        let [a, b] = [part, other].map(|k| &self.items[k]);
        if b.fixed { b.gap } else { a.gap }
    }

    fn reach(&self, part: usize) -> Rect {
        self.bounds[part].inflated(self.spacing)
    }

    /// Loss of a pair; if it is more than `enough`, anything more than that.
    fn loss_at(
        &self,
        part: usize,
        other: usize,
        (rotated, pose): (&ConvexPieces, Pose),
        enough: f64,
    ) -> f64 {
        let there = &self.items[other];
        let by = there.pose.translation() - pose.translation();
        let weight = |k: usize| self.shapes[self.items[k].shape].weight;
        let weight = weight(part) * weight(other);
        let enough = (enough / weight).powi(2);
        let gap = self.gap(part, other);
        let overlap = rotated.overlap(&there.rotated, by, gap, enough);
        if overlap <= 0.0 { 0.0 } else { overlap.sqrt() * weight }
    }

    /// Weighted loss of a part if it lay at `pose`; infinite once it reaches `bound`.
    pub(super) fn cost(
        &mut self,
        part: usize,
        rotated: &ConvexPieces,
        pose: Pose,
        bound: f64,
    ) -> f64 {
        self.work += 1;
        let reach = rotated.bounds.translated(pose.translation()).inflated(self.spacing);
        let row = part * self.items.len();
        let mut cost = 0.0;
        for (other, bounds) in self.bounds.iter().enumerate() {
            if !reach.overlaps(bounds) || other == part {
                continue;
            }
            let weight = self.weights[row + other];
            let enough = (bound - cost) / weight * (1.0 + NEST_BOUND);
            cost += weight * self.loss_at(part, other, (rotated, pose), enough);
            if cost >= bound {
                return f64::INFINITY;
            }
        }
        cost
    }

    /// Weighted loss of a part where it lies.
    pub(super) fn cost_now(&self, part: usize) -> f64 {
        let row = part * self.items.len()..(part + 1) * self.items.len();
        self.losses[row.clone()].iter().zip(&self.weights[row]).map(|(l, w)| l * w).sum()
    }

    /// Unweighted loss of a part.
    pub(super) fn loss(&self, part: usize) -> f64 {
        let count = self.items.len();
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
        self.items.iter().map(|item| item.pose).collect()
    }

    /// Puts all parts, as far as they fit their bins by being moved.
    pub(super) fn restore(&mut self, poses: &[Pose]) {
        for (part, &pose) in poses.iter().enumerate() {
            if pose.is_nowhere() {
                self.remove(part);
                continue;
            }
            let mut rotated = std::mem::take(&mut self.items[part].rotated);
            self.rotate(part, pose.angle, &mut rotated);
            let fixed = self.items[part].fixed;
            let inside = if fixed { None } else { self.inside(&rotated, pose) };
            self.items[part].rotated = rotated;
            self.put(part, inside.unwrap_or(pose));
        }
    }
}
