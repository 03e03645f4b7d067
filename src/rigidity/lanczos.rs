//! The largest eigenvalues of an inverse: block Lanczos with full reorthogonalisation.
//!
//! Solving for several right-hand sides at once costs little more than for one, because
//! the factor is read from memory once (Grimes, Lewis and Simon 1994).

use crate::tolerance::{MODE_RESIDUAL, VANISHED};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par, Side};

/// A symmetric operator on blocks of vectors.
pub(super) trait Operator {
    /// Length of the vectors.
    fn size(&self) -> usize;

    /// Applies it to each column.
    fn apply(&self, block: MatRef<'_, f64>) -> Mat<f64>;

    /// Takes from each column what the wanted vectors must not contain.
    fn project(&self, block: &mut Mat<f64>);
}

/// Columns that are solved for together.
const BLOCK: usize = 4;
/// Steps before it is content with what it has.
const MOST_STEPS: usize = 40;

/// Numbers from -1 to 1 that are the same everywhere (SplitMix64).
pub(super) fn scattered(seed: u64, rows: usize, columns: usize) -> Mat<f64> {
    let mut state = seed;
    Mat::from_fn(rows, columns, |_, _| {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    })
}

/// Approximate eigenvectors of the `wanted` largest eigenvalues, orthonormal columns, the
/// largest first; fewer if the space is smaller.
pub(super) fn largest(operator: &dyn Operator, wanted: usize) -> Mat<f64> {
    let size = operator.size();
    let mut start = scattered(1, size, BLOCK);
    operator.project(&mut start);
    let mut next = operator.apply(start.as_ref());
    operator.project(&mut next);
    let mut basis: Vec<Mat<f64>> = Vec::new();
    let mut projected: Mat<f64> = Mat::zeros(0, 0);
    for _ in 0..MOST_STEPS {
        let mut fresh = orthonormal(&[], &next).0;
        // Short columns have lost digits: what they were cleared of may be back.
        operator.project(&mut fresh);
        fresh = orthonormal(&basis, &fresh).0;
        if fresh.ncols() == 0 {
            break;
        }
        next = operator.apply(fresh.as_ref());
        operator.project(&mut next);
        basis.push(fresh);
        let shares = clear(&basis, &mut next);
        projected = bordered(&projected, &shares);
        let (_, rest) = orthonormal(&[], &next);
        if ritz(&projected).is_some_and(|ends| ends.converged(&rest, wanted)) {
            break;
        }
    }
    let Some(ends) = ritz(&projected) else { return Mat::zeros(size, 0) };
    let count = wanted.min(ends.values.len());
    let mut vectors = Mat::zeros(size, count);
    let mut from = 0;
    for block in &basis {
        let part = ends.vectors.submatrix(from, 0, block.ncols(), count);
        matmul(vectors.as_mut(), Accum::Add, block.as_ref(), part, 1.0, Par::Seq);
        from += block.ncols();
    }
    vectors
}

/// Ritz values, the largest first, and their vectors in the basis.
struct Ritz {
    values: Vec<f64>,
    vectors: Mat<f64>,
}

fn ritz(projected: &Mat<f64>) -> Option<Ritz> {
    let n = projected.ncols();
    if n == 0 {
        return None;
    }
    let eigen = projected.self_adjoint_eigen(Side::Lower).ok()?;
    let values = (0..n).rev().map(|k| eigen.S()[k]).collect();
    let vectors = Mat::from_fn(n, n, |i, j| eigen.U()[(i, n - 1 - j)]);
    Some(Ritz { values, vectors })
}

impl Ritz {
    /// Whether the residual `rest · (last entries)` of each wanted vector is small.
    fn converged(&self, rest: &Mat<f64>, wanted: usize) -> bool {
        let n = self.values.len();
        let last = rest.ncols().min(n);
        n >= wanted
            && (0..wanted).all(|k| {
                let residual = (0..rest.nrows()).map(|i| {
                    let terms =
                        (0..last).map(|j| rest[(i, j)] * self.vectors[(n - last + j, k)]);
                    terms.sum::<f64>()
                });
                let residual = residual.map(|r| r * r).sum::<f64>().sqrt();
                residual <= MODE_RESIDUAL * self.values[k].abs()
            })
    }
}

/// The old matrix with a new last block of columns, and of rows by symmetry.
fn bordered(old: &Mat<f64>, columns: &Mat<f64>) -> Mat<f64> {
    let (n, before) = (columns.nrows(), old.ncols());
    Mat::from_fn(n, n, |i, j| match (i < before, j < before) {
        (true, true) => old[(i, j)],
        (_, false) if i < before => columns[(i, j - before)],
        (false, true) => columns[(j, i - before)],
        _ => (columns[(i, j - before)] + columns[(j, i - before)]) / 2.0,
    })
}

/// Takes from each column of `block` its share in the basis, twice; returns the shares.
pub(super) fn clear(basis: &[Mat<f64>], block: &mut Mat<f64>) -> Mat<f64> {
    let rows = basis.iter().map(Mat::ncols).sum();
    let mut all = Mat::zeros(rows, block.ncols());
    for _ in 0..2 {
        let mut from = 0;
        for part in basis {
            let mut shares = Mat::zeros(part.ncols(), block.ncols());
            let across = part.transpose();
            matmul(
                shares.as_mut(),
                Accum::Replace,
                across,
                block.as_ref(),
                1.0,
                Par::Seq,
            );
            let (part_ref, shares_ref) = (part.as_ref(), shares.as_ref());
            matmul(block.as_mut(), Accum::Add, part_ref, shares_ref, -1.0, Par::Seq);
            let mut into = all.subrows_mut(from, part.ncols());
            into += shares;
            from += part.ncols();
        }
    }
    all
}

/// Orthonormal columns that span what `block` has beside the basis, and the triangular
/// factor; columns that vanish are left out.
pub(super) fn orthonormal(basis: &[Mat<f64>], block: &Mat<f64>) -> (Mat<f64>, Mat<f64>) {
    let columns = block.ncols();
    let largest = block.norm_l2();
    let mut block = block.to_owned();
    clear(basis, &mut block);
    let mut made: Vec<Mat<f64>> = Vec::new();
    let mut factor = Mat::zeros(columns, columns);
    for j in 0..columns {
        let mut column = block.subcols(j, 1).to_owned();
        let shares = clear(&made, &mut column);
        for i in 0..made.len() {
            factor[(i, j)] = shares[(i, 0)];
        }
        let length = column.norm_l2();
        if length > VANISHED * largest {
            factor[(made.len(), j)] = length;
            column *= faer::Scale(1.0 / length);
            made.push(column);
        }
    }
    let together = Mat::from_fn(block.nrows(), made.len(), |i, j| made[j][(i, 0)]);
    (together, factor)
}
