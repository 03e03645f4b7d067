//! The commands, and the only place that writes files.

use crate::cli::advise;
use crate::cli::args::{CheckArgs, Cli, Command, EffortLevel, InputArgs, MakeArgs};
use crate::cli::coupon;
use crate::cli::embedded;
use crate::cli::input::{self, Input, InputError};
use crate::cli::jobdir::{self, JobDirError, JobFile};
use crate::cli::joint;
use crate::cli::nest;
use crate::cli::picture;
use crate::cli::planarise;
use crate::cli::rigidity;
use crate::cli::show::{self, Terminal, Voice};
use crate::cli::verify::{self, VerifyError, prove_before_writing};
use crate::diagnostic::{Finding, Place, passes};
use crate::export;
use crate::job::{self, Interrupted, Job, Order};
use crate::joint::Joint;
use crate::nest::Effort;
use crate::proof::Proof;
use crate::replacement;
use crate::report::{self, Page, Source};
use crate::structure::{Structure, write_json};
use crate::template::Template;
use crate::vendor;
use crate::watch::Watch;
use clap::CommandFactory;
use miette::Diagnostic;
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

/// How a command ended; the number is the exit code (contract §1).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    Done = 0,
    CouldNotRun = 1,
    Refused = 3,
    Interrupted = 4,
}

/// Why a command could not run.
pub(super) enum Failure {
    Other(Box<dyn Diagnostic>),
    Input(InputError),
    JobDir(JobDirError),
    Verify(VerifyError),
    Interrupted,
    /// What was wrong has been said.
    Said(End),
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Self::Input(error)
    }
}

impl From<JobDirError> for Failure {
    fn from(error: JobDirError) -> Self {
        Self::JobDir(error)
    }
}

impl From<VerifyError> for Failure {
    fn from(error: VerifyError) -> Self {
        Self::Verify(error)
    }
}

impl From<Interrupted> for Failure {
    fn from(_: Interrupted) -> Self {
        Self::Interrupted
    }
}

/// Runs a command line.
pub fn run(cli: Cli) -> ExitCode {
    let voice = Voice { quiet: cli.quiet, verbose: cli.verbose };
    let json = match &cli.command {
        Command::Make(args) => args.input.json,
        Command::Verify(args) => args.json,
        Command::Coupon(args) => args.json,
        Command::Check(args) => args.input.json,
        Command::Nest(args) => args.json,
        Command::Rigidity(args) => args.input.json,
        _ => false,
    };
    let end = match cli.command {
        Command::Make(args) => make(&args, voice),
        Command::Check(args) if args.advise => advise::run(&args.input, voice),
        Command::Check(args) => check(&args, voice),
        Command::Rigidity(args) => rigidity::rigidity(&args, voice),
        Command::Coupon(args) => coupon::run(&args, voice),
        Command::Verify(args) => verify::run(&args, voice),
        Command::Planarise(args) => planarise::run(&args, voice),
        Command::Nest(args) => nest::run(&args, voice),
        Command::Template { action } => embedded::templates(action),
        Command::Example { action } => embedded::example(action),
        Command::Completions { shell } => {
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "finwright", &mut text);
            Ok(print(&String::from_utf8_lossy(&text)))
        }
    };
    let end = end.unwrap_or_else(|failure| match failure {
        Failure::Input(error) => {
            complain(&error, &error.to_string(), json.then(|| error.findings()))
        }
        Failure::JobDir(error) => tell(&error, json),
        Failure::Verify(error) => tell(&error, json),
        Failure::Other(error) => tell(&*error, json),
        Failure::Interrupted => {
            let _ = writeln!(std::io::stderr(), "interrupted; nothing was written");
            End::Interrupted
        }
        Failure::Said(end) => end,
    });
    ExitCode::from(end as u8)
}

/// As [`complain`], of an error that is its own finding.
fn tell(error: &dyn Diagnostic, json: bool) -> End {
    let findings = || vec![Finding::new(error, Place::default())];
    complain(error, &error.to_string(), json.then(findings))
}

/// Says what went wrong, always; as JSON too, if it was asked for.
pub(super) fn complain(
    error: &dyn Diagnostic,
    message: &str,
    json: Option<Vec<Finding>>,
) -> End {
    if let Some(findings) = json {
        print(&format!("{}\n", check_json(&findings)));
    }
    let mut stderr = std::io::stderr();
    let _ = writeln!(stderr, "error: {message}");
    if let (Some(code), Some(help)) = (error.code(), error.help()) {
        let _ = writeln!(stderr, "  {code}: {help}");
    }
    End::CouldNotRun
}

