//! What is typed. Flags know no command: each command takes its own and asks no other's.

pub(super) mod coupon;
pub(super) mod design;
pub(super) mod drawing;
pub(super) mod nest;
pub(super) mod planarise;
pub(super) mod rigidity;
pub(super) mod structure;
pub(super) mod value;
pub(super) mod verify;

use clap::error::ErrorKind;
use clap::{Args, CommandFactory, Parser, Subcommand};
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// From a torsion-free support structure to laser-cut sheets.
#[derive(Debug, Parser)]
#[command(name = "finwright", version, max_term_width = 90)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,

    /// What holds for all of them.
    #[command(flatten)]
    pub console: Console,
}

/// How every command works and what it says.
#[derive(Debug, Clone, Copy, Args)]
pub struct Console {
    /// Say only what went wrong
    #[arg(short, long, global = true)]
    pub quiet: bool,

    /// Say more: every finding, not the first few of a kind
    #[arg(short, long, global = true)]
    pub verbose: bool,

    /// Work on so many threads; the result is the same on any number [default: all]
    #[arg(long, global = true, value_name = "N")]
    pub threads: Option<NonZeroUsize>,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Make laser sheets from a structure
    #[command(after_help = structure::MAKE_HELP)]
    Make(structure::MakeArgs),

    /// Report everything that is wrong with a structure; write nothing
    #[command(after_help = structure::CHECK_HELP)]
    Check(structure::CheckArgs),

    /// Say whether a structure is rigid, and what would help if it is not
    #[command(after_help = rigidity::HELP)]
    Rigidity(rigidity::RigidityArgs),

    /// Design a structure on a reference surface
    #[command(after_help = design::HELP)]
    Design(Box<design::DesignArgs>),

    /// Planar fins from any quad-dominant mesh
    #[command(after_help = planarise::HELP)]
    Planarise(Box<planarise::PlanariseArgs>),

    /// Read the files of a job back, fold the parts and compare with the structure
    #[command(after_help = verify::HELP)]
    Verify(verify::VerifyArgs),

    /// Make a kerf and fit coupon for a material, or read one
    #[command(after_help = coupon::HELP)]
    Coupon(coupon::CouponArgs),

    /// Nest parts on sheets, or in a strip
    #[command(after_help = nest::HELP)]
    Nest(nest::NestArgs),

    /// Show materials and machines
    #[command(after_help = TEMPLATE_HELP)]
    Template {
        /// What to show.
        #[command(subcommand)]
        action: TemplateAction,
    },

    /// Show or write the embedded structures and surfaces
    #[command(after_help = EXAMPLE_HELP)]
    Example {
        /// What to show.
        #[command(subcommand)]
        action: ExampleAction,
    },

    /// Print completions for a shell
    #[command(after_help = COMPLETIONS_HELP)]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
}

const TEMPLATE_HELP: &str = "\
Example:
  finwright template show pmma-cast-3 > mine.toml
  finwright template check mine.toml
      start a template of your own: enter the thickness and kerf you measured";

const EXAMPLE_HELP: &str = "\
Example:
  finwright example write dome -o dome.json
      the embedded dome, to look at the format or to change it";

const COMPLETIONS_HELP: &str = "\
Example:
  finwright completions bash > ~/.local/share/bash-completion/completions/finwright";

/// Actions of `template`.
#[derive(Debug, Subcommand)]
pub enum TemplateAction {
    /// List the embedded templates
    List,
    /// Print a template as TOML, every value with its source
    Show {
        /// Name of an embedded template
        name: String,
    },
    /// Read a template and say what is wrong with it
    Check {
        /// The .toml file, or the name of an embedded template
        file: PathBuf,
    },
}

/// Actions of `example`.
#[derive(Debug, Subcommand)]
pub enum ExampleAction {
    /// List the embedded structures and surfaces
    List,
    /// Write one: a structure as JSON, a surface as OBJ
    Write {
        /// Its name
        name: String,
        /// File to write; standard output if left out
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
    },
}

impl Command {
    /// Whether one JSON object is to be printed.
    pub(super) const fn wants_json(&self) -> bool {
        match self {
            Self::Make(args) => args.input.json,
            Self::Verify(args) => args.json,
            Self::Coupon(args) => args.json,
            Self::Design(args) => args.json,
            Self::Check(args) => args.input.json,
            Self::Nest(args) => args.json,
            Self::Rigidity(args) => args.input.json,
            _ => false,
        }
    }
}

/// Ends the command if single hubs were asked for where every node has one, or remedies for
/// a joint that has none.
pub(super) fn may_have_hubs(args: &structure::InputArgs, apply_remedies: bool) {
    let joint = args.joint;
    let message = if joint.has_hubs_everywhere() && !args.hubs.is_empty() {
        format!("--joint {} has a hub on every node", joint.name())
    } else if apply_remedies && !joint.takes_remedies() {
        "--apply-remedies goes with --joint hinge".to_owned()
    } else {
        return;
    };
    Cli::command().error(ErrorKind::ArgumentConflict, message).exit();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
