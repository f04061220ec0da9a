//! Speed-up by threads: µs per communication step of systems of many lines on one thread, on two, and on the number that the solver chooses. They are
//! measured in turn, so that other load on the machine affects all of them.

mod common;
#[path = "../tests/common/copies.rs"]
mod copies;

use std::time::Instant;

use moorline::scene::{Integrator, Scene, Threads};
use moorline::simulation::Simulation;

/// Number of rounds; the fastest counts.
const ROUNDS: usize = 200;
/// Time before the timed steps, for the ramp to pass [s].
const WARM_UP: f64 = 70.0;
/// Communication step [s].
const STEP: f64 = 0.05;
/// Timed communication steps of a round.
const STEPS: usize = 20;

/// Semi-submersible with twelve lines of `elements` each, with or without waves.
fn semi(elements: usize, waves: bool) -> Scene {
    let mut scene = common::scene("storm_moored_semi");
    scene.solver.integrator = Integrator::Leapfrog;
    scene.solver.elements = Some(elements);
    if let (false, Some(water)) = (waves, &mut scene.water) {
        water.waves = None;
    }
    scene
}

/// Five such vessels, three kilometres apart: sixty lines.
fn farm(elements: usize, waves: bool) -> Scene {
    copies::copies(&semi(elements, waves), 5, 0, 3000.0)
}

/// Simulation past its start-up, on a number of threads.
fn warm(scene: &Scene, threads: Threads) -> Simulation {
    let mut scene = scene.clone();
    scene.solver.threads = threads;
    let mut simulation = Simulation::new(&scene).expect("an equilibrium");
    simulation.follow_scene().expect("an equilibrium");
    while simulation.time() < WARM_UP {
        simulation.advance(STEP).expect("a step");
    }
    simulation
}

/// Minimum of `best` and the time of a step in another round [µs].
fn time(simulation: &mut Simulation, best: f64) -> f64 {
    let clock = Instant::now();
    for _ in 0..STEPS {
        simulation.advance(STEP).expect("a step");
    }
    best.min(1e6 * clock.elapsed().as_secs_f64() / STEPS as f64)
}

fn main() {
    println!(
        "{:<24} {:>9} {:>9} {:>9} {:>7}  auto",
        "scene", "1 [µs]", "2 [µs]", "auto [µs]", "1 / 2"
    );
    let scenes = [
        ("semi, n = 8, calm", semi(8, false)),
        ("semi, n = 16, calm", semi(16, false)),
        ("semi, n = 32, calm", semi(32, false)),
        ("semi, n = 67, calm", semi(67, false)),
        ("semi, n = 67, waves", semi(67, true)),
        ("farm, n = 20, calm", farm(20, false)),
        ("farm, n = 67, calm", farm(67, false)),
        ("farm, n = 67, waves", farm(67, true)),
    ];
    for (name, scene) in &scenes {
        let settings = [Threads::Number(1), Threads::Number(2), Threads::Auto];
        let mut runs = settings.map(|threads| warm(scene, threads));
        let starts = runs.each_ref().map(|run| run.snapshot().clone());
        let mut best = [f64::INFINITY; 3];
        for _ in 0..ROUNDS {
            for ((run, start), best) in runs.iter_mut().zip(&starts).zip(&mut best) {
                run.restore(start.clone());
                *best = time(run, *best);
            }
        }
        let [one, two, auto] = best;
        println!(
            "{name:<24} {one:>9.1} {two:>9.1} {auto:>9.1} {:>7.2}  {}",
            one / two,
            runs[2].threads_in_words(STEP)
        );
    }
}