/// Prints on standard output; a reader that went away is no fault of ours.
pub(super) fn print(text: &str) -> End {
    let _ = std::io::stdout().write_all(text.as_bytes());
    End::Done
}

/// A job with what it was made from.
struct Ordered {
    job: Job,
    input: Input,
    template: Template,
    template_sha256: String,
    terminal: Terminal,
}

/// What `make` wants beyond what `check` does.
#[derive(Default)]
struct Wishes {
    accepted_flexible: Option<String>,
    apply_remedies: bool,
}

fn ordered(args: &InputArgs, wishes: Wishes, voice: Voice) -> Result<Ordered, Failure> {
    let mut template = input::template(&args.template)?.with_hub_nodes(&args.hubs);
    let mut input = input::structure(args)?;
    let mut terminal = Terminal::new(voice, args.time_limit);
    let worst = template.gate.planarity_warn_percent / 100.0;
    planarise::when_needed(&mut input, args, worst, &mut terminal)?;
    let draft = std::mem::take(&mut input.draft);
    if wishes.apply_remedies {
        template = job::with_remedies(&draft, template, &mut terminal)?;
        voice.say(&format!("hubs on nodes {:?}", template.joint.hub_nodes));
    }
    let order = Order {
        draft,
        template: &template,
        joint: args.joint,
        effort: effort(args),
        accepted_flexible: wishes.accepted_flexible,
    };
    let job = job::run(order, &mut terminal);
    terminal.finish();
    let mut job = job?;
    job.findings.splice(0..0, input.findings.drain(..));
    let template_sha256 = input::sha256(template.source.as_bytes());
    Ok(Ordered { job, input, template, template_sha256, terminal })
}

fn effort(args: &InputArgs) -> Effort {
    let trials = match args.effort {
        EffortLevel::Quick => 1,
        EffortLevel::Normal => 8,
        EffortLevel::Thorough => 64,
    };
    let trials = if args.time_limit.is_some() { u32::MAX } else { trials };
    Effort { trials, seed: args.seed }
}

fn make(args: &MakeArgs, voice: Voice) -> Result<End, Failure> {
    joint::may_have_hubs(&args.input, args.apply_remedies);
    if let Some(dir) = &args.output {
        jobdir::may_be_written(dir)?;
    }
    let apply_remedies = args.apply_remedies;
    let wishes =
        Wishes { accepted_flexible: args.accept_flexible.clone(), apply_remedies };
    let mut ordered = ordered(&args.input, wishes, voice)?;
    voice.findings(&ordered.job.findings);
    ordered.terminal.resume("export");
    ordered.keep(args)?;
    let job = &ordered.job;
    let name = job.structure.as_ref().map(Structure::name).unwrap_or_default();
    let dir = args
        .output
        .clone()
        .unwrap_or_else(|| Path::new("out").join(folder_name(name, job)));
    let source = ordered.source(&args.input);
    let mut manifest = report::manifest(job, &source);
    let mut files = ordered.files(&manifest);
    let cut = cut_files(job, args.input.joint, &ordered.template);
    let Drawn { end, proof } = draw(job, cut, &mut files, &mut manifest, voice);
    let proof = proof.as_ref();
    let is_approved = end == End::Done;
    let page = Page { job, source: &source, manifest: &manifest, proof, is_approved };
    files.push(named(("report.html".to_owned(), report::page(&page).into_bytes())));
    if is_approved && job.only.is_empty() {
        let guide = report::guide(job, &source);
        files.extend(guide.map(|pdf| named(("assembly.pdf".to_owned(), pdf))));
    }
    ordered.terminal.finish();
    if ordered.terminal.stopped() {
        return Err(Failure::Interrupted);
    }
    if job.structure.is_some() {
        jobdir::write(&dir, &files)?;
    }
    if args.input.json {
        print(&format!("{manifest}\n"));
    }
    if let (End::Refused, Some(verdict)) = (end, &job.verdict) {
        verdict.remedies_in_words().iter().for_each(|line| voice.say(line));
    }
    voice.say(&summary(job, end, &dir));
    Ok(end)
}

/// What became of the files for the laser.
pub(super) struct Drawn {
    /// Whether they are there.
    pub end: End,
    /// What they prove, if they could be read.
    pub proof: Option<Proof>,
}

/// The files for the laser, of the sheets and for the vendor, if nothing forbids them.
fn cut_files(job: &Job, joint: Joint, template: &Template) -> Option<Vec<export::File>> {
    let sheets = job.approved(joint, template).ok()?;
    let mut files = export::cut_files(&sheets);
    let vendor = job.approved_vendor(joint, template);
    files.extend(vendor.iter().flat_map(vendor::files));
    (!job.sheets.is_empty()).then_some(files)
}

