//! Every key a template may have: its kind, whether it is needed, and its range.

use crate::diagnostic::short;
use crate::template::Template;
use crate::template::error::TemplateFault;
use toml::{Table, Value};

/// What a value has to be.
#[derive(Debug, Clone, Copy)]
enum Kind {
    /// A number from the first to the second.
    Number(f64, f64),
    Whole,
    Flag,
    Text,
    /// A list of node numbers.
    Nodes,
    /// One of these words.
    Word(&'static [&'static str]),
}

struct Key {
    name: &'static str,
    kind: Kind,
    needed: bool,
}

const fn need(name: &'static str, kind: Kind) -> Key {
    Key { name, kind, needed: true }
}

const fn may(name: &'static str, kind: Kind) -> Key {
    Key { name, kind, needed: false }
}

const MATERIAL: &[Key] = &[
    need("name", Kind::Text),
    need("thickness_mm", Kind::Number(0.05, 50.0)),
    need("thickness_least_mm", Kind::Number(0.05, 50.0)),
    need("thickness_most_mm", Kind::Number(0.05, 50.0)),
    need("kerf_mm", Kind::Number(0.0, 2.0)),
    need("clearance_mm", Kind::Number(-1.0, 2.0)),
    need("web_mm", Kind::Number(0.0, 100.0)),
    need("web_least_mm", Kind::Number(0.0, 100.0)),
    need("relief_radius_mm", Kind::Number(0.0, 10.0)),
    need("e_modulus_mpa", Kind::Number(1.0, 1e6)),
    need("density_kg_m3", Kind::Number(1.0, 3e4)),
    need("cut_speed_mm_s", Kind::Number(0.01, 1e4)),
    need("engrave_speed_mm_s", Kind::Number(0.01, 1e5)),
    may("price_per_m2", Kind::Number(0.0, 1e6)),
    may("grain", Kind::Flag),
];
const BEND: &[Key] = &[
    need("long_term", Kind::Number(0.0, 1e4)),
    need("model", Kind::Number(0.0, 1e4)),
    need("crack", Kind::Number(0.0, 1e4)),
    need("fold_marks", Kind::Word(&["none", "engrave", "score"])),
];
const JOINT: &[Key] = &[
    need("overhang_mm", Kind::Number(0.0, 500.0)),
    may("lap_split", Kind::Number(0.3, 0.7)),
    need("depth_allowance_mm", Kind::Number(0.0, 5.0)),
    need("mouth_chamfer_mm", Kind::Number(0.0, 20.0)),
    need("mouth_chamfer_deg", Kind::Number(0.0, 60.0)),
    need("setback_mm", Kind::Number(0.0, 50.0)),
    need("connector_thickness_mm", Kind::Number(0.05, 50.0)),
    need("rod_diameter_mm", Kind::Number(0.1, 100.0)),
    may("disc_slot_mm", Kind::Number(1.0, 500.0)),
    may("hub_nodes", Kind::Nodes),
];
const SHEET: &[Key] = &[
    need("width_mm", Kind::Number(10.0, 1e5)),
    need("height_mm", Kind::Number(10.0, 1e5)),
    need("margin_mm", Kind::Number(0.0, 1e3)),
    need("spacing_mm", Kind::Number(0.0, 1e3)),
    may("count", Kind::Whole),
    may("price", Kind::Number(0.0, 1e6)),
];
/// What `output.profile` may be.
pub const PROFILES: [&str; 6] =
    ["generic", "lightburn", "rgb-lab", "snijlab", "epilog", "single-part"];

const OUTPUT: &[Key] = &[
    may("profile", Kind::Word(&PROFILES)),
    may("frame", Kind::Flag),
    may("lettering_mm", Kind::Number(1.0, 50.0)),
    may("one_file_per", Kind::Word(&["sheet", "part"])),
];
const GATE: &[Key] = &[
    may("play_mm", Kind::Number(0.0, 10.0)),
    may("sway_limit", Kind::Text),
    may("planarity_warn_percent", Kind::Number(0.0, 5.0)),
    may("planarity_limit_percent", Kind::Number(0.0, 5.0)),
    may("crossing_warn_deg", Kind::Number(0.0, 90.0)),
    may("crossing_least_deg", Kind::Number(5.0, 90.0)),
    may("fin_angle_least_deg", Kind::Number(5.0, 120.0)),
    may("proof_mm", Kind::Number(0.001, 1.0)),
    may("proof_deg", Kind::Number(0.0001, 5.0)),
];
const TABLES: &[(&str, &[Key])] = &[
    ("material", MATERIAL),
    ("bend", BEND),
    ("joint", JOINT),
    ("sheet", SHEET),
    ("output", OUTPUT),
    ("gate", GATE),
];

