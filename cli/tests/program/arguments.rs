//! Arguments, and files that are not scenes: exit codes and messages.

use super::*;

/// Every command that reads a scene: its arguments before and after the name of the scene.
const COMMANDS: [[&str; 2]; 4] = [
    ["check", ""],
    ["statics", ""],
    ["run", "-o r"],
    ["fmu", "-o x.fmu"],
];

#[test]
fn no_argument_shows_the_help() {
    let output = folder().run("");
    assert_eq!(output.status.code(), Some(2));
    let commands = ["check", "statics", "run", "fmu", "demo"].map(|command| format!("\n  {command} "));
    assert_says(&err(&output), &commands.each_ref().map(String::as_str));
    let codes = "Exit codes: 0 done, 2 the input is wrong, 1 the computation failed";
    assert_says(&err(&output), &[codes]);
}

#[test]
fn help_and_version_go_to_standard_output() {
    folder().shows("--help", &["Usage: moorline <COMMAND>"]);
    folder().shows("--version", &[env!("CARGO_PKG_VERSION")]);
    folder().shows("run --help", &["--communication-step <H>"]);
}

#[test]
fn wrong_arguments_are_refused_with_what_would_be_right() {
    let folder = folder();
    for (arguments, part) in [
        ("runn", "unrecognized subcommand 'runn'"),
        ("statics", "<SCENE>"),
        ("run scene.toml", "--output <DIR>"),
        ("fmu scene.toml", "--output <FILE>"),
        ("fmu scene.toml -o x.fmu --fmi 1", "[possible values: 2, 3]"),
        ("run scene.toml -o r --velocities", "--communication-step <H>"),
        (
            "check scene.toml --vessel a+b",
            "'--vessel <NAME>': \"a+b\" holds '+'",
        ),
    ] {
        folder.refused(arguments, &[part]);
    }
    for step in ["0", "-0.1", "inf", "NaN", "fast"] {
        let part = if step == "fast" {
            "is not a number"
        } else {
            "must be positive and finite"
        };
        folder.refused(
            &format!("run scene.toml -o r --communication-step={step}"),
            &[part],
        );
    }
    assert_eq!(folder.names(), ["scene.toml"]);
}

#[test]
fn every_command_refuses_a_file_that_is_not_there() {
    let folder = folder();
    for [command, output] in COMMANDS {
        folder.refused(&format!("{command} scene.tml {output}"), &["scene.tml"]);
    }
    assert_eq!(folder.names(), ["scene.toml"]);
}

#[test]
fn a_folder_or_a_picture_is_no_scene() {
    let folder = folder();
    folder.refused("check .", &["."]);
    folder.write("p.png", [0x89, b'P', 0xff, 0xfe, 0]);
    folder.refused("check p.png", &["p.png"]);
}

#[test]
fn a_mistake_is_shown_with_its_line_and_what_would_be_right() {
    let folder = folder();
    folder.write(
        "wrong.toml",
        SCENE.replace("axial_stiffness = 2505.0", "axial_stifness = 2505.0"),
    );
    for [command, output] in COMMANDS {
        let parts = ["wrong.toml:5:1", "axial_stifness = 2505.0", "axial_stiffness"];
        folder.refused(&format!("{command} wrong.toml {output}"), &parts);
    }
    assert_eq!(folder.names(), ["scene.toml", "wrong.toml"]);
}

#[test]
fn all_mistakes_are_shown_beside_their_lines() {
    let wrong = SCENE
        .replace("mass = 0.05", "mass = -1.0")
        .replace("to = \"fairlead\"", "to = \"fairlaed\"");
    let parts = [
        "(and 1 mistake more)",
        "mass = -1.0",
        "to = \"fairlaed\"",
        "did you mean `fairlead`?",
    ];
    folder_with(&[("wrong.toml", &wrong)]).refused("check wrong.toml", &parts);
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
        folder.write("end.toml", text);
        folder.refused("check end.toml", &["end.toml:"]);
        assert!(!err(&folder.run("check end.toml")).contains("Failed"));
    }
}

#[test]
fn what_a_deck_leaves_to_its_host_is_refused_beside_a_scene() {
    let folder = folder();
    for [command, output] in COMMANDS {
        for (given, part) in [
            ("--depth 300", "`seabed.depth`"),
            ("--at platform=1,2,3", "`position`"),
            ("--vessel platform", "[[vessels]]"),
        ] {
            let arguments = format!("{command} {output} scene.toml {given}");
            folder.refused(&arguments, &["scene.toml: a scene gives", part]);
        }
    }
    assert_eq!(folder.names(), ["scene.toml"]);
}

