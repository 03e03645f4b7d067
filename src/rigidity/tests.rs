//! Exactly known cases and laws.

use super::*;
use crate::geometry::{Point3, Vector3};
use crate::rigidity::amplify::{Bracketing, Load};
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
    use crate::geometry::trig;
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
    place: impl Fn(usize, usize) -> (Point3, Vector3),
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

/// A scatter that is the same everywhere, from -1 to 1.
fn noise(k: usize) -> f64 {
    2.0 * ((k as f64 + 1.0) * 0.618_033_988_749_894_9).fract() - 1.0
}

/// A plane net, its inner lines bent by `jitter`.
fn plan(i: usize, j: usize, jitter: f64) -> [f64; 2] {
    let k = 31 * i + 17 * j;
    [i as f64 + jitter * noise(k), j as f64 + jitter * noise(k + 7)]
}

fn parallel(n: usize, strips: bool, jitter: f64) -> Model {
    grid(n, strips, |i, j| {
        let [x, y] = plan(i, j, jitter);
        (Point3::new(x, y, 0.05 * x * y), Vector3::z())
    })
}

/// Axes through one point, nodes on a sphere around it, over a plane net: a gnomonic grid.
fn radial(n: usize, strips: bool, jitter: f64) -> Model {
    let middle = (n as f64 - 1.0) / 2.0;
    grid(n, strips, |i, j| {
        let [x, y] = plan(i, j, jitter);
        let out = Vector3::new(x - middle, y - middle, n as f64).normalize();
        (Point3::from(out * n as f64), out)
    })
}

/// A translational net whose axes are a net parallel to it.
fn combescure(n: usize, strips: bool) -> Model {
    let step = |k: usize, way: Vector3| way + Vector3::z() * (0.3 - 0.12 * k as f64);
    let along = |k: usize, way: Vector3, lean: f64| {
        let steps = (0..k).map(|m| (step(m, way), lean * (0.1 + 0.03 * noise(m))));
        steps.fold((Vector3::zeros(), Vector3::zeros()), |(p, a), (s, l)| {
            (p + s, a - s * l)
        })
    };
    grid(n, strips, |i, j| {
        let (p, a) = along(i, Vector3::x(), 1.0);
        let (q, b) = along(j, Vector3::y(), 0.7);
        (Point3::from(p + q), Vector3::z() + a + b)
    })
}

fn held_all_round(mut model: Model, n: usize) -> Model {
    for knot in &mut model.knots {
        let (i, j) = (knot.node % n, knot.node / n);
        knot.held = i == 0 || j == 0 || i + 1 == n || j + 1 == n;
    }
    model
}

fn dof(model: &Model) -> usize {
    let system = System::new(model, None, 1);
    mobility(&system, &least(&system, 8).unwrap()).unwrap().count
}

#[test]
fn exact_families_have_their_mobility() {
    for n in [4, 7, 12] {
        assert_eq!(dof(&parallel(n, false, 0.2)), 2 * n - 3, "parallel {n}");
        assert_eq!(dof(&radial(n, false, 0.2)), 2 * n - 3, "radial {n}");
    }
    for n in [5, 8] {
        assert_eq!(dof(&parallel(n, true, 0.0)), 1, "trellis {n}");
        assert_eq!(dof(&parallel(n, true, 0.2)), 0, "jittered {n}");
        // An assembly by normal equations once called this one rigid.
        assert_eq!(dof(&radial(n, true, 0.0)), 1, "gnomonic {n}");
        assert_eq!(dof(&torus(n, false)), 0);
        assert_eq!(dof(&combescure(n, false)), 0);
    }
    assert_eq!(dof(&held_all_round(parallel(7, false, 0.2), 7)), 0, "held all round");
}

#[test]
fn nodes_of_valence_three_and_five_leave_twice_v_less_e_less_three() {
    use crate::design::examples;
    for name in ["three", "five"] {
        let mut draft = (examples::named(name).unwrap().draft)();
        draft.fixed = Some(Vec::new());
        let (structure, _) =
            Structure::new(draft, &crate::tolerance::Tolerance::default()).unwrap();
        let model = Model::of(&structure, Joint::Hinge, &Default::default());
        let (v, e) = (structure.nodes().len(), structure.fins().len());
        assert_eq!(dof(&model), 2 * v - e - 3, "{name}");
    }
}

