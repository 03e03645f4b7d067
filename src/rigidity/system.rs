//! Resistance against motion as a sparse matrix.
//!
//! Unknowns are the velocities `y` of the points of all couplings that the ground does not
//! hold. A body answers with its best rigid motion, so that it resists by
//! `yᵀ S (I - Q Qᵀ) S y`, `Q` its motions and `S` the roots of the weights of its
//! contacts: the *pin form* `K` (docs/formulas.md 1.3). A body on many couplings keeps its
//! motion as six unknowns of its own; eliminating the couplings first is then the *body
//! form*.

use crate::geometry::Point3;
use crate::rigidity::model::Model;
use crate::rigidity::motions::{Motions, Twists};
use crate::rigidity::stiffness::Stiffness;
use crate::sparse::{Factor, NotPositiveDefinite, Symbolic, map_chunks, map_range};
use std::ops::Range;

/// Bodies with more rows than this keep their motion as unknowns.
const MOST_ROWS: usize = 18;
/// Bodies that are asked together.
const TOGETHER: usize = 1000;

/// The unknowns of a model, their order, and where each body's resistance goes.
pub(super) struct System<'a> {
    /// The model.
    pub(super) model: &'a Model,
    /// The motions of each body, all weights 1; none for a body that is fixed.
    pub(super) motions: Vec<Motions>,
    /// A body that the ground holds.
    pub(super) fixed: Option<usize>,
    /// For each coupling its first unknown, unless it is held.
    pub(super) coupling_at: Vec<Option<usize>>,
    /// For each coupling its group.
    pub(super) coupling_group: Vec<Option<u32>>,
    /// For each body its group, if it keeps its motion.
    pub(super) body_group: Vec<Option<u32>>,
    /// The fixed part of the factorisation.
    pub(super) symbolic: Symbolic,
    /// By supernode, what bodies add there.
    pub(super) contributions: Vec<Vec<Contribution>>,
    /// By body, the first of its contacts (one per coupling and point); one more at the
    /// end.
    pub(super) first_contact: Vec<usize>,
    /// Whether the six rigid motions of the whole are free.
    pub(super) floats: bool,
    pub(super) threads: usize,
}

/// A free coupling of a body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    /// Place of its group.
    pub(super) place: usize,
    /// Its first row in the body.
    pub(super) row: usize,
    /// How many rows it has.
    pub(super) size: usize,
}

/// A block that a body adds to the matrix.
#[derive(Debug, Clone, Copy)]
pub(super) enum Contribution {
    /// Between two of its couplings, the row's place not before the column's.
    Block { body: usize, row: Span, column: Span },
    /// Between one of its couplings and its own motion, at the place `own`.
    Link { body: usize, coupling: Span, own: usize },
}

impl<'a> System<'a> {
    /// Sets the unknowns of a model up; `fixed` is a body to hold beside its held
    /// couplings.
    pub(super) fn new(model: &'a Model, fixed: Option<usize>, threads: usize) -> Self {
        let motions = motions(model, fixed, threads);
        let rows = |body: usize| motions[body].rows;
        let mut sizes = Vec::new();
        let mut group = |size: usize| {
            sizes.push(size);
            (sizes.len() - 1) as u32
        };
        let couplings = model.couplings.iter();
        let coupling_group: Vec<Option<u32>> =
            couplings.map(|k| (!k.held).then(|| group(3 * k.points.len()))).collect();
        let keeps = |body: usize| rows(body) > MOST_ROWS && Some(body) != fixed;
        let body_group: Vec<Option<u32>> = (0..model.bodies.len())
            .map(|body| keeps(body).then(|| group(motions[body].rank)))
            .collect();
        let neighbours = neighbours(model, &coupling_group, &body_group, sizes.len());
        let symbolic = Symbolic::new(&sizes, &neighbours);
        let at = |group: u32| symbolic.start[symbolic.place[group as usize]];
        let coupling_at = coupling_group.iter().map(|group| group.map(at)).collect();
        let mut first_contact = vec![0];
        for body in 0..model.bodies.len() {
            first_contact.push(first_contact[body] + rows(body) / 3);
        }
        let floats = !model.is_supported() && fixed.is_none();
        let contributions = Vec::new();
        let mut system = Self {
            model,
            motions,
            fixed,
            coupling_at,
            coupling_group,
            body_group,
            symbolic,
            contributions,
            first_contact,
            floats,
            threads,
        };
        system.contributions = system.contributions();
        system
    }

