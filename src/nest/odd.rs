//! Stock that is no bare rectangle: remnants, and sheets on which parts lie already.

use crate::nest::random::Random;
use crate::nest::search::MOST_PARTS;
use crate::nest::turned::Turned;
use crate::nest::yard::Yard;
use crate::nest::{Layout, NestedSheet, Shape, Stock};

/// Parts in a row that find no place before the others are not tried any more.
const FAILURES: usize = 100;
/// More pieces of one kind are not opened.
const MOST_SHEETS: usize = 100;

/// The kinds of odd stock to be filled before all other sheets, and those that cost more.
pub(super) fn kinds(stock: &[Stock]) -> (Vec<usize>, Vec<usize>) {
    let rate = |s: &Stock| s.cost / s.area().max(f64::MIN_POSITIVE);
    let plain = stock.iter().filter(|s| s.is_plain()).map(rate);
    let cheapest = plain.fold(f64::INFINITY, f64::min);
    let odd = (0..stock.len()).filter(|&kind| !stock[kind].is_plain());
    odd.partition(|&k| !stock[k].locked.is_empty() || rate(&stock[k]) <= cheapest)
}

/// Lays parts on all sheets of the given kinds, in the order given, as long as they find a
/// place; the sheets that are not empty, and the parts that are left.
pub(super) fn fill(
    shapes: &[Shape],
    stock: &[Stock],
    kinds: &[usize],
    order: Vec<usize>,
    seed: u64,
) -> (Vec<NestedSheet>, Vec<usize>) {
    let many = |&kind: &usize| vec![kind; stock[kind].most().min(MOST_SHEETS)];
    let sheets: Vec<usize> = kinds.iter().flat_map(many).collect();
    let mut parts: Vec<usize> = order.iter().copied().take(MOST_PARTS).collect();
    let locked = kinds.iter().flat_map(|&kind| &stock[kind].locked);
    parts.extend(locked.map(|placement| placement.shape));
    parts.sort_unstable();
    let yard = if sheets.is_empty() { None } else { Yard::new(shapes, parts, stock) };
    let Some(yard) = yard else { return (Vec::new(), order) };
    let mut crowd = yard.crowd(&sheets, Random::new(seed));
    let mut scratch = Turned::default();
    let (mut failed, mut left) = (0, Vec::new());
    for index in order {
        let part = yard.parts.binary_search(&index).ok().filter(|_| failed < FAILURES);
        scratch.angle = f64::NAN;
        let pose = part.and_then(|part| {
            crowd.free_place(part, &mut scratch).map(|pose| (part, pose))
        });
        match pose {
            Some((part, pose)) => {
                failed = 0;
                crowd.put(part, pose);
            }
            None => {
                failed += 1;
                left.push(index);
            }
        }
    }
    let Layout { sheets } = yard.layout(&crowd, &sheets);
    (sheets, left)
}
