//! Setting a key of a scene by its path, such as `lines.line1.length`.
//!
//! A path consists of the keys of the scene format from the top. Lines, points and vessels are addressed by name, parts of other lists by `[0]`.
//! The index of a list with a single part may be left out, as for the only sea of `water.waves` or the only section of a line:
//! `lines.line1.length` is the length of its section. `seed` is short for `water.waves.seed`.

use std::fmt::Write;

use moorline::scene::Scene;
use moorline::scene::nearest::suggestion;
use moorline::scene::path::quoted;
use moorline::scene::table::{Kind, Schema, Table};
use toml::Value;

/// One step of a path.
#[derive(Debug, Clone, PartialEq)]
enum Step {
    Key(String),
    Index(usize),
}

/// Paths that have a short name.
const SHORT: [(&str, &[&str]); 1] = [("seed", &["water", "waves", "seed"])];
/// Lists whose keys may be written without the name of the list.
const PASSED: &str = "sections";
/// Levels of tables in which a misplaced key is looked up [-].
const DEPTH: usize = 4;

/// Place of a value in the document of a scene.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Place {
    steps: Vec<Step>,
    /// Second name of the key, which must not be given together with it.
    alias: Option<&'static str>,
    /// Unit of the number.
    pub unit: Option<&'static str>,
}

/// Kinds of values on the way down a path.
#[derive(Clone, Copy)]
enum At {
    /// A table, or a list of tables.
    Table(Schema),
    /// Tables by name.
    ByName(Schema),
    /// A value, or a list of values.
    Plain,
}

impl At {
    fn of(kind: Kind, value: Option<&Value>) -> At {
        match kind {
            Kind::Table(schema) => At::Table(schema),
            Kind::NumberOrTable(schema) if value.is_none_or(Value::is_table) => At::Table(schema),
            Kind::ByName(schema) => At::ByName(schema),
            _ => At::Plain,
        }
    }
}

impl Place {
    /// Finds the place of a path in a document.
    ///
    /// # Errors
    /// The step that leads nowhere, and its correction.
    pub(crate) fn find(document: &Value, path: &str) -> Result<Place, String> {
        let steps = match SHORT.iter().find(|(short, _)| *short == path) {
            Some((_, long)) => long.iter().map(|key| Step::Key((*key).to_string())).collect(),
            None => steps(path)?,
        };
        let mut walk = Walk {
            document,
            value: Some(document),
            at: At::Table(Scene::SCHEMA),
            place: Place {
                steps: Vec::new(),
                alias: None,
                unit: None,
            },
        };
        for step in &steps {
            walk.step(step)?;
        }
        Ok(walk.place)
    }

    /// Path as the reader of scenes writes it.
    pub(crate) fn path(&self) -> String {
        rendered(&self.steps)
    }

    /// Returns whether the value is the name of a file.
    pub(crate) fn is_file(&self) -> bool {
        self.steps.last() == Some(&Step::Key("file".to_string()))
    }

    /// Returns whether the value belongs to the motions of the scene.
    pub(crate) fn is_motion(&self) -> bool {
        self.steps.first() == Some(&Step::Key("motion".to_string()))
    }

    /// Returns whether only one of two places can have a value in a case: one contains the other, or one is the file of a motion to which the other
    /// belongs.
    pub(crate) fn excludes(&self, other: &Place) -> bool {
        let holds =
            |one: &Place, other: &Place| other.steps.starts_with(one.replaced().unwrap_or(&one.steps));
        holds(self, other) || holds(other, self)
    }

    /// Steps to the motion that a file here replaces.
    fn replaced(&self) -> Option<&[Step]> {
        let (_, above) = self.steps.split_last()?;
        let is_motion = above.contains(&Step::Key("motion".to_string()));
        (is_motion && self.is_file()).then_some(above)
    }

    /// Sets the value in a document with the same lists; missing tables are created. If a motion becomes a file, its other keys are removed.
    pub(crate) fn set(&self, document: &mut Value, new: Value) {
        let Some((last, above)) = self.steps.split_last() else {
            return;
        };
        let mut holder = document;
        for step in above {
            holder = match step {
                Step::Key(key) => {
                    let empty = || Value::Table(toml::Table::new());
                    as_table(holder).entry(key.clone()).or_insert_with(empty)
                }
                Step::Index(index) => &mut holder[*index],
            };
        }
        match last {
            Step::Index(index) => holder[*index] = new,
            Step::Key(key) => {
                let table = as_table(holder);
                if self.replaced().is_some() {
                    table.clear();
                }
                if let Some(alias) = self.alias {
                    table.remove(alias);
                }
                table.insert(key.clone(), new);
            }
        }
    }
}

