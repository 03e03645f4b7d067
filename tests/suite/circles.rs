//! Which file uses which, read from the source itself: no circle larger than two files, and
//! no public type name that stands for two types.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// A source file without its tests.
struct File {
    /// Its module, such as `["parts", "outline"]`; a folder's `mod.rs` is the folder.
    module: Vec<String>,
    text: String,
}

fn files() -> Vec<File> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    let mut open = vec![root.clone()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).expect("folders can be read") {
            let path = entry.expect("entries can be read").path();
            if path.is_dir() && path.file_name().is_some_and(|name| name != "tests") {
                open.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                let inside = path.strip_prefix(&root).expect("it is below");
                let inside = inside.with_extension("");
                let words = inside.iter().map(|word| word.to_string_lossy().into_owned());
                let module = words.filter(|word| word != "mod").collect();
                let text = fs::read_to_string(&path).expect("sources can be read");
                found.push(File { module, text: code(&text) });
            }
        }
    }
    found.sort_by(|a, b| a.module.cmp(&b.module));
    found
}

/// The text up to the tests, comments left out.
fn code(text: &str) -> String {
    let end = text.find("#[cfg(test)]\nmod tests").unwrap_or(text.len());
    let lines = text[..end].lines();
    lines
        .map(|line| line.split("//").next().unwrap_or_default().to_owned() + "\n")
        .collect()
}

/// `a::{b, c::{d, e}}` as the paths it stands for.
fn spread(text: &str) -> Vec<Vec<String>> {
    let text = text.trim();
    let Some(brace) = text.find('{') else {
        let path = text.split(" as ").next().unwrap_or_default();
        return vec![path.split("::").map(|word| word.trim().to_owned()).collect()];
    };
    let before = &text[..brace];
    let before: Vec<String> = before
        .split("::")
        .map(|w| w.trim().to_owned())
        .filter(|w| !w.is_empty())
        .collect();
    let inside = &text[brace + 1..text.rfind('}').unwrap_or(text.len())];
    let mut depth = 0;
    let items = inside.split(|c: char| {
        depth += i32::from(c == '{') - i32::from(c == '}');
        c == ',' && depth == 0
    });
    let items = items.filter(|item| !item.trim().is_empty()).flat_map(spread);
    items.map(|item| [before.clone(), item].concat()).collect()
}

/// Statements `use ...;` of a file: whether it hands on, and the paths.
fn uses(text: &str) -> Vec<(bool, Vec<String>)> {
    let mut found = Vec::new();
    for statement in text.split(';') {
        let start = statement.rfind("\nuse ").map(|at| (at + 5, false));
        let public = statement.rfind("\npub use ").map(|at| (at + 9, true));
        let inner = statement.rfind("\npub(crate) use ").map(|at| (at + 16, true));
        if let Some((at, handed)) = start.or(public).or(inner) {
            found.extend(spread(&statement[at..]).into_iter().map(|path| (handed, path)));
        }
    }
    found
}

/// Paths that stand in the code itself, such as `crate::nest::fits(`.
fn spoken(text: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    for word in ["crate::", "super::"] {
        for (at, _) in text.match_indices(word) {
            let path =
                text[at..].split(|c: char| !c.is_alphanumeric() && c != '_' && c != ':');
            let path = path.clone().next().unwrap_or_default().split("::");
            found.push(path.map(str::to_owned).filter(|w| !w.is_empty()).collect());
        }
    }
    found
}

/// Files by their module, and what each `mod.rs` hands on from below.
struct Modules<'a> {
    files: BTreeMap<&'a [String], usize>,
    handed: BTreeMap<(usize, String), Vec<String>>,
}

