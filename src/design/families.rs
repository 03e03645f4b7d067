//! The two families of fins, as far as they can be told apart.

use crate::design::quads::sides;
use crate::structure::Draft;
use std::collections::BTreeMap;

/// The family, 1 or 2, of each edge of a mesh, by its two nodes, the smaller first. Opposite
/// sides of a quad are of one family, neighbouring ones are not; around a node of three or
/// five fins that cannot hold, and edges that hang together with one have none.
///
/// Family 1 is the one with more edges; where its edges are to be `aspect` times as long as
/// those of the other, the one for which that is the more nearly so.
pub(super) fn families(draft: &Draft, aspect: f64) -> BTreeMap<[usize; 2], Option<u8>> {
    let mut families = by_count(&draft.faces);
    let mut sums = [[0.0; 2]; 2];
    for (&[a, b], family) in &families {
        if let &Some(family) = family {
            let sum = &mut sums[usize::from(family) - 1];
            sum[0] += (draft.positions[a] - draft.positions[b]).norm();
            sum[1] += 1.0;
        }
    }
    let [first, second] = sums.map(|[length, count]| length / count);
    // False where there is no family, for these are no numbers.
    if (first / second > 1.0 && aspect < 1.0) || (first / second < 1.0 && aspect > 1.0) {
        families.values_mut().flatten().for_each(|family| *family = 3 - *family);
    }
    families
}

fn by_count(faces: &[Vec<usize>]) -> BTreeMap<[usize; 2], Option<u8>> {
    let mut numbers: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for (a, b) in faces.iter().flat_map(|face| sides(face)) {
        let next = numbers.len();
        numbers.entry([a.min(b), a.max(b)]).or_insert(next);
    }
    let mut beside: Vec<Vec<usize>> = vec![Vec::new(); numbers.len()];
    for face in faces.iter().filter(|face| face.len() == 4) {
        let sides: Vec<usize> =
            sides(face).map(|(a, b)| numbers[&[a.min(b), a.max(b)]]).collect();
        for k in 0..4 {
            beside[sides[k]].push(sides[(k + 1) % 4]);
            beside[sides[(k + 1) % 4]].push(sides[k]);
        }
    }
    let mut second: Vec<Option<bool>> = vec![None; numbers.len()];
    let mut known = vec![true; numbers.len()];
    for start in 0..second.len() {
        if second[start].is_some() {
            continue;
        }
        second[start] = Some(false);
        let (mut group, mut at, mut holds) = (vec![start], 0, !beside[start].is_empty());
        while let Some(&edge) = group.get(at) {
            at += 1;
            for &other in &beside[edge] {
                let wanted = second[edge].map(|own| !own);
                if second[other].is_none() {
                    second[other] = wanted;
                    group.push(other);
                }
                holds &= second[other] == wanted;
            }
        }
        let seconds = group.iter().filter(|&&edge| second[edge] == Some(true)).count();
        let swap = 2 * seconds > group.len();
        for &edge in &group {
            known[edge] = holds;
            second[edge] = second[edge].map(|second| second ^ swap);
        }
    }
    let family = |edge: usize| {
        let own = if second[edge] == Some(true) { 2 } else { 1 };
        known[edge].then_some(own)
    };
    numbers.into_iter().map(|(ends, edge)| (ends, family(edge))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_has_two_families_and_a_node_of_three_none() {
        let grid = [vec![0, 1, 4, 3], vec![1, 2, 5, 4]];
        let found = by_count(&grid);
        // Four edges along, three across: the larger family is the first.
        assert_eq!(found[&[0, 1]], Some(1));
        assert_eq!(found[&[1, 4]], Some(2));
        let three = [vec![0, 1, 2, 3], vec![0, 3, 4, 5], vec![0, 5, 6, 1]];
        assert!(by_count(&three).values().all(Option::is_none));
    }
}
