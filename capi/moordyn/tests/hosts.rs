//! The small hosts in `hosts/hosts.c` run on the library under valgrind without memory errors, and closed systems do not leak.
//! `python_tests/test_libmoordyn.py` compares their forces with MoorDyn's.

#[path = "../../tests/common/mod.rs"]
mod common;

use std::path::{Path, PathBuf};
use std::process::Command;

use common::{has, library, run};

const DECK: &str = "\
one line
--- LINE TYPES ---
Name Diam Mass EA BA EI Cd Ca CdAx CaAx
- m kg/m N N-s N-m2 - - - -
chain 0.1 100 1E8 -0.8 0 1.6 1.0 0.1 0.0
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
- - m m m kg m3 m2 -
1 Fixed 100 0 -60 0 0 0 0
2 Coupled 0 0 -10 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
- - - - m - -
1 chain 1 2 118 6 pvt
--- OPTIONS ---
60 WtrDpth
--- OUTPUTS ---
FairTen1
--- end ---
";

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn build(target: &Path) {
    let mut command = Command::new("gcc");
    command
        .args(["-std=gnu99", "-g", "-Wall", "-Wextra", "-Werror", "-I"])
        .arg(folder().join("include"));
    run(command
        .arg(folder().join("hosts/hosts.c"))
        .arg("-o")
        .arg(target)
        .arg("-ldl"));
}

/// Motion of a swaying fairlead over `count` steps of `step` [s], in the format that the program reads.
fn motion(step: f64, count: usize) -> Vec<u8> {
    let row = |k: usize| {
        let t = k as f64 * step;
        [t.sin(), 0.0, -10.0, t.cos(), 0.0, 0.0]
    };
    (0..count).flat_map(row).flat_map(f64::to_le_bytes).collect()
}

/// Runs a host, within a tool if one is given, and returns its forces.
fn drive(tool: &[&str], program: &Path, host: &str) -> Vec<u8> {
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join("deck"), DECK).unwrap();
    std::fs::write(place.path().join("motion"), motion(0.05, 30)).unwrap();
    let mut words = tool.iter().map(|word| word.to_string()).collect::<Vec<_>>();
    words.push(program.to_str().unwrap().to_string());
    let mut command = Command::new(&words[0]);
    command.args(&words[1..]).arg(library("moordyn"));
    command
        .args([host, "deck", "3", "motion", "0.05", "forces"])
        .current_dir(place.path());
    run(&mut command);
    std::fs::read(place.path().join("forces")).unwrap()
}

#[test]
fn every_host_finds_the_same_forces() {
    if !cfg!(target_os = "linux") || !has("gcc") {
        return;
    }
    let built = tempfile::tempdir().unwrap();
    let program = built.path().join("hosts");
    build(&program);
    let forces = drive(&[], &program, "erf");
    assert!(forces.iter().any(|byte| *byte != 0));
    for host in ["wec_sim", "hydrochrono", "foam_mooring"] {
        assert!(
            drive(&[], &program, host) == forces,
            "{host}: iterations and a restart change bits"
        );
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn valgrind_finds_no_error_of_memory_and_no_leak() {
    if !cfg!(target_os = "linux") || !has("gcc") || !has("valgrind") {
        return;
    }
    let built = tempfile::tempdir().unwrap();
    let program = built.path().join("hosts");
    build(&program);
    let switches = [
        "valgrind",
        "--quiet",
        "--error-exitcode=9",
        "--leak-check=full",
        "--errors-for-leak-kinds=definite",
    ];
    for host in ["wec_sim", "hydrochrono", "foam_mooring", "erf"] {
        drive(&switches, &program, host);
    }
}
