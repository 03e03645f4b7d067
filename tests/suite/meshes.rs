//! Meshes with common defects are told what they have, and a way out.

use std::fs;
use std::path::Path;
use std::process::Command;

fn run(place: &Path, words: &[&str]) -> (i32, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_finwright"))
        .args(words)
        .current_dir(place)
        .output()
        .expect("the binary was built");
    let said = String::from_utf8(output.stderr).expect("it is text");
    (output.status.code().expect("it ended by itself"), said)
}

fn height(x: f64, y: f64) -> f64 {
    20.0 - (x * x + y * y) / 400.0
}

/// Each of three by three panels with vertices of its own, `gap` apart.
fn unwelded(gap: f64) -> String {
    let (mut text, mut faces) = (String::new(), String::new());
    for k in 0..9 {
        let (i, j) = (f64::from(k % 3), f64::from(k / 3));
        for (a, b) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            let (x, y) = (50.0 * (i + a) - 75.0, 50.0 * (j + b) - 75.0);
            let off = gap * f64::from(k);
            text += &format!("v {} {y} {}\n", x + off, height(x, y));
        }
        let first = 4 * k + 1;
        faces += &format!("f {first} {} {} {}\n", first + 1, first + 2, first + 3);
    }
    text + &faces
}

/// A grid of three by three panels; `y_up` has y upward.
fn grid(y_up: bool) -> String {
    let mut text = String::new();
    for k in 0..16 {
        let (x, y) = (50.0 * f64::from(k % 4) - 75.0, 50.0 * f64::from(k / 4) - 75.0);
        let z = height(x, y);
        text += &if y_up {
            format!("v {x} {z} {}\n", -y)
        } else {
            format!("v {x} {y} {z}\n")
        };
    }
    for k in (0..12).filter(|k| k % 4 < 3) {
        text += &format!("f {} {} {} {}\n", k + 1, k + 2, k + 6, k + 5);
    }
    text
}

const UP: [&str; 2] = ["--axes", "0,0,1"];

#[test]
fn panels_that_only_lie_together_are_an_error_with_a_way_out() {
    let place = tempfile::tempdir().expect("there is room");
    fs::write(place.path().join("panels.obj"), unwelded(0.0)).expect("it can be written");
    for command in ["check", "make", "rigidity", "planarise"] {
        let (code, said) =
            run(place.path(), &[&[command, "panels.obj"], &UP[..]].concat());
        assert_eq!(code, 3, "{command}: {said}");
        assert!(said.contains("structure::coincident_nodes"), "{command}: {said}");
        assert!(said.contains("--weld") && said.contains("nodes 1 and 4 are"), "{said}");
    }
    let welded = [&["check", "panels.obj", "--weld", "0.01"], &UP[..]].concat();
    let (_, said) = run(place.path(), &welded);
    assert!(said.contains("36 vertices of the file became 16 nodes"), "{said}");
    assert!(said.contains("24 fins"), "{said}");
    assert!(!said.contains("all_held"), "{said}");
}

#[test]
fn a_vertex_given_twice_in_a_seam_is_found_by_its_number() {
    let place = tempfile::tempdir().expect("there is room");
    // The last face takes a second vertex at the place of the sixth.
    let mesh = grid(false);
    let corner = format!("v -25 -25 {}\n", height(-25.0, -25.0));
    let (vertices, faces) = mesh.split_at(mesh.find("f ").expect("it has faces"));
    let faces = faces.replacen("f 6 7 11 10", "f 17 7 11 10", 1);
    let mesh = format!("{vertices}{corner}{faces}");
    fs::write(place.path().join("seam.obj"), mesh).expect("it can be written");
    let (code, said) = run(place.path(), &[&["check", "seam.obj"], &UP[..]].concat());
    assert_eq!(code, 3);
    assert!(said.contains("nodes 5 and 16 are at one place"), "{said}");
    let welded = [&["check", "seam.obj", "--weld", "0.001"], &UP[..]].concat();
    let (_, said) = run(place.path(), &welded);
    assert!(said.contains("17 vertices of the file became 16 nodes"), "{said}");
    assert!(said.contains("24 fins"), "{said}");
}

#[test]
fn what_gaps_between_panels_bring_about_says_so() {
    let place = tempfile::tempdir().expect("there is room");
    fs::write(place.path().join("gaps.obj"), unwelded(0.02)).expect("it can be written");
    let loose =
        [&["check", "gaps.obj", "--fix", "0", "--joint", "hinge"], &UP[..]].concat();
    let (code, said) = run(place.path(), &loose);
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("structure::nodes_near"), "{said}");
    assert!(said.contains("rigidity::mechanism: panels are not joined"), "{said}");
    let welded = [&["check", "gaps.obj", "--weld", "0.1"], &UP[..]].concat();
    let (_, said) = run(place.path(), &welded);
    assert!(said.contains("16 nodes") && said.contains("24 fins"), "{said}");
}

