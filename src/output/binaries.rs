//! Machine code of FMUs: the FMU library for this platform, or for all platforms of a release.
//!
//! An archive of libraries is a zip file with an entry such as `x86_64-linux/libmoorline_fmu.so` for each platform, by its name in FMI 3.0.
//! `release/build` makes it.

use std::fs;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

use zip::ZipArchive;
use zip::result::ZipError;

use super::fmi::Platform;
use super::package::PackageError;

/// File name of an archive of libraries.
const ARCHIVE: &str = "moorline_fmu.zip";

/// First bytes of a zip file.
const MAGIC: &[u8] = b"PK\x03\x04";

/// FMU libraries of one or more platforms.
#[derive(Debug, Clone)]
pub struct Binaries(Vec<(Platform, Vec<u8>)>);

impl Binaries {
    /// Returns the libraries in the folder of the running program.
    ///
    /// # Errors
    /// As for [`Binaries::of_folder`].
    pub fn beside_the_program() -> Result<Binaries, PackageError> {
        Binaries::of_folder(&folder_of_the_program()?)
    }

    /// Returns the libraries in a folder: those of its archive, or else the library for this platform.
    ///
    /// # Errors
    /// A file is missing or cannot be read.
    pub fn of_folder(folder: &Path) -> Result<Binaries, PackageError> {
        let archive = folder.join(ARCHIVE);
        match archive.is_file() {
            true => Binaries::read(&archive),
            false => Binaries::read(&library_in(folder)?),
        }
    }

    /// Returns the libraries in a file, as [`Binaries::of_bytes`] does.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn read(path: &Path) -> Result<Binaries, PackageError> {
        let bytes = fs::read(path).map_err(|problem| PackageError::File {
            path: path.to_path_buf(),
            problem,
        })?;
        Binaries::of_bytes(&bytes)
    }

    /// Returns the libraries of an archive, or a library for this platform.
    ///
    /// # Errors
    /// The archive is damaged or has other content, or FMI has no name for the platform.
    pub fn of_bytes(bytes: &[u8]) -> Result<Binaries, PackageError> {
        if !bytes.starts_with(MAGIC) {
            let this = Platform::this().ok_or(PackageError::Platform)?;
            return Ok(Binaries(vec![(this, bytes.to_vec())]));
        }
        Ok(Binaries(libraries(bytes).map_err(PackageError::Archive)?))
    }

    /// Platforms, each with its library.
    pub fn iter(&self) -> impl Iterator<Item = (Platform, &[u8])> {
        self.0
            .iter()
            .map(|(platform, library)| (*platform, library.as_slice()))
    }
}

/// Platforms and libraries of an archive.
fn libraries(bytes: &[u8]) -> Result<Vec<(Platform, Vec<u8>)>, String> {
    let damaged = |problem: ZipError| problem.to_string();
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(damaged)?;
    let mut libraries = Vec::new();
    for place in 0..archive.len() {
        let mut entry = archive.by_index(place).map_err(damaged)?;
        let name = entry.name().map_err(damaged)?.into_owned();
        let platform = name
            .split_once('/')
            .and_then(|(folder, _)| Platform::of_name(folder));
        let platform =
            platform.ok_or_else(|| format!("{name} is in no folder of a platform, such as x86_64-linux"))?;
        let mut library = Vec::new();
        let read = entry.read_to_end(&mut library);
        read.map_err(|problem| format!("{name}: {problem}"))?;
        libraries.push((platform, library));
    }
    Ok(libraries)
}

/// Folder of the running program.
fn folder_of_the_program() -> Result<PathBuf, PackageError> {
    let program = std::env::current_exe().map_err(|problem| PackageError::File {
        path: PathBuf::from("the running program"),
        problem,
    })?;
    Ok(program.parent().unwrap_or(Path::new(".")).to_path_buf())
}

/// FMU library for this platform in a folder or, for test programs, one folder up.
fn library_in(folder: &Path) -> Result<PathBuf, PackageError> {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    let name = format!("{DLL_PREFIX}moorline_fmu{DLL_SUFFIX}");
    [Some(folder), folder.parent()]
        .into_iter()
        .flatten()
        .map(|folder| folder.join(&name))
        .find(|path| path.is_file())
        .ok_or_else(|| PackageError::NoLibrary {
            name,
            folder: folder.to_path_buf(),
        })
}

/// FMU library that Cargo built next to the running program, or one folder up.
///
/// # Errors
/// Names the library and the folder where it was expected.
pub fn find_library() -> Result<PathBuf, PackageError> {
    library_in(&folder_of_the_program()?)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use zip::ZipWriter;
    use zip::write::SimpleFileOptions;

    use super::*;

    fn archive(entries: &[(&str, &str)]) -> Vec<u8> {
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        for (name, text) in entries {
            zip.start_file(*name, SimpleFileOptions::default()).unwrap();
            zip.write_all(text.as_bytes()).unwrap();
        }
        zip.finish().unwrap().into_inner()
    }

    #[test]
    fn an_archive_holds_the_libraries_of_its_platforms() {
        let bytes = archive(&[
            ("x86_64-linux/a.so", "linux"),
            ("x86_64-windows/a.dll", "windows"),
        ]);
        let binaries = Binaries::of_bytes(&bytes).unwrap();
        let found: Vec<_> = binaries
            .iter()
            .map(|(platform, code)| (platform.name(), code))
            .collect();
        let expected: [(&str, &[u8]); 2] = [("x86_64-linux", b"linux"), ("x86_64-windows", b"windows")];
        assert_eq!(found, expected);
    }

    #[test]
    fn an_archive_of_something_else_is_refused_with_the_name_of_the_entry() {
        let error = Binaries::of_bytes(&archive(&[("readme.txt", "")])).unwrap_err();
        assert!(
            error.to_string().contains("readme.txt is in no folder"),
            "{error}"
        );
        let cut = archive(&[("x86_64-linux/a.so", "linux")]);
        assert!(Binaries::of_bytes(&cut[..cut.len() / 2]).is_err());
    }

    #[test]
    fn a_folder_gives_its_archive_before_its_library_and_says_what_is_missing() {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("a/b");
        fs::create_dir_all(&inner).unwrap();
        let missing = Binaries::of_folder(&inner).unwrap_err().to_string();
        assert!(
            missing.contains("moorline_fmu") && missing.contains("cargo build"),
            "{missing}"
        );
        fs::write(inner.join(ARCHIVE), archive(&[("x86_64-darwin/a.dylib", "mac")])).unwrap();
        let found = Binaries::of_folder(&inner).unwrap();
        assert_eq!(
            found
                .iter()
                .map(|(platform, _)| platform.name())
                .collect::<Vec<_>>(),
            ["x86_64-darwin"]
        );
    }
}
