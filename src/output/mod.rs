//! Results written by the program: tables, ParaView files, figures, the report and `--json`.
//!
//! All outputs are written from plain numbers: a [`record::Record`] of a run, a [`json::Statics`] of an equilibrium. Nothing here prints. Tables and
//! shapes of a run are written during the run ([`files`]); every other file receives its name only when it is complete ([`write_file`]).

mod arrow_schema;
pub mod binaries;
pub mod channels;
pub mod collect;
pub mod csv;
pub mod description;
pub mod figures;
pub mod files;
pub mod fmi;
pub mod folder;
mod growing;
pub mod json;
pub mod modes;
pub mod package;
mod parquet;
pub mod record;
pub mod recorder;
pub mod report;
pub mod sealed;
pub mod state;
pub mod table;
pub mod times;
pub mod trace;
pub mod vtk;
mod xml;

#[cfg(test)]
mod sample;

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::scene::Scene;

/// Reason why an output could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// A folder could not be made.
    #[error("cannot make the folder {}: {source}", .path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A path that is not a folder has the folder's name.
    #[error("{} is no folder: give the name of one", .path.display())]
    NotAFolder {
        /// The path with this name.
        path: PathBuf,
    },
    /// No file can be written into a folder.
    #[error("cannot write into the folder {}: {source}", .path.display())]
    Closed {
        /// The folder.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// Another process writes into a folder.
    #[error("another process of moorline writes into the folder {}: wait for its end, or give another folder", .path.display())]
    InUse {
        /// The folder.
        path: PathBuf,
    },
    /// A file could not be written.
    #[error("cannot write {}: {source}", .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The state of an interrupted run cannot be used.
    #[error("cannot continue from {}: {problem}", .path.display())]
    State {
        /// File of the state.
        path: PathBuf,
        /// Reason.
        problem: String,
    },
}

impl OutputError {
    fn of_file(path: &Path, source: io::Error) -> OutputError {
        let path = path.to_path_buf();
        OutputError::File { path, source }
    }
}

/// Removes incomplete files of this process from the folder of a run, and next to the targets of links in it.
pub fn remove_partial(folder: &Path) {
    let ending = partial_ending();
    for folder in [folder.to_path_buf(), folder.join(vtk::FRAME_FOLDER)] {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            // An incomplete file that cannot be removed is recognisable by its name.
            let _ = if path.is_symlink() {
                target_of(&path).and_then(|target| fs::remove_file(partial_name(&target)))
            } else if entry.file_name().to_string_lossy().ends_with(&ending) {
                fs::remove_file(path)
            } else {
                Ok(())
            };
        }
    }
}

/// Writes a file under a temporary name in the same folder and renames it when it is complete: an interrupted run leaves the old file or none, but no
/// incomplete one. A link is kept and its target is written; only regular files are replaced.
///
/// # Errors
/// The name belongs to something other than a regular file, or the operating system refuses; the temporary file is
/// then removed.
pub fn write_file(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), OutputError> {
    let made = replace_file(path, |partial| {
        let mut file = BufWriter::new(create(partial)?);
        write(&mut file)?;
        file.flush()
    });
    made.map_err(|source| OutputError::of_file(path, source))
}

/// Checks that a file could be written under a name: the name belongs to a regular file, a link to one, or nothing, and the folder exists.
///
/// # Errors
/// States why no file can be written.
pub fn check_file(path: &Path) -> Result<(), OutputError> {
    let target = target_of(path).and_then(|target| {
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty());
        match folder {
            Some(folder) if !folder.is_dir() => Err(io::Error::new(
                io::ErrorKind::NotFound,
                format!("there is no folder {}", folder.display()),
            )),
            _ => Ok(()),
        }
    });
    target.map_err(|source| OutputError::of_file(path, source))
}

/// Returns the regular file or the unused name to which a path leads; links are followed.
fn target_of(path: &Path) -> io::Result<PathBuf> {
    let refuse = |problem: String| Err(io::Error::new(io::ErrorKind::InvalidInput, problem));
    // /dev/stdout is a link that leads to no name if standard output is a pipe
    if let Ok(found) = fs::metadata(path) {
        let what = match (found.is_file(), found.is_dir()) {
            (true, _) => return fs::canonicalize(path),
            (_, true) => "a folder",
            _ => "a device or a pipe",
        };
        return refuse(format!("it is {what}: give the name of a file"));
    }
    let mut target = path.to_path_buf();
    for _ in 0..LINKS_MAX {
        let Ok(next) = fs::read_link(&target) else {
            return Ok(target);
        };
        target = target.parent().unwrap_or(Path::new("")).join(next);
    }
    refuse(format!("more than {LINKS_MAX} links lead from it"))
}

