//! Arguments, and files that are no scenes: exit codes and messages.

use std::fs;

use super::{SCENE, done, err, folder, moorline, names, refused};

#[test]
fn no_argument_shows_the_help() {
    let output = moorline(folder().path(), &[] as &[&str]);
    assert_eq!(output.status.code(), Some(2));
    let text = err(&output);
    for command in ["check", "statics", "run", "fmu", "demo"] {
        assert!(text.contains(&format!("\n  {command} ")), "{command} in {text}");
    }
    assert!(text.contains("Exit codes: 0 done, 2 the input is wrong, 1 the computation failed"));
}

#[test]
fn help_and_version_go_to_standard_output() {
    let folder = folder();
    assert!(done(folder.path(), &["--help"]).contains("Usage: moorline <COMMAND>"));
    assert!(done(folder.path(), &["--version"]).contains(env!("CARGO_PKG_VERSION")));
    assert!(done(folder.path(), &["run", "--help"]).contains("--communication-step <H>"));
}

#[test]
fn wrong_arguments_are_refused_with_what_would_be_right() {
    let folder = folder();
    let refused = |arguments: &[&str], part: &str| refused(folder.path(), arguments, 2, &[part]);
    refused(&["runn"], "unrecognized subcommand 'runn'");
    refused(&["statics"], "<SCENE>");
    refused(&["run", "scene.toml"], "--output <DIR>");
    refused(&["fmu", "scene.toml"], "--output <FILE>");
    refused(
        &["fmu", "scene.toml", "-o", "x.fmu", "--fmi", "1"],
        "[possible values: 2, 3]",
    );
    refused(
        &["run", "scene.toml", "-o", "r", "--velocities"],
        "--communication-step <H>",
    );
    let with_step = |step: &str, part: &str| {
        let step = format!("--communication-step={step}");
        refused(&["run", "scene.toml", "-o", "r", &step], part);
    };
    with_step("0", "must be positive and finite");
    with_step("-0.1", "must be positive and finite");
    with_step("inf", "must be positive and finite");
    with_step("NaN", "must be positive and finite");
    with_step("fast", "is not a number");
    refused(
        &["check", "scene.toml", "--vessel", "a b"],
        "invalid value 'a b' for '--vessel <NAME>': \"a b\" holds ' '",
    );
    assert_eq!(names(folder.path()), ["scene.toml"]);
}

#[test]
fn every_command_refuses_a_file_that_is_not_there() {
    let folder = folder();
    for arguments in [
        ["check", "scene.tml"].as_slice(),
        &["statics", "scene.tml"],
        &["run", "scene.tml", "-o", "r"],
        &["fmu", "scene.tml", "-o", "x.fmu"],
    ] {
        refused(folder.path(), arguments, 2, &["scene.tml"]);
    }
    assert_eq!(names(folder.path()), ["scene.toml"]);
}

#[test]
fn a_folder_or_a_picture_is_no_scene() {
    let folder = folder();
    refused(folder.path(), &["check", "."], 2, &["."]);
    fs::write(folder.path().join("p.png"), [0x89, b'P', 0xff, 0xfe, 0]).unwrap();
    refused(folder.path(), &["check", "p.png"], 2, &["p.png"]);
}

#[test]
fn a_mistake_is_shown_with_its_line_and_what_would_be_right() {
    let folder = folder();
    let wrong = SCENE.replace("axial_stiffness = 2505.0", "axial_stifness = 2505.0");
    fs::write(folder.path().join("wrong.toml"), wrong).unwrap();
    for arguments in [
        ["check", "wrong.toml"].as_slice(),
        &["statics", "wrong.toml"],
        &["run", "wrong.toml", "-o", "r"],
        &["fmu", "wrong.toml", "-o", "x.fmu"],
    ] {
        let parts = ["wrong.toml:5:1", "axial_stifness = 2505.0", "axial_stiffness"];
        refused(folder.path(), arguments, 2, &parts);
    }
    assert_eq!(names(folder.path()), ["scene.toml", "wrong.toml"]);
}

#[test]
fn all_mistakes_are_shown_beside_their_lines() {
    let folder = folder();
    let wrong = SCENE
        .replace("mass = 0.05", "mass = -1.0")
        .replace("to = \"fairlead\"", "to = \"fairlaed\"");
    fs::write(folder.path().join("wrong.toml"), wrong).unwrap();
    let parts = [
        "(and 1 mistake more)",
        "mass = -1.0",
        "to = \"fairlaed\"",
        "did you mean `fairlead`?",
    ];
    refused(folder.path(), &["check", "wrong.toml"], 2, &parts);
}

#[test]
fn a_mistake_at_the_very_end_of_a_file_can_be_shown() {
    let folder = folder();
    for text in [
        "",
        "gravity =",
        "gravity =\n",
        "title = \"",
        "[",
        "\u{feff}\u{fc} = ",
    ] {
        fs::write(folder.path().join("end.toml"), text).unwrap();
        let output = moorline(folder.path(), &["check", "end.toml"]);
        let shown = err(&output);
        assert_eq!(output.status.code(), Some(2), "{shown}");
        assert!(
            shown.contains("end.toml:") && !shown.contains("Failed"),
            "{shown}"
        );
    }
}

#[test]
fn what_a_deck_leaves_to_its_host_is_refused_beside_a_scene() {
    let folder = folder();
    for command in [
        ["check"].as_slice(),
        &["statics"],
        &["run", "-o", "r"],
        &["fmu", "-o", "x.fmu"],
    ] {
        let refused = |more: &[&str], part: &str| {
            let arguments = [command, &["scene.toml"], more].concat();
            refused(folder.path(), &arguments, 2, &["scene.toml: a scene gives", part]);
        };
        refused(&["--depth", "300"], "`seabed.depth`");
        refused(&["--at", "platform=1,2,3"], "`position`");
        refused(&["--vessel", "platform"], "[[vessels]]");
    }
    assert_eq!(names(folder.path()), ["scene.toml"]);
}

#[test]
fn dynamics_is_another_name_of_the_integrator() {
    let folder = folder();
    let scene = |solver: &str| {
        fs::write(
            folder.path().join("s.toml"),
            format!("{SCENE}[solver]\n{solver}\n"),
        )
        .unwrap();
    };
    scene("dynamics = \"quasi_static\"");
    assert!(done(folder.path(), &["check", "s.toml"]).contains("quasi-static: an equilibrium"));
    scene("dynamics = \"quasistatic\"");
    refused(
        folder.path(),
        &["check", "s.toml"],
        2,
        &["s.toml:31:12", "quasi_static"],
    );
    scene("dynamics = \"quasi_static\"\nintegrator = \"auto\"");
    refused(
        folder.path(),
        &["check", "s.toml"],
        2,
        &["`integrator` is given twice"],
    );
}

#[test]
fn check_says_what_is_modelled_and_what_a_host_finds() {
    let text = done(folder().path(), &["check", "scene.toml"]);
    for part in [
        "a rope between two poles",
        "not modelled",
        "in: fairlead.x [m]",
        "out: line1.sag [m]",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
}
