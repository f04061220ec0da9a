//! The program `moorline`: parse, call, print, exit code.
//!
//! Exit codes: 0 done, 2 the input is wrong, 1 the computation failed, 130 interrupted.

mod accuracy;
mod arguments;
mod check;
mod convert;
mod demo;
mod failure;
mod fmu;
mod folder;
mod run;
mod statics;
mod summary;
mod terminal;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};
use run::Pace;

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Check { scene, host } => check::check(&scene, &host.into()),
        Command::Statics { scene, json, host } => statics::statics(&scene, &host.into(), json),
        Command::Run {
            scene,
            output,
            communication_step,
            velocities,
            moved,
            host,
        } => {
            let pace = match communication_step {
                Some(step) => Pace::Host { step, velocities },
                None => Pace::Scene,
            };
            run::run(&scene, &host.into(), &moved.into(), &output, pace)
        }
        Command::Convert { deck, output, host } => convert::convert(&deck, &output, &host.into()),
        Command::Fmu {
            scene,
            output,
            fmi,
            host,
        } => fmu::fmu(&scene, &host.into(), &output, &fmi),
        Command::Accuracy {
            scenes,
            output,
            peers,
            moved,
            host,
        } => {
            let (host, moved) = (host.into(), moved.into());
            accuracy::accuracy(&scenes, &host, &moved, &output, peers.as_deref())
        }
        Command::Demo { output } => demo::demo(&output),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.tell(),
    }
}
