//! The property table: one entry for each key of the scene format. See the module documentation of [`crate::scene`].

use toml::Value as Toml;

use super::SceneError;
use super::check::{Bounds, Findings};
use super::document::Node;
use super::nearest::suggestion;

/// A key of the scene format.
#[derive(Clone, Copy)]
pub struct Key {
    pub(super) field: &'static str,
    /// Lines of the doc comment of the field.
    pub(super) doc: &'static [&'static str],
    /// Bounds, spellings and other facts in addition to the type and the doc comment.
    pub rule: Rule,
    pub(super) kind: fn() -> Kind,
    pub(super) is_optional: fn() -> bool,
}

impl Key {
    /// Returns whether a table needs the key.
    pub(crate) fn is_required(&self) -> bool {
        !(self.is_optional)()
    }

    /// Name in a scene.
    pub fn name(&self) -> &'static str {
        self.rule.name.unwrap_or(self.field)
    }

    /// Returns whether the key may have this name in a scene.
    fn is_called(&self, name: &str) -> bool {
        self.name() == name || self.rule.alias == Some(name)
    }

    /// Type of the value.
    pub fn kind(&self) -> Kind {
        (self.kind)()
    }

    /// Doc comment of the field, in one line.
    pub fn text(&self) -> String {
        in_line(self.doc)
    }

    /// Unit of its numbers: that of the rule, or the first one in brackets in the doc comment; `None` for a key without numbers.
    pub fn unit(&self) -> Option<&'static str> {
        match self.rule.bounds {
            Bounds::Elsewhere => self.rule.unit,
            _ if self.kind().is_numeric() => self.rule.unit.or_else(|| unit(self.doc)),
            _ => None,
        }
    }

    /// Short meaning, for descriptions in the FMU and the sentences of `check`: the beginning of the doc comment without units.
    pub fn meaning(&self) -> String {
        meaning(self.doc)
    }

    /// Name of the property in the sentences of `check`.
    pub fn label(&self) -> String {
        self.rule.label.map_or_else(|| self.meaning(), str::to_string)
    }
}

/// A doc comment in one line.
fn in_line(doc: &[&str]) -> String {
    let lines: Vec<&str> = doc.iter().map(|line| line.trim()).collect();
    lines.join(" ")
}

