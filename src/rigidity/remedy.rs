//! What would help: joints to make stiff, nodes to hold, fewest first.
//!
//! Greedy, as bracing a grid is a matroid: each step takes the pair of bodies whose turn
//! against each other counts most in the motions that meet no resistance, or, when there
//! are none, in the least resisted ones weighted by their compliance (docs/formulas.md
//! 1.8).

use crate::geometry::Vector3;
use crate::ids::NodeId;
use crate::rigidity::criteria::Criteria;
use crate::rigidity::mobility::mobility;
use crate::rigidity::model::{Model, RigidBody};
use crate::rigidity::motions::Twists;
use crate::rigidity::spectrum::least;
use crate::rigidity::sway::{self, Sway, node_velocity};
use crate::rigidity::system::System;
use crate::sparse::Halt;
use crate::watch::{Stopped, Watch};
use std::collections::BTreeSet;

/// What is done in one step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cure {
    /// Two bodies are made one at a node: by a hub, or glue.
    Weld([usize; 2]),
    /// The node is held by the ground.
    Fix,
}

/// A step of a cure; each is counted on top of those before it of its kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Remedy {
    /// Where.
    pub node: NodeId,
    /// What.
    pub cure: Cure,
    /// Largest amplification afterwards, upper bound; `None` while it is a mechanism.
    pub amplification_after: Option<f64>,
    /// Exact motions left afterwards.
    pub mobility_after: usize,
    /// Whether it passes afterwards.
    pub passes: bool,
}

/// Steps of each kind that say enough where a whole course would take long.
pub const FEW_STEPS: usize = 6;
/// Steps of each kind at most.
pub const MOST_STEPS: usize = 200;
/// Motions that are weighed.
const MODES: usize = 10;

/// Two cures, each to where it passes or `most` steps: by welds, and by holding nodes.
///
/// # Errors
/// [`Stopped`] if the watch stopped the work.
pub fn remedies(
    model: &Model,
    criteria: &Criteria,
    most: usize,
    watch: &mut dyn Watch,
) -> Result<Vec<Remedy>, Stopped> {
    let mut all = course(model, criteria, most, weld, watch)?;
    all.extend(course(model, criteria, most, fix, watch)?);
    Ok(all)
}

/// A motion to resist, as velocities of the unknowns.
struct Resisted {
    weight: f64,
    motion: Vec<f64>,
}

/// A cure and the coupling where it is applied.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Choice {
    coupling: usize,
    cure: Cure,
}

/// Chooses the next cure, none of those taken, from the motions to resist.
type Choose = fn(&System, &[Resisted], &BTreeSet<Choice>) -> Option<Choice>;

fn course(
    model: &Model,
    criteria: &Criteria,
    most: usize,
    choose: Choose,
    watch: &mut dyn Watch,
) -> Result<Vec<Remedy>, Stopped> {
    let threads = watch.threads();
    let mut model = model.clone();
    let mut taken = BTreeSet::new();
    let mut course: Vec<Remedy> = Vec::new();
    while course.len() < most {
        watch.progress("remedies", course.len(), most);
        let system = System::new(&model, None, threads);
        let resisted = match resisted(&system, watch) {
            Err(Halt::Stopped(stopped)) => return Err(stopped),
            Err(Halt::Failed) => break,
            Ok(resisted) => resisted,
        };
        let Some(choice) = choose(&system, &resisted, &taken) else { break };
        drop(system);
        taken.insert(choice);
        let node = model.couplings[choice.coupling].node;
        model = match choice.cure {
            Cure::Weld(bodies) => model.welded(choice.coupling, bodies),
            Cure::Fix => model.with_held(node),
        };
        let remedy = effect(&model, criteria, node, choice.cure, watch)?;
        let passes = remedy.passes;
        course.push(remedy);
        if passes {
            break;
        }
    }
    Ok(course)
}

/// The motions to resist, with their weights.
fn resisted(system: &System, watch: &dyn Watch) -> Result<Vec<Resisted>, Halt> {
    let modes = least(system, MODES, watch)?;
    let exact = mobility(system, &modes, watch)?.motions.into_iter();
    if exact.len() > 0 {
        return Ok(exact.map(|motion| Resisted { weight: 1.0, motion }).collect());
    }
    let weight = |sigma: &f64| 1.0 / (sigma * sigma).max(f64::MIN_POSITIVE);
    let weights = modes.sigma.iter().map(weight);
    let both = weights.zip(modes.motions);
    Ok(both.map(|(weight, motion)| Resisted { weight, motion }).collect())
}

