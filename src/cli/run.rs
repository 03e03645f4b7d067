//! From a command line to an exit code.

use crate::cli::check;
use crate::cli::coupon;
use crate::cli::design;
use crate::cli::embedded;
use crate::cli::flags::{Cli, Command};
use crate::cli::make;
use crate::cli::nest;
use crate::cli::outcome::print;
use crate::cli::planarise;
use crate::cli::rigidity;
use crate::cli::verify;
use clap::CommandFactory;
use std::process::ExitCode;

/// Runs a command line.
pub fn run(cli: Cli) -> ExitCode {
    let (console, json) = (cli.console, cli.command.wants_json());
    let end = match cli.command {
        Command::Make(args) => make::run(&args, console),
        Command::Check(args) => check::run(&args, console),
        Command::Rigidity(args) => rigidity::run(&args, console),
        Command::Coupon(args) => coupon::run(&args, console),
        Command::Verify(args) => verify::run(&args, console),
        Command::Design(args) => design::run(&args, console),
        Command::Planarise(args) => planarise::run(&args, console),
        Command::Nest(args) => nest::run(&args, console),
        Command::Template { action } => embedded::templates(action),
        Command::Example { action } => embedded::example(action),
        Command::Completions { shell } => {
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "finwright", &mut text);
            Ok(print(&String::from_utf8_lossy(&text)))
        }
    };
    ExitCode::from(end.unwrap_or_else(|failure| failure.end(json)) as u8)
}
