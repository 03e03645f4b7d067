//! The steps of assembly in words.

use crate::job::Job;
use crate::parts::{Body, Opening, insertion};
use crate::template::Template;

/// One part that goes in.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Step {
    /// Index of the part.
    pub part: usize,
    /// Nodes where it goes onto parts that stand, in order along it.
    pub onto: Vec<(usize, String)>,
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
pub(super) fn standing(job: &Job, steps: &[Step], k: usize) -> Vec<usize> {
    let fins = job.structure.as_ref().map_or(0, |structure| structure.fins().len());
    let all = fins * steps.len() / 2 <= ALL_SHOWN;
    let onto =
        |part: &usize| steps[k].onto.iter().any(|(_, id)| *id == job.parts[*part].id);
    let before = steps[..k].iter().map(|step| step.part);
    before.filter(|part| all || onto(part)).collect()
}

/// The steps in order: one per part of the structure.
pub(super) fn steps(job: &Job, template: &Template) -> Vec<Step> {
    (0..job.parts.len()).filter_map(|part| step(job, part, template)).collect()
}

fn step(job: &Job, part: usize, template: &Template) -> Option<Step> {
    let Body::Strip(body) = &job.parts[part].body else { return None };
    let onto = body.slits.iter().filter(|(slit, _)| slit.from == Opening::Bottom);
    let onto: Vec<(usize, String)> =
        onto.map(|(slit, partner)| (slit.node, partner.clone())).collect();
    let material = &template.material;
    let way = insertion(job.structure.as_ref()?, body, material.clearance_mm);
    let ratio = |radius: f64| radius / material.thickness_mm;
    let bend = way.and_then(|way| way.bend);
    let is_tight = bend.is_some_and(|(radius, _)| ratio(radius) < template.bend.model);
    let words = match (way, bend) {
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
    Some(Step { part, onto, words, is_tight })
}
