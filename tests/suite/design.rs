//! From reference surfaces to structures: what has to hold of every design, and what the
//! embedded surfaces reach.

use finwright::design::surface::{Polygons, Surface, clean};
use finwright::design::{
    Align, Designed, SURFACES, SingularWish, Size, Wishes, design, surface_named,
};
use finwright::geometry::{Point3, Vector3, trig};
use std::process::Command;

fn wishes(size: Size, align: Align) -> Wishes {
    Wishes { size, align, ..Wishes::default() }
}

fn surface(polygons: Polygons) -> Surface {
    clean(polygons).unwrap().0
}

/// Designs and checks what has to hold always.
fn sound(surface: &Surface, wishes: &Wishes) -> Designed {
    let designed = design(surface, "test", wishes, &mut ()).unwrap();
    let figures = &designed.figures;
    assert_eq!((figures.flipped, figures.reversed), (0, 0));
    assert_eq!(figures.euler, surface.euler());
    assert!(figures.planarity_percent.after.max <= 1e-6, "{figures:?}");
    if wishes.align != Align::None || surface.boundary().is_empty() {
        assert!(designed.draft.faces.iter().all(|face| face.len() == 4));
    }
    designed
}

fn valences(designed: &Designed) -> Vec<usize> {
    let mut valences: Vec<usize> =
        designed.figures.singular.iter().map(|node| node.valence).collect();
    valences.sort_unstable();
    valences
}

#[test]
fn embedded_surfaces_reach_their_figures() {
    // Least share in band, largest turn of an axis, most singular nodes; trimmed, aligned.
    let limits = [
        ("hill", [(0.75, 6.5, 10), (0.70, 20.0, 14)]),
        ("court", [(0.90, 6.5, 8), (0.80, 30.0, 14)]),
        ("dome-surface", [(0.95, 4.0, 6), (0.75, 6.0, 6)]),
    ];
    for (name, limits) in limits {
        let surface = surface((surface_named(name).unwrap().polygons)());
        for (align, (in_band, turn, singular)) in
            [Align::None, Align::Boundary].iter().zip(limits)
        {
            let designed = sound(&surface, &wishes(Size::Cell(40.0), *align));
            let figures = &designed.figures;
            let reached = format!(
                "{name} {align:?}: {:.3} in band, {:.1}° of turn, {:?} singular",
                figures.edge.in_band,
                figures.axis_turn_deg.max,
                valences(&designed)
            );
            assert!(figures.edge.in_band >= in_band, "{reached}");
            assert!(figures.axis_turn_deg.max <= turn, "{reached}");
            assert!(figures.singular.len() <= singular, "{reached}");
        }
    }
}

#[test]
fn moved_turned_scaled_and_renumbered_the_design_is_the_same() {
    let given = (surface_named("dome-surface").unwrap().polygons)();
    let count = given.positions.len();
    let axis = Vector3::new(0.3, -0.5, 0.8);
    let turn = nalgebra::Rotation3::new(axis * 1.1);
    let moved = |p: &Point3| turn * (p * 37.0) + Vector3::new(1e4, -3e3, 700.0);
    // A prime that does not divide the count: every number once.
    let number = |k: usize| (k * 7919 + 13) % count;
    let mut positions = vec![Point3::origin(); count];
    given.positions.iter().enumerate().for_each(|(k, p)| positions[number(k)] = moved(p));
    let mut faces: Vec<Vec<usize>> = given
        .faces
        .iter()
        .map(|face| face.iter().cycle().skip(1).take(3).map(|&k| number(k)).collect())
        .collect();
    faces.reverse();
    let first = sound(&surface(given), &wishes(Size::Cell(40.0), Align::None));
    let other = Polygons { positions, faces, axes: None };
    let other = sound(&surface(other), &wishes(Size::Cell(40.0 * 37.0), Align::None));
    assert_eq!(valences(&first), valences(&other));
    let nodes = [first.figures.nodes, other.figures.nodes];
    assert!(nodes[0].abs_diff(nodes[1]) * 50 <= nodes[0], "{nodes:?}");
    let turns = [first, other].map(|designed| designed.figures.axis_turn_deg.max);
    assert!((turns[0] - turns[1]).abs() < 0.5, "{turns:?}");
}

