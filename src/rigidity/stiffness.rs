//! What the factor is made from: the resistance of each body, contacts with weights.

use crate::rigidity::motions::Motions;
use crate::rigidity::system::{Contribution, Span, System};
use crate::sparse::{Entries, Factor, NotPositiveDefinite, map_chunks};
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
                let range = system.first_contact[body]..system.first_contact[body + 1];
                if system.fixed == Some(body) {
                    return Motions::none(3 * range.len());
                }
                Motions::new(&system.model.points(body), &roots[range])
            };
            let bodies = system.motions.len();
            let make = |part: Range<usize>| part.map(of).collect();
            (map_chunks(bodies, system.threads, make), roots)
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

    /// Its factor.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`] if a motion meets no resistance even with the shift.
    pub(super) fn factor(&self) -> Result<Factor<'a>, NotPositiveDefinite> {
        Factor::new(&self.system.symbolic, self, self.system.threads)
    }

    /// How far each contact leaves its pin when bodies follow the heavier contacts more,
    /// three numbers per contact.
    pub(super) fn deviations(&self, y: &[f64]) -> Vec<f64> {
        let system = self.system;
        let some = |part: Range<usize>| {
            let (mut all, mut values) = (Vec::new(), Vec::new());
            for body in part {
                system.gather(body, y, &mut values);
                for (velocity, contact) in
                    values.chunks_exact_mut(3).zip(system.first_contact[body]..)
                {
                    velocity.iter_mut().for_each(|x| *x *= self.root(contact));
                }
                self.motions(body).clear_values(&mut values);
                for (off, contact) in
                    values.chunks_exact(3).zip(system.first_contact[body]..)
                {
                    all.extend(off.iter().map(|x| x / self.root(contact)));
                }
            }
            all
        };
        map_chunks(system.motions.len(), system.threads, some)
    }

    /// Bodies that keep their motion: its six unknowns, and the weights on their couplings.
    fn add_own(&mut self) {
        let system = self.system;
        for (body, group) in system.body_group.iter().enumerate() {
            let Some(group) = *group else { continue };
            let place = system.symbolic.place[group as usize];
            let own = system.symbolic.start[place]..system.symbolic.start[place + 1];
            self.diagonal[own].fill(1.0);
            let mut contact = system.first_contact[body];
            for &coupling in &system.model.incidence[body] {
                for k in 0..system.model.couplings[coupling].points.len() {
                    let root = self.root(contact);
                    if let Some(at) = system.coupling_at[coupling] {
                        let at = at + 3 * k;
                        self.diagonal[at..at + 3]
                            .iter_mut()
                            .for_each(|d| *d += root * root);
                    }
                    contact += 1;
                }
            }
        }
    }

    fn root(&self, contact: usize) -> f64 {
        self.weighted.as_ref().map_or(1.0, |(_, roots)| roots[contact])
    }

    fn motions(&self, body: usize) -> &Motions {
        let all = self.weighted.as_ref().map_or(&self.system.motions, |(all, _)| all);
        &all[body]
    }

    /// The block of a body between two of its couplings: `S (I - Q Qᵀ) S`.
    fn block(&self, body: usize, row: Span, column: Span, block: &mut [f64]) {
        let motions = self.motions(body);
        block.fill(0.0);
        for k in 0..motions.rank {
            let motion = motions.column(k);
            let down = &motion[row.row..row.row + row.size];
            let across = &motion[column.row..column.row + column.size];
            // Loops of known length are quicker.
            match (block.as_chunks_mut::<6>(), down.as_chunks::<6>()) {
                ((columns, []), ([down], [])) => less_product(columns, down, across),
                _ => {
                    for (values, share) in block.chunks_exact_mut(row.size).zip(across) {
                        values.iter_mut().zip(down).for_each(|(x, m)| *x -= m * share);
                    }
                }
            }
        }
        if row.row == column.row {
            block.iter_mut().step_by(row.size + 1).for_each(|x| *x += 1.0);
        }
        if self.weighted.is_some() {
            let root = |row: usize| self.root(self.system.first_contact[body] + row / 3);
            for (c, values) in block.chunks_exact_mut(row.size).enumerate() {
                let across = root(column.row + c);
                for (r, x) in values.iter_mut().enumerate() {
                    *x *= across * root(row.row + r);
                }
            }
        }
    }

    /// The block between a coupling and a body that keeps its motion, `-S Q`; transposed
    /// if the coupling is eliminated first.
    fn link(&self, body: usize, coupling: Span, own: usize, block: &mut [f64]) {
        let motions = self.motions(body);
        let entry = |r: usize, k: usize| {
            let root =
                self.root(self.system.first_contact[body] + (coupling.row + r) / 3);
            -root * motions.column(k)[coupling.row + r]
        };
        for (at, x) in block.iter_mut().enumerate() {
            *x = if coupling.place > own {
                entry(at % coupling.size, at / coupling.size)
            } else {
                entry(at / motions.rank, at % motions.rank)
            };
        }
    }
}

/// Takes the product of `down` with each share of `across` from a column.
fn less_product(columns: &mut [[f64; 6]], down: &[f64; 6], across: &[f64]) {
    for (values, share) in columns.iter_mut().zip(across) {
        for (x, m) in values.iter_mut().zip(down) {
            *x -= m * share;
        }
    }
}

impl Entries for Stiffness<'_> {
    fn entries(&self, supernode: usize, add: &mut dyn FnMut(usize, usize, &[f64])) {
        let symbolic = &self.system.symbolic;
        let node = &symbolic.supernodes[supernode];
        let mut block = [0.0; 36];
        for place in node.first..node.end {
            let size = symbolic.size(place);
            let block = &mut block[..size * size];
            block.fill(0.0);
            let diagonal = &self.diagonal[symbolic.start[place]..];
            block.iter_mut().step_by(size + 1).zip(diagonal).for_each(|(x, d)| *x = *d);
            add(place, place, block);
        }
        for &contribution in &self.system.contributions[supernode] {
            match contribution {
                Contribution::Block { body, row, column } => {
                    let block = &mut block[..row.size * column.size];
                    self.block(body, row, column, block);
                    add(row.place, column.place, block);
                }
                Contribution::Link { body, coupling, own } => {
                    let block = &mut block[..coupling.size * self.motions(body).rank];
                    self.link(body, coupling, own, block);
                    add(coupling.place.max(own), coupling.place.min(own), block);
                }
            }
        }
    }
}
