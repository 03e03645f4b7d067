//! The motions that meet least resistance.
//!
//! `K y = λ D y`: the root of λ is the rms deviation of contacts from their pins over the
//! rms motion of the pins, free of units and origin (docs/formulas.md 1.3, 1.4). All
//! figures come from residuals `(I - QQᵀ) y`, never from `yᵀ K y`, which loses half the
//! digits.

use crate::geometry::Vector3;
use crate::rigidity::model::Coupling;
use crate::rigidity::system::System;
use crate::sparse::{
    Block, Factor, Halt, Operator, RHS, largest, orthonormalise, project_out,
    random_block,
};
use crate::watch::Watch;
use faer::Mat;

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
/// [`Halt`] if the factorisation fails or the watch stops it.
pub(super) fn least(
    system: &System,
    wanted: usize,
    watch: &dyn Watch,
) -> Result<Modes, Halt> {
    if system.unknowns() == 0 {
        return Ok(Modes { sigma: Vec::new(), motions: Vec::new() });
    }
    let modes = if is_dense(system) {
        dense(system, wanted)?
    } else {
        by_inverse(system, &system.factor()?, wanted, watch)?
    };
    let found = modes.sigma.iter().all(|sigma| sigma.is_finite());
    if found { Ok(modes) } else { Err(Halt::Failed) }
}

/// Whether a model is small enough for dense work.
pub(super) fn is_dense(system: &System) -> bool {
    system.unknowns() <= DENSE
}

/// The same with a factor at hand.
///
/// # Errors
/// [`Halt::Stopped`].
pub(super) fn by_inverse(
    system: &System,
    factor: &Factor,
    wanted: usize,
    watch: &dyn Watch,
) -> Result<Modes, Halt> {
    let inverse = Inverse::new(system, factor);
    let vectors = largest(&inverse, wanted, watch)?;
    let motions = (0..vectors.columns).map(|k| inverse.motion(&vectors, k));
    Ok(measured(system, motions.collect()))
}

/// Motions sorted by their resistance.
pub(super) fn measured(system: &System, motions: Vec<Vec<f64>>) -> Modes {
    let counts = system.counts();
    let moved = |y: &[f64]| y.iter().zip(&counts).map(|(y, n)| n * y * y).sum::<f64>();
    let resistances = system.resistances(&motions).into_iter();
    let both = resistances.zip(motions).map(|(all, y)| ((all / moved(&y)).sqrt(), y));
    let mut both: Vec<(f64, Vec<f64>)> = both.collect();
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
    rigid: Vec<Block>,
}

impl<'a> Inverse<'a> {
    pub(super) fn new(system: &'a System<'a>, factor: &'a Factor<'a>) -> Self {
        let roots: Vec<f64> = system.counts().into_iter().map(f64::sqrt).collect();
        let mut rigid = Vec::new();
        if system.floats {
            rigid.push(scaled_rigid(system, &roots));
        }
        Self { system, factor, roots, rigid }
    }

    /// The motion that a column stands for.
    pub(super) fn motion(&self, block: &Block, k: usize) -> Vec<f64> {
        let scaled = block.column(k).into_iter().zip(&self.roots);
        scaled.map(|(x, root)| if *root > 0.0 { x / root } else { 0.0 }).collect()
    }

    /// Multiplies each row with its root.
    fn scale(&self, block: &mut Block) {
        for (row, root) in block.rows_mut().zip(&self.roots) {
            row.iter_mut().for_each(|x| *x *= root);
        }
    }

    /// Becomes the product with each column.
    pub(super) fn multiply(&self, block: &mut Block) {
        if block.columns > 0 {
            self.scale(block);
            self.factor.solve(&mut block.values, block.columns);
            self.scale(block);
        }
    }

    /// Takes from each column what the wanted motions must not contain.
    pub(super) fn project(&self, block: &mut Block) {
        // Unknowns that are a body's own are no part of the motion.
        for (row, root) in block.rows_mut().zip(&self.roots) {
            if *root <= 0.0 {
                row.fill(0.0);
            }
        }
        project_out(&self.rigid, block);
    }
}

/// Orthonormal `D^½ R`.
fn scaled_rigid(system: &System, roots: &[f64]) -> Block {
    let mut rigid = Block::from_columns(roots.len(), &system.rigid());
    for (row, root) in rigid.rows_mut().zip(roots) {
        row.iter_mut().for_each(|x| *x *= root);
    }
    orthonormalise(&mut rigid);
    rigid
}

