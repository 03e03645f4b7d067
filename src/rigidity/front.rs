//! One front: gathering, elimination, and the update for the parent.

use crate::rigidity::factor::{Entries, Mail, Singular};
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
    symbolic: &'a Symbolic,
    threads: usize,
    /// By place of a group, its first row in the present front.
    local: Vec<u32>,
    /// Buffers of updates that were taken in, to be used again.
    spare: Vec<Vec<f64>>,
}

impl<'a> Work<'a> {
    pub(super) fn new(symbolic: &'a Symbolic, threads: usize) -> Self {
        Self {
            symbolic,
            threads,
            local: vec![0; symbolic.place.len()],
            spare: Vec::new(),
        }
    }

    /// Numbers the rows of a front.
    pub(super) fn enter(&mut self, node: &Supernode) {
        let mut row = 0;
        let own = (node.first..node.end).map(|k| k as u32);
        for k in own.chain(node.rows.iter().copied()) {
            self.local[k as usize] = row;
            row += self.symbolic.size(k as usize) as u32;
        }
    }

    pub(super) fn local(&self, group: usize) -> usize {
        self.local[group] as usize
    }

    /// Eliminates a supernode; returns its columns and mails its update.
    pub(super) fn eliminate(
        &mut self,
        s: usize,
        entries: &dyn Entries,
        mail: &mut Mail,
    ) -> Result<Vec<f64>, Singular> {
        let symbolic = self.symbolic;
        let node = &symbolic.supernodes[s];
        let (width, below) = (node.width, node.below);
        let height = width + below;
        let mut columns = vec![0.0; width * height];
        let mut update = self.spare.pop().unwrap_or_default();
        update.clear();
        update.resize(below * below, 0.0);
        self.enter(node);
        entries.entries(s, &mut |row, column, block| {
            let (r, c) = (self.local(row), self.local(column));
            let size = symbolic.size(row);
            for (k, values) in block.chunks_exact(size).enumerate() {
                if c < width {
                    let at = (c + k) * height + r;
                    add(&mut columns[at..at + size], values);
                } else {
                    let at = (c - width + k) * below + r - width;
                    add(&mut update[at..at + size], values);
                }
            }
        });
        for &child in &node.children {
            let letter = mail.take(child);
            self.take_in(
                &symbolic.supernodes[child],
                &letter,
                (&mut columns, &mut update),
            );
            self.spare.push(letter);
        }
        self.reduce(node, &mut columns, &mut update)?;
        mail.put(s, update);
        Ok(columns)
    }

    /// Turns the columns of a front into the factor's and takes their share from the update.
    fn reduce(
        &self,
        node: &Supernode,
        columns: &mut [f64],
        update: &mut [f64],
    ) -> Result<(), Singular> {
        let (width, below) = (node.width, node.below);
        let height = width + below;
        let mut front = MatMut::from_column_major_slice_mut(columns, height, width);
        let (mut top, mut bottom) = front.rb_mut().split_at_row_mut(width);
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
                subtract_square(update, bottom.rb());
            } else {
                self.eliminate_large(top.rb(), bottom.rb_mut(), update);
            }
        }
        Ok(())
    }

    /// Adds a child's update, whose lower triangle counts, to the front.
    fn take_in(&self, child: &Supernode, letter: &[f64], into: (&mut [f64], &mut [f64])) {
        let (columns, update) = into;
        let symbolic = self.symbolic;
        let parent_owner = child.parent.map(|p| &symbolic.supernodes[p]);
        let Some(parent) = parent_owner else { return };
        let (width, height) = (parent.width, parent.width + parent.below);
        let runs = self.runs(child, width);
        let mut column_of = 0;
        for (index, &(local, size)) in runs.iter().enumerate() {
            for c in local..local + size {
                let source =
                    &letter[column_of * child.below..(column_of + 1) * child.below];
                let (target, top) = if c < width {
                    (&mut columns[c * height..(c + 1) * height], 0)
                } else {
                    let c = c - width;
                    (&mut update[c * parent.below..(c + 1) * parent.below], width)
                };
                let mut from: usize = runs[..index].iter().map(|run| run.1).sum();
                for &(row, size) in &runs[index..] {
                    add(
                        &mut target[row - top..row - top + size],
                        &source[from..from + size],
                    );
                    from += size;
                }
                column_of += 1;
            }
        }
    }

    /// Rows of a child in the present front, as runs of (first row, length); none goes over
    /// the edge of the front's own `width` rows.
    fn runs(&self, child: &Supernode, width: usize) -> Vec<(usize, usize)> {
        let mut runs: Vec<(usize, usize)> = Vec::with_capacity(child.rows.len());
        for &row in &child.rows {
            let (local, size) =
                (self.local(row as usize), self.symbolic.size(row as usize));
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
                subtract_square(corner.rb_mut(), first);
                let (mut a, mut b) = side.rb_mut().split_at_row_mut(half);
                matmul(a.rb_mut(), Accum::Add, second, first.transpose(), -1.0, Par::Seq);
                matmul(b.rb_mut(), Accum::Add, lower, first.transpose(), -1.0, Par::Seq);
            },
            || {
                let (left, right) = rest.rb_mut().split_at_col_mut(half);
                let (mut a, mut b) = left.split_at_row_mut(half);
                subtract_square(a.rb_mut(), second);
                matmul(b.rb_mut(), Accum::Add, lower, second.transpose(), -1.0, Par::Seq);
                subtract_square(right.split_at_row_mut(half).1, lower);
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

/// Takes `a · aᵀ` from the lower triangle of `from`.
fn subtract_square(from: MatMut<'_, f64>, a: MatRef<'_, f64>) {
    triangular::matmul(
        from,
        BlockStructure::TriangularLower,
        Accum::Add,
        a,
        BlockStructure::Rectangular,
        a.transpose(),
        BlockStructure::Rectangular,
        -1.0,
        Par::Seq,
    );
}
