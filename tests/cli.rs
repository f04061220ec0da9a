//! The command line from outside: exit codes, messages, files.

use std::ffi::OsStr;
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

/// A hanging line in still air, quick to run.
const SCENE: &str = r#"title = "a rope between two poles"

[line_types.rope]
mass = 0.05
axial_stiffness = 2505.0
axial_damping = 5.0

[[points]]
name = "anchor"
position = [0.0, 0.0, 0.0]
kind = "fixed"

[[points]]
name = "fairlead"
position = [14.0, 0.0, 0.0]
kind = "coupled"

[[lines]]
name = "line1"
from = "anchor"
to = "fairlead"
sections = [{ type = "rope", length = 14.1421, elements = 8 }]

[motion]
fairlead = { x = [[0.05, 2.0]], ramp = 1.0 }

[output]
duration = 1.0
interval = 0.1
"#;

/// A folder with the scene in it.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    folder
}

fn moorline<S: AsRef<OsStr>>(folder: &Path, arguments: &[S]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_moorline"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Runs what must be refused with this exit code and a message that has all these parts and no backtrace.
fn refused(folder: &Path, arguments: &[&str], code: i32, parts: &[&str]) {
    let output = moorline(folder, arguments);
    let message = err(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
    // A message that is broken into lines is compared as if it were not.
    let flat = message
        .split_whitespace()
        .filter(|word| *word != "│")
        .collect::<Vec<_>>()
        .join(" ");
    for part in parts {
        assert!(
            flat.contains(part),
            "{arguments:?}: no \"{part}\" in\n{message}"
        );
    }
    assert!(!message.contains("panicked"), "{message}");
    assert!(output.stdout.is_empty(), "{arguments:?}: {}", out(&output));
}

/// Runs what must be done.
fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = moorline(folder, arguments);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{arguments:?}: {}",
        err(&output)
    );
    out(&output)
}

/// Names below a folder, sorted, with forward slashes.
fn names(folder: &Path) -> Vec<String> {
    fn collect(folder: &Path, prefix: &str, names: &mut Vec<String>) {
        for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
            if entry.path().is_dir() {
                collect(&entry.path(), &format!("{name}/"), names);
            } else {
                names.push(name);
            }
        }
    }
    let mut found = Vec::new();
    collect(folder, "", &mut found);
    found.sort();
    found
}

/// Numbers of a results table: header and rows.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let header = reader.headers().unwrap().iter().map(String::from).collect();
    let rows = reader.deserialize().collect::<Result<_, _>>().unwrap();
    (header, rows)
}

#[test]
fn no_argument_shows_the_help() {
    let output = moorline(folder().path(), &[] as &[&str]);
    assert_eq!(output.status.code(), Some(2));
    let text = err(&output);
    for command in ["check", "statics", "run", "fmu", "demo"] {
        assert!(
            text.contains(&format!("\n  {command} ")),
            "{command} in {text}"
        );
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
        let parts = [
            "wrong.toml:5:1",
            "axial_stifness = 2505.0",
            "axial_stiffness",
        ];
        refused(folder.path(), arguments, 2, &parts);
    }
    assert_eq!(names(folder.path()), ["scene.toml", "wrong.toml"]);
}

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
    refused(
        folder.path(),
        &["fmu", "soft.toml", "-o", "x.fmu"],
        1,
        &parts,
    );
    assert_eq!(names(folder.path()), ["scene.toml", "soft.toml"]);
}

