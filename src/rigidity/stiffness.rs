//! What the factor is made from: the resistance of each body, sleeves with weights.

use crate::rigidity::factor::Entries;
use crate::rigidity::motions::Motions;
use crate::rigidity::system::{System, WHOLE, in_parts};
use crate::tolerance::SHIFT;
use std::ops::Range;

/// A system with weights: what the factor is made from.
pub(super) struct Stiffness<'a> {
    system: &'a System<'a>,
    /// Weighted motions and roots of weights, if any weight is not 1.
    weighted: Option<(Vec<Motions>, Vec<f64>)>,
    /// What stands on the diagonal beside the blocks of bodies that are eliminated.
    diagonal: Vec<f64>,
}

impl<'a> Stiffness<'a> {
    pub(super) fn new(system: &'a System<'a>, weights: Option<&[f64]>) -> Self {
        let weighted = weights.map(|weights| {
            let roots: Vec<f64> = weights.iter().map(|w| w.sqrt()).collect();
            let of = |body: usize| {
                let range = system.sleeve[body]..system.sleeve[body + 1];
                if system.fixed == Some(body) {
                    return Motions::none(3 * range.len());
                }
                Motions::new(&system.model.points(body), &roots[range])
            };
            let bodies = system.motions.len();
            let make = |part: Range<usize>| part.map(of).collect();
            (in_parts(bodies, system.threads, make), roots)
        });
        let mut diagonal = system.counts();
        if system.floats {
            let stays = system.stays(&diagonal);
            diagonal.iter_mut().for_each(|d| *d *= SHIFT);
            stays.into_iter().for_each(|(k, strength)| diagonal[k] += strength);
        } else {
            diagonal.iter_mut().for_each(|d| *d *= SHIFT);
        }
        let mut stiffness = Self { system, weighted, diagonal };
        stiffness.add_own();
        stiffness
    }

    /// Bodies that keep their motion: its six unknowns, and the weights on their knots.
    fn add_own(&mut self) {
        let system = self.system;
        for (body, group) in system.body_group.iter().enumerate() {
            let Some(group) = *group else { continue };
            let place = system.symbolic.place[group as usize];
            let own = system.symbolic.start[place]..system.symbolic.start[place + 1];
            self.diagonal[own].fill(1.0);
            let mut sleeve = system.sleeve[body];
            for &knot in &system.model.touches[body] {
                for k in 0..system.model.knots[knot].points.len() {
                    let root = self.root(sleeve);
                    if let Some(at) = system.knot_at[knot] {
                        let at = at + 3 * k;
                        self.diagonal[at..at + 3]
                            .iter_mut()
                            .for_each(|d| *d += root * root);
                    }
                    sleeve += 1;
                }
            }
        }
    }

    fn root(&self, sleeve: usize) -> f64 {
        self.weighted.as_ref().map_or(1.0, |(_, roots)| roots[sleeve])
    }

    fn motions(&self, body: usize) -> &Motions {
        let all = self.weighted.as_ref().map_or(&self.system.motions, |(all, _)| all);
        &all[body]
    }

    /// The knots of a body that are free: place of the group, row in the body, size.
    fn free(&self, body: usize) -> Vec<(usize, usize, usize)> {
        let system = self.system;
        let mut row = 0;
        let mut free = Vec::with_capacity(3);
        for &knot in &system.model.touches[body] {
            let size = 3 * system.model.knots[knot].points.len();
            if let Some(group) = system.knot_group[knot] {
                free.push((system.symbolic.place[group as usize], row, size));
            }
            row += size;
        }
        free
    }

    fn add_body(&self, body: usize, add: &mut dyn FnMut(usize, usize, &[f64])) {
        let motions = self.motions(body);
        let first = self.system.sleeve[body];
        let root = |row: usize| self.root(first + row / 3);
        let free = self.free(body);
        let mut block = [0.0; 36];
        for &(row_place, row, rows) in &free {
            for &(column_place, column, columns) in &free {
                if row_place < column_place {
                    continue;
                }
                let block = &mut block[..rows * columns];
                block.fill(0.0);
                for k in 0..motions.rank {
                    let motion = motions.column(k);
                    for (c, values) in block.chunks_exact_mut(rows).enumerate() {
                        let share = motion[column + c];
                        let motion = &motion[row..row + rows];
                        values.iter_mut().zip(motion).for_each(|(x, m)| *x -= m * share);
                    }
                }
                for (c, values) in block.chunks_exact_mut(rows).enumerate() {
                    if row == column {
                        values[c] += 1.0;
                    }
                    let across = root(column + c);
                    for (r, x) in values.iter_mut().enumerate() {
                        *x *= across * root(row + r);
                    }
                }
                add(row_place, column_place, block);
            }
        }
    }

    /// The block between a knot and a body that keeps its motion: `-S Q`.
    fn add_link(
        &self,
        (body, touch): (usize, usize),
        add: &mut dyn FnMut(usize, usize, &[f64]),
    ) {
        let system = self.system;
        let knots = &system.model.touches[body];
        let (Some(own), Some(knot)) =
            (system.body_group[body], system.knot_group[knots[touch]])
        else {
            return;
        };
        let [own, knot] = [own, knot].map(|group| system.symbolic.place[group as usize]);
        let points = |k: &usize| 3 * system.model.knots[*k].points.len();
        let row: usize = knots[..touch].iter().map(points).sum();
        let rows = points(&knots[touch]);
        let motions = self.motions(body);
        let entry = |r: usize, k: usize| {
            let root = self.root(system.sleeve[body] + (row + r) / 3);
            -root * motions.column(k)[row + r]
        };
        let mut block = [0.0; 36];
        let block = &mut block[..rows * motions.rank];
        if knot > own {
            for (at, x) in block.iter_mut().enumerate() {
                *x = entry(at % rows, at / rows);
            }
            add(knot, own, block);
        } else {
            for (at, x) in block.iter_mut().enumerate() {
                *x = entry(at / motions.rank, at % motions.rank);
            }
            add(own, knot, block);
        }
    }
}

impl Entries for Stiffness<'_> {
    fn entries(&self, supernode: usize, add: &mut dyn FnMut(usize, usize, &[f64])) {
        let symbolic = &self.system.symbolic;
        let node = &symbolic.supernodes[supernode];
        for place in node.first..node.end {
            let size = symbolic.size(place);
            let mut block = vec![0.0; size * size];
            for k in 0..size {
                block[k * size + k] = self.diagonal[symbolic.start[place] + k];
            }
            add(place, place, &block);
        }
        for &(body, touch) in &self.system.jobs[supernode] {
            match touch {
                WHOLE => self.add_body(body as usize, add),
                touch => self.add_link((body as usize, touch as usize), add),
            }
        }
    }
}
