//! Which strip goes in before which.
//!
//! Any ranking gives an order of assembly; this one uses as few
//! strips with slits from both edges as two-colouring allows, and depends on the strips'
//! lengths, not on how the structure is numbered.

use crate::parts::unfold::FlatStrip;
use crate::tolerance::SAME_LENGTH_MM;
use std::collections::VecDeque;

/// The strips by rank, and the rank of each. Strips that cross are two-coloured; the
/// colour whose strips are longer goes in first and carries the others.
pub(crate) fn ranks(
    strips: &[FlatStrip],
    laps: impl Iterator<Item = [usize; 2]>,
) -> (Vec<usize>, Vec<usize>) {
    let mut crossed = vec![Vec::new(); strips.len()];
    for [a, b] in laps {
        crossed[a].push(b);
        crossed[b].push(a);
    }
    let lengths: Vec<f64> = strips.iter().map(FlatStrip::length).collect();
    let mut late = vec![None; strips.len()];
    for start in longest_first(&lengths) {
        if late[start].is_none() {
            colour(&crossed, &lengths, start, &mut late);
        }
    }
    let mut order: Vec<usize> = (0..strips.len()).collect();
    order.sort_by_key(|&strip| (late[strip], strip));
    let mut rank = vec![0; strips.len()];
    for (place, &strip) in order.iter().enumerate() {
        rank[strip] = place;
    }
    (order, rank)
}

/// Strips from long to short; equal ones as they are numbered.
fn longest_first(lengths: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..lengths.len()).collect();
    let whole = |k: usize| (lengths[k] / SAME_LENGTH_MM / 1e3).round();
    order.sort_by(|&a, &b| whole(b).total_cmp(&whole(a)).then(a.cmp(&b)));
    order
}

/// Colours all strips that hang together with `start`: by the parity of the number of
/// crossings on the shortest way there.
fn colour(
    crossed: &[Vec<usize>],
    lengths: &[f64],
    start: usize,
    late: &mut [Option<bool>],
) {
    let mut piece = vec![start];
    let mut queue = VecDeque::from([start]);
    late[start] = Some(false);
    while let Some(strip) = queue.pop_front() {
        for &other in &crossed[strip] {
            if late[other].is_none() {
                late[other] = late[strip].map(|late| !late);
                queue.push_back(other);
                piece.push(other);
            }
        }
    }
    let mean = |colour: bool| {
        let of_it = piece.iter().filter(|&&strip| late[strip] == Some(colour));
        let lengths: Vec<f64> = of_it.map(|&strip| lengths[strip]).collect();
        lengths.iter().sum::<f64>() / lengths.len().max(1) as f64
    };
    if mean(true) > mean(false) + SAME_LENGTH_MM {
        for strip in piece {
            late[strip] = late[strip].map(|late| !late);
        }
    }
}
