//! What is said on the terminal: findings, progress, a summary. All of it on stderr.

pub(super) use crate::cli::flags::Console;
use crate::diagnostic::{Finding, Severity};
use crate::structure::Structure;
use crate::watch::Watch;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Findings of one kind that are shown before the rest is only counted.
const FEW: usize = 3;

impl Console {
    /// Says a line unless told to be quiet.
    pub(super) fn say(self, line: &str) {
        if !self.quiet {
            whisper(line);
        }
    }

    /// Says what was found, worst first, then in the order of the stages; the first few of
    /// each kind.
    pub(super) fn findings(self, findings: &[Finding]) {
        let mut kinds: Vec<Vec<&Finding>> = Vec::new();
        for finding in findings {
            match kinds.iter_mut().find(|kind| kind[0].code == finding.code) {
                Some(kind) => kind.push(finding),
                None => kinds.push(vec![finding]),
            }
        }
        kinds.sort_by_key(|kind| std::cmp::Reverse(kind[0].severity));
        for found in kinds {
            let (severity, code) = (found[0].severity, &found[0].code);
            if self.quiet && severity != Severity::Error {
                continue;
            }
            let shown = if self.verbose { found.len() } else { FEW.min(found.len()) };
            for finding in &found[..shown] {
                whisper(&format!("{}: {}", title(severity), finding.message));
            }
            if found.len() > shown {
                let more = found.len() - shown;
                whisper(&format!("  ... and {more} more of this kind (-v shows all)"));
            }
            whisper(&format!("  {code}: {}", found[0].help));
        }
    }
}

/// What was read, so that one sees whether it was read as meant.
pub(super) fn about(structure: &Structure) -> String {
    let (fins, strips) = (structure.fins().len(), structure.strips().len());
    let (name, size) = (structure.name(), structure.size_text());
    format!("{name}: {fins} fins in {strips} strips, {size}")
}

/// One line on stderr; a closed terminal is no reason to fail.
fn whisper(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

fn title(severity: Severity) -> String {
    let (word, colour) = match severity {
        Severity::Error => ("error", 31),
        Severity::Warning => ("warning", 33),
        Severity::Note => ("note", 36),
    };
    let plain = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    if plain || !std::io::stderr().is_terminal() {
        word.to_owned()
    } else {
        format!("\u{1b}[{colour}m{word}\u{1b}[0m")
    }
}

/// A progress bar on stderr and a stop switch on Ctrl-C.
pub(super) struct Terminal {
    bar: ProgressBar,
    stop: Arc<AtomicBool>,
    threads: Option<NonZeroUsize>,
    until: Option<Instant>,
    /// When the last line was said where there is no terminal for the bar, and whether one
    /// is to be said at all.
    said: Option<Instant>,
}

/// From one line of progress to the next where there is no terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(5);

impl Terminal {
    /// Shows progress unless told to be quiet; Ctrl-C stops it from here on. A search is
    /// content with what it has after `limit` seconds.
    pub(super) fn new(console: Console, limit: Option<f64>) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let switch = Arc::clone(&stop);
        // Without a handler Ctrl-C just ends the process, and nothing has been written then.
        let _ = ctrlc::set_handler(move || switch.store(true, Ordering::Relaxed));
        let bar = if console.quiet { ProgressBar::hidden() } else { ProgressBar::new(1) };
        if let Ok(style) =
            ProgressStyle::with_template("{msg:10} {wide_bar} {pos}/{len} {prefix}")
        {
            bar.set_style(style);
        }
        let until = limit.map(|limit| Instant::now() + Duration::from_secs_f64(limit));
        let lines = !console.quiet && !std::io::stderr().is_terminal();
        let said = lines.then(Instant::now);
        Self { bar, stop, threads: console.threads, until, said }
    }

    /// Says beside the bar what has been found.
    pub(super) fn note(&self, text: &str) {
        self.bar.set_prefix(text.to_owned());
    }

    /// Takes the bar off the screen.
    pub(super) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Watch for Terminal {
    fn progress(&mut self, stage: &'static str, done: usize, total: usize) {
        if self.said.is_some_and(|said| said.elapsed() >= BETWEEN_LINES) {
            self.said = Some(Instant::now());
            whisper(&format!("working: {stage}, {done} of {total}"));
        }
        self.bar.set_message(stage);
        // A search by the clock has no number of trials to come.
        let total = if self.until.is_some() { total.min(done + 1) } else { total };
        self.bar.set_length(total as u64);
        self.bar.set_position(done as u64);
    }

    fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn threads(&self) -> usize {
        self.threads.map_or_else(|| ().threads(), NonZeroUsize::get)
    }

    fn enough(&self) -> bool {
        self.until.is_some_and(|until| Instant::now() >= until)
    }
}
