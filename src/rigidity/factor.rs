//! Sparse Cholesky by fronts (Duff and Reid 1983), on as many threads as are given.
//!
//! Each supernode gathers its entries and its children's updates in a dense front, is
//! eliminated by `faer`'s dense kernels and hands an update to its parent. Subtrees are
//! independent; the way they are cut does not depend on the number of threads, so that
//! results are the same bits on one thread and on many.

use crate::rigidity::front::Work;
use crate::rigidity::symbolic::Symbolic;
use faer::linalg::matmul::matmul;
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
pub(super) struct Mail {
    first: usize,
    letters: Vec<Option<Vec<f64>>>,
}

impl Mail {
    pub(super) fn new(range: Range<usize>) -> Self {
        Self { first: range.start, letters: vec![None; range.len()] }
    }

    pub(super) fn put(&mut self, s: usize, letter: Vec<f64>) {
        self.letters[s - self.first] = Some(letter);
    }

    pub(super) fn take(&mut self, s: usize) -> Vec<f64> {
        self.letters[s - self.first].take().unwrap_or_default()
    }
}

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