#[test]
fn dynamics_is_another_name_of_the_integrator() {
    let with = |solver: &str| folder_with(&[("s.toml", &format!("{SCENE}[solver]\n{solver}\n"))]);
    with("dynamics = \"quasi_static\"").shows("check s.toml", &["quasi-static: an equilibrium"]);
    with("dynamics = \"quasistatic\"").refused("check s.toml", &["s.toml:31:12", "quasi_static"]);
    let twice = with("dynamics = \"quasi_static\"\nintegrator = \"auto\"");
    twice.refused("check s.toml", &["`integrator` is given twice"]);
}

#[test]
fn check_says_what_is_modelled_and_what_a_host_finds() {
    let parts = [
        "a rope between two poles",
        "not modelled",
        "in: fairlead.x [m]",
        "out: line1.sag [m]",
    ];
    folder().shows("check scene.toml", &parts);
}

#[test]
fn check_writes_the_discretisation_into_the_scene_and_a_run_is_the_same_without_trials() {
    let folder = folder_of("hanging_riser");
    let (given, before) = (folder.read("scene.toml"), folder.columns("run scene.toml -o out"));
    folder.shows(
        "check scene.toml --write",
        &["written to scene.toml: solver.elements = "],
    );
    let held = folder.read("scene.toml");
    let kept = |line: &&str| held.contains(*line);
    assert!(
        given.lines().all(|line| kept(&line)),
        "comments and order stay: {held}"
    );
    assert_eq!(folder.columns("run scene.toml -o out"), before);
    folder.shows(
        "check scene.toml --write",
        &["scene.toml is unchanged: the elements of all lines are given"],
    );
}

/// A rope between two lengths of chain that are one element on all mesh levels.
const ROPE_AND_CHAINS: &str = "\
water.density = 1025.0
line_types.chain = { mass = 113.35, diameter = 0.0766, axial_stiffness = 7.5e8, drag_normal = 2.0 }
line_types.rope = { mass = 38.0, diameter = 0.22, axial_stiffness = 2.0e8, drag_normal = 1.2 }
points = [
    { name = \"anchor\", kind = \"fixed\", position = [1800.0, 0.0, -2000.0] },
    { name = \"fairlead\", kind = \"coupled\", position = [0.0, 0.0, -15.0] },
]
motion.fairlead = { x = [[4.0, 14.0]], z = [[2.0, 10.0]], ramp = 20.0 }
solver.tolerance = 0.005
output = { duration = 60.0, interval = 0.1 }

[[lines]]
name = \"leg\"
from = \"anchor\"
to = \"fairlead\"
sections = [{ type = \"chain\", length = 150.0 }, { type = \"rope\", length = 2400.0 }, { type = \"chain\", length = 100.0 }]
";

#[test]
fn check_writes_the_elements_of_sections_too() {
    let folder = folder_with(&[("scene.toml", ROPE_AND_CHAINS)]);
    let before = folder.columns("run scene.toml -o out");
    folder.shows(
        "check scene.toml --write",
        &[
            "lines[0].sections[0].elements = 2",
            "lines[0].sections[2].elements = 2",
        ],
    );
    let held = folder.read("scene.toml");
    assert!(
        held.contains("{ type = \"chain\", length = 150.0, elements = 2 }"),
        "{held}"
    );
    assert_eq!(folder.columns("run scene.toml -o out"), before);
}

#[test]
fn check_writes_one_name_of_the_integrator_and_the_line_ends_of_the_file() {
    let scene = ROPE_AND_CHAINS.replace("solver.tolerance", "solver.dynamics = \"auto\"\nsolver.tolerance");
    let folder = folder_with(&[("scene.toml", &scene.replace('\n', "\r\n"))]);
    folder.shows("check scene.toml --write", &["solver.integrator = "]);
    let held = folder.read("scene.toml");
    assert!(
        !held.contains("dynamics") && !held.replace("\r\n", "").contains('\n'),
        "{held}"
    );
    folder.shows("check scene.toml --write", &["scene.toml is unchanged"]);
}

#[test]
fn check_writes_no_deck() {
    let folder = folder_with(&[("lines.txt", VERSION_1)]);
    folder.refused("check lines.txt --write", &["--write", "moorline convert"]);
    assert_eq!(folder.read("lines.txt"), VERSION_1);
}
