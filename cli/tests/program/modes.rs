//! `moorline modes`: natural modes as a table, as JSON and as a figure.

use std::fs;

use super::{SCENE, assert_documented, done, folder, names, refused};

fn json(arguments: &[&str]) -> serde_json::Value {
    let text = done(
        folder().path(),
        &[&["modes", "scene.toml", "--json"], arguments].concat(),
    );
    serde_json::from_str(&text).unwrap()
}

#[test]
fn modes_shows_periods_directions_and_places() {
    let text = done(folder().path(), &["modes", "scene.toml"]);
    for part in [
        "a rope between two poles",
        "period [s]",
        "frequency [Hz]",
        "line \"line1\", node 4",
        "out of plane",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    assert_eq!(
        text.lines().filter(|line| line.contains("%")).count(),
        10,
        "{text}"
    );
}

#[test]
fn modes_as_json_has_the_documented_keys() {
    let json = json(&["--count", "3"]);
    let modes = json["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 3);
    assert_documented(&json);
    let mode = &modes[0];
    let (period, frequency) = (
        mode["period"].as_f64().unwrap(),
        mode["frequency"].as_f64().unwrap(),
    );
    assert!((period * frequency - 1.0).abs() < 1e-12);
    let shape = mode["shapes"][0]["nodes"].as_array().unwrap();
    assert_eq!((shape.len(), shape[0]["y"].as_f64()), (9, Some(0.0)));
    let size = |node: &serde_json::Value| {
        ["x", "y", "z"]
            .map(|axis| node[axis].as_f64().unwrap().powi(2))
            .iter()
            .sum::<f64>()
    };
    let greatest = shape.iter().map(size).fold(0.0, f64::max);
    assert!((greatest - 1.0).abs() < 1e-12, "{greatest}");
}

#[test]
fn modes_of_one_line_end_where_it_has_no_more() {
    let modes = json(&["--count", "100"]);
    assert_eq!(modes["modes"].as_array().unwrap().len(), 3 * 7);
}

#[test]
fn modes_draws_the_lowest_ones() {
    let folder = folder();
    done(folder.path(), &["modes", "scene.toml", "-o", "figures"]);
    assert_eq!(names(folder.path()), ["figures/modes.svg", "scene.toml"]);
    let svg = fs::read_to_string(folder.path().join("figures/modes.svg")).unwrap();
    assert!(svg.contains("s [m]") && svg.contains("line1"));
}

#[test]
fn modes_refuses_no_modes_and_beams() {
    let folder = folder();
    refused(
        folder.path(),
        &["modes", "scene.toml", "--count", "0"],
        2,
        &["--count"],
    );
    let beam = SCENE.replace(
        "axial_damping = 5.0",
        "model = \"beam\"\nshear_stiffness = 1e3\nbending_stiffness = 10.0\ntorsional_stiffness = 10.0\nrotary_inertia = 1e-4",
    );
    fs::write(folder.path().join("beam.toml"), beam).unwrap();
    let parts = ["line \"line1\": natural modes of beams are not computed"];
    refused(folder.path(), &["modes", "beam.toml"], 2, &parts);
}
