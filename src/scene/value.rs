//! Values of the scene format: numbers, texts and lists of them.

use std::collections::BTreeMap;

use toml::Value as Toml;

use super::check::{Findings, number, quantity};
use super::document::Node;
use super::table::{Key, Kind, Value};
use super::{AngleOrder, SceneError, table};

impl Value for f64 {
    fn kind() -> Kind {
        Kind::Number
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        *self = node.number("a number")?;
        Ok(())
    }

    fn write(&self) -> Option<Toml> {
        Some(Toml::Float(*self))
    }

    fn check(&self, key: &Key, findings: &mut Findings) {
        findings.ruled("", *self, &key.rule, key.unit().unwrap_or("-"));
    }

    fn number(&self) -> Option<f64> {
        Some(*self)
    }

    fn set_number(&mut self, number: f64) -> Result<(), String> {
        *self = number;
        Ok(())
    }

    fn in_words(&self, key: &Key) -> Option<String> {
        Some(quantity(*self, key.unit().unwrap_or("-")))
    }
}

/// Implements [`Value`] for a whole number; its bounds are those of its key.
macro_rules! count {
    ($type:ty) => {
        impl Value for $type {
            fn kind() -> Kind {
                Kind::Count
            }

            fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
                *self = node.count("a whole number, not negative")? as $type;
                Ok(())
            }

            fn write(&self) -> Option<Toml> {
                Some(Toml::Integer(*self as i64))
            }

            fn check(&self, key: &Key, findings: &mut Findings) {
                let value = *self as f64;
                if let Some(problem) = key.rule.bounds.complaint(value, "-") {
                    findings.say("", problem.replacen(&number(value), &self.to_string(), 1));
                }
            }

            fn in_words(&self, _: &Key) -> Option<String> {
                Some(self.to_string())
            }
        }
    };
}

count!(usize);
count!(u64);

impl Value for bool {
    fn kind() -> Kind {
        Kind::Truth
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        *self = node.truth()?;
        Ok(())
    }

    fn write(&self) -> Option<Toml> {
        Some(Toml::Boolean(*self))
    }
}

impl Value for String {
    fn kind() -> Kind {
        Kind::Text
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        *self = node.text()?.to_string();
        Ok(())
    }

    fn write(&self) -> Option<Toml> {
        Some(Toml::String(self.clone()))
    }
}

impl<T: Value + Default> Value for Option<T> {
    fn kind() -> Kind {
        T::kind()
    }

    fn is_optional() -> bool {
        true
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        self.insert(T::default()).read(node)
    }

    fn write(&self) -> Option<Toml> {
        self.as_ref().and_then(T::write)
    }

    fn check(&self, key: &Key, findings: &mut Findings) {
        if let Some(value) = self {
            value.check(key, findings);
        }
    }

    fn number(&self) -> Option<f64> {
        self.as_ref().and_then(T::number)
    }

    fn set_number(&mut self, number: f64) -> Result<(), String> {
        self.get_or_insert_with(T::default).set_number(number)
    }

    fn is_absent(&self) -> bool {
        self.is_none()
    }

    fn in_words(&self, key: &Key) -> Option<String> {
        self.as_ref()?.in_words(key)
    }
}

/// A TOML table with one entry.
pub(super) fn entry(key: &str, value: impl Into<Toml>) -> Toml {
    Toml::Table([(key.to_string(), value.into())].into_iter().collect())
}

/// Type of a list of values.
fn list_of(kind: Kind) -> Kind {
    match kind {
        Kind::Number => Kind::Numbers,
        other => other,
    }
}

/// End of the message on a refused list: a hint if the list would have one of the lengths with decimal commas, otherwise empty.
pub(super) fn decimal_commas(numbers: &[f64], lengths: &[usize]) -> String {
    let is_whole = |number: &f64| number.fract() == 0.0;
    let pairs = numbers
        .chunks_exact(2)
        .filter(|pair| pair.iter().all(is_whole) && pair[1] >= 0.0);
    let joined: Vec<String> = pairs.map(|pair| format!("{}.{}", pair[0], pair[1])).collect();
    match 2 * joined.len() == numbers.len() && lengths.contains(&joined.len()) {
        true => format!(
            ": if these are decimal commas, write points, [{}]",
            joined.join(", ")
        ),
        false => String::new(),
    }
}

