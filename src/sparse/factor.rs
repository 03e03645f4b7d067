//! Sparse Cholesky by fronts (Duff and Reid 1983), on as many threads as are given.
//!
//! Each supernode gathers its entries and its children's updates in a dense front, is
//! eliminated by `faer`'s dense kernels and hands an update to its parent. Subtrees are
//! independent; the way they are cut does not depend on the number of threads, so that
//! results are the same bits on one thread and on many.

use crate::sparse::error::NotPositiveDefinite;
use crate::sparse::front::Workspace;
use crate::sparse::panel::{Columns, pack};
use crate::sparse::parallel::{map_range, worthwhile};
use crate::sparse::symbolic::{Entries, Supernode, Symbolic};
use std::ops::Range;
use std::sync::mpsc::channel;

/// Fronts of the top that are gathered before they are needed.
const AHEAD: usize = 2;

/// A Cholesky factor.
pub(crate) struct Factor<'a> {
    pub(crate) symbolic: &'a Symbolic,
    /// Roots of the subtrees that are worked on side by side.
    pub(crate) subtrees: Vec<usize>,
    /// Supernodes above all these subtrees, children first.
    pub(crate) top: Vec<usize>,
    /// Per subtree, then of the top, a segment: the columns of its supernodes one after
    /// another.
    storage: Vec<Vec<f64>>,
    /// Per supernode the segment of storage, and where in it its columns begin.
    offsets: Vec<(u32, usize)>,
    pub(crate) threads: usize,
}

impl<'a> Factor<'a> {
    /// Factorises.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] if a pivot is not positive.
    pub(crate) fn new(
        symbolic: &'a Symbolic,
        entries: &dyn Entries,
        threads: usize,
    ) -> Result<Self, NotPositiveDefinite> {
        let subtrees = symbolic.subtrees();
        let threads = worthwhile(threads, symbolic.unknowns());
        let (storage, offsets) = (Vec::new(), Vec::new());
        let top = top(symbolic, &subtrees);
        let mut factor = Self { symbolic, subtrees, top, storage, offsets, threads };
        factor.assign_offsets();
        let eliminate = |work: &mut Workspace, k: usize| {
            let stored = eliminate_subtree(factor.range(k), work, entries)?;
            Ok((stored, work.last_update(factor.subtrees[k])))
        };
        let fresh = || Workspace::new(symbolic, 1);
        let done = map_range(threads, factor.subtrees.len(), fresh, eliminate);
        let mut handed = vec![Vec::new(); symbolic.supernodes.len()];
        for (k, subtree) in done.into_iter().enumerate() {
            let (stored, update) = subtree?;
            factor.storage.push(stored);
            handed[factor.subtrees[k]] = update;
        }
        let last = factor.eliminate_top(entries, &handed)?;
        factor.storage.push(last);
        Ok(factor)
    }

    /// Eliminates the supernodes of the top; their columns one after another. A assembler
    /// gathers the fronts to come and packs those that are done.
    fn eliminate_top(
        &self,
        entries: &dyn Entries,
        handed: &[Vec<f64>],
    ) -> Result<Vec<f64>, NotPositiveDefinite> {
        let (symbolic, top) = (self.symbolic, &self.top);
        let mut work = Workspace::new(symbolic, self.threads);
        work.reserve(top.iter().copied(), handed);
        let sizes = top.iter().map(|&s| symbolic.supernodes[s].stored());
        let mut stored = Vec::with_capacity(sizes.sum());
        let mut gatherer = Workspace::new(symbolic, 1);
        let mut gather = |s: usize, mut columns: Vec<f64>| {
            gatherer.gather(s, entries, &mut columns);
            columns
        };
        let mut put = |s: usize, columns: &[f64]| {
            pack(columns, symbolic.supernodes[s].width, &mut stored);
        };
        if self.threads < 2 {
            let mut columns = Vec::new();
            for &s in top {
                columns = gather(s, columns);
                work.eliminate(s, &mut columns, handed)?;
                put(s, &columns);
            }
            return Ok(stored);
        }
        let (to_assembler, done) = channel::<Vec<f64>>();
        let (ready, from_assembler) = channel();
        std::thread::scope(|scope| {
            scope.spawn(move || {
                let mut next = top.iter();
                for &s in next.by_ref().take(AHEAD) {
                    // Nobody listens any more if a front was singular.
                    let _ = ready.send(gather(s, Vec::new()));
                }
                for (&s, columns) in top.iter().zip(done) {
                    put(s, &columns);
                    if let Some(&s) = next.next() {
                        let _ = ready.send(gather(s, columns));
                    }
                }
            });
            // Gone when this ends, so that the assembler ends too.
            let to_assembler = to_assembler;
            for (&s, mut columns) in top.iter().zip(from_assembler) {
                work.eliminate(s, &mut columns, handed)?;
                let _ = to_assembler.send(columns);
            }
            Ok(())
        })?;
        Ok(stored)
    }

    /// The supernodes of a subtree.
    pub(crate) fn range(&self, subtree: usize) -> Range<usize> {
        let root = self.subtrees[subtree];
        self.symbolic.supernodes[root].first_descendant..root + 1
    }

    fn assign_offsets(&mut self) {
        self.offsets = vec![(0, 0); self.symbolic.supernodes.len()];
        for k in 0..=self.subtrees.len() {
            let is_top = k == self.subtrees.len();
            let stored: Vec<usize> =
                if is_top { self.top.clone() } else { self.range(k).collect() };
            let mut at = 0;
            for s in stored {
                self.offsets[s] = (k as u32, at);
                at += self.symbolic.supernodes[s].stored();
            }
        }
    }

    /// The columns of a supernode.
    pub(crate) fn columns(&self, s: usize) -> Columns<'_> {
        let node = &self.symbolic.supernodes[s];
        let (segment, at) = self.offsets[s];
        let values = &self.storage[segment as usize][at..at + node.stored()];
        Columns { values, width: node.width }
    }
}

/// Eliminates the supernodes of a subtree; their columns one after another.
fn eliminate_subtree(
    range: Range<usize>,
    work: &mut Workspace,
    entries: &dyn Entries,
) -> Result<Vec<f64>, NotPositiveDefinite> {
    work.reserve(range.clone(), &[]);
    let nodes = &work.symbolic.supernodes;
    let mut stored =
        Vec::with_capacity(nodes[range.clone()].iter().map(Supernode::stored).sum());
    let mut columns = Vec::new();
    for s in range {
        work.gather(s, entries, &mut columns);
        work.eliminate(s, &mut columns, &[])?;
        pack(&columns, nodes[s].width, &mut stored);
    }
    Ok(stored)
}

fn top(symbolic: &Symbolic, subtrees: &[usize]) -> Vec<usize> {
    let mut below_top = vec![false; symbolic.supernodes.len()];
    for &root in subtrees {
        below_top[symbolic.supernodes[root].first_descendant..=root].fill(true);
    }
    (0..below_top.len()).filter(|&s| !below_top[s]).collect()
}
