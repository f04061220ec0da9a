//! Deserialises a parsed TOML document and keeps account of where it is, so that every mistake has a key path,
//! a place in the text and a sentence that says what is accepted.

use std::fmt::Display;
use std::ops::Range;

use serde::de::{
    self, DeserializeSeed, Deserializer, EnumAccess, Expected, IntoDeserializer, MapAccess, SeqAccess,
    Unexpected, VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::SceneError;
use super::nearest::suggestion;
use super::path::{self, Step};
use super::units;

/// Reads a value of the scene from a document.
pub(super) fn deserialize<'de, T: de::Deserialize<'de>>(
    root: &'de Spanned<DeValue<'de>>,
) -> Result<T, SceneError> {
    T::deserialize(Node { value: root }).map_err(ReadError::finish)
}

/// A mistake on its way up from where it was found.
#[derive(Debug)]
pub(super) struct ReadError {
    /// Steps to the place, the innermost first.
    steps: Vec<Step>,
    problem: Problem,
    span: Option<Range<usize>>,
}

#[derive(Debug)]
enum Problem {
    /// Another type than the one that is wanted, with the unit of the number that is wanted.
    Type {
        expected: String,
        found: String,
        unit: Option<&'static str>,
    },
    /// A key that must be there is not.
    Missing {
        key: &'static str,
        unit: Option<&'static str>,
    },
    Other(String),
}

impl ReadError {
    fn other(problem: impl Into<String>) -> Self {
        ReadError {
            steps: Vec::new(),
            problem: Problem::Other(problem.into()),
            span: None,
        }
    }

    fn wrong_type(unexpected: Unexpected<'_>, expected: &str) -> Self {
        ReadError {
            steps: Vec::new(),
            problem: Problem::Type {
                expected: expected.to_string(),
                found: found_in_words(unexpected),
                unit: None,
            },
            span: None,
        }
    }

    fn or_span(mut self, span: Range<usize>) -> Self {
        self.span.get_or_insert(span);
        self
    }

    fn inside(mut self, step: Step) -> Self {
        self.steps.push(step);
        self
    }

    /// Says the unit of the key `key` of the struct `owner`, where that key is what the mistake is about.
    fn or_unit(mut self, owner: &str, key: Option<&str>) -> Self {
        match (&mut self.problem, key) {
            (Problem::Missing { key, unit }, None) => {
                *unit = unit.or_else(|| units::unit(owner, key));
            }
            // Below a further key the numbers are other ones, such as the times of a load's step.
            (Problem::Type { unit, .. }, Some(key))
                if self.steps.iter().all(|step| matches!(step, Step::Index(_))) =>
            {
                *unit = unit.or_else(|| units::unit(owner, key));
            }
            _ => {}
        }
        self
    }

    fn finish(self) -> SceneError {
        let problem = match self.problem {
            Problem::Type {
                expected,
                found,
                unit: Some(unit),
            } if expected.contains("number") && !expected.contains("whole") => {
                let (upto, rest) = match expected.find("a number") {
                    Some(start) => expected.split_at(start + "a number".len()),
                    None => (expected.as_str(), ""),
                };
                format!("expected {upto} [{unit}]{rest}, found {found}")
            }
            Problem::Type { expected, found, .. } => format!("expected {expected}, found {found}"),
            Problem::Missing {
                key,
                unit: Some(unit),
            } => format!("missing key `{key}` [{unit}]"),
            Problem::Missing { key, unit: None } => format!("missing key `{key}`"),
            Problem::Other(problem) => problem,
        };
        SceneError {
            at: path::render(self.steps.iter().rev()),
            problem,
            span: self.span,
        }
    }
}

impl Display for ReadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?}", self.problem)
    }
}

impl std::error::Error for ReadError {}

impl de::Error for ReadError {
    fn custom<T: Display>(message: T) -> Self {
        ReadError::other(message.to_string())
    }

    fn invalid_type(unexpected: Unexpected<'_>, expected: &dyn Expected) -> Self {
        ReadError::wrong_type(unexpected, &expected_in_words(expected))
    }

    fn invalid_value(unexpected: Unexpected<'_>, expected: &dyn Expected) -> Self {
        ReadError::wrong_type(unexpected, &expected_in_words(expected))
    }

