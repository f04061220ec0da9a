//! Where results go: folders, pipes, and what is left of an interrupted run.

use std::ffi::OsStr;
use std::fs;
use std::io::Read;
use std::process::{Command, Stdio};

use super::{SCENE, err, folder, moorline, names, refused};

#[test]
fn an_output_folder_that_cannot_be_made_is_refused_before_the_run() {
    let folder = folder();
    fs::write(folder.path().join("taken"), "").unwrap();
    let run = |output: &str, parts: &[&str]| {
        refused(folder.path(), &["run", "scene.toml", "-o", output], 2, parts);
    };
    run("taken", &["taken is no folder: give the name of one"]);
    run("taken/below", &["cannot make the folder taken/below"]);
    refused(
        folder.path(),
        &["demo", "-o", "taken"],
        2,
        &["taken is no folder"],
    );
    assert_eq!(names(folder.path()), ["scene.toml", "taken"]);
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

/// Files cannot be made in /proc, not even by root.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_takes_no_files_is_refused_before_any_work() {
    let folder = folder();
    let part = "cannot write into the folder /proc: ";
    for command in ["run", "accuracy"] {
        refused(folder.path(), &[command, "scene.toml", "-o", "/proc"], 2, &[part]);
    }
    refused(folder.path(), &["demo", "-o", "/proc"], 2, &[part]);
}

#[test]
fn a_file_that_cannot_be_written_where_it_is_wanted_is_wrong_input() {
    let folder = folder();
    let deck = format!("{}/../decks/tests/decks/oc3.map", env!("CARGO_MANIFEST_DIR"));
    let arguments = ["convert", &deck, "--depth", "320", "-o", "nowhere/x.toml"];
    refused(folder.path(), &arguments, 2, &["cannot write nowhere"]);
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_says_so_and_leaves_no_empty_folder() {
    for signal in ["-INT", "-TERM"] {
        interrupt(signal);
    }
}

/// Each waits for a scene that does not come.
#[cfg(unix)]
#[test]
fn every_command_that_is_interrupted_says_so_and_leaves_no_file() {
    let folder = folder();
    let fmu = ["fmu", "/dev/stdin", "-o", "x.fmu"];
    let commands = [
        ["check", "/dev/stdin"].as_slice(),
        &["statics", "/dev/stdin"],
        &fmu,
    ];
    for (arguments, signal) in commands.into_iter().zip(["-TERM", "-INT", "-TERM"]) {
        let mut child = Command::new(env!("CARGO_BIN_EXE_moorline"))
            .args(arguments)
            .current_dir(folder.path())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let _open = child.stdin.take();
        std::thread::sleep(std::time::Duration::from_millis(300));
        assert!(
            Command::new("kill")
                .args([signal, &child.id().to_string()])
                .status()
                .unwrap()
                .success()
        );
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{arguments:?}: {}", err(&output));
        let said = "interrupted: nothing was written\n";
        assert_eq!(err(&output), said, "{arguments:?}");
    }
    assert_eq!(names(folder.path()), ["scene.toml"]);
}

#[cfg(unix)]
fn interrupt(signal: &str) {
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
            .args([signal, &pid])
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

/// A pipe with a name, which nobody writes into or reads from.
#[cfg(unix)]
fn make_pipe(path: &std::path::Path) {
    let made = Command::new("mkfifo").arg(path).status().unwrap();
    assert!(made.success());
}

#[cfg(unix)]
#[test]
fn outputs_follow_links_and_replace_nothing_but_regular_files() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let deck = format!("{}/../decks/tests/decks/oc3.map", env!("CARGO_MANIFEST_DIR"));
    make_pipe(&at("pipe"));
    symlink("/dev/null", at("null")).unwrap();
    symlink("real.toml", at("link.toml")).unwrap();
    for target in ["pipe", "null"] {
        let what = format!("cannot write {target}: it is a device or a pipe: give the name of a file");
        refused(folder.path(), &["fmu", "scene.toml", "-o", target], 2, &[&what]);
        let convert = ["convert", &deck, "--depth", "320", "-o", target];
        refused(folder.path(), &convert, 2, &[&what]);
    }
    let convert = ["convert", &deck, "--depth", "320", "-o", "link.toml"];
    let result = moorline(folder.path(), &convert);
    assert_eq!(result.status.code(), Some(0), "{}", err(&result));
    assert!(fs::symlink_metadata(at("link.toml")).unwrap().is_symlink());
    assert!(fs::read_to_string(at("real.toml")).unwrap().contains("[[lines]]"));
    assert!(fs::symlink_metadata(at("pipe")).unwrap().file_type().is_fifo());
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_is_a_pipe_takes_no_file() {
    let folder = folder();
    let deck = format!("{}/../decks/tests/decks/oc3.map", env!("CARGO_MANIFEST_DIR"));
    let what = "cannot write /dev/stdout: it is a device or a pipe: give the name of a file";
    let convert = ["convert", &deck, "--depth", "320", "-o", "/dev/stdout"];
    refused(folder.path(), &convert, 2, &[what]);
    refused(
        folder.path(),
        &["fmu", "scene.toml", "-o", "/dev/stdout"],
        2,
        &[what],
    );
    refused(
        folder.path(),
        &["run", "scene.toml", "-o", "/dev/stdout"],
        2,
        &["/dev/stdout is no folder"],
    );
}

#[cfg(unix)]
#[test]
fn results_in_a_folder_replace_no_pipe() {
    let folder = folder();
    fs::create_dir(folder.path().join("out")).unwrap();
    make_pipe(&folder.path().join("out/results.csv"));
    let run = ["run", "scene.toml", "-o", "out"];
    refused(
        folder.path(),
        &run,
        2,
        &["out/results.csv: it is a device or a pipe"],
    );
}

#[cfg(unix)]
#[test]
fn inputs_that_are_no_regular_files_are_refused_at_once() {
    let folder = folder();
    let pipe = folder.path().join("pipe");
    make_pipe(&pipe);
    let zero = std::path::Path::new("/dev/zero");
    for device in [zero, &pipe] {
        let name = device.to_str().unwrap();
        let what = format!("{name} is a device or a pipe, not a CSV file");
        let run = ["run", "scene.toml", "-o", "out", "--motion", name];
        refused(folder.path(), &run, 2, &[&what]);
        let scene = SCENE.replace(
            "fairlead = { x = [[0.05, 2.0]], ramp = 1.0 }",
            &format!("fairlead = {{ file = \"{name}\" }}"),
        );
        fs::write(folder.path().join("moved.toml"), scene).unwrap();
        refused(
            folder.path(),
            &["check", "moved.toml"],
            2,
            &["is a device or a pipe"],
        );
        let what = "is a device or a pipe, not a scene file";
        refused(folder.path(), &["check", name], 2, &[what]);
    }
}

#[cfg(unix)]
#[test]
fn a_scene_comes_from_standard_input() {
    let folder = folder();
    let output = Command::new(env!("CARGO_BIN_EXE_moorline"))
        .args(["check", "/dev/stdin"])
        .current_dir(folder.path())
        .stdin(fs::File::open(folder.path().join("scene.toml")).unwrap())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
}