/// What a model does after a step.
fn effect(
    model: &Model,
    criteria: &Criteria,
    node: NodeId,
    cure: Cure,
    watch: &dyn Watch,
) -> Result<Remedy, Stopped> {
    let threads = watch.threads();
    let system = System::new(model, None, threads);
    let mut remedy = Remedy {
        node,
        cure,
        amplification_after: None,
        mobility_after: 0,
        passes: false,
    };
    let mut look = || {
        let modes = least(&system, MODES, watch)?;
        remedy.mobility_after = mobility(&system, &modes, watch)?.count;
        if remedy.mobility_after > 0 {
            return Ok(());
        }
        let sway = sway::worst(&system, &modes, criteria, 0, watch)?;
        let upper = |of: fn(&Sway) -> f64| sway.as_ref().map_or(0.0, of);
        remedy.amplification_after = Some(upper(|sway| sway.bracket.upper));
        remedy.passes = upper(|sway| sway.demand.upper) * criteria.play_mm <= 1.0;
        Ok(())
    };
    // What cannot be solved is no cure.
    if let Err(Halt::Stopped(stopped)) = look() { Err(stopped) } else { Ok(remedy) }
}

/// How fast a body turns in a motion of the pins.
fn turning(
    system: &System,
    body: usize,
    twists: &Twists,
    y: &[f64],
    values: &mut Vec<f64>,
) -> Vector3 {
    system.gather(body, y, values);
    let shares = system.motions[body].shares(values);
    let turns = twists.iter().zip(shares);
    turns.map(|(t, share)| Vector3::new(t[0], t[1], t[2]) * share).sum()
}

fn weld(
    system: &System,
    resisted: &[Resisted],
    taken: &BTreeSet<Choice>,
) -> Option<Choice> {
    let twists = system.twists();
    let mut values = Vec::new();
    let mut turns = |resisted: &Resisted| -> Vec<Vector3> {
        let bodies = twists.iter().enumerate();
        bodies
            .map(|(body, twists)| {
                turning(system, body, twists, &resisted.motion, &mut values)
            })
            .collect()
    };
    let turns: Vec<Vec<Vector3>> = resisted.iter().map(&mut turns).collect();
    let mut best: Option<(f64, Choice)> = None;
    let couplings = system.model.couplings.iter().enumerate();
    for (coupling, pin) in couplings.filter(|(_, coupling)| coupling.is_pin()) {
        let axis = pin.points[1] - pin.points[0];
        for (i, &a) in pin.bodies.iter().enumerate() {
            for &b in &pin.bodies[i + 1..] {
                let choice = Choice { coupling, cure: Cure::Weld([a, b]) };
                let each = resisted.iter().zip(&turns);
                let gain = each.map(|(resisted, turns)| {
                    resisted.weight * (turns[a] - turns[b]).dot(&axis).powi(2)
                });
                let gain: f64 = gain.sum();
                if best.is_none_or(|(most, _)| gain > most) && !taken.contains(&choice) {
                    best = Some((gain, choice));
                }
            }
        }
    }
    best.filter(|(gain, _)| *gain > 0.0).map(|(_, choice)| choice)
}

fn fix(
    system: &System,
    resisted: &[Resisted],
    taken: &BTreeSet<Choice>,
) -> Option<Choice> {
    let couplings = system.model.couplings.iter().enumerate();
    let free =
        couplings.filter(|(k, pin)| pin.is_pin() && system.coupling_at[*k].is_some());
    let choices = free.map(|(coupling, _)| Choice { coupling, cure: Cure::Fix });
    let gain = |choice: &Choice| -> f64 {
        let speed = |y: &[f64]| node_velocity(system, choice.coupling, y).norm_squared();
        resisted.iter().map(|one| one.weight * speed(&one.motion)).sum()
    };
    let gains = choices.filter(|choice| !taken.contains(choice)).map(|c| (gain(&c), c));
    let best = gains.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))?;
    Some(best.1)
}

/// Remedies as lines of text: how many steps of each kind it takes, and the first of them.
pub(super) fn in_words(remedies: &[Remedy], bodies: &[RigidBody]) -> Vec<String> {
    let kind = |fix: bool| {
        let steps = remedies.iter().filter(move |r| (r.cure == Cure::Fix) == fix);
        steps.collect::<Vec<_>>()
    };
    let mut lines = Vec::new();
    for (steps, what) in [(kind(false), "joints made stiff"), (kind(true), "nodes held")]
    {
        let Some(last) = steps.last() else { continue };
        let end = if last.passes { "it is rigid" } else { "it is not rigid yet" };
        lines.push(format!("with {} {what} {end}:", steps.len()));
        lines.extend(steps.iter().take(SAID).map(|step| said(step, bodies)));
        if steps.len() > SAID {
            lines.push(format!(
                "  ... and {} more (--json lists all)",
                steps.len() - SAID
            ));
        }
    }
    lines
}

/// Steps that are written out.
const SAID: usize = 8;

fn said(step: &Remedy, bodies: &[RigidBody]) -> String {
    let node = step.node;
    let what = match step.cure {
        Cure::Weld([a, b]) => {
            let [a, b] = [a, b].map(|body| bodies[body]);
            format!("join {a} and {b} at node {node} stiffly")
        }
        Cure::Fix => format!("hold node {node}"),
    };
    match step.amplification_after {
        Some(sway) => format!("  {what}: {sway:.1} mm of sway per mm of play"),
        None => format!("  {what}: {} motions left", step.mobility_after),
    }
}
