//! A first layout that is sound: parts are let down one by one, from large to small.
//!
//! Remnants, and sheets on which parts lie already, are filled at random places, bare
//! rectangles bottom-left: each part stays where it leaves least room lost. Holes of parts
//! are filled before. A few orders of parts are tried.

use crate::nest::bottom_left::OpenSheet;
use crate::nest::convex::ConvexPieces;
use crate::nest::hole_filling::FilledHoles;
use crate::nest::instance::Instance;
use crate::nest::random::Random;
use crate::nest::search::MOST_PARTS;
use crate::nest::{
    Effort, Layout, NestError, NestedSheet, Shape, Stock, check, fits_any, rotation,
};
use crate::watch::{Stopped, Watch};
use std::collections::BTreeSet;

/// Sheets that are still open for further parts.
const OPEN_SHEETS: usize = 4;
/// Orders that are tried at most, and the parts beyond which one must do.
const ORDERS: u32 = 8;
const MANY_PARTS: usize = 1000;

/// Parts in a row that find no place before the others are not tried any more.
const FAILURES: usize = 100;
/// More pieces of one kind are not opened.
const MOST_SHEETS: usize = 100;

/// The cheapest of some layouts with most of what is important on it.
pub(super) fn initial_layout(
    shapes: &[Shape],
    stock: &[Stock],
    effort: &Effort,
    watch: &mut dyn Watch,
) -> Result<Layout, NestError> {
    let mut open = vec![true; shapes.len()];
    stock.iter().flat_map(|s| &s.locked).for_each(|p| open[p.shape] = false);
    let mut fitting: Vec<usize> = (0..shapes.len()).collect();
    fitting.retain(|&k| open[k] && fits_any(&shapes[k], stock));
    let first = order(shapes, &fitting, 0, effort.seed);
    let filled = FilledHoles::fill(shapes, stock, &first, effort.seed);
    let found = laid(&filled, (shapes, stock), &fitting, effort, watch);
    match found {
        Err(NestError::Unsound { .. }) if !filled.is_empty() => {
            laid(&FilledHoles::none(shapes), (shapes, stock), &fitting, effort, watch)
        }
        found => found,
    }
}

/// The best layout of some orders, with what lies in holes.
fn laid(
    filled: &FilledHoles,
    (shapes, stock): (&[Shape], &[Stock]),
    fitting: &[usize],
    effort: &Effort,
    watch: &mut dyn Watch,
) -> Result<Layout, NestError> {
    let solid = &filled.shapes;
    let inside: BTreeSet<usize> = filled.within(fitting).collect();
    let mut fitting = fitting.to_vec();
    fitting.retain(|part| !inside.contains(part));
    let (cheap, dear) = irregular_kinds(stock);
    let first = order(solid, &fitting, 0, effort.seed);
    let (cheap, rest) = fill_irregular(solid, stock, &cheap, first, effort.seed);
    let mut best: Option<(Vec<i32>, f64, Layout)> = None;
    let mut failure = NestError::Stopped(Stopped);
    let orders =
        if shapes.len() > MANY_PARTS { 1 } else { effort.trials.clamp(1, ORDERS) };
    for trial in 0..orders {
        watch.progress("nest", trial as usize, orders as usize);
        if watch.stopped() {
            break;
        }
        let mut order = order(solid, &rest, trial, effort.seed);
        let (open_sheets, left) = lay(filled, stock, &mut order);
        let open_sheets = smaller(open_sheets, solid, stock);
        let last = open_sheets.last().map_or(0.0, OpenSheet::filled);
        let (dear, left) = fill_irregular(solid, stock, &dear, left, effort.seed);
        let nested = open_sheets.into_iter().map(OpenSheet::nested);
        let sheets = cheap.iter().cloned().chain(nested).chain(dear).collect();
        let layout = filled.with_contents(Layout { sheets });
        if let Some(fault) = check(&layout, shapes, stock).first() {
            failure = NestError::Unsound { fault: fault.to_string() };
            continue;
        }
        let mut missing: Vec<i32> = left.iter().map(|&k| shapes[k].priority).collect();
        missing.sort_by(|a, b| b.cmp(a));
        let cost: f64 = layout.sheets.iter().map(|s| stock[s.stock].cost).sum();
        // How far the last sheet is filled decides between layouts of the same cost.
        let cost = cost * (1.0 + f64::EPSILON.sqrt() * last);
        let is_better = |best: &(Vec<i32>, f64, Layout)| {
            missing.cmp(&best.0).then(cost.total_cmp(&best.1)).is_lt()
        };
        if best.as_ref().is_none_or(is_better) {
            best = Some((missing, cost, layout));
        }
    }
    best.map(|(_, _, layout)| layout).ok_or(failure)
}

/// Important parts first if there may not be room for all, then large ones; later trials
/// shuffle sizes by up to a third.
fn order(shapes: &[Shape], fitting: &[usize], trial: u32, seed: u64) -> Vec<usize> {
    let mut random = Random::new(seed ^ (u64::from(trial) << 32));
    let keys = fitting.iter().map(|&k| {
        let shuffle = if trial == 0 { 0.0 } else { random.unit() - 0.5 };
        (k, rotation::longest(&shapes[k].outline) * (1.0 + 0.6 * shuffle))
    });
    let mut keyed: Vec<(usize, f64)> = keys.collect();
    keyed.sort_by(|a, b| {
        let priority = shapes[b.0].priority.cmp(&shapes[a.0].priority);
        priority.then(b.1.total_cmp(&a.1)).then(a.0.cmp(&b.0))
    });
    keyed.into_iter().map(|(index, _)| index).collect()
}

