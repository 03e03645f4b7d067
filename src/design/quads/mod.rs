//! From a seamless map to a mesh: nodes where lines meet, faces between them.
//!
//! All decisions are made on whole numbers (after Ebke, Bommes, Campen and Kobbelt 2013,
//! QEx: robust quad mesh extraction): lines leave each node by *ports*, are followed
//! through triangles to the next node or to the boundary, and faces are read off the order
//! of lines around nodes alone. What has to hold of the result is checked always.

mod chart;
mod faces;
mod nodes;
mod ring;
mod tidy;
mod trace;

pub(super) use tidy::tidy;

use crate::design::map::Map;
use crate::design::surface::Surface;
use chart::Charts;
use std::collections::BTreeSet;

/// Where a node lies, and how it came to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Node {
    /// A triangle that holds it.
    pub triangle: usize,
    /// Shares of the triangle's corners.
    pub shares: [f64; 3],
    /// The vertex on which it lies.
    pub vertex: Option<usize>,
    pub rank: Rank,
}

/// What a node has to keep when others are joined with it, most last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Rank {
    Inner,
    Boundary,
    Corner,
}

/// A mesh of quads, but for polygons along a boundary that was not aligned.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Quads {
    pub nodes: Vec<Node>,
    pub faces: Vec<Vec<usize>>,
}

/// What does not hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Broken {
    /// Lines that meet no other, and the triangle where the first was lost.
    Lost { count: usize, triangle: usize },
    /// Nodes − edges + faces, and that of the surface.
    Euler { found: i64, wanted: i64 },
    /// Faces inside that are no quads.
    NoQuads { count: usize },
}

/// Extracts the mesh of a map without flipped triangles. `corners` are vertices where the
/// boundary turns.
pub(super) fn extract(
    surface: &Surface,
    map: &Map,
    corners: &BTreeSet<usize>,
) -> Result<Quads, Broken> {
    let charts = Charts { surface, map };
    let mut net = nodes::net(&charts);
    let stops = trace::pair(&charts, &mut net)?;
    let rings = ring::rings(&charts, &mut net, stops, corners);
    let mesh = faces::faces(&net, &rings);
    let euler = net.nodes.len() as i64 - mesh.edges as i64 + mesh.faces.len() as i64;
    if euler != surface.euler() {
        return Err(Broken::Euler { found: euler, wanted: surface.euler() });
    }
    if mesh.no_quads > 0 {
        return Err(Broken::NoQuads { count: mesh.no_quads });
    }
    let nodes = net.nodes.iter().map(|node| node.place).collect();
    Ok(Quads { nodes, faces: mesh.faces })
}

/// The directed sides of a face.
pub(super) fn sides(face: &[usize]) -> impl Iterator<Item = (usize, usize)> + '_ {
    face.iter().zip(face.iter().cycle().skip(1)).map(|(&a, &b)| (a, b))
}
