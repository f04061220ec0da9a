//! `moorline statics`: the equilibrium as a table and as JSON.

use std::fs;

use super::{SCENE, assert_documented, done, err, folder, moorline, names, out, refused};

#[test]
fn an_equilibrium_that_does_not_exist_is_a_computation_that_failed() {
    let folder = folder();
    // Beyond λ = e the logarithmic measure of an incompressible line carries less and less.
    let soft = SCENE
        .replace(
            "axial_stiffness = 2505.0",
            "axial_stiffness = 1.0\nstrain = { logarithmic = 0.5 }",
        )
        .replace("mass = 0.05", "mass = 100.0");
    fs::write(folder.path().join("soft.toml"), soft).unwrap();
    let parts = ["error: line \"line1\"", "lower the load"];
    refused(folder.path(), &["statics", "soft.toml"], 1, &parts);
    refused(folder.path(), &["run", "soft.toml", "-o", "r"], 1, &parts);
    refused(folder.path(), &["fmu", "soft.toml", "-o", "x.fmu"], 1, &parts);
    assert_eq!(names(folder.path()), ["scene.toml", "soft.toml"]);
}

#[test]
fn statics_shows_the_closed_form_beside_the_solution() {
    let text = done(folder().path(), &["statics", "scene.toml"]);
    for part in [
        "line1 tension at end B [N]",
        "catenary",
        "line1 sag [m]",
        "fairlead",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
}

#[test]
fn statics_as_json_has_the_documented_keys_and_balances() {
    let text = done(folder().path(), &["statics", "scene.toml", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let line = &json["lines"][0];
    for key in ["horizontal", "vertical", "laid_length", "stretched_length", "sag"] {
        assert!(line[key].is_f64(), "{key} in {line}");
    }
    let force = |end: &str, axis: usize| line[end]["force"][axis].as_f64().unwrap();
    let weight = 0.05 * 9.80665 * 14.1421;
    assert!((force("end_a", 2) + force("end_b", 2) + weight).abs() < 1e-6 * weight);
    assert!((force("end_a", 0) + force("end_b", 0)).abs() < 1e-6 * weight);
    assert_eq!(line["horizontal"].as_f64().unwrap(), -force("end_b", 0));
    assert_eq!(line["vertical"].as_f64().unwrap(), -force("end_b", 2));
    let profile = line["profile"].as_array().unwrap();
    assert_eq!(profile.len(), 9);
    assert_eq!(profile[8]["s"].as_f64(), Some(14.1421));
    assert_eq!(profile[8]["x"].as_f64(), Some(14.0));
    assert_eq!(json["points"][1]["name"], "fairlead");
    assert_eq!(json["points"][1]["kind"], "coupled");
    assert_eq!(json["points"][1]["force"][2], line["end_b"]["force"][2]);
    assert_eq!(json["vessels"], serde_json::json!([]));
}

/// The number in this column, from 1, of the row of a table that begins with `name`.
fn cell(text: &str, name: &str, column: usize) -> f64 {
    let row = text.lines().find_map(|line| line.strip_prefix(name));
    let cells = row.unwrap_or_else(|| panic!("{name} in {text}"));
    let cell = cells.split_whitespace().nth(column - 1);
    cell.unwrap_or_else(|| panic!("{name} in {text}"))
        .parse()
        .unwrap()
}

fn public_scene(name: &str) -> String {
    format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn statics_solves_the_equilibrium_whatever_shape_a_run_starts_on() {
    let folder = folder();
    // A parabola as deep as the catenary carries almost three times its tension.
    let output = moorline(folder.path(), &["statics", &public_scene("seafem11")]);
    assert_eq!(output.status.code(), Some(0));
    assert!(
        err(&output).contains("lines[0].initial: runs start on this shape"),
        "{}",
        err(&output)
    );
    // The catenary of SeaFEM case 11, to what 22 elements leave.
    let horizontal = cell(&out(&output), "line1 horizontal force at end B [N]", 1);
    assert!((horizontal / 17.00889855 - 1.0).abs() < 1e-3, "{horizontal}");
    let straight = SCENE.replace("name = \"line1\"", "name = \"line1\"\ninitial = \"straight\"");
    fs::write(folder.path().join("straight.toml"), straight).unwrap();
    let json = |scene: &str| done(folder.path(), &["statics", scene, "--json"]);
    assert_eq!(json("straight.toml"), json("scene.toml"));
}

#[test]
fn a_run_that_starts_at_speed_shows_the_equilibrium_at_rest() {
    let folder = folder();
    let moved = ["--move", "fairlead.x=5,12", "--duration", "0.1"];
    let scene = public_scene("oc3_catenary");
    let run = done(
        folder.path(),
        &[["run", &scene, "-o", "out"].as_slice(), &moved].concat(),
    );
    let statics = done(folder.path(), &["statics", &scene]);
    for name in [
        "line1 tension at end B [N]",
        "line1 horizontal force at end B [N]",
    ] {
        // The mesh depends on the motion.
        let ratio = cell(&run, name, 1) / cell(&statics, name, 1);
        assert!((ratio - 1.0).abs() < 1e-3, "{name}: {ratio}");
    }
}

#[test]
fn what_flies_freely_has_no_equilibrium_to_show() {
    let folder = folder();
    let scene = public_scene("flying_spaghetti");
    refused(
        folder.path(),
        &["statics", &scene],
        1,
        &["line \"rod\"", "nothing holds this beam"],
    );
    let run = done(folder.path(), &["run", &scene, "-o", "out", "--duration", "0.2"]);
    assert!(run.starts_with("no static equilibrium\n"), "{run}");
}

#[test]
fn every_key_of_the_json_is_documented() {
    let folder = folder();
    for scene in ["storm_moored_semi", "power_cable"] {
        let text = done(folder.path(), &["statics", &public_scene(scene), "--json"]);
        assert_documented(&serde_json::from_str(&text).unwrap());
    }
}
