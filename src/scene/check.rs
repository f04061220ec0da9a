//! Checks on a whole scene: values in range, names that exist, parts that fit together.

mod line_types;
mod lines;
mod points;
mod seabed;
mod settings;
mod surroundings;
mod waves;
mod winch;

use std::collections::BTreeMap;

use super::names::Names;
use super::nearest::suggestion;
use super::plausibility::degrees;
use super::table::{Rule, check_table};
use super::{Note, Scene, SceneError};

impl Scene {
    /// Checks the scene.
    ///
    /// # Errors
    /// The first mistake, with its key path and correction.
    pub fn check(&self) -> Result<(), SceneError> {
        match self.mistakes().into_iter().next() {
            Some(first) => Err(first),
            None => Ok(()),
        }
    }

    /// Finds every mistake, each with its key path.
    pub fn mistakes(&self) -> Vec<SceneError> {
        let mut findings = Findings::default();
        check_table(self, &mut findings);
        surroundings::check(self, &mut findings);
        line_types::check(self, &mut findings);
        let names = Names::of(self);
        points::check(self, &names, &mut findings);
        lines::check(self, &names, &mut findings);
        settings::check(self, &mut findings);
        findings.mistakes
    }
}

/// List to which rules add their findings.
pub(super) trait Report {
    /// Adds a finding at a key path.
    fn add(&mut self, at: String, text: String);
}

impl Report for Findings {
    fn add(&mut self, at: String, text: String) {
        self.say(at, text);
    }
}

impl Report for Vec<Note> {
    fn add(&mut self, at: String, text: String) {
        self.push(Note::new(at, text));
    }
}

/// The path of a key, or of an index in brackets, below a path; both may be empty.
pub(super) fn below(at: &str, key: &str) -> String {
    match (at, key) {
        ("", _) => key.to_string(),
        (_, "") => at.to_string(),
        _ if key.starts_with('[') => format!("{at}{key}"),
        _ => format!("{at}.{key}"),
    }
}

/// Adds the findings of a table of rules. A rule is a key below a path, a condition, and the sentence that is added if it holds; or, with
/// `given`, an optional value and the sentence about it. The rules of a table are independent.
macro_rules! rules {
    ($report:expr, $at:expr;) => {};
    ($report:expr, $at:expr; $key:literal if $holds:expr => $text:literal $(, $part:expr)*; $($rest:tt)*) => {
        rules!($report, $at; $key given () = $holds.then_some(()) => $text $(, $part)*; $($rest)*);
    };
    ($report:expr, $at:expr; $key:literal given $found:pat = $value:expr => $text:literal $(, $part:expr)*; $($rest:tt)*) => {
        if let Some($found) = $value {
            let at = $crate::scene::check::below($at, &format!($key));
            $crate::scene::check::Report::add($report, at, format!($text $(, $part)*));
        }
        rules!($report, $at; $($rest)*);
    };
}
pub(super) use rules;

/// The mistakes found so far, and notes on unusual values.
#[derive(Default)]
pub struct Findings {
    pub(super) mistakes: Vec<SceneError>,
    pub(super) notes: Vec<Note>,
}

impl Findings {
    /// Runs the check of the value at a key or an index, `place`, and prefixes the paths of its findings with it.
    pub(super) fn below(&mut self, place: impl FnOnce() -> String, check: impl FnOnce(&mut Findings)) {
        let (mistakes, notes) = (self.mistakes.len(), self.notes.len());
        check(self);
        if self.mistakes.len() == mistakes && self.notes.len() == notes {
            return;
        }
        let place = place();
        let mistakes = self.mistakes[mistakes..]
            .iter_mut()
            .map(|mistake| &mut mistake.at);
        let notes = self.notes[notes..].iter_mut().map(|note| &mut note.at);
        mistakes.chain(notes).for_each(|at| *at = below(&place, at));
    }

    /// Adds a mistake.
    pub(super) fn say(&mut self, at: impl Into<String>, problem: impl Into<String>) {
        self.mistakes.push(SceneError::new(at, problem));
    }

    /// Adds a mistake for a number that is not finite or outside its bounds; returns whether it is within them.
    pub(super) fn number(&mut self, at: impl Into<String>, value: f64, bounds: Bounds, unit: &str) -> bool {
        match bounds.complaint(value, unit) {
            None => true,
            Some(problem) => {
                self.say(at, problem);
                false
            }
        }
    }

    /// Adds a mistake for every number of a row that is not finite or outside the bounds of its column; columns have units.
    pub(super) fn row(&mut self, at: &str, numbers: &[f64], columns: &[(Bounds, &str)]) {
        for (i, (value, (bounds, unit))) in numbers.iter().zip(columns).enumerate() {
            if !bounds.accepts(*value) {
                self.number(format!("{at}[{i}]"), *value, *bounds, unit);
            }
        }
    }

