//! `moorline check`: description of a scene's model, in words.

use moorline::discretisation;
use moorline::interface::{Causality, Interface, Layout};
use moorline::model::Model;
use moorline::output::channels::Channels;
use moorline::scene::{Scene, TOML};
use moorline::simulation::{Simulation, Watch};
use moorline_decks::load_with;

use crate::arguments::Input;
use crate::failure::Failure;
use crate::hold;
use crate::terminal::{noted, print};

/// Reads a scene, discretises it, and prints a description of its model, notes on it, and the variables of its FMU. If `write` is set, also writes
/// the discretisation into the scene's file.
pub(crate) fn check(input: &Input, write: bool) -> Result<(), Failure> {
    let loaded = load_with(&input.scene, &input.host.supplement())?;
    if write {
        hold::check_format(&loaded)?;
    }
    let located = |mistake| Failure::of_scene(mistake, &loaded);
    let settled = discretisation::select(&loaded.scene);
    let scene = settled.as_ref().map_or(&loaded.scene, |found| &found.scene);
    let model = Model::new(scene).map_err(located)?;
    let interface = Interface::new(scene, &model, Layout::Arrays).map_err(located)?;
    Channels::new(scene, &model).map_err(located)?;
    let (simulation, failure) = match Simulation::new(scene) {
        Ok(simulation) => (Some(simulation), None),
        Err(error) => (None, Some(Failure::of_simulation(error, &loaded))),
    };
    let started = || simulation.iter();
    let mut text = String::new();
    if loaded.format != TOML {
        text.push_str(&format!("read as a {} file\n", loaded.format));
    }
    text.push_str(&loaded.scene.in_words());
    text.push_str("elements\n");
    let chosen = settled.iter().flat_map(|found| found.in_words());
    let chosen = model.mesh_in_words(scene).into_iter().chain(chosen);
    let steps = started().flat_map(|simulation| steps_in_words(scene, simulation));
    for line in chosen.chain(steps) {
        text.push_str(&format!("  {line}\n"));
    }
    text.push_str("\nvariables of the FMU\n");
    for (role, causality) in [
        ("in", Causality::Input),
        ("out", Causality::Output),
        ("at the start", Causality::CalculatedParameter),
    ] {
        let variables = interface.variables().iter();
        for variable in variables.filter(|variable| variable.causality == causality) {
            let (name, unit) = (&variable.name, variable.unit.name);
            text.push_str(&format!("  {role}: {name} [{unit}], {}\n", variable.description));
        }
    }
    let at_rest = started().flat_map(|simulation| Watch::new(scene, simulation).look(simulation));
    let interval = scene.output.interval;
    let expense = started().filter_map(|simulation| discretisation::expense(scene, simulation, interval));
    let later = at_rest.chain(expense).chain(loaded.scene.advice());
    let later = later.map(|note| loaded.locate_note(note));
    for note in loaded.notes.iter().cloned().chain(later) {
        text.push_str(&format!("{}\n", noted(&loaded.path, &note)));
    }
    print(&text)?;
    failure.map_or(Ok(()), Err)?; // a scene without an equilibrium can be described, but not run
    if !write {
        return Ok(());
    }
    let held = match settled {
        Some(found) => Some(found.scene),
        None => discretisation::by_rule(&loaded.scene),
    };
    print(&format!("\n{}\n", hold::hold(&loaded, held.as_ref())?))
}

/// Describes integrators with their steps, and threads, in a sentence each.
fn steps_in_words(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let mut said = simulation.choices_in_words();
    let threads = simulation.threads_in_words(scene.output.interval);
    said.push(format!("lines on {threads}"));
    said
}
