//! Errors in units are noted with the key concerned; correct scenes give no notes.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use common::{assert_answers, assert_says, draft};
use moorline::scene::{Scene, load};
use moorline::simulation::{Simulation, Watch};

/// A typical mooring: chain and rope, a vessel, waves, motion.
const SCENE: &str = include_str!("scenes/platform.toml");

/// The notes on a text, each with its line number.
fn noted(text: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).unwrap();
    let loaded = load(&path).unwrap_or_else(|error| panic!("{}", error.list()));
    let notes = loaded.notes.iter().map(|note| {
        let line = note.line.expect("the key stands in the file");
        format!("{line}: {note}\n")
    });
    notes.collect()
}

#[test]
fn forty_slips_of_units_are_each_noted_by_key_line_and_what_is_usual() {
    assert_answers(SCENE, include_str!("scenes/slips_of_units.txt"), noted);
}

/// Every shipped scene, and that of the README.
fn shipped() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = fs::read_dir(root.join("scenes")).unwrap();
    let files = files.map(|entry| entry.unwrap().path());
    let files: Vec<PathBuf> = files
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    let scenes = files
        .iter()
        .map(|path| (path.display().to_string(), fs::read_to_string(path).unwrap()));
    let readme = fs::read_to_string(root.join("README.md")).unwrap();
    let block = readme.split("```toml\n").nth(1).unwrap();
    let block = block.split("```").next().unwrap().to_string();
    scenes
        .chain([
            ("README.md".to_string(), block),
            ("the test's".to_string(), SCENE.to_string()),
        ])
        .collect()
}

#[test]
fn no_shipped_scene_is_noted() {
    let scenes = shipped();
    assert!(scenes.len() > 15);
    for (name, text) in scenes {
        let notes = Scene::from_toml(&text).unwrap().plausibility();
        assert_eq!(notes, [], "{name}");
    }
}

#[test]
fn no_shipped_scene_is_strained_at_rest() {
    for (name, text) in shipped() {
        let scene = Scene::from_toml(&text).unwrap();
        let simulation = Simulation::new(&scene).unwrap();
        assert_eq!(Watch::new(&scene, &simulation).look(&simulation), [], "{name}");
    }
}

#[test]
fn missing_axial_damping_is_advice_with_a_value_and_no_note() {
    let text = SCENE
        .replace("axial_damping = 1.0e6\n", "")
        .replace("axial_damping = 3.0e5\n", "");
    let scene = Scene::from_toml(&text).unwrap();
    assert!(
        scene
            .notes()
            .iter()
            .all(|note| !note.text.contains("axial_damping"))
    );
    let advice = scene.advice();
    assert_eq!(advice.len(), 2);
    // 0.04/π · 500 m · √(5.5e8 N · 126 kg/m)
    assert!(
        advice[0].text.contains("`axial_damping = 1.7e6`"),
        "{}",
        advice[0]
    );
    assert_eq!(Scene::from_toml(SCENE).unwrap().advice(), []);
}

#[test]
fn values_of_models_turned_vessels_and_bench_tests_are_not_noted() {
    for (usual, other) in [
        ("x = [[2.0, 12.0]]", "x = [[0.02, 0.15]]"),
        ("attitude = [0.0, 0.0, 0.3]", "attitude = [0.2, -0.1, 0.3]"),
        (
            "density = 1025.0",
            "density = 1025.0\ncurrent = { profile = [[0.5, 4.0, 0.0], [-120.0, 0.0, 0.0]] }",
        ),
        (
            "[[points]]\nname = \"buoy\"\nposition = [-5.0, 0.0, -10.0]",
            "[[points]]\nname = \"buoy\"\nposition = [-405.0, 0.0, -120.0]",
        ),
    ] {
        let text = SCENE.replacen(usual, other, 1);
        assert!(text != SCENE, "{usual}");
        let notes = Scene::from_toml(&text).unwrap().plausibility();
        assert_eq!(notes, [], "{other}");
    }
    let bench = SCENE.replace("[water]\ndensity = 1025.0\n[water.waves]\nregular = { height = 4.0, period = 10.0, direction = 0.5 }\nramp = 20.0\n", "");
    let bench = bench.replace("position = [-405.0, 0.0, -120.0]", "position = [-5.0, 0.0, 5.0]");
    let notes = Scene::from_toml(&bench).unwrap().plausibility();
    assert_eq!(notes, []);
}

#[test]
fn a_line_that_its_tension_at_rest_breaks_is_noted_at_the_start() {
    let noted = |tension: &str| {
        let line = "sections = [{ type = \"chain\", length = 450.0 }]";
        let text = SCENE.replace(
            line,
            &format!("{line}\nbreak = {{ at = \"b\", tension = {tension} }}"),
        );
        let scene = Scene::from_toml(&text).unwrap();
        let simulation = Simulation::new(&scene).unwrap();
        let mut watch = Watch::new(&scene, &simulation);
        let notes = watch.look(&simulation);
        assert_eq!(watch.look(&simulation), []);
        notes
    };
    let [note] = &noted("1.0e3")[..] else {
        panic!("{:?}", noted("1.0e3"));
    };
    assert_eq!(note.at, "lines[1].break.tension");
    assert!(
        note.text.contains("breaks in its first step") && note.text.contains("it breaks at 1000 N"),
        "{note}"
    );
    assert_eq!(noted("1.0e8"), []);
}

