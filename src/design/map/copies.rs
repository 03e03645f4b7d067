//! Coordinates of all corners by as few unknowns as there are.
//!
//! A vertex on the cut has a copy in each sector between cut edges. With coordinates as
//! complex numbers a copy is `i^j x + Σ i^q t`: the vertex's own unknown `x`, and the
//! translations `t` of the segments that lie between. Closing the fan around an inner
//! vertex gives conditions, an aligned piece of the boundary one per vertex on it; both are
//! taken out with whole factors, so that what is left may be chosen freely and all copies
//! agree exactly.

use crate::design::directions::Singular;
use crate::design::map::Failure;
use crate::design::map::arcs::Arc;
use crate::design::map::cut::Cut;
use crate::design::map::forms::{
    Form, Gauss, NotWhole, Solved, add, power_of_i, product,
};
use crate::design::surface::{Surface, previous};
use std::collections::BTreeMap;

/// A free unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Unknown {
    Continuous(usize),
    Integer(usize),
}

/// A multiple of a free unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Term {
    pub unknown: Unknown,
    pub factor: i64,
}

/// All copies of all vertices.
pub(super) struct Copies {
    /// The copy at each corner.
    pub of_corner: Vec<usize>,
    /// Both coordinates of each copy.
    pub forms: Vec<[Vec<Term>; 2]>,
    pub continuous: usize,
    pub integers: usize,
}

impl From<NotWhole> for Failure {
    fn from(_: NotWhole) -> Self {
        Self::NoWholeNumbers
    }
}

/// Copies as complex forms. Unknowns: one per vertex, then one per segment.
struct Sectors {
    of_corner: Vec<usize>,
    forms: Vec<Form>,
    /// What has to vanish for each inner vertex on the cut.
    closings: Vec<Form>,
}

impl Copies {
    pub(super) fn of(
        surface: &Surface,
        cut: &Cut,
        singular: &[Singular],
        arcs: &[Arc],
    ) -> Result<Self, Failure> {
        let vertices = surface.positions.len();
        let sectors = Sectors::of(surface, cut);
        let mut solved = Solved::default();
        if let (true, Some(first)) = (arcs.is_empty(), singular.first()) {
            // One singular vertex may lie anywhere.
            solved.vanish(&Form::from([(first.vertex, [1, 0])]), |_| 0)?;
        }
        for closing in &sectors.closings {
            // Translations first: positions of singular vertices are what is rounded.
            solved.vanish(closing, |unknown| usize::from(unknown < vertices))?;
        }
        let complex: Vec<Form> =
            sectors.forms.iter().map(|form| solved.reduced(form)).collect();
        let mut is_whole = vec![false; vertices];
        singular.iter().for_each(|s| is_whole[s.vertex] = true);
        // Real unknowns: two per complex one, then one per arc.
        let last = 2 * (vertices + cut.count);
        let rank = |unknown: usize| match unknown {
            k if k < 2 * vertices && !is_whole[k / 2] => 0,
            k if k >= last => 1,
            _ => 2,
        };
        let mut straight = Solved::default();
        for (number, arc) in arcs.iter().enumerate() {
            for &(corner, component) in &arc.corners {
                let mut form = real(&complex[sectors.of_corner[corner]], component);
                add(&mut form, last + number, [-1, 0]);
                straight.vanish(&form, rank)?;
            }
        }
        let forms = complex
            .iter()
            .map(|form| [0, 1].map(|component| straight.reduced(&real(form, component))));
        let is_continuous = |unknown: usize| rank(unknown) == 0;
        Ok(Self::numbered(sectors.of_corner, forms, is_continuous))
    }

    /// Gives the unknowns that are left consecutive numbers, in their order.
    fn numbered(
        of_corner: Vec<usize>,
        forms: impl Iterator<Item = [Form; 2]>,
        is_continuous: impl Fn(usize) -> bool,
    ) -> Self {
        let forms: Vec<[Form; 2]> = forms.collect();
        let mut numbers: BTreeMap<usize, Unknown> = BTreeMap::new();
        for &unknown in forms.iter().flatten().flat_map(|form| form.keys()) {
            numbers.insert(unknown, Unknown::Integer(0));
        }
        let (mut continuous, mut integers) = (0, 0);
        for (&unknown, number) in &mut numbers {
            let (of, count): (fn(usize) -> Unknown, _) = if is_continuous(unknown) {
                (Unknown::Continuous, &mut continuous)
            } else {
                (Unknown::Integer, &mut integers)
            };
            *number = of(*count);
            *count += 1;
        }
        let terms = |form: &Form| {
            let term =
                |(k, f): (&usize, &Gauss)| Term { unknown: numbers[k], factor: f[0] };
            form.iter().map(term).collect()
        };
        let forms = forms.iter().map(|form| [terms(&form[0]), terms(&form[1])]).collect();
        Self { of_corner, forms, continuous, integers }
    }
}

/// The real part (component 0) or the imaginary part (1) of a complex form.
fn real(form: &Form, component: usize) -> Form {
    let mut part = Form::new();
    for (&unknown, &[a, b]) in form {
        let by = if component == 0 { [a, -b] } else { [b, a] };
        for (k, factor) in by.into_iter().enumerate().filter(|by| by.1 != 0) {
            add(&mut part, 2 * unknown + k, [factor, 0]);
        }
    }
    part
}

impl Sectors {
    fn of(surface: &Surface, cut: &Cut) -> Self {
        let mut sectors = Self {
            of_corner: vec![usize::MAX; surface.side_count()],
            forms: Vec::new(),
            closings: Vec::new(),
        };
        for vertex in 0..surface.positions.len() {
            sectors.around(surface, cut, vertex);
        }
        sectors
    }

    fn around(&mut self, surface: &Surface, cut: &Cut, vertex: usize) {
        let own = Form::from([(vertex, [1, 0])]);
        let mut form = own.clone();
        let mut copy = None;
        for corner in surface.fan(vertex) {
            let number = *copy.get_or_insert_with(|| {
                self.forms.push(form.clone());
                self.forms.len() - 1
            });
            self.of_corner[corner] = number;
            let over = previous(corner);
            if let Some((segment, with)) = cut.segments[over] {
                let translation = surface.positions.len() + segment;
                form = across(&form, cut.quarters[over], translation, with);
                copy = None;
            }
        }
        if !surface.on_boundary(vertex) && form != own {
            add(&mut form, vertex, [-1, 0]);
            self.closings.push(form);
        } else if !surface.on_boundary(vertex) && copy.is_some() {
            // The last sector runs on into the first.
            self.join(surface, vertex);
        }
    }

    /// Makes the copies of the first and the last sector around a vertex one.
    fn join(&mut self, surface: &Surface, vertex: usize) {
        let fan: Vec<usize> = surface.fan(vertex).collect();
        let (Some(&first), Some(&last)) = (fan.first(), fan.last()) else { return };
        let (keep, drop) = (self.of_corner[first], self.of_corner[last]);
        for corner in fan {
            if self.of_corner[corner] == drop {
                self.of_corner[corner] = keep;
            }
        }
    }
}

/// A form beyond a cut: turned by quarters and moved by the segment's translation, or the
/// other way round against the segment's direction.
fn across(form: &Form, quarters: i32, translation: usize, with: bool) -> Form {
    let turn = power_of_i(quarters);
    let mut beyond: Form = form.iter().map(|(&k, &f)| (k, product(turn, f))).collect();
    // Against the segment x' = i^k (x − t).
    let factor = if with { [1, 0] } else { product(turn, [-1, 0]) };
    add(&mut beyond, translation, factor);
    beyond
}
