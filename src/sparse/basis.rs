//! Orthonormal vectors block by block, and how the next block is made so.
//!
//! Works on pieces of some rows, each read once for all that is asked of it, side by side.
//! Sums are taken piece by piece in order: one thread and many give the same bits.

use crate::sparse::block::{Block, cholesky, orthonormalise, project_out};
use crate::sparse::panel::RHS;
use crate::sparse::parallel::{map_items, worthwhile};
use crate::sparse::tall;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};

/// Rows of a piece, so that it stays in the cache.
const ROWS: usize = 512;
/// Blocks at the end of a basis in which the next one has its share, but for rounding.
const NEAR: usize = 2;

/// Blocks whose columns are orthonormal altogether.
pub(crate) struct Basis {
    pub(crate) blocks: Vec<Block>,
    threads: usize,
    /// How many blocks it began with.
    deflated: usize,
}

/// What a block that was cleared had in the basis, and what is left.
pub(crate) struct Cleared {
    /// Shares of its columns in the vectors of the basis after those it began with.
    pub(crate) shares: Mat<f64>,
    /// The triangular factor of what is left.
    pub(crate) rest: Mat<f64>,
    /// Its inverse; `None` if the block is orthonormal already.
    pub(crate) inverse: Option<Mat<f64>>,
}

/// Some rows of a block.
struct Piece<'a> {
    /// The first of them.
    from: usize,
    columns: usize,
    values: &'a mut [f64],
}

impl Basis {
    /// Begins with `blocks`.
    pub(crate) fn new(blocks: Vec<Block>, rows: usize, threads: usize) -> Self {
        Self { deflated: blocks.len(), blocks, threads: worthwhile(threads, rows) }
    }

    /// Takes from each column of an operator's image of the last block its share in the
    /// basis. Such an image has none but in the two last blocks (Lanczos).
    pub(crate) fn project_out(&self, block: &mut Block) -> Cleared {
        let near = self.blocks.len().saturating_sub(NEAR).max(self.deflated);
        let (deflated, late) = (&self.blocks[..self.deflated], &self.blocks[near..]);
        let parts: Vec<&Block> = deflated.iter().chain(late).collect();
        let (shares, left) = self.take_shares(block, &parts, None);
        let columns = |blocks: &[Block]| blocks.iter().map(|b| b.columns).sum::<usize>();
        let (before, own) = (columns(&self.blocks[self.deflated..near]), columns(late));
        let skipped = columns(deflated);
        let mut all = Mat::zeros(before + own, block.columns);
        all.subrows_mut(before, own).copy_from(shares.subrows(skipped, own));
        let shares = all;
        // By the Cholesky factor of the products if that is safe.
        match cholesky(&left) {
            Some((rest, inverse)) => Cleared { shares, rest, inverse: Some(inverse) },
            None => Cleared { shares, rest: orthonormalise(block), inverse: None },
        }
    }

    /// Adds the columns of a block that was cleared, made orthonormal. What has shrunk has
    /// lost digits, so that both steps are made twice (Fukaya et al. 2014).
    pub(crate) fn add(&mut self, block: &mut Block, inverse: Option<&Mat<f64>>) {
        let parts: Vec<&Block> = self.blocks.iter().collect();
        let (_, left) = self.take_shares(block, &parts, inverse);
        if let Some((_, inverse)) = cholesky(&left) {
            self.blocks.push(self.product(&[block], inverse.as_ref()));
            return;
        }
        orthonormalise(block);
        project_out(&self.blocks, block);
        orthonormalise(block);
        self.blocks.push(block.clone());
    }

    /// The combinations of vectors, after those it began with, whose coefficients are the
    /// columns of `of`.
    pub(crate) fn combined(&self, of: MatRef<'_, f64>) -> Block {
        let parts: Vec<&Block> = self.blocks[self.deflated..].iter().collect();
        self.product(&parts, of)
    }

    fn product(&self, parts: &[&Block], of: MatRef<'_, f64>) -> Block {
        let rows = parts.first().map_or(0, |block| block.rows);
        let mut made = Block::zeros(rows, of.ncols());
        let coefficients = -of;
        self.each_piece(&mut made, |mut piece| {
            // A page that is read before it is written is touched twice, and the second
            // time stops the other thread.
            piece.values.fill(0.0);
            piece.take(parts, coefficients.as_ref());
        });
        made
    }

