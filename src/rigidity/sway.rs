//! Which node sways most, against what it may: the numbers behind a verdict.

use crate::geometry::{Point3, Vector3};
use crate::ids::NodeId;
use crate::rigidity::amplify::{Bracket, Bracketing, Load};
use crate::rigidity::compliance::compliances;
use crate::rigidity::criteria::Criteria;
use crate::rigidity::model::Model;
use crate::rigidity::spectrum::Modes;
use crate::rigidity::system::System;
use crate::sparse::Halt;
use crate::tolerance::SAME_SWAY;
use crate::watch::Watch;
use nalgebra::Matrix3;
use std::collections::BTreeSet;

/// Nodes of largest compliance that are looked at.
const TOP: usize = 5;
/// Rounds of tightening in all before it is content with a wide bracket, while the verdict
/// is open.
const MOST_ROUNDS: usize = 60;
/// The same times unknowns when the verdict stands and only the figures are wide.
const MOST_WORK: usize = 500_000;
/// Rounds that a mere comparison is worth.
const FEW_ROUNDS: usize = 6;

/// Rounds that figures are worth when the verdict stands.
pub(super) fn rounds_for_figures(system: &System) -> usize {
    (MOST_WORK / system.unknowns().max(1)).min(10 * MOST_ROUNDS)
}

/// The worst node and direction found.
#[derive(Debug, Clone, PartialEq)]
pub struct Sway {
    /// The node.
    pub node: NodeId,
    /// Which way, unit vector.
    pub direction: Vector3,
    /// Sway over play there.
    pub bracket: Bracket,
    /// What it may sway, mm.
    pub limit_mm: f64,
    /// From the node to the nearest support, or the size of what floats, mm.
    pub span_mm: f64,
    /// Largest amplification over limit at any node and direction that was looked at, as
    /// bounds, 1/mm.
    pub demand: Bracket,
}

impl Sway {
    /// A sway there in mm, or in words where the model of small motions ends.
    pub(super) fn in_words(&self, bracket: Bracket, play: f64) -> String {
        if !bracket.upper.is_finite() {
            let low = bracket.lower * play;
            return format!("at least {low:.2} mm, and nobody can tell how much at most");
        }
        let (low, high) = (bracket.lower * play, bracket.upper * play);
        if low > self.span_mm / 10.0 {
            format!("more than a tenth of its span of {:.0} mm", self.span_mm)
        } else {
            format!("{low:.2} to {high:.2} mm")
        }
    }
}

/// Spans of all couplings: the distance to the nearest held pin, or the size of the whole.
pub(super) fn spans(model: &Model) -> Vec<f64> {
    let pins = || model.couplings.iter().filter(|coupling| coupling.is_pin());
    let held: Vec<Point3> = pins().filter(|k| k.held).map(|k| k.place()).collect();
    if held.is_empty() {
        let count = pins().count().max(1) as f64;
        let centre = pins().map(|k| k.place().coords).sum::<Vector3>() / count;
        let reach =
            pins().map(|k| (k.place().coords - centre).norm()).fold(0.0, f64::max);
        return vec![2.0 * reach; model.couplings.len()];
    }
    let nearest = |p: Point3| {
        let off = held.iter().map(|h| (h - p).norm_squared());
        off.fold(f64::INFINITY, f64::min).sqrt()
    };
    model.couplings.iter().map(|coupling| nearest(coupling.place())).collect()
}

/// Velocity of the node of a coupling.
pub(super) fn node_velocity(system: &System, coupling: usize, y: &[f64]) -> Vector3 {
    let Some(at) = system.coupling_at[coupling] else { return Vector3::zeros() };
    let share = system.model.couplings[coupling].share;
    let end = |k: usize| Vector3::new(y[at + k], y[at + k + 1], y[at + k + 2]);
    end(0) * (1.0 - share) + end(3) * share
}

/// Brackets the amplification where it is worst, for a play and a limit; `rounds` are
/// spent on figures when the verdict stands. `None` if no node can move.
///
/// # Errors
/// [`Halt`] if a factorisation fails or the watch stops it.
pub(super) fn worst(
    system: &System,
    modes: &Modes,
    criteria: &Criteria,
    rounds: usize,
    watch: &dyn Watch,
) -> Result<Option<Sway>, Halt> {
    let factor = system.factor()?;
    let rigid = if system.floats { system.rigid() } else { Vec::new() };
    let spans = spans(system.model);
    let limit = |coupling: usize| criteria.limit.of(spans[coupling]);
    let compliances = compliances(system, &factor, &rigid, watch)?;
    let chosen = chosen(system, &compliances, modes, &limit);
    let loads = chosen.iter().flat_map(|coupling| {
        let axes = compliances.iter().find(|(k, _)| k == coupling).map(|(_, m)| *m);
        let axes = axes.unwrap_or_else(Matrix3::identity).symmetric_eigen().eigenvectors;
        let rigid = &rigid;
        (0..3).filter_map(move |k| {
            Load::new(system, rigid, *coupling, settled(axes.column(k).into()))
        })
    });
    watch.unless_stopped()?;
    let mut all = Bracketing::first(system, &factor, loads.collect());
    // The rounds need the room.
    drop(factor);
    if all.is_empty() {
        return Ok(None);
    }
    tighten(&mut all, criteria.play_mm, &limit, rounds, watch)?;
    let top = highest(&all, &limit);
    let demand = |of: fn(&Bracket) -> f64| {
        let each = all.iter().map(|b| of(&b.bracket()) / limit(b.load.coupling));
        each.fold(0.0, f64::max)
    };
    let worst = &all[top];
    Ok(Some(Sway {
        node: system.model.couplings[worst.load.coupling].node,
        direction: worst.load.direction,
        bracket: worst.bracket(),
        limit_mm: limit(worst.load.coupling),
        span_mm: spans[worst.load.coupling],
        demand: Bracket { lower: demand(|b| b.lower), upper: demand(|b| b.upper) },
    }))
}

