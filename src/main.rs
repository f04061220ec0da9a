//! The command line: parse, call, print, exit code.
//!
//! Exit codes: 0 done, 2 the input is wrong, 1 the computation failed, 130 interrupted.

mod cli;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};

use cli::modes::Shown;
use cli::run::Pace;
use moorline::scene::{Drive, RegularMotion, Supplement};

/// Mooring-line dynamics: statics, time-domain runs, FMUs.
#[derive(Debug, Parser)]
#[command(version, arg_required_else_help = true, after_help = EXIT_CODES)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str =
    "Exit codes: 0 done, 2 the input is wrong, 1 the computation failed, 130 interrupted.";

#[derive(Debug, Subcommand)]
enum Command {
    /// Say in words what a scene models and what it does not; find every mistake
    Check {
        /// Scene of moorline, or deck of MoorDyn or MAP++
        scene: PathBuf,
        #[command(flatten)]
        host: FromHost,
    },
    /// Static equilibrium: forces, shape, sag, length on the seabed
    Statics {
        /// Scene of moorline, or deck of MoorDyn or MAP++
        scene: PathBuf,
        /// Print JSON with every number in full
        #[arg(long)]
        json: bool,
        #[command(flatten)]
        host: FromHost,
    },
    /// Natural periods and shapes of lines and networks about the static equilibrium
    ///
    /// Added mass is included; drag, damping and waves are not. The seabed's springs act where nodes rest on it, and slack segments resist
    /// nothing, both as at rest.
    Modes {
        /// Scene of moorline, or deck of MoorDyn or MAP++
        scene: PathBuf,
        /// Modes of all lines together, from the lowest frequency up
        #[arg(long, value_name = "N", default_value = "10", value_parser = clap::value_parser!(u16).range(1..))]
        count: u16,
        /// Print JSON with shapes and every number in full
        #[arg(long)]
        json: bool,
        /// Folder for modes.svg, a figure of the lowest modes; made where it is missing
        #[arg(short, long, value_name = "DIR")]
        output: Option<PathBuf>,
        #[command(flatten)]
        host: FromHost,
    },
    /// Run in time with the scene's motion: CSV, ParaView files, figures, report
    Run {
        /// Scene of moorline, or deck of MoorDyn or MAP++
        scene: PathBuf,
        /// Folder for the results; made where it is missing
        #[arg(short, long, value_name = "DIR")]
        output: PathBuf,
        /// Drive the run as a host does: set the motion at every multiple of H [s], then step by H; a row of results each. With input_reconstruction = "interpolate" the motion set is that of the end of the step
        #[arg(long, value_name = "H", value_parser = cli::positive_number)]
        communication_step: Option<f64>,
        /// Set velocities beside displacements
        #[arg(long, requires = "communication_step")]
        velocities: bool,
        #[command(flatten)]
        moved: Moved,
        #[command(flatten)]
        host: FromHost,
    },
    /// Write a MoorDyn or MAP++ file as a scene with comments
    Convert {
        /// MoorDyn or MAP++ file
        deck: PathBuf,
        /// The scene
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
        #[command(flatten)]
        host: FromHost,
    },
    /// Package a scene as an FMU for co-simulation
    Fmu {
        /// Scene of moorline, or deck of MoorDyn or MAP++
        scene: PathBuf,
        /// The .fmu file
        #[arg(short, long, value_name = "FILE")]
        output: PathBuf,
        /// Version of FMI
        #[arg(long, default_value = "2", value_name = "VERSION", value_parser = ["2", "3"])]
        fmi: String,
        #[command(flatten)]
        host: FromHost,
    },
    /// Speed against error on this machine: meshes, integrators and steps against a converged solution
    Accuracy {
        /// Scenes of moorline, or decks of MoorDyn or MAP++; the five public scenes where none is given
        scenes: Vec<PathBuf>,
        /// Folder for tables and figures; made where it is missing
        #[arg(short, long, value_name = "DIR", default_value = "moorline-accuracy")]
        output: PathBuf,
        /// Run MoorDyn and CableDyn too, in the same run on the same core; PYTHON is an interpreter, or the folder of a virtual
        /// environment, that can import moordyn and cabledyn
        #[arg(long, value_name = "PYTHON")]
        peers: Option<PathBuf>,
        #[command(flatten)]
        moved: Moved,
        #[command(flatten)]
        host: FromHost,
    },
    /// Package the built-in scene as an FMU, drive it as a host does, show what comes out
    Demo {
        /// Folder for the results; made where it is missing
        #[arg(short, long, value_name = "DIR", default_value = "moorline-demo")]
        output: PathBuf,
    },
}

