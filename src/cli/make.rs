//! `make`: a job directory.

use crate::cli::console::{Console, Terminal};
use crate::cli::flags::may_have_hubs;
use crate::cli::flags::structure::MakeArgs;
use crate::cli::input;
use crate::cli::jobdir;
use crate::cli::outcome::{End, Failure, print};
use crate::job::{self, Job, Specification};
use crate::json;
use crate::structure::Structure;
use std::path::Path;

/// Runs the command.
pub(super) fn run(args: &MakeArgs, console: Console) -> Result<End, Failure> {
    may_have_hubs(&args.input, args.apply_remedies);
    if let Some(dir) = &args.output {
        jobdir::may_be_written(dir)?;
    }
    let mut specification = Specification {
        apply_remedies: args.apply_remedies,
        only: args.only.clone(),
        ..input::specification(&args.input)?
    };
    specification.settings.accepted_flexible = args.accept_flexible.clone();
    let mut terminal = Terminal::new(console, args.input.time_limit);
    let job = job::make(specification, &mut terminal);
    terminal.finish();
    let job = job?;
    let made = &job.fabrication;
    if args.apply_remedies {
        console.say(&format!("hubs on nodes {:?}", made.settings.hub_nodes));
    }
    console.findings(&made.findings);
    console.findings(&job.proof_findings);
    let dir = || Path::new("out").join(folder_name(&job));
    let dir = jobdir::place(&args.output.clone().unwrap_or_else(dir), job.end);
    if made.structure.is_some() {
        let kept = jobdir::write(&dir, &job.files)?;
        kept.iter().for_each(|kept| console.say(&kept.to_string()));
    }
    if args.input.json {
        print(&json::line(&job.manifest).map_err(Failure::of)?);
    }
    if let (job::End::Refused, Some(verdict)) = (job.end, &made.verdict) {
        verdict.remedies_in_words().iter().for_each(|line| console.say(line));
    }
    console.say(&summary(&job, &dir));
    Ok(job.end.into())
}

/// A name that can be a folder.
fn folder_name(job: &Job) -> String {
    let structure = job.fabrication.structure.as_ref();
    let name = structure.map(Structure::name).unwrap_or_default();
    // Most disks take 255 bytes; a character may have four.
    const LONGEST: usize = 50;
    let safe = |c: char| if c.is_alphanumeric() || "-_ .".contains(c) { c } else { '-' };
    let name: String = name.chars().map(safe).take(LONGEST).collect();
    let name = name.trim_matches(['.', ' ']);
    let name = if name.is_empty() { "job" } else { name };
    let end = if job.fabrication.only.is_empty() { "" } else { "-only" };
    format!("{name}{end}")
}

fn summary(job: &Job, dir: &Path) -> String {
    let made = &job.fabrication;
    let parts: usize = made.parts.iter().map(|part| part.quantity).sum();
    let sheets = made.sheets.len();
    match job.end {
        job::End::Approved => {
            let plural = if sheets == 1 { "" } else { "s" };
            let page = dir.join("report.html");
            let (dir, page) = (dir.display(), page.display());
            format!("{parts} parts on {sheets} sheet{plural} in {dir}; {page} tells all")
        }
        _ if made.structure.is_some() => format!(
            "refused: no cut file was written; {} says why",
            dir.join("report.html").display()
        ),
        _ => "refused: there is no structure to make parts of".to_owned(),
    }
}
