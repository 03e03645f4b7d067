//! From a surface to a structure: axes, directions, map, mesh, planar fins.
//!
//! Figure 2 of "Freeform Shading and Lighting Systems from Planar Quads", a to c. When one
//! way of setting the map up fails, the next is tried ([`Attempt`]); a mesh that breaks one
//! of its invariants is never handed on.

use crate::design::attempt::{Attempt, Meshed, foot, sized};
use crate::design::directions::Singular;
use crate::design::families::families;
use crate::design::figures::{DesignFigures, Judged};
use crate::design::finding::ChainFinding;
use crate::design::planarise::{self, PlanariseError, Planarised, planarise};
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
pub(super) const TORSAL: f64 = 0.65;
/// Weight of even spacing.
const EVEN: f64 = 1.0;
/// Edges at the boundary shorter than this share of a cell are joined, and more of them
/// when a cell there was turned over.
const SHORT: f64 = 0.35;
const LESS_SHORT: f64 = 0.5;
/// Depth to either side, as a share of a cell.
const DEPTH: f64 = 0.35;
/// Ratios of lengths that differ by no more are the same.
const SAME_ASPECT: f64 = 0.001;

/// One design, as it is sought.
pub(super) struct Search<'a> {
    pub surface: &'a Surface,
    pub measures: Measures,
    pub name: &'a str,
    pub wishes: &'a Wishes,
}

/// A mesh on the surface, with what was wanted of it.
pub(super) struct Mesh {
    pub before: Draft,
    /// For each node a triangle near it.
    pub starts: Vec<usize>,
    /// Of the surface's vertices.
    pub axes: Vec<Vector3>,
    pub directions: Vec<[Vector3; 2]>,
    /// Wanted lengths of fins in both families.
    pub cells: [f64; 2],
    pub aligned: bool,
}

/// How an attempt ended.
pub(super) enum Outcome {
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
    if let Some(designed) = search.mirrored(watch)? {
        return Ok(designed);
    }
    search.designed(watch)
}

impl Search<'_> {
    /// A design on the surface as it is.
    pub(super) fn designed(
        &self,
        watch: &mut dyn Watch,
    ) -> Result<Designed, PlanariseError> {
        let singular = match &self.wishes.singular {
            SingularWish::Auto => None,
            SingularWish::At(places) => Some(self.given(places)?),
        };
        let first = Attempt {
            cell: self.cell(),
            aspect: self.wishes.aspect,
            torsal: TORSAL,
            even: EVEN,
            align: self.wishes.align != Align::None,
            follow: true,
            short: SHORT,
            singular: singular.as_deref(),
        };
        let (designed, attempt) = self.ladder(first, watch)?;
        let designed = self.gathered(designed, attempt, watch)?;
        if self.wishes.even {
            self.evened(designed, attempt, watch)
        } else {
            Ok(designed)
        }
    }

    pub(super) fn cell(&self) -> f64 {
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
    pub(super) fn given(
        &self,
        places: &[(Point3, usize)],
    ) -> Result<Vec<Singular>, ChainFinding> {
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

    pub(super) fn tried(
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

    /// Makes the fins of a mesh planar and says what was reached.
    fn planar(
        &self,
        meshed: Meshed,
        aligned: bool,
        watch: &mut dyn Watch,
    ) -> Result<Designed, PlanariseError> {
        let Meshed { quads, axes, directions, cell, aspect } = meshed;
        let nodes = quads.nodes.iter();
        let before = Draft {
            name: self.name.to_owned(),
            positions: nodes.clone().map(|node| self.surface.point(foot(node))).collect(),
            axes: nodes.map(|node| self.surface.between(&axes, foot(node))).collect(),
            faces: quads.faces,
            ..Draft::default()
        };
        let mesh = Mesh {
            before,
            starts: quads.nodes.iter().map(|node| node.triangle).collect(),
            axes,
            directions,
            cells: [cell * aspect.sqrt(), cell / aspect.sqrt()],
            aligned,
        };
        self.finished(mesh, &|_| (), watch)
    }

    /// The same for any mesh on the surface; `after` may touch up what was made planar.
    pub(super) fn finished(
        &self,
        mesh: Mesh,
        after: &dyn Fn(&mut Draft),
        watch: &mut dyn Watch,
    ) -> Result<Designed, PlanariseError> {
        let Mesh { before, starts, axes, directions, cells, aligned } = mesh;
        let cell = (cells[0] * cells[1]).sqrt();
        let [below, above] = self.wishes.depth.unwrap_or([DEPTH * cell; 2]);
        let before = before.with_depth(below, above);
        let mut options = planarise::Options {
            boundary_fins: self.wishes.boundary_fins,
            ..planarise::Options::default()
        };
        let mut planarised = planarise(before.clone(), &options, watch)?;
        if planarised.figures.after.worst > DESIGNED_PLANAR {
            // Plane enough to be made, but not to be called planar.
            options.target = DESIGNED_PLANAR;
            planarised = planarise(before.clone(), &options, watch)?;
        }
        let Planarised { mut draft, figures: planarised, mut findings, .. } = planarised;
        after(&mut draft);
        let families = families(&draft, cells[0] / cells[1]);
        let judged = Judged {
            surface: self.surface,
            axes: &axes,
            starts,
            draft: &draft,
            wanted: cells,
            families: &families,
        };
        let figures = judged.figures(&planarised);
        let family = |fin: FinId| {
            let [a, b] = fin.ends().map(NodeId::index);
            families.get(&[a.min(b), a.max(b)]).copied().flatten()
        };
        draft.families = Some(draft.fin_ids().into_iter().map(family).collect());
        draft.design = Some(self.provenance(cells, aligned));
        // Cells of one shape were asked for, or could be had.
        let off = (cells[0] / cells[1] / self.wishes.aspect - 1.0).abs();
        if off > SAME_ASPECT {
            findings.push(ChainFinding::CellsAlike { cell_mm: cell }.into());
        }
        Ok(Designed { draft, before, figures, findings, axes, directions })
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
