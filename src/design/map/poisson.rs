//! The map as a least squares problem, with the unknowns that are no whole numbers taken
//! out once and for all.
//!
//! Per triangle the map is to have `grad u · t2 = grad v · t1 = 0` (lines run along the
//! directions) and, weighing `even`, `grad u · n2 = grad v · n1 = 1 / cell` across them. The
//! normal equations are `[Hcc Hci; Hic Hii]`; with `X = Hcc⁻¹ Hci` the whole numbers see the
//! dense `S = Hii − Hic X` alone.

use crate::design::map::Failure;
use crate::design::map::copies::{Copies, Term, Unknown};
use crate::design::surface::{Measures, Surface, next};
use crate::geometry::Vector2;
use crate::sparse::{Cholesky, Triplets};
use crate::tolerance::PINNED;
use nalgebra::{DMatrix, DVector};

/// Bounds of the wanted spacing about 1 / cell, and rounds in which it follows the map.
const WIDEST: f64 = 1.4;
const NARROWEST: f64 = 0.7;
const ROUNDS: usize = 3;

/// How lines are to be spaced.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spacing {
    /// Wanted lengths of fins along both directions.
    pub cells: [f64; 2],
    /// How much they weigh beside true directions.
    pub even: f64,
}

pub(super) struct Poisson<'a> {
    surface: &'a Surface,
    measures: &'a Measures,
    copies: &'a Copies,
    /// Wanted lengths of fins along both directions.
    cells: [f64; 2],
    even: f64,
    /// Both directions of each triangle, in its frame.
    pairs: Vec<[Vector2; 2]>,
    /// Wanted slopes across the lines of each triangle.
    spacing: Vec<[f64; 2]>,
    /// How stiff each triangle is.
    stiffness: Vec<f64>,
    factor: Option<Cholesky>,
    /// Hci by columns, sparse.
    couplings: Vec<Vec<(usize, f64)>>,
    /// X by columns.
    carried: Vec<f64>,
    /// S.
    pub schur: DMatrix<f64>,
    /// Right side of the whole numbers, `S x = pull`.
    pub pull: DVector<f64>,
    /// The continuous unknowns where all whole numbers are 0.
    loaded: Vec<f64>,
}

impl<'a> Poisson<'a> {
    pub(super) fn new(
        surface: &'a Surface,
        measures: &'a Measures,
        pairs: Vec<[Vector2; 2]>,
        copies: &'a Copies,
        Spacing { cells, even }: Spacing,
    ) -> Self {
        let count = surface.triangles.len();
        Self {
            surface,
            measures,
            copies,
            cells,
            even,
            pairs,
            spacing: vec![cells.map(|cell| 1.0 / cell); count],
            stiffness: vec![1.0; count],
            factor: None,
            couplings: Vec::new(),
            carried: Vec::new(),
            schur: DMatrix::zeros(0, 0),
            pull: DVector::zeros(0),
            loaded: Vec::new(),
        }
    }

    /// Along and across the lines of coordinate `k` in a triangle, unit vectors.
    fn axes(&self, triangle: usize, k: usize) -> [Vector2; 2] {
        let [along, other] = [self.pairs[triangle][1 - k], self.pairs[triangle][k]];
        let across = Vector2::new(-along.y, along.x);
        [along, if across.dot(&other) < 0.0 { -across } else { across }]
    }

    fn terms(&self, triangle: usize, corner: usize, k: usize) -> &[Term] {
        &self.copies.forms[self.copies.of_corner[3 * triangle + corner]][k]
    }

