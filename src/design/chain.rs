//! From a surface to a structure: axes, directions, map, mesh, planar fins.
//!
//! Figure 2 of "Freeform Shading and Lighting Systems from Planar Quads", a to c. When one
//! way of setting the map up fails, the next is tried ([`Attempt`]); a mesh that breaks one
//! of its invariants is never handed on.

use crate::design::attempt::{Attempt, Meshed, foot, sized};
use crate::design::directions::Singular;
use crate::design::families::families;
use crate::design::figures::{DesignFigures, Judged, SingularNode};
use crate::design::finding::ChainFinding;
use crate::design::planarise::{self, PlanariseError, Planarised, planarise};
use crate::design::quads::Rank;
use crate::design::surface::{Measures, Surface};
use crate::design::wishes::{Align, SingularWish, Size, Wishes};
use crate::diagnostic::{Finding, passes};
use crate::geometry::{Point3, Vector3};
use crate::ids::{FinId, NodeId};
use crate::structure::{DesignRecord, Draft};
use crate::tolerance::DESIGNED_PLANAR;
use crate::watch::{Stopped, Watch};

/// A structure with where it came from.
#[derive(Debug, Clone, PartialEq)]
pub struct Designed {
    /// The structure's draft, planar.
    pub draft: Draft,
    /// The mesh before fins were made planar.
    pub before: Draft,
    /// Figures.
    pub figures: DesignFigures,
    /// What has to be said.
    pub findings: Vec<Finding>,
    /// Wanted axes of the surface's vertices.
    pub axes: Vec<Vector3>,
    /// Both directions in the middle of each triangle, of unit length.
    pub directions: Vec<[Vector3; 2]>,
}

/// Weight of torsal directions: smoothing reaches 1.2 cells.
const TORSAL: f64 = 0.65;
/// Weight of even spacing.
const EVEN: f64 = 1.0;
/// Edges at the boundary shorter than this share of a cell are joined, and more of them
/// when a cell there was turned over.
const SHORT: f64 = 0.35;
const LESS_SHORT: f64 = 0.5;
/// Depth to either side, as a share of a cell.
const DEPTH: f64 = 0.35;
/// Weights tried for even cells, in the order of what they cost: of torsal directions as a
/// share of their own, and of even spacing.
const EVENER: [[f64; 2]; 8] = [
    [1.0, 3.0],
    [1.0, 10.0],
    [0.3, 1.0],
    [0.3, 3.0],
    [0.3, 10.0],
    [0.3, 18.0],
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

/// One design, as it is sought.
struct Search<'a> {
    surface: &'a Surface,
    measures: Measures,
    name: &'a str,
    wishes: &'a Wishes,
}

/// How an attempt ended.
enum Outcome {
    Sound(Box<Designed>),
    /// The mesh had to be bent too far for its fins.
    Bent(Vec<Finding>),
    NoNet(Vec<Finding>),
}

/// Designs a structure on a surface.
///
/// # Errors
/// [`PlanariseError::Refused`] with what was tried and where it failed;
/// [`PlanariseError::Stopped`] if the watch stopped the work.
pub fn design(
    surface: &Surface,
    name: &str,
    wishes: &Wishes,
    watch: &mut dyn Watch,
) -> Result<Designed, PlanariseError> {
    let search = Search { surface, measures: Measures::of(surface), name, wishes };
    let singular = match &wishes.singular {
        SingularWish::Auto => None,
        SingularWish::At(places) => Some(search.given(places)?),
    };
    let first = Attempt {
        cell: search.cell(),
        aspect: wishes.aspect,
        torsal: TORSAL,
        even: EVEN,
        align: wishes.align != Align::None,
        follow: true,
        short: SHORT,
        singular: singular.as_deref(),
    };
    let (designed, attempt) = search.ladder(first, watch)?;
    let designed = search.gathered(designed, attempt, watch)?;
    if wishes.even { search.evened(designed, attempt, watch) } else { Ok(designed) }
}

