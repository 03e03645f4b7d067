//! The given mesh as a surface to stay close to: feet of points on it and on its boundary.
//!
//! A face of more than three corners is a fan of triangles around the mean of its corners,
//! so that nothing depends on the corner it starts with. Feet are sought near the node that
//! moves: on faces two rings around it, on the boundary three edges to either side, on
//! every loop alike.

use crate::geometry::{Mesh, Point3, Vector3};
use crate::ids::{FaceId, NodeId};
use crate::structure::area_vector;

/// Boundary edges to either side of a node among which its foot is sought.
const REACH: usize = 3;

/// The given mesh with smooth normals.
pub(super) struct Surface {
    patches: Vec<Patch>,
    /// Faces within two rings of each node.
    near: Vec<Vec<FaceId>>,
    /// Boundary edges near each boundary node.
    rim: Vec<Vec<Segment>>,
    normals: Vec<Vector3>,
}

/// A face as triangles, in a ball.
struct Patch {
    centre: Point3,
    radius: f64,
    triangles: Vec<[Corner; 3]>,
}

/// A point with the unit normal there.
#[derive(Debug, Clone, Copy)]
struct Corner {
    point: Point3,
    normal: Vector3,
}

/// A boundary edge with the unit tangents of the curve at its ends.
#[derive(Debug, Clone, Copy)]
struct Segment {
    ends: [Point3; 2],
    tangents: [Vector3; 2],
}

/// Where a point comes down on the surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot {
    /// The nearest point.
    pub point: Point3,
    /// Unit normal there, interpolated between those of nodes.
    pub normal: Vector3,
}

impl Surface {
    /// The surface of a mesh with nodes at these positions. `corners` are nodes where its
    /// boundary turns.
    pub(super) fn new(mesh: &Mesh, positions: &[Point3], corners: &[bool]) -> Self {
        let area = |face| area_vector(positions, mesh.corners(face));
        let areas: Vec<Vector3> = mesh.faces().map(area).collect();
        let normal = |node| unit(mesh.faces_at(node).map(|face| areas[face]).sum());
        let normals: Vec<Vector3> = mesh.nodes().map(normal).collect();
        let patches = mesh.faces().map(|face| {
            let corner = |&k: &NodeId| Corner { point: positions[k], normal: normals[k] };
            let corners: Vec<Corner> = mesh.corners(face).iter().map(corner).collect();
            Patch::new(&corners, unit(areas[face]))
        });
        let rim = rim(mesh, positions, corners);
        Self { patches: patches.collect(), near: near(mesh), rim, normals }
    }

    /// The same with node `order[k]` as the `k`-th; faces keep their numbers.
    pub(super) fn renumbered(mut self, order: &[usize]) -> Self {
        let near = order.iter().map(|&node| std::mem::take(&mut self.near[node]));
        let rim = order.iter().map(|&node| std::mem::take(&mut self.rim[node]));
        Self {
            near: near.collect(),
            rim: rim.collect(),
            normals: order.iter().map(|&node| self.normals[node]).collect(),
            patches: self.patches,
        }
    }

    /// Unit normal at a node.
    pub(super) fn normal(&self, node: usize) -> Vector3 {
        self.normals[node]
    }

    /// The foot of a point that belongs to `node`; `None` for a node without faces.
    pub(super) fn foot(&self, node: usize, point: Point3) -> Option<Foot> {
        let (mut nearest, mut best) = (f64::INFINITY, None);
        for &face in &self.near[node] {
            let patch = &self.patches[face];
            let least = ((point - patch.centre).norm() - patch.radius).max(0.0);
            if least * least > nearest {
                continue;
            }
            for triangle in &patch.triangles {
                let foot = foot_on(triangle, point);
                let square = (point - foot.point).norm_squared();
                // A triangle without area gives no number and is passed over.
                if square < nearest {
                    (nearest, best) = (square, Some(foot));
                }
            }
        }
        best.map(|foot| Foot { normal: unit(foot.normal), ..foot })
    }

    /// The foot of a point that belongs to a boundary node on the boundary, with the unit
    /// tangent there.
    pub(super) fn boundary_foot(
        &self,
        node: usize,
        point: Point3,
    ) -> Option<(Point3, Vector3)> {
        let feet = self.rim[node].iter().map(|segment| {
            let [a, b] = segment.ends;
            let along = b - a;
            let share = (point - a).dot(&along) / along.norm_squared();
            let share = share.clamp(0.0, 1.0);
            let [from, to] = segment.tangents;
            let foot = a + along * share;
            ((point - foot).norm_squared(), foot, from * (1.0 - share) + to * share)
        });
        feet.reduce(|best, foot| if foot.0 < best.0 { foot } else { best })
            .map(|(_, foot, tangent)| (foot, unit(tangent)))
    }
}

impl Patch {
    fn new(corners: &[Corner], normal: Vector3) -> Self {
        let sum: Vector3 = corners.iter().map(|c| c.point.coords).sum();
        let centre = Point3::from(sum / corners.len() as f64);
        let radius =
            corners.iter().map(|c| (c.point - centre).norm()).fold(0.0, f64::max);
        let triangles = match corners {
            &[a, b, c] => vec![[a, b, c]],
            _ => {
                let middle = Corner { point: centre, normal };
                let next = corners.iter().cycle().skip(1);
                corners.iter().zip(next).map(|(&a, &b)| [a, b, middle]).collect()
            }
        };
        Self { centre, radius, triangles }
    }
}

