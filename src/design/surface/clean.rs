//! From the faces of a file to a clean surface: weld, cut polygons up, drop what has no
//! area, turn faces alike, keep fans apart.

use crate::design::surface::faults::{Pieces, oriented, split_fans};
use crate::design::surface::{Surface, SurfaceFinding};
use crate::diagnostic::Finding;
use crate::geometry::{Point3, Vector3};
use crate::structure::area_vector;
use crate::tolerance::{NO_AREA, WELD};
use std::collections::BTreeSet;

/// Faces as a file holds them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Polygons {
    /// Vertices, mm.
    pub positions: Vec<Point3>,
    /// Corners of each face, in order.
    pub faces: Vec<Vec<usize>>,
    /// Wanted axes, one per vertex, of any length; `None`: normals.
    pub axes: Option<Vec<Vector3>>,
}

impl Polygons {
    /// As OBJ, with a line of comment.
    pub fn obj(&self, about: &str) -> String {
        let mut text = format!("# {about} (mm)\n");
        for p in &self.positions {
            text.push_str(&format!("v {} {} {}\n", p.x, p.y, p.z));
        }
        for face in &self.faces {
            let corners: Vec<String> = face.iter().map(|k| (k + 1).to_string()).collect();
            text.push_str(&format!("f {}\n", corners.join(" ")));
        }
        text
    }
}

/// A triangle and the face of the file it was cut from.
pub(super) struct Piece {
    pub corners: [usize; 3],
    pub face: usize,
}

/// Makes a clean surface of polygons, and says what was done to them.
///
/// Vertices nearer to each other than a millionth of the whole become one; a polygon of
/// more than four corners is cut from the mean of its corners; faces are turned to agree
/// with the side that most of the area shows, or with the axes where these are given.
///
/// # Errors
/// All faults that must be mended first, with their places.
pub fn clean(polygons: Polygons) -> Result<(Surface, Vec<Finding>), Vec<Finding>> {
    let refuse = |fact: SurfaceFinding| vec![Finding::from(fact)];
    checked(&polygons).map_err(refuse)?;
    let mut findings: Vec<SurfaceFinding> = Vec::new();
    let (mut polygons, joined) = welded(polygons);
    if joined > 0 {
        findings.push(SurfaceFinding::VerticesJoined { count: joined });
    }
    let pieces = triangulated(&mut polygons);
    let (pieces, flat) = with_area(&polygons.positions, pieces);
    if let Some(&face) = flat.first() {
        findings.push(SurfaceFinding::FacesWithoutArea { count: flat.len(), face });
    }
    if pieces.is_empty() {
        return Err(refuse(SurfaceFinding::NoArea));
    }
    let mut oriented = oriented(&polygons, pieces).map_err(refuse)?;
    if let Some(&face) = oriented.turned.first() {
        let count = oriented.turned.len();
        findings.push(SurfaceFinding::FacesTurned { count, face });
    }
    let split = split_fans(&mut polygons, &mut oriented.triangles);
    if split > 0 {
        findings.push(SurfaceFinding::FansSplit { count: split });
    }
    let pieces = Pieces::of(&polygons.positions, &oriented.triangles);
    if pieces.count > 1 {
        let (count, at) = (pieces.count, pieces.other.coords.into());
        let percent = 100.0 * pieces.largest;
        return Err(refuse(SurfaceFinding::SeveralPieces { pieces: count, percent, at }));
    }
    let surface = compact(polygons, oriented.triangles).without_ears();
    let folds: Vec<usize> = surface.folds().collect();
    if let Some(&side) = folds.first() {
        let at = surface.positions[surface.tail(side)].coords.into();
        findings.push(SurfaceFinding::Folded { edges: folds.len(), at });
    }
    Ok((surface, findings.into_iter().map(Finding::from).collect()))
}

fn checked(polygons: &Polygons) -> Result<(), SurfaceFinding> {
    let vertices = polygons.positions.len();
    for (face, corners) in polygons.faces.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&vertex| vertex >= vertices) {
            return Err(SurfaceFinding::NoSuchVertex { face, vertex, vertices });
        }
    }
    let numbers = |p: &Point3| p.iter().all(|x| x.is_finite());
    let axes = polygons.axes.iter().flatten();
    let bad = polygons.positions.iter().position(|p| !numbers(p));
    let bad_axis = || axes.clone().position(|axis| axis.iter().any(|x| !x.is_finite()));
    bad.or_else(bad_axis)
        .map_or(Ok(()), |vertex| Err(SurfaceFinding::NoNumber { vertex }))
}

