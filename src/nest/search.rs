//! From a sound layout to a better one: what found no place is tried again, sheets are
//! exchanged for cheaper ones or emptied, and the last one is compacted so that a
//! rectangle of it is left over.

use crate::nest::budget::{Budget, UNIT};
use crate::nest::collision_shape::Pose;
use crate::nest::convex::ConvexPieces;
use crate::nest::instance::Instance;
use crate::nest::random::Random;
use crate::nest::state::OverlapState;
use crate::nest::{Layout, Placement, Shape, Stock};
use crate::tolerance::ROOM_MM;

/// More parts than this are searched in groups: the state keeps a table of all pairs.
pub(super) const MOST_PARTS: usize = 1500;

/// A better layout of the given parts (in rising order), or `None`. Not checked yet.
pub(super) fn denser(
    layout: &Layout,
    parts: Vec<usize>,
    (shapes, stock): (&[Shape], &[Stock]),
    seed: u64,
    budget: &mut Budget,
) -> Option<Layout> {
    let sheets: Vec<usize> = layout.sheets.iter().map(|sheet| sheet.stock).collect();
    if sheets.is_empty() {
        return None;
    }
    let priorities = parts.iter().map(|&k| shapes[k].priority).collect();
    let instance = Instance::new(shapes, parts, stock)?;
    let mut state = instance.state(&sheets, Random::new(seed));
    state.work = budget.done * UNIT;
    instance.put(&mut state, layout);
    if state.total() > 0.0 && !state.separate(budget) {
        return None;
    }
    let mut search = Search { instance: &instance, state, sheets, priorities };
    search.run(shapes, budget);
    Some(instance.layout(&search.state, &search.sheets))
}

/// Units for each act of the first round.
const FIRST: u64 = 50;
/// Share of the material up to which other sheets are tried before the emptiest is compacted
/// together, and beyond which they are not tried at all.
const ROOMY: f64 = 0.62;
const FULLEST: f64 = 0.9;
/// Pressing gets so many times the units of an exchange.
const COMPACTION: u64 = 4;

pub(super) struct Search<'a> {
    pub(super) instance: &'a Instance<'a>,
    pub(super) state: OverlapState<'a>,
    /// Stock of each bin.
    pub(super) sheets: Vec<usize>,
    /// Of each part.
    pub(super) priorities: Vec<i32>,
}

impl Search<'_> {
    fn run(&mut self, shapes: &[Shape], budget: &mut Budget) {
        self.insert_unplaced(budget);
        let mut units = FIRST;
        while !budget.over {
            let work = self.state.work;
            let (gained, cut) = self.improve(units, budget);
            if gained {
                let layout = self.instance.layout(&self.state, &self.sheets);
                budget.show(layout, shapes, self.instance.stock);
            }
            // Where nothing was cut short, more of the same would not help either; without an
            // evaluation the clock is not looked at.
            let idle = self.state.work == work;
            if idle || !(gained || cut || budget.is_endless()) {
                break;
            }
            units = if gained { units } else { units.saturating_mul(2) };
        }
    }

    /// Easy exchanges of sheets, then the emptiest sheet compacted, and only when
    /// that gains nothing hard exchanges; whether there was a gain, and whether something
    /// was cut short.
    fn improve(&mut self, units: u64, budget: &mut Budget) -> (bool, bool) {
        let (exchanged, cut) = self.exchange(ROOMY, units, budget);
        let (compacted, too) = budget
            .within(COMPACTION.saturating_mul(units), |budget| {
                self.compact_emptiest(budget)
            });
        if exchanged || compacted {
            return (true, cut || too);
        }
        let (exchanged, also) = self.exchange(FULLEST, units, budget);
        (exchanged, cut || too || also)
    }

    /// The emptiest sheet that is a bare rectangle.
    pub(super) fn emptiest(&self) -> Option<usize> {
        let plain = |bin: &usize| self.instance.stock[self.sheets[*bin]].is_plain();
        let plain = (0..self.sheets.len()).filter(plain).map(|k| (self.filled(k), k));
        plain.min_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1))).map(|(_, bin)| bin)
    }

    /// Presses the emptiest plain sheet together, into the others if need be, and gives it
    /// up once it is empty; `true` if more of it is free now.
    fn compact_emptiest(&mut self, budget: &mut Budget) -> bool {
        let Some(bin) = self.emptiest().filter(|_| !budget.over) else { return false };
        let (before, whole) = (self.state.used(bin), self.state.bins[bin]);
        self.state.compact(bin, false, budget, &mut |_, _| ());
        let after = self.state.used(bin);
        self.state.bins[bin] = whole;
        if self.filled(bin) <= 0.0 {
            self.close_bin(bin);
        }
        after < before
    }

    /// Area of the parts in a bin.
    pub(super) fn filled(&self, bin: usize) -> f64 {
        let items = self.state.items.iter().filter(|m| !m.pose.is_nowhere());
        let inside = items.filter(|m| self.state.bin_at(m.pose.x) == bin);
        inside.map(|m| self.instance.shapes[m.shape].area).sum()
    }

    pub(super) fn area(&self, part: usize) -> f64 {
        self.instance.shapes[self.state.items[part].shape].area
    }

    /// Tries to find room for the parts that have none, by priority, then the small ones
    /// first: as many as can be. If need be, parts of lower priority make room.
    fn insert_unplaced(&mut self, budget: &mut Budget) {
        let count = self.priorities.len();
        let nowhere =
            |search: &Self, part: &usize| search.state.items[*part].pose.is_nowhere();
        let mut tried = vec![false; count];
        while !budget.over {
            let open = (0..count).filter(|part| !tried[*part] && nowhere(self, part));
            let next = open.max_by(|&a, &b| {
                let priority = self.priorities[a].cmp(&self.priorities[b]);
                priority.then(self.area(b).total_cmp(&self.area(a))).then(b.cmp(&a))
            });
            let Some(part) = next else { break };
            tried[part] = true;
            if self.insert(part, &[], budget) {
                continue;
            }
            let lower = self.lower_than(part);
            if !lower.is_empty() {
                self.insert(part, &lower, budget);
            }
        }
    }

    /// Parts that must make room for one of higher priority: the least important first, as
    /// much area as it needs.
    fn lower_than(&self, part: usize) -> Vec<usize> {
        let items = &self.state.items;
        let mut lower: Vec<usize> = (0..self.priorities.len()).collect();
        lower.retain(|&k| {
            let moves = !items[k].fixed && !items[k].pose.is_nowhere();
            moves && self.priorities[k] < self.priorities[part]
        });
        lower.sort_by_key(|&k| self.priorities[k]);
        let mut left = 1.5 * self.area(part);
        let needed = lower.iter().take_while(|&&k| {
            let more = left > 0.0;
            left -= self.area(k);
            more
        });
        let count = needed.count();
        lower.truncate(count);
        lower
    }

    /// Lets a part in, where some others are taken out for it.
    fn insert(&mut self, part: usize, others: &[usize], budget: &mut Budget) -> bool {
        let bins: f64 = self.sheets.iter().map(|&k| self.instance.stock[k].area()).sum();
        let filled: f64 = (0..self.sheets.len()).map(|bin| self.filled(bin)).sum();
        let freed: f64 = others.iter().map(|&k| self.area(k)).sum();
        if filled - freed + self.area(part) > bins {
            return false;
        }
        let before = self.state.poses();
        others.iter().for_each(|&other| self.state.remove(other));
        let done = self.state.insert(part, budget);
        if !done {
            self.state.restore(&before);
        }
        done
    }
}

