//! `planarise`.

use crate::cli::flags::value::{axis_rule, depth, fix, length, numbers};
use crate::design::planarise::{Options, WISHES, Weights, Wish};
use crate::job::{Depth, Fix};
use crate::structure::AxisRule;
use crate::units::Unit;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches, ValueEnum};
use std::path::PathBuf;

/// Shown after the help of `planarise`.
pub(super) const HELP: &str = "\
Examples:
  finwright planarise roof.obj --units m -o roof.json --picture roof.png
      fins on all inner edges, from vertex normals; a picture of planarity before and after
  finwright planarise roof.obj --smooth 4 --boundary-fins --export roof-files
      milder folds, fins on the rim too, and files for Rhino, COMPAS and others";

/// Whether fins are made plane on the way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum PlanariseWhen {
    /// When they are not plane enough
    Auto,
    /// Keep nodes and axes as given
    Never,
}

/// Arguments of `planarise`.
#[derive(Debug, Args)]
pub struct PlanariseArgs {
    /// Mesh to read: .obj, .json (of finwright or COMPAS), or the name of an embedded
    /// structure
    pub mesh: String,

    /// File to write the structure to; standard output if left out
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,

    /// Unit of an OBJ or COMPAS file: mm, cm, m, in or ft [default: mm]
    #[arg(long)]
    pub units: Option<Unit>,

    /// Axes to start from: `vn` (from the file, else vertex normals), `normal`, a direction
    /// X,Y,Z, or point:X,Y,Z (away from that point, in the file's units)
    #[arg(long, default_value = "vn", value_parser = axis_rule, allow_hyphen_values = true)]
    pub axes: AxisRule,

    /// Second mesh with the same faces, whose vertices lie on the axes
    #[arg(long, value_name = "OBJ", conflicts_with_all = ["axis_lines", "upper"])]
    pub axis_mesh: Option<PathBuf>,

    /// Axes as OBJ line segments, one per vertex in order, each starting at its vertex
    #[arg(long, value_name = "OBJ", conflicts_with = "upper")]
    pub axis_lines: Option<PathBuf>,

    /// MESH is the lower one of a pair with the same faces and this is the upper one: nodes
    /// lie midway, fins reach from one to the other
    #[arg(long, value_name = "OBJ")]
    pub upper: Option<PathBuf>,

    /// Smooth the axes before the start: each round brings every axis half way to the mean
    /// of its neighbours; strips then fold less
    #[arg(long, default_value_t = 0, value_name = "ROUNDS")]
    pub smooth: usize,

    /// Vertices nearer than so many mm become one node
    #[arg(long, default_value = "0", value_parser = length, value_name = "MM")]
    pub weld: f64,

    /// How far fins reach along their axes, in mm [default: 0.35 of the median fin length on
    /// each side, or as the file says]
    #[arg(long, value_parser = depth, value_name = "BELOW,ABOVE")]
    pub depth: Option<Depth>,

    /// Nodes held by the ground, for the structure's record: none, boundary, lowest, or a
    /// list of numbers
    #[arg(long, value_parser = fix)]
    pub fix: Option<Fix>,

    /// Fins on boundary edges too; without, strips end at boundary nodes. The boundary is
    /// seldom made for fins: axes turn further
    #[arg(long)]
    pub boundary_fins: bool,

    /// Nodes that may not move: none, boundary, lowest, or a list of numbers
    #[arg(long, value_parser = fix, value_name = "NODES")]
    pub hold: Option<Fix>,

    /// Nodes whose axes may not turn: none, boundary, lowest, or a list of numbers
    #[arg(long, value_parser = fix, value_name = "NODES")]
    pub hold_axes: Option<Fix>,

    /// Worst planarity that is good enough, in percent of a fin's diameter
    #[arg(long, default_value = "0.01", value_parser = positive, value_name = "PERCENT")]
    pub target: f64,

    /// Largest angle between an axis and the surface normal, in degrees
    #[arg(long, default_value = "60", value_parser = positive, value_name = "DEGREES")]
    pub tilt_limit: f64,

    /// How far a node may move, as a share of its shortest edge
    #[arg(long, default_value = "0.2", value_parser = positive, value_name = "SHARE")]
    pub move_limit: f64,

    /// Systems of equations that may be solved before it ends with what it has
    #[arg(long, default_value_t = Options::default().steps, value_name = "COUNT")]
    pub steps: usize,

    /// How much each wish counts.
    #[command(flatten, next_help_heading = "Weights (1 counts a whole fin length)")]
    pub weights: WeightArgs,

    /// Write a picture of planarity before and after (PNG)
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,

    /// Write the structure in every exchange form, and its fins as quads, into this folder
    #[arg(long, value_name = "DIR")]
    pub export: Option<PathBuf>,

    /// Print figures, history and findings as one JSON object on standard output
    #[arg(long)]
    pub json: bool,
}

/// An option for each wish.
#[derive(Debug, Clone)]
pub struct WeightArgs(pub(in crate::cli) Weights);

impl Args for WeightArgs {
    fn augment_args(command: Command) -> Command {
        command.args(WISHES.iter().map(|wish| {
            // clap keeps texts that live as long as the program.
            let default: &'static str = wish.weight.to_string().leak();
            Arg::new(wish.name)
                .long(wish.name)
                .value_name("W")
                .value_parser(weight)
                .default_value(default)
                .help(wish.sentence)
        }))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for WeightArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let chosen = |wish: &Wish| matches.get_one(wish.name).copied();
        let weighed = |weights: Weights, wish| match chosen(wish) {
            Some(weight) => weights.with(wish, weight),
            None => weights,
        };
        Ok(Self(WISHES.iter().fold(Weights::default(), weighed)))
    }

    fn update_from_arg_matches(
        &mut self,
        matches: &ArgMatches,
    ) -> Result<(), clap::Error> {
        Self::from_arg_matches(matches).map(|weights| *self = weights)
    }
}

fn weight(text: &str) -> Result<f64, String> {
    match numbers(text)?.as_slice() {
        &[weight] if (0.0..=1e6).contains(&weight) => Ok(weight),
        _ => Err(format!("{text:?} is no weight; write a number from 0 to 1000000")),
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match numbers(text)?.as_slice() {
        &[number] if number > 0.0 => Ok(number),
        _ => Err(format!("{text:?} is no number above zero")),
    }
}