/// Returns a value as a table; a value of another type is replaced by an empty table.
fn as_table(value: &mut Value) -> &mut toml::Table {
    if !value.is_table() {
        *value = Value::Table(toml::Table::new());
    }
    match value {
        Value::Table(table) => table,
        _ => unreachable!("it was made a table"),
    }
}

/// State of the way down a path.
struct Walk<'d> {
    document: &'d Value,
    value: Option<&'d Value>,
    at: At,
    place: Place,
}

impl<'d> Walk<'d> {
    fn step(&mut self, step: &Step) -> Result<(), String> {
        match (self.at, self.value.and_then(Value::as_array), step) {
            (At::Table(schema), Some(list), _) => self.part(schema, list, step),
            (At::Table(schema), None, Step::Key(name)) => self.key(schema, name),
            (At::ByName(schema), _, Step::Key(name)) => self.named(schema, name),
            (At::Plain, Some(list), Step::Index(index)) => self.index(list, *index),
            (_, _, Step::Index(_)) => Err(format!("{} is no list in the base", self.shown())),
            (At::Plain, _, Step::Key(name)) => Err(format!(
                "{} is a value without keys: `{name}` leads nowhere",
                self.shown()
            )),
        }
    }

    fn shown(&self) -> String {
        match self.place.path() {
            path if path.is_empty() => "the scene".to_string(),
            path => format!("`{path}`"),
        }
    }

    fn enter(&mut self, step: Step, value: Option<&'d Value>, at: At) {
        self.place.steps.push(step);
        (self.value, self.at, self.place.alias) = (value, at, None);
    }

    fn index(&mut self, list: &'d [Value], index: usize) -> Result<(), String> {
        match list.get(index) {
            Some(value) => {
                self.enter(Step::Index(index), Some(value), self.at);
                Ok(())
            }
            None => Err(format!(
                "{} has {} parts, [0] being the first: there is no [{index}]",
                self.shown(),
                list.len()
            )),
        }
    }

    /// Enters a part of a list of tables, by name or index; or a key of its only part.
    fn part(&mut self, schema: Schema, list: &'d [Value], step: &Step) -> Result<(), String> {
        let name = match step {
            Step::Index(index) => return self.index(list, *index),
            Step::Key(name) => name,
        };
        if schema.key("name").is_none() {
            if list.len() != 1 {
                let path = self.place.path();
                return Err(format!(
                    "`{path}` has {} parts in the base: write `{path}[0].{name}` of the first",
                    list.len()
                ));
            }
            self.index(list, 0)?;
            return self.step(step);
        }
        let names = || {
            list.iter()
                .map(|part| part.get("name").and_then(Value::as_str).unwrap_or(""))
        };
        match names().position(|known| known == name) {
            Some(index) => self.index(list, index),
            None => {
                let what = self.place.path();
                Err(format!(
                    "no part of `{what}` is called `{name}`{}",
                    suggestion(name, &what, names().collect::<Vec<_>>())
                ))
            }
        }
    }

    fn key(&mut self, schema: Schema, name: &str) -> Result<(), String> {
        if let Some(key) = schema.key(name) {
            let under = |name: &str| self.value.and_then(|value| value.get(name));
            let value = under(key.name()).or(key.rule.alias.and_then(under));
            self.enter(
                Step::Key(key.name().to_string()),
                value,
                At::of(key.kind(), value),
            );
            (self.place.alias, self.place.unit) = (key.rule.alias, key.unit());
            return Ok(());
        }
        let passed = schema.key(PASSED).map(|key| key.kind());
        if let Some(Kind::Table(parts)) = passed
            && parts.key(name).is_some()
        {
            self.key(schema, PASSED)?;
            return self.step(&Step::Key(name.to_string()));
        }
        let known = schema.keys.iter().map(|key| key.name());
        let elsewhere = below(&Scene::SCHEMA, "", name, DEPTH).filter(|_| self.place.steps.is_empty());
        Err(match elsewhere {
            Some(path) => format!("unknown key `{name}`, did you mean `{path}`?"),
            None => format!("unknown key `{name}`{}", suggestion(name, "known keys", known)),
        })
    }

