//! Judging a draft and the structure made of it, all faults at once.

use crate::geometry::{DisjointSets, Mesh, Point3, trig};
use crate::ids::{FaceId, FinId, NodeId};
use crate::structure::draft::{Draft, area_vector};
use crate::structure::finding::{FaceFault, StructureFinding};
use crate::structure::{Node, Structure, surface, weld};
use crate::tolerance::{FARTHEST_MM, NO_AXIS, NO_LENGTH_MM, Tolerance};
use std::collections::{BTreeMap, BTreeSet};

/// Off-plane distance of a quad's corners from their middle plane and their largest
/// distance, mm (docs/formulas.md §3): half the distance between the two diagonals' lines.
pub fn planarity(corners: &[Point3; 4]) -> (f64, f64) {
    let [a, b, c, d] = corners;
    let across = (c - a).cross(&(d - b));
    let norm = across.norm();
    let off = if norm > 0.0 { (b - a).dot(&across).abs() / norm / 2.0 } else { 0.0 };
    let pairs = [(a, b), (a, c), (a, d), (b, c), (b, d), (c, d)];
    let diameter = pairs.iter().map(|(p, q)| (*p - *q).norm()).fold(0.0, f64::max);
    (off, diameter)
}

/// Counts, indices and numbers.
pub(super) fn numbers(draft: &Draft) -> Vec<StructureFinding> {
    let mut findings = counts(draft);
    if findings.is_empty() {
        findings.extend(values(draft));
    }
    findings.extend(indices(draft));
    let fins = draft.fins.as_ref().map_or(0, Vec::len);
    if draft.faces.is_empty() && fins == 0 {
        let nodes = draft.positions.len();
        findings.push(StructureFinding::Empty { nodes, faces: 0 });
    }
    findings
}

fn counts(draft: &Draft) -> Vec<StructureFinding> {
    let nodes = draft.positions.len();
    [
        ("axes", draft.axes.len()),
        ("depths below", draft.below.len()),
        ("depths above", draft.above.len()),
    ]
    .into_iter()
    .filter(|&(_, count)| count != nodes)
    .map(|(what, count)| StructureFinding::CountMismatch { what, count, nodes })
    .collect()
}

fn values(draft: &Draft) -> Vec<StructureFinding> {
    let mut findings = Vec::new();
    for node in 0..draft.positions.len() {
        let (position, axis) = (draft.positions[node], draft.axes[node]);
        let (below, above) = (draft.below[node], draft.above[node]);
        let node = NodeId::new(node);
        let named = [("position", position.coords), ("axis", axis)];
        let vectors = named.iter().flat_map(|(what, v)| v.iter().map(|&x| (*what, x)));
        let all = vectors.chain([("depth", below), ("depth", above)]);
        let wrong = all.clone().find(|(_, value)| !value.is_finite());
        if let Some((what, value)) = wrong {
            findings.push(StructureFinding::NotFinite { node, what, value });
        } else if let Some((what, value)) =
            all.clone().find(|(_, v)| v.abs() > FARTHEST_MM)
        {
            let limit = FARTHEST_MM;
            findings.push(StructureFinding::TooLarge { node, what, value, limit });
        } else if axis.norm() < NO_AXIS {
            findings.push(StructureFinding::ZeroAxis { node });
        } else if below < 0.0 || above < 0.0 || below + above < NO_LENGTH_MM {
            findings.push(StructureFinding::NoDepth { node, below, above });
        }
    }
    findings
}

fn indices(draft: &Draft) -> Vec<StructureFinding> {
    let nodes = draft.positions.len();
    let faces = draft.faces.iter().enumerate();
    let faces = faces.map(|(k, f)| ("face", Some(k), f.as_slice()));
    let fins = draft.fins.iter().flatten().enumerate();
    let fins = fins.map(|(k, f)| ("fin", Some(k), f.as_slice()));
    let strips = draft.strips.iter().flatten().enumerate();
    let strips = strips.map(|(k, s)| ("strip", Some(k), s.as_slice()));
    let fixed = draft.fixed.iter();
    let fixed = fixed.map(|f| ("the list of fixed nodes", None, f.as_slice()));
    faces
        .chain(fins)
        .chain(strips)
        .chain(fixed)
        .flat_map(|(what, index, list)| list.iter().map(move |&node| (what, index, node)))
        .filter(|&(_, _, node)| node >= nodes)
        .map(|(what, index, node)| StructureFinding::IndexOutOfRange {
            what,
            index,
            node: node.into(),
            nodes,
        })
        .collect()
}

/// Faces, edges and fins as a mesh; indices are in range.
pub(super) fn mesh(draft: &Draft, mesh: &Mesh) -> Vec<StructureFinding> {
    [
        faces(draft),
        surface::faults(mesh),
        fins(draft),
        families(draft),
        weld::unjoined(draft),
        pieces(draft),
    ]
    .concat()
}

fn faces(draft: &Draft) -> Vec<StructureFinding> {
    let mut findings = Vec::new();
    let mut seen: BTreeMap<Vec<usize>, FaceId> = BTreeMap::new();
    for (face, corners) in draft.faces.iter().enumerate() {
        let face = FaceId::new(face);
        let mut sorted = corners.clone();
        sorted.sort_unstable();
        let repeated = sorted.windows(2).find(|pair| pair[0] == pair[1]);
        let fault = if corners.len() < 3 {
            Some(FaceFault::TooFewCorners { count: corners.len() })
        } else if let Some(pair) = repeated {
            Some(FaceFault::RepeatedNode { node: pair[0].into() })
        } else {
            let area_mm2 = area_vector(&draft.positions, corners).norm();
            (area_mm2 < NO_LENGTH_MM).then_some(FaceFault::NoArea { area_mm2 })
        };
        if let Some(fault) = fault {
            findings.push(StructureFinding::DegenerateFace { face, fault });
        } else if let Some(first) = seen.insert(sorted, face) {
            findings.push(StructureFinding::DuplicateFace { first, second: face });
        }
    }
    findings
}

