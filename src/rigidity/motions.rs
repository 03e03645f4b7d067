//! An orthonormal basis of how the points of one rigid body can move.
//!
//! Made from centred, scaled points by modified Gram-Schmidt with pivoting, twice: the
//! basis must be orthonormal to the last digit, or exact mechanisms look rigid
//! (`docs/rigidity.md`, "Accuracy").

use crate::geometry::{Point3, Vector3};
use crate::tolerance::NO_ROTATION;

/// Orthonormal columns: velocities of a body's points under its rigid motions, each
/// velocity multiplied by the root of the point's weight.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Motions {
    /// Three per point.
    pub(super) rows: usize,
    /// How many motions can be told apart at these points, 0 to 6.
    pub(super) rank: usize,
    /// Column by column, `rows * rank` numbers.
    pub(super) columns: Vec<f64>,
    /// For each column the motion `(C, C̄)` that makes it: `V(q) = C × q + C̄`.
    pub(super) twists: [[f64; 6]; 6],
}

impl Motions {
    /// No motion: the body is held.
    pub(super) fn none(rows: usize) -> Self {
        Self { rows, rank: 0, columns: Vec::new(), twists: [[0.0; 6]; 6] }
    }

    /// The motions of a body with these points, in mm; `roots` are roots of weights.
    pub(super) fn new(points: &[Point3], roots: &[f64]) -> Self {
        let total: f64 = roots.iter().map(|r| r * r).sum();
        if points.is_empty() || total <= 0.0 {
            return Self::none(3 * points.len());
        }
        let weighted = points.iter().zip(roots).map(|(p, r)| p.coords * (r * r));
        let centre = weighted.sum::<Vector3>() / total;
        let off = |p: &Point3| p.coords - centre;
        let spread: f64 =
            points.iter().zip(roots).map(|(p, r)| r * r * off(p).norm_squared()).sum();
        let radius = (spread / total).sqrt();
        let mut made = Self::none(3 * points.len());
        made.columns.reserve_exact(6 * made.rows);
        for k in 0..3 {
            made.twists[k][3 + k] = 1.0 / total.sqrt();
            let way = Vector3::ith(k, made.twists[k][3 + k]);
            made.columns.extend(roots.iter().flat_map(|r| <[f64; 3]>::from(way * *r)));
        }
        made.rank = 3;
        // What is no number must not pass for a point.
        if radius > 0.0 || radius.is_nan() {
            for k in 0..3 {
                let turn = Vector3::ith(k, 1.0 / (radius * total.sqrt()));
                let shift = centre.cross(&turn);
                made.twists[3 + k] = [turn.x, turn.y, turn.z, shift.x, shift.y, shift.z];
                let moved = points.iter().zip(roots);
                made.columns.extend(
                    moved.flat_map(|(p, r)| <[f64; 3]>::from(turn.cross(&off(p)) * *r)),
                );
            }
            made.choose_turns();
        }
        made
    }

    /// Makes what is new in the three last columns orthonormal, longest rest first; what is
    /// not new is dropped.
    fn choose_turns(&mut self) {
        for k in 3..6 {
            for turn in k..6 {
                self.clear(turn);
                self.clear(turn);
            }
            let lengths: [f64; 6] =
                std::array::from_fn(|j| if j < k { 0.0 } else { norm(self.column(j)) });
            let longest = (k..6).max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]));
            let Some(longest) =
                longest.filter(|&j| lengths[j].is_nan() || lengths[j] > NO_ROTATION)
            else {
                break;
            };
            self.swap(k, longest);
            let scale = 1.0 / lengths[longest];
            let column = &mut self.columns[k * self.rows..(k + 1) * self.rows];
            column.iter_mut().chain(&mut self.twists[k]).for_each(|x| *x *= scale);
            self.rank += 1;
        }
        self.columns.truncate(self.rank * self.rows);
    }

    fn swap(&mut self, a: usize, b: usize) {
        self.twists.swap(a, b);
        if a < b {
            let (before, after) = self.columns.split_at_mut(b * self.rows);
            before[a * self.rows..(a + 1) * self.rows]
                .swap_with_slice(&mut after[..self.rows]);
        }
    }

    /// Takes from a column what the basis before has already.
    fn clear(&mut self, turn: usize) {
        let (before, after) = self.columns.split_at_mut(turn * self.rows);
        let column = &mut after[..self.rows];
        for k in 0..self.rank {
            let basis = &before[k * self.rows..(k + 1) * self.rows];
            let share: f64 = basis.iter().zip(&*column).map(|(a, b)| a * b).sum();
            column.iter_mut().zip(basis).for_each(|(x, b)| *x -= share * b);
            let twist = self.twists[k];
            self.twists[turn].iter_mut().zip(twist).for_each(|(x, t)| *x -= share * t);
        }
    }

    /// One column.
    pub(super) fn column(&self, k: usize) -> &[f64] {
        &self.columns[k * self.rows..(k + 1) * self.rows]
    }

    /// Shares of `values` in each column.
    pub(super) fn shares(&self, values: &[f64]) -> [f64; 6] {
        let mut shares = [0.0; 6];
        for (k, share) in shares.iter_mut().enumerate().take(self.rank) {
            *share = self.column(k).iter().zip(values).map(|(a, b)| a * b).sum();
        }
        shares
    }

    /// What is left of `values` when the nearest rigid motion is taken away.
    pub(super) fn clear_values(&self, values: &mut [f64]) {
        let shares = self.shares(values);
        for (k, share) in shares.iter().enumerate().take(self.rank) {
            values.iter_mut().zip(self.column(k)).for_each(|(x, b)| *x -= share * b);
        }
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum::<f64>().sqrt()
}
