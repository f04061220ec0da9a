//! The program `moorline`: parses arguments, calls a command, prints and returns an exit code. The binary of this package and the Python package both
//! call [`main`].
//!
//! Exit codes: 0 done, 2 the input is wrong, 1 the computation failed, 130 interrupted.
#![forbid(unsafe_code)]

mod accuracy;
mod arguments;
mod check;
mod convert;
mod demo;
mod failure;
mod fmu;
mod folder;
mod hold;
mod manual;
mod modes;
mod run;
mod statics;
mod summary;
mod sweep;
mod terminal;

use std::ffi::OsString;
use std::io::Write;
use std::path::Path;

use clap::Parser;
use moorline::output::binaries::Binaries;
use moorline::output::package::PackageError;

use arguments::{Arguments, Command};
use failure::Failure;
use run::Stepping;

/// Exit code of a program that was called with wrong arguments.
const USAGE: u8 = 2;

/// FMU libraries of all platforms of a release, as `release/build` collects them, or the library for this platform.
#[cfg(feature = "embedded-fmu")]
const EMBEDDED: Option<&[u8]> = Some(include_bytes!(env!(
    "MOORLINE_FMU_LIBRARIES",
    "MOORLINE_FMU_LIBRARIES has to name the archive or the library that the feature embedded-fmu puts into the program"
)));
#[cfg(not(feature = "embedded-fmu"))]
const EMBEDDED: Option<&[u8]> = None;

/// Location of the FMU libraries that the program packages. Libraries embedded in the program take precedence.
#[derive(Debug, Clone, Copy)]
pub enum Library<'a> {
    /// In the folder of the program.
    BesideTheProgram,
    /// In another folder.
    In(&'a Path),
}

impl Library<'_> {
    /// Returns the libraries.
    ///
    /// # Errors
    /// A file is missing or cannot be read.
    pub fn find(self) -> Result<Binaries, PackageError> {
        match (EMBEDDED, self) {
            (Some(embedded), _) => Binaries::of_bytes(embedded),
            (None, Library::BesideTheProgram) => Binaries::beside_the_program(),
            (None, Library::In(folder)) => Binaries::of_folder(folder),
        }
    }
}

/// Runs the program with its arguments, of which the first is its name. Returns the exit code.
pub fn main(arguments: impl IntoIterator<Item = OsString>, library: Library<'_>) -> u8 {
    let command = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments.command,
        Err(usage) => {
            // A failure to write the message is ignored.
            let _ = usage.print();
            let _ = std::io::stdout().flush();
            return u8::try_from(usage.exit_code()).unwrap_or(USAGE);
        }
    };
    folder::end_on_interrupt();
    match call(command, library) {
        Ok(()) => 0,
        Err(failure) => failure.report(),
    }
}

fn call(command: Command, library: Library<'_>) -> Result<(), Failure> {
    match command {
        Command::Check { input, write } => check::check(&input, write),
        Command::Statics { input, json } => statics::statics(&input, json),
        Command::Modes {
            input,
            count,
            json,
            output,
        } => {
            let shown = modes::Shown {
                count: usize::from(count),
                as_json: json,
                output: output.as_deref(),
            };
            modes::modes(&input, &shown)
        }
        Command::Run {
            input,
            output,
            communication_step,
            velocities,
            resume,
            until,
            moved,
        } => {
            let stepping =
                communication_step.map_or(Stepping::Scene, |step| Stepping::Host { step, velocities });
            let course = run::Course {
                stepping,
                resume,
                until,
            };
            run::run(&input, &moved.into(), &output, &course)
        }
        Command::Sweep {
            base,
            cases,
            output,
            from,
            series,
        } => sweep::sweep(&base, &cases, &output, &sweep::Choice { from, series }),
        Command::Completions { shell } => manual::completions(shell),
        Command::Man { output } => manual::man(output.as_deref()),
        Command::Convert { deck, output, host } => convert::convert(&deck, &output, &host.supplement()),
        Command::Fmu { packaging, verify } => match packaging.output.as_deref() {
            Some(target) if !verify => fmu::fmu(&packaging, target, library),
            _ => fmu::verify(&packaging.input.scene),
        },
        Command::Accuracy {
            scenes,
            output,
            add,
            peers,
            moved,
            host,
        } => {
            let (host, moved) = (host.supplement(), moved.into());
            let results = accuracy::Results { folder: &output, add };
            accuracy::accuracy(&scenes, &host, &moved, results, (peers.as_deref(), library))
        }
        Command::Demo { output } => demo::demo(&output, library),
    }
}
