//! A first layout that is sound: parts are let down one by one, from large to small.
//!
//! Each part stays where it leaves least room lost. A few orders of parts are tried.

use crate::nest::drop::Board;
use crate::nest::random::Random;
use crate::nest::{Effort, Layout, NestError, Shape, Stock, check, fits, turn};
use crate::watch::Watch;

/// Sheets that are still open for further parts.
const OPEN_SHEETS: usize = 4;
/// Orders that are tried at most, and the parts beyond which one must do.
const ORDERS: u32 = 8;
const MANY_PARTS: usize = 1000;

/// The cheapest of some layouts, and what found no place, with the reason.
pub(super) fn start(
    shapes: &[Shape],
    stock: &[Stock],
    effort: &Effort,
    watch: &mut dyn Watch,
) -> Result<(Layout, Vec<NestError>), NestError> {
    let fit = |k: &usize| {
        let Shape { outline, turns, .. } = &shapes[*k];
        stock.iter().any(|sheet| fits(outline, turns, sheet).is_some())
    };
    let (fitting, too_large): (Vec<usize>, Vec<usize>) = (0..shapes.len()).partition(fit);
    let mut best: Option<(usize, f64, Layout, Vec<usize>)> = None;
    let mut failure = NestError::Stopped;
    let orders =
        if shapes.len() > MANY_PARTS { 1 } else { effort.trials.clamp(1, ORDERS) };
    for trial in 0..orders {
        watch.progress("nest", trial as usize, orders as usize);
        if watch.stopped() {
            break;
        }
        let order = order(shapes, &fitting, trial, effort.seed);
        let (boards, left) = lay(shapes, stock, &order);
        match sound(boards, shapes, stock) {
            Ok((cost, layout)) => {
                let rank = |best: &(usize, f64, Layout, Vec<usize>)| {
                    left.len().cmp(&best.0).then(cost.total_cmp(&best.1)).is_lt()
                };
                if best.as_ref().is_none_or(rank) {
                    best = Some((left.len(), cost, layout, left));
                }
            }
            Err(error) => failure = error,
        }
    }
    let (_, _, layout, left) = best.ok_or(failure)?;
    let too_large =
        too_large.into_iter().map(|k| NestError::too_large(&shapes[k], stock));
    let left = left.into_iter().map(|k| NestError::used_up(&shapes[k]));
    Ok((layout, too_large.chain(left).collect()))
}

/// Large parts first; later trials shuffle sizes by up to a third.
fn order(shapes: &[Shape], fitting: &[usize], trial: u32, seed: u64) -> Vec<usize> {
    let mut random = Random::new(seed ^ (u64::from(trial) << 32));
    let keys = fitting.iter().map(|&k| {
        let shuffle = if trial == 0 { 0.0 } else { random.unit() - 0.5 };
        (k, turn::longest(&shapes[k].outline) * (1.0 + 0.6 * shuffle))
    });
    let mut keyed: Vec<(usize, f64)> = keys.collect();
    keyed.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
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
        let fresh = stock.iter().enumerate().find_map(|(kind, sheet)| {
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

/// Smaller sheets where they do, then the exact check; the first value is the cost.
fn sound(
    boards: Vec<Board>,
    shapes: &[Shape],
    stock: &[Stock],
) -> Result<(f64, Layout), NestError> {
    let boards = smaller(boards, shapes, stock);
    let area = |board: &Board| stock[board.stock].width * stock[board.stock].height;
    let last = boards.last().map_or(0.0, |board| board.filled() / 1e3);
    let cost = boards.iter().map(area).sum::<f64>() + last;
    let sheets = boards.into_iter().map(Board::nested).collect();
    let layout = Layout { sheets };
    match check(&layout, shapes, stock).first() {
        None => Ok((cost, layout)),
        Some(fault) => Err(NestError::Unsound { fault: fault.to_string() }),
    }
}

/// Each sheet as the smallest size on which its parts still fit.
fn smaller(boards: Vec<Board>, shapes: &[Shape], stock: &[Stock]) -> Vec<Board> {
    let mut used = vec![0; stock.len()];
    for board in &boards {
        used[board.stock] += 1;
    }
    let area = |kind: usize| stock[kind].width * stock[kind].height;
    let mut kinds: Vec<usize> = (0..stock.len()).collect();
    kinds.sort_by(|&a, &b| area(a).total_cmp(&area(b)).then(a.cmp(&b)));
    let mut shrink = |board: Board| {
        let fitting = kinds.iter().copied().find_map(|kind| {
            let left = stock[kind].count.is_none_or(|count| used[kind] < count);
            if area(kind) >= area(board.stock) || !left {
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
