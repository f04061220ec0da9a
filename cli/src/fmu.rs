//! `moorline fmu`: a scene as an FMU.

use std::path::Path;

use moorline::discretisation;
use moorline::output::check_file;
use moorline::output::fmi::FmiVersion;
use moorline::output::package::{Container, Stamp, write_package};
use moorline::scene::LoadedScene;
use moorline::simulation::Watch;
use moorline_host::{Fmu, HostError, replay};
use time::OffsetDateTime;
use time::format_description::well_known::Rfc3339;

use crate::Library;
use crate::arguments::Packaging;
use crate::failure::Failure;
use crate::folder::{Folder, check_apart};
use crate::terminal::{discretise, print, read_scene, remark_all, simulate};

/// Packages a scene for the FMI version "2" or "3".
pub(crate) fn fmu(packaging: &Packaging, target: &Path, library: Library<'_>) -> Result<(), Failure> {
    let input = &packaging.input;
    let mut loaded = read_scene(&input.scene, &input.host.supplement())?;
    check_file(target)?;
    check_apart(&input.scene, target)?;
    let author = packaging.author.clone();
    let stamp = Stamp {
        author,
        date: epoch()?,
    };
    let _open = Folder::of_file(target);
    discretise(&mut loaded, discretisation::select);
    // A scene without an equilibrium would make an FMU that no host can start.
    let simulation = simulate(&loaded)?;
    remark_all(&loaded, Watch::new(&loaded.scene, &simulation).look(&simulation));
    let version = match packaging.fmi.as_str() {
        "3" => FmiVersion::Three,
        _ => FmiVersion::Two,
    };
    let container = match packaging.ssp {
        true => Container::Ssp,
        false => Container::Fmu,
    };
    package(&loaded, target, version, (container, &stamp), library)?;
    print(&format!("written to {}\n", target.display()))
}

/// Date in the environment variable that reproducible builds set.
/// Source: reproducible-builds.org, "SOURCE_DATE_EPOCH specification", version 1.1.
fn epoch() -> Result<Option<String>, Failure> {
    let Some(text) = std::env::var_os("SOURCE_DATE_EPOCH") else {
        return Ok(None);
    };
    let seconds = text
        .to_str()
        .and_then(|text| text.parse::<i64>().ok())
        .filter(|seconds| *seconds >= 0);
    let time = seconds.and_then(|seconds| OffsetDateTime::from_unix_timestamp(seconds).ok());
    let date = time.and_then(|time| time.format(&Rfc3339).ok());
    let date = date.ok_or_else(|| {
        let text = text.to_string_lossy();
        Failure::Argument(format!(
            "SOURCE_DATE_EPOCH is \"{text}\": whole seconds since 1970 would be right"
        ))
    })?;
    Ok(Some(date))
}

/// Replays the reference results of an FMU.
pub(crate) fn verify(file: &Path) -> Result<(), Failure> {
    let failed = |error: HostError| {
        let text = format!("{}: {error}", file.display());
        match error {
            HostError::Call { .. } | HostError::Instantiate(_) => Failure::Computation(text),
            _ => Failure::Argument(text),
        }
    };
    let replay = replay(&Fmu::open(file).map_err(failed)?).map_err(failed)?;
    let greatest = match &replay.greatest {
        None => "no deviation".to_string(),
        Some(found) => format!(
            "greatest deviation {:.1e} of its magnitude, {} at t = {} s",
            found.relative, found.variable, found.time
        ),
    };
    let text = format!(
        "{}: {} variables in {} steps to t = {} s: {greatest}; {:.1e} is allowed\n",
        file.display(),
        replay.variables,
        replay.steps,
        replay.end,
        replay.tolerance
    );
    match replay.agrees() {
        true => print(&text),
        false => Err(Failure::Computation(text.trim_end().to_string())),
    }
}

/// Writes the FMU of a scene; the file receives its name when it is complete.
pub(crate) fn package(
    loaded: &LoadedScene,
    target: &Path,
    version: FmiVersion,
    form: (Container, &Stamp),
    library: Library<'_>,
) -> Result<(), Failure> {
    let scene = (&loaded.scene, loaded.text.as_str());
    let binaries = library.find();
    let written = binaries.and_then(|binaries| write_package(scene, version, form, &binaries, target));
    written.map_err(|error| Failure::of_package(error, loaded))
}
