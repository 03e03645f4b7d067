//! What is minimised: a sum of squared residuals of nodes and axes, the rows of its
//! [terms](crate::design::planarise::terms).
//!
//! Lengths are in units of the median fin length, around the mesh's own middle, so that
//! moving and scaling the input changes nothing. Every row knows its derivative; feet on
//! the given surface are frozen while a system is solved and sought again after each step.

use crate::design::planarise::given::{At, Feet, Given, Slope, State, slope};
use crate::design::planarise::matrix::{NormalMatrix, SIZE};
use crate::design::planarise::surface::unit;
use crate::design::planarise::terms::{Planarity, Stencil, Term};
use crate::geometry::{Point3, Vector3};
use crate::structure::planarity;

/// The sum of squares.
pub(super) struct Energy {
    pub given: Given,
    pub planarity: Planarity,
    /// What is wished for besides.
    pub wishes: Vec<Box<dyn Term>>,
}

impl Energy {
    /// Planarity counts and nothing else, but that axes have length one.
    pub(super) fn silence_wishes(&mut self) {
        self.wishes.iter_mut().for_each(|wish| wish.silence());
    }

    fn terms(&self) -> impl Iterator<Item = &dyn Term> {
        let planarity: &dyn Term = &self.planarity;
        std::iter::once(planarity).chain(self.wishes.iter().map(AsRef::as_ref))
    }

    fn stencils(&self) -> impl Iterator<Item = &Stencil> {
        self.terms().flat_map(|term| term.stencils())
    }

    /// Feet of all nodes.
    pub(super) fn feet(&self, state: &State) -> Vec<Feet> {
        let sought = self.terms().any(Term::needs_feet);
        let surface = &self.given.surface;
        let feet = |(node, &point): (usize, &Point3)| {
            if !sought || !self.given.free[node][0] {
                return Feet { surface: None, boundary: None };
            }
            let foot = surface.foot(node, point);
            let boundary = foot.and_then(|foot| {
                let (point, tangent) = surface.boundary_foot(node, point)?;
                Some((point, unit(tangent.cross(&foot.normal))))
            });
            Feet { surface: foot, boundary }
        };
        state.positions.iter().enumerate().map(feet).collect()
    }

    /// The sum of squares.
    pub(super) fn value(&self, state: &State, feet: &[Feet]) -> f64 {
        let at = At { given: &self.given, now: state, feet };
        let mut sum = 0.0;
        for fin in &self.given.fins {
            let row = &mut |value: f64, _| sum += value * value;
            self.terms().for_each(|term| term.on_fin(fin, &at, row));
        }
        for node in 0..feet.len() {
            let row = &mut |value: f64, _| sum += value * value;
            self.terms().for_each(|term| term.on_node(node, &at, row));
        }
        let rows = self.stencils().map(|stencil| stencil.rows(&at));
        sum + rows.map(|rows| rows.iter().map(|x| x * x).sum::<f64>()).sum::<f64>()
    }

    /// The matrix of the rows that never change, those of stencils.
    pub(super) fn constant(&self) -> NormalMatrix {
        let free = &self.given.free;
        let mut matrix = NormalMatrix::new(free.len(), &self.given.coupled());
        for Stencil { shares, weights } in self.stencils() {
            for (k, &(i, a)) in shares.iter().enumerate() {
                for &(j, b) in &shares[..=k] {
                    let part = |c: usize| {
                        let free = free[i][c / 3] && free[j][c / 3];
                        if free { a * b * weights[c / 3] * weights[c / 3] } else { 0.0 }
                    };
                    matrix.add_diagonal([i, j], &std::array::from_fn(part));
                }
            }
        }
        for (node, free) in free.iter().enumerate() {
            // A held unknown is its own equation: no change.
            let held = |c: usize| if free[c / 3] { 0.0 } else { 1.0 };
            matrix.add_diagonal([node, node], &std::array::from_fn(held));
        }
        matrix
    }

    /// Adds the rows that change to the matrix, and returns the sum of each row times its
    /// derivative.
    pub(super) fn linearise(
        &self,
        state: &State,
        feet: &[Feet],
        matrix: &mut NormalMatrix,
    ) -> Vec<f64> {
        let at = At { given: &self.given, now: state, feet };
        let mut pull = vec![0.0; SIZE * feet.len()];
        let mut add = |node: usize, value: f64, slope: &Slope| {
            let pull = &mut pull[SIZE * node..SIZE * (node + 1)];
            pull.iter_mut().zip(slope).for_each(|(pull, slope)| *pull += value * slope);
        };
        for fin in &self.given.fins {
            let [i, j] = fin.ends;
            let row = &mut |value, [a, b]: [Slope; 2]| {
                let slopes = [self.masked(i, a), self.masked(j, b)];
                matrix.add_square(i, &slopes[0]);
                matrix.add_square(j, &slopes[1]);
                matrix.add_product(fin.ends, &slopes[0], &slopes[1]);
                add(i, value, &slopes[0]);
                add(j, value, &slopes[1]);
            };
            self.terms().for_each(|term| term.on_fin(fin, &at, row));
        }
        for node in 0..feet.len() {
            let row = &mut |value, slope| {
                let slope = self.masked(node, slope);
                matrix.add_square(node, &slope);
                add(node, value, &slope);
            };
            self.terms().for_each(|term| term.on_node(node, &at, row));
        }
        for stencil in self.stencils() {
            let rows = stencil.rows(&at);
            for &(node, share) in &stencil.shares {
                let slope = |c: usize| share * stencil.weights[c / 3] * rows[c];
                add(node, 1.0, &self.masked(node, std::array::from_fn(slope)));
            }
        }
        pull
    }

