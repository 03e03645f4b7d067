//! Faults planted in copies of a job: each is found, with its part and place.

use crate::planting::{
    DXF, Line, Planting, finwright as command, found, is_near, job, point, read_lines,
    vault, written,
};
use finwright::diagnostic::{Finding, Severity, passes};
use finwright::geometry::offset::offset;
use finwright::geometry::{Contour, Point2, Vertex};
use finwright::proof::prove;
use serde_json::Value;
use std::process::Command;

#[test]
fn every_job_folds_into_its_structure() {
    let jobs = ["vault", "dome", "facade", "sphere-patch", "five", "three"];
    // Ends set back, closed strips, splices, T nodes.
    let fixtures = [
        "fixtures/mixed.obj --axes point:0,0,-900",
        "fixtures/ring.json -t petg-1",
        "fixtures/long.json -t fixtures/small-bed.toml",
        "fixtures/bricks.obj --axes 0,0,1",
    ];
    for example in jobs.into_iter().chain(fixtures) {
        let proof = prove(&job(example)).unwrap();
        assert!(proof.findings.is_empty(), "{example}: {:#?}", proof.findings);
        assert_eq!(proof.worst.len(), 3);
        for worst in &proof.worst {
            let gap = worst.node_gap_mm.max(worst.node_off_mm);
            assert!(gap < 0.001, "{example} {worst:?}");
            let off = worst.fin_mm.max(worst.slit_off_mm);
            assert!(off < 0.001 && worst.moved_mm < 0.001, "{example} {worst:?}");
            let play = [worst.slit_play_least_mm, worst.slit_play_most_mm];
            let wanted = if example.contains("petg") { 0.08 } else { 0.1 };
            let off = play.map(|play| (play - wanted).abs());
            assert!(off[0].max(off[1]) < 0.001, "{example} {worst:?}");
        }
        let parts = proof.worst[0].parts;
        assert!(proof.worst.iter().all(|worst| worst.parts == parts) && parts > 0);
    }
}

#[test]
fn a_file_saved_by_another_program_passes_with_a_note() {
    let proof = Planting::new().proof();
    assert!(passes(&proof.findings), "{:#?}", proof.findings);
    let [note] = proof.findings.as_slice() else { panic!("{:#?}", proof.findings) };
    assert_eq!(
        (note.severity, note.code.as_str()),
        (Severity::Note, "proof::file_changed")
    );
    assert_eq!(note.place.file.as_deref(), Some(DXF));
}

#[test]
fn a_file_exploded_into_single_lines_and_arcs_passes() {
    let mut planting = Planting::new();
    let pieces = planting.lines.drain(..).flat_map(|line| {
        let steps = line.contour.vertices.len() - usize::from(!line.closed);
        let segments: Vec<_> = line.contour.segments().take(steps).collect();
        let single = line.layer.starts_with("CUT");
        let whole = (!single).then(|| line.clone());
        let layer = line.layer;
        let parts = segments.into_iter().filter(move |_| single).map(move |s| Line {
            layer: layer.clone(),
            closed: false,
            contour: Contour {
                vertices: vec![Vertex::arc(s.from, s.bulge), Vertex::line(s.to)],
            },
        });
        parts.chain(whole).collect::<Vec<_>>()
    });
    let mut lines: Vec<Line> = pieces.collect();
    lines.reverse();
    planting.lines = lines;
    let proof = planting.proof();
    assert!(passes(&proof.findings), "{:#?}", proof.findings);
    assert_eq!(proof.worst[0].parts, proof.worst[1].parts);
}