/// Creates a file for writing, replacing a temporary file that an ended process may have left.
fn create(partial: &Path) -> io::Result<File> {
    // there may be nothing to remove
    let _ = fs::remove_file(partial);
    File::create_new(partial)
}

/// Calls `write` for a temporary file next to the file that `path` leads to, and renames that file when it is
/// complete.
fn replace_file(path: &Path, write: impl FnOnce(&Path) -> io::Result<()>) -> io::Result<()> {
    let path = &target_of(path)?;
    let partial = partial_name(path);
    let rights = fs::metadata(path).map(|found| found.permissions());
    let keep = || rights.map_or(Ok(()), |rights| fs::set_permissions(&partial, rights));
    let made = write(&partial)
        .and_then(|()| keep())
        .and_then(|()| fs::rename(&partial, path));
    if made.is_err() {
        // The first failure is reported; an incomplete file that cannot be removed is recognisable by its name.
        let _ = fs::remove_file(&partial);
    }
    made
}

/// Greatest number of links that are followed to a file [-].
const LINKS_MAX: usize = 40;

/// Writes the figures of a run as SVG, and `report.html`, into its folder.
///
/// # Errors
/// Names the first file that the operating system refuses.
pub fn write_report(record: &record::Record, scene: &Scene, folder: &Path) -> Result<(), OutputError> {
    let figures = figures::all(record);
    for (stem, svg) in &figures {
        let path = folder.join(format!("{stem}.svg"));
        write_file(&path, |w| w.write_all(svg.as_bytes()))?;
    }
    let html = report::html(record, &figures, &scene.in_words());
    write_file(&folder.join("report.html"), |w| w.write_all(html.as_bytes()))
}

/// `results.csv` -> `results.csv.1234.partial`, with the process number, so that two runs do not write to the same file.
fn partial_name(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(partial_ending());
    path.with_file_name(name)
}

fn partial_ending() -> String {
    format!(".{}.partial", std::process::id())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("results.csv");
        write_file(&path, |w| w.write_all(b"old")).unwrap();
        let error = write_file(&path, |w| {
            w.write_all(b"half")?;
            Err(io::Error::other("disk full"))
        })
        .unwrap_err();
        assert!(error.to_string().contains("results.csv: disk full"));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_followed_and_what_is_no_regular_file_is_not_replaced() {
        use std::os::unix::{fs::symlink, net::UnixListener};
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let write = |name: &str| write_file(&at(name), |w| w.write_all(b"new"));
        fs::write(at("real"), "old").unwrap();
        symlink("real", at("link")).unwrap();
        symlink(at("link"), at("second")).unwrap();
        symlink("later", at("dangling")).unwrap();
        symlink("loop", at("loop")).unwrap();
        symlink("/dev/null", at("null")).unwrap();
        let _socket = UnixListener::bind(at("socket")).unwrap();
        write("second").unwrap();
        write("dangling").unwrap();
        for name in ["real", "later"] {
            assert_eq!(fs::read(at(name)).unwrap(), b"new");
        }
        for name in ["link", "second", "dangling"] {
            assert!(fs::symlink_metadata(at(name)).unwrap().is_symlink());
        }
        for name in ["socket", "null", "loop"] {
            let problem = write(name).unwrap_err().to_string();
            let wanted = ["device or a pipe", "links lead from it"];
            assert!(wanted.iter().any(|part| problem.contains(part)), "{problem}");
            assert!(check_file(&at(name)).is_err());
        }
        assert!(!fs::symlink_metadata(at("socket")).unwrap().is_file());
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 8);
    }

    #[cfg(unix)]
    #[test]
    fn the_remainder_of_a_file_that_a_link_leads_to_is_removed() {
        use std::os::unix::fs::symlink;
        let [folder, elsewhere] = [(), ()].map(|()| tempfile::tempdir().unwrap());
        let place = |name: &str| elsewhere.path().join(name);
        for (link, target) in [("new.fmu", "later.fmu"), ("old.fmu", "earlier.fmu")] {
            symlink(place(target), folder.path().join(link)).unwrap();
            fs::write(partial_name(&place(target)), "half").unwrap();
        }
        fs::write(place("earlier.fmu"), "whole").unwrap();
        remove_partial(folder.path());
        let left = fs::read_dir(elsewhere.path()).unwrap();
        let left: Vec<_> = left.map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, ["earlier.fmu"]);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }
}
