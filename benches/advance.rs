//! Cost of a communication step compared with the kernel: ns per advance by elements, internal steps and source of the fairlead motion, and ns per
//! read of all outputs.

mod common;

use std::time::Instant;

use moorline::interface::{Binding, Causality, Interface, Layout};
use moorline::model::Body;
use moorline::scene::{Integrator, Scene};
use moorline::simulation::Simulation;

/// Number of repetitions; the fastest counts.
const REPETITIONS: usize = 30;
/// Time before the timed steps, for the ramp to pass [s].
const WARM_UP: f64 = 30.0;
/// Timed communication steps.
const STEPS: usize = 400;

/// Source of the motion of the bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Drive {
    /// Motion of the scene.
    Scene,
    /// Displacements set by a host.
    Displacements,
    /// Displacements and velocities set by a host.
    Velocities,
}

/// Input of a host for a body at a time: displacements [m, rad] and velocities [m/s, rad/s].
type Said = ([f64; 6], [Option<f64>; 6]);

/// Smooth motion at time `t` [s].
fn said(drive: Drive, t: f64) -> Said {
    let frequencies = [0.63, 0.5, 0.79, 0.6, 0.55, 0.1];
    let amplitudes = [6.0, 2.0, 2.0, 0.02, 0.03, 0.01];
    let place = std::array::from_fn(|i| amplitudes[i] * (frequencies[i] * t).sin());
    let rate = |i: usize| amplitudes[i] * frequencies[i] * (frequencies[i] * t).cos();
    let velocity = std::array::from_fn(|i| (drive == Drive::Velocities).then(|| rate(i)));
    (place, velocity)
}

/// Simulation past its start-up, with the bodies that a host moves.
fn warm(scene: &Scene, drive: Drive, step: f64) -> (Simulation, Vec<Body>) {
    let mut simulation = Simulation::new(scene).expect("an equilibrium");
    if drive == Drive::Scene {
        simulation.follow_scene().expect("an equilibrium");
    }
    let model = simulation.model();
    let interface = Interface::new(scene, model, Layout::Scalars).expect("an interface");
    let mut bodies: Vec<Body> = interface
        .variables()
        .iter()
        .filter_map(|variable| match variable.binding {
            Binding::Displacement { body, .. } => Some(body),
            _ => None,
        })
        .collect();
    bodies.dedup();
    while simulation.time() < WARM_UP {
        if drive != Drive::Scene {
            let (place, velocity) = said(drive, simulation.time());
            bodies
                .iter()
                .for_each(|&body| simulation.set_body(body, place, velocity));
        }
        simulation.advance(step).expect("a step");
    }
    (simulation, bodies)
}

/// Minimum time of a communication step of `step` [s], in [ns], and its number of internal steps.
fn advance(scene: &Scene, drive: Drive, step: f64) -> (f64, f64) {
    let (mut simulation, bodies) = warm(scene, drive, step);
    let start = simulation.snapshot().clone();
    let now = simulation.time();
    let table: Vec<Said> = (0..STEPS).map(|k| said(drive, now + k as f64 * step)).collect();
    let (mut best, mut substeps) = (f64::INFINITY, 0);
    for _ in 0..REPETITIONS {
        simulation.restore(start.clone());
        substeps = 0;
        let clock = Instant::now();
        for (place, velocity) in &table {
            if drive != Drive::Scene {
                for &body in &bodies {
                    simulation.set_body(body, *place, *velocity);
                }
            }
            simulation.advance(step).expect("a step");
            substeps += simulation.substeps();
        }
        best = best.min(clock.elapsed().as_secs_f64());
    }
    (1e9 * best / STEPS as f64, substeps as f64 / STEPS as f64)
}

/// Minimum time to read all outputs once [ns], and their number.
fn outputs(scene: &Scene) -> (f64, usize) {
    let (simulation, _) = warm(scene, Drive::Velocities, 0.05);
    let model = simulation.model();
    let interface = Interface::new(scene, model, Layout::Scalars).expect("an interface");
    let variables = interface
        .variables()
        .iter()
        .filter(|variable| variable.causality == Causality::Output)
        .collect::<Vec<_>>();
    let mut best = f64::INFINITY;
    let mut value = [0.0];
    for _ in 0..REPETITIONS {
        let clock = Instant::now();
        for variable in &variables {
            Interface::read(variable, &simulation, &mut value).expect("a value");
            std::hint::black_box(&value);
        }
        best = best.min(clock.elapsed().as_secs_f64());
    }
    (1e9 * best, variables.len())
}

/// Taut line with `elements`.
fn taut(elements: usize) -> Scene {
    let mut scene = common::scene("taut_polyester");
    scene.solver.integrator = Integrator::Leapfrog;
    scene.lines[0].sections[0].elements = Some(elements);
    scene
}

/// Taut line with `elements` and implicit tensions, in internal steps of at most `longest` [s].
fn taut_implicit(elements: usize, longest: f64) -> Scene {
    let mut scene = taut(elements);
    scene.solver.integrator = Integrator::AxialImplicit;
    scene.solver.time_step_max = longest;
    scene
}

/// Twelve lines of a semi-submersible, with or without waves.
fn semi(waves: bool) -> Scene {
    let mut scene = common::scene("storm_moored_semi");
    scene.solver.integrator = Integrator::Leapfrog;
    if let (false, Some(water)) = (waves, &mut scene.water) {
        water.waves = None;
    }
    scene
}

fn main() {
    let pick: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let wanted = |part: &str| pick.is_empty() || pick.iter().any(|name| name == part);
    println!(
        "{:<16} {:>4} {:<14} {:>10} {:>12} {:>12}",
        "scene", "n", "drive", "internal", "ns/advance", "ns/internal"
    );
    let row = |name: &str, n: usize, scene: &Scene, drive: Drive, step: f64| {
        let (cost, count) = advance(scene, drive, step);
        println!(
            "{name:<16} {n:>4} {:<14} {count:>10.1} {cost:>12.1} {:>12.1}",
            format!("{drive:?}"),
            cost / count
        );
    };
    let drives = [Drive::Scene, Drive::Displacements, Drive::Velocities];
    if wanted("taut") {
        for elements in [4, 8, 16, 32] {
            let scene = taut(elements);
            for drive in drives {
                for step in [0.05, 0.4] {
                    row("taut_polyester", elements, &scene, drive, step);
                }
            }
        }
    }
    if wanted("implicit") {
        for (elements, longest) in [(4, 0.5), (5, 0.5), (6, 0.25), (8, 0.25)] {
            let scene = taut_implicit(elements, longest);
            for drive in drives {
                row("taut, implicit", elements, &scene, drive, 0.5);
            }
        }
    }
    if wanted("semi") {
        for (name, waves) in [("semi in waves", true), ("semi, calm", false)] {
            for drive in [Drive::Displacements, Drive::Velocities] {
                row(name, 12, &semi(waves), drive, 0.05);
            }
            let (cost, count) = outputs(&semi(waves));
            println!("{name:<16} {count} outputs {cost:>12.1} ns");
        }
    }
}