impl Search<'_> {
    fn cell(&self) -> f64 {
        match self.wishes.size {
            Size::Cell(cell) => cell,
            Size::Nodes(count) => (self.measures.area() / count.max(1) as f64).sqrt(),
        }
    }

    /// Where the structure comes from, for its record.
    fn provenance(&self, cells: [f64; 2], aligned: bool) -> DesignRecord {
        let align = if aligned { "boundary" } else { "none" };
        let record = [
            ("surface", self.name.into()),
            ("cell", cells.to_vec().into()),
            ("align", align.into()),
            ("even", self.wishes.even.into()),
        ];
        record.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
    }

    /// Singular vertices nearest to the given places.
    fn given(&self, places: &[(Point3, usize)]) -> Result<Vec<Singular>, ChainFinding> {
        let mut singular: Vec<Singular> = Vec::new();
        let positions = &self.surface.positions;
        let inner: Vec<usize> =
            (0..positions.len()).filter(|&v| !self.surface.on_boundary(v)).collect();
        for &(at, valence) in places {
            let far = |vertex: &usize| (positions[*vertex] - at).norm();
            let nearest = inner.iter().min_by(|a, b| far(a).total_cmp(&far(b)));
            let index = 4 - valence as i32;
            match nearest {
                Some(&vertex) if singular.iter().all(|other| other.vertex != vertex) => {
                    singular.push(Singular { vertex, index });
                }
                _ => return Err(ChainFinding::SingularTogether { at: at.into() }),
            }
        }
        let (sum, euler) =
            (singular.iter().map(|s| s.index).sum::<i32>(), self.surface.euler());
        if self.surface.boundary().is_empty() && i64::from(sum) != 4 * euler {
            return Err(ChainFinding::SingularSum { sum, wanted: 4 * euler });
        }
        Ok(singular)
    }

    fn tried(
        &self,
        attempt: Attempt,
        watch: &mut dyn Watch,
    ) -> Result<Outcome, PlanariseError> {
        if watch.stopped() {
            return Err(PlanariseError::Stopped(Stopped));
        }
        match sized(self.surface, &self.measures, attempt, self.wishes.size) {
            Ok(meshed) => {
                let designed = self.planar(meshed, attempt.align, watch)?;
                let sound = passes(&designed.findings) && designed.figures.reversed == 0;
                Ok(if sound {
                    Outcome::Sound(Box::new(designed))
                } else {
                    Outcome::Bent(designed.findings)
                })
            }
            Err(why) => {
                Ok(Outcome::NoNet(vec![why.fact(self.surface, self.cell()).into()]))
            }
        }
    }

    /// The first attempt that succeeds.
    fn ladder<'a>(
        &self,
        first: Attempt<'a>,
        watch: &mut dyn Watch,
    ) -> Result<(Designed, Attempt<'a>), PlanariseError> {
        let (mut missed, mut turned, mut no_net) = (Vec::new(), None, false);
        let follows = !self.surface.lines().is_empty();
        let attempts = attempts(first, follows);
        for (k, attempt) in attempts.iter().enumerate() {
            watch.progress("design", k, attempts.len());
            // What is joined at the boundary makes no net.
            if std::mem::take(&mut no_net) && attempt.short > SHORT {
                continue;
            }
            match self.tried(*attempt, watch)? {
                Outcome::NoNet(mut why) => {
                    no_net = true;
                    missed.append(&mut why);
                }
                Outcome::Bent(mut why) => missed.append(&mut why),
                Outcome::Sound(mut designed) => {
                    let turn_deg = designed.figures.axis_turn_deg.max;
                    if attempt.align && turn_deg > self.wishes.align.most_turn_deg() {
                        turned = turned.or(Some(turn_deg));
                        continue;
                    }
                    if first.align && !attempt.align {
                        let given_up = ChainFinding::AlignmentGivenUp;
                        let turns = |turn_deg| ChainFinding::AlignmentTurns { turn_deg };
                        designed.findings.push(turned.map_or(given_up, turns).into());
                    }
                    if follows && !attempt.follow {
                        designed.findings.push(ChainFinding::FollowingGivenUp.into());
                    }
                    return Ok((*designed, *attempt));
                }
            }
        }
        // All were tried for the sake of the first.
        missed.truncate(1);
        Err(PlanariseError::Refused(missed))
    }

    /// Where the boundary alone asks for four nodes of three fins they come too near to it:
    /// the most even of designs with them nearer to the middle.
    fn gathered(
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
    fn evened(
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

    /// Makes the fins of a mesh planar and says what was reached.
    fn planar(
        &self,
        meshed: Meshed,
        aligned: bool,
        watch: &mut dyn Watch,
    ) -> Result<Designed, PlanariseError> {
        let (surface, wishes) = (self.surface, self.wishes);
        let Meshed { quads, axes, directions, cell, aspect } = meshed;
        let nodes = quads.nodes.iter();
        let mut draft = Draft {
            name: self.name.to_owned(),
            positions: nodes.clone().map(|node| surface.point(foot(node))).collect(),
            axes: nodes.map(|node| surface.between(&axes, foot(node))).collect(),
            faces: quads.faces.clone(),
            ..Draft::default()
        };
        let [below, above] = wishes.depth.unwrap_or([DEPTH * cell; 2]);
        draft = draft.with_depth(below, above);
        let mut options = planarise::Options {
            boundary_fins: wishes.boundary_fins,
            ..planarise::Options::default()
        };
        let mut planarised = planarise(draft.clone(), &options, watch)?;
        if planarised.figures.after.worst > DESIGNED_PLANAR {
            // Plane enough to be made, but not to be called planar.
            options.target = DESIGNED_PLANAR;
            planarised = planarise(draft.clone(), &options, watch)?;
        }
        let Planarised { draft: mut result, figures: planarised, mut findings, .. } =
            planarised;
        let families = families(&result, aspect);
        let wanted = [cell * aspect.sqrt(), cell / aspect.sqrt()];
        let judged = Judged {
            surface,
            axes: &axes,
            starts: quads.nodes.iter().map(|node| node.triangle).collect(),
            on_boundary: quads.nodes.iter().map(|node| node.rank > Rank::Inner).collect(),
            draft: &result,
            wanted,
            families: &families,
        };
        let figures = judged.figures(&planarised);
        let family = |fin: FinId| {
            let [a, b] = fin.ends().map(NodeId::index);
            families.get(&[a.min(b), a.max(b)]).copied().flatten()
        };
        result.families = Some(result.fin_ids().into_iter().map(family).collect());
        result.design = Some(self.provenance(wanted, aligned));
        // Cells of one shape were asked for, or could be had.
        if wishes.aspect.to_bits() != aspect.to_bits() {
            findings.push(ChainFinding::CellsAlike { cell_mm: cell }.into());
        }
        Ok(Designed { draft: result, before: draft, figures, findings, axes, directions })
    }
}

/// The ladder: smoother directions, then no alignment, then smaller cells, then more even
/// ones.
fn attempts(first: Attempt, follows: bool) -> Vec<Attempt> {
    let mut attempts = vec![
        first,
        Attempt { short: LESS_SHORT, ..first },
        Attempt { torsal: TORSAL / 3.0, ..first },
    ];
    if first.align {
        attempts.push(Attempt { align: false, ..first });
        attempts.push(Attempt { align: false, torsal: TORSAL / 3.0, ..first });
    }
    let free = Attempt { align: false, ..first };
    attempts.push(Attempt { torsal: TORSAL / 9.0, ..free });
    attempts.push(Attempt { cell: 0.8 * first.cell, ..free });
    attempts.push(Attempt { even: 3.0 * EVEN, torsal: TORSAL / 9.0, ..free });
    if follows {
        attempts.push(Attempt { follow: false, ..first });
        attempts.push(Attempt { follow: false, ..free });
    }
    attempts
}
