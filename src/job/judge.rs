//! Asking whether what will be built is rigid.

use crate::diagnostic::{Finding, Severity};
use crate::job::Interrupted;
use crate::joint::Joint;
use crate::parts;
use crate::rigidity::{
    self, Criteria, Cure, FEW_STEPS, Fingerprint, MOST_STEPS, Model, Pairing,
    RigidityFinding, Stopped, SwayLimit, Verdict,
};
use crate::setting::{fit, tolerance};
use crate::structure::{Draft, Structure};
use crate::template::Template;
use crate::watch::Watch;
use std::collections::BTreeSet;

/// What a structure is as a mechanism, the structure with its strips as they will be cut,
/// and what is judged.
pub fn model(
    structure: &Structure,
    joint: Joint,
    template: &Template,
) -> (Model, Structure, Fingerprint) {
    let fingerprint = |structure| Fingerprint::of(structure, joint, &template.source);
    match joint {
        Joint::Lap => {
            let asked = &template.joint.hub_nodes;
            let lapped = parts::lapped(structure, asked, &fit(template));
            let parts::Lapped { structure, unheld, levers } = lapped;
            let fingerprint = fingerprint(&structure);
            (Model::of_strips(&structure, &unheld, &levers), structure, fingerprint)
        }
        Joint::Hinge | Joint::Hub => {
            let levers = parts::levers(
                structure,
                &|node| has_hub(joint, template, node),
                &fit(template),
            );
            let model = Model::of_fins(structure, &levers);
            (model, structure.clone(), fingerprint(structure))
        }
    }
}

/// Rounds of remedies at most: hubs have play too, so that what was enough for joints made
/// stiff may want some more.
const ROUNDS: usize = 8;

/// The template with hubs on as many nodes as it takes to make a structure of hinged fins
/// rigid, the most useful first.
///
/// # Errors
/// [`Interrupted`] if the watch stopped the work.
pub fn with_remedies(
    draft: &Draft,
    mut template: Template,
    watch: &mut dyn Watch,
) -> Result<Template, Interrupted> {
    let Ok((structure, _)) = Structure::new(draft.clone(), &tolerance(&template)) else {
        return Ok(template);
    };
    // What cannot be asked is said when the job is judged.
    let Ok(criteria) = criteria(&structure, &template) else { return Ok(template) };
    for _ in 0..ROUNDS {
        let (model, _, fingerprint) = model(&structure, Joint::Hinge, &template);
        let verdict = rigidity::judge(&model, &criteria, fingerprint, watch);
        if verdict.map_err(|Stopped| Interrupted)?.passes() {
            break;
        }
        let remedies = rigidity::remedies(&model, &criteria, MOST_STEPS, watch);
        let remedies = remedies.map_err(|Stopped| Interrupted)?;
        let welds = remedies.iter().filter(|remedy| matches!(remedy.cure, Cure::Weld(_)));
        let known = &template.joint.hub_nodes;
        let new: BTreeSet<usize> =
            welds.map(|weld| weld.node).filter(|node| !known.contains(node)).collect();
        if new.is_empty() {
            break;
        }
        template = template.with_hub_nodes(&new.into_iter().collect::<Vec<_>>());
    }
    Ok(template)
}

/// Whether single fins meet in a hub at a node; else they hang on a rod.
pub(super) fn has_hub(joint: Joint, template: &Template, node: usize) -> bool {
    joint == Joint::Hub || template.joint.hub_nodes.contains(&node)
}

/// What is asked about a structure: play and limit as the template says, else half the
/// clearance and L/50.
///
/// # Errors
/// A limit that cannot be read.
pub fn criteria(
    structure: &Structure,
    template: &Template,
) -> Result<Criteria, RigidityFinding> {
    let lengths = structure.fins().iter().map(|&[i, j]| {
        (structure.nodes()[i].position - structure.nodes()[j].position).norm()
    });
    let mean = lengths.sum::<f64>() / structure.fins().len().max(1) as f64;
    let play = template.gate.play_mm.unwrap_or(template.material.clearance_mm / 2.0);
    Ok(Criteria {
        play_mm: play.max(0.0),
        limit: template.gate.sway_limit.parse::<SwayLimit>()?,
        modes: 6,
        pairing: Pairing::Pin,
        scale: 1000.0 / mean,
    })
}

/// Up to this many bodies a refusal comes with the first steps of what would help.
const CURABLE: usize = 2000;

/// Judges a structure with a joint; the criteria are the template's unless one is given.
///
/// # Errors
/// A limit that cannot be read; within, [`Stopped`] if the watch stopped the work.
pub fn verdict(
    structure: &Structure,
    joint: Joint,
    (template, asked): (&Template, Option<&Criteria>),
    watch: &mut dyn Watch,
) -> Result<Result<Verdict, Stopped>, RigidityFinding> {
    let criteria = match asked {
        Some(criteria) => *criteria,
        None => criteria(structure, template)?,
    };
    let (model, _, fingerprint) = model(structure, joint, template);
    let verdict = rigidity::judge(&model, &criteria, fingerprint, watch);
    Ok(verdict.and_then(|verdict| {
        if verdict.passes() || model.bodies.len() > CURABLE {
            return Ok(verdict);
        }
        let remedies = rigidity::remedies(&model, &criteria, FEW_STEPS, watch)?;
        Ok(verdict.with_remedies(remedies))
    }))
}

/// Findings of a verdict; what is accepted becomes a warning.
pub(super) fn judged(verdict: &Verdict, accepted: Option<&str>) -> Vec<Finding> {
    let mut findings: Vec<Finding> =
        verdict.findings().into_iter().map(Finding::from).collect();
    let reason = accepted.filter(|reason| !reason.trim().is_empty());
    let refuses = !crate::diagnostic::passes(&findings);
    if let (Some(reason), true) = (reason, refuses) {
        for finding in &mut findings {
            finding.severity = finding.severity.min(Severity::Warning);
        }
        let (verdict, reason) = (verdict.outcome().name(), reason.to_owned());
        findings.push(RigidityFinding::Accepted { verdict, reason }.into());
    }
    findings
}
