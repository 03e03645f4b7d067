//! `coupon`: pieces to try a material with, and what they told.

use crate::cli::console::{Console, Terminal};
use crate::cli::flags::coupon::CouponArgs;
use crate::cli::input;
use crate::cli::jobdir::{self, JobDirError};
use crate::cli::outcome::{End, Failure, print};
use crate::job;
use crate::json;
use crate::parts::{CouponMark, Fitted};
use crate::settings::Settings;
use crate::template::{self, Template};
use std::path::Path;

/// Makes a coupon, or a template from what one told.
pub(super) fn run(args: &CouponArgs, console: Console) -> Result<End, Failure> {
    let template = input::template(&args.template)?;
    match &args.set {
        Some(marks) => set(args, &template, marks, console),
        None => make(args, template, console),
    }
}

fn make(args: &CouponArgs, template: Template, console: Console) -> Result<End, Failure> {
    let dir = args.output.clone().unwrap_or_else(|| Path::new("out").join("coupon"));
    jobdir::may_be_written(&dir)?;
    let mut terminal = Terminal::new(console, None);
    let job = job::coupon(Settings::new(template), &mut terminal);
    terminal.finish();
    let job = job?;
    console.findings(&job.fabrication.findings);
    console.findings(&job.proof_findings);
    let dir = jobdir::place(&dir, job.end);
    let kept = jobdir::write(&dir, &job.files)?;
    kept.iter().for_each(|kept| console.say(&kept.to_string()));
    if args.json {
        print(&json::line(&job.manifest).map_err(Failure::of)?);
    }
    console.say(&format!("{} pieces in {}", job.fabrication.parts.len(), dir.display()));
    Ok(job.end.into())
}

fn set(
    args: &CouponArgs,
    template: &Template,
    marks: &[CouponMark],
    console: Console,
) -> Result<End, Failure> {
    let material = &template.material;
    let made = Fitted { kerf: material.kerf_mm, clearance: material.clearance_mm };
    let fitted = Fitted::read(made, marks);
    let kerf = fitted.kerf.max(0.0);
    let marks: Vec<String> =
        marks.iter().map(|mark| format!("{}{}", mark.number, mark.piece)).collect();
    let why = format!("from the coupon of {}: {}", template.name, marks.join(", "));
    let text = with_value(&template.source, "kerf_mm", kerf, &why);
    let text = with_value(&text, "clearance_mm", fitted.clearance, &why);
    // A fit out of range is told as any template's fault is.
    template::read(&text, &template.name).map_err(input::InputError::BadTemplate)?;
    console.say(&format!(
        "kerf {} mm (was {}), clearance {} mm (was {})",
        short(kerf),
        made.kerf,
        short(fitted.clearance),
        made.clearance
    ));
    if args.json {
        let value = serde_json::json!({
            "kerf_mm": kerf, "clearance_mm": fitted.clearance,
        });
        print(&format!("{value}\n"));
    }
    match &args.output {
        Some(path) => {
            let path = path.clone();
            std::fs::write(&path, text)
                .map_err(|source| JobDirError::Disk { path, source })?;
            Ok(End::Done)
        }
        None if args.json => Ok(End::Done),
        None => Ok(print(&text)),
    }
}

fn short(mm: f64) -> f64 {
    (mm * 1e4).round() / 1e4 + 0.0
}

/// A template's text with another value for a key and the reason beside it.
fn with_value(source: &str, key: &str, mm: f64, why: &str) -> String {
    let line = |line: &str| match line.trim_start().split(['=', ' ']).next() {
        Some(found) if found == key => format!("{key} = {:?}  # {why}\n", short(mm)),
        _ => format!("{line}\n"),
    };
    source.lines().map(line).collect()
}
