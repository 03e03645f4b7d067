//! Brackets against a conic program, and their proofs against the points alone.

use super::close;
use super::nets::{combescure, held_all_round, parallel, radial, torus};
use crate::geometry::Vector3;
use crate::rigidity::Bracket;
use crate::rigidity::amplify::{Bracketing, Load};
use crate::rigidity::system::System;

/// Sway over play by a conic program: bodies' motions and pins' velocities are unknowns,
/// each contact within 1 of its pin.
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
    for (body, couplings) in model.incidence.iter().enumerate() {
        let motions = &system.motions[body];
        let mut row = 0;
        for &coupling in couplings {
            for point in 0..model.couplings[coupling].points.len() {
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
                    if let Some(at) = system.coupling_at[coupling] {
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
    for (body, couplings) in model.incidence.iter().enumerate() {
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        let points = model.points(body);
        let mut moved = nalgebra::DVector::zeros(3 * points.len());
        let mut rigid = nalgebra::DMatrix::zeros(3 * points.len(), 6);
        let mut k = 0;
        for &coupling in couplings {
            for (end, q) in model.couplings[coupling].points.iter().enumerate() {
                let three = |of: &[f64]| Vector3::new(of[row], of[row + 1], of[row + 2]);
                let (f, off) = (three(&proof.forces), three(&proof.off));
                force += f;
                moment += q.coords.cross(&f);
                assert!(off.norm() <= 1.0 + 1e-9, "a contact leaves its pin too far");
                let at = system.coupling_at[coupling].map(|at| at + 3 * end);
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
        ("torus fins, every joint stiff", torus(5, false).stiff()),
    ];
    for (name, model) in cases {
        let system = System::new(&model, None, 1);
        let rigid = if system.floats { system.rigid() } else { Vec::new() };
        let middle = model.couplings.len() / 2;
        let coupling = (0..model.couplings.len())
            .filter(|&k| model.couplings[k].is_pin() && !model.couplings[k].held)
            .min_by_key(|k| k.abs_diff(middle))
            .unwrap();
        let load = Load::new(&system, &rigid, coupling, Vector3::z()).unwrap();
        let known = by_cone_program(&system, &load);
        let factor = system.factor().unwrap();
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
        assert!(upper <= 1.25 * lower, "{name}: [{lower}, {upper}], {known}");
        check_proofs(&system, &found);
    }
}
