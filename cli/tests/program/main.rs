//! The command line from outside: exit codes, messages, files.

mod arguments;
mod continued;
mod decks;
mod drive;
mod fmu;
mod manual;
mod modes;
mod places;
mod run;
mod statics;
mod study;
mod sweep;
#[path = "../../../tests/common/text.rs"]
mod text;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

use tempfile::TempDir;
use text::assert_says;

/// A hanging line in still air, which runs quickly.
const SCENE: &str = include_str!("../../../tests/scenes/rope.toml");

const OPENFAST: &str = include_str!("../../../decks/tests/decks/openfast_v2.dat");
const VERSION_1: &str = include_str!("../../../decks/tests/decks/moordyn_v1.dat");
const C_STYLE: &str = include_str!("../../../decks/tests/decks/moordyn_c.txt");
const FARM: &str = include_str!("../../../decks/tests/decks/farm.dat");
const MAP: &str = include_str!("../../../decks/tests/decks/oc3.map");

/// Folder in which the program runs.
struct Folder(TempDir);

/// Folder with the scene in it.
fn folder() -> Folder {
    folder_with(&[("scene.toml", SCENE)])
}

/// Folder with files of these names and texts in it.
fn folder_with(files: &[(&str, &str)]) -> Folder {
    let folder = Folder(tempfile::tempdir().unwrap());
    files.iter().for_each(|(name, text)| folder.write(name, text));
    folder
}

/// Folder with a scene of the repository in it, as `scene.toml`.
fn folder_of(name: &str) -> Folder {
    let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    folder_with(&[("scene.toml", &fs::read_to_string(path).unwrap())])
}

impl Folder {
    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        fs::write(self.path(name), text).unwrap();
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// Returns the program with these arguments, separated by blanks, in the folder.
    fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_moorline"));
        command
            .args(arguments.split_whitespace())
            .current_dir(self.0.path());
        command
    }

    fn run(&self, arguments: &str) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Runs a command to its end with all of its pipes; `meanwhile` may act on it first.
    fn piped(&self, arguments: &str, meanwhile: impl FnOnce(&mut Child)) -> Output {
        let mut command = self.command(arguments);
        let pipes = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = pipes.spawn().unwrap();
        meanwhile(&mut child);
        child.wait_with_output().unwrap()
    }

    /// Runs a command that must succeed, and returns its output.
    fn done(&self, arguments: &str) -> String {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments}: {}", err(&output));
        out(&output)
    }

    /// Runs a command that must succeed and whose output must contain all these parts.
    fn shows(&self, arguments: &str, parts: &[&str]) {
        assert_says(&self.done(arguments), parts);
    }

    /// Runs a command that must succeed, and returns its remarks.
    fn remarks(&self, arguments: &str) -> String {
        let output = self.run(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments}: {}", err(&output));
        err(&output)
    }

    /// Runs a command that must succeed, and reads the columns of its results by name.
    fn columns(&self, arguments: &str) -> BTreeMap<String, Vec<f64>> {
        self.done(arguments);
        let (names, rows) = table(&self.path("out/results.csv"));
        let column = |index: usize| rows.iter().map(|row| row[index]).collect();
        let columns = names.into_iter().enumerate();
        columns.map(|(index, name)| (name, column(index))).collect()
    }

    /// Runs a command that must be refused as wrong input with a message that contains all these parts.
    fn refused(&self, arguments: &str, parts: &[&str]) {
        self.ends(arguments, 2, parts);
    }

    /// Runs a computation that must fail with a message that contains all these parts.
    fn fails(&self, arguments: &str, parts: &[&str]) {
        self.ends(arguments, 1, parts);
    }

    /// Runs a command that must end with this exit code and a message that contains all these parts and no backtrace.
    fn ends(&self, arguments: &str, code: i32, parts: &[&str]) {
        let output = self.run(arguments);
        let message = err(&output);
        assert_eq!(output.status.code(), Some(code), "{arguments}: {message}");
        // line breaks in a message are ignored
        let words = message.split_whitespace().filter(|word| *word != "│");
        assert_says(&words.collect::<Vec<_>>().join(" "), parts);
        assert!(!message.contains("panicked"), "{message}");
        assert!(output.stdout.is_empty(), "{arguments}: {}", out(&output));
    }

    /// Names of all files, sorted, with forward slashes.
    fn names(&self) -> Vec<String> {
        self.names_in("")
    }

    /// Names of the files below a folder in it.
    fn names_in(&self, below: &str) -> Vec<String> {
        fn collect(folder: &Path, prefix: &str, names: &mut Vec<String>) {
            for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
                let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
                match entry.path().is_dir() {
                    true => collect(&entry.path(), &format!("{name}/"), names),
                    false => names.push(name),
                }
            }
        }
        let mut found = Vec::new();
        collect(&self.path(below), "", &mut found);
        found.sort();
        found
    }
}

fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Numbers of a results table: header and rows.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let header = reader.headers().unwrap().iter().map(String::from).collect();
    let rows = reader.deserialize().collect::<Result<_, _>>().unwrap();
    (header, rows)
}

/// Collects the keys of all tables in a value, including those in arrays.
fn collect_keys(value: &serde_json::Value, keys: &mut Vec<String>) {
    match value {
        serde_json::Value::Object(table) => {
            for (key, value) in table {
                keys.push(key.clone());
                collect_keys(value, keys);
            }
        }
        serde_json::Value::Array(values) => values.iter().for_each(|value| collect_keys(value, keys)),
        _ => {}
    }
}

/// Checks that every key is documented on the page of the JSON output.
fn assert_documented(json: &serde_json::Value) {
    let page = include_str!("../../../docs/json.md");
    let mut keys = Vec::new();
    collect_keys(json, &mut keys);
    for key in keys {
        let written = ["`", "."]
            .map(|before| ["`", "[]`"].map(|after| page.contains(&format!("{before}{key}{after}"))));
        assert!(written.concat().contains(&true), "{key}");
    }
}