impl Operator for Inverse<'_> {
    fn size(&self) -> usize {
        self.system.unknowns()
    }

    fn apply(&self, block: &Block, into: &mut Block) {
        into.clone_from(block);
        self.multiply(into);
    }

    fn deflated(&self) -> &[Block] {
        &self.rigid
    }

    fn threads(&self) -> usize {
        self.system.threads
    }

    fn start(&self) -> Block {
        smooth(self.system, &self.roots)
    }
}

/// How much of the first vectors is random_block, beside what is smooth.
const SCATTERED: f64 = 0.1;

/// Velocities to begin with: quadratic in the place, as the least resisted motions nearly
/// are, and a random_block part so that none is missed.
fn smooth(system: &System, roots: &[f64]) -> Block {
    let model = system.model;
    let count = model.couplings.len().max(1) as f64;
    let centre =
        model.couplings.iter().map(|k| k.place().coords).sum::<Vector3>() / count;
    let off = |coupling: &Coupling| (coupling.place().coords - centre).norm_squared();
    let radius = (model.couplings.iter().map(off).sum::<f64>() / count).sqrt();
    let scale = if radius > 0.0 { 1.0 / radius } else { 0.0 };
    // Ten products of pairs of 1, x, y and z in three directions.
    let shares = random_block(2, 30, RHS).values;
    let (shares, _) = shares.as_chunks::<RHS>();
    let mut block = random_block(1, system.unknowns(), RHS);
    let (rows, _) = block.values.as_chunks_mut::<RHS>();
    for (row, root) in rows.iter_mut().zip(roots) {
        row.iter_mut().for_each(|x| *x *= SCATTERED * root);
    }
    for (coupling, at) in model.couplings.iter().zip(&system.coupling_at) {
        let Some(at) = *at else { continue };
        let points = at..at + 3 * coupling.points.len();
        for (at, point) in points.step_by(3).zip(&coupling.points) {
            let q = (point.coords - centre) * scale;
            let linear = [1.0, q.x, q.y, q.z];
            let pairs = (0..4).flat_map(|i| (i..4).map(move |j| linear[i] * linear[j]));
            let rows = &mut rows[at..at + 3];
            for (product, shares) in pairs.zip(shares.chunks_exact(3)) {
                let product = product * roots[at];
                for (row, shares) in rows.iter_mut().zip(shares) {
                    row.iter_mut().zip(shares).for_each(|(x, s)| *x += product * s);
                }
            }
        }
    }
    block
}

/// All by a singular value decomposition of the compatibility matrix `(I - QQᵀ) D^-½`;
/// rows are added that resist the rigid motions of a whole that floats.
///
/// # Errors
/// [`Halt::Failed`] if the decomposition fails.
pub(super) fn dense(system: &System, wanted: usize) -> Result<Modes, Halt> {
    let roots: Vec<f64> = system.counts().into_iter().map(f64::sqrt).collect();
    let n = roots.len();
    let rigid =
        if system.floats { scaled_rigid(system, &roots) } else { Block::zeros(n, 0) };
    let unknowns: Vec<usize> = (0..n).filter(|&k| roots[k] > 0.0).collect();
    let column = |&k: &usize| {
        let mut y = vec![0.0; n];
        y[k] = 1.0 / roots[k];
        let mut column = system.deviations(&y);
        column.extend(
            rigid.values[k * rigid.columns..(k + 1) * rigid.columns]
                .iter()
                .map(|x| 2.0 * x),
        );
        column
    };
    let columns: Vec<Vec<f64>> = unknowns.iter().map(column).collect();
    let rows = columns.first().map_or(0, Vec::len);
    let matrix = Mat::from_fn(rows, columns.len(), |i, j| columns[j][i]);
    let svd = matrix.thin_svd().map_err(|_| Halt::Failed)?;
    let all = columns.len().min(rows);
    let motions = (0..wanted.min(all.saturating_sub(rigid.columns))).map(|k| {
        let mut y = vec![0.0; n];
        for (row, &at) in unknowns.iter().enumerate() {
            y[at] = svd.V()[(row, all - 1 - k)] / roots[at];
        }
        y
    });
    Ok(measured(system, motions.collect()))
}
