//! Parts files that say what finwright does not know, or say it twice, are refused with the
//! place and the nearest known word; nothing is read over.

use serde_json::{Value, json};
use std::process::Command;

fn file(parts: Value) -> Value {
    let sheet = json!({"width": 600, "height": 400});
    json!({"format": "finwright-parts", "version": 1, "sheets": [sheet], "parts": parts})
}

fn part(id: &str, side: f64) -> Value {
    json!({"id": id, "outline": [[0, 0], [side, 0], [side, side], [0, side]]})
}

fn with(mut value: Value, key: &str, what: Value) -> Value {
    value[key] = what;
    value
}

/// The exit code, what was said and the layout.
fn nested(file: &Value) -> (Option<i32>, String, Option<Value>) {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("parts.json");
    std::fs::write(&path, file.to_string()).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_finwright"));
    command.args(["nest", "parts.json", "--effort", "quick", "-o", "out"]);
    let ran = command.current_dir(place.path()).output().unwrap();
    let layout = std::fs::read_to_string(place.path().join("out/layout.json")).ok();
    let layout = layout.map(|text| serde_json::from_str(&text).unwrap());
    (ran.status.code(), String::from_utf8(ran.stderr).unwrap(), layout)
}

fn refused(file: &Value, words: &[&str]) {
    let (code, said, layout) = nested(file);
    assert_eq!((code, layout), (Some(1), None), "{said}");
    words.iter().for_each(|word| assert!(said.contains(word), "{word} in {said}"));
}

#[test]
fn a_misspelt_key_is_refused_with_the_nearest_one_wherever_it_stands() {
    let misspelt = with(part("a", 50.0), "quanity", json!(5));
    refused(&file(json!([misspelt])), &["part 1 \"a\"", "quanity", "quantity"]);
    let second = json!([part("a", 50.0), with(part("b", 50.0), "hole", json!([]))]);
    refused(&file(second), &["part 2 \"b\"", "\"hole\"", "\"holes\""]);
    let sheet = json!({"width": 600, "height": 400, "margn": 3});
    let odd = with(file(json!([part("a", 50.0)])), "sheets", json!([sheet]));
    refused(&odd, &["sheet 1", "margn", "margin"]);
    let odd = with(file(json!([part("a", 50.0)])), "spaceing", json!(3));
    refused(&odd, &["the file", "spaceing", "spacing"]);
    let placed = json!({"part": "a", "copy": 1, "x": 10, "y": 10, "angle": 0});
    let sheet = json!({"width": 600, "height": 400, "placements": [placed]});
    let odd = with(file(json!([part("a", 50.0)])), "sheets", json!([sheet]));
    refused(&odd, &["a placement on sheet 1", "\"angle\"", "angle_deg"]);
}

#[test]
fn an_unknown_word_for_rotations_is_never_taken_for_free() {
    for (word, nearest) in [("fixed", "free"), ("lock", "locked"), ("Free", "free")] {
        let odd = with(part("a", 50.0), "rotations", json!(word));
        refused(&file(json!([odd])), &["part 1 \"a\"", word, nearest]);
    }
    for fine in [json!("free"), json!("locked"), json!([0, 180])] {
        let (code, said, _) =
            nested(&file(json!([with(part("a", 50.0), "rotations", fine)])));
        assert_eq!(code, Some(0), "{said}");
    }
}

#[test]
fn one_id_for_two_parts_is_refused_with_both_places() {
    let parts =
        json!([part("b", 5.0), part("a", 10.0), part("c", 5.0), part("a", 200.0)]);
    refused(&file(parts), &["\"a\"", "part 2", "part 4"]);
}

#[test]
fn a_layout_given_back_is_read_with_all_its_keys() {
    let (code, said, layout) =
        nested(&file(json!([with(part("a", 50.0), "quantity", json!(3))])));
    assert_eq!(code, Some(0), "{said}");
    let (code, said, layout) = nested(&layout.unwrap());
    assert_eq!(code, Some(0), "{said}");
    let layout = layout.unwrap();
    assert_eq!(layout["sheets"][0]["placements"].as_array().unwrap().len(), 3);
    // What is left of a sheet is a sheet for the next parts.
    let mut again = file(json!([part("b", 50.0)]));
    again["sheets"] = layout["sheets"][0]["free"].clone();
    let (code, said, layout) = nested(&again);
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(layout.unwrap()["sheets"][0]["placements"].as_array().unwrap().len(), 1);
}

#[test]
fn a_hole_in_a_hole_or_outside_is_refused_with_its_place() {
    let square =
        |low: f64, high: f64| json!([[low, low], [high, low], [high, high], [low, high]]);
    let cases = [
        (
            json!([square(10.0, 90.0), square(30.0, 60.0)]),
            "hole 2 at (30.000, 60.000) is inside of hole 1",
        ),
        (
            json!([square(30.0, 60.0), square(10.0, 90.0)]),
            "hole 1 at (30.000, 60.000) is inside of hole 2",
        ),
        (json!([square(110.0, 120.0)]), "hole 1 at (110.000, 120.000) is outside of it"),
    ];
    for (holes, why) in cases {
        let bad = with(part("a", 100.0), "holes", holes);
        let (code, said, _) = nested(&file(json!([bad, part("b", 50.0)])));
        assert_eq!(code, Some(3), "{said}");
        assert!(said.contains(why), "{said}");
    }
}

#[test]
fn parts_without_a_place_end_with_code_3() {
    let sheet = json!({"width": 150, "height": 100, "margin": 5, "count": 3});
    let outline = json!([[0, 0], [141, 0], [141, 90], [0, 90]]);
    let parts = json!([{"id": "r", "quantity": 30, "outline": outline}]);
    let (code, said, _) = nested(&with(file(parts), "sheets", json!([sheet.clone()])));
    assert_eq!(code, Some(3), "{said}");
    // As large as the free area: three fit, one each.
    let outline = json!([[0, 0], [140, 0], [140, 90], [0, 90]]);
    let parts = json!([{"id": "r", "quantity": 30, "outline": outline}]);
    let (code, said, layout) = nested(&with(file(parts), "sheets", json!([sheet])));
    assert_eq!(code, Some(3), "{said}");
    assert_eq!(layout.unwrap()["sheets"].as_array().unwrap().len(), 3);
    assert!(said.contains("30 sheet(s)"), "{said}");
}