/// A patch over a grid, of this height.
fn patch(columns: usize, rows: usize, height: impl Fn(f64, f64) -> f64) -> Polygons {
    let at = |i: usize, j: usize| j * (columns + 1) + i;
    let mut polygons = Polygons::default();
    for j in 0..=rows {
        for i in 0..=columns {
            let (x, y) = (20.0 * i as f64, 20.0 * j as f64);
            polygons.positions.push(Point3::new(x, y, height(x, y)));
            if i < columns && j < rows {
                polygons.faces.push(vec![
                    at(i, j),
                    at(i + 1, j),
                    at(i + 1, j + 1),
                    at(i, j + 1),
                ]);
            }
        }
    }
    polygons
}

#[test]
fn a_flat_surface_gets_an_exact_grid() {
    let flat = surface(patch(20, 12, |_, _| 0.0));
    let designed = sound(&flat, &wishes(Size::Cell(40.0), Align::Boundary));
    let figures = &designed.figures;
    assert_eq!((figures.nodes, figures.faces), (11 * 7, 10 * 6));
    assert!(figures.axis_turn_deg.max < 1e-6 && figures.edge.p95 < 40.001, "{figures:?}");
}

#[test]
fn a_closed_surface_has_eight_nodes_of_three_fins_more_than_of_five() {
    // An octahedron, cut finer and blown up to an ellipsoid.
    let mut polygons = Polygons::default();
    let steps: usize = 12;
    for octant in 0..8 {
        let sign = |bit: usize| if octant >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let first = polygons.positions.len();
        let row = |i: usize| first + i * (i + 1) / 2;
        for i in 0..=steps {
            for j in 0..=i {
                let (x, y, z) = ((i - j) as f64, j as f64, (steps - i) as f64);
                let out = Vector3::new(x * sign(0), y * sign(1), z * sign(2)).normalize();
                polygons.positions.push(Point3::new(
                    300.0 * out.x,
                    220.0 * out.y,
                    170.0 * out.z,
                ));
                if i < steps {
                    polygons.faces.push(vec![
                        row(i) + j,
                        row(i + 1) + j,
                        row(i + 1) + j + 1,
                    ]);
                }
                if i < steps && j < i {
                    polygons.faces.push(vec![
                        row(i) + j,
                        row(i + 1) + j + 1,
                        row(i) + j + 1,
                    ]);
                }
            }
        }
    }
    let closed = surface(polygons);
    assert_eq!(closed.euler(), 2);
    let designed = sound(&closed, &wishes(Size::Cell(45.0), Align::None));
    let missing: i64 =
        designed.figures.singular.iter().map(|node| 4 - node.valence as i64).sum();
    assert_eq!(missing, 8);
}

#[test]
fn the_wanted_number_of_nodes_is_met_within_a_tenth() {
    let hill = surface((SURFACES[0].polygons)());
    for wanted in [250, 700] {
        let designed = sound(&hill, &wishes(Size::Nodes(wanted), Align::None));
        let nodes = designed.figures.nodes;
        assert!(nodes.abs_diff(wanted) * 10 <= wanted, "{nodes} for {wanted}");
    }
}

