//! Structures of our own. The vault is planarised; the others have planar fins by
//! construction.
//!
//! *Parallel nets* (Combescure transforms): if the axes form a net whose edges are parallel
//! to those of the base mesh, each fin is a trapezoid. *Revolution*: the normals of a
//! surface of revolution meet along meridians and parallels. *Radial axes*: axes through
//! one point span a plane with any edge.

use crate::geometry::{Point3, Vector3, trig};
use crate::structure::{AxisRule, Draft, read_json};
use std::f64::consts::PI;

/// An embedded structure.
pub struct Example {
    /// Name for `finwright example write`.
    pub name: &'static str,
    /// One line on what it is.
    pub about: &'static str,
    /// Makes it.
    pub draft: fn() -> Draft,
}

/// All embedded structures, the default one first.
pub const ALL: [Example; 6] = [
    Example {
        name: "vault",
        about: "three vaults with valleys between, over a courtyard; the default",
        draft: vault,
    },
    Example {
        name: "dome",
        about: "surface of revolution with its normals, open at the top ring",
        draft: dome,
    },
    Example {
        name: "sphere-patch",
        about: "patch of a sphere with radial axes",
        draft: sphere_patch,
    },
    Example {
        name: "facade",
        about: "flat facade whose axes turn freely across it",
        draft: facade,
    },
    Example {
        name: "five",
        about: "patch around an inner node with five fins, radial axes",
        draft: || star("five", 5),
    },
    Example {
        name: "three",
        about: "patch around an inner node with three fins, radial axes",
        draft: || star("three", 3),
    },
];

/// The example of this name.
pub fn named(name: &str) -> Option<&'static Example> {
    ALL.iter().find(|example| example.name == name)
}

