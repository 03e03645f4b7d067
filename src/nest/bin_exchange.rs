//! Other sheets for the same parts: one or two sheets are given up for cheaper ones, or for
//! none at all.

use crate::nest::Stock;
use crate::nest::budget::Budget;
use crate::nest::collision_shape::Pose;
use crate::nest::search::Search;
use crate::nest::state::OverlapState;
use std::collections::BTreeMap;

/// Attempts at each choice of sheets.
const ATTEMPTS: usize = 2;
/// Share of the material up to which any choice is as easy as another: what saves most goes
/// first.
const EASY: f64 = 0.6;

/// Sheets given up, by kind, and those taken instead.
struct BinExchange {
    given: Vec<usize>,
    taken: Vec<usize>,
    /// Share of the material that parts would cover.
    full: f64,
    /// What is saved.
    saved: f64,
}

impl Search<'_> {
    /// Goes over to cheaper sheets, the least full ones first, until no exchange up to that
    /// share of the material succeeds; whether one did, and whether an attempt was cut
    /// short by its units.
    pub(super) fn exchange(
        &mut self,
        fullest: f64,
        units: u64,
        budget: &mut Budget,
    ) -> (bool, bool) {
        let mut tried: BTreeMap<Vec<usize>, usize> = BTreeMap::new();
        let (mut succeeded, mut cut) = (false, false);
        'next: while !budget.over {
            for exchange in self.exchanges(fullest) {
                let after = exchange.after(&self.sheets);
                let attempts = tried.entry(after).or_default();
                if *attempts < ATTEMPTS {
                    *attempts += 1;
                    let rank = *attempts - 1;
                    let (done, was_cut) = budget
                        .within(units, |budget| self.attempt(&exchange, rank, budget));
                    succeeded |= done;
                    cut |= was_cut;
                    continue 'next;
                }
            }
            break;
        }
        (succeeded, cut)
    }

    /// All exchanges that save something and leave enough material.
    fn exchanges(&self, fullest: f64) -> Vec<BinExchange> {
        let stock = self.instance.stock;
        let mut used = vec![0; stock.len()];
        self.sheets.iter().for_each(|&kind| used[kind] += 1);
        let parts: f64 = (0..self.sheets.len()).map(|bin| self.filled(bin)).sum();
        let area: f64 = self.sheets.iter().map(|&kind| stock[kind].area()).sum();
        let sum = |kinds: &[usize], of: fn(&Stock) -> f64| -> f64 {
            kinds.iter().map(|&kind| of(&stock[kind])).sum()
        };
        // A remnant that costs nothing is used rather than left.
        let is_whole = |kinds: &[usize]| kinds.iter().all(|&kind| stock[kind].is_plain());
        let choices = choices(stock.len());
        let mut all = Vec::new();
        for given in choices.iter().filter(|given| !given.is_empty()) {
            let may_go = |kind: usize| {
                let count = given.iter().filter(|&&k| k == kind).count();
                used[kind] >= count && stock[kind].locked.is_empty()
            };
            if !given.iter().all(|&kind| may_go(kind)) {
                continue;
            }
            for taken in
                choices.iter().filter(|taken| !taken.iter().any(|k| given.contains(k)))
            {
                let is_there = |kind: usize| {
                    let count = taken.iter().filter(|&&k| k == kind).count();
                    used[kind] + count <= stock[kind].most()
                };
                let saved = sum(given, |s| s.cost) - sum(taken, |s| s.cost);
                let left = area - sum(given, Stock::area) + sum(taken, Stock::area);
                let full = parts / left.max(f64::MIN_POSITIVE);
                let fewer = taken.len() < given.len() && is_whole(given);
                let better = saved > 0.0 || (saved >= 0.0 && fewer);
                if better && full < fullest && taken.iter().all(|&kind| is_there(kind)) {
                    let (given, taken) = (given.clone(), taken.clone());
                    all.push(BinExchange { given, taken, full, saved });
                }
            }
        }
        let easiest = |a: &BinExchange, b: &BinExchange| {
            let full = |exchange: &BinExchange| exchange.full.max(EASY);
            let for_nothing = |exchange: &BinExchange| exchange.saved <= 0.0;
            let order = for_nothing(a).cmp(&for_nothing(b));
            order.then(full(a).total_cmp(&full(b))).then(b.saved.total_cmp(&a.saved))
        };
        all.sort_by(easiest);
        all
    }

    /// Gives up sheets, the emptiest of their kind or, by rank, the next; their parts go
    /// where they overlap least, and all are separated. If that fails, everything is as
    /// before.
    fn attempt(
        &mut self,
        exchange: &BinExchange,
        rank: usize,
        budget: &mut Budget,
    ) -> bool {
        let mut order: Vec<usize> = (0..self.sheets.len()).collect();
        let filled: Vec<f64> = order.iter().map(|&bin| self.filled(bin)).collect();
        order.sort_by(|&a, &b| filled[a].total_cmp(&filled[b]).then(b.cmp(&a)));
        let mut gone = vec![false; self.sheets.len()];
        for &kind in &exchange.given {
            let of_kind = order.iter().filter(|&&bin| self.sheets[bin] == kind);
            let left: Vec<usize> = of_kind.filter(|&&bin| !gone[bin]).copied().collect();
            if let Some(&bin) = left.get(rank.min(left.len().saturating_sub(1))) {
                gone[bin] = true;
            }
        }
        let kept = |bins: &[usize]| -> Vec<usize> {
            bins.iter().zip(&gone).filter(|(_, gone)| !**gone).map(|(k, _)| *k).collect()
        };
        let mut sheets = kept(&self.sheets);
        let bins = kept(&(0..self.sheets.len()).collect::<Vec<_>>());
        sheets.extend(&exchange.taken);
        self.with_sheets(sheets, &bins, budget)
    }

    /// Goes over to other sheets; `bins` are the old bins that the first of them were.
    fn with_sheets(
        &mut self,
        sheets: Vec<usize>,
        bins: &[usize],
        budget: &mut Budget,
    ) -> bool {
        let (mut next, mut homeless) = self.moved(&sheets, bins);
        let size = |part: usize| self.instance.shapes[self.state.items[part].shape].size;
        homeless.sort_by(|&a, &b| size(b).total_cmp(&size(a)).then(a.cmp(&b)));
        let placed = homeless.into_iter().all(|part| next.insert_overlapping(part));
        if placed && next.separate(budget) {
            self.state = next;
            self.sheets = sheets;
            return true;
        }
        (self.state.random, self.state.work) = (next.random, next.work);
        false
    }
}

