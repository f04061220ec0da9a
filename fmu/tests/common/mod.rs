//! A small scene, packaged with the library that Cargo built for this test program.
#![allow(dead_code)] // each test file uses a part

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use moorline::output::binaries::{Binaries, find_library};
use moorline::output::package;
use moorline::scene::Scene;
use moorline_host::{FmiVersion, Fmu};

/// One chain on a seabed, 20 elements.
pub(crate) const SCENE: &str = include_str!("../../../tests/scenes/chain.toml");

/// A copy of the library that later builds leave alone: the one that this program was built with, or one with `features`.
fn copy_library(features: &[&str]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(env!("CARGO_CRATE_NAME"));
    std::fs::create_dir_all(&folder).unwrap();
    if !features.is_empty() {
        run_cargo(features);
    }
    let built = find_library().unwrap();
    let copy = folder.join(built.file_name().unwrap());
    std::fs::copy(&built, &copy).unwrap();
    if !features.is_empty() {
        run_cargo(&[]); // leaves the plain library where users look for it
    }
    copy
}

fn run_cargo(features: &[&str]) {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    // target/PROFILE/deps/TEST
    let program = std::env::current_exe().unwrap();
    let target = program.ancestors().nth(3).unwrap();
    let profile = if cfg!(debug_assertions) { "test" } else { "release" };
    let done = Command::new(cargo)
        .args(["build", "--package", "moorline-fmu", "--lib"])
        .args(["--profile", profile, "--target-dir"])
        .arg(target)
        .args(features.iter().flat_map(|feature| ["--features", feature]))
        .output()
        .unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

/// The packaged scene, written once for each test program and version.
fn package(version: FmiVersion, features: &[&str], text: &str) -> &'static Path {
    static LIBRARY: OnceLock<PathBuf> = OnceLock::new();
    static PACKAGED: [OnceLock<PathBuf>; 2] = [OnceLock::new(), OnceLock::new()];
    let library = LIBRARY.get_or_init(|| copy_library(features));
    PACKAGED[version as usize].get_or_init(|| {
        let fmu = library.with_file_name(format!("line{version}.fmu"));
        let scene = Scene::from_toml(text).unwrap();
        let binaries = Binaries::read(library).unwrap();
        package::write_fmu(&scene, text, version, &binaries, &fmu).unwrap();
        fmu
    })
}

/// Packages the scene with a library that is built with the given features, and opens it.
pub(crate) fn open(version: FmiVersion, features: &[&str]) -> Fmu {
    Fmu::open(package(version, features, SCENE)).unwrap()
}

/// Packages another scene, the only one of its test program, and opens it.
pub(crate) fn open_scene(version: FmiVersion, text: &str) -> Fmu {
    Fmu::open(package(version, &[], text)).unwrap()
}
