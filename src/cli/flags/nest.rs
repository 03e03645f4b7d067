//! `nest`.

use crate::cli::flags::drawing::DrawingArgs;
use crate::cli::flags::value::{EffortLevel, length, seconds, size};
use clap::Args;
use std::path::PathBuf;

/// Shown after the help of `nest`.
pub(super) const HELP: &str = "\
Examples:
  finwright nest parts.json -o out/parts
      parts on the sheets that the file names
  finwright nest drawing.dxf -t pmma-cast-3
      the closed lines of a drawing with what is engraved on them, on the template's sheets
  finwright nest a.svg b.dxf --sheet 600x400 --join 0.2 --layers Plan=ignore --quantity 3
      parts of two drawings, three of each, small gaps closed, without the lines of one layer
  finwright nest parts.json --sheet 600x400 --sheet 1000x600 --spacing 2 --margin 5
      on sheets of two sizes, as many of each as needed; the smaller one is tried first
  finwright nest swim.json --time-limit 60
      a strip-packing instance; the units of work that repeat the result are printed
  finwright nest --check out/parts/layout.json
      whether parts overlap, come too near, or reach into the margin";

/// Arguments of `nest`.
#[derive(Debug, Args)]
pub struct NestArgs {
    /// Parts to nest: drawings (.dxf, .svg), or one finwright-parts or strip-packing file
    /// (.json)
    #[arg(required = true)]
    pub input: Vec<PathBuf>,

    #[command(flatten)]
    pub drawing: DrawingArgs,

    /// Only check a layout.json that was written before
    #[arg(long)]
    pub check: bool,

    /// Take the sheets of this template [default: as the file says, else pmma-cast-3]
    #[arg(short, long, value_name = "TEMPLATE", conflicts_with = "sheet")]
    pub template: Option<String>,

    /// Size of a sheet in mm; may be given more than once
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub sheet: Vec<[f64; 2]>,

    /// Least distance between parts, mm [default: as the file says, else 2 on sheets and 0
    /// in strips]
    #[arg(long, value_name = "MM", value_parser = length)]
    pub spacing: Option<f64>,

    /// Free strip along the sheet's edge, mm [default: as the file says, else 5 on sheets
    /// and 0 in strips]
    #[arg(long, value_name = "MM", value_parser = length)]
    pub margin: Option<f64>,

    /// Keep holes of parts free
    #[arg(long)]
    pub no_parts_in_holes: bool,

    /// Folder for layout and sheets [default: out/<name>]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,

    /// Seed of the search
    #[arg(long, default_value_t = 0)]
    pub seed: u64,

    /// How hard to search
    #[arg(long, value_enum, default_value = "normal")]
    pub effort: EffortLevel,

    /// Search for this many units of work instead
    #[arg(long, value_name = "UNITS", conflicts_with_all = ["effort", "time_limit"])]
    pub work: Option<u32>,

    /// Search for this long instead; prints the units of work that repeat the result
    #[arg(long, value_name = "SECONDS", conflicts_with = "effort",
          value_parser = seconds)]
    pub time_limit: Option<f64>,

    /// Keep a picture (PNG) of the best layout so far here while searching
    #[arg(long, value_name = "FILE")]
    pub snapshot: Option<PathBuf>,

    /// Print layout.json on standard output
    #[arg(long)]
    pub json: bool,
}
