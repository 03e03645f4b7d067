//! The command as a user meets it: the built binary, its exit codes, its streams, its
//! folders (docs/job.md).

use finwright::structure::{AxisRule, Structure, read_json};
use finwright::tolerance::Tolerance;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn command(place: &Path, words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_finwright"));
    command.args(words).current_dir(place);
    command
}

fn run(place: &Path, words: &[&str]) -> Output {
    command(place, words).output().expect("the binary was built")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("it ended by itself")
}

fn said(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("terminal output is text")
}

/// All files below a folder with their bytes.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(&next).expect("it can be read") {
            let path = entry.expect("it can be read").path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).expect("it is below");
                let bytes = fs::read(&path).expect("it can be read");
                all.insert(name.to_string_lossy().into_owned(), bytes);
            }
        }
    }
    all
}

/// What stands in a folder, hidden files too.
fn entries(folder: &Path) -> Vec<String> {
    let list = fs::read_dir(folder).expect("it can be read");
    let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
    let mut names: Vec<String> = list.map(|e| name(e.expect("it can be read"))).collect();
    names.sort();
    names
}

/// A zigzag whose strips fold too sharply for acrylic.
const ZIGZAG: &str = "v 0 0 0\nv 30 7.5 0\nv 60 0 0\nv 0 60 0\nv 30 67.5 0\nv 60 60 0\n\
                      f 1 2 5 4\nf 2 3 6 5\n";

#[test]
fn the_readme_commands_do_what_it_says() {
    let readme = include_str!("../../README.md");
    let place = tempfile::tempdir().expect("there is room");
    // In metres, 1:50: a patch of 2 m x 1.5 m cells.
    let grid =
        (0..12).map(|k| format!("v {} {} {}\n", k % 4 * 2, 1.5 * f64::from(k / 4), 3));
    let cells = (0..6).map(|k| {
        let first = k / 3 * 4 + k % 3 + 1;
        format!("f {} {} {} {}\n", first, first + 1, first + 5, first + 4)
    });
    let mesh: String = grid.chain(cells).collect();
    fs::write(place.path().join("my_mesh.obj"), mesh).expect("it can be written");
    let lines = readme
        .lines()
        .filter_map(|line| line.strip_prefix("    cargo run --release -- "));
    let mut count = 0;
    for line in lines {
        let (words, redirected) = match line.split_once(" > ") {
            Some((words, file)) => (words, Some(file)),
            None => (line, None),
        };
        let words: Vec<&str> = words.split_whitespace().collect();
        let output = run(place.path(), &words);
        assert_eq!(code(&output), 0, "{line}: {}", said(&output.stderr));
        if let Some(file) = redirected {
            fs::write(place.path().join(file), &output.stdout)
                .expect("it can be written");
        }
        count += 1;
    }
    assert!(count >= 4, "only {count} commands were found in README.md");
    assert!(readme.contains("cargo test"));
    let vault = files(&place.path().join("out/vault"));
    for name in ["job.json", "structure.json", "parts.csv", "sheets/sheets.pdf"] {
        assert!(vault.contains_key(name), "{name} of {:?}", vault.keys());
    }
    for ending in ["dxf", "svg", "png"] {
        assert!(vault.contains_key(&format!("sheets/sheet-01.{ending}")));
    }
    assert!(place.path().join("out/my_mesh/sheets/sheet-01.dxf").exists());
}

#[test]
fn the_fixtures_are_made_by_their_commands() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = include_str!("../../fixtures/README.md");
    let place = tempfile::tempdir().expect("there is room");
    let job = place.path().join("job").to_string_lossy().into_owned();
    let lines = readme.lines().filter_map(|line| line.strip_prefix("    finwright "));
    let mut parts = BTreeMap::new();
    for line in lines {
        let words =
            line.split_whitespace().chain(["-q", "-o", &job, "--effort", "quick"]);
        let output = run(root, &words.collect::<Vec<_>>());
        assert_eq!(code(&output), 0, "{line}: {}", said(&output.stderr));
        let text =
            fs::read_to_string(place.path().join("job/job.json")).expect("written");
        let value: serde_json::Value = serde_json::from_str(&text).expect("it is JSON");
        let list = value["parts"].as_array().expect("parts are a list").clone();
        parts
            .insert(value["input"]["name"].as_str().unwrap_or_default().to_owned(), list);
    }
    let some = |file: &str, claim: &dyn Fn(&serde_json::Value) -> bool| {
        assert!(parts[file].iter().any(|part| claim(&part["strip"])), "{file}");
    };
    some("ring.json", &|strip| strip["closed"] == true);
    some("long.json", &|strip| {
        strip["splices"].as_array().is_some_and(|s| !s.is_empty())
    });
    some("bricks.obj", &|strip| strip["nodes"].as_array().is_some_and(|n| n.len() == 2));
    assert!(parts["mixed.obj"].len() > 10);
}

