//! Planarising: what must hold whatever the mesh (issue "planar fins from any mesh").

use finwright::design::planarise::{Options, PlanariseError, Planarised, planarise};
use finwright::diagnostic::Finding;
use finwright::geometry::{Point3, Vector3, trig};
use finwright::ids::NodeId;
use finwright::structure::{AxisRule, Draft, planarity};
use finwright::units::Unit;

const N: usize = 9;

/// A wavy grid of quads with one cut into triangles and one missing, axes along normals.
fn wavy() -> Draft {
    let at = |i: usize, j: usize| {
        let (x, y) = (i as f64, j as f64);
        let z = 16.0 * trig::sin(0.7 * x + 0.3 * y) + 7.0 * trig::cos(0.16 * y * x);
        Point3::new(60.0 * x + 5.0 * trig::sin(y), 55.0 * y, z)
    };
    let positions: Vec<Point3> = (0..N * N).map(|k| at(k % N, k / N)).collect();
    let mut faces = Vec::new();
    for k in (0..N * (N - 1)).filter(|k| k % N < N - 1) {
        let [a, b, c, d] = [k, k + 1, k + N + 1, k + N];
        match k {
            31 => faces.extend([vec![a, b, c], vec![a, c, d]]),
            41 => {}
            _ => faces.push(vec![a, b, c, d]),
        }
    }
    with_normals(positions, faces)
}

fn with_normals(positions: Vec<Point3>, faces: Vec<Vec<usize>>) -> Draft {
    let axes = AxisRule::Normal.axes(&positions, &faces).unwrap();
    Draft { name: "wavy".into(), positions, axes, faces, ..Draft::default() }
        .with_depth(20.0, 20.0)
}

fn made(draft: Draft) -> Planarised {
    planarise(draft, &Options::default(), &mut ()).unwrap()
}

/// Planarity by its definition in docs/formulas.md §3, from the draft alone.
fn worst(draft: &Draft) -> f64 {
    let shares = draft.fin_ids().into_iter().map(|fin| {
        let [i, j] = fin.ends();
        let end =
            |k: NodeId, by: f64| draft.positions[k] + draft.axes[k].normalize() * by;
        let (off, diameter) = planarity(&[
            end(i, -draft.below[i]),
            end(j, -draft.below[j]),
            end(j, draft.above[j]),
            end(i, draft.above[i]),
        ]);
        off / diameter
    });
    shares.fold(0.0, f64::max)
}

/// The largest distance between nodes, mm, and between axes.
fn off(a: &Draft, b: &Draft) -> [f64; 2] {
    let points = a.positions.iter().zip(&b.positions).map(|(p, q)| (p - q).norm());
    let axes = a.axes.iter().zip(&b.axes).map(|(p, q)| (p - q).norm());
    [points.fold(0.0, f64::max), axes.fold(0.0, f64::max)]
}

fn same(a: &Draft, b: &Draft) {
    let [points, axes] = off(a, b);
    assert!(points < 1e-6 && axes < 1e-8, "nodes {points} mm, axes {axes}");
}

/// The draft with every node and axis turned about an oblique line, then moved.
fn turned(mut draft: Draft) -> Draft {
    let line = Vector3::new(1.0, -2.0, 0.5).normalize();
    let (s, c) = (trig::sin(0.9), trig::cos(0.9));
    // Rodrigues' formula.
    let turn =
        |v: Vector3| v * c + line.cross(&v) * s + line * (line.dot(&v) * (1.0 - c));
    for point in &mut draft.positions {
        *point = Point3::from(turn(point.coords) + Vector3::new(3000.0, -200.0, 70.0));
    }
    draft.axes.iter_mut().for_each(|axis| *axis = turn(*axis));
    draft
}

