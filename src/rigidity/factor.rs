//! Sparse Cholesky by fronts (Duff and Reid 1983), on as many threads as are given.
//!
//! Each supernode gathers its entries and its children's updates in a dense front, is
//! eliminated by `faer`'s dense kernels and hands an update to its parent. Subtrees are
//! independent; the way they are cut does not depend on the number of threads, so that
//! results are the same bits on one thread and on many.

use crate::rigidity::front::Work;
use crate::rigidity::panel::Columns;
use crate::rigidity::side::side_by_side;
use crate::rigidity::symbolic::Symbolic;
use crate::watch::Watch;
use std::ops::Range;

/// Where a symmetric matrix gets its entries from.
pub(super) trait Entries: Sync {
    /// Hands all entries in the columns of `supernode` to `add`: as row group, column group
    /// (places, row after or at column) and the column-major block, of which the lower
    /// triangle counts if both are the same group.
    fn entries(&self, supernode: usize, add: &mut dyn FnMut(usize, usize, &[f64]));
}

/// The matrix is not positive definite: a motion meets no resistance at all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Singular;

/// Why there is no answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Halt {
    /// A factorisation or decomposition failed.
    Failed,
    /// Nobody waits for it any more.
    Stopped,
}

impl From<Singular> for Halt {
    fn from(_: Singular) -> Self {
        Self::Failed
    }
}

impl Halt {
    /// To be asked between long steps.
    pub(super) fn if_stopped(watch: &dyn Watch) -> Result<(), Self> {
        if watch.stopped() { Err(Self::Stopped) } else { Ok(()) }
    }
}

/// Below so many unknowns threads cost more than they save.
const FEW: usize = 5000;

/// A Cholesky factor.
pub(super) struct Factor<'a> {
    pub(super) symbolic: &'a Symbolic,
    /// Roots of the subtrees that are worked on side by side.
    pub(super) branches: Vec<usize>,
    /// Supernodes above all branches, children first.
    pub(super) trunk: Vec<usize>,
    /// Per branch, then of the trunk, the columns of its supernodes one after another.
    shelves: Vec<Vec<f64>>,
    /// Per supernode its shelf, and where on it its columns begin.
    spots: Vec<(u32, usize)>,
    pub(super) threads: usize,
}

/// What supernodes hand to their parents, by supernode from `first` on.
pub(super) struct Mail {
    first: usize,
    letters: Vec<Vec<f64>>,
}

impl Mail {
    fn new(range: Range<usize>) -> Self {
        Self { first: range.start, letters: vec![Vec::new(); range.len()] }
    }

    pub(super) fn put(&mut self, s: usize, letter: Vec<f64>) {
        self.letters[s - self.first] = letter;
    }

    pub(super) fn take(&mut self, s: usize) -> Vec<f64> {
        std::mem::take(&mut self.letters[s - self.first])
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
        let threads = if symbolic.unknowns() < FEW { 1 } else { threads };
        let (shelves, spots) = (Vec::new(), Vec::new());
        let trunk = trunk(symbolic, &branches);
        let mut factor = Self { symbolic, branches, trunk, shelves, spots, threads };
        factor.assign_spots();
        let eliminate = |work: &mut Work, k: usize| {
            let range = factor.range(k);
            let mut mail = Mail::new(range.clone());
            let shelf = shelf(range, work, entries, &mut mail)?;
            Ok((shelf, mail.take(factor.branches[k])))
        };
        let fresh = || Work::new(symbolic, 1);
        let done = side_by_side(threads, factor.branches.len(), fresh, eliminate);
        let mut mail = Mail::new(0..symbolic.supernodes.len());
        for (k, branch) in done.into_iter().enumerate() {
            let (shelf, update) = branch?;
            factor.shelves.push(shelf);
            mail.put(factor.branches[k], update);
        }
        let mut work = Work::new(symbolic, threads);
        let last = shelf(factor.trunk.iter().copied(), &mut work, entries, &mut mail)?;
        factor.shelves.push(last);
        Ok(factor)
    }

    /// The supernodes of a branch.
    pub(super) fn range(&self, branch: usize) -> Range<usize> {
        let root = self.branches[branch];
        self.symbolic.supernodes[root].leaf..root + 1
    }

    fn assign_spots(&mut self) {
        self.spots = vec![(0, 0); self.symbolic.supernodes.len()];
        for k in 0..=self.branches.len() {
            let on_trunk = k == self.branches.len();
            let shelf: Vec<usize> =
                if on_trunk { self.trunk.clone() } else { self.range(k).collect() };
            let mut at = 0;
            for s in shelf {
                self.spots[s] = (k as u32, at);
                at += self.symbolic.supernodes[s].room();
            }
        }
    }

    /// The columns of a supernode.
    pub(super) fn columns(&self, s: usize) -> Columns<'_> {
        let node = &self.symbolic.supernodes[s];
        let (shelf, at) = self.spots[s];
        let values = &self.shelves[shelf as usize][at..at + node.room()];
        Columns { values, width: node.width }
    }
}

/// Eliminates supernodes, children first; their columns one after another.
fn shelf(
    supernodes: impl Iterator<Item = usize> + Clone,
    work: &mut Work,
    entries: &dyn Entries,
    mail: &mut Mail,
) -> Result<Vec<f64>, Singular> {
    let room = |s: usize| work.symbolic.supernodes[s].room();
    let mut shelf = Vec::with_capacity(supernodes.clone().map(room).sum());
    for s in supernodes {
        work.eliminate(s, entries, (&mut shelf, mail))?;
    }
    Ok(shelf)
}

fn trunk(symbolic: &Symbolic, branches: &[usize]) -> Vec<usize> {
    let mut in_branch = vec![false; symbolic.supernodes.len()];
    for &root in branches {
        in_branch[symbolic.supernodes[root].leaf..=root].fill(true);
    }
    (0..in_branch.len()).filter(|&s| !in_branch[s]).collect()
}
