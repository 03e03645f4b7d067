//! The seamless map: two functions on the surface, cut open, whose whole values are the two
//! families of fins.
//!
//! Across a cut the map turns by quarters and moves by whole numbers, singular vertices and
//! aligned pieces of the boundary lie on whole numbers, so that lines run on over every cut
//! (Bommes, Zimmer and Kobbelt 2009, Mixed-integer quadrangulation). Coordinates of the
//! result are exact: multiples of [`UNIT`]⁻¹.

mod arcs;
mod copies;
mod cut;
mod forms;
mod integers;
mod poisson;

pub(super) use cut::Cut;

use crate::design::directions::{Directions, Singular};
use crate::design::surface::{Line, Measures, Surface};
use crate::geometry::{Vector2, Vector3};
use crate::sparse::NotPositiveDefinite;
use copies::Copies;
use poisson::{Poisson, Spacing};

/// Steps of a coordinate between two lines.
pub(super) const UNIT: i64 = 1 << 20;

/// Times that triangles which are turned over may be stiffened.
const STIFFENINGS: usize = 8;
const STIFFER_AROUND: f64 = 2.0;
const STIFFER: f64 = 4.0;

/// How a map is sought.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Wish {
    /// Wanted length of a fin, mm; of two families the geometric mean.
    pub cell: f64,
    /// How many times as long fins of family 1 are as those of family 2.
    pub aspect: f64,
    /// How much even spacing weighs beside true directions.
    pub even: f64,
    /// Whether lines run along the boundary.
    pub align: bool,
    /// Whether they run along the lines inside.
    pub follow: bool,
}

/// A seamless map.
#[derive(Debug, Clone)]
pub(super) struct Map {
    /// Where each corner (half-edge) of each triangle lies, in steps of [`UNIT`]⁻¹.
    pub corners: Vec<[i64; 2]>,
    /// How the surface was cut.
    pub cut: Cut,
    /// Triangles that are turned over or have no area in the map.
    pub flipped: Vec<usize>,
    /// Ratio of the lengths in both families: 1 where they cannot be told apart.
    pub aspect: f64,
}

/// Why there is no map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Failure {
    /// A system of equations could not be factored.
    NotDefinite,
    /// The conditions at cuts or boundaries have no whole solution.
    NoWholeNumbers,
    /// There is more to be rounded than can be.
    TooManyIntegers(usize),
}

impl From<NotPositiveDefinite> for Failure {
    fn from(_: NotPositiveDefinite) -> Self {
        Self::NotDefinite
    }
}

/// Most whole numbers that are rounded.
const MOST_INTEGERS: usize = 300;

/// Finds a map whose lines follow the directions.
///
/// # Errors
/// [`Failure`] if there is none; a map with flipped triangles is none either, but is
/// returned.
pub(super) fn map(
    surface: &Surface,
    measures: &Measures,
    directions: &Directions,
    singular: &[Singular],
    wish: &Wish,
) -> Result<Map, Failure> {
    let cut = Cut::of(surface, measures, directions, singular);
    let mut lines = if wish.follow { surface.lines() } else { Vec::new() };
    if wish.align {
        let rings = surface.boundary().into_iter();
        lines.extend(rings.map(|sides| Line { sides, closed: true }));
    }
    let arcs = arcs::arcs(surface, measures, directions, &cut, &lines);
    let copies = Copies::of(surface, &cut, singular, &arcs)?;
    if copies.integers > MOST_INTEGERS {
        return Err(Failure::TooManyIntegers(copies.integers));
    }
    let pairs: Vec<[Vector2; 2]> =
        (0..surface.triangles.len()).map(|k| directions.pair(k, cut.turns[k])).collect();
    // Over an odd number of quarters the families swap.
    let apart = cut.quarters.iter().all(|quarters| quarters % 2 == 0);
    let aspect = if apart { wish.aspect } else { 1.0 };
    let cells = cells(surface, measures, &pairs, wish.cell, aspect);
    let spacing = Spacing { cells, even: wish.even };
    let mut poisson = Poisson::new(surface, measures, pairs, &copies, spacing);
    poisson.factor()?;
    poisson.space()?;
    let mut whole = integers::rounded(&poisson.schur, &poisson.pull);
    integers::repaired(&poisson, &mut whole);
    let mut map = exact(&copies, &poisson.solution(&whole), &whole);
    for _ in 0..STIFFENINGS {
        let flipped = flipped(&map);
        if flipped.is_empty() {
            break;
        }
        poisson.stiffen(&flipped, STIFFER_AROUND, STIFFER);
        poisson.factor()?;
        integers::repaired(&poisson, &mut whole);
        map = exact(&copies, &poisson.solution(&whole), &whole);
    }
    let flipped = flipped(&map);
    Ok(Map { corners: map, cut, flipped, aspect })
}

