//! Which part, step and sheet each fin of a job belongs to, for those who draw it.

use crate::job::Job;
use crate::parts::{Body, Part};
use std::collections::BTreeMap;

/// The fins of a part by their nodes, the smaller one first; a fin that is spliced is on
/// both of its parts.
pub(super) fn of_part(part: &Part) -> Vec<[usize; 2]> {
    let Body::Strip(body) = &part.body else { return Vec::new() };
    let run = body.axes.windows(2).map(|pair| [pair[0].node, pair[1].node]);
    let spliced = body.splices.iter().copied();
    run.chain(spliced).map(|[i, j]| [i.min(j), i.max(j)]).collect()
}

/// The part of each fin of the structure, if it is on one.
pub(super) fn parts(job: &Job) -> BTreeMap<[usize; 2], usize> {
    let mut of = BTreeMap::new();
    for (index, part) in job.parts.iter().enumerate() {
        for fin in of_part(part) {
            of.entry(fin).or_insert(index);
        }
    }
    of
}

/// Where a part lies: number of its sheet, from 0.
pub(super) fn sheets(job: &Job) -> BTreeMap<usize, usize> {
    let sheets = job.layout.sheets.iter().enumerate();
    sheets
        .flat_map(|(sheet, nested)| {
            nested.placements.iter().map(move |p| (p.shape, sheet))
        })
        .collect()
}
