//! Arguments of the program.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use moorline::scene::{Drive, RegularMotion, name_problem};
use moorline_decks::Supplement;

/// Mooring-line dynamics: statics, time-domain runs, FMUs.
#[derive(Debug, Parser)]
#[command(name = "moorline", version, arg_required_else_help = true, after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    /// The command and its arguments.
    #[command(subcommand)]
    pub command: Command,
}

const EXIT_CODES: &str =
    "Exit codes: 0 done, 2 the input is wrong, 1 the computation failed, 130 interrupted.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Describe what a scene models and what it does not; find every mistake
    Check {
        /// Write the selected elements, integrator and step to the scene file, so that later commands run no trials
        #[arg(long)]
        write: bool,
        #[command(flatten)]
        input: Input,
    },
    /// Static equilibrium: forces, shape, sag, length on the seabed
    Statics {
        /// Print JSON, with all digits of every number
        #[arg(long)]
        json: bool,
        #[command(flatten)]
        input: Input,
    },
    /// Natural periods and shapes of lines and networks about the static equilibrium
    ///
    /// Added mass is included; drag, damping and waves are not. Contact and slack are those of the equilibrium: seabed springs act under
    /// the nodes that rest on them, and slack segments have no stiffness.
    Modes {
        #[command(flatten)]
        input: Input,
        /// Number of modes of all lines together, from the lowest frequency up
        #[arg(long, value_name = "N", default_value = "10", value_parser = clap::value_parser!(u16).range(1..))]
        count: u16,
        /// Print JSON with shapes, and with all digits of every number
        #[arg(long)]
        json: bool,
        /// Folder for modes.svg, a figure of the lowest modes; created if missing
        #[arg(short, long, value_name = "DIR")]
        output: Option<PathBuf>,
    },
    /// Time-domain run with the scene's motion: tables, ParaView files, figures, report
    ///
    /// Tables and shapes are written during the run. Ctrl-C ends the run after the current step; DIR then contains the results so far and a saved
    /// state. The state is also saved every minute.
    Run {
        /// Folder for the results; created if missing
        #[arg(short, long, value_name = "DIR")]
        output: PathBuf,
        /// Drive the run as a host does: set the motion at every multiple of H [s], step by H and write a row. With input_reconstruction = "interpolate" the motion is that at the end of the step
        #[arg(long, value_name = "H", value_parser = positive_number)]
        communication_step: Option<f64>,
        /// With --communication-step, set velocities as well as displacements
        #[arg(long, requires = "communication_step")]
        velocities: bool,
        /// Continue the interrupted run in DIR from its saved state, to the same rows as an uninterrupted run
        #[arg(long)]
        resume: bool,
        /// Stop at T [s] and save the state, as if interrupted there
        #[arg(long, value_name = "T", value_parser = positive_number)]
        until: Option<f64>,
        #[command(flatten)]
        moved: Moved,
        #[command(flatten)]
        input: Input,
    },
    /// Run load cases, with other values of the scene's keys, on all cores
    ///
    /// CASES is CSV (one case per row) or TOML (all combinations of its lists); its columns are keys of the scene by path, such as water.waves.peak_period,
    /// lines.line1.length or seed, and motion files. With the same input, an interrupted or killed sweep continues where it stopped.
    Sweep {
        #[command(flatten)]
        base: Input,
        /// Case file
        cases: PathBuf,
        /// Folder for the table and the journal; created if missing
        #[arg(short, long, value_name = "DIR")]
        output: PathBuf,
        /// Start of the statistics, T [s]; by default the end of the ramps of motions and waves
        #[arg(long, value_name = "T", value_parser = time)]
        from: Option<f64>,
        /// Also keep the time series of every case
        #[arg(long)]
        series: bool,
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
    ///
    /// If SOURCE_DATE_EPOCH is set in the environment, its date is written into the description. Otherwise there is no date; the same scene then gives
    /// the same bytes.
    Fmu {
        #[command(flatten)]
        packaging: Packaging,
        /// Replay the reference results in an FMU, which is given instead of the scene; exit code 1 if they are not reproduced
        #[arg(long, conflicts_with_all = ["output", "author", "ssp"])]
        verify: bool,
    },
    /// Speed against error on this machine: meshes, integrators and steps against a converged solution
    Accuracy {
        /// Scenes of moorline, or decks of MoorDyn or MAP++; the public scenes if none is given
        scenes: Vec<PathBuf>,
        /// Folder for tables and figures; created if missing
        #[arg(short, long, value_name = "DIR", default_value = "moorline-accuracy")]
        output: PathBuf,
        /// Keep the results of other scenes in DIR, and add these scenes to its tables and figures
        #[arg(long)]
        add: bool,
        /// Also run MoorDyn and CableDyn, on the same core; PYTHON is an interpreter, or the folder of a virtual
        /// environment, that can import moordyn and cabledyn
        #[arg(long, value_name = "PYTHON")]
        peers: Option<PathBuf>,
        #[command(flatten)]
        moved: Moved,
        #[command(flatten)]
        host: FromHost,
    },
    /// Package the built-in scene as an FMU, drive it as a host does, and show the results
    Demo {
        /// Folder for the results; created if missing
        #[arg(short, long, value_name = "DIR", default_value = "moorline-demo")]
        output: PathBuf,
    },
    /// Print completions for a shell
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the manual page, or write the pages of all commands
    Man {
        /// Folder for the pages; created if missing
        #[arg(short, long, value_name = "DIR")]
        output: Option<PathBuf>,
    },
}

