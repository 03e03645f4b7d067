//! Whole numbers: rounded one after the other, nearest first, then improved by steps of one
//! (Bommes, Zimmer and Kobbelt 2009, section 4), all on the dense Schur complement.

use crate::design::map::poisson::{Poisson, relaxed};
use nalgebra::{DMatrix, DVector};

/// Whole numbers near the least of `x S x / 2 − r x`.
pub(super) fn rounded(schur: &DMatrix<f64>, pull: &DVector<f64>) -> Vec<i64> {
    let count = pull.len();
    let mut whole = vec![0_i64; count];
    let mut free: Vec<usize> = (0..count).collect();
    let mut right = pull.clone();
    while !free.is_empty() {
        let part =
            DMatrix::from_fn(free.len(), free.len(), |i, j| schur[(free[i], free[j])]);
        let known = DVector::from_fn(free.len(), |i, _| right[free[i]]);
        let relaxed = relaxed(&part, &known).unwrap_or(known);
        let off = |k: usize| (relaxed[k] - relaxed[k].round()).abs();
        let nearest = (0..free.len()).min_by(|&a, &b| off(a).total_cmp(&off(b)));
        let Some(nearest) = nearest else { break };
        let unknown = free.remove(nearest);
        whole[unknown] = relaxed[nearest].round() as i64;
        for &other in &free {
            right[other] -= schur[(other, unknown)] * whole[unknown] as f64;
        }
    }
    improved(schur, pull, whole)
}

/// Steps of one as long as one lowers the sum.
fn improved(schur: &DMatrix<f64>, pull: &DVector<f64>, mut whole: Vec<i64>) -> Vec<i64> {
    let x = DVector::from_iterator(whole.len(), whole.iter().map(|&x| x as f64));
    let mut slope = schur * x - pull;
    // Each step lowers the sum, so that none comes twice; the bound is for rounding.
    for _ in 0..16 * whole.len() {
        let steps = (0..whole.len()).flat_map(|k| [(k, 1), (k, -1)]);
        let change =
            |&(k, step): &(usize, i64)| schur[(k, k)] / 2.0 + step as f64 * slope[k];
        let best = steps.min_by(|a, b| change(a).total_cmp(&change(b)));
        let Some((k, step)) = best.filter(|best| change(best) < 0.0) else { break };
        whole[k] += step;
        slope += schur.column(k) * step as f64;
    }
    whole
}

/// Steps of one that are taken for the sake of triangles that are turned over, and the share
/// of all triangles beyond which steps do not help.
const MOST_REPAIRS: usize = 12;
const BEYOND_REPAIR: f64 = 0.05;

/// While triangles are turned over, takes the step of one that leaves the fewest.
pub(super) fn repaired(poisson: &Poisson, whole: &mut [i64]) {
    let mut free = poisson.solution(whole);
    let mut flips = poisson.flips(&free, whole);
    let most = (BEYOND_REPAIR * poisson.triangle_count() as f64) as usize;
    for _ in 0..MOST_REPAIRS {
        if flips == 0 || flips > most {
            break;
        }
        let mut best = (flips, None);
        for k in 0..whole.len() {
            for step in [1, -1] {
                let moved = stepped(poisson, &free, k, step);
                whole[k] += step;
                let after = poisson.flips(&moved, whole);
                whole[k] -= step;
                if after < best.0 {
                    best = (after, Some((k, step)));
                }
            }
        }
        let (after, Some((k, step))) = best else { break };
        free = stepped(poisson, &free, k, step);
        whole[k] += step;
        flips = after;
    }
}

fn stepped(poisson: &Poisson, free: &[f64], k: usize, step: i64) -> Vec<f64> {
    let by = poisson.column(k).iter();
    free.iter().zip(by).map(|(x, by)| x - by * step as f64).collect()
}