#[test]
fn a_run_that_blows_up_is_a_computation_that_failed_and_leaves_no_results() {
    let folder = folder();
    let wild = SCENE.replace("[[0.05, 2.0]], ramp = 1.0", "[[1.0e7, 0.02]]");
    let wild = wild.replace("duration = 1.0", "duration = 60.0");
    fs::write(folder.path().join("wild.toml"), wild).unwrap();
    let parts = ["error: t = ", " s, line", "try"];
    refused(folder.path(), &["run", "wild.toml", "-o", "r"], 1, &parts);
    assert_eq!(names(folder.path()), ["scene.toml", "wild.toml"]);
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
    for key in [
        "horizontal",
        "vertical",
        "laid_length",
        "stretched_length",
        "sag",
    ] {
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
    format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))
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
    assert!(
        (horizontal / 17.00889855 - 1.0).abs() < 1e-3,
        "{horizontal}"
    );
    let straight = SCENE.replace(
        "name = \"line1\"",
        "name = \"line1\"\ninitial = \"straight\"",
    );
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
    refused(folder.path(), &["statics", &scene], 1, &["line \"rod\""]);
    let run = done(
        folder.path(),
        &["run", &scene, "-o", "out", "--duration", "0.2"],
    );
    assert!(run.starts_with("no static equilibrium\n"), "{run}");
}

#[test]
fn run_writes_its_files_and_nothing_else() {
    let folder = folder();
    done(folder.path(), &["run", "scene.toml", "-o", "out"]);
    let shapes = (0..11).map(|i| format!("out/vtk/lines_{i:05}.vtp"));
    let mut expected: Vec<String> = [
        "force.svg",
        "lines.pvd",
        "profile.svg",
        "report.html",
        "results.csv",
        "results.units.csv",
        "tension.svg",
    ]
    .map(|name| format!("out/{name}"))
    .into_iter()
    .chain(shapes)
    .chain(["scene.toml".to_string()])
    .collect();
    expected.sort();
    assert_eq!(names(folder.path()), expected);
    let (header, rows) = table(&folder.path().join("out/results.csv"));
    assert_eq!(
        header[..4],
        ["time", "fairlead.x", "fairlead.y", "fairlead.z"]
    );
    assert!(header.contains(&"line1.tension_b".to_string()));
    assert_eq!(rows.len(), 11);
    assert_eq!(rows[10][0], 1.0);
    let (units, _) = header_of_units(&folder.path().join("out/results.units.csv"));
    assert_eq!(units, header);
    let text = fs::read_to_string(folder.path().join("out/results.csv")).unwrap();
    let last = text.lines().last().unwrap().split(',');
    let steps = last
        .zip(&header)
        .find(|(_, name)| *name == "solver.substeps");
    assert!(steps.unwrap().0.parse::<usize>().is_ok(), "{text}");
}

/// Names and units of the columns.
fn header_of_units(path: &Path) -> (Vec<String>, Vec<String>) {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let rows = reader.records().map(Result::unwrap);
    rows.map(|row| (row[0].to_string(), row[1].to_string()))
        .unzip()
}

#[test]
fn profiles_are_written_where_the_scene_asks() {
    let folder = folder();
    fs::write(
        folder.path().join("p.toml"),
        format!("{SCENE}profile = true\n"),
    )
    .unwrap();
    done(folder.path(), &["run", "p.toml", "-o", "out"]);
    let text = fs::read_to_string(folder.path().join("out/profile.csv")).unwrap();
    assert!(text.starts_with("time,line,node,s,x,y,z,tension\n0.0,line1,0,0.0,0.0,0.0,0.0,"));
    assert_eq!(text.lines().count(), 1 + 11 * 9);
}

#[test]
fn a_second_run_replaces_the_first_and_gives_the_same_numbers() {
    let folder = folder();
    let read = || fs::read(folder.path().join("out/results.csv")).unwrap();
    done(folder.path(), &["run", "scene.toml", "-o", "out"]);
    let first = read();
    fs::write(folder.path().join("out/results.csv"), "left over").unwrap();
    done(folder.path(), &["run", "scene.toml", "-o", "out"]);
    assert_eq!(read(), first);
}

