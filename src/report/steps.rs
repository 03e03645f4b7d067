//! The steps of assembly in words.

use crate::fabrication::Fabrication;
use crate::ids::{NodeId, PartId};
use crate::parts::{Body, ConnectorBody, Opening, insertion};
use crate::template::Template;
use std::collections::BTreeSet;

/// One part of a strip that goes in, or a connector with the fins that are new at it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Step {
    /// The parts that go in.
    pub parts: Vec<PartId>,
    /// Nodes where it goes onto parts that stand, in order along it.
    pub onto: Vec<(NodeId, String)>,
    /// What to do.
    pub words: String,
    /// Whether it bends more tightly on the way than a model should.
    pub is_tight: bool,
}

/// Up to so many fins in the pictures of all steps together each shows all that stands;
/// beyond it the report would be mostly pictures.
const ALL_SHOWN: usize = 100_000;

/// The parts that stand before a step, as far as its picture shows them: those it goes
/// onto, and where that is not too much all others.
pub(super) fn standing(job: &Fabrication, steps: &[Step], k: usize) -> Vec<PartId> {
    let fins = job.structure.as_ref().map_or(0, |structure| structure.fins().len());
    let all = fins * steps.len() / 2 <= ALL_SHOWN;
    let onto =
        |part: &PartId| steps[k].onto.iter().any(|(_, id)| *id == job.parts[*part].id);
    let before = steps[..k].iter().flat_map(|step| step.parts.iter().copied());
    before.filter(|part| all || onto(part)).collect()
}

fn step(job: &Fabrication, part: PartId, template: &Template) -> Option<Step> {
    let Body::Strip(body) = &job.parts[part].body else { return None };
    let onto = body.slits.iter().filter(|(slit, _)| slit.from == Opening::Bottom);
    let onto: Vec<(NodeId, String)> =
        onto.map(|(slit, partner)| (slit.node, partner.clone())).collect();
    let material = &template.material;
    let way = insertion(job.structure.as_ref()?, body, material.clearance_mm);
    let ratio = |radius: f64| radius / material.thickness_mm;
    let bend = way.and_then(|way| way.bend);
    let is_tight = bend.is_some_and(|(radius, _)| ratio(radius) < template.bend.model);
    let words = match (way, bend) {
        (None, _) if body.slits.is_empty() => {
            "Set its ends into the windows of their discs.".to_owned()
        }
        (None, _) => "Stand it in its place; its open slits look up.".to_owned(),
        (Some(way), _) if way.is_rigid => {
            "Push it straight down; all its slits slide at once.".to_owned()
        }
        (Some(_), Some((radius, node))) => format!(
            "Zip it in from one end, node after node. It gives way most after node {node}: \
             to a radius of {radius:.0} mm, {:.0} times the thickness.",
            ratio(radius)
        ),
        (Some(_), None) => "Zip it in from one end, node after node.".to_owned(),
    };
    Some(Step { parts: vec![part], onto, words, is_tight })
}

/// The steps in order: one per strip and one per connector, which ends with the last of its
/// plates; the fins that came since the step before go in with it.
pub(super) fn steps(job: &Fabrication, template: &Template) -> Vec<Step> {
    let mut steps = Vec::new();
    let mut new: Vec<PartId> = Vec::new();
    let strips = job.has(|body| matches!(body, Body::Strip(_)));
    let (mut laid, mut below) = (BTreeSet::new(), Vec::new());
    for (k, &crate::parts::Step { part, copies }) in job.steps.iter().enumerate() {
        let made = &job.parts[part];
        let alone = || job.steps.get(k + 1).is_some_and(|next| next.part != part);
        match &made.body {
            Body::Strip(_) => {
                let below = std::mem::take(&mut below);
                steps.extend(
                    step(job, part, template).map(|step| onto_discs(step, &below)),
                );
            }
            Body::Fin(_) => new.push(part),
            Body::Connector(body) if copies[1] == made.quantity => {
                let words = match strips {
                    true => Some(held(&made.id, laid.contains(&part))),
                    false => None,
                };
                steps.push(connected(job, part, (body, words), std::mem::take(&mut new)));
            }
            Body::Connector(_) if strips && alone() => {
                laid.insert(part);
                below.push(made.id.as_str());
            }
            Body::Connector(_) | Body::Coupon => {}
        }
    }
    // Fins that no connector finishes stand by themselves.
    let loose = (!new.is_empty()).then(|| Step {
        parts: new,
        onto: Vec::new(),
        words: "Stand them in their places.".to_owned(),
        is_tight: false,
    });
    steps.into_iter().chain(loose).collect()
}

/// A connector with the fins that are new at it.
fn connected(
    job: &Fabrication,
    part: PartId,
    (body, words): (&ConnectorBody, Option<String>),
    new: Vec<PartId>,
) -> Step {
    let fins: Vec<String> = new.iter().map(|&fin| job.parts[fin].id.clone()).collect();
    let stand = body.fins.iter().filter(|id| !fins.contains(id));
    let mut onto: Vec<(NodeId, String)> =
        stand.map(|id| (body.node(), id.clone())).collect();
    // A ring comes there with both its ends.
    let mut told = BTreeSet::new();
    onto.retain(|(_, id)| told.insert(id.clone()));
    let words = words.unwrap_or_else(|| self::words(body, &fins));
    let parts = std::iter::once(part).chain(new).collect();
    Step { parts, onto, words, is_tight: false }
}

/// The step of a strip that no slit holds; it begins with the lower discs at its ends.
fn onto_discs(step: Step, below: &[&str]) -> Step {
    let words = match below {
        [] => step.words,
        discs => format!(
            "First one disc {} in its place, letters up, for the ends that nothing else holds. {}",
            discs.join(" and one disc "),
            step.words
        ),
    };
    Step { words, ..step }
}

/// Discs at the ends of strips.
fn held(id: &str, is_laid: bool) -> String {
    let how = match is_laid {
        true => format!("Push the other disc {id} on from above"),
        false => format!("Push one disc {id} on from below and one from above"),
    };
    format!("{how}, letters up, over the ends as they are lettered, and bolt the rod.")
}

fn words(body: &ConnectorBody, fins: &[String]) -> String {
    match fins {
        [] => body.words.clone(),
        fins => format!("New: {}. {}", fins.join(", "), body.words),
    }
}
