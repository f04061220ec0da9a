//! Slips of units are noted, each by the key it concerns; scenes that are right are silent.

use std::fs;
use std::path::{Path, PathBuf};

use moorline::scene::{Note, Scene, load};
use moorline::simulation::{Simulation, Watch};

/// An ordinary mooring: chain and rope, a vessel, waves, motion.
const SCENE: &str = r#"gravity = 9.81
[water]
density = 1025.0
[water.waves]
regular = { height = 4.0, period = 10.0, direction = 0.5 }
ramp = 20.0
[seabed]
depth = 120.0
[line_types.chain]
mass = 126.0
diameter = 0.144
axial_stiffness = 5.5e8
axial_damping = 1.0e6
drag_normal = 1.3
drag_tangential = 0.3
added_mass_normal = 1.0
[line_types.rope]
mass = 22.0
diameter = 0.145
axial_stiffness = 8.0e7
axial_damping = 3.0e5
drag_normal = 1.2
added_mass_normal = 1.0
[[vessels]]
name = "platform"
attitude = [0.0, 0.0, 0.3]
[[points]]
name = "anchor"
position = [500.0, 0.0, -120.0]
kind = "fixed"
[[points]]
name = "fairlead"
position = [40.0, 0.0, -10.0]
kind = "coupled"
on = "platform"
[[points]]
name = "anchor2"
position = [-405.0, 0.0, -120.0]
kind = "fixed"
[[points]]
name = "buoy"
position = [-5.0, 0.0, -10.0]
kind = "coupled"
[[lines]]
name = "line1"
from = "anchor"
to = "fairlead"
sections = [{ type = "chain", length = 350.0 }, { type = "rope", length = 150.0 }]
[[lines]]
name = "line2"
from = "anchor2"
to = "buoy"
sections = [{ type = "chain", length = 450.0 }]
[motion]
platform = { x = [[2.0, 12.0]], pitch = [[0.05, 9.0]], yaw = [[0.05, 30.0, 1.0]] }
[output]
duration = 60.0
interval = 0.1
"#;