/// FMU to be packaged.
#[derive(Debug, Args)]
pub(crate) struct Packaging {
    /// The .fmu file
    #[arg(short, long, value_name = "FILE", required_unless_present = "verify")]
    pub output: Option<PathBuf>,
    /// Version of FMI
    #[arg(long, default_value = "2", value_name = "VERSION", value_parser = ["2", "3"])]
    pub fmi: String,
    /// Author of the model, for the description
    #[arg(long, value_name = "NAME")]
    pub author: Option<String>,
    /// Write a system of SSP 1.0 that contains the FMU, with connectors for the motion of the body and the force on it
    #[arg(long)]
    pub ssp: bool,
    #[command(flatten)]
    pub input: Input,
}

/// Input file, with the data that a deck leaves to its host.
#[derive(Debug, Args)]
pub(crate) struct Input {
    /// Scene of moorline, or deck of MoorDyn or MAP++
    pub scene: PathBuf,
    #[command(flatten)]
    pub host: FromHost,
}

/// Values that a deck of another program leaves to its host.
#[derive(Debug, Args)]
pub(crate) struct FromHost {
    /// Water depth D [m], if the deck leaves it to its host
    #[arg(long, value_name = "D", value_parser = positive_number)]
    depth: Option<f64>,
    /// Reference position of a vessel [m], if the deck leaves it to its host; may be given several times
    #[arg(long, value_name = "NAME=X,Y,Z", value_parser = placed_vessel)]
    at: Vec<(String, [f64; 3])>,
    /// Join all coupled points of a deck to one vessel of this name, with its origin at (0, 0, 0)
    #[arg(long, value_name = "NAME", value_parser = vessel_name)]
    vessel: Option<String>,
}

impl FromHost {
    /// Converts the values for the reader of decks.
    pub(crate) fn supplement(&self) -> Supplement {
        Supplement {
            depth: self.depth,
            positions: self.at.iter().cloned().collect(),
            vessel: self.vessel.clone(),
        }
    }
}

/// Motion of a run, in place of that in the scene.
#[derive(Debug, Args)]
pub struct Moved {
    /// Motion in a CSV file: time,x,y,z[,roll,pitch,yaw] of the one vessel or of all coupled points, or time and columns such
    /// as platform.x
    #[arg(long, value_name = "FILE")]
    motion: Option<PathBuf>,
    /// Regular motion of a vessel or coupled point: amplitude [m, rad], period [s], phase [rad]; may be given several times
    #[arg(long = "move", value_name = "BODY.AXIS=A,T[,PHASE]")]
    regular: Vec<RegularMotion>,
    /// Ramp of the regular motion, R [s]
    #[arg(long, value_name = "R", value_parser = positive_number, requires = "regular")]
    ramp: Option<f64>,
    /// End the run at T [s]; by default at the end of the motion file, or at the duration of the scene
    #[arg(long, value_name = "T", value_parser = positive_number)]
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

/// Reads a positive, finite number.
fn positive_number(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 0.0 && number.is_finite() => Ok(number),
        Ok(_) => Err("must be positive and finite".to_string()),
        Err(_) => Err("is not a number".to_string()),
    }
}

/// Reads a finite time that is not negative.
fn time(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number >= 0.0 && number.is_finite() => Ok(number),
        Ok(_) => Err("must be finite and not negative".to_string()),
        Err(_) => Err("is not a number".to_string()),
    }
}

/// Reads the name of a vessel.
fn vessel_name(text: &str) -> Result<String, String> {
    name_problem(text).map_or(Ok(text.to_string()), Err)
}

/// Reads `NAME=X,Y,Z`: a vessel and its reference position [m].
fn placed_vessel(text: &str) -> Result<(String, [f64; 3]), String> {
    let wanted = "must be NAME=X,Y,Z in metres";
    let (name, position) = text.split_once('=').ok_or(wanted)?;
    let numbers: Vec<f64> = position
        .split(',')
        .map(|part| {
            part.trim()
                .parse::<f64>()
                .ok()
                .filter(|number| number.is_finite())
        })
        .collect::<Option<_>>()
        .ok_or(wanted)?;
    let position = numbers.try_into().map_err(|_| wanted)?;
    Ok((name.trim().to_string(), position))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vessel_is_placed_by_name_and_three_numbers() {
        let placed = placed_vessel("turbine2=1600,0,-0.5");
        assert_eq!(placed, Ok(("turbine2".to_string(), [1600.0, 0.0, -0.5])));
        for wrong in [
            "turbine2",
            "turbine2=1,2",
            "a=1,2,3,4",
            "a=1,2,x",
            "a=1,2,nan",
            "",
        ] {
            assert!(placed_vessel(wrong).is_err(), "{wrong}");
        }
    }
}
