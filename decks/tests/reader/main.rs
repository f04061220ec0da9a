//! Decks of MoorDyn and MAP++: contents read, mistakes refused with their places, and conversion to the same system.

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

/// Depth and positions from the host, for the decks without them.
fn supplement() -> Supplement {
    let at = |name: &str, x| (name.to_string(), [x, 0.0, 0.0]);
    Supplement {
        depth: Some(320.0),
        positions: [at("turbine1", 0.0), at("turbine2", 1000.0)].into(),
        ..Supplement::default()
    }
}

/// Depth from the host of the MAP++ deck.
fn deep() -> Supplement {
    Supplement {
        depth: Some(320.0),
        ..Supplement::default()
    }
}

/// Loads bytes from a file whose name does not reveal the format.
fn load_bytes(bytes: &[u8], supplement: &Supplement) -> Result<LoadedScene, LoadError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("input");
    fs::write(&path, bytes).unwrap();
    load_with(&path, supplement)
}

fn load_text(text: &str) -> Result<LoadedScene, LoadError> {
    load_bytes(text.as_bytes(), &Supplement::default())
}

/// Loads the text of a MAP++ deck, with the depth from its host.
fn load_deep(text: &str) -> Result<LoadedScene, LoadError> {
    load_bytes(text.as_bytes(), &deep())
}

/// Loads the text of a deck without mistakes.
fn loaded(text: &str) -> LoadedScene {
    load_text(text).unwrap_or_else(|error| panic!("{}", error.list()))
}

/// Lists the mistakes, one per line, without the folder: `input:7:32: …`.
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

/// Replaces a part of the deck's text, which must be there.
fn with(text: &str, old: &str, new: &str) -> String {
    assert!(text.contains(old), "{old:?} is not in the deck");
    text.replacen(old, new, 1)
}

/// Returns the sentences of `check` on a scene, in one line.
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
