//! `moorline check`: what a scene models, in words.

use std::fmt::Write;
use std::path::Path;

use moorline::interface::{Causality, Interface, Layout};
use moorline::model::Model;
use moorline::output::channels::Channels;
use moorline::scene::{Supplement, TOML, load_with};

use super::failure::Failure;
use super::print;

/// Reads a scene, makes it discrete, and says what it models, what surprises, and which variables a host finds.
pub fn check(path: &Path, supplement: &Supplement) -> Result<(), Failure> {
    let loaded = load_with(path, supplement)?;
    let located = |mistake| Failure::of_scene(mistake, &loaded);
    let model = Model::new(&loaded.scene).map_err(located)?;
    let interface = Interface::new(&loaded.scene, &model, Layout::Arrays).map_err(located)?;
    Channels::new(&loaded.scene, &model).map_err(located)?;
    let mut text = String::new();
    if loaded.format != TOML {
        writeln!(text, "read as a {} file", loaded.format).expect("a string takes any text");
    }
    text.push_str(&loaded.scene.in_words());
    text.push_str("elements\n");
    for line in model.mesh_in_words(&loaded.scene) {
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
