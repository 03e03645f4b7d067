//! The motions that meet least resistance.
//!
//! `K y = λ D y`: the root of λ is the rms deviation of sleeves from their pins over the
//! rms motion of the pins, free of units and origin (notes §1.3, §3.2). All figures come
//! from residuals `(I - QQᵀ) y`, never from `yᵀ K y`, which loses half the digits.

use crate::rigidity::factor::{Factor, Singular};
use crate::rigidity::lanczos::{self, Operator};
use crate::rigidity::system::System;
use faer::{Mat, MatRef};

/// Up to this many unknowns everything is done by a dense singular value decomposition.
const DENSE: usize = 240;

/// Motions with their resistance.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Modes {
    /// Rms deviation over rms motion, ascending.
    pub sigma: Vec<f64>,
    /// Velocities of the unknowns of each mode.
    pub motions: Vec<Vec<f64>>,
}

/// The `wanted` motions that meet least resistance; rigid motions of a whole that floats
/// are left out.
///
/// # Errors
/// [`Singular`] if the factorisation fails.
pub(super) fn least(system: &System, wanted: usize) -> Result<Modes, Singular> {
    if system.unknowns() == 0 {
        return Ok(Modes { sigma: Vec::new(), motions: Vec::new() });
    }
    if is_dense(system) {
        return Ok(dense(system, wanted));
    }
    let factor = system.factor(None)?;
    Ok(by_inverse(system, &factor, wanted))
}

/// Whether a model is small enough for dense work.
pub(super) fn is_dense(system: &System) -> bool {
    system.unknowns() <= DENSE
}

/// The same with a factor at hand.
pub(super) fn by_inverse(system: &System, factor: &Factor, wanted: usize) -> Modes {
    let inverse = Inverse::new(system, factor);
    let vectors = lanczos::largest(&inverse, wanted);
    let motions = (0..vectors.ncols()).map(|k| {
        let column = inverse.roots.iter().enumerate();
        column.map(|(i, r)| if *r > 0.0 { vectors[(i, k)] / r } else { 0.0 }).collect()
    });
    measured(system, motions.collect())
}

/// Motions sorted by their resistance.
pub(super) fn measured(system: &System, motions: Vec<Vec<f64>>) -> Modes {
    let counts = system.counts();
    let resistance = |y: &Vec<f64>| {
        let off: f64 = system.deviations(y).iter().map(|d| d * d).sum();
        let moved: f64 = y.iter().zip(&counts).map(|(y, n)| n * y * y).sum();
        (off / moved).sqrt()
    };
    let mut both: Vec<(f64, Vec<f64>)> =
        motions.into_iter().map(|y| (resistance(&y), y)).collect();
    both.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (sigma, motions) = both.into_iter().unzip();
    Modes { sigma, motions }
}

/// `D^½ K⁻¹ D^½` without the rigid motions of a whole that floats.
pub(super) struct Inverse<'a> {
    pub(super) system: &'a System<'a>,
    factor: &'a Factor<'a>,
    /// Roots of `D`.
    pub(super) roots: Vec<f64>,
    /// Orthonormal `D^½ R`, or nothing.
    rigid: Vec<Mat<f64>>,
}

impl<'a> Inverse<'a> {
    pub(super) fn new(system: &'a System<'a>, factor: &'a Factor<'a>) -> Self {
        let roots: Vec<f64> = system.counts().into_iter().map(f64::sqrt).collect();
        let mut rigid = Vec::new();
        if system.floats {
            let motions = system.rigid();
            let scaled =
                Mat::from_fn(roots.len(), motions.len(), |i, k| motions[k][i] * roots[i]);
            rigid.push(lanczos::orthonormal(&[], &scaled).0);
        }
        Self { system, factor, roots, rigid }
    }

    /// Deviations of the sleeves in the motion of a column.
    pub(super) fn deviations(&self, block: &Mat<f64>, k: usize) -> Vec<f64> {
        let y: Vec<f64> = (0..block.nrows())
            .map(
                |i| if self.roots[i] > 0.0 { block[(i, k)] / self.roots[i] } else { 0.0 },
            )
            .collect();
        self.system.deviations(&y)
    }
}

impl Operator for Inverse<'_> {
    fn size(&self) -> usize {
        self.system.unknowns()
    }

    fn apply(&self, block: MatRef<'_, f64>) -> Mat<f64> {
        let count = block.ncols();
        if count == 0 {
            return Mat::zeros(block.nrows(), 0);
        }
        let mut x = vec![0.0; block.nrows() * count];
        for (i, (row, root)) in x.chunks_exact_mut(count).zip(&self.roots).enumerate() {
            row.iter_mut().enumerate().for_each(|(k, x)| *x = block[(i, k)] * root);
        }
        self.factor.solve(&mut x, count);
        Mat::from_fn(block.nrows(), count, |i, k| x[i * count + k] * self.roots[i])
    }

    fn project(&self, block: &mut Mat<f64>) {
        // Unknowns that are a body's own are no part of the motion.
        for k in 0..block.ncols() {
            for (i, root) in self.roots.iter().enumerate() {
                if *root <= 0.0 {
                    block[(i, k)] = 0.0;
                }
            }
        }
        lanczos::clear(&self.rigid, block);
    }
}

/// All by a singular value decomposition of the compatibility matrix `(I - QQᵀ) D^-½`;
/// rows are added that resist the rigid motions of a whole that floats.
pub(super) fn dense(system: &System, wanted: usize) -> Modes {
    let roots: Vec<f64> = system.counts().into_iter().map(f64::sqrt).collect();
    let n = roots.len();
    let rigid = if system.floats { system.rigid() } else { Vec::new() };
    let rigid_scaled = Mat::from_fn(n, rigid.len(), |i, k| rigid[k][i] * roots[i]);
    let rigid = lanczos::orthonormal(&[], &rigid_scaled).0;
    let unknowns: Vec<usize> = (0..n).filter(|&k| roots[k] > 0.0).collect();
    let column = |&k: &usize| {
        let mut y = vec![0.0; n];
        y[k] = 1.0 / roots[k];
        let mut column = system.deviations(&y);
        column.extend((0..rigid.ncols()).map(|j| 2.0 * rigid[(k, j)]));
        column
    };
    let columns: Vec<Vec<f64>> = unknowns.iter().map(column).collect();
    let rows = columns.first().map_or(0, Vec::len);
    let matrix = Mat::from_fn(rows, columns.len(), |i, j| columns[j][i]);
    let Ok(svd) = matrix.thin_svd() else {
        return Modes { sigma: Vec::new(), motions: Vec::new() };
    };
    let all = columns.len().min(rows);
    let motions = (0..wanted.min(all.saturating_sub(rigid.ncols()))).map(|k| {
        let mut y = vec![0.0; n];
        for (row, &at) in unknowns.iter().enumerate() {
            y[at] = svd.V()[(row, all - 1 - k)] / roots[at];
        }
        y
    });
    measured(system, motions.collect())
}
