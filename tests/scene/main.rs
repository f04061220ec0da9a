//! Scenes as a user writes them: every refusal once with its place, files that are no scenes, text that is anything.

mod broken;
#[path = "../common/mod.rs"]
mod common;
mod files;
mod garbage;
mod refusals;
mod relations;
mod words;

use moorline::scene::Scene;

/// A scene without a mistake that has a little of everything.
const SCENE: &str = r#"title = "a scene"
gravity = 9.81

[water]
density = 1025.0

[seabed]
depth = 50.0

[line_types.chain]
mass = 100.0
diameter = 0.1
axial_stiffness = 1.0e8
drag_normal = 1.2

[[points]]
name = "anchor"
position = [100.0, 0.0, -50.0]
kind = "fixed"

[[points]]
name = "buoy"
position = [20.0, 0.0, -20.0]
kind = "free"

[[points]]
name = "fairlead"
position = [0.0, 0.0, 0.0]
kind = "coupled"

[[lines]]
name = "line1"
from = "anchor"
to = "buoy"
sections = [{ type = "chain", length = 80.0 }]

[[lines]]
name = "line2"
from = "buoy"
to = "fairlead"
sections = [{ type = "chain", length = 150.0, elements = 10 }]

[motion]
fairlead = { x = [[1.0, 10.0]] }

[output]
duration = 60.0
interval = 0.1
"#;

/// What is written instead, and the beginning of what is said about it: line, column, key, problem.
type Refusal = (&'static str, &'static str, &'static str);

/// What reading a text says: line, column, key and problem of the first mistake, or `fine`.
fn said(text: &str) -> String {
    match Scene::from_toml(text) {
        Ok(_) => "fine".to_string(),
        Err(mistake) => {
            let (line, column) = mistake.line_column(text);
            format!("{line}:{column}: {mistake}")
        }
    }
}

fn assert_refused(refusals: &[Refusal]) {
    for (right, wrong, message) in refusals {
        assert!(SCENE.contains(right), "{right} is not in the scene");
        let said = said(&SCENE.replacen(right, wrong, 1));
        assert!(
            said.starts_with(message),
            "{wrong}\n  said:   {said}\n  wanted: {message}"
        );
    }
}

#[test]
fn the_scene_that_the_mistakes_are_made_in_is_right() {
    assert_eq!(said(SCENE), "fine");
}
