//! No key of the scene format is silently ignored: for every key of the reader, and every kind of object that may
//! have it, another value changes a result, or is refused by name, or a note names the key and states that it has
//! no effect.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use moorline::dynamics::Choice;
use moorline::interface::{Binding, Causality, Interface, Layout, SolverResult};
use moorline::model::{Body, Role};
use moorline::output::channels::Channels;
use moorline::scene::keys;
use moorline::scene::{LoadedScene, Note, SceneError, load};
use moorline::simulation::{Error, Simulation, WaterFlow};
use toml::{Table, Value};

const VALUES: &str = include_str!("values.toml");
const SCENES: &str = include_str!("scenes.toml");

/// Tables of the format, by the last name in an object's path that is not a number.
const PLACES: &[(&str, &str)] = &[
    ("water", "Water"),
    ("current", "Current"),
    ("waves", "Sea"),
    ("regular", "RegularWave"),
    ("seabed", "Seabed"),
    ("grid", "DepthGrid"),
    ("friction", "Directions"),
    ("tension_strain", "TensionFile"),
    ("solid_section", "SolidSection"),
    ("rayleigh", "Rayleigh"),
    ("points", "Point"),
    ("force", "PointForce"),
    ("moment", "PointMoment"),
    ("vessels", "Vessel"),
    ("lines", "Line"),
    ("sections", "Section"),
    ("break", "Break"),
    ("winch", "Winch"),
    ("solver", "Solver"),
    ("bossak", "Bossak"),
    ("output", "Output"),
    ("motion", "MotionText"),
    ("factor", "FunctionText"),
    ("path", "FunctionText"),
    ("x", "FunctionText"),
    ("y", "FunctionText"),
    ("z", "FunctionText"),
];

/// Every table of the format with the names of its keys, including aliases.
fn tables() -> Vec<(&'static str, Vec<&'static str>)> {
    let names = |table: keys::Schema| {
        let keys = table.keys.iter();
        let names = keys.flat_map(|key| [Some(key.name()), key.rule.alias]).flatten();
        (table.name, names.collect())
    };
    keys::tables().into_iter().map(names).collect()
}

/// Table of the format to which the object at a path belongs; `None` for a map of names.
fn table_of(path: &[String]) -> Option<&'static str> {
    match path {
        [] => return Some("Scene"),
        [map] if map == "line_types" || map == "motion" => return None,
        [map, _] if map == "line_types" => return Some("LineType"),
        [map, _] if map == "motion" => return Some("MotionText"),
        _ => {}
    }
    let mut names = path.iter().rev().filter(|step| step.parse::<usize>().is_err());
    let name = names.next()?;
    if name == "initial" {
        return None; // a choice with a value
    }
    let place = PLACES.iter().find(|(place, _)| place == name);
    Some(place.unwrap_or_else(|| panic!("no table at {path:?}")).1)
}

/// Paths of all tables in a value.
fn objects(value: &Value, path: &mut Vec<String>, found: &mut Vec<Vec<String>>) {
    let mut inside = |step: String, value: &Value| {
        path.push(step);
        objects(value, path, found);
        path.pop();
    };
    match value {
        Value::Table(table) => table.iter().for_each(|(key, value)| inside(key.clone(), value)),
        Value::Array(array) => array
            .iter()
            .enumerate()
            .for_each(|(i, value)| inside(i.to_string(), value)),
        _ => {}
    }
    if value.is_table() {
        found.push(path.clone());
    }
}

fn object<'s>(scene: &'s mut Value, path: &[String]) -> &'s mut Table {
    let at = path.iter().fold(scene, |value, step| match value {
        Value::Array(array) => &mut array[step.parse::<usize>().unwrap()],
        value => value.get_mut(step).unwrap(),
    });
    at.as_table_mut().unwrap()
}

/// Path in the form used by mistakes and notes: `lines[1].sections[0]`.
fn rendered(path: &[String]) -> String {
    let steps = path.iter().map(|step| match step.parse::<usize>() {
        Ok(_) => format!("[{step}]"),
        Err(_) => format!(".{step}"),
    });
    steps.collect::<String>().trim_start_matches('.').to_string()
}

/// Outcome of a scene.
struct Outcome {
    loaded: LoadedScene,
    names: Vec<String>,
    numbers: Vec<f64>,
    notes: Vec<Note>,
}

