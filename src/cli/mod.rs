//! The commands, and what they share.

pub mod accuracy;
pub mod check;
pub mod convert;
pub mod demo;
mod failure;
pub mod fmu;
mod folder;
pub mod modes;
pub mod run;
pub mod statics;
mod summary;

use std::io::{self, Write};
use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};
use moorline::discretisation::discretised;
use moorline::scene::{LoadedScene, Note, Supplement, load_with};
use moorline::simulation::Simulation;

use failure::Failure;

/// Reads a scene file with what a deck leaves to its host; remarks on it go to standard error.
fn read_scene(path: &Path, supplement: &Supplement) -> Result<LoadedScene, Failure> {
    let loaded = load_with(path, supplement)?;
    loaded.notes.iter().for_each(|note| remark(path, note));
    Ok(loaded)
}

/// Says a remark on a scene on standard error. One that nobody can read is no reason to stop.
fn remark(path: &Path, note: &Note) {
    let _ = writeln!(io::stderr(), "{}", noted(path, note));
}

/// A remark with its file and, where it has one, its line.
fn noted(path: &Path, note: &Note) -> String {
    match note.line {
        Some(line) => format!("note: {}:{line}: {note}", path.display()),
        None => format!("note: {}: {note}", path.display()),
    }
}

/// Remarks that were found after the scene was read.
fn remark_all(loaded: &LoadedScene, notes: Vec<Note>) {
    for note in notes {
        remark(&loaded.path, &loaded.locate_note(note));
    }
}

/// The simulation of a scene, in static equilibrium.
fn simulate(loaded: &LoadedScene) -> Result<Simulation, Failure> {
    Simulation::new(&discretised(&loaded.scene)).map_err(|error| Failure::of_simulation(error, loaded))
}

/// Prints text to standard output.
fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .map_err(Failure::Print)
}

/// A bar on a terminal, nothing in a pipe.
fn progress(steps: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {eta} left")
        .expect("the template is a constant that indicatif accepts");
    ProgressBar::new(steps).with_style(style)
}

/// Reads a positive, finite number.
pub fn positive_number(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number > 0.0 && number.is_finite() => Ok(number),
        Ok(_) => Err("must be positive and finite".to_string()),
        Err(_) => Err("is not a number".to_string()),
    }
}
