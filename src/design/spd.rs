//! Sparse symmetric positive definite systems of fields and maps: one analysis, many
//! factorisations, many right sides.

use faer::linalg::solvers::SolveCore;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use faer::{Conj, MatMut, Side};

/// A symmetric matrix, by entries on and below its diagonal that add up where they meet.
#[derive(Debug, Clone, Default)]
pub(super) struct Entries {
    size: usize,
    places: Vec<[usize; 2]>,
    values: Vec<f64>,
}

impl Entries {
    /// No entry yet.
    pub(super) fn new(size: usize) -> Self {
        Self { size, ..Self::default() }
    }

    /// Adds to the entry at row `i`, column `j` and to that at row `j`, column `i`, which
    /// are the same one on the diagonal.
    pub(super) fn add(&mut self, i: usize, j: usize, value: f64) {
        self.places.push([i.min(j), i.max(j)]);
        self.values.push(value);
    }

    /// Adds `weight (a x_i − b x_j)²` to the form.
    pub(super) fn add_difference(
        &mut self,
        [i, j]: [usize; 2],
        [a, b]: [f64; 2],
        weight: f64,
    ) {
        self.add(i, i, weight * a * a);
        self.add(j, j, weight * b * b);
        self.add(i, j, -weight * a * b);
    }

    /// Compressed columns of the lower half.
    fn compressed(&self) -> (Vec<usize>, Vec<usize>, Vec<f64>) {
        let mut starts = vec![0; self.size + 1];
        self.places.iter().for_each(|place| starts[place[0] + 1] += 1);
        for k in 0..self.size {
            starts[k + 1] += starts[k];
        }
        let mut next = starts.clone();
        let mut unsorted = vec![(0, 0.0); self.places.len()];
        for (place, &value) in self.places.iter().zip(&self.values) {
            unsorted[next[place[0]]] = (place[1], value);
            next[place[0]] += 1;
        }
        let (mut columns, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for column in 0..self.size {
            let entries = &mut unsorted[starts[column]..starts[column + 1]];
            // Stable, so that sums are made in the order of adding.
            entries.sort_by_key(|entry| entry.0);
            for along in entries.chunk_by(|a, b| a.0 == b.0) {
                rows.push(along[0].0);
                values.push(along.iter().map(|entry| entry.1).sum());
            }
            columns.push(rows.len());
        }
        (columns, rows, values)
    }
}

/// A factored matrix.
pub(super) struct Factor {
    size: usize,
    symbolic: SymbolicLlt<usize>,
    numeric: Llt<usize, f64>,
}

/// The matrix is not positive definite, or too large.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NotDefinite;

impl Factor {
    /// Factors a matrix.
    pub(super) fn new(entries: &Entries) -> Result<Self, NotDefinite> {
        let matrix = assembled(entries);
        let symbolic = SymbolicLlt::try_new(matrix.symbolic(), Side::Lower)
            .map_err(|_| NotDefinite)?;
        let numeric =
            Llt::try_new_with_symbolic(symbolic.clone(), matrix.as_ref(), Side::Lower)
                .map_err(|_| NotDefinite)?;
        Ok(Self { size: entries.size, symbolic, numeric })
    }

    /// Factors another matrix with entries in the same places.
    pub(super) fn refactor(&mut self, entries: &Entries) -> Result<(), NotDefinite> {
        let matrix = assembled(entries);
        let symbolic = self.symbolic.clone();
        self.numeric = Llt::try_new_with_symbolic(symbolic, matrix.as_ref(), Side::Lower)
            .map_err(|_| NotDefinite)?;
        Ok(())
    }

    /// Solves for right sides that stand one after the other, in place.
    pub(super) fn solve(&self, right: &mut [f64]) {
        if let Some(count) = right.len().checked_div(self.size) {
            let right = MatMut::from_column_major_slice_mut(right, self.size, count);
            self.numeric.solve_in_place_with_conj(Conj::No, right);
        }
    }
}

fn assembled(entries: &Entries) -> SparseColMat<usize, f64> {
    let (columns, rows, values) = entries.compressed();
    let size = entries.size;
    let pattern = SymbolicSparseColMat::new_checked(size, size, columns, None, rows);
    SparseColMat::new(pattern, values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_that_meet_add_up_and_the_system_is_solved() {
        let mut entries = Entries::new(3);
        entries.add_difference([0, 1], [1.0, 1.0], 2.0);
        entries.add_difference([2, 1], [1.0, -1.0], 1.0);
        entries.add(0, 0, 1.0);
        entries.add(2, 2, 3.0);
        // [3 -2 0; -2 3 1; 0 1 4] x = b
        let factor = Factor::new(&entries).unwrap();
        let mut right = vec![-1.0, 7.0, 14.0, 3.0, -2.0, 0.0];
        factor.solve(&mut right);
        for (found, wanted) in right.iter().zip([1.0, 2.0, 3.0]) {
            assert!((found - wanted).abs() < 1e-12, "{right:?}");
        }
    }
}
