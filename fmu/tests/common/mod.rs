//! A small scene, packaged with the library that Cargo built for this test program.
#![allow(dead_code)] // each test file uses some of it

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use moorline::output::binaries::{Binaries, find_library};
use moorline::output::package;
use moorline::scene::Scene;
use moorline_host::{FmiVersion, Fmu};

/// Scene of one chain on a seabed, 20 elements.
pub(crate) const SCENE: &str = include_str!("../../../tests/scenes/chain.toml");

/// Copies the library that this program was built with, so that later builds do not replace it.
fn copy_library() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(env!("CARGO_CRATE_NAME"));
    std::fs::create_dir_all(&folder).unwrap();
    let built = find_library().unwrap();
    let copy = folder.join(built.file_name().unwrap());
    std::fs::copy(&built, &copy).unwrap();
    copy
}

/// Packages the scene, once per test program and FMI version.
fn package(version: FmiVersion, text: &str) -> &'static Path {
    static LIBRARY: OnceLock<PathBuf> = OnceLock::new();
    static PACKAGED: [OnceLock<PathBuf>; 2] = [OnceLock::new(), OnceLock::new()];
    let library = LIBRARY.get_or_init(copy_library);
    PACKAGED[version as usize].get_or_init(|| {
        let fmu = library.with_file_name(format!("line{version}.fmu"));
        let scene = Scene::from_toml(text).unwrap();
        let binaries = Binaries::read(library).unwrap();
        package::write_fmu(&scene, text, version, &binaries, &fmu).unwrap();
        fmu
    })
}

/// Packages the scene and opens it.
pub(crate) fn open(version: FmiVersion) -> Fmu {
    open_scene(version, SCENE)
}

/// Packages another scene, the only one of its test program, and opens it.
pub(crate) fn open_scene(version: FmiVersion, text: &str) -> Fmu {
    Fmu::open(package(version, text)).unwrap()
}