#[test]
fn every_command_explains_itself_with_an_example() {
    let place = tempfile::tempdir().expect("there is room");
    let top = said(&run(place.path(), &["--help"]).stdout);
    for name in ["make", "check", "template", "example", "completions"] {
        assert!(top.contains(&format!("  {name} ")), "{name} in {top}");
        let output = run(place.path(), &[name, "--help"]);
        assert_eq!(code(&output), 0);
        let help = said(&output.stdout);
        assert!(help.contains("Usage: finwright"), "{help}");
        assert!(help.contains("Example"), "{help}");
        assert!(help.contains(&format!("  finwright {name}")), "{help}");
    }
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(
            said(&run(place.path(), &["completions", shell]).stdout)
                .contains("finwright")
        );
    }
}

#[test]
fn exit_codes_tell_how_it_ended() {
    let place = tempfile::tempdir().expect("there is room");
    fs::write(place.path().join("zigzag.obj"), ZIGZAG).expect("it can be written");
    fs::write(place.path().join("broken.json"), "{").expect("it can be written");
    let ends = |words: &[&str]| code(&run(place.path(), words));
    assert_eq!(ends(&["check", "three", "-q"]), 0);
    assert_eq!(ends(&["make", "missing.obj"]), 1);
    assert_eq!(ends(&["make", "broken.json"]), 1);
    assert_eq!(ends(&["make", "three", "-t", "granite"]), 1);
    assert_eq!(ends(&["make", "--no-such-option"]), 2);
    assert_eq!(ends(&["make", "three", "--joint", "hinge", "--scale", "0:0"]), 2);
    assert_eq!(ends(&["no-such-command"]), 2);
    let sharp = ["zigzag.obj", "--axes", "0,0,1"];
    assert_eq!(ends(&[&["check"], &sharp[..]].concat()), 3);
    assert_eq!(ends(&[&["make"], &sharp[..]].concat()), 3);
    // Refused: the report and stamped pictures, and nothing a laser could cut.
    let written = files(&place.path().join("out/zigzag.refused"));
    assert!(
        written.contains_key("job.json") && written.contains_key("preview/sheet-01.png")
    );
    let cut =
        |name: &String| [".dxf", ".svg", ".pdf"].iter().any(|end| name.ends_with(end));
    assert!(!written.keys().any(cut), "{:?}", written.keys());
}

#[test]
fn a_folder_of_somebody_else_is_never_touched_and_a_job_is_replaced_whole() {
    let place = tempfile::tempdir().expect("there is room");
    let dir = place.path().join("work");
    fs::create_dir(&dir).expect("it can be made");
    fs::write(dir.join("thesis.txt"), "years").expect("it can be written");
    let output = run(place.path(), &["make", "three", "-o", "work"]);
    assert_eq!(code(&output), 1);
    assert!(said(&output.stderr).contains("job::foreign_directory"));
    assert_eq!(entries(&dir), ["thesis.txt"]);
    assert_eq!(entries(place.path()), ["work"]);

    assert_eq!(code(&run(place.path(), &["make", "three", "-o", "job", "-q"])), 0);
    fs::write(place.path().join("job/sheets/sheet-99.dxf"), "stale")
        .expect("it can be written");
    assert_eq!(code(&run(place.path(), &["make", "five", "-o", "job", "-q"])), 0);
    let job = files(&place.path().join("job"));
    assert!(!job.contains_key("sheets/sheet-99.dxf"));
    assert!(said(&job["job.json"]).contains("\"name\": \"five\""));
    let kept = files(&place.path().join("job.before-1"));
    assert_eq!(kept.keys().collect::<Vec<_>>(), ["sheets/sheet-99.dxf"]);
    assert_eq!(entries(place.path()), ["job", "job.before-1", "work"]);
}