/// The table's head, and its rows of a run that follows the scene's motion exactly and of one driven as by a host in steps of `step` [s].
fn exact_and_host(folder: &TempDir, scene: &str, step: &str) -> (Vec<String>, [Vec<Vec<f64>>; 2]) {
    let run = |output: &str, more: &[&str]| {
        done(
            folder.path(),
            &[&["run", scene, "-o", output], more].concat(),
        );
        table(&folder.path().join(output).join("results.csv"))
    };
    let (header, exact) = run("exact", &[]);
    let (_, host) = run("host", &["--communication-step", step, "--velocities"]);
    (header, [exact, host])
}

fn column(header: &[String], name: &str) -> usize {
    header.iter().position(|column| column == name).unwrap()
}

#[test]
fn a_run_driven_like_a_host_follows_the_exact_motion() {
    let folder = folder();
    let fine = SCENE.replace("interval = 0.1", "interval = 0.01");
    fs::write(folder.path().join("fine.toml"), fine).unwrap();
    let (header, [exact, host]) = exact_and_host(&folder, "fine.toml", "0.01");
    let tension = column(&header, "line1.tension_b");
    assert_eq!(exact.len(), host.len());
    for (exact, host) in exact.iter().zip(&host) {
        // The same motion to the last bit; of the tension what the path between communication points costs.
        assert_eq!(exact[..7], host[..7]);
        assert!(
            (exact[tension] / host[tension] - 1.0).abs() < 0.01,
            "{exact:?} {host:?}"
        );
    }
}

#[test]
fn a_run_whose_inputs_mean_the_end_of_a_step_is_told_the_motion_there() {
    let folder = folder();
    let solver = "[solver]\ninput_reconstruction = \"interpolate\"\n";
    fs::write(folder.path().join("known.toml"), format!("{SCENE}{solver}")).unwrap();
    let (header, [exact, host]) = exact_and_host(&folder, "known.toml", "0.1");
    let [place, tension] = ["fairlead.x", "line1.tension_b"].map(|name| column(&header, name));
    assert_eq!(exact.len(), host.len());
    for (exact, host) in exact.iter().zip(&host) {
        assert_eq!(exact[place], host[place]);
        // one step late the tension would be up to a quarter off
        let off = (exact[tension] / host[tension] - 1.0).abs();
        assert!(off < 0.02, "{exact:?} {host:?}");
    }
}

#[test]
fn a_communication_step_sets_the_rows() {
    let folder = folder();
    done(
        folder.path(),
        &[
            "run",
            "scene.toml",
            "-o",
            "out",
            "--communication-step",
            "0.3",
        ],
    );
    let (_, rows) = table(&folder.path().join("out/results.csv"));
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(times, [0.0, 0.3, 0.6, 3.0 * 0.3, 1.0]);
}

#[test]
fn an_output_folder_that_cannot_be_made_is_refused_before_the_run() {
    let folder = folder();
    fs::write(folder.path().join("taken"), "").unwrap();
    let run = |output: &str, parts: &[&str]| {
        refused(
            folder.path(),
            &["run", "scene.toml", "-o", output],
            2,
            parts,
        );
    };
    run("taken", &["taken is a file: give the name of a folder"]);
    run("taken/below", &["cannot make the folder taken/below"]);
    refused(
        folder.path(),
        &["demo", "-o", "taken"],
        2,
        &["taken is a file"],
    );
    assert_eq!(names(folder.path()), ["scene.toml", "taken"]);
}

#[test]
fn an_fmu_that_cannot_be_placed_is_refused() {
    let folder = folder();
    let fmu = |output: &str, part: &str| {
        refused(
            folder.path(),
            &["fmu", "scene.toml", "-o", output],
            2,
            &[part],
        );
    };
    fmu(".", ". is a folder: give the name of a file");
    fmu("nowhere/x.fmu", "nowhere: there is no such folder");
    assert_eq!(names(folder.path()), ["scene.toml"]);
}

