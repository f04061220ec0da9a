//! Extension module `moorline._moorline`: the Python interface of the library. It contains no computations.
//!
//! | module | content |
//! |---|---|
//! | [`scene`] | scenes and decks, statics, modes, FMUs |
//! | [`simulation`] | simulation stepped from Python, and its saved state |
//! | [`moordyn`] | mooring with MoorDyn's interface |
//! | [`runs`] | runs of a scene's own motion, one or many |
//! | [`sweep`] | load cases |
//! | [`motion`], [`parameters`] | motion from columns, values of parameters |
//! | [`aside`] | work on another thread while the Python thread checks for Ctrl-C |
//! | [`convert`] | Python values to TOML, and JSON to Python values |
//! | [`errors`] | errors as exceptions |
//!
//! The classes and functions that users import are described in `package/moorline/_moorline.pyi`.
#![forbid(unsafe_code)]

mod aside;
mod convert;
mod errors;
mod moordyn;
mod motion;
mod parameters;
mod runs;
mod scene;
mod simulation;
mod sweep;

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use moorline_cli::Library;
use pyo3::prelude::*;

/// Returns the folder of the package, which contains the FMU libraries.
fn package_folder(py: Python<'_>) -> PyResult<PathBuf> {
    let file: PathBuf = py.import("moorline")?.getattr("__file__")?.extract()?;
    Ok(file.parent().unwrap_or(Path::new(".")).to_path_buf())
}

/// Runs the program `moorline` with its arguments, the first of which is its name, and returns the exit code.
#[pyfunction]
fn main(py: Python<'_>, arguments: Vec<OsString>) -> PyResult<u8> {
    let folder = package_folder(py)?;
    Ok(py.detach(|| moorline_cli::main(arguments, Library::In(&folder))))
}

/// The extension module.
#[pymodule]
mod _moorline {
    #[pymodule_export]
    use super::main;
    #[pymodule_export]
    use super::moordyn::MoorDyn;
    #[pymodule_export]
    use super::runs::{batch, run};
    #[pymodule_export]
    use super::scene::{Scene, fmu};
    #[pymodule_export]
    use super::simulation::{Simulation, State};
    #[pymodule_export]
    use super::sweep::Sweep;

    /// Version of the package.
    #[pymodule_export]
    #[allow(non_upper_case_globals, reason = "a name of Python")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
