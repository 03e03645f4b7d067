//! One front: gathering, elimination, and the update for the parent.

use crate::sparse::error::NotPositiveDefinite;
use crate::sparse::symbolic::{Entries, Supernode, Symbolic};
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
pub(crate) struct Workspace<'a> {
    pub(crate) symbolic: &'a Symbolic,
    threads: usize,
    /// By place of a group, its first row in the present front.
    local: Vec<u32>,
    /// Updates that wait for their parents, on two stacks: of supernodes at even depth and
    /// at odd_depth depth, so that a front reads from one and writes to the other.
    stacks: [Vec<f64>; 2],
    /// How much of each is in use.
    tops: [usize; 2],
    scratch: MemBuffer,
}

/// The update of a supernode, of which the lower triangle counts.
#[derive(Clone, Copy)]
pub(crate) struct Update<'a> {
    pub(crate) child: &'a Supernode,
    pub(crate) values: &'a [f64],
    /// Whether the columns begin at the diagonal.
    pub(crate) packed: bool,
}

/// One part of a front: its own columns, or the update.
struct FrontPart<'a> {
    values: &'a mut [f64],
    /// Length of a column.
    height: usize,
    /// Rows of the front that stand above the first row.
    above: usize,
}

impl<'a> Workspace<'a> {
    pub(crate) fn new(symbolic: &'a Symbolic, threads: usize) -> Self {
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
    /// among them or were handed theirs.
    pub(crate) fn reserve(
        &mut self,
        supernodes: impl Iterator<Item = usize>,
        handed: &[Vec<f64>],
    ) {
        let nodes = &self.symbolic.supernodes;
        let (mut tops, mut most) = ([0_usize; 2], [0_usize; 2]);
        let mut widest = 0;
        for s in supernodes {
            let node = &nodes[s];
            let own = usize::from(node.odd_depth);
            tops[own] += node.below * node.below;
            most[own] = most[own].max(tops[own]);
            let gone = node
                .children
                .iter()
                .filter(|&&k| handed.get(k).is_none_or(Vec::is_empty));
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
    fn number_rows(&mut self, node: &Supernode) {
        let mut row = 0;
        let own = (node.first..node.end).map(|k| k as u32);
        for k in own.chain(node.rows.iter().copied()) {
            self.local[k as usize] = row;
            row += self.symbolic.size(k as usize) as u32;
        }
    }

    /// The columns of a front with its own entries, in a buffer that is used again.
    pub(crate) fn gather(
        &mut self,
        s: usize,
        entries: &dyn Entries,
        columns: &mut Vec<f64>,
    ) {
        let symbolic = self.symbolic;
        let node = &symbolic.supernodes[s];
        let height = node.width + node.below;
        self.number_rows(node);
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

    /// Eliminates a supernode whose columns were gathered. Children that were not handed
    /// theirs have them on top of the stack.
    pub(crate) fn eliminate(
        &mut self,
        s: usize,
        columns: &mut [f64],
        handed: &[Vec<f64>],
    ) -> Result<(), NotPositiveDefinite> {
        let node = &self.symbolic.supernodes[s];
        let (height, own) = (node.width + node.below, usize::from(node.odd_depth));
        self.number_rows(node);
        let mut stacks = std::mem::take(&mut self.stacks);
        let [even, odd_depth] = &mut stacks;
        let (theirs, ours) =
            if node.odd_depth { (even, odd_depth) } else { (odd_depth, even) };
        let (updates, left) = self.updates(node, &theirs[..self.tops[1 - own]], handed);
        self.tops[1 - own] = left;
        for &child in &updates {
            let part = FrontPart { values: columns, height, above: 0 };
            self.extend_add(child, node.width, part);
        }
        let from = self.tops[own];
        self.tops[own] += node.below * node.below;
        let update = &mut ours[from..self.tops[own]];
        self.reduce(node, columns, update)?;
        for &child in &updates {
            let (height, above) = (node.below, node.width);
            let part = FrontPart { values: update, height, above };
            self.extend_add(child, node.width, part);
        }
        self.stacks = stacks;
        Ok(())
    }

    /// The updates of the children, and how much of the stack is left without them.
    fn updates<'b>(
        &self,
        node: &Supernode,
        stack: &'b [f64],
        handed: &'b [Vec<f64>],
    ) -> (Vec<Update<'b>>, usize)
    where
        'a: 'b,
    {
        let nodes = &self.symbolic.supernodes;
        let mut left = stack.len();
        let mut updates = Vec::with_capacity(node.children.len());
        for &k in node.children.iter().rev() {
            let child = &nodes[k];
            let packed = handed.get(k).filter(|update| !update.is_empty());
            updates.push(match packed {
                Some(values) => Update { child, values, packed: true },
                None => {
                    let from = left - child.below * child.below;
                    let values = &stack[from..left];
                    left = from;
                    Update { child, values, packed: false }
                }
            });
        }
        updates.reverse();
        (updates, left)
    }

    /// The update of the supernode that was eliminated last, packed.
    pub(crate) fn last_update(&mut self, s: usize) -> Vec<f64> {
        let node = &self.symbolic.supernodes[s];
        let own = usize::from(node.odd_depth);
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
    ) -> Result<(), NotPositiveDefinite> {
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
            .map_err(|_| NotPositiveDefinite)?;
            let half = if large { bottom.nrows() / 2 } else { 0 };
            let (upper, lower) = bottom.rb_mut().split_at_row_mut(half);
            let top = top.rb();
            join(threads, || trsm(top, lower), || trsm(top, upper));
            let rest = right.split_at_row_mut(to).1;
            syrk(threads, rest, bottom.rb(), Accum::Add);
        }
        let update = MatMut::from_column_major_slice_mut(update, below, below);
        syrk(threads, update, front.rb().split_at_row(width).1, Accum::Replace);
        Ok(())
    }

    /// Adds that part of a child's update which belongs to one part of the present front of
    /// `width` own rows.
    fn extend_add(&self, update: Update, width: usize, part: FrontPart) {
        let runs = self.runs(update.child, width);
        let height = update.child.below;
        let (mut column, mut at) = (0, 0);
        for (index, &(local, size)) in runs.iter().enumerate() {
            for k in 0..size {
                let source = &update.values[at..at + height - column];
                at += if update.packed { height - column } else { height + 1 };
                column += 1;
                if (local < width) != (part.above == 0) {
                    continue;
                }
                let row = local + k - part.above;
                let from = row * part.height;
                let target = &mut part.values[from..from + part.height];
                let mut from = size - k;
                add(&mut target[row..row + from], &source[..from]);
                for &(row, size) in &runs[index + 1..] {
                    let row = row - part.above;
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

fn join(threads: usize, first: impl FnOnce(), second: impl FnOnce() + Send) {
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
fn trsm(top: MatRef<'_, f64>, bottom: MatMut<'_, f64>) {
    if bottom.nrows() > 0 {
        solve_lower_triangular_in_place(top, bottom.transpose_mut(), Par::Seq);
    }
}

/// Takes `a · aᵀ`, as far as it stands on or below the diagonal, from `into`, or writes its
/// opposite; in two parts if `threads` allow.
fn syrk(threads: usize, into: MatMut<'_, f64>, a: MatRef<'_, f64>, accum: Accum) {
    // Equal work: the first columns of a triangle are its longest.
    let cut = if threads < 2 { 0 } else { into.ncols() * 3 / 10 };
    let (left, right) = into.split_at_col_mut(cut);
    let right = right.split_at_row_mut(cut).1;
    let low = a.split_at_row(cut).1;
    join(
        threads,
        || syrk_trapezoid(right, low, accum),
        || syrk_trapezoid(left, a, accum),
    );
}

fn syrk_trapezoid(into: MatMut<'_, f64>, a: MatRef<'_, f64>, accum: Accum) {
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