use crate::joint::Joint;
use crate::structure::Structure;

/// The model under a projective map of space, axes cut to their old half length.
fn projected(model: &Model) -> Model {
    let map = |p: &Point3| {
        let w = 1.0 + 0.02 * p.x - 0.013 * p.y + 0.017 * p.z;
        Point3::new(p.x + 0.2 * p.z, 1.3 * p.y - 0.1 * p.x, 0.8 * p.z + 0.3 * p.y) / w
    };
    let mut model = model.clone();
    for knot in &mut model.knots {
        let [a, b] = [map(&knot.points[0]), map(&knot.points[1])];
        let (middle, half) = (nalgebra::center(&a, &b), (b - a).normalize() * 0.1);
        knot.points = vec![middle - half, middle + half];
    }
    model
}

#[test]
fn mobility_is_a_projective_invariant() {
    let cases = [parallel(6, false, 0.2), radial(6, true, 0.0), torus(6, false)];
    for model in cases {
        assert_eq!(dof(&model), dof(&projected(&model)));
    }
}

fn question() -> Question {
    Question {
        play_mm: 0.001,
        limit: SwayLimit::Share(0.02),
        modes: 4,
        pairing: Pairing::Pin,
        scale: 1.0,
    }
}

#[test]
fn the_verdict_ignores_motion_scale_and_numbering() {
    let turned = |model: &Model, scale: f64| {
        let turn = nalgebra::Rotation3::from_euler_angles(0.3, -0.8, 1.9);
        let mut model = model.clone();
        let points = model.knots.iter_mut().flat_map(|k| &mut k.points);
        points.for_each(|p| *p = (turn * *p) * scale + Vector3::new(9.0, -4.0, 2.0));
        model
    };
    let renumbered = |model: &Model| {
        let last = model.bodies.len() - 1;
        let bodies = model.bodies.iter().rev().copied().collect();
        let knots = model.knots.iter().rev().cloned().map(|mut knot| {
            knot.bodies.iter_mut().for_each(|b| *b = last - *b);
            knot.bodies.sort_unstable();
            knot
        });
        Model::new(bodies, knots.collect())
    };
    for model in [torus(6, false), combescure(6, true), parallel(5, false, 0.2)] {
        let nothing = Fingerprint::of_nothing;
        let first = judge(&model, &question(), nothing());
        let scaled = Question { play_mm: 0.025, ..question() };
        for (other, question) in
            [(turned(&model, 25.0), scaled), (renumbered(&model), question())]
        {
            let second = judge(&other, &question, nothing());
            assert_eq!(first.outcome(), second.outcome());
            assert_eq!(first.mobility(), second.mobility());
            for (a, b) in first.spectrum.iter().zip(&second.spectrum) {
                assert!(close(*a, *b, 1e-6) || a.max(*b) < 1e-12, "{a} {b}");
            }
        }
    }
}

/// Sway over play by a conic program: bodies' motions and pins' velocities are unknowns,
/// each sleeve within 1 of its pin.
fn by_cone_program(system: &System, load: &Load) -> f64 {
    use clarabel::algebra::CscMatrix;
    use clarabel::solver::{
        DefaultSettings, DefaultSolver, IPSolver, SupportedConeT::SecondOrderConeT,
    };
    let model = system.model;
    let pins = system.unknowns();
    let mut first = vec![pins];
    for motions in &system.motions {
        first.push(first[first.len() - 1] + motions.rank);
    }
    let columns = first[first.len() - 1];
    let (mut rows, mut places, mut values) = (Vec::new(), Vec::new(), Vec::new());
    let mut right = Vec::new();
    for (body, knots) in model.touches.iter().enumerate() {
        let motions = &system.motions[body];
        let mut row = 0;
        for &knot in knots {
            for point in 0..model.knots[knot].points.len() {
                right.push(1.0);
                for k in 0..3 {
                    let mut put = |column: usize, value: f64| {
                        rows.push(right.len());
                        places.push(column);
                        values.push(value);
                    };
                    for j in 0..motions.rank {
                        put(first[body] + j, -motions.column(j)[row + k]);
                    }
                    if let Some(at) = system.knot_at[knot] {
                        put(at + 3 * point + k, 1.0);
                    }
                    right.push(0.0);
                }
                row += 3;
            }
        }
    }
    let a = CscMatrix::new_from_triplets(right.len(), columns, rows, places, values);
    let mut aim: Vec<f64> = load.forces.iter().map(|f| -f).collect();
    aim.resize(columns, 0.0);
    let cones = vec![SecondOrderConeT(4); right.len() / 4];
    let settings = DefaultSettings { verbose: false, ..DefaultSettings::default() };
    let p = CscMatrix::zeros((columns, columns));
    let mut solver = DefaultSolver::new(&p, &aim, &a, &right, &cones, settings).unwrap();
    solver.solve();
    -solver.solution.obj_val
}

