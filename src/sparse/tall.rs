//! TransposedProduct of pieces of blocks with eight columns, in plain loops on wide
//! vectors.
//!
//! Such pieces are long and narrow; products made for square matrices take twice as
//! long.

use crate::sparse::panel::{RHS, Row};
use pulp::{Arch, Simd, WithSimd};

/// Eight by eight numbers, row by row.
pub(crate) type Square = [Row; RHS];

/// Rows of a product that are summed up together, so that all registers are busy.
const SOME: usize = 4;

/// `aᵀ · b`.
pub(crate) fn transposed_product(a: &[Row], b: &[Row]) -> Square {
    let mut into = [[0.0; RHS]; RHS];
    Arch::new().dispatch(TransposedProduct { a, b, into: &mut into });
    into
}

/// Takes `a · of` from `into`.
pub(crate) fn subtract_product(into: &mut [Row], a: &[Row], of: &Square) {
    Arch::new().dispatch(SubtractProduct { into, a, of });
}

struct TransposedProduct<'a> {
    a: &'a [Row],
    b: &'a [Row],
    into: &'a mut Square,
}

impl WithSimd for TransposedProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let per_row = RHS / S::F64_LANES;
        let (b, _) = S::as_simd_f64s(self.b.as_flattened());
        let (into, _) = S::as_mut_simd_f64s(self.into.as_flattened_mut());
        for from in (0..RHS).step_by(SOME) {
            let mut v = 0;
            while v < per_row {
                let w = if v + 1 < per_row { v + 1 } else { v };
                let mut sums = [[simd.splat_f64s(0.0); SOME]; 2];
                for (a, b) in self.a.iter().zip(b.chunks_exact(per_row)) {
                    let (first, second) = (b[v], b[w]);
                    for k in 0..SOME {
                        let share = simd.splat_f64s(a[from + k]);
                        sums[0][k] = simd.mul_add_e_f64s(share, first, sums[0][k]);
                        sums[1][k] = simd.mul_add_e_f64s(share, second, sums[1][k]);
                    }
                }
                for k in 0..SOME {
                    into[(from + k) * per_row + v] = sums[0][k];
                    into[(from + k) * per_row + w] = sums[1][k];
                }
                v = w + 1;
            }
        }
    }
}

struct SubtractProduct<'a> {
    into: &'a mut [Row],
    a: &'a [Row],
    of: &'a Square,
}

impl WithSimd for SubtractProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let per_row = RHS / S::F64_LANES;
        let (of, _) = S::as_simd_f64s(self.of.as_flattened());
        let (into, _) = S::as_mut_simd_f64s(self.into.as_flattened_mut());
        for (row, a) in into.chunks_exact_mut(per_row).zip(self.a) {
            let mut v = 0;
            while v < per_row {
                let w = if v + 1 < per_row { v + 1 } else { v };
                let (mut first, mut second) = (row[v], row[w]);
                for k in 0..RHS {
                    let share = simd.splat_f64s(-a[k]);
                    first = simd.mul_add_e_f64s(share, of[k * per_row + v], first);
                    second = simd.mul_add_e_f64s(share, of[k * per_row + w], second);
                }
                row[v] = first;
                row[w] = second;
                v = w + 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_those_of_columns() {
        let noise = |k: usize| ((k as f64 + 1.0) * 0.618_033_988_749_894_9).fract() - 0.5;
        let rows = |from: usize| -> Vec<Row> {
            (0..37).map(|i| std::array::from_fn(|k| noise(from + 8 * i + k))).collect()
        };
        let (a, b) = (rows(0), rows(900));
        let found = transposed_product(&a, &b);
        for i in 0..RHS {
            for j in 0..RHS {
                let known: f64 = a.iter().zip(&b).map(|(a, b)| a[i] * b[j]).sum();
                assert!((found[i][j] - known).abs() < 1e-13);
            }
        }
        let mut subtracted = b.clone();
        subtract_product(&mut subtracted, &a, &found);
        for (row, (a, b)) in subtracted.iter().zip(a.iter().zip(&b)) {
            for j in 0..RHS {
                let known: f64 = (0..RHS).map(|k| a[k] * found[k][j]).sum();
                assert!((row[j] - (b[j] - known)).abs() < 1e-13);
            }
        }
    }
}
