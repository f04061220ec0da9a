//! `moorline modes`: natural periods and shapes about the static equilibrium, as a table, as JSON and as a figure.

use std::path::Path;

use moorline::output::figures;
use moorline::output::json;
use moorline::output::modes::{Mode, NaturalModes, natural_modes};
use moorline::output::report::rounded;
use moorline::output::write_file;
use moorline::scene::Integrator;
use moorline::statics::modes::ModesError;

use crate::arguments::Input;
use crate::failure::Failure;
use crate::folder::Folder;
use crate::summary::Table;
use crate::terminal::{at_rest, print, read_scene};

/// Digits of periods and frequencies [-].
const DIGITS: usize = 6;

/// Options of the command.
#[derive(Debug)]
pub(crate) struct Shown<'a> {
    /// Number of modes of all lines together.
    pub count: usize,
    /// True to print JSON instead of a table.
    pub as_json: bool,
    /// Folder for the figure.
    pub output: Option<&'a Path>,
}

/// Finds the lowest modes, prints them and draws them.
pub(crate) fn modes(input: &Input, shown: &Shown) -> Result<(), Failure> {
    let mut loaded = read_scene(&input.scene, &input.host.supplement())?;
    if let Some(water) = &mut loaded.scene.water {
        water.waves = None; // the equilibrium is that in still water
    }
    if loaded.scene.solver.integrator == Integrator::QuasiStatic {
        loaded.scene.solver.integrator = Integrator::Leapfrog; // elements at rest, not catenaries
    }
    let folder = shown.output.map(Folder::open).transpose()?;
    let simulation = at_rest(&mut loaded)?;
    let found =
        natural_modes(&loaded.scene.title, &simulation, shown.count).map_err(|error| match error {
            ModesError::Beam { .. } | ModesError::NoMass { .. } => Failure::Argument(error.to_string()),
            ModesError::Unstable { .. } => Failure::Computation(error.to_string()),
        })?;
    if let (Some(output), Some(svg)) = (shown.output, figures::modes::modes(&found)) {
        write_file(&output.join("modes.svg"), |file| file.write_all(svg.as_bytes()))?;
    }
    drop(folder);
    if shown.as_json {
        return print(&json::text(&found));
    }
    print(&table(&found))
}

/// Table of the modes for the terminal.
fn table(found: &NaturalModes) -> String {
    let head = [
        "natural mode",
        "period [s]",
        "frequency [Hz]",
        "direction",
        "moves most at",
    ];
    let mut table = Table::new(&head).ending_in_words();
    for (index, mode) in found.modes.iter().enumerate() {
        let period = mode
            .period
            .map_or("-".to_string(), |period| rounded(period, DIGITS));
        table.text_row(vec![
            (index + 1).to_string(),
            period,
            rounded(mode.frequency, DIGITS),
            direction(mode),
            place(mode),
        ]);
    }
    let title = match found.title.is_empty() {
        true => String::new(),
        false => format!("{}\n\n", found.title),
    };
    format!(
        "{title}{table}\nabout the static equilibrium, added mass included, without drag and damping; seabed and slack as at rest\n"
    )
}

fn direction(mode: &Mode) -> String {
    let (direction, share) = mode.shares.greatest();
    format!(
        "{} ({} %)",
        direction.words(),
        rounded((100.0 * share).round(), 3)
    )
}

fn place(mode: &Mode) -> String {
    let at = &mode.greatest;
    match &at.point {
        Some(point) => format!("point \"{point}\""),
        None => format!(
            "line \"{}\", node {} (s = {} m)",
            at.line,
            at.node,
            rounded(at.s, 4)
        ),
    }
}