#[test]
fn random_surfaces_give_a_sound_net_or_a_named_refusal() {
    let mut seed = 7_u64;
    let mut random = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / (1_u64 << 31) as f64
    };
    for round in 0..20 {
        let [a, b, c, d] = [random(), random(), random(), random()];
        let noise: Vec<f64> = (0..200).map(|_| (random() - 0.5) * 4.0 * d).collect();
        let height = |x: f64, y: f64| {
            let wave = 60.0
                * a
                * trig::sin(x / (40.0 + 80.0 * b))
                * trig::cos(y / (30.0 + 90.0 * c));
            wave + noise[((x + 3.0 * y) / 20.0) as usize % noise.len()]
        };
        let surface = surface(patch(16, 12, height));
        let cell = 10.0 + 90.0 * random();
        let align = if round % 2 == 0 { Align::None } else { Align::Auto };
        match design(&surface, "random", &wishes(Size::Cell(cell), align), &mut ()) {
            Ok(designed) => assert_eq!(designed.figures.euler, 1, "round {round}"),
            Err(finwright::design::planarise::PlanariseError::Refused(findings)) => {
                assert!(!findings.is_empty(), "round {round}");
            }
            Err(other) => panic!("round {round}: {other:?}"),
        }
    }
}

#[test]
fn the_command_designs_on_the_embedded_hill_and_says_what_it_reached() {
    let run = || {
        let output = Command::new(env!("CARGO_BIN_EXE_finwright"))
            .args(["design", "--nodes", "300", "--json"])
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    };
    let first = run();
    assert_eq!(first, run());
    let report: serde_json::Value = serde_json::from_slice(&first).unwrap();
    for key in ["nodes", "fins", "euler", "singular", "edge", "axis_turn_deg", "findings"]
    {
        assert!(report.get(key).is_some(), "{key}");
    }
    assert_eq!(report["euler"], 1);
}

#[test]
fn singular_nodes_are_where_they_are_wanted_and_nowhere_else() {
    let hill = surface((surface_named("hill").unwrap().polygons)());
    let none = Wishes {
        singular: SingularWish::At(Vec::new()),
        ..wishes(Size::Cell(40.0), Align::None)
    };
    assert_eq!(valences(&sound(&hill, &none)), Vec::<usize>::new());
    let dome = surface((surface_named("dome-surface").unwrap().polygons)());
    let places = [(200.0, 160.0), (-200.0, 160.0), (-200.0, -160.0), (200.0, -160.0)];
    let places = places.map(|(x, y)| (Point3::new(x, y, 200.0), 3));
    let four = Wishes {
        singular: SingularWish::At(places.to_vec()),
        ..wishes(Size::Cell(40.0), Align::None)
    };
    let designed = sound(&dome, &four);
    assert_eq!(valences(&designed), [3; 4]);
    for node in &designed.figures.singular {
        let [x, y, _] = node.position;
        assert!(
            (x.abs() - 200.0).abs() < 30.0 && (y.abs() - 160.0).abs() < 30.0,
            "{node:?}"
        );
    }
}

#[test]
fn even_cells_are_paid_for_by_axes_and_both_are_said() {
    let hill = surface((surface_named("hill").unwrap().polygons)());
    let plain = sound(&hill, &wishes(Size::Cell(40.0), Align::None));
    let even = Wishes { even: true, ..wishes(Size::Cell(40.0), Align::None) };
    let even = sound(&hill, &even);
    let in_band = [&plain, &even].map(|designed| designed.figures.edge.in_band);
    assert!(in_band[1] > in_band[0], "{in_band:?}");
    assert!(even.figures.axis_turn_deg.max <= 13.0);
    assert!(even.findings.iter().any(|finding| finding.code == "design::evened"));
}