/// Sway over play at the same node and direction with all bodies of each pin joined by a
/// moment arm of half the pin's length, to compare (docs/formulas.md 1.7). On a whole that
/// floats the best fit counts the ends of these moment arms too. `None` for what is too
/// large to compare.
///
/// # Errors
/// [`Halt`] if a factorisation fails or the watch stops it.
pub(super) fn with_stiff_joints(
    system: &System,
    sway: &Sway,
    watch: &dyn Watch,
) -> Result<Option<Bracket>, Halt> {
    watch.unless_stopped()?;
    let model = system.model.clone().stiff();
    let stiff = System::new(&model, system.fixed, system.threads);
    let rounds = rounds_for_figures(&stiff).min(FEW_ROUNDS);
    let rigid = if stiff.floats { stiff.rigid() } else { Vec::new() };
    let load = model
        .pin(sway.node)
        .and_then(|pin| Load::new(&stiff, &rigid, pin, sway.direction));
    let Some(load) = load.filter(|_| rounds > 0) else { return Ok(None) };
    watch.unless_stopped()?;
    let mut found = Bracketing::first(&stiff, &stiff.factor()?, vec![load]).remove(0);
    for _ in 0..rounds {
        watch.unless_stopped()?;
        if found.bracket().is_narrow() {
            break;
        }
        found.tighten()?;
    }
    let proven = |b: &Bracket| b.upper.is_finite() && b.lower > 0.0 && b.lower <= b.upper;
    Ok(Some(found.bracket()).filter(proven))
}

/// The same direction or its opposite, whichever has its largest entry positive.
fn settled(direction: Vector3) -> Vector3 {
    if direction[direction.iamax()] < 0.0 { -direction } else { direction }
}

/// The bracketing of largest upper bound over limit.
fn highest(all: &[Bracketing], limit: &dyn Fn(usize) -> f64) -> usize {
    let demands: Vec<f64> =
        all.iter().map(|b| b.bracket().upper / limit(b.load.coupling)).collect();
    largest(&demands).unwrap_or(0)
}

/// Where the largest value stands; of those that differ by rounding only, the first.
fn largest(values: &[f64]) -> Option<usize> {
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = largest - SAME_SWAY * largest.abs();
    values.iter().position(|&x| x >= least || x >= largest)
}

/// Tightens until the verdict stands, or what decides it is narrow.
fn tighten(
    all: &mut [Bracketing],
    play: f64,
    limit: &dyn Fn(usize) -> f64,
    rounds: usize,
    watch: &dyn Watch,
) -> Result<(), Halt> {
    for round in 0..MOST_ROUNDS.max(rounds) {
        watch.unless_stopped()?;
        let top = highest(all, limit);
        let sways = |b: &Bracketing| b.bracket().lower * play > limit(b.load.coupling);
        let stands = all[top].bracket().upper * play <= limit(all[top].load.coupling)
            || all.iter().any(sways);
        let narrow = all[top].bracket().is_narrow();
        if narrow || round >= if stands { rounds } else { rounds.max(MOST_ROUNDS) } {
            return Ok(());
        }
        all[top].tighten()?;
    }
    Ok(())
}

/// Where to look: the nodes of largest compliance for their limit, the one that moves most
/// in each of the least resisted motions, and the one farthest from any support.
fn chosen(
    system: &System,
    compliances: &[(usize, Matrix3<f64>)],
    modes: &Modes,
    limit: &dyn Fn(usize) -> f64,
) -> BTreeSet<usize> {
    let most = |of: &dyn Fn(usize) -> f64| {
        let values: Vec<f64> =
            compliances.iter().map(|(coupling, _)| of(*coupling)).collect();
        largest(&values).map(|k| compliances[k].0)
    };
    let mut chosen = BTreeSet::new();
    chosen.extend(most(limit));
    for y in &modes.motions {
        chosen.extend(most(&|k| node_velocity(system, k, y).norm() / limit(k)));
    }
    let mut left: Vec<f64> = compliances
        .iter()
        .map(|(coupling, m)| {
            m.symmetric_eigenvalues().max().max(0.0).sqrt() / limit(*coupling)
        })
        .collect();
    for _ in 0..TOP.min(left.len()) {
        let Some(k) = largest(&left) else { break };
        chosen.insert(compliances[k].0);
        left[k] = f64::NEG_INFINITY;
    }
    chosen
}