    /// Multiplies with `by`, then takes the shares in `parts`; these, and the products of
    /// what is left.
    fn take_shares(
        &self,
        block: &mut Block,
        parts: &[&Block],
        by: Option<&Mat<f64>>,
    ) -> (Mat<f64>, Mat<f64>) {
        let shares = self.each_piece(block, |mut piece| {
            if let Some(by) = by {
                piece.multiply(by);
            }
            piece.shares(parts)
        });
        let shares = sum(shares);
        let left = self.each_piece(block, |mut piece| {
            piece.take(parts, shares.as_ref());
            piece.products(piece.values, piece.columns)
        });
        (shares, sum(left))
    }

    /// Runs `task` on all pieces of a block; the results in order.
    fn each_piece<T: Send>(
        &self,
        block: &mut Block,
        task: impl Fn(Piece) -> T + Sync,
    ) -> Vec<T> {
        let columns = block.columns;
        let pieces = block.values.chunks_mut(ROWS * columns.max(1)).enumerate();
        let one = |(): &mut (), (k, values): (usize, &mut [f64])| {
            task(Piece { from: k * ROWS, columns, values })
        };
        map_items(self.threads, pieces, || (), one)
    }
}

fn sum(parts: Vec<Mat<f64>>) -> Mat<f64> {
    parts.into_iter().reduce(|sum, next| sum + next).unwrap_or_else(|| Mat::zeros(0, 0))
}

impl Piece<'_> {
    /// The same rows of another block.
    fn beside<'b>(&self, block: &'b Block) -> &'b [f64] {
        let rows = self.values.len() / self.columns.max(1);
        &block.values[self.from * block.columns..(self.from + rows) * block.columns]
    }

    fn multiply(&mut self, by: &Mat<f64>) {
        let old = self.values.to_vec();
        self.values.fill(0.0);
        self.less(&old, (-by).as_ref());
    }

    /// Shares of its columns in each column of `parts`.
    fn shares(&self, parts: &[&Block]) -> Mat<f64> {
        let all = parts.iter().map(|block| block.columns).sum();
        let mut shares = Mat::zeros(all, self.columns);
        let mut at = 0;
        for part in parts {
            let some = self.products(self.beside(part), part.columns);
            shares.subrows_mut(at, part.columns).copy_from(some);
            at += part.columns;
        }
        shares
    }

    /// Takes from it the columns of `parts` with these coefficients.
    fn take(&mut self, parts: &[&Block], of: MatRef<'_, f64>) {
        let mut at = 0;
        for part in parts {
            self.less(self.beside(part), of.subrows(at, part.columns));
            at += part.columns;
        }
    }

    /// Products of `columns` columns with its own.
    fn products(&self, of: &[f64], columns: usize) -> Mat<f64> {
        if let (RHS, RHS) = (columns, self.columns) {
            let sums =
                tall::transposed_product(of.as_chunks().0, self.values.as_chunks().0);
            return Mat::from_fn(RHS, RHS, |i, j| sums[i][j]);
        }
        let mut products = Mat::zeros(columns, self.columns);
        let rows = self.values.len() / self.columns.max(1);
        let of = MatRef::from_row_major_slice(of, rows, columns).transpose();
        let own = MatRef::from_row_major_slice(self.values, rows, self.columns);
        matmul(products.as_mut(), Accum::Replace, of, own, 1.0, Par::Seq);
        products
    }

    /// Takes from it some columns with these coefficients.
    fn less(&mut self, columns: &[f64], of: MatRef<'_, f64>) {
        if let (RHS, RHS) = (of.nrows(), of.ncols()) {
            let of = std::array::from_fn(|i| std::array::from_fn(|j| of[(i, j)]));
            tall::subtract_product(
                self.values.as_chunks_mut().0,
                columns.as_chunks().0,
                &of,
            );
            return;
        }
        let rows = self.values.len() / self.columns.max(1);
        let columns = MatRef::from_row_major_slice(columns, rows, of.nrows());
        let own = MatMut::from_row_major_slice_mut(self.values, rows, self.columns);
        matmul(own, Accum::Add, columns, of, -1.0, Par::Seq);
    }
}
