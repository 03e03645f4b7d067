//! What would help: joints to make stiff, nodes to hold, fewest first.
//!
//! Greedy, as bracing a grid is a matroid: each step takes the pair of bodies whose turn
//! against each other counts most in the motions that meet no resistance, or, when there
//! are none, in the least resisted ones weighted by their compliance (notes §3.5).

use crate::geometry::Vector3;
use crate::rigidity::mobility::mobility;
use crate::rigidity::model::{Body, Model};
use crate::rigidity::motions::Twists;
use crate::rigidity::spectrum::least;
use crate::rigidity::sway::{self, Sway, node_velocity};
use crate::rigidity::system::System;
use crate::rigidity::verdict::{Question, Stopped};
use crate::sparse::Halt;
use crate::watch::Watch;
use std::collections::BTreeSet;

/// What is done in one step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
    pub node: usize,
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
    question: &Question,
    most: usize,
    watch: &mut dyn Watch,
) -> Result<Vec<Remedy>, Stopped> {
    let mut all = course(model, (question, most), &weld, watch)?;
    all.extend(course(model, (question, most), &fix, watch)?);
    Ok(all)
}

/// A choice of the next step from motions with weights, and the model after it.
type Step =
    dyn Fn(&System, &[(f64, Vec<f64>)], &BTreeSet<Choice>) -> Option<(Choice, Model)>;

/// A knot, and the bodies to weld there.
type Choice = (usize, Option<[usize; 2]>);

fn course(
    model: &Model,
    (question, most): (&Question, usize),
    step: &Step,
    watch: &mut dyn Watch,
) -> Result<Vec<Remedy>, Stopped> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut model = model.clone();
    let mut taken = BTreeSet::new();
    let mut course: Vec<Remedy> = Vec::new();
    while course.len() < most {
        watch.progress("remedies", course.len(), most);
        let motions = match weighed(&System::new(&model, None, threads), watch) {
            Err(Halt::Stopped) => return Err(Stopped),
            Err(Halt::Failed) => break,
            Ok(motions) => motions,
        };
        let system = System::new(&model, None, threads);
        let Some((choice, better)) = step(&system, &motions, &taken) else { break };
        drop(system);
        taken.insert(choice);
        let node = better.knots[choice.0].node;
        let cure = choice.1.map_or(Cure::Fix, Cure::Weld);
        let remedy = effect(&better, question, (node, cure), watch)?;
        let passes = remedy.passes;
        course.push(remedy);
        if passes {
            break;
        }
        model = better;
    }
    Ok(course)
}

/// The motions to resist, with their weights.
fn weighed(system: &System, watch: &dyn Watch) -> Result<Vec<(f64, Vec<f64>)>, Halt> {
    let modes = least(system, MODES, watch)?;
    let exact = mobility(system, &modes, watch)?;
    if !exact.motions.is_empty() {
        return Ok(exact.motions.into_iter().map(|y| (1.0, y)).collect());
    }
    let weight = |sigma: &f64| 1.0 / (sigma * sigma).max(f64::MIN_POSITIVE);
    Ok(modes.sigma.iter().map(weight).zip(modes.motions).collect())
}

/// What a model does after a step.
fn effect(
    model: &Model,
    question: &Question,
    (node, cure): (usize, Cure),
    watch: &dyn Watch,
) -> Result<Remedy, Stopped> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
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
        let asked = (question.play_mm, question.limit, 0);
        let sway = sway::worst(&system, &modes, asked, watch)?;
        let upper = |of: fn(&Sway) -> f64| sway.as_ref().map_or(0.0, of);
        remedy.amplification_after = Some(upper(|sway| sway.bracket.upper));
        remedy.passes = upper(|sway| sway.demand.upper) * question.play_mm <= 1.0;
        Ok(())
    };
    // What cannot be solved is no cure.
    if let Err(Halt::Stopped) = look() { Err(Stopped) } else { Ok(remedy) }
}

/// How fast a body turns in a motion of the pins.
fn turning(
    system: &System,
    (body, twists): (usize, &Twists),
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
    motions: &[(f64, Vec<f64>)],
    taken: &BTreeSet<Choice>,
) -> Option<(Choice, Model)> {
    let model = system.model;
    let twists = system.twists();
    let mut values = Vec::new();
    let turns: Vec<Vec<Vector3>> = motions
        .iter()
        .map(|(_, y)| {
            let bodies = twists.iter().enumerate();
            bodies.map(|body| turning(system, body, y, &mut values)).collect()
        })
        .collect();
    let mut best: Option<(f64, Choice)> = None;
    for (k, knot) in model.knots.iter().enumerate().filter(|(_, knot)| knot.is_pin()) {
        let axis = knot.points[1] - knot.points[0];
        for (i, &a) in knot.bodies.iter().enumerate() {
            for &b in &knot.bodies[i + 1..] {
                let choice = (k, Some([a, b]));
                let each = motions.iter().zip(&turns);
                let gain = |((weight, _), turns): ((&f64, ()), &Vec<Vector3>)| {
                    weight * (turns[a] - turns[b]).dot(&axis).powi(2)
                };
                let gain: f64 = each.map(|((w, _), t)| gain(((w, ()), t))).sum();
                if best.is_none_or(|(most, _)| gain > most) && !taken.contains(&choice) {
                    best = Some((gain, choice));
                }
            }
        }
    }
    let (gain, choice) = best?;
    let (pin, bodies) = (choice.0, choice.1?);
    (gain > 0.0).then(|| (choice, model.clone().welded(pin, bodies)))
}

fn fix(
    system: &System,
    motions: &[(f64, Vec<f64>)],
    taken: &BTreeSet<Choice>,
) -> Option<(Choice, Model)> {
    let model = system.model;
    let free = |k: &usize| model.knots[*k].is_pin() && system.knot_at[*k].is_some();
    let free =
        (0..model.knots.len()).filter(free).filter(|k| !taken.contains(&(*k, None)));
    let gain = |knot: usize| -> f64 {
        let each = motions.iter();
        each.map(|(w, y)| w * node_velocity(system, knot, y).norm_squared()).sum()
    };
    let gains = free.map(|knot| (gain(knot), knot));
    let best = gains.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))?;
    let node = model.knots[best.1].node;
    Some(((best.1, None), model.clone().with_held(node)))
}

/// Remedies as lines of text: how many steps of each kind it takes, and the first of them.
pub(super) fn in_words(remedies: &[Remedy], bodies: &[Body]) -> Vec<String> {
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

fn said(step: &Remedy, bodies: &[Body]) -> String {
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
