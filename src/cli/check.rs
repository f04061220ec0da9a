//! `moorline check`: what a scene models, in words.

use std::fmt::Write;
use std::path::Path;

use moorline::dynamics::Choice;
use moorline::interface::{Causality, Interface, Layout};
use moorline::model::Model;
use moorline::output::channels::Channels;
use moorline::scene::{Scene, Supplement, TOML, load_with};
use moorline::simulation::{Simulation, pilot};

use super::failure::Failure;
use super::print;

/// Reads a scene, makes it discrete, and says what it models, what surprises, and which variables a host finds.
pub fn check(path: &Path, supplement: &Supplement) -> Result<(), Failure> {
    let loaded = load_with(path, supplement)?;
    let located = |mistake| Failure::of_scene(mistake, &loaded);
    let settled = pilot::settle(&loaded.scene);
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
    for line in chosen.chain(steps_in_words(scene)) {
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
    for note in &loaded.notes {
        writeln!(text, "note: {note}").expect("a string takes any text");
    }
    print(&text)
}

/// Integrator and step of every network, each in a sentence once; nothing where the scene has no equilibrium to start from.
fn steps_in_words(scene: &Scene) -> Vec<String> {
    let Ok(simulation) = Simulation::new(scene) else {
        return Vec::new();
    };
    let mut said: Vec<String> = simulation.choices().map(Choice::in_words).collect();
    said.dedup();
    let threads = simulation.threads_in_words(scene.output.interval);
    said.push(format!("lines on {threads}"));
    said
}