/// Reads the elements of an array one by one.
fn read_all<T: Value + Default>(node: &Node<'_>, mut keep: impl FnMut(T)) -> Result<(), SceneError> {
    for element in node.elements().ok_or_else(|| node.expected("an array"))? {
        keep(element.read()?);
    }
    Ok(())
}

impl<T: Value + Default, const N: usize> Value for [T; N] {
    fn kind() -> Kind {
        list_of(T::kind())
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        let expected = format!("an array of {N} numbers");
        let elements = node.elements().ok_or_else(|| node.expected(&expected))?;
        let count = elements.len();
        if count != N {
            let numbers = elements.map_while(|element| element.number("a number").ok());
            let commas = decimal_commas(&numbers.collect::<Vec<f64>>(), &[N]);
            return Err(node.expected_instead_of(&expected, &format!("an array of {count}{commas}")));
        }
        let mut index = 0;
        read_all(node, |value| {
            self[index] = value;
            index += 1;
        })
    }

    fn write(&self) -> Option<Toml> {
        Some(Toml::Array(self.iter().filter_map(T::write).collect()))
    }

    fn check(&self, key: &Key, findings: &mut Findings) {
        for (index, value) in self.iter().enumerate() {
            findings.below(|| format!("[{index}]"), |findings| value.check(key, findings));
        }
    }

    fn in_words(&self, key: &Key) -> Option<String> {
        let words: Vec<String> = self.iter().filter_map(|value| value.in_words(key)).collect();
        Some(words.join(" and "))
    }
}

impl<T: Value + Default> Value for Vec<T> {
    fn kind() -> Kind {
        list_of(T::kind())
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        self.clear();
        read_all(node, |value| self.push(value))
    }

    fn write(&self) -> Option<Toml> {
        (!self.is_empty()).then(|| Toml::Array(self.iter().filter_map(T::write).collect()))
    }

    fn check(&self, key: &Key, findings: &mut Findings) {
        let known = findings.mistakes.len();
        let is_plain = |value: &T| {
            value
                .number()
                .is_some_and(|number| key.rule.bounds.accepts(number))
        };
        for (index, value) in self.iter().enumerate().filter(|(_, value)| !is_plain(value)) {
            findings.below(|| format!("[{index}]"), |findings| value.check(key, findings));
            if matches!(T::kind(), Kind::Number | Kind::Numbers) && findings.mistakes.len() > known {
                return; // one mistake per list of numbers is enough
            }
        }
    }
}

impl<T: Value + Default> Value for BTreeMap<String, T> {
    fn kind() -> Kind {
        match T::kind() {
            Kind::Table(schema) => Kind::ByName(schema),
            other => other,
        }
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        for entry in node.entries().ok_or_else(|| node.expected("a table"))? {
            self.insert(entry.name().to_string(), entry.value.read()?);
        }
        Ok(())
    }

    fn write(&self) -> Option<Toml> {
        let entries = self
            .iter()
            .filter_map(|(name, value)| Some((name.clone(), value.write()?)));
        (!self.is_empty()).then(|| Toml::Table(entries.collect()))
    }

    fn check(&self, key: &Key, findings: &mut Findings) {
        for (name, value) in self {
            findings.below(
                || super::path::quoted(name),
                |findings| value.check(key, findings),
            );
        }
    }
}

table::choice!(@value AngleOrder, [
    ("zyx", Zyx, ["R = Rz(yaw)·Ry(pitch)·Rx(roll), the order of the FMU's variables."]),
    ("xyz", Xyz, ["R = Rx(roll)·Ry(pitch)·Rz(yaw), the order of MoorDyn."])
]);
