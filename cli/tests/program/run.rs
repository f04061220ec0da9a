//! `moorline run`: its files, and motion as a host gives it.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::{SCENE, columns, done, err, folder, moorline, names, out, refused, table};

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
    assert_eq!(header[..4], ["time", "fairlead.x", "fairlead.y", "fairlead.z"]);
    assert!(header.contains(&"line1.tension_b".to_string()));
    assert_eq!(rows.len(), 11);
    assert_eq!(rows[10][0], 1.0);
    let (units, _) = header_of_units(&folder.path().join("out/results.units.csv"));
    assert_eq!(units, header);
    let text = fs::read_to_string(folder.path().join("out/results.csv")).unwrap();
    let last = text.lines().last().unwrap().split(',');
    let steps = last.zip(&header).find(|(_, name)| *name == "solver.substeps");
    assert!(steps.unwrap().0.parse::<usize>().is_ok(), "{text}");
}

/// Names and units of the columns.
fn header_of_units(path: &Path) -> (Vec<String>, Vec<String>) {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let rows = reader.records().map(Result::unwrap);
    rows.map(|row| (row[0].to_string(), row[1].to_string())).unzip()
}

#[test]
fn profiles_are_written_where_the_scene_asks() {
    let folder = folder();
    fs::write(folder.path().join("p.toml"), format!("{SCENE}profile = true\n")).unwrap();
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
        done(folder.path(), &[&["run", scene, "-o", output], more].concat());
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
        &["run", "scene.toml", "-o", "out", "--communication-step", "0.3"],
    );
    let (_, rows) = table(&folder.path().join("out/results.csv"));
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(times, [0.0, 0.3, 0.6, 3.0 * 0.3, 1.0]);
}

/// What a command says on standard error.
fn remarks(folder: &TempDir, scene: &str, arguments: &[&str]) -> String {
    fs::write(folder.path().join("left.toml"), scene).unwrap();
    let output = moorline(folder.path(), &[&["run", "left.toml"], arguments].concat());
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    said
}

#[test]
fn a_run_that_leaves_a_table_is_remarked_on_once_with_its_name_and_its_time() {
    let folder = folder();
    let scene = SCENE
        .replace("mass = 0.05", "mass = 0.5\ndiameter = 0.01")
        .replace(
            "axial_stiffness = 2505.0",
            "tension_strain = [[0.0, 0.0], [0.001, 2.5]]",
        )
        .replace(
            "x = [[0.05, 2.0]], ramp = 1.0",
            "table = [[0.0, 0.0, 0.0, 0.0], [0.5, 0.4, 0.0, 0.0]]",
        )
        .replace("position = [0.0, 0.0, 0.0]", "position = [0.0, 0.0, -20.0]")
        .replace("position = [14.0, 0.0, 0.0]", "position = [14.0, 0.0, -20.0]")
        + "[water]\ndensity = 1025.0\ncurrent = { profile = [[0.0, 0.1, 0.0], [-10.0, 0.0, 0.0]] }\n\
           [seabed]\ndepth = 21.0\ngrid = { x = [0.0, 5.0], y = [-5.0, 5.0], depth = [[21.0, 21.1], [21.0, 21.0]] }\n";
    let said = remarks(&folder, &scene, &["-o", "out"]);
    for part in [
        "line_types.rope.tension_strain: line1 is strained by ",
        "where MoorDyn stays at the last tension",
        "water.current.profile: line1 is at z = -20.00 m at t = 0 s, below the lowest row at -10 m",
        "seabed.grid: line1 lies at (",
        "motion.fairlead: the table ends at 0.5 s, the run at 1 s: in between it stays at its last row",
    ] {
        assert_eq!(said.matches(part).count(), 1, "{part}\n{said}");
    }
}

#[test]
fn a_run_that_stays_within_its_tables_says_nothing_of_them() {
    let folder = folder();
    let scene = SCENE
        .replace(
            "axial_stiffness = 2505.0",
            "tension_strain = [[0.0, 0.0], [0.5, 1252.5]]",
        )
        .replace(
            "x = [[0.05, 2.0]], ramp = 1.0",
            "table = [[0.0, 0.0, 0.0, 0.0], [1.0, 0.1, 0.0, 0.0]]",
        );
    let said = remarks(&folder, &scene, &["-o", "out"]);
    assert!(!said.contains("table") && !said.contains("row"), "{said}");
    fs::write(folder.path().join("m.csv"), "time,x,y,z\n0,0,0,0\n0.4,0.1,0,0\n").unwrap();
    let said = remarks(
        &folder,
        &scene,
        &["--motion", "m.csv", "--duration", "1", "-o", "out"],
    );
    assert!(
        said.contains("motion.fairlead: the table ends at 0.4 s"),
        "{said}"
    );
}

#[test]
fn a_run_of_hours_and_a_line_that_breaks_at_once_are_noted_before_the_run() {
    let folder = folder();
    let line = "sections = [{ type = \"rope\", length = 14.1421, elements = 8 }]";
    let breaks = SCENE.replace(line, &format!("{line}\nbreak = {{ at = \"b\", tension = 0.5 }}"));
    let said = remarks(&folder, &breaks, &["-o", "out"]);
    assert!(
        said.contains("lines[0].break.tension: line1 breaks in its first step"),
        "{said}"
    );
    let shown = err(&moorline(folder.path(), &["statics", "left.toml"]));
    assert!(shown.contains("line1 breaks in its first step"), "{shown}");
    let long = SCENE
        .replace("elements = 8", "elements = 8000")
        .replace("duration = 1.0", "duration = 1000.0");
    fs::write(folder.path().join("long.toml"), long).unwrap();
    let said = done(folder.path(), &["check", "long.toml"]);
    assert!(said.contains("hours on one thread: 8000 elements"), "{said}");
    assert!(!done(folder.path(), &["check", "scene.toml"]).contains("hours on one thread"));
}

/// Source: span and sag of the inextensible wire as in `tests/quasi_static.rs`.
#[test]
fn the_command_line_draws_the_collar_out_too() {
    let folder = tempfile::tempdir().unwrap();
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/collar.toml");
    let columns = columns(folder.path(), &["run", scene, "-o", "out"]);
    let last = |name: &str| *columns[name].last().unwrap();
    let (sag, pull, half_weight) = (4.086_064_837, 20.0_f64, 19.62);
    assert!((last("wire.sag") / sag - 1.0).abs() < 1e-5);
    assert!((last("wire.tension_a") - pull.hypot(half_weight)).abs() < 1e-10);
}

#[test]
fn every_command_says_a_note_once_with_the_line_of_the_file() {
    let folder = folder();
    let text = SCENE.replacen('\n', "\ngravity = 32.2\n", 1);
    let text = text.replace("axial_damping = 5.0\n", "");
    fs::write(folder.path().join("slip.toml"), text).unwrap();
    for arguments in [
        &["check", "slip.toml"][..],
        &["statics", "slip.toml"],
        &["run", "slip.toml", "-o", "out"],
        &["fmu", "slip.toml", "-o", "slip.fmu"],
    ] {
        let output = moorline(folder.path(), arguments);
        let said = out(&output) + &err(&output);
        let note = "note: slip.toml:2: gravity: 32.2 m/s² is unusual: 9.80665 m/s² is usual";
        assert_eq!(said.matches(note).count(), 1, "{arguments:?}: {said}");
        let advice = said.contains("no `axial_damping`");
        assert_eq!(advice, arguments[0] == "check", "{arguments:?}: {said}");
    }
}
