//! The fixed part of a sparse factorisation: order of elimination, tree, supernodes.
//!
//! Works on *groups* of unknowns (the six of a pin, the six of a strip), which are
//! eliminated together; the graph is then six times smaller than the matrix. Ordering by
//! approximate minimum degree (`feral-amd`), then supernodes with relaxed merging.

use crate::rigidity::panel::packed;
use feral_amd::{CscPattern, amd_order};
use std::ops::Range;

/// Consecutive groups that are eliminated as one dense block.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Supernode {
    /// Its first group, by place in the order.
    pub(super) first: usize,
    /// One after its last group.
    pub(super) end: usize,
    /// How many unknowns it eliminates.
    pub(super) width: usize,
    /// Groups after `end` that it touches, ascending.
    pub(super) rows: Vec<u32>,
    /// How many unknowns these have.
    pub(super) below: usize,
    /// The supernode that takes in its update.
    pub(super) parent: Option<usize>,
    /// Supernodes whose updates it takes in.
    pub(super) children: Vec<usize>,
    /// The first supernode of its subtree; a subtree is a range.
    pub(super) leaf: usize,
    /// Whether its depth in the tree is odd.
    pub(super) odd: bool,
}

impl Supernode {
    /// How many numbers its columns take in the factor.
    pub(super) fn room(&self) -> usize {
        packed(self.width, self.width + self.below)
    }

    /// Work of its elimination, about.
    pub(super) fn work(&self) -> f64 {
        self.width as f64 * ((self.width + self.below) as f64).powi(2)
    }
}

/// Order and supernodes of a matrix of groups.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Symbolic {
    /// For each group its place in the order.
    pub(super) place: Vec<usize>,
    /// By place, the first unknown of each group; one more entry at the end.
    pub(super) start: Vec<usize>,
    /// In an order in which children come first.
    pub(super) supernodes: Vec<Supernode>,
    /// By place of a group, its supernode.
    pub(super) owner: Vec<u32>,
}

impl Symbolic {
    /// Analyses groups of these sizes that touch each other as `neighbours` lists (both
    /// ways, without the group itself, each once).
    pub(super) fn new(sizes: &[usize], neighbours: &[Vec<u32>]) -> Self {
        let order = minimum_degree(neighbours);
        let order = postordered(order, neighbours);
        let mut place = vec![0; order.len()];
        for (k, &group) in order.iter().enumerate() {
            place[group] = k;
        }
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
            let leaf = supernodes[s].leaf;
            if let Some(parent) = supernodes[s].parent {
                supernodes[parent].children.push(s);
                supernodes[parent].leaf = supernodes[parent].leaf.min(leaf);
            }
        }
        for s in (0..supernodes.len()).rev() {
            let above = supernodes[s].parent.map(|parent| supernodes[parent].odd);
            supernodes[s].odd = above == Some(false);
        }
        Self { place, start, supernodes, owner }
    }

    /// How many unknowns there are.
    pub(super) fn unknowns(&self) -> usize {
        self.start[self.start.len() - 1]
    }

    /// How many unknowns the group at a place has.
    pub(super) fn size(&self, place: usize) -> usize {
        self.start[place + 1] - self.start[place]
    }

    /// Unknowns of the group at a place.
    pub(super) fn rows(&self, place: usize) -> Range<usize> {
        self.start[place]..self.start[place + 1]
    }

    /// Supernodes whose subtrees can be worked on side by side, the largest work first.
    /// Depends on the matrix only, so that results do not depend on the machine.
    pub(super) fn branches(&self) -> Vec<usize> {
        let mut work: Vec<f64> = self.supernodes.iter().map(Supernode::work).collect();
        for s in 0..work.len() {
            if let Some(parent) = self.supernodes[s].parent {
                work[parent] += work[s];
            }
        }
        let roots = (0..work.len()).filter(|&s| self.supernodes[s].parent.is_none());
        let mut branches: Vec<usize> = roots.collect();
        let total: f64 = branches.iter().map(|&s| work[s]).sum();
        loop {
            branches.sort_by(|&a, &b| work[b].total_cmp(&work[a]).then(a.cmp(&b)));
            let split = branches.iter().position(|&s| {
                work[s] > total / 4.0 && !self.supernodes[s].children.is_empty()
            });
            let Some(split) = split else { return branches };
            let s = branches.swap_remove(split);
            branches.extend(&self.supernodes[s].children);
        }
    }
}

