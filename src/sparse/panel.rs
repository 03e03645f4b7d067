//! Triangular solves with the columns of one supernode, for eight right-hand sides.
//!
//! A solve is bound by how fast the factor comes from memory. The columns are therefore
//! stored six abreast, row by row, so that one pass reads them in a single stream
//! (`docs/rigidity.md`, "Speed").

use pulp::{Arch, Simd, WithSimd};

/// Right-hand sides that are solved for together.
pub(crate) const RHS: usize = 8;

/// One row of all right-hand sides.
pub(crate) type Row = [f64; RHS];

/// Columns that are stored abreast; those that are left over stand alone.
const PANEL: usize = 6;
/// Vectors of a row that are worked on together.
const PAIR: usize = 2;

/// The packed columns of a supernode: panel after panel, each from its diagonal on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Columns<'a> {
    pub(crate) values: &'a [f64],
    pub(crate) width: usize,
}

/// How many numbers the first `count` of columns of this height take when packed.
pub(crate) fn packed(count: usize, height: usize) -> usize {
    let full = count - count % PANEL;
    let alone = (full..count).map(|column| height - column).sum::<usize>();
    full * height - full * full.saturating_sub(PANEL) / 2 + alone
}

/// Packs `width` columns that stand one after another; what is above the diagonals is lost.
pub(crate) fn pack(columns: &[f64], width: usize, into: &mut Vec<f64>) {
    let height = columns.len() / width.max(1);
    let even = width - width % PANEL;
    for k in (0..even).step_by(PANEL) {
        let column = |j: usize| &columns[(k + j) * height..(k + j + 1) * height];
        let abreast: [&[f64]; PANEL] = std::array::from_fn(column);
        into.extend((k..height).flat_map(|row| abreast.map(|column| column[row])));
    }
    for k in even..width {
        into.extend_from_slice(&columns[k * height + k..(k + 1) * height]);
    }
}

impl<'a> Columns<'a> {
    /// The columns one after another as they were before they were packed, `height` numbers
    /// each, zeros above the diagonal.
    pub(crate) fn unpacked(self, height: usize) -> Vec<f64> {
        let mut columns = vec![0.0; self.width * height];
        let even = self.width - self.width % PANEL;
        for k in (0..even).step_by(PANEL) {
            for (row, values) in (k..height).zip(self.panel::<PANEL>(k, height)) {
                let some = values.iter().enumerate().take(row - k + 1);
                some.for_each(|(j, x)| columns[(k + j) * height + row] = *x);
            }
        }
        for k in even..self.width {
            let values = self.panel::<1>(k, height).as_flattened();
            columns[k * height + k..(k + 1) * height].copy_from_slice(values);
        }
        columns
    }

    /// Solves for the first `width` rows, and takes what they cause from the rest.
    pub(crate) fn forward(self, rows: &mut [Row]) {
        Arch::new().dispatch(Sweep { columns: self, rows, down: true });
    }

    /// Takes what the rows after the first `width` cause from those, and solves for them
    /// with the transpose.
    pub(crate) fn backward(self, rows: &mut [Row]) {
        Arch::new().dispatch(Sweep { columns: self, rows, down: false });
    }

    /// The panel of column `k` in columns of this height: `P` numbers a row, from row `k`.
    #[inline(always)]
    fn panel<const P: usize>(self, k: usize, height: usize) -> &'a [[f64; P]] {
        let at = packed(k, height);
        self.values[at..at + P * (height - k)].as_chunks().0
    }
}

struct Sweep<'a> {
    columns: Columns<'a>,
    rows: &'a mut [Row],
    down: bool,
}

impl WithSimd for Sweep<'_> {
    type Output = ();

    // Plain loops: what stands in a closure is compiled without wide vectors.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let columns = self.columns;
        let (height, per_row) = (self.rows.len(), RHS / S::F64_LANES);
        let (rows, _) = S::as_mut_simd_f64s(self.rows.as_flattened_mut());
        let even = columns.width - columns.width % PANEL;
        if self.down {
            for k in (0..even).step_by(PANEL) {
                let panel = columns.panel::<PANEL>(k, height);
                forward::<S, _>(simd, panel, &mut rows[k * per_row..]);
            }
            for k in even..columns.width {
                let panel = columns.panel::<1>(k, height);
                forward::<S, _>(simd, panel, &mut rows[k * per_row..]);
            }
        } else {
            for k in (even..columns.width).rev() {
                let panel = columns.panel::<1>(k, height);
                backward::<S, _>(simd, panel, &mut rows[k * per_row..]);
            }
            for k in (0..even).step_by(PANEL).rev() {
                let panel = columns.panel::<PANEL>(k, height);
                backward::<S, _>(simd, panel, &mut rows[k * per_row..]);
            }
        }
    }
}

/// `sum - share · of`.
#[inline(always)]
fn subtract_product<S: Simd>(simd: S, sum: S::f64s, share: f64, of: S::f64s) -> S::f64s {
    simd.mul_add_e_f64s(simd.splat_f64s(-share), of, sum)
}

