//! What is refused leaves nothing half-written, and ends with the code of docs/job.md.

use std::path::Path;
use std::process::Command;

fn make(input: &str, output: &Path) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_finwright"))
        .args(["make", input, "--effort", "quick", "--json", "-o"])
        .arg(output)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    (output.status.code(), String::from_utf8(output.stdout).unwrap())
}

fn entries(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn a_file_that_cannot_be_read_writes_nothing() {
    let place = tempfile::tempdir().unwrap();
    let (code, printed) =
        make("fixtures/bad/read/bad_json.json", &place.path().join("job"));
    assert_eq!(code, Some(1));
    let said: serde_json::Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(said["passes"], false);
    assert_eq!(said["findings"][0]["code"], "read::bad_json");
    assert_eq!(said["findings"][0]["place"]["line"], 11);
    assert_eq!(entries(place.path()), Vec::<String>::new());
}

#[test]
fn rigidity_says_in_json_what_it_cannot_read() {
    let cases: [(&[&str], &str, i32); 4] = [
        (&["nowhere.json"], "input::unreadable", 1),
        (&["fixtures/bad/read/bad_json.json"], "read::bad_json", 1),
        (&["--linkage", "fixtures/bad/read/bad_json.json"], "rigidity::bad_linkage", 1),
        (&["vault", "-t", "nowhere"], "template::unknown_name", 1),
    ];
    for (words, first, ends) in cases {
        let output = Command::new(env!("CARGO_BIN_EXE_finwright"))
            .args(["rigidity", "--json"])
            .args(words)
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .unwrap();
        let said: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(ends), "{words:?}");
        assert_eq!(said["passes"], false, "{words:?}");
        assert_eq!(said["findings"][0]["code"], first, "{words:?}");
    }
}

#[test]
fn a_draft_that_is_no_structure_writes_nothing_and_says_so_in_json() {
    let place = tempfile::tempdir().unwrap();
    let (code, printed) =
        make("fixtures/bad/structure/zero_axis.json", &place.path().join("job"));
    assert_eq!(code, Some(3));
    let job: serde_json::Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(job["findings"][0]["code"], "structure::zero_axis");
    assert_eq!(job["findings"][0]["place"]["nodes"][0], 4);
    assert_eq!(entries(place.path()), Vec::<String>::new());
}

#[test]
fn a_structure_that_cannot_be_cut_gets_stamped_pictures_only() {
    let place = tempfile::tempdir().unwrap();
    let job = place.path().join("job");
    let (code, _) = make("fixtures/bad/parts/web_too_thin.json", &job);
    assert_eq!(code, Some(3));
    assert_eq!(entries(place.path()), ["job.refused"]);
    let job = place.path().join("job.refused");
    let files = [
        "SHA256SUMS",
        "job.json",
        "parts.csv",
        "preview",
        "report.html",
        "structure.json",
    ];
    assert_eq!(entries(&job), files);
    assert!(entries(&job.join("preview")).iter().all(|name| name.ends_with(".png")));
}

/// All below a folder with its bytes.
fn all(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for name in entries(folder) {
        let path = folder.join(&name);
        if path.is_dir() {
            files.extend(all(&path));
        } else {
            files.push((
                path.to_string_lossy().into_owned(),
                std::fs::read(path).unwrap(),
            ));
        }
    }
    files
}

#[test]
fn a_good_job_outlives_a_refused_one_and_what_was_changed_is_kept() {
    let place = tempfile::tempdir().unwrap();
    let job = place.path().join("job");
    assert_eq!(make("three", &job).0, Some(0));
    std::fs::write(job.join("sheets/sheet-01.svg"), "edited").unwrap();
    std::fs::write(job.join("notes.txt"), "cut twice").unwrap();
    let good = all(&job);
    // Refused, and refused again: the good one is as it was, edits and all.
    for _ in 0..2 {
        assert_eq!(make("fixtures/bad/parts/web_too_thin.json", &job).0, Some(3));
        assert_eq!(all(&job), good);
        assert_eq!(entries(place.path()), ["job", "job.refused"]);
    }
    assert_eq!(make("five", &job).0, Some(0));
    assert_eq!(entries(place.path()), ["job", "job.before-1", "job.refused"]);
    let kept = place.path().join("job.before-1");
    assert_eq!(entries(&kept), ["notes.txt", "sheets"]);
    assert_eq!(entries(&kept.join("sheets")), ["sheet-01.svg"]);
    assert_eq!(std::fs::read(kept.join("notes.txt")).unwrap(), b"cut twice");
}

#[test]
fn what_the_stock_does_not_hold_is_pictured_with_the_sheets_it_would_take() {
    let place = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_finwright"))
        .args(["make", "three", "-t", "fixtures/bad/nest/two-small-sheets.toml", "-o"])
        .arg(place.path().join("job"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(3));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("all parts would take "), "{said}");
    let job = place.path().join("job.refused");
    assert!(entries(&job.join("preview")).len() > 2);
}

#[test]
fn a_report_of_what_was_never_made_shows_no_zeros() {
    let place = tempfile::tempdir().unwrap();
    let (code, _) =
        make("fixtures/bad/parts/model_too_small.json", &place.path().join("job"));
    assert_eq!(code, Some(3));
    let page = place.path().join("job.refused/report.html");
    let page = std::fs::read_to_string(page).unwrap();
    assert!(!page.contains("<b>0</b>") && !page.contains("0.0 m"), "{page}");
    assert!(page.contains("No part was made."));
}

#[test]
fn a_folder_of_somebody_else_is_refused_before_any_work() {
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join("thesis.txt"), "years of work").unwrap();
    let (code, _) = make("vault", place.path());
    assert_eq!(code, Some(1));
    assert_eq!(entries(place.path()), ["thesis.txt"]);
}

/// Windows editors put a mark before the text, and old exporters write names in Latin-1.
#[test]
fn foreign_bytes_that_do_no_harm_are_read_over() {
    let place = tempfile::tempdir().unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mesh = std::fs::read(root.join("fixtures/bad/read/not_a_face.obj")).unwrap();
    let latin = [b"# Fl\xE4che\n".as_slice(), &mesh].concat();
    let json = std::fs::read(root.join("fixtures/bad/read/unknown_key.json")).unwrap();
    let marked = [b"\xEF\xBB\xBF".as_slice(), &json].concat();
    for (name, bytes) in [("latin.obj", latin), ("marked.json", marked)] {
        let path = place.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let (code, _) = make(&path.to_string_lossy(), &place.path().join("job"));
        assert_eq!(code, Some(0), "{name}");
    }
}
