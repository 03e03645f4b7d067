//! How far a node can sway for a play, bracketed from both sides.
//!
//! Every point of a contact may leave its pin by the play `p`, in any direction. The sway
//! of a node along `d` is then `α p`, where
//!
//! * any motion gives a lower bound of α: the node's way over the largest deviation;
//! * any contact forces in equilibrium with a unit load on the node along `d` give an upper
//!   bound: the sum of their sizes (conic duality; docs/formulas.md 1.6).
//!
//! One solve with the factor of the resistance gives both. Reweighting the contacts by
//! their forces and solving again (IRLS) draws the bounds together.

use crate::geometry::Vector3;
use crate::rigidity::stiffness::Stiffness;
use crate::rigidity::system::System;
use crate::sparse::{Factor, NotPositiveDefinite};
use crate::tolerance::{BRACKET_WIDTH, FORCE_BALANCE, LEAST_WEIGHT};

/// A load on the unknowns: one unit on a node along a direction. On a whole that floats
/// its share in the rigid motions is taken off, so that it asks for the sway beside the
/// best-fitting rigid motion.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Load {
    /// The coupling whose node is loaded.
    pub(super) coupling: usize,
    /// Unit vector.
    pub(super) direction: Vector3,
    /// One number per unknown.
    pub(super) forces: Vec<f64>,
}

impl Load {
    /// A unit load on the node of a free pin.
    pub(super) fn new(
        system: &System,
        rigid: &[Vec<f64>],
        coupling: usize,
        direction: Vector3,
    ) -> Option<Self> {
        let at = system.coupling_at[coupling]?;
        let share = system.model.couplings[coupling].share;
        let mut forces = vec![0.0; system.unknowns()];
        for k in 0..3 {
            forces[at + k] = (1.0 - share) * direction[k];
            forces[at + 3 + k] = share * direction[k];
        }
        for motion in rigid {
            let part: f64 =
                (at..at + 6).map(|k| motion[k] * load_at(share, direction, k - at)).sum();
            forces.iter_mut().zip(motion).for_each(|(f, r)| *f -= part * r);
        }
        Some(Self { coupling, direction, forces })
    }
}

fn load_at(share: f64, direction: Vector3, k: usize) -> f64 {
    let weight = if k < 3 { 1.0 - share } else { share };
    weight * direction[k % 3]
}

/// Bounds of an amplification, sway over play.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bracket {
    /// No motion within the play sways less at its most.
    pub lower: f64,
    /// None sways more.
    pub upper: f64,
}

impl Bracket {
    const OPEN: Self = Self { lower: 0.0, upper: f64::INFINITY };

    fn met(self, other: Self) -> Self {
        Self { lower: self.lower.max(other.lower), upper: self.upper.min(other.upper) }
    }

    /// Whether upper and lower are near enough.
    pub fn is_narrow(&self) -> bool {
        self.upper <= BRACKET_WIDTH * self.lower
    }
}

/// What proves a bracket.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Proof {
    /// The bounds.
    pub(super) bracket: Bracket,
    /// Velocities of the unknowns in the motion of the lower bound, deviations at most 1.
    pub(super) motion: Vec<f64>,
    /// Deviations of the contacts in that motion, three numbers each.
    pub(super) off: Vec<f64>,
    /// Contact forces of the upper bound, three numbers per contact.
    pub(super) forces: Vec<f64>,
}

/// A bracket in the making.
pub(super) struct Bracketing<'a> {
    system: &'a System<'a>,
    /// What is asked.
    pub(super) load: Load,
    /// The best so far.
    pub(super) proof: Proof,
    weights: Vec<f64>,
    floor: f64,
}

/// Least weight of a contact in the first round, halved each round.
const FIRST_FLOOR: f64 = 0.1;

impl<'a> Bracketing<'a> {
    /// First bounds of some loads at once, with the factor of the unweighted resistance.
    pub(super) fn first(
        system: &'a System<'a>,
        factor: &Factor,
        loads: Vec<Load>,
    ) -> Vec<Self> {
        let count = loads.len();
        let mut x = vec![0.0; system.unknowns() * count];
        for (i, row) in x.chunks_exact_mut(count.max(1)).enumerate() {
            row.iter_mut().zip(&loads).for_each(|(x, load)| *x = load.forces[i]);
        }
        if count > 0 {
            factor.solve(&mut x, count);
        }
        let contacts = system.first_contact[system.first_contact.len() - 1];
        let begun = loads.into_iter().enumerate().map(|(k, load)| {
            let y: Vec<f64> = x.chunks_exact(count).map(|row| row[k]).collect();
            let proof = Proof {
                bracket: Bracket::OPEN,
                motion: Vec::new(),
                off: Vec::new(),
                forces: Vec::new(),
            };
            let (weights, floor) = (vec![1.0; contacts], FIRST_FLOOR);
            let mut begun = Self { system, load, proof, weights, floor };
            begun.learn(&y, &system.deviations(&y));
            begun
        });
        begun.collect()
    }

    /// One more round.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] if the factorisation fails.
    pub(super) fn tighten(&mut self) -> Result<(), NotPositiveDefinite> {
        let stiffness = Stiffness::new(self.system, Some(&self.weights));
        let mut y = self.load.forces.clone();
        stiffness.factor()?.solve(&mut y, 1);
        self.learn(&y, &stiffness.deviations(&y));
        Ok(())
    }

    /// Bounds and the next weights from a solution and what the contacts deviate in it.
    fn learn(&mut self, y: &[f64], off: &[f64]) {
        let sizes: Vec<f64> = off
            .chunks_exact(3)
            .map(|d| d.iter().map(|x| x * x).sum::<f64>().sqrt())
            .collect();
        let most = sizes.iter().copied().fold(0.0, f64::max);
        let way: f64 = y.iter().zip(&self.load.forces).map(|(y, f)| y * f).sum();
        let weighted = sizes.iter().zip(&self.weights);
        let forces: Vec<f64> = weighted.map(|(d, w)| d * w).collect();
        let upper: f64 = forces.iter().sum();
        if most > 0.0 && way / most > self.proof.bracket.lower {
            self.proof.bracket.lower = way / most;
            self.proof.motion = y.iter().map(|y| y / most).collect();
            self.proof.off = off.iter().map(|d| d / most).collect();
        }
        let vectors = || {
            let scaled = off.chunks_exact(3).zip(&self.weights);
            scaled.flat_map(|(d, w)| d.iter().map(move |d| d * w)).collect::<Vec<f64>>()
        };
        if upper < self.proof.bracket.upper {
            let vectors = vectors();
            // What does not balance the load proves nothing.
            if self.imbalance(&vectors) <= FORCE_BALANCE {
                self.proof.bracket.upper = upper;
                self.proof.forces = vectors;
            }
        }
        let strongest = forces.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        self.weights = forces.iter().map(|f| (f / strongest).max(self.floor)).collect();
        self.floor = (self.floor / 2.0).max(LEAST_WEIGHT);
    }

    /// How far forces on the pins are from the load, largest entry.
    fn imbalance(&self, forces: &[f64]) -> f64 {
        let on_pins = self.system.scatter(forces);
        let counts = self.system.counts();
        let off = on_pins.iter().zip(&self.load.forces).zip(&counts);
        off.filter(|(_, n)| **n > 0.0)
            .map(|((a, b), _)| (a - b).abs())
            .fold(0.0, f64::max)
    }

    /// Bounds together with those of another direction or node.
    pub(super) fn bracket(&self) -> Bracket {
        self.proof.bracket.met(Bracket::OPEN)
    }
}
