//! Sparse Cholesky by fronts (Duff and Reid 1983), on as many threads as are given.
//!
//! Each supernode gathers its entries and its children's updates in a dense front, is
//! eliminated by `faer`'s dense kernels and hands an update to its parent. Subtrees are
//! independent; the way they are cut does not depend on the number of threads, so that
//! results are the same bits on one thread and on many.

use crate::rigidity::front::Work;
use crate::rigidity::panel::{Columns, pack};
use crate::rigidity::side::{side_by_side, worthwhile};
use crate::rigidity::symbolic::{Supernode, Symbolic};
use crate::watch::Watch;
use std::ops::Range;
use std::sync::mpsc::channel;

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

/// Fronts of the trunk that are gathered before they are needed.
const AHEAD: usize = 2;

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
        let threads = worthwhile(threads, symbolic.unknowns());
        let (shelves, spots) = (Vec::new(), Vec::new());
        let trunk = trunk(symbolic, &branches);
        let mut factor = Self { symbolic, branches, trunk, shelves, spots, threads };
        factor.assign_spots();
        let eliminate = |work: &mut Work, k: usize| {
            let shelf = branch_shelf(factor.range(k), work, entries)?;
            Ok((shelf, work.last_letter(factor.branches[k])))
        };
        let fresh = || Work::new(symbolic, 1);
        let done = side_by_side(threads, factor.branches.len(), fresh, eliminate);
        let mut mail = vec![Vec::new(); symbolic.supernodes.len()];
        for (k, branch) in done.into_iter().enumerate() {
            let (shelf, update) = branch?;
            factor.shelves.push(shelf);
            mail[factor.branches[k]] = update;
        }
        let last = factor.trunk_shelf(entries, &mail)?;
        factor.shelves.push(last);
        Ok(factor)
    }

    /// Eliminates the supernodes of the trunk; their columns one after another. A clerk
    /// gathers the fronts to come and packs those that are done.
    fn trunk_shelf(
        &self,
        entries: &dyn Entries,
        mail: &[Vec<f64>],
    ) -> Result<Vec<f64>, Singular> {
        let (symbolic, trunk) = (self.symbolic, &self.trunk);
        let mut work = Work::new(symbolic, self.threads);
        work.make_room(trunk.iter().copied(), mail);
        let room = trunk.iter().map(|&s| symbolic.supernodes[s].room());
        let mut shelf = Vec::with_capacity(room.sum());
        let mut gatherer = Work::new(symbolic, 1);
        let mut gather = |s: usize, mut columns: Vec<f64>| {
            gatherer.gather(s, entries, &mut columns);
            columns
        };
        let mut put = |s: usize, columns: &[f64]| {
            pack(columns, symbolic.supernodes[s].width, &mut shelf);
        };
        if self.threads < 2 {
            let mut columns = Vec::new();
            for &s in trunk {
                columns = gather(s, columns);
                work.eliminate(s, &mut columns, mail)?;
                put(s, &columns);
            }
            return Ok(shelf);
        }
        let (to_clerk, done) = channel::<Vec<f64>>();
        let (ready, from_clerk) = channel();
        std::thread::scope(|scope| {
            scope.spawn(move || {
                let mut next = trunk.iter();
                for &s in next.by_ref().take(AHEAD) {
                    // Nobody listens any more if a front was singular.
                    let _ = ready.send(gather(s, Vec::new()));
                }
                for (&s, columns) in trunk.iter().zip(done) {
                    put(s, &columns);
                    if let Some(&s) = next.next() {
                        let _ = ready.send(gather(s, columns));
                    }
                }
            });
            // Gone when this ends, so that the clerk ends too.
            let to_clerk = to_clerk;
            for (&s, mut columns) in trunk.iter().zip(from_clerk) {
                work.eliminate(s, &mut columns, mail)?;
                let _ = to_clerk.send(columns);
            }
            Ok(())
        })?;
        Ok(shelf)
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

/// Eliminates the supernodes of a branch; their columns one after another.
fn branch_shelf(
    range: Range<usize>,
    work: &mut Work,
    entries: &dyn Entries,
) -> Result<Vec<f64>, Singular> {
    work.make_room(range.clone(), &[]);
    let nodes = &work.symbolic.supernodes;
    let mut shelf =
        Vec::with_capacity(nodes[range.clone()].iter().map(Supernode::room).sum());
    let mut columns = Vec::new();
    for s in range {
        work.gather(s, entries, &mut columns);
        work.eliminate(s, &mut columns, &[])?;
        pack(&columns, nodes[s].width, &mut shelf);
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
