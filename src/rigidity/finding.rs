//! What can be found when a structure is judged.

use crate::diagnostic::{Located, Place};
use crate::ids::NodeId;
use miette::Diagnostic;
use thiserror::Error;

/// A fact found while judging rigidity.
#[derive(Debug, Clone, PartialEq, Error, Diagnostic)]
#[allow(missing_docs, reason = "each variant's message says what its fields are")]
pub enum RigidityFinding {
    #[error("the linkage is not as expected: {message}")]
    #[diagnostic(
        code(rigidity::bad_linkage),
        help(
            "write {{\"bodies\": N, \"r\": 0.5, \"pins\": [[[px,py,pz], [ax,ay,az], [b0,b1]]]}}"
        )
    )]
    BadLinkage { line: usize, message: String },

    #[error("a linkage of {bodies} bodies cannot be judged")]
    #[diagnostic(
        code(rigidity::body_count),
        help("give `bodies` as the number of rigid bodies, at least 1")
    )]
    BodyCount { bodies: usize },

    #[error("the reach r of the pins is {r}, which is no length")]
    #[diagnostic(
        code(rigidity::no_reach),
        help("`r` is half the length of a pin; give a number above 0")
    )]
    NoReach { r: f64 },

    #[error("pin {pin} has a coordinate that is no finite number")]
    #[diagnostic(
        code(rigidity::not_finite),
        help("repair the exporting program's output; every coordinate must be a number")
    )]
    NotFinite { pin: usize },

    #[error("the axis of pin {pin} has no length")]
    #[diagnostic(code(rigidity::zero_axis), help("give the pin a direction"))]
    ZeroAxis { pin: usize },

    #[error("pin {pin} names body {body}, but there are only {bodies} bodies")]
    #[diagnostic(
        code(rigidity::no_such_body),
        help("bodies are counted from 0; the last one is `bodies` - 1")
    )]
    NoSuchBody { pin: usize, body: usize, bodies: usize },

    #[error(
        "pin {pin} joins the bodies {bodies:?}: two or more different ones are needed"
    )]
    #[diagnostic(
        code(rigidity::pin_bodies),
        help("list each body once; leave out a pin that joins nothing")
    )]
    PinBodies { pin: usize, bodies: Vec<usize> },

    #[error("{bodies} bodies are too many for `--pairing {pairing}`")]
    #[diagnostic(
        code(rigidity::pairing_too_large),
        help("up to {most} bodies can be compared so; `--pairing pin` has no limit")
    )]
    PairingTooLarge { bodies: usize, pairing: &'static str, most: usize },

    #[error("nothing is joined to anything: {bodies} bodies and no pin")]
    #[diagnostic(
        code(rigidity::no_pins),
        severity(Warning),
        help("strips or fins must meet on node axes; see which ends are held")
    )]
    NoPins { bodies: usize },

    #[error("every node is held by the ground; nothing can sway")]
    #[diagnostic(
        code(rigidity::all_held),
        severity(Advice),
        help("if that is not meant, hold fewer nodes, for instance `--fix lowest`")
    )]
    AllHeld,

    #[error(
        "mechanism: {mobility} independent motions meet no resistance; node {node} moves \
         most"
    )]
    #[diagnostic(
        code(rigidity::mechanism),
        help(
            "hold more nodes (`--fix`), make joints stiff (`finwright rigidity --remedies` \
             says which), or join rigid strips (`--joint lap`)"
        )
    )]
    Mechanism { mobility: usize, node: NodeId },

    #[error(
        "flexible: with {play_mm} mm of play, node {node} sways by {sway}; the limit is \
         {limit_mm:.2} mm"
    )]
    #[diagnostic(
        code(rigidity::flexible),
        help(
            "{}; tighten the fit (`clearance_mm`), hold \
             more nodes (`--fix`), or see `finwright rigidity --remedies`", would_pass(*pass_mm)
        )
    )]
    Flexible { play_mm: f64, node: NodeId, sway: String, limit_mm: f64, pass_mm: f64 },

    #[error(
        "near the limit: with {play_mm} mm of play, node {node} sways by {sway}; the limit \
         is {limit_mm:.2} mm"
    )]
    #[diagnostic(
        code(rigidity::grey),
        severity(Warning),
        help(
            "{} without doubt; tighten `clearance_mm`", would_pass(*pass_mm)
        )
    )]
    Grey { play_mm: f64, node: NodeId, sway: String, limit_mm: f64, pass_mm: f64 },

    #[error("{verdict}, and accepted as such: {reason}")]
    #[diagnostic(
        code(rigidity::accepted_flexible),
        severity(Warning),
        help("the reason is in job.json and on the frame of every sheet")
    )]
    Accepted { verdict: &'static str, reason: String },

    #[error(
        "the bounds of the sway contradict each other: {lower:.3e} above {upper:.3e}"
    )]
    #[diagnostic(
        code(rigidity::contradiction),
        help("the structure is too near a mechanism to be judged; treat it as one")
    )]
    Contradiction { lower: f64, upper: f64 },

    #[error("the rigidity could not be computed: a factorisation failed")]
    #[diagnostic(
        code(rigidity::not_solved),
        help(
            "look for bodies or axes that are out of all proportion to the rest \
             (`finwright check`); without a verdict nothing is cut"
        )
    )]
    NotSolved,

    #[error("the sway limit {text:?} is neither a length in mm nor like L/50")]
    #[diagnostic(
        code(rigidity::bad_limit),
        help(
            "write a number of mm, or L/50 for a fiftieth of the distance to a support"
        )
    )]
    BadLimit { text: String },
}

/// Which play would pass, as far as three decimals show it.
pub(super) fn would_pass(pass_mm: f64) -> String {
    if pass_mm >= 0.001 {
        format!("a play of {pass_mm:.3} mm would pass")
    } else {
        "hardly any play would pass".to_owned()
    }
}

impl Located for RigidityFinding {
    fn place(&self) -> Place {
        match self {
            Self::BadLinkage { line, .. } => {
                Place { line: Some(*line), ..Place::default() }
            }
            Self::NotFinite { pin }
            | Self::ZeroAxis { pin }
            | Self::NoSuchBody { pin, .. }
            | Self::PinBodies { pin, .. } => Place::nodes([*pin]),
            Self::Mechanism { node, .. }
            | Self::Flexible { node, .. }
            | Self::Grey { node, .. } => Place::nodes([*node]),
            _ => Place::default(),
        }
    }
}
