//! How long the least resisted motions take: `cargo bench --bench rigidity -- NODES`.
//!
//! A patch of a torus with its normals, NODES × NODES nodes, hinged fins, fin 0 held, the
//! four least resisted motions; prints one JSON line. With `-` it reads NODES from standard
//! input, line after line. `tests/bench/rigidity.py` runs it beside scipy on the same
//! matrix. By hand, never a test.

use finwright::geometry::{Point3, Vector3, trig};
use finwright::ids::FinId;
use finwright::rigidity::{Coupling, Model, RigidBody, least_resisted};
use std::time::Instant;

fn torus(n: usize) -> Model {
    let place = |i: usize, j: usize| {
        let size = n as f64 - 1.0;
        let (u, v) = (i as f64 / size - 0.5, 1.6 * (j as f64 / size - 0.5));
        let out = Vector3::new(
            trig::cos(v) * trig::cos(u),
            trig::cos(v) * trig::sin(u),
            trig::sin(v),
        );
        let ring = Vector3::new(trig::cos(u), trig::sin(u), 0.0);
        ((Point3::from(ring + out * 0.5)) * size, out)
    };
    let mut on = vec![Vec::new(); n * n];
    let mut bodies = Vec::new();
    for at in 0..n * n {
        let steps = [(at % n + 1 < n).then_some(1), (at / n + 1 < n).then_some(n)];
        for step in steps.into_iter().flatten() {
            on[at].push(bodies.len());
            on[at + step].push(bodies.len());
            bodies.push(RigidBody::Fin(FinId::between(at.into(), (at + step).into())));
        }
    }
    let couplings = on.into_iter().enumerate().map(|(node, mut bodies)| {
        let (p, a) = place(node % n, node / n);
        bodies.sort_unstable();
        let points = vec![p - a * 0.25, p + a * 0.25];
        Coupling { node: node.into(), points, bodies, held: false, share: 0.5 }
    });
    Model::new(bodies, couplings.collect())
}

#[allow(clippy::print_stdout, reason = "a benchmark prints its lines")]
fn measure(n: usize) {
    let model = torus(n);
    let begun = Instant::now();
    let sigma = least_resisted(&model, Some(0), 4).unwrap_or_default();
    let seconds = begun.elapsed().as_secs_f64();
    let fins = model.bodies.len();
    println!(r#"{{"fins": {fins}, "seconds": {seconds:.4}, "sigma": {sigma:?}}}"#);
}

fn main() {
    let number = |text: &str| text.trim().parse::<usize>().ok();
    if std::env::args().any(|text| text == "-") {
        let lines = std::io::stdin().lines().map_while(Result::ok);
        lines.filter_map(|line| number(&line)).for_each(measure);
    } else {
        measure(std::env::args().skip(1).find_map(|text| number(&text)).unwrap_or(71));
    }
}
