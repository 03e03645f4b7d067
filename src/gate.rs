//! The gate: cut files can only be made from what has been approved.

use crate::diagnostic::{Finding, passes};
use crate::rigidity::{Fingerprint, Verdict};
use thiserror::Error;

/// Work that may go to the laser. Only [`approve`] and [`approve_loose`] make one, and
/// exporters of cut files take nothing else.
#[derive(Debug, Clone, PartialEq)]
pub struct Approved<T>(T);

impl<T> Approved<T> {
    /// What was approved.
    pub const fn get(&self) -> &T {
        &self.0
    }
}

/// Why work may not go to the laser.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Shut {
    /// Something that was found forbids it.
    #[error("an error was found")]
    Findings,
    /// No verdict, or one about another structure, joint or template.
    #[error("it was not judged as it stands")]
    Stale,
    /// Judged flexible or a mechanism, and not accepted as such.
    #[error("it is flexible")]
    NotRigid,
}

/// Parts of a structure, with what proves that they were judged.
#[derive(Debug, Clone, Copy)]
pub struct Judged<'a> {
    /// What the parts are made from.
    pub fingerprint: &'a Fingerprint,
    /// What was found out about it.
    pub verdict: Option<&'a Verdict>,
    /// Why it may be flexible.
    pub accepted: Option<&'a str>,
}

/// Lets the parts of a structure pass if nothing that was found forbids cutting and the
/// verdict, about this very structure, joint and template, allows it.
///
/// # Errors
/// [`Shut`] says why not.
pub fn approve<T>(
    work: T,
    findings: &[Finding],
    judged: Judged,
) -> Result<Approved<T>, Shut> {
    let verdict = judged.verdict.ok_or(Shut::Stale)?;
    if verdict.fingerprint() != judged.fingerprint {
        return Err(Shut::Stale);
    }
    let accepted = judged.accepted.is_some_and(|reason| !reason.trim().is_empty());
    if !verdict.passes() && !accepted {
        return Err(Shut::NotRigid);
    }
    if passes(findings) { Ok(Approved(work)) } else { Err(Shut::Findings) }
}

/// Lets parts pass that belong to no structure: coupons, outlines to nest.
pub fn approve_loose<T>(work: T, findings: &[Finding]) -> Option<Approved<T>> {
    passes(findings).then_some(Approved(work))
}