/// One layout: each part goes on the first open sheet that takes it; and what is left.
/// What should lie in the holes of a part that is left over is laid by itself.
fn lay(
    filled: &FilledHoles,
    stock: &[Stock],
    order: &mut Vec<usize>,
) -> (Vec<OpenSheet>, Vec<usize>) {
    let mut open_sheets: Vec<OpenSheet> = Vec::new();
    let mut left_over = Vec::new();
    let mut next = 0;
    while let Some(&index) = order.get(next) {
        next += 1;
        let shape = &filled.shapes[index];
        let first_open = open_sheets.len().saturating_sub(OPEN_SHEETS);
        if open_sheets[first_open..]
            .iter_mut()
            .any(|open_sheet| open_sheet.place(index, shape))
        {
            continue;
        }
        let used = |kind: usize| {
            open_sheets.iter().filter(|open_sheet| open_sheet.stock == kind).count()
        };
        let plain = stock.iter().enumerate().filter(|(_, sheet)| sheet.is_plain());
        let fresh = plain.into_iter().find_map(|(kind, sheet)| {
            let left = sheet.count.is_none_or(|count| used(kind) < count);
            let mut open_sheet = OpenSheet::new(kind, sheet);
            (left && open_sheet.place(index, shape)).then_some(open_sheet)
        });
        match fresh {
            Some(open_sheet) => open_sheets.push(open_sheet),
            None => {
                left_over.push(index);
                order.extend(filled.within(&[index]));
            }
        }
    }
    (open_sheets, left_over)
}

/// Each sheet as the cheapest one on which its parts still fit.
fn smaller(
    open_sheets: Vec<OpenSheet>,
    shapes: &[Shape],
    stock: &[Stock],
) -> Vec<OpenSheet> {
    let mut used = vec![0; stock.len()];
    for open_sheet in &open_sheets {
        used[open_sheet.stock] += 1;
    }
    let cost = |kind: usize| stock[kind].cost;
    let mut kinds: Vec<usize> = (0..stock.len()).collect();
    kinds.retain(|&kind| stock[kind].is_plain());
    kinds.sort_by(|&a, &b| cost(a).total_cmp(&cost(b)).then(a.cmp(&b)));
    let mut shrink = |open_sheet: OpenSheet| {
        let fitting = kinds.iter().copied().find_map(|kind| {
            let left = stock[kind].count.is_none_or(|count| used[kind] < count);
            if cost(kind) >= cost(open_sheet.stock) || !left {
                return None;
            }
            let mut small = OpenSheet::new(kind, &stock[kind]);
            let indices = open_sheet.placements.iter().map(|placement| placement.shape);
            let all = indices.into_iter().all(|k| small.place(k, &shapes[k]));
            all.then_some(small)
        });
        match fitting {
            Some(small) => {
                used[open_sheet.stock] -= 1;
                used[small.stock] += 1;
                small
            }
            None => open_sheet,
        }
    };
    open_sheets.into_iter().map(&mut shrink).collect()
}

/// The kinds of irregular stock to be filled before all other sheets, and those that cost more.
fn irregular_kinds(stock: &[Stock]) -> (Vec<usize>, Vec<usize>) {
    let rate = |s: &Stock| s.cost / s.area().max(f64::MIN_POSITIVE);
    let plain = stock.iter().filter(|s| s.is_plain()).map(rate);
    let cheapest = plain.fold(f64::INFINITY, f64::min);
    let irregular = (0..stock.len()).filter(|&kind| !stock[kind].is_plain());
    irregular.partition(|&k| !stock[k].locked.is_empty() || rate(&stock[k]) <= cheapest)
}

/// Lays parts on all sheets of the given kinds, in the order given, as long as they find a
/// place; the sheets that are not empty, and the parts that are left.
pub(super) fn fill_irregular(
    shapes: &[Shape],
    stock: &[Stock],
    kinds: &[usize],
    order: Vec<usize>,
    seed: u64,
) -> (Vec<NestedSheet>, Vec<usize>) {
    let many = |&kind: &usize| vec![kind; stock[kind].most().min(MOST_SHEETS)];
    let sheets: Vec<usize> = kinds.iter().flat_map(many).collect();
    let mut parts: Vec<usize> = order.iter().copied().take(MOST_PARTS).collect();
    let locked = kinds.iter().flat_map(|&kind| &stock[kind].locked);
    parts.extend(locked.map(|placement| placement.shape));
    parts.sort_unstable();
    let instance =
        if sheets.is_empty() { None } else { Instance::new(shapes, parts, stock) };
    let Some(instance) = instance else { return (Vec::new(), order) };
    let mut state = instance.state(&sheets, Random::new(seed));
    let mut scratch = ConvexPieces::default();
    let (mut failed, mut left) = (0, Vec::new());
    for index in order {
        let part =
            instance.parts.binary_search(&index).ok().filter(|_| failed < FAILURES);
        scratch.angle = f64::NAN;
        let pose = part.and_then(|part| {
            state.free_place(part, &mut scratch).map(|pose| (part, pose))
        });
        match pose {
            Some((part, pose)) => {
                failed = 0;
                state.put(part, pose);
            }
            None => {
                failed += 1;
                left.push(index);
            }
        }
    }
    let Layout { sheets } = instance.layout(&state, &sheets);
    (sheets, left)
}