    /// Assembles and factors; right sides are not needed for that.
    pub(super) fn factor(&mut self) -> Result<(), Failure> {
        let (free, whole) = (self.copies.continuous, self.copies.integers);
        let mut system = Triplets::new(free);
        let mut couplings = vec![Vec::new(); whole];
        let mut schur = DMatrix::zeros(whole, whole);
        for triangle in 0..self.surface.triangles.len() {
            for k in 0..2 {
                self.assemble(triangle, k, &mut |a, b, value| match (a, b) {
                    (Unknown::Continuous(a), Unknown::Continuous(b)) => {
                        system.add([a, b], value);
                    }
                    (Unknown::Continuous(a), Unknown::Integer(b))
                    | (Unknown::Integer(b), Unknown::Continuous(a)) => {
                        couplings[b].push((a, value));
                    }
                    (Unknown::Integer(a), Unknown::Integer(b)) => {
                        schur[(a, b)] += value;
                        if a != b {
                            schur[(b, a)] += value;
                        }
                    }
                });
            }
        }
        // A map that nothing pins has its mean at 0.
        let pin = PINNED * self.even;
        (0..free).for_each(|k| system.add([k, k], pin));
        (0..whole).for_each(|k| schur[(k, k)] += pin);
        let matrix = system.matrix();
        match &mut self.factor {
            Some(factor) => factor.factorise(&matrix)?,
            none => *none = Some(Cholesky::of(&matrix)?),
        }
        let mut carried = vec![0.0; free * whole];
        for (j, column) in couplings.iter().enumerate() {
            column.iter().for_each(|&(row, value)| carried[j * free + row] += value);
        }
        self.solve(&mut carried);
        self.carried = carried;
        for (i, column) in couplings.iter().enumerate() {
            for j in 0..whole {
                let x = &self.carried[j * free..(j + 1) * free];
                schur[(i, j)] -= column.iter().map(|&(row, v)| v * x[row]).sum::<f64>();
            }
        }
        self.couplings = couplings;
        self.schur = schur;
        self.load();
        Ok(())
    }

    fn solve(&mut self, right: &mut [f64]) {
        if let Some(factor) = &mut self.factor {
            factor.solve(right);
        }
    }

    /// Calls for every pair of unknowns in one triangle's form of one coordinate.
    fn assemble(
        &self,
        triangle: usize,
        k: usize,
        add: &mut impl FnMut(Unknown, Unknown, f64),
    ) {
        let [along, across] = self.axes(triangle, k);
        let slopes = self.measures.slopes(triangle);
        let weight = self.stiffness[triangle] * self.measures.areas[triangle];
        let value = |i: usize, j: usize| {
            let [a, b] = [slopes[i], slopes[j]];
            weight
                * (a.dot(&along) * b.dot(&along)
                    + self.even * a.dot(&across) * b.dot(&across))
        };
        for i in 0..3 {
            for (m, a) in self.terms(triangle, i, k).iter().enumerate() {
                for j in 0..=i {
                    for (n, b) in self.terms(triangle, j, k).iter().enumerate() {
                        if i == j && n > m {
                            break;
                        }
                        let twice = (i != j || m != n) && a.unknown == b.unknown;
                        let factor = (a.factor * b.factor) as f64;
                        let factor = if twice { 2.0 * factor } else { factor };
                        add(a.unknown, b.unknown, factor * value(i, j));
                    }
                }
            }
        }
    }

    /// Right sides: of the continuous unknowns, and of the whole ones.
    fn right(&self) -> (Vec<f64>, DVector<f64>) {
        let mut free = vec![0.0; self.copies.continuous];
        let mut whole = DVector::zeros(self.copies.integers);
        for triangle in 0..self.surface.triangles.len() {
            let slopes = self.measures.slopes(triangle);
            let weight =
                self.even * self.stiffness[triangle] * self.measures.areas[triangle];
            for k in 0..2 {
                let [_, across] = self.axes(triangle, k);
                let wanted = weight * self.spacing[triangle][k];
                for (i, slope) in slopes.iter().enumerate() {
                    let part = wanted * slope.dot(&across);
                    for term in self.terms(triangle, i, k) {
                        match term.unknown {
                            Unknown::Continuous(at) => {
                                free[at] += part * term.factor as f64;
                            }
                            Unknown::Integer(at) => {
                                whole[at] += part * term.factor as f64;
                            }
                        }
                    }
                }
            }
        }
        (free, whole)
    }

    /// Takes in the wanted spacing: right sides, and what the continuous ones lead to.
    fn load(&mut self) {
        let (mut free, mut whole) = self.right();
        self.solve(&mut free);
        for (pull, column) in whole.iter_mut().zip(&self.couplings) {
            *pull -= column.iter().map(|&(row, value)| value * free[row]).sum::<f64>();
        }
        (self.loaded, self.pull) = (free, whole);
    }

    /// The continuous unknowns for these numbers in the place of the whole ones.
    fn continuous(&self, whole: &[f64]) -> Vec<f64> {
        let mut free = self.loaded.clone();
        for (j, x) in whole.iter().enumerate() {
            let carried = self.column(j);
            free.iter_mut().zip(carried).for_each(|(free, by)| *free -= by * x);
        }
        free
    }

