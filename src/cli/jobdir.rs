//! Job directories: written whole or not at all.

use crate::export::File;
use miette::Diagnostic;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
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

/// Writes a job beside its place and then puts it there, replacing an older job.
///
/// # Errors
/// [`JobDirError`]; then the place is as it was.
pub(super) fn write(dir: &Path, files: &[File]) -> Result<(), JobDirError> {
    may_be_written(dir)?;
    let name = dir.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let beside = |suffix: &str| dir.with_file_name(format!(".{name}.{suffix}"));
    let process = std::process::id();
    let new = beside(&format!("new-{process}"));
    let old = beside(&format!("old-{process}"));
    let written = write_files(&new, files).and_then(|()| swap(dir, &new, &old));
    written.map_err(|source| {
        // Best effort: the error that counts is the first one.
        let _ = fs::remove_dir_all(&new);
        // Where the user meant it to be, not where it was on the way there.
        JobDirError::Disk { path: dir.to_owned(), source }
    })
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
    for (path, bytes) in files {
        let path = new.join(path);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        fs::write(&path, bytes)?;
    }
    Ok(())
}

/// Puts `new` at `dir`; what was there goes by way of `old`.
fn swap(dir: &Path, new: &Path, old: &Path) -> io::Result<()> {
    let replaces = dir.exists();
    if replaces {
        fs::rename(dir, old)?;
    }
    if let Err(source) = fs::rename(new, dir) {
        if replaces {
            // Back to where it was.
            let _ = fs::rename(old, dir);
        }
        return Err(source);
    }
    if replaces {
        // The job stands; an old one that cannot be removed does no harm.
        let _ = fs::remove_dir_all(old);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(text: &str) -> [File; 2] {
        let manifest = br#"{"format":"finwright-job"}"#.to_vec();
        [("job.json".into(), manifest), ("sheets/a.svg".into(), text.into())]
    }

    #[test]
    fn a_job_replaces_a_job_as_a_whole() {
        let place = tempfile::tempdir().unwrap();
        let dir = place.path().join("vault");
        write(&dir, &job("one")).unwrap();
        fs::write(dir.join("sheets/b.svg"), "left over").unwrap();
        write(&dir, &job("two")).unwrap();
        assert_eq!(fs::read_to_string(dir.join("sheets/a.svg")).unwrap(), "two");
        assert!(!dir.join("sheets/b.svg").exists());
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
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