    fn unknown_field(field: &str, known: &'static [&'static str]) -> Self {
        let suggestion = suggestion(field, "known keys", known.iter().copied());
        ReadError::other(format!("unknown key `{field}`{suggestion}"))
    }

    fn unknown_variant(variant: &str, known: &'static [&'static str]) -> Self {
        let suggestion = suggestion(variant, "known values", known.iter().copied());
        ReadError::other(format!("unknown value `{variant}`{suggestion}"))
    }

    fn duplicate_field(field: &'static str) -> Self {
        // TOML has no key twice, so that the other one is another name of it.
        ReadError::other(format!("`{field}` is given twice, under both of its names"))
    }

    fn missing_field(field: &'static str) -> Self {
        ReadError {
            steps: Vec::new(),
            problem: Problem::Missing {
                key: field,
                unit: None,
            },
            span: None,
        }
    }
}

/// What serde's visitors say they expect, in the words of the scene format.
fn expected_in_words(expected: &dyn Expected) -> String {
    let said = expected.to_string();
    match said.as_str() {
        "f64" => "a number".into(),
        "usize" => "a whole number, not negative".into(),
        "a boolean" => "true or false".into(),
        "a sequence" => "an array".into(),
        "a map" => "a table".into(),
        _ if said.starts_with("struct ") => "a table".into(),
        _ => said,
    }
}

fn found_in_words(unexpected: Unexpected<'_>) -> String {
    match unexpected {
        Unexpected::Str(text) if text.chars().count() > 40 => "a string".into(),
        Unexpected::Str(text) => format!("the string {text:?}"),
        Unexpected::Signed(value) => format!("{value}"),
        Unexpected::Unsigned(value) => format!("{value}"),
        Unexpected::Float(value) => format!("{value:?}"),
        Unexpected::Bool(value) => format!("{value}"),
        Unexpected::Seq => "an array".into(),
        Unexpected::Map => "a table".into(),
        Unexpected::Other(what) => what.into(),
        other => other.to_string(),
    }
}

fn unexpected<'v>(value: &'v DeValue<'_>) -> Unexpected<'v> {
    match value {
        DeValue::String(text) => Unexpected::Str(text),
        DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix())
            .map_or(Unexpected::Other("a whole number"), Unexpected::Signed),
        DeValue::Float(float) => float
            .as_str()
            .parse()
            .map_or(Unexpected::Other("a number"), Unexpected::Float),
        DeValue::Boolean(value) => Unexpected::Bool(*value),
        DeValue::Datetime(_) => Unexpected::Other("a date"),
        DeValue::Array(_) => Unexpected::Seq,
        DeValue::Table(_) => Unexpected::Map,
    }
}

/// A value of the document.
#[derive(Clone, Copy)]
struct Node<'de> {
    value: &'de Spanned<DeValue<'de>>,
}

impl<'de> Node<'de> {
    fn at_span<T>(self, result: Result<T, ReadError>) -> Result<T, ReadError> {
        result.map_err(|error| error.or_span(self.value.span()))
    }

    fn visit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match self.value.get_ref() {
            DeValue::String(text) => visitor.visit_str(text),
            DeValue::Integer(integer) => {
                let parsed = i64::from_str_radix(integer.as_str(), integer.radix());
                visitor.visit_i64(
                    parsed.map_err(|_| {
                        ReadError::other(format!("{integer} is beyond a 64-bit whole number"))
                    })?,
                )
            }
            DeValue::Float(float) => visitor.visit_f64(finite(float.as_str())?),
            DeValue::Boolean(value) => visitor.visit_bool(*value),
            DeValue::Datetime(_) => Err(de::Error::invalid_type(Unexpected::Other("a date"), &visitor)),
            DeValue::Array(array) => visitor.visit_seq(Elements::new(array)),
            DeValue::Table(table) => visitor.visit_map(Entries::new(table, None)),
        }
    }
}

/// A float as written, where it is a number.
fn finite(written: &str) -> Result<f64, ReadError> {
    match written.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(ReadError::other(format!("{written} is not a finite number"))),
    }
}

