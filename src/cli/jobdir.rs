//! Job directories: written whole or not at all, and nothing of the user's is lost.

use crate::export::File;
use crate::files::sha256;
use crate::job;
use miette::Diagnostic;
use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;
use thiserror::Error;

/// Why a job directory could not be written.
#[derive(Debug, Error, Diagnostic)]
#[allow(missing_docs, reason = "the messages say it")]
pub(super) enum JobDirError {
    #[error("{} is there already and was not written by finwright", dir.display())]
    #[diagnostic(
        code(job::foreign_directory),
        help("it was left as it is; choose another folder with `-o`")
    )]
    Foreign { dir: PathBuf },

    #[error("{} is the folder you are in; it cannot be replaced as a whole", dir.display())]
    #[diagnostic(code(job::current_directory), help("name a folder inside it: `-o job`"))]
    CurrentDirectory { dir: PathBuf },

    #[error("{} could not be written: {source}", path.display())]
    #[diagnostic(
        code(job::disk),
        help("nothing was changed there; choose another place with `-o`")
    )]
    Disk { path: PathBuf, source: io::Error },
}

/// List of what was written, as `sha256sum -c` reads it.
const SUMS: &str = "SHA256SUMS";

/// Files that were in a job's folder and are nobody's but the user's.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Kept {
    /// How many.
    count: usize,
    /// Where they are now.
    pub(super) dir: PathBuf,
}

impl fmt::Display for Kept {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (files, are) =
            if self.count == 1 { ("file", "is") } else { ("files", "are") };
        write!(
            f,
            "{} {files} that finwright did not write, or that changed since, {are} in {}",
            self.count,
            self.dir.display()
        )
    }
}

/// Where a job goes: one that was refused goes beside, so that a good one stays.
pub(super) fn place(dir: &Path, end: job::End) -> PathBuf {
    match end {
        job::End::Approved => dir.to_owned(),
        job::End::Refused => beside(dir, "", ".refused"),
    }
}

/// Writes a job beside its place and then puts it there, replacing an older job as a whole;
/// what the user changed or added there is kept beside.
///
/// # Errors
/// [`JobDirError`]; then the place is as it was.
pub(super) fn write(dir: &Path, files: &[File]) -> Result<Option<Kept>, JobDirError> {
    may_be_written(dir)?;
    sweep(dir);
    let new = beside(dir, ".", &format!("{NEW}{}", std::process::id()));
    let written = write_files(&new, files).and_then(|()| put(&new, dir));
    written.map_err(|source| {
        // Best effort: the error that counts is the first one.
        let _ = fs::remove_dir_all(&new);
        // Where the user meant it to be, not where it was on the way there.
        JobDirError::Disk { path: dir.to_owned(), source }
    })
}

/// How the folder of a job that is being written ends, before the number of its process.
const NEW: &str = ".new-";

/// A neighbour of a folder.
fn beside(dir: &Path, before: &str, after: &str) -> PathBuf {
    let name = dir.file_name().unwrap_or_default().to_string_lossy();
    dir.with_file_name(format!("{before}{name}{after}"))
}

