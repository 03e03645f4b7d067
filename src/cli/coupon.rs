//! `coupon`: pieces to try a material with, and what they told.

use crate::cli::input;
use crate::cli::jobdir::{self, JobDirError};
use crate::cli::run::{End, Failure, draw, named, print};
use crate::cli::show::Voice;
use crate::export;
use crate::gate::approve_loose;
use crate::job;
use crate::joint::Joint;
use crate::nest::Effort;
use crate::parts::{CouponMark, Fitted};
use crate::report::{self, Source};
use crate::template::{self, Template};
use crate::vendor;
use clap::Args;
use std::path::{Path, PathBuf};

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

/// Makes a coupon, or a template from what one told.
pub(super) fn run(args: &CouponArgs, voice: Voice) -> Result<End, Failure> {
    let template = input::template(&args.template)?;
    match &args.set {
        Some(marks) => set(args, &template, marks, voice),
        None => make(args, &template, voice),
    }
}

fn make(args: &CouponArgs, template: &Template, voice: Voice) -> Result<End, Failure> {
    let dir = args.output.clone().unwrap_or_else(|| Path::new("out").join("coupon"));
    jobdir::may_be_written(&dir)?;
    let job = job::coupon(template, &Effort { trials: 8, seed: 0 }, &mut ())?;
    voice.findings(&job.findings);
    let template_sha256 = input::sha256(template.source.as_bytes());
    let source = Source {
        input: "coupon",
        input_sha256: &template_sha256,
        template,
        template_sha256: &template_sha256,
        seed: 0,
        scale: "1:1",
        joint: Joint::Lap,
    };
    let mut manifest = report::manifest(&job, &source);
    let pretty = serde_json::to_string_pretty(&manifest).unwrap_or_default() + "\n";
    let bill = report::bill(&job, &template.material.name);
    let mut files = vec![
        named(("job.json".to_owned(), pretty.into_bytes())),
        named(("parts.csv".to_owned(), bill.into_bytes())),
    ];
    let cut = approve_loose(&job.sheets, &job.findings);
    let vendor = job.vendor.as_ref().and_then(|v| approve_loose(v, &job.findings));
    let cut = cut.map(|sheets| {
        let vendor = vendor.iter().flat_map(vendor::files);
        export::cut_files(&sheets).into_iter().chain(vendor).collect()
    });
    let drawn = draw(&job, cut, &mut files, &mut manifest, voice);
    jobdir::write(&dir, &files)?;
    if args.json {
        print(&format!("{manifest}\n"));
    }
    voice.say(&format!("{} pieces in {}", job.parts.len(), dir.display()));
    Ok(drawn.end)
}

fn set(
    args: &CouponArgs,
    template: &Template,
    marks: &[CouponMark],
    voice: Voice,
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
    voice.say(&format!(
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