/// Indices of a grid of `columns` × `rows` nodes, row by row, and its faces.
fn grid_faces(columns: usize, rows: usize) -> Vec<Vec<usize>> {
    let at = |i: usize, j: usize| j * columns + i;
    let cells = (0..rows - 1).flat_map(|j| (0..columns - 1).map(move |i| (i, j)));
    cells
        .map(|(i, j)| vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
        .collect()
}

/// Three vaults with valleys between, spanning a courtyard: 19 × 12 nodes, 504 mm long,
/// planarised from a plain mesh (fixtures/README.md has the command).
fn vault() -> Draft {
    let (draft, _) = read_json(include_str!("../../fixtures/vault.json"), AxisRule::File)
        .expect("a test reads every embedded structure");
    draft
}

/// A shallow dome over a ring, open at the top: five rings of 32 nodes on a sphere, axes
/// along its normals.
fn dome() -> Draft {
    const SEGMENTS: usize = 32;
    const RINGS: usize = 6;
    const RADIUS: f64 = 460.0;
    let mut draft = Draft { name: "dome".into(), ..Draft::default() };
    for ring in 0..RINGS {
        // Angle of the normal from the vertical, from the foot to the top ring.
        let tilt = (66.0 - 5.2 * ring as f64) * PI / 180.0;
        for segment in 0..SEGMENTS {
            let turn = 2.0 * PI * segment as f64 / SEGMENTS as f64;
            let normal = Vector3::new(
                trig::sin(tilt) * trig::cos(turn),
                trig::sin(tilt) * trig::sin(turn),
                trig::cos(tilt),
            );
            draft.positions.push(Point3::from(normal * RADIUS));
            draft.axes.push(normal);
        }
    }
    for ring in 0..RINGS - 1 {
        for segment in 0..SEGMENTS {
            let next = (segment + 1) % SEGMENTS;
            let (low, high) = (ring * SEGMENTS, (ring + 1) * SEGMENTS);
            draft.faces.push(vec![
                low + segment,
                low + next,
                high + next,
                high + segment,
            ]);
        }
    }
    draft.with_depth(18.0, 18.0)
}

/// A patch of a sphere under a stereographic grid, axes through its centre.
fn sphere_patch() -> Draft {
    const COUNT: usize = 12;
    const RADIUS: f64 = 600.0;
    let mut draft = Draft { name: "sphere-patch".into(), ..Draft::default() };
    let at = |k: usize| 0.34 * (2.0 * k as f64 / (COUNT - 1) as f64 - 1.0) / 2.0;
    for j in 0..COUNT {
        for i in 0..COUNT {
            let (u, v) = (at(i), at(j));
            let share = 1.0 + u * u + v * v;
            let out = Vector3::new(2.0 * u, 2.0 * v, 1.0 - u * u - v * v) / share;
            draft.positions.push(Point3::from(out * RADIUS - Vector3::z() * RADIUS));
            draft.axes.push(out);
        }
    }
    draft.faces = grid_faces(COUNT, COUNT);
    draft.with_depth(16.0, 16.0)
}

/// A flat facade of curved rows: axes lean as a parallel net of the facade does that is
/// free along its first row and column.
fn facade() -> Draft {
    const COLUMNS: usize = 15;
    const ROWS: usize = 10;
    let place = |i: usize, j: usize| {
        let (x, y) = (34.0 * i as f64, 34.0 * j as f64);
        let (wave_x, wave_y) = (trig::sin(x / 150.0), trig::sin(y / 120.0));
        Point3::new(x + 7.0 * wave_y, y + 9.0 * wave_x, 0.0)
    };
    let mut lean = vec![Vector3::zeros(); COLUMNS * ROWS];
    let at = |i: usize, j: usize| j * COLUMNS + i;
    // Free choice along the edges: how much faster the lean runs than the facade.
    let pace = |k: usize, count: usize| {
        0.004 * trig::sin(2.0 * PI * k as f64 / count as f64 + 0.6)
    };
    for i in 1..COLUMNS {
        let step = place(i, 0) - place(i - 1, 0);
        lean[at(i, 0)] = lean[at(i - 1, 0)] + step * pace(i, COLUMNS);
    }
    for j in 1..ROWS {
        let step = place(0, j) - place(0, j - 1);
        lean[at(0, j)] = lean[at(0, j - 1)] + step * pace(j, ROWS);
        for i in 1..COLUMNS {
            let (below, left) = (lean[at(i, j - 1)], lean[at(i - 1, j)]);
            let up = place(i, j) - place(i, j - 1);
            let right = place(i, j) - place(i - 1, j);
            // Where the line from `below` along `up` meets that from `left` along `right`.
            let share = right.cross(&(below - left)).z / up.cross(&right).z;
            lean[at(i, j)] = below + up * share;
        }
    }
    let cells = (0..ROWS).flat_map(|j| (0..COLUMNS).map(move |i| (i, j)));
    Draft {
        name: "facade".into(),
        positions: cells.map(|(i, j)| place(i, j)).collect(),
        axes: lean.into_iter().map(|lean| lean + Vector3::z()).collect(),
        faces: grid_faces(COLUMNS, ROWS),
        ..Draft::default()
    }
    .with_depth(15.0, 15.0)
}

/// `sectors` patches of 5 × 5 cells around one node on a sphere, axes through its centre.
/// In plan each patch is a square corner under the map z^(4 / sectors), so that lines run
/// smoothly from one patch into the next.
fn star(name: &str, sectors: usize) -> Draft {
    const CELLS: usize = 5;
    const REACH: f64 = 230.0;
    const RADIUS: f64 = 700.0;
    let power = 4.0 / sectors as f64;
    let lifted = |sector: usize, i: usize, j: usize| {
        let (x, y) = (i as f64 / CELLS as f64, j as f64 / CELLS as f64);
        let reach = REACH * libm::pow(x * x + y * y, power / 2.0);
        let turn = power * (trig::atan2(y, x) + sector as f64 * PI / 2.0);
        let height = (RADIUS * RADIUS - reach * reach).sqrt();
        Vector3::new(reach * trig::cos(turn), reach * trig::sin(turn), height)
    };
    // Node 0 is the centre; then each sector with its first ray, without its last.
    let first = |sector: usize| 1 + sector % sectors * CELLS * (CELLS + 1);
    let at = |sector: usize, i: usize, j: usize| match (i, j) {
        (0, 0) => 0,
        (0, j) => first(sector + 1) + (j - 1) * (CELLS + 1),
        (i, j) => first(sector) + (i - 1) * (CELLS + 1) + j,
    };
    let mut outs = vec![lifted(0, 0, 0)];
    let mut faces = Vec::new();
    for sector in 0..sectors {
        let nodes = (1..=CELLS).flat_map(|i| (0..=CELLS).map(move |j| (i, j)));
        outs.extend(nodes.map(|(i, j)| lifted(sector, i, j)));
        let cells = (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| (i, j)));
        faces.extend(cells.map(|(i, j)| {
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            corners.map(|(i, j)| at(sector, i, j)).to_vec()
        }));
    }
    let draft = Draft {
        name: name.into(),
        positions: outs
            .iter()
            .map(|out| Point3::from(out - Vector3::z() * RADIUS))
            .collect(),
        axes: outs,
        faces,
        ..Draft::default()
    };
    draft.with_depth(18.0, 18.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::{Structure, planarity};
    use crate::tolerance::Tolerance;

    #[test]
    fn every_example_is_planar_to_1e_9_and_has_no_fault() {
        for example in &ALL {
            let (structure, findings) =
                Structure::new((example.draft)(), &Tolerance::default()).unwrap();
            assert!(findings.is_empty(), "{}: {findings:?}", example.name);
            for &fin in structure.fins() {
                let (off, diameter) = planarity(&structure.corners(fin.ends()));
                assert!(off <= 1e-9 * diameter, "{} {fin:?} {off}", example.name);
            }
        }
    }
}
