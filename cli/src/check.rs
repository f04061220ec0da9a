//! `moorline check`: what a scene models, in words.

use std::fmt::Write;
use std::path::Path;

use moorline::discretisation;
use moorline::dynamics::Choice;
use moorline::interface::{Causality, Interface, Layout};
use moorline::model::Model;
use moorline::output::channels::Channels;
use moorline::scene::{Scene, TOML};
use moorline::simulation::{Simulation, Watch};
use moorline_decks::{Supplement, load_with};

use crate::failure::Failure;
use crate::terminal::{noted, print};

/// Reads a scene, makes it discrete, and says what it models, what surprises, and which variables a host finds.
pub fn check(path: &Path, supplement: &Supplement) -> Result<(), Failure> {
    let loaded = load_with(path, supplement)?;
    let located = |mistake| Failure::of_scene(mistake, &loaded);
    let settled = discretisation::select(&loaded.scene);
    let scene = settled.as_ref().map_or(&loaded.scene, |found| &found.scene);
    let model = Model::new(scene).map_err(located)?;
    let interface = Interface::new(scene, &model, Layout::Arrays).map_err(located)?;
    Channels::new(scene, &model).map_err(located)?;
    let mut text = String::new();
    if loaded.format != TOML {
        writeln!(text, "read as a {} file", loaded.format).expect("a string takes any text");
    }
    text.push_str(&loaded.scene.in_words());
    text.push_str("elements\n");
    let chosen = settled.iter().flat_map(|found| found.in_words());
    let chosen = model.mesh_in_words(scene).into_iter().chain(chosen);
    let (simulation, failure) = match Simulation::new(scene) {
        Ok(simulation) => (Some(simulation), None),
        Err(error) => (None, Some(Failure::of_simulation(error, &loaded))),
    };
    let steps = simulation
        .iter()
        .flat_map(|started| steps_in_words(scene, started));
    for line in chosen.chain(steps) {
        writeln!(text, "  {line}").expect("a string takes any text");
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
            writeln!(text, "  {role}: {name} [{unit}], {}", variable.description)
                .expect("a string takes any text");
        }
    }
    let at_rest = simulation
        .iter()
        .flat_map(|started| Watch::new(scene, started).look(started));
    let chosen = simulation.iter().flat_map(Simulation::choices);
    let idle = match simulation {
        Some(_) => loaded.scene.idle_with(chosen.map(|choice| choice.integrator)),
        None => Vec::new(),
    };
    let later = at_rest.chain(idle).chain(loaded.scene.advice());
    let later = later.map(|note| loaded.locate_note(note));
    for note in loaded.notes.iter().cloned().chain(later) {
        writeln!(text, "{}", noted(path, &note)).expect("a string takes any text");
    }
    print(&text)?;
    failure.map_or(Ok(()), Err) // a scene without an equilibrium can be described, but not run
}

/// Integrator and step of every network, each in a sentence once.
fn steps_in_words(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let mut said: Vec<String> = simulation.choices().map(Choice::in_words).collect();
    said.dedup();
    let threads = simulation.threads_in_words(scene.output.interval);
    said.push(format!("lines on {threads}"));
    said
}
