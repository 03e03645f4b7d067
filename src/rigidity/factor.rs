//! Sparse Cholesky by fronts (Duff and Reid 1983), on as many threads as are given.
//!
//! Each supernode gathers its entries and its children's updates in a dense front, is
//! eliminated by `faer`'s dense kernels and hands an update to its parent. Subtrees are
//! independent; the way they are cut does not depend on the number of threads, so that
//! results are the same bits on one thread and on many.

use crate::rigidity::symbolic::{Supernode, Symbolic};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::reborrow::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, MatRef, Par};
use std::ops::Range;

/// Where a symmetric matrix gets its entries from.
pub(super) trait Entries: Sync {
    /// Hands all entries whose first eliminated group belongs to `supernode` to `add`: as
    /// row group, column group (places, row after or at column) and the column-major
    /// block, of which the lower triangle counts if both are the same group.
    fn entries(&self, supernode: usize, add: &mut dyn FnMut(usize, usize, &[f64]));
}

/// The matrix is not positive definite: a motion meets no resistance at all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Singular;

/// A Cholesky factor.
pub(super) struct Factor<'a> {
    symbolic: &'a Symbolic,
    branches: Vec<usize>,
    /// Per supernode its columns, `width + below` long, one after another.
    columns: Vec<Vec<f64>>,
    threads: usize,
}

/// What supernodes hand to their parents, by supernode from `first` on.
struct Mail {
    first: usize,
    letters: Vec<Option<Vec<f64>>>,
}

impl Mail {
    fn new(range: Range<usize>) -> Self {
        Self { first: range.start, letters: vec![None; range.len()] }
    }

    fn put(&mut self, s: usize, letter: Vec<f64>) {
        self.letters[s - self.first] = Some(letter);
    }

    fn take(&mut self, s: usize) -> Vec<f64> {
        self.letters[s - self.first].take().unwrap_or_default()
    }
}

/// Products of more work than this are cut in two halves.
const LARGE: f64 = 2e7;

impl<'a> Factor<'a> {
    /// Factorises.
    ///
    /// # Errors
    /// [`Singular`] if a pivot is not positive.
    pub(super) fn new(
        symbolic: &'a Symbolic,
        entries: &dyn Entries,
        threads: usize,
    ) -> Result<Self, Singular> {
        let branches = symbolic.branches();
        let all = symbolic.supernodes.len();
        let mut factor =
            Self { symbolic, branches, columns: vec![Vec::new(); all], threads };
        let done = factor.side_by_side(|root| {
            let range = symbolic.supernodes[root].leaf..root + 1;
            let mut mail = Mail::new(range.clone());
            let mut work = Work::new(symbolic, 1);
            let columns: Result<Vec<_>, Singular> =
                range.map(|s| work.eliminate(s, entries, &mut mail)).collect();
            Ok::<_, Singular>((root, columns?, mail.take(root)))
        });
        let mut mail = Mail::new(0..all);
        for branch in done {
            let (root, columns, update) = branch?;
            let leaf = symbolic.supernodes[root].leaf;
            for (slot, column) in factor.columns[leaf..].iter_mut().zip(columns) {
                *slot = column;
            }
            mail.put(root, update);
        }
        let mut work = Work::new(symbolic, threads);
        for s in factor.trunk() {
            factor.columns[s] = work.eliminate(s, entries, &mut mail)?;
        }
        Ok(factor)
    }

    /// Supernodes above all branches, children first.
    fn trunk(&self) -> Vec<usize> {
        let mut in_branch = vec![false; self.symbolic.supernodes.len()];
        for &root in &self.branches {
            in_branch[self.symbolic.supernodes[root].leaf..=root].fill(true);
        }
        (0..in_branch.len()).filter(|&s| !in_branch[s]).collect()
    }

