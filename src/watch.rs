//! Listener and stop switch of long work.
//!
//! Stages neither print nor read the clock; they report here and ask whether to stop.

use thiserror::Error;

/// Hears how far long work has come, and may ask it to stop.
pub trait Watch {
    /// `done` of `total` steps of the stage called `stage` are finished.
    fn progress(&mut self, stage: &'static str, done: usize, total: usize);

    /// Whether the work should stop at its next safe point.
    fn stopped(&self) -> bool;

    /// To be asked between long steps.
    ///
    /// # Errors
    /// [`Stopped`] if the work should stop.
    fn unless_stopped(&self) -> Result<(), Stopped> {
        if self.stopped() { Err(Stopped) } else { Ok(()) }
    }

    /// On how many threads the work may run: on as many as there are cores, on one where
    /// that is not known. What comes out does not depend on it.
    fn threads(&self) -> usize {
        std::thread::available_parallelism().map_or(1, usize::from)
    }

    /// Whether a search that has found something should be content with it.
    fn enough(&self) -> bool {
        false
    }

    /// Something better was found; what it is, the stage says.
    fn better(&mut self, _found: &dyn std::any::Any) {}
}

/// The work was stopped from outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("stopped")]
pub struct Stopped;

/// Nobody listens, nobody stops.
impl Watch for () {
    fn progress(&mut self, _stage: &'static str, _done: usize, _total: usize) {}

    fn stopped(&self) -> bool {
        false
    }
}