/// Checks both proofs of a bracket from the points alone.
fn check_proofs(system: &System, found: &Bracketing) {
    let (model, proof) = (system.model, &found.proof);
    let mut row = 0;
    let mut on_pins = vec![0.0; system.unknowns()];
    for (body, knots) in model.touches.iter().enumerate() {
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        let points = model.points(body);
        let mut moved = nalgebra::DVector::zeros(3 * points.len());
        let mut rigid = nalgebra::DMatrix::zeros(3 * points.len(), 6);
        let mut k = 0;
        for &knot in knots {
            for (end, q) in model.knots[knot].points.iter().enumerate() {
                let three = |of: &[f64]| Vector3::new(of[row], of[row + 1], of[row + 2]);
                let (f, off) = (three(&proof.forces), three(&proof.off));
                force += f;
                moment += q.coords.cross(&f);
                assert!(off.norm() <= 1.0 + 1e-9, "a sleeve leaves its pin too far");
                let at = system.knot_at[knot].map(|at| at + 3 * end);
                for c in 0..3 {
                    // A deviation is the pin's velocity less the body's.
                    moved[k + c] = at.map_or(0.0, |at| proof.motion[at + c]) - off[c];
                    rigid[(k + c, 3 + c)] = 1.0;
                    let turned = Vector3::ith(c, 1.0).cross(&q.coords);
                    for r in 0..3 {
                        rigid[(k + r, c)] = turned[r];
                    }
                    if let Some(at) = at {
                        on_pins[at + c] += f[c];
                    }
                }
                k += 3;
                row += 3;
            }
        }
        let scale: f64 = proof.forces.iter().map(|f| f.abs()).fold(1.0, f64::max);
        assert!(force.norm() < 1e-7 * scale && moment.norm() < 1e-6 * scale);
        let fit = rigid.clone().svd(true, true).solve(&moved, 1e-12).unwrap();
        let rest = (&rigid * fit - &moved).norm();
        assert!(rest < 1e-6 * moved.norm().max(1.0), "body {body} bends by {rest}");
    }
    let counts = system.counts();
    for (k, (f, load)) in on_pins.iter().zip(&found.load.forces).enumerate() {
        assert!(counts[k] == 0.0 || (f - load).abs() < 1e-6, "{f} {load}");
    }
    let way: f64 = proof.motion.iter().zip(&found.load.forces).map(|(y, f)| y * f).sum();
    let sizes = proof.forces.chunks_exact(3);
    let total: f64 = sizes.map(|f| f.iter().map(|x| x * x).sum::<f64>().sqrt()).sum();
    assert!(close(way, proof.bracket.lower, 1e-9));
    assert!(close(total, proof.bracket.upper, 1e-9));
}

