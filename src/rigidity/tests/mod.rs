//! Exactly known cases and laws.

mod cone;
mod nets;

use super::*;
use crate::geometry::{Point3, Vector3};
use crate::ids::NodeId;
use crate::rigidity::amplify::{Bracketing, Load};
use crate::rigidity::compliance::compliances;
use crate::rigidity::mobility::mobility;
use crate::rigidity::spectrum::{by_inverse, dense, least};
use crate::rigidity::system::System;
use crate::watch::Stopped;
use nets::{
    combescure, ellipsoid, held_all_round, parallel, parallel_by, radial, radial_by,
    torus,
};
use serde_json::Value;

fn linkages() -> Vec<(Value, Model)> {
    let text = include_str!("../../../fixtures/rigidity/linkages.jsonl");
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
        let modes = least(&system, 8, &()).unwrap();
        let dof = case["dof"].as_u64().unwrap() as usize;
        assert_eq!(mobility(&system, &modes, &()).unwrap().count, dof, "{name}");
        let paper =
            paper::paper(&model, &Criteria { modes: dof + 3, ..criteria() }, 1, &())
                .unwrap();
        for (k, known) in numbers(&case["paper_sigma_next"]).into_iter().enumerate() {
            let ours = paper.singular_values[dof + k];
            assert!((ours - known).abs() <= 5e-7 * known, "{name} {ours} {known}");
        }
        assert!(paper.singular_values[..dof].iter().all(|s| *s < 1e-12), "{name}");
    }
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
            let dense = dense(&system, 6).unwrap();
            let factor = system.factor().unwrap();
            let sparse = by_inverse(&system, &factor, 6, &()).unwrap();
            for (a, b) in dense.sigma.iter().zip(&sparse.sigma) {
                assert!(close(*a, *b, 1e-7), "{:?} {:?}", dense.sigma, sparse.sigma);
            }
        }
    }
}

#[test]
fn compliances_are_what_unit_loads_move() {
    let held = held_all_round(combescure(9, false), 9);
    let mut apart = held_all_round(torus(6, false), 6);
    let other = held_all_round(radial(7, false, 0.2), 7);
    let more = other.couplings.into_iter().map(|mut coupling| {
        coupling.bodies.iter_mut().for_each(|body| *body += apart.bodies.len());
        coupling
    });
    apart.couplings.extend(more);
    apart.bodies.extend(other.bodies);
    let apart = Model::new(apart.bodies, apart.couplings);
    let slots = torus(7, false).stiff();
    for model in [torus(8, false), held, torus(9, true), torus(31, false), apart, slots] {
        let system = System::new(&model, None, 2);
        let factor = system.factor().unwrap();
        let rigid = if system.floats { system.rigid() } else { Vec::new() };
        let found = compliances(&system, &factor, &rigid, &()).unwrap();
        let free =
            model.couplings.iter().filter(|coupling| coupling.is_pin() && !coupling.held);
        assert_eq!(found.len(), free.count());
        let few = found.iter().step_by(found.len() / 7);
        for (coupling, block) in few.chain(found.last()) {
            let load =
                |i| Load::new(&system, &rigid, *coupling, Vector3::ith(i, 1.0)).unwrap();
            for i in 0..3 {
                let mut moved = load(i).forces;
                factor.solve(&mut moved, 1);
                for j in 0..3 {
                    let forces = load(j).forces;
                    let known: f64 = forces.iter().zip(&moved).map(|(f, y)| f * y).sum();
                    let off = (block[(j, i)] - known).abs();
                    assert!(
                        off < 1e-7 * block.trace(),
                        "{coupling} {i} {j} {known} {block}"
                    );
                }
            }
        }
    }
}

fn dof(model: &Model) -> usize {
    let system = System::new(model, None, 1);
    mobility(&system, &least(&system, 8, &()).unwrap(), &()).unwrap().count
}