/// All keys with their tables.
#[cfg(test)]
pub(super) fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    let tables = TABLES.iter();
    tables.flat_map(|(table, keys)| keys.iter().map(move |key| (*table, key.name)))
}

/// The known name most like the one found.
pub(crate) fn nearest<'a>(
    found: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> String {
    let off = |name: &&str| strsim::damerau_levenshtein(found, name);
    // A known name that begins as the found one does is what was meant, most often.
    let begins = |name: &&str| !name.starts_with(found);
    known
        .into_iter()
        .min_by_key(|name| (begins(name), off(name)))
        .unwrap_or_default()
        .into()
}

/// A fault of TOML itself, with its line.
pub(super) fn syntax(source: &str, error: &toml::de::Error) -> TemplateFault {
    let end = error.span().map_or(0, |span| span.start.min(source.len()));
    let line = 1 + source.get(..end).unwrap_or_default().matches('\n').count();
    let text = source.lines().nth(line - 1).unwrap_or_default();
    let comma = text.split_once('=').and_then(|(_, value)| decimal_comma(value));
    let comma = comma.map(|(meant, found)| format!(" (write {meant}, not {found})"));
    let message = format!("{}{}", error.message(), comma.unwrap_or_default());
    TemplateFault::BadToml { line, message }
}

/// A number that begins a value and has a comma for its point, mended and as found.
fn decimal_comma(value: &str) -> Option<(String, String)> {
    let value = value.trim_start();
    let is_in = |c: char| c.is_ascii_digit() || matches!(c, ',' | '+' | '-' | '.');
    let found = &value[..value.find(|c| !is_in(c)).unwrap_or(value.len())];
    let meant = found.replacen(',', ".", 1);
    let is_number =
        meant != found && !meant.contains(',') && meant.parse::<f64>().is_ok();
    is_number.then(|| (meant, found.to_owned()))
}

/// Unknown and missing keys, wrong kinds, values out of range.
pub(super) fn faults(file: &Table, source: &str) -> Vec<TemplateFault> {
    let mut faults = Vec::new();
    let known = || TABLES.iter().map(|(table, _)| *table);
    for found in file.keys().filter(|found| !known().any(|table| table == found.as_str()))
    {
        faults.push(TemplateFault::UnknownKey {
            line: line(source, "", found),
            table: "the file".to_owned(),
            found: found.clone(),
            nearest: nearest(found, known()),
        });
    }
    for (table, keys) in TABLES {
        match file.get(*table) {
            Some(Value::Table(found)) if *table != "sheet" => {
                faults.extend(table_faults(table, found, keys, source));
            }
            Some(Value::Array(sheets)) if *table == "sheet" => {
                for sheet in sheets.iter().filter_map(Value::as_table) {
                    faults.extend(table_faults(table, sheet, keys, source));
                }
            }
            None if keys.iter().any(|key| key.needed) => {
                let table = table.to_string();
                faults.push(TemplateFault::MissingKey {
                    table,
                    key: "(the whole table)".to_owned(),
                });
            }
            None => {}
            Some(found) => faults.push(TemplateFault::WrongType {
                line: line(source, "", table),
                key: table.to_string(),
                found: found.type_str().to_owned(),
                wanted: if *table == "sheet" { "[[sheet]]" } else { "a [table]" },
            }),
        }
    }
    faults
}

fn table_faults(
    table: &str,
    found: &Table,
    keys: &[Key],
    source: &str,
) -> Vec<TemplateFault> {
    let mut faults = Vec::new();
    for (name, value) in found {
        match keys.iter().find(|key| key.name == name) {
            Some(key) => {
                faults.extend(value_fault(key, value, line(source, table, name)));
            }
            None => faults.push(TemplateFault::UnknownKey {
                line: line(source, table, name),
                table: format!("[{table}]"),
                found: name.clone(),
                nearest: nearest(name, keys.iter().map(|key| key.name)),
            }),
        }
    }
    let missing = keys.iter().filter(|key| key.needed && !found.contains_key(key.name));
    faults.extend(missing.map(|key| TemplateFault::MissingKey {
        table: table.to_owned(),
        key: key.name.to_owned(),
    }));
    faults
}