    /// Each block goes to the supernode that eliminates the first of its two groups.
    fn contributions(&self) -> Vec<Vec<Contribution>> {
        let mut contributions = vec![Vec::new(); self.symbolic.supernodes.len()];
        let place = |group: u32| self.symbolic.place[group as usize];
        let mut give = |contribution: Contribution, first: usize| {
            contributions[self.symbolic.owner[first] as usize].push(contribution);
        };
        for body in 0..self.model.bodies.len() {
            let mut row = 0;
            let mut free = Vec::with_capacity(3);
            for &coupling in &self.model.incidence[body] {
                let size = 3 * self.model.couplings[coupling].points.len();
                free.extend(self.coupling_group[coupling].map(|group| Span {
                    place: place(group),
                    row,
                    size,
                }));
                row += size;
            }
            let own = self.body_group[body].map(place);
            for &column in &free {
                if let Some(own) = own {
                    give(
                        Contribution::Link { body, coupling: column, own },
                        column.place.min(own),
                    );
                    continue;
                }
                for &row in free.iter().filter(|row| row.place >= column.place) {
                    give(Contribution::Block { body, row, column }, column.place);
                }
            }
        }
        contributions
    }

    /// The body that is held beside the held couplings.
    pub(super) fn fixed(&self) -> Option<usize> {
        self.fixed
    }

    /// How many unknowns there are.
    pub(super) fn unknowns(&self) -> usize {
        self.symbolic.unknowns()
    }

    /// How many bodies sit on each unknown; none on those that are a body's own.
    pub(super) fn counts(&self) -> Vec<f64> {
        let mut counts = vec![0.0; self.unknowns()];
        for (coupling, at) in self.model.couplings.iter().zip(&self.coupling_at) {
            if let Some(at) = *at {
                counts[at..at + 3 * coupling.points.len()]
                    .fill(coupling.bodies.len() as f64);
            }
        }
        counts
    }

    /// The motions behind the bases of all bodies.
    pub(super) fn twists(&self) -> Vec<Twists> {
        let of = |body: usize| {
            let points = self.model.points(body);
            if self.fixed == Some(body) {
                return [[0.0; 6]; 6];
            }
            Motions::twists(&points, &vec![1.0; points.len()])
        };
        (0..self.motions.len()).map(of).collect()
    }

    /// Velocities at the points of a body.
    pub(super) fn gather(&self, body: usize, y: &[f64], into: &mut Vec<f64>) {
        into.clear();
        for &coupling in &self.model.incidence[body] {
            let size = 3 * self.model.couplings[coupling].points.len();
            match self.coupling_at[coupling] {
                Some(at) => into.extend_from_slice(&y[at..at + size]),
                None => into.extend(std::iter::repeat_n(0.0, size)),
            }
        }
    }

    /// How far each contact leaves its pin, three numbers per contact: `(I - QQᵀ) y`.
    pub(super) fn deviations(&self, y: &[f64]) -> Vec<f64> {
        let mut all =
            Vec::with_capacity(3 * self.first_contact[self.first_contact.len() - 1]);
        let mut values = Vec::new();
        for (body, motions) in self.motions.iter().enumerate() {
            self.gather(body, y, &mut values);
            motions.clear_values(&mut values);
            all.extend_from_slice(&values);
        }
        all
    }

    /// `yᵀ K y` of each `y`, from the contacts' deviations.
    pub(super) fn resistances(&self, all: &[Vec<f64>]) -> Vec<f64> {
        let count = self.motions.len();
        let some = |values: &mut Vec<f64>, k: usize| {
            let mut sums = vec![0.0; all.len()];
            for body in k * TOGETHER..count.min((k + 1) * TOGETHER) {
                for (sum, y) in sums.iter_mut().zip(all) {
                    self.gather(body, y, values);
                    self.motions[body].clear_values(values);
                    *sum += values.iter().map(|x| x * x).sum::<f64>();
                }
            }
            sums
        };
        let parts = map_range(self.threads, count.div_ceil(TOGETHER), Vec::new, some);
        (0..all.len()).map(|k| parts.iter().map(|sums| sums[k]).sum()).collect()
    }