    /// Adds a mistake for a number that breaks the rule of its key, with the hint of the rule if the number is negative or only its magnitude is
    /// bounded; or a note on a number outside the usual range or an angle beyond a turn. Zero is not noted, since it leaves an effect out.
    pub(super) fn ruled(&mut self, at: impl Into<String>, value: f64, rule: &Rule, unit: &str) {
        if let Some(problem) = rule.bounds.complaint(value, unit) {
            let about = value < 0.0 || matches!(rule.bounds, Bounds::Magnitude(_));
            let fact = problem.split(": ").next().unwrap_or_default();
            return match rule.hint.filter(|_| about) {
                Some(hint) => self.say(at, format!("{fact}: {hint}")),
                None => self.say(at, problem),
            };
        }
        let unusual = rule
            .usual
            .filter(|([least, most], _)| value != 0.0 && !(*least..=*most).contains(&value));
        let text = unusual.map(|(_, usual)| format!("{} is unusual: {usual}", quantity(value, unit)));
        let angle = (unit == "rad").then(|| degrees(value)).flatten();
        self.notes.extend(text.or(angle).map(|text| Note::new(at, text)));
    }
}

/// Smallest positive value accepted for a physical quantity, in any unit: products of a few such values do not underflow.
const POSITIVE_MIN: f64 = 1e-15;

/// Bounds of a number. The limits are far beyond any mooring: they catch slips of units and powers of ten.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bounds {
    /// Any finite number.
    Finite,
    /// Bounds that depend on other keys or on the position in a list; the code of the value or of its table checks them.
    Elsewhere,
    /// From [`POSITIVE_MIN`] up to a limit.
    Positive(f64),
    /// Zero or more, up to a limit.
    NotNegative(f64),
    /// Magnitude up to a limit.
    Magnitude(f64),
    /// From one value to another, both allowed.
    Within(f64, f64),
}

impl Bounds {
    /// Returns whether a value is finite and within the bounds.
    pub(super) fn accepts(self, value: f64) -> bool {
        let [least, most] = self.range();
        let is_within = least.is_none_or(|least| value >= least) && most.is_none_or(|most| value <= most);
        self == Bounds::Elsewhere || value.is_finite() && is_within
    }

    /// Smallest and largest number that are accepted, if the bounds alone determine them.
    pub(crate) fn range(self) -> [Option<f64>; 2] {
        match self {
            Bounds::Finite | Bounds::Elsewhere => [None, None],
            Bounds::Positive(limit) => [Some(POSITIVE_MIN), Some(limit)],
            Bounds::NotNegative(limit) => [Some(0.0), Some(limit)],
            Bounds::Magnitude(limit) => [Some(-limit), Some(limit)],
            Bounds::Within(least, most) => [Some(least), Some(most)],
        }
    }

    /// Returns the refusal of a value outside the bounds.
    pub(super) fn complaint(self, value: f64, unit: &str) -> Option<String> {
        if self.accepts(value) {
            return None;
        }
        let (said, of) = (quantity(value, unit), |limit| quantity(limit, unit));
        let slip = "is the unit or the power of ten right?";
        Some(match self {
            _ if !value.is_finite() => format!("{said} is not a finite number"),
            Bounds::Positive(_) if value <= 0.0 => format!("{said} is not positive"),
            Bounds::Positive(_) if value < POSITIVE_MIN => {
                format!("{said} is below the limit of {}: {slip}", of(POSITIVE_MIN))
            }
            Bounds::NotNegative(_) if value < 0.0 => format!("{said} is negative"),
            Bounds::Within(least, most) => {
                format!("{said} is not between {} and {}", number(least), of(most))
            }
            Bounds::Positive(limit) | Bounds::NotNegative(limit) | Bounds::Magnitude(limit) => {
                format!("{said} is beyond the limit of {}: {slip}", of(limit))
            }
            Bounds::Finite | Bounds::Elsewhere => return None,
        })
    }
}

/// A number with the fewest digits; with a power of ten if plain digits would be long.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-4..1e6).contains(&size) || !value.is_finite() {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// A number rounded to significant digits.
pub(super) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

/// A number and its unit; the number alone if it has no unit.
pub(super) fn quantity(value: f64, unit: &str) -> String {
    if unit == "-" {
        number(value)
    } else {
        format!("{} {unit}", number(value))
    }
}

/// Returns the reason why a line type, point, line or vessel cannot have this name, which is the stem of variables of the FMU.
pub fn name_problem(name: &str) -> Option<String> {
    let allowed = "a name starts with a letter or _ and holds letters a-z A-Z, digits, _ and - only, \
                   since the variables of the FMU are called after it";
    let first = name.chars().next();
    let other = |c: &char| !(c.is_ascii_alphanumeric() || *c == '_' || *c == '-');
    Some(if first.is_none() {
        format!("the name is empty: {allowed}")
    } else if let Some(wrong) = name.chars().find(other) {
        format!("{name:?} holds {wrong:?}: {allowed}")
    } else if first.is_some_and(|c| c.is_ascii_digit() || c == '-') {
        format!("{name:?} starts with a digit or -: {allowed}")
    } else if name.len() > 64 {
        format!("the name has {} characters, 64 at most", name.len())
    } else if ["time", "solver"].contains(&name) {
        format!("`{name}` is the name of variables of every FMU: take another")
    } else {
        return None;
    })
}

fn check_name(findings: &mut Findings, at: &str, name: &str) {
    if let Some(problem) = name_problem(name) {
        findings.say(at, problem);
    }
}

/// Checks the names of points, lines and vessels, which must be unique.
fn check_names(scene: &Scene, findings: &mut Findings) {
    let mut taken = BTreeMap::new();
    for (owner, name) in scene.names() {
        let at = below(&owner, "name");
        check_name(findings, &at, name);
        if let Some(other) = taken.get(name) {
            findings.say(at, format!("the name `{name}` is taken by {other}: take another"));
        } else {
            taken.insert(name, owner);
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