#[test]
fn a_wavy_mesh_gets_planar_fins_near_it() {
    let given = wavy();
    let result = made(given.clone());
    assert!(result.figures.before.worst > 0.01);
    assert!(worst(&result.draft) < 1e-8, "{}", worst(&result.draft));
    assert!((worst(&result.draft) - result.figures.after.worst).abs() < 1e-12);
    assert_eq!(result.figures.reversed_faces, 0);
    assert!(off(&given, &result.draft)[0] < 0.21 * 60.0);
    assert!(result.figures.largest_turn.to_degrees() < 25.0, "{:?}", result.figures);
    assert_eq!(result.draft.faces, given.faces);
}

#[test]
fn a_moved_and_turned_mesh_gives_the_result_moved_and_turned() {
    same(&turned(made(wavy()).draft), &made(turned(wavy())).draft);
}

#[test]
fn a_scaled_mesh_gives_the_scaled_result() {
    same(&made(wavy()).draft.scaled(37.0), &made(wavy().scaled(37.0)).draft);
}

#[test]
fn numbers_of_nodes_and_order_of_faces_do_not_matter() {
    // 31 and 81 have no common factor.
    let place = |k: usize| (31 * k + 5) % (N * N);
    let draft = wavy();
    let mut shuffled = draft.clone();
    for k in 0..N * N {
        shuffled.positions[place(k)] = draft.positions[k];
        shuffled.axes[place(k)] = draft.axes[k];
    }
    let renamed = |face: &Vec<usize>| face.iter().map(|&k| place(k)).collect();
    shuffled.faces = draft.faces.iter().rev().map(renamed).collect();
    let (straight, shuffled) = (made(draft).draft, made(shuffled).draft);
    let mut back = straight.clone();
    for k in 0..N * N {
        back.positions[k] = shuffled.positions[place(k)];
        back.axes[k] = shuffled.axes[place(k)];
    }
    same(&straight, &back);
}

#[test]
fn planar_input_comes_back_unchanged() {
    for rule in ["0,0,1", "point"] {
        let mut draft = wavy();
        let axes = match rule {
            "point" => AxisRule::Through(Point3::new(200.0, 200.0, -900.0)),
            _ => AxisRule::Parallel(Vector3::z()),
        };
        draft.axes = axes.axes(&draft.positions, &draft.faces).unwrap();
        let result = made(draft.clone());
        assert_eq!(result.draft.positions, draft.positions);
        assert_eq!(result.draft.axes, draft.axes);
        assert!(result.history.is_empty());
    }
}

#[test]
fn a_result_given_again_stays() {
    let once = made(wavy()).draft;
    let again = made(once.clone()).draft;
    assert_eq!(once, again);
}

#[test]
fn held_nodes_and_axes_stay() {
    let given = wavy();
    let options =
        Options { fixed_nodes: vec![40, 50], fixed_axes: vec![22], ..Options::default() };
    let result = planarise(given.clone(), &options, &mut ()).unwrap().draft;
    assert_eq!(result.positions[40], given.positions[40]);
    assert_eq!(result.positions[50], given.positions[50]);
    assert_eq!(result.axes[22], given.axes[22].normalize());
    assert!(worst(&result) < 1e-4);
}