    /// Adds up contact values on the unknowns: the transpose of gathering.
    pub(super) fn scatter(&self, contacts: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.unknowns()];
        let mut from = 0;
        for couplings in &self.model.incidence {
            for &coupling in couplings {
                let size = 3 * self.model.couplings[coupling].points.len();
                if let Some(at) = self.coupling_at[coupling] {
                    let values = &contacts[from..from + size];
                    y[at..at + size].iter_mut().zip(values).for_each(|(y, v)| *y += v);
                }
                from += size;
            }
        }
        y
    }

    /// Six orthonormal rigid motions of the whole, over all unknowns of couplings.
    pub(super) fn rigid(&self) -> Vec<Vec<f64>> {
        let couplings = self.model.couplings.iter().zip(&self.coupling_at);
        let free: Vec<(Point3, usize)> = couplings
            .filter_map(|(coupling, at)| Some((coupling, (*at)?)))
            .flat_map(|(coupling, at)| {
                coupling.points.iter().enumerate().map(move |(k, &p)| (p, at + 3 * k))
            })
            .collect();
        let points: Vec<Point3> = free.iter().map(|(p, _)| *p).collect();
        let motions = Motions::new(&points, &vec![1.0; points.len()]);
        let spread = |k: usize| {
            let mut y = vec![0.0; self.unknowns()];
            for (values, (_, at)) in motions.column(k).chunks_exact(3).zip(&free) {
                y[*at..at + 3].copy_from_slice(values);
            }
            y
        };
        (0..motions.rank).map(spread).collect()
    }

    /// Factorises the resistance.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] if a motion meets no resistance even with the shift.
    pub(super) fn factor(&self) -> Result<Factor<'_>, NotPositiveDefinite> {
        Stiffness::new(self, None).factor()
    }

    /// Six unknowns that hold the whole still and strain nothing, and how strongly.
    pub(super) fn stays(&self, diagonal: &[f64]) -> Vec<(usize, f64)> {
        let free = |k: &usize| {
            self.coupling_at[*k].is_some() && self.model.couplings[*k].is_pin()
        };
        let Some(first) = (0..self.model.couplings.len()).find(free) else {
            return Vec::new();
        };
        let Some(at) = self.coupling_at[first] else { return Vec::new() };
        let [a, b] = [0, 1].map(|k| self.model.couplings[first].points[k]);
        let axis = (b - a).normalize();
        let along = axis.iamax();
        let mut stays: Vec<usize> =
            (at..at + 6).filter(|&k| k != at + 3 + along).collect();
        let couplings = self.model.couplings.iter().zip(&self.coupling_at);
        let moment_arm = |p: Point3| axis.cross(&(p - a));
        let far = couplings
            .filter_map(|(coupling, at)| Some((moment_arm(coupling.points[0]), (*at)?)))
            .max_by(|(p, _), (q, _)| p.norm_squared().total_cmp(&q.norm_squared()));
        stays.extend(far.map(|(moment_arm, at)| at + moment_arm.iamax()));
        stays.into_iter().map(|k| (k, diagonal[k].max(1.0))).collect()
    }
}

fn motions(model: &Model, fixed: Option<usize>, threads: usize) -> Vec<Motions> {
    let make = |part: Range<usize>| {
        let (mut points, mut roots) = (Vec::new(), Vec::new());
        let of = |body: usize| {
            points.clear();
            points.extend(model.points_of(body));
            if Some(body) == fixed {
                return Motions::none(3 * points.len());
            }
            roots.resize(points.len(), 1.0);
            Motions::new(&points, &roots)
        };
        part.map(of).collect()
    };
    map_chunks(model.bodies.len(), threads, make)
}

/// Which groups meet in a body.
fn neighbours(
    model: &Model,
    coupling_group: &[Option<u32>],
    body_group: &[Option<u32>],
    groups: usize,
) -> Vec<Vec<u32>> {
    let mut neighbours = vec![Vec::new(); groups];
    for (body, couplings) in model.incidence.iter().enumerate() {
        let free: Vec<u32> =
            couplings.iter().filter_map(|&k| coupling_group[k]).collect();
        match body_group[body] {
            Some(own) => {
                for &coupling in &free {
                    neighbours[coupling as usize].push(own);
                    neighbours[own as usize].push(coupling);
                }
            }
            None => {
                for &coupling in &free {
                    neighbours[coupling as usize]
                        .extend(free.iter().filter(|&&o| o != coupling));
                }
            }
        }
    }
    for list in &mut neighbours {
        list.sort_unstable();
        list.dedup();
    }
    neighbours
}