impl<'de> Deserializer<'de> for Node<'de> {
    type Error = ReadError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        self.at_span(self.visit(visitor))
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        match self.value.get_ref() {
            DeValue::Integer(integer) if integer.radix() == 10 => {
                let number = finite(integer.as_str());
                self.at_span(number.and_then(|number| visitor.visit_f64(number)))
            }
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadError> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, len: usize, visitor: V) -> Result<V::Value, ReadError> {
        let expected = format!("an array of {len} numbers");
        let result = match self.value.get_ref() {
            DeValue::Array(array) if array.len() == len => self.visit(visitor),
            DeValue::Array(array) => Err(ReadError::wrong_type(
                Unexpected::Other(&format!("an array of {}", array.len())),
                &expected,
            )),
            other => Err(ReadError::wrong_type(unexpected(other), &expected)),
        };
        self.at_span(result)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        let result = match self.value.get_ref() {
            DeValue::Table(table) => visitor.visit_map(Entries::new(table, Some(name))),
            other => Err(de::Error::invalid_type(unexpected(other), &visitor)),
        };
        self.at_span(result.map_err(|error| error.or_unit(name, None)))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadError> {
        let result = match self.value.get_ref() {
            DeValue::String(text) => visitor.visit_enum(Choice {
                owner: name,
                name: text,
                name_span: self.value.span(),
                content: None,
            }),
            DeValue::Table(table) if table.len() == 1 => {
                let (key, value) = table.iter().next().expect("it has one entry");
                visitor.visit_enum(Choice {
                    owner: name,
                    name: key.get_ref(),
                    name_span: key.span(),
                    content: Some(Node { value }),
                })
            }
            other => {
                let names: Vec<_> = variants.iter().map(|name| format!("`{name}`")).collect();
                let expected = format!("one of {}", names.join(", "));
                Err(ReadError::wrong_type(unexpected(other), &expected))
            }
        };
        self.at_span(result)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 char str string bytes byte_buf unit
        unit_struct seq tuple_struct map identifier ignored_any
    }
}

/// Elements of an array.
struct Elements<'de> {
    rest: std::slice::Iter<'de, Spanned<DeValue<'de>>>,
    index: usize,
}

impl<'de> Elements<'de> {
    fn new(array: &'de DeArray<'de>) -> Self {
        Elements {
            rest: array.iter(),
            index: 0,
        }
    }
}

impl<'de> SeqAccess<'de> for Elements<'de> {
    type Error = ReadError;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, ReadError> {
        let Some(value) = self.rest.next() else {
            return Ok(None);
        };
        let step = Step::Index(self.index);
        self.index += 1;
        seed.deserialize(Node { value })
            .map(Some)
            .map_err(|error| error.or_span(value.span()).inside(step))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

type Entry<'de> = (&'de Spanned<toml::de::DeString<'de>>, &'de Spanned<DeValue<'de>>);

/// Entries of a table in the order of the text.
struct Entries<'de> {
    rest: std::vec::IntoIter<Entry<'de>>,
    current: Option<Entry<'de>>,
    owner: Option<&'static str>,
}

impl<'de> Entries<'de> {
    fn new(table: &'de DeTable<'de>, owner: Option<&'static str>) -> Self {
        let mut entries: Vec<Entry<'de>> = table.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        Entries {
            rest: entries.into_iter(),
            current: None,
            owner,
        }
    }
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = ReadError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, ReadError> {
        self.current = self.rest.next();
        let Some((key, _)) = self.current else {
            return Ok(None);
        };
        let name: &str = key.get_ref();
        seed.deserialize(name.into_deserializer())
            .map(Some)
            .map_err(|error: ReadError| error.or_span(key.span()).inside(Step::Key(name.to_string())))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, ReadError> {
        let (key, value) = self.current.expect("serde asks for the key first");
        seed.deserialize(Node { value }).map_err(|error| {
            let error = match self.owner {
                Some(owner) => error.or_unit(owner, Some(key.get_ref())),
                None => error,
            };
            error
                .or_span(value.span())
                .inside(Step::Key(key.get_ref().to_string()))
        })
    }
}

/// One of several: `"name"`, or `{ name = content }`.
struct Choice<'de> {
    owner: &'static str,
    name: &'de str,
    name_span: Range<usize>,
    content: Option<Node<'de>>,
}

impl<'de> EnumAccess<'de> for Choice<'de> {
    type Error = ReadError;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), ReadError> {
        let variant = seed
            .deserialize(self.name.into_deserializer())
            .map_err(|error: ReadError| error.or_span(self.name_span.clone()))?;
        Ok((variant, self))
    }
}

impl<'de> VariantAccess<'de> for Choice<'de> {
    type Error = ReadError;

    fn unit_variant(self) -> Result<(), ReadError> {
        match self.content {
            None => Ok(()),
            Some(_) => Err(
                ReadError::other(format!("`{0}` takes no value: write \"{0}\"", self.name))
                    .or_span(self.name_span),
            ),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, ReadError> {
        let Some(content) = self.content else {
            return Err(ReadError::other(format!(
                "`{0}` needs a value: write {{ {0} = … }}",
                self.name
            )));
        };
        seed.deserialize(content).map_err(|error| {
            error
                .or_unit(self.owner, Some(self.name))
                .or_span(content.value.span())
                .inside(Step::Key(self.name.to_string()))
        })
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, ReadError> {
        Err(ReadError::other("the scene format has no such choice"))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        _: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, ReadError> {
        Err(ReadError::other("the scene format has no such choice"))
    }
}