    /// Enters a table by its name. A motion may be new, a line type may not.
    fn named(&mut self, schema: Schema, name: &str) -> Result<(), String> {
        let of = self.place.path();
        let value = self.value.and_then(|value| value.get(name));
        let known: Vec<&str> = match of.as_str() {
            "motion" => ["vessels", "points"]
                .iter()
                .flat_map(|list| names(self.document, list))
                .collect(),
            _ => self
                .value
                .and_then(Value::as_table)
                .map_or(Vec::new(), |table| table.keys().map(String::as_str).collect()),
        };
        if value.is_none() && !known.contains(&name) {
            let what = if of == "motion" { "vessels and points" } else { &of };
            return Err(format!(
                "nothing of `{of}` is called `{name}`{}",
                suggestion(name, what, known)
            ));
        }
        self.enter(Step::Key(name.to_string()), value, At::Table(schema));
        Ok(())
    }
}

/// Names of the parts of a list at the top of a document.
fn names<'d>(document: &'d Value, list: &str) -> impl Iterator<Item = &'d str> {
    let parts = document.get(list).and_then(Value::as_array);
    parts
        .into_iter()
        .flatten()
        .filter_map(|part| part.get("name").and_then(Value::as_str))
}

/// Path of the first key with this name, here or in other programs, in a table and those below it.
fn below(schema: &Schema, above: &str, name: &str, depth: usize) -> Option<String> {
    let lower = name.to_lowercase();
    let is_called = |key: &&moorline::scene::table::Key| {
        key.name() == name || key.rule.spellings.contains(&lower.as_str())
    };
    let path = |key: &moorline::scene::table::Key| match above {
        "" => key.name().to_string(),
        _ => format!("{above}.{}", key.name()),
    };
    if let Some(key) = schema.keys.iter().find(is_called) {
        return Some(path(key));
    }
    schema.keys.iter().filter(|_| depth > 0).find_map(|key| {
        let at = match key.kind() {
            Kind::Table(below) if below.key("name").is_some() => (below, format!("{}.NAME", path(key))),
            Kind::Table(below) => (below, path(key)),
            Kind::ByName(below) => (below, format!("{}.NAME", path(key))),
            _ => return None,
        };
        below(&at.0, &at.1, name, depth - 1)
    })
}

fn rendered(steps: &[Step]) -> String {
    let mut path = String::new();
    for step in steps {
        let dot = if path.is_empty() { "" } else { "." };
        let written = match step {
            Step::Key(key) => write!(path, "{dot}{}", quoted(key)),
            Step::Index(index) => write!(path, "[{index}]"),
        };
        written.expect("a String takes all");
    }
    path
}