/// A 10 m rope between two points in air, with these keys of the scene.
fn rope(elements: usize, keys: &str) -> Scene {
    draft(format!(
        "line_types.rope = {{ mass = 0.2, axial_stiffness = 2505.0 }}\n{keys}"
    ))
    .fixed("wall", [0.0; 3])
    .coupled("hand", [9.0, 0.0, 0.0])
    .line("rope", ["wall", "hand"], "rope", 10.0, elements)
    .scene()
}

#[test]
fn a_run_of_hours_is_noted_with_its_elements_and_steps_and_what_to_change() {
    let expense = |elements: usize| {
        let scene = rope(elements, "solver.integrator = 'leapfrog'");
        let simulation = Simulation::new(&scene).unwrap();
        moorline::discretisation::expense(&scene, &simulation, scene.output.interval)
    };
    assert_eq!(expense(100), None);
    let note = expense(20_000).unwrap();
    assert_eq!(note.at, "lines[0]");
    assert_says(
        &note.text,
        &["hours on one thread: 20000 elements, ", "fewer `elements`"],
    );
}

#[test]
fn an_end_that_a_host_lifts_out_of_the_water_is_noted_once_unless_the_scene_decides() {
    for (surface, notes) in [("", 1), (", surface = true", 0), (", surface = false", 0)] {
        let scene = draft(format!(
            "water = {{ density = 1025.0{surface} }}
            line_types.rope = {{ mass = 20.0, diameter = 0.1, axial_stiffness = 1e6, axial_damping = 1e4 }}"
        ))
        .fixed("anchor", [0.0, 0.0, -20.0])
        .coupled("hand", [8.0, 0.0, -0.5])
        .line("rope", ["anchor", "hand"], "rope", 25.0, 6)
        .scene();
        let mut simulation = Simulation::new(&scene).unwrap();
        let mut watch = Watch::new(&scene, &simulation);
        let hand = simulation.model().point_index("hand").unwrap();
        let mut noted = Vec::new();
        for step in 0..30 {
            simulation.set_displacement(hand, [0.0, 0.0, 0.1 * f64::from(step)]);
            simulation.advance(0.1).unwrap();
            noted.extend(watch.look(&simulation));
        }
        let risen = noted.iter().filter(|note| note.at == "water.surface");
        assert_eq!(risen.count(), notes, "{surface}: {noted:?}");
    }
}

#[test]
fn a_fairlead_that_jumps_a_line_that_is_strained_and_a_motion_of_few_samples_are_each_noted_once_in_a_run() {
    let scene = rope(6, "");
    let mut simulation = Simulation::new(&scene).unwrap();
    let mut watch = Watch::new(&scene, &simulation);
    let hand = simulation.model().point_index("hand").unwrap();
    let mut noted = Vec::new();
    for step in 0..60 {
        let x = match step {
            0..10 => 0.0,
            10..20 => -2.0,
            20..30 => 0.0,
            _ => (0.1 * f64::from(step - 30)).min(2.0),
        };
        simulation.set_displacement(hand, [x, 0.0, 0.0]);
        simulation.advance(0.1).unwrap();
        noted.extend(watch.look(&simulation));
    }
    let texts: Vec<&str> = noted.iter().map(|note| note.text.as_str()).collect();
    let expected = [
        "hand has moved by",
        "rope is strained by",
        "are too few for its extrapolation",
    ];
    assert_eq!(texts.len(), expected.len(), "{texts:?}");
    for (text, words) in texts.iter().zip(expected) {
        assert!(text.contains(words), "{texts:?}");
    }
}

#[test]
fn a_given_element_that_is_far_shorter_than_its_neighbour_is_noted() {
    let notes = |length: f64| {
        let rope = draft("line_types.rope = { mass = 0.2, axial_stiffness = 2505.0 }")
            .fixed("wall", [0.0; 3])
            .coupled("hook", [100.0, 0.0, 0.0]);
        let sections = [("rope", 100.0, Some(10)), ("rope", length, Some(1))];
        rope.sections("rope", ["wall", "hook"], &sections)
            .scene()
            .plausibility()
    };
    assert_eq!(notes(1.0), []);
    let [note] = &notes(0.1)[..] else {
        panic!("{:?}", notes(0.1));
    };
    assert_eq!(note.at, "lines[0].sections[1].elements");
    let said = "elements of 0.1 m beside elements of 10 m: ";
    assert!(note.text.starts_with(said), "{note}");
}