#[test]
fn exact_families_have_their_mobility() {
    for [n, m] in [[4, 4], [7, 7], [12, 12], [3, 8], [9, 5], [14, 6]] {
        let [parallel, radial] = [parallel_by, radial_by];
        assert_eq!(dof(&parallel([n, m], false, 0.2)), n + m - 3, "parallel {n} x {m}");
        assert_eq!(dof(&radial([n, m], false, 0.2)), n + m - 3, "radial {n} x {m}");
    }
    for [n, m] in [[5, 5], [8, 8], [4, 9], [11, 6]] {
        let [parallel, radial] = [parallel_by, radial_by];
        assert_eq!(dof(&parallel([n, m], true, 0.0)), 1, "trellis {n} x {m}");
        assert_eq!(dof(&parallel([n, m], true, 0.2)), 0, "jittered {n} x {m}");
        // An assembly by normal equations once called this one rigid.
        assert_eq!(dof(&radial([n, m], true, 0.0)), 1, "gnomonic {n} x {m}");
        assert_eq!(dof(&radial([n, m], true, 0.2)), 0, "jittered, radial {n} x {m}");
    }
    for n in [5, 8] {
        assert_eq!(dof(&torus(n, false)), 0);
        assert_eq!(dof(&combescure(n, false)), 0);
        assert_eq!(dof(&ellipsoid(n, false)), 0);
        assert_eq!(dof(&ellipsoid(n, true)), 0);
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
        let model = Model::of_fins(&structure, &Default::default());
        let (v, e) = (structure.nodes().len(), structure.fins().len());
        assert_eq!(dof(&model), 2 * v - e - 3, "{name}");
    }
}

use crate::structure::Structure;

