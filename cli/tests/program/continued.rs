//! Runs that are interrupted and continued, and the formats of their tables.

#[cfg(unix)]
use std::{
    thread::sleep,
    time::{Duration, Instant},
};

use super::*;

/// Folder with a scene that has these lines in its output table.
fn scene_with(output: &str) -> Folder {
    folder_with(&[("scene.toml", &format!("{SCENE}{output}\n"))])
}

/// Checks that the folders `whole` and `parts` contain the same files, with the same content except in reports and Parquet files.
fn assert_same(folder: &Folder, files: &[&str]) {
    let names = folder.names_in("whole");
    assert_eq!(names, folder.names_in("parts"));
    for name in names.iter().filter(|name| !name.ends_with("report.html")) {
        let [whole, parts] = ["whole", "parts"].map(|of| fs::read(folder.path(of).join(name)).unwrap());
        assert!(whole == parts || name.ends_with(".parquet"), "{name}");
    }
    assert!(
        files.iter().all(|file| names.iter().any(|name| name == file)),
        "{names:?}"
    );
}

#[test]
fn a_continued_run_writes_the_same_files_bit_for_bit() {
    let folder = scene_with("profile = true\nframes = { every = 0.3 }\ndigits = 9");
    for coupling in [
        "",
        "--communication-step 0.07",
        "--communication-step 0.1 --velocities",
    ] {
        folder.done(&format!("run scene.toml -o whole {coupling}"));
        let said = folder.done(&format!("run scene.toml -o parts {coupling} --until 0.25"));
        assert_says(
            &said,
            &["stopped at t = 0.", " s of 1 s: --resume continues the run"],
        );
        assert!(folder.path("parts/run.state").is_file());
        folder.done(&format!(
            "run scene.toml -o parts {coupling} --resume --until 0.6"
        ));
        folder.done(&format!("run scene.toml -o parts {coupling} --resume"));
        assert_same(
            &folder,
            &[
                "results.csv",
                "profile.csv",
                "lines.pvd",
                "report.html",
                "tension.svg",
            ],
        );
    }
}

#[test]
fn systems_of_lines_in_waves_continue_bit_for_bit() {
    for name in ["storm_moored_semi", "clump_weight", "power_cable"] {
        let folder = folder_of(name);
        let text = folder.read("scene.toml");
        let from = text.find("duration = ").unwrap();
        let to = from + text[from..].find('\n').unwrap();
        let short = format!("{}duration = 2.0{}", &text[..from], &text[to..]);
        folder.write("scene.toml", short.replace("ramp = 60.0", "ramp = 1.0"));
        folder.done("run scene.toml -o whole");
        folder.done("run scene.toml -o parts --until 1.2");
        folder.done("run scene.toml -o parts --resume");
        assert_same(&folder, &["results.csv"]);
    }
}

#[test]
fn what_a_run_left_is_continued_by_the_same_run_only() {
    let folder = folder();
    folder.refused(
        "run scene.toml -o out --resume",
        &["cannot continue from out/run.state: not found: no run was interrupted in this folder, or the run is complete"],
    );
    folder.done("run scene.toml -o out --until 0.5");
    let other = SCENE.replace("mass = 0.05", "mass = 0.06");
    folder.write("other.toml", &other);
    folder.refused(
        "run other.toml -o out --resume",
        &["it belongs to another scene or motion: `mass = 0.05` there, `mass = 0.06` here"],
    );
    folder.refused(
        "run scene.toml -o out --resume --communication-step 0.1",
        &["the run was coupled to the motion of the scene, not to --communication-step 0.1"],
    );
    folder.refused(
        "run scene.toml -o out --resume --duration 2",
        &["`duration = 1.0` there, `duration = 2.0` here"],
    );
    folder.refused(
        "run scene.toml -o out --resume --until 0.5",
        &["--until 0.5: the run has already reached t = 0.5 s"],
    );
    let (rows, state) = (
        folder.read("out/results.csv"),
        fs::read(folder.path("out/run.state")).unwrap(),
    );
    folder.write("out/results.csv", rows.replace("0.5,", "0.6,"));
    folder.refused(
        "run scene.toml -o out --resume",
        &["out/results.csv: it has been changed since the run was interrupted: run the scene from the start"],
    );
    folder.write("out/results.csv", &rows);
    let mut damaged = state.clone();
    *damaged.last_mut().unwrap() ^= 1;
    folder.write("out/run.state", damaged);
    folder.refused("run scene.toml -o out --resume", &["out/run.state: damaged"]);
    folder.write("out/run.state", "something else");
    folder.refused(
        "run scene.toml -o out --resume",
        &["not a state of this version of moorline"],
    );
    folder.write("out/run.state", state);
    folder.done("run scene.toml -o out --resume");
    assert!(!folder.path("out/run.state").exists());
    folder.refused("run scene.toml -o out --resume", &["or the run is complete"]);
}

#[test]
fn a_run_leaves_nothing_of_an_earlier_one() {
    let folder = scene_with("profile = true");
    folder.done("run scene.toml -o out --until 0.5");
    folder.write("out/notes.txt", "mine");
    folder.write(
        "other.toml",
        format!("{SCENE}format = \"parquet\"\nframes = \"none\"\n"),
    );
    folder.done("run other.toml -o out");
    let left = "force.svg notes.txt profile.svg report.html results.parquet results.units.csv tension.svg";
    assert_eq!(folder.names_in("out").join(" "), left);
}

