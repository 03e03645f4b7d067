//! `make` and `check`, and what all commands ask about a structure.

use crate::cli::flags::planarise::PlanariseWhen;
use crate::cli::flags::value::{
    EffortLevel, axis_rule, depth, fix, length, scale, seconds, sheet,
};
use crate::job::{Depth, Fix, Scale};
use crate::joint::Joint;
use crate::structure::AxisRule;
use crate::units::Unit;
use clap::Args;
use std::path::PathBuf;

/// Shown after the help of `make`.
pub(super) const MAKE_HELP: &str = "\
Examples:
  finwright make
      the embedded vault in 3 mm cast acrylic, into out/vault
  finwright make roof.obj --units m --scale 1:50 --axes 0,0,1 -t card-1.5
      a mesh drawn in metres, as a 1:50 card model with upright node axes
  finwright make --only S07,S12
      two parts again, on a sheet of their own";

/// Shown after the help of `check`.
pub(super) const CHECK_HELP: &str = "\
Example:
  finwright check roof.obj --units m --scale 1:50 --axes point:0,0,-20
      every finding about a roof whose node axes pass through one point";

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

    /// Vertices of an OBJ file nearer than so many mm (at the file's size, before --scale)
    /// become one node
    #[arg(long, default_value = "0", value_parser = length, value_name = "MM")]
    pub weld: f64,

    /// Sheet of so many mm instead of those of the template, and how many there are; may be
    /// given more than once
    #[arg(long, value_name = "WxH[:COUNT]", value_parser = sheet)]
    pub sheet: Vec<([f64; 2], Option<usize>)>,

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
    pub drawing: PictureArgs,

    /// Find the smallest scale at which all checks pass, and what binds
    #[arg(long)]
    pub advise: bool,
}

/// What to draw.
#[derive(Debug, Args)]
pub struct PictureArgs {
    /// Draw this node's connector as it is built, into `--picture`
    #[arg(long, value_name = "N", requires = "picture")]
    pub node: Option<usize>,

    /// Where to draw it
    #[arg(long, value_name = "FILE.png", requires = "node")]
    pub picture: Option<PathBuf>,
}
