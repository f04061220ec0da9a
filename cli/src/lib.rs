//! The program `moorline`: parse, call, print, exit code. The binary of this package and the Python package both call [`main`].
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
use std::path::{Path, PathBuf};

use clap::Parser;
use moorline::output::package::{PackageError, find_library};

use arguments::{Arguments, Command};
use failure::Failure;
use run::Pace;

/// Exit code of a program that was called with wrong arguments.
const USAGE: u8 = 2;

/// Place of the FMU library that the program packages.
#[derive(Debug, Clone, Copy)]
pub enum Library<'a> {
    /// In the folder of the program.
    BesideTheProgram,
    /// A file.
    At(&'a Path),
}

impl Library<'_> {
    fn find(self) -> Result<PathBuf, PackageError> {
        match self {
            Library::BesideTheProgram => find_library(),
            Library::At(path) => Ok(path.to_path_buf()),
        }
    }
}

/// Runs the program with its arguments, of which the first is its name. Returns the exit code.
pub fn main(arguments: impl IntoIterator<Item = OsString>, library: Library<'_>) -> u8 {
    let command = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments.command,
        Err(usage) => {
            // A message that cannot be written changes nothing.
            let _ = usage.print();
            let _ = std::io::stdout().flush();
            return u8::try_from(usage.exit_code()).unwrap_or(USAGE);
        }
    };
    folder::end_on_interrupt();
    match call(command, library) {
        Ok(()) => 0,
        Err(failure) => failure.tell(),
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
            let pace = communication_step.map_or(Pace::Scene, |step| Pace::Host { step, velocities });
            let course = run::Course { pace, resume, until };
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
        Command::Fmu { made, verify } => match made.output.as_deref() {
            Some(target) if !verify => fmu::fmu(&made, target, library),
            _ => fmu::verify(&made.input.scene),
        },
        Command::Accuracy {
            scenes,
            output,
            peers,
            moved,
            host,
        } => {
            let (host, moved) = (host.supplement(), moved.into());
            accuracy::accuracy(&scenes, &host, &moved, &output, peers.as_deref())
        }
        Command::Demo { output } => demo::demo(&output, library),
    }
}