/// Puts the FMU library beside the program under test, once: `cargo test` does not build it for the tests of another package.
fn build_library() {
    static BUILT: std::sync::Once = std::sync::Once::new();
    BUILT.call_once(|| {
        let profile = if cfg!(debug_assertions) {
            "dev"
        } else {
            "release"
        };
        let output = Command::new(env!("CARGO"))
            .args([
                "build",
                "--quiet",
                "--package",
                "moorline-fmu",
                "--lib",
                "--profile",
                profile,
            ])
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", err(&output));
    });
}

#[test]
fn an_fmu_of_either_version_is_one_whole_file() {
    build_library();
    let folder = folder();
    for version in ["2", "3"] {
        let target = format!("rope{version}.fmu");
        let arguments = ["fmu", "scene.toml", "-o", &target, "--fmi", version];
        assert_eq!(
            done(folder.path(), &arguments),
            format!("written to {target}\n")
        );
        let file = fs::File::open(folder.path().join(&target)).unwrap();
        let mut archive = zip::ZipArchive::new(file).unwrap();
        let mut xml = String::new();
        let mut entry = archive.by_name("modelDescription.xml").unwrap();
        entry.read_to_string(&mut xml).unwrap();
        drop(entry);
        assert!(xml.contains(&format!("fmiVersion=\"{version}.0\"")));
        let names: Vec<String> = (0..archive.len())
            .map(|i| archive.by_index(i).unwrap().name().unwrap().to_string())
            .collect();
        assert!(
            names.iter().any(|name| name.starts_with("binaries/")),
            "{names:?}"
        );
        assert!(
            names.contains(&"resources/scene.toml".to_string()),
            "{names:?}"
        );
    }
    assert_eq!(
        names(folder.path()),
        ["rope2.fmu", "rope3.fmu", "scene.toml"]
    );
}

