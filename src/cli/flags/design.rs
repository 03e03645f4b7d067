//! `design`.

use crate::cli::flags::value::{ForScale, axis_rule, cell, depth, fix, for_scale};
use crate::job::{Depth, Fix};
use crate::structure::AxisRule;
use crate::units::Unit;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Shown after the help of `design`.
pub(super) const HELP: &str = "\
Examples:
  finwright design --cell 40 -o hill.json --picture hill.png
      fins about 40 mm long on the embedded surface `hill`, and a picture of the way there
  finwright design roof.obj --units m --nodes 700 --align boundary -o roof.json --json
      about 700 nodes, fins along the boundary, figures as JSON";

/// Whether fins run along the boundary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum AlignWhen {
    /// When axes turn little for it
    Auto,
    /// Cells are trimmed at the boundary
    None,
    /// Always, if there is a valid net
    Boundary,
}

/// Whether symmetry is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SymmetryWhen {
    /// In up to two planes through the middle
    Auto,
    /// Not at all
    None,
}

/// Arguments of `design`.
#[derive(Debug, Args)]
pub struct DesignArgs {
    /// Surface to read: .obj, .stl, .ply, .json (of finwright or COMPAS), or the name of an
    /// embedded one [default: hill]
    pub surface: Option<String>,

    /// File to write the structure to; standard output if left out
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,

    /// Unit of an OBJ, STL, PLY or COMPAS file: mm, cm, m, in or ft [default: mm]
    #[arg(long)]
    pub units: Option<Unit>,

    /// Wanted axes: `vn` (from the file, else the surface's normals), `normal`, a direction
    /// X,Y,Z, or point:X,Y,Z (away from that point, in the file's units)
    #[arg(long, default_value = "vn", value_parser = axis_rule, allow_hyphen_values = true)]
    pub axes: AxisRule,

    /// Wanted length of a fin, in mm of the surface; of two, the first is of fins that run more
    /// along the surface's longest extent (family 1)
    #[arg(long, value_parser = cell, value_name = "MM[,MM]", conflicts_with = "nodes")]
    pub cell: Option<[f64; 2]>,

    /// Wanted number of nodes, met within a tenth [default without --cell: 700]
    #[arg(long, value_name = "N")]
    pub nodes: Option<usize>,

    /// Whether fins run along the boundary
    #[arg(long, value_enum, default_value = "none")]
    pub align: AlignWhen,

    /// Lines inside that fins follow: auto for creases, or an OBJ file with polylines (`l`), in
    /// the surface's units
    #[arg(long, value_name = "auto|FILE")]
    pub follow: Option<String>,

    /// Nodes inside with other than four fins: auto, none, or a file with a line X Y Z FINS for
    /// each, in the surface's units
    #[arg(long, default_value = "auto", value_name = "auto|none|FILE")]
    pub singular: String,

    /// Whether a surface that is its own mirror image gets a mesh that is: one sector is
    /// designed, and reflected
    #[arg(long, value_enum, default_value = "none")]
    pub symmetry: SymmetryWhen,

    /// Let axes turn, by up to 13 degrees, for fins of more even length
    #[arg(long)]
    pub even: bool,

    /// Say what `check` says of it at this model scale, in the default or another material
    #[arg(long = "for", value_parser = for_scale, value_name = "1:N[,TEMPLATE]")]
    pub for_scale: Option<ForScale>,

    /// For the record: nothing is drawn at random here, and results do not depend on it
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub seed: u64,

    /// How far fins reach along their axes, in mm of the surface [default: 0.35 of the wanted
    /// fin length on each side]
    #[arg(long, value_parser = depth, value_name = "BELOW,ABOVE")]
    pub depth: Option<Depth>,

    /// Nodes held by the ground, for the structure's record: none, boundary, lowest, or a
    /// list of numbers
    #[arg(long, value_parser = fix)]
    pub fix: Option<Fix>,

    /// Fins on boundary edges too; without, strips end at boundary nodes
    #[arg(long)]
    pub boundary_fins: bool,

    /// Write a picture: axes and directions, the mesh, planarity before and after (PNG)
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,

    /// Print figures and findings as one JSON object on standard output
    #[arg(long)]
    pub json: bool,
}
