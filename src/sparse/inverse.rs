//! Blocks on the diagonal of the inverse, without the rest of it.
//!
//! From the root of the tree downwards: the inverse over the rows of a supernode follows
//! from its own columns of the factor and the inverse over its parent's rows, which its
//! rows below are part of (Takahashi, Fagan and Chin 1973; by supernodes Lin et al. 2011).
//! Takes two to three times as long as the factorisation.

use crate::sparse::error::Halt;
use crate::sparse::factor::Factor;
use crate::sparse::parallel::map_range;
use crate::sparse::symbolic::{Supernode, Symbolic};
use crate::watch::Watch;
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::reborrow::{Reborrow, ReborrowMut};
use faer::{Accum, Mat, MatRef, Par};

/// By supernode, the inverse over its rows while a child still needs it.
type Fronts = Vec<Option<Mat<f64>>>;

impl Factor<'_> {
    /// What `take` makes of the block of each group, by place.
    ///
    /// # Errors
    /// [`Halt::Stopped`].
    pub(crate) fn inverse_blocks<T: Send>(
        &self,
        take: &(dyn Fn(MatRef<'_, f64>) -> T + Sync),
        watch: &dyn Watch,
    ) -> Result<Vec<T>, Halt> {
        let count = self.symbolic.supernodes.len();
        let mut top: Fronts = vec![None; count];
        let mut taken: Vec<(usize, T)> = Vec::with_capacity(self.symbolic.place.len());
        for &s in self.top.iter().rev() {
            watch.unless_stopped()?;
            let front = self.front(s, |parent| top[parent].as_ref());
            taken.extend(self.blocks(s, front.as_ref(), take));
            top[s] = Some(front);
        }
        let subtree = |fronts: &mut Fronts, k: usize| {
            let mut taken = Vec::new();
            for s in self.range(k).rev() {
                let front = self
                    .front(s, |parent| fronts[parent].as_ref().or(top[parent].as_ref()));
                taken.extend(self.blocks(s, front.as_ref(), take));
                self.put(s, front, fronts);
            }
            taken
        };
        watch.unless_stopped()?;
        let fresh = || vec![None; count];
        let subtrees = map_range(self.threads, self.subtrees.len(), fresh, subtree);
        taken.extend(subtrees.into_iter().flatten());
        taken.sort_unstable_by_key(|(place, _)| *place);
        Ok(taken.into_iter().map(|(_, block)| block).collect())
    }

    /// Keeps a front for its children, and lets go of its parent's after the last of them,
    /// which is the first: they are visited backwards.
    fn put(&self, s: usize, front: Mat<f64>, fronts: &mut Fronts) {
        let nodes = &self.symbolic.supernodes;
        if !nodes[s].children.is_empty() {
            fronts[s] = Some(front);
        }
        if let Some(parent) = nodes[s].parent.filter(|&p| nodes[p].children[0] == s) {
            fronts[parent] = None;
        }
    }

    /// The inverse over the rows of a supernode, its own first, from that of its parent.
    fn front<'f>(
        &self,
        s: usize,
        of: impl Fn(usize) -> Option<&'f Mat<f64>>,
    ) -> Mat<f64> {
        let node = &self.symbolic.supernodes[s];
        let (width, below) = (node.width, node.below);
        let columns = self.columns(s).unpacked(width + below);
        let columns = MatRef::from_column_major_slice(&columns, width + below, width);
        let (top, low) = columns.split_at_row(width);
        let mut front = Mat::zeros(width + below, width + below);
        let (mut own, mut across, mut down, mut rest) =
            front.as_mut().split_at_mut(width, width);
        // (L Lᵀ)⁻¹
        own.rb_mut().diagonal_mut().fill(1.0);
        solve_lower_triangular_in_place(top, own.rb_mut(), Par::Seq);
        solve_upper_triangular_in_place(top.transpose(), own.rb_mut(), Par::Seq);
        if let Some((parent, above)) = node.parent.and_then(|p| Some((p, of(p)?))) {
            let parent = &self.symbolic.supernodes[parent];
            let at = rows_in(self.symbolic, node, parent);
            for (j, &column) in at.iter().enumerate() {
                for (i, &row) in at.iter().enumerate() {
                    rest[(i, j)] = above[(row, column)];
                }
            }
            // Y = B L⁻¹, below the own rows -Z Y, in their square Yᵀ Z Y more.
            let mut y = low.to_owned();
            solve_upper_triangular_in_place(
                top.transpose(),
                y.as_mut().transpose_mut(),
                Par::Seq,
            );
            matmul(down.rb_mut(), Accum::Replace, rest.rb(), y.as_ref(), -1.0, Par::Seq);
            matmul(own, Accum::Add, y.transpose(), down.rb(), -1.0, Par::Seq);
            across.copy_from(down.transpose());
        }
        front
    }

    /// What is made of the blocks of its own groups.
    fn blocks<T>(
        &self,
        s: usize,
        front: MatRef<'_, f64>,
        take: &(dyn Fn(MatRef<'_, f64>) -> T + Sync),
    ) -> Vec<(usize, T)> {
        let node = &self.symbolic.supernodes[s];
        let first = self.symbolic.start[node.first];
        let block = |place: usize| {
            let (at, size) =
                (self.symbolic.start[place] - first, self.symbolic.size(place));
            (place, take(front.submatrix(at, at, size, size)))
        };
        (node.first..node.end).map(block).collect()
    }
}

/// The rows of a parent's front at which the rows below a child stand.
fn rows_in(symbolic: &Symbolic, child: &Supernode, parent: &Supernode) -> Vec<usize> {
    let mut rows = Vec::with_capacity(child.below);
    let groups =
        (parent.first..parent.end).chain(parent.rows.iter().map(|&k| k as usize));
    let (mut at, mut next) = (0, child.rows.iter().peekable());
    for group in groups {
        let size = symbolic.size(group);
        if next.next_if(|&&row| row as usize == group).is_some() {
            rows.extend(at..at + size);
        }
        at += size;
    }
    rows
}
