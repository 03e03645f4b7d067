//! Which ends of strips nothing holds.

use crate::parts::fit::Fit;
use crate::parts::joint::{End, join};
use crate::structure::{Strip, Structure};
use std::collections::BTreeSet;

/// A structure with its strips as they will be cut, and the ends, as strip and node, that
/// lap with nothing: they are set back from the axis.
pub fn lapped(structure: &Structure, fit: &Fit) -> (Structure, BTreeSet<(usize, usize)>) {
    let (flat, _) = super::flat_strips(structure);
    let strips: Vec<Strip> = flat.iter().map(super::chain).collect();
    let structure = structure.clone().with_strips(strips);
    let (joinery, _) = join(&structure, &flat, fit);
    let mut unheld = BTreeSet::new();
    let mut held = BTreeSet::new();
    for (strip, (flat, joints)) in flat.iter().zip(&joinery.joints).enumerate() {
        let last = flat.axes.len() - 1;
        for (place, axis) in flat.axes.iter().enumerate() {
            let end = match place {
                0 => Some(joints.ends[0]),
                k if k == last => Some(joints.ends[1]),
                _ => None,
            };
            let loose = matches!(end, Some(End::SetBack(_)));
            let into = if loose { &mut unheld } else { &mut held };
            into.insert((strip, axis.node));
        }
    }
    // A closed strip comes to its seam twice; one visit that holds is enough.
    (structure, unheld.difference(&held).copied().collect())
}