/// Joins vertices that lie on one another; each keeps the first number.
fn welded(mut polygons: Polygons) -> (Polygons, usize) {
    let positions = &polygons.positions;
    let reach = WELD * diagonal(positions);
    let mut order: Vec<usize> = (0..positions.len()).collect();
    order.sort_by(|&a, &b| positions[a].x.total_cmp(&positions[b].x).then(a.cmp(&b)));
    let mut same: Vec<usize> = (0..positions.len()).collect();
    for (k, &a) in order.iter().enumerate() {
        let near = order[k + 1..].iter();
        for &b in near.take_while(|&&b| positions[b].x - positions[a].x <= reach) {
            if (positions[a] - positions[b]).norm() <= reach {
                let (a, b) = (root(&same, a), root(&same, b));
                same[a.max(b)] = a.min(b);
            }
        }
    }
    let joined = (0..same.len()).filter(|&k| same[k] != k).count();
    for corner in polygons.faces.iter_mut().flatten() {
        *corner = root(&same, *corner);
    }
    if let Some(axes) = &mut polygons.axes {
        for k in 0..same.len() {
            if same[k] != k {
                let axis = axes[k];
                axes[root(&same, k)] += axis;
            }
        }
    }
    (polygons, joined)
}

fn root(same: &[usize], mut at: usize) -> usize {
    while same[at] != at {
        at = same[at];
    }
    at
}

/// Length of the diagonal of the box around points.
pub(super) fn diagonal(positions: &[Point3]) -> f64 {
    let extent = |k: usize| {
        let along = || positions.iter().map(|p| p[k]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    Vector3::new(extent(0), extent(1), extent(2)).norm()
}

/// Cuts faces into triangles: quads along the shorter diagonal, larger ones from their
/// middle, which becomes a vertex.
fn triangulated(polygons: &mut Polygons) -> Vec<Piece> {
    let mut pieces = Vec::with_capacity(polygons.faces.len());
    for (face, corners) in polygons.faces.iter().enumerate() {
        let mut ring: Vec<usize> = corners.clone();
        ring.dedup();
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        let mut push = |corners: [usize; 3]| pieces.push(Piece { corners, face });
        match ring[..] {
            [] | [_] | [_, _] => push([0; 3]),
            [a, b, c] => push([a, b, c]),
            [a, b, c, d] => {
                let p = |k: usize| polygons.positions[k];
                let cuts = if (p(a) - p(c)).norm() <= (p(b) - p(d)).norm() {
                    [[a, b, c], [a, c, d]]
                } else {
                    [[a, b, d], [b, c, d]]
                };
                cuts.into_iter().for_each(push);
            }
            _ => {
                let middle = polygons.positions.len();
                let points = ring.iter().map(|&k| polygons.positions[k].coords);
                let sum: Vector3 = points.sum();
                polygons.positions.push(Point3::from(sum / ring.len() as f64));
                if let Some(axes) = &mut polygons.axes {
                    axes.push(ring.iter().map(|&k| axes[k]).sum());
                }
                let next = ring.iter().cycle().skip(1);
                ring.iter().zip(next).for_each(|(&a, &b)| push([a, b, middle]));
            }
        }
    }
    pieces
}

/// Leaves out triangles without area and repeated ones; returns the faces they were of.
fn with_area(positions: &[Point3], pieces: Vec<Piece>) -> (Vec<Piece>, Vec<usize>) {
    let least = NO_AREA * diagonal(positions).powi(2);
    let mut seen = BTreeSet::new();
    let mut flat = Vec::new();
    let kept = pieces.into_iter().filter(|piece| {
        let mut key = piece.corners;
        key.sort_unstable();
        let area = area_vector(positions, &piece.corners).norm();
        let keep = area > least && seen.insert(key);
        if !keep {
            flat.push(piece.face);
        }
        keep
    });
    (kept.collect(), flat)
}

/// Numbers vertices as they first appear in triangles, so that it does not matter in what
/// format they came, drops those without a face, and makes axes unit vectors.
fn compact(polygons: Polygons, mut triangles: Vec<[usize; 3]>) -> Surface {
    let mut number = vec![None; polygons.positions.len()];
    let mut kept = Vec::new();
    for corner in triangles.iter_mut().flatten() {
        let vertex = *corner;
        *corner = *number[vertex].get_or_insert_with(|| {
            kept.push(vertex);
            kept.len() - 1
        });
    }
    let unit = |axis: Vector3| axis.try_normalize(0.0).unwrap_or(Vector3::z());
    let axes = polygons.axes.map(|axes| kept.iter().map(|&k| unit(axes[k])).collect());
    let positions = kept.iter().map(|&k| polygons.positions[k]).collect();
    Surface::new(positions, triangles, axes)
}
