//! The command line: parse, call, print, exit code.
//!
//! Exit codes: 0 done, 2 the input is wrong, 1 the computation failed.

mod cli;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use cli::run::Drive;
use moorline::scene::Supplement;

/// Mooring-line dynamics: statics, time-domain runs, FMUs.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true, after_help = EXIT_CODES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str = "Exit codes: 0 done, 2 the input is wrong, 1 the computation failed.";

#[derive(Debug, Subcommand)]
enum Command {
    /// Say in words what a scene models and what it does not; find every mistake
    Check {
        /// Scene file
        scene: PathBuf,
    },
    /// Static equilibrium: forces, shape, sag, length on the seabed
    Statics {
        /// Scene file
        scene: PathBuf,
        /// Print JSON with every number in full
        #[arg(long)]
        json: bool,
    },
    /// Run in time with the scene's motion: CSV, ParaView files, figures, report
    Run {
        /// Scene file
        scene: PathBuf,
        /// Folder for the results; made where it is missing
        #[arg(short, long, value_name = "DIR")]
        output: PathBuf,
        /// Drive the run as a host does: set the motion at every multiple of H [s], then step by H; a row of results each
        #[arg(long, value_name = "H", value_parser = cli::positive_number)]
        communication_step: Option<f64>,
        /// Set velocities beside displacements
        #[arg(long, requires = "communication_step")]
        velocities: bool,
    },
    /// Write a MoorDyn or MAP++ file as a scene with comments
    Convert {
        /// MoorDyn or MAP++ file
        deck: PathBuf,
        /// The scene
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
        /// Water depth D [m], where the file leaves it to its host
        #[arg(long, value_name = "D", value_parser = cli::positive_number)]
        depth: Option<f64>,
        /// Reference position of a vessel [m], where the file leaves it to its host; may be given several times
        #[arg(long, value_name = "NAME=X,Y,Z", value_parser = cli::convert::placed_vessel)]
        at: Vec<(String, [f64; 3])>,
    },
    /// Package a scene as an FMU for co-simulation
    Fmu {
        /// Scene file
        scene: PathBuf,
        /// The .fmu file
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
        /// Version of FMI
        #[arg(long, default_value = "2", value_name = "VERSION", value_parser = ["2", "3"])]
        fmi: String,
    },
    /// Speed against error on this machine: meshes, integrators and steps against a converged solution
    Accuracy {
        /// Scene files; the five public scenes where none is given
        scenes: Vec<PathBuf>,
        /// Folder for tables and figures; made where it is missing
        #[arg(short, long, value_name = "DIR", default_value = "moorline-accuracy")]
        output: PathBuf,
        /// Run MoorDyn and CableDyn too, in the same run on the same core; PYTHON is an interpreter, or the folder of a virtual
        /// environment, that can import moordyn and cabledyn
        #[arg(long, value_name = "PYTHON")]
        peers: Option<PathBuf>,
    },
    /// Package the built-in scene as an FMU, drive it as a host does, show what comes out
    Demo {
        /// Folder for the results; made where it is missing
        #[arg(short, long, value_name = "DIR", default_value = "moorline-demo")]
        output: PathBuf,
    },
}

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Check { scene } => cli::check::check(&scene),
        Command::Statics { scene, json } => cli::statics::statics(&scene, json),
        Command::Run {
            scene,
            output,
            communication_step,
            velocities,
        } => {
            let drive = match communication_step {
                Some(step) => Drive::Host { step, velocities },
                None => Drive::Scene,
            };
            cli::run::run(&scene, &output, drive)
        }
        Command::Convert {
            deck,
            output,
            depth,
            at,
        } => {
            let supplement = Supplement {
                depth,
                positions: at.into_iter().collect(),
            };
            cli::convert::convert(&deck, &output, &supplement)
        }
        Command::Fmu { scene, output, fmi } => cli::fmu::fmu(&scene, &output, &fmi),
        Command::Accuracy {
            scenes,
            output,
            peers,
        } => cli::accuracy::accuracy(&scenes, &output, peers.as_deref()),
        Command::Demo { output } => cli::demo::demo(&output),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.tell(),
    }
}
