//! `finwright rigidity`: the verdict on its own.

use crate::cli::console::{Console, Terminal};
use crate::cli::flags::may_have_hubs;
use crate::cli::flags::rigidity::RigidityArgs;
use crate::cli::flags::structure::InputArgs;
use crate::cli::input;
use crate::cli::jobdir::JobDirError;
use crate::cli::outcome::{End, Failure, check_json, complain, print};
use crate::diagnostic::Finding;
use crate::fabrication;
use crate::joint::Joint;
use crate::json;
use crate::rigidity::{
    self, Criteria, Fingerprint, Look, MOST_PAIRED, MOST_STEPS, Model, Pairing,
    RigidityFinding, SwayLimit, Verdict,
};
use crate::structure::{Structure, blame_gaps};
use crate::watch::{Stopped, Watch};
use std::path::Path;

/// What is judged, and what was found before that.
struct Case {
    model: Model,
    fingerprint: Fingerprint,
    criteria: Criteria,
    findings: Vec<Finding>,
    joint: Option<Joint>,
    structure: Option<Structure>,
}

/// Runs `rigidity`.
pub(super) fn run(args: &RigidityArgs, console: Console) -> Result<End, Failure> {
    may_have_hubs(&args.input, false);
    let case = match &args.linkage {
        Some(path) => linkage(path, args.input.json),
        None => structure(&args.input),
    };
    let mut case = match case? {
        Ok(case) => case,
        Err(findings) => {
            console.findings(&findings);
            console.say("refused: there is nothing to judge");
            if args.input.json {
                print(&format!("{}\n", check_json(&findings)));
            }
            return Ok(End::Refused);
        }
    };
    args.amend(&mut case.criteria);
    if let Some(fact) = args.too_many_pairs(case.model.bodies.len()) {
        let said = fact.to_string();
        let findings = || vec![Finding::from(fact.clone())];
        return Ok(complain(&fact, &said, args.input.json.then(findings)));
    }
    let mut terminal = Terminal::new(console, None);
    let verdict = args.verdict(&case, &mut terminal);
    terminal.finish();
    let verdict = verdict?;
    case.findings.extend(verdict.findings().into_iter().map(Finding::from));
    blame_gaps(&mut case.findings);
    console.findings(&case.findings);
    if args.input.json {
        print(&json::line(&verdict.entry(case.joint, true)).map_err(Failure::of)?);
    }
    if let Some(path) = &args.picture {
        args.draw(path, &case.model, case.structure.as_ref(), &verdict)?;
    }
    say(&verdict, &case.model, console);
    Ok(if verdict.passes() { End::of(&case.findings) } else { End::Refused })
}

impl RigidityArgs {
    fn verdict(&self, case: &Case, watch: &mut dyn Watch) -> Result<Verdict, Stopped> {
        let (model, criteria) = (&case.model, &case.criteria);
        let verdict = rigidity::judge(model, criteria, case.fingerprint.clone(), watch)?;
        if !self.remedies {
            return Ok(verdict);
        }
        let remedies = rigidity::remedies(model, criteria, MOST_STEPS, watch)?;
        Ok(verdict.with_remedies(remedies))
    }

    fn draw(
        &self,
        path: &Path,
        model: &Model,
        structure: Option<&Structure>,
        verdict: &Verdict,
    ) -> Result<(), Failure> {
        let look = Look {
            from: [self.view.around.to_radians(), self.view.up.to_radians()],
            motion: usize::from(self.picture_mode) - 1,
            red: self.red,
            ..Look::default()
        };
        let drawn = structure.zip(verdict.paper());
        let drawn = drawn.map(|(s, paper)| rigidity::picture(s, model, paper, &look));
        let Some(bytes) = drawn.transpose().map_err(Failure::of)?.flatten() else {
            return Ok(());
        };
        std::fs::write(path, bytes)
            .map_err(|source| JobDirError::Disk { path: path.to_owned(), source }.into())
    }

    fn too_many_pairs(&self, bodies: usize) -> Option<RigidityFinding> {
        let pairing = self.pairing.name();
        (self.pairing != Pairing::Pin && bodies > MOST_PAIRED).then_some(
            RigidityFinding::PairingTooLarge { bodies, pairing, most: MOST_PAIRED },
        )
    }

    fn amend(&self, criteria: &mut Criteria) {
        criteria.modes = usize::from(self.modes);
        criteria.pairing = self.pairing;
        criteria.play_mm = self.play.unwrap_or(criteria.play_mm);
        criteria.limit = self.sway_limit.unwrap_or(criteria.limit);
    }
}

fn linkage(path: &Path, json: bool) -> Result<Result<Case, Vec<Finding>>, Failure> {
    let text = input::text_of(path)?;
    let model = match rigidity::read_linkage(&text) {
        Ok(model) => model,
        Err(facts) => {
            let findings = || facts.iter().cloned().map(Finding::from).collect();
            let mut json = json.then(findings);
            for fact in &facts {
                complain(fact, &format!("{}: {fact}", path.display()), json.take());
            }
            return Err(Failure::Said(End::CouldNotRun));
        }
    };
    let criteria = Criteria {
        play_mm: 0.0,
        limit: SwayLimit::Share(1.0 / 50.0),
        modes: 6,
        pairing: Pairing::Pin,
        scale: 1.0,
    };
    let fingerprint = Fingerprint::of_nothing();
    Ok(Ok(Case {
        model,
        fingerprint,
        criteria,
        findings: Vec::new(),
        joint: None,
        structure: None,
    }))
}

fn structure(args: &InputArgs) -> Result<Result<Case, Vec<Finding>>, Failure> {
    let settings = input::settings(args)?;
    let input = input::structure(args)?;
    let mut findings = input.findings;
    let structure = match Structure::new(input.draft, &settings.tolerance) {
        Ok((structure, found)) => {
            findings.extend(found);
            structure
        }
        Err(refused) => {
            findings.extend(refused.findings);
            return Ok(Err(findings));
        }
    };
    // Faults of shape do not keep anybody from asking whether it is rigid.
    findings.retain(|f| f.severity != crate::diagnostic::Severity::Error);
    let criteria = match fabrication::criteria(&structure, &settings.template) {
        Ok(criteria) => criteria,
        Err(fact) => return Ok(Err(vec![fact.into()])),
    };
    let plan = fabrication::plan(&structure, &settings);
    let (model, structure) = (plan.model(), plan.structure);
    let fingerprint = settings.fingerprint(&structure);
    let (joint, structure) = (Some(args.joint), Some(structure));
    Ok(Ok(Case { model, fingerprint, criteria, findings, joint, structure }))
}

/// The verdict and the cures in words.
fn say(verdict: &Verdict, model: &Model, console: Console) {
    console.say(&format!(
        "{} bodies, {} pins, mobility {}",
        model.bodies.len(),
        model.pins(),
        verdict
            .mobility()
            .map_or_else(|| "unknown".to_owned(), |count| count.to_string())
    ));
    console.say(&verdict.summary());
    for line in verdict.stiff_in_words().into_iter().chain(verdict.remedies_in_words()) {
        console.say(&line);
    }
}