#[test]
fn a_part_turned_and_moved_aside_is_found_and_told() {
    let mut planting = Planting::new();
    let id = planting.outline(0).0;
    for line in &mut planting.lines {
        // The whole sheet is turned by half a turn: nothing is wrong but the list.
        line.contour = line.contour.moved(|p| Point2::new(1000.0 - p.x, 600.0 - p.y));
    }
    let proof = planting.proof();
    let moved =
        |f: &&Finding| f.code == "proof::part_moved" && f.place.parts == [id.as_str()];
    let moved = proof.findings.iter().find(moved);
    assert!(
        moved.is_some()
            || proof.findings.iter().any(|f| f.code == "proof::parts_swapped")
    );
    let parts = proof.worst[1].parts;
    assert_eq!(proof.worst[0].parts, parts);
    let lost = ["proof::part_missing", "proof::part_mirrored", "proof::outline_differs"];
    assert!(proof.findings.iter().all(|f| !lost.contains(&f.code.as_str())));
}

#[test]
fn a_file_25_4_times_too_large_is_found() {
    let mut planting = Planting::new();
    let (id, _) = planting.placed(3);
    for line in &mut planting.lines {
        line.contour = line.contour.moved(|p| p * 25.4);
    }
    let proof = planting.proof();
    let finding = found(&proof, "proof::scaled", &id);
    assert_eq!(finding.place.file.as_deref(), Some(DXF));
    assert!(finding.message.contains("25.4"), "{}", finding.message);
}

#[test]
fn inches_that_the_header_tells_of_are_no_fault() {
    let mut planting = Planting::new();
    for line in &mut planting.lines {
        line.contour = line.contour.moved(|p| p / 25.4);
    }
    let inches = written(&planting.lines, 1);
    let mut files = planting.files;
    files.insert(DXF.into(), inches);
    assert!(passes(&prove(&files).unwrap().findings));
}

#[test]
fn a_slit_moved_by_half_a_millimetre_is_found() {
    let mut planting = Planting::new();
    let (_, mouth, ..) = planting.slit(4, 3);
    let (id, node) = planting.bend_slit(4, 3, |_| 0.5);
    let proof = planting.proof();
    let finding = found(&proof, "proof::slit_moved", &id);
    assert_eq!(finding.place.nodes, [node as usize]);
    assert!(finding.message.contains("0.500"), "{}", finding.message);
    is_near(finding, mouth, 2.0);
}

/// Limits come from the template by way of job.json.
#[test]
fn what_the_limits_of_the_template_allow_is_no_fault() {
    let mut planting = Planting::new();
    assert_eq!(planting.manifest["proof"]["limits"]["axes_and_slits_mm"], 0.01);
    planting.bend_slit(4, 3, |_| 0.05);
    planting.manifest["proof"]["limits"]["axes_and_slits_mm"] = 0.1.into();
    let proof = planting.proof();
    assert!(passes(&proof.findings), "{:#?}", proof.findings);
    assert!((proof.worst[0].slit_off_mm - 0.05).abs() < 1e-3);
}

#[test]
fn a_slit_too_narrow_is_found() {
    let mut planting = Planting::new();
    let (_, mouth, ..) = planting.slit(2, 1);
    let (id, node) = planting.bend_slit(2, 1, |side| -0.06 * side.signum());
    let proof = planting.proof();
    let finding = found(&proof, "proof::slit_narrow", &id);
    assert_eq!(finding.place.nodes, [node as usize]);
    is_near(finding, mouth, 2.0);
    let figure =
        proof.slits.iter().find(|s| s.part == id && s.node == node as usize).unwrap();
    assert!((figure.play_mm + 0.02).abs() < 1e-3, "{figure:?}");
}

fn mirrored(line: &mut Line, about: f64) {
    let mirrored = line.contour.moved(|p| Point2::new(2.0 * about - p.x, p.y));
    line.contour = Contour {
        vertices: mirrored
            .vertices
            .iter()
            .map(|v| Vertex::arc(v.point, -v.bulge))
            .collect(),
    };
}

#[test]
fn a_mirrored_part_is_named_as_mirrored() {
    let mut planting = Planting::of(job("facade"));
    let (_, at) = planting.placed(6);
    let (id, line) = planting.outline(6);
    mirrored(line, line.middle().x);
    let proof = planting.proof();
    is_near(found(&proof, "proof::part_mirrored", &id), at, 3.0);
}

