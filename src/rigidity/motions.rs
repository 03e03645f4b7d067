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
}

/// For each column the motion `(C, C̄)` that makes it: `V(q) = C × q + C̄`.
pub(super) type Twists = [[f64; 6]; 6];

/// A basis in the making, with the motions that make it if they are asked for.
struct Making {
    motions: Motions,
    twists: Option<Twists>,
}

impl Motions {
    /// No motion: the body is held.
    pub(super) fn none(rows: usize) -> Self {
        Self { rows, rank: 0, columns: Vec::new() }
    }

    /// The motions of a body with these points, in mm; `roots` are roots of weights.
    pub(super) fn new(points: &[Point3], roots: &[f64]) -> Self {
        Making::done(points, roots, None).motions
    }

    /// The motions that make the columns of the basis.
    pub(super) fn twists(points: &[Point3], roots: &[f64]) -> Twists {
        let none = [[0.0; 6]; 6];
        Making::done(points, roots, Some(none)).twists.unwrap_or(none)
    }

    /// One column.
    pub(super) fn column(&self, k: usize) -> &[f64] {
        &self.columns[k * self.rows..(k + 1) * self.rows]
    }

    /// Shares of `values` in each column.
    pub(super) fn shares(&self, values: &[f64]) -> [f64; 6] {
        let mut shares = [0.0; 6];
        for (k, share) in shares.iter_mut().enumerate().take(self.rank) {
            *share = dot(self.column(k), values);
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

impl Making {
    fn done(points: &[Point3], roots: &[f64], twists: Option<Twists>) -> Self {
        let total: f64 = roots.iter().map(|r| r * r).sum();
        let mut made = Self { motions: Motions::none(3 * points.len()), twists };
        if points.is_empty() || total <= 0.0 {
            return made;
        }
        let weighted = points.iter().zip(roots).map(|(p, r)| p.coords * (r * r));
        let centre = weighted.sum::<Vector3>() / total;
        let off = |p: &Point3| p.coords - centre;
        let spread: f64 =
            points.iter().zip(roots).map(|(p, r)| r * r * off(p).norm_squared()).sum();
        let radius = (spread / total).sqrt();
        let motions = &mut made.motions;
        motions.columns.reserve_exact(6 * motions.rows);
        for k in 0..3 {
            let way = Vector3::ith(k, 1.0 / total.sqrt());
            motions.columns.extend(roots.iter().flat_map(|r| <[f64; 3]>::from(way * *r)));
            if let Some(twists) = &mut made.twists {
                twists[k][3 + k] = way[k];
            }
        }
        motions.rank = 3;
        // What is no number must not pass for a point.
        if radius > 0.0 || radius.is_nan() {
            for k in 0..3 {
                let turn = Vector3::ith(k, 1.0 / (radius * total.sqrt()));
                if let Some(twists) = &mut made.twists {
                    let shift = centre.cross(&turn);
                    twists[3 + k] = [turn.x, turn.y, turn.z, shift.x, shift.y, shift.z];
                }
                let moved = points.iter().zip(roots);
                motions.columns.extend(
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
        (3..6).for_each(|turn| self.clear(turn, 0));
        for k in 3..6 {
            let lengths: [f64; 6] = std::array::from_fn(|j| {
                if j < k { 0.0 } else { length(self.motions.column(j)) }
            });
            let longest = (k..6).max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]));
            let Some(longest) =
                longest.filter(|&j| lengths[j].is_nan() || lengths[j] > NO_ROTATION)
            else {
                break;
            };
            self.swap(k, longest);
            // What has shrunk has lost digits: once more.
            self.clear(k, 0);
            let rows = self.motions.rows;
            let column = &mut self.motions.columns[k * rows..(k + 1) * rows];
            let scale = 1.0 / length(column);
            column.iter_mut().for_each(|x| *x *= scale);
            if let Some(twists) = &mut self.twists {
                twists[k].iter_mut().for_each(|x| *x *= scale);
            }
            self.motions.rank += 1;
            (k + 1..6).for_each(|turn| self.clear(turn, k));
        }
        let Motions { rows, rank, columns } = &mut self.motions;
        columns.truncate(*rank * *rows);
    }

    fn swap(&mut self, a: usize, b: usize) {
        if a < b {
            let rows = self.motions.rows;
            let (before, after) = self.motions.columns.split_at_mut(b * rows);
            before[a * rows..(a + 1) * rows].swap_with_slice(&mut after[..rows]);
            if let Some(twists) = &mut self.twists {
                twists.swap(a, b);
            }
        }
    }

    /// Takes from a column what the basis, from column `first` on, has already.
    fn clear(&mut self, turn: usize, first: usize) {
        let Motions { rows, rank, columns } = &mut self.motions;
        let (before, after) = columns.split_at_mut(turn * *rows);
        let column = &mut after[..*rows];
        for k in first..*rank {
            let basis = &before[k * *rows..(k + 1) * *rows];
            let share = dot(basis, column);
            column.iter_mut().zip(basis).for_each(|(x, b)| *x -= share * b);
            if let Some(twists) = &mut self.twists {
                let twist = twists[k];
                twists[turn].iter_mut().zip(twist).for_each(|(x, t)| *x -= share * t);
            }
        }
    }
}

/// Lanes that are summed up apart, which is quicker.
const LANES: usize = 4;

fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        for k in 0..LANES {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = rest_a.iter().zip(rest_b).map(|(a, b)| a * b).sum();
    sums[0] + sums[1] + (sums[2] + sums[3]) + rest
}

fn length(values: &[f64]) -> f64 {
    dot(values, values).sqrt()
}
