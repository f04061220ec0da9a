//! `moorline modes`: natural modes as a table, as JSON and as a figure.

use serde_json::Value;

use super::*;

fn json(count: usize) -> Value {
    let text = folder().done(&format!("modes scene.toml --json --count {count}"));
    serde_json::from_str(&text).unwrap()
}

#[test]
fn modes_shows_periods_directions_and_places() {
    let text = folder().done("modes scene.toml");
    let parts = [
        "a rope between two poles",
        "period [s]",
        "frequency [Hz]",
        "line \"line1\", node 4",
    ];
    assert_says(&text, &parts);
    assert_says(&text, &["out of plane"]);
    assert_eq!(
        text.lines().filter(|line| line.contains("%")).count(),
        10,
        "{text}"
    );
}

#[test]
fn modes_as_json_has_the_documented_keys() {
    let json = json(3);
    let modes = json["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 3);
    assert_documented(&json);
    let [period, frequency] = ["period", "frequency"].map(|key| modes[0][key].as_f64().unwrap());
    assert!((period * frequency - 1.0).abs() < 1e-12);
    let shape = modes[0]["shapes"][0]["nodes"].as_array().unwrap();
    assert_eq!((shape.len(), shape[0]["y"].as_f64()), (9, Some(0.0)));
    let part = |node: &Value, axis: &str| node[axis].as_f64().unwrap().powi(2);
    let size = |node: &Value| ["x", "y", "z"].map(|axis| part(node, axis)).iter().sum::<f64>();
    let greatest = shape.iter().map(size).fold(0.0, f64::max);
    assert!((greatest - 1.0).abs() < 1e-12, "{greatest}");
}

#[test]
fn modes_of_one_line_end_where_it_has_no_more() {
    assert_eq!(json(100)["modes"].as_array().unwrap().len(), 3 * 7);
}

#[test]
fn modes_draws_the_lowest_ones() {
    let folder = folder();
    folder.done("modes scene.toml -o figures");
    assert_eq!(folder.names(), ["figures/modes.svg", "scene.toml"]);
    assert_says(&folder.read("figures/modes.svg"), &["s [m]", "line1"]);
}

#[test]
fn modes_refuses_no_modes_and_beams() {
    folder().refused("modes scene.toml --count 0", &["--count"]);
    let beam =
        "model = \"beam\"\nshear_stiffness = 1e3\nbending_stiffness = 10.0\ntorsional_stiffness = 10.0";
    let beam = SCENE.replace("axial_damping = 5.0", &format!("{beam}\nrotary_inertia = 1e-4"));
    let parts = ["line \"line1\": natural modes of beams are not computed"];
    folder_with(&[("beam.toml", &beam)]).refused("modes beam.toml", &parts);
}
