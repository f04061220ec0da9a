//! Checks on a whole scene: values in range, names that exist, parts that fit together.

mod line_types;
mod lines;
mod points;
mod seabed;
mod settings;
mod surroundings;
mod time;
mod waves;
mod winch;

use std::collections::BTreeMap;

use super::nearest::suggestion;
use super::{Scene, SceneError};

pub(super) use line_types::coefficients;
pub(super) use settings::integrator_name;

impl Scene {
    /// Finds the first mistake.
    ///
    /// # Errors
    /// Names the key path and what would be right.
    pub fn check(&self) -> Result<(), SceneError> {
        match self.mistakes().into_iter().next() {
            Some(first) => Err(first),
            None => Ok(()),
        }
    }

    /// Finds every mistake, each with its key path.
    pub fn mistakes(&self) -> Vec<SceneError> {
        let mut findings = Findings::default();
        surroundings::check(self, &mut findings);
        line_types::check(self, &mut findings);
        points::check(self, &mut findings);
        lines::check(self, &mut findings);
        settings::check(self, &mut findings);
        findings.mistakes
    }
}

/// The mistakes found so far.
#[derive(Default)]
struct Findings {
    mistakes: Vec<SceneError>,
}

impl Findings {
    /// Notes a mistake.
    fn say(&mut self, at: impl Into<String>, problem: impl Into<String>) {
        self.mistakes.push(SceneError::new(at, problem));
    }

    /// Notes a number that is not finite or outside its bounds; whether it is right.
    fn number(&mut self, at: impl Into<String>, value: f64, bounds: Bounds, unit: &str) -> bool {
        match bounds.complaint(value, unit) {
            Some(problem) => {
                self.say(at, problem);
                false
            }
            None => true,
        }
    }

    /// The same for a number that may be absent.
    fn number_if(&mut self, at: String, value: Option<f64>, bounds: Bounds, unit: &str) {
        if let Some(value) = value {
            self.number(at, value, bounds, unit);
        }
    }
}

/// Least positive number that stands for anything in a mooring, in any unit: squares and products of a few of them are numbers still.
const POSITIVE_MIN: f64 = 1e-15;

/// What a number may be. Limits are far beyond any mooring: they catch slips of units and powers of ten.
#[derive(Clone, Copy)]
enum Bounds {
    /// From [`POSITIVE_MIN`] up to a limit.
    Positive(f64),
    /// Zero or more, up to a limit.
    NotNegative(f64),
    /// No further from zero than a limit.
    Magnitude(f64),
    /// From one value to another, both allowed.
    Within(f64, f64),
}

impl Bounds {
    /// What is wrong with the value, where something is.
    fn complaint(self, value: f64, unit: &str) -> Option<String> {
        let value_said = quantity(value, unit);
        if !value.is_finite() {
            return Some(format!("{value_said} is not a finite number"));
        }
        let upper = match self {
            Bounds::Positive(_) if value <= 0.0 => {
                return Some(format!("{value_said} is not positive"));
            }
            Bounds::Positive(_) if value < POSITIVE_MIN => {
                return Some(format!(
                    "{value_said} is below the limit of {}: is the unit or the power of ten right?",
                    quantity(POSITIVE_MIN, unit)
                ));
            }
            Bounds::NotNegative(_) if value < 0.0 => {
                return Some(format!("{value_said} is negative"));
            }
            Bounds::Within(lower, upper) if value < lower || value > upper => {
                return Some(format!(
                    "{value_said} is not between {} and {}",
                    number(lower),
                    quantity(upper, unit)
                ));
            }
            Bounds::Within(..) => return None,
            Bounds::Positive(upper) | Bounds::NotNegative(upper) | Bounds::Magnitude(upper) => upper,
        };
        (value.abs() > upper).then(|| {
            format!(
                "{value_said} is beyond the limit of {}: is the unit or the power of ten right?",
                quantity(upper, unit)
            )
        })
    }
}

/// Shortest digits; powers of ten where plain digits would be long.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-4..1e6).contains(&size) || !value.is_finite() {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// A number and its unit; a bare number where it has none.
pub(super) fn quantity(value: f64, unit: &str) -> String {
    if unit == "-" {
        number(value)
    } else {
        format!("{} {unit}", number(value))
    }
}

/// Names that are the stem of variables of the FMU.
fn check_name(findings: &mut Findings, at: &str, name: &str) {
    let allowed = "a name starts with a letter or _ and holds letters a-z A-Z, digits, _ and - only, \
                   since the variables of the FMU are called after it";
    let first = name.chars().next();
    let other = |c: &char| !(c.is_ascii_alphanumeric() || *c == '_' || *c == '-');
    if first.is_none() {
        findings.say(at, format!("the name is empty: {allowed}"));
    } else if let Some(wrong) = name.chars().find(other) {
        findings.say(at, format!("{name:?} holds {wrong:?}: {allowed}"));
    } else if first.is_some_and(|c| c.is_ascii_digit() || c == '-') {
        findings.say(at, format!("{name:?} starts with a digit or -: {allowed}"));
    } else if name.len() > 64 {
        findings.say(at, format!("the name has {} characters, 64 at most", name.len()));
    } else if ["time", "solver"].contains(&name) {
        findings.say(
            at,
            format!("`{name}` is the name of variables of every FMU: take another"),
        );
    }
}

/// Checks the names of points and lines, which share the name space of the FMU's variables.
fn check_names<'s>(
    findings: &mut Findings,
    taken: &mut BTreeMap<&'s str, String>,
    list: &str,
    names: impl Iterator<Item = &'s str>,
) {
    for (index, name) in names.enumerate() {
        let at = format!("{list}[{index}].name");
        check_name(findings, &at, name);
        if let Some(other) = taken.get(name) {
            findings.say(at, format!("the name `{name}` is taken by {other}: take another"));
        } else {
            taken.insert(name, format!("{list}[{index}]"));
        }
    }
}

/// "no point is called `anchr`, did you mean `anchor`? (points: anchor, fairlead)".
fn unknown<'a>(
    what: &str,
    plural: &str,
    name: &str,
    known: impl IntoIterator<Item = &'a str> + Clone,
) -> String {
    format!("no {what} is called `{name}`{}", suggestion(name, plural, known))
}
