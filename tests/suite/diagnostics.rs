//! `docs/diagnostics.md` says what finwright says.
//!
//! Every code in `src` has a section there; the section's block is what the command
//! prints about the code's fixture. `UPDATE_DOCS=1 cargo test --test suite` writes blocks
//! and table anew and leaves the prose.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Prose begins so where no file can lead to a code.
const UNREACHABLE: &str = "No file leads here";

/// The path from the root.
fn at(path: impl AsRef<Path>) -> PathBuf {
    Path::new(ROOT).join(path)
}

fn files_under(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<PathBuf> = entries.collect();
    paths.sort();
    let below = |path: PathBuf| {
        if path.is_dir() { files_under(&path) } else { vec![path] }
    };
    paths.into_iter().flat_map(below).collect()
}

/// All codes that the sources declare.
fn codes() -> BTreeSet<String> {
    let is_word =
        |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_' || c == ':';
    let code = |text: &str| {
        let code = text.split_once(')')?.0;
        (code.contains("::") && code.chars().all(is_word)).then(|| code.to_owned())
    };
    let sources =
        files_under(&at("src")).into_iter().map(|path| fs::read_to_string(path).unwrap());
    sources
        .flat_map(|text| text.split("code(").skip(1).filter_map(code).collect::<Vec<_>>())
        .collect()
}

/// The fixture of each code, by its path from the root.
fn fixtures() -> BTreeMap<String, String> {
    let name = |path: &Path| path.to_string_lossy().replace('\\', "/");
    files_under(&at("fixtures/bad"))
        .into_iter()
        .map(|path| {
            let stage = path.parent().and_then(Path::file_name).unwrap();
            let what = path.file_stem().unwrap();
            let code = format!("{}::{}", name(stage.as_ref()), name(what.as_ref()));
            (code, name(path.strip_prefix(ROOT).unwrap()))
        })
        .collect()
}

/// What one types to see a fixture's diagnostic.
fn arguments(fixture: &str) -> String {
    match fixture.rsplit_once('.').map(|(_, ending)| ending) {
        Some("cmd") => {
            let text = fs::read_to_string(at(fixture)).unwrap();
            let line = text.lines().find(|line| !line.starts_with('#'));
            line.unwrap().to_owned()
        }
        Some("toml") => format!("template check {fixture}"),
        _ if is_linkage(fixture) => format!("rigidity --linkage {fixture}"),
        _ => format!("check {fixture}"),
    }
}

/// Bodies and pins instead of a structure.
fn is_linkage(fixture: &str) -> bool {
    fs::read_to_string(at(fixture)).is_ok_and(|text| text.starts_with("{\"bodies\""))
}

fn finwright(arguments: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_finwright"))
        .args(arguments.split_whitespace())
        .current_dir(ROOT)
        .output()
        .unwrap()
}

/// The lines printed about a code: those up to its help, after the help before.
fn block(code: &str, printed: &str) -> Option<String> {
    let is_help = |line: &str| {
        let first = line.trim_start().split(": ").next().unwrap_or_default();
        line.starts_with("  ") && first.contains("::") && !first.contains(' ')
    };
    // What a slow machine says of its progress is not about the code.
    let lines = printed.lines().filter(|line| !line.starts_with("working: "));
    let lines: Vec<&str> = lines.collect();
    let end = lines.iter().position(|line| {
        is_help(line) && line.trim_start().starts_with(&format!("{code}: "))
    })?;
    let start = lines[..end].iter().rposition(|line| is_help(line)).map_or(0, |k| k + 1);
    Some(lines[start..=end].join("\n"))
}

/// What a fixture's command says about its code.
struct Said {
    severity: String,
    command: String,
    block: String,
}

fn said(code: &str, fixture: &str) -> Said {
    let command = arguments(fixture);
    let output = finwright(&command);
    let printed = String::from_utf8(output.stderr).unwrap();
    let block = block(code, &printed).unwrap_or_else(|| {
        panic!("{fixture} does not lead to {code} but to:\n{printed}")
    });
    let severity = block.split(':').next().unwrap_or_default().to_owned();
    let stage = code.split("::").next().unwrap_or_default();
    let could_not_run = ["input", "read", "template", "job"].contains(&stage)
        || is_linkage(fixture)
        || ["rigidity::pairing_too_large", "surface::bad_ply", "surface::bad_stl"]
            .contains(&code);
    match (severity.as_str(), could_not_run) {
        ("error", true) => assert_eq!(output.status.code(), Some(1), "{fixture}"),
        ("error", false) => assert_eq!(output.status.code(), Some(3), "{fixture}"),
        _ => assert!([Some(0), Some(3)].contains(&output.status.code()), "{fixture}"),
    }
    assert!(!printed.contains(ROOT), "{fixture}: {printed}");
    Said { severity, command, block }
}

