//! How many threads share the lines of a system: `threads = "auto"` or a number.

use std::fmt;

use serde::de::{self, Deserialize, Deserializer, Unexpected, Visitor};
use serde::{Serialize, Serializer};

/// Threads that share the lines of a system. Results do not depend on it.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Threads {
    /// As many as pay: one for a few lines.
    #[default]
    Auto,
    /// So many [-], or as many as there are systems of lines that nothing but held points joins.
    Number(usize),
}

impl Threads {
    /// Whether the number is left open.
    pub fn is_auto(&self) -> bool {
        *self == Threads::Auto
    }
}

impl Serialize for Threads {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Threads::Auto => "auto".serialize(serializer),
            Threads::Number(number) => number.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for Threads {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ThreadsVisitor)
    }
}

struct ThreadsVisitor;

impl Visitor<'_> for ThreadsVisitor {
    type Value = Threads;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number of threads, or \"auto\"")
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Threads, E> {
        let number = usize::try_from(value);
        number
            .map(Threads::Number)
            .map_err(|_| de::Error::invalid_value(Unexpected::Signed(value), &self))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Threads, E> {
        let number = usize::try_from(value);
        number
            .map(Threads::Number)
            .map_err(|_| de::Error::invalid_value(Unexpected::Unsigned(value), &self))
    }

    fn visit_str<E: de::Error>(self, value: &str) -> Result<Threads, E> {
        match value {
            "auto" => Ok(Threads::Auto),
            _ => Err(de::Error::invalid_value(Unexpected::Str(value), &self)),
        }
    }
}
