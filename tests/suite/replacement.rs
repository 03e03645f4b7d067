//! Single parts again: the same shapes as in the whole job, alone, and proved.
#![allow(clippy::unwrap_used, reason = "a test that cannot be set up has failed")]

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

fn finwright(args: &[&str], dir: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_finwright")).args(args).arg(dir).output().unwrap()
}

fn manifest(dir: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(dir.join("job.json")).unwrap()).unwrap()
}

#[test]
fn parts_made_again_are_the_parts_of_the_job_and_verify_passes() {
    let place = tempfile::tempdir().unwrap();
    let (whole, again) = (place.path().join("whole"), place.path().join("again"));
    let make = ["make", "dome", "-q", "--effort", "quick"];
    let code = |args: &[&str], dir: &Path| finwright(args, dir).status.code();
    assert_eq!(code(&[&make[..], &["-o"]].concat(), &whole), Some(0));
    let only = ["--only", "s05,S02a,S05a", "-o"];
    assert_eq!(code(&[&make[..], &only].concat(), &again), Some(0));
    assert_eq!(code(&["verify", "-q"], &again), Some(0));
    let (whole, again) = (manifest(&whole), manifest(&again));
    // Strip 5 of the dome is spliced.
    assert_eq!(again["only"], serde_json::json!(["S05a", "S05b", "S02a"]));
    assert_eq!(whole["only"], Value::Null);
    let part = |id: &str| {
        let parts = whole["parts"].as_array().unwrap();
        parts.iter().find(|part| part["id"] == id).unwrap()
    };
    let parts = ["S02a", "S05a", "S05b"].map(part);
    assert_eq!(again["parts"], serde_json::json!(parts));
    let placed = again["sheets"][0]["placements"].as_array().unwrap().len();
    assert_eq!(placed, 3);
}

#[test]
fn a_connector_is_made_again_with_all_its_plates() {
    let place = tempfile::tempdir().unwrap();
    let dir = place.path().join("again");
    let make = ["make", "three", "--joint", "hub", "-q", "--effort", "quick"];
    let only = ["--only", "n0,F001", "-o"];
    let made = finwright(&[&make[..], &only].concat(), &dir);
    assert_eq!(made.status.code(), Some(0), "{}", String::from_utf8_lossy(&made.stderr));
    assert_eq!(finwright(&["verify", "-q"], &dir).status.code(), Some(0));
    let manifest = manifest(&dir);
    let placements = manifest["sheets"][0]["placements"].as_array().unwrap();
    let copies: Vec<&Value> = placements.iter().map(|p| &p["copy"]).collect();
    assert_eq!(placements.len(), 3, "two discs and a fin: {copies:?}");
}

#[test]
fn a_name_that_no_part_has_is_told_with_the_nearest_and_nothing_is_written() {
    let place = tempfile::tempdir().unwrap();
    let dir = place.path().join("again");
    let args = ["make", "three", "-q", "--effort", "quick", "--only", "S2O", "-o"];
    let told = finwright(&args, &dir);
    assert_eq!(told.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&told.stderr).contains("job::no_such_part"));
    assert!(!dir.exists());
}