#[test]
fn a_part_that_is_its_own_mirror_image_is_told_by_its_lettering() {
    let mut planting = Planting::new();
    let (_, at) = planting.placed(6);
    let (id, line) = planting.outline(6);
    let xs = || line.contour.vertices.iter().map(|v| v.point);
    let (low, high) = (xs().reduce(|a, b| a.inf(&b)), xs().reduce(|a, b| a.sup(&b)));
    let (low, high) = (low.unwrap(), high.unwrap());
    for line in &mut planting.lines {
        let p = line.middle();
        if low < p && p < high && line.layer != "SHEET" {
            mirrored(line, at.x);
        }
    }
    let proof = planting.proof();
    is_near(found(&proof, "proof::part_mirrored", &id), at, 3.0);
}

#[test]
fn a_kerf_the_wrong_way_round_is_found_in_one_part_and_in_all() {
    for all in [false, true] {
        let mut planting = Planting::new();
        let (_, at) = planting.placed(5);
        let id = planting.outline(5).0;
        let kerf = planting.manifest["material"]["kerf"].as_f64().unwrap();
        for line in planting.lines.iter_mut().filter(|line| line.layer == "CUT_OUTER") {
            if all || (line.middle() - at).norm() < 1.0 {
                line.contour = offset(&line.contour, -kerf);
            }
        }
        let proof = planting.proof();
        let finding = found(&proof, "proof::kerf_wrong", &id);
        assert!(finding.message.contains("-0.180"), "{}", finding.message);
        let parts = finding.place.parts.len();
        assert_eq!(parts == 1, !all, "{parts}");
    }
}

#[test]
fn a_missing_slit_is_found() {
    let mut planting = Planting::new();
    let (node, mouth, inward, across) = planting.slit(1, 2);
    let (id, line) = planting.outline(1);
    line.contour.vertices.retain(|vertex| {
        let way = vertex.point - mouth;
        !(way.dot(&across).abs() < 5.0 && (-0.5..20.0).contains(&way.dot(&inward)))
    });
    let proof = planting.proof();
    let finding = found(&proof, "proof::slit_missing", &id);
    assert_eq!(finding.place.nodes, [node as usize]);
    is_near(finding, mouth, 25.0);
}

#[test]
fn two_parts_swapped_are_found_on_the_sheet_and_in_the_list() {
    let mut planting = Planting::new();
    let (first, a) = planting.placed(2);
    let (second, b) = planting.placed(9);
    let outer = planting.lines.iter_mut().filter(|line| line.layer == "CUT_OUTER");
    for line in outer {
        let middle = line.middle();
        if (middle - a).norm() < 1.0 {
            line.shift(b - a);
        } else if (middle - b).norm() < 1.0 {
            line.shift(a - b);
        }
    }
    let proof = planting.proof();
    is_near(found(&proof, "proof::parts_swapped", &first), b, 3.0);
    found(&proof, "proof::parts_swapped", &second);
    let label = found(&proof, "proof::wrong_label", &first);
    assert!(label.message.contains(&second), "{}", label.message);

    let mut planting = Planting::new();
    for key in ["x", "y", "angle_deg"] {
        let value = |nth: usize| planting.placement(nth)[key].clone();
        let (a, b) = (value(2), value(9));
        planting.manifest["sheets"][0]["placements"][2][key] = b;
        planting.manifest["sheets"][0]["placements"][9][key] = a;
    }
    let proof = planting.proof();
    is_near(found(&proof, "proof::parts_swapped", &first), a, 3.0);
}

