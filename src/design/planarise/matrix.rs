//! Normal equations in blocks of 6 × 6, one per pair of nodes that a residual couples.
//!
//! Nodes are numbered in the order of elimination (approximate minimum degree on the graph
//! of nodes, not of unknowns), so that the matrix is factorised as it stands.

use crate::sparse::{Last, SymmetricMatrix, elimination_order};

/// Unknowns of a node: three of its position, three of its axis.
pub(super) const SIZE: usize = 6;

/// An order of nodes in which eliminating them fills little; `order[k]` is the node that
/// comes as the `k`-th. `pairs` are the coupled nodes.
pub(super) fn node_order(nodes: usize, pairs: &[[usize; 2]]) -> Vec<usize> {
    let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); nodes];
    for &[i, j] in pairs {
        neighbours[i].push(j as u32);
        neighbours[j].push(i as u32);
    }
    for list in &mut neighbours {
        list.sort_unstable();
        list.dedup();
    }
    elimination_order(&neighbours, Last::Lowest)
}

/// The lower half of a symmetric matrix of 6 × 6 blocks.
pub(super) struct NormalMatrix {
    /// For each node, the nodes after it that it is coupled with, ascending.
    below: Vec<Vec<usize>>,
    pub(super) lower: SymmetricMatrix,
}

impl NormalMatrix {
    /// All zero, with a block for each node and for each pair of coupled ones.
    pub(super) fn new(nodes: usize, pairs: &[[usize; 2]]) -> Self {
        let mut below: Vec<Vec<usize>> = vec![Vec::new(); nodes];
        for &[i, j] in pairs {
            below[i.min(j)].push(i.max(j));
        }
        for list in &mut below {
            list.sort_unstable();
            list.dedup();
        }
        let mut columns = vec![0];
        let mut rows = Vec::new();
        for (node, list) in below.iter().enumerate() {
            for unknown in 0..SIZE {
                rows.extend((unknown..SIZE).map(|r| SIZE * node + r));
                let blocks = list.iter();
                rows.extend(blocks.flat_map(|&k| (0..SIZE).map(move |r| SIZE * k + r)));
                columns.push(rows.len());
            }
        }
        let values = vec![0.0; rows.len()];
        Self { below, lower: SymmetricMatrix { columns, rows, values } }
    }

    /// Sets all values to those of another matrix of the same pattern.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.lower.values.copy_from_slice(&other.lower.values);
    }

    /// Adds `a aᵀ` to the block of a node.
    pub(super) fn add_square(&mut self, node: usize, a: &[f64; SIZE]) {
        for c in 0..SIZE {
            let start = self.lower.columns[SIZE * node + c];
            for r in c..SIZE {
                self.lower.values[start + r - c] += a[r] * a[c];
            }
        }
    }

    /// Adds `a bᵀ` to the block of the pair `i`, `j`, where `a` belongs to `i`.
    pub(super) fn add_product(
        &mut self,
        [i, j]: [usize; 2],
        a: &[f64; SIZE],
        b: &[f64; SIZE],
    ) {
        let (low, high, lower, upper) = if i < j { (i, j, b, a) } else { (j, i, a, b) };
        let Ok(place) = self.below[low].binary_search(&high) else { return };
        for (c, by) in upper.iter().enumerate() {
            let start = self.lower.columns[SIZE * low + c] + (SIZE - c) + SIZE * place;
            for (value, part) in
                self.lower.values[start..start + SIZE].iter_mut().zip(lower)
            {
                *value += part * by;
            }
        }
    }

    /// Adds these numbers to the diagonal of the block of the pair `i`, `j` (or of a node
    /// with itself).
    pub(super) fn add_diagonal(&mut self, [i, j]: [usize; 2], diagonal: &[f64; SIZE]) {
        let (low, high) = (i.min(j), i.max(j));
        for (c, part) in diagonal.iter().enumerate() {
            let start = self.lower.columns[SIZE * low + c];
            let place = if low == high {
                0
            } else {
                match self.below[low].binary_search(&high) {
                    Ok(place) => (SIZE - c) + SIZE * place + c,
                    Err(_) => return,
                }
            };
            self.lower.values[start + place] += part;
        }
    }

    /// Adds a number to the whole diagonal.
    pub(super) fn shift(&mut self, by: f64) {
        for &start in &self.lower.columns[..self.lower.size()] {
            self.lower.values[start] += by;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sparse::{Cholesky, Ordering};

    #[test]
    fn a_small_system_is_solved_as_by_hand() {
        let pairs = [[0, 1], [2, 1]];
        let mut matrix = NormalMatrix::new(3, &pairs);
        for node in 0..3 {
            matrix.add_diagonal([node, node], &[4.0 + node as f64; SIZE]);
        }
        let a = [0.3, -0.2, 0.5, 0.1, 0.7, -0.4];
        let b = [-0.1, 0.6, 0.2, -0.3, 0.4, 0.8];
        let mut dense = nalgebra::DMatrix::<f64>::zeros(18, 18);
        for k in 0..18 {
            dense[(k, k)] = 4.0 + (k / 6) as f64;
        }
        for [i, j] in pairs {
            matrix.add_square(i, &a);
            matrix.add_square(j, &b);
            matrix.add_product([i, j], &a, &b);
            let mut row = nalgebra::DVector::<f64>::zeros(18);
            for k in 0..6 {
                row[6 * i + k] = a[k];
                row[6 * j + k] = b[k];
            }
            dense += &row * row.transpose();
        }
        let right: Vec<f64> = (0..18).map(|k| 1.0 + k as f64).collect();
        let mut found = right.clone();
        let mut factor = Cholesky::analysed(&matrix.lower, Ordering::AsNumbered).unwrap();
        factor.factorise(&matrix.lower).unwrap();
        factor.solve(&mut found);
        let wanted = dense.lu().solve(&nalgebra::DVector::from_vec(right)).unwrap();
        for (found, wanted) in found.iter().zip(wanted.iter()) {
            assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
        }
    }
}
