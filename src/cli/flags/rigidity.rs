//! `rigidity`.

use crate::cli::flags::structure::InputArgs;
use crate::rigidity::{Pairing, RigidityFinding, SwayLimit};
use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

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
    pub(in crate::cli) around: f64,
    pub(in crate::cli) up: f64,
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
