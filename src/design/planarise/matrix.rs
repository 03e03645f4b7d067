//! Normal equations in blocks of 6 × 6, one per pair of nodes that a residual couples.
//!
//! Nodes are numbered in the order of elimination (approximate minimum degree on the graph
//! of nodes, not of unknowns), so that `faer` takes the matrix as it stands. The symbolic
//! factorisation is made once.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use feral_amd::{CscPattern, amd_order};

/// Unknowns of a node: three of its position, three of its axis.
pub(super) const SIZE: usize = 6;

/// An order of nodes in which eliminating them fills little; `order[k]` is the node that
/// comes as the `k`-th. `pairs` are the coupled nodes.
pub(super) fn elimination_order(nodes: usize, pairs: &[[usize; 2]]) -> Vec<usize> {
    let mut columns: Vec<Vec<i32>> = vec![Vec::new(); nodes];
    for &[i, j] in pairs {
        columns[i].push(j as i32);
        columns[j].push(i as i32);
    }
    let mut starts = vec![0];
    let mut rows = Vec::new();
    for column in &mut columns {
        column.sort_unstable();
        column.dedup();
        rows.extend_from_slice(column);
        starts.push(rows.len() as i32);
    }
    let order: Vec<usize> = CscPattern::new(nodes, &starts, &rows)
        .and_then(|pattern| amd_order(&pattern).ok())
        .map_or_else(
            || (0..nodes).collect(),
            |order| order.into_iter().map(|node| node as usize).collect(),
        );
    postordered(order, &columns)
}

/// The same order but for children coming right before their parents in the elimination
/// tree, as the factorisation by supernodes asks; this changes nothing in what fills.
/// (Liu 1990, The role of elimination trees in sparse factorization, 3 and 4.2.)
fn postordered(order: Vec<usize>, columns: &[Vec<i32>]) -> Vec<usize> {
    const NONE: usize = usize::MAX;
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(k, &node)| place[node] = k);
    let mut parent = vec![NONE; order.len()];
    let mut ancestor = parent.clone();
    for (k, &node) in order.iter().enumerate() {
        for &neighbour in &columns[node] {
            let mut at = place[neighbour as usize];
            while at < k {
                let up = std::mem::replace(&mut ancestor[at], k);
                if up == NONE {
                    parent[at] = k;
                    break;
                }
                at = up;
            }
        }
    }
    let mut children = vec![Vec::new(); order.len()];
    let mut stack = Vec::new();
    for k in (0..order.len()).rev() {
        if parent[k] == NONE { stack.push(k) } else { children[parent[k]].push(k) }
    }
    // Parents before children and then turned round.
    stack.reverse();
    let mut turned = Vec::with_capacity(order.len());
    while let Some(k) = stack.pop() {
        turned.push(order[k]);
        stack.append(&mut children[k]);
    }
    turned.reverse();
    turned
}

/// The lower half of a symmetric matrix of 6 × 6 blocks.
pub(super) struct NormalMatrix {
    /// For each node, the nodes after it that it is coupled with, ascending.
    below: Vec<Vec<usize>>,
    columns: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
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
        Self { below, columns, rows, values }
    }

    /// Sets all values to those of another matrix of the same pattern.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.values.copy_from_slice(&other.values);
    }

    /// Adds `a aᵀ` to the block of a node.
    pub(super) fn add_square(&mut self, node: usize, a: &[f64; SIZE]) {
        for c in 0..SIZE {
            let start = self.columns[SIZE * node + c];
            for r in c..SIZE {
                self.values[start + r - c] += a[r] * a[c];
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
            let start = self.columns[SIZE * low + c] + (SIZE - c) + SIZE * place;
            for (value, part) in self.values[start..start + SIZE].iter_mut().zip(lower) {
                *value += part * by;
            }
        }
    }

    /// Adds these numbers to the diagonal of the block of the pair `i`, `j` (or of a node
    /// with itself).
    pub(super) fn add_diagonal(&mut self, [i, j]: [usize; 2], diagonal: &[f64; SIZE]) {
        let (low, high) = (i.min(j), i.max(j));
        for (c, part) in diagonal.iter().enumerate() {
            let start = self.columns[SIZE * low + c];
            let place = if low == high {
                0
            } else {
                match self.below[low].binary_search(&high) {
                    Ok(place) => (SIZE - c) + SIZE * place + c,
                    Err(_) => return,
                }
            };
            self.values[start + place] += part;
        }
    }

    /// Adds a number to the whole diagonal.
    pub(super) fn shift(&mut self, by: f64) {
        for &start in &self.columns[..self.size()] {
            self.values[start] += by;
        }
    }

    /// The pattern of the upper half, by columns.
    fn upper(&self) -> (Vec<usize>, Vec<usize>) {
        let size = self.size();
        let mut columns = vec![0; size + 1];
        self.rows.iter().for_each(|&row| columns[row + 1] += 1);
        for k in 0..size {
            columns[k + 1] += columns[k];
        }
        let mut next = columns.clone();
        let mut rows = vec![0; self.rows.len()];
        for column in 0..size {
            for &row in &self.rows[self.columns[column]..self.columns[column + 1]] {
                rows[next[row]] = column;
                next[row] += 1;
            }
        }
        (columns, rows)
    }

    fn size(&self) -> usize {
        self.columns.len() - 1
    }
}

/// Factors matrices of one pattern.
pub(super) struct Factor {
    symbolic: SymbolicCholesky<usize>,
    lower: Vec<f64>,
    scratch: MemBuffer,
}

impl Factor {
    /// Finds the pattern of the factor; `None` if it is larger than memory can hold.
    pub(super) fn new(matrix: &NormalMatrix) -> Option<Self> {
        let size = matrix.size();
        // Without a permutation `faer` 0.24 wants the upper half here, whatever the side.
        let (columns, rows) = matrix.upper();
        let pattern =
            SymbolicSparseColMatRef::new_checked(size, size, &columns, None, &rows);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..CholeskySymbolicParams::default()
        };
        let order = SymmetricOrdering::Identity;
        let symbolic =
            factorize_symbolic_cholesky(pattern, Side::Upper, order, params).ok()?;
        let numeric =
            symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let solve = symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
        let scratch = MemBuffer::try_new(numeric.or(solve)).ok()?;
        let lower = vec![0.0; symbolic.len_val()];
        Some(Self { symbolic, lower, scratch })
    }

    /// Solves `matrix x = right` in place; false if the matrix is not positive definite.
    pub(super) fn solve(&mut self, matrix: &NormalMatrix, right: &mut [f64]) -> bool {
        let size = matrix.size();
        let pattern = SymbolicSparseColMatRef::new_checked(
            size,
            size,
            &matrix.columns,
            None,
            &matrix.rows,
        );
        let factored = self.symbolic.factorize_numeric_llt(
            &mut self.lower,
            SparseColMatRef::new(pattern, &matrix.values),
            Side::Lower,
            Default::default(),
            Par::Seq,
            MemStack::new(&mut self.scratch),
            Default::default(),
        );
        let Ok(factor) = factored else { return false };
        let right = MatMut::from_column_major_slice_mut(right, size, 1);
        factor.solve_in_place_with_conj(
            Conj::No,
            right,
            Par::Seq,
            MemStack::new(&mut self.scratch),
        );
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert!(Factor::new(&matrix).unwrap().solve(&matrix, &mut found));
        let wanted = dense.lu().solve(&nalgebra::DVector::from_vec(right)).unwrap();
        for (found, wanted) in found.iter().zip(wanted.iter()) {
            assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
        }
    }
}
