//! Faults that were found once and must not come back, each by its name.

use finwright::design::examples;
use finwright::diagnostic::Finding;
use finwright::fabrication::{Fabrication, fabricate};
use finwright::geometry::{Point3, Vector3};
use finwright::lettering::letter;
use finwright::nest::Effort;
use finwright::parts::Part;
use finwright::settings::Settings;
use finwright::structure::{AxisRule, Draft, ObjOptions, read_json, read_obj};
use finwright::template::{self, Template};
use finwright::units::Unit;
use std::time::{Duration, Instant};

fn template(name: &str) -> Template {
    template::read(template::embedded(name).unwrap(), name).unwrap()
}

fn made(draft: Draft, template: &Template) -> Fabrication {
    let effort = Effort { trials: 1, seed: 0 };
    let settings = Settings { effort, ..Settings::new(template.clone()) };
    fabricate(draft, settings, &mut ()).unwrap()
}

fn codes(findings: &[Finding]) -> Vec<&str> {
    findings.iter().map(|finding| finding.code.as_str()).collect()
}

fn obj(text: &str) -> Draft {
    let options =
        ObjOptions { unit: Unit::Millimetre, axes: AxisRule::File, weld_mm: 0.0 };
    read_obj(text, &options).unwrap().0
}

/// A row of `fins` long fins with one strip across each node but the ends.
fn ladder(fins: usize, length: f64) -> Draft {
    let at = |i: usize, j: usize| 3 * i + j;
    let nodes = (0..=fins).flat_map(|i| (0..3).map(move |j| (i, j)));
    let positions: Vec<Point3> = nodes
        .map(|(i, j)| Point3::new(length * i as f64, 60.0 * j as f64, 0.0))
        .collect();
    let cells = (0..fins).flat_map(|i| (0..2).map(move |j| (i, j)));
    Draft {
        name: "ladder".into(),
        axes: vec![Vector3::z(); positions.len()],
        positions,
        faces: cells
            .map(|(i, j)| vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
            .collect(),
        ..Draft::default()
    }
    .with_depth(20.0, 20.0)
}

/// A stray node made the grid of fins as large as the way to it, and the search for
/// crossing fins endless.
#[test]
fn one_stray_node_far_away_does_not_hang() {
    let mut draft = (examples::named("vault").unwrap().draft)();
    draft.positions[7] = Point3::new(9e8, -9e8, 9e8);
    let begun = Instant::now();
    let job = made(draft, &template("pmma-cast-3"));
    assert!(codes(&job.findings).iter().any(|code| code.starts_with("structure::")));
    assert!(begun.elapsed() < Duration::from_secs(20), "{:?}", begun.elapsed());
}

/// Where a splice lies in the fins on both sides of a node, the piece has one node only,
/// and its ends took their direction from nowhere.
#[test]
fn a_spliced_piece_of_one_node_has_a_sound_outline() {
    let mut template = template("pmma-cast-3");
    template.sheet.truncate(1);
    template.sheet[0].width_mm = 330.0;
    template.sheet[0].height_mm = 200.0;
    let job = made(ladder(3, 300.0), &template);
    assert!(!codes(&job.findings).contains(&"parts::outline_crosses_itself"));
    let nodes = |part: &Part| part.body.nodes().len();
    let short: Vec<&Part> = job.parts.iter().filter(|part| nodes(part) == 1).collect();
    assert!(!short.is_empty());
    for part in short {
        let corners = part.region.outline.vertices.iter();
        assert!(corners.flat_map(|v| v.point.coords.iter()).all(|x| x.is_finite()));
        let name = letter(&part.id, 1.0).unwrap().strokes.len();
        assert!(part.marks.iter().any(|mark| mark.strokes.len() >= name), "{}", part.id);
    }
}

/// A byte order mark is no part of a text; line ends may be those of Windows or old Macs.
#[test]
fn line_ends_and_continued_lines_make_no_difference() {
    let unix =
        "v 0 0 0\nv 60 0 0\nv 60 60 0\nv 0 60 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\n";
    let windows = unix.replace('\n', "\r\n");
    let mac = unix.replace('\n', "\r");
    let continued = unix.replace("2//1 3", "2//1 \\\n 3");
    for other in [windows, mac, continued] {
        assert_eq!(obj(&other), obj(unix), "{other:?}");
    }
}

#[test]
fn negative_numbers_of_vertices_count_from_the_newest() {
    let backward = "v 0 0 0\nv 60 0 0\nv 60 60 0\nvn 0 0 1\nf -3//-1 -2//-1 -1//-1\n";
    assert_eq!(obj(backward).faces, [[0, 1, 2]]);
}

/// Both ends of a fin lean as much as they like, but to one side.
#[test]
fn one_axis_upside_down_is_found_and_a_tetrahedron_is_fine() {
    let corners =
        [[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]];
    let positions: Vec<Point3> = corners.map(|c| Point3::from(c) * 100.0).to_vec();
    let draft = Draft {
        axes: positions.iter().map(|p| p.coords).collect(),
        positions,
        faces: vec![vec![0, 2, 1], vec![0, 1, 3], vec![0, 3, 2], vec![1, 2, 3]],
        ..Draft::default()
    }
    .with_depth(10.0, 10.0);
    let mut turned = draft.clone();
    turned.axes[2] = -turned.axes[2];
    let template = template("card-1.5");
    let found = |draft: Draft| {
        let job = made(draft, &template);
        codes(&job.findings)
            .iter()
            .filter(|code| **code == "structure::axes_opposed")
            .count()
    };
    assert_eq!(found(draft), 0);
    assert_eq!(found(turned), 3);
}

/// Areas were taken from the origin, and drowned in rounding far away from it.
#[test]
fn a_structure_far_from_the_origin_has_no_faces_without_area() {
    let mut draft = ladder(2, 60.0);
    for position in &mut draft.positions {
        *position += Vector3::new(3.4e8, 5.6e8, 1e7);
    }
    let job = made(draft, &template("pmma-cast-3"));
    let codes = codes(&job.findings);
    assert!(!codes.iter().any(|code| code.starts_with("structure::")), "{codes:?}");
}

/// The reader names line and column, and says what it wants without Rust's words.
#[test]
fn wrong_types_in_json_have_a_place_and_plain_words() {
    let cases = [
        (r#""depth": {"below": "20", "above": 20}"#, "a number, or a list of one number"),
        (r#""depth": {"below": [20, null], "above": 20}"#, "expected a number"),
        (r#""depth": 20"#, "expected {\"below\": ..., \"above\": ...}"),
        (r#""depht": {"below": 20, "above": 20}"#, "(there is \"depht\")"),
    ];
    for (depth, expected) in cases {
        let text = format!(
            "{{\"format\": \"finwright-structure\", \"version\": 1, \"units\": \"mm\",\n\
             \"positions\": [[0, 0, 0]], \"axes\": [[0, 0, 1]],\n{depth}}}"
        );
        let error = read_json(&text, AxisRule::File).unwrap_err().to_string();
        assert!(error.starts_with("line 3, column "), "{error}");
        assert!(error.contains(expected), "{error}");
        assert!(
            !["usize", "f64", "struct", "variant"].iter().any(|w| error.contains(w)),
            "{error}"
        );
    }
}

/// A relief smaller than half the kerf made the cut line run back over itself.
#[test]
fn a_relief_smaller_than_half_the_kerf_can_be_cut() {
    let mut template = template("pmma-cast-3");
    for relief in [1e-6, 0.05, 0.09] {
        template.material.relief_radius_mm = relief;
        let job = made(ladder(2, 60.0), &template);
        assert!(!codes(&job.findings).contains(&"nest::unsound"), "{relief}");
    }
}