/// What was written, the slip, the key that is noted, and a phrase of the note.
const SLIPS: &[(&str, &str, &str, &str)] = &[
    (
        "density = 1025.0",
        "density = 1.025",
        "water.density",
        "1000 to 1030 kg/m³ is usual",
    ),
    (
        "density = 1025.0",
        "density = 10055.0",
        "water.density",
        "is unusual",
    ),
    (
        "gravity = 9.81",
        "gravity = 32.2",
        "gravity",
        "9.80665 m/s² is usual",
    ),
    (
        "gravity = 9.81",
        "gravity = 981.0",
        "gravity",
        "9.80665 m/s² is usual",
    ),
    (
        "= 5.5e8",
        "= 5.5e5",
        "line_types.chain.axial_stiffness",
        "300 to 6000 m/s is usual",
    ),
    (
        "= 5.5e8",
        "= 5.5e11",
        "line_types.chain.axial_stiffness",
        "300 to 6000 m/s is usual",
    ),
    ("= 8.0e7", "= 8.0e4", "lines[0]", "less than 20 % is usual"),
    (
        "mass = 126.0",
        "mass = 0.126",
        "line_types.chain.diameter",
        "200 to 12 000 kg/m³ is usual",
    ),
    (
        "diameter = 0.145",
        "diameter = 14.5",
        "line_types.rope.diameter",
        "with the diameter in m",
    ),
    (
        "diameter = 0.145",
        "diameter = 0.0145",
        "line_types.rope.diameter",
        "more than steel",
    ),
    (
        "diameter = 0.144",
        "diameter = 0.08",
        "line_types.chain.diameter",
        "a chain whose bar has this diameter",
    ),
    (
        "drag_normal = 1.3",
        "drag_normal = 13.0",
        "line_types.chain.drag_normal",
        "0 to 5 is usual",
    ),
    (
        "drag_tangential = 0.3",
        "drag_tangential = 30.0",
        "line_types.chain.drag_tangential",
        "0 to 5 is usual",
    ),
    (
        "added_mass_normal = 1.0",
        "added_mass_normal = 10.0",
        "line_types.chain.added_mass_normal",
        "0 to 5 is usual",
    ),
    (
        "direction = 0.5",
        "direction = 45.0",
        "water.waves.regular.direction",
        "45 degrees are 0.7854 rad",
    ),
    ("height = 4.0", "height = 40.0", "water.waves.regular", "breaks"),
    ("period = 10.0", "period = 0.1", "water.waves.regular", "breaks"),
    (
        "pitch = [[0.05, 9.0]]",
        "pitch = [[5.0, 9.0]]",
        "motion.platform.pitch",
        "5 degrees are 0.0873 rad",
    ),
    (
        "yaw = [[0.05, 30.0, 1.0]]",
        "yaw = [[10.0, 30.0]]",
        "motion.platform.yaw",
        "degrees",
    ),
    (
        "yaw = [[0.05, 30.0, 1.0]]",
        "yaw = [[0.05, 30.0, 90.0]]",
        "motion.platform.yaw",
        "90 degrees are 1.5708 rad",
    ),
    (
        "position = [40.0, 0.0, -10.0]",
        "position = [440.0, 0.0, -10.0]",
        "points[1].position",
        "from the origin of platform",
    ),
    (
        "from = \"anchor2\"\nto = \"buoy\"",
        "from = \"buoy\"\nto = \"anchor2\"",
        "lines[1].to",
        "end B, anchor2, is on the seabed",
    ),
    (
        "length = 450.0",
        "length = 380.0",
        "lines[1]",
        "strained by at least",
    ),
    (
        "density = 1025.0",
        "density = 1025.0\ncurrent = { velocity = [0.0, -36.0, 0.0] }",
        "water.current.velocity[1]",
        "less than 5 m/s",
    ),
    (
        "density = 1025.0",
        "density = 1025.0\ncurrent = { profile = [[0.0, 4.0, 4.0], [-20.0, 1.0, 0.0]] }",
        "water.current.profile[0]",
        "5.657 m/s is unusual: less than 5 m/s",
    ),
    (
        "density = 1025.0",
        "density = 1025.0\ncurrent = { profile = [[0.0, 1.0, 0.0], [20.0, 0.5, 0.0]] }",
        "water.current.profile[1]",
        "20 m above the water: heights count upwards",
    ),
    (
        "density = 1025.0",
        "density = 1025.0\ncurrent = { velocity = [1.0, 0.0, 0.0], factor = { ramp = [0.0, 0.0, 9.0, 100.0] } }",
        "water.current.factor",
        "100 m/s with it is unusual",
    ),
    (
        "depth = 120.0",
        "depth = 120.0\nstiffness = 3.0e3",
        "seabed.stiffness",
        "1e4 to 2e9 Pa/m is usual",
    ),
    (
        "depth = 120.0",
        "depth = 120.0\nstiffness = 3.0e9",
        "seabed.stiffness",
        "1e4 to 2e9 Pa/m is usual",
    ),
    (
        "depth = 120.0",
        "depth = 120.0\nslope = [0.0, -1.5]",
        "seabed.slope[1]",
        "no angle in degrees",
    ),
    (
        "axial_damping = 1.0e6",
        "damping_ratio = 80.0",
        "line_types.chain.damping_ratio",
        "0 to 1 is usual",
    ),
    (
        "axial_damping = 1.0e6",
        "axial_damping = 1.0e6\nrayleigh = { ratios = [0.9, 1.5], frequencies = [1.0, 10.0] }",
        "line_types.chain.rayleigh.ratios[1]",
        "0 to 1 is usual",
    ),
    (
        "axial_damping = 3.0e5",
        "axial_damping = 3.0e5\nsolid_section = { diameter = 0.02, youngs_modulus = 210.0 }",
        "line_types.rope.solid_section.youngs_modulus",
        "2.1e11 Pa of steel",
    ),
    (
        "position = [-405.0, 0.0, -120.0]",
        "position = [-405.0, 0.0, 120.0]",
        "points[2].position",
        "120 m above the water: a fixed point is usually an anchor below it",
    ),
    (
        "length = 450.0",
        "length = 45000.0",
        "lines[1]",
        "less than 20 km is usual",
    ),
    (
        "length = 450.0",
        "length = 9450.0",
        "lines[1]",
        "9450 m long, and its ends are 414.8 m apart: less than 20 times their distance",
    ),
    (
        "x = [[2.0, 12.0]]",
        "x = [[2.0, 0.08]]",
        "motion.platform.x",
        "a frequency of 0.08 Hz is a period of 12.5 s",
    ),
    (
        "attitude = [0.0, 0.0, 0.3]",
        "attitude = [0.0, -5.0, 0.3]",
        "vessels[0].attitude[1]",
        "pitch of 5 rad is a turn by 286 degrees: 5 degrees are 0.0873 rad",
    ),
    (
        "pitch = [[0.05, 9.0]]",
        "roll = [[1.6, 9.0]]",
        "motion.platform.roll",
        "is a turn by 92 degrees",
    ),
];