/// The steps of a path as written.
fn steps(path: &str) -> Result<Vec<Step>, String> {
    let wrong = || {
        format!(
            "`{path}` is no path of a key: write names with dots between them, such as water.waves.peak_period, and [0] for the first of a list"
        )
    };
    let mut steps = Vec::new();
    let mut rest = path;
    while !rest.is_empty() {
        if let Some(inside) = rest.strip_prefix('[') {
            let (index, after) = inside.split_once(']').ok_or_else(wrong)?;
            steps.push(Step::Index(index.trim().parse().map_err(|_| wrong())?));
            rest = after;
        } else if let Some(inside) = rest.strip_prefix('"') {
            let (key, after) = inside.split_once('"').ok_or_else(wrong)?;
            steps.push(Step::Key(key.to_string()));
            rest = after;
        } else {
            let end = rest.find(['.', '[']).unwrap_or(rest.len());
            let key = rest[..end].trim();
            if key.is_empty() {
                return Err(wrong());
            }
            steps.push(Step::Key(key.to_string()));
            rest = &rest[end..];
        }
        match rest.strip_prefix('.') {
            Some("") => return Err(wrong()),
            Some(after) => rest = after,
            None if rest.is_empty() || rest.starts_with('[') => {}
            None => return Err(wrong()),
        }
    }
    match steps.is_empty() {
        true => Err(wrong()),
        false => Ok(steps),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"
        [water]
        density = 1025.0
        [water.waves]
        spectrum = "jonswap"
        significant_height = 4.0
        [line_types.chain]
        mass = 100.0
        [line_types."a rope"]
        mass = 20.0
        [[points]]
        name = "anchor"
        position = [1.0, 2.0, 3.0]
        [[vessels]]
        name = "semi"
        [[lines]]
        name = "line1"
        sections = [{ type = "chain", length = 450.0 }]
        [[lines]]
        name = "line2"
        sections = [{ type = "chain", length = 450.0 }, { type = "a rope", length = 10.0 }]
        [solver]
        dynamics = "auto"
        [motion]
        semi = { x = [[2.5, 12.0]], ramp = 15.0 }
    "#;

    fn document() -> Value {
        Value::Table(SCENE.parse().unwrap())
    }

    fn path(short: &str) -> String {
        Place::find(&document(), short).unwrap().path()
    }

    #[test]
    fn lines_points_vessels_and_types_are_addressed_by_name() {
        assert_eq!(path("lines.line1.length"), "lines[0].sections[0].length");
        assert_eq!(
            path("lines.line2.sections[1].length"),
            "lines[1].sections[1].length"
        );
        assert_eq!(path("lines[1].sections[0].type"), "lines[1].sections[0].type");
        assert_eq!(path("points.anchor.position[2]"), "points[0].position[2]");
        assert_eq!(path("line_types.chain.mass"), "line_types.chain.mass");
        assert_eq!(path("line_types.\"a rope\".mass"), "line_types.\"a rope\".mass");
        assert_eq!(path("vessels.semi.attitude"), "vessels[0].attitude");
        assert_eq!(path("motion.semi.x[0][1]"), "motion.semi.x[0][1]");
        assert_eq!(path("seed"), "water.waves.seed");
        assert_eq!(path("solver.dynamics"), "solver.integrator");
    }

    #[test]
    fn a_path_that_leads_nowhere_says_where_and_what_is_near() {
        for (path, parts) in [
            (
                "water.waves.significant_heigth",
                [
                    "unknown key `significant_heigth`",
                    "did you mean `significant_height`?",
                ],
            ),
            (
                "peak_period",
                [
                    "unknown key `peak_period`",
                    "did you mean `water.waves.peak_period`?",
                ],
            ),
            (
                "hs",
                [
                    "unknown key `hs`",
                    "did you mean `water.waves.significant_height`?",
                ],
            ),
            (
                "lines.lin1.length",
                ["no part of `lines` is called `lin1`", "did you mean `line1`?"],
            ),
            (
                "lines.line2.length",
                [
                    "`lines[1].sections` has 2 parts",
                    "write `lines[1].sections[0].length`",
                ],
            ),
            (
                "line_types.chian.mass",
                [
                    "nothing of `line_types` is called `chian`",
                    "did you mean `chain`?",
                ],
            ),
            (
                "motion.semmi.x",
                ["nothing of `motion` is called `semmi`", "did you mean `semi`?"],
            ),
            (
                "points.anchor.position[3]",
                ["`points[0].position` has 3 parts", "there is no [3]"],
            ),
            (
                "water.density.value",
                ["`water.density` is a value without keys", "leads nowhere"],
            ),
            ("water..waves", ["is no path of a key", "names with dots"]),
        ] {
            let problem = Place::find(&document(), path).unwrap_err();
            assert!(
                parts.iter().all(|part| problem.contains(part)),
                "{path}: {problem}"
            );
        }
    }

    #[test]
    fn a_value_is_set_where_the_path_leads_and_nowhere_else() {
        let mut document = document();
        let mut set = |path: &str, value: Value| {
            let place = Place::find(&document, path).unwrap();
            place.set(&mut document, value);
        };
        set("lines.line1.length", Value::Float(460.0));
        set("seed", Value::Integer(7));
        set("water.current.velocity", Value::Array(vec![Value::Float(1.0); 3]));
        set("solver.dynamics", Value::String("leapfrog".into()));
        set("motion.semi.file", Value::String("m.csv".into()));
        let mut expected: toml::Table = SCENE.parse().unwrap();
        expected["lines"][0]["sections"][0]["length"] = Value::Float(460.0);
        let water = as_table(&mut expected["water"]);
        water["waves"]
            .as_table_mut()
            .unwrap()
            .insert("seed".into(), Value::Integer(7));
        water.insert(
            "current".into(),
            Value::Table("velocity = [1.0, 1.0, 1.0]".parse().unwrap()),
        );
        expected["solver"] = Value::Table("integrator = \"leapfrog\"".parse().unwrap());
        expected["motion"]["semi"] = Value::Table("file = \"m.csv\"".parse().unwrap());
        assert_eq!(document, Value::Table(expected));
    }
}
