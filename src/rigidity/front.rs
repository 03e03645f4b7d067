//! One front: gathering, elimination, and the update for the parent.

use crate::rigidity::factor::{Entries, Singular};
use crate::rigidity::symbolic::{Supernode, Symbolic};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::reborrow::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, MatRef, Par};

/// Fronts of more work than this are made in parts.
const LARGE: f64 = 2e8;
/// Columns of a large front that are made together.
const TOGETHER: usize = 128;

/// What one thread works with.
pub(super) struct Work<'a> {
    pub(super) symbolic: &'a Symbolic,
    threads: usize,
    /// By place of a group, its first row in the present front.
    local: Vec<u32>,
    /// Updates that wait for their parents, on two stacks: of supernodes at even depth and
    /// at odd depth, so that a front reads from one and writes to the other.
    stacks: [Vec<f64>; 2],
    /// How much of each is in use.
    tops: [usize; 2],
    scratch: MemBuffer,
}

/// The update of a supernode, of which the lower triangle counts.
#[derive(Clone, Copy)]
pub(super) struct Letter<'a> {
    pub(super) child: &'a Supernode,
    pub(super) values: &'a [f64],
    /// Whether the columns begin at the diagonal.
    pub(super) packed: bool,
}

/// One side of a front: its own columns, or the update.
struct Side<'a> {
    values: &'a mut [f64],
    /// Length of a column.
    height: usize,
    /// Rows of the front that stand above the first row.
    above: usize,
}

impl<'a> Work<'a> {
    pub(super) fn new(symbolic: &'a Symbolic, threads: usize) -> Self {
        Self {
            symbolic,
            threads,
            local: vec![0; symbolic.place.len()],
            stacks: [Vec::new(), Vec::new()],
            tops: [0, 0],
            scratch: MemBuffer::new(faer::dyn_stack::StackReq::EMPTY),
        }
    }

    /// Makes room for the updates of some supernodes, children first, whose children are
    /// among them or have their letters in the `mail`.
    pub(super) fn make_room(
        &mut self,
        supernodes: impl Iterator<Item = usize>,
        mail: &[Vec<f64>],
    ) {
        let nodes = &self.symbolic.supernodes;
        let (mut tops, mut most) = ([0_usize; 2], [0_usize; 2]);
        let mut widest = 0;
        for s in supernodes {
            let node = &nodes[s];
            let own = usize::from(node.odd);
            tops[own] += node.below * node.below;
            most[own] = most[own].max(tops[own]);
            let gone =
                node.children.iter().filter(|&&k| mail.get(k).is_none_or(Vec::is_empty));
            tops[1 - own] -= gone.map(|&child| nodes[child].below.pow(2)).sum::<usize>();
            widest = widest.max(node.width);
        }
        for (stack, most) in self.stacks.iter_mut().zip(most) {
            if stack.len() < most {
                *stack = vec![0.0; most];
            }
        }
        self.tops = [0, 0];
        let scratch =
            cholesky_in_place_scratch::<f64>(widest, Par::Seq, Default::default());
        self.scratch = MemBuffer::new(scratch);
    }

    /// Numbers the rows of a front.
    fn enter(&mut self, node: &Supernode) {
        let mut row = 0;
        let own = (node.first..node.end).map(|k| k as u32);
        for k in own.chain(node.rows.iter().copied()) {
            self.local[k as usize] = row;
            row += self.symbolic.size(k as usize) as u32;
        }
    }

    /// The columns of a front with its own entries, in a buffer that is used again.
    pub(super) fn gather(
        &mut self,
        s: usize,
        entries: &dyn Entries,
        columns: &mut Vec<f64>,
    ) {
        let symbolic = self.symbolic;
        let node = &symbolic.supernodes[s];
        let height = node.width + node.below;
        self.enter(node);
        columns.clear();
        columns.resize(node.width * height, 0.0);
        entries.entries(s, &mut |row, column, block| {
            let [r, c] = [row, column].map(|group| self.local[group] as usize);
            let size = symbolic.size(row);
            for (k, values) in block.chunks_exact(size).enumerate() {
                let at = (c + k) * height + r;
                add(&mut columns[at..at + size], values);
            }
        });
    }

