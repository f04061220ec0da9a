//! The FMU driven through its C interface by `moorline-host`, as `moorline demo` does.

mod common;

use std::path::Path;

use moorline::output::description::Description;
use moorline::scene::Scene;
use moorline::simulation::Simulation;
use moorline_host::{Causality, FmiVersion, HostError, Slave, Status, VariableType};

const VERSIONS: [FmiVersion; 2] = [FmiVersion::Two, FmiVersion::Three];

fn drive(slave: &mut Slave, steps: usize) -> Vec<u64> {
    let fmu = slave.fmu().clone();
    let x = fmu.reference("fairlead.x").unwrap();
    let outputs: Vec<u32> = fmu
        .description()
        .variables
        .iter()
        .filter(|v| v.causality == Causality::Output && v.kind == VariableType::Real)
        .map(|v| v.reference)
        .collect();
    let mut values = vec![0.0; outputs.len()];
    let mut bits = Vec::new();
    for k in 0..steps {
        let time = 0.05 * k as f64;
        slave.set_real(&[x], &[2.0 * (0.7 * time).sin()]).unwrap();
        slave.do_step(time, 0.05).unwrap();
        slave.get_real(&outputs, &mut values).unwrap();
        bits.extend(values.iter().map(|value| value.to_bits()));
    }
    bits
}

fn start(slave: &mut Slave) {
    slave.enter_initialization(0.0, None).unwrap();
    slave.exit_initialization().unwrap();
}

#[test]
fn a_host_gets_the_bits_of_the_library_in_both_versions() {
    let scene = Scene::from_toml(common::SCENE).unwrap();
    let mut simulation = Simulation::new(&scene).unwrap();
    let mut expected = Vec::new();
    for k in 0..40 {
        let time = 0.05 * f64::from(k);
        simulation.set_displacement(1, [2.0 * (0.7 * time).sin(), 0.0, 0.0]);
        simulation.advance(0.05).unwrap();
        expected.push(simulation.tension_b(0).to_bits());
    }
    for version in VERSIONS {
        let fmu = common::open(version);
        let mut slave = fmu.instantiate("mooring", true).unwrap();
        start(&mut slave);
        let x = fmu.reference("fairlead.x").unwrap();
        let found: Vec<u64> = (0..40)
            .map(|k| {
                let time = 0.05 * f64::from(k);
                slave.set_real(&[x], &[2.0 * (0.7 * time).sin()]).unwrap();
                slave.do_step(time, 0.05).unwrap();
                slave.real("line1.tension_b").unwrap().to_bits()
            })
            .collect();
        assert_eq!(found, expected, "FMI {version}");
        assert!(slave.integer("solver.substeps").unwrap() > 0);
        slave.terminate().unwrap();
    }
}

#[test]
fn a_saved_state_replays_bit_for_bit() {
    for version in VERSIONS {
        let fmu = common::open(version);
        let mut slave = fmu.instantiate("mooring", false).unwrap();
        start(&mut slave);
        let state = slave.save_state().unwrap();
        let first = drive(&mut slave, 20);
        slave.restore_state(&state).unwrap();
        assert_eq!(first, drive(&mut slave, 20), "FMI {version}");
        slave.free_state(state).unwrap();
        slave.reset().unwrap();
        start(&mut slave);
        assert_eq!(first, drive(&mut slave, 20), "FMI {version} after reset");
    }
}

#[test]
fn a_refused_call_says_which_function_refused_and_why() {
    for version in VERSIONS {
        let fmu = common::open(version);
        let mut slave = fmu.instantiate("mooring", true).unwrap();
        start(&mut slave);
        match slave.do_step(7.0, 0.05).unwrap_err() {
            HostError::Call {
                function,
                status,
                log,
            } => {
                assert!(function.ends_with("DoStep"), "{function}");
                assert_eq!(status, Status::Error);
                assert!(log.contains("the host steps from 7 s"), "{log}");
            }
            other => panic!("{other}"),
        }
        drive(&mut slave, 2);
    }
}

#[test]
fn a_wrong_token_is_refused_in_words() {
    for version in VERSIONS {
        let fmu = common::open(version);
        let error = fmu.instantiate_with_token("mooring", "other", false).unwrap_err();
        assert!(error.to_string().contains("token"), "{error}");
    }
}

#[test]
fn the_host_reads_the_description_that_was_written() {
    let scene = Scene::from_toml(common::SCENE).unwrap();
    for version in VERSIONS {
        let fmu = common::open(version);
        let written = Description::new(common::SCENE, &scene, version).unwrap();
        let read = fmu.description();
        assert_eq!(read.token, written.token);
        assert_eq!(read.model_name, "one chain line");
        let names: Vec<&str> = read.variables.iter().map(|v| v.name.as_str()).collect();
        let own: Vec<&str> = written
            .interface
            .variables()
            .iter()
            .map(|v| v.name.as_str())
            .collect();
        assert_eq!(names[..own.len()], own[..]);
        assert_eq!(read.variables[0].unit.as_deref(), Some("m"));
    }
}

#[test]
fn the_log_says_which_integrator_was_chosen() {
    let fmu = common::open(FmiVersion::Two);
    let mut slave = fmu.instantiate("mooring", true).unwrap();
    start(&mut slave);
    let log = slave.take_log();
    assert!(
        log.iter()
            .any(|m| m.category == "logEvents" && m.text.starts_with("integrator: explicit")),
        "{log:?}"
    );
}

#[test]
fn the_unpacked_folder_goes_with_the_last_instance() {
    let fmu = common::open(FmiVersion::Three);
    let place = fmu.folder().to_path_buf();
    let slave = fmu.instantiate("mooring", false).unwrap();
    drop(fmu);
    assert!(place.is_dir());
    drop(slave);
    assert!(!Path::new(&place).exists());
}