#[test]
fn the_demo_drives_an_fmu_that_gives_the_bits_of_a_run() {
    build_library();
    let folder = folder();
    let text = done(folder.path(), &["demo"]);
    for part in [
        "static equilibrium",
        "catenary",
        "line1 tension at end B [N]",
        "times real time",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    let made = names(&folder.path().join("moorline-demo"));
    for name in [
        "demo.fmu",
        "profile.svg",
        "report.html",
        "results.csv",
        "tension.svg",
    ] {
        assert!(made.contains(&name.to_string()), "{name} in {made:?}");
    }
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/demo.toml");
    done(
        folder.path(),
        &["run", scene, "-o", "run", "--communication-step", "0.05"],
    );
    for table in ["results.csv", "profile.csv"] {
        let read = |of: &str| fs::read_to_string(folder.path().join(of).join(table)).unwrap();
        let (run, demo) = (read("run"), read("moorline-demo"));
        let differing = run
            .lines()
            .zip(demo.lines())
            .find(|(run, demo)| run != demo);
        assert_eq!(differing, None, "{table}");
        assert_eq!(run.len(), demo.len());
    }
}

#[test]
fn a_missing_fmu_library_is_named_with_how_to_build_it() {
    let folder = folder();
    // The program alone, away from the library. A link, since a program that was just written may still count as open where other
    // threads start processes.
    let bin = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
    let program = bin
        .path()
        .join(format!("moorline{}", std::env::consts::EXE_SUFFIX));
    fs::hard_link(env!("CARGO_BIN_EXE_moorline"), &program).unwrap();
    let output = Command::new(&program)
        .args(["fmu", "scene.toml", "-o", "x.fmu"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(err(&output).contains("moorline_fmu"), "{}", err(&output));
    assert!(
        err(&output).contains("cargo build --release"),
        "{}",
        err(&output)
    );
    assert!(!folder.path().join("x.fmu").exists());
}

#[test]
fn paths_may_have_spaces_and_any_letters_and_be_far_from_here() {
    let folder = folder();
    let elsewhere = tempfile::tempdir().unwrap();
    let place = folder.path().join("målestokk æøå 図 {x}");
    fs::create_dir(&place).unwrap();
    let scene = place.join("min scene.toml");
    fs::write(&scene, SCENE).unwrap();
    let output = place.join("ut data").join("prøve 1");
    let arguments = [
        OsStr::new("run"),
        scene.as_os_str(),
        OsStr::new("-o"),
        output.as_os_str(),
    ];
    let result = moorline(elsewhere.path(), &arguments);
    assert_eq!(result.status.code(), Some(0), "{}", err(&result));
    assert!(output.join("results.csv").is_file());
    assert!(names(elsewhere.path()).is_empty());
}

#[test]
fn a_closed_pipe_ends_the_program_in_silence() {
    let folder = folder();
    // A profile longer than a pipe holds, so that writing goes on after the reader has gone.
    let long = SCENE.replace("elements = 8", "elements = 1000");
    fs::write(folder.path().join("long.toml"), long).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_moorline"))
        .args(["statics", "long.toml", "--json"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut first = [0; 1];
    let mut pipe = child.stdout.take().unwrap();
    pipe.read_exact(&mut first).unwrap();
    drop(pipe);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(err(&output), "");
}

/// The scene with a motion that is studied in a moment.
fn short_study(folder: &Path) {
    let wet = format!("[water]\ndensity = 1025.0\n\n{SCENE}").replacen("title", "# title", 1);
    let wet = wet
        .replace("# title = \"a rope between two poles\"\n", "")
        .replace(", elements = 8", "")
        .replace(
            "mass = 0.05",
            "mass = 20.0\ndiameter = 0.1\ndrag_normal = 1.2\nadded_mass_normal = 1.0",
        );
    fs::write(folder.join("short.toml"), wet).unwrap();
}

const STUDIED: [&str; 5] = [
    "accuracy.csv",
    "overview.svg",
    "short.svg",
    "summary.md",
    "verdicts.csv",
];

#[test]
fn a_study_is_written_to_its_end_whatever_becomes_of_standard_output() {
    let folder = folder();
    short_study(folder.path());
    let mut child = Command::new(env!("CARGO_BIN_EXE_moorline"))
        .args(["accuracy", "short.toml", "-o", "out"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), err(&output).as_str()), (Some(0), ""));
    assert_eq!(names(&folder.path().join("out")), STUDIED);
}

#[test]
fn a_study_of_a_scene_without_title_or_bed_speaks_of_neither() {
    let folder = folder();
    short_study(folder.path());
    let text = done(folder.path(), &["accuracy", "short.toml", "-o", "out"]);
    assert!(text.contains("\nshort\nconverged solution"), "{text}");
    assert!(!text.contains("bed"), "{text}");
}

#[test]
fn a_study_takes_decks_and_motion_as_a_run_does() {
    let folder = folder();
    short_study(folder.path());
    let accuracy = |more: &[&str], part: &str| {
        let arguments = [["accuracy", "short.toml", "-o", "out"].as_slice(), more].concat();
        refused(folder.path(), &arguments, 2, &[part]);
    };
    accuracy(&["--move", "buoy.x=1,5"], "short: `buoy` is no vessel");
    accuracy(&["--motion", "none.csv"], "none.csv");
    accuracy(&["--depth", "300"], "`seabed.depth`");
    let public = ["accuracy", "--depth", "300"];
    refused(folder.path(), &public, 2, &["--depth and --at"]);
    assert_eq!(names(folder.path()), ["scene.toml", "short.toml"]);
}

/// A program that answers to `-c` as Python does that has the peers, and to nothing else.
#[cfg(unix)]
fn python_in_vain(folder: &Path) -> String {
    use std::os::unix::fs::PermissionsExt;
    let path = folder.join("python");
    fs::write(&path, "#!/bin/sh\n[ \"$1\" = -c ] && echo ready\n").unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    path.display().to_string()
}

#[cfg(unix)]
#[test]
fn peers_that_give_nothing_are_a_computation_that_failed_after_all_else_is_written() {
    let folder = folder();
    short_study(folder.path());
    let python = python_in_vain(folder.path());
    let arguments = ["accuracy", "short.toml", "-o", "out", "--peers", &python];
    let output = moorline(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(1), "{}", err(&output));
    assert!(err(&output).contains("no peer gave a result"));
    assert!(out(&output).contains("no result: peers: "));
    let mut written = STUDIED.map(str::to_string).to_vec();
    written.insert(2, "peers.py".to_string());
    assert_eq!(names(&folder.path().join("out")), written);
}

#[cfg(unix)]
#[test]
fn what_is_no_python_is_refused_at_once() {
    let folder = folder();
    for program in ["true", "false", "echo"] {
        let program = format!("/bin/{program}");
        let arguments = ["accuracy", "scene.toml", "-o", "out", "--peers", &program];
        refused(folder.path(), &arguments, 2, &["no Python interpreter"]);
    }
    assert_eq!(names(folder.path()), ["scene.toml"]);
}

/// Files cannot be made in /proc, not even by root.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_takes_no_files_is_refused_before_any_work() {
    let folder = folder();
    let part = "cannot write into the folder /proc: ";
    for command in ["run", "accuracy"] {
        refused(
            folder.path(),
            &[command, "scene.toml", "-o", "/proc"],
            2,
            &[part],
        );
    }
    refused(folder.path(), &["demo", "-o", "/proc"], 2, &[part]);
}

#[test]
fn a_file_that_cannot_be_written_where_it_is_wanted_is_wrong_input() {
    let folder = folder();
    let deck = format!("{}/tests/decks/oc3.map", env!("CARGO_MANIFEST_DIR"));
    let arguments = ["convert", &deck, "--depth", "320", "-o", "nowhere/x.toml"];
    refused(folder.path(), &arguments, 2, &["cannot write nowhere"]);
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
            refused(
                folder.path(),
                &arguments,
                2,
                &["scene.toml: a scene gives", part],
            );
        };
        refused(&["--depth", "300"], "`seabed.depth`");
        refused(&["--at", "platform=1,2,3"], "`position`");
    }
    assert_eq!(names(folder.path()), ["scene.toml"]);
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_says_so_and_leaves_no_empty_folder() {
    let folder = folder();
    let child = Command::new(env!("CARGO_BIN_EXE_moorline"))
        .args(["run", "scene.toml", "-o", "new/out", "--duration", "90000"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    while !folder.path().join("new/out").exists() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    // The folder is tried before the signal is listened to.
    std::thread::sleep(std::time::Duration::from_millis(200));
    let pid = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &pid])
            .status()
            .unwrap()
            .success()
    );
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", err(&output));
    assert!(
        err(&output).ends_with("interrupted: nothing was written\n"),
        "{}",
        err(&output)
    );
    assert_eq!(names(folder.path()), ["scene.toml"]);
    assert!(!folder.path().join("new").exists());
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

/// Adds the keys of all tables in it, arrays of tables included.
fn collect_keys(value: &serde_json::Value, keys: &mut Vec<String>) {
    match value {
        serde_json::Value::Object(table) => {
            for (key, value) in table {
                keys.push(key.clone());
                collect_keys(value, keys);
            }
        }
        serde_json::Value::Array(values) => {
            values.iter().for_each(|value| collect_keys(value, keys))
        }
        _ => {}
    }
}

#[test]
fn every_key_of_the_json_is_documented() {
    let page = include_str!("../docs/json.md");
    let folder = folder();
    for scene in ["storm_moored_semi", "power_cable"] {
        let text = done(folder.path(), &["statics", &public_scene(scene), "--json"]);
        let mut keys = Vec::new();
        collect_keys(&serde_json::from_str(&text).unwrap(), &mut keys);
        for key in keys {
            let written = ["`", "."].map(|before| {
                ["`", "[]`"].map(|after| page.contains(&format!("{before}{key}{after}")))
            });
            assert!(written.concat().contains(&true), "{key}");
        }
    }
}
