//! Scenes as a user writes them: every refusal once with its place, files that are not scenes, arbitrary text.

mod broken;
#[path = "../common/mod.rs"]
mod common;
mod files;
mod garbage;
mod refusals;
mod words;

use moorline::scene::Scene;

/// A valid scene with a variety of features.
const SCENE: &str = include_str!("../scenes/small.toml");

/// Line, column, key and problem of the first mistake in a text, or `fine`.
fn said(text: &str) -> String {
    Scene::from_toml(text).map_or_else(
        |mistake| {
            let (line, column) = mistake.line_column(text);
            format!("{line}:{column}: {mistake}\n")
        },
        |_| "fine".to_string(),
    )
}

#[test]
fn the_scene_that_the_mistakes_are_made_in_is_right() {
    assert_eq!(said(SCENE), "fine");
}
