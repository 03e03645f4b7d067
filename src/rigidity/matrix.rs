//! The paper's matrix `A` and its smallest singular values, dense and sparse.

use crate::geometry::Vector3;
use crate::rigidity::criteria::Pairing;
use crate::rigidity::model::Model;
use crate::rigidity::motions::Twists;
use crate::rigidity::paper::{free_rank, velocity};
use crate::rigidity::system::System;
use crate::sparse::{Block, Factor, Halt, Operator, largest, map_range, worthwhile};
use crate::watch::Watch;
use faer::Mat;

/// `A`, row by row; unknowns are the motions of the bodies after the first.
pub(super) struct Matrix<'a> {
    pub(super) model: &'a Model,
    pub(super) pairing: Pairing,
}

/// NotPositiveDefinite values, ascending, their motions, and the largest singular value.
type Solved = (Vec<f64>, Vec<Vec<[f64; 6]>>, f64);

impl Matrix<'_> {
    fn size(&self) -> usize {
        6 * (self.model.bodies.len() - 1)
    }

    fn twists(&self, x: impl Fn(usize) -> f64) -> Vec<[f64; 6]> {
        let of = |body: usize| std::array::from_fn(|k| x(6 * body + k));
        let moving = (0..self.model.bodies.len() - 1).map(of);
        std::iter::once([0.0; 6]).chain(moving).collect()
    }

    /// `A x`.
    fn apply(&self, twists: &[[f64; 6]]) -> Vec<f64> {
        let mut all = Vec::new();
        for coupling in &self.model.couplings {
            for difference in self.pairing.differences(coupling.bodies.len()) {
                for &q in &coupling.points {
                    let terms = difference.iter();
                    let off: Vector3 = terms
                        .map(|(i, s)| velocity(&twists[coupling.bodies[*i]], q) * *s)
                        .sum();
                    all.extend_from_slice(off.as_slice());
                }
            }
        }
        all
    }

    /// `Aᵀ v`, body 0 left out.
    fn transposed(&self, values: &[f64]) -> Vec<f64> {
        let mut x = vec![0.0; self.size() + 6];
        let mut values = values.chunks_exact(3);
        for coupling in &self.model.couplings {
            for difference in self.pairing.differences(coupling.bodies.len()) {
                for (q, v) in coupling.points.iter().zip(&mut values) {
                    let v = Vector3::new(v[0], v[1], v[2]);
                    let turn = q.coords.cross(&v);
                    for (i, share) in &difference {
                        let at = 6 * coupling.bodies[*i];
                        for k in 0..3 {
                            x[at + k] += share * turn[k];
                            x[at + 3 + k] += share * v[k];
                        }
                    }
                }
            }
        }
        x.split_off(6)
    }

    /// Everything by one singular value decomposition; motions that move no hinge are
    /// left out.
    pub(super) fn dense(&self, wanted: usize) -> Solved {
        let n = self.size();
        let columns: Vec<Vec<f64>> = (0..n)
            .map(|k| self.apply(&self.twists(|i| f64::from(u8::from(i == k)))))
            .collect();
        let rows = columns.first().map_or(0, Vec::len);
        if rows == 0 {
            return (Vec::new(), Vec::new(), 0.0);
        }
        let matrix =
            Mat::from_fn(
                rows.max(n),
                n,
                |i, j| {
                    if i < rows { columns[j][i] } else { 0.0 }
                },
            );
        let Ok(svd) = matrix.thin_svd() else { return (Vec::new(), Vec::new(), 0.0) };
        let spins: usize =
            (1..self.model.bodies.len()).map(|b| 6 - free_rank(self.model, b)).sum();
        let all: Vec<f64> = (0..n).rev().map(|k| svd.S()[k]).collect();
        let last = (spins + wanted).min(n);
        let twists = (spins..last).map(|k| self.twists(|i| svd.V()[(i, n - 1 - k)]));
        (all[spins..last].to_vec(), twists.collect(), svd.S()[0])
    }

    pub(super) fn sparse(
        &self,
        wanted: usize,
        threads: usize,
        watch: &dyn Watch,
    ) -> Result<Solved, Halt> {
        let system = System::new(self.model, Some(0), threads);
        let factor = system.factor()?;
        let twists = system.twists();
        let inverse = PinInverse { system: &system, factor: &factor, twists };
        let vectors = largest(&inverse, wanted, watch)?;
        let mut found: Vec<(f64, Vec<[f64; 6]>)> = (0..vectors.columns)
            .map(|k| {
                let vector = vectors.column(k);
                let twists = self.twists(|i| vector[i]);
                let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
                (norm(&self.apply(&twists)) / norm(twists.as_flattened()), twists)
            })
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let top = largest(&Square { matrix: self, threads }, 1, watch)?;
        let top = self.apply(&self.twists(|i| top.values[i]));
        let largest = top.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (sigma, twists) = found.into_iter().unzip();
        Ok((sigma, twists, largest))
    }
}

