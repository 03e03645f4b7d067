//! The fixed part of a sparse factorisation: order of elimination, tree, supernodes.
//!
//! Works on *groups* of unknowns (the six of a pin, the six of a strip), which are
//! eliminated together; the graph is then six times smaller than the matrix. Ordering by
//! approximate minimum degree (`feral-amd`), then supernodes with relaxed merging.

use crate::sparse::etree::{Last, elimination_tree, places};
use crate::sparse::ordering::elimination_order;
use crate::sparse::panel::packed;
use std::ops::Range;

/// Consecutive groups that are eliminated as one dense block.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Supernode {
    /// Its first group, by place in the order.
    pub(crate) first: usize,
    /// One after its last group.
    pub(crate) end: usize,
    /// How many unknowns it eliminates.
    pub(crate) width: usize,
    /// Groups after `end` that it touches, ascending.
    pub(crate) rows: Vec<u32>,
    /// How many unknowns these have.
    pub(crate) below: usize,
    /// The supernode that takes in its update.
    pub(crate) parent: Option<usize>,
    /// Supernodes whose updates it takes in.
    pub(crate) children: Vec<usize>,
    /// The first supernode of its subtree; a subtree is a range.
    pub(crate) first_descendant: usize,
    /// Whether its depth in the tree is odd_depth.
    pub(crate) odd_depth: bool,
}

impl Supernode {
    /// How many numbers its columns take in the factor.
    pub(crate) fn stored(&self) -> usize {
        packed(self.width, self.width + self.below)
    }

    /// Workspace of its elimination, about.
    pub(crate) fn work(&self) -> f64 {
        self.width as f64 * ((self.width + self.below) as f64).powi(2)
    }
}

/// Order and supernodes of a matrix of groups.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Symbolic {
    /// For each group its place in the order.
    pub(crate) place: Vec<usize>,
    /// By place, the first unknown of each group; one more entry at the end.
    pub(crate) start: Vec<usize>,
    /// In an order in which children come first.
    pub(crate) supernodes: Vec<Supernode>,
    /// By place of a group, its supernode.
    pub(crate) owner: Vec<u32>,
}

impl Symbolic {
    /// Analyses groups of these sizes that touch each other as `neighbours` lists (both
    /// ways, without the group itself, each once).
    pub(crate) fn new(sizes: &[usize], neighbours: &[Vec<u32>]) -> Self {
        let order = elimination_order(neighbours, Last::Largest);
        let place = places(&order);
        let mut start = vec![0];
        for &group in &order {
            start.push(start[start.len() - 1] + sizes[group]);
        }
        let (parents, columns) = columns(&order, &place, neighbours);
        let mut supernodes = supernodes(&parents, columns, &start);
        let mut owner = vec![0_u32; order.len()];
        for (s, node) in supernodes.iter().enumerate() {
            owner[node.first..node.end].fill(s as u32);
        }
        for s in 0..supernodes.len() {
            supernodes[s].parent =
                supernodes[s].rows.first().map(|&row| owner[row as usize] as usize);
            let first_descendant = supernodes[s].first_descendant;
            if let Some(parent) = supernodes[s].parent {
                supernodes[parent].children.push(s);
                supernodes[parent].first_descendant =
                    supernodes[parent].first_descendant.min(first_descendant);
            }
        }
        for s in (0..supernodes.len()).rev() {
            let above = supernodes[s].parent.map(|parent| supernodes[parent].odd_depth);
            supernodes[s].odd_depth = above == Some(false);
        }
        Self { place, start, supernodes, owner }
    }

    /// How many unknowns there are.
    pub(crate) fn unknowns(&self) -> usize {
        self.start[self.start.len() - 1]
    }

    /// How many unknowns the group at a place has.
    pub(crate) fn size(&self, place: usize) -> usize {
        self.start[place + 1] - self.start[place]
    }

    /// Unknowns of the group at a place.
    pub(crate) fn rows(&self, place: usize) -> Range<usize> {
        self.start[place]..self.start[place + 1]
    }

    /// Supernodes whose subtrees can be worked on side by side, the largest work first.
    /// Depends on the matrix only, so that results do not depend on the machine.
    pub(crate) fn subtrees(&self) -> Vec<usize> {
        let mut work: Vec<f64> = self.supernodes.iter().map(Supernode::work).collect();
        for s in 0..work.len() {
            if let Some(parent) = self.supernodes[s].parent {
                work[parent] += work[s];
            }
        }
        let roots = (0..work.len()).filter(|&s| self.supernodes[s].parent.is_none());
        let mut subtrees: Vec<usize> = roots.collect();
        let total: f64 = subtrees.iter().map(|&s| work[s]).sum();
        loop {
            subtrees.sort_by(|&a, &b| work[b].total_cmp(&work[a]).then(a.cmp(&b)));
            let split = subtrees.iter().position(|&s| {
                work[s] > total / 4.0 && !self.supernodes[s].children.is_empty()
            });
            let Some(split) = split else { return subtrees };
            let s = subtrees.swap_remove(split);
            subtrees.extend(&self.supernodes[s].children);
        }
    }
}

