//! `moorline run`: its files, and motion as a host gives it.

use super::*;

#[test]
fn a_run_that_blows_up_is_a_computation_that_failed_and_keeps_the_rows_before() {
    let folder = folder();
    let wild = SCENE.replace("[[0.05, 2.0]], ramp = 1.0", "[[1.0e7, 0.02]]");
    let wild = wild.replace("duration = 1.0", "duration = 60.0");
    folder.write("wild.toml", wild);
    let parts = ["error: t = ", " s, line", "try"];
    folder.fails("run wild.toml -o r", &parts);
    let (header, rows) = table(&folder.path("r/results.csv"));
    assert!(!rows.is_empty() && rows.iter().all(|row| row.len() == header.len()));
    assert!(!folder.path("r/report.html").exists() && !folder.path("r/run.state").exists());
}

#[test]
fn run_writes_its_files_and_nothing_else() {
    let folder = folder();
    folder.done("run scene.toml -o out");
    let shapes = (0..11).map(|i| format!("out/vtk/lines_{i:05}.vtp"));
    let files = "force.svg lines.pvd profile.svg report.html results.csv results.units.csv tension.svg";
    let files = files.split(' ').map(|name| format!("out/{name}"));
    let mut expected: Vec<String> = files.chain(shapes).chain(["scene.toml".to_string()]).collect();
    expected.sort();
    assert_eq!(folder.names(), expected);
    let (header, rows) = table(&folder.path("out/results.csv"));
    assert_eq!(header[..4], ["time", "fairlead.x", "fairlead.y", "fairlead.z"]);
    assert!(header.contains(&"line1.tension_b".to_string()));
    assert_eq!(rows.len(), 11);
    assert_eq!(rows[10][0], 1.0);
    let (units, _) = header_of_units(&folder.path("out/results.units.csv"));
    assert_eq!(units, header);
    let text = folder.read("out/results.csv");
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
    folder.write("p.toml", format!("{SCENE}profile = true\n"));
    folder.done("run p.toml -o out");
    let text = folder.read("out/profile.csv");
    assert!(text.starts_with("time,line,node,s,x,y,z,tension\n0.0,line1,0,0.0,0.0,0.0,0.0,"));
    assert_eq!(text.lines().count(), 1 + 11 * 9);
}

#[test]
fn a_second_run_replaces_the_first_and_gives_the_same_numbers() {
    let folder = folder();
    let read = || folder.read("out/results.csv");
    folder.done("run scene.toml -o out");
    let first = read();
    folder.write("out/results.csv", "left over");
    folder.done("run scene.toml -o out");
    assert_eq!(read(), first);
}

/// Header of the table, and rows of a run that follows the scene's motion exactly and of one driven as by a host in steps of `step` [s].
fn exact_and_host(scene: &str, step: f64) -> (Vec<String>, [Vec<Vec<f64>>; 2]) {
    let folder = folder_with(&[("scene.toml", scene)]);
    let host = format!("--communication-step {step} --velocities");
    let [(header, exact), (_, host)] = ["", &host].map(|more| {
        folder.done(&format!("run scene.toml -o out {more}"));
        table(&folder.path("out/results.csv"))
    });
    (header, [exact, host])
}

fn column(header: &[String], name: &str) -> usize {
    header.iter().position(|column| column == name).unwrap()
}

#[test]
fn a_run_driven_like_a_host_follows_the_exact_motion() {
    let fine = SCENE.replace("interval = 0.1", "interval = 0.01");
    let (header, [exact, host]) = exact_and_host(&fine, 0.01);
    let tension = column(&header, "line1.tension_b");
    assert_eq!(exact.len(), host.len());
    for (exact, host) in exact.iter().zip(&host) {
        // The motion is the same to the last bit; the tension differs by the error of the path between communication points.
        assert_eq!(exact[..7], host[..7]);
        assert!(
            (exact[tension] / host[tension] - 1.0).abs() < 0.01,
            "{exact:?} {host:?}"
        );
    }
}

