//! Listener and stop switch of long work.
//!
//! Stages neither print nor read the clock; they report here and ask whether to stop.

/// Hears how far long work has come, and may ask it to stop.
pub trait Watch {
    /// `done` of `total` steps of the stage called `stage` are finished.
    fn progress(&mut self, stage: &'static str, done: usize, total: usize);

    /// Whether the work should stop at its next safe point.
    fn stopped(&self) -> bool;

    /// Whether a search that has found something should be content with it.
    fn enough(&self) -> bool {
        false
    }

    /// Something better was found; what it is, the stage says.
    fn better(&mut self, _found: &dyn std::any::Any) {}
}

/// Nobody listens, nobody stops.
impl Watch for () {
    fn progress(&mut self, _stage: &'static str, _done: usize, _total: usize) {}

    fn stopped(&self) -> bool {
        false
    }
}
