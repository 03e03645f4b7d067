//! Joints as they are typed.

use crate::cli::args::{Cli, InputArgs};
use crate::joint::Joint;
use clap::builder::PossibleValue;
use clap::error::ErrorKind;
use clap::{CommandFactory, ValueEnum};

impl ValueEnum for Joint {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self::Lap, Self::Hinge, Self::Hub]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let about = match self {
            Self::Lap => "Rigid strips, half-lapped where they cross",
            Self::Hinge => "Single fins on rods",
            Self::Hub => "Single fins in slotted discs",
        };
        Some(PossibleValue::new(self.name()).help(about))
    }
}

/// Ends the command if single hubs were asked for where every node has one, or remedies for
/// a joint that has none.
pub(super) fn may_have_hubs(args: &InputArgs, apply_remedies: bool) {
    let message = match args.joint {
        Joint::Hub if !args.hubs.is_empty() => "--joint hub has a hub on every node",
        Joint::Hub | Joint::Lap if apply_remedies => {
            "--apply-remedies goes with --joint hinge"
        }
        _ => return,
    };
    Cli::command().error(ErrorKind::ArgumentConflict, message).exit();
}
