//! Words of a parts file that mean nothing, and names given twice: told, never read over.

use crate::template::nearest;
use miette::Diagnostic;
use serde_json::Value;
use std::collections::BTreeMap;
use thiserror::Error;

/// What a parts file says that cannot be meant so.
#[derive(Debug, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub(super) enum NestKeyError {
    #[error("{place}: there is no key \"{found}\"")]
    #[diagnostic(
        code(read::unknown_part_key),
        help("the nearest known key is \"{nearest}\"; docs/nesting.md lists them all")
    )]
    UnknownKey { place: String, found: String, nearest: String },

    #[error("{place}: \"{found}\" are no rotations")]
    #[diagnostic(
        code(read::unknown_rotations),
        help("the nearest known word is \"{nearest}\"; or give a list of degrees")
    )]
    UnknownRotations { place: String, found: String, nearest: String },

    #[error("the id \"{id}\" is given twice, to part {first} and to part {second}")]
    #[diagnostic(
        code(read::part_id_twice),
        help("give each shape an id of its own; `quantity` asks for copies")
    )]
    IdTwice { id: String, first: usize, second: usize },
}

/// Of a parts file, and of a layout.json, which may be given back.
const FILE: [&str; 14] = [
    "format",
    "version",
    "generator",
    "name",
    "seed",
    "work",
    "spacing",
    "utilisation",
    "cost",
    "length",
    "density",
    "sheets",
    "unplaced",
    "parts",
];
/// Of a sheet, and of a piece of free space in a layout.json, which may be a sheet again.
const SHEET: [&str; 14] = [
    "id",
    "width",
    "height",
    "margin",
    "count",
    "cost",
    "outline",
    "holes",
    "area",
    "placements",
    "files",
    "utilisation",
    "offcut",
    "free",
];
const PLACEMENT: [&str; 6] = ["part", "copy", "x", "y", "angle_deg", "locked"];
const PART: [&str; 6] = ["id", "quantity", "outline", "holes", "rotations", "priority"];
const ROTATIONS: [&str; 2] = ["free", "locked"];

/// The first thing in a parts file that cannot be meant so; strips have keys of their own.
pub(super) fn fault(text: &str) -> Option<NestKeyError> {
    let file: &Value = &serde_json::from_str(text).ok()?;
    if file.get("strip_height").is_some() {
        return None;
    }
    let rows =
        |of: &'static str| file.get(of).and_then(Value::as_array).into_iter().flatten();
    let sheets = rows("sheets").enumerate().find_map(|(k, sheet)| {
        let place = format!("sheet {}", k + 1);
        let placed = sheet.get("placements").and_then(Value::as_array);
        let mut placed = placed.into_iter().flatten();
        unknown(sheet, &SHEET, &place).or_else(|| {
            placed
                .find_map(|p| unknown(p, &PLACEMENT, &format!("a placement on {place}")))
        })
    });
    let parts = || rows("parts").enumerate();
    let mut known: BTreeMap<&str, usize> = BTreeMap::new();
    unknown(file, &FILE, "the file")
        .or(sheets)
        .or_else(|| parts().find_map(|(k, part)| of_part(k + 1, part)))
        .or_else(|| {
            parts().find_map(|(k, part)| {
                let id = part.get("id")?.as_str()?;
                let first = known.insert(id, k + 1)?;
                Some(NestKeyError::IdTwice { id: id.to_owned(), first, second: k + 1 })
            })
        })
}

fn of_part(number: usize, part: &Value) -> Option<NestKeyError> {
    let id = part.get("id").and_then(Value::as_str).unwrap_or_default();
    let place = format!("part {number} \"{id}\"");
    let word = part.get("rotations").and_then(Value::as_str);
    let word = word.filter(|word| !ROTATIONS.contains(word));
    unknown(part, &PART, &place).or_else(|| {
        let (found, nearest) = (word?.to_owned(), nearest(word?, ROTATIONS));
        Some(NestKeyError::UnknownRotations { place, found, nearest })
    })
}

fn unknown(object: &Value, known: &[&'static str], place: &str) -> Option<NestKeyError> {
    let mut keys = object.as_object()?.keys();
    let found = keys.find(|key| !known.contains(&key.as_str()))?.clone();
    let nearest = nearest(&found, known.iter().copied());
    Some(NestKeyError::UnknownKey { place: place.to_owned(), found, nearest })
}