/// A vector of length one, or zero if it has no direction.
pub(super) fn unit(v: Vector3) -> Vector3 {
    let length = v.norm();
    if length > 0.0 { v / length } else { v }
}

fn near(mesh: &Mesh) -> Vec<Vec<FaceId>> {
    mesh.nodes()
        .map(|node| {
            // The node's own faces first: the foot is nearly always there.
            let mut faces: Vec<FaceId> = mesh.faces_at(node).collect();
            let own = faces.len();
            faces.extend(mesh.ring(node).into_iter().flat_map(|k| mesh.faces_at(k)));
            faces[own..].sort_unstable();
            let mut seen = Vec::with_capacity(faces.len());
            for face in faces {
                if seen.last() != Some(&face)
                    && !seen[..own.min(seen.len())].contains(&face)
                {
                    seen.push(face);
                }
            }
            seen
        })
        .collect()
}

/// The neighbours of a boundary node on the boundary: the next, faces to the left, and the
/// one before.
pub(super) fn rim_beside(mesh: &Mesh, node: NodeId) -> Option<[NodeId; 2]> {
    let [out, back] = mesh.boundary_at(node)?;
    Some([mesh.tip(out), mesh.tail(back)])
}

fn rim(mesh: &Mesh, positions: &[Point3], corners: &[bool]) -> Vec<Vec<Segment>> {
    let forward = |node: NodeId| {
        rim_beside(mesh, node).map(|[next, _]| unit(positions[next] - positions[node]))
    };
    let backward = |node: NodeId| {
        rim_beside(mesh, node).map(|[_, last]| unit(positions[node] - positions[last]))
    };
    // At a corner each side keeps its own direction.
    let tangent = |node: NodeId, own: Vector3| match (forward(node), backward(node)) {
        (Some(a), Some(b)) if !corners[node] => unit(a + b),
        _ => own,
    };
    let segment = |from: NodeId, to: NodeId| {
        let own = unit(positions[to] - positions[from]);
        Segment {
            ends: [positions[from], positions[to]],
            tangents: [tangent(from, own), tangent(to, own)],
        }
    };
    mesh.nodes()
        .map(|node| {
            let mut segments = Vec::new();
            for side in [0, 1] {
                let mut at = node;
                for _ in 0..REACH {
                    let Some(rim) = rim_beside(mesh, at) else { break };
                    let to = rim[side];
                    segments.push(if side == 0 {
                        segment(at, to)
                    } else {
                        segment(to, at)
                    });
                    at = to;
                }
            }
            segments
        })
        .collect()
}

/// Nearest point of a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
fn foot_on(corners: &[Corner; 3], p: Point3) -> Foot {
    let [u, v, w] = shares(&corners.map(|corner| corner.point), p);
    let [a, b, c] = corners;
    Foot {
        point: Point3::from(a.point.coords * u + b.point.coords * v + c.point.coords * w),
        normal: a.normal * u + b.normal * v + c.normal * w,
    }
}

/// Barycentric coordinates of the triangle's point nearest to `p`.
pub(in crate::design) fn shares(&[a, b, c]: &[Point3; 3], p: Point3) -> [f64; 3] {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(&(p - a)), ac.dot(&(p - a)));
    let (d3, d4) = (ab.dot(&(p - b)), ac.dot(&(p - b)));
    let (d5, d6) = (ab.dot(&(p - c)), ac.dot(&(p - c)));
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if d1 <= 0.0 && d2 <= 0.0 {
        [1.0, 0.0, 0.0]
    } else if d3 >= 0.0 && d4 <= d3 {
        [0.0, 1.0, 0.0]
    } else if d6 >= 0.0 && d5 <= d6 {
        [0.0, 0.0, 1.0]
    } else if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let share = d1 / (d1 - d3);
        [1.0 - share, share, 0.0]
    } else if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let share = d2 / (d2 - d6);
        [1.0 - share, 0.0, share]
    } else if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        [0.0, 1.0 - share, share]
    } else {
        let sum = va + vb + vc;
        [va / sum, vb / sum, vc / sum]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn feet_on_a_triangle_are_the_nearest_points() {
        let corners =
            [Point3::origin(), Point3::new(2.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0)];
        let at = |p: Point3| {
            let [u, v, w] = shares(&corners, p);
            let [a, b, c] = corners.map(|c| c.coords);
            a * u + b * v + c * w
        };
        assert!(
            (at(Point3::new(0.5, 0.3, 7.0)) - Vector3::new(0.5, 0.3, 0.0)).norm() < 1e-15
        );
        assert!((at(Point3::new(1.0, -3.0, 1.0)) - Vector3::x()).norm() < 1e-15);
        assert!((at(Point3::new(-1.0, 9.0, 0.0)) - Vector3::y()).norm() < 1e-15);
        let across = at(Point3::new(2.0, 2.0, 0.0));
        assert!((across - Vector3::new(1.2, 0.4, 0.0)).norm() < 1e-15);
    }
}
