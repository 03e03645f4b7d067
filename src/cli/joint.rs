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

/// Ends the command if hubs were asked for on nodes of a joint that has none or only hubs.
pub(super) fn may_have_hubs(args: &InputArgs, apply_remedies: bool) {
    if args.joint == Joint::Hinge || args.hubs.is_empty() && !apply_remedies {
        return;
    }
    let option = if apply_remedies { "--apply-remedies" } else { "--hubs" };
    let message = format!("{option} goes with --joint hinge");
    Cli::command().error(ErrorKind::ArgumentConflict, message).exit();
}
