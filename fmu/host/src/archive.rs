//! The .fmu container: unpacked into a separate folder; the platform's name selects the library.

use std::fs::File;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use moorline::output::fmi::{FmiVersion, Platform};

use crate::HostError;

/// Unpacks an FMU.
pub(crate) fn unpack(path: &Path) -> Result<TempDir, HostError> {
    let fail = |problem: String| HostError::Archive {
        path: path.to_path_buf(),
        problem,
    };
    let file = File::open(path).map_err(|e| fail(e.to_string()))?;
    let mut archive = zip::ZipArchive::new(file).map_err(|e| fail(e.to_string()))?;
    let folder = tempfile::Builder::new()
        .prefix("fmu-")
        .tempdir()
        .map_err(|e| fail(e.to_string()))?;
    archive.extract(folder.path()).map_err(|e| fail(e.to_string()))?;
    Ok(folder)
}

/// Returns the path of the library in an unpacked FMU.
pub(crate) fn library_path(
    folder: &Path,
    version: FmiVersion,
    model_identifier: &str,
) -> Result<PathBuf, HostError> {
    let platform = Platform::this().ok_or(HostError::Platform)?;
    Ok(folder.join(platform.path(version, model_identifier)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_no_archive_is_refused_with_its_path() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("no.fmu");
        std::fs::write(&path, b"not a zip").unwrap();
        let message = unpack(&path).unwrap_err().to_string();
        assert!(message.contains("no.fmu"), "{message}");
    }
}