    /// Runs `task` for the root of every branch; results in the order of branches.
    fn side_by_side<T: Send>(&self, task: impl Fn(usize) -> T + Sync) -> Vec<T> {
        if self.threads < 2 || self.symbolic.unknowns() < 5000 {
            return self.branches.iter().map(|&root| task(root)).collect();
        }
        let next = std::sync::atomic::AtomicUsize::new(0);
        let mut results: Vec<(usize, T)> = std::thread::scope(|scope| {
            let worker = || {
                let mut mine = Vec::new();
                loop {
                    let k = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    let Some(&root) = self.branches.get(k) else { return mine };
                    mine.push((k, task(root)));
                }
            };
            let workers: Vec<_> =
                (1..self.threads).map(|_| scope.spawn(worker)).collect();
            let mut all = worker();
            for other in workers {
                match other.join() {
                    Ok(results) => all.extend(results),
                    Err(panic) => std::panic::resume_unwind(panic),
                }
            }
            all
        });
        results.sort_by_key(|(k, _)| *k);
        results.into_iter().map(|(_, result)| result).collect()
    }

    /// Solves for `count` right-hand sides at once; `x` holds them row by row, `count`
    /// numbers per unknown, and receives the solutions.
    pub(super) fn solve(&self, x: &mut [f64], count: usize) {
        self.forward(x, count);
        self.backward(x, count);
    }

    fn rows(&self, range: &Range<usize>, count: usize) -> Range<usize> {
        let of = |s: usize| self.symbolic.start[self.symbolic.supernodes[s].first];
        let end = match range.end {
            end if end == self.symbolic.supernodes.len() => self.symbolic.unknowns(),
            end => of(end),
        };
        of(range.start) * count..end * count
    }

    fn forward(&self, x: &mut [f64], count: usize) {
        let all = self.symbolic.supernodes.len();
        let nodes = &self.symbolic.supernodes;
        let shared: &[f64] = x;
        let done = self.side_by_side(|root| {
            let range = nodes[root].leaf..root + 1;
            let rows = self.rows(&range, count);
            let mut part = shared[rows.clone()].to_vec();
            let mut mail = Mail::new(range.clone());
            let mut work = Work::new(self.symbolic, 1);
            for s in range {
                self.forward_one(
                    s,
                    (&mut part, rows.start),
                    &mut mail,
                    (&mut work, count),
                );
            }
            (root, rows, part, mail.take(root))
        });
        let mut mail = Mail::new(0..all);
        for (root, rows, part, update) in done {
            x[rows].copy_from_slice(&part);
            mail.put(root, update);
        }
        let mut work = Work::new(self.symbolic, 1);
        for s in self.trunk() {
            self.forward_one(s, (x, 0), &mut mail, (&mut work, count));
        }
    }

    fn forward_one(
        &self,
        s: usize,
        (x, base): (&mut [f64], usize),
        mail: &mut Mail,
        (work, count): (&mut Work, usize),
    ) {
        let node = &self.symbolic.supernodes[s];
        let from = self.symbolic.start[node.first] * count - base;
        let own = &mut x[from..from + node.width * count];
        let mut below = vec![0.0; node.below * count];
        work.enter(node);
        for &child in &node.children {
            let letter = mail.take(child);
            let mut read = letter.chunks_exact(count);
            for &row in &self.symbolic.supernodes[child].rows {
                let size = self.symbolic.size(row as usize);
                let at = work.local(row as usize);
                for k in at..at + size {
                    let Some(values) = read.next() else { break };
                    let into = match k.checked_sub(node.width) {
                        None => &mut own[k * count..(k + 1) * count],
                        Some(k) => &mut below[k * count..(k + 1) * count],
                    };
                    into.iter_mut().zip(values).for_each(|(x, v)| *x += v);
                }
            }
        }
        let height = node.width + node.below;
        let l = MatRef::from_column_major_slice(&self.columns[s], height, node.width);
        let mut own = MatMut::from_row_major_slice_mut(own, node.width, count);
        solve_lower_triangular_in_place(l.subrows(0, node.width), own.rb_mut(), Par::Seq);
        let mut update = MatMut::from_row_major_slice_mut(&mut below, node.below, count);
        let l = l.subrows(node.width, node.below);
        matmul(update.rb_mut(), Accum::Add, l, own.rb(), -1.0, Par::Seq);
        mail.put(s, below);
    }

