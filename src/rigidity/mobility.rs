//! How many motions meet no resistance at all.
//!
//! Decided by orthogonal means: singular values of the compatibility matrix, or of its
//! restriction to a subspace refined by residuals, never eigenvalues of `AᵀA`. Bodies that
//! spin unseen about their only axis are counted.

use crate::rigidity::factor::{Factor, Singular};
use crate::rigidity::lanczos::{self, Operator};
use crate::rigidity::spectrum::{self, Inverse, Modes};
use crate::rigidity::system::System;
use crate::tolerance::{NO_RESISTANCE, SUSPECT_RESISTANCE};
use faer::Mat;

/// Vectors looked at together when a null space is exhausted.
const BLOCK: usize = 8;
/// Up to this many unknowns one dense decomposition is quicker.
const DENSE: usize = 480;

/// Exact motions.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Mobility {
    /// Independent motions left when one body, or the fixed nodes, are held.
    pub count: usize,
    /// Those that move a pin, as velocities of the unknowns.
    pub motions: Vec<Vec<f64>>,
    /// Motions of single bodies that move none of their points.
    pub spins: usize,
}

/// Counts the exact motions of a system whose least resisted motions are `modes`.
///
/// # Errors
/// [`Singular`] if the factorisation fails.
pub(super) fn mobility(system: &System, modes: &Modes) -> Result<Mobility, Singular> {
    let suspect = modes.sigma.first().is_some_and(|s| *s < SUSPECT_RESISTANCE);
    let motions = if !suspect {
        Vec::new()
    } else if system.unknowns() <= DENSE {
        let all = spectrum::dense(system, system.unknowns());
        let zero = all.sigma.iter().take_while(|s| **s <= NO_RESISTANCE).count();
        all.motions.into_iter().take(zero).collect()
    } else {
        null_space(system, &system.factor(None)?)
    };
    let fixed = system.fixed();
    let spins = (0..system.motions.len()).filter(|&body| Some(body) != fixed);
    let spins: usize = spins.map(|body| 6 - system.motions[body].rank).sum();
    let free = if system.floats { system.rigid().len() } else { 0 };
    let whole = if system.floats { 6 } else { 0 };
    let count = (motions.len() + free + spins).saturating_sub(whole);
    Ok(Mobility { count, motions, spins })
}

/// All motions without resistance, by refined inverse iteration on block after block until
/// one holds a motion that is resisted.
fn null_space(system: &System, factor: &Factor) -> Vec<Vec<f64>> {
    let inverse = Inverse::new(system, factor);
    let size = inverse.size();
    let mut found: Vec<Mat<f64>> = Vec::new();
    for seed in 0..(size / BLOCK) as u64 + 1 {
        let mut block = lanczos::scattered(seed, size, BLOCK);
        inverse.project(&mut block);
        for _ in 0..2 {
            block = inverse.apply(block.as_ref());
            inverse.project(&mut block);
            block = lanczos::orthonormal(&found, &block).0;
        }
        for _ in 0..2 {
            block = refined(&inverse, &block);
            inverse.project(&mut block);
            block = lanczos::orthonormal(&found, &block).0;
        }
        let zero = unresisted(&inverse, &block);
        let count = zero.ncols();
        found.push(zero);
        if count < BLOCK {
            break;
        }
    }
    let roots = &inverse.roots;
    let unscaled = |block: &Mat<f64>, k: usize| {
        let entry =
            |(i, r): (usize, &f64)| if *r > 0.0 { block[(i, k)] / r } else { 0.0 };
        roots.iter().enumerate().map(entry).collect()
    };
    found
        .iter()
        .flat_map(|block| (0..block.ncols()).map(move |k| unscaled(block, k)))
        .collect()
}

/// Takes from each column what its residual says it has too much of: `x - K⁻¹ Bᵀ (B x)`,
/// with the residual `B x` from orthogonal projectors.
fn refined(inverse: &Inverse, block: &Mat<f64>) -> Mat<f64> {
    let residual = |k: usize| {
        let off = inverse.deviations(block, k);
        inverse.system.scatter(&off)
    };
    let residuals: Vec<Vec<f64>> = (0..block.ncols()).map(residual).collect();
    let roots = &inverse.roots;
    let scaled = Mat::from_fn(block.nrows(), block.ncols(), |i, k| {
        if roots[i] > 0.0 { residuals[k][i] / roots[i] } else { 0.0 }
    });
    block - inverse.apply(scaled.as_ref())
}

/// Combinations of the columns that meet no resistance.
fn unresisted(inverse: &Inverse, block: &Mat<f64>) -> Mat<f64> {
    let columns: Vec<Vec<f64>> =
        (0..block.ncols()).map(|k| inverse.deviations(block, k)).collect();
    let rows = columns.first().map_or(0, Vec::len);
    let off = Mat::from_fn(rows, columns.len(), |i, k| columns[k][i]);
    let Ok(svd) = off.thin_svd() else { return Mat::zeros(block.nrows(), 0) };
    let count = columns.len();
    let zero: Vec<usize> = (0..count).filter(|&k| svd.S()[k] <= NO_RESISTANCE).collect();
    let v = svd.V();
    let chosen = Mat::from_fn(count, zero.len(), |i, k| v[(i, zero[k])]);
    block * chosen
}
