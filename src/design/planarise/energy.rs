//! What is minimised: a sum of squared residuals of nodes and axes
//! (`notes`: planarity, closeness, fairness, staying, unit axes, limits).
//!
//! Lengths are in units of the median fin length, around the mesh's own middle, so that
//! moving and scaling the input changes nothing. Every row knows its derivative; feet on
//! the given surface are frozen while a system is solved and sought again after each step.

use crate::design::planarise::matrix::{NormalMatrix, SIZE};
use crate::design::planarise::options::Weights;
use crate::design::planarise::surface::{Foot, Surface, unit};
use crate::geometry::{Point3, Vector3};
use crate::structure::planarity;

/// Derivative of a row by a node's position and axis.
pub(super) type Slope = [f64; SIZE];

/// Positions and axes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct State {
    pub positions: Vec<Point3>,
    pub axes: Vec<Vector3>,
}

/// A fin with how far it reaches at its ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fin {
    pub ends: [usize; 2],
    /// Below and above, at both ends.
    pub reach: [[f64; 2]; 2],
}

/// Nodes whose changes belong together: their weighted sum is to vanish.
pub(super) struct Even {
    /// Nodes with their shares in the sum.
    pub stencil: Vec<(usize, f64)>,
    /// Whether this is a node that stays, and not a line that keeps its sweep.
    pub stays: bool,
}

/// Where the feet of a node are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Feet {
    surface: Option<Foot>,
    /// A point of the boundary, and the direction inside the surface away from it.
    rim: Option<(Point3, Vector3)>,
}

/// The sum of squares.
pub(super) struct Energy {
    pub start: State,
    pub fins: Vec<Fin>,
    pub evens: Vec<Even>,
    pub surface: Surface,
    pub weights: Weights,
    /// How far each node may move.
    pub reach: Vec<f64>,
    /// Normal of the surface at each node, on the side of its axis, and the least cosine
    /// between the two.
    pub upright: Vec<(Vector3, f64)>,
    /// Whether each node's position and axis are free.
    pub free: Vec<[bool; 2]>,
}