/// `AᵀA`.
struct Square<'a> {
    matrix: &'a Matrix<'a>,
    threads: usize,
}

impl Operator for Square<'_> {
    fn size(&self) -> usize {
        self.matrix.size()
    }

    fn apply(&self, block: &Block, into: &mut Block) {
        let image = |(): &mut (), k: usize| {
            let column = block.column(k);
            let twists = self.matrix.twists(|i| column[i]);
            self.matrix.transposed(&self.matrix.apply(&twists))
        };
        let images = map_range(self.threads(), block.columns, || (), image);
        *into = Block::from_columns(block.rows, &images);
    }

    fn threads(&self) -> usize {
        worthwhile(self.threads, self.size())
    }
}

/// The inverse of `AᵀA` for the pairing `pin`: with `J X = Q z` and `X = T z` it is
/// `T (I + Qᵀ K⁻¹ Q) Tᵀ`, so that the factor of the pin form serves.
struct PinInverse<'a> {
    system: &'a System<'a>,
    factor: &'a Factor<'a>,
    /// Of all bodies, `T`.
    twists: Vec<Twists>,
}

impl PinInverse<'_> {
    /// `Q z` on the pins, and `z = Tᵀ x` of each body but the one that is held.
    fn push(&self, x: &[f64]) -> (Vec<f64>, Vec<[f64; 6]>) {
        let system = self.system;
        let mut contacts = vec![0.0; 3 * system.first_contact[1]];
        let (x, _) = x.as_chunks::<6>();
        let bodies = x.iter().zip(&self.twists[1..]).zip(&system.motions[1..]);
        let all = bodies.map(|((x, twists), motions)| {
            let z = twists.map(|twist| twist.iter().zip(x).map(|(t, x)| t * x).sum());
            let from = contacts.len();
            contacts.resize(from + motions.rows, 0.0);
            for (j, z) in z.iter().enumerate().take(motions.rank) {
                let column = motions.column(j).iter();
                contacts[from..]
                    .iter_mut()
                    .zip(column)
                    .for_each(|(s, q): (_, &f64)| *s += z * q);
            }
            z
        });
        let all = all.collect();
        (system.scatter(&contacts), all)
    }

    /// `T (z + Qᵀ y)`.
    fn follow(&self, y: &[f64], shares: &[[f64; 6]]) -> Vec<f64> {
        let (mut image, mut values) = (Vec::with_capacity(self.size()), Vec::new());
        for (body, z) in (1..).zip(shares) {
            self.system.gather(body, y, &mut values);
            let back = self.system.motions[body].shares(&values);
            let mut x = [0.0; 6];
            for (twist, (z, back)) in self.twists[body].iter().zip(z.iter().zip(back)) {
                x.iter_mut().zip(twist).for_each(|(x, t)| *x += t * (z + back));
            }
            image.extend(x);
        }
        image
    }
}

impl Operator for PinInverse<'_> {
    fn size(&self) -> usize {
        6 * (self.system.motions.len() - 1)
    }

    fn apply(&self, block: &Block, into: &mut Block) {
        let (count, threads) = (block.columns, self.threads());
        let (pushed, shares): (Vec<_>, Vec<_>) =
            map_range(threads, count, || (), |(), k| self.push(&block.column(k)))
                .into_iter()
                .unzip();
        let mut moved = Block::from_columns(self.system.unknowns(), &pushed);
        self.factor.solve(&mut moved.values, count);
        let image = |(): &mut (), k: usize| self.follow(&moved.column(k), &shares[k]);
        let images = map_range(threads, count, || (), image);
        *into = Block::from_columns(block.rows, &images);
    }

    fn threads(&self) -> usize {
        worthwhile(self.system.threads, self.size())
    }
}