/// The prose of each section, below what was printed.
fn prose(doc: &str) -> BTreeMap<String, String> {
    let section = |text: &str| {
        let (code, rest) = text.split_once('\n').unwrap_or((text, ""));
        let written = |line: &&str| {
            line.is_empty() || line.starts_with("    ") || line.contains(" · ")
        };
        let rest = rest.split("\n## ").next().unwrap_or_default();
        let prose: Vec<&str> = rest.lines().skip_while(written).collect();
        (code.trim().to_owned(), prose.join("\n").trim().to_owned())
    };
    doc.split("\n### ").skip(1).map(section).collect()
}

fn link(code: &str) -> String {
    format!("[{code}](#{})", code.replace(':', ""))
}

/// The document: front page, table, and a section per code.
fn written(front: &str, prose: &BTreeMap<String, String>) -> String {
    let fixtures = fixtures();
    let mut table = String::from("| code | | fixture |\n|---|---|---|\n");
    let mut sections = String::new();
    let mut stage = "";
    for (code, prose) in prose {
        let now = code.split("::").next().unwrap_or_default();
        if now != stage {
            stage = now;
            let _ = write!(sections, "\n## {stage}\n");
        }
        let _ = write!(sections, "\n### {code}\n\n");
        match fixtures.get(code) {
            Some(fixture) => {
                let Said { severity, command, block } = said(code, fixture);
                let block = block.replace('\n', "\n    ");
                let _ = writeln!(
                    table,
                    "| {} | {severity} | [{}](../{fixture}) |",
                    link(code),
                    fixture.trim_start_matches("fixtures/bad/")
                );
                let _ = write!(
                    sections,
                    "{severity} · `finwright {command}`\n\n    {block}\n\n"
                );
            }
            None => {
                let _ = writeln!(table, "| {} | | none |", link(code));
                assert!(
                    prose.starts_with(UNREACHABLE),
                    "{code} has no file in fixtures/bad"
                );
            }
        }
        let _ = writeln!(sections, "{prose}");
    }
    format!("{front}\n\n{table}{sections}")
}

#[test]
fn the_document_says_what_is_printed_about_every_code() {
    let path = at("docs/diagnostics.md");
    let doc = fs::read_to_string(&path).unwrap();
    let (codes, mut prose) = (codes(), prose(&doc));
    prose.retain(|code, _| codes.contains(code));
    let undescribed: Vec<_> =
        codes.iter().filter(|code| !prose.contains_key(*code)).collect();
    assert!(undescribed.is_empty(), "write a `### ` section for {undescribed:?}");
    let silent: Vec<_> = prose.iter().filter(|(_, text)| text.is_empty()).collect();
    assert!(silent.is_empty(), "say what to do: {silent:?}");
    let front = doc.split("\n\n| code").next().unwrap();
    let new = written(front, &prose);
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(&path, new).unwrap();
    } else if let Some((old, new)) = doc.lines().zip(new.lines()).find(|(a, b)| a != b) {
        panic!(
            "docs/diagnostics.md has\n{old}\nwhere it should have\n{new}\n(UPDATE_DOCS=1 mends it)"
        );
    } else {
        assert_eq!(doc.lines().count(), new.lines().count(), "UPDATE_DOCS=1 mends it");
    }
}

#[test]
fn every_fixture_is_of_a_code_or_used_by_one_that_is() {
    let codes = codes();
    let fixtures = fixtures();
    let commands: String = fixtures
        .values()
        .filter(|path| path.ends_with(".cmd"))
        .map(|p| arguments(p))
        .collect();
    let idle = fixtures.iter().filter(|(code, path)| {
        !codes.contains(*code) && !commands.contains(path.as_str())
    });
    assert_eq!(idle.collect::<Vec<_>>(), Vec::new());
}
