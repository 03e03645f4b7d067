//! More parts than one state can hold: sheets are searched a few at a time.
//!
//! The emptiest sheets come first and together. In each group one sheet is compacted into the
//! others; in the next pass those that are emptiest now meet, until no pass gains anything.

use crate::geometry::ring;
use crate::nest::budget::Budget;
use crate::nest::search::{self, MOST_PARTS};
use crate::nest::{Layout, NestedSheet, Shape, Stock, check};

/// Parts and sheets searched together, at most; one sheet may hold more parts.
const GROUP_PARTS: usize = 400;
const GROUP_SHEETS: usize = 8;
/// Units for each group in the first pass; doubled when a pass gained nothing.
const FIRST: u64 = 16;

/// A better layout of the given parts (in rising order), or `None`. Not checked yet.
pub(super) fn denser(
    layout: &Layout,
    parts: Vec<usize>,
    (shapes, stock): (&[Shape], &[Stock]),
    seed: u64,
    budget: &mut Budget,
) -> Option<Layout> {
    if parts.len() <= MOST_PARTS {
        return search::denser(layout, parts, (shapes, stock), seed, budget);
    }
    let mut layout = layout.clone();
    let mut units = FIRST;
    while !budget.over {
        let before = worth(&layout, shapes, stock);
        layout = pass(layout, (shapes, stock), (seed, units), budget);
        let gained = worth(&layout, shapes, stock) < before;
        if gained {
            budget.show(layout.clone(), shapes, stock);
        }
        units = units.saturating_mul(if gained { 1 } else { 2 });
        if units >= budget.units {
            break;
        }
    }
    Some(layout)
}

/// Searches all groups once.
fn pass(
    mut layout: Layout,
    (shapes, stock): (&[Shape], &[Stock]),
    (seed, units): (u64, u64),
    budget: &mut Budget,
) -> Layout {
    let filled = |sheet: &NestedSheet| area(sheet, shapes) / stock[sheet.stock].area();
    layout.sheets.sort_by(|a, b| filled(a).total_cmp(&filled(b)));
    let mut done: Vec<NestedSheet> = Vec::new();
    let mut left = layout.sheets;
    let shows = std::mem::replace(&mut budget.shows, false);
    while !left.is_empty() && !budget.over {
        let rest = left.split_off(group(&left));
        let own = Layout { sheets: left };
        let elsewhere: Vec<usize> = done.iter().chain(&rest).map(|s| s.stock).collect();
        let stock = without(stock, &elsewhere);
        let (better, _) = budget.within(units, |budget| {
            let parts = own.sheets.iter().flat_map(|s| &s.placements).map(|p| p.shape);
            let mut parts: Vec<usize> = parts.collect();
            parts.sort_unstable();
            search::denser(&own, parts, (shapes, &stock), seed, budget)
        });
        let sound = |layout: &Layout| check(layout, shapes, &stock).is_empty();
        done.extend(better.filter(sound).unwrap_or(own).sheets);
        left = rest;
    }
    budget.shows = shows;
    done.extend(left);
    Layout { sheets: done }
}

/// How many of the first sheets are searched together.
fn group(sheets: &[NestedSheet]) -> usize {
    let mut parts = 0;
    let few = sheets.iter().take(GROUP_SHEETS).take_while(|sheet| {
        parts += sheet.placements.len();
        parts <= GROUP_PARTS
    });
    few.count().max(1)
}

/// The stock that is left when some of it is in use.
fn without(stock: &[Stock], used: &[usize]) -> Vec<Stock> {
    let left = |(kind, sheet): (usize, &Stock)| {
        let used = used.iter().filter(|&&k| k == kind).count();
        let count =
            if used > 0 && !sheet.locked.is_empty() { Some(0) } else { sheet.count };
        Stock { count: count.map(|count| count.saturating_sub(used)), ..sheet.clone() }
    };
    stock.iter().enumerate().map(left).collect()
}

/// What the sheets cost, then how full the emptiest is: less is better.
fn worth(layout: &Layout, shapes: &[Shape], stock: &[Stock]) -> [f64; 2] {
    let cost = layout.sheets.iter().map(|sheet| stock[sheet.stock].cost).sum();
    let filled = layout.sheets.iter().map(|sheet| area(sheet, shapes));
    [cost, filled.fold(f64::INFINITY, f64::min)]
}

/// Area of the parts on a sheet, mm².
fn area(sheet: &NestedSheet, shapes: &[Shape]) -> f64 {
    sheet.placements.iter().map(|p| ring::area(&shapes[p.shape].outline)).sum()
}
