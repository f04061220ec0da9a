//! The program `moorline`: parse, call, print, exit code.
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
mod modes;
mod run;
mod statics;
mod summary;
mod terminal;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};
use run::Pace;

fn main() -> ExitCode {
    let command = Arguments::parse().command;
    folder::end_on_interrupt();
    let result = match command {
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
        Command::Convert { deck, output, host } => convert::convert(&deck, &output, &host.supplement()),
        Command::Fmu { input, output, fmi } => fmu::fmu(&input, &output, &fmi),
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
        Command::Demo { output } => demo::demo(&output),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.tell(),
    }
}
