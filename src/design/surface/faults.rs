//! How triangles hang together: alike oriented, in fans, in pieces.

use crate::design::surface::clean::{Piece, Polygons};
use crate::design::surface::{
    NONE, SurfaceFinding, next, previous, sides_by_edge, sides_of,
};
use crate::geometry::{Point3, Vector3};
use crate::structure::area_vector;

/// Triangles that all show the same side.
pub(super) struct Oriented {
    pub triangles: Vec<[usize; 3]>,
    /// Faces of the file that were turned, each once.
    pub turned: Vec<usize>,
}

/// Turns triangles to agree with one another, piece by piece, and each piece with its axes
/// or with what most of its area showed.
pub(super) fn oriented(
    polygons: &Polygons,
    pieces: Vec<Piece>,
) -> Result<Oriented, SurfaceFinding> {
    let mut triangles: Vec<[usize; 3]> = pieces.iter().map(|p| p.corners).collect();
    let place = |vertex: usize| polygons.positions[vertex].coords.into();
    let beside = neighbours(&triangles).map_err(|(edges, ends)| {
        SurfaceFinding::NotManifold { edges, ends, at: place(ends[0]) }
    })?;
    let mut turn: Vec<Option<bool>> = vec![None; triangles.len()];
    for start in 0..triangles.len() {
        if turn[start].is_some() {
            continue;
        }
        let piece = piece(&triangles, &beside, &mut turn, start).map_err(|other| {
            let (face, at) = (pieces[other].face, place(triangles[other][0]));
            SurfaceFinding::OneSided { face, at }
        })?;
        if shows_back(polygons, &triangles, &piece, &turn) {
            piece.iter().for_each(|&t| turn[t] = turn[t].map(|turned| !turned));
        }
    }
    let mut turned = Vec::new();
    for (triangle, turn) in turn.iter().enumerate() {
        if *turn == Some(true) {
            triangles[triangle].swap(1, 2);
            turned.push(pieces[triangle].face);
        }
    }
    turned.dedup();
    Ok(Oriented { triangles, turned })
}

/// The triangles that hang together with one, each told whether it must be turned to agree
/// with it; or the first that cannot agree.
fn piece(
    triangles: &[[usize; 3]],
    beside: &[usize],
    turn: &mut [Option<bool>],
    start: usize,
) -> Result<Vec<usize>, usize> {
    turn[start] = Some(false);
    let (mut piece, mut at) = (vec![start], 0);
    while let Some(&triangle) = piece.get(at) {
        at += 1;
        for side in sides_of(triangle) {
            let other = beside[side];
            if other == NONE {
                continue;
            }
            let tail = |s: usize| triangles[s / 3][s % 3];
            // Two triangles agree if they run along their edge against each other.
            let wanted = turn[triangle].map(|own| own ^ (tail(side) == tail(other)));
            match turn[other / 3] {
                None => {
                    turn[other / 3] = wanted;
                    piece.push(other / 3);
                }
                turned if turned != wanted => return Err(other / 3),
                _ => {}
            }
        }
    }
    Ok(piece)
}

/// Whether a piece, turned as planned, shows the other side than its axes or its area.
fn shows_back(
    polygons: &Polygons,
    triangles: &[[usize; 3]],
    piece: &[usize],
    turn: &[Option<bool>],
) -> bool {
    let share = |&triangle: &usize| {
        let area = area_vector(&polygons.positions, &triangles[triangle]);
        let sign = if turn[triangle] == Some(true) { -1.0 } else { 1.0 };
        let shown = match &polygons.axes {
            Some(axes) => {
                let axis: Vector3 = triangles[triangle].iter().map(|&k| axes[k]).sum();
                axis.dot(&area)
            }
            None => area.norm(),
        };
        sign * shown
    };
    piece.iter().map(share).sum::<f64>() < 0.0
}

/// The half-edge beside each along its edge, whichever way it runs; or how many edges have
/// more than two, and the ends of the first.
fn neighbours(triangles: &[[usize; 3]]) -> Result<Vec<usize>, (usize, [usize; 2])> {
    let sides = sides_by_edge(triangles);
    let mut beside = vec![NONE; 3 * triangles.len()];
    let (mut edges, mut first) = (0, None);
    for along in sides.chunk_by(|a, b| a.0 == b.0) {
        match along {
            [_] => {}
            [a, b] => (beside[a.1], beside[b.1]) = (b.1, a.1),
            _ => {
                edges += 1;
                first = first.or(Some(along[0].0));
            }
        }
    }
    first.map_or(Ok(beside), |ends| Err((edges, ends)))
}

/// Gives every fan but the first of a vertex a vertex of its own; returns how many
/// vertices had several.
pub(super) fn split_fans(polygons: &mut Polygons, triangles: &mut [[usize; 3]]) -> usize {
    let twins = super::twins(triangles);
    let mut seen = vec![false; twins.len()];
    let mut taken = vec![false; polygons.positions.len()];
    let mut split = std::collections::BTreeSet::new();
    for side in 0..twins.len() {
        if seen[side] {
            continue;
        }
        let vertex = triangles[side / 3][side % 3];
        let fan = fan(&twins, side);
        fan.iter().for_each(|&side| seen[side] = true);
        if !std::mem::replace(&mut taken[vertex], true) {
            continue;
        }
        split.insert(vertex);
        let own = polygons.positions.len();
        polygons.positions.push(polygons.positions[vertex]);
        if let Some(axes) = &mut polygons.axes {
            axes.push(axes[vertex]);
        }
        fan.iter().for_each(|&side| triangles[side / 3][side % 3] = own);
    }
    split.len()
}

/// The half-edges that leave a vertex in one fan.
fn fan(twins: &[usize], side: usize) -> Vec<usize> {
    let mut fan = vec![side];
    let mut at = twins[previous(side)];
    while at != NONE && at != side {
        fan.push(at);
        at = twins[previous(at)];
    }
    if at == NONE {
        at = twins[side];
        while at != NONE {
            fan.push(next(at));
            at = twins[next(at)];
        }
    }
    fan
}

/// Triangles that hang together.
pub(super) struct Pieces {
    pub count: usize,
    /// Share of the area in the largest.
    pub largest: f64,
    /// A corner of a piece that is not the largest.
    pub other: Point3,
}

impl Pieces {
    pub(super) fn of(positions: &[Point3], triangles: &[[usize; 3]]) -> Self {
        let twins = super::twins(triangles);
        let mut seen = vec![false; triangles.len()];
        let mut areas = Vec::new();
        for start in 0..triangles.len() {
            if std::mem::replace(&mut seen[start], true) {
                continue;
            }
            let (mut area, mut open) = (0.0, vec![start]);
            while let Some(triangle) = open.pop() {
                area += area_vector(positions, &triangles[triangle]).norm();
                for side in sides_of(triangle) {
                    let twin = twins[side];
                    if twin != NONE && !std::mem::replace(&mut seen[twin / 3], true) {
                        open.push(twin / 3);
                    }
                }
            }
            areas.push((area, positions[triangles[start][0]]));
        }
        let total: f64 = areas.iter().map(|piece| piece.0).sum();
        areas.sort_by(|a, b| b.0.total_cmp(&a.0));
        let largest = areas.first().map_or(0.0, |piece| piece.0 / total);
        let other = areas.get(1).map_or(Point3::origin(), |piece| piece.1);
        Self { count: areas.len(), largest, other }
    }
}
