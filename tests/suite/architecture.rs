//! The order of modules and a few house rules, read from the source itself.

use std::fs;
use std::path::{Path, PathBuf};

/// Each module may use only the modules before it. This list is the architecture.
const ORDER: &[&str] = &[
    "tolerance",
    "units",
    "ids",
    "watch",
    "diagnostic",
    "json",
    "files",
    "geometry",
    "picture",
    "sparse",
    "drawing",
    "lettering",
    "joint",
    "structure",
    "design",
    "template",
    "rigidity",
    "parts",
    "nest",
    "sheets",
    "gate",
    "export",
    "vendor",
    "manifest",
    "settings",
    "fabrication",
    "proof",
    "report",
    "job",
    "cli",
];

/// A source file without its tests.
struct Source {
    /// Such as `parts/joint.rs`.
    path: String,
    lines: Vec<String>,
    /// Lines with tests.
    length: usize,
}

impl Source {
    fn module(&self) -> &str {
        self.path.split(['/', '.']).next().unwrap_or_default()
    }

    /// Lines of code with their numbers, comments left out.
    fn code(&self) -> impl Iterator<Item = (usize, &str)> {
        let lines = self.lines.iter().enumerate();
        lines.map(|(k, line)| (k + 1, line.split("//").next().unwrap_or_default()))
    }
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    collect(&root, &mut files);
    files.sort();
    let sources = files.into_iter().map(|file| {
        let text = fs::read_to_string(&file).expect("sources can be read");
        let tests = text.find("#[cfg(test)]\nmod tests").unwrap_or(text.len());
        let path = file.strip_prefix(&root).expect("it is below").to_string_lossy();
        Source {
            path: path.replace('\\', "/"),
            lines: text[..tests].lines().map(str::to_owned).collect(),
            length: text.lines().count(),
        }
    });
    sources.collect()
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("folders can be read") {
        let path = entry.expect("entries can be read").path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            files.push(path);
        }
    }
}

/// The modules that a line names after `crate::`; `*` for a list that hides them.
fn named(line: &str) -> Vec<String> {
    let after = line.match_indices("crate::").map(|(at, word)| &line[at + word.len()..]);
    let word = |rest: &str| match rest.chars().next() {
        Some('{') => "*".to_owned(),
        _ => rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect(),
    };
    after.map(word).collect()
}

#[test]
fn modules_use_only_earlier_modules() {
    let place = |module: &str| ORDER.iter().position(|known| *known == module);
    let mut offences = Vec::new();
    for source in sources() {
        let module = source.module();
        if ["lib", "main"].contains(&module) {
            continue;
        }
        let Some(own) = place(module) else {
            offences.push(format!("{}: {module} is not in ORDER", source.path));
            continue;
        };
        for (number, line) in source.code() {
            let later = |other: &String| place(other).is_none_or(|other| other > own);
            for other in named(line).into_iter().filter(later) {
                offences.push(format!("{}:{number}: uses {other}", source.path));
            }
        }
    }
    assert!(offences.is_empty(), "{}", offences.join("\n"));
}

/// Lines outside `exempt` files that hold one of the words.
fn found(words: &[&str], exempt: impl Fn(&str) -> bool) -> Vec<String> {
    // A folder `tests` inside a stage is compiled for tests only.
    let checked = |path: &str| !exempt(path) && !path.contains("/tests/");
    let sources = sources().into_iter().filter(|source| checked(&source.path));
    let lines = sources.flat_map(|source| {
        let hits =
            source.code().filter(|(_, line)| words.iter().any(|w| line.contains(w)));
        let hits: Vec<String> = hits
            .map(|(k, line)| format!("{}:{k}: {}", source.path, line.trim()))
            .collect();
        hits
    });
    lines.collect()
}

#[test]
fn only_the_command_line_touches_the_world() {
    let words = ["std::fs", "std::env", "println!", "Instant", "SystemTime", "std::io"];
    let words = [&words[..], &["std::process"]].concat();
    let offences = found(&words, |path| path.starts_with("cli/") || path == "main.rs");
    // A type of the standard library, not the disk.
    let offences: Vec<String> =
        offences.into_iter().filter(|line| !line.contains("std::io::Error")).collect();
    assert!(offences.is_empty(), "{}", offences.join("\n"));
}

#[test]
fn every_slack_has_a_name_in_tolerance() {
    let small: Vec<String> = (0..10).map(|digit| format!("{digit}e-")).collect();
    let small: Vec<&str> = small.iter().map(String::as_str).collect();
    // `export/sample.rs` is compiled for tests only.
    let exempt = ["tolerance.rs", "export/sample.rs"];
    let offences = found(&small, |path| exempt.contains(&path));
    assert!(offences.is_empty(), "{}", offences.join("\n"));
}

#[test]
fn no_file_is_longer_than_four_hundred_lines() {
    let long = sources().into_iter().filter(|source| source.length > 400);
    let long: Vec<String> = long.map(|s| format!("{}: {}", s.path, s.length)).collect();
    assert!(long.is_empty(), "{}", long.join("\n"));
}

#[test]
fn only_sheets_know_how_far_the_kerf_moves_a_line() {
    let offences = found(&["offset::offset("], |path| path.starts_with("geometry/"));
    assert!(offences.is_empty(), "{}", offences.join("\n"));
    let users = found(&["offset::offset;"], |path| path == "sheets/kerf.rs");
    assert!(users.is_empty(), "{}", users.join("\n"));
}

/// What docs/proof.md says that the proof shares with the makers, and no more.
#[test]
fn the_proof_shares_only_what_its_page_lists() {
    let shared = "diagnostic json files geometry lettering structure drawing manifest parts export \
                  sheets proof tolerance units ids";
    let shared: Vec<&str> = shared.split_whitespace().collect();
    let mut offences = Vec::new();
    for source in sources().into_iter().filter(|source| source.module() == "proof") {
        for (number, line) in source.code() {
            let others = named(line).into_iter();
            let others = others.filter(|other| !shared.contains(&&**other));
            offences.extend(others.map(|o| format!("{}:{number}: {o}", source.path)));
            let maker = ["offset", "crate::parts::", "crate::export::"];
            let allowed = ["slit.offset", "LAYERS"];
            let collides = source.path == "proof/assembled.rs";
            if maker.iter().any(|word| line.contains(word))
                && !allowed.iter().any(|word| line.contains(word))
                && !(collides && line.starts_with("use crate::parts::{"))
            {
                offences.push(format!("{}:{number}: {}", source.path, line.trim()));
            }
        }
    }
    assert!(offences.is_empty(), "{}", offences.join("\n"));
}
