//! Parts on sheets of stock.
//!
//! The caller gives shapes and stock and gets a [`Layout`] that has passed the exact
//! [`check`]; how it is found is this module's own business. Today: a *drop* nester. Parts
//! go in from large to small; each is let down from above at every place and in a few
//! turns onto what lies there already, and stays where it leaves least room lost. Several
//! orders are tried, a seeded number of trials, never seconds.

mod check;
mod drop;
mod error;
mod turn;

pub use check::{Fault, check};
pub use error::NestError;
pub use turn::fits;

use crate::geometry::Point2;
use crate::watch::Watch;
use drop::Board;

/// A part as the nester sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Name for messages.
    pub name: String,
    /// The curve that must keep its distance (the drawn cut line, arcs flattened),
    /// counter-clockwise, mm.
    pub outline: Vec<Point2>,
    /// Which turns are allowed.
    pub turns: Turns,
}

/// How a part may be turned on the sheet.
#[derive(Debug, Clone, PartialEq)]
pub enum Turns {
    /// By any angle.
    Free,
    /// Only by these angles, radians.
    Only(Vec<f64>),
}

/// A size of sheet one can buy or has in the rack.
#[derive(Debug, Clone, PartialEq)]
pub struct Stock {
    /// Width, mm.
    pub width: f64,
    /// Height, mm.
    pub height: f64,
    /// Strip along the sheet's edge that stays free, mm.
    pub margin: f64,
    /// Least distance between two parts, mm.
    pub spacing: f64,
    /// How many there are; `None` is as many as needed.
    pub count: Option<usize>,
}

/// Where a part lies: turned about its origin, then moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Index into the shapes given.
    pub shape: usize,
    /// Counter-clockwise turn, radians; a multiple of 1e-7 degrees.
    pub angle: f64,
    /// Then moved right, mm; a multiple of 1e-6.
    pub x: f64,
    /// Then moved up, mm; a multiple of 1e-6.
    pub y: f64,
}

/// One sheet of a layout.
#[derive(Debug, Clone, PartialEq)]
pub struct NestedSheet {
    /// Index into the stock given.
    pub stock: usize,
    /// What lies on it.
    pub placements: Vec<Placement>,
}

/// All parts on sheets.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// In order of cutting.
    pub sheets: Vec<NestedSheet>,
}

/// How hard to search, counted in trials: the same effort gives the same layout on every
/// machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// Orders of parts that are tried.
    pub trials: u32,
    /// Start of the random numbers.
    pub seed: u64,
}

/// Sheets that are still open for further parts.
const OPEN_SHEETS: usize = 4;

/// Lays all shapes on sheets of the stock; earlier entries of the stock are opened first,
/// and a sheet whose parts fit a smaller size becomes one.
///
/// # Errors
/// [`NestError`] names a shape that fits no sheet, what is left when the stock is used up,
/// or that the watch stopped the search before there was a layout.
pub fn nest(
    shapes: &[Shape],
    stock: &[Stock],
    effort: &Effort,
    watch: &mut dyn Watch,
) -> Result<Layout, NestError> {
    for shape in shapes {
        if !stock.iter().any(|sheet| fits(&shape.outline, &shape.turns, sheet).is_some())
        {
            return Err(NestError::too_large(shape, stock));
        }
    }
    let mut best: Option<(f64, Layout)> = None;
    let mut failure = NestError::Stopped;
    for trial in 0..effort.trials.max(1) {
        watch.progress("nest", trial as usize, effort.trials as usize);
        if watch.stopped() || (best.is_some() && watch.enough()) {
            break;
        }
        let order = order(shapes, trial, effort.seed);
        let tried =
            lay(shapes, stock, &order).and_then(|layout| sound(layout, shapes, stock));
        match tried {
            Ok((cost, layout))
                if best.as_ref().is_none_or(|(least, _)| cost < *least) =>
            {
                best = Some((cost, layout));
            }
            Ok(_) => {}
            Err(error) => failure = error,
        }
    }
    match best {
        Some((_, layout)) if !watch.stopped() => Ok(layout),
        Some(_) => Err(NestError::Stopped),
        None => Err(failure),
    }
}

/// Large parts first; later trials shuffle sizes by up to a third.
fn order(shapes: &[Shape], trial: u32, seed: u64) -> Vec<usize> {
    let mut state = seed ^ (u64::from(trial) << 32);
    let keys = shapes.iter().map(|shape| {
        let shuffle = if trial == 0 { 0.0 } else { random(&mut state) - 0.5 };
        turn::longest(&shape.outline) * (1.0 + 0.6 * shuffle)
    });
    let mut keyed: Vec<(usize, f64)> = keys.enumerate().collect();
    keyed.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    keyed.into_iter().map(|(index, _)| index).collect()
}

/// The next number of splitmix64, in [0, 1).
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// One layout: each part goes on the first open sheet that takes it.
fn lay(
    shapes: &[Shape],
    stock: &[Stock],
    order: &[usize],
) -> Result<Vec<Board>, NestError> {
    let mut boards: Vec<Board> = Vec::new();
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
        boards.push(fresh.ok_or_else(|| NestError::used_up(shape))?);
    }
    Ok(boards)
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
