//! How far a unit load on a node moves it.

use crate::geometry::Vector3;
use crate::rigidity::system::System;
use crate::sparse::{Block, Factor, Halt};
use crate::watch::Watch;
use faer::MatRef;
use nalgebra::{Matrix3, Matrix3x6, Matrix6};

/// Compliance of every free pin's node, the 3 × 3 block of `K⁻¹` seen from there: coupling
/// and block. On a whole that floats, of loads and motions without their rigid part.
///
/// # Errors
/// [`Halt::Stopped`].
pub(super) fn compliances(
    system: &System,
    factor: &Factor,
    rigid: &[Vec<f64>],
    watch: &dyn Watch,
) -> Result<Vec<(usize, Matrix3<f64>)>, Halt> {
    let take = |block: MatRef<'_, f64>| {
        (block.nrows() == 6).then(|| Matrix6::from_fn(|i, j| block[(i, j)]))
    };
    let blocks = factor.inverse_blocks(&take, watch)?;
    let rigid = Rigid::new(system, factor, rigid);
    let of = |(coupling, group): (usize, &Option<u32>)| {
        let at = system.coupling_at[coupling]?;
        let pin = &system.model.couplings[coupling];
        let block = blocks[system.symbolic.place[(*group)? as usize]]?;
        let seen = Seen { at, share: pin.share };
        Some((coupling, seen.block(&block) - rigid.part(seen))).filter(|_| pin.is_pin())
    };
    Ok(system.coupling_group.iter().enumerate().filter_map(of).collect())
}

/// The node of a pin between the pin's ends, whose first unknown is `at`.
#[derive(Clone, Copy)]
struct Seen {
    at: usize,
    share: f64,
}

impl Seen {
    fn block(self, block: &Matrix6<f64>) -> Matrix3<f64> {
        let node = Matrix3x6::from_fn(|i, j| {
            if j % 3 != i {
                0.0
            } else if j < 3 {
                1.0 - self.share
            } else {
                self.share
            }
        });
        let seen = node * block * node.transpose();
        (seen + seen.transpose()) / 2.0
    }

    fn velocity(self, block: &Block, k: usize) -> Vector3 {
        let end = |end: usize| {
            Vector3::from_fn(|i, _| {
                block.values[(self.at + 3 * end + i) * block.columns + k]
            })
        };
        end(0) * (1.0 - self.share) + end(1) * self.share
    }
}

/// Orthonormal rigid motions `R` of the whole, and `K⁻¹ R`.
struct Rigid {
    motions: Block,
    moved: Block,
    /// `Rᵀ K⁻¹ R`
    between: faer::Mat<f64>,
}

impl Rigid {
    fn new(system: &System, factor: &Factor, motions: &[Vec<f64>]) -> Self {
        let motions = Block::from_columns(system.unknowns(), motions);
        let mut moved = motions.clone();
        if moved.columns > 0 {
            factor.solve(&mut moved.values, moved.columns);
        }
        let between = motions.products(&moved);
        Self { motions, moved, between }
    }

    /// What `(I - R Rᵀ) K⁻¹ (I - R Rᵀ)` lacks of `K⁻¹` at a node.
    fn part(&self, seen: Seen) -> Matrix3<f64> {
        let mut part = Matrix3::zeros();
        for k in 0..self.motions.columns {
            let rigid = seen.velocity(&self.motions, k);
            let cross = rigid * seen.velocity(&self.moved, k).transpose();
            part += cross + cross.transpose();
            for j in 0..self.motions.columns {
                let other = seen.velocity(&self.motions, j).transpose();
                part -= rigid * other * self.between[(k, j)];
            }
        }
        part
    }
}