/// The first unit in brackets in a doc comment.
pub(crate) fn unit(doc: &[&'static str]) -> Option<&'static str> {
    let mut inside = doc.iter().flat_map(|line| line.split('[').skip(1));
    inside.find_map(|rest| rest.split_once(']').map(|(unit, _)| unit))
}

/// The beginning of a doc comment, without units and the final stop.
pub(crate) fn meaning(doc: &[&str]) -> String {
    let mut meaning = String::new();
    let mut depth = 0;
    for c in in_line(doc).chars() {
        match c {
            '[' => depth += 1,
            ']' => depth -= 1,
            '.' | ';' | ':' if depth == 0 => break,
            _ if depth == 0 => meaning.push(c),
            _ => {}
        }
    }
    let meaning = meaning.trim().replace("  ", " ").replace(" ,", ",");
    let mut letters = meaning.chars();
    let first = letters.next().map(|c| c.to_lowercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

/// Facts about a key that its type and doc comment do not contain.
#[derive(Clone, Copy)]
pub struct Rule {
    name: Option<&'static str>,
    /// Second name that is also read.
    pub alias: Option<&'static str>,
    /// Names in decks, papers and other programs, in lower case, for "did you mean"; the first is the column of MoorDyn, where there is one.
    pub spellings: &'static [&'static str],
    unit: Option<&'static str>,
    /// Keys of the same table that cannot be given together with it.
    pub excluded: &'static [&'static str],
    /// Numbers that are accepted.
    pub bounds: Bounds,
    /// Sentence that ends the refusal of a negative number, or of a magnitude beyond its limit.
    pub hint: Option<&'static str>,
    /// Range usual in moorings [unit of the key], and the note on numbers outside it.
    pub usual: Option<([f64; 2], &'static str)>,
    /// Circumstances under which the property acts on a line or point.
    pub acts: Acts,
    label: Option<&'static str>,
    /// Name of the force or effect that is not modelled if the key is left out.
    pub absence: Option<&'static str>,
    /// True if the FMU has it as a parameter, which is fixed after initialization.
    pub is_parameter: bool,
    /// Description of the FMU's parameter, where it differs from the meaning of the key.
    pub described: Option<&'static str>,
}

/// Circumstances under which a property acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Acts {
    /// At rest and in motion.
    Always,
    /// On moving lines only, not in quasi-static runs.
    InMotion,
    /// In water, at rest and in motion.
    InWater,
    /// In water that flows past the line.
    InFlow,
    /// In water, on accelerations.
    InAccelerations,
}

/// Rule without further facts: numbers must be finite.
pub(super) const PLAIN: Rule = Rule {
    name: None,
    alias: None,
    spellings: &[],
    unit: None,
    excluded: &[],
    bounds: Bounds::Finite,
    hint: None,
    usual: None,
    acts: Acts::Always,
    label: None,
    absence: None,
    is_parameter: false,
    described: None,
};

/// Rule of a key whose numbers have several units, and whose bounds are checked by the code of its value.
pub(super) const MIXED: Rule = bounded(Bounds::Elsewhere);

const fn bounded(bounds: Bounds) -> Rule {
    Rule { bounds, ..PLAIN }
}

/// Numbers above 0, up to a limit.
pub(super) const fn positive(limit: f64) -> Rule {
    bounded(Bounds::Positive(limit))
}

/// Numbers from 0 to a limit.
pub(super) const fn not_negative(limit: f64) -> Rule {
    bounded(Bounds::NotNegative(limit))
}

/// Numbers with a magnitude up to a limit.
pub(super) const fn magnitude(limit: f64) -> Rule {
    bounded(Bounds::Magnitude(limit))
}

/// Numbers from one value to another, both included.
pub(super) const fn within(least: f64, most: f64) -> Rule {
    bounded(Bounds::Within(least, most))
}

/// Declares methods that add a fact to a rule.
macro_rules! facts {
    ($($(#[doc = $doc:literal])+ $name:ident($($fact:ident: $type:ty),+) $field:ident = $value:expr;)+) => {
        impl Rule {
            $($(#[doc = $doc])+
            pub(super) const fn $name(self, $($fact: $type),+) -> Rule {
                Rule { $field: $value, ..self }
            })+
        }
    };
}

facts! {
    /// Name in a scene, where it differs from the field.
    called(name: &'static str) name = Some(name);
    /// Second name that is also read.
    or_called(alias: &'static str) alias = Some(alias);
    /// Names in decks, papers and other programs.
    elsewhere(names: &'static [&'static str]) spellings = names;
    /// Keys that cannot be given together with it.
    instead_of(keys: &'static [&'static str]) excluded = keys;
    /// Units of a list that holds several quantities.
    in_units(unit: &'static str) unit = Some(unit);
    /// Sentence that ends the refusal of a negative number, or of a magnitude beyond its limit.
    hint(hint: &'static str) hint = Some(hint);
    /// Range usual in moorings, and the note on numbers outside it.
    usual(range: [f64; 2], note: &'static str) usual = Some((range, note));
    /// Circumstances under which the property acts.
    acts(acts: Acts) acts = acts;
    /// Name in the sentences of `check`.
    label(label: &'static str) label = Some(label);
    /// Effect that is missing if the key is left out.
    absence(absence: &'static str) absence = Some(absence);
    /// Description of the FMU's parameter, instead of the meaning of the key.
    in_fmu(description: &'static str) described = Some(description);
}

impl Rule {
    /// Unit given by the rule.
    pub(super) const fn unit(&self) -> Option<&'static str> {
        self.unit
    }

    /// Parameter of the FMU.
    pub(super) const fn parameter(self) -> Rule {
        let is_parameter = true;
        Rule { is_parameter, ..self }
    }

    /// Parameter of the FMU with its own description.
    pub(super) const fn described(self, description: &'static str) -> Rule {
        self.parameter().in_fmu(description)
    }
}

/// Type of a value.
#[derive(Clone, Copy)]
pub enum Kind {
    /// A number.
    Number,
    /// A list of numbers, or of rows of numbers.
    Numbers,
    /// A whole number.
    Count,
    /// `true` or `false`.
    Truth,
    /// A text, or a list of texts.
    Text,
    /// One of several words, with their meanings; some hold a value.
    Words(Words),
    /// A table, or a list of tables.
    Table(Schema),
    /// Tables by name.
    ByName(Schema),
    /// A number, rows of numbers or a table.
    NumberOrTable(Schema),
}

impl Kind {
    fn is_numeric(self) -> bool {
        matches!(
            self,
            Kind::Number | Kind::Numbers | Kind::Count | Kind::NumberOrTable(_)
        )
    }
}

/// Words of a choice with their meanings.
#[derive(Clone, Copy)]
pub struct Words {
    /// Name of the type.
    pub name: &'static str,
    /// Each word and its meaning.
    pub words: &'static [(&'static str, &'static str)],
}

/// Keys of a table.
#[derive(Clone, Copy)]
pub struct Schema {
    /// Name of the type.
    pub name: &'static str,
    /// Heading on the reference page.
    pub title: &'static str,
    /// Doc comment of the type, line by line.
    pub doc: &'static [&'static str],
    /// Keys in the order of the page.
    pub keys: &'static [Key],
    /// Values of keys that are left out.
    pub defaults: fn() -> Vec<Option<Toml>>,
}

impl Schema {
    /// The key with this name.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.is_called(name))
    }
}

/// A value of the scene format.
pub trait Value {
    /// Type of the value.
    fn kind() -> Kind
    where
        Self: Sized;
    /// Returns whether a table may leave the key out without giving a default.
    fn is_optional() -> bool
    where
        Self: Sized,
    {
        false
    }
    /// Reads the value.
    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError>;
    /// The value as TOML; `None` if it is absent.
    fn write(&self) -> Option<Toml>;
    /// Adds the mistakes in the value itself: numbers out of bounds, rows out of order.
    fn check(&self, _key: &Key, _findings: &mut Findings) {}
    /// Number, in the unit of the key; `None` for a value that is not a number.
    fn number(&self) -> Option<f64> {
        None
    }
    /// Sets the number. Bounds are left to [`Value::check`].
    ///
    /// # Errors
    /// A number that denotes no word of a choice.
    fn set_number(&mut self, _number: f64) -> Result<(), String> {
        Ok(())
    }
    /// Returns whether the key was left out.
    fn is_absent(&self) -> bool {
        false
    }
    /// Value in the sentences of `check`; `None` for a value that is described together with others.
    fn in_words(&self, _key: &Key) -> Option<String> {
        None
    }
}

/// A table of the scene format.
pub trait Table: Default {
    /// Keys and headings.
    const SCHEMA: Schema;
    /// Values in the order of the keys.
    fn values(&self) -> Vec<&dyn Value>;
    /// Values in the order of the keys.
    fn values_mut(&mut self) -> Vec<&mut dyn Value>;

    /// Keys with their values.
    fn entries(&self) -> impl Iterator<Item = (&'static Key, &dyn Value)> {
        Self::SCHEMA.keys.iter().zip(self.values())
    }

    /// The value of a key.
    fn get(&self, name: &str) -> Option<&dyn Value> {
        self.entries()
            .find(|(key, _)| key.name() == name)
            .map(|(_, value)| value)
    }

    /// The value of a key.
    fn get_mut(&mut self, name: &str) -> Option<&mut dyn Value> {
        let index = Self::SCHEMA.keys.iter().position(|key| key.name() == name)?;
        self.values_mut().into_iter().nth(index)
    }
}

impl<T: Table> Value for T {
    fn kind() -> Kind {
        Kind::Table(T::SCHEMA)
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        let keys = T::SCHEMA.keys;
        let entries = node.entries().ok_or_else(|| node.expected("a table"))?;
        let mut is_read = vec![false; keys.len()];
        for entry in entries {
            let name = entry.name();
            let Some(index) = keys.iter().position(|key| key.is_called(name)) else {
                let suggestion = suggestion(name, "known keys", keys.iter().map(Key::name));
                return Err(entry.refuse(format!("unknown key `{name}`{suggestion}")));
            };
            let key = &keys[index];
            if is_read[index] {
                let problem = format!("`{}` is given twice, under both of its names", key.name());
                return Err(entry.refuse(problem));
            }
            is_read[index] = true;
            self.values_mut()[index].read(&entry.value.in_unit(key.unit()))?;
        }
        match keys
            .iter()
            .zip(is_read)
            .find(|(key, read)| key.is_required() && !read)
        {
            None => Ok(()),
            Some((key, _)) => {
                let unit = key.unit().map_or_else(String::new, |unit| format!(" [{unit}]"));
                Err(node.refuse(format!("missing key `{}`{unit}", key.name())))
            }
        }
    }

    fn write(&self) -> Option<Toml> {
        let entries = self
            .entries()
            .filter_map(|(key, value)| Some((key.name().to_string(), value.write()?)));
        Some(Toml::Table(entries.collect()))
    }

    fn check(&self, _key: &Key, findings: &mut Findings) {
        check_table(self, findings);
    }

    fn in_words(&self, _key: &Key) -> Option<String> {
        Some(super::words::group(self))
    }
}

/// Adds the mistakes in each value of a table, and keys that exclude one another.
pub(super) fn check_table<T: Table>(table: &T, findings: &mut Findings) {
    for (key, value) in table.entries().filter(|(_, value)| !value.is_absent()) {
        findings.below(|| key.name().to_string(), |findings| value.check(key, findings));
        let given = |name: &&&str| table.get(name).is_some_and(|other| !other.is_absent());
        if let Some(other) = key.rule.excluded.iter().find(given) {
            findings.say(key.name(), format!("`{other}` is given too: give one of them"));
        }
    }
}

/// Declares a table of the scene format: its struct, and next to each field the rule of its key. The doc comment of a field is the text of the
/// reference page and gives the unit of the number. A field has a default after `=`, is optional by its type, or is required.
macro_rules! table {
    (
        $(#[doc = $about:literal])+ $(#[derive($($derive:ident),+)])?
        $vis:vis struct $name:ident, $title:literal {
            $($(#[doc = $doc:literal])+ $field_vis:vis $field:ident: $type:ty $(= $default:expr)? $(=> $rule:expr)?,)+
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Debug, Clone, PartialEq $($(, $derive)+)?)]
        $vis struct $name {
            $($(#[doc = $doc])+ $field_vis $field: $type,)+
        }

        impl Default for $name {
            fn default() -> Self {
                $name { $($field: $crate::scene::table::table!(@default $type $(, $default)?),)+ }
            }
        }

        impl $crate::scene::table::Table for $name {
            const SCHEMA: $crate::scene::table::Schema = $crate::scene::table::Schema {
                name: stringify!($name),
                title: $title,
                doc: &[$($about),+],
                keys: &[$($crate::scene::table::Key {
                    field: stringify!($field),
                    doc: &[$($doc),+],
                    rule: $crate::scene::table::table!(@rule $($rule)?),
                    kind: <$type as $crate::scene::table::Value>::kind,
                    is_optional: $crate::scene::table::table!(@optional $type $(, $default)?),
                }),+],
                defaults: || {
                    let blank = $name::default();
                    let values = $crate::scene::table::Table::values(&blank);
                    values.into_iter().map(|value| value.write()).collect()
                },
            };

            fn values(&self) -> Vec<&dyn $crate::scene::table::Value> {
                vec![$(&self.$field),+]
            }

            fn values_mut(&mut self) -> Vec<&mut dyn $crate::scene::table::Value> {
                vec![$(&mut self.$field),+]
            }
        }
    };
    (@default $type:ty) => { <$type as Default>::default() };
    (@default $type:ty, $default:expr) => { $default };
    (@optional $type:ty) => { <$type as $crate::scene::table::Value>::is_optional };
    (@optional $type:ty, $default:expr) => { || true };
    (@rule) => { $crate::scene::table::PLAIN };
    (@rule $rule:expr) => { $rule };
}

/// Declares a choice of words: an enum, and for each variant the word in a scene. The doc comment of a variant is its meaning on the
/// reference page; the first variant is the default.
macro_rules! choice {
    ($(#[doc = $about:literal])+ $vis:vis enum $name:ident {
        $($(#[doc = $doc:literal])+ $variant:ident = $word:literal,)+
    }) => {
        $(#[doc = $about])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        $vis enum $name {
            $($(#[doc = $doc])+ $variant,)+
        }

        impl Default for $name {
            fn default() -> $name {
                <$name as $crate::scene::table::Choice>::WORDS[0].1
            }
        }

        $crate::scene::table::choice!(@value $name, [$(($word, $variant, [$($doc),+])),+]);
    };
    (@value $name:ident, [$(($word:literal, $variant:ident, [$($doc:literal),+])),+]) => {
        impl $crate::scene::table::Choice for $name {
            const WORDS: &'static [(&'static str, $name)] = &[$(($word, $name::$variant)),+];
            const MEANINGS: $crate::scene::table::Words = $crate::scene::table::Words {
                name: stringify!($name),
                words: &[$(($word, concat!($($doc),+))),+],
            };
        }

        impl $crate::scene::table::Value for $name {
            fn kind() -> $crate::scene::table::Kind {
                $crate::scene::table::Kind::Words(<$name as $crate::scene::table::Choice>::MEANINGS)
            }

            fn read(&mut self, node: &$crate::scene::document::Node<'_>) -> Result<(), $crate::scene::SceneError> {
                *self = $crate::scene::table::read_choice(node)?;
                Ok(())
            }

            fn write(&self) -> Option<toml::Value> {
                Some($crate::scene::table::Choice::word(*self).into())
            }

            fn in_words(&self, _: &$crate::scene::table::Key) -> Option<String> {
                Some($crate::scene::table::Choice::word(*self).to_string())
            }

            fn number(&self) -> Option<f64> {
                $crate::scene::table::Choice::place(*self).map(|place| place as f64)
            }

            fn set_number(&mut self, number: f64) -> Result<(), String> {
                *self = $crate::scene::table::numbered_choice(number)?;
                Ok(())
            }
        }
    };
}

/// Declares a choice of words of which the last ones hold a value, written `{ word = value }`: an enum with the word of each variant, and the rule
/// of each value. The doc comments are the meanings on the reference page; the first variant is the default.
macro_rules! choice_of_values {
    ($(#[doc = $about:literal])+ $(#[derive($($derive:ident),+)])? $vis:vis enum $name:ident {
        $($(#[doc = $doc:literal])+ $plain:ident = $word:literal),+;
        $($(#[doc = $held_doc:literal])+ $held:ident($type:ty) = $held_word:literal => $rule:expr,)+
    }) => {
        $(#[doc = $about])+
        #[derive(Debug, Clone, PartialEq $($(, $derive)+)?)]
        $vis enum $name {
            $($(#[doc = $doc])+ $plain,)+
            $($(#[doc = $held_doc])+ $held($type),)+
        }

        impl Default for $name {
            fn default() -> $name {
                let [first, ..] = [$($name::$plain),+];
                first
            }
        }

        impl $crate::scene::table::Value for $name {
            fn kind() -> $crate::scene::table::Kind {
                $crate::scene::table::Kind::Words($crate::scene::table::Words {
                    name: stringify!($name),
                    words: &[
                        $(($word, concat!($($doc),+)),)+
                        $(($held_word, concat!($($held_doc),+)),)+
                    ],
                })
            }

            fn read(&mut self, node: &$crate::scene::document::Node<'_>) -> Result<(), $crate::scene::SceneError> {
                let known = [$(($word, None),)+ $(($held_word, $rule.unit()),)+];
                *self = match node.word(known.into_iter())? {
                    $(($held_word, Some(node)) => $name::$held(node.read()?),)+
                    $(($word, _) => $name::$plain,)+
                    _ => $name::default(),
                };
                Ok(())
            }

            fn write(&self) -> Option<toml::Value> {
                Some(match self {
                    $($name::$plain => $word.into(),)+
                    $($name::$held(value) => $crate::scene::value::entry($held_word, value.write()?),)+
                })
            }

            fn check(&self, key: &$crate::scene::table::Key, findings: &mut $crate::scene::check::Findings) {
                match self {
                    $($name::$held(value) => {
                        let key = $crate::scene::table::Key { rule: $rule, kind: <$type>::kind, ..*key };
                        findings.below(|| $held_word.to_string(), |findings| value.check(&key, findings));
                    })+
                    _ => {}
                }
            }
        }
    };
}

pub(super) use {choice, choice_of_values, table};

/// A choice of words.
pub trait Choice: Copy + PartialEq + 'static {
    /// Words in a scene.
    const WORDS: &'static [(&'static str, Self)];
    /// Words with their meanings.
    const MEANINGS: Words;

    /// Index among the words, from 0.
    fn place(self) -> Option<usize> {
        Self::WORDS.iter().position(|(_, value)| *value == self)
    }

    /// Word in a scene.
    fn word(self) -> &'static str {
        self.place().map_or("", |place| Self::WORDS[place].0)
    }
}

/// Reads a word.
pub(super) fn read_choice<T: Choice>(node: &Node<'_>) -> Result<T, SceneError> {
    let words = || T::WORDS.iter();
    let (word, _) = node.word(words().map(|(word, _)| (*word, None)))?;
    let known = words().find(|(known, _)| *known == word);
    Ok(known.expect("the word is one of these").1)
}

/// Choice that a number denotes in the FMU.
pub(super) fn numbered_choice<T: Choice>(number: f64) -> Result<T, String> {
    let words = T::WORDS.iter().enumerate();
    let found = words.clone().find(|(place, _)| *place as f64 == number);
    found.map(|(_, (_, value))| *value).ok_or_else(|| {
        let known: Vec<String> = words
            .map(|(place, (word, _))| format!("{place} ({word})"))
            .collect();
        format!("{number} is neither {}", known.join(" nor "))
    })
}
