//! How a command ends, and what is said when it could not run.

use crate::cli::input::InputError;
use crate::cli::jobdir::JobDirError;
use crate::diagnostic::{Finding, Place, passes};
use crate::job::{self, JobError};
use crate::watch::Stopped;
use miette::Diagnostic;
use serde_json::{Value, json};
use std::io::Write;

/// How a command ended; the number is the exit code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    Done = 0,
    CouldNotRun = 1,
    Refused = 3,
    Interrupted = 4,
}

impl End {
    /// Of a command whose findings are these.
    pub(super) fn of(findings: &[Finding]) -> Self {
        if passes(findings) { Self::Done } else { Self::Refused }
    }
}

impl From<job::End> for End {
    fn from(end: job::End) -> Self {
        match end {
            job::End::Approved => Self::Done,
            job::End::Refused => Self::Refused,
        }
    }
}

/// Why a command could not run.
pub(super) enum Failure {
    Other(Box<dyn Diagnostic>),
    Input(InputError),
    Interrupted,
    /// What was wrong has been said.
    Said(End),
}

impl Failure {
    /// Of an error that is its own finding.
    pub(super) fn of(error: impl Diagnostic + 'static) -> Self {
        Self::Other(Box::new(error))
    }

    /// Says it, on standard output too if JSON was asked for.
    pub(super) fn end(self, json: bool) -> End {
        match self {
            Self::Input(error) => {
                complain(&error, &error.to_string(), json.then(|| error.findings()))
            }
            Self::Other(error) => {
                let findings = || vec![Finding::new(&*error, Place::default())];
                complain(&*error, &error.to_string(), json.then(findings))
            }
            Self::Interrupted => {
                let _ = writeln!(std::io::stderr(), "interrupted; nothing was written");
                End::Interrupted
            }
            Self::Said(end) => end,
        }
    }
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Self::Input(error)
    }
}

impl From<JobDirError> for Failure {
    fn from(error: JobDirError) -> Self {
        Self::of(error)
    }
}

impl From<JobError> for Failure {
    fn from(error: JobError) -> Self {
        match error {
            JobError::Stopped(stopped) => stopped.into(),
            error => Self::of(error),
        }
    }
}

impl From<Stopped> for Failure {
    fn from(Stopped: Stopped) -> Self {
        Self::Interrupted
    }
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

/// Findings as JSON.
pub(super) fn check_json(findings: &[Finding]) -> Value {
    json!({"passes": passes(findings), "findings": findings})
}
