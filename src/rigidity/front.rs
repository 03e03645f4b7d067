//! One front: gathering, elimination, and the update for the parent.

use crate::rigidity::factor::{Entries, Mail, Singular};
use crate::rigidity::panel::pack;
use crate::rigidity::symbolic::{Supernode, Symbolic};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::reborrow::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, MatRef, Par};

/// Products of more work than this are cut in two halves.
const LARGE: f64 = 2e7;

/// What one thread works with.
pub(super) struct Work<'a> {
    pub(super) symbolic: &'a Symbolic,
    threads: usize,
    /// By place of a group, its first row in the present front.
    local: Vec<u32>,
    /// Buffers of updates that were taken in, to be used again.
    spare: Vec<Vec<f64>>,
    /// The columns of the present front.
    columns: Vec<f64>,
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
            spare: Vec::new(),
            columns: Vec::new(),
        }
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

    /// Eliminates a supernode; puts its packed columns on the shelf and mails its update.
    pub(super) fn eliminate(
        &mut self,
        s: usize,
        entries: &dyn Entries,
        (shelf, mail): (&mut Vec<f64>, &mut Mail),
    ) -> Result<(), Singular> {
        let symbolic = self.symbolic;
        let node = &symbolic.supernodes[s];
        let height = node.width + node.below;
        self.enter(node);
        let mut columns = std::mem::take(&mut self.columns);
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
        let letters: Vec<(&Supernode, Vec<f64>)> = node
            .children
            .iter()
            .map(|&child| (&symbolic.supernodes[child], mail.take(child)))
            .collect();
        for (child, letter) in &letters {
            let side = Side { values: &mut columns, height, above: 0 };
            self.take_in((child, letter), node.width, side);
        }
        let mut update = self.buffer(node.below * node.below);
        self.reduce(node, &mut columns, &mut update[..node.below * node.below])?;
        for (child, letter) in letters {
            let (height, above) = (node.below, node.width);
            let side = Side { values: &mut update, height, above };
            self.take_in((child, &letter), node.width, side);
            self.spare.push(letter);
        }
        pack(&columns, node.width, shelf);
        self.columns = columns;
        mail.put(s, update);
        Ok(())
    }

    /// Room for so many numbers or more, whatever they are.
    fn buffer(&mut self, count: usize) -> Vec<f64> {
        let spare = self.spare.iter().enumerate().filter(|(_, room)| room.len() >= count);
        match spare.min_by_key(|(_, room)| room.len()).map(|(k, _)| k) {
            Some(k) => self.spare.swap_remove(k),
            None => vec![0.0; count.next_power_of_two()],
        }
    }

    /// Turns the columns of a front into the factor's; `update` becomes what they take from
    /// the rest.
    fn reduce(
        &self,
        node: &Supernode,
        columns: &mut [f64],
        update: &mut [f64],
    ) -> Result<(), Singular> {
        let (width, below) = (node.width, node.below);
        let height = width + below;
        let front = MatMut::from_column_major_slice_mut(columns, height, width);
        let (mut top, mut bottom) = front.split_at_row_mut(width);
        let scratch =
            cholesky_in_place_scratch::<f64>(width, Par::Seq, Default::default());
        cholesky_in_place(
            top.rb_mut(),
            Default::default(),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
            Default::default(),
        )
        .map_err(|_| Singular)?;
        if below > 0 {
            let update = MatMut::from_column_major_slice_mut(update, below, below);
            if node.work() < LARGE {
                solve_below(top.rb(), bottom.rb_mut());
                less_square(update, bottom.rb());
            } else {
                self.eliminate_large(top.rb(), bottom.rb_mut(), update);
            }
        }
        Ok(())
    }

    /// Adds that part of a child's update, of which the lower triangle counts, which
    /// belongs to one side of the present front of `width` own rows.
    fn take_in(&self, (child, letter): (&Supernode, &[f64]), width: usize, side: Side) {
        let runs = self.runs(child, width);
        let mut column = 0;
        for (index, &(local, size)) in runs.iter().enumerate() {
            if (local < width) != (side.above == 0) {
                column += size;
                continue;
            }
            for k in 0..size {
                let source = &letter[column * child.below..(column + 1) * child.below];
                let at = (local + k - side.above) * side.height;
                let target = &mut side.values[at..at + side.height];
                let (row, mut from) = (local + k - side.above, column);
                add(&mut target[row..row + size - k], &source[from..from + size - k]);
                from += size - k;
                for &(row, size) in &runs[index + 1..] {
                    let row = row - side.above;
                    add(&mut target[row..row + size], &source[from..from + size]);
                    from += size;
                }
                column += 1;
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

    /// The same in two halves, always cut in one place.
    fn eliminate_large(
        &self,
        top: MatRef<'_, f64>,
        bottom: MatMut<'_, f64>,
        update: MatMut<'_, f64>,
    ) {
        let below = bottom.nrows();
        let (mut upper, mut lower) = bottom.split_at_row_mut(below / 2);
        self.both(
            || solve_below(top, upper.rb_mut()),
            || solve_below(top, lower.rb_mut()),
        );
        let (upper, lower) = (upper.rb(), lower.rb());
        // Equal work: the first columns of a triangle are its longest.
        let cut = (below * 3 / 10).min(upper.nrows());
        let (left, right) = update.split_at_col_mut(cut);
        let (mut corner, mut side) = left.split_at_row_mut(cut);
        let mut rest = right.split_at_row_mut(cut).1;
        let (first, second) = upper.split_at_row(cut);
        let half = second.nrows();
        self.both(
            || {
                less_square(corner.rb_mut(), first);
                let (a, b) = side.rb_mut().split_at_row_mut(half);
                less_product(a, second, first);
                less_product(b, lower, first);
            },
            || {
                let (left, right) = rest.rb_mut().split_at_col_mut(half);
                let (a, b) = left.split_at_row_mut(half);
                less_square(a, second);
                less_product(b, lower, second);
                less_square(right.split_at_row_mut(half).1, lower);
            },
        );
    }

    fn both(&self, first: impl FnOnce() + Send, second: impl FnOnce() + Send) {
        if self.threads < 2 {
            first();
            second();
        } else {
            std::thread::scope(|scope| {
                scope.spawn(second);
                first();
            });
        }
    }
}

fn add(into: &mut [f64], values: &[f64]) {
    into.iter_mut().zip(values).for_each(|(x, v)| *x += v);
}

/// `bottom` becomes `bottom · top⁻ᵀ`.
fn solve_below(top: MatRef<'_, f64>, bottom: MatMut<'_, f64>) {
    solve_lower_triangular_in_place(top, bottom.transpose_mut(), Par::Seq);
}

/// The lower triangle of `into` becomes `-a · aᵀ`.
fn less_square(into: MatMut<'_, f64>, a: MatRef<'_, f64>) {
    triangular::matmul(
        into,
        BlockStructure::TriangularLower,
        Accum::Replace,
        a,
        BlockStructure::Rectangular,
        a.transpose(),
        BlockStructure::Rectangular,
        -1.0,
        Par::Seq,
    );
}

/// `into` becomes `-a · bᵀ`.
fn less_product(into: MatMut<'_, f64>, a: MatRef<'_, f64>, b: MatRef<'_, f64>) {
    matmul(into, Accum::Replace, a, b.transpose(), -1.0, Par::Seq);
}
