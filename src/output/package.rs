//! The .fmu container: description, scene, libraries, documentation, terminals and reference results in one zip file; and the .ssp container that
//! holds it.
//!
//! The output is deterministic: the same scene, libraries, version and stamp give the same bytes. Names have forward slashes; libraries have the
//! executable bit.

mod documentation;
mod icon;
mod osp;
mod ports;
mod reference;
mod ssp;
mod stamp;
mod terminals;

use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

pub use reference::EXPERIMENTS_FILE;
pub use stamp::Stamp;

use super::binaries::Binaries;
use super::description::Description;
use super::fmi::FmiVersion;
use super::{OutputError, write_file};
use crate::discretisation;
use crate::scene::{Scene, SceneError};
use crate::simulation::{self, Simulation};

/// Name of the scene below `resources/`.
pub const SCENE_FILE: &str = "scene.toml";

/// Reason why an FMU was not written.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    /// The scene cannot be described.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The scene has no equilibrium.
    #[error(transparent)]
    Statics(#[from] simulation::Error),
    /// The FMU library is missing.
    #[error(
        "the FMU library {name} is not in {}: build it with `cargo build --release -p moorline-fmu` in the workspace \
         and copy it from target/release to there, or take a program of a release, which contains it",
        folder.display()
    )]
    NoLibrary {
        /// File name.
        name: String,
        /// Folder that was searched.
        folder: PathBuf,
    },
    /// An archive of libraries cannot be used.
    #[error("the archive of FMU libraries: {0}")]
    Archive(String),
    /// A file cannot be read.
    #[error("{}: {problem}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The system's message.
        problem: std::io::Error,
    },
    /// The FMU cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// FMI names no folder for this platform.
    #[error("FMI names no binaries folder for this platform")]
    Platform,
    /// The container cannot be made.
    #[error("the zip container cannot be made: {0}")]
    Zip(#[from] zip::result::ZipError),
}

/// Kind of container to be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Container {
    /// An FMU.
    Fmu,
    /// A system of SSP 1.0 that contains the FMU, with connectors for the body.
    Ssp,
}

/// Packages a scene with FMU libraries into `target`, which receives its name when it is complete. `text` is the text of the file from which the
/// scene was read. The mesh is the present one of the scene, regardless of later inputs of a host.
///
/// # Errors
/// The scene cannot be described or has no equilibrium, or the target cannot be written.
pub fn write_fmu(
    scene: &Scene,
    text: &str,
    version: FmiVersion,
    binaries: &Binaries,
    target: &Path,
) -> Result<(), PackageError> {
    let plain = (Container::Fmu, &Stamp::default());
    write_package((scene, text), version, plain, binaries, target)
}

/// Packages a scene, given with its text, as [`write_fmu`] does, in a container and with author and date.
///
/// # Errors
/// As [`write_fmu`].
pub fn write_package(
    (scene, text): (&Scene, &str),
    version: FmiVersion,
    (container, stamp): (Container, &Stamp),
    binaries: &Binaries,
    target: &Path,
) -> Result<(), PackageError> {
    let frozen = discretisation::frozen(scene);
    let text = match &frozen {
        Some(frozen) => frozen.to_toml(),
        None => packaged_text(scene, text),
    };
    let scene = frozen.as_ref().unwrap_or(scene);
    let description = Description::stamped(&text, scene, version, stamp)?;
    let mut bytes = zipped(&fmu_entries(scene, &text, version, &description, binaries)?)?;
    if container == Container::Ssp {
        let fmu = format!("resources/{}.fmu", description.model_identifier);
        let structure = ssp::text(scene, &description.interface, &description.model_name, &fmu);
        bytes = zipped(&[Entry::new(ssp::FILE, structure), Entry::new(&fmu, bytes)])?;
    }
    write_file(target, |out| out.write_all(&bytes))?;
    Ok(())
}

/// A file of a container.
struct Entry {
    name: String,
    bytes: Vec<u8>,
    mode: u32,
}

impl Entry {
    fn new(name: &str, bytes: impl Into<Vec<u8>>) -> Entry {
        Entry {
            name: name.to_string(),
            bytes: bytes.into(),
            mode: 0o644,
        }
    }
}

/// Files of an FMU with these libraries.
fn fmu_entries(
    scene: &Scene,
    text: &str,
    version: FmiVersion,
    description: &Description,
    binaries: &Binaries,
) -> Result<Vec<Entry>, PackageError> {
    let interface = &description.interface;
    let simulation = Simulation::new(scene)?;
    let ports = ports::ports(interface);
    let page = documentation::html(&description.model_name, scene, &simulation, interface);
    let mut entries = vec![Entry::new("modelDescription.xml", description.xml.as_str())];
    entries.extend(binaries.iter().map(|(platform, library)| Entry {
        mode: 0o755,
        ..Entry::new(&platform.path(version, &description.model_identifier), library)
    }));
    entries.extend([
        Entry::new(&format!("resources/{SCENE_FILE}"), text),
        Entry::new(documentation::FILE, page),
        Entry::new(documentation::LICENSE_FILE, documentation::license()),
        Entry::new(terminals::FILE, terminals::text(&ports)),
        Entry::new("terminalsAndIcons/icon.svg", icon::SVG),
        Entry::new("terminalsAndIcons/icon.png", icon::PNG),
    ]);
    if version == FmiVersion::Two {
        entries.push(Entry::new("model.png", icon::PNG));
        entries.push(Entry::new(osp::FILE, osp::text(&ports)));
    }
    let files = reference::files(scene, &simulation, interface)?;
    let files = files.into_iter();
    entries.extend(files.map(|(name, bytes)| Entry::new(&format!("{}{name}", reference::FOLDER), bytes)));
    Ok(entries)
}

/// Returns the user's text if it alone defines the whole scene; otherwise, as with motion files or another format, returns the scene written as TOML.
fn packaged_text(scene: &Scene, text: &str) -> String {
    match Scene::from_toml(text) {
        Ok(read) if read == *scene => text.to_string(),
        _ => scene.to_toml(),
    }
}

fn zipped(entries: &[Entry]) -> Result<Vec<u8>, PackageError> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for Entry { name, bytes, mode } in entries {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(DateTime::default())
            .unix_permissions(*mode);
        zip.start_file(name.as_str(), options)?;
        zip.write_all(bytes).map_err(|problem| PackageError::File {
            path: PathBuf::from(name),
            problem,
        })?;
    }
    Ok(zip.finish()?.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_container_is_the_same_each_time_and_its_library_may_run() {
        let make = || {
            let text = include_str!("../../tests/scenes/rope.toml");
            let scene = Scene::from_toml(text).unwrap();
            let description = Description::new(text, &scene, FmiVersion::Two).unwrap();
            let binaries = Binaries::of_bytes(b"library").unwrap();
            let entries = fmu_entries(&scene, text, FmiVersion::Two, &description, &binaries).unwrap();
            zipped(&entries).unwrap()
        };
        let bytes = make();
        assert_eq!(bytes, make());
        let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
        let names: Vec<String> = archive
            .file_names()
            .map(|name| name.unwrap().into_owned())
            .collect();
        assert!(names.iter().all(|name| !name.contains('\\')), "{names:?}");
        let library = archive.by_index(1).unwrap();
        assert!(library.name().unwrap().starts_with("binaries/"));
        assert_eq!(library.unix_mode().unwrap() & 0o777, 0o755);
        let time = library.last_modified().unwrap();
        assert_eq!((time.year(), time.month(), time.day()), (1980, 1, 1));
    }
}