/// Runs a command until there are rows of results, sends it a signal, and waits for its end.
#[cfg(unix)]
fn interrupted(folder: &Folder, command: &str, file: &str, signal: &str) -> Output {
    folder.piped(command, |child| {
        let start = Instant::now();
        let size = || fs::metadata(folder.path(file)).map_or(0, |found| found.len());
        while size() < 1 << 16 {
            assert!(start.elapsed() < Duration::from_secs(60), "no rows in {file}");
            sleep(Duration::from_millis(5));
        }
        super::places::send(signal, child);
    })
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_keeps_its_rows_and_its_report_and_says_how_to_continue() {
    for signal in ["-INT", "-TERM"] {
        let folder = folder();
        let output = interrupted(
            &folder,
            "run scene.toml -o out --duration 90000",
            "out/results.csv",
            signal,
        );
        assert_eq!(output.status.code(), Some(130), "{}", err(&output));
        let (_, rows) = table(&folder.path("out/results.csv"));
        let time = rows.last().unwrap()[0];
        let said = format!(
            "interrupted at t = {time} s of 90000 s: out holds the results up to there, and --resume continues the run\n"
        );
        assert!(err(&output).ends_with(&said), "{}", err(&output));
        assert!(folder.read("out/results.csv").ends_with('\n'));
        assert!(folder.read("out/lines.pvd").ends_with("</VTKFile>"));
        let shapes = folder.read("out/lines.pvd").matches("<DataSet ").count();
        assert_eq!(folder.names_in("out/vtk").len(), shapes);
        assert_says(
            &folder.read("out/report.html"),
            &[&format!("<p>{time} s simulated")],
        );
        assert_eq!(rows.len(), 1 + (10.0 * time).round() as usize);
    }
}

/// SIGKILL may interrupt a write.
#[cfg(unix)]
#[test]
fn a_killed_run_leaves_whole_rows_but_for_the_last_one() {
    let folder = folder();
    let command = "run scene.toml -o out --duration 90000";
    interrupted(&folder, command, "out/results.csv", "-KILL");
    let text = folder.read("out/results.csv");
    let (whole, _) = text.rsplit_once('\n').unwrap();
    folder.write("whole.csv", whole);
    let (header, rows) = table(&folder.path("whole.csv"));
    assert!(rows.len() > 100 && rows.iter().all(|row| row.len() == header.len()));
    assert!(rows.windows(2).all(|pair| pair[0][0] < pair[1][0]));
    folder.refused(&format!("{command} --resume"), &["out/run.state: not found"]);
}

/// A limit on the size of files simulates a full disk.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_a_run_without_half_a_row() {
    let folder = folder();
    let program = env!("CARGO_BIN_EXE_moorline");
    let limited = format!("trap '' XFSZ; ulimit -f 200; {program} run scene.toml -o out --duration 9000");
    let run = Command::new("bash")
        .args(["-c", &limited])
        .current_dir(folder.path(""))
        .output();
    let output = run.unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", err(&output));
    assert_says(&err(&output), &["error: cannot write out/results.csv: "]);
    let (header, rows) = table(&folder.path("out/results.csv"));
    assert!(rows.len() > 100 && rows.iter().all(|row| row.len() == header.len()));
    assert!(folder.read("out/results.csv").ends_with('\n'));
}

/// Columns of a Parquet file by name, with the time as bits.
fn parquet(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;
    let file = SerializedFileReader::new(fs::File::open(path).unwrap()).unwrap();
    let schema = file.metadata().file_metadata().schema_descr();
    let names = schema.columns().iter().map(|column| column.name().to_string());
    let number = |field: &Field| match field {
        Field::Double(value) => *value,
        Field::Float(value) => value.to_string().parse().unwrap(),
        Field::Long(value) => *value as f64,
        other => panic!("{other}"),
    };
    let rows = file.get_row_iter(None).unwrap().map(|row| {
        let row = row.unwrap();
        row.get_column_iter().map(|(_, field)| number(field)).collect()
    });
    (names.collect(), rows.collect())
}

#[test]
fn a_parquet_file_holds_the_numbers_of_the_csv_file_and_continues_too() {
    for digits in ["", "digits = 5", "digits = 12"] {
        let folder = folder_with(&[
            ("csv.toml", &format!("{SCENE}{digits}\n")),
            (
                "parquet.toml",
                &format!("{SCENE}{digits}\nformat = \"parquet\"\n"),
            ),
        ]);
        folder.done("run csv.toml -o out");
        folder.done("run parquet.toml -o whole");
        folder.done("run parquet.toml -o parts --until 0.5");
        assert_eq!(parquet(&folder.path("parts/results.parquet")).1.len(), 6);
        folder.done("run parquet.toml -o parts --resume");
        let expected = table(&folder.path("out/results.csv"));
        for of in ["whole", "parts"] {
            assert_eq!(
                parquet(&folder.path(of).join("results.parquet")),
                expected,
                "{digits}"
            );
        }
        assert_same(&folder, &["results.parquet", "results.units.csv"]);
    }
}

#[cfg(unix)]
#[test]
fn an_interrupted_parquet_file_can_be_read_to_its_last_row() {
    let folder = scene_with("format = \"parquet\"");
    let command = "run scene.toml -o out --duration 90000";
    let output = interrupted(&folder, command, "out/results.parquet", "-INT");
    let (names, rows) = parquet(&folder.path("out/results.parquet"));
    assert_eq!((names[0].as_str(), rows[0].len()), ("time", names.len()));
    let mut rows = rows.iter().enumerate();
    assert!(rows.clone().all(|(index, row)| row[0] == index as f64 / 10.0));
    let last = rows.next_back().unwrap().1[0];
    assert_says(
        &err(&output),
        &[&format!("interrupted at t = {last} s of 90000 s")],
    );
}
