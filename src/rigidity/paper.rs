//! The algorithm of the paper, section "Stability", as it stands there.
//!
//! Every body has a motion `X = (C, C̄)`, `V(q) = C × q + C̄`; the rows of `A` compare the
//! velocities of bodies at the two ends of each hinge; body 0 is held. The right singular
//! vector of the smallest singular value is the motion that the hinges resist least, and
//! the *discrepancy* of a hinge is how far two bodies part there while the far node moves
//! by 1. Depends on units and on the held body, so that it is shown and not judged by
//! (docs/formulas.md 1.1, 1.4).

use crate::geometry::{Point3, Vector3};
use crate::ids::NodeId;
use crate::rigidity::criteria::{Criteria, Pairing};
use crate::rigidity::matrix::Matrix;
use crate::rigidity::model::Model;
use crate::rigidity::motions::Motions;
use crate::sparse::Halt;
use crate::tolerance::STANDS_STILL;
use crate::watch::Watch;

/// How far two bodies part at a hinge.
#[derive(Debug, Clone, PartialEq)]
pub struct Discrepancy {
    /// The node of the hinge.
    pub node: NodeId,
    /// The two bodies.
    pub bodies: [usize; 2],
    /// The larger of the two ends' differences of velocity, the far node moving by 1.
    pub value: f64,
}

/// One of the motions that the hinges resist least.
#[derive(Debug, Clone, PartialEq)]
pub struct HingeMotion {
    /// Its singular value.
    pub sigma: f64,
    /// `(C, C̄)` of each body, in the scaled structure, the far node moving by 1.
    pub twists: Vec<[f64; 6]>,
}

/// The paper's figures.
#[derive(Debug, Clone, PartialEq)]
pub struct Paper {
    /// How bodies on one axis were compared.
    pub pairing: Pairing,
    /// Scaled lengths over lengths in mm.
    pub scale: f64,
    /// The smallest singular values of `A`, ascending.
    pub singular_values: Vec<f64>,
    /// The largest.
    pub largest: f64,
    /// The motions of the smallest that move a hinge.
    pub motions: Vec<HingeMotion>,
    /// Per hinge and pair of bodies, in the first of these motions.
    pub discrepancies: Vec<Discrepancy>,
}

/// Up to this many bodies all singular values come from one dense decomposition.
const DENSE: usize = 48;

/// Bodies that a pairing other than [`Pairing::Pin`] is computed for: its matrix has no
/// sparse operator here.
pub const MOST_PAIRED: usize = 100;

/// Computes the paper's figures with body 0 held and no other support.
///
/// # Errors
/// [`NotPositiveDefinite`] if the factorisation fails.
pub(super) fn paper(
    model: &Model,
    criteria: &Criteria,
    threads: usize,
    watch: &dyn Watch,
) -> Result<Paper, Halt> {
    let Criteria { pairing, scale, modes: wanted, .. } = *criteria;
    let free = scaled(model, scale);
    let matrix = Matrix { model: &free, pairing };
    let (mut sigma, twists, largest) =
        if pairing != Pairing::Pin || model.bodies.len() <= DENSE {
            matrix.dense(wanted)
        } else {
            matrix.sparse(wanted, threads, watch)?
        };
    let spins: usize =
        (1..free.bodies.len()).map(|body| 6 - free_rank(&free, body)).sum();
    let far = far_node(&free);
    let moving = twists.into_iter().zip(&sigma);
    let motions: Vec<HingeMotion> = moving
        .map(|(twists, &sigma)| HingeMotion {
            sigma,
            twists: normalised(&free, far, twists),
        })
        .collect();
    sigma.splice(0..0, std::iter::repeat_n(0.0, spins.min(wanted)));
    sigma.truncate(wanted);
    let discrepancies =
        motions.first().map_or_else(Vec::new, |motion| discrepancies(&free, motion));
    Ok(Paper { pairing, scale, singular_values: sigma, largest, motions, discrepancies })
}

/// The model with other lengths and no supports.
fn scaled(model: &Model, scale: f64) -> Model {
    let mut free = model.clone();
    for coupling in &mut free.couplings {
        coupling.held = false;
        coupling.points.iter_mut().for_each(|p| *p *= scale);
    }
    free
}

pub(super) fn free_rank(model: &Model, body: usize) -> usize {
    let points = model.points(body);
    Motions::new(&points, &vec![1.0; points.len()]).rank
}

/// Velocity of a point.
pub(super) fn velocity(x: &[f64; 6], q: Point3) -> Vector3 {
    let (c, bar) = (Vector3::new(x[0], x[1], x[2]), Vector3::new(x[3], x[4], x[5]));
    c.cross(&q.coords) + bar
}

/// The pin farthest from the middle of body 0.
fn far_node(model: &Model) -> Option<usize> {
    let points = model.points(0);
    let sum: Vector3 = points.iter().map(|p| p.coords).sum();
    let middle = Point3::from(sum / points.len().max(1) as f64);
    let pins = (0..model.couplings.len()).filter(|&k| model.couplings[k].is_pin());
    let off = |k: &usize| (model.couplings[*k].place() - middle).norm_squared();
    pins.max_by(|a, b| off(a).total_cmp(&off(b)))
}

/// Velocity of the rod of a coupling: the mean of its bodies.
fn rod(model: &Model, coupling: usize, twists: &[[f64; 6]]) -> Vector3 {
    let coupling = &model.couplings[coupling];
    let all = coupling.bodies.iter().map(|&b| velocity(&twists[b], coupling.place()));
    all.sum::<Vector3>() / coupling.bodies.len().max(1) as f64
}

/// A motion scaled so that the far node, or if it stands still the one that moves most,
/// moves by 1.
fn normalised(
    model: &Model,
    far: Option<usize>,
    mut twists: Vec<[f64; 6]>,
) -> Vec<[f64; 6]> {
    let speeds: Vec<f64> =
        (0..model.couplings.len()).map(|k| rod(model, k, &twists).norm()).collect();
    let most = speeds.iter().copied().fold(0.0, f64::max);
    let speed = far.map_or(most, |far| speeds[far]);
    let speed = if speed > STANDS_STILL * most { speed } else { most };
    if speed > 0.0 {
        twists.iter_mut().flatten().for_each(|x| *x /= speed);
    }
    twists
}

impl Paper {
    /// Discrepancies of the hinges of the model in one of the motions.
    pub(super) fn discrepancies_in(
        &self,
        model: &Model,
        motion: usize,
    ) -> Vec<Discrepancy> {
        let motion = self.motions.get(motion);
        motion.map_or_else(Vec::new, |m| discrepancies(&scaled(model, self.scale), m))
    }
}

fn discrepancies(model: &Model, motion: &HingeMotion) -> Vec<Discrepancy> {
    let mut all = Vec::new();
    for coupling in &model.couplings {
        for (k, &a) in coupling.bodies.iter().enumerate() {
            for &b in &coupling.bodies[k + 1..] {
                let part = |&q: &Point3| {
                    let [x, y] = [a, b].map(|body| velocity(&motion.twists[body], q));
                    (x - y).norm()
                };
                let value = coupling.points.iter().map(part).fold(0.0, f64::max);
                all.push(Discrepancy { node: coupling.node, bodies: [a, b], value });
            }
        }
    }
    all
}