#[test]
fn json_is_alone_on_standard_output_and_quiet_is_quiet() {
    let place = tempfile::tempdir().expect("there is room");
    for words in [["make", "three", "--json"], ["check", "five", "--json"]] {
        let output = run(place.path(), &words);
        let value: serde_json::Value =
            serde_json::from_slice(&output.stdout).expect("one JSON object");
        assert!(value.is_object());
    }
    let made = run(place.path(), &["make", "three", "--json", "-q", "-o", "j"]);
    let written = fs::read(place.path().join("j/job.json")).expect("it was written");
    let printed: serde_json::Value = serde_json::from_slice(&made.stdout).expect("JSON");
    assert_eq!(
        printed,
        serde_json::from_slice::<serde_json::Value>(&written).expect("JSON")
    );
    assert!(made.stderr.is_empty(), "{}", said(&made.stderr));
    let spoken = run(place.path(), &["make", "three", "-o", "j"]);
    assert!(spoken.stdout.is_empty());
    assert!(said(&spoken.stderr).contains("in j"), "{}", said(&spoken.stderr));
    let listed = run(place.path(), &["make", "three", "-v", "-o", "d"]);
    let short = run(place.path(), &["make", "three", "-o", "d"]);
    assert!(listed.stderr.len() > short.stderr.len(), "-v says more");
}

#[test]
fn two_runs_write_the_same_bytes_and_no_colours_into_pipes() {
    let place = tempfile::tempdir().expect("there is room");
    for name in ["one", "two"] {
        let mut command =
            command(place.path(), &["make", "three", "--seed", "7", "-o", name]);
        let output = command.env("NO_COLOR", "1").output().expect("it was built");
        assert_eq!(code(&output), 0);
        assert!(!output.stderr.contains(&0x1b));
    }
    let (one, two) = (files(&place.path().join("one")), files(&place.path().join("two")));
    assert!(one.keys().eq(two.keys()));
    for (name, bytes) in &one {
        assert_eq!(bytes.len(), two[name].len(), "{name}");
        assert!(*bytes == two[name], "{name} differs");
    }
}

#[test]
fn examples_are_structures_and_templates_pass_their_own_check() {
    let place = tempfile::tempdir().expect("there is room");
    let examples = said(&run(place.path(), &["example", "list"]).stdout);
    let names = |list: &str| -> Vec<String> {
        list.lines()
            .filter_map(|l| l.split_whitespace().next())
            .map(str::to_owned)
            .collect()
    };
    // Surfaces are for `design` and written as OBJ.
    let (surfaces, structures): (Vec<&str>, Vec<&str>) =
        examples.lines().partition(|line| line.contains(" surface: "));
    assert_eq!(surfaces.len(), 3);
    for name in names(&structures.join("\n")) {
        let text = said(&run(place.path(), &["example", "write", &name]).stdout);
        let draft = read_json(&text, AxisRule::File).expect("we wrote it");
        assert!(Structure::new(draft.0, &Tolerance::default()).is_ok(), "{name}");
    }
    for name in names(&said(&run(place.path(), &["template", "list"]).stdout)) {
        let source = run(place.path(), &["template", "show", &name]).stdout;
        fs::write(place.path().join("own.toml"), source).expect("it can be written");
        assert_eq!(
            code(&run(place.path(), &["template", "check", "own.toml"])),
            0,
            "{name}"
        );
    }
}

/// Ctrl-C while the nester searches: exit code 4, and nothing is left behind.
#[cfg(unix)]
#[test]
fn an_interrupted_job_leaves_nothing() {
    let place = tempfile::tempdir().expect("there is room");
    let words = ["make", "vault", "--time-limit", "100", "-o", "job"];
    let mut command = command(place.path(), &words);
    let child =
        command.stderr(std::process::Stdio::piped()).spawn().expect("it was built");
    std::thread::sleep(std::time::Duration::from_millis(1500));
    let id = child.id().to_string();
    let killed =
        Command::new("kill").args(["-INT", &id]).status().expect("kill is there");
    assert!(killed.success());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(4), "{}", said(&output.stderr));
    assert!(said(&output.stderr).contains("nothing was written"));
    assert!(entries(place.path()).is_empty(), "{:?}", entries(place.path()));
}
