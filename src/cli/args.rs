//! What was typed.

use crate::cli::coupon::{self, CouponArgs};
use crate::cli::nest;
use crate::cli::picture;
use crate::cli::planarise::{PLANARISE_HELP, PlanariseArgs, PlanariseWhen};
use crate::cli::rigidity;
use crate::cli::verify::{self, VerifyArgs};
use crate::geometry::{Point3, Vector3};
use crate::joint::Joint;
use crate::structure::AxisRule;
use crate::units::Unit;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// From a torsion-free support structure to laser-cut sheets.
#[derive(Debug, Parser)]
#[command(name = "finwright", version, max_term_width = 90)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,

    /// Say only what went wrong
    #[arg(short, long, global = true)]
    pub quiet: bool,

    /// Say more: every finding, not the first few of a kind
    #[arg(short, long, global = true)]
    pub verbose: bool,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Make laser sheets from a structure
    #[command(after_help = MAKE_HELP)]
    Make(MakeArgs),

    /// Report everything that is wrong with a structure; write nothing
    #[command(after_help = CHECK_HELP)]
    Check(CheckArgs),

    /// Say whether a structure is rigid, and what would help if it is not
    #[command(after_help = rigidity::HELP)]
    Rigidity(rigidity::RigidityArgs),

    /// Planar fins from any quad-dominant mesh
    #[command(after_help = PLANARISE_HELP)]
    Planarise(Box<PlanariseArgs>),

    /// Read the files of a job back, fold the parts and compare with the structure
    #[command(after_help = verify::HELP)]
    Verify(VerifyArgs),

    /// Make a kerf and fit coupon for a material, or read one
    #[command(after_help = coupon::HELP)]
    Coupon(CouponArgs),

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

    /// Show or write the embedded structures
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

const MAKE_HELP: &str = "\
Examples:
  finwright make
      the embedded vault in 3 mm cast acrylic, into out/vault
  finwright make roof.obj --units m --scale 1:50 --axes 0,0,1 -t card-1.5
      a mesh drawn in metres, as a 1:50 card model with upright node axes
  finwright make --only S07,S12
      two parts again, on a sheet of their own";

const CHECK_HELP: &str = "\
Example:
  finwright check roof.obj --units m --scale 1:50 --axes point:0,0,-20
      every finding about a roof whose node axes pass through one point";

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

/// Options about the structure.
#[derive(Debug, Args)]
pub struct InputArgs {
    /// Structure to read: .json, .obj, or the name of an embedded one [default: vault]
    pub structure: Option<String>,

    /// Material and machine: name of an embedded template, or a .toml file
    #[arg(short, long, default_value = "pmma-cast-3")]
    pub template: String,

    /// How strips and fins are joined
    #[arg(long, value_enum, default_value = "lap")]
    pub joint: Joint,

    /// Nodes that get hubs although the others lap, or hang on rods
    #[arg(long, value_name = "I,J,..", value_delimiter = ',')]
    pub hubs: Vec<usize>,

    /// Model scale
    #[arg(long, default_value = "1:1", value_parser = scale, value_name = "1:N")]
    pub scale: Scale,

    /// Unit of an OBJ file: mm, cm, m, in or ft [default: mm]
    #[arg(long)]
    pub units: Option<Unit>,

    /// Node axes: `vn` (from the file), `normal`, a direction X,Y,Z, or point:X,Y,Z (away
    /// from that point, in the file's units)
    #[arg(long, default_value = "vn", value_parser = axis_rule, allow_hyphen_values = true)]
    pub axes: AxisRule,

    /// How far fins reach along their axes, in mm of the model [default: 0.35 of the median
    /// fin length on each side, or as the file says]
    #[arg(long, value_parser = depth, value_name = "BELOW,ABOVE")]
    pub depth: Option<Depth>,

    /// Nodes held by the ground: none, boundary, lowest, or a list of numbers [default: as
    /// the file says, else boundary]
    #[arg(long, value_parser = fix)]
    pub fix: Option<Fix>,

    /// Whether fins that are not plane are made so by moving nodes and axes
    #[arg(long, value_enum, default_value = "auto", value_name = "WHEN")]
    pub planarise: PlanariseWhen,

    /// Seed of the nesting search
    #[arg(long, default_value_t = 0)]
    pub seed: u64,

    /// How hard to nest
    #[arg(long, value_enum, default_value = "normal")]
    pub effort: EffortLevel,

    /// Nest for this long instead; the result may then differ from run to run
    #[arg(long, value_name = "SECONDS", conflicts_with = "effort", value_parser = seconds)]
    pub time_limit: Option<f64>,

    /// Print one JSON object on standard output
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `make`.
#[derive(Debug, Args)]
pub struct MakeArgs {
    /// What to make.
    #[command(flatten)]
    pub input: InputArgs,

    /// Folder of the job [default: out/<name>]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Only these parts again, on a sheet of their own [default DIR: out/<name>-only]
    #[arg(long, value_name = "S07,S12", value_delimiter = ',')]
    pub only: Vec<String>,

