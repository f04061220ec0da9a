//! Choices that a host of MoorDyn's interface cannot make through it, from environment variables.
//!
//! | variable | words | default |
//! |---|---|---|
//! | `MOORLINE_FORCE` | `nodal`: force of the lumped end node without its inertia; `reaction`: the load on the support, with it | `nodal` |
//! | `MOORLINE_LAWS` | `moordyn`: damping acts in compression, contact as given in the deck; `moorline`: neither | `moordyn` |
//! | `MOORLINE_PATH` | `jump`: constant velocity from where the host is, as in MoorDyn, with a jump at the start of the step; `smooth`: a C1 path through the ends of the same steps; `predict`: the C1 path of moorline's own hosts | `jump` |
//! | `MOORLINE_TOLERANCE` | target error of the fairlead tension by the time steps, 1e-12 to 0.5 | `0.005` |

use moorline::scene::{ContactLaw, Reconstruction, Scene};

use crate::failure::{Code, Failure, Outcome};

/// Meaning of the force on a coupled object.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Force {
    /// Sum of the forces on the lumped end nodes, without their inertia.
    #[default]
    Nodal,
    /// Load on the support, with the inertia of the end nodes.
    Reaction,
}

/// Laws of slack lines and of contact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Laws {
    /// Those of MoorDyn.
    #[default]
    Moordyn,
    /// Those of moorline.
    Moorline,
}

/// Path of coupled objects within a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Path {
    /// Constant velocity from the position that the host gives, with a jump at the start of the step.
    #[default]
    Jump,
    /// C1 through the positions that constant velocities reach at the ends of the steps.
    Smooth,
    /// C1 towards a predicted position.
    Predict,
}

/// All choices.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Meaning of forces.
    pub force: Force,
    /// Laws.
    pub laws: Laws,
    /// Paths.
    pub path: Path,
    /// Target error of the fairlead tension by the time steps [-].
    pub tolerance: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            force: Force::default(),
            laws: Laws::default(),
            path: Path::default(),
            tolerance: 0.005,
        }
    }
}

impl Settings {
    /// Reads the choices from variables by their names.
    ///
    /// # Errors
    /// A word that is none of those known.
    pub fn read(variable: impl Fn(&str) -> Option<String>) -> Outcome<Settings> {
        let tolerance = variable("MOORLINE_TOLERANCE").map_or(Ok(0.005), |text| {
            let number = text.trim().parse::<f64>().ok();
            number
                .filter(|value| (1e-12..=0.5).contains(value))
                .ok_or_else(|| unknown("MOORLINE_TOLERANCE", &text, "a number from 1e-12 to 0.5"))
        })?;
        let of = |name: &str| (name.to_string(), variable(name));
        Ok(Settings {
            force: choice(
                of("MOORLINE_FORCE"),
                &[("nodal", Force::Nodal), ("reaction", Force::Reaction)],
            )?,
            laws: choice(
                of("MOORLINE_LAWS"),
                &[("moordyn", Laws::Moordyn), ("moorline", Laws::Moorline)],
            )?,
            path: choice(
                of("MOORLINE_PATH"),
                &[
                    ("jump", Path::Jump),
                    ("smooth", Path::Smooth),
                    ("predict", Path::Predict),
                ],
            )?,
            tolerance,
        })
    }

    /// Writes the choices to a scene.
    pub fn apply(&self, scene: &mut Scene) {
        scene.solver.tolerance = self.tolerance;
        scene.solver.input_reconstruction = match self.path {
            Path::Smooth => Reconstruction::Interpolate,
            Path::Jump => Reconstruction::Jump,
            Path::Predict => Reconstruction::Smooth,
        };
        if self.laws == Laws::Moordyn {
            scene.solver.negative_tension = true;
            if let Some(seabed) = &mut scene.seabed {
                seabed.contact = ContactLaw::AsGiven;
            }
        }
    }
}

fn unknown(name: &str, text: &str, known: &str) -> Failure {
    Failure::new(
        Code::InvalidInput,
        format!("the environment variable {name} is {text:?}: it takes {known}"),
    )
}

fn choice<T: Copy + Default>((name, given): (String, Option<String>), words: &[(&str, T)]) -> Outcome<T> {
    let Some(text) = given else {
        return Ok(T::default());
    };
    let found = words.iter().find(|(word, _)| *word == text.trim());
    found.map(|(_, value)| *value).ok_or_else(|| {
        let known: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        unknown(&name, &text, &known.join(" or "))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_that_are_not_known_are_refused_with_those_that_are() {
        let none = Settings::read(|_| None).unwrap();
        assert_eq!(none, Settings::default());
        let given = |name: &str| (name == "MOORLINE_FORCE").then(|| "reaction".to_string());
        assert_eq!(Settings::read(given).unwrap().force, Force::Reaction);
        for (name, word) in [
            ("MOORLINE_FORCE", "kN"),
            ("MOORLINE_PATH", ""),
            ("MOORLINE_TOLERANCE", "2"),
        ] {
            let given = |other: &str| (other == name).then(|| word.to_string());
            let message = Settings::read(given).unwrap_err().message;
            assert!(message.contains(name) && message.contains("takes"), "{message}");
        }
    }
}