#[test]
fn a_run_whose_inputs_mean_the_end_of_a_step_is_told_the_motion_there() {
    let solver = "[solver]\ninput_reconstruction = \"interpolate\"\n";
    let (header, [exact, host]) = exact_and_host(&format!("{SCENE}{solver}"), 0.1);
    let [place, tension] = ["fairlead.x", "line1.tension_b"].map(|name| column(&header, name));
    assert_eq!(exact.len(), host.len());
    for (exact, host) in exact.iter().zip(&host) {
        assert_eq!(exact[place], host[place]);
        // one step late, the tension would be off by up to a quarter
        let off = (exact[tension] / host[tension] - 1.0).abs();
        assert!(off < 0.02, "{exact:?} {host:?}");
    }
}

#[test]
fn a_communication_step_sets_the_rows_and_is_checked_as_their_interval() {
    let folder = folder();
    let said = folder.remarks("run scene.toml -o out --communication-step 0.3");
    let (_, rows) = table(&folder.path("out/results.csv"));
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(times, [0.0, 0.3, 0.6, 3.0 * 0.3, 1.0]);
    let note =
        "note: --communication-step: output.interval: the duration of 1 s is not a whole number of intervals";
    assert_says(&said, &[note]);
    for (step, problem) in [
        ("2", "longer than the duration of 1 s"),
        ("1e-9", "more than 1e7 steps"),
    ] {
        let command = format!("run scene.toml -o out --communication-step {step}");
        folder.refused(&command, &["--communication-step: ", problem]);
    }
}

#[test]
fn the_winch_of_a_scene_pays_out_in_communication_steps_too() {
    let winch =
        "name = \"line1\"\nwinch = { end = \"b\", length_max = 1.0, path = { ramp = [0.0, 0.0, 1.0, 0.2] } }";
    let scene = SCENE.replace("name = \"line1\"", winch);
    let (header, [exact, host]) = exact_and_host(&scene, 0.1);
    let [length, sag] = ["line1.length_change", "line1.sag"].map(|name| column(&header, name));
    let first = exact[0][sag];
    let [exact, host] = [&exact, &host].map(|rows| rows.last().unwrap());
    assert_eq!([exact[length], host[length]], [0.2; 2]);
    // the last step of the host knows the length at its start
    let share = (host[sag] - first) / (exact[sag] - first);
    assert!((share - 1.0).abs() < 0.2, "{share}");
}

#[test]
fn notes_on_a_duration_are_those_of_the_duration_of_the_command_line() {
    let folder = folder();
    let said = folder.remarks("run scene.toml -o out --duration 0.25");
    assert_says(
        &said,
        &["the duration of 0.25 s is not a whole number of intervals"],
    );
    folder.write("odd.toml", SCENE.replace("duration = 1.0", "duration = 1.03"));
    assert!(folder.remarks("check odd.toml").is_empty());
    folder.shows(
        "check odd.toml",
        &["the duration of 1.03 s is not a whole number"],
    );
    let said = folder.remarks("run odd.toml -o out --duration 0.5");
    assert!(!said.contains("whole number"), "{said}");
}

#[test]
fn a_run_that_leaves_a_table_is_remarked_on_once_with_its_name_and_its_time() {
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
        .replace("0.0, 0.0]\nkind", "0.0, -20.0]\nkind")
        + "[water]\ndensity = 1025.0\ncurrent = { profile = [[0.0, 0.1, 0.0], [-10.0, 0.0, 0.0]] }\n\
           [seabed]\ndepth = 21.0\ngrid = { x = [0.0, 5.0], y = [-5.0, 5.0], depth = [[21.0, 21.1], [21.0, 21.0]] }\n";
    let said = folder_with(&[("left.toml", &scene)]).remarks("run left.toml -o out");
    for part in [
        "line_types.rope.tension_strain: line1 is strained by ",
        "where MoorDyn keeps the last tension",
        "water.current.profile: line1 is at z = -20.00 m at t = 0 s, below the lowest row at -10 m",
        "seabed.grid: line1 lies at (",
        "motion.fairlead: the table ends at 0.5 s, the run at 1 s: in between it stays at its last row",
    ] {
        assert_eq!(said.matches(part).count(), 1, "{part}\n{said}");
    }
}