/// Wanted lengths of fins along both directions: family 1 is that which runs the more along
/// the surface's longest extent.
fn cells(
    surface: &Surface,
    measures: &Measures,
    pairs: &[[Vector2; 2]],
    cell: f64,
    aspect: f64,
) -> [f64; 2] {
    let count = surface.positions.len() as f64;
    let middle = surface.positions.iter().map(|p| p.coords / count).sum::<Vector3>();
    let spread = surface.positions.iter().map(|p| p.coords - middle);
    let spread: nalgebra::Matrix3<f64> = spread.map(|p| p * p.transpose()).sum();
    let mut along = [0.0; 2];
    for (triangle, pair) in pairs.iter().enumerate() {
        let [x, y, _] = measures.frames[triangle];
        for (along, d) in along.iter_mut().zip(pair) {
            let d = x * d.x + y * d.y;
            *along += measures.areas[triangle] * d.dot(&(spread * d));
        }
    }
    let [first, second] = [cell * aspect.sqrt(), cell / aspect.sqrt()];
    if along[0] >= along[1] { [first, second] } else { [second, first] }
}

/// Exact coordinates of all corners. Every free coordinate becomes an odd number of steps,
/// so that no line of the map meets a vertex that is not meant to lie on it.
fn exact(copies: &Copies, continuous: &[f64], whole: &[i64]) -> Vec<[i64; 2]> {
    let odd = |x: f64| 2 * ((x * UNIT as f64 - 1.0) / 2.0).round() as i64 + 1;
    let free: Vec<i64> = continuous.iter().map(|&x| odd(x)).collect();
    let value = |term: &copies::Term| match term.unknown {
        copies::Unknown::Continuous(k) => term.factor * free[k],
        copies::Unknown::Integer(k) => term.factor * whole[k] * UNIT,
    };
    let of_copy: Vec<[i64; 2]> = copies
        .forms
        .iter()
        .map(|form| form.each_ref().map(|terms| terms.iter().map(value).sum()))
        .collect();
    copies.of_corner.iter().map(|&copy| of_copy[copy]).collect()
}

/// Triangles that do not lie counter-clockwise in the map.
fn flipped(corners: &[[i64; 2]]) -> Vec<usize> {
    let triangles = corners.chunks_exact(3).enumerate();
    let bad =
        triangles.filter(|(_, corners)| side(corners[0], corners[1], corners[2]) <= 0);
    bad.map(|(triangle, _)| triangle).collect()
}

/// Twice the signed area of a triangle, exactly: above 0 if it is counter-clockwise.
pub(super) fn side(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i128 {
    cross([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]])
}

/// The cross product, exactly.
pub(super) fn cross(a: [i64; 2], b: [i64; 2]) -> i128 {
    i128::from(a[0]) * i128::from(b[1]) - i128::from(a[1]) * i128::from(b[0])
}

/// A vector turned counter-clockwise by quarters.
pub(super) fn turned([x, y]: [i64; 2], quarters: i32) -> [i64; 2] {
    match quarters.rem_euclid(4) {
        0 => [x, y],
        1 => [-y, x],
        2 => [-x, -y],
        _ => [y, -x],
    }
}