/// Groups in an order of little fill.
fn minimum_degree(neighbours: &[Vec<u32>]) -> Vec<usize> {
    let mut starts = vec![0_i32];
    let mut rows: Vec<i32> = Vec::with_capacity(neighbours.iter().map(Vec::len).sum());
    for (group, list) in neighbours.iter().enumerate() {
        let from = rows.len();
        rows.extend(list.iter().map(|&other| other as i32));
        rows.push(group as i32);
        rows[from..].sort_unstable();
        starts.push(rows.len() as i32);
    }
    let pattern = CscPattern::new(neighbours.len(), &starts, &rows);
    let order = pattern.and_then(|pattern| amd_order(&pattern).ok());
    let order = order.map(|order| order.into_iter().map(|group| group as usize));
    // Any order is correct; without the library's answer it is only slow.
    order.map_or_else(|| (0..neighbours.len()).collect(), Iterator::collect)
}

/// Parents in the elimination tree of an order (Liu 1986), by place.
fn tree(order: &[usize], place: &[usize], neighbours: &[Vec<u32>]) -> Vec<Option<usize>> {
    let mut parent: Vec<Option<usize>> = vec![None; order.len()];
    let mut ancestor: Vec<Option<usize>> = vec![None; order.len()];
    for (k, &group) in order.iter().enumerate() {
        for &other in &neighbours[group] {
            let mut at = place[other as usize];
            while at < k {
                let next = ancestor[at].replace(k);
                match next {
                    None => {
                        parent[at] = Some(k);
                        break;
                    }
                    Some(next) if next == k => break,
                    Some(next) => at = next,
                }
            }
        }
    }
    parent
}

/// The order renumbered so that each subtree is a range, its largest branch last.
fn postordered(order: Vec<usize>, neighbours: &[Vec<u32>]) -> Vec<usize> {
    let count = order.len();
    let mut place = vec![0; count];
    for (k, &group) in order.iter().enumerate() {
        place[group] = k;
    }
    let parent = tree(&order, &place, neighbours);
    let mut size = vec![1_usize; count];
    let mut children = vec![Vec::new(); count];
    let mut roots = Vec::new();
    for k in 0..count {
        match parent[k] {
            Some(parent) => {
                size[parent] += size[k];
                children[parent].push(k);
            }
            None => roots.push(k),
        }
    }
    // Walk from the roots, last first, and read the walk backwards.
    let mut walk = Vec::with_capacity(count);
    let mut stack = roots;
    while let Some(k) = stack.pop() {
        walk.push(order[k]);
        let mut below = std::mem::take(&mut children[k]);
        below.sort_by_key(|&child| (size[child], child));
        stack.extend(below);
    }
    walk.reverse();
    walk
}

/// Parents, and for each place the later places its column reaches, ascending.
fn columns(
    order: &[usize],
    place: &[usize],
    neighbours: &[Vec<u32>],
) -> (Vec<Option<usize>>, Vec<Vec<u32>>) {
    let parents = tree(order, place, neighbours);
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
            leaf: 0,
            odd: false,
        };
        merged.push((node, 0));
    }
    merge_last(&mut merged);
    let nodes = merged.into_iter().enumerate();
    nodes.map(|(s, (node, _))| Supernode { leaf: s, ..node }).collect()
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
            assert!(parent > s && above.leaf <= node.leaf);
            assert!(node.rows.iter().all(|row| {
                (above.first..above.end).contains(&(*row as usize))
                    || above.rows.contains(row)
            }));
        }
        assert_eq!(symbolic.unknowns(), 864);
    }
}
