//! `coupon`.

use crate::parts::CouponMark;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `coupon`.
#[derive(Debug, Args)]
pub struct CouponArgs {
    /// Material and machine: name of an embedded template, or a .toml file
    #[arg(short, long, default_value = "pmma-cast-3")]
    pub template: String,

    /// Folder of the coupon [default: out/coupon]; with --set the .toml file to write
    /// [default: standard output]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,

    /// What fitted: the notch of piece a that just holds the plug, slits of b to e
    #[arg(long, value_name = "5a,3b", value_delimiter = ',')]
    pub set: Option<Vec<CouponMark>>,

    /// Print one JSON object on standard output
    #[arg(long)]
    pub json: bool,
}

/// Help after the options.
pub(super) const HELP: &str = "\
Examples:
  finwright coupon -t pmma-cast-3
      sheets with a kerf comb (a), slits at 90, 75, 60 and 45 degrees (b to e), a bend strip
      and lettering, into out/coupon
  finwright coupon -t pmma-cast-3 --set 6a,3b -o mine.toml
      the plug p just held in notch 6 of a, the plate s went well into slit 3 of b:
      a template with the kerf and the clearance that follow";
