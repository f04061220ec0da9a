//! Settings that a host cannot make through MoorDyn's interface, from environment variables.
//!
//! | variable | words | default |
//! |---|---|---|
//! | `MOORLINE_FORCE` | `nodal`: force on the lumped end node without its inertia; `reaction`: the load on the support, including this inertia | `nodal` |
//! | `MOORLINE_LAWS` | `moordyn`: damping acts in compression, contact as given in the deck at the nodes; `moorline`: neither | `moordyn` |
//! | `MOORLINE_PATH` | `jump`: constant velocity from the host's position, as in MoorDyn, with a jump at the start of the step; `smooth`: a C1 path through the ends of the same steps; `predict`: the C1 path of moorline's own hosts | `jump` |
//! | `MOORLINE_TOLERANCE` | target error of the fairlead tension from the time steps, 1e-12 to 0.5 | `0.005` |

use moorline::physics::tension_table::TensionTable;
use moorline::scene::{ContactLaw, LineType, Reconstruction, Scene};

use crate::failure::{Code, Failure, Outcome};

/// Half-width of a corner of the tension curve, relative to the shorter adjacent interval [-].
const CORNER: f64 = 1e-3;

/// Definition of the force on a coupled object.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Force {
    /// Sum of the forces on the lumped end nodes, without their inertia.
    #[default]
    Nodal,
    /// Load on the support, with the inertia of the end nodes.
    Reaction,
}

/// Laws for slack lines, contact, and tension between the rows of a table.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Laws {
    /// Laws of MoorDyn.
    #[default]
    Moordyn,
    /// Laws of moorline.
    Moorline,
}

/// Path of coupled objects within a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Path {
    /// Constant velocity from the position that the host gives, with a jump at the start of the step.
    #[default]
    Jump,
    /// C1 path through the positions that constant velocities reach at the ends of the steps.
    Smooth,
    /// C1 path towards a predicted position.
    Predict,
}

/// All settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Definition of the force.
    pub force: Force,
    /// Laws of lines and contact.
    pub laws: Laws,
    /// Path within a step.
    pub path: Path,
    /// Target error of the fairlead tension from the time steps [-].
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
    /// Reads the settings from variables by name.
    ///
    /// # Errors
    /// A value is not allowed.
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

    /// Applies the settings to a scene.
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
                seabed.contact = ContactLaw::AtNodes;
            }
            scene.line_types.values_mut().for_each(straighten);
        }
    }
}

/// Makes the tension of a line type linear between the rows of its table, as in MoorDyn, and keeps its damping.
fn straighten(line_type: &mut LineType) {
    let Some(table) = &mut line_type.tension_strain else {
        return;
    };
    if table.rows.len() < 2 {
        return; // refused when the simulation is built
    }
    let (_, before) = TensionTable::through(&table.rows);
    table.rows = with_corners(&table.rows);
    let (_, steepest) = TensionTable::through(&table.rows);
    if let Some(ratio) = &mut line_type.damping_ratio {
        *ratio *= (before / steepest).sqrt();
    }
}

/// Inserts two rows of strain [-] and tension [N] next to each inner row, so that the smooth curve through all rows is straight except at corners.
fn with_corners(rows: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut all = vec![rows[0]];
    for three in rows.windows(3) {
        let [before, row, after] = [three[0], three[1], three[2]];
        let reach = CORNER * (row[0] - before[0]).min(after[0] - row[0]);
        let towards = |other: [f64; 2]| {
            let part = reach / (other[0] - row[0]).abs();
            [0, 1].map(|column| row[column] + part * (other[column] - row[column]))
        };
        all.extend([towards(before), row, towards(after)]);
    }
    all.push(rows[rows.len() - 1]);
    all
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
    fn tension_is_straight_between_the_rows_of_a_table() {
        let rows = [[0.0, 0.0], [0.01, 1e5], [0.05, 1.5e6], [0.08, 1.8e6]];
        let (curve, scale) = TensionTable::through(&with_corners(&rows));
        for pair in rows.windows(2) {
            for part in [0.01, 0.3, 0.5, 0.99] {
                let [strain, tension] =
                    [0, 1].map(|column| pair[0][column] + part * (pair[1][column] - pair[0][column]));
                let off = (scale * curve.at(strain).force / tension - 1.0).abs();
                assert!(off < 1e-9, "{off} at {strain}");
            }
        }
        let two = [[0.0, 0.0], [0.1, 2e6]];
        assert_eq!(with_corners(&two), two);
    }

    #[test]
    fn a_damping_ratio_refers_to_the_last_row_of_a_table() {
        let mut rope = LineType {
            mass: Some(18.0),
            damping_ratio: Some(0.5),
            ..LineType::default()
        };
        let mut table = moorline::scene::TensionStrain::from_file("rope.txt");
        table.rows = vec![[0.0, 0.0], [0.05, 5e5], [0.1, 2.5e6]];
        rope.tension_strain = Some(table);
        let damping = |rope: &LineType| {
            let rows = &rope.tension_strain.as_ref().expect("it has a table").rows;
            let (_, steepest) = TensionTable::through(rows);
            rope.damping_ratio.expect("it has a ratio") * steepest.sqrt()
        };
        let before = damping(&rope);
        straighten(&mut rope);
        assert!((damping(&rope) / before - 1.0).abs() < 1e-12);
    }

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
