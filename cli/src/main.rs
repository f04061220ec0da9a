//! The program `moorline`: see [`moorline_cli`].
#![forbid(unsafe_code)]

use std::process::ExitCode;

use moorline_cli::Library;

fn main() -> ExitCode {
    ExitCode::from(moorline_cli::main(std::env::args_os(), Library::BesideTheProgram))
}
