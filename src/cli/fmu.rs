//! `moorline fmu`: a scene as an FMU.

use std::io;
use std::path::Path;

use moorline::output::package::{PackageError, find_library, write_fmu};
use moorline::output::replace_file;
use moorline::scene::{LoadedScene, Supplement};
use moorline::simulation::Watch;
use moorline_host::FmiVersion;

use super::failure::Failure;
use super::{print, read_scene, remark_all, simulate};

/// Packages a scene for the FMI version "2" or "3".
pub fn fmu(
    path: &Path,
    supplement: &Supplement,
    target: &Path,
    version: &str,
) -> Result<(), Failure> {
    let loaded = read_scene(path, supplement)?;
    check_target(target)?;
    // A scene without an equilibrium would make an FMU that no host can start.
    let simulation = simulate(&loaded)?;
    remark_all(
        &loaded,
        Watch::new(&loaded.scene, &simulation).look(&simulation),
    );
    let version = match version {
        "3" => FmiVersion::Three,
        _ => FmiVersion::Two,
    };
    package(&loaded, target, version)?;
    print(&format!("written to {}\n", target.display()))
}

fn check_target(target: &Path) -> Result<(), Failure> {
    if target.is_dir() {
        let text = format!("{} is a folder: give the name of a file", target.display());
        return Err(Failure::Argument(text));
    }
    let folder = target
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    match folder {
        Some(folder) if !folder.is_dir() => {
            let text = format!("{}: there is no such folder", folder.display());
            Err(Failure::Argument(text))
        }
        _ => Ok(()),
    }
}

/// Writes the FMU of a scene; its name appears when the file is whole.
pub fn package(loaded: &LoadedScene, target: &Path, version: FmiVersion) -> Result<(), Failure> {
    let library = find_library().map_err(|error| Failure::of_package(error, loaded))?;
    replace_file(target, |partial| {
        write_fmu(loaded, version, &library, partial).map_err(|error| match error {
            PackageError::File { path, problem } if path == partial => {
                PackageFailure::Target(problem)
            }
            error => PackageFailure::Package(error),
        })
    })
    .map_err(|failure| match failure {
        PackageFailure::Package(error) => Failure::of_package(error, loaded),
        PackageFailure::Target(problem) => {
            let text = format!("cannot write {}: {problem}", target.display());
            Failure::of_file(problem.kind(), text)
        }
    })
}

/// A package that was not written, or not under its name.
enum PackageFailure {
    Package(PackageError),
    Target(io::Error),
}

impl From<io::Error> for PackageFailure {
    fn from(error: io::Error) -> Self {
        PackageFailure::Target(error)
    }
}
