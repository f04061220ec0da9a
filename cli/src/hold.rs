//! `moorline check --write`: the selected discretisation in the scene's own file, so that later commands need no selection.

use std::io::Write;

use moorline::output::write_file;
use moorline::scene::{LoadedScene, Scene, TOML};
use toml_edit::{Array, DocumentMut, Item, RawString, TableLike};

use crate::failure::Failure;

/// Keys of `[solver]` that a discretisation sets.
const SOLVER: [&str; 3] = ["elements", "integrator", "time_step_max"];
/// Byte order mark.
const MARK: char = '\u{feff}';
/// The other name of `integrator`.
const DYNAMICS: &str = "dynamics";

/// Refuses the file of another program, which cannot contain a discretisation.
pub(crate) fn check_format(loaded: &LoadedScene) -> Result<(), Failure> {
    if loaded.format == TOML {
        return Ok(());
    }
    Err(Failure::Argument(format!(
        "--write: {} is a {} file, which has no place for elements, integrator and step of moorline; `moorline convert` makes a scene of it",
        loaded.path.display(),
        loaded.format
    )))
}

/// Writes the elements, integrator and step of a discretised scene, if there is one, into the file of the scene. The rest of the file does not
/// change. Returns a sentence.
pub(crate) fn hold(loaded: &LoadedScene, held: Option<&Scene>) -> Result<String, Failure> {
    let path = loaded.path.display();
    let Some(held) = held else {
        return Ok(format!(
            "{path} is unchanged: the elements of all lines are given"
        ));
    };
    let edited = edited(&loaded.text, &loaded.scene, held);
    let (text, keys) = edited.ok_or_else(|| {
        Failure::Computation(format!(
            "{path} is unchanged: its tables `solver` and `lines` cannot be edited"
        ))
    })?;
    write_file(&loaded.path, |out: &mut dyn Write| out.write_all(text.as_bytes()))?;
    Ok(format!("written to {path}: {}", keys.join(", ")))
}

/// Text of a scene with the discretisation of the scene `held` instead of that of the scene `given`, and the keys set; `None` if the text is not a
/// scene.
fn edited(text: &str, given: &Scene, held: &Scene) -> Option<(String, Vec<String>)> {
    let mut document: DocumentMut = text.parse().ok()?;
    let [mut before, mut after] = [given, held].map(|scene| scene.to_toml().parse::<DocumentMut>().ok());
    let (before, after) = (before.as_mut()?, after.as_mut()?);
    let mut keys = Vec::new();
    for key in SOLVER {
        let [before, after] = [&*before, &*after].map(|scene| scene.get("solver")?.get(key));
        if let Some(item) = changed(before, after) {
            let solver = document.entry("solver").or_insert(toml_edit::table());
            let solver = solver.as_table_like_mut()?;
            if key == "integrator" {
                solver.remove(DYNAMICS);
            }
            keys.push(put(solver, "solver", key, item));
        }
    }
    for (i, line) in held.lines.iter().enumerate() {
        let scenes = [&mut *before, &mut *after];
        let [old, new] = scenes.map(|scene| table_at(scene.get_mut("lines")?, i)?.get("elements"));
        if let Some(item) = changed(old, new) {
            let line = table_at(document.get_mut("lines")?, i)?;
            keys.push(put(line, &format!("lines[{i}]"), "elements", item));
        }
        for k in 0..line.sections.len() {
            let scenes = [&mut *before, &mut *after];
            let [old, new] = scenes.map(|scene| section(scene, [i, k])?.get("elements"));
            if let Some(item) = changed(old, new) {
                let at = format!("lines[{i}].sections[{k}]");
                keys.push(put(section(&mut document, [i, k])?, &at, "elements", item));
            }
        }
    }
    Some((like(text, &document.to_string()), keys))
}

/// A text with the line ends and the byte order mark of another.
fn like(model: &str, text: &str) -> String {
    let text = match model.contains("\r\n") {
        true => text.replace("\r\n", "\n").replace('\n', "\r\n"),
        false => text.to_string(),
    };
    match model.starts_with(MARK) && !text.starts_with(MARK) {
        true => format!("{MARK}{text}"),
        false => text,
    }
}

/// Value of a key after a change; `None` if it is the same as before or absent.
fn changed<'d>(before: Option<&Item>, after: Option<&'d Item>) -> Option<&'d Item> {
    let words = |item: &Item| item.to_string().trim().to_string();
    after.filter(|item| before.map(words) != Some(words(item)))
}

/// Sets a key of the table `at`, and returns the assignment.
fn put(table: &mut dyn TableLike, at: &str, key: &str, item: &Item) -> String {
    let mut item = item.clone();
    if let Some(value) = item.as_value_mut() {
        value.decor_mut().clear();
    }
    let assignment = format!("{at}.{key} = {item}");
    if table.get(key).is_none() {
        close_up(table);
    }
    table.insert(key, item);
    assignment
}

/// Removes the blank after the last value of a table: it stands before the closing brace of an inline table, and would stand before the comma of a
/// new key.
fn close_up(table: &mut dyn TableLike) {
    let Some(last) = table.iter_mut().last().and_then(|(_, item)| item.as_value_mut()) else {
        return;
    };
    let behind = last.decor().suffix().and_then(RawString::as_str);
    if behind.is_some_and(|behind| behind.trim().is_empty()) {
        last.decor_mut().set_suffix("");
    }
}

/// Table of section `k` of line `i` of a scene.
fn section(scene: &mut DocumentMut, [i, k]: [usize; 2]) -> Option<&mut dyn TableLike> {
    let line = table_at(scene.get_mut("lines")?, i)?;
    table_at(line.get_mut("sections")?, k)
}

/// Table `i` of an array of tables or of inline tables.
fn table_at(tables: &mut Item, i: usize) -> Option<&mut dyn TableLike> {
    match tables {
        Item::ArrayOfTables(tables) => Some(tables.get_mut(i)?),
        tables => Some(Array::get_mut(tables.as_array_mut()?, i)?.as_inline_table_mut()?),
    }
}
