//! How drawings are read.

use crate::cli::flags::value::length;
use crate::drawing::Purpose;
use crate::nest::Rotations;
use crate::units::Unit;
use clap::Args;

/// How drawings are read.
#[derive(Debug, Clone, Args)]
pub struct DrawingArgs {
    /// Unit of a drawing, whatever it says: mm, cm, m, in, ft
    #[arg(long, value_name = "UNIT")]
    pub units: Option<Unit>,

    /// User units to the inch of an SVG without a unit [default: 96]
    #[arg(long, value_name = "DPI", value_parser = dpi)]
    pub dpi: Option<f64>,

    /// Close gaps in the lines of a drawing up to this width, mm
    #[arg(long, value_name = "MM", value_parser = length)]
    pub join: Option<f64>,

    /// What is done along the lines of a layer, or of a colour written #ff0000: cut,
    /// engrave or ignore; may be given more than once
    #[arg(long, value_name = "NAME=WHAT", value_parser = layer)]
    pub layers: Vec<(String, Purpose)>,

    /// So many of each part of a drawing
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub quantity: Option<u32>,

    /// By which angles parts of a drawing may be rotated: free, none, or degrees such as
    /// 0,180
    #[arg(long, value_name = "ANGLES", value_parser = rotations)]
    pub rotations: Option<Rotations>,
}

fn dpi(text: &str) -> Result<f64, String> {
    let dpi = text.parse::<f64>().ok().filter(|dpi| (1.0..=1e5).contains(dpi));
    dpi.ok_or_else(|| format!("{text:?} is no number of user units to the inch"))
}

fn layer(text: &str) -> Result<(String, Purpose), String> {
    let wrong = || format!("{text:?}: write NAME=cut, NAME=engrave or NAME=ignore");
    let (name, purpose) = text.rsplit_once('=').ok_or_else(wrong)?;
    let purpose = match purpose {
        "cut" => Purpose::Cut,
        "engrave" => Purpose::Engrave,
        "ignore" => Purpose::Ignore,
        _ => return Err(wrong()),
    };
    Ok((name.to_owned(), purpose))
}

fn rotations(text: &str) -> Result<Rotations, String> {
    let degrees = |text: &str| {
        let degrees = text.trim().parse::<f64>().ok().filter(|d| d.is_finite());
        degrees.map(f64::to_radians)
    };
    let listed = || text.split(',').map(degrees).collect::<Option<Vec<f64>>>();
    match text {
        "free" => Ok(Rotations::Free),
        "none" => Ok(Rotations::Only(vec![0.0])),
        _ => listed().map(Rotations::Only).ok_or_else(|| {
            format!("{text:?} is none of free, none, or degrees such as 0,180")
        }),
    }
}
