//! Destinations of results: folders, pipes, and the rest of an interrupted run.

use std::ffi::OsStr;
use std::io::Read;
use std::thread::sleep;
use std::time::Duration;

use moorline::output::folder::ResultsFolder;

use super::*;

#[test]
fn an_output_folder_that_cannot_be_made_is_refused_before_the_run() {
    let folder = folder();
    folder.write("taken", "");
    folder.refused(
        "run scene.toml -o taken",
        &["taken is no folder: give the name of one"],
    );
    folder.refused(
        "run scene.toml -o taken/below",
        &["cannot make the folder taken/below"],
    );
    folder.refused("demo -o taken", &["taken is no folder"]);
    assert_eq!(folder.names(), ["scene.toml", "taken"]);
}

#[test]
fn a_folder_into_which_another_process_writes_is_refused() {
    let folder = folder();
    folder.write("cases.csv", "output.duration\n2.0\n");
    let taken = ResultsFolder::open(&folder.path("out")).unwrap();
    let commands = [
        "run scene.toml",
        "sweep scene.toml cases.csv",
        "demo",
        "modes scene.toml",
    ];
    for command in commands {
        let parts = ["another process of moorline writes into the folder out"];
        folder.refused(&format!("{command} -o out"), &parts);
    }
    drop(taken);
    folder.done("modes scene.toml -o out");
    assert_eq!(folder.names(), ["cases.csv", "out/modes.svg", "scene.toml"]);
}

#[test]
fn paths_may_have_spaces_and_any_letters_and_be_far_from_here() {
    let (folder, elsewhere) = (folder(), folder_with(&[]));
    let place = folder.path("målestokk æøå 図 {x}");
    fs::create_dir(&place).unwrap();
    let scene = place.join("min scene.toml");
    fs::write(&scene, SCENE).unwrap();
    let output = place.join("ut data").join("prøve 1");
    let arguments = [scene.as_os_str(), OsStr::new("-o"), output.as_os_str()];
    let result = elsewhere.command("run").args(arguments).output().unwrap();
    assert_eq!(result.status.code(), Some(0), "{}", err(&result));
    assert!(output.join("results.csv").is_file());
    assert!(elsewhere.names().is_empty());
}

#[test]
fn a_closed_pipe_ends_the_program_in_silence() {
    // a profile longer than the pipe's buffer, so that writing continues after the reader has gone
    let folder = folder_with(&[("long.toml", &SCENE.replace("elements = 8", "elements = 1000"))]);
    let output = folder.piped("statics long.toml --json", |child| {
        let mut pipe = child.stdout.take().unwrap();
        pipe.read_exact(&mut [0; 1]).unwrap();
    });
    assert_eq!((output.status.code(), err(&output).as_str()), (Some(0), ""));
}

/// Files cannot be made in /proc, not even by root.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_takes_no_files_is_refused_before_any_work() {
    for command in ["run scene.toml", "accuracy scene.toml", "demo"] {
        folder().refused(
            &format!("{command} -o /proc"),
            &["cannot write into the folder /proc: "],
        );
    }
}

#[test]
fn a_file_that_cannot_be_written_where_it_is_wanted_is_wrong_input() {
    let folder = folder_with(&[("oc3.map", MAP)]);
    folder.refused(
        "convert oc3.map --depth 320 -o nowhere/x.toml",
        &["cannot write nowhere"],
    );
}

#[test]
fn the_file_that_is_read_is_not_written_over() {
    let folder = folder_with(&[("oc3.map", MAP)]);
    for command in [
        "convert oc3.map --depth 320 -o ./oc3.map",
        "fmu oc3.map --depth 320 -o oc3.map",
    ] {
        folder.refused(
            command,
            &["oc3.map is the file that is read: give another name to write"],
        );
    }
    assert_eq!(folder.read("oc3.map"), MAP);
}

/// Sends a signal to a program.
#[cfg(unix)]
pub(super) fn send(signal: &str, child: &Child) {
    let pid = child.id().to_string();
    assert!(
        Command::new("kill")
            .args([signal, &pid])
            .status()
            .unwrap()
            .success()
    );
}

