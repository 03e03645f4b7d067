//! Whether the faces make a surface: two to an edge, one side, one fan around a node.

use crate::geometry::Mesh;
use crate::geometry::mesh::OneSided;
use crate::ids::{EdgeId, FaceId, NodeId};
use crate::structure::finding::StructureFinding;

/// Everything that keeps faces from being an oriented surface, by the numbers of nodes.
pub(super) fn faults(mesh: &Mesh) -> Vec<StructureFinding> {
    let mut edges: Vec<EdgeId> = mesh.edges().collect();
    edges.sort_by_key(|&edge| mesh.ends(edge));
    let crowded = edges.iter().filter_map(|&edge| {
        let fin = mesh.ends(edge).map(NodeId::index);
        let count = mesh.half_edges_of(edge).len();
        (count > 2).then_some(StructureFinding::NonManifoldEdge { fin, count })
    });
    let mut findings: Vec<StructureFinding> = crowded.collect();
    match mesh.turned_faces() {
        Err(OneSided { faces }) => {
            let [first, second] = faces.map(FaceId::index);
            findings.push(StructureFinding::NotOrientable { first, second });
        }
        Ok(_) => findings.extend(edges.iter().filter_map(|&edge| {
            let (faces, same_way) = mesh.neighbours(edge)?;
            let [first, second] = faces.map(FaceId::index);
            same_way.then_some(StructureFinding::FaceOrientation { first, second })
        })),
    }
    let nodes = mesh.non_manifold_nodes();
    findings.extend(nodes.map(|(node, fans)| {
        let node = node.index();
        StructureFinding::NonManifoldNode { node, fans }
    }));
    findings
}
