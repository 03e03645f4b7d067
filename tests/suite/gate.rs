//! Nothing flexible leaves a cut file behind.

use finwright::design::examples;
use finwright::fabrication::{Fabrication, criteria, fabricate, plan, verdict};
use finwright::gate::Shut;
use finwright::joint::Joint;
use finwright::nest::Effort;
use finwright::rigidity::Outcome;
use finwright::settings::Settings;
use finwright::structure::{Draft, Structure};
use finwright::template::{self, Template};
use finwright::tolerance::Tolerance;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn run(place: &Path, words: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_finwright"));
    command.args(words).current_dir(place).output().expect("the binary was built")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("it ended by itself")
}

/// Endings of all files below a folder.
fn endings(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("it can be read") {
        let path = entry.expect("it can be read").path();
        if path.is_dir() {
            found.extend(endings(&path));
        } else if let Some(ending) = path.extension() {
            found.push(ending.to_string_lossy().into_owned());
        }
    }
    found
}

/// A flat square net: its strips are straight and its axes parallel.
fn trellis() -> String {
    let mut text = String::new();
    for k in 0..36 {
        let _ = writeln!(text, "v {} {} 0", 40 * (k % 6), 40 * (k / 6));
    }
    for k in (0..30).filter(|k| k % 6 < 5) {
        let _ = writeln!(text, "f {} {} {} {}", k + 1, k + 2, k + 8, k + 7);
    }
    text
}

fn default_template() -> Template {
    let name = template::names()[0];
    let source = template::embedded(name).expect("it is embedded");
    template::read(source, name).expect("it can be read")
}

fn vault(fixed: Option<Vec<usize>>) -> Draft {
    let mut draft = (examples::named("vault").expect("it is embedded").draft)();
    draft.fixed = fixed;
    draft
}

fn outcome(draft: Draft, joint: Joint) -> Outcome {
    let (structure, _) = Structure::new(draft, &Tolerance::default()).expect("it is one");
    let settings = Settings { joint, ..Settings::new(default_template()) };
    let criteria = criteria(&structure, &settings.template);
    let criteria = criteria.expect("the template's limit can be read");
    let plan = plan(&structure, &settings);
    let verdict = verdict(&plan, &settings, &criteria, &mut ());
    verdict.expect("nobody stops it").outcome()
}

#[test]
fn a_trellis_leaves_no_cut_file_unless_it_is_accepted() {
    let place = tempfile::tempdir().expect("there is room");
    fs::write(place.path().join("trellis.obj"), trellis()).expect("it can be written");
    let words = ["make", "trellis.obj", "--axes", "0,0,1", "--fix", "none", "--effort"];
    let words = [&words[..], &["quick"]].concat();
    let refused = run(place.path(), &words);
    assert_eq!(code(&refused), 3);
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(said.contains("rigidity::mechanism"), "{said}");
    let job = place.path().join("out/trellis.refused");
    let cut = endings(&job).into_iter().filter(|e| ["dxf", "svg", "pdf"].contains(&&**e));
    assert_eq!(cut.count(), 0);
    let manifest = |job: &Path| -> serde_json::Value {
        let text = fs::read_to_string(job.join("job.json")).expect("it was written");
        serde_json::from_str(&text).expect("it is JSON")
    };
    assert_eq!(manifest(&job)["verdict"]["verdict"], "mechanism");
    assert_eq!(manifest(&job)["verdict"]["mobility"], 1);
    let accepted = [&words[..], &["--accept-flexible", "a folding screen"]].concat();
    assert_eq!(code(&run(place.path(), &accepted)), 0);
    let job = place.path().join("out/trellis");
    let passed = manifest(&job);
    assert_eq!(passed["accepted_flexible"], "a folding screen");
    assert_eq!(passed["verdict"]["verdict"], "mechanism");
    assert!(endings(&job).iter().any(|ending| ending == "dxf"));
    // An empty reason is none.
    let empty = [&words[..], &["--accept-flexible", " "]].concat();
    assert_eq!(code(&run(place.path(), &empty)), 3);
}

#[test]
fn the_frame_of_each_sheet_says_why_it_may_be_flexible() {
    let template = default_template();
    let strokes = |accepted: Option<&str>| -> usize {
        let job = made(&template, accepted);
        job.sheets.iter().map(|sheet| sheet.frame.len()).sum()
    };
    assert!(strokes(Some("a folding screen")) > strokes(None));
}

fn made(template: &Template, accepted: Option<&str>) -> Fabrication {
    let settings = Settings {
        effort: Effort { trials: 1, seed: 0 },
        accepted_flexible: accepted.map(str::to_owned),
        ..Settings::new(template.clone())
    };
    let draft = (examples::named("three").expect("it is embedded").draft)();
    fabricate(draft, settings, &mut ()).expect("nobody stops it")
}

#[test]
fn a_verdict_about_something_else_opens_nothing() {
    let template = default_template();
    let job = made(&template, None);
    assert!(job.approved().is_ok());
    let with = |settings| Fabrication { settings, ..job.clone() };
    let hinged = Settings { joint: Joint::Hinge, ..job.settings.clone() };
    assert_eq!(with(hinged).approved(), Err(Shut::Stale));
    let mut other = template.clone();
    other.source.push_str("\n# another clearance");
    assert_eq!(with(Settings::new(other)).approved(), Err(Shut::Stale));
    let (moved, _) = Structure::new(
        (examples::named("three").expect("it is embedded").draft)().scaled(1.001),
        &Tolerance::default(),
    )
    .expect("it is one");
    let moved = Fabrication { structure: Some(moved), ..job.clone() };
    assert_eq!(moved.approved(), Err(Shut::Stale));
    let unjudged = Fabrication { verdict: None, ..job };
    assert_eq!(unjudged.approved(), Err(Shut::Stale));
}

#[test]
fn hinges_are_judged_before_their_parts_exist() {
    let place = tempfile::tempdir().expect("there is room");
    let ends = |words: &[&str]| code(&run(place.path(), words));
    assert_eq!(ends(&["make", "dome", "--joint", "hinge", "-q"]), 3);
    assert!(place.path().join("out/dome.refused/job.json").exists());
    assert_eq!(ends(&["check", "dome", "--joint", "hinge", "-q"]), 3);
    assert_eq!(ends(&["rigidity", "dome", "--joint", "hinge", "-q"]), 3);
    assert_eq!(ends(&["rigidity", "vault", "-q"]), 0);
}

#[test]
fn the_vault_is_rigid_as_strips_and_flexible_as_fins_on_columns() {
    assert_eq!(outcome(vault(None), Joint::Lap), Outcome::Rigid);
    let draft = vault(None);
    let corner = |x: f64, y: f64| {
        let out = |k: &usize| draft.positions[*k].x * x + draft.positions[*k].y * y;
        let nodes = 0..draft.positions.len();
        nodes.max_by(|a, b| out(a).total_cmp(&out(b))).expect("it has nodes")
    };
    let columns = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
    let columns: Vec<usize> = columns.iter().map(|&(x, y)| corner(x, y)).collect();
    let single = outcome(vault(Some(columns)), Joint::Hinge);
    assert!(matches!(single, Outcome::Flexible | Outcome::Mechanism), "{single:?}");
}
