//! `moorline statics`: the equilibrium as a table and as JSON.

use serde_json::Value;

use super::*;

#[test]
fn an_equilibrium_that_does_not_exist_is_a_computation_that_failed() {
    let folder = folder();
    // beyond a stretch of λ = e, an incompressible line with logarithmic strain carries less and less tension
    let soft = SCENE.replace("mass = 0.05", "mass = 100.0\nstrain = { logarithmic = 0.5 }");
    folder.write(
        "soft.toml",
        soft.replace("axial_stiffness = 2505.0", "axial_stiffness = 1.0"),
    );
    for command in [
        "statics soft.toml",
        "run soft.toml -o r",
        "fmu soft.toml -o x.fmu",
    ] {
        folder.fails(command, &["error: line \"line1\"", "lower the load"]);
    }
    assert_eq!(folder.names(), ["scene.toml", "soft.toml"]);
}

#[test]
fn statics_shows_the_closed_form_beside_the_solution() {
    let parts = [
        "line1 tension at end B [N]",
        "catenary",
        "line1 sag [m]",
        "fairlead",
    ];
    folder().shows("statics scene.toml", &parts);
}

#[test]
fn statics_as_json_has_the_documented_keys_and_balances() {
    let json: Value = serde_json::from_str(&folder().done("statics scene.toml --json")).unwrap();
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
    let last = ["s", "x"].map(|key| profile[8][key].as_f64());
    assert_eq!((profile.len(), last), (9, [Some(14.1421), Some(14.0)]));
    let point = &json["points"][1];
    assert_eq!(
        (&point["name"], &point["kind"]),
        (&"fairlead".into(), &"coupled".into())
    );
    assert_eq!(point["force"][2], line["end_b"]["force"][2]);
    assert_eq!(json["vessels"], serde_json::json!([]));
}

/// Number in a column, counted from 1, of the table row that begins with `name`.
fn cell(text: &str, name: &str, column: usize) -> f64 {
    let row = text.lines().find_map(|line| line.strip_prefix(name));
    let cell = row.and_then(|cells| cells.split_whitespace().nth(column - 1));
    cell.unwrap_or_else(|| panic!("{name} in {text}"))
        .parse()
        .unwrap()
}

#[test]
fn statics_solves_the_equilibrium_whatever_shape_a_run_starts_on() {
    // a parabola as deep as the catenary has almost three times its tension
    let output = folder_of("seafem11").run("statics scene.toml");
    assert_eq!(output.status.code(), Some(0));
    assert_says(&err(&output), &["lines[0].initial: runs start on this shape"]);
    // the catenary of SeaFEM case 11, within the error of 22 elements
    let horizontal = cell(&out(&output), "line1 horizontal force at end B [N]", 1);
    assert!((horizontal / 17.00889855 - 1.0).abs() < 1e-3, "{horizontal}");
    let folder = folder();
    let straight = SCENE.replace("name = \"line1\"", "name = \"line1\"\ninitial = \"straight\"");
    folder.write("straight.toml", straight);
    let json = |scene: &str| folder.done(&format!("statics {scene} --json"));
    assert_eq!(json("straight.toml"), json("scene.toml"));
}

#[test]
fn a_run_that_starts_at_speed_shows_the_equilibrium_at_rest() {
    let folder = folder_of("oc3_catenary");
    let run = folder.done("run scene.toml -o out --move fairlead.x=5,12 --duration 0.1");
    let statics = folder.done("statics scene.toml");
    for name in [
        "line1 tension at end B [N]",
        "line1 horizontal force at end B [N]",
    ] {
        // the mesh depends on the motion
        let ratio = cell(&run, name, 1) / cell(&statics, name, 1);
        assert!((ratio - 1.0).abs() < 1e-3, "{name}: {ratio}");
    }
}

#[test]
fn what_flies_freely_has_no_equilibrium_to_show() {
    let folder = folder_of("flying_spaghetti");
    folder.fails("statics scene.toml", &["line \"rod\"", "nothing holds this beam"]);
    let run = folder.done("run scene.toml -o out --duration 0.2");
    assert!(run.starts_with("no static equilibrium\n"), "{run}");
}

#[test]
fn every_key_of_the_json_is_documented() {
    for scene in ["storm_moored_semi", "power_cable"] {
        let text = folder_of(scene).done("statics scene.toml --json");
        assert_documented(&serde_json::from_str(&text).unwrap());
    }
}
