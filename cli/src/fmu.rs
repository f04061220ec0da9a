//! `moorline fmu`: a scene as an FMU.

use std::path::Path;

use moorline::discretisation;
use moorline::output::check_file;
use moorline::output::fmi::FmiVersion;
use moorline::output::package::write_fmu;
use moorline::scene::LoadedScene;
use moorline::simulation::Watch;

use crate::Library;
use crate::arguments::Input;
use crate::failure::Failure;
use crate::folder::{Folder, check_apart};
use crate::terminal::{discretise, print, read_scene, remark_all, simulate};

/// Packages a scene for the FMI version "2" or "3".
pub(crate) fn fmu(input: &Input, target: &Path, version: &str, library: Library<'_>) -> Result<(), Failure> {
    let mut loaded = read_scene(&input.scene, &input.host.supplement())?;
    check_file(target)?;
    check_apart(&input.scene, target)?;
    let _open = Folder::of_file(target);
    discretise(&mut loaded, discretisation::select);
    // A scene without an equilibrium would make an FMU that no host can start.
    let simulation = simulate(&loaded)?;
    remark_all(&loaded, Watch::new(&loaded.scene, &simulation).look(&simulation));
    let version = match version {
        "3" => FmiVersion::Three,
        _ => FmiVersion::Two,
    };
    package(&loaded, target, version, library)?;
    print(&format!("written to {}\n", target.display()))
}

/// Writes the FMU of a scene; its name appears when the file is whole.
pub(crate) fn package(
    loaded: &LoadedScene,
    target: &Path,
    version: FmiVersion,
    library: Library<'_>,
) -> Result<(), Failure> {
    let binaries = library.find();
    let written =
        binaries.and_then(|binaries| write_fmu(&loaded.scene, &loaded.text, version, &binaries, target));
    written.map_err(|error| Failure::of_package(error, loaded))
}