#[inline(always)]
fn forward<S: Simd, const P: usize>(simd: S, panel: &[[f64; P]], rows: &mut [S::f64s]) {
    let per_row = RHS / S::F64_LANES;
    let (own, rest) = rows.split_at_mut(P * per_row);
    let (top, below) = panel.split_at(P);
    let mut v = 0;
    while v < per_row {
        // Two vectors of a row at once keep all registers busy.
        let w = if v + PAIR <= per_row { v + 1 } else { v };
        let mut solved = [[simd.splat_f64s(0.0); P]; PAIR];
        for j in 0..P {
            let inverse = simd.splat_f64s(1.0 / top[j][j]);
            let (mut first, mut second) = (own[j * per_row + v], own[j * per_row + w]);
            for i in 0..j {
                first = subtract_product(simd, first, top[j][i], solved[0][i]);
                second = subtract_product(simd, second, top[j][i], solved[1][i]);
            }
            solved[0][j] = simd.mul_f64s(first, inverse);
            solved[1][j] = simd.mul_f64s(second, inverse);
            own[j * per_row + v] = solved[0][j];
            own[j * per_row + w] = solved[1][j];
        }
        for (row, shares) in rest.chunks_exact_mut(per_row).zip(below) {
            let (mut first, mut second) = (row[v], row[w]);
            for j in 0..P {
                first = subtract_product(simd, first, shares[j], solved[0][j]);
                second = subtract_product(simd, second, shares[j], solved[1][j]);
            }
            row[v] = first;
            row[w] = second;
        }
        v = w + 1;
    }
}

#[inline(always)]
fn backward<S: Simd, const P: usize>(simd: S, panel: &[[f64; P]], rows: &mut [S::f64s]) {
    let per_row = RHS / S::F64_LANES;
    let (own, rest) = rows.split_at_mut(P * per_row);
    let (top, below) = panel.split_at(P);
    let mut v = 0;
    while v < per_row {
        let w = if v + PAIR <= per_row { v + 1 } else { v };
        let mut sums = [[simd.splat_f64s(0.0); P]; PAIR];
        for j in 0..P {
            (sums[0][j], sums[1][j]) = (own[j * per_row + v], own[j * per_row + w]);
        }
        for (row, shares) in rest.chunks_exact(per_row).zip(below) {
            for j in 0..P {
                sums[0][j] = subtract_product(simd, sums[0][j], shares[j], row[v]);
                sums[1][j] = subtract_product(simd, sums[1][j], shares[j], row[w]);
            }
        }
        for j in (0..P).rev() {
            let inverse = simd.splat_f64s(1.0 / top[j][j]);
            for i in j + 1..P {
                sums[0][j] = subtract_product(simd, sums[0][j], top[i][j], sums[0][i]);
                sums[1][j] = subtract_product(simd, sums[1][j], top[i][j], sums[1][i]);
            }
            sums[0][j] = simd.mul_f64s(sums[0][j], inverse);
            sums[1][j] = simd.mul_f64s(sums[1][j], inverse);
            own[j * per_row + v] = sums[0][j];
            own[j * per_row + w] = sums[1][j];
        }
        v = w + 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers from 0 to 1 that are the same everywhere.
    fn noise(k: usize) -> f64 {
        ((k as f64 + 1.0) * 0.618_033_988_749_894_9).fract()
    }

    #[test]
    fn packed_columns_solve_whatever_their_number() {
        for (width, height) in [(1, 1), (5, 9), (6, 6), (13, 20), (18, 211)] {
            // Lower trapezoid with a strong diagonal; what is above is never read.
            let entry = |row: usize, column: usize| match row.cmp(&column) {
                std::cmp::Ordering::Less => f64::NAN,
                std::cmp::Ordering::Equal => 2.0 + noise(row),
                std::cmp::Ordering::Greater => noise(31 * row + column) / 40.0,
            };
            let columns: Vec<f64> =
                (0..width * height).map(|k| entry(k % height, k / height)).collect();
            let mut values = Vec::new();
            pack(&columns, width, &mut values);
            assert_eq!(values.len(), packed(width, height));
            let packed = Columns { values: &values, width };
            let back = packed.unpacked(height);
            let below = (0..width * height).filter(|k| k % height >= k / height);
            assert!(below.clone().all(|k| back[k].to_bits() == columns[k].to_bits()));
            assert_eq!(back.iter().filter(|x| **x != 0.0).count(), below.count());
            let columns = packed;
            let known: Vec<Row> = (0..height)
                .map(|row| std::array::from_fn(|k| noise(8 * row + k)))
                .collect();
            let times = |rows: &[Row], row: usize, transposed: bool| -> Row {
                let share = |j: usize| {
                    let (a, b) = if transposed { (j, row) } else { (row, j) };
                    if b <= a && b < width { entry(a, b) } else { 0.0 }
                };
                std::array::from_fn(|k| (0..height).map(|j| share(j) * rows[j][k]).sum())
            };
            let mut down = known.clone();
            columns.forward(&mut down);
            // L times what was solved for, and what is left below, is what was given.
            for row in 0..height {
                let product = times(&down, row, false);
                for k in 0..RHS {
                    let rest = if row < width { 0.0 } else { down[row][k] };
                    assert!((product[k] + rest - known[row][k]).abs() < 1e-12);
                }
            }
            let mut up = known.clone();
            columns.backward(&mut up);
            for (row, known) in known[..width].iter().enumerate() {
                let product = times(&up, row, true);
                let off = product.iter().zip(known).map(|(x, y)| (x - y).abs());
                assert!(off.fold(0.0, f64::max) < 1e-12);
            }
        }
    }
}
