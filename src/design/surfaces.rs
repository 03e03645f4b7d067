//! Reference surfaces of our own, made by formulas; lengths in mm.

use crate::design::surface::Polygons;
use crate::geometry::{Point3, trig};
use std::f64::consts::{PI, TAU};

/// An embedded reference surface.
pub struct ReferenceSurface {
    /// Its name for `finwright design`.
    pub name: &'static str,
    /// One line on what it is.
    pub about: &'static str,
    /// Makes it.
    pub polygons: fn() -> Polygons,
}

/// All embedded surfaces, the default one first.
pub const SURFACES: [ReferenceSurface; 3] = [
    ReferenceSurface {
        name: "hill",
        about: "surface: two bumps over a rectangle, with singular nodes inside",
        polygons: hill,
    },
    ReferenceSurface {
        name: "court",
        about: "surface: arched roof with a round and a rectangular courtyard",
        polygons: court,
    },
    ReferenceSurface {
        name: "dome-surface",
        about: "surface: dome over an ellipse",
        polygons: dome,
    },
];

/// The embedded surface of this name.
pub fn surface_named(name: &str) -> Option<&'static ReferenceSurface> {
    SURFACES.iter().find(|surface| surface.name == name)
}

/// A bump of this height at a place, falling to 1/e of it at these distances.
fn bump([x, y]: [f64; 2], [at_x, at_y]: [f64; 2], [far_x, far_y]: [f64; 2]) -> f64 {
    let (u, v) = ((x - at_x) / far_x, (y - at_y) / far_y);
    libm::exp(-u * u - v * v)
}

/// 1200 × 800 mm: z = 170 exp(−((x + 250)/330)² − ((y − 60)/260)²)
/// + 120 exp(−((x − 330)/260)² − ((y + 110)/300)²).
fn hill() -> Polygons {
    const CELLS: [usize; 2] = [66, 44];
    let place = |i: usize, j: usize| {
        let x = 1200.0 * (i as f64 / CELLS[0] as f64 - 0.5);
        let y = 800.0 * (j as f64 / CELLS[1] as f64 - 0.5);
        let west = 170.0 * bump([x, y], [-250.0, 60.0], [330.0, 260.0]);
        let east = 120.0 * bump([x, y], [330.0, -110.0], [260.0, 300.0]);
        Point3::new(x, y, west + east)
    };
    grid(CELLS, place, |_, _| true)
}

/// Height of the court's roof.
fn arched(x: f64, y: f64) -> f64 {
    150.0 * trig::cos(PI * y / 1300.0) + 40.0 * trig::cos(PI * (x - 150.0) / 900.0)
}

/// 1800 × 1000 mm, arched: z = 150 cos(π y / 1300) + 40 cos(π (x − 150) / 900), with a
/// round courtyard of radius 170 about (−450, 25) and a rectangular one of 400 × 250
/// between (300, −100) and (700, 150).
fn court() -> Polygons {
    const CELL: f64 = 25.0;
    const BLOCK: usize = 20;
    const LAYERS: usize = 4;
    let place = |i: usize, j: usize| {
        let (x, y) = (CELL * i as f64 - 900.0, CELL * j as f64 - 500.0);
        Point3::new(x, y, arched(x, y))
    };
    // Cells of the block around the round courtyard, and of the rectangular one.
    let in_block = |i: usize, j: usize| (8..28).contains(&i) && (11..31).contains(&j);
    let in_court = |i: usize, j: usize| (48..64).contains(&i) && (16..26).contains(&j);
    let mut polygons = grid([72, 40], place, |i, j| !in_block(i, j) && !in_court(i, j));
    // Around the circle: layers from the edge of the block inward, joined by welding.
    let rim = |k: usize| {
        let (side, along) = (k / BLOCK % 4, (k % BLOCK) as f64 * CELL - 250.0);
        let [x, y] = match side {
            0 => [along, -250.0],
            1 => [250.0, along],
            2 => [-along, 250.0],
            _ => [-250.0, -along],
        };
        [x, y]
    };
    let ring = |layer: usize, k: usize| {
        let [x, y] = rim(k);
        let share = layer as f64 / LAYERS as f64;
        let scale = 1.0 + share * (170.0 / libm::hypot(x, y) - 1.0);
        let (x, y) = (-450.0 + x * scale, 25.0 + y * scale);
        Point3::new(x, y, arched(x, y))
    };
    let first = polygons.positions.len();
    for layer in 0..=LAYERS {
        polygons.positions.extend((0..4 * BLOCK).map(|k| ring(layer, k)));
    }
    let at = |layer: usize, k: usize| first + layer * 4 * BLOCK + k % (4 * BLOCK);
    for layer in 0..LAYERS {
        polygons.faces.extend((0..4 * BLOCK).map(|k| {
            vec![at(layer, k), at(layer, k + 1), at(layer + 1, k + 1), at(layer + 1, k)]
        }));
    }
    polygons
}

/// Over the ellipse with half axes 560 and 450 mm: z = 275 (1 − (x/560)² − (y/450)²).
fn dome() -> Polygons {
    const RINGS: usize = 24;
    let place = |ring: usize, k: usize| {
        let share = ring as f64 / RINGS as f64;
        let turn = TAU * k as f64 / (6 * ring.max(1)) as f64;
        let (x, y) = (560.0 * share * trig::cos(turn), 450.0 * share * trig::sin(turn));
        Point3::new(x, y, 275.0 * (1.0 - share * share))
    };
    let mut polygons = Polygons { positions: vec![place(0, 0)], ..Polygons::default() };
    let first = |ring: usize| if ring == 0 { 0 } else { 1 + 3 * ring * (ring - 1) };
    for ring in 1..=RINGS {
        polygons.positions.extend((0..6 * ring).map(|k| place(ring, k)));
        let (inner, outer) = (6 * (ring - 1), 6 * ring);
        let low = |k: usize| first(ring - 1) + k % inner.max(1);
        let high = |k: usize| first(ring) + k % outer;
        for sector in 0..6 {
            for k in 0..ring {
                let (i, o) = (sector * (ring - 1) + k, sector * ring + k);
                polygons.faces.push(vec![low(i), high(o), high(o + 1)]);
                if k + 1 < ring {
                    polygons.faces.push(vec![low(i), high(o + 1), low(i + 1)]);
                }
            }
        }
    }
    polygons
}

/// The cells of a grid that are `kept`.
fn grid(
    [columns, rows]: [usize; 2],
    place: impl Fn(usize, usize) -> Point3,
    kept: impl Fn(usize, usize) -> bool,
) -> Polygons {
    let at = |i: usize, j: usize| j * (columns + 1) + i;
    let points = (0..=rows).flat_map(|j| (0..=columns).map(move |i| (i, j)));
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    Polygons {
        positions: points.map(|(i, j)| place(i, j)).collect(),
        faces: cells
            .filter(|&(i, j)| kept(i, j))
            .map(|(i, j)| vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
            .collect(),
        axes: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::surface::clean;

    #[test]
    fn embedded_surfaces_are_clean_and_have_the_holes_they_should() {
        for (surface, euler) in SURFACES.iter().zip([1, -1, 1]) {
            let (clean, findings) = clean((surface.polygons)()).unwrap();
            assert_eq!(clean.euler(), euler, "{}", surface.name);
            let told =
                |f: &crate::diagnostic::Finding| f.code != "surface::vertices_joined";
            assert!(!findings.iter().any(told), "{}: {findings:?}", surface.name);
        }
    }
}
