//! Nodes that lie together and are not joined: found, and made one where that is asked.

use crate::diagnostic::Finding;
use crate::geometry::Point3;
use crate::ids::{FinId, NodeId};
use crate::structure::draft::Draft;
use crate::structure::finding::StructureFinding;
use crate::structure::obj::median_fin_length;
use crate::tolerance::{NEAR_SHARE, NO_LENGTH_MM};
use rstar::RTree;
use rstar::primitives::GeomWithData;
use std::collections::{BTreeMap, BTreeSet};

type Entry = GeomWithData<[f64; 3], usize>;

fn entry((index, p): (usize, &Point3)) -> Entry {
    GeomWithData::new([p.x, p.y, p.z], index)
}

/// The number that each point gets when those within `within` of an earlier one that stays
/// become that one; the others are numbered in their order.
pub(super) fn numbers(points: &[Point3], within: f64) -> Vec<usize> {
    let mut kept: RTree<Entry> = RTree::new();
    let number = |point: &Point3| {
        let near = kept.nearest_neighbor([point.x, point.y, point.z]);
        let near = near.filter(|found| {
            let [x, y, z] = *found.geom();
            (Point3::new(x, y, z) - point).norm() <= within
        });
        if let Some(found) = near {
            return found.data;
        }
        let new = kept.size();
        kept.insert(entry((new, point)));
        new
    };
    points.iter().map(number).collect()
}

/// Nodes with fins that lie at one place, or so near that they look joined, and are not.
pub(super) fn unjoined(draft: &Draft) -> Vec<StructureFinding> {
    let fins: BTreeSet<FinId> = draft.fin_ids().into_iter().collect();
    let used: BTreeSet<usize> =
        fins.iter().flat_map(|fin| fin.ends()).map(NodeId::index).collect();
    let near = NO_LENGTH_MM.max(NEAR_SHARE * median_fin_length(draft));
    let entries = used.iter().map(|&node| entry((node, &draft.positions[node])));
    let tree = RTree::bulk_load(entries.collect());
    let mut places: BTreeMap<usize, Vec<NodeId>> = BTreeMap::new();
    let mut findings = Vec::new();
    let mut at_a_place = BTreeSet::new();
    for &node in &used {
        let p = draft.positions[node];
        let found = tree.locate_within_distance([p.x, p.y, p.z], near * near);
        let mut others: Vec<usize> = found.map(|entry| entry.data).collect();
        others.retain(|&other| other > node);
        others.sort_unstable();
        for other in others {
            let off_mm = (draft.positions[other] - p).norm();
            if fins.contains(&FinId::between(node.into(), other.into())) {
                continue;
            }
            if off_mm > NO_LENGTH_MM {
                let nodes = [node.into(), other.into()];
                findings.push(StructureFinding::NodesNear { nodes, off_mm });
            } else if at_a_place.insert(other) {
                let place = places.entry(node).or_insert_with(|| vec![node.into()]);
                place.push(other.into());
            }
        }
    }
    let place = |nodes| StructureFinding::CoincidentNodes { nodes };
    places.into_values().map(place).chain(findings).collect()
}

/// How the help begins then.
const UNJOINED: &str = "panels are not joined";

/// What loose panels do to a structure.
const BLAMED: [&str; 3] =
    ["rigidity::mechanism", "structure::fins_cross", "structure::fins_cross_often"];

/// Loose panels, the likeliest cause first.
const CAUSES: [&str; 2] = ["structure::nodes_near", "structure::disconnected"];

/// Says of what panels that are not joined bring about that they do.
pub fn blame_gaps(findings: &mut [Finding]) {
    let cause = |code: &&str| findings.iter().find(|found| found.code == **code);
    let Some(cause) = CAUSES.iter().find_map(cause) else { return };
    let why = format!("{UNJOINED} ({}): {}", cause.message, cause.help);
    let blamed = findings.iter_mut().filter(|f| BLAMED.contains(&f.code.as_str()));
    for finding in blamed.filter(|finding| !finding.help.starts_with(UNJOINED)) {
        finding.help = format!("{why}; else {}", finding.help);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_those_that_lie_together_stays() {
        let points = [0.0, 5.0, 0.1, 9.0, 5.05].map(|x| Point3::new(x, 0.0, 0.0));
        assert_eq!(numbers(&points, 0.2), [0, 1, 0, 2, 1]);
        assert_eq!(numbers(&points, 0.0), [0, 1, 2, 3, 4]);
    }
}
