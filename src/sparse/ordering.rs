//! An order of elimination that fills little: approximate minimum degree.

use crate::sparse::etree::{Last, elimination_tree, postorder};
use feral_amd::{CscPattern, amd_order};

/// The vertices of a graph in an order of little fill, each right after the subtree of the
/// elimination tree below it; `neighbours` lists each edge both ways, without loops, each
/// once.
pub(crate) fn elimination_order(neighbours: &[Vec<u32>], last: Last) -> Vec<usize> {
    let order = minimum_degree(neighbours);
    let tree = elimination_tree(&order, neighbours);
    postorder(&tree, last).into_iter().map(|k| order[k]).collect()
}

fn minimum_degree(neighbours: &[Vec<u32>]) -> Vec<usize> {
    let mut starts = vec![0_i32];
    let mut rows: Vec<i32> = Vec::with_capacity(neighbours.iter().map(Vec::len).sum());
    for (vertex, list) in neighbours.iter().enumerate() {
        let from = rows.len();
        rows.extend(list.iter().map(|&other| other as i32));
        rows.push(vertex as i32);
        rows[from..].sort_unstable();
        starts.push(rows.len() as i32);
    }
    let pattern = CscPattern::new(neighbours.len(), &starts, &rows);
    let order = pattern.and_then(|pattern| amd_order(&pattern).ok());
    let order = order.map(|order| order.into_iter().map(|vertex| vertex as usize));
    // Any order is correct; without the library's answer it is only slow.
    order.map_or_else(|| (0..neighbours.len()).collect(), Iterator::collect)
}
