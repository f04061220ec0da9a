//! Parameters of a scene, with the names of the FMU.

use moorline::interface::{Binding, Interface, Layout, Variable};
use moorline::model::Model;
use moorline::scene::nearest::nearest;
use moorline::scene::{LoadedScene, Scene};

use crate::errors::Failure;

/// Returns the table of inputs, outputs and parameters of a scene.
pub(crate) fn interface(loaded: &LoadedScene) -> Result<Interface, Failure> {
    let scene = &loaded.scene;
    let made = Model::new(scene).and_then(|model| Interface::new(scene, &model, Layout::Scalars));
    made.map_err(|mistake| Failure::of_scene(mistake, loaded))
}

/// Returns names and values of all parameters.
pub(crate) fn values(loaded: &LoadedScene) -> Result<Vec<(String, f64)>, Failure> {
    let interface = interface(loaded)?;
    let value = |variable: &Variable| match &variable.binding {
        Binding::Parameter(parameter) => Some((variable.name.clone(), parameter.value(&loaded.scene)?)),
        _ => None,
    };
    Ok(interface.variables().iter().filter_map(value).collect())
}

/// Returns the scene with other values of some parameters.
///
/// # Errors
/// A name is not that of a parameter, or a value is not valid in the scene.
pub(crate) fn with_values(loaded: &LoadedScene, values: &[(String, f64)]) -> Result<Scene, Failure> {
    let mut scene = loaded.scene.clone();
    let interface = interface(loaded)?;
    for (name, value) in values {
        let variable = interface
            .variables()
            .iter()
            .find(|variable| variable.name == *name);
        let Some(Binding::Parameter(parameter)) = variable.map(|variable| &variable.binding) else {
            let parameters = interface.variables().iter();
            let parameters = parameters.filter(|variable| matches!(variable.binding, Binding::Parameter(_)));
            return Err(unknown(
                name,
                "parameter",
                parameters.map(|variable| variable.name.as_str()),
            ));
        };
        if !value.is_finite() {
            return Err(Failure::of_argument(
                name,
                format!("{value} is not a finite number"),
            ));
        }
        let set = parameter.set(&mut scene, *value);
        set.map_err(|problem| Failure::Input(name.clone(), problem))?;
    }
    check(scene)
}

/// Refuses a scene that a modification has made invalid.
pub(crate) fn check(scene: Scene) -> Result<Scene, Failure> {
    let mistakes = scene.mistakes();
    match mistakes.is_empty() {
        true => Ok(scene),
        false => Err(Failure::Scene(mistakes)),
    }
}

/// Returns the failure for an unknown name, with a suggestion.
pub(crate) fn unknown<'n>(name: &str, kind: &str, known: impl Iterator<Item = &'n str> + Clone) -> Failure {
    let suggestion = match nearest(name, known.clone()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => {
            let some: Vec<String> = known.take(6).map(|name| format!("`{name}`")).collect();
            match some.is_empty() {
                true => "the scene has none".to_string(),
                false => format!("there are {} …", some.join(", ")),
            }
        }
    };
    Failure::of_argument(name, format!("no such {kind}: {suggestion}"))
}
