//! The command line from outside: exit codes, messages, files.

mod arguments;
mod decks;
mod drive;
mod fmu;
mod modes;
mod places;
mod run;
mod statics;
mod study;

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

/// A hanging line in still air, quick to run.
const SCENE: &str = r#"title = "a rope between two poles"

[line_types.rope]
mass = 0.05
axial_stiffness = 2505.0
axial_damping = 5.0

[[points]]
name = "anchor"
position = [0.0, 0.0, 0.0]
kind = "fixed"

[[points]]
name = "fairlead"
position = [14.0, 0.0, 0.0]
kind = "coupled"

[[lines]]
name = "line1"
from = "anchor"
to = "fairlead"
sections = [{ type = "rope", length = 14.1421, elements = 8 }]

[motion]
fairlead = { x = [[0.05, 2.0]], ramp = 1.0 }

[output]
duration = 1.0
interval = 0.1
"#;

/// A folder with the scene in it.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    folder
}

fn moorline<S: AsRef<OsStr>>(folder: &Path, arguments: &[S]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_moorline"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Runs what must be done, and reads the columns of its results by name.
fn columns(folder: &Path, arguments: &[&str]) -> BTreeMap<String, Vec<f64>> {
    done(folder, arguments);
    let (names, rows) = table(&folder.join("out/results.csv"));
    let column = |index: usize| rows.iter().map(|row| row[index]).collect();
    names
        .into_iter()
        .enumerate()
        .map(|(index, name)| (name, column(index)))
        .collect()
}

/// Runs what must be refused with this exit code and a message that has all these parts and no backtrace.
fn refused(folder: &Path, arguments: &[&str], code: i32, parts: &[&str]) {
    let output = moorline(folder, arguments);
    let message = err(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
    // A message that is broken into lines is compared as if it were not.
    let flat = message
        .split_whitespace()
        .filter(|word| *word != "│")
        .collect::<Vec<_>>()
        .join(" ");
    for part in parts {
        assert!(flat.contains(part), "{arguments:?}: no \"{part}\" in\n{message}");
    }
    assert!(!message.contains("panicked"), "{message}");
    assert!(output.stdout.is_empty(), "{arguments:?}: {}", out(&output));
}

/// Runs what must be done.
fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = moorline(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", err(&output));
    out(&output)
}

/// Names below a folder, sorted, with forward slashes.
fn names(folder: &Path) -> Vec<String> {
    fn collect(folder: &Path, prefix: &str, names: &mut Vec<String>) {
        for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
            if entry.path().is_dir() {
                collect(&entry.path(), &format!("{name}/"), names);
            } else {
                names.push(name);
            }
        }
    }
    let mut found = Vec::new();
    collect(folder, "", &mut found);
    found.sort();
    found
}

/// Numbers of a results table: header and rows.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let header = reader.headers().unwrap().iter().map(String::from).collect();
    let rows = reader.deserialize().collect::<Result<_, _>>().unwrap();
    (header, rows)
}

/// Adds the keys of all tables in it, arrays of tables included.
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

/// Every key is on the page of the JSON.
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
