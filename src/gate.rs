//! The gate: cut files can only be made from what has been approved.

use crate::diagnostic::{Finding, passes};

/// Work that may go to the laser. Only [`approve`] makes one, and exporters of cut files
/// take nothing else.
#[derive(Debug, Clone, PartialEq)]
pub struct Approved<T>(T);

impl<T> Approved<T> {
    /// What was approved.
    pub const fn get(&self) -> &T {
        &self.0
    }
}

/// Lets work pass if nothing that was found about it forbids cutting.
pub fn approve<T>(work: T, findings: &[Finding]) -> Option<Approved<T>> {
    passes(findings).then_some(Approved(work))
}
