//! Factors of matrices of one pattern, one thread, by `faer`'s supernodes: for systems that
//! are factorised again and again with other values.

use crate::sparse::error::NotPositiveDefinite;
use crate::sparse::matrix::SymmetricMatrix;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// In which order unknowns are eliminated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ordering {
    /// As they are numbered.
    AsNumbered,
    /// Approximate minimum degree.
    MinimumDegree,
}

/// The Cholesky factor of a symmetric positive definite matrix; analysed once, it takes any
/// number of matrices of the same pattern.
///
/// ```
/// use finwright::sparse::{Cholesky, Triplets};
///
/// // [2 -1; -1 2] x = [1, 4]
/// let mut triplets = Triplets::new(2);
/// triplets.add_difference([0, 1], [1.0, 1.0], 1.0);
/// triplets.add([0, 0], 1.0);
/// triplets.add([1, 1], 1.0);
/// let mut factor = Cholesky::of(&triplets.matrix()).unwrap();
/// let mut x = [1.0, 4.0];
/// factor.solve(&mut x);
/// assert!((x[0] - 2.0).abs() < 1e-14 && (x[1] - 3.0).abs() < 1e-14);
/// ```
pub struct Cholesky {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    scratch: MemBuffer,
}

/// Right-hand sides that are solved at once.
const AT_ONCE: usize = 8;

impl Cholesky {
    /// The factor of one matrix, in the order of minimum degree.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] if a pivot is not positive, or it is larger than memory can
    /// hold.
    pub fn of(matrix: &SymmetricMatrix) -> Result<Self, NotPositiveDefinite> {
        let analysed = Self::analysed(matrix, Ordering::MinimumDegree);
        let mut factor = analysed.ok_or(NotPositiveDefinite)?;
        factor.factorise(matrix)?;
        Ok(factor)
    }

    /// Finds the pattern of the factor; `None` if it is larger than memory can hold. It
    /// cannot solve before the first call of [`factorise`](Self::factorise).
    pub fn analysed(matrix: &SymmetricMatrix, ordering: Ordering) -> Option<Self> {
        let size = matrix.size();
        // Without a permutation `faer` 0.24 wants the upper half here, whatever the side.
        let (columns, rows) = matrix.upper();
        let pattern =
            SymbolicSparseColMatRef::new_checked(size, size, &columns, None, &rows);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..CholeskySymbolicParams::default()
        };
        let order = match ordering {
            Ordering::AsNumbered => SymmetricOrdering::Identity,
            Ordering::MinimumDegree => SymmetricOrdering::Amd,
        };
        let symbolic =
            factorize_symbolic_cholesky(pattern, Side::Upper, order, params).ok()?;
        let numeric =
            symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let solve = symbolic.solve_in_place_scratch::<f64>(AT_ONCE, Par::Seq);
        let scratch = MemBuffer::try_new(numeric.or(solve)).ok()?;
        let values = vec![0.0; symbolic.len_val()];
        Some(Self { symbolic, values, scratch })
    }

    /// Factorises a matrix of the pattern that was analysed.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] if a pivot is not positive; it must not solve then.
    pub fn factorise(
        &mut self,
        matrix: &SymmetricMatrix,
    ) -> Result<(), NotPositiveDefinite> {
        let size = matrix.size();
        let (columns, rows) = (&matrix.columns, &matrix.rows);
        let pattern =
            SymbolicSparseColMatRef::new_checked(size, size, columns, None, rows);
        let factored = self.symbolic.factorize_numeric_llt(
            &mut self.values,
            SparseColMatRef::new(pattern, &matrix.values),
            Side::Lower,
            Default::default(),
            Par::Seq,
            MemStack::new(&mut self.scratch),
            Default::default(),
        );
        factored.map(|_| ()).map_err(|_| NotPositiveDefinite)
    }

    /// Solves with the matrix that was factorised last, in place, for right-hand sides that
    /// stand one after another.
    pub fn solve(&mut self, right: &mut [f64]) {
        let factor = LltRef::<'_, usize, f64>::new(&self.symbolic, &self.values);
        let rows = self.symbolic.nrows().max(1);
        for right in right.chunks_mut(AT_ONCE * rows) {
            let count = right.len() / rows;
            factor.solve_in_place_with_conj(
                Conj::No,
                MatMut::from_column_major_slice_mut(right, rows, count),
                Par::Seq,
                MemStack::new(&mut self.scratch),
            );
        }
    }
}
