//! Some vectors side by side, and what makes them orthonormal.
//!
//! They lie row by row: a solve for all of them reads one row after another, and so does
//! every product of two blocks.

use crate::tolerance::{NEARLY_PARALLEL, VANISHED};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};

/// Rows that are multiplied at a time, so that they stay in the cache.
const ROWS: usize = 512;

/// Vectors as columns, stored row by row.
#[derive(Debug, PartialEq)]
pub(crate) struct Block {
    pub(crate) rows: usize,
    pub(crate) columns: usize,
    /// `rows * columns` numbers.
    pub(crate) values: Vec<f64>,
}

impl Clone for Block {
    fn clone(&self) -> Self {
        Self { values: self.values.clone(), ..*self }
    }

    // Keeps the room.
    fn clone_from(&mut self, other: &Self) {
        (self.rows, self.columns) = (other.rows, other.columns);
        self.values.clone_from(&other.values);
    }
}

impl Block {
    pub(crate) fn zeros(rows: usize, columns: usize) -> Self {
        Self { rows, columns, values: vec![0.0; rows * columns] }
    }

    /// Columns put side by side.
    pub(crate) fn from_columns(rows: usize, columns: &[Vec<f64>]) -> Self {
        let mut block = Self::zeros(rows, columns.len());
        for (row, i) in block.rows_mut().zip(0..) {
            row.iter_mut().zip(columns).for_each(|(x, column): (_, &Vec<f64>)| {
                *x = column[i];
            });
        }
        block
    }

    /// One row after another.
    pub(crate) fn rows_mut(&mut self) -> std::slice::ChunksExactMut<'_, f64> {
        self.values.chunks_exact_mut(self.columns.max(1))
    }

    pub(crate) fn column(&self, k: usize) -> Vec<f64> {
        self.values.iter().skip(k).step_by(self.columns.max(1)).copied().collect()
    }

    pub(crate) fn as_ref(&self) -> MatRef<'_, f64> {
        MatRef::from_row_major_slice(&self.values, self.rows, self.columns)
    }

    pub(crate) fn as_mut(&mut self) -> MatMut<'_, f64> {
        MatMut::from_row_major_slice_mut(&mut self.values, self.rows, self.columns)
    }

    /// `self · other`.
    pub(crate) fn times(&self, other: MatRef<'_, f64>) -> Self {
        let mut product = Self::zeros(self.rows, other.ncols());
        matmul(product.as_mut(), Accum::Replace, self.as_ref(), other, 1.0, Par::Seq);
        product
    }

    /// Becomes `self · square`.
    fn multiply(&mut self, square: MatRef<'_, f64>) {
        let columns = self.columns.max(1);
        let mut product = vec![0.0; ROWS * columns];
        for rows in self.values.chunks_mut(ROWS * columns) {
            let count = rows.len() / columns;
            let product = &mut product[..rows.len()];
            let into = MatMut::from_row_major_slice_mut(product, count, columns);
            let from = MatRef::from_row_major_slice(rows, count, columns);
            matmul(into, Accum::Replace, from, square, 1.0, Par::Seq);
            rows.copy_from_slice(product);
        }
    }

    /// `selfᵀ · other`.
    pub(crate) fn products(&self, other: &Self) -> Mat<f64> {
        let mut products = Mat::zeros(self.columns, other.columns);
        let across = self.as_ref().transpose();
        matmul(products.as_mut(), Accum::Replace, across, other.as_ref(), 1.0, Par::Seq);
        products
    }
}

/// Takes from each column of `block` its share in each orthonormal part; returns the
/// shares.
pub(crate) fn project_out(basis: &[Block], block: &mut Block) -> Mat<f64> {
    let rows = basis.iter().map(|part| part.columns).sum();
    let mut all = Mat::zeros(rows, block.columns);
    let mut from = 0;
    for part in basis {
        let shares = part.products(block);
        let (part_ref, shares_ref) = (part.as_ref(), shares.as_ref());
        matmul(block.as_mut(), Accum::Add, part_ref, shares_ref, -1.0, Par::Seq);
        all.subrows_mut(from, part.columns).copy_from(&shares);
        from += part.columns;
    }
    all
}

/// Makes the columns orthonormal and returns the triangular factor; columns that vanish are
/// left out.
pub(crate) fn orthonormalise(block: &mut Block) -> Mat<f64> {
    // By the Cholesky factor of the products, twice (Fukaya et al. 2014), if that is safe.
    let mut quick = || {
        let (factor, inverse) = cholesky(&block.products(block))?;
        block.multiply(inverse.as_ref());
        Some(factor)
    };
    match quick().and_then(|first| Some((first, quick()?))) {
        Some((first, second)) => second * first,
        None => column_by_column(block),
    }
}

/// The upper triangular `R` of `RᵀR = products` and its inverse; `None` if a column nearly
/// depends on those before.
pub(crate) fn cholesky(products: &Mat<f64>) -> Option<(Mat<f64>, Mat<f64>)> {
    let n = products.ncols();
    let mut factor = Mat::<f64>::zeros(n, n);
    let mut inverse = Mat::<f64>::zeros(n, n);
    for j in 0..n {
        for i in 0..j {
            let known: f64 = (0..i).map(|k| factor[(k, i)] * factor[(k, j)]).sum();
            factor[(i, j)] = (products[(i, j)] - known) / factor[(i, i)];
        }
        let known: f64 = (0..j).map(|k| factor[(k, j)] * factor[(k, j)]).sum();
        let rest = products[(j, j)] - known;
        if rest.is_nan() || rest <= NEARLY_PARALLEL * products[(j, j)] {
            return None;
        }
        factor[(j, j)] = rest.sqrt();
        inverse[(j, j)] = 1.0 / factor[(j, j)];
        for i in 0..j {
            let sum: f64 = (i..j).map(|k| inverse[(i, k)] * factor[(k, j)]).sum();
            inverse[(i, j)] = -sum / factor[(j, j)];
        }
    }
    Some((factor, inverse))
}

fn column_by_column(block: &mut Block) -> Mat<f64> {
    let largest = block.values.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut made: Vec<Block> = Vec::new();
    let mut factor = Mat::zeros(block.columns, block.columns);
    for j in 0..block.columns {
        let mut column = Block { rows: block.rows, columns: 1, values: block.column(j) };
        for _ in 0..2 {
            let shares = project_out(&made, &mut column);
            (0..made.len()).for_each(|i| factor[(i, j)] += shares[(i, 0)]);
        }
        let length = column.values.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > VANISHED * largest {
            factor[(made.len(), j)] = length;
            column.values.iter_mut().for_each(|x| *x /= length);
            made.push(column);
        }
    }
    let columns: Vec<Vec<f64>> = made.into_iter().map(|column| column.values).collect();
    *block = Block::from_columns(block.rows, &columns);
    factor
}
