//! The `fmi` crate, a host by other authors, opens and drives the FMU in both versions.
//!
//! `run_tests.py` sets the environment variable MOORLINE to the path of the command-line program, which packages the FMU.

use std::fs::File;
use std::io::{Cursor, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::Command;

use fmi::fmi2::import::Fmi2Import;
use fmi::fmi2::instance::{CoSimulation as _, Common as _};
use fmi::fmi3::import::Fmi3Import;
use fmi::fmi3::{CoSimulation as _, Common as _, Fmi3Model as _, GetSet as _};
use fmi::schema::MajorVersion;
use fmi::schema::traits::FmiModelDescription as _;
use fmi::traits::FmiImport as _;

const SCENE: &str = include_str!("../../../tests/scenes/hand.toml");

/// Value references of `hand.x` and `rope.tension_b`: indices in the table of variables, the same in both versions.
const HAND_X: u32 = 1;
const TENSION_B: u32 = 10;

fn package(version: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let scene = folder.join(format!("scene{version}.toml"));
    let fmu = folder.join(format!("rope{version}.fmu"));
    std::fs::write(&scene, SCENE).unwrap();
    let program = std::env::var("MOORLINE").expect("MOORLINE is the path of the command line");
    let status = Command::new(program)
        .arg("fmu")
        .args([&scene, Path::new("-o"), &fmu])
        .args(["--fmi", version])
        .status()
        .unwrap();
    assert!(status.success());
    fmu
}

/// Removes the units of the variables from an FMU: version 0.8 of the crate refuses the attribute `unit`, which the standard
/// allows on every Float64 (FMI 3.0.2, section 2.4.7). The token stays valid, since the FMU computes its own.
fn without_units(fmu: &Path) -> Cursor<Vec<u8>> {
    let mut archive = zip::ZipArchive::new(File::open(fmu).unwrap()).unwrap();
    let mut copy = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for index in 0..archive.len() {
        let mut entry = archive.by_index(index).unwrap();
        let name = entry.name().unwrap().into_owned();
        let mut bytes = Vec::new();
        entry.read_to_end(&mut bytes).unwrap();
        if name == "modelDescription.xml" {
            let text = String::from_utf8(bytes).unwrap();
            let mut parts = text.split(" unit=\"");
            let first = parts.next().unwrap().to_string();
            let rest = parts.map(|part| part.split_once('"').unwrap().1);
            bytes = rest.fold(first, |text, part| text + part).into_bytes();
        }
        copy.start_file(name, zip::write::SimpleFileOptions::default())
            .unwrap();
        copy.write_all(&bytes).unwrap();
    }
    copy.finish().unwrap()
}

fn displacement(step: i32) -> f64 {
    0.2 * (0.05 * f64::from(step)).sin()
}

fn drive2() -> Vec<u64> {
    let fmu = package("2");
    let import: Fmi2Import = fmi::import::from_path(&fmu).unwrap();
    let description = import.model_description();
    assert_eq!(description.major_version().unwrap(), MajorVersion::FMI2);
    assert_eq!(description.model_name, "a rope in the hand");
    let mut slave = import.instantiate_cs("mooring", false, true).unwrap();
    slave.setup_experiment(None, 0.0, None).unwrap();
    slave.enter_initialization_mode().unwrap();
    slave.exit_initialization_mode().unwrap();
    let mut tension = [0.0];
    let mut tensions = Vec::new();
    for k in 0..40 {
        slave.set_real(&[HAND_X], &[displacement(k)]).unwrap();
        slave.do_step(0.05 * f64::from(k), 0.05, true).unwrap();
        slave.get_real(&[TENSION_B], &mut tension).unwrap();
        tensions.push(tension[0].to_bits());
    }
    assert!(slave.do_step(9.0, 0.05, true).is_err());
    slave.terminate().unwrap();
    tensions
}

fn drive3() -> Vec<u64> {
    let fmu = package("3");
    let import: Fmi3Import = fmi::import::new(without_units(&fmu)).unwrap();
    let description = import.model_description();
    assert_eq!(description.major_version().unwrap(), MajorVersion::FMI3);
    let mut slave = import
        .instantiate_cs("mooring", false, true, false, false, &[])
        .unwrap();
    slave.enter_initialization_mode(None, 0.0, None).unwrap();
    slave.exit_initialization_mode().unwrap();
    let mut tension = [0.0];
    let mut tensions = Vec::new();
    let (mut event, mut end, mut early, mut reached) = (false, false, false, 0.0);
    for k in 0..40 {
        let time = 0.05 * f64::from(k);
        slave.set_float64(&[HAND_X], &[displacement(k)]).unwrap();
        slave
            .do_step(time, 0.05, true, &mut event, &mut end, &mut early, &mut reached)
            .unwrap();
        assert_eq!(reached, time + 0.05);
        slave.get_float64(&[TENSION_B], &mut tension).unwrap();
        tensions.push(tension[0].to_bits());
    }
    assert!(!event && !end && !early);
    slave.terminate().unwrap();
    tensions
}

#[test]
fn the_fmi_crate_drives_both_versions_to_the_same_bits() {
    let tensions = drive2();
    assert_eq!(tensions, drive3());
    assert!(tensions.iter().all(|&bits| f64::from_bits(bits) > 0.0));
}