impl Modules<'_> {
    /// The words from the crate's root, if the path stays in the crate.
    fn absolute(&self, from: &[String], path: &[String]) -> Option<Vec<String>> {
        match path.first()?.as_str() {
            "crate" => Some(path[1..].to_vec()),
            "self" => Some([from, &path[1..]].concat()),
            "super" => {
                let above = &from[..from.len().checked_sub(1)?];
                match path.get(1).map(String::as_str) {
                    Some("super") => self.absolute(above, &path[1..]),
                    _ => Some([above, &path[1..]].concat()),
                }
            }
            child => {
                let below = [from, &[child.to_owned()]].concat();
                let known = self.files.contains_key(below.as_slice());
                known.then(|| [from, path].concat())
            }
        }
    }

    /// The file that defines what a path names.
    fn file(&self, path: &[String], depth: usize) -> Option<usize> {
        let longest =
            (1..=path.len()).rev().find(|&k| self.files.contains_key(&path[..k]))?;
        let file = self.files[&path[..longest]];
        let name = path.get(longest)?;
        match self.handed.get(&(file, name.clone())) {
            Some(source) if depth < 5 => self.file(source, depth + 1),
            _ => Some(file),
        }
    }
}

fn modules(files: &[File]) -> Modules<'_> {
    let places = files.iter().enumerate();
    let places = places.map(|(k, file)| (file.module.as_slice(), k)).collect();
    let mut modules = Modules { files: places, handed: BTreeMap::new() };
    for (k, file) in files.iter().enumerate() {
        for (_, path) in uses(&file.text).into_iter().filter(|(handed, _)| *handed) {
            if let Some(path) = modules.absolute(&file.module, &path) {
                let name = path.last().expect("a path has words").clone();
                modules.handed.insert((k, name), path);
            }
        }
    }
    modules
}

/// For each file those that it uses. A folder's front (`mod.rs`) shows the types of a stage and
/// calls its files one after another; that is no arrow, the files' use of the front is one.
fn arrows(files: &[File]) -> Vec<BTreeSet<usize>> {
    let modules = modules(files);
    let of = |(k, file): (usize, &File)| {
        let used = uses(&file.text).into_iter().filter(|(handed, _)| !handed);
        let paths = used.map(|(_, path)| path).chain(spoken(&file.text));
        let absolute = paths.filter_map(|path| modules.absolute(&file.module, &path));
        absolute
            .filter_map(|path| modules.file(&path, 0))
            .filter(|&other| other != k && !files[other].module.starts_with(&file.module))
            .collect()
    };
    files.iter().enumerate().map(of).collect()
}

/// All files that can be reached.
fn reached(arrows: &[BTreeSet<usize>], from: usize) -> BTreeSet<usize> {
    let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(file) = open.pop() {
        open.extend(arrows[file].iter().copied().filter(|&next| seen.insert(next)));
    }
    seen
}

#[test]
fn no_circle_of_imports_is_larger_than_two_files() {
    let files = files();
    let arrows = arrows(&files);
    let reach: Vec<BTreeSet<usize>> =
        (0..files.len()).map(|k| reached(&arrows, k)).collect();
    let mut told = BTreeSet::new();
    let mut circles = Vec::new();
    for k in 0..files.len() {
        let circle: Vec<usize> =
            reach[k].iter().copied().filter(|&other| reach[other].contains(&k)).collect();
        if circle.len() > 2 && told.insert(circle.clone()) {
            let inside = |&from: &usize| {
                let to = arrows[from].iter().filter(|to| circle.contains(to));
                let to: Vec<String> = to.map(|&to| files[to].module.join("::")).collect();
                format!("  {} uses {}", files[from].module.join("::"), to.join(", "))
            };
            let lines: Vec<String> = circle.iter().map(inside).collect();
            circles.push(format!("a circle of {}:\n{}", circle.len(), lines.join("\n")));
        }
    }
    assert!(circles.is_empty(), "{}", circles.join("\n"));
}

#[test]
fn a_public_type_name_stands_for_one_type() {
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for file in files() {
        for line in file.text.lines() {
            let rest = ["pub struct ", "pub enum ", "pub trait ", "pub type "];
            let rest = rest.iter().find_map(|word| line.strip_prefix(word));
            let end = |c: char| !c.is_alphanumeric() && c != '_';
            if let Some(name) = rest.and_then(|rest| rest.split(end).next()) {
                places.entry(name.to_owned()).or_default().push(file.module.join("::"));
            }
        }
    }
    let twice = places.into_iter().filter(|(_, places)| places.len() > 1);
    let twice: Vec<String> =
        twice.map(|(name, places)| format!("{name}: {}", places.join(", "))).collect();
    assert!(twice.is_empty(), "{}", twice.join("\n"));
}
