//! How many motions meet no resistance at all.
//!
//! Decided by orthogonal means: singular values of the compatibility matrix, or of its
//! restriction to a subspace refined by residuals, never eigenvalues of `AᵀA`. Bodies that
//! spin unseen about their only axis are counted.

use crate::rigidity::spectrum::{self, Inverse, Modes};
use crate::rigidity::system::System;
use crate::sparse::{
    Block, Factor, Halt, Operator, RHS, orthonormalise, project_out, random_block,
};
use crate::tolerance::{NO_RESISTANCE, SUSPECT_RESISTANCE};
use crate::watch::Watch;
use faer::Mat;

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
/// [`Halt`] if a factorisation fails or the watch stops it.
pub(super) fn mobility(
    system: &System,
    modes: &Modes,
    watch: &dyn Watch,
) -> Result<Mobility, Halt> {
    let suspect = modes.sigma.first().is_some_and(|s| *s < SUSPECT_RESISTANCE);
    let motions = if !suspect {
        Vec::new()
    } else if system.unknowns() <= DENSE {
        let all = spectrum::dense(system, system.unknowns())?;
        let zero = all.sigma.iter().take_while(|s| **s <= NO_RESISTANCE).count();
        all.motions.into_iter().take(zero).collect()
    } else {
        null_space(system, &system.factor()?, watch)?
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
fn null_space(
    system: &System,
    factor: &Factor,
    watch: &dyn Watch,
) -> Result<Vec<Vec<f64>>, Halt> {
    let inverse = Inverse::new(system, factor);
    let size = inverse.size();
    let mut found: Vec<Block> = Vec::new();
    let fresh = |block: &mut Block, found: &[Block]| {
        inverse.project(block);
        for _ in 0..2 {
            project_out(found, block);
        }
        orthonormalise(block);
    };
    for seed in 0..(size / RHS) as u64 + 1 {
        watch.unless_stopped()?;
        let mut block = random_block(seed, size, RHS);
        inverse.project(&mut block);
        for _ in 0..2 {
            inverse.multiply(&mut block);
            fresh(&mut block, &found);
        }
        for _ in 0..2 {
            refine(&inverse, &mut block);
            fresh(&mut block, &found);
        }
        let zero = unresisted(&inverse, &block)?;
        let count = zero.columns;
        found.push(zero);
        if count < RHS {
            break;
        }
    }
    let motions = |block: &Block| -> Vec<Vec<f64>> {
        (0..block.columns).map(|k| inverse.motion(block, k)).collect()
    };
    Ok(found.iter().flat_map(motions).collect())
}

/// Takes from each column what its residual says it has too much of: `x - K⁻¹ Bᵀ (B x)`,
/// with the residual `B x` from orthogonal projectors.
fn refine(inverse: &Inverse, block: &mut Block) {
    let residual = |k: usize| {
        let off = inverse.system.deviations(&inverse.motion(block, k));
        let residual = inverse.system.scatter(&off).into_iter().zip(&inverse.roots);
        residual.map(|(x, root)| if *root > 0.0 { x / root } else { 0.0 }).collect()
    };
    let residuals: Vec<Vec<f64>> = (0..block.columns).map(residual).collect();
    let mut excess = Block::from_columns(block.rows, &residuals);
    inverse.multiply(&mut excess);
    block.values.iter_mut().zip(&excess.values).for_each(|(x, e)| *x -= e);
}

/// Combinations of the columns that meet no resistance.
fn unresisted(inverse: &Inverse, block: &Block) -> Result<Block, Halt> {
    let off = |k: usize| inverse.system.deviations(&inverse.motion(block, k));
    let columns: Vec<Vec<f64>> = (0..block.columns).map(off).collect();
    let rows = columns.first().map_or(0, Vec::len);
    let off = Mat::from_fn(rows, columns.len(), |i, k| columns[k][i]);
    let svd = off.thin_svd().map_err(|_| Halt::Failed)?;
    let count = columns.len();
    let zero: Vec<usize> = (0..count).filter(|&k| svd.S()[k] <= NO_RESISTANCE).collect();
    let v = svd.V();
    let chosen = Mat::from_fn(count, zero.len(), |i, k| v[(i, zero[k])]);
    Ok(block.times(chosen.as_ref()))
}