impl OverlapState<'_> {
    /// Lets one more part in, where all can be separated again.
    pub(super) fn insert(&mut self, part: usize, budget: &mut Budget) -> bool {
        let before = self.poses();
        let done = self.insert_overlapping(part) && self.separate(budget);
        if !done {
            self.restore(&before);
        }
        done
    }

    /// Puts a part where it overlaps least of some random places.
    pub(super) fn insert_overlapping(&mut self, part: usize) -> bool {
        let mut scratch = ConvexPieces::default();
        scratch.angle = f64::NAN;
        let mut best: Option<(f64, Pose)> = None;
        for _ in 0..200 {
            let Some(pose) = self.anywhere(part, &mut scratch) else { continue };
            let bound = best.map_or(f64::INFINITY, |(cost, _)| cost);
            let cost = self.cost(part, &scratch, pose, bound);
            if cost < bound {
                best = Some((cost, pose));
            }
        }
        if let Some((_, pose)) = best {
            self.put(part, pose);
        }
        best.is_some()
    }
}

/// Parts in a strip of fixed height, as short as the budget allows: the placements and the
/// length, margin included at both ends. `None` if a part does not fit or its rings cross.
pub(super) fn strip(
    shapes: &[Shape],
    stock: &Stock,
    seed: u64,
    budget: &mut Budget,
) -> Option<(Vec<Placement>, f64)> {
    let (margin, stock) = (stock.margin, std::slice::from_ref(stock));
    let instance = Instance::new(shapes, (0..shapes.len()).collect(), stock)?;
    let mut state = instance.state(&[0], Random::new(seed));
    state.bins[0].max.x = margin;
    state.fill();
    if state.items.iter().any(|item| item.pose.is_nowhere()) {
        return None;
    }
    if state.total() <= 0.0 || state.separate(budget) {
        let mut shown = |state: &OverlapState, budget: &mut Budget| {
            let stock =
                Stock { width: state.used(0) + margin + ROOM_MM, ..stock[0].clone() };
            budget.show(instance.layout(state, &[0]), shapes, &[stock]);
        };
        state.compact(0, budget.is_endless(), budget, &mut shown);
    }
    let layout = instance.layout(&state, &[0]);
    let placements = layout.sheets.into_iter().flat_map(|sheet| sheet.placements);
    Some((placements.collect(), state.used(0) + margin))
}
