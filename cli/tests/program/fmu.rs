//! `moorline fmu` and `moorline demo`: FMUs from the command line.

use std::io::Read;

use super::*;

#[test]
fn an_fmu_that_cannot_be_placed_is_refused() {
    let folder = folder();
    folder.refused(
        "fmu scene.toml -o .",
        &["cannot write .: it is a folder: give the name of a file"],
    );
    let nowhere = "cannot write nowhere/x.fmu: there is no folder nowhere";
    folder.refused("fmu scene.toml -o nowhere/x.fmu", &[nowhere]);
    assert_eq!(folder.names(), ["scene.toml"]);
}

/// Puts the FMU library that Cargo built for this test program next to the program under test, once.
fn place_library() {
    static PLACED: std::sync::Once = std::sync::Once::new();
    PLACED.call_once(|| {
        let library = moorline::output::binaries::find_library().unwrap();
        let beside = Path::new(env!("CARGO_BIN_EXE_moorline")).with_file_name(library.file_name().unwrap());
        if library != beside {
            let _ = fs::remove_file(&beside); // of an earlier build, if any
            fs::hard_link(library, beside).unwrap();
        }
    });
}

#[test]
fn an_fmu_of_either_version_is_one_whole_file() {
    place_library();
    let folder = folder();
    for version in ["2", "3"] {
        let target = format!("rope{version}.fmu");
        let said = folder.done(&format!("fmu scene.toml -o {target} --fmi {version}"));
        assert_eq!(said, format!("written to {target}\n"));
        let file = fs::File::open(folder.path(&target)).unwrap();
        let mut archive = zip::ZipArchive::new(file).unwrap();
        let mut xml = String::new();
        let mut entry = archive.by_name("modelDescription.xml").unwrap();
        entry.read_to_string(&mut xml).unwrap();
        drop(entry);
        assert_says(&xml, &[&format!("fmiVersion=\"{version}.0\"")]);
        let names: Vec<_> = archive.file_names().map(Result::unwrap).collect();
        assert!(
            names.iter().any(|name| name.starts_with("binaries/")),
            "{names:?}"
        );
        assert!(names.contains(&"resources/scene.toml".into()), "{names:?}");
    }
    assert_eq!(folder.names(), ["rope2.fmu", "rope3.fmu", "scene.toml"]);
}

#[test]
fn the_demo_drives_an_fmu_that_gives_the_bits_of_a_run() {
    place_library();
    let folder = folder_of("demo");
    let parts = [
        "static equilibrium",
        "catenary",
        "line1 tension at end B [N]",
        "times real time",
    ];
    folder.shows("demo", &parts);
    let made = folder.names_in("moorline-demo");
    for name in [
        "demo.fmu",
        "profile.svg",
        "report.html",
        "results.csv",
        "tension.svg",
    ] {
        assert!(made.contains(&name.to_string()), "{name} in {made:?}");
    }
    folder.done("run scene.toml -o run --communication-step 0.05");
    for table in ["results.csv", "profile.csv"] {
        let read = |of: &str| folder.read(&format!("{of}/{table}"));
        let (run, demo) = (read("run"), read("moorline-demo"));
        let differing = run.lines().zip(demo.lines()).find(|(run, demo)| run != demo);
        assert_eq!(differing, None, "{table}");
        assert_eq!(run.len(), demo.len());
    }
}

#[test]
fn a_missing_fmu_library_is_named_with_how_to_build_it() {
    let folder = folder();
    // The program is alone, away from the library. It is a link, since a program that was just written may still count as open while other threads
    // start processes.
    let bin = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
    let program = bin
        .path()
        .join(format!("moorline{}", std::env::consts::EXE_SUFFIX));
    fs::hard_link(env!("CARGO_BIN_EXE_moorline"), &program).unwrap();
    let output = Command::new(&program)
        .args(["fmu", "scene.toml", "-o", "x.fmu"])
        .current_dir(folder.path(""))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert_says(&err(&output), &["moorline_fmu", "cargo build --release"]);
    assert!(!folder.path("x.fmu").exists());
}

#[test]
fn the_reference_results_of_an_fmu_are_replayed() {
    place_library();
    let folder = folder();
    for version in ["2", "3"] {
        folder.done(&format!("fmu scene.toml -o x.fmu --fmi {version}"));
        let said = folder.done("fmu --verify x.fmu");
        assert_says(&said, &["x.fmu: ", " steps to t = ", "1.0e-6 is allowed"]);
    }
    folder.refused("fmu --verify none.fmu", &["none.fmu"]);
    folder.refused("fmu --verify scene.toml", &["scene.toml"]);
    folder.refused(
        "fmu --verify x.fmu scene.toml",
        &["unexpected argument 'scene.toml'"],
    );
}

#[test]
fn an_ssp_package_holds_the_fmu_beside_its_structure() {
    place_library();
    let folder = folder();
    folder.done("fmu scene.toml -o x.ssp --ssp");
    let file = fs::File::open(folder.path("x.ssp")).unwrap();
    let archive = zip::ZipArchive::new(file).unwrap();
    let names: Vec<_> = archive.file_names().map(Result::unwrap).collect();
    assert!(
        names[0] == "SystemStructure.ssd" && names[1].starts_with("resources/moorline"),
        "{names:?}"
    );
}
