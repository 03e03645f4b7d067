//! Whether the faces make a surface: two to an edge, one side, one fan around a node.

use crate::structure::draft::face_edges;
use crate::structure::finding::StructureFinding;
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Two faces that share an edge, and whether they run the same way along it.
struct Meeting {
    faces: [usize; 2],
    same_way: bool,
}

/// Everything that keeps faces from being an oriented surface.
pub(super) fn faults(faces: &[Vec<usize>]) -> Vec<StructureFinding> {
    let mut uses: BTreeMap<[usize; 2], Vec<(usize, bool)>> = BTreeMap::new();
    for (face, corners) in faces.iter().enumerate() {
        for (i, j) in face_edges(corners) {
            uses.entry([i.min(j), i.max(j)]).or_default().push((face, i < j));
        }
    }
    let mut findings = Vec::new();
    let mut meetings = Vec::new();
    for (fin, faces) in uses {
        match faces.as_slice() {
            [(first, a), (second, b)] if first != second => {
                meetings.push(Meeting { faces: [*first, *second], same_way: a == b });
            }
            [] | [_] | [_, _] => {}
            more => {
                let count = more.len();
                findings.push(StructureFinding::NonManifoldEdge { fin, count });
            }
        }
    }
    findings.extend(turned(faces.len(), &meetings));
    findings.extend(fans(faces));
    findings
}

/// Neighbours that run the same way along their edge; or, if no turning of faces would
/// mend that, the first two that cannot agree.
fn turned(faces: usize, meetings: &[Meeting]) -> Vec<StructureFinding> {
    if let Some([first, second]) = disagreement(faces, meetings) {
        return vec![StructureFinding::NotOrientable { first, second }];
    }
    let wrong = meetings.iter().filter(|meeting| meeting.same_way);
    wrong
        .map(|meeting| StructureFinding::FaceOrientation {
            first: meeting.faces[0],
            second: meeting.faces[1],
        })
        .collect()
}

/// Walks from face to face and turns each to agree with the one before.
fn disagreement(faces: usize, meetings: &[Meeting]) -> Option<[usize; 2]> {
    let mut around = vec![Vec::new(); faces];
    for meeting in meetings {
        let [a, b] = meeting.faces;
        around[a].push((b, meeting.same_way));
        around[b].push((a, meeting.same_way));
    }
    let mut turned: Vec<Option<bool>> = vec![None; faces];
    for start in 0..faces {
        if turned[start].is_some() {
            continue;
        }
        turned[start] = Some(false);
        let mut queue = VecDeque::from([(start, false)]);
        while let Some((face, is_turned)) = queue.pop_front() {
            for &(other, same_way) in &around[face] {
                match turned[other] {
                    None => {
                        turned[other] = Some(is_turned != same_way);
                        queue.push_back((other, is_turned != same_way));
                    }
                    Some(before) if before != (is_turned != same_way) => {
                        return Some([face.min(other), face.max(other)]);
                    }
                    Some(_) => {}
                }
            }
        }
    }
    None
}

/// Nodes around which the faces are not one fan.
fn fans(faces: &[Vec<usize>]) -> Vec<StructureFinding> {
    let mut around: BTreeMap<usize, Vec<BTreeSet<usize>>> = BTreeMap::new();
    for face in faces {
        let count = face.len();
        for (k, &node) in face.iter().enumerate() {
            let beside = [face[(k + count - 1) % count], face[(k + 1) % count]];
            let fans = around.entry(node).or_default();
            let (mut joined, rest): (Vec<_>, Vec<_>) = fans
                .drain(..)
                .partition(|fan| beside.iter().any(|other| fan.contains(other)));
            joined.push(BTreeSet::from(beside));
            *fans = rest;
            fans.push(joined.into_iter().flatten().collect());
        }
    }
    let split = around.into_iter().filter(|(_, fans)| fans.len() > 1);
    split
        .map(|(node, fans)| StructureFinding::NonManifoldNode { node, fans: fans.len() })
        .collect()
}
