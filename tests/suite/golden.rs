//! Golden drawings: one sheet of each small structure, as files that one can open.
//!
//! A miss writes `golden.html` into the target folder: old, new, and one over the other.
//! `UPDATE_GOLDEN=1 cargo test --test suite golden` accepts what is drawn now.

use crate::structures::{grid, made, material};
use finwright::design::examples;
use finwright::export;
use finwright::geometry::{Point3, Vector3, trig};
use finwright::structure::Draft;
use std::fs;
use std::path::{Path, PathBuf};

/// Three by three nodes on a sphere, two strips each way with one between.
fn tiny() -> Draft {
    let nodes = (0..9).map(|k| (f64::from(k % 3) - 1.0, f64::from(k / 3) - 1.0));
    let out: Vec<Vector3> =
        nodes.map(|(i, j)| Vector3::new(45.0 * i, 40.0 * j, 400.0)).collect();
    Draft {
        name: "tiny".into(),
        positions: out.iter().map(|p| Point3::from(p.normalize() * 400.0)).collect(),
        axes: out,
        faces: grid(3, 3),
        ..Draft::default()
    }
    .with_depth(14.0, 14.0)
}

/// Two by eight nodes, longer than a small sheet: both long strips are spliced.
fn spliced() -> Draft {
    let nodes = (0..16).map(|k| (f64::from(k % 8), f64::from(k / 8)));
    let place =
        |(i, j): (f64, f64)| Point3::new(50.0 * i, 45.0 * j, 3.0 * (i - 3.5).powi(2));
    Draft {
        name: "spliced".into(),
        positions: nodes.map(place).collect(),
        axes: vec![Vector3::z(); 16],
        faces: grid(8, 2),
        ..Draft::default()
    }
    .with_depth(15.0, 15.0)
}

/// Two rings of twelve nodes around a cone: closed strips and short ribs.
fn closed() -> Draft {
    let mut draft = Draft { name: "closed".into(), ..Draft::default() };
    for (radius, height) in [(70.0, 0.0), (100.0, -30.0)] {
        for k in 0..12 {
            let turn = std::f64::consts::TAU * f64::from(k) / 12.0;
            let out = Vector3::new(trig::cos(turn), trig::sin(turn), 0.0);
            draft.positions.push(Point3::from(out * radius + Vector3::z() * height));
            draft.axes.push(out + Vector3::z());
        }
    }
    for k in 0..12 {
        let next = (k + 1) % 12;
        draft.faces.push(vec![k, 12 + k, 12 + next, next]);
    }
    draft.with_depth(12.0, 12.0)
}

fn golden(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name)
}

/// A drawing that is not what it was.
struct Miss {
    name: String,
    old: String,
    new: String,
}

/// Compares the first sheet with the golden one, or replaces it.
fn compare(name: &str, draft: Draft, template: &str) -> Vec<Miss> {
    let mut template = material(template);
    if name == "spliced" {
        // One small sheet, so that the long strips do not fit.
        template.sheet.truncate(1);
        template.sheet[0].width_mm = 300.0;
        template.sheet[0].height_mm = 200.0;
    }
    let job = made(draft, &template);
    let sheet = &job.sheets[0];
    let drawings = [("svg", export::svg(sheet)), ("dxf", export::dxf(sheet))];
    let mut misses = Vec::new();
    for (ending, bytes) in drawings {
        let path = golden(name).join(format!("sheet-01.{ending}"));
        let new = String::from_utf8(bytes).expect("drawings are text");
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            fs::create_dir_all(golden(name)).expect("the folder can be made");
            fs::write(&path, new).expect("golden files can be written");
            continue;
        }
        let old = fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
        if old != new {
            misses.push(Miss { name: format!("{name}/sheet-01.{ending}"), old, new });
        }
    }
    misses
}

#[test]
fn sheets_are_drawn_as_they_were() {
    let three = (examples::named("three").expect("it is embedded").draft)();
    let drawn = [
        compare("three", three, "pmma-cast-3"),
        compare("tiny", tiny(), "pmma-cast-3"),
        compare("spliced", spliced(), "petg-1"),
        compare("closed", closed(), "card-1.5"),
    ];
    let misses: Vec<Miss> = drawn.into_iter().flatten().collect();
    if misses.is_empty() {
        return;
    }
    let names: Vec<&str> = misses.iter().map(|miss| miss.name.as_str()).collect();
    let page = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("golden.html");
    fs::write(&page, html(&misses)).expect("the target folder can be written");
    panic!(
        "drawn differently: {}; look at {} and accept with UPDATE_GOLDEN=1",
        names.join(", "),
        page.display()
    );
}

/// Old, new and overlay of each drawing; of a DXF the first line that differs.
fn html(misses: &[Miss]) -> String {
    let mut page = String::from(
        "<!doctype html><meta charset=\"utf-8\"><title>golden drawings</title><style>\
         svg{width:100%;height:auto;border:1px solid #ccc}path{stroke-width:.3}\
         .over{position:relative}.over>*+*{position:absolute;inset:0}\
         .old path{stroke:#d00}.new path{stroke:#06c}</style>\n",
    );
    for Miss { name, old, new } in misses {
        page += &format!("<h2>{name}</h2>\n");
        if name.ends_with(".svg") {
            let body =
                |text: &str| text.split_once("?>").map_or(text, |t| t.1).to_owned();
            let old = format!("<div class=old>{}</div>", body(old));
            let new = format!("<div class=new>{}</div>", body(new));
            page += &format!("<h3>old</h3>{old}<h3>new</h3>{new}\n");
            page += &format!("<h3>overlay</h3><div class=over>{old}{new}</div>\n");
        } else {
            let line = old.lines().zip(new.lines()).position(|(a, b)| a != b);
            let line =
                line.map_or("their lengths".to_owned(), |k| format!("line {}", k + 1));
            page += &format!("<p>first difference: {line}</p>\n");
        }
    }
    page
}
