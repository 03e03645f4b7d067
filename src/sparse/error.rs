//! Why there is no factor, or no answer.

use crate::watch::Stopped;
use thiserror::Error;

/// A pivot of the factorisation is not positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("the matrix is not positive definite")]
pub struct NotPositiveDefinite;

/// Why there is no answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Halt {
    /// A factorisation or decomposition failed.
    Failed,
    /// Nobody waits for it any more.
    Stopped(Stopped),
}

impl From<NotPositiveDefinite> for Halt {
    fn from(_: NotPositiveDefinite) -> Self {
        Self::Failed
    }
}

impl From<Stopped> for Halt {
    fn from(stopped: Stopped) -> Self {
        Self::Stopped(stopped)
    }
}