#[test]
fn a_run_that_stays_within_its_tables_says_nothing_of_them() {
    let scene = SCENE
        .replace(
            "axial_stiffness = 2505.0",
            "tension_strain = [[0.0, 0.0], [0.5, 1252.5]]",
        )
        .replace(
            "x = [[0.05, 2.0]], ramp = 1.0",
            "table = [[0.0, 0.0, 0.0, 0.0], [1.0, 0.1, 0.0, 0.0]]",
        );
    let folder = folder_with(&[
        ("within.toml", &scene),
        ("m.csv", "time,x,y,z\n0,0,0,0\n0.4,0.1,0,0\n"),
    ]);
    let said = folder.remarks("run within.toml -o out");
    assert!(!said.contains("table") && !said.contains("row"), "{said}");
    let said = folder.remarks("run within.toml -o out --motion m.csv --duration 1");
    assert_says(&said, &["motion.fairlead: the table ends at 0.4 s"]);
}

#[test]
fn a_run_of_hours_and_a_line_that_breaks_at_once_are_noted_before_the_run() {
    let folder = folder();
    let breaks = "name = \"line1\"\nbreak = { at = \"b\", tension = 0.5 }";
    folder.write("breaks.toml", SCENE.replace("name = \"line1\"", breaks));
    let note = "lines[0].break.tension: line1 breaks in its first step";
    assert_says(&folder.remarks("run breaks.toml -o out"), &[note]);
    assert_says(
        &folder.remarks("statics breaks.toml"),
        &["line1 breaks in its first step"],
    );
    let long = SCENE
        .replace("elements = 8", "elements = 8000")
        .replace("duration = 1.0", "duration = 1000.0");
    folder.write("long.toml", long);
    folder.shows("check long.toml", &["hours on one thread: 8000 elements"]);
    assert!(!folder.done("check scene.toml").contains("hours on one thread"));
}

#[test]
fn a_run_whose_water_a_host_would_move_is_one_in_still_water_and_says_so_once() {
    let folder = folder();
    let rope = "[line_types.rope]\ndiameter = 0.01\ndrag_normal = 1.2";
    let still = format!(
        "water.density = 1025.0\n{}",
        SCENE.replace("[line_types.rope]", rope)
    );
    folder.write("still.toml", &still);
    folder.write("hosted.toml", format!("water.flow = \"host\"\n{still}"));
    let said = folder.remarks("run hosted.toml -o hosted");
    let note = "note: hosted.toml:1: water.flow: no host gives the flow in this run: the water is at rest";
    assert_eq!(said.matches(note).count(), 1, "{said}");
    assert!(!folder.remarks("run still.toml -o still").contains("flow"));
    let results = |name: &str| {
        let (names, rows) = table(&folder.path(&format!("{name}/results.csv")));
        (names, rows.into_iter().flatten().collect::<Vec<f64>>())
    };
    let ((names, hosted), (wanted, still)) = (results("hosted"), results("still"));
    assert_eq!(names, wanted);
    let apart = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-9 * b.abs().max(1.0);
    assert!(hosted.len() == still.len() && hosted.iter().zip(&still).all(apart));
}

/// Source: span and sag of the inextensible wire as in `tests/statics/quasi_static.rs`.
#[test]
fn the_command_line_draws_the_collar_out_too() {
    let columns = folder_of("collar").columns("run scene.toml -o out");
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
    folder.write("slip.toml", text);
    let commands = [
        "check slip.toml",
        "statics slip.toml",
        "run slip.toml -o out",
        "fmu slip.toml -o slip.fmu",
    ];
    for command in commands {
        let output = folder.run(command);
        let said = out(&output) + &err(&output);
        let note = "note: slip.toml:2: gravity: 32.2 m/s² is unusual: 9.80665 m/s² is usual";
        assert_eq!(said.matches(note).count(), 1, "{command}: {said}");
        let advice = said.contains("no `axial_damping`");
        assert_eq!(advice, command == "check slip.toml", "{command}: {said}");
    }
}
