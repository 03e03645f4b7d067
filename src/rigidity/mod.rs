//! Rigid or flexible: the verdict that stands before the cut files.
//!
//! A structure with a joint is a set of rigid bodies that share points on their node axes
//! ([`Model`]). [`judge`] asks four things of it: how many motions meet no resistance
//! (mobility); which meet least (the paper's algorithm, [`Paper`], and a form free of
//! units); how far a node sways for the play of the joints, bracketed from both sides; and
//! whether that is within the limit. [`remedies`] says what would help.
//!
//! First order only: a mechanism may be stiffened by prestress, and a large sway is said
//! in words. Sources: "Freeform Shading and Lighting Systems from Planar Quads", section
//! Stability; `docs/rigidity.md`.

mod amplify;
mod compliance;
mod criteria;
mod entry;
mod finding;
mod linkage;
mod matrix;
mod mobility;
mod model;
mod motions;
mod paper;
mod picture;
mod remedy;
mod spectrum;
mod stiffness;
mod sway;
mod system;
#[cfg(test)]
mod tests;
mod verdict;

use crate::watch::Watch;
pub use amplify::Bracket;
pub use criteria::{Criteria, Pairing, SwayLimit};
pub use entry::{
    BoundsEntry, DiscrepancyEntry, HingeEntry, PaperEntry, RemedyEntry, VerdictEntry,
};
pub use finding::RigidityFinding;
pub use linkage::read_linkage;
pub use model::{Coupling, Model, RigidBody};
pub use paper::{Discrepancy, HingeMotion, MOST_PAIRED, Paper};
pub use picture::{Look, picture};
pub use remedy::{Cure, FEW_STEPS, MOST_STEPS, Remedy, remedies};
pub use sway::Sway;

/// Rms deviation of contacts over rms motion in the `wanted` motions that meet least
/// resistance, ascending; `fixed` is a body to hold beside the held nodes. `None` if a
/// motion meets no resistance at all and the factorisation fails on it.
pub fn least_resisted(
    model: &Model,
    fixed: Option<usize>,
    wanted: usize,
) -> Option<Vec<f64>> {
    let threads = ().threads();
    let system = system::System::new(model, fixed, threads);
    spectrum::least(&system, wanted, &()).ok().map(|modes| modes.sigma)
}

pub use verdict::{Fingerprint, Outcome, Verdict, judge};
