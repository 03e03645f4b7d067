//! `verify`.

use clap::Args;
use std::path::PathBuf;

/// Arguments of `verify`.
#[derive(Debug, Args)]
pub struct VerifyArgs {
    /// Folder that `finwright make` wrote, its files edited or not
    #[arg(value_name = "JOBDIR")]
    pub job: PathBuf,

    /// Print one JSON object on standard output
    #[arg(long)]
    pub json: bool,
}

/// Help after the options.
pub(super) const HELP: &str = "\
Example:
  finwright make dome && finwright verify out/dome
      reads the DXF, SVG and PDF files back, folds the parts and compares with the structure";
