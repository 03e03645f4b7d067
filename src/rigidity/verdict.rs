//! Rigid, grey, flexible or mechanism.

use crate::files::sha256;
use crate::ids::NodeId;
use crate::joint::Joint;
use crate::rigidity::amplify::Bracket;
use crate::rigidity::criteria::Criteria;
use crate::rigidity::finding::{RigidityFinding, would_pass};
use crate::rigidity::mobility::{Mobility, mobility};
use crate::rigidity::model::{Model, RigidBody};
use crate::rigidity::paper::{Paper, paper};
use crate::rigidity::remedy::{self, Remedy};
use crate::rigidity::spectrum::least;
use crate::rigidity::sway::{self, Sway};
use crate::rigidity::system::System;
use crate::sparse::Halt;
use crate::structure::{Structure, write_json};
use crate::tolerance::FORCE_BALANCE;
use crate::watch::{Stopped, Watch};
use serde::{Deserialize, Serialize};

/// The modes that decide where to look.
const LEAST_MODES: usize = 8;

/// What exactly was judged: structure, joint and template, as SHA-256.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fingerprint(String);

impl Fingerprint {
    /// Of a structure as built, its joint, the text of the template and the nodes with hubs
    /// that the text does not name.
    pub fn of(
        structure: &Structure,
        joint: Joint,
        template: &str,
        hub_nodes: &[NodeId],
    ) -> Self {
        let (structure, hubs) = (write_json(structure), format!("{hub_nodes:?}"));
        let hubs = (!hub_nodes.is_empty()).then_some(hubs.as_str());
        let mut text = Vec::new();
        for part in [structure.as_str(), joint.name(), template].into_iter().chain(hubs) {
            text.extend((part.len() as u64).to_le_bytes());
            text.extend(part.as_bytes());
        }
        Self(sha256(&text))
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
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
    pub(super) bodies: Vec<RigidBody>,
    pub(super) pins: usize,
    /// Exact motions, if they could be counted.
    pub(super) mobility: Option<usize>,
    pub(super) paper: Option<Paper>,
    pub(super) spectrum: Vec<f64>,
    pub(super) play_mm: f64,
    pub(super) sway: Option<Sway>,
    /// Sway over play at the same node with every joint stiff, if it was computed.
    pub(super) stiff: Option<Bracket>,
    /// The node that moves most if it is a mechanism.
    pub(super) loose: Option<NodeId>,
    pub(super) remedies: Vec<Remedy>,
    notes: Vec<RigidityFinding>,
}

/// Judges a model. `of` says what it was made from.
///
/// # Errors
/// [`Stopped`] if the watch stopped the work.
pub fn judge(
    model: &Model,
    criteria: &Criteria,
    of: Fingerprint,
    watch: &mut dyn Watch,
) -> Result<Verdict, Stopped> {
    let threads = watch.threads();
    let criteria = &Criteria { play_mm: criteria.play_mm.max(0.0), ..*criteria };
    let system = System::new(model, None, threads);
    watch.progress("rigidity", 0, STEPS);
    let paper = match paper(model, criteria, threads, watch) {
        Err(Halt::Stopped(stopped)) => return Err(stopped),
        paper => paper.ok(),
    };
    let mut verdict = Verdict {
        outcome: Outcome::Grey,
        of,
        bodies: model.bodies.clone(),
        pins: model.pins(),
        mobility: None,
        paper,
        spectrum: Vec::new(),
        play_mm: criteria.play_mm,
        sway: None,
        stiff: None,
        loose: None,
        remedies: Vec::new(),
        notes: notes(model),
    };
    match verdict.find(&system, criteria, watch) {
        Err(Halt::Stopped(stopped)) => return Err(stopped),
        Err(Halt::Failed) => verdict.notes.push(RigidityFinding::NotSolved),
        Ok(()) => {}
    }
    Ok(verdict)
}

/// Steps of a verdict.
const STEPS: usize = 4;

fn notes(model: &Model) -> Vec<RigidityFinding> {
    let mut notes = Vec::new();
    if model.pins() == 0 {
        notes.push(RigidityFinding::NoPins { bodies: model.bodies.len() });
    } else if model.couplings.iter().all(|coupling| coupling.held) {
        notes.push(RigidityFinding::AllHeld);
    }
    notes
}

/// The node that moves most in any of the exact motions.
fn loosest(system: &System, mobility: &Mobility) -> Option<NodeId> {
    let model = system.model;
    let speed = |coupling: usize| {
        let of = |y: &Vec<f64>| sway::node_velocity(system, coupling, y).norm_squared();
        mobility.motions.iter().map(of).sum::<f64>()
    };
    let pins = (0..model.couplings.len()).filter(|&k| model.couplings[k].is_pin());
    let speeds = pins.map(|k| (speed(k), k));
    let most = speeds.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    most.map(|(_, k)| model.couplings[k].node)
}

impl Verdict {
    /// Counts the exact motions and, if there are none, weighs the sway.
    fn find(
        &mut self,
        system: &System,
        criteria: &Criteria,
        watch: &mut dyn Watch,
    ) -> Result<(), Halt> {
        watch.progress("rigidity", 1, STEPS);
        let modes = least(system, criteria.modes.max(LEAST_MODES), watch)?;
        self.spectrum = modes.sigma.iter().take(criteria.modes).copied().collect();
        watch.progress("rigidity", 2, STEPS);
        let mobility = mobility(system, &modes, watch)?;
        self.mobility = Some(mobility.count);
        if mobility.count > 0 {
            self.outcome = Outcome::Mechanism;
            self.loose = loosest(system, &mobility);
            return Ok(());
        }
        watch.progress("rigidity", 3, STEPS);
        let rounds = sway::rounds_for_figures(system);
        self.sway = sway::worst(system, &modes, criteria, rounds, watch)?;
        if let Some(sway) = &self.sway {
            self.stiff = match sway::with_stiff_joints(system, sway, watch) {
                // Nothing hangs on it.
                Err(Halt::Failed) => None,
                found => found?,
            };
        }
        self.weigh();
        Ok(())
    }

