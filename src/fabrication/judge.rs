//! Asking whether what will be built is rigid.

use crate::diagnostic::{Finding, Severity};
use crate::ids::NodeId;
use crate::parts::{self, Plan};
use crate::rigidity::{
    self, Criteria, Cure, FEW_STEPS, MOST_STEPS, Pairing, RigidityFinding, SwayLimit,
    Verdict,
};
use crate::settings::Settings;
use crate::structure::{Draft, Structure};
use crate::template::Template;
use crate::watch::{Stopped, Watch};
use std::collections::BTreeSet;

/// How a structure is built with its settings.
pub fn plan(structure: &Structure, settings: &Settings) -> Plan {
    parts::plan(structure, settings.joint, &settings.hub_nodes, &settings.fit)
}

/// Rounds of remedies at most: hubs have play too, so that what was enough for joints made
/// stiff may want some more.
const ROUNDS: usize = 8;

/// The settings with hubs on as many nodes as it takes to make a structure of hinged fins
/// rigid, the most useful first.
///
/// # Errors
/// [`Stopped`] if the watch stopped the work.
pub fn with_remedies(
    draft: &Draft,
    mut settings: Settings,
    watch: &mut dyn Watch,
) -> Result<Settings, Stopped> {
    let Ok((structure, _)) = Structure::new(draft.clone(), &settings.tolerance) else {
        return Ok(settings);
    };
    // What cannot be asked is said when the job is judged.
    let Ok(criteria) = criteria(&structure, &settings.template) else {
        return Ok(settings);
    };
    for _ in 0..ROUNDS {
        let model = plan(&structure, &settings).model();
        let fingerprint = settings.fingerprint(&structure);
        if rigidity::judge(&model, &criteria, fingerprint, watch)?.passes() {
            break;
        }
        let remedies = rigidity::remedies(&model, &criteria, MOST_STEPS, watch)?;
        let welds = remedies.iter().filter(|remedy| matches!(remedy.cure, Cure::Weld(_)));
        let known = &settings.hub_nodes;
        let new: BTreeSet<NodeId> =
            welds.map(|weld| weld.node).filter(|node| !known.contains(node)).collect();
        if new.is_empty() {
            break;
        }
        settings = settings.with_hubs(new);
    }
    Ok(settings)
}

/// What is asked of a structure: play and limit as the template says, else half the
/// clearance and L/50.
///
/// # Errors
/// A limit that cannot be read.
pub fn criteria(
    structure: &Structure,
    template: &Template,
) -> Result<Criteria, RigidityFinding> {
    let lengths = structure.fins().iter().map(|&fin| structure.length(fin));
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

/// Judges the plan of a structure with its settings.
///
/// # Errors
/// [`Stopped`] if the watch stopped the work.
/// ```
/// use finwright::design::examples;
/// use finwright::fabrication::{criteria, plan, verdict};
/// use finwright::{settings::Settings, structure::Structure, template, tolerance::Tolerance};
///
/// let draft = (examples::named("three").unwrap().draft)();
/// let (structure, _) = Structure::new(draft, &Tolerance::default()).unwrap();
/// let source = template::embedded("pmma-cast-3").unwrap();
/// let settings = Settings::new(template::read(source, "pmma-cast-3").unwrap());
/// let plan = plan(&structure, &settings);
/// let criteria = criteria(&structure, &settings.template).unwrap();
/// assert!(verdict(&plan, &settings, &criteria, &mut ()).unwrap().passes());
/// ```
pub fn verdict(
    plan: &Plan,
    settings: &Settings,
    criteria: &Criteria,
    watch: &mut dyn Watch,
) -> Result<Verdict, Stopped> {
    let model = plan.model();
    let fingerprint = settings.fingerprint(&plan.structure);
    let verdict = rigidity::judge(&model, criteria, fingerprint, watch)?;
    if verdict.passes() || model.bodies.len() > CURABLE {
        return Ok(verdict);
    }
    let remedies = rigidity::remedies(&model, criteria, FEW_STEPS, watch)?;
    Ok(verdict.with_remedies(remedies))
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
