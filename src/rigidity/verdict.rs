//! Rigid, grey, flexible or mechanism.

use crate::joint::Joint;
use crate::rigidity::finding::RigidityFinding;
use crate::rigidity::mobility::{Mobility, mobility};
use crate::rigidity::model::{Body, Model};
use crate::rigidity::paper::{Pairing, Paper, paper};
use crate::rigidity::remedy::{self, Remedy};
use crate::rigidity::spectrum::{Modes, least};
use crate::rigidity::sway::{self, Sway};
use crate::rigidity::system::System;
use crate::structure::{Structure, write_json};
use crate::tolerance::FORCE_BALANCE;
use sha2::{Digest, Sha256};

/// What a structure may sway.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SwayLimit {
    /// So many mm.
    Length(f64),
    /// A share of the distance to the nearest support: 1/50 for `L/50`.
    Share(f64),
}

impl SwayLimit {
    /// The limit over a span, both in mm.
    pub fn of(self, span: f64) -> f64 {
        match self {
            Self::Length(length) => length,
            Self::Share(share) => share * span,
        }
    }
}

impl std::str::FromStr for SwayLimit {
    type Err = RigidityFinding;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let wrong = || RigidityFinding::BadLimit { text: text.to_owned() };
        let number = |text: &str| {
            let number = text.trim().parse::<f64>().map_err(|_| wrong())?;
            if number.is_finite() && number > 0.0 { Ok(number) } else { Err(wrong()) }
        };
        match text.trim().strip_prefix("L/") {
            Some(parts) => Ok(Self::Share(1.0 / number(parts)?)),
            None => Ok(Self::Length(number(text)?)),
        }
    }
}

/// What is asked about a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Question {
    /// How far a sleeve may leave its pin, mm.
    pub play_mm: f64,
    /// What a node may sway.
    pub limit: SwayLimit,
    /// How many of the least resisted motions to look at.
    pub modes: usize,
    /// How the paper's matrix compares bodies.
    pub pairing: Pairing,
    /// Scaled lengths over lengths in the paper's figures.
    pub scale: f64,
}

/// The modes that decide where to look.
const LEAST_MODES: usize = 8;

/// What exactly was judged: structure, joint and template, as SHA-256.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fingerprint(String);

impl Fingerprint {
    /// Of a structure as built, its joint and the text of the template.
    pub fn of(structure: &Structure, joint: Joint, template: &str) -> Self {
        let mut hash = Sha256::new();
        for part in [write_json(structure).as_str(), joint.name(), template] {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part.as_bytes());
        }
        Self(hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
    }

    /// Of something that will never be cut.
    pub fn of_nothing() -> Self {
        Self(String::new())
    }

    /// Hexadecimal digits.
    pub fn digits(&self) -> &str {
        &self.0
    }
}

/// The outcome in a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It sways within the limit at all nodes looked at.
    Rigid,
    /// The bounds do not decide it.
    Grey,
    /// It sways beyond the limit.
    Flexible,
    /// It moves without any resistance.
    Mechanism,
}

impl Outcome {
    /// As it is written.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::Grey => "grey",
            Self::Flexible => "flexible",
            Self::Mechanism => "mechanism",
        }
    }
}

/// What was found out about a model. Only [`judge`] makes one, so that nobody can alter it
/// on its way to the gate.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    outcome: Outcome,
    of: Fingerprint,
    pub(super) bodies: Vec<Body>,
    pub(super) pins: usize,
    pub(super) mobility: usize,
    pub(super) paper: Option<Paper>,
    pub(super) spectrum: Vec<f64>,
    pub(super) play_mm: f64,
    pub(super) sway: Option<Sway>,
    /// The node that moves most if it is a mechanism.
    pub(super) loose: Option<usize>,
    pub(super) remedies: Vec<Remedy>,
    notes: Vec<RigidityFinding>,
}

/// Judges a model. `of` says what it was made from.
pub fn judge(model: &Model, question: &Question, of: Fingerprint) -> Verdict {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let modes = question.modes.max(LEAST_MODES);
    let system = System::new(model, None, threads);
    let scaled = (question.pairing, question.scale);
    let mut verdict = Verdict {
        outcome: Outcome::Mechanism,
        of,
        bodies: model.bodies.clone(),
        pins: model.pins(),
        mobility: 0,
        paper: paper(model, scaled, question.modes, threads).ok(),
        spectrum: Vec::new(),
        play_mm: question.play_mm.max(0.0),
        sway: None,
        loose: None,
        remedies: Vec::new(),
        notes: notes(model),
    };
    let found = least(&system, modes).and_then(|modes| {
        let mobility = mobility(&system, &modes)?;
        Ok((modes, mobility))
    });
    // A factorisation that fails in spite of the shift has met a mechanism.
    let Ok((modes, mobility)) = found else {
        verdict.mobility = 1;
        return verdict;
    };
    verdict.spectrum = modes.sigma.iter().take(question.modes).copied().collect();
    verdict.mobility = mobility.count;
    if mobility.count > 0 {
        verdict.loose = loosest(&system, &mobility);
        return verdict;
    }
    verdict.weigh(&system, &modes, question);
    verdict
}

fn notes(model: &Model) -> Vec<RigidityFinding> {
    let mut notes = Vec::new();
    if model.pins() == 0 {
        notes.push(RigidityFinding::NoPins { bodies: model.bodies.len() });
    } else if model.knots.iter().all(|knot| knot.held) {
        notes.push(RigidityFinding::AllHeld);
    }
    notes
}