impl Energy {
    /// The same with node `order[k]` as the `k`-th.
    pub(super) fn renumbered(mut self, order: &[usize]) -> Self {
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(k, &node)| place[node] = k);
        for node in self.fins.iter_mut().flat_map(|fin| &mut fin.ends) {
            *node = place[*node];
        }
        for (node, _) in self.evens.iter_mut().flat_map(|even| &mut even.stencil) {
            *node = place[*node];
        }
        Self {
            start: State {
                positions: order.iter().map(|&node| self.start.positions[node]).collect(),
                axes: order.iter().map(|&node| self.start.axes[node]).collect(),
            },
            surface: self.surface.renumbered(order),
            reach: order.iter().map(|&node| self.reach[node]).collect(),
            upright: order.iter().map(|&node| self.upright[node]).collect(),
            free: order.iter().map(|&node| self.free[node]).collect(),
            ..self
        }
    }

    /// Feet of all nodes.
    pub(super) fn feet(&self, state: &State) -> Vec<Feet> {
        let foot = |(node, &point): (usize, &Point3)| {
            let sought = self.weights.closeness > 0.0 || self.weights.rim > 0.0;
            if !sought || !self.free[node][0] {
                return Feet { surface: None, rim: None };
            }
            let surface = self.surface.foot(node, point);
            let rim = surface.and_then(|surface| {
                let (point, tangent) = self.surface.rim_foot(node, point)?;
                Some((point, unit(tangent.cross(&surface.normal))))
            });
            Feet { surface, rim }
        };
        state.positions.iter().enumerate().map(foot).collect()
    }

    /// The sum of squares.
    pub(super) fn value(&self, state: &State, feet: &[Feet]) -> f64 {
        let mut sum = 0.0;
        for fin in &self.fins {
            let (value, _) = self.fin_row(fin, state);
            sum += value * value;
        }
        for (node, feet) in feet.iter().enumerate() {
            self.node_rows(node, state, feet, &mut |value, _| sum += value * value);
        }
        let even = |even| self.even_rows(even, state).iter().map(|x| x * x).sum::<f64>();
        sum + self.evens.iter().map(even).sum::<f64>()
    }

    /// The matrix of the rows that never change: fairness and staying.
    pub(super) fn constant(&self) -> NormalMatrix {
        let mut matrix =
            NormalMatrix::new(self.free.len(), &coupled(&self.fins, &self.evens));
        for even in &self.evens {
            let (stencil, weights) = (&even.stencil, self.even_weights(even));
            for (k, &(i, a)) in stencil.iter().enumerate() {
                for &(j, b) in &stencil[..=k] {
                    let part = |c: usize| {
                        let free = self.free[i][c / 3] && self.free[j][c / 3];
                        if free { a * b * weights[c / 3] * weights[c / 3] } else { 0.0 }
                    };
                    matrix.add_diagonal([i, j], &std::array::from_fn(part));
                }
            }
        }
        for (node, free) in self.free.iter().enumerate() {
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
        let mut pull = vec![0.0; SIZE * self.free.len()];
        let mut add = |node: usize, value: f64, slope: &Slope| {
            let pull = &mut pull[SIZE * node..SIZE * (node + 1)];
            pull.iter_mut().zip(slope).for_each(|(pull, slope)| *pull += value * slope);
        };
        for fin in &self.fins {
            let (value, slopes) = self.fin_row(fin, state);
            let [i, j] = fin.ends;
            let slopes = [self.masked(i, slopes[0]), self.masked(j, slopes[1])];
            matrix.add_square(i, &slopes[0]);
            matrix.add_square(j, &slopes[1]);
            matrix.add_product(fin.ends, &slopes[0], &slopes[1]);
            add(i, value, &slopes[0]);
            add(j, value, &slopes[1]);
        }
        for (node, feet) in feet.iter().enumerate() {
            self.node_rows(node, state, feet, &mut |value, slope| {
                let slope = self.masked(node, slope);
                matrix.add_square(node, &slope);
                add(node, value, &slope);
            });
        }
        for even in &self.evens {
            let value = self.even_rows(even, state);
            let weights = self.even_weights(even);
            for &(node, share) in &even.stencil {
                let slope = |c: usize| share * weights[c / 3] * value[c];
                add(node, 1.0, &self.masked(node, std::array::from_fn(slope)));
            }
        }
        pull
    }

    /// Planarity (contract §2) of each fin, as a share of its diameter.
    pub(super) fn planarities(&self, state: &State) -> impl Iterator<Item = f64> {
        self.fins.iter().map(move |fin| {
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

    /// How far a fin is from plane: height × [u, eᵢ, eⱼ], u the edge's unit vector.
    fn fin_row(&self, fin: &Fin, state: &State) -> (f64, [Slope; 2]) {
        let [i, j] = fin.ends;
        let (a, b) = (state.axes[i], state.axes[j]);
        let edge = state.positions[j] - state.positions[i];
        let length = edge.norm();
        let u = edge / length;
        let height = fin.reach.iter().flatten().sum::<f64>() / 2.0;
        let weight = self.weights.planarity * height;
        let across = a.cross(&b);
        let value = u.dot(&across);
        let by_position = (across - u * value) * (weight / length);
        let by_a = b.cross(&u) * weight;
        let by_b = u.cross(&a) * weight;
        (weight * value, [slope(-by_position, by_a), slope(by_position, by_b)])
    }

    /// The rows of one node alone.
    fn node_rows(
        &self,
        node: usize,
        state: &State,
        feet: &Feet,
        row: &mut dyn FnMut(f64, Slope),
    ) {
        let (x, e) = (state.positions[node], state.axes[node]);
        let weights = &self.weights;
        let zero = Vector3::zeros();
        // Unit axis.
        row(e.norm_squared() - 1.0, slope(zero, e * 2.0));
        if let Some(foot) = feet.surface {
            let off = foot.normal.dot(&(x - foot.point));
            row(weights.closeness * off, slope(foot.normal * weights.closeness, zero));
        }
        if let Some((point, out)) = feet.rim {
            row(weights.rim * out.dot(&(x - point)), slope(out * weights.rim, zero));
        }
        let (normal, least) = self.upright[node];
        let short = e.dot(&normal) - least;
        if short < 0.0 {
            row(weights.walls * short, slope(zero, normal * weights.walls));
        }
        let moved = x - self.start.positions[node];
        let far = moved.norm() - self.reach[node];
        if far > 0.0 {
            row(weights.walls * far, slope(unit(moved) * weights.walls, zero));
        }
    }

    /// The six rows of a stencil: changes of positions and of axes.
    fn even_rows(&self, even: &Even, state: &State) -> [f64; SIZE] {
        let (mut moved, mut turned) = (Vector3::zeros(), Vector3::zeros());
        for &(node, share) in &even.stencil {
            moved += (state.positions[node] - self.start.positions[node]) * share;
            turned += (state.axes[node] - self.start.axes[node]) * share;
        }
        let [by_move, by_turn] = self.even_weights(even);
        slope(moved * by_move, turned * by_turn)
    }

    /// Weights of positions and of axes.
    fn even_weights(&self, even: &Even) -> [f64; 2] {
        let weights = &self.weights;
        if even.stays { [weights.stay, weights.stay_axes] } else { [weights.fairness; 2] }
    }

    /// Zero where the node is held.
    fn masked(&self, node: usize, mut slope: Slope) -> Slope {
        for (c, part) in slope.iter_mut().enumerate() {
            if !self.free[node][c / 3] {
                *part = 0.0;
            }
        }
        slope
    }
}

fn slope(position: Vector3, axis: Vector3) -> Slope {
    [position.x, position.y, position.z, axis.x, axis.y, axis.z]
}

/// All pairs of nodes that a row couples.
pub(super) fn coupled(fins: &[Fin], evens: &[Even]) -> Vec<[usize; 2]> {
    let evens = evens.iter().flat_map(|even| {
        let nodes = even.stencil.iter().enumerate();
        nodes.flat_map(|(k, &(i, _))| even.stencil[..k].iter().map(move |&(j, _)| [i, j]))
    });
    fins.iter().map(|fin| fin.ends).chain(evens).collect()
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
        let mut state = energy.start.clone();
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
            if !energy.free[node][c / 3] {
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
