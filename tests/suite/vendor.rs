//! Files for services: each profile's are made, hold what they should, and are proved.
#![allow(clippy::unwrap_used, reason = "a test that cannot be set up has failed")]

use finwright::template;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

fn finwright(args: &[&str], dir: &Path) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_finwright"));
    let done = command.args(args).arg(dir).output().unwrap();
    (done.status.code(), String::from_utf8_lossy(&done.stderr).into_owned())
}

/// A job of an example for a service.
fn ordered(example: &str, output: &str, place: &Path) {
    let file = place.join("template.toml");
    let source = template::embedded("pmma-cast-3").unwrap();
    fs::write(&file, format!("{source}\n[output]\n{output}\n")).unwrap();
    let file = file.to_string_lossy();
    let make = ["make", example, "-q", "--effort", "quick", "-t", &file, "-o"];
    assert_eq!(finwright(&make, &place.join("job")).0, Some(0), "{output}");
}

fn names(place: &Path) -> Vec<String> {
    let entries = fs::read_dir(place.join("job/order")).unwrap();
    let name = |e: fs::DirEntry| e.file_name().to_string_lossy().into_owned();
    let mut names: Vec<String> = entries.map(|entry| name(entry.unwrap())).collect();
    names.sort();
    names
}

fn manifest(place: &Path) -> Value {
    serde_json::from_slice(&fs::read(place.join("job/job.json")).unwrap()).unwrap()
}

#[test]
fn the_files_of_every_profile_pass_verify() {
    let wanted: [(&str, &[&str]); 4] = [
        ("lightburn", &["svg"]),
        ("rgb-lab", &["svg", "pdf"]),
        ("snijlab", &["dxf"]),
        ("epilog", &["pdf"]),
    ];
    for (profile, formats) in wanted {
        let place = tempfile::tempdir().unwrap();
        ordered("vault", &format!("profile = \"{profile}\""), place.path());
        let manifest = manifest(place.path());
        let sheets = manifest["sheets"].as_array().unwrap();
        let mut files: Vec<String> = Vec::new();
        for format in formats {
            match *format {
                "pdf" => files.push("sheets.pdf".into()),
                ending => files.extend(
                    sheets
                        .iter()
                        .map(|s| format!("{}.{ending}", s["id"].as_str().unwrap())),
                ),
            }
        }
        files.sort();
        assert_eq!(names(place.path()), files, "{profile}");
        let job = place.path().join("job");
        assert_eq!(finwright(&["verify", "-q"], &job).0, Some(0), "{profile}");
        let proof = &manifest["proof"];
        let worst = proof["worst"].as_array().unwrap();
        assert_eq!(worst.len(), 3 + formats.len(), "{profile}");
        for path in files {
            assert!(proof["files"].get(format!("order/{path}")).is_some(), "{path}");
        }
    }
}

#[test]
fn single_parts_are_cut_lines_of_nominal_size_in_files_of_their_own() {
    let place = tempfile::tempdir().unwrap();
    ordered("three", "profile = \"single-part\"", place.path());
    let manifest = manifest(place.path());
    let parts = manifest["parts"].as_array().unwrap();
    assert_eq!(names(place.path()).len(), parts.len());
    for part in parts.iter().filter(|part| part["kind"] == "strip") {
        let id = part["id"].as_str().unwrap();
        let path = place.path().join(format!("job/order/{id}.dxf"));
        let drawing = dxf::Drawing::load(&mut &*fs::read(path).unwrap()).unwrap();
        assert!(drawing.entities().all(|e| e.common.layer.starts_with("CUT_")), "{id}");
        let [entity] = drawing.entities().collect::<Vec<_>>()[..] else { panic!("{id}") };
        let dxf::entities::EntityType::Polyline(line) = &entity.specific else {
            panic!()
        };
        let points: Vec<[f64; 2]> =
            line.vertices().map(|v| [v.location.x, v.location.y]).collect();
        let span = |k: usize| {
            let along = points.iter().map(|p| p[k]);
            let low = along.clone().fold(f64::INFINITY, f64::min);
            (low, along.fold(f64::NEG_INFINITY, f64::max) - low)
        };
        let outline = part["outline"].as_array().unwrap();
        for k in 0..2 {
            let along = outline.iter().map(|p| p[k].as_f64().unwrap());
            let low = along.clone().fold(f64::INFINITY, f64::min);
            let nominal = along.fold(f64::NEG_INFINITY, f64::max) - low;
            let (low, size) = span(k);
            assert!(
                low.abs() < 2e-6 && (size - nominal).abs() < 2e-6,
                "{id}: {low} {size}"
            );
        }
    }
    assert_eq!(finwright(&["verify", "-q"], &place.path().join("job")).0, Some(0));
    let findings = manifest["findings"].as_array().unwrap();
    assert!(findings.iter().any(|finding| finding["code"] == "order::unmarked"));
}

#[test]
fn a_fault_in_the_file_for_the_service_alone_is_found_there() {
    let place = tempfile::tempdir().unwrap();
    ordered("three", "profile = \"single-part\"", place.path());
    let job = place.path().join("job");
    let file = job.join("order/S02.dxf");
    let text = fs::read_to_string(&file).unwrap();
    // The first corner of the part, half a millimetre to the right.
    let vertex = text.find("VERTEX").unwrap();
    let x = vertex + text[vertex..].find(" 10\n").unwrap() + 4;
    let end = x + text[x..].find('\n').unwrap();
    let moved: f64 = text[x..end].trim().parse::<f64>().unwrap() + 0.5;
    fs::write(&file, format!("{}{moved}{}", &text[..x], &text[end..])).unwrap();
    let (code, said) = finwright(&["verify"], &job);
    assert_eq!(code, Some(3));
    assert!(said.contains("S02") && said.contains("order/S02.dxf"), "{said}");
    fs::remove_file(&file).unwrap();
    let (code, said) = finwright(&["verify"], &job);
    assert_eq!(code, Some(3));
    assert!(said.contains("order/S02.dxf"), "{said}");
}

#[test]
fn colours_are_those_of_the_profile_and_no_frame_is_drawn() {
    let place = tempfile::tempdir().unwrap();
    ordered("three", "profile = \"lightburn\"", place.path());
    let svg = fs::read_to_string(place.path().join("job/order/sheet-01.svg")).unwrap();
    let group = |name: &str| {
        let start = svg.find(&format!("<g id=\"{name}\"")).unwrap();
        let end = start + svg[start..].find("</g>").unwrap();
        svg[start..end].to_owned()
    };
    assert!(group("ENGRAVE").contains("stroke=\"#00e0e0\""));
    assert!(group("CUT_OUTER").contains("stroke=\"#ff0000\""));
    assert!(!group("SHEET").contains("<path"));
}
