//! Cost of a communication step of the taut rope through the C interface: set three displacements, make a step, read three forces.
//!
//! `cargo bench -p moorline-fmu --bench communication`. The simulation alone, with communication steps of one and of eight internal steps,
//! gives the cost of an internal step.

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use moorline::scene::Scene;
use moorline::simulation::Simulation;
use moorline_host::FmiVersion;

/// Number of repetitions [-]; the fastest one counts.
const REPETITIONS: usize = 40;
/// Number of timed communication steps [-].
const STEPS: usize = 400;
/// Communication step [s]: one internal step.
const STEP: f64 = 0.05;

/// Returns the displacements [m] of the fairlead at communication points spaced `step` [s] apart.
fn displacements(step: f64) -> Vec<[f64; 3]> {
    let at = |t: f64| {
        [
            6.0 * (0.63 * t).sin(),
            2.0 * (0.5 * t).sin(),
            2.0 * (0.79 * t).sin(),
        ]
    };
    (0..STEPS).map(|k| at(k as f64 * step)).collect()
}

/// Returns the least wall time per communication step of `step` [s] without FMI [ns], and the number of internal steps per communication step [-].
fn alone(scene: &Scene, step: f64) -> (f64, f64) {
    let mut simulation = Simulation::new(scene).expect("an equilibrium");
    let (start, table) = (simulation.snapshot().clone(), displacements(step));
    let (mut best, mut internal) = (f64::INFINITY, 0);
    for _ in 0..REPETITIONS {
        simulation.restore(start.clone());
        internal = 0;
        let clock = Instant::now();
        for displacement in &table {
            simulation.set_displacement(1, *displacement);
            simulation.advance(step).expect("a step");
            internal += simulation.substeps();
        }
        best = best.min(clock.elapsed().as_secs_f64());
    }
    (1e9 * best / STEPS as f64, internal as f64 / STEPS as f64)
}

/// Returns the least wall time per communication step through the C interface [ns].
fn hosted(version: FmiVersion, text: &str) -> f64 {
    let fmu = common::open_scene(version, text);
    let inputs = ["x", "y", "z"].map(|axis| fmu.reference(&format!("fairlead.{axis}")).expect("an input"));
    let outputs =
        ["fx", "fy", "fz"].map(|axis| fmu.reference(&format!("fairlead.{axis}")).expect("an output"));
    let (mut best, table) = (f64::INFINITY, displacements(STEP));
    for _ in 0..REPETITIONS {
        let mut slave = fmu.instantiate("rope", false).expect("an instance");
        slave.enter_initialization(0.0, None).expect("initialised");
        slave.exit_initialization().expect("initialised");
        let mut forces = [0.0; 3];
        let clock = Instant::now();
        for (k, displacement) in table.iter().enumerate() {
            slave.set_real(&inputs, displacement).expect("set");
            slave.do_step(k as f64 * STEP, STEP).expect("a step");
            slave.get_real(&outputs, &mut forces).expect("read");
            std::hint::black_box(&forces);
        }
        best = best.min(clock.elapsed().as_secs_f64());
        slave.terminate().expect("terminated");
    }
    1e9 * best / STEPS as f64
}

fn main() {
    let text = include_str!("../../scenes/taut_polyester.toml").replace("elements = 40", "elements = 4");
    let scene = Scene::from_toml(&text).expect("a scene");
    let ((one, internal), (eight, internal_of_eight)) = (alone(&scene, STEP), alone(&scene, 8.0 * STEP));
    let each = (eight - one) / (internal_of_eight - internal);
    println!("taut_polyester, 4 elements: {internal:.1} internal steps of {each:.0} ns");
    println!(
        "{:<24} {:>14} {:>26}",
        "", "ns a point", "beyond internal steps [ns]"
    );
    let row = |name: &str, cost: f64| println!("{name:<24} {cost:>14.0} {:>26.0}", cost - internal * each);
    row("simulation alone", one);
    for version in [FmiVersion::Two, FmiVersion::Three] {
        row(&format!("FMI {version}, three forces"), hosted(version, &text));
    }
}