/// Reason why there is no outcome.
#[derive(Debug)]
enum Refusal {
    /// Mistakes with their places.
    Mistakes(Vec<SceneError>),
    /// A failed computation.
    Failure(String),
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Refusal {
        match error {
            Error::Scene(mistake) => Refusal::Mistakes(vec![mistake]),
            Error::Statics(error) => Refusal::Failure(error.to_string()),
        }
    }
}

impl From<SceneError> for Refusal {
    fn from(mistake: SceneError) -> Refusal {
        Refusal::Mistakes(vec![mistake])
    }
}

/// Names and values of all results of a run that follows the scene and of one driven by a host, and the notes of `check`.
fn outcome(folder: &Path, scene: &Value) -> Result<Outcome, Refusal> {
    let path = folder.join("scene.toml");
    fs::write(&path, toml::to_string(scene).unwrap()).unwrap();
    let loaded = load(&path).map_err(|error| Refusal::Mistakes(error.mistakes().to_vec()))?;
    let scene = &loaded.scene;
    let hosted = Simulation::new(scene)?;
    let mut followed = hosted.clone();
    followed.follow_scene()?;
    let mut notes = loaded.notes.clone();
    notes.extend(scene.advice());
    notes.extend(scene.idle_with(hosted.choices().map(|choice: &Choice| choice.integrator)));
    let mut found = Outcome {
        loaded: loaded.clone(),
        names: Vec::new(),
        numbers: Vec::new(),
        notes,
    };
    let interface = Interface::new(scene, hosted.model(), Layout::Scalars)?;
    let channels = Channels::new(scene, hosted.model())?;
    let steps = (scene.output.duration / scene.output.interval).round() as u32;
    for (mut simulation, driven) in [(followed, false), (hosted, true)] {
        collect(&simulation, &interface, &channels, &mut found);
        for step in 1..=steps {
            if driven {
                drive(&mut simulation, scene.output.interval * f64::from(step));
            }
            let advanced = simulation.advance(scene.output.interval);
            advanced.map_err(|error| Refusal::Failure(error.to_string()))?;
            collect(&simulation, &interface, &channels, &mut found);
        }
    }
    Ok(found)
}

/// Moves, releases and pays out everything that a host can, and sets the water flow.
fn drive(simulation: &mut Simulation, t: f64) {
    let model = simulation.model().clone();
    let mut flow = WaterFlow::still(&model);
    for line in 0..model.lines.len() {
        for node in 0..flow.node_count(line) {
            flow.set(line, node, [2.0 * t, 0.4, 0.1], [2.0, 0.0, 0.3]);
        }
    }
    simulation.inputs_mut().flow.clone_from(&flow);
    let pose = [0.3 * t, 0.1 * t * t, 0.5 * t * t, 0.1 * t, 0.02 * t, 0.2 * t];
    for body in model.bodies() {
        let moved = match body {
            Body::Point(point) => matches!(model.points[point].role, Role::Coupled { .. }),
            Body::Vessel(_) => true,
        };
        if moved {
            simulation.set_body(body, pose, [None; 6]);
        }
    }
    for (index, line) in model.lines.iter().enumerate() {
        simulation.set_release(index, t > 0.06);
        if line.winch.is_some() {
            simulation.set_length_change(index, 4.0 * t);
        }
    }
}

fn collect(simulation: &Simulation, interface: &Interface, channels: &Channels, found: &mut Outcome) {
    let (names, numbers) = (&mut found.names, &mut found.numbers);
    for variable in interface.outputs() {
        // the number of steps is not a result
        if !matches!(variable.binding, Binding::Solver(SolverResult::Substeps)) {
            let mut values = vec![f64::NAN; variable.size()];
            let _ = Interface::read(variable, simulation, &mut values);
            numbers.append(&mut values);
        }
    }
    let seen = [Causality::Input, Causality::Output];
    let variables = interface
        .variables()
        .iter()
        .filter(|variable| seen.contains(&variable.causality));
    names.extend(variables.map(|variable| variable.name.clone()));
    names.extend(channels.columns().map(|column| column.name));
    numbers.extend(channels.values(simulation));
    for (index, line) in simulation.state().lines.iter().enumerate() {
        numbers.extend(line.position.iter().flat_map(|r| [r.x, r.y, r.z]));
        let bending = simulation.bending(index).unwrap_or_default();
        numbers.extend(bending.iter().flat_map(|node| [node.curvature, node.moment]));
    }
    let points = 0..simulation.model().points.len();
    numbers.extend(points.flat_map(|point| simulation.end_force(point)));
}

