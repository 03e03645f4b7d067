//! The strips of a plan: flat, with their joints and the hubs at their ends.

use crate::ids::{NodeId, StripId};
use crate::parts::hub::dimensions::Hubs;
use crate::parts::lap::join::Joinery;
use crate::parts::outline::End;
use crate::parts::unfold::FlatStrip;
use std::collections::{BTreeMap, BTreeSet};

/// Strips as they will be cut and joined.
#[derive(Debug)]
pub(crate) struct Strips {
    /// The strips in the plane.
    pub flat: Vec<FlatStrip>,
    /// Their joints.
    pub joinery: Joinery,
    /// What holds ends that do not lap.
    pub hubs: Hubs,
}

impl Strips {
    /// What slits take of each fin at its nodes, by node and the one at the other end, mm.
    pub(crate) fn slits(&self) -> BTreeMap<[NodeId; 2], f64> {
        let mut taken = BTreeMap::new();
        for (flat, joints) in self.flat.iter().zip(&self.joinery.joints) {
            for (&place, slit) in &joints.slits {
                let node = |place: usize| flat.axes.get(place).map(|axis| axis.node);
                let sides = [
                    (place.checked_sub(1).and_then(node), slit.before),
                    (node(place + 1), slit.after),
                ];
                for (to, wall) in sides {
                    taken.extend(to.map(|to| ([slit.node, to], wall)));
                }
            }
        }
        taken
    }

    /// The ends, as strip and node, that nothing holds.
    pub(crate) fn unheld(&self) -> BTreeSet<(StripId, NodeId)> {
        let mut unheld = BTreeSet::new();
        let mut held = BTreeSet::new();
        for (strip, (flat, joints)) in
            self.flat.iter().zip(&self.joinery.joints).enumerate()
        {
            let last = flat.axes.len() - 1;
            for (place, axis) in flat.axes.iter().enumerate() {
                let end = match place {
                    0 => Some(joints.ends[0]),
                    k if k == last => Some(joints.ends[1]),
                    _ => None,
                };
                let loose = matches!(end, Some(End::SetBack(_)));
                let into = if loose { &mut unheld } else { &mut held };
                into.insert((StripId::new(strip), axis.node));
            }
        }
        // A closed strip comes to its seam twice; one visit that holds is enough.
        unheld.difference(&held).copied().collect()
    }
}