/// A surface of triangles in five formats, each with its ending.
fn in_all_formats(surface: &Surface) -> [(&'static str, Vec<u8>); 5] {
    let corners =
        |t: &[usize; 3]| t.map(|k| surface.positions[k].coords.map(|x| x as f32));
    let (mut obj, mut stl) = (String::new(), "solid s\n".to_owned());
    let mut stl_binary = vec![b' '; 80];
    stl_binary.extend((surface.triangles.len() as u32).to_le_bytes());
    let head = |format: &str| {
        let (v, f) = (surface.positions.len(), surface.triangles.len());
        format!(
            "ply\nformat {format} 1.0\nelement vertex {v}\nproperty float x\n\
             property float y\nproperty float z\nelement face {f}\n\
             property list uchar int vertex_index\nend_header\n"
        )
    };
    let mut little = head("binary_little_endian").into_bytes();
    let mut big = head("binary_big_endian").into_bytes();
    for p in &surface.positions {
        let p = p.coords.map(|x| x as f32);
        obj += &format!("v {} {} {}\n", f64::from(p.x), f64::from(p.y), f64::from(p.z));
        p.iter().for_each(|x| little.extend(x.to_le_bytes()));
        p.iter().for_each(|x| big.extend(x.to_be_bytes()));
    }
    for t in &surface.triangles {
        obj += &format!("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
        stl += "facet normal 0 0 0\nouter loop\n";
        stl_binary.extend([0; 12]);
        for p in corners(t) {
            stl += &format!(
                "vertex {} {} {}\n",
                f64::from(p.x),
                f64::from(p.y),
                f64::from(p.z)
            );
            p.iter().for_each(|x| stl_binary.extend(x.to_le_bytes()));
        }
        stl += "endloop\nendfacet\n";
        stl_binary.extend([0; 2]);
        little.push(3);
        big.push(3);
        t.iter().for_each(|&k| little.extend((k as i32).to_le_bytes()));
        t.iter().for_each(|&k| big.extend((k as i32).to_be_bytes()));
    }
    [
        ("obj", obj.into_bytes()),
        ("stl", stl.into_bytes()),
        ("STL", stl_binary),
        ("ply", little),
        ("PLY", big),
    ]
}

#[test]
fn obj_stl_and_ply_give_the_same_bytes() {
    let place = tempfile::tempdir().unwrap();
    let surface = surface(patch(12, 9, |x, y| 40.0 * trig::sin(x / 70.0 + y / 90.0)));
    let designed = |(ending, bytes): &(&str, Vec<u8>)| {
        let dir = place.path().join(ending);
        std::fs::create_dir_all(&dir).unwrap();
        let path = dir.join(format!("patch.{ending}"));
        std::fs::write(&path, bytes).unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_finwright"))
            .args(["design", "--cell", "30", path.to_str().unwrap(), "-q"])
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    };
    let files = in_all_formats(&surface);
    let first = designed(&files[0]);
    assert!(first.len() > 1000);
    for file in &files[1..] {
        assert!(first == designed(file), "{}", file.0);
    }
}

/// Code and message of the error that a surface is refused with.
fn refusal(polygons: Polygons) -> (String, String) {
    let findings = clean(polygons).unwrap_err();
    (findings[0].code.clone(), findings[0].message.clone())
}

#[test]
fn faults_of_a_surface_are_named_with_their_place() {
    let flat = || patch(4, 3, |_, _| 0.0);
    let mut wall = flat();
    wall.positions.push(Point3::new(30.0, 20.0, 50.0));
    wall.faces.push(vec![6, 7, 20]);
    let (code, message) = refusal(wall);
    assert_eq!(code, "surface::not_manifold");
    assert!(message.contains("(20.0, 20.0, 0.0)"), "{message}");
    let mut unwelded = flat();
    let other = patch(2, 2, |_, _| 0.0);
    let shift = Vector3::new(80.001, 0.0, 0.0);
    unwelded.faces.extend(other.faces.iter().map(|f| f.iter().map(|k| k + 20).collect()));
    unwelded.positions.extend(other.positions.iter().map(|p| p + shift));
    let (code, message) = refusal(unwelded);
    assert_eq!(code, "surface::several_pieces");
    assert!(message.contains("(80.0, 0.0, 0.0)"), "{message}");
    let mut folded = flat();
    folded.positions[9].x = 20.0;
    let (_, findings) = clean(folded).unwrap();
    assert!(findings.iter().any(|f| f.code == "surface::folded"), "{findings:?}");
    let mut thin = flat();
    thin.faces.push(vec![0, 1, 1]);
    let (_, findings) = clean(thin).unwrap();
    assert!(findings.iter().any(|f| f.code == "surface::faces_without_area"));
}

fn finwright(place: &std::path::Path, words: &[&str]) -> std::process::Output {
    let binary = env!("CARGO_BIN_EXE_finwright");
    Command::new(binary).current_dir(place).args(words).output().unwrap()
}

fn json(path: &std::path::Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

#[test]
fn families_and_design_are_kept_by_planarise_and_make() {
    let place = tempfile::tempdir().unwrap();
    let here = place.path();
    let run = |words: &str| {
        let output = finwright(here, &words.split(' ').collect::<Vec<_>>());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    run("design hill --cell 120 --align boundary --boundary-fins -o a.json -q");
    let given = json(&here.join("a.json"));
    let families = given["families"].as_array().unwrap();
    assert_eq!(families.len(), given["fins"].as_array().unwrap().len());
    assert!([1, 2].iter().all(|k| families.iter().filter(|f| *f == k).count() > 50));
    assert_eq!(given["design"]["surface"], "hill");
    // Strips follow families: every fin of a strip is of one.
    let fins: Vec<serde_json::Value> = given["fins"].as_array().unwrap().clone();
    let family = |a: &serde_json::Value, b: &serde_json::Value| {
        let is = |f: &serde_json::Value| {
            (&f[0] == a && &f[1] == b) || (&f[0] == b && &f[1] == a)
        };
        families[fins.iter().position(is).unwrap()].clone()
    };
    for strip in given["strips"].as_array().unwrap() {
        let nodes = strip.as_array().unwrap();
        let all: Vec<_> =
            nodes.windows(2).map(|step| family(&step[0], &step[1])).collect();
        assert!(all.iter().all(|f| *f == all[0]), "{strip}");
    }
    run("planarise a.json -o b.json -q");
    run("make b.json --scale 1:2 --effort quick --accept-flexible test -o job -q");
    let made = json(&here.join("job/structure.json"));
    assert_eq!(made["families"], given["families"]);
    let cells = [&given, &made].map(|file| file["design"]["cell"][0].as_f64().unwrap());
    assert!((cells[0] - 120.0).abs() < 1e-9 && (cells[1] - 60.0).abs() < 1e-9);
    let text = std::fs::read_to_string(here.join("a.json")).unwrap();
    let wrong = text.replacen("\"families\": [1,", "\"families\": [3,", 1);
    let wrong = wrong.replacen("\"families\": [2,", "\"families\": [3,", 1);
    std::fs::write(here.join("wrong.json"), wrong).unwrap();
    let refused = finwright(here, &["check", "wrong.json"]);
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(
        !refused.status.success() && told.contains("structure::bad_family"),
        "{told}"
    );
}

/// Designs on an embedded surface, makes the job and reads it back.
fn made_and_verified(surface: &[&str], make: &[&str]) -> serde_json::Value {
    let place = tempfile::tempdir().unwrap();
    let design = [&["design"], surface, &["-o", "s.json", "-q", "--json"]].concat();
    let designed = finwright(place.path(), &design);
    assert!(designed.status.success());
    let make =
        [&["make", "s.json", "-o", "job", "-q", "--effort", "quick"], make].concat();
    for words in [&make[..], &["verify", "job", "-q"]] {
        let output = finwright(place.path(), words);
        assert!(
            output.status.success(),
            "{words:?}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
    serde_json::from_slice(&designed.stdout).unwrap()
}

#[test]
fn every_embedded_surface_goes_through_make_and_verify() {
    for name in ["hill", "court", "dome-surface"] {
        made_and_verified(&[name, "--cell", "150"], &[]);
    }
}

#[test]
fn nodes_of_three_and_five_fins_are_made_in_hubs() {
    let surface = ["hill", "--cell", "80", "--align", "boundary"];
    let report = made_and_verified(&surface, &["--joint", "hub"]);
    let valences: Vec<u64> = report["singular"]
        .as_array()
        .unwrap()
        .iter()
        .map(|n| n["valence"].as_u64().unwrap())
        .collect();
    assert!(valences.contains(&3) && valences.contains(&5), "{valences:?}");
}

#[test]
fn fins_of_both_families_have_the_lengths_asked_for() {
    let wave = surface(patch(30, 20, |x, y| 30.0 * trig::sin(x / 150.0 + y / 400.0)));
    let long = Wishes {
        size: Size::Cell((60.0_f64 * 30.0).sqrt()),
        aspect: 2.0,
        ..wishes(Size::Cell(40.0), Align::Boundary)
    };
    let draft = sound(&wave, &long).draft;
    let families = draft.families.clone().unwrap();
    for (family, wanted) in [(1, 60.0), (2, 30.0)] {
        let own = draft.fin_ids().into_iter().zip(&families);
        let own = own.filter(|(_, of)| **of == Some(family));
        let mut lengths: Vec<f64> = own
            .map(|(fin, _)| {
                let [a, b] = fin.ends().map(|node| draft.positions[node]);
                (a - b).norm()
            })
            .collect();
        lengths.sort_by(f64::total_cmp);
        let median = lengths[lengths.len() / 2];
        assert!((median / wanted - 1.0).abs() < 0.1, "family {family}: {median}");
    }
}

/// A roof of two slopes that meet in a crease at y = 140.
fn folded_roof() -> Polygons {
    patch(24, 16, |x, y| 200.0 - (y - 140.0).abs() + 10.0 * trig::sin(x / 160.0))
}

/// Fins with both ends on the plane y = `at`, and those that cross it.
fn along_and_across(designed: &Designed, at: f64) -> [usize; 2] {
    const NEAR: f64 = 0.5;
    let draft = &designed.draft;
    let side = |k: finwright::ids::NodeId| draft.positions[k].y - at;
    let ends = || draft.fin_ids().into_iter().map(|fin| fin.ends().map(side));
    let along = ends().filter(|ends| ends.iter().all(|y| y.abs() < NEAR)).count();
    let across = |[a, b]: &[f64; 2]| a.min(*b) < -NEAR && a.max(*b) > NEAR;
    [along, ends().filter(across).count()]
}

#[test]
fn no_fin_crosses_a_crease_that_is_followed() {
    let folded = surface(folded_roof());
    let plain = sound(&folded, &wishes(Size::Cell(40.0), Align::None));
    assert!(along_and_across(&plain, 140.0)[1] > 0);
    let folded = folded.following_creases(100.0);
    for align in [Align::None, Align::Boundary] {
        let designed = sound(&folded, &wishes(Size::Cell(40.0), align));
        let [along, across] = along_and_across(&designed, 140.0);
        assert!(across == 0 && along >= 10, "{align:?}: {along} along, {across} across");
        let off = designed.figures.surface_distance.max;
        assert!(off <= 0.01 * designed.figures.edge.wanted, "{align:?}: {off}");
    }
}

#[test]
fn fins_run_along_every_piece_of_a_curve_that_is_given() {
    let hill = surface(patch(24, 16, |x, y| 40.0 * trig::sin((x + y) / 150.0)));
    let height = |x: f64, y: f64| Point3::new(x, y, 40.0 * trig::sin((x + y) / 150.0));
    // Between lines of the grid, and a little oblique.
    let at = |x: f64| height(x, 150.0 + 0.05 * x);
    let curve: Vec<Point3> = (2..=22).map(|k| at(20.0 * f64::from(k))).collect();
    let (followed, missed) = hill.following(std::slice::from_ref(&curve));
    assert!(missed.is_empty());
    let designed = sound(&followed, &wishes(Size::Cell(40.0), Align::None));
    let draft = &designed.draft;
    for middle in curve.windows(2).map(|ends| nalgebra::center(&ends[0], &ends[1])) {
        let near = |fin: finwright::ids::FinId| {
            let [a, b] = fin.ends().map(|node| draft.positions[node]);
            let along = b - a;
            let share = (middle - a).dot(&along) / along.norm_squared();
            (a + along * share.clamp(0.0, 1.0) - middle).norm()
        };
        let nearest = draft.fin_ids().into_iter().map(near).fold(f64::INFINITY, f64::min);
        // A fifth of a fin: nodes slide on the surface when fins are made plane.
        assert!(nearest < 8.0, "{nearest} mm from {middle}");
    }
}

#[test]
fn a_disk_follows_its_rim_with_even_cells() {
    // Squares drawn out to a circle, so that triangles lead nowhere in particular.
    let mut polygons = patch(24, 24, |_, _| 0.0);
    for p in &mut polygons.positions {
        let (x, y) = (p.x / 240.0 - 1.0, p.y / 240.0 - 1.0);
        let (u, v) = (x * (1.0 - y * y / 2.0).sqrt(), y * (1.0 - x * x / 2.0).sqrt());
        *p = Point3::new(240.0 * u, 240.0 * v, 0.0);
    }
    let disk = surface(polygons);
    let designed = sound(&disk, &wishes(Size::Nodes(300), Align::Boundary));
    assert!(designed.figures.edge.in_band >= 0.75, "{:?}", designed.figures.edge);
}

#[test]
fn a_symmetric_surface_gets_a_symmetric_mesh() {
    let dome = surface((surface_named("dome-surface").unwrap().polygons)());
    for align in [Align::None, Align::Boundary] {
        let symmetric = Wishes { symmetry: true, ..wishes(Size::Nodes(300), align) };
        let designed = sound(&dome, &symmetric);
        let draft = &designed.draft;
        let nodes = draft.positions.len();
        assert!(nodes.abs_diff(300) <= 30, "{nodes}");
        for mirror in [Vector3::new(-1.0, 1.0, 1.0), Vector3::new(1.0, -1.0, 1.0)] {
            for p in &draft.positions {
                let image = Point3::from(p.coords.component_mul(&mirror));
                let far = |q: &Point3| (q - image).norm();
                let nearest =
                    draft.positions.iter().map(far).fold(f64::INFINITY, f64::min);
                assert!(nearest <= 1e-6, "{align:?}: {p} has no image: {nearest}");
            }
        }
    }
    // Without a mirror nothing changes.
    let hill = surface((surface_named("hill").unwrap().polygons)());
    let plain = wishes(Size::Cell(100.0), Align::None);
    let asked = Wishes { symmetry: true, ..plain.clone() };
    assert_eq!(sound(&hill, &asked).draft, sound(&hill, &plain).draft);
}

#[test]
fn a_design_is_judged_for_a_scale_and_a_material() {
    let place = tempfile::tempdir().unwrap();
    let codes = |scale: &str| {
        let words = ["design", "hill", "--cell", "150", "--for", scale, "--json", "-q"];
        let words = [&words[..], &["--seed", "7", "-o", "s.json"]].concat();
        let output = finwright(place.path(), &words);
        assert!(output.status.success());
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let findings = report["findings"].as_array().unwrap().clone();
        findings
            .iter()
            .map(|f| f["code"].as_str().unwrap().to_owned())
            .collect::<Vec<_>>()
    };
    assert!(codes("1:1").contains(&"design::fits_scale".to_owned()));
    assert!(codes("1:40,pmma-cast-3").contains(&"design::not_at_scale".to_owned()));
    assert_eq!(json(&place.path().join("s.json"))["design"]["seed"], 7);
}
