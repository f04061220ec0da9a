//! What leaves the program: tables, ParaView files, figures, the report and `--json`.
//!
//! All of it is written from plain numbers: a [`record::Record`] of a run, a [`json::Statics`] of an equilibrium. Nothing here
//! prints. A file appears under its name only when it is whole ([`write_file`]).

pub mod accuracy;
pub mod channels;
pub mod collect;
pub mod csv;
pub mod description;
pub mod figures;
pub mod json;
pub mod left_tables;
pub mod package;
pub mod record;
pub mod report;
pub mod vtk;

#[cfg(test)]
mod sample;

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Why something could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// A folder could not be made.
    #[error("cannot make the folder {}: {source}", .path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// Something that is not a folder has the folder's name.
    #[error("{} is a file: give the name of a folder", .path.display())]
    NotAFolder {
        /// What has the name.
        path: PathBuf,
    },
    /// A folder takes no files.
    #[error("cannot write into the folder {}: {source}", .path.display())]
    Closed {
        /// The folder.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
    /// A file could not be written.
    #[error("cannot write {}: {source}", .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        source: io::Error,
    },
}

/// Makes a folder and those above it, where they are missing.
///
/// # Errors
/// Where a file has its name, or the operating system refuses.
pub fn make_folder(path: &Path) -> Result<(), OutputError> {
    if path.exists() && !path.is_dir() {
        return Err(OutputError::NotAFolder {
            path: path.to_path_buf(),
        });
    }
    fs::create_dir_all(path).map_err(|source| OutputError::Folder {
        path: path.to_path_buf(),
        source,
    })
}

/// Makes a folder as [`make_folder`] does, and sees that it takes files.
///
/// # Errors
/// As there, and where it takes none.
pub fn open_folder(path: &Path) -> Result<(), OutputError> {
    make_folder(path)?;
    let probe = partial_name(&path.join("probe"));
    let tried = File::create(&probe).and_then(|_| fs::remove_file(&probe));
    tried.map_err(|source| OutputError::Closed {
        path: path.to_path_buf(),
        source,
    })
}

/// Removes what this process has not written to its end in a folder of a run.
pub fn remove_partial(folder: &Path) {
    let ending = partial_ending();
    for folder in [folder.to_path_buf(), folder.join(vtk::FRAME_FOLDER)] {
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            if entry.file_name().to_string_lossy().ends_with(&ending) {
                // A remainder that cannot be removed does not look complete.
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

/// Writes a file under a temporary name beside it and renames it when it is whole: an interrupted run leaves the old file or
/// none, never half of one.
///
/// # Errors
/// Where the operating system refuses; the temporary file is then removed.
pub fn write_file(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), OutputError> {
    let made = replace_file(path, |partial| {
        let mut file = BufWriter::new(File::create(partial)?);
        write(&mut file)?;
        file.flush()
    });
    made.map_err(|source| OutputError::File {
        path: path.to_path_buf(),
        source,
    })
}

/// Lets `write` make a file under a temporary name beside `path`, and gives it that name when it is whole.
///
/// # Errors
/// Those of `write`, and where the operating system refuses the new name; the temporary file is then removed.
pub fn replace_file<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), E> {
    let partial = partial_name(path);
    let made = write(&partial).and_then(|()| Ok(fs::rename(&partial, path)?));
    if made.is_err() {
        // The first failure is the one to tell; a remainder that cannot be removed does not look complete.
        let _ = fs::remove_file(&partial);
    }
    made
}

/// Most shapes written for ParaView [-]; of more, evenly chosen ones stand for all.
const VTK_FRAMES_MAX: usize = 240;

/// Writes a run into a folder: `results.csv` with `results.units.csv`, `profile.csv` where `profile` asks for it, the
/// shapes for ParaView (`lines.pvd` and its folder), every figure as SVG, and `report.html`. `words` says what is modelled.
///
/// # Errors
/// The first file or folder that the operating system refuses.
pub fn write_run(
    record: &record::Record,
    folder: &Path,
    words: &str,
    profile: bool,
) -> Result<(), OutputError> {
    make_folder(folder)?;
    write_file(&folder.join("results.csv"), |w| {
        csv::write_results(record, w)
    })?;
    write_file(&folder.join("results.units.csv"), |w| {
        csv::write_units(record, w)
    })?;
    if profile {
        write_file(&folder.join("profile.csv"), |w| {
            csv::write_profile(record, w)
        })?;
    }
    write_shapes(record, folder)?;
    for (stem, svg) in figures::all(record) {
        let path = folder.join(format!("{stem}.svg"));
        write_file(&path, |w| w.write_all(svg.as_bytes()))?;
    }
    let html = report::html(record, words);
    write_file(&folder.join("report.html"), |w| {
        w.write_all(html.as_bytes())
    })
}

/// Writes the shapes for ParaView; the collection comes last, when all it names is there.
fn write_shapes(record: &record::Record, folder: &Path) -> Result<(), OutputError> {
    make_folder(&folder.join(vtk::FRAME_FOLDER))?;
    let stride = record.frames.len().div_ceil(VTK_FRAMES_MAX).max(1);
    let frames = || record.frames.iter().step_by(stride);
    for (index, frame) in frames().enumerate() {
        let path = folder.join(vtk::frame_name(index));
        write_file(&path, |w| vtk::write_frame(frame, w))?;
    }
    let times = frames().map(|frame| frame.time);
    write_file(&folder.join("lines.pvd"), |w| {
        vtk::write_collection(times, w)
    })
}

/// `results.csv` -> `results.csv.1234.partial`, with the number of the process: two runs do not write into one another.
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

    #[test]
    fn a_file_in_place_of_a_folder_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("taken");
        fs::write(&path, "").unwrap();
        let message = make_folder(&path).unwrap_err().to_string();
        assert!(message.ends_with("taken is a file: give the name of a folder"));
    }
}
