//! The .fmu container: description, scene and libraries in one zip file.
//!
//! Deterministic: the same scene, libraries and version give the same bytes. Names have forward slashes, a library
//! its run bit.

use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::binaries::Binaries;
use super::description::{Description, MODEL_IDENTIFIER};
use super::fmi::FmiVersion;
use super::{OutputError, write_file};
use crate::discretisation;
use crate::scene::{Scene, SceneError};

/// Name of the scene below `resources/`.
pub const SCENE_FILE: &str = "scene.toml";

/// Reason for which an FMU was not written.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    /// The scene cannot be described.
    #[error(transparent)]
    Scene(#[from] SceneError),
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

/// Packages a scene with FMU libraries into `target`, which gets its name when it is complete. `text` is the text
/// of the file that the scene was read from. The mesh is the present one of the scene, regardless of later inputs of
/// a host.
///
/// # Errors
/// A scene that cannot be described, a target that cannot be written.
pub fn write_fmu(
    scene: &Scene,
    text: &str,
    version: FmiVersion,
    binaries: &Binaries,
    target: &Path,
) -> Result<(), PackageError> {
    let frozen = discretisation::frozen(scene);
    let text = match &frozen {
        Some(frozen) => frozen.to_toml(),
        None => packaged_text(scene, text),
    };
    let scene = frozen.as_ref().unwrap_or(scene);
    let description = Description::new(&text, scene, version)?;
    let bytes = container(&description.xml, &text, version, binaries)?;
    write_file(target, |out| out.write_all(&bytes))?;
    Ok(())
}

/// Returns the user's text where it alone defines the whole scene; else, with motion files or in another format, the
/// scene written out.
fn packaged_text(scene: &Scene, text: &str) -> String {
    match Scene::from_toml(text) {
        Ok(read) if read == *scene => text.to_string(),
        _ => scene.to_toml(),
    }
}

fn container(
    description: &str,
    scene: &str,
    version: FmiVersion,
    binaries: &Binaries,
) -> Result<Vec<u8>, PackageError> {
    let scene_path = format!("resources/{SCENE_FILE}");
    let mut entries = vec![("modelDescription.xml".to_string(), description.as_bytes(), 0o644)];
    for (platform, library) in binaries.iter() {
        entries.push((platform.path(version, MODEL_IDENTIFIER), library, 0o755));
    }
    entries.push((scene_path, scene.as_bytes(), 0o644));
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes, mode) in entries {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(DateTime::default())
            .unix_permissions(mode);
        zip.start_file(&*name, options)?;
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
            container(
                "<xml/>",
                "title = \"\"",
                FmiVersion::Two,
                &Binaries::of_bytes(b"library").unwrap(),
            )
            .unwrap()
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