impl<'a> Search<'a> {
    /// A state on other sheets, with the parts of those bins that are kept, and the parts
    /// that lose their bin.
    fn moved(&self, sheets: &[usize], bins: &[usize]) -> (OverlapState<'a>, Vec<usize>) {
        let mut next = self.instance.state(sheets, self.state.random.clone());
        next.work = self.state.work;
        let mut homeless = Vec::new();
        for part in 0..self.priorities.len() {
            let item = &self.state.items[part];
            if item.fixed || item.pose.is_nowhere() {
                continue;
            }
            let bin = self.state.bin_at(item.pose.x);
            match bins.iter().position(|&old| old == bin) {
                Some(new) => {
                    let by = next.bins[new].min.x - self.state.bins[bin].min.x;
                    next.put(part, Pose { x: item.pose.x + by, ..item.pose });
                }
                None => homeless.push(part),
            }
        }
        (next, homeless)
    }

    /// Goes on without a bin in which nothing lies.
    pub(super) fn close_bin(&mut self, bin: usize) {
        let bins: Vec<usize> = (0..self.sheets.len()).filter(|&k| k != bin).collect();
        let sheets: Vec<usize> = bins.iter().map(|&k| self.sheets[k]).collect();
        (self.state, _) = self.moved(&sheets, &bins);
        self.sheets = sheets;
    }
}

impl BinExchange {
    /// The kinds of sheet after it, in order.
    fn after(&self, sheets: &[usize]) -> Vec<usize> {
        let mut after = sheets.to_vec();
        for kind in &self.given {
            if let Some(at) = after.iter().position(|k| k == kind) {
                after.swap_remove(at);
            }
        }
        after.extend(&self.taken);
        after.sort_unstable();
        after
    }
}

/// No kind, one, or two of them.
fn choices(kinds: usize) -> Vec<Vec<usize>> {
    let mut all = vec![Vec::new()];
    for a in 0..kinds {
        all.push(vec![a]);
        all.extend((a..kinds).map(|b| vec![a, b]));
    }
    all
}
