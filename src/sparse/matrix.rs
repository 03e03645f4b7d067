//! Symmetric matrices of one number per entry, in compressed columns.

/// The lower half of a symmetric matrix: column after column, rows ascending.
#[derive(Debug, Clone, PartialEq)]
pub struct SymmetricMatrix {
    /// Where each column begins; one more at the end.
    pub(crate) columns: Vec<usize>,
    /// Rows of the entries, none above its column.
    pub(crate) rows: Vec<usize>,
    /// Values of the entries.
    pub(crate) values: Vec<f64>,
}

impl SymmetricMatrix {
    /// A matrix of `size` rows from entries `([i, j], value)`. An entry stands for both of
    /// its places; entries of one place add up, in the order in which they are given.
    ///
    /// # Panics
    /// If a place is not below `size`.
    pub fn from_entries(size: usize, entries: &[([usize; 2], f64)]) -> Self {
        let mut by_column: Vec<Vec<(usize, f64)>> = vec![Vec::new(); size];
        for &([i, j], value) in entries {
            by_column[i.min(j)].push((i.max(j), value));
        }
        let (mut columns, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for column in &mut by_column {
            column.sort_by_key(|(row, _)| *row);
            for equal in column.chunk_by(|a, b| a.0 == b.0) {
                rows.push(equal[0].0);
                values.push(equal.iter().map(|(_, value)| value).sum());
            }
            columns.push(rows.len());
        }
        Self { columns, rows, values }
    }

    /// How many rows there are.
    pub fn size(&self) -> usize {
        self.columns.len() - 1
    }

    /// The pattern of the upper half, by columns.
    pub(super) fn upper(&self) -> (Vec<usize>, Vec<usize>) {
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
}
