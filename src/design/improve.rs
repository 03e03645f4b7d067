//! More even cells than those of the first valid design, at a stated price.

use crate::design::attempt::Attempt;
use crate::design::chain::{Designed, Outcome, Search, TORSAL};
use crate::design::figures::SingularNode;
use crate::design::finding::ChainFinding;
use crate::design::planarise::PlanariseError;
use crate::geometry::{Point3, Vector3};
use crate::watch::Watch;

/// Weights tried for even cells, in the order of what they cost: of torsal directions as a
/// share of their own, and of even spacing.
const EVENER: [[f64; 2]; 10] = [
    [1.0, 3.0],
    [1.0, 10.0],
    [0.3, 1.0],
    [0.3, 3.0],
    [0.3, 10.0],
    [0.3, 14.0],
    [0.2, 5.0],
    [0.2, 10.0],
    [0.1, 3.0],
    [0.1, 10.0],
];
/// How near to the middle, as shares of their distance, nodes of three fins are tried, and
/// how much farther axes may turn for it, degrees.
const NEARER: [f64; 4] = [0.9, 0.8, 0.7, 0.6];
const MORE_TURN_DEG: f64 = 1.0;
/// Share of fins in band that is even enough, and how far axes may turn for it, degrees.
const EVEN_ENOUGH: f64 = 0.95;
const MOST_EVEN_TURN_DEG: f64 = 13.0;

impl Search<'_> {
    /// Where the boundary alone asks for four nodes of three fins they come too near to it:
    /// the most even of designs with them nearer to the middle.
    pub(super) fn gathered(
        &self,
        mut best: Designed,
        attempt: Attempt,
        watch: &mut dyn Watch,
    ) -> Result<Designed, PlanariseError> {
        let at = |node: &SingularNode| Point3::from(node.position);
        let four: Vec<Point3> = best.figures.singular.iter().map(at).collect();
        let all_three = best.figures.singular.iter().all(|node| node.valence == 3);
        let wanted = attempt.align && attempt.singular.is_none() && all_three;
        if !wanted || four.len() != 4 || best.figures.edge.in_band >= EVEN_ENOUGH {
            return Ok(best);
        }
        let most = best.figures.axis_turn_deg.max + MORE_TURN_DEG;
        let middle = four.iter().map(|p| p.coords / 4.0).sum::<Vector3>();
        for share in NEARER {
            let places: Vec<(Point3, usize)> = four
                .iter()
                .map(|p| (Point3::from(middle + (p.coords - middle) * share), 3))
                .collect();
            let Ok(singular) = self.given(&places) else { continue };
            let attempt = Attempt { singular: Some(&singular), ..attempt };
            if let Outcome::Sound(designed) = self.tried(attempt, watch)?
                && designed.figures.axis_turn_deg.max <= most
                && designed.figures.edge.in_band > best.figures.edge.in_band
            {
                best = *designed;
            }
        }
        Ok(best)
    }

    /// The most even of several designs whose axes do not turn too far.
    pub(super) fn evened(
        &self,
        plain: Designed,
        attempt: Attempt<'_>,
        watch: &mut dyn Watch,
    ) -> Result<Designed, PlanariseError> {
        let before = (plain.figures.edge.in_band, plain.figures.axis_turn_deg.max);
        let mut best = plain;
        let weighed = EVENER.map(|[torsal, even]| Attempt {
            torsal: torsal * TORSAL,
            even,
            ..attempt
        });
        // Nothing singular at all, where the surface allows it.
        let may_be_none =
            attempt.singular.is_none() && !self.surface.boundary().is_empty();
        let none = Attempt { singular: Some(&[]), ..attempt };
        for attempt in weighed.into_iter().chain(may_be_none.then_some(none)) {
            if best.figures.edge.in_band >= EVEN_ENOUGH {
                break;
            }
            if let Outcome::Sound(designed) = self.tried(attempt, watch)?
                && designed.figures.axis_turn_deg.max <= MOST_EVEN_TURN_DEG
                && designed.figures.edge.in_band > best.figures.edge.in_band
            {
                best = *designed;
            }
        }
        let after = (best.figures.edge.in_band, best.figures.axis_turn_deg.max);
        best.findings.push(ChainFinding::Evened { before, after }.into());
        Ok(best)
    }
}
