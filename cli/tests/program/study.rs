//! `moorline accuracy`: studies of short scenes, and peers that are none.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use super::{SCENE, done, err, folder, moorline, names, out, refused};

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
    let remarks = err(&output);
    assert!(output.status.success(), "{remarks}");
    assert!(
        remarks.lines().all(|line| line.starts_with("note: ")),
        "{remarks}"
    );
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
    refused(folder.path(), &public, 2, &["--depth, --at and --vessel"]);
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
