//! The `finwright` command.

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    finwright::cli::run(finwright::cli::Cli::parse())
}
