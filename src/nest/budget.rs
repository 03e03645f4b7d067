//! How much work a search may do, and how it is counted.

use crate::geometry::ring;
use crate::nest::{Layout, Shape, Stock, check};
use crate::watch::Watch;

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
            let filled: f64 = parts.map(|p| ring::area(&shapes[p.shape].outline)).sum();
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
