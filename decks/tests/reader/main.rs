//! Decks of MoorDyn and MAP++: what is read of them, what is refused and where, and that a converted deck is the same system.

#[path = "../../../tests/common/chance.rs"]
mod chance;
mod files;
mod garbage;
mod read;
mod refusals;
#[path = "../../../tests/common/text.rs"]
mod text;
mod traps;

use std::fs;
use std::path::{Path, PathBuf};

use moorline::model::Model;
use moorline::scene::{LoadError, LoadedScene, Scene};
use moorline::simulation::Simulation;
use moorline_decks::{Supplement, load, load_with};
use text::{assert_says, wrong_answers};

const OPENFAST: &str = include_str!("../decks/openfast_v2.dat");
const VERSION_1: &str = include_str!("../decks/moordyn_v1.dat");
const C_STYLE: &str = include_str!("../decks/moordyn_c.txt");
const FARM: &str = include_str!("../decks/farm.dat");
const MAP: &str = include_str!("../decks/oc3.map");

fn deck(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/decks")
        .join(name)
}

fn read(name: &str) -> LoadedScene {
    load(&deck(name)).unwrap_or_else(|error| panic!("{}", error.list()))
}

/// Depth and places that the host of the decks gives that leave them out.
fn supplement() -> Supplement {
    let at = |name: &str, x| (name.to_string(), [x, 0.0, 0.0]);
    Supplement {
        depth: Some(320.0),
        positions: [at("turbine1", 0.0), at("turbine2", 1000.0)].into(),
        ..Supplement::default()
    }
}

/// Depth that the host of the MAP++ deck gives.
fn deep() -> Supplement {
    Supplement {
        depth: Some(320.0),
        ..Supplement::default()
    }
}

/// A deck as bytes of a file with a name that says nothing.
fn load_bytes(bytes: &[u8], supplement: &Supplement) -> Result<LoadedScene, LoadError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("input");
    fs::write(&path, bytes).unwrap();
    load_with(&path, supplement)
}

fn load_text(text: &str) -> Result<LoadedScene, LoadError> {
    load_bytes(text.as_bytes(), &Supplement::default())
}

/// A deck of MAP++ as text, with the depth of its host.
fn load_deep(text: &str) -> Result<LoadedScene, LoadError> {
    load_bytes(text.as_bytes(), &deep())
}

/// A deck as text that is right.
fn loaded(text: &str) -> LoadedScene {
    load_text(text).unwrap_or_else(|error| panic!("{}", error.list()))
}

/// Every mistake on a line, without the folder: `input:7:32: …`.
fn said_by(result: Result<LoadedScene, LoadError>) -> String {
    let listed = result
        .err()
        .map_or("the deck is read".to_string(), |error| error.list());
    let short = |line: &str| {
        line.rsplit_once("/input")
            .map_or(line.to_string(), |(_, rest)| rest.to_string())
    };
    listed
        .lines()
        .map(|line| format!("input{}\n", short(line)))
        .collect()
}

fn said(text: &str) -> String {
    said_by(load_text(text))
}

/// The deck with one part of its text replaced, which must be there.
fn with(text: &str, old: &str, new: &str) -> String {
    assert!(text.contains(old), "{old:?} is not in the deck");
    text.replacen(old, new, 1)
}

/// The words of `check` on a scene, in one line.
fn in_words(scene: &Scene) -> String {
    scene.in_words().split_whitespace().collect::<Vec<_>>().join(" ")
}

fn notes(loaded: &LoadedScene) -> String {
    loaded.notes.iter().map(|note| format!("{note}\n")).collect()
}

fn point<'s>(scene: &'s Scene, name: &str) -> &'s moorline::scene::Point {
    let mut points = scene.points.iter();
    points
        .find(|point| point.name == name)
        .unwrap_or_else(|| panic!("no {name}"))
}