fn value_fault(key: &Key, value: &Value, line: usize) -> Option<TemplateFault> {
    let number = match value {
        Value::Float(number) => Some(*number),
        Value::Integer(number) => Some(*number as f64),
        _ => None,
    };
    let wanted = match (key.kind, number, value) {
        (Kind::Number(least, most), Some(value), _) => {
            let key = key.name.to_owned();
            return (!(least..=most).contains(&value))
                .then_some(TemplateFault::OutOfRange { line, key, value, least, most });
        }
        (Kind::Number(..), ..) => "a number",
        (Kind::Whole, _, Value::Integer(count)) if *count >= 0 => return None,
        (Kind::Whole, ..) => "a whole number",
        (Kind::Flag, _, Value::Boolean(_)) => return None,
        (Kind::Flag, ..) => "true or false",
        (Kind::Nodes, _, Value::Array(list)) if list.iter().all(is_node) => return None,
        (Kind::Nodes, ..) => "a list of node numbers, such as [3, 17]",
        (Kind::Text, _, Value::String(_)) => return None,
        (Kind::Text, ..) => "a text in quotes",
        (Kind::Word(words), _, Value::String(word)) if words.contains(&word.as_str()) => {
            return None;
        }
        (Kind::Word(&["none", ..]), ..) => "\"none\", \"engrave\" or \"score\"",
        (Kind::Word(&["sheet", ..]), ..) => "\"sheet\" or \"part\"",
        (Kind::Word(_), ..) => {
            "\"generic\", \"lightburn\", \"rgb-lab\", \"snijlab\", \"epilog\" or \"single-part\""
        }
    };
    Some(TemplateFault::WrongType {
        line,
        key: key.name.to_owned(),
        found: value.to_string(),
        wanted,
    })
}

fn is_node(value: &Value) -> bool {
    value.as_integer().is_some_and(|node| node >= 0)
}

/// Line of a key in its table, from 1; 0 if it cannot be found (inline tables).
fn line(source: &str, table: &str, key: &str) -> usize {
    let mut current = "";
    for (index, text) in source.lines().enumerate() {
        let text = text.trim();
        if text.starts_with('[') {
            current = text.trim_matches(['[', ']']).split(']').next().unwrap_or_default();
            if table.is_empty() && current == key {
                return index + 1;
            }
        }
        let name = text.split('=').next().unwrap_or_default().trim().trim_matches('"');
        if (table.is_empty() || current == table) && name == key {
            return index + 1;
        }
    }
    0
}

/// Values that do not go together.
pub(super) fn contradictions(template: &Template) -> Vec<TemplateFault> {
    let (material, bend, gate) = (&template.material, &template.bend, &template.gate);
    let mut messages = Vec::new();
    let (least, most) = (material.thickness_least_mm, material.thickness_most_mm);
    if !(least <= material.thickness_mm && material.thickness_mm <= most) {
        let t = material.thickness_mm;
        messages.push(format!("thickness_mm {t} is outside its range {least} to {most}"));
    }
    let mut order = |what: &str, low: f64, high: f64| {
        if low > high {
            messages.push(format!("{what}: {low} is more than {high}"));
        }
    };
    order("web_least_mm above web_mm", material.web_least_mm, material.web_mm);
    order("bend.crack above bend.model", bend.crack, bend.model);
    order("bend.model above bend.long_term", bend.model, bend.long_term);
    order(
        "planarity_warn_percent above planarity_limit_percent",
        gate.planarity_warn_percent,
        gate.planarity_limit_percent,
    );
    order(
        "crossing_least_deg above crossing_warn_deg",
        gate.crossing_least_deg,
        gate.crossing_warn_deg,
    );
    for (index, sheet) in template.sheet.iter().enumerate() {
        let smaller = sheet.width_mm.min(sheet.height_mm);
        order(
            &format!("margins wider than sheet {}", index + 1),
            2.0 * sheet.margin_mm + 1.0,
            smaller,
        );
    }
    if template.sheet.is_empty() {
        messages.push("there is no [[sheet]]".to_owned());
    }
    let (gap, kerf) = (material.thickness_mm + material.clearance_mm, material.kerf_mm);
    if gap <= kerf {
        messages.push(format!(
            "thickness_mm and clearance_mm make slits of {} mm, no wider than kerf_mm {kerf}",
            short(gap)
        ));
    }
    messages.into_iter().map(|message| TemplateFault::Contradiction { message }).collect()
}
