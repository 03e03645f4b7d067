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
    pub(super) twists: Vec<[f64; 6]>,
}

impl Motions {
    /// No motion: the body is held.
    pub(super) fn none(rows: usize) -> Self {
        Self { rows, rank: 0, columns: Vec::new(), twists: Vec::new() }
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
        for k in 0..3 {
            let mut twist = [0.0; 6];
            twist[3 + k] = 1.0 / total.sqrt();
            let way = Vector3::ith(k, twist[3 + k]);
            made.columns.extend(roots.iter().flat_map(|r| <[f64; 3]>::from(way * *r)));
            made.twists.push(twist);
        }
        made.rank = 3;
        if radius > 0.0 {
            let turns = (0..3).map(|k| {
                let turn = Vector3::ith(k, 1.0 / (radius * total.sqrt()));
                let shift = centre.cross(&turn);
                let moved = points.iter().zip(roots);
                let column =
                    moved.flat_map(|(p, r)| <[f64; 3]>::from(turn.cross(&off(p)) * *r));
                let twist = [turn.x, turn.y, turn.z, shift.x, shift.y, shift.z];
                (column.collect(), twist)
            });
            made.add_turns(turns.collect());
        }
        made
    }

    /// Adds what is new in these columns, longest rest first.
    fn add_turns(&mut self, mut turns: Vec<(Vec<f64>, [f64; 6])>) {
        while !turns.is_empty() {
            for (column, twist) in &mut turns {
                self.clear(column, twist);
                self.clear(column, twist);
            }
            let lengths: Vec<f64> = turns.iter().map(|(c, _)| norm(c)).collect();
            let longest = (0..turns.len())
                .max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]))
                .unwrap_or(0);
            let (mut column, mut twist) = turns.swap_remove(longest);
            if lengths[longest] <= NO_ROTATION {
                return;
            }
            let scale = 1.0 / lengths[longest];
            column.iter_mut().chain(&mut twist).for_each(|x| *x *= scale);
            self.columns.append(&mut column);
            self.twists.push(twist);
            self.rank += 1;
        }
    }

    /// Takes from a column what the basis has already.
    fn clear(&self, column: &mut [f64], twist: &mut [f64; 6]) {
        for k in 0..self.rank {
            let basis = self.column(k);
            let share: f64 = basis.iter().zip(&*column).map(|(a, b)| a * b).sum();
            column.iter_mut().zip(basis).for_each(|(x, b)| *x -= share * b);
            twist.iter_mut().zip(&self.twists[k]).for_each(|(x, t)| *x -= share * t);
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
