//! Conditions with whole coefficients, and unknowns taken out by them.

use std::collections::BTreeMap;

/// A Gaussian integer: a point of the whole grid of the plane; times i is a quarter turn.
pub(super) type Gauss = [i64; 2];

/// The product.
pub(super) fn product(a: Gauss, b: Gauss) -> Gauss {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// i to this power.
pub(super) fn power_of_i(quarters: i32) -> Gauss {
    crate::design::map::turned([1, 0], quarters)
}

/// The quotient, if it is whole.
fn quotient(a: Gauss, b: Gauss) -> Option<Gauss> {
    let norm = b[0] * b[0] + b[1] * b[1];
    let scaled = product(a, [b[0], -b[1]]);
    let whole = norm != 0 && scaled.iter().all(|x| x % norm == 0);
    whole.then(|| scaled.map(|x| x / norm))
}

/// A sum of unknowns, each with its factor; none is 0.
pub(super) type Form = BTreeMap<usize, Gauss>;

/// Adds a multiple of an unknown.
pub(super) fn add(form: &mut Form, unknown: usize, factor: Gauss) {
    let entry = form.entry(unknown).or_insert([0; 2]);
    *entry = [entry[0] + factor[0], entry[1] + factor[1]];
    if *entry == [0; 2] {
        form.remove(&unknown);
    }
}

/// Unknowns that are given by others.
#[derive(Debug, Default)]
pub(super) struct Solved(BTreeMap<usize, Form>);

/// A condition that no whole numbers can meet in general.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NotWhole;

impl Solved {
    /// A form in unknowns that are free.
    pub(super) fn reduced(&self, form: &Form) -> Form {
        let mut reduced = Form::new();
        for (&unknown, &factor) in form {
            match self.0.get(&unknown) {
                None => add(&mut reduced, unknown, factor),
                // Those may have been taken out since.
                Some(by) => {
                    for (&other, &share) in &self.reduced(by) {
                        add(&mut reduced, other, product(factor, share));
                    }
                }
            }
        }
        reduced
    }

    /// Takes out an unknown so that a form vanishes: of those by whose factor all others
    /// can be divided, one of the first rank.
    ///
    /// # Errors
    /// [`NotWhole`] if there is none.
    pub(super) fn vanish(
        &mut self,
        form: &Form,
        rank: impl Fn(usize) -> usize,
    ) -> Result<(), NotWhole> {
        let form = self.reduced(form);
        if form.is_empty() {
            return Ok(());
        }
        let divided = |unknown: usize, factor: Gauss| -> Option<Form> {
            let others = form.iter().filter(|other| *other.0 != unknown);
            others.map(|(&k, &f)| Some((k, quotient([-f[0], -f[1]], factor)?))).collect()
        };
        let best = form
            .iter()
            .filter_map(|(&unknown, &factor)| {
                divided(unknown, factor).map(|by| (rank(unknown), unknown, by))
            })
            .min_by_key(|(rank, unknown, _)| (*rank, *unknown));
        let (_, unknown, by) = best.ok_or(NotWhole)?;
        self.0.insert(unknown, by);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_are_met_by_what_is_taken_out() {
        // (i - 1) x + i t = 0 takes t out, t = (i + 1) ... x, not x.
        let form = Form::from([(0, [-1, 1]), (7, [0, 1])]);
        let mut solved = Solved::default();
        solved.vanish(&form, |unknown| usize::from(unknown != 7)).unwrap();
        assert!(solved.reduced(&form).is_empty());
        assert_eq!(solved.reduced(&Form::from([(0, [1, 0])])), Form::from([(0, [1, 0])]));
    }

    #[test]
    fn half_numbers_are_refused() {
        let form = Form::from([(0, [2, 0]), (1, [3, 0])]);
        assert!(Solved::default().vanish(&form, |_| 0).is_err());
    }
}
