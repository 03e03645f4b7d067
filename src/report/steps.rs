//! The steps of assembly in words.

use crate::job::Job;
use crate::parts::{Body, Connector, Opening, Part, insertion};
use crate::template::Template;

/// One part of a strip that goes in, or a connector with the fins that are new at it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Step {
    /// Indices of the parts that go in.
    pub parts: Vec<usize>,
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
    let before = steps[..k].iter().flat_map(|step| step.parts.iter().copied());
    before.filter(|part| all || onto(part)).collect()
}

/// The steps in order: one per strip, or one per connector.
pub(super) fn steps(job: &Job, template: &Template) -> Vec<Step> {
    if !job.steps.is_empty() {
        return connected(job);
    }
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
    Some(Step { parts: vec![part], onto, words, is_tight })
}

/// A step ends with the connector that gets its last fin; the fins that came since the step
/// before go in with it.
fn connected(job: &Job) -> Vec<Step> {
    let mut steps = Vec::new();
    let mut new: Vec<usize> = Vec::new();
    for &crate::parts::Step { part, copies } in &job.steps {
        let made = &job.parts[part];
        match &made.body {
            Body::Fin(_) => new.push(part),
            Body::Connector(body) if copies[1] == made.quantity => {
                let fins = new.iter().map(|&fin| job.parts[fin].id.clone());
                let words = words(made, &fins.collect::<Vec<_>>(), &body.connector);
                let stand = body
                    .fins
                    .iter()
                    .filter(|id| new.iter().all(|&k| job.parts[k].id != **id));
                let onto = stand.map(|id| (body.node(), id.clone())).collect();
                let parts = std::iter::once(part).chain(new.drain(..)).collect();
                steps.push(Step { parts, onto, words, is_tight: false });
            }
            _ => {}
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

fn words(connector: &Part, fins: &[String], kind: &Connector) -> String {
    let new = match fins {
        [] => String::new(),
        fins => format!("New: {}. ", fins.join(", ")),
    };
    let id = &connector.id;
    match kind {
        Connector::Hub(_) => format!(
            "{new}One disc {id} lies below, its letters up: set the fins into its windows as they \
             are lettered, push the other disc on from above, its letters up too, and bolt the rod."
        ),
        Connector::Hinge(_) => format!(
            "{new}Push plates {id} into the end slits of the fins and glue them; lay the fins \
             about the node in the order of job.json and slide the rod through all eyes."
        ),
    }
}