    /// Planarity of each fin, as a share of its diameter.
    pub(super) fn planarities(&self, state: &State) -> impl Iterator<Item = f64> {
        self.given.fins.iter().map(move |fin| {
            let [a, b] =
                fin.ends.map(|node| (state.positions[node], unit(state.axes[node])));
            let [[below_a, above_a], [below_b, above_b]] = fin.reach;
            let (off, diameter) = planarity(&[
                a.0 - a.1 * below_a,
                b.0 - b.1 * below_b,
                b.0 + b.1 * above_b,
                a.0 + a.1 * above_a,
            ]);
            off / diameter
        })
    }

    /// Zero where the node is held.
    fn masked(&self, node: usize, mut slope: Slope) -> Slope {
        for (c, part) in slope.iter_mut().enumerate() {
            if !self.given.free[node][c / 3] {
                *part = 0.0;
            }
        }
        slope
    }
}

impl Stencil {
    /// Its six rows: changes of positions and of axes.
    fn rows(&self, at: &At) -> [f64; SIZE] {
        let start = &at.given.start;
        let (mut moved, mut turned) = (Vector3::zeros(), Vector3::zeros());
        for &(node, share) in &self.shares {
            moved += (at.now.positions[node] - start.positions[node]) * share;
            turned += (at.now.axes[node] - start.axes[node]) * share;
        }
        slope(moved * self.weights[0], turned * self.weights[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::planarise::options::Options;
    use crate::design::planarise::setup;
    use crate::geometry::{Mesh, trig};
    use crate::structure::{AxisRule, Draft};

    /// Five by five nodes, every row of the energy at work.
    fn energy() -> Energy {
        let point = |k: usize| {
            let (x, y) = ((k % 5) as f64, (k / 5) as f64);
            Point3::new(x, y + 0.1 * trig::sin(x), 0.4 * trig::sin(x * y))
        };
        let positions: Vec<Point3> = (0..25).map(point).collect();
        let cells = (0..20).filter(|k| k % 5 < 4);
        let faces: Vec<Vec<usize>> =
            cells.map(|k| vec![k, k + 1, k + 6, k + 5]).collect();
        let axes = AxisRule::Normal.axes(&positions, &faces).unwrap();
        let draft =
            Draft { positions, axes, faces, ..Draft::default() }.with_depth(0.3, 0.5);
        let mesh = Mesh::new(25, &draft.faces).unwrap();
        let options =
            Options { tilt_limit: 0.05, move_limit: 0.02, ..Options::default() };
        let fins = setup::fins(&draft, &mesh, true);
        setup::task(&draft, &mesh, &options, &fins).energy
    }

    #[test]
    fn derivatives_agree_with_finite_differences() {
        const STEP: f64 = 1e-6;
        let energy = energy();
        let mut state = energy.given.start.clone();
        for (k, (point, axis)) in
            state.positions.iter_mut().zip(&mut state.axes).enumerate()
        {
            let wave = |c: f64| 0.1 * trig::sin(c * (k as f64 + 1.0));
            *point += Vector3::new(wave(1.3), wave(2.1), wave(3.7));
            *axis += Vector3::new(wave(0.9), wave(1.9), wave(2.9));
        }
        let feet = energy.feet(&state);
        let pull = energy.linearise(&state, &feet, &mut energy.constant());
        for (k, pull) in pull.iter().enumerate() {
            let (node, c) = (k / SIZE, k % SIZE);
            if !energy.given.free[node][c / 3] {
                assert_eq!(pull.to_bits(), 0.0_f64.to_bits());
                continue;
            }
            let value = |by: f64| {
                let mut state = state.clone();
                match c {
                    0..3 => state.positions[node][c] += by,
                    _ => state.axes[node][c - 3] += by,
                }
                energy.value(&state, &feet)
            };
            let wanted = (value(STEP) - value(-STEP)) / (4.0 * STEP);
            assert!((pull - wanted).abs() < 1e-6 * (1.0 + wanted.abs()), "{k}: {wanted}");
        }
    }
}