fn refused(draft: Draft) -> Vec<String> {
    let code = |finding: Finding| finding.code.to_string();
    match planarise(draft, &Options::default(), &mut ()) {
        Err(PlanariseError::Refused(findings)) => {
            findings.into_iter().map(code).collect()
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_is_no_surface_is_refused_with_a_finding() {
    let mut flipped = wavy();
    flipped.faces[20].reverse();
    assert!(refused(flipped).contains(&"design::faces_turned".to_owned()));

    let mut fans = wavy();
    fans.faces.retain(|face| !(face.contains(&22) && face.contains(&23)));
    fans.faces.retain(|face| !(face.contains(&21) && face.contains(&22)));
    fans.faces.push(vec![22, 14, 23]);
    fans.faces.push(vec![22, 30, 21]);
    assert!(refused(fans).contains(&"design::several_fans".to_owned()));

    let mut nowhere = wavy();
    nowhere.positions[7].y = f64::NAN;
    assert_eq!(refused(nowhere), ["structure::not_finite"]);

    let mut flat = wavy();
    flat.positions[11] = flat.positions[10];
    assert!(!refused(flat).is_empty());
}

#[test]
fn a_moebius_strip_is_refused() {
    let count = 14;
    let end = |k: usize, side: f64| {
        let turn = std::f64::consts::TAU * k as f64 / count as f64;
        let radius = 200.0 + 30.0 * side * trig::cos(turn / 2.0);
        let z = 30.0 * side * trig::sin(turn / 2.0);
        Point3::new(radius * trig::cos(turn), radius * trig::sin(turn), z)
    };
    let positions = (0..count).flat_map(|k| [end(k, -1.0), end(k, 1.0)]).collect();
    let mut faces: Vec<Vec<usize>> =
        (0..count - 1).map(|k| vec![2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1]).collect();
    faces.push(vec![2 * count - 2, 1, 0, 2 * count - 1]);
    assert_eq!(refused(with_normals(positions, faces)), ["structure::not_orientable"]);
}

#[test]
fn a_node_without_faces_takes_no_part() {
    let mut draft = wavy();
    draft.positions.push(Point3::new(1e4, 0.0, 0.0));
    draft.axes.push(Vector3::z());
    let draft = draft.with_depth(20.0, 20.0);
    let result = made(draft.clone()).draft;
    assert_eq!(result.positions[N * N], draft.positions[N * N]);
    assert!(worst(&result) < 1e-8);
}

#[test]
fn exchange_forms_bring_the_axes_back() {
    use finwright::structure::{ObjOptions, Structure, interop, read_obj};
    let draft = made(wavy()).draft;
    let (structure, _) = Structure::new(draft.clone(), &Default::default()).unwrap();
    let mesh = |text: &str| {
        let options =
            ObjOptions { unit: Unit::Millimetre, axes: AxisRule::Normal, weld_mm: 0.0 };
        read_obj(text, &options).unwrap().0
    };
    let [lower, upper] = interop::write_pair(&structure).map(|text| mesh(&text));
    let between = interop::between(lower, &upper).unwrap();
    let unit = |mut draft: Draft| {
        for axis in &mut draft.axes {
            axis.normalize_mut();
        }
        draft
    };
    same(&unit(between), &draft);
    let [base, lines] = interop::write_lines(&structure);
    let mut read = mesh(&base);
    read.axes = interop::axes_from_lines(&read, &lines, Unit::Millimetre).unwrap();
    same(&unit(read), &draft);
    let compas = interop::write_compas(&structure);
    assert!(interop::is_compas(&compas));
    let read = interop::read_compas(&compas, Unit::Millimetre, AxisRule::File).unwrap().0;
    same(&read, &draft);
    assert_eq!(read.fin_ids().len(), draft.fin_ids().len());
}

/// `finwright planarise fixtures/vault.obj --smooth 8 --boundary-fins --depth 12,12`
#[test]
fn the_vault_still_comes_out_of_its_mesh() {
    use finwright::design::planarise::smoothed_axes;
    use finwright::structure::{ObjOptions, read_json, read_obj};
    let text = |name: &str| {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(root.join("fixtures").join(name)).unwrap()
    };
    let options =
        ObjOptions { unit: Unit::Millimetre, axes: AxisRule::File, weld_mm: 0.0 };
    let mut mesh =
        read_obj(&text("vault.obj"), &options).unwrap().0.with_depth(12.0, 12.0);
    mesh.axes = smoothed_axes(&mesh, 8);
    let options = Options { boundary_fins: true, ..Options::default() };
    let found = planarise(mesh, &options, &mut ()).unwrap().draft;
    let (stored, _) = read_json(&text("vault.json"), AxisRule::File).unwrap();
    same(&found, &stored);
}