fn differ(a: &Outcome, b: &Outcome) -> bool {
    let apart = |(a, b): (&f64, &f64)| a.is_nan() != b.is_nan() || (a - b).abs() > 1e-12 * a.abs().max(1.0);
    let mut pairs = a.numbers.iter().zip(&b.numbers);
    a.names != b.names || a.numbers.len() != b.numbers.len() || pairs.any(apart)
}

/// Folder with the files that scenes may refer to.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [
        ("rope.txt", "0 0\n0.1 2e5\n"),
        ("other.txt", "0 0\n0.1 4e5\n"),
        ("current.txt", "a\nb\nc\n0 2.0 0 0\n-20 1.0 0 0\n"),
        ("tide.txt", "a\nb\nc\n0 1.0 0 0\n-20 0.5 0 0\n"),
        ("waves.txt", "1.0 1.0 0.0 0.0\n1.2 0.5 0.0 0.0\n"),
        ("swell.txt", "0.8 1.0 0.0 0.0\n"),
        ("seabed.csv", "y/x,0,50\n-9,20.5,20.6\n9,20.5,20.7\n"),
        ("other_seabed.csv", "y/x,0,50\n-9,20.1,20.2\n9,20.1,20.3\n"),
        ("motion.csv", "time,x,y,z\n0,0,0,0\n1,2,0,1\n"),
        ("other.csv", "time,x,y,z\n0,0,0,0\n1,1,0,1\n"),
    ] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Effect of another value of a key.
enum Fate {
    Acts,
    Told(String),
    Silent(String),
}

/// Returns whether a text contains one of these names, as a key or in words.
fn names(text: &str, known: &[&str]) -> bool {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    known.iter().filter(|name| !name.is_empty()).any(|name| {
        let spaced = name.replace('_', " ");
        text.split(|c| !is_name(c)).any(|word| word == *name) || name.contains('_') && text.contains(&spaced)
    })
}

/// Compares the outcome with a changed key of a named object with the unchanged outcome.
fn fate(found: Result<Outcome, Refusal>, at: &str, [name, key]: [&str; 2], before: &Outcome) -> Fate {
    let after = match found {
        Ok(after) => after,
        Err(Refusal::Failure(error)) => return Fate::Told(error),
        Err(Refusal::Mistakes(mistakes)) => {
            let told = |mistake: &SceneError| {
                names(&mistake.to_string(), &[name, key]) || mistake.at.starts_with(at)
            };
            let all: Vec<String> = mistakes.iter().map(ToString::to_string).collect();
            return match mistakes.iter().any(told) {
                true => Fate::Told(all.join(", ")),
                false => Fate::Silent(format!("is refused without its name, {all:?}")),
            };
        }
    };
    let about = |note: &&Note| {
        let here = note.at == at || note.at == format!("{at}.{key}");
        here && note.text.contains(&format!("`{key}`")) && note.text.contains("nothing")
    };
    // these keys act only on files
    let is_of_files = ["title", "format", "digits", "frames", "derivatives"].contains(&key);
    let written = is_of_files && after.loaded.scene.in_words() != before.loaded.scene.in_words();
    match (after.notes.iter().find(about), differ(&after, before) || written) {
        (Some(note), true) => Fate::Silent(format!("acts, against the note {note}")),
        (Some(note), false) => Fate::Told(note.to_string()),
        (None, true) => Fate::Acts,
        (None, false) => Fate::Silent("changes nothing".to_string()),
    }
}

/// Sets a key of an object to another value; returns the previous name of the object.
fn change(scene: &mut Value, path: &[String], key: &str, value: &Value) -> String {
    let object = object(scene, path);
    let name = object
        .get("name")
        .and_then(Value::as_str)
        .unwrap_or_default()
        .to_string();
    let moved = |(old, by): (&Value, &Value)| Some(Value::Float(old.as_float()? + by.as_float()?));
    let value = match (object.get(key), value) {
        (Some(Value::Array(old)), Value::Array(by)) if key == "position" => {
            Value::Array(old.iter().zip(by).filter_map(moved).collect())
        }
        _ => value.clone(),
    };
    object.insert(key.to_string(), value);
    name
}

/// Outcomes of the keys of the objects of all scenes, each after the scene's name: keys that act, changes that are refused or noted, and changes
/// that are silently ignored.
#[derive(Default)]
struct Found {
    acting: BTreeSet<String>,
    told: Vec<String>,
    silent: Vec<String>,
}