    /// Eliminates a supernode whose columns were gathered. Children whose letters are not
    /// in the `mail` have theirs on top of the stack.
    pub(super) fn eliminate(
        &mut self,
        s: usize,
        columns: &mut [f64],
        mail: &[Vec<f64>],
    ) -> Result<(), Singular> {
        let node = &self.symbolic.supernodes[s];
        let (height, own) = (node.width + node.below, usize::from(node.odd));
        self.enter(node);
        let mut stacks = std::mem::take(&mut self.stacks);
        let [even, odd] = &mut stacks;
        let (theirs, ours) = if node.odd { (even, odd) } else { (odd, even) };
        let (letters, left) = self.letters(node, &theirs[..self.tops[1 - own]], mail);
        self.tops[1 - own] = left;
        for &letter in &letters {
            let side = Side { values: columns, height, above: 0 };
            self.take_in(letter, node.width, side);
        }
        let from = self.tops[own];
        self.tops[own] += node.below * node.below;
        let update = &mut ours[from..self.tops[own]];
        self.reduce(node, columns, update)?;
        for &letter in &letters {
            let (height, above) = (node.below, node.width);
            let side = Side { values: update, height, above };
            self.take_in(letter, node.width, side);
        }
        self.stacks = stacks;
        Ok(())
    }

    /// The letters of the children, and how much of the stack is left without them.
    fn letters<'b>(
        &self,
        node: &Supernode,
        stack: &'b [f64],
        mail: &'b [Vec<f64>],
    ) -> (Vec<Letter<'b>>, usize)
    where
        'a: 'b,
    {
        let nodes = &self.symbolic.supernodes;
        let mut left = stack.len();
        let mut letters = Vec::with_capacity(node.children.len());
        for &k in node.children.iter().rev() {
            let child = &nodes[k];
            let mailed = mail.get(k).filter(|letter| !letter.is_empty());
            letters.push(match mailed {
                Some(values) => Letter { child, values, packed: true },
                None => {
                    let from = left - child.below * child.below;
                    let values = &stack[from..left];
                    left = from;
                    Letter { child, values, packed: false }
                }
            });
        }
        letters.reverse();
        (letters, left)
    }

    /// The update of the supernode that was eliminated last, packed.
    pub(super) fn last_letter(&mut self, s: usize) -> Vec<f64> {
        let node = &self.symbolic.supernodes[s];
        let own = usize::from(node.odd);
        let n = node.below;
        let values = &self.stacks[own][self.tops[own] - n * n..self.tops[own]];
        let mut packed = Vec::with_capacity(n * (n + 1) / 2);
        for k in 0..n {
            packed.extend_from_slice(&values[k * n + k..(k + 1) * n]);
        }
        packed
    }

    /// Turns the columns of a front into the factor's; `update` becomes what they take from
    /// the rest.
    fn reduce(
        &mut self,
        node: &Supernode,
        columns: &mut [f64],
        update: &mut [f64],
    ) -> Result<(), Singular> {
        let (width, below) = (node.width, node.below);
        let height = width + below;
        let mut front = MatMut::from_column_major_slice_mut(columns, height, width);
        let large = node.work() > LARGE;
        let threads = if large { self.threads } else { 1 };
        let step = if large { TOGETHER } else { width };
        for from in (0..width).step_by(step) {
            let to = (from + step).min(width);
            let (left, right) = front.rb_mut().split_at_col_mut(to);
            let made = left.split_at_col_mut(from).1.split_at_row_mut(from).1;
            let (mut top, mut bottom) = made.split_at_row_mut(to - from);
            cholesky_in_place(
                top.rb_mut(),
                Default::default(),
                Par::Seq,
                MemStack::new(&mut self.scratch),
                Default::default(),
            )
            .map_err(|_| Singular)?;
            let half = if large { bottom.nrows() / 2 } else { 0 };
            let (upper, lower) = bottom.rb_mut().split_at_row_mut(half);
            let top = top.rb();
            both(threads, || solve_below(top, lower), || solve_below(top, upper));
            let rest = right.split_at_row_mut(to).1;
            less_squares(threads, rest, bottom.rb(), Accum::Add);
        }
        let update = MatMut::from_column_major_slice_mut(update, below, below);
        less_squares(threads, update, front.rb().split_at_row(width).1, Accum::Replace);
        Ok(())
    }

    /// Adds that part of a child's update which belongs to one side of the present front of
    /// `width` own rows.
    fn take_in(&self, letter: Letter, width: usize, side: Side) {
        let runs = self.runs(letter.child, width);
        let height = letter.child.below;
        let (mut column, mut at) = (0, 0);
        for (index, &(local, size)) in runs.iter().enumerate() {
            for k in 0..size {
                let source = &letter.values[at..at + height - column];
                at += if letter.packed { height - column } else { height + 1 };
                column += 1;
                if (local < width) != (side.above == 0) {
                    continue;
                }
                let row = local + k - side.above;
                let from = row * side.height;
                let target = &mut side.values[from..from + side.height];
                let mut from = size - k;
                add(&mut target[row..row + from], &source[..from]);
                for &(row, size) in &runs[index + 1..] {
                    let row = row - side.above;
                    add(&mut target[row..row + size], &source[from..from + size]);
                    from += size;
                }
            }
        }
    }

    /// Rows of a child in the present front, as runs of (first row, length); none goes over
    /// the edge of the front's own `width` rows.
    fn runs(&self, child: &Supernode, width: usize) -> Vec<(usize, usize)> {
        let mut runs: Vec<(usize, usize)> = Vec::with_capacity(child.rows.len());
        for &row in &child.rows {
            let (local, size) =
                (self.local[row as usize] as usize, self.symbolic.size(row as usize));
            match runs.last_mut() {
                Some(last) if last.0 + last.1 == local && local != width => {
                    last.1 += size;
                }
                _ => runs.push((local, size)),
            }
        }
        runs
    }
}