#[test]
fn doubled_lines_are_found_whole_and_in_part() {
    let mut planting = Planting::new();
    let (_, at) = planting.placed(7);
    let (id, line) = planting.outline(7);
    let twin = line.clone();
    planting.lines.push(twin);
    is_near(found(&planting.proof(), "proof::doubled_line", &id), at, 600.0);

    let mut planting = Planting::new();
    let (id, line) = planting.outline(7);
    let longest = line
        .contour
        .segments()
        .filter(|s| s.bulge == 0.0)
        .max_by(|a, b| a.length().total_cmp(&b.length()));
    let edge = longest.unwrap();
    let contour = Contour::polygon([edge.to, edge.from]);
    planting.lines.push(Line { layer: "CUT_OUTER".into(), closed: false, contour });
    is_near(found(&planting.proof(), "proof::doubled_line", &id), edge.from, 60.0);
}

#[test]
fn an_open_outline_is_found_with_its_place() {
    let mut planting = Planting::new();
    let (id, line) = planting.outline(3);
    line.closed = false;
    line.contour.vertices.pop();
    let at = line.contour.vertices[0].point;
    let proof = planting.proof();
    found(&proof, "proof::part_missing", &id);
    let open = proof.findings.iter().find(|f| f.code == "proof::open_line").unwrap();
    is_near(open, at, 600.0);
}

#[test]
fn a_part_nudged_into_another_is_found_with_both() {
    let mut planting = Planting::new();
    let (first, a) = planting.placed(4);
    let places = planting.manifest["sheets"][0]["placements"].as_array().unwrap().len();
    let others = (0..places).filter(|&k| k != 4).map(|k| planting.placed(k));
    let off = |p: &(String, Point2)| (p.1 - a).norm();
    let (_, b) = others.min_by(|p, q| off(p).total_cmp(&off(q))).unwrap();
    planting.outline(4).1.shift((b - a) * 0.4);
    let proof = planting.proof();
    let finding = found(&proof, "proof::parts_overlap", &first);
    assert_eq!(finding.place.parts.len(), 2);
    assert!(finding.place.at.is_some());
}

#[test]
fn parts_nearer_than_the_spacing_are_found() {
    let mut planting = Planting::new();
    for stock in planting.manifest["sheet_stock"].as_array_mut().unwrap() {
        stock["spacing"] = 4.0.into();
    }
    let proof = planting.proof();
    let near = proof.findings.iter().filter(|f| f.code == "proof::parts_too_near");
    assert!(near.count() > 0 && !passes(&proof.findings));
}

#[test]
fn a_fold_the_wrong_way_is_found() {
    let mut planting = Planting::new();
    let id = planting.manifest["parts"][8]["id"].as_str().unwrap().to_owned();
    let folds = planting.manifest["parts"][8]["strip"]["folds"].as_array_mut().unwrap();
    let bent = |fold: &&mut Value| fold["angle_deg"].as_f64().unwrap().abs() > 1.0;
    let fold = folds.iter_mut().find(bent).unwrap();
    let node = fold["node"].as_u64().unwrap() as usize;
    fold["angle_deg"] = (-fold["angle_deg"].as_f64().unwrap()).into();
    let proof = planting.proof();
    let finding = found(&proof, "proof::fold_wrong", &id);
    assert_eq!(finding.place.nodes, [node]);
    let gap = proof.worst[0].node_off_mm;
    assert!(gap > 0.1, "the fold opens a gap: {gap}");
}

#[test]
fn files_of_another_job_are_found() {
    let dome = job("dome");
    let mut files = vault();
    files.insert(DXF.into(), dome[DXF].clone());
    let proof = prove(&files).unwrap();
    let other = proof.findings.iter().find(|f| f.code == "proof::other_job").unwrap();
    assert_eq!(other.place.file.as_deref(), Some(DXF));
    assert!(other.place.parts.len() > 5);
    assert!(proof.findings.iter().any(|f| f.code == "proof::file_changed"));

    let mut files = vault();
    files.insert("structure.json".into(), dome["structure.json"].clone());
    let proof = prove(&files).unwrap();
    assert!(!passes(&proof.findings));
    let changed =
        proof.findings.iter().find(|f| f.code == "proof::file_changed").unwrap();
    assert_eq!(changed.place.file.as_deref(), Some("structure.json"));
}

