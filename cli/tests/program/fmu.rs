//! `moorline fmu` and `moorline demo`: FMUs from the command line.

use std::fs;
use std::io::Read;
use std::process::Command;

use super::{done, err, folder, names, refused};

#[test]
fn an_fmu_that_cannot_be_placed_is_refused() {
    let folder = folder();
    let fmu = |output: &str, part: &str| {
        refused(folder.path(), &["fmu", "scene.toml", "-o", output], 2, &[part]);
    };
    fmu(".", "cannot write .: it is a folder: give the name of a file");
    fmu(
        "nowhere/x.fmu",
        "cannot write nowhere/x.fmu: there is no folder nowhere",
    );
    assert_eq!(names(folder.path()), ["scene.toml"]);
}

/// Puts the FMU library beside the program under test, once: `cargo test` does not build it for the tests of another package.
fn build_library() {
    static BUILT: std::sync::Once = std::sync::Once::new();
    BUILT.call_once(|| {
        let profile = if cfg!(debug_assertions) { "dev" } else { "release" };
        let output = Command::new(env!("CARGO"))
            .args([
                "build",
                "--quiet",
                "--package",
                "moorline-fmu",
                "--lib",
                "--profile",
                profile,
            ])
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", err(&output));
    });
}

#[test]
fn an_fmu_of_either_version_is_one_whole_file() {
    build_library();
    let folder = folder();
    for version in ["2", "3"] {
        let target = format!("rope{version}.fmu");
        let arguments = ["fmu", "scene.toml", "-o", &target, "--fmi", version];
        assert_eq!(done(folder.path(), &arguments), format!("written to {target}\n"));
        let file = fs::File::open(folder.path().join(&target)).unwrap();
        let mut archive = zip::ZipArchive::new(file).unwrap();
        let mut xml = String::new();
        let mut entry = archive.by_name("modelDescription.xml").unwrap();
        entry.read_to_string(&mut xml).unwrap();
        drop(entry);
        assert!(xml.contains(&format!("fmiVersion=\"{version}.0\"")));
        let names: Vec<String> = (0..archive.len())
            .map(|i| archive.by_index(i).unwrap().name().unwrap().to_string())
            .collect();
        assert!(
            names.iter().any(|name| name.starts_with("binaries/")),
            "{names:?}"
        );
        assert!(names.contains(&"resources/scene.toml".to_string()), "{names:?}");
    }
    assert_eq!(names(folder.path()), ["rope2.fmu", "rope3.fmu", "scene.toml"]);
}

#[test]
fn the_demo_drives_an_fmu_that_gives_the_bits_of_a_run() {
    build_library();
    let folder = folder();
    let text = done(folder.path(), &["demo"]);
    for part in [
        "static equilibrium",
        "catenary",
        "line1 tension at end B [N]",
        "times real time",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    let made = names(&folder.path().join("moorline-demo"));
    for name in [
        "demo.fmu",
        "profile.svg",
        "report.html",
        "results.csv",
        "tension.svg",
    ] {
        assert!(made.contains(&name.to_string()), "{name} in {made:?}");
    }
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/demo.toml");
    done(
        folder.path(),
        &["run", scene, "-o", "run", "--communication-step", "0.05"],
    );
    for table in ["results.csv", "profile.csv"] {
        let read = |of: &str| fs::read_to_string(folder.path().join(of).join(table)).unwrap();
        let (run, demo) = (read("run"), read("moorline-demo"));
        let differing = run.lines().zip(demo.lines()).find(|(run, demo)| run != demo);
        assert_eq!(differing, None, "{table}");
        assert_eq!(run.len(), demo.len());
    }
}

#[test]
fn a_missing_fmu_library_is_named_with_how_to_build_it() {
    let folder = folder();
    // The program alone, away from the library. A link, since a program that was just written may still count as open where other
    // threads start processes.
    let bin = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
    let program = bin
        .path()
        .join(format!("moorline{}", std::env::consts::EXE_SUFFIX));
    fs::hard_link(env!("CARGO_BIN_EXE_moorline"), &program).unwrap();
    let output = Command::new(&program)
        .args(["fmu", "scene.toml", "-o", "x.fmu"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(err(&output).contains("moorline_fmu"), "{}", err(&output));
    assert!(err(&output).contains("cargo build --release"), "{}", err(&output));
    assert!(!folder.path().join("x.fmu").exists());
}