/// Adds the files for the laser if nothing forbids it and they can be proved, else stamped
/// pictures.
pub(super) fn draw(
    job: &Job,
    cut: Option<Vec<export::File>>,
    files: &mut Vec<JobFile>,
    manifest: &mut serde_json::Value,
    voice: Voice,
) -> Drawn {
    let mut proof = None;
    if let Some(cut) = cut {
        let kept = files.len();
        files.extend(cut.into_iter().map(named));
        let (proved, found) = prove_before_writing(files, manifest);
        voice.findings(&found);
        proof = proved;
        if passes(&found) {
            return Drawn { end: End::Done, proof };
        }
        files.truncate(kept);
    }
    files.extend(export::stamped_previews(&job.sheets).into_iter().map(named));
    Drawn { end: End::Refused, proof }
}

/// A name that can be a folder.
fn folder_name(name: &str, job: &Job) -> String {
    // Most disks take 255 bytes; a character may have four.
    const LONGEST: usize = 50;
    let safe = |c: char| if c.is_alphanumeric() || "-_ .".contains(c) { c } else { '-' };
    let name: String = name.chars().map(safe).take(LONGEST).collect();
    let name = name.trim_matches(['.', ' ']);
    let name = if name.is_empty() { "job" } else { name };
    let end = if job.only.is_empty() { "" } else { "-only" };
    format!("{name}{end}")
}

pub(super) fn named((path, bytes): (String, Vec<u8>)) -> JobFile {
    JobFile { path, bytes }
}

fn summary(job: &Job, end: End, dir: &Path) -> String {
    let parts: usize = job.parts.iter().map(|part| part.quantity).sum();
    let sheets = job.sheets.len();
    match end {
        End::Done => {
            let plural = if sheets == 1 { "" } else { "s" };
            let page = dir.join("report.html");
            let (dir, page) = (dir.display(), page.display());
            format!("{parts} parts on {sheets} sheet{plural} in {dir}; {page} tells all")
        }
        _ if job.structure.is_some() => format!(
            "refused: no cut file was written; {} says why",
            dir.join("report.html").display()
        ),
        _ => "refused: there is no structure to make parts of".to_owned(),
    }
}

impl Ordered {
    /// Keeps the parts that were asked for, on sheets of their own.
    fn keep(&mut self, args: &MakeArgs) -> Result<(), Failure> {
        if args.only.is_empty() || self.job.parts.is_empty() {
            return Ok(());
        }
        let names = replacement::named(&self.job, &args.only)
            .map_err(|error| Failure::Said(tell(&error, args.input.json)))?;
        let (job, effort) = (std::mem::take(&mut self.job), effort(&args.input));
        self.job =
            replacement::only(job, names, &self.template, &effort, &mut self.terminal)?;
        Ok(())
    }

    fn source<'a>(&'a self, args: &'a InputArgs) -> Source<'a> {
        Source {
            input: &self.input.file,
            input_sha256: &self.input.sha256,
            template: &self.template,
            template_sha256: &self.template_sha256,
            seed: args.seed,
            scale: &args.scale.text,
            joint: args.joint,
        }
    }

    /// The files that stand in every job directory.
    fn files(&self, manifest: &serde_json::Value) -> Vec<JobFile> {
        let text = |path: &str, text: String| named((path.to_owned(), text.into_bytes()));
        let pretty = serde_json::to_string_pretty(manifest).unwrap_or_default() + "\n";
        let mut files = vec![
            text("job.json", pretty),
            text("parts.csv", report::bill(&self.job, &self.template.material.name)),
        ];
        let structure = self.job.structure.as_ref();
        files.extend(structure.map(|s| text("structure.json", write_json(s))));
        files
    }
}

fn check(check: &CheckArgs, voice: Voice) -> Result<End, Failure> {
    let args = &check.input;
    joint::may_have_hubs(args, false);
    let ordered = ordered(args, Wishes::default(), voice)?;
    picture::draw(&check.drawing, &ordered.job, &ordered.template)?;
    let findings = &ordered.job.findings;
    voice.findings(findings);
    let fine = passes(findings);
    if let Some(structure) = &ordered.job.structure {
        voice.say(&show::about(structure));
    }
    if args.json {
        print(&format!("{}\n", check_json(findings)));
    }
    voice.say(match (fine, findings.is_empty()) {
        (true, true) => "nothing wrong was found: it can be cut",
        (true, false) => "it can be cut",
        (false, _) => "it cannot be cut as it is",
    });
    Ok(if fine { End::Done } else { End::Refused })
}

pub(super) fn check_json(findings: &[Finding]) -> serde_json::Value {
    serde_json::json!({"passes": passes(findings), "findings": findings})
}