/// The node that moves most in any of the exact motions.
fn loosest(system: &System, mobility: &Mobility) -> Option<usize> {
    let model = system.model;
    let speed = |knot: usize| {
        let of = |y: &Vec<f64>| sway::node_velocity(system, knot, y).norm_squared();
        mobility.motions.iter().map(of).sum::<f64>()
    };
    let pins = (0..model.knots.len()).filter(|&k| model.knots[k].is_pin());
    let speeds = pins.map(|k| (speed(k), k));
    let most = speeds.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    most.map(|(_, k)| model.knots[k].node)
}

impl Verdict {
    /// Decides between rigid, grey and flexible.
    fn weigh(&mut self, system: &System, modes: &Modes, question: &Question) {
        self.outcome = Outcome::Rigid;
        match sway::worst(system, modes, (self.play_mm, question.limit)) {
            Err(_) => {
                self.outcome = Outcome::Mechanism;
                self.mobility = 1;
            }
            Ok(None) => {}
            Ok(Some(sway)) => {
                let (lower, upper) = (sway.bracket.lower, sway.bracket.upper);
                if lower > upper * (1.0 + FORCE_BALANCE) {
                    self.outcome = Outcome::Mechanism;
                    self.mobility = 1;
                    self.notes.push(RigidityFinding::Contradiction { lower, upper });
                } else if sway.demand.lower * self.play_mm > 1.0 {
                    self.outcome = Outcome::Flexible;
                } else if sway.demand.upper * self.play_mm > 1.0 {
                    self.outcome = Outcome::Grey;
                }
                self.sway = Some(sway);
            }
        }
    }

    /// The outcome.
    pub fn outcome(&self) -> Outcome {
        self.outcome
    }

    /// Whether the gate lets it through as it is.
    pub fn passes(&self) -> bool {
        matches!(self.outcome, Outcome::Rigid | Outcome::Grey)
    }

    /// What was judged.
    pub fn fingerprint(&self) -> &Fingerprint {
        &self.of
    }

    /// Exact motions left when one body or the fixed nodes are held.
    pub fn mobility(&self) -> usize {
        self.mobility
    }

    /// The paper's figures, if they could be computed.
    pub fn paper(&self) -> Option<&Paper> {
        self.paper.as_ref()
    }

    /// Where it sways most, unless nothing can or it is a mechanism.
    pub fn sway(&self) -> Option<&Sway> {
        self.sway.as_ref()
    }

    /// The play at which it would be rigid, mm.
    pub fn play_to_pass(&self) -> Option<f64> {
        self.sway.as_ref().map(|sway| 1.0 / sway.demand.upper)
    }

    /// What would help, as far as it was asked.
    pub fn remedies(&self) -> &[Remedy] {
        &self.remedies
    }

    /// What would help as lines of text.
    pub fn remedies_in_words(&self) -> Vec<String> {
        remedy::in_words(&self.remedies, &self.bodies)
    }

    /// The same with what would help.
    #[must_use]
    pub fn with_remedies(self, remedies: Vec<Remedy>) -> Self {
        Self { remedies, ..self }
    }

    /// What forbids cutting, or is worth knowing.
    pub fn findings(&self) -> Vec<RigidityFinding> {
        let mut all = self.notes.clone();
        if self.outcome == Outcome::Mechanism {
            let node = self.loose.unwrap_or(0);
            all.push(RigidityFinding::Mechanism { mobility: self.mobility, node });
        }
        let Some(sway) = &self.sway else { return all };
        let (play_mm, node, limit_mm) = (self.play_mm, sway.node, sway.limit_mm);
        let pass_mm = self.play_to_pass().unwrap_or(0.0);
        let sway = in_words(sway, play_mm);
        type Fact = RigidityFinding;
        match self.outcome {
            Outcome::Flexible => {
                all.push(Fact::Flexible { play_mm, node, sway, limit_mm, pass_mm });
            }
            Outcome::Grey => {
                all.push(Fact::Grey { play_mm, node, sway, limit_mm, pass_mm });
            }
            Outcome::Rigid | Outcome::Mechanism => {}
        }
        all
    }

    /// One line for the terminal.
    pub fn summary(&self) -> String {
        let name = self.outcome.name();
        match (&self.sway, self.outcome) {
            (_, Outcome::Mechanism) => {
                format!("{name}: {} motions without any resistance", self.mobility)
            }
            (Some(sway), _) => format!(
                "{name}: node {} sways by {} for {} mm of play; the limit is {:.2} mm; up to \
                 {:.3} mm of play would pass",
                sway.node,
                in_words(sway, self.play_mm),
                self.play_mm,
                sway.limit_mm,
                self.play_to_pass().unwrap_or(0.0),
            ),
            (None, _) => format!("{name}: nothing can move"),
        }
    }
}

/// A sway in mm, or in words where the model of small motions ends.
fn in_words(sway: &Sway, play: f64) -> String {
    let (low, high) = (sway.bracket.lower * play, sway.bracket.upper * play);
    if low > sway.span_mm / 10.0 {
        format!("more than a tenth of its span of {:.0} mm", sway.span_mm)
    } else {
        format!("{low:.2} to {high:.2} mm")
    }
}