/// Takes away what runs that were killed left half-written here, an hour ago or earlier.
fn sweep(dir: &Path) {
    let stem = beside(dir, ".", NEW);
    let stem = stem.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let parent = dir.parent().filter(|parent| !parent.as_os_str().is_empty());
    let Ok(entries) = fs::read_dir(parent.unwrap_or(Path::new("."))) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        let process = name.strip_prefix(&stem).unwrap_or_default();
        let is_left = !process.is_empty() && process.bytes().all(|b| b.is_ascii_digit());
        let written = entry.metadata().and_then(|found| found.modified());
        let age = written.ok().and_then(|written| written.elapsed().ok());
        if is_left && age.is_some_and(|age| age > Duration::from_secs(3600)) {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

/// Whether a job may be put there.
///
/// # Errors
/// [`JobDirError::Foreign`] if something else is there, [`JobDirError::CurrentDirectory`]
/// if one stands in it.
pub(super) fn may_be_written(dir: &Path) -> Result<(), JobDirError> {
    let here = std::env::current_dir().and_then(fs::canonicalize).ok();
    if here.is_some() && fs::canonicalize(dir).ok() == here {
        return Err(JobDirError::CurrentDirectory { dir: dir.to_owned() });
    }
    let foreign = || JobDirError::Foreign { dir: dir.to_owned() };
    may_be_replaced(dir).then_some(()).ok_or_else(foreign)
}

/// Whether nothing is there, or an empty folder, or a job of ours.
fn may_be_replaced(dir: &Path) -> bool {
    if !dir.exists() && !dir.is_symlink() {
        return true;
    }
    if dir.is_symlink() || !dir.is_dir() {
        return false;
    }
    let ours = fs::read_to_string(dir.join("job.json"))
        .ok()
        .and_then(|text| serde_json::from_str::<serde_json::Value>(&text).ok())
        .is_some_and(|job| job["format"] == "finwright-job");
    let ours = ours || is_layout(dir);
    ours || fs::read_dir(dir).is_ok_and(|mut entries| entries.next().is_none())
}

/// Whether `finwright nest` wrote it.
fn is_layout(dir: &Path) -> bool {
    let text = fs::read_to_string(dir.join("layout.json")).unwrap_or_default();
    serde_json::from_str::<serde_json::Value>(&text)
        .is_ok_and(|layout| layout["format"] == "finwright-layout")
}

fn write_files(new: &Path, files: &[File]) -> io::Result<()> {
    let mut sums = String::new();
    for (path, bytes) in files {
        sums += &format!("{}  {path}\n", sha256(bytes));
        let path = new.join(path);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        fs::write(&path, bytes)?;
    }
    fs::create_dir_all(new)?;
    fs::write(new.join(SUMS), sums)
}

/// Puts `new` at `dir`. What the user has there is never in one place only: if this is
/// interrupted, it is in `dir` or in the folder that is named after it.
fn put(new: &Path, dir: &Path) -> io::Result<Option<Kept>> {
    if !dir.exists() {
        return fs::rename(new, dir).map(|()| None);
    }
    let sums = fs::read_to_string(dir.join(SUMS)).unwrap_or_default();
    let mut count = 0;
    walk(dir, dir, &mut |path, name| count += usize::from(!is_ours(path, name, &sums)))?;
    if count == 0 {
        exchange(new, dir)?;
        // The job stands; an old one that cannot be removed does no harm.
        let _ = fs::remove_dir_all(new);
        return Ok(None);
    }
    let mut names = (1..).map(|n| beside(dir, "", &format!(".before-{n}")));
    let kept = names.find(|kept| !kept.exists() && !kept.is_symlink());
    let kept = kept.unwrap_or_default();
    fs::rename(new, &kept)?;
    if let Err(source) = exchange(&kept, dir) {
        let _ = fs::rename(&kept, new);
        return Err(source);
    }
    walk(&kept, &kept, &mut |path, name| {
        if is_ours(path, name, &sums) {
            let _ = fs::remove_file(path);
        }
    })?;
    remove_empty(&kept);
    Ok(Some(Kept { count, dir: kept }))
}

/// Shows each file below a folder with its name from the root, as the list has it. Links are
/// not followed.
fn walk(root: &Path, dir: &Path, see: &mut dyn FnMut(&Path, &str)) -> io::Result<()> {
    for entry in fs::read_dir(dir)? {
        let entry = entry?;
        let path = entry.path();
        if entry.file_type()?.is_dir() {
            walk(root, &path, see)?;
        } else {
            let name = path.strip_prefix(root).unwrap_or(&path).to_string_lossy();
            see(&path, &name.replace('\\', "/"));
        }
    }
    Ok(())
}

/// Whether a file is as it was written; no other is ever removed.
fn is_ours(path: &Path, name: &str, sums: &str) -> bool {
    let is_file = fs::symlink_metadata(path).is_ok_and(|found| found.is_file());
    let written =
        || sums.lines().find(|line| line.split_once("  ").is_some_and(|l| l.1 == name));
    let as_written =
        |line: &str| fs::read(path).is_ok_and(|bytes| line.starts_with(&sha256(&bytes)));
    is_file && (name == SUMS || written().is_some_and(as_written))
}

/// Removes the folders below that hold nothing.
fn remove_empty(dir: &Path) {
    for entry in fs::read_dir(dir).into_iter().flatten().flatten() {
        if entry.file_type().is_ok_and(|found| found.is_dir()) {
            remove_empty(&entry.path());
            let _ = fs::remove_dir(entry.path());
        }
    }
}

/// Each of two folders takes the other's place: at once where the system knows how, else by
/// way of a third name.
fn exchange(new: &Path, dir: &Path) -> io::Result<()> {
    if at_once(new, dir) {
        return Ok(());
    }
    let aside = beside(dir, ".", &format!(".old-{}", std::process::id()));
    fs::rename(dir, &aside)?;
    if let Err(source) = fs::rename(new, dir) {
        // Back to where it was.
        let _ = fs::rename(&aside, dir);
        return Err(source);
    }
    fs::rename(&aside, new)
}

#[cfg(any(target_os = "linux", target_vendor = "apple"))]
fn at_once(new: &Path, dir: &Path) -> bool {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    renameat_with(CWD, new, CWD, dir, RenameFlags::EXCHANGE).is_ok()
}

#[cfg(not(any(target_os = "linux", target_vendor = "apple")))]
const fn at_once(_: &Path, _: &Path) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(text: &str) -> [File; 2] {
        let manifest = br#"{"format":"finwright-job"}"#.to_vec();
        [("job.json".into(), manifest), ("sheets/a.svg".into(), text.into())]
    }

    fn names(dir: &Path) -> Vec<String> {
        let mut names = Vec::new();
        walk(dir, dir, &mut |_, name| names.push(name.to_owned())).unwrap();
        names.sort();
        names
    }

    #[test]
    fn a_job_replaces_a_job_as_a_whole() {
        let place = tempfile::tempdir().unwrap();
        let dir = place.path().join("vault");
        assert_eq!(write(&dir, &job("one")).unwrap(), None);
        assert_eq!(write(&dir, &job("two")).unwrap(), None);
        assert_eq!(fs::read_to_string(dir.join("sheets/a.svg")).unwrap(), "two");
        assert_eq!(names(&dir), [SUMS, "job.json", "sheets/a.svg"]);
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    }

    #[test]
    fn what_was_added_or_changed_is_kept_beside() {
        let place = tempfile::tempdir().unwrap();
        let dir = place.path().join("vault");
        for (text, n) in [("one", 1), ("two", 2)] {
            write(&dir, &job(text)).unwrap();
            fs::write(dir.join("sheets/a.svg"), "with my logo").unwrap();
            fs::create_dir(dir.join("notes")).unwrap();
            fs::write(dir.join("notes/b.txt"), "glue first").unwrap();
            let kept = write(&dir, &job("three")).unwrap().unwrap();
            let before = place.path().join(format!("vault.before-{n}"));
            assert_eq!(kept, Kept { count: 2, dir: before.clone() });
            assert_eq!(names(&before), ["notes/b.txt", "sheets/a.svg"]);
            assert_eq!(
                fs::read_to_string(before.join("sheets/a.svg")).unwrap(),
                "with my logo"
            );
            assert_eq!(fs::read_to_string(dir.join("sheets/a.svg")).unwrap(), "three");
        }
    }

    #[test]
    fn a_job_without_its_list_is_kept_whole() {
        let place = tempfile::tempdir().unwrap();
        let dir = place.path().join("vault");
        write(&dir, &job("one")).unwrap();
        fs::remove_file(dir.join(SUMS)).unwrap();
        let kept = write(&dir, &job("two")).unwrap().unwrap();
        assert_eq!(names(&kept.dir), ["job.json", "sheets/a.svg"]);
    }

    /// A run that was killed leaves its half beside, and the old job where it is.
    #[test]
    fn an_interrupted_job_leaves_the_good_one_and_the_next_goes_on() {
        let place = tempfile::tempdir().unwrap();
        let dir = place.path().join("vault");
        write(&dir, &job("one")).unwrap();
        let half = place.path().join(".vault.new-1");
        write_files(&half, &job("half")[..1]).unwrap();
        assert_eq!(fs::read_to_string(dir.join("sheets/a.svg")).unwrap(), "one");
        write(&dir, &job("two")).unwrap();
        assert_eq!(fs::read_to_string(dir.join("sheets/a.svg")).unwrap(), "two");
        // Another run may be at work on it: only what is old is taken away.
        assert!(half.exists());
        let long_ago = std::time::SystemTime::now() - Duration::from_secs(7200);
        fs::File::open(&half).unwrap().set_modified(long_ago).unwrap();
        write(&dir, &job("three")).unwrap();
        assert!(!half.exists());
    }

    #[test]
    fn a_place_that_cannot_be_written_stays_as_it_was() {
        let place = tempfile::tempdir().unwrap();
        let dir = place.path().join("vault");
        write(&dir, &job("one")).unwrap();
        // A file cannot be a folder.
        let files = [("a".into(), Vec::new()), ("a/b".into(), Vec::new())];
        assert!(matches!(write(&dir, &files), Err(JobDirError::Disk { .. })));
        assert_eq!(fs::read_to_string(dir.join("sheets/a.svg")).unwrap(), "one");
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    }

    #[test]
    fn folders_change_places_where_the_system_does_not_help() {
        let place = tempfile::tempdir().unwrap();
        let [a, b] = ["a", "b"].map(|name| place.path().join(name));
        for dir in [&a, &b] {
            fs::create_dir(dir).unwrap();
            fs::write(dir.join("name"), dir.to_string_lossy().as_bytes()).unwrap();
        }
        exchange(&a, &b).unwrap();
        assert_eq!(fs::read(a.join("name")).unwrap(), b.to_string_lossy().as_bytes());
        assert_eq!(fs::read(b.join("name")).unwrap(), a.to_string_lossy().as_bytes());
    }

    #[test]
    fn a_folder_of_somebody_else_is_left_alone() {
        let place = tempfile::tempdir().unwrap();
        fs::write(place.path().join("thesis.txt"), "years of work").unwrap();
        let error = write(place.path(), &job("one")).unwrap_err();
        assert!(matches!(error, JobDirError::Foreign { .. }));
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    }
}