    /// The continuous unknowns for these whole numbers.
    pub(super) fn solution(&self, whole: &[i64]) -> Vec<f64> {
        self.continuous(&whole.iter().map(|&x| x as f64).collect::<Vec<_>>())
    }

    /// How the continuous unknowns fall when a whole number rises by one.
    pub(super) fn column(&self, j: usize) -> &[f64] {
        let free = self.copies.continuous;
        &self.carried[j * free..(j + 1) * free]
    }

    /// Coordinates of all copies.
    fn values(&self, free: &[f64], whole: &[f64]) -> Vec<[f64; 2]> {
        let value = |term: &Term| {
            let x = match term.unknown {
                Unknown::Continuous(k) => free[k],
                Unknown::Integer(k) => whole[k],
            };
            term.factor as f64 * x
        };
        let sum = |terms: &Vec<Term>| terms.iter().map(value).sum();
        self.copies.forms.iter().map(|form| [sum(&form[0]), sum(&form[1])]).collect()
    }

    /// Lets the wanted spacing follow the map, within bounds.
    pub(super) fn space(&mut self) -> Result<(), Failure> {
        for _ in 0..ROUNDS {
            let relaxed = relaxed(&self.schur, &self.pull).ok_or(Failure::NotDefinite)?;
            let free = self.continuous(relaxed.as_slice());
            let values = self.values(&free, relaxed.as_slice());
            let (mut sum, mut spacing) = (0.0, Vec::with_capacity(self.spacing.len()));
            for triangle in 0..self.surface.triangles.len() {
                let slopes = self.measures.slopes(triangle);
                let own = [0, 1].map(|k| {
                    let slope: Vector2 = (0..3)
                        .map(|i| {
                            slopes[i] * values[self.copies.of_corner[3 * triangle + i]][k]
                        })
                        .sum();
                    let across = slope.dot(&self.axes(triangle, k)[1]);
                    let cell = self.cells[k];
                    across.clamp(1.0 / (WIDEST * cell), 1.0 / (NARROWEST * cell))
                });
                let mean = (own[0] * self.cells[0] + own[1] * self.cells[1]) / 2.0;
                sum += self.measures.areas[triangle] * mean;
                spacing.push(own);
            }
            let scale = self.measures.area() / sum;
            self.spacing =
                spacing.into_iter().map(|own| own.map(|s| s * scale)).collect();
            self.load();
        }
        Ok(())
    }

    /// Makes triangles stiffer, and in part those within two rings of them.
    pub(super) fn stiffen(&mut self, triangles: &[usize], around: f64, own: f64) {
        let mut near = vec![false; self.stiffness.len()];
        triangles.iter().for_each(|&triangle| near[triangle] = true);
        for _ in 0..2 {
            let reached: Vec<usize> = (0..near.len())
                .filter(|&k| near[k])
                .flat_map(|k| self.surface.triangles[k])
                .flat_map(|vertex| self.surface.fan(vertex).map(|side| side / 3))
                .collect();
            reached.into_iter().for_each(|triangle| near[triangle] = true);
        }
        (0..near.len()).filter(|&k| near[k]).for_each(|k| self.stiffness[k] *= around);
        triangles.iter().for_each(|&k| self.stiffness[k] *= own);
    }

    /// How many triangles there are.
    pub(super) fn triangle_count(&self) -> usize {
        self.surface.triangles.len()
    }

    /// How many triangles are turned over by these unknowns.
    pub(super) fn flips(&self, free: &[f64], whole: &[i64]) -> usize {
        let whole: Vec<f64> = whole.iter().map(|&x| x as f64).collect();
        let values = self.values(free, &whole);
        let triangles = 0..self.surface.triangles.len();
        let at = |side: usize| Vector2::from(values[self.copies.of_corner[side]]);
        let is_flipped = |triangle: &usize| {
            let side = 3 * triangle;
            let from = at(side);
            (at(next(side)) - from).perp(&(at(side + 2) - from)) <= 0.0
        };
        triangles.filter(is_flipped).count()
    }
}

/// The solution of `S x = r`; `None` if there is none.
pub(super) fn relaxed(schur: &DMatrix<f64>, pull: &DVector<f64>) -> Option<DVector<f64>> {
    if pull.is_empty() {
        return Some(pull.clone());
    }
    let positive = schur.clone().cholesky().map(|factor| factor.solve(pull));
    positive.or_else(|| schur.clone().lu().solve(pull))
}
