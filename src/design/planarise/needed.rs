//! Planarising on the way to something else: only when fins are not plane.

use crate::design::planarise::finding::DesignFinding;
use crate::design::planarise::options::Options;
use crate::design::planarise::{PlanariseError, planarise_sound};
use crate::diagnostic::Finding;
use crate::ids::{FinId, NodeId};
use crate::structure::{Draft, SoundDraft, planarity};
use crate::watch::{Stopped, Watch};

/// The draft as it is if its fins are plane to [`Options::target`] or if it is no structure
/// at all (which others say); else planarised, with what has to be said about it.
///
/// # Errors
/// [`Stopped`] if the watch stopped the work.
pub fn planarised_if_needed(
    draft: Draft,
    options: &Options,
    watch: &mut dyn Watch,
) -> Result<(Draft, Vec<Finding>), Stopped> {
    let Ok(sound) = SoundDraft::new(draft.clone()) else {
        return Ok((draft, Vec::new()));
    };
    if worst(&draft) <= options.target {
        return Ok((draft, Vec::new()));
    }
    let all = draft.fin_ids().len();
    let planarised = match planarise_sound(sound, options, watch) {
        Ok(planarised) => planarised,
        Err(PlanariseError::Refused(findings)) => return Ok((draft, findings)),
        Err(PlanariseError::Stopped(stopped)) => return Err(stopped),
    };
    let figures = planarised.figures;
    let mut facts = Vec::new();
    if !planarised.history.is_empty() {
        facts.push(DesignFinding::Planarised {
            fins: figures.fins,
            before_percent: figures.before.worst * 100.0,
            after_percent: figures.after.worst * 100.0,
            move_mm: figures.moves[1],
            turn_deg: figures.largest_turn.to_degrees(),
        });
    }
    if figures.fins < all {
        facts.push(DesignFinding::BoundaryLeft { count: all - figures.fins });
    }
    let findings = facts.into_iter().map(Finding::from).chain(planarised.findings);
    Ok((planarised.draft, findings.collect()))
}

/// Worst planarity of a checked draft's fins, as a share of a fin's diameter.
fn worst(draft: &Draft) -> f64 {
    let end =
        |k: NodeId, reach: f64| draft.positions[k] + draft.axes[k].normalize() * reach;
    let planarity = |fin: FinId| {
        let [i, j] = fin.ends();
        let (below, above) = (&draft.below, &draft.above);
        let corners =
            [end(i, -below[i]), end(j, -below[j]), end(j, above[j]), end(i, above[i])];
        let (off, diameter) = planarity(&corners);
        off / diameter
    };
    draft.fin_ids().into_iter().map(planarity).fold(0.0, f64::max)
}
