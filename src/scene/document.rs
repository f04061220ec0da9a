//! A parsed TOML document whose values carry their key path, their place in the text and the unit of their numbers.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::SceneError;
use super::nearest::suggestion;
use super::path::{Step, push};
use super::table::Value;

/// A value of the document.
#[derive(Clone, Copy)]
pub struct Node<'n> {
    value: &'n Spanned<DeValue<'n>>,
    /// The table or array that holds it, and the step from there.
    holder: Option<(&'n Node<'n>, Step<'n>)>,
    /// Unit of its numbers.
    unit: Option<&'static str>,
}

impl<'n> Node<'n> {
    /// The whole document.
    pub(super) fn root(value: &'n Spanned<DeValue<'n>>) -> Node<'n> {
        Node {
            value,
            holder: None,
            unit: None,
        }
    }

    /// Returns the value with a unit for its numbers.
    pub(super) fn in_unit(self, unit: Option<&'static str>) -> Node<'n> {
        Node { unit, ..self }
    }

    /// Value of a key in a table, without a unit for its numbers.
    fn under(&'n self, key: &'n str, value: &'n Spanned<DeValue<'n>>) -> Node<'n> {
        Node {
            value,
            holder: Some((self, Step::Key(key))),
            unit: None,
        }
    }

    /// Reads a value of a type of the scene format.
    pub(super) fn read<T: Value + Default>(&self) -> Result<T, SceneError> {
        let mut value = T::default();
        value.read(self)?;
        Ok(value)
    }

    fn path(&self) -> String {
        let Some((holder, step)) = self.holder else {
            return String::new();
        };
        let mut path = holder.path();
        push(&mut path, step);
        path
    }

    /// Returns a mistake in this value.
    pub(super) fn refuse(&self, problem: impl Into<String>) -> SceneError {
        SceneError {
            at: self.path(),
            problem: problem.into(),
            span: Some(self.value.span()),
        }
    }

    /// Returns a mistake in the type of this value; `expected` gets its unit if it refers to a number.
    pub(super) fn expected(&self, expected: &str) -> SceneError {
        self.expected_instead_of(expected, &self.found())
    }

    /// As [`Node::expected`], with another description of the value.
    pub(super) fn expected_instead_of(&self, expected: &str, found: &str) -> SceneError {
        let expected = match self.unit {
            Some(unit) if expected.contains("a number") => {
                expected.replacen("a number", &format!("a number [{unit}]"), 1)
            }
            Some(unit) if expected.ends_with("numbers") => format!("{expected} [{unit}]"),
            _ => expected.to_string(),
        };
        self.refuse(format!("expected {expected}, found {found}"))
    }

    fn found(&self) -> String {
        match self.value.get_ref() {
            DeValue::String(text) if text.chars().count() > 40 => "a string".into(),
            DeValue::String(text) => format!("the string {text:?}"),
            DeValue::Integer(number) => number.to_string(),
            DeValue::Float(number) => number.as_str().into(),
            DeValue::Boolean(truth) => truth.to_string(),
            DeValue::Datetime(_) => "a date".into(),
            DeValue::Array(_) => "an array".into(),
            DeValue::Table(table) if table.is_empty() => "an empty table".into(),
            DeValue::Table(_) => "a table".into(),
        }
    }

    /// Reads a number; `expected` describes the accepted values.
    pub(super) fn number(&self, expected: &str) -> Result<f64, SceneError> {
        let written = match self.value.get_ref() {
            DeValue::Integer(number) if number.radix() != 10 => {
                return Ok(self.integer(expected)? as f64);
            }
            DeValue::Integer(number) => number.as_str(),
            DeValue::Float(number) => number.as_str(),
            _ => return Err(self.expected(expected)),
        };
        match written.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(self.refuse(format!("{written} is not a finite number"))),
        }
    }

    fn integer(&self, expected: &str) -> Result<i64, SceneError> {
        let DeValue::Integer(number) = self.value.get_ref() else {
            return Err(self.expected(expected));
        };
        let parsed = i64::from_str_radix(number.as_str(), number.radix());
        parsed.map_err(|_| self.refuse(format!("{number} is beyond a 64-bit whole number")))
    }

    /// Reads a whole number that is not negative; `expected` describes the accepted values.
    pub(super) fn count(&self, expected: &str) -> Result<u64, SceneError> {
        u64::try_from(self.integer(expected)?).map_err(|_| self.expected(expected))
    }

    pub(super) fn truth(&self) -> Result<bool, SceneError> {
        let truth = self.value.get_ref().as_bool();
        truth.ok_or_else(|| self.expected("true or false"))
    }

    pub(super) fn text(&self) -> Result<&'n str, SceneError> {
        self.value
            .get_ref()
            .as_str()
            .ok_or_else(|| self.expected("a string"))
    }

    /// Elements of an array; `None` for any other value.
    pub(super) fn elements(&'n self) -> Option<impl ExactSizeIterator<Item = Node<'n>>> {
        let elements = self.value.get_ref().as_array()?.iter().enumerate();
        Some(elements.map(move |(index, value)| Node {
            value,
            holder: Some((self, Step::Index(index))),
            unit: self.unit,
        }))
    }

    /// Entries of a table in the order of the text; `None` for any other value.
    pub(super) fn entries(&'n self) -> Option<Vec<Entry<'n>>> {
        let entries = self.value.get_ref().as_table()?.iter();
        let entries = entries.map(|(key, value)| Entry {
            key,
            value: self.under(key.get_ref(), value),
        });
        let mut entries: Vec<Entry<'n>> = entries.collect();
        entries.sort_by_key(|entry| entry.key.span().start);
        Some(entries)
    }

    /// Reads one of several words, of which those with a unit hold a value: `"word"` or `{ word = value }`. Returns the word and the value.
    pub(super) fn word(
        &'n self,
        mut known: impl Iterator<Item = (&'static str, Option<&'static str>)> + Clone,
    ) -> Result<(&'static str, Option<Node<'n>>), SceneError> {
        let all = known.clone();
        let names = || all.clone().map(|(name, _)| name);
        let entry = match self.entries().as_deref() {
            Some([entry]) => Some(*entry),
            _ => None,
        };
        let Some(name) = entry
            .map(|entry| entry.name())
            .or_else(|| self.value.get_ref().as_str())
        else {
            let names: Vec<String> = names().map(|name| format!("`{name}`")).collect();
            return Err(self.expected(&format!("one of {}", names.join(", "))));
        };
        let refuse = |problem: String| match entry {
            Some(entry) => SceneError {
                span: Some(entry.key.span()),
                ..self.refuse(problem)
            },
            None => self.refuse(problem),
        };
        let Some((name, unit)) = known.find(|(known, _)| *known == name) else {
            let suggestion = suggestion(name, "known values", names());
            return Err(refuse(format!("unknown value `{name}`{suggestion}")));
        };
        match (unit, entry) {
            (None, None) => Ok((name, None)),
            (Some(_), Some(entry)) => Ok((name, Some(entry.value.in_unit(unit)))),
            (Some(_), None) => Err(refuse(format!("`{name}` needs a value: write {{ {name} = … }}"))),
            (None, Some(_)) => Err(refuse(format!("`{name}` takes no value: write \"{name}\""))),
        }
    }
}

/// A key of a table and its value.
#[derive(Clone, Copy)]
pub(super) struct Entry<'n> {
    key: &'n Spanned<DeString<'n>>,
    pub value: Node<'n>,
}

impl<'n> Entry<'n> {
    /// The key as written.
    pub(super) fn name(&self) -> &'n str {
        self.key.get_ref()
    }

    /// Returns a mistake in the key.
    pub(super) fn refuse(&self, problem: impl Into<String>) -> SceneError {
        SceneError {
            span: Some(self.key.span()),
            ..self.value.refuse(problem)
        }
    }
}

/// Parses a text.
///
/// # Errors
/// The message of the TOML parser.
pub(super) fn parse(text: &str) -> Result<Spanned<DeValue<'_>>, toml::de::Error> {
    let table = DeTable::parse(text)?;
    let span: Range<usize> = table.span();
    Ok(Spanned::new(span, DeValue::Table(table.into_inner())))
}
