//! Scene as TOML with comments: the units of numbers, and the line of the original file for each part.
//!
//! The comments are appended to lines of the TOML that [`Scene::to_toml`] writes. They do not change the scene, which is read back bit for bit.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::keys;
use super::read::LoadedScene;
use super::words::paragraph;

impl LoadedScene {
    /// The scene as commented TOML that needs no other file and is read back to the same numbers, bit for bit.
    pub fn to_commented_toml(&self) -> String {
        let mut text = String::new();
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        let name: String = name.chars().filter(|c| !c.is_control()).collect();
        let heading = format!("{name}, a {} file, as a scene of moorline", self.format);
        paragraph(&mut text, "# ", &heading);
        for note in &self.notes {
            let note: String = note.to_string().chars().filter(|c| !c.is_control()).collect();
            paragraph(&mut text, "# ", &note);
        }
        text.push('\n');
        let mut place = Place::default();
        for line in self.scene.to_toml().lines() {
            text.push_str(line);
            if let Some(comment) = place.comment(line, self) {
                write!(text, "  # {comment}").expect("a String takes all");
            }
            text.push('\n');
        }
        text
    }
}

/// Table that contains a line of TOML.
#[derive(Default)]
struct Place {
    /// Header, such as `lines.sections`.
    table: String,
    /// Number of elements of each list of tables so far.
    begun: BTreeMap<String, usize>,
}

impl Place {
    /// Comment at the end of a line of TOML: the line of the file, or the unit.
    fn comment(&mut self, line: &str, loaded: &LoadedScene) -> Option<String> {
        let header = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
        if let Some(header) = header {
            let element = header.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
            self.table = element.unwrap_or(header).to_string();
            let mut at = self.table.clone();
            if element.is_some() {
                let count = self.begun.entry(self.table.clone()).or_default();
                write!(at, "[{count}]").expect("a String takes all");
                *count += 1;
            }
            let line = loaded.places.line(&loaded.text, &at)?;
            return Some(format!("file line {line}"));
        }
        let (key, value) = line.split_once(" = ")?;
        // the tables in an inline list hold several units
        if value.contains('{') {
            return None;
        }
        let unit = keys::table(&self.table)?.key(key)?.unit();
        unit.filter(|unit| *unit != "-").map(str::to_string)
    }
}