/// Scene of the list: its text, and the first parts of the paths of the objects under test.
fn scene(list: &Table, row: &Value) -> (Value, Vec<String>) {
    let chosen = |key: &str, usual: &str| {
        let name = row.get(key).and_then(Value::as_str).unwrap_or(usual);
        list[key].get(name).unwrap_or_else(|| panic!("no {key} {name}"))
    };
    let mut text = chosen("layout", "moored").as_str().unwrap().to_string();
    for (key, usual) in [("water", "still"), ("seabed", "seabed"), ("line", "chain")] {
        text = text.replace(&format!("${key}"), chosen(key, usual).as_str().unwrap());
    }
    let integrator = row.get("integrator").and_then(Value::as_str);
    text = text.replace("$integrator", integrator.unwrap_or("leapfrog"));
    for change in row.get("change").and_then(Value::as_array).into_iter().flatten() {
        text = text.replace(change[0].as_str().unwrap(), change[1].as_str().unwrap());
    }
    let scene = text
        .parse::<Table>()
        .unwrap_or_else(|error| panic!("{text}: {error}"));
    (scene.into(), chosen("objects", "all").clone().try_into().unwrap())
}

/// Tries every value of every key of the objects of a scene under test.
fn try_all(folder: &Path, name: &str, (scene, tried): (Value, Vec<String>), found: &mut Found) {
    let values: BTreeMap<String, BTreeMap<String, Vec<Value>>> = toml::from_str(VALUES).unwrap();
    let before = outcome(folder, &scene).unwrap_or_else(|error| panic!("{name}: {error:?}"));
    let (mut paths, tables) = (Vec::new(), tables());
    objects(&scene, &mut Vec::new(), &mut paths);
    paths.retain(|path| tried.iter().any(|start| path.join(".").starts_with(start)));
    for (path, table) in paths.iter().filter_map(|path| Some((path, table_of(path)?))) {
        let (_, keys) = tables.iter().find(|(known, _)| *known == table).unwrap();
        let values = |key| values.get(table).and_then(|keys| keys.get(key));
        let values = |key| values(key).unwrap_or_else(|| panic!("no value of {table}.{key} to try"));
        for (key, value) in keys
            .iter()
            .flat_map(|key| values(*key).iter().map(move |value| (*key, value)))
        {
            let mut changed = scene.clone();
            let owner = change(&mut changed, path, key, value);
            let after = outcome(folder, &changed);
            if after
                .as_ref()
                .is_ok_and(|after| after.loaded.scene == before.loaded.scene)
            {
                continue; // unchanged, such as a default
            }
            let place = [path.as_slice(), &[key.to_string()]].concat().join(".");
            let said = |text: String| format!("{name}: {place} = {value}: {text}");
            match fate(after, &rendered(path), [&owner, key], &before) {
                Fate::Acts => _ = found.acting.insert(format!("{table}.{key}")),
                Fate::Told(text) => found.told.push(said(text)),
                Fate::Silent(why) => found.silent.push(said(why)),
            }
        }
    }
}

#[test]
fn every_key_of_every_object_changes_a_result_or_is_refused_or_noted() {
    let list: Table = SCENES.parse().unwrap();
    let folder = folder();
    let mut found = Found::default();
    for row in list["scenes"].as_array().unwrap() {
        let name = row["name"].as_str().unwrap();
        try_all(folder.path(), name, scene(&list, row), &mut found);
    }
    let except: Vec<[String; 3]> = list["except"].clone().try_into().unwrap();
    let mut wrong = found.silent;
    for [scene, change, _] in except {
        let count = wrong.len();
        wrong.retain(|silent| !(silent.starts_with(&scene) && silent.contains(&format!(": {change}"))));
        if wrong.len() == count {
            wrong.push(format!("{scene}: {change} is no exception"));
        }
    }
    let told: Vec<[String; 3]> = list["told"].clone().try_into().unwrap();
    for [scene, change, text] in told {
        let start = format!("{scene}: {change} = ");
        let mut told = found.told.iter();
        if !told.any(|told| told.starts_with(&start) && told.contains(&text)) {
            wrong.push(format!("{scene}: {change} is not told by \"{text}\""));
        }
    }
    let nowhere: BTreeSet<String> = list["nowhere"].clone().try_into().unwrap();
    let all = tables()
        .into_iter()
        .flat_map(|(table, keys)| keys.into_iter().map(move |key| format!("{table}.{key}")));
    let odd = all.filter(|key| found.acting.contains(key) == nowhere.contains(key));
    wrong.extend(odd.map(|key| format!("{key} acts nowhere, or is said to")));
    assert!(
        wrong.is_empty(),
        "{} keys pass in silence:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}