#[test]
fn a_part_that_is_missing_is_found() {
    let mut planting = Planting::new();
    let (id, at) = planting.placed(10);
    planting
        .lines
        .retain(|line| line.layer != "CUT_OUTER" || (line.middle() - at).norm() > 1.0);
    let proof = planting.proof();
    is_near(found(&proof, "proof::part_missing", &id), at, 1.0);
}

#[test]
fn an_svg_edited_where_the_dxf_is_not_is_found() {
    let planting = Planting::new();
    let (id, at) = planting.placed(0);
    let mut files = planting.files;
    let svg = String::from_utf8(files["sheets/sheet-01.svg"].clone()).unwrap();
    let start = svg.find("id=\"CUT_OUTER\"").unwrap();
    let path = start + svg[start..].find("<path ").unwrap();
    let moved = format!(
        "{}<path transform=\"translate(0 0.4)\" {}",
        &svg[..path],
        &svg[path + 6..]
    );
    files.insert("sheets/sheet-01.svg".into(), moved.into_bytes());
    let proof = prove(&files).unwrap();
    let differs = |f: &&Finding| f.code == "proof::formats_differ";
    let finding = proof.findings.iter().find(differs).unwrap();
    assert_eq!(finding.place.file.as_deref(), Some("sheets/sheet-01.svg"));
    assert_eq!(finding.place.parts.len(), 1);
    assert!(!passes(&proof.findings) && finding.place.at.is_some());
    let _ = (id, at);
}

#[test]
fn verify_ends_with_0_on_a_job_with_3_on_a_mismatch_and_with_1_on_no_job() {
    let place = tempfile::tempdir().unwrap();
    let dir = place.path().join("three");
    assert_eq!(
        command(&["make", "three", "-q", "--effort", "quick", "-o"], &dir),
        Some(0)
    );
    assert_eq!(command(&["verify", "-q"], &dir), Some(0));
    let file = dir.join(DXF);
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, text.replacen("CUT_OUTER", "CUT_INNER", 40)).unwrap();
    assert_eq!(command(&["verify", "-q"], &dir), Some(3));
    std::fs::write(&file, "no drawing").unwrap();
    assert_eq!(command(&["verify", "-q"], &dir), Some(3));
    assert_eq!(command(&["verify", "-q"], place.path()), Some(1));
}

/// Pieces of a coupon are parts like others; what a coupon tells changes the cut lines.
#[test]
fn a_coupon_is_proved_and_what_it_tells_moves_the_next_lines() {
    let place = tempfile::tempdir().unwrap();
    let dir = place.path().join("coupon");
    for template in finwright::template::names() {
        assert_eq!(command(&["coupon", "-q", "-t", template, "-o"], &dir), Some(0));
        assert_eq!(command(&["verify", "-q"], &dir), Some(0), "{template}");
    }
    let fitted = place.path().join("fitted.toml");
    let told = ["coupon", "-q", "-t", "pmma-cast-3", "--set", "3a,6b,6c", "-o"];
    assert_eq!(command(&told, &fitted), Some(0));
    let text = std::fs::read_to_string(&fitted).unwrap();
    let template = finwright::template::read(&text, "fitted").unwrap();
    // Notch 3 is two steps of 0.025 mm up from the middle, slit 6 two steps of 0.05 mm.
    assert!((template.material.kerf_mm - 0.23).abs() < 1e-9);
    assert!((template.material.clearance_mm - 0.25).abs() < 1e-9);
    let outline = |template: &str| {
        let dir = place.path().join("job");
        let made = ["make", "three", "-q", "--effort", "quick", "-t", template, "-o"];
        assert_eq!(command(&made, &dir), Some(0));
        let lines = read_lines(&std::fs::read(dir.join(DXF)).unwrap());
        let manifest = std::fs::read(dir.join("job.json")).unwrap();
        let manifest: Value = serde_json::from_slice(&manifest).unwrap();
        let nominal = |part: &Value| {
            let ring = part["outline"].as_array().unwrap().iter();
            let copies = part["quantity"].as_f64().unwrap();
            copies * Contour::polygon(ring.map(point)).signed_area()
        };
        let parts: f64 = manifest["parts"].as_array().unwrap().iter().map(nominal).sum();
        let outer = lines.iter().filter(|line| line.layer == "CUT_OUTER");
        let (area, length) = outer
            .map(|line| (line.contour.signed_area().abs(), line.contour.length()))
            .fold((0.0, 0.0), |sum, line| (sum.0 + line.0, sum.1 + line.1));
        // Half a kerf all round: what the drawn area has more than the parts.
        2.0 * (area - parts) / length
    };
    assert!((outline("pmma-cast-3") - 0.18).abs() < 0.005);
    assert!((outline(fitted.to_str().unwrap()) - 0.23).abs() < 0.005);
    assert_eq!(command(&["coupon", "-q", "--set", "9z", "-o"], &fitted), Some(2));
}