    /// With `--joint hinge`: put hubs on as many nodes as it takes to make it rigid, the most
    /// useful first
    #[arg(long)]
    pub apply_remedies: bool,

    /// The structure is flexible on purpose; the reason goes on record and on every sheet
    #[arg(long, value_name = "REASON")]
    pub accept_flexible: Option<String>,
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// What to check.
    #[command(flatten)]
    pub input: InputArgs,

    /// What to draw.
    #[command(flatten)]
    pub drawing: picture::PictureArgs,

    /// Find the smallest scale at which all checks pass, and what binds
    #[arg(long)]
    pub advise: bool,
}

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
    /// List the embedded structures
    List,
    /// Write one as JSON
    Write {
        /// Name of the structure
        name: String,
        /// File to write; standard output if left out
        #[arg(short, long, value_name = "FILE")]
        output: Option<PathBuf>,
    },
}

/// How hard to nest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum EffortLevel {
    /// One order of parts
    Quick,
    /// Some orders
    Normal,
    /// Many orders
    Thorough,
}

/// A model scale with the text it was given as.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    /// Such as `1:50`.
    pub text: String,
    /// Such as 0.02.
    pub factor: f64,
}

/// Depth of all fins, mm of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Depth {
    /// Against the axes.
    pub below: f64,
    /// Along the axes.
    pub above: f64,
}

/// Nodes held by the ground.
#[derive(Debug, Clone, PartialEq)]
pub enum Fix {
    /// No node.
    None,
    /// All nodes on the boundary of the mesh.
    Boundary,
    /// The lowest nodes.
    Lowest,
    /// These.
    Nodes(Vec<usize>),
}

pub(super) fn numbers(text: &str) -> Result<Vec<f64>, String> {
    let number = |word: &str| match word.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(format!("{word:?} is no number")),
    };
    text.split(',').map(number).collect()
}

pub(super) fn seconds(text: &str) -> Result<f64, String> {
    match numbers(text)?.as_slice() {
        &[seconds] if seconds > 0.0 && seconds <= 1e6 => Ok(seconds),
        _ => Err(format!("{text:?} is no number of seconds")),
    }
}

fn scale(text: &str) -> Result<Scale, String> {
    let wrong = || format!("{text:?} is no scale; write 1:50 for a fiftieth");
    let (one, many) = text.split_once(':').ok_or_else(wrong)?;
    match (numbers(one)?.as_slice(), numbers(many)?.as_slice()) {
        (&[one], &[many]) if one > 0.0 && many > 0.0 => {
            Ok(Scale { text: text.to_owned(), factor: one / many })
        }
        _ => Err(wrong()),
    }
}

pub(super) fn axis_rule(text: &str) -> Result<AxisRule, String> {
    let triple = |text: &str| match numbers(text)?.as_slice() {
        &[x, y, z] => Ok([x, y, z]),
        other => Err(format!("three numbers X,Y,Z are needed, found {}", other.len())),
    };
    match text {
        "vn" => Ok(AxisRule::File),
        "normal" => Ok(AxisRule::Normal),
        _ => match text.strip_prefix("point:") {
            Some(point) => Ok(AxisRule::Through(Point3::from(triple(point)?))),
            None => {
                let direction = Vector3::from(triple(text).map_err(|error| {
                    format!("{error}; use vn, normal, X,Y,Z or point:X,Y,Z")
                })?);
                if direction.norm() > 0.0 {
                    Ok(AxisRule::Parallel(direction))
                } else {
                    Err("the direction 0,0,0 points nowhere".to_owned())
                }
            }
        },
    }
}

pub(super) fn depth(text: &str) -> Result<Depth, String> {
    match numbers(text)?.as_slice() {
        &[below, above] if below >= 0.0 && above >= 0.0 && below + above > 0.0 => {
            Ok(Depth { below, above })
        }
        _ => Err(format!("{text:?} is no depth; write 20,20 for 20 mm on each side")),
    }
}

pub(super) fn fix(text: &str) -> Result<Fix, String> {
    match text {
        "none" => Ok(Fix::None),
        "boundary" => Ok(Fix::Boundary),
        "lowest" => Ok(Fix::Lowest),
        list => {
            let node = |word: &str| {
                word.trim().parse::<usize>().map_err(|_| {
                    format!("{word:?} is no node; use none, boundary, lowest or numbers")
                })
            };
            list.split(',').map(node).collect::<Result<_, _>>().map(Fix::Nodes)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }

    #[test]
    fn scales_and_axes_are_read_as_written() {
        assert!((scale("1:50").unwrap().factor - 0.02).abs() < 1e-15);
        assert!(scale("1:0").is_err());
        assert!(axis_rule("0,0,0").is_err());
        assert_eq!(
            axis_rule("point:1,2,-3"),
            Ok(AxisRule::Through(Point3::new(1.0, 2.0, -3.0)))
        );
    }
}
