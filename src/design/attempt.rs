//! One attempt at a mesh on a surface: fields, map, extraction.

use crate::design::axes;
use crate::design::directions::{self, Directions, Singular, boundary_turn, singular};
use crate::design::finding::ChainFinding;
use crate::design::map::{self, Failure};
use crate::design::quads::{self, Broken, Quads};
use crate::design::surface::{Foot, Measures, Surface};
use crate::design::wishes::Size;
use crate::geometry::{Point3, Vector3};
use std::collections::BTreeSet;

/// One way of setting up fields and map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Attempt<'a> {
    pub cell: f64,
    /// How many times as long fins of family 1 are as those of family 2.
    pub aspect: f64,
    pub torsal: f64,
    pub even: f64,
    pub align: bool,
    /// Whether fins follow the lines inside the surface.
    pub follow: bool,
    /// Edges at the boundary shorter than this share of a cell are joined.
    pub short: f64,
    /// Where singular vertices have to be; `None`: where they come.
    pub singular: Option<&'a [Singular]>,
}

/// How near the number of nodes comes to that which is wanted, and how often the cells are
/// resized for it.
const NEAR_NODES: f64 = 0.08;
const RESIZINGS: usize = 4;
/// A boundary that turns by more than this, radians, has a corner.
const CORNER: f64 = std::f64::consts::FRAC_PI_4;

/// A mesh on the surface, before fins are made planar.
pub(super) struct Meshed {
    pub quads: Quads,
    pub axes: Vec<Vector3>,
    pub directions: Vec<[Vector3; 2]>,
    /// Length of a fin that was aimed at, mm; of two families the geometric mean.
    pub cell: f64,
    /// Ratio of the lengths in both families that was aimed at.
    pub aspect: f64,
}

/// Why there is no mesh.
pub(super) enum Missed {
    NotDefinite,
    Map(Failure),
    Flipped { count: usize, triangle: usize },
    Mesh(Broken),
}

/// A mesh with as many nodes as are wanted, within a tenth, if their number is.
pub(super) fn sized(
    surface: &Surface,
    measures: &Measures,
    mut attempt: Attempt,
    size: Size,
) -> Result<Meshed, Missed> {
    let mut meshed = meshed(surface, measures, attempt)?;
    let Size::Nodes(wanted) = size else { return Ok(meshed) };
    for _ in 0..RESIZINGS {
        let share = meshed.quads.nodes.len() as f64 / wanted as f64;
        if (share - 1.0).abs() <= NEAR_NODES {
            break;
        }
        attempt.cell *= share.sqrt();
        meshed = self::meshed(surface, measures, attempt)?;
    }
    Ok(meshed)
}

fn meshed(
    surface: &Surface,
    measures: &Measures,
    attempt: Attempt,
) -> Result<Meshed, Missed> {
    let Attempt { cell, aspect, torsal, even, align, follow, short, singular: given } =
        attempt;
    let axes = axes::wanted(surface, measures, cell).map_err(|_| Missed::NotDefinite)?;
    let wish = directions::Wish { cell, torsal, align, follow, singular: given };
    let directions = Directions::of(surface, measures, &axes, &wish)
        .map_err(|_| Missed::NotDefinite)?;
    let singular: Vec<Singular> = singular(surface, measures, &directions);
    let wish = map::Wish { cell, aspect, even, align, follow };
    let map = map::map(surface, measures, &directions, &singular, &wish)
        .map_err(Missed::Map)?;
    if let Some(&triangle) = map.flipped.first() {
        return Err(Missed::Flipped { count: map.flipped.len(), triangle });
    }
    let corners = corners(surface, cell / 2.0);
    let quads = quads::extract(surface, &map, &corners).map_err(Missed::Mesh)?;
    let positions: Vec<Point3> =
        quads.nodes.iter().map(|node| surface.point(foot(node))).collect();
    let quads = quads::tidy(quads, &positions, short * cell);
    let pair = |triangle: usize| {
        let frame = &measures.frames[triangle];
        directions.pair(triangle, 0).map(|d| frame[0] * d.x + frame[1] * d.y)
    };
    let directions = (0..surface.triangles.len()).map(pair).collect();
    Ok(Meshed { quads, axes, directions, cell, aspect: map.aspect })
}

pub(super) fn foot(node: &quads::Node) -> Foot {
    Foot { triangle: node.triangle, shares: node.shares }
}

/// Vertices where the boundary turns, seen over chords of this length; of several near
/// each other the sharpest.
fn corners(surface: &Surface, chord: f64) -> BTreeSet<usize> {
    let mut corners = BTreeSet::new();
    for ring in surface.boundary() {
        let turns: Vec<f64> = (0..ring.len())
            .map(|k| boundary_turn(surface, &ring, [k, k], chord))
            .collect();
        let at = |k: usize| surface.positions[surface.tail(ring[k])];
        for k in (0..ring.len()).filter(|&k| turns[k] > CORNER) {
            let count = ring.len();
            let sharper = |step: usize| {
                let mut other = (k + step) % count;
                while other != k && (at(other) - at(k)).norm() <= chord {
                    // Of two alike the one that comes first along the loop.
                    if turns[other] > turns[k] || (turns[other] >= turns[k] && step == 1)
                    {
                        return true;
                    }
                    other = (other + step) % count;
                }
                false
            };
            if !sharper(1) && !sharper(count - 1) {
                corners.insert(surface.tail(ring[k]));
            }
        }
    }
    corners
}

impl Missed {
    /// As a finding; `cell_mm` is what was wanted.
    pub(super) fn fact(&self, surface: &Surface, cell_mm: f64) -> ChainFinding {
        let place = |triangle: usize| {
            let foot = Foot { triangle, shares: [1.0 / 3.0; 3] };
            let point = surface.point(foot);
            [point.x, point.y, point.z]
        };
        match *self {
            Self::NotDefinite | Self::Map(Failure::NotDefinite) => {
                ChainFinding::NoSolution { triangles: surface.triangles.len() }
            }
            Self::Map(Failure::NoWholeNumbers) => ChainFinding::NoWholeNumbers,
            Self::Map(Failure::TooManyIntegers(count)) => {
                ChainFinding::TooManySingular { count, cell_mm }
            }
            Self::Flipped { count, triangle } => {
                ChainFinding::Folded { count, at: place(triangle), cell_mm }
            }
            Self::Mesh(Broken::Lost { count, triangle }) => {
                ChainFinding::LinesLost { count, at: place(triangle) }
            }
            Self::Mesh(Broken::Euler { found, wanted }) => {
                ChainFinding::HolesLost { found, wanted, cell_mm }
            }
            Self::Mesh(Broken::NoQuads { count }) => ChainFinding::NoQuads { count },
        }
    }
}
