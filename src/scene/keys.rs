//! The keys of the scene format, as the reader has them.

use std::fmt::Display;

use serde::Deserialize;
use serde::de::value::StrDeserializer;
use serde::de::{self, DeserializeSeed, Deserializer, MapAccess, Visitor};
use serde::forward_to_deserialize_any;

use super::seabed::Directions;
use super::time_function::MotionText;
use super::{
    AngleOrder, Axis, Bossak, Break, ContactLaw, Current, DepthGrid, FibreLaw, InitialShape, Integrator,
    Line, LineModel, LineType, Output, Point, PointForce, PointKind, PointMoment, Rayleigh, Reconstruction,
    RegularWave, RestShape, Scene, Sea, Seabed, Section, SolidSection, Solver, SpectrumKind, Strain,
    TensionStrain, TimeFunction, Vessel, Water, Winch, channel,
};

/// A table of the scene format, or a choice of words, by the name of its type.
pub type Known = (&'static str, &'static [&'static str]);

/// Returns every table of the scene format with its keys, those of serde's derived readers and those written by hand.
pub fn tables() -> Vec<Known> {
    vec![
        ("Scene", known::<Scene>()),
        ("Water", known::<Water>()),
        ("Current", known::<Current>()),
        ("Sea", known::<Sea>()),
        ("RegularWave", known::<RegularWave>()),
        ("Seabed", known::<Seabed>()),
        ("DepthGrid", known::<DepthGrid>()),
        ("Directions", known::<Directions>()),
        ("LineType", known::<LineType>()),
        ("TensionStrain", known::<TensionStrain>()),
        ("SolidSection", known::<SolidSection>()),
        ("Rayleigh", known::<Rayleigh>()),
        ("Point", known::<Point>()),
        ("PointForce", known::<PointForce>()),
        ("PointMoment", known::<PointMoment>()),
        ("TimeFunction", known::<TimeFunction>()),
        ("MotionText", known::<MotionText>()),
        ("Vessel", known::<Vessel>()),
        ("Line", known::<Line>()),
        ("Section", known::<Section>()),
        ("Break", known::<Break>()),
        ("Winch", known::<Winch>()),
        ("Solver", known::<Solver>()),
        ("Bossak", known::<Bossak>()),
        ("Output", known::<Output>()),
    ]
}

/// Returns every choice of words of the scene format.
pub fn choices() -> Vec<Known> {
    vec![
        ("LineModel", known::<LineModel>()),
        ("FibreLaw", known::<FibreLaw>()),
        ("Strain", known::<Strain>()),
        ("PointKind", known::<PointKind>()),
        ("Axis", known::<Axis>()),
        ("RestShape", known::<RestShape>()),
        ("InitialShape", known::<InitialShape>()),
        ("Integrator", known::<Integrator>()),
        ("Reconstruction", known::<Reconstruction>()),
        ("AngleOrder", known::<AngleOrder>()),
        ("ContactLaw", known::<ContactLaw>()),
        ("SpectrumKind", known::<SpectrumKind>()),
        ("LineEnd", known::<channel::LineEnd>()),
    ]
}

/// Returns the keys or words that a type is refused for want of, where it is given one that nothing has.
fn known<T: for<'de> Deserialize<'de>>() -> &'static [&'static str] {
    match T::deserialize(Stranger) {
        Err(Refusal(Some(known))) => known,
        _ => unreachable!("every table and choice refuses what it does not know"),
    }
}

/// A table with one key, and a word, that nothing knows.
struct Stranger;

const STRANGE: &str = "?";

/// The names that were expected in place of the stranger.
#[derive(Debug)]
struct Refusal(Option<&'static [&'static str]>);

impl Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

impl std::error::Error for Refusal {}

impl de::Error for Refusal {
    fn custom<T: Display>(_: T) -> Self {
        Refusal(None)
    }

    fn unknown_field(_: &str, known: &'static [&'static str]) -> Self {
        Refusal(Some(known))
    }

    fn unknown_variant(_: &str, known: &'static [&'static str]) -> Self {
        Refusal(Some(known))
    }
}

impl<'de> Deserializer<'de> for Stranger {
    type Error = Refusal;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_map(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        visitor.visit_enum(StrDeserializer::new(STRANGE))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit
        unit_struct newtype_struct seq tuple tuple_struct map struct identifier ignored_any
    }
}

impl<'de> MapAccess<'de> for Stranger {
    type Error = Refusal;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Refusal> {
        seed.deserialize(StrDeserializer::new(STRANGE)).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Refusal> {
        seed.deserialize(Stranger)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_that_the_reader_can_read_is_on_the_list() {
        let sources = [
            include_str!("mod.rs"),
            include_str!("waves.rs"),
            include_str!("seabed.rs"),
            include_str!("tension_strain.rs"),
            include_str!("time_function.rs"),
            include_str!("channel.rs"),
        ];
        let listed: Vec<_> = tables().into_iter().chain(choices()).collect();
        for source in sources {
            let mut derived = false;
            for line in source.lines() {
                derived |= line.starts_with("#[derive(") && line.contains("Deserialize");
                derived &= !line.contains("try_from");
                let mut words = line.split_whitespace().skip_while(|word| word.starts_with("pub"));
                if let (Some("struct" | "enum"), Some(name), true) = (words.next(), words.next(), derived) {
                    let name = name.trim_end_matches(['{', ';']);
                    assert!(listed.iter().any(|(known, _)| *known == name), "{name}");
                    derived = false;
                }
            }
        }
        assert!(listed.iter().all(|(_, keys)| !keys.is_empty()));
    }
}
