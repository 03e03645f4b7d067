//! Symmetric matrices of one number per entry: collected as triplets, then in compressed
//! columns.

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

/// Entries of a symmetric matrix as they come: an entry stands for both of its places;
/// entries of one place add up, in the order in which they came.
///
/// ```
/// use finwright::sparse::Triplets;
///
/// // (x - y)^2 + y^2
/// let mut triplets = Triplets::new(2);
/// triplets.add_difference([0, 1], [1.0, 1.0], 1.0);
/// triplets.add([1, 1], 1.0);
/// assert_eq!(triplets.matrix().size(), 2);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Triplets {
    size: usize,
    /// Column, row and value: on or below the diagonal.
    entries: Vec<(usize, usize, f64)>,
}

impl Triplets {
    /// None yet, of a matrix of `size` rows.
    pub const fn new(size: usize) -> Self {
        Self { size, entries: Vec::new() }
    }

    /// Adds to the entry in this row and column and to its mirror image, which on the
    /// diagonal are one.
    pub fn add(&mut self, [i, j]: [usize; 2], value: f64) {
        self.entries.push((i.min(j), i.max(j), value));
    }

    /// Adds `weight (a x_i − b x_j)²` to the quadratic form.
    pub fn add_difference(&mut self, [i, j]: [usize; 2], [a, b]: [f64; 2], weight: f64) {
        self.add([i, i], weight * a * a);
        self.add([j, j], weight * b * b);
        self.add([i, j], -weight * a * b);
    }

    /// Their sum.
    ///
    /// # Panics
    /// If a place is not below the size.
    pub fn matrix(&self) -> SymmetricMatrix {
        let mut starts = vec![0; self.size + 1];
        self.entries.iter().for_each(|entry| starts[entry.0 + 1] += 1);
        for k in 0..self.size {
            starts[k + 1] += starts[k];
        }
        let mut next = starts.clone();
        let mut by_column = vec![(0, 0.0); self.entries.len()];
        for &(column, row, value) in &self.entries {
            by_column[next[column]] = (row, value);
            next[column] += 1;
        }
        let (mut columns, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for column in 0..self.size {
            let entries = &mut by_column[starts[column]..starts[column + 1]];
            // Stable, so that sums are made in the order of adding.
            entries.sort_by_key(|entry| entry.0);
            for equal in entries.chunk_by(|a, b| a.0 == b.0) {
                rows.push(equal[0].0);
                values.push(equal.iter().map(|entry| entry.1).sum());
            }
            columns.push(rows.len());
        }
        SymmetricMatrix { columns, rows, values }
    }
}
