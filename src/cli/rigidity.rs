//! `finwright rigidity`: the verdict on its own.

use crate::cli::args::InputArgs;
use crate::cli::input;
use crate::cli::jobdir::JobDirError;
use crate::cli::joint;
use crate::cli::run::{End, Failure, check_json, complain, print};
use crate::cli::show::{Terminal, Voice};
use crate::diagnostic::{Finding, passes};
use crate::job;
use crate::joint::Joint;
use crate::rigidity::{
    self, Criteria, Fingerprint, Look, MOST_PAIRED, MOST_STEPS, Model, Pairing,
    RigidityFinding, Stopped, SwayLimit, Verdict,
};
use crate::setting;
use crate::structure::Structure;
use crate::watch::Watch;
use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// Worked examples.
pub(super) const HELP: &str = "\
Examples:
  finwright rigidity --joint hinge --fix lowest --remedies
      is the embedded vault rigid as single fins on rods, and if not, what would help
  finwright rigidity roof.json --play 0.1 --sway-limit L/100 --json
      with 0.1 mm of play at every joint and a hundredth of the span as limit";

/// Arguments of `rigidity`.
#[derive(Debug, Args)]
pub struct RigidityArgs {
    /// What to judge.
    #[command(flatten)]
    pub input: InputArgs,

    /// How many of the least resisted motions to list
    #[arg(long, default_value_t = 6, value_name = "K",
          value_parser = clap::value_parser!(u16).range(1..=200))]
    pub modes: u16,

    /// How far a sleeve may leave its pin, mm [default: half the template's clearance]
    #[arg(long, value_name = "MM", value_parser = play)]
    pub play: Option<f64>,

    /// What a node may sway: mm, or L/N of the distance to the nearest support [default: as
    /// the template says, L/50]
    #[arg(long, value_name = "MM|L/N", value_parser = limit)]
    pub sway_limit: Option<SwayLimit>,

    /// Which bodies on one axis the paper's matrix compares
    #[arg(long, value_enum, default_value = "pin")]
    pub pairing: Pairing,

    /// Bodies and pins from a JSON file instead of a structure
    #[arg(long, value_name = "FILE", conflicts_with = "structure")]
    pub linkage: Option<PathBuf>,

    /// Draw the least resisted motion, fins coloured by the discrepancy of their hinges
    #[arg(long, value_name = "FILE.png", conflicts_with = "linkage")]
    pub picture: Option<PathBuf>,

    /// Which of the least resisted motions to draw, the first is 1
    #[arg(long, default_value_t = 1, value_name = "N",
          value_parser = clap::value_parser!(u16).range(1..=200))]
    pub picture_mode: u16,

    /// From where to look at it, degrees around and up
    #[arg(long, default_value = "-63,32", value_name = "AROUND,UP", value_parser = view,
          allow_hyphen_values = true)]
    pub view: View,

    /// The discrepancy to draw in full red [default: the largest there is]
    #[arg(long, value_name = "D", value_parser = play)]
    pub red: Option<f64>,

    /// Say which joints to make stiff or which nodes to hold, fewest first
    #[arg(long)]
    pub remedies: bool,
}

/// From where a structure is looked at, degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    around: f64,
    up: f64,
}

fn view(text: &str) -> Result<View, String> {
    let numbers: Option<Vec<f64>> =
        text.split(',').map(|word| word.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[around, up]) if around.is_finite() && up.is_finite() => {
            Ok(View { around, up })
        }
        _ => Err(format!("{text:?} is no view; write -63,32")),
    }
}

impl ValueEnum for Pairing {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Pin, Self::Chain, Self::Star, Self::Cyclic, Self::All]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()))
    }
}

fn play(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(play) if play.is_finite() && play >= 0.0 => Ok(play),
        _ => Err(format!("{text:?} is no play in mm")),
    }
}

fn limit(text: &str) -> Result<SwayLimit, String> {
    text.parse().map_err(|error: RigidityFinding| error.to_string())
}

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
pub(super) fn rigidity(args: &RigidityArgs, voice: Voice) -> Result<End, Failure> {
    joint::may_have_hubs(&args.input, false);
    let case = match &args.linkage {
        Some(path) => linkage(path, args.input.json),
        None => structure(&args.input),
    };
    let mut case = match case? {
        Ok(case) => case,
        Err(findings) => {
            voice.findings(&findings);
            voice.say("refused: there is nothing to judge");
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
    let mut terminal = Terminal::new(voice, None);
    let verdict = args.verdict(&case, &mut terminal);
    terminal.finish();
    let verdict = verdict.map_err(|Stopped| Failure::Interrupted)?;
    case.findings.extend(verdict.findings().into_iter().map(Finding::from));
    voice.findings(&case.findings);
    if args.input.json {
        print(&format!("{}\n", verdict.json(case.joint, true)));
    }
    if let Some(path) = &args.picture {
        args.draw(path, &case.model, case.structure.as_ref(), &verdict)?;
    }
    say(&verdict, &case.model, voice);
    Ok(if verdict.passes() && passes(&case.findings) { End::Done } else { End::Refused })
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
        let drawn =
            drawn.and_then(|(s, paper)| rigidity::picture(s, model, paper, &look));
        let Some(bytes) = drawn else { return Ok(()) };
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
    let template = input::template(&args.template)?.with_hub_nodes(&args.hubs);
    let input = input::structure(args)?;
    let mut findings = input.findings;
    let structure = match Structure::new(input.draft, &setting::tolerance(&template)) {
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
    let criteria = match job::criteria(&structure, &template) {
        Ok(criteria) => criteria,
        Err(fact) => return Ok(Err(vec![fact.into()])),
    };
    let joint = args.joint;
    let (model, structure, fingerprint) = job::model(&structure, joint, &template);
    let structure = Some(structure);
    Ok(Ok(Case { model, fingerprint, criteria, findings, joint: Some(joint), structure }))
}

/// The verdict and the cures in words.
fn say(verdict: &Verdict, model: &Model, voice: Voice) {
    voice.say(&format!(
        "{} bodies, {} pins, mobility {}",
        model.bodies.len(),
        model.pins(),
        verdict
            .mobility()
            .map_or_else(|| "unknown".to_owned(), |count| count.to_string())
    ));
    voice.say(&verdict.summary());
    for line in verdict.stiff_in_words().into_iter().chain(verdict.remedies_in_words()) {
        voice.say(&line);
    }
}
