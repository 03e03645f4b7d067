//! Exactly known cases and laws.

use super::*;
use crate::rigidity::mobility::mobility;
use crate::rigidity::spectrum::{by_inverse, dense, least};
use crate::rigidity::system::System;
use serde_json::Value;

fn linkages() -> Vec<(Value, Model)> {
    let text = include_str!("../../fixtures/rigidity/linkages.jsonl");
    text.lines()
        .map(|line| (serde_json::from_str(line).unwrap(), read_linkage(line).unwrap()))
        .collect()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

#[test]
fn known_linkages_have_their_mobility_and_singular_values() {
    for (case, model) in linkages() {
        let name = &case["name"];
        let system = System::new(&model, None, 1);
        let modes = least(&system, 8).unwrap();
        let dof = case["dof"].as_u64().unwrap() as usize;
        assert_eq!(mobility(&system, &modes).unwrap().count, dof, "{name}");
        let paper = paper::paper(&model, (Pairing::Pin, 1.0), dof + 3, 1).unwrap();
        for (k, known) in numbers(&case["paper_sigma_next"]).into_iter().enumerate() {
            let ours = paper.singular_values[dof + k];
            assert!((ours - known).abs() <= 5e-7 * known, "{name} {ours} {known}");
        }
        assert!(paper.singular_values[..dof].iter().all(|s| *s < 1e-12), "{name}");
    }
}

/// A patch of a torus (radii 3 and 1, its outer side) with its normals, as hinged fins or
/// rigid strips.
pub(super) fn torus(n: usize, strips: bool) -> Model {
    use crate::geometry::{Point3, Vector3, trig};
    let place = |i: usize, j: usize| {
        let (u, v) = (0.2 * i as f64, 0.1 * j as f64 - 0.05 * n as f64);
        let out = Vector3::new(
            trig::cos(v) * trig::cos(u / 2.0),
            trig::cos(v) * trig::sin(u / 2.0),
            trig::sin(v),
        );
        let ring = Vector3::new(trig::cos(u / 2.0), trig::sin(u / 2.0), 0.0) * 3.0;
        (Point3::from(ring + out), out)
    };
    grid(n, strips, place)
}

/// A net of `n` × `n` nodes.
pub(super) fn grid(
    n: usize,
    strips: bool,
    place: impl Fn(usize, usize) -> (crate::geometry::Point3, crate::geometry::Vector3),
) -> Model {
    let mut on = vec![Vec::new(); n * n];
    let mut bodies = Vec::new();
    for j in 0..n {
        for i in 0..n {
            if strips {
                on[j * n + i].extend([j, n + i]);
                continue;
            }
            for other in [(i + 1 < n).then_some(1), (j + 1 < n).then_some(n)] {
                let Some(step) = other else { continue };
                let at = j * n + i;
                on[at].push(bodies.len());
                on[at + step].push(bodies.len());
                bodies.push(Body::Fin([at, at + step]));
            }
        }
    }
    if strips {
        bodies = (0..2 * n).map(Body::Strip).collect();
    }
    let knots = on.into_iter().enumerate().map(|(node, mut bodies)| {
        let (p, a) = place(node % n, node / n);
        let half = a.normalize() * 0.1;
        bodies.sort_unstable();
        let points = vec![p - half, p + half];
        Knot { node, points, bodies, held: false, share: 0.5 }
    });
    Model::new(bodies, knots.collect())
}

fn close(a: f64, b: f64, share: f64) -> bool {
    (a - b).abs() <= share * a.abs().max(b.abs())
}

#[test]
fn dense_and_sparse_agree() {
    for (n, strips) in [(7, false), (9, true)] {
        let model = torus(n, strips);
        for fixed in [None, Some(0)] {
            let system = System::new(&model, fixed, 1);
            let dense = dense(&system, 6);
            let factor = system.factor(None).unwrap();
            let sparse = by_inverse(&system, &factor, 6);
            for (a, b) in dense.sigma.iter().zip(&sparse.sigma) {
                assert!(close(*a, *b, 1e-7), "{:?} {:?}", dense.sigma, sparse.sigma);
            }
        }
    }
}