#[test]
fn twenty_slips_of_units_are_each_noted_by_key_line_and_what_is_usual() {
    let folder = tempfile::tempdir().unwrap();
    for &(right, slip, at, phrase) in SLIPS {
        assert!(SCENE.contains(right), "{right}");
        let text = SCENE.replacen(right, slip, 1);
        let path = folder.path().join("scene.toml");
        fs::write(&path, &text).unwrap();
        let loaded = load(&path).unwrap_or_else(|error| panic!("{slip}: {}", error.list()));
        let found: Vec<&Note> = loaded.notes.iter().filter(|note| note.at == at).collect();
        let [note] = found[..] else {
            panic!("{slip}: {found:?} in {:#?}", loaded.notes);
        };
        assert!(note.text.contains(phrase), "{slip}: {note}");
        let line = note.line.expect("the key stands in the file");
        let beside = text
            .lines()
            .skip(line.saturating_sub(3))
            .take(8)
            .collect::<Vec<_>>()
            .join("\n");
        let shown = slip.lines().last().unwrap();
        let whole_line = at.starts_with("lines") && beside.contains("[[lines]]");
        assert!(
            whole_line || beside.contains(shown),
            "{slip}: line {line} is {beside}"
        );
    }
}

/// Every scene that is shipped, and that of the README.
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
        note.text.contains("breaks in its first step") && note.text.contains("1000 N breaks it"),
        "{note}"
    );
    assert_eq!(noted("1.0e8"), []);
}

#[test]
fn a_run_of_hours_is_noted_with_its_elements_and_steps_and_what_to_change() {
    let expense = |elements: usize| {
        let text = ROPE.replace("elements = 6", &format!("elements = {elements}"));
        let scene = Scene::from_toml(&(text + "[solver]\nintegrator = \"leapfrog\"\n")).unwrap();
        let simulation = Simulation::new(&scene).unwrap();
        moorline::discretisation::expense(&scene, &simulation, scene.output.interval)
    };
    assert_eq!(expense(100), None);
    let note = expense(20_000).unwrap();
    assert_eq!(note.at, "lines[0]");
    for part in ["hours on one thread: 20000 elements, ", "fewer `elements`"] {
        assert!(note.text.contains(part), "{note}");
    }
}

/// A rope between two points in the dry, 10 m long.
const ROPE: &str = r#"
[line_types.rope]
mass = 0.2
axial_stiffness = 2505.0
[[points]]
name = "wall"
position = [0.0, 0.0, 0.0]
kind = "fixed"
[[points]]
name = "hand"
position = [9.0, 0.0, 0.0]
kind = "coupled"
[[lines]]
name = "rope"
from = "wall"
to = "hand"
sections = [{ type = "rope", length = 10.0, elements = 6 }]
"#;

#[test]
fn a_fairlead_that_jumps_and_a_line_that_is_strained_are_each_noted_once_in_a_run() {
    let scene = Scene::from_toml(ROPE).unwrap();
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
    assert_eq!(texts.len(), 2, "{texts:?}");
    assert!(texts[0].contains("hand has moved by"), "{texts:?}");
    assert!(texts[1].contains("rope is strained by"), "{texts:?}");
}
