//! The examples in C, Fortran and Octave are built and run if their tools are installed; all give the same force.

mod common;

use std::path::{Path, PathBuf};
use std::process::Command;

use common::{STRICT, has, library, run};
use moorline::scene::Scene;
use moorline::simulation::Simulation;

const SCENE: &str = include_str!("../../scenes/oc3_catenary.toml");

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn scene() -> PathBuf {
    folder().join("../scenes/oc3_catenary.toml")
}

/// Force [N] that the Rust library computes for the run of the examples.
fn expected() -> [f64; 3] {
    let mut mooring = Simulation::new(&Scene::from_toml(SCENE).unwrap()).unwrap();
    let fairlead = mooring.model().point_index("fairlead").unwrap();
    mooring.restart(0.0).unwrap();
    for _ in 0..600 {
        let time = mooring.time();
        let turn = 2.0 * std::f64::consts::PI * time / 12.0;
        mooring.set_displacement(fairlead, [5.0 * (time / 20.0).min(1.0) * turn.sin(), 0.0, 0.0]);
        mooring.advance(0.05).unwrap();
    }
    mooring.end_force(fairlead)
}

/// Asserts that the numbers after `force` in a line equal the expected force, to six digits.
fn assert_force(said: &str) {
    let words = said.split("force").nth(1).unwrap_or_else(|| panic!("{said}"));
    let numbers: Vec<f64> = words
        .split_whitespace()
        .map_while(|word| word.parse().ok())
        .collect();
    for (found, expected) in numbers.iter().zip(expected()) {
        assert!(
            (found - expected).abs() <= 1e-6 * expected.abs().max(1.0),
            "{said}: {expected}"
        );
    }
    assert_eq!(numbers.len(), 3, "{said}");
}

/// Runs a program on the scene; its linker searches the library's folder.
fn run_host(program: &Path) -> String {
    let libraries = library("moorline_c").parent().unwrap().to_path_buf();
    run(Command::new(program)
        .arg(scene())
        .env("LD_LIBRARY_PATH", libraries))
}

fn link(command: &mut Command) {
    let libraries = library("moorline_c").parent().unwrap().display().to_string();
    command.args([&format!("-L{libraries}"), "-lmoorline_c", "-lm"]);
}

#[test]
fn the_host_in_c_has_the_force_of_the_host_in_rust() {
    if !cfg!(target_os = "linux") || !has("gcc") {
        return;
    }
    let built = tempfile::tempdir().unwrap();
    let program = built.path().join("host");
    let mut command = Command::new("gcc");
    command
        .arg("-std=c99")
        .args(STRICT)
        .arg("-I")
        .arg(folder().join("include"));
    command
        .arg(folder().join("examples/host.c"))
        .arg("-o")
        .arg(&program);
    link(&mut command);
    run(&mut command);
    assert_force(&run_host(&program));
}

#[test]
fn the_host_in_fortran_has_the_force_of_the_host_in_rust() {
    if !cfg!(target_os = "linux") || !has("gfortran") {
        return;
    }
    let built = tempfile::tempdir().unwrap();
    let program = built.path().join("host");
    let mut command = Command::new("gfortran");
    command
        .args(["-std=f2008", "-Wall", "-Werror", "-J"])
        .arg(built.path());
    command
        .arg(folder().join("examples/host.f90"))
        .arg("-o")
        .arg(&program);
    link(&mut command);
    run(&mut command);
    assert_force(&run_host(&program));
}

/// Requires the headers of Octave: `mkoctfile` of Debian's octave-dev, or their folder in the environment variable OCTAVE_HEADERS.
#[test]
fn the_host_in_octave_has_the_force_of_the_host_in_rust() {
    if !cfg!(target_os = "linux") || !has("octave-cli") {
        return;
    }
    let built = tempfile::tempdir().unwrap();
    let source = folder().join("examples/moorline_run.c");
    let mut command = match std::env::var_os("OCTAVE_HEADERS") {
        Some(headers) => {
            let mut command = Command::new("gcc");
            command.args(["-shared", "-fPIC", "-I"]).arg(headers);
            command
        }
        None if has("mkoctfile") => {
            let mut command = Command::new("mkoctfile");
            command.arg("--mex");
            command
        }
        None => return,
    };
    // one word: mkoctfile does not accept the folder as a separate argument
    let headers = format!("-I{}", folder().join("include").display());
    command.arg(headers).arg(source);
    command.arg("-o").arg(built.path().join("moorline_run.mex"));
    link(&mut command);
    run(&mut command);
    let mut octave = Command::new("octave-cli");
    octave
        .args(["--no-gui", "--quiet", "--path"])
        .arg(built.path())
        .arg(folder().join("examples/host.m"));
    let libraries = library("moorline_c").parent().unwrap().to_path_buf();
    octave.env("SCENE", scene()).env("LD_LIBRARY_PATH", libraries);
    assert_force(&run(&mut octave));
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn valgrind_finds_no_error_of_memory_and_no_leak_in_the_host_in_c() {
    if !cfg!(target_os = "linux") || !has("gcc") || !has("valgrind") {
        return;
    }
    let built = tempfile::tempdir().unwrap();
    let program = built.path().join("host");
    let mut command = Command::new("gcc");
    command
        .args(["-std=c99", "-g", "-I"])
        .arg(folder().join("include"));
    command
        .arg(folder().join("examples/host.c"))
        .arg("-o")
        .arg(&program);
    link(&mut command);
    run(&mut command);
    let libraries = library("moorline_c").parent().unwrap().to_path_buf();
    let mut valgrind = Command::new("valgrind");
    valgrind.args([
        "--quiet",
        "--error-exitcode=9",
        "--leak-check=full",
        "--errors-for-leak-kinds=definite",
    ]);
    assert_force(&run(valgrind
        .arg(&program)
        .arg(scene())
        .env("LD_LIBRARY_PATH", libraries)));
}