/// Where a symmetric matrix gets its entries from.
pub(crate) trait Entries: Sync {
    /// Hands all entries in the columns of `supernode` to `add`: as row group, column group
    /// (places, row after or at column) and the column-major block, of which the lower
    /// triangle counts if both are the same group.
    fn entries(&self, supernode: usize, add: &mut dyn FnMut(usize, usize, &[f64]));
}

/// Parents, and for each place the later places its column reaches, ascending.
fn columns(
    order: &[usize],
    place: &[usize],
    neighbours: &[Vec<u32>],
) -> (Vec<Option<usize>>, Vec<Vec<u32>>) {
    let parents = elimination_tree(order, neighbours);
    let mut seen = vec![u32::MAX; order.len()];
    let mut columns: Vec<Vec<u32>> = Vec::with_capacity(order.len());
    let mut children = vec![Vec::new(); order.len()];
    for (k, &group) in order.iter().enumerate() {
        let mut column = Vec::new();
        seen[k] = k as u32;
        let mut add = |row: u32| {
            if row as usize > k && seen[row as usize] != k as u32 {
                seen[row as usize] = k as u32;
                column.push(row);
            }
        };
        neighbours[group].iter().for_each(|&o| add(place[o as usize] as u32));
        for child in std::mem::take(&mut children[k]) {
            let column: &Vec<u32> = &columns[child];
            column.iter().for_each(|&row| add(row));
        }
        column.sort_unstable();
        columns.push(column);
        if let Some(parent) = parents[k] {
            children[parent].push(k);
        }
    }
    (parents, columns)
}

/// Columns with one pattern become a supernode; then a supernode joins the one after it
/// if that stores few zeros.
fn supernodes(
    parents: &[Option<usize>],
    columns: Vec<Vec<u32>>,
    start: &[usize],
) -> Vec<Supernode> {
    let mut merged: Vec<(Supernode, usize)> = Vec::new();
    let lengths: Vec<usize> = columns.iter().map(Vec::len).collect();
    let size = |k: usize| start[k + 1] - start[k];
    for (k, rows) in columns.into_iter().enumerate() {
        let below = rows.iter().map(|&row| size(row as usize)).sum();
        let same = k > 0 && parents[k - 1] == Some(k) && lengths[k - 1] == lengths[k] + 1;
        if let (true, Some((last, _))) = (same, merged.last_mut()) {
            last.end = k + 1;
            last.width += size(k);
            (last.rows, last.below) = (rows, below);
            continue;
        }
        merge_last(&mut merged);
        let width = size(k);
        let (parent, children) = (None, Vec::new());
        let node = Supernode {
            first: k,
            end: k + 1,
            width,
            rows,
            below,
            parent,
            children,
            first_descendant: 0,
            odd_depth: false,
        };
        merged.push((node, 0));
    }
    merge_last(&mut merged);
    let nodes = merged.into_iter().enumerate();
    nodes.map(|(s, (node, _))| Supernode { first_descendant: s, ..node }).collect()
}

/// Merges the last two supernodes as long as that is worth it.
fn merge_last(merged: &mut Vec<(Supernode, usize)>) {
    while let [.., (child, child_zeros), (parent, parent_zeros)] = merged.as_mut_slice() {
        let linked = child
            .rows
            .first()
            .is_some_and(|&row| (parent.first..parent.end).contains(&(row as usize)));
        let height = parent.width + parent.below;
        let zeros = *child_zeros
            + *parent_zeros
            + child.width * (height - child.below.min(height));
        let width = child.width + parent.width;
        let share = zeros as f64 / (width * (width + parent.below)) as f64;
        let allowed = match width {
            0..=18 => 0.4,
            19..=30 => 0.2,
            31..=96 => 0.1,
            _ => 0.03,
        };
        if !linked || share > allowed {
            return;
        }
        parent.first = child.first;
        parent.width = width;
        *parent_zeros = zeros;
        let last = merged.len() - 2;
        merged.remove(last);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of `n` × `n` groups.
    fn grid(n: usize) -> Vec<Vec<u32>> {
        let at = |i: usize, j: usize| (j * n + i) as u32;
        let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
        let around = |(i, j): (usize, usize)| {
            let mut list = Vec::new();
            if i > 0 {
                list.push(at(i - 1, j));
            }
            if j > 0 {
                list.push(at(i, j - 1));
            }
            if i + 1 < n {
                list.push(at(i + 1, j));
            }
            if j + 1 < n {
                list.push(at(i, j + 1));
            }
            list
        };
        cells.map(around).collect()
    }

    #[test]
    fn subtrees_are_ranges_and_rows_belong_to_ancestors() {
        let symbolic = Symbolic::new(&[6; 144], &grid(12));
        for (s, node) in symbolic.supernodes.iter().enumerate() {
            let Some(parent) = node.parent else { continue };
            let above = &symbolic.supernodes[parent];
            assert!(parent > s && above.first_descendant <= node.first_descendant);
            assert!(node.rows.iter().all(|row| {
                (above.first..above.end).contains(&(*row as usize))
                    || above.rows.contains(row)
            }));
        }
        assert_eq!(symbolic.unknowns(), 864);
    }
}