fn fins(draft: &Draft) -> Vec<StructureFinding> {
    let mut seen = BTreeSet::new();
    let mut findings = Vec::new();
    for fin in draft.fin_ids() {
        let [i, j] = fin.ends();
        let length = (draft.positions[i] - draft.positions[j]).norm();
        if length < NO_LENGTH_MM {
            findings.push(StructureFinding::ShortFin { fin, length });
        }
        if !seen.insert(fin) {
            findings.push(StructureFinding::DuplicateFin { fin });
        }
    }
    findings
}

fn families(draft: &Draft) -> Vec<StructureFinding> {
    let Some(families) = &draft.families else { return Vec::new() };
    let fins = draft.fin_ids();
    if families.len() != fins.len() {
        let (count, fins) = (families.len(), fins.len());
        return vec![StructureFinding::FamilyCount { count, fins }];
    }
    let bad = |(fin, family): (FinId, &Option<u8>)| {
        let family = family.filter(|family| ![1, 2].contains(family))?;
        Some(StructureFinding::BadFamily { fin, family })
    };
    fins.into_iter().zip(families).filter_map(bad).collect()
}

/// Connected pieces and loose nodes.
fn pieces(draft: &Draft) -> Vec<StructureFinding> {
    let mut pieces = DisjointSets::new(draft.positions.len());
    let mut used = vec![false; draft.positions.len()];
    for fin in draft.fin_ids() {
        let [i, j] = fin.ends();
        used[i] = true;
        used[j] = true;
        pieces.join(i.index(), j.index());
    }
    let (starts, loose): (Vec<usize>, Vec<usize>) =
        pieces.firsts().into_iter().partition(|&node| used[node]);
    let mut findings = Vec::new();
    if let [_, second, ..] = starts[..] {
        let pieces = starts.len();
        findings.push(StructureFinding::Disconnected { pieces, node: second.into() });
    }
    if let Some(&node) = loose.first() {
        let (node, count) = (node.into(), loose.len());
        findings.push(StructureFinding::LooseNode { node, count });
    }
    findings
}

/// Fins and faces as shapes in space.
pub(super) fn shape(
    structure: &Structure,
    tolerance: &Tolerance,
) -> Vec<StructureFinding> {
    let fins = structure.fins().iter();
    let mut findings: Vec<StructureFinding> =
        fins.filter_map(|&fin| fin_shape(structure, fin, tolerance)).collect();
    findings.extend(turned_faces(structure));
    findings
}

fn fin_shape(
    structure: &Structure,
    fin: FinId,
    tolerance: &Tolerance,
) -> Option<StructureFinding> {
    let ends = fin.ends().map(|node| &structure.nodes()[node]);
    let edge = ends[1].position - ends[0].position;
    for (node, end) in fin.ends().into_iter().zip(ends) {
        let angle = trig::atan2(edge.cross(&end.axis).norm(), edge.dot(&end.axis).abs());
        if angle < tolerance.axis_edge_angle {
            return Some(StructureFinding::AxisAlongFin {
                node,
                fin,
                angle_deg: angle.to_degrees(),
                least_deg: tolerance.axis_edge_angle.to_degrees(),
            });
        }
    }
    if edge.cross(&ends[0].axis).dot(&edge.cross(&ends[1].axis)) < 0.0 {
        return Some(StructureFinding::AxesOpposed { fin });
    }
    if let Some(share) = depth_share(ends) {
        let share_percent = share * 100.0;
        return Some(StructureFinding::AxesCrossInFin { fin, share_percent });
    }
    let (off_mm, diameter) = planarity(&structure.corners(fin.ends()));
    let percent = off_mm / diameter * 100.0;
    if off_mm > tolerance.planarity_limit * diameter {
        let limit_percent = tolerance.planarity_limit * 100.0;
        Some(StructureFinding::FinNotPlanar { fin, percent, off_mm, limit_percent })
    } else if off_mm > tolerance.planarity_warn * diameter {
        Some(StructureFinding::FinWarped { fin, percent, off_mm })
    } else {
        None
    }
}

/// The share of its depth at which a fin's axes would stop meeting inside it, or `None`
/// if they do not meet.
fn depth_share([a, b]: [&Node; 2]) -> Option<f64> {
    let edge = b.position - a.position;
    // At height z the fin is edge + z (axis_b - axis_a) wide, as seen along the edge.
    let left = |reach_a: f64, reach_b: f64| {
        let change =
            (b.axis * reach_b - a.axis * reach_a).dot(&edge) / edge.norm_squared();
        (change <= -1.0).then(|| -1.0 / change)
    };
    let shares = [left(a.above, b.above), left(-a.below, -b.below)];
    shares.into_iter().flatten().reduce(f64::min)
}

fn turned_faces(structure: &Structure) -> impl Iterator<Item = StructureFinding> + '_ {
    let positions: Vec<Point3> = structure.nodes().iter().map(|n| n.position).collect();
    let mesh = structure.mesh();
    mesh.faces().filter_map(move |face| {
        let corners = mesh.corners(face);
        let normal = area_vector(&positions, corners);
        let with = corners.iter().map(|&k| structure.nodes()[k].axis.dot(&normal));
        (with.sum::<f64>() < 0.0).then_some(StructureFinding::FaceAgainstAxis { face })
    })
}
