//! Parameters of a scene: numbers and choices of the property table that a host may change before the simulation starts.

use super::rows::row;
use super::{Binding, Causality, Kind, Unit, Variable};
use crate::scene::table::{self, Key, Table, Value};
use crate::scene::{Line, LineType, Scene, Seabed, Section, Solver, Water};

/// A parameter of the scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parameter {
    /// Table of the scene.
    pub place: Place,
    /// Key of the table.
    pub key: &'static str,
}

/// A table of a scene that has parameters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// A line type by name.
    LineType(String),
    /// A section of a line.
    Section {
        /// The line.
        line: usize,
        /// The section of the line.
        section: usize,
    },
    /// The water.
    Water,
    /// The seabed.
    Seabed,
    /// The scene itself.
    Scene,
    /// The solver settings.
    Solver,
}

impl Parameter {
    /// Value in a scene, in its unit; `None` if the scene does not contain the key.
    pub fn value(&self, scene: &Scene) -> Option<f64> {
        let key = self.key;
        let value = match &self.place {
            Place::LineType(name) => scene.line_types.get(name)?.get(key),
            Place::Section { line, section } => scene.lines.get(*line)?.sections.get(*section)?.get(key),
            Place::Water => scene.water.as_ref()?.get(key),
            Place::Seabed => scene.seabed.as_ref()?.get(key),
            Place::Scene => scene.get(key),
            Place::Solver => scene.solver.get(key),
        };
        value?.number()
    }

    fn value_mut<'s>(&self, scene: &'s mut Scene) -> Option<&'s mut dyn Value> {
        let key = self.key;
        match &self.place {
            Place::LineType(name) => scene.line_types.get_mut(name)?.get_mut(key),
            Place::Section { line, section } => scene
                .lines
                .get_mut(*line)?
                .sections
                .get_mut(*section)?
                .get_mut(key),
            Place::Water => scene.water.as_mut()?.get_mut(key),
            Place::Seabed => scene.seabed.as_mut()?.get_mut(key),
            Place::Scene => scene.get_mut(key),
            Place::Solver => scene.solver.get_mut(key),
        }
    }

    /// Sets the parameter in a scene that contains it.
    ///
    /// # Errors
    /// The accepted numbers, if the number denotes no choice. Bounds are left to [`Scene::check`].
    pub fn set(&self, scene: &mut Scene, value: f64) -> Result<(), String> {
        self.value_mut(scene)
            .map_or(Ok(()), |target| target.set_number(value))
    }
}

/// Variables of all parameters that the scene gives.
pub(super) fn variables(scene: &Scene) -> Vec<Variable> {
    let mut variables = Vec::new();
    let mut add = |place: Place, keys: &'static [Key], names: (&str, &str), about: &str| {
        // with soundings, the depth is only that of the waves
        let rests = |key: &Key| place == Place::Seabed && key.name() == "depth" && scene.has_idle_depth();
        let parameters = keys.iter().filter(|key| key.rule.is_parameter && !rests(key));
        variables.extend(parameters.filter_map(|key| variable(scene, &place, key, names, about)));
    };
    for name in scene.line_types.keys() {
        let place = Place::LineType(name.clone());
        add(place, LineType::SCHEMA.keys, (name, &format!("{name}.")), "");
    }
    for (line, described) in scene.lines.iter().enumerate() {
        let Line { name, sections, .. } = described;
        for section in 0..sections.len() {
            let number = section + 1;
            let (prefix, about) = match sections.len() {
                1 => (format!("{name}."), String::new()),
                _ => (
                    format!("{name}.section{number}."),
                    format!(" of section {number}, counted from end A"),
                ),
            };
            let place = Place::Section { line, section };
            add(place, Section::SCHEMA.keys, (name, &prefix), &about);
        }
    }
    add(Place::Water, Water::SCHEMA.keys, ("", "water."), "");
    add(Place::Seabed, Seabed::SCHEMA.keys, ("", "seabed."), "");
    add(Place::Scene, Scene::SCHEMA.keys, ("", ""), "");
    add(Place::Solver, Solver::SCHEMA.keys, ("", "solver."), "");
    variables
}

/// Variable of a key, if the scene gives it. `names` are the name of the owner and the prefix of the variable's name; `about` ends the description.
fn variable(
    scene: &Scene,
    place: &Place,
    key: &'static Key,
    (owner, prefix): (&str, &str),
    about: &str,
) -> Option<Variable> {
    let parameter = Parameter {
        place: place.clone(),
        key: key.name(),
    };
    let start = parameter.value(scene)?;
    let meaning = key.rule.described.map_or_else(|| key.meaning(), str::to_string);
    let description = match owner {
        "" => meaning,
        _ => format!("{owner}: {meaning}{about}"),
    };
    let name = format!("{prefix}{}", key.name());
    let unit = key.unit().map_or(Unit::ONE, Unit::of_scene);
    let binding = Binding::Parameter(parameter);
    let mut variable = row(name, description, Causality::Parameter, unit, binding);
    variable.range = key.rule.bounds.range();
    if let table::Kind::Words(words) = key.kind() {
        variable.kind = Kind::Int32;
        variable.range = [Some(0.0), Some(words.words.len() as f64 - 1.0)];
    }
    variable.start = Some(start);
    Some(variable)
}
