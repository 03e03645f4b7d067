//! The elimination tree of an order, and its postorder.

/// For each vertex its place in the order.
pub(crate) fn places(order: &[usize]) -> Vec<usize> {
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(k, &vertex)| place[vertex] = k);
    place
}

/// Parents in the elimination tree of an order, by place (Liu 1986, A compact row storage
/// scheme for Cholesky factors using elimination trees, algorithm 4.2).
pub(crate) fn elimination_tree(
    order: &[usize],
    neighbours: &[Vec<u32>],
) -> Vec<Option<usize>> {
    let place = places(order);
    let mut parent: Vec<Option<usize>> = vec![None; order.len()];
    let mut ancestor: Vec<Option<usize>> = vec![None; order.len()];
    for (k, &vertex) in order.iter().enumerate() {
        for &other in &neighbours[vertex] {
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

/// Which child comes right before its parent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Last {
    /// The one with the largest subtree, so that the fewest updates wait (Liu 1986, On the
    /// storage requirement in the out-of-core multifrontal method).
    Largest,
    /// The first of them.
    Lowest,
}

/// The places of a tree renumbered so that children come before their parents and each
/// subtree is a range; this changes nothing in what fills (Liu 1990, The role of
/// elimination trees in sparse factorization, 3).
pub(crate) fn postorder(parent: &[Option<usize>], last: Last) -> Vec<usize> {
    let count = parent.len();
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
        walk.push(k);
        let mut below = std::mem::take(&mut children[k]);
        match last {
            Last::Largest => below.sort_by_key(|&child| (size[child], child)),
            Last::Lowest => below.reverse(),
        }
        stack.extend(below);
    }
    walk.reverse();
    walk
}