    fn backward(&self, x: &mut [f64], count: usize) {
        let nodes = &self.symbolic.supernodes;
        let mut mail = Mail::new(0..nodes.len());
        let mut work = Work::new(self.symbolic, 1);
        for s in self.trunk().into_iter().rev() {
            self.backward_one(s, (x, 0), &mut mail, (&mut work, count));
        }
        let shared: &[f64] = x;
        let letters: Vec<Vec<f64>> =
            self.branches.iter().map(|&root| mail.take(root)).collect();
        let branch_of: std::collections::BTreeMap<usize, usize> =
            self.branches.iter().enumerate().map(|(k, &root)| (root, k)).collect();
        let done = self.side_by_side(|root| {
            let range = nodes[root].leaf..root + 1;
            let rows = self.rows(&range, count);
            let mut part = shared[rows.clone()].to_vec();
            let mut mail = Mail::new(range.clone());
            mail.put(root, letters[branch_of[&root]].clone());
            let mut work = Work::new(self.symbolic, 1);
            for s in range.rev() {
                self.backward_one(
                    s,
                    (&mut part, rows.start),
                    &mut mail,
                    (&mut work, count),
                );
            }
            (rows, part)
        });
        for (rows, part) in done {
            x[rows].copy_from_slice(&part);
        }
    }

    fn backward_one(
        &self,
        s: usize,
        (x, base): (&mut [f64], usize),
        mail: &mut Mail,
        (work, count): (&mut Work, usize),
    ) {
        let node = &self.symbolic.supernodes[s];
        let from = self.symbolic.start[node.first] * count - base;
        let own = &mut x[from..from + node.width * count];
        let below = mail.take(s);
        let height = node.width + node.below;
        let l = MatRef::from_column_major_slice(&self.columns[s], height, node.width);
        let mut mine = MatMut::from_row_major_slice_mut(own, node.width, count);
        let under = MatRef::from_row_major_slice(&below, node.below, count);
        let l_under = l.subrows(node.width, node.below).transpose();
        matmul(mine.rb_mut(), Accum::Add, l_under, under, -1.0, Par::Seq);
        let l = l.subrows(0, node.width).transpose();
        solve_upper_triangular_in_place(l, mine.rb_mut(), Par::Seq);
        work.enter(node);
        for &child in &node.children {
            let rows = &self.symbolic.supernodes[child];
            let mut letter = Vec::with_capacity(rows.below * count);
            for &row in &rows.rows {
                let size = self.symbolic.size(row as usize);
                let at = work.local(row as usize);
                for k in at..at + size {
                    letter.extend_from_slice(match k.checked_sub(node.width) {
                        None => &own[k * count..(k + 1) * count],
                        Some(k) => &below[k * count..(k + 1) * count],
                    });
                }
            }
            mail.put(child, letter);
        }
    }
}

/// What one thread works with.
struct Work<'a> {
    symbolic: &'a Symbolic,
    threads: usize,
    /// By place of a group, its first row in the present front.
    local: Vec<u32>,
}

impl<'a> Work<'a> {
    fn new(symbolic: &'a Symbolic, threads: usize) -> Self {
        Self { symbolic, threads, local: vec![0; symbolic.place.len()] }
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

    fn local(&self, group: usize) -> usize {
        self.local[group] as usize
    }

    /// Eliminates a supernode; returns its columns and mails its update.
    fn eliminate(
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
        let mut update = vec![0.0; below * below];
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
        }
        let mut front = MatMut::from_column_major_slice_mut(&mut columns, height, width);
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
            let update = MatMut::from_column_major_slice_mut(&mut update, below, below);
            if node.work() < LARGE {
                solve_below(top.rb(), bottom.rb_mut());
                subtract_square(update, bottom.rb());
            } else {
                self.eliminate_large(top.rb(), bottom.rb_mut(), update);
            }
        }
        mail.put(s, update);
        Ok(columns)
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
                    last.1 += size
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
