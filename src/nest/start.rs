//! A first layout that is sound: parts are let down one by one, from large to small.
//!
//! Each part stays where it leaves least room lost. A few orders of parts are tried.

use crate::nest::drop::Board;
use crate::nest::random::Random;
use crate::nest::{Effort, Layout, NestError, Shape, Stock, check, fits_any, odd, turn};
use crate::watch::{Stopped, Watch};

/// Sheets that are still open for further parts.
const OPEN_SHEETS: usize = 4;
/// Orders that are tried at most, and the parts beyond which one must do.
const ORDERS: u32 = 8;
const MANY_PARTS: usize = 1000;

/// The cheapest of some layouts with most of what is important on it.
pub(super) fn start(
    shapes: &[Shape],
    stock: &[Stock],
    effort: &Effort,
    watch: &mut dyn Watch,
) -> Result<Layout, NestError> {
    let mut open = vec![true; shapes.len()];
    stock.iter().flat_map(|s| &s.locked).for_each(|p| open[p.shape] = false);
    let mut fitting: Vec<usize> = (0..shapes.len()).collect();
    fitting.retain(|&k| open[k] && fits_any(&shapes[k], stock));
    let (cheap, dear) = odd::kinds(stock);
    let first = order(shapes, &fitting, 0, effort.seed);
    let (cheap, rest) = odd::fill(shapes, stock, &cheap, first, effort.seed);
    let mut best: Option<(Vec<i32>, f64, Layout)> = None;
    let mut failure = NestError::Stopped(Stopped);
    let orders =
        if shapes.len() > MANY_PARTS { 1 } else { effort.trials.clamp(1, ORDERS) };
    for trial in 0..orders {
        watch.progress("nest", trial as usize, orders as usize);
        if watch.stopped() {
            break;
        }
        let order = order(shapes, &rest, trial, effort.seed);
        let (boards, left) = lay(shapes, stock, &order);
        let boards = smaller(boards, shapes, stock);
        let last = boards.last().map_or(0.0, Board::filled);
        let (dear, left) = odd::fill(shapes, stock, &dear, left, effort.seed);
        let nested = boards.into_iter().map(Board::nested);
        let layout =
            Layout { sheets: cheap.iter().cloned().chain(nested).chain(dear).collect() };
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
        (k, turn::longest(&shapes[k].outline) * (1.0 + 0.6 * shuffle))
    });
    let mut keyed: Vec<(usize, f64)> = keys.collect();
    keyed.sort_by(|a, b| {
        let priority = shapes[b.0].priority.cmp(&shapes[a.0].priority);
        priority.then(b.1.total_cmp(&a.1)).then(a.0.cmp(&b.0))
    });
    keyed.into_iter().map(|(index, _)| index).collect()
}

/// One layout: each part goes on the first open sheet that takes it; and what is left.
fn lay(shapes: &[Shape], stock: &[Stock], order: &[usize]) -> (Vec<Board>, Vec<usize>) {
    let mut boards: Vec<Board> = Vec::new();
    let mut left_over = Vec::new();
    for &index in order {
        let shape = &shapes[index];
        let first_open = boards.len().saturating_sub(OPEN_SHEETS);
        if boards[first_open..].iter_mut().any(|board| board.place(index, shape)) {
            continue;
        }
        let used =
            |kind: usize| boards.iter().filter(|board| board.stock == kind).count();
        let plain = stock.iter().enumerate().filter(|(_, sheet)| sheet.is_plain());
        let fresh = plain.into_iter().find_map(|(kind, sheet)| {
            let left = sheet.count.is_none_or(|count| used(kind) < count);
            let mut board = Board::new(kind, sheet);
            (left && board.place(index, shape)).then_some(board)
        });
        match fresh {
            Some(board) => boards.push(board),
            None => left_over.push(index),
        }
    }
    (boards, left_over)
}

/// Each sheet as the cheapest one on which its parts still fit.
fn smaller(boards: Vec<Board>, shapes: &[Shape], stock: &[Stock]) -> Vec<Board> {
    let mut used = vec![0; stock.len()];
    for board in &boards {
        used[board.stock] += 1;
    }
    let cost = |kind: usize| stock[kind].cost;
    let mut kinds: Vec<usize> = (0..stock.len()).collect();
    kinds.retain(|&kind| stock[kind].is_plain());
    kinds.sort_by(|&a, &b| cost(a).total_cmp(&cost(b)).then(a.cmp(&b)));
    let mut shrink = |board: Board| {
        let fitting = kinds.iter().copied().find_map(|kind| {
            let left = stock[kind].count.is_none_or(|count| used[kind] < count);
            if cost(kind) >= cost(board.stock) || !left {
                return None;
            }
            let mut small = Board::new(kind, &stock[kind]);
            let indices = board.placements.iter().map(|placement| placement.shape);
            let all = indices.into_iter().all(|k| small.place(k, &shapes[k]));
            all.then_some(small)
        });
        match fitting {
            Some(small) => {
                used[board.stock] -= 1;
                used[small.stock] += 1;
                small
            }
            None => board,
        }
    };
    boards.into_iter().map(&mut shrink).collect()
}