#[test]
fn a_mesh_with_y_upward_is_told_how_to_be_read() {
    let place = tempfile::tempdir().expect("there is room");
    for (name, y_up) in [("y.obj", true), ("z.obj", false)] {
        fs::write(place.path().join(name), grid(y_up)).expect("it can be written");
        for axes in ["0,0,1", "0,0,-1"] {
            let (_, said) = run(place.path(), &["check", name, "--axes", axes]);
            assert_eq!(said.contains("try `--axes 0,1,0`"), y_up, "{name}: {said}");
        }
    }
    let (_, said) = run(place.path(), &["check", "y.obj", "--axes", "0,1,0"]);
    assert!(!said.contains("y_up") && !said.contains("axis_along_fin"), "{said}");
}

#[test]
fn what_is_no_number_in_obj_is_an_error_with_its_line() {
    let place = tempfile::tempdir().expect("there is room");
    for word in
        ["1.#IND", "-1.#IND00", "1.#QNAN", "1.#INF", "nan", "-nan", "inf", "1e999"]
    {
        let mesh = grid(false).replacen("v -25 -75", &format!("v {word} -75"), 1);
        fs::write(place.path().join("bad.obj"), mesh).expect("it can be written");
        let (code, said) = run(place.path(), &[&["check", "bad.obj"], &UP[..]].concat());
        assert_eq!(code, 1, "{word}: {said}");
        assert!(
            said.contains("line 2: ") && said.contains("read::bad_obj"),
            "{word}: {said}"
        );
    }
    // A comment is still one, with or without a space before it.
    let mesh = grid(false).replacen("v -25 -75 ", "v -25 -75# of the rim\nv -25 -75 ", 1);
    let mesh = mesh.replacen("v -25 -75# of", "# v -25 -75 # of", 1);
    fs::write(place.path().join("good.obj"), mesh).expect("it can be written");
    let (_, said) = run(place.path(), &[&["check", "good.obj"], &UP[..]].concat());
    assert!(!said.contains("bad_obj"), "{said}");
}

#[test]
fn a_linkage_near_a_mechanism_has_no_nan_in_any_text() {
    let place = tempfile::tempdir().expect("there is room");
    // Four axes nearly parallel: stiff enough to count as rigid, too soft to bound.
    let tilt = 1e-9;
    let pin = |x: f64, y: f64, a: f64, bodies: &str| {
        format!("[[{x},{y},0],[{a},0,1],[{bodies}]]")
    };
    let pins = [
        pin(0.0, 0.0, 0.0, "0,1"),
        pin(10.0, 0.0, tilt, "1,2"),
        pin(10.0, 10.0, -tilt, "2,3"),
        pin(0.0, 10.0, 2.0 * tilt, "0,3"),
    ];
    let text = format!("{{\"bodies\":4,\"r\":0.5,\"pins\":[{}]}}", pins.join(","));
    fs::write(place.path().join("four.json"), text).expect("it can be written");
    for play in ["0", "0.1"] {
        let words = ["rigidity", "--linkage", "four.json", "--json", "--play", play];
        let output = Command::new(env!("CARGO_BIN_EXE_finwright"))
            .args(words)
            .current_dir(place.path())
            .output()
            .expect("the binary was built");
        for text in [output.stdout, output.stderr] {
            let text = String::from_utf8(text).expect("it is text");
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        }
    }
}

#[test]
fn sheets_can_be_named_without_a_template_of_ones_own() {
    let place = tempfile::tempdir().expect("there is room");
    let sheets = ["--sheet", "250x200:1", "--sheet", "500x300"];
    let make =
        [&["make", "three", "--effort", "quick", "-o", "job"], &sheets[..]].concat();
    let (code, said) = run(place.path(), &make);
    assert_eq!(code, 0, "{said}");
    let job =
        fs::read_to_string(place.path().join("job/job.json")).expect("it was written");
    let job: serde_json::Value = serde_json::from_str(&job).expect("it is JSON");
    assert_eq!(job["sheet_stock"][0]["count"], 1);
    assert_eq!(job["sheet_stock"][1]["width"], 500.0);
    let (code, said) = run(place.path(), &["check", "three", "--sheet", "250x200:1"]);
    assert_eq!(code, 3);
    assert!(said.contains("all parts would take "), "{said}");
}