fn both(threads: usize, first: impl FnOnce(), second: impl FnOnce() + Send) {
    if threads < 2 {
        first();
        second();
    } else {
        std::thread::scope(|scope| {
            scope.spawn(second);
            first();
        });
    }
}

fn add(into: &mut [f64], values: &[f64]) {
    into.iter_mut().zip(values).for_each(|(x, v)| *x += v);
}

/// `bottom` becomes `bottom · top⁻ᵀ`.
fn solve_below(top: MatRef<'_, f64>, bottom: MatMut<'_, f64>) {
    if bottom.nrows() > 0 {
        solve_lower_triangular_in_place(top, bottom.transpose_mut(), Par::Seq);
    }
}

/// Takes `a · aᵀ`, as far as it stands on or below the diagonal, from `into`, or writes its
/// opposite; in two parts if `threads` allow.
fn less_squares(threads: usize, into: MatMut<'_, f64>, a: MatRef<'_, f64>, accum: Accum) {
    // Equal work: the first columns of a triangle are its longest.
    let cut = if threads < 2 { 0 } else { into.ncols() * 3 / 10 };
    let (left, right) = into.split_at_col_mut(cut);
    let right = right.split_at_row_mut(cut).1;
    let low = a.split_at_row(cut).1;
    both(
        threads,
        || less_trapezoid(right, low, accum),
        || less_trapezoid(left, a, accum),
    );
}

fn less_trapezoid(into: MatMut<'_, f64>, a: MatRef<'_, f64>, accum: Accum) {
    let columns = into.ncols();
    if columns == 0 {
        return;
    }
    let (square, rest) = into.split_at_row_mut(columns);
    let (upper, lower) = a.split_at_row(columns);
    triangular::matmul(
        square,
        BlockStructure::TriangularLower,
        accum,
        upper,
        BlockStructure::Rectangular,
        upper.transpose(),
        BlockStructure::Rectangular,
        -1.0,
        Par::Seq,
    );
    if lower.nrows() > 0 {
        matmul(rest, accum, lower, upper.transpose(), -1.0, Par::Seq);
    }
}