#[test]
fn advice_names_a_scale_that_passes_and_what_binds_just_below() {
    let run = |args: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_finwright")).args(args).output().unwrap()
    };
    let told = run(&["check", "dome", "-t", "mdf-3", "--advise", "--json", "-q"]);
    assert_eq!(told.status.code(), Some(0));
    let advice: Value = serde_json::from_slice(&told.stdout).unwrap();
    let tried = advice["tried"].as_array().unwrap();
    let fails = |tried: &&Value| !tried["fails"].as_array().unwrap().is_empty();
    let worst = tried.iter().rfind(fails).unwrap();
    let scale = |value: &Value| value["scale"].as_str().unwrap().to_owned();
    let at = |scale: &str| run(&["check", "dome", "-t", "mdf-3", "--scale", scale, "-q"]);
    assert_eq!(at(&scale(&advice["smallest"])).status.code(), Some(0));
    // Rounded scales name models a little larger: 1 % below the worst fails for certain.
    let below = 1.01 / worst["factor"].as_f64().unwrap();
    let failed = at(&format!("1:{below}"));
    assert_eq!(failed.status.code(), Some(3));
    let said = String::from_utf8(failed.stderr).unwrap();
    let code = worst["fails"][0]["code"].as_str().unwrap();
    assert!(said.contains(code), "{code} not in {said}");
}

#[test]
fn an_end_that_reaches_into_the_plates_of_its_node_is_found() {
    let mut planting = Planting::of(job("five"));
    let places = planting.manifest["sheets"][0]["placements"].as_array().unwrap();
    let nth = |id: &Value| places.iter().position(|placement| placement["part"] == *id);
    let strips = planting.manifest["parts"].as_array().unwrap().iter();
    let (nth, node) = strips
        .filter(|part| part["strip"]["setbacks"][0].as_f64().is_some_and(|s| s > 0.0))
        .find_map(|part| Some((nth(&part["id"])?, part["strip"]["nodes"][0].clone())))
        .unwrap();
    let (id, _) = planting.placed(nth);
    let axes = planting.part(&id)["strip"]["axes"].as_array().unwrap();
    let axis = axes.iter().find(|axis| axis["node"] == node).unwrap();
    let bottom = planting.to_sheet(nth, point(&axis["bottom"]));
    let top = planting.to_sheet(nth, point(&axis["top"]));
    let corners = planting.outline(nth).1;
    // The end is drawn out to the axis.
    let near = |end: Point2, line: &Line| {
        let off = |p: &Point2| (p - end).norm();
        let points = line.contour.vertices.iter().map(|v| v.point);
        points.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap()
    };
    let ends = [near(bottom, corners), near(top, corners)];
    corners.contour = corners.contour.moved(|p| match () {
        () if p == ends[0] => bottom,
        () if p == ends[1] => top,
        () => p,
    });
    let proof = planting.proof();
    let finding = found(&proof, "proof::end_in_the_way", &id);
    assert_eq!(finding.place.nodes, [node.as_u64().unwrap() as usize]);
    is_near(finding, bottom, 1.0);
}