/// The model under a projective map of space, axes cut to their old half length.
fn projected(model: &Model) -> Model {
    let map = |p: &Point3| {
        let w = 1.0 + 0.02 * p.x - 0.013 * p.y + 0.017 * p.z;
        Point3::new(p.x + 0.2 * p.z, 1.3 * p.y - 0.1 * p.x, 0.8 * p.z + 0.3 * p.y) / w
    };
    let mut model = model.clone();
    for coupling in &mut model.couplings {
        let [a, b] = [map(&coupling.points[0]), map(&coupling.points[1])];
        let (middle, half) = (nalgebra::center(&a, &b), (b - a).normalize() * 0.1);
        coupling.points = vec![middle - half, middle + half];
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

fn criteria() -> Criteria {
    Criteria {
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
        let points = model.couplings.iter_mut().flat_map(|k| &mut k.points);
        points.for_each(|p| *p = (turn * *p) * scale + Vector3::new(9.0, -4.0, 2.0));
        model
    };
    let renumbered = |model: &Model| {
        let last = model.bodies.len() - 1;
        let bodies = model.bodies.iter().rev().copied().collect();
        let couplings = model.couplings.iter().rev().cloned().map(|mut coupling| {
            coupling.bodies.iter_mut().for_each(|b| *b = last - *b);
            coupling.bodies.sort_unstable();
            coupling
        });
        Model::new(bodies, couplings.collect())
    };
    for model in [torus(6, false), combescure(6, true), parallel(5, false, 0.2)] {
        let judge = |model: &Model, criteria: &Criteria| {
            judge(model, criteria, Fingerprint::of_nothing(), &mut ()).unwrap()
        };
        let first = judge(&model, &criteria());
        let scaled = Criteria { play_mm: 0.025, ..criteria() };
        for (other, criteria) in
            [(turned(&model, 25.0), scaled), (renumbered(&model), criteria())]
        {
            let second = judge(&other, &criteria);
            assert_eq!(first.outcome(), second.outcome());
            assert_eq!(first.mobility(), second.mobility());
            for (a, b) in first.spectrum.iter().zip(&second.spectrum) {
                assert!(close(*a, *b, 1e-6) || a.max(*b) < 1e-12, "{a} {b}");
            }
        }
    }
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let model = torus(34, false);
    let found = |threads: usize| {
        let system = System::new(&model, None, threads);
        let factor = system.factor().unwrap();
        let (sigma, rigid) =
            (by_inverse(&system, &factor, 4, &()).unwrap().sigma, system.rigid());
        let load = Load::new(&system, &rigid, 7, Vector3::z()).unwrap();
        let mut bracket = Bracketing::first(&system, &factor, vec![load]).remove(0);
        bracket.tighten().unwrap();
        let compliances = compliances(&system, &factor, &rigid, &()).unwrap();
        (sigma, compliances, bracket.bracket())
    };
    assert!(System::new(&model, None, 1).unknowns() > 5000 && model.bodies.len() > 2000);
    assert_eq!(found(1), found(2));
}

#[test]
fn greedy_welds_are_as_few_as_the_mobility() {
    for model in [parallel(5, false, 0.2), radial(5, false, 0.1)] {
        let criteria = Criteria { play_mm: 0.0, ..criteria() };
        let steps = remedies(&model, &criteria, MOST_STEPS, &mut ()).unwrap();
        let welds = steps.iter().filter(|r| matches!(r.cure, Cure::Weld(_)));
        let left: Vec<usize> = welds.map(|r| r.mobility_after).collect();
        assert_eq!(left, (0..7).rev().collect::<Vec<_>>());
    }
}

#[test]
fn stiff_joints_help_most_where_supports_are_few() {
    let n = 12;
    let one_side = (0..n).map(NodeId::new).fold(torus(n, false), Model::with_held);
    let times = |model: &Model| {
        let verdict =
            judge(model, &criteria(), Fingerprint::of_nothing(), &mut ()).unwrap();
        let sway = verdict.sway().unwrap();
        let stiff = verdict.stiff.unwrap();
        let words = verdict.stiff_in_words().unwrap();
        assert!(
            words.contains(&format!("node {} ", sway.node)) && words.ends_with("less")
        );
        assert!(stiff.lower <= sway.bracket.upper && stiff.lower > 0.0);
        (sway.bracket.lower / stiff.upper, sway.bracket.upper / stiff.lower)
    };
    let (free, held) = (times(&one_side), times(&held_all_round(torus(n, false), n)));
    assert!(free.0 > 5.0 && held.1 < 0.5 * free.0, "{free:?} {held:?}");
}

#[test]
fn degenerate_models_get_an_answer() {
    let loose =
        |bodies: usize| Model::new((0..bodies).map(RigidBody::Link).collect(), vec![]);
    let judge = |model: &Model| {
        judge(model, &criteria(), Fingerprint::of_nothing(), &mut ()).unwrap()
    };
    assert_eq!(judge(&loose(1)).mobility(), Some(0));
    let two = judge(&loose(2));
    assert_eq!((two.mobility(), two.outcome()), (Some(6), Outcome::Mechanism));
    let mut held = torus(4, false);
    held.couplings.iter_mut().for_each(|coupling| coupling.held = true);
    let held = judge(&held);
    assert_eq!((held.mobility(), held.outcome()), (Some(0), Outcome::Rigid));
    assert!(held.findings().contains(&RigidityFinding::AllHeld));
    let mut apart = torus(4, false);
    let far = torus(4, false);
    let bodies = apart.bodies.len();
    for mut coupling in far.couplings {
        coupling.bodies.iter_mut().for_each(|b| *b += bodies);
        coupling.points.iter_mut().for_each(|p| p.z += 50.0);
        apart.couplings.push(coupling);
    }
    let apart = Model::new([apart.bodies, far.bodies].concat(), apart.couplings);
    assert_eq!(dof(&apart), 6, "two pieces");
}

#[test]
fn what_cannot_be_solved_is_no_verdict() {
    // Small and large: by a dense decomposition and by a factorisation.
    for n in [4, 12] {
        let mut model = torus(n, false);
        model.couplings[5].points[0].x = f64::NAN;
        let nothing = Fingerprint::of_nothing();
        let verdict = judge(&model, &criteria(), nothing, &mut ()).unwrap();
        assert_eq!(verdict.mobility(), None);
        assert!(!verdict.passes());
        assert_eq!(verdict.findings(), [RigidityFinding::NotSolved]);
        assert!(verdict.entry(None, false).mobility.is_none());
    }
}

/// Stops after so many questions.
struct Impatient(std::cell::Cell<usize>);

impl Watch for Impatient {
    fn progress(&mut self, _stage: &'static str, _done: usize, _total: usize) {}

    fn stopped(&self) -> bool {
        let left = self.0.get();
        self.0.set(left.saturating_sub(1));
        left == 0
    }
}

#[test]
fn a_verdict_can_be_stopped_wherever_it_is() {
    let model = torus(10, false);
    let nothing = Fingerprint::of_nothing;
    let stops = |patience: usize| {
        let mut watch = Impatient(patience.into());
        judge(&model, &criteria(), nothing(), &mut watch) == Err(Stopped)
    };
    let mut watch = Impatient(1000.into());
    assert!(judge(&model, &criteria(), nothing(), &mut watch).is_ok());
    let questions = 1000 - watch.0.get();
    assert!((0..questions).step_by(3).chain([questions - 1]).all(stops));
    let mut watch = Impatient(3.into());
    assert_eq!(remedies(&model, &criteria(), 2, &mut watch), Err(Stopped));
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
