//! A small scene, packaged with the library that this test run built.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use moorline::output::package;
use moorline_host::{FmiVersion, Fmu};

/// One chain on a seabed, 20 elements.
pub const SCENE: &str = r#"
title = "one chain line"
[water]
density = 1025.0
[seabed]
depth = 200.0
[line_types.chain]
mass = 113.35
diameter = 0.0766
axial_stiffness = 753.6e6
axial_damping = 2.0e6
[[points]]
name = "anchor"
position = [837.6, 0.0, -200.0]
kind = "fixed"
[[points]]
name = "fairlead"
position = [40.868, 0.0, -14.0]
kind = "coupled"
[[lines]]
name = "line1"
from = "anchor"
to = "fairlead"
sections = [{ type = "chain", length = 835.35, elements = 20 }]
"#;

/// The packaged scene, written once for each test program and version.
fn package(version: FmiVersion) -> &'static Path {
    static PACKAGED: [OnceLock<PathBuf>; 2] = [OnceLock::new(), OnceLock::new()];
    PACKAGED[version as usize].get_or_init(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(env!("CARGO_CRATE_NAME"));
        std::fs::create_dir_all(&folder).unwrap();
        let scene = folder.join(format!("scene{version}.toml"));
        let fmu = folder.join(format!("line{version}.fmu"));
        std::fs::write(&scene, SCENE).unwrap();
        let loaded = moorline::scene::load(&scene).unwrap();
        let library = package::find_library().unwrap();
        package::write_fmu(&loaded, version, &library, &fmu).unwrap();
        fmu
    })
}

/// Packages and opens the scene.
pub fn open(version: FmiVersion) -> Fmu {
    Fmu::open(package(version)).unwrap()
}