/// What a deck of another program leaves to its host.
#[derive(Debug, Args)]
struct FromHost {
    /// Water depth D [m], where a deck leaves it to its host
    #[arg(long, value_name = "D", value_parser = cli::positive_number)]
    depth: Option<f64>,
    /// Reference position of a vessel [m], where a deck leaves it to its host; may be given several times
    #[arg(long, value_name = "NAME=X,Y,Z", value_parser = cli::convert::placed_vessel)]
    at: Vec<(String, [f64; 3])>,
    /// Join all coupled points of a deck to one vessel of this name, with its origin at (0, 0, 0)
    #[arg(long, value_name = "NAME")]
    vessel: Option<String>,
}

impl From<FromHost> for Supplement {
    fn from(host: FromHost) -> Self {
        Supplement {
            depth: host.depth,
            positions: host.at.into_iter().collect(),
            vessel: host.vessel,
        }
    }
}

/// What moves in a run, in place of what the scene says.
#[derive(Debug, Args)]
struct Moved {
    /// Motion in a CSV file: time,x,y,z[,roll,pitch,yaw] of the one vessel or of all coupled points, or time and columns such
    /// as platform.x
    #[arg(long, value_name = "FILE")]
    motion: Option<PathBuf>,
    /// Regular motion of a vessel or coupled point: amplitude [m, rad], period [s], phase [rad]; may be given several times
    #[arg(long = "move", value_name = "BODY.AXIS=A,T[,PHASE]")]
    regular: Vec<RegularMotion>,
    /// Let the regular motion grow for R [s]
    #[arg(long, value_name = "R", value_parser = cli::positive_number, requires = "regular")]
    ramp: Option<f64>,
    /// End the run at T [s]; else with the motion file, or as the scene says
    #[arg(long, value_name = "T", value_parser = cli::positive_number)]
    duration: Option<f64>,
}

impl From<Moved> for Drive {
    fn from(moved: Moved) -> Self {
        Drive {
            file: moved.motion,
            regular: moved.regular,
            ramp: moved.ramp,
            duration: moved.duration,
        }
    }
}

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Check { scene, host } => cli::check::check(&scene, &host.into()),
        Command::Statics { scene, json, host } => cli::statics::statics(&scene, &host.into(), json),
        Command::Modes {
            scene,
            count,
            json,
            output,
            host,
        } => {
            let shown = Shown {
                count: usize::from(count),
                as_json: json,
                output: output.as_deref(),
            };
            cli::modes::modes(&scene, &host.into(), &shown)
        }
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
            cli::run::run(&scene, &host.into(), &moved.into(), &output, pace)
        }
        Command::Convert { deck, output, host } => cli::convert::convert(&deck, &output, &host.into()),
        Command::Fmu {
            scene,
            output,
            fmi,
            host,
        } => cli::fmu::fmu(&scene, &host.into(), &output, &fmi),
        Command::Accuracy {
            scenes,
            output,
            peers,
            moved,
            host,
        } => {
            let (host, moved) = (host.into(), moved.into());
            cli::accuracy::accuracy(&scenes, &host, &moved, &output, peers.as_deref())
        }
        Command::Demo { output } => cli::demo::demo(&output),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.tell(),
    }
}
