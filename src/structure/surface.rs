//! Whether the faces make a surface: two to an edge, one side, one fan around a node.

use crate::geometry::Mesh;
use crate::geometry::mesh::OneSided;
use crate::ids::EdgeId;
use crate::structure::finding::StructureFinding;

/// Everything that keeps faces from being an oriented surface, by the numbers of nodes.
pub(super) fn faults(mesh: &Mesh) -> Vec<StructureFinding> {
    let mut edges: Vec<EdgeId> = mesh.edges().collect();
    edges.sort_by_key(|&edge| mesh.ends(edge));
    let crowded = edges.iter().filter_map(|&edge| {
        let fin = mesh.ends(edge).into();
        let count = mesh.half_edges_of(edge).len();
        (count > 2).then_some(StructureFinding::NonManifoldEdge { fin, count })
    });
    let mut findings: Vec<StructureFinding> = crowded.collect();
    match mesh.turned_faces() {
        Err(OneSided { faces: [first, second] }) => {
            findings.push(StructureFinding::NotOrientable { first, second });
        }
        Ok(_) => findings.extend(edges.iter().filter_map(|&edge| {
            let ([first, second], same_way) = mesh.neighbours(edge)?;
            same_way.then_some(StructureFinding::FaceOrientation { first, second })
        })),
    }
    let split = |(node, fans)| StructureFinding::NonManifoldNode { node, fans };
    findings.extend(mesh.non_manifold_nodes().map(split));
    findings
}
