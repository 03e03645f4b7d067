//! A smooth cross in each triangle: the fourth power of its direction, `y = e^{4 i theta}`,
//! by linear least squares (Knöppel, Crane, Pinkall and Schröder 2013, Globally optimal
//! direction fields; here on triangles), then drawn to length one (Viertel and Osting 2019,
//! An approach to quad meshing based on harmonic cross-valued maps).

use crate::design::directions::{Congruence, Wish};
use crate::design::surface::{Measures, Surface};
use crate::geometry::trig;
use crate::sparse::{Cholesky, NotPositiveDefinite, SymmetricMatrix, Triplets};

/// Weight of an aligned boundary.
const BOUNDARY: f64 = 5.0;
/// Weight of the crosses found first, drawn to length one, beside the torsal ones.
const UNIT_LENGTH: f64 = 0.3;
/// A boundary that turns by more than this within a cell, radians, has a corner.
const CORNER: f64 = std::f64::consts::FRAC_PI_4;

/// Angles of the crosses, radians.
pub(super) fn field(
    surface: &Surface,
    measures: &Measures,
    congruence: &Congruence,
    wish: &Wish,
) -> Result<Vec<f64>, NotPositiveDefinite> {
    let count = surface.triangles.len();
    let mean_area = measures.area() / count as f64;
    let torsal = wish.torsal * mean_area / (wish.cell * wish.cell);
    let share = |triangle: usize| torsal * measures.areas[triangle] / mean_area;
    let mut goals: Vec<[f64; 3]> = (0..count)
        .map(|triangle| {
            let weight = share(triangle) * congruence.confidence[triangle];
            goal(weight, congruence.theta[triangle])
        })
        .collect();
    // Parallel axes leave every direction open: then the boundary leads.
    if wish.align || congruence.parallel {
        for (side, turn) in straight_boundary(surface, wish.cell) {
            if turn {
                let more = goal(BOUNDARY, measures.directions[side]);
                (0..3).for_each(|k| goals[side / 3][k] += more[k]);
            }
        }
    }
    if wish.follow {
        for side in surface.lines().into_iter().flat_map(|line| line.sides) {
            for side in [Some(side), surface.twin(side)].into_iter().flatten() {
                let more = goal(BOUNDARY, measures.directions[side]);
                (0..3).for_each(|k| goals[side / 3][k] += more[k]);
            }
        }
    }
    let (matrix, mut crosses) = system(surface, measures, &goals);
    let mut factor = Cholesky::of(&matrix)?;
    factor.solve(&mut crosses);
    for (triangle, y) in crosses.chunks_exact(2).enumerate() {
        let weight = UNIT_LENGTH * share(triangle);
        let more = goal(weight, trig::atan2(y[1], y[0]) / 4.0);
        (0..3).for_each(|k| goals[triangle][k] += more[k]);
    }
    let (matrix, mut crosses) = system(surface, measures, &goals);
    factor.factorise(&matrix)?;
    factor.solve(&mut crosses);
    Ok(crosses.chunks_exact(2).map(|y| trig::atan2(y[1], y[0]) / 4.0).collect())
}

/// A wish for a direction: its weight, and the weight times `y`.
fn goal(weight: f64, theta: f64) -> [f64; 3] {
    [weight, weight * trig::cos(4.0 * theta), weight * trig::sin(4.0 * theta)]
}

/// The equations of smooth crosses near their goals: real and imaginary part of each.
fn system(
    surface: &Surface,
    measures: &Measures,
    goals: &[[f64; 3]],
) -> (SymmetricMatrix, Vec<f64>) {
    let mut system = Triplets::new(2 * goals.len());
    let mut right = vec![0.0; 2 * goals.len()];
    for (triangle, goal) in goals.iter().enumerate() {
        for k in 0..2 {
            let row = 2 * triangle + k;
            system.add([row, row], goal[0] + crate::tolerance::LEAST_GOAL);
            right[row] = goal[1 + k];
        }
    }
    for side in 0..surface.side_count() {
        let Some(twin) = surface.twin(side).filter(|&twin| side < twin) else { continue };
        let (weight, turn) = (measures.couplings[side], 4.0 * measures.transports[side]);
        let (f, g) = (2 * (side / 3), 2 * (twin / 3));
        for k in 0..2 {
            system.add([f + k, f + k], weight);
            system.add([g + k, g + k], weight);
            system.add([g + k, f + k], -weight * trig::cos(turn));
        }
        // Real and imaginary part of y_f e^{i turn} against those of y_g.
        system.add([g, f + 1], weight * trig::sin(turn));
        system.add([g + 1, f], -weight * trig::sin(turn));
    }
    (system.matrix(), right)
}

/// The half-edges of the boundary, each with whether the boundary runs on straight enough
/// there, seen over half a cell to either side.
fn straight_boundary(surface: &Surface, cell: f64) -> Vec<(usize, bool)> {
    let mut sides = Vec::new();
    for ring in surface.boundary() {
        for k in 0..ring.len() {
            let turn =
                boundary_turn(surface, &ring, [k, (k + 1) % ring.len()], cell / 2.0);
            sides.push((ring[k], turn <= CORNER));
        }
    }
    sides
}

/// By how much a boundary loop turns, radians, between chords of this length, one that
/// ends where the `before`-th of its half-edges starts, one that begins where the
/// `after`-th does.
pub(in crate::design) fn boundary_turn(
    surface: &Surface,
    ring: &[usize],
    [before, after]: [usize; 2],
    chord: f64,
) -> f64 {
    let at = |k: usize| surface.positions[surface.tail(ring[k])];
    let count = ring.len();
    let far = |from: usize, step: usize| {
        let mut k = from;
        for _ in 1..count {
            k = (k + step) % count;
            if (at(k) - at(from)).norm() >= chord {
                break;
            }
        }
        at(k)
    };
    let back = at(before) - far(before, count - 1);
    let on = far(after, 1) - at(after);
    trig::atan2(back.cross(&on).norm(), back.dot(&on))
}