    /// Decides between rigid, grey and flexible.
    fn weigh(&mut self) {
        let Some(sway) = &self.sway else {
            self.outcome = Outcome::Rigid;
            return;
        };
        let (lower, upper) = (sway.bracket.lower, sway.bracket.upper);
        if lower > upper * (1.0 + FORCE_BALANCE) {
            self.notes.push(RigidityFinding::Contradiction { lower, upper });
        } else if sway.demand.lower * self.play_mm > 1.0 {
            self.outcome = Outcome::Flexible;
        } else if sway.demand.upper * self.play_mm <= 1.0 {
            self.outcome = Outcome::Rigid;
        }
    }

    /// The outcome.
    pub fn outcome(&self) -> Outcome {
        self.outcome
    }

    /// Whether the gate lets it through as it is.
    pub fn passes(&self) -> bool {
        matches!(self.outcome, Outcome::Rigid | Outcome::Grey) && !self.failed()
    }

    /// Whether it could not be computed, or not be trusted.
    fn failed(&self) -> bool {
        type Fact = RigidityFinding;
        let bad = |fact| matches!(fact, &Fact::NotSolved | &Fact::Contradiction { .. });
        self.notes.iter().any(bad)
    }

    /// What was judged.
    pub fn fingerprint(&self) -> &Fingerprint {
        &self.of
    }

    /// Exact motions left when one body or the fixed nodes are held; `None` if they could
    /// not be counted.
    pub fn mobility(&self) -> Option<usize> {
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

    /// What stiff joints would do to the sway, in words.
    pub fn stiff_in_words(&self) -> Option<String> {
        let (sway, stiff) = (self.sway.as_ref()?, self.stiff.filter(|_| !self.failed())?);
        let way = sway.in_words(stiff, self.play_mm);
        let times = [sway.bracket.lower / stiff.upper, sway.bracket.upper / stiff.lower];
        let less = if times[0] >= 1.0 && times[1].is_finite() {
            format!(", {:.1} to {:.1} times less", times[0], times[1])
        } else {
            String::new()
        };
        Some(format!(
            "with every joint stiff node {} would sway by {way}{less}",
            sway.node
        ))
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
            let node = self.loose.unwrap_or(NodeId::new(0));
            let mobility = self.mobility.unwrap_or(0);
            all.push(RigidityFinding::Mechanism { mobility, node });
        }
        if self.failed() {
            return all;
        }
        let Some(sway) = &self.sway else { return all };
        let (play_mm, node, limit_mm) = (self.play_mm, sway.node, sway.limit_mm);
        let pass_mm = self.play_to_pass().unwrap_or(0.0);
        let sway = sway.in_words(sway.bracket, play_mm);
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
            _ if self.failed() => {
                "there is no verdict: it could not be computed".to_owned()
            }
            (_, Outcome::Mechanism) => {
                let mobility = self.mobility.unwrap_or(0);
                format!("{name}: {mobility} motions without any resistance")
            }
            (Some(sway), _) => format!(
                "{name}: node {} sways by {} for {} mm of play; the limit is {:.2} mm; {}",
                sway.node,
                sway.in_words(sway.bracket, self.play_mm),
                self.play_mm,
                sway.limit_mm,
                would_pass(self.play_to_pass().unwrap_or(0.0)),
            ),
            (None, _) => format!("{name}: nothing can move"),
        }
    }
}
