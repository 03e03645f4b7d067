//! The largest eigenvalues of an inverse: block Lanczos with full reorthogonalisation.
//!
//! Solving for several right-hand sides at once costs little more than for one, because
//! the factor is read from memory once (Grimes, Lewis and Simon 1994).

use crate::sparse::basis::Basis;
use crate::sparse::block::Block;
use crate::sparse::error::Halt;
use crate::sparse::panel::RHS;
use crate::tolerance::MODE_RESIDUAL;
use crate::watch::Watch;
use faer::{Mat, Side};

/// A symmetric operator on blocks of vectors.
pub(crate) trait Operator {
    /// Length of the vectors.
    fn size(&self) -> usize;

    /// Writes its product with each column of `block`.
    fn apply(&self, block: &Block, into: &mut Block);

    /// Orthonormal vectors that the wanted ones are orthogonal to.
    fn deflated(&self) -> &[Block] {
        &[]
    }

    /// How many threads may work on it.
    fn threads(&self) -> usize {
        1
    }

    /// What to begin with.
    fn start(&self) -> Block {
        random_block(1, self.size(), RHS)
    }
}

/// Steps before it is content with what it has.
const MOST_STEPS: usize = 20;

/// Numbers from -1 to 1 that are the same everywhere (SplitMix64).
pub(crate) fn random_block(seed: u64, rows: usize, columns: usize) -> Block {
    let mut state = seed;
    let mut block = Block::zeros(rows, columns);
    block.values.fill_with(|| {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    });
    block
}

/// Approximate eigenvectors of the `wanted` largest eigenvalues, orthonormal columns, the
/// largest first; fewer if the space is smaller.
///
/// # Errors
/// [`Halt::Stopped`].
pub(crate) fn largest(
    operator: &dyn Operator,
    wanted: usize,
    watch: &dyn Watch,
) -> Result<Block, Halt> {
    let size = operator.size();
    let deflated = operator.deflated().to_vec();
    let mut basis = Basis::new(deflated, size, operator.threads());
    let mut next = operator.start();
    let mut cleared = basis.project_out(&mut next);
    let mut projected: Mat<f64> = Mat::zeros(0, 0);
    let mut ends = None;
    for _ in 0..MOST_STEPS {
        watch.unless_stopped()?;
        basis.add(&mut next, cleared.inverse.as_ref());
        let Some(last) = basis.blocks.last().filter(|last| last.columns > 0) else {
            break;
        };
        operator.apply(last, &mut next);
        cleared = basis.project_out(&mut next);
        projected = bordered(&projected, &cleared.shares);
        ends = ritz(&projected);
        if ends.as_ref().is_some_and(|ends| ends.converged(&cleared.rest, wanted)) {
            break;
        }
    }
    let Some(ends) = ends else { return Ok(Block::zeros(size, 0)) };
    let count = wanted.min(ends.values.len());
    Ok(basis.combined(ends.vectors.subcols(0, count)))
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
