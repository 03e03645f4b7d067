//! A verdict as JSON.

use crate::ids::NodeId;
use crate::joint::Joint;
use crate::rigidity::amplify::Bracket;
use crate::rigidity::paper::{Discrepancy, Paper};
use crate::rigidity::remedy::{Cure, Remedy};
use crate::rigidity::verdict::{Outcome, Verdict};
use crate::tolerance::ROUNDING;
use serde::{Deserialize, Serialize};

/// A verdict as `rigidity --json` prints it and job.json carries it. Numbers have six
/// digits; `null` stands for what was not found or has no bound.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct VerdictEntry {
    /// How fins are joined; `null` of a linkage.
    pub joint: Option<Joint>,
    /// Rigid bodies of the model.
    pub bodies: usize,
    /// Pins between them.
    pub pins: usize,
    /// Exact motions.
    pub mobility: Option<usize>,
    /// Singular values and discrepancies as in the paper (Pellis 2026, §5).
    pub paper: Option<PaperEntry>,
    /// The least stiffnesses.
    pub spectrum: Vec<Option<f64>>,
    /// Play of a joint, mm.
    pub play_mm: Option<f64>,
    /// Sway over play.
    pub amplification: BoundsEntry,
    /// Sway over play at the same node if every joint were stiff.
    pub amplification_stiff: BoundsEntry,
    /// Sway, mm.
    pub sway_mm: BoundsEntry,
    /// The most that is allowed at that node, mm.
    pub sway_limit_mm: Option<f64>,
    /// The node that sways most.
    pub node: Option<usize>,
    /// The unit vector along which it does.
    pub direction: Option<Vec<Option<f64>>>,
    /// The play with which it would be rigid, mm.
    pub play_to_pass_mm: Option<f64>,
    /// The outcome.
    pub verdict: Option<Outcome>,
    /// What would help.
    pub remedies: Vec<RemedyEntry>,
    /// Digits of what was judged.
    pub fingerprint: String,
}

/// A number that lies between two.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct BoundsEntry {
    /// At least this.
    pub lower: Option<f64>,
    /// At most this.
    pub upper: Option<f64>,
}

/// What the paper asks of a structure.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct PaperEntry {
    /// The body that is held.
    pub fixed_body: usize,
    /// Which bodies of a node hinge with which.
    pub pairing: String,
    /// Lengths are multiplied by it, 1 / mm.
    pub scale: Option<f64>,
    /// The smallest.
    pub singular_values: Vec<Option<f64>>,
    /// The largest.
    pub largest_singular_value: Option<f64>,
    /// Of the hinges in the motion they resist least.
    pub discrepancy: DiscrepancyEntry,
}

/// How far hinges would have to give.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default)]
pub struct DiscrepancyEntry {
    /// The largest.
    pub max: Option<f64>,
    /// The mean.
    pub mean: Option<f64>,
    /// The root of the mean square.
    pub rms: Option<f64>,
    /// Each hinge, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub per_hinge: Option<Vec<HingeEntry>>,
}

/// A hinge.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct HingeEntry {
    /// On the axis of this node.
    pub node: usize,
    /// The bodies it joins.
    pub bodies: [usize; 2],
    /// How far it would have to give.
    pub value: Option<f64>,
}

/// What would make a structure stiffer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct RemedyEntry {
    /// `weld` two bodies of the node, or `fix` the node to the ground.
    pub kind: String,
    /// The node.
    pub node: usize,
    /// The bodies that are welded.
    pub bodies: Vec<usize>,
    /// Sway over play then.
    pub amplification_after: Option<f64>,
    /// Exact motions then.
    pub mobility_after: usize,
    /// Whether it is rigid then.
    pub passes: bool,
}

/// Six significant digits: the last ones of a sum differ between processors.
fn six(value: f64) -> Option<f64> {
    let six = || format!("{value:.5e}").parse().unwrap_or(value);
    value.is_finite().then(|| if value.abs() < ROUNDING { 0.0 } else { six() })
}

fn bounds(bracket: Option<Bracket>, by: f64) -> BoundsEntry {
    let bound = |of: fn(&Bracket) -> f64| bracket.as_ref().and_then(|b| six(of(b) * by));
    BoundsEntry { lower: bound(|b| b.lower), upper: bound(|b| b.upper) }
}

impl Verdict {
    /// As written; `per_hinge` adds the list of all hinges.
    pub fn entry(
        &self,
        joint: impl Into<Option<Joint>>,
        per_hinge: bool,
    ) -> VerdictEntry {
        // A mechanism sways without end: there is no number for it.
        let sway = self.sway.as_ref().filter(|_| self.outcome() != Outcome::Mechanism);
        let amplification = sway.map(|sway| sway.bracket);
        let still = Bracket { lower: 0.0, upper: 0.0 };
        let moves = self.outcome() == Outcome::Mechanism || sway.is_some();
        let amplification = if moves { amplification } else { Some(still) };
        let stiff =
            if moves { self.stiff.filter(|_| sway.is_some()) } else { Some(still) };
        VerdictEntry {
            joint: joint.into(),
            bodies: self.bodies.len(),
            pins: self.pins,
            mobility: self.mobility,
            paper: self.paper.as_ref().map(|paper| paper_entry(paper, per_hinge)),
            spectrum: self.spectrum.iter().map(|s| six(*s)).collect(),
            play_mm: six(self.play_mm),
            amplification: bounds(amplification, 1.0),
            amplification_stiff: bounds(stiff, 1.0),
            sway_mm: bounds(amplification, self.play_mm),
            sway_limit_mm: sway.and_then(|sway| six(sway.limit_mm)),
            node: sway.map(|sway| sway.node).or(self.loose).map(NodeId::index),
            direction: sway.map(|sway| sway.direction.iter().map(|x| six(*x)).collect()),
            play_to_pass_mm: self.play_to_pass().filter(|_| sway.is_some()).and_then(six),
            verdict: Some(self.outcome()),
            remedies: self.remedies.iter().map(remedy).collect(),
            fingerprint: self.fingerprint().digits().to_owned(),
        }
    }
}

fn paper_entry(paper: &Paper, per_hinge: bool) -> PaperEntry {
    let values = || paper.discrepancies.iter().map(|d| d.value);
    let count = paper.discrepancies.len().max(1) as f64;
    let mean = values().sum::<f64>() / count;
    let rms = (values().map(|v| v * v).sum::<f64>() / count).sqrt();
    PaperEntry {
        fixed_body: 0,
        pairing: paper.pairing.name().to_owned(),
        scale: six(paper.scale),
        singular_values: paper.singular_values.iter().map(|s| six(*s)).collect(),
        largest_singular_value: six(paper.largest),
        discrepancy: DiscrepancyEntry {
            max: six(values().fold(0.0, f64::max)),
            mean: six(mean),
            rms: six(rms),
            per_hinge: per_hinge.then(|| paper.discrepancies.iter().map(hinge).collect()),
        },
    }
}

fn hinge(d: &Discrepancy) -> HingeEntry {
    HingeEntry { node: d.node.index(), bodies: d.bodies, value: six(d.value) }
}

fn remedy(remedy: &Remedy) -> RemedyEntry {
    let (kind, bodies) = match remedy.cure {
        Cure::Weld(bodies) => ("weld", bodies.to_vec()),
        Cure::Fix => ("fix", Vec::new()),
    };
    RemedyEntry {
        kind: kind.to_owned(),
        node: remedy.node.index(),
        bodies,
        amplification_after: remedy.amplification_after.and_then(six),
        mobility_after: remedy.mobility_after,
        passes: remedy.passes,
    }
}