#[test]
fn brackets_hold_what_a_cone_program_finds() {
    let cases = [
        ("torus fins", torus(5, false)),
        ("torus strips", torus(5, true)),
        ("combescure fins", combescure(5, false)),
        ("combescure strips", combescure(5, true)),
        ("flat fins, held all round", held_all_round(parallel(6, false, 0.2), 6)),
        ("sphere fins, held all round", held_all_round(radial(6, false, 0.2), 6)),
        ("flat strips, jittered", parallel(6, true, 0.2)),
        ("torus strips, held all round", held_all_round(torus(7, true), 7)),
        ("torus fins, a weld", torus(5, false).welded(12, [20, 22])),
    ];
    for (name, model) in cases {
        let system = System::new(&model, None, 1);
        let rigid = if system.floats { system.rigid() } else { Vec::new() };
        let middle = model.knots.len() / 2;
        let knot = (0..model.knots.len())
            .filter(|&k| model.knots[k].is_pin() && !model.knots[k].held)
            .min_by_key(|k| k.abs_diff(middle))
            .unwrap();
        let load = Load::new(&system, &rigid, knot, Vector3::z()).unwrap();
        let known = by_cone_program(&system, &load);
        let factor = system.factor(None).unwrap();
        let mut found = Bracketing::first(&system, &factor, vec![load]).remove(0);
        for round in 0..16 {
            let Bracket { lower, upper } = found.bracket();
            let share = 1e-6 * known;
            assert!(
                lower <= known + share && known <= upper + share,
                "{name}, round {round}: {lower} {known} {upper}"
            );
            if found.bracket().is_narrow() {
                break;
            }
            found.tighten().unwrap();
        }
        let Bracket { lower, upper } = found.bracket();
        eprintln!("{name}: [{lower:.5}, {upper:.5}] cone program {known:.5}");
        assert!(upper <= 1.25 * lower, "{name}: [{lower}, {upper}], {known}");
        check_proofs(&system, &found);
    }
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let model = torus(34, false);
    let sigma = |threads: usize| {
        let system = System::new(&model, None, threads);
        let factor = system.factor(None).unwrap();
        by_inverse(&system, &factor, 4).sigma
    };
    assert!(System::new(&model, None, 1).unknowns() > 5000);
    assert_eq!(sigma(1), sigma(2));
}

#[test]
fn greedy_welds_are_as_few_as_the_mobility() {
    for model in [parallel(5, false, 0.2), radial(5, false, 0.1)] {
        let question = Question { play_mm: 0.0, ..question() };
        let steps = remedies(&model, &question);
        let welds = steps.iter().filter(|r| matches!(r.cure, Cure::Weld(_)));
        let left: Vec<usize> = welds.map(|r| r.mobility_after).collect();
        assert_eq!(left, (0..7).rev().collect::<Vec<_>>());
    }
}

#[test]
fn degenerate_models_get_an_answer() {
    let loose = |bodies: usize| Model::new((0..bodies).map(Body::Link).collect(), vec![]);
    let nothing = Fingerprint::of_nothing;
    assert_eq!(judge(&loose(1), &question(), nothing()).mobility(), 0);
    let two = judge(&loose(2), &question(), nothing());
    assert_eq!((two.mobility(), two.outcome()), (6, Outcome::Mechanism));
    let mut held = torus(4, false);
    held.knots.iter_mut().for_each(|knot| knot.held = true);
    let held = judge(&held, &question(), nothing());
    assert_eq!((held.mobility(), held.outcome()), (0, Outcome::Rigid));
    assert!(held.findings().contains(&RigidityFinding::AllHeld));
    let mut apart = torus(4, false);
    let far = torus(4, false);
    let bodies = apart.bodies.len();
    for mut knot in far.knots {
        knot.bodies.iter_mut().for_each(|b| *b += bodies);
        knot.points.iter_mut().for_each(|p| p.z += 50.0);
        apart.knots.push(knot);
    }
    let apart = Model::new([apart.bodies, far.bodies].concat(), apart.knots);
    assert_eq!(dof(&apart), 6, "two pieces");
}

#[test]
fn bad_linkages_are_told_what_is_wrong() {
    let cases = [
        ("{", "bad_linkage"),
        (r#"{"bodies":0,"r":1,"pins":[]}"#, "body_count"),
        (r#"{"bodies":2,"r":0,"pins":[]}"#, "no_reach"),
        (r#"{"bodies":2,"r":1,"pins":[[[0,0,0],[0,0,0],[0,1]]]}"#, "zero_axis"),
        (r#"{"bodies":2,"r":1,"pins":[[[0,0,0],[0,0,1],[0,2]]]}"#, "no_such_body"),
        (r#"{"bodies":2,"r":1,"pins":[[[0,0,0],[0,0,1],[1,1]]]}"#, "pin_bodies"),
    ];
    for (text, code) in cases {
        use miette::Diagnostic;
        let found = read_linkage(text).unwrap_err();
        let found = found[0].code().unwrap().to_string();
        assert_eq!(found, format!("rigidity::{code}"), "{text}");
    }
}