/// The program waits for a scene that is never written.
#[cfg(unix)]
#[test]
fn a_run_that_is_interrupted_before_its_first_row_leaves_no_folder() {
    for signal in ["-INT", "-TERM"] {
        let folder = folder();
        let mut open = None;
        let output = folder.piped("run /dev/stdin -o new/out", |child| {
            open = child.stdin.take();
            sleep(Duration::from_millis(200));
            send(signal, child);
        });
        drop(open);
        assert_eq!(output.status.code(), Some(130), "{}", err(&output));
        assert!(err(&output).ends_with("interrupted: nothing was written\n"));
        assert_eq!(folder.names(), ["scene.toml"]);
        assert!(!folder.path("new").exists());
    }
}

/// Each command waits for a scene that is never written.
#[cfg(unix)]
#[test]
fn every_command_that_is_interrupted_says_so_and_leaves_no_file() {
    let folder = folder();
    for (command, signal) in [
        ("check /dev/stdin", "-TERM"),
        ("statics /dev/stdin", "-INT"),
        ("fmu /dev/stdin -o x.fmu", "-TERM"),
    ] {
        let mut open = None;
        let output = folder.piped(command, |child| {
            open = child.stdin.take();
            sleep(Duration::from_millis(300));
            send(signal, child);
        });
        drop(open);
        assert_eq!(output.status.code(), Some(130), "{command}: {}", err(&output));
        assert_eq!(err(&output), "interrupted: nothing was written\n", "{command}");
    }
    assert_eq!(folder.names(), ["scene.toml"]);
}

/// Makes a named pipe without writer or reader.
#[cfg(unix)]
fn make_pipe(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

#[cfg(unix)]
#[test]
fn outputs_follow_links_and_replace_nothing_but_regular_files() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let folder = folder();
    folder.write("oc3.map", MAP);
    make_pipe(&folder.path("pipe"));
    symlink("/dev/null", folder.path("null")).unwrap();
    symlink("real.toml", folder.path("link.toml")).unwrap();
    for target in ["pipe", "null"] {
        let what = format!("cannot write {target}: it is a device or a pipe: give the name of a file");
        for command in ["fmu scene.toml", "convert oc3.map --depth 320"] {
            folder.refused(&format!("{command} -o {target}"), &[&what]);
        }
    }
    folder.done("convert oc3.map --depth 320 -o link.toml");
    let kind = |name: &str| fs::symlink_metadata(folder.path(name)).unwrap().file_type();
    assert!(kind("link.toml").is_symlink() && kind("pipe").is_fifo());
    assert_says(&folder.read("real.toml"), &["[[lines]]"]);
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_is_a_pipe_takes_no_file() {
    let folder = folder();
    folder.write("oc3.map", MAP);
    let what = "cannot write /dev/stdout: it is a device or a pipe: give the name of a file";
    folder.refused("convert oc3.map --depth 320 -o /dev/stdout", &[what]);
    folder.refused("fmu scene.toml -o /dev/stdout", &[what]);
    folder.refused("run scene.toml -o /dev/stdout", &["/dev/stdout is no folder"]);
}

#[cfg(unix)]
#[test]
fn results_in_a_folder_replace_no_pipe() {
    let folder = folder();
    fs::create_dir(folder.path("out")).unwrap();
    make_pipe(&folder.path("out/results.csv"));
    folder.refused(
        "run scene.toml -o out",
        &["out/results.csv: it is a device or a pipe"],
    );
}

#[cfg(unix)]
#[test]
fn inputs_that_are_no_regular_files_are_refused_at_once() {
    let folder = folder();
    make_pipe(&folder.path("pipe"));
    for name in ["/dev/zero", "pipe"] {
        let what = format!("{name} is a device or a pipe, not a CSV file");
        folder.refused(&format!("run scene.toml -o out --motion {name}"), &[&what]);
        let motion = format!("fairlead = {{ file = \"{name}\" }}");
        folder.write(
            "moved.toml",
            SCENE.replace("fairlead = { x = [[0.05, 2.0]], ramp = 1.0 }", &motion),
        );
        folder.refused("check moved.toml", &["is a device or a pipe"]);
        folder.refused(
            &format!("check {name}"),
            &["is a device or a pipe, not a scene file"],
        );
    }
}

#[cfg(unix)]
#[test]
fn a_scene_comes_from_standard_input() {
    let folder = folder();
    let scene = fs::File::open(folder.path("scene.toml")).unwrap();
    let output = folder.command("check /dev/stdin").stdin(scene).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
}
