//! `check`: everything that is wrong with a structure.

use crate::cli::advise;
use crate::cli::console::{Console, Terminal, about};
use crate::cli::flags::may_have_hubs;
use crate::cli::flags::structure::CheckArgs;
use crate::cli::input;
use crate::cli::outcome::{End, Failure, check_json, print};
use crate::cli::picture;
use crate::diagnostic::passes;
use crate::job;

/// Runs the command.
pub(super) fn run(check: &CheckArgs, console: Console) -> Result<End, Failure> {
    let args = &check.input;
    if check.advise {
        return advise::run(args, console);
    }
    may_have_hubs(args, false);
    let specification = input::specification(args)?;
    let mut terminal = Terminal::new(console, args.time_limit);
    let found = job::check(specification, &mut terminal);
    terminal.finish();
    let found = found?;
    picture::draw(&check.drawing, &found)?;
    let findings = &found.findings;
    console.findings(findings);
    if let Some(structure) = &found.structure {
        console.say(&about(structure));
    }
    if args.json {
        print(&format!("{}\n", check_json(findings)));
    }
    console.say(match (passes(findings), findings.is_empty()) {
        (true, true) => "nothing wrong was found: it can be cut",
        (true, false) => "it can be cut",
        (false, _) => "it cannot be cut as it is",
    });
    Ok(End::of(findings))
}
