//! Input and output of all commands: scenes, remarks, results, progress.

use std::io::{self, Write};
use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};
use moorline::discretisation::{self, Discretisation};
use moorline::scene::{LoadedScene, Note, Scene};
use moorline::simulation::Simulation;
use moorline_decks::{Supplement, load_with};

use crate::failure::Failure;

/// Reads a scene file with the data that a deck leaves to its host; remarks on it go to standard error.
pub(crate) fn read_scene(path: &Path, supplement: &Supplement) -> Result<LoadedScene, Failure> {
    let loaded = load_with(path, supplement)?;
    loaded.notes.iter().for_each(|note| remark(path, note));
    Ok(loaded)
}

/// Writes a remark on a scene, or on another file, to standard error. A remark that cannot be written does not end the command.
pub(crate) fn remark(path: &Path, note: &Note) {
    let _ = writeln!(io::stderr(), "{}", noted(path, note));
}

/// A remark with its file and, where it has one, its line.
pub(crate) fn noted(path: &Path, note: &Note) -> String {
    match note.line {
        Some(line) => format!("note: {}:{line}: {note}", path.display()),
        None => format!("note: {}: {note}", path.display()),
    }
}

/// Remarks that were found after the scene was read.
pub(crate) fn remark_all(loaded: &LoadedScene, notes: Vec<Note>) {
    for note in notes {
        remark(&loaded.path, &loaded.locate_note(note));
    }
}

/// Gives a scene the mesh, integrator and step that it leaves open, once for all that a command does with it. Remarks where they are not
/// expected to keep the tolerance.
pub(crate) fn discretise(loaded: &mut LoadedScene, select: fn(&Scene) -> Option<Discretisation>) {
    if let Some(found) = select(&loaded.scene) {
        take(loaded, found);
    }
}

/// Gives a scene the mesh that its equilibrium needs, and solves that; remarks as [`discretise`].
pub(crate) fn at_rest(loaded: &mut LoadedScene) -> Result<Simulation, Failure> {
    match discretisation::at_rest(&loaded.scene) {
        Ok((found, simulation)) => {
            found.into_iter().for_each(|found| take(loaded, found));
            Ok(simulation)
        }
        Err(error) => Err(Failure::of_simulation(error, loaded)),
    }
}

fn take(loaded: &mut LoadedScene, found: Discretisation) {
    let notes = found.shortfalls().into_iter();
    let notes = notes.map(|text| Note::new("solver.tolerance".to_string(), text));
    remark_all(loaded, notes.collect());
    loaded.scene = found.scene;
}

/// The simulation of a scene, in static equilibrium.
pub(crate) fn simulate(loaded: &LoadedScene) -> Result<Simulation, Failure> {
    Simulation::new(&loaded.scene).map_err(|error| Failure::of_simulation(error, loaded))
}

/// Prints text to standard output.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .map_err(Failure::Print)
}

/// A bar on a terminal, nothing in a pipe.
pub(crate) fn progress(steps: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {eta} left")
        .expect("the template is a constant that indicatif accepts");
    ProgressBar::new(steps).with_style(style)
}
