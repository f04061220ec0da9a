//! Cost of many lines: static equilibrium and a step of the generalised-α integrator for nets of free points; and the cost of a step per line in
//! small and large systems.

mod common;
#[path = "../tests/common/copies.rs"]
mod copies;
#[path = "../tests/common/draft.rs"]
mod draft;
#[path = "../tests/common/net.rs"]
mod net;

use std::time::Instant;

use moorline::elements::Workspace;
use moorline::model::{Model, PointState};
use moorline::scene::{Integrator, Scene, Threads};
use moorline::simulation::Simulation;
use moorline::statics::{catenary_network, equilibrium};

/// Number of repetitions; the fastest counts.
const REPETITIONS: usize = 7;
/// Elements of a rope.
const ELEMENTS: usize = 3;
/// Step of the integrator [s].
const STEP: f64 = 0.02;
/// Steps before the timed ones, and timed ones.
const STEPS: [usize; 2] = [50, 10];

/// Minimum time of a call [ms].
fn least(mut call: impl FnMut()) -> f64 {
    let run = |_| {
        let clock = Instant::now();
        call();
        1e3 * clock.elapsed().as_secs_f64()
    };
    (0..REPETITIONS).map(run).fold(f64::INFINITY, f64::min)
}

/// `lines` copies of one line, each driven at its own fairlead.
fn alone(lines: usize) -> Scene {
    let mut scene = copies::copies(&common::scene("oc3_catenary"), lines, 0, 0.0);
    (scene.solver.integrator, scene.solver.elements) = (Integrator::Leapfrog, Some(20));
    scene.solver.threads = Threads::Number(1);
    scene
}

/// Time per line and communication step [µs].
fn line_step(scene: &Scene, follows_scene: bool) -> f64 {
    let mut simulation = Simulation::new(scene).expect("an equilibrium");
    if follows_scene {
        simulation.follow_scene().expect("an equilibrium");
    }
    let steps = 2000 / scene.lines.len();
    let mut run = || (0..steps).for_each(|_| simulation.advance(0.05).expect("a step"));
    run();
    1e3 * least(run) / (steps * scene.lines.len()) as f64
}

fn main() {
    println!(
        "{:>6} {:>22} {:>22}",
        "lines", "as the scene [µs]", "as a host [µs]"
    );
    for lines in [20, 100, 400] {
        let scene = alone(lines);
        let [own, host] = [true, false].map(|follows_scene| line_step(&scene, follows_scene));
        println!("{lines:>6} {own:>22.2} {host:>22.2}");
    }
    println!(
        "{:>6} {:>6} {:>14} {:>14} {:>14} {:>10} {:>8}",
        "points", "lines", "elements [ms]", "catenary [ms]", "step [ms]", "steps", "solves"
    );
    for count in [1, 2, 3, 10, 17, 24] {
        let scene = net::net(count, ELEMENTS);
        let model = Model::new(&scene).expect("a scene that passes its checks");
        let places: Vec<PointState> = model
            .points
            .iter()
            .map(|point| PointState::at_rest(point.reference))
            .collect();
        let mut work = Workspace::new(&model);
        let elements = least(|| {
            equilibrium::solve(&model, &places, 0.0, &mut work).expect("an equilibrium");
        });
        let catenary = least(|| {
            let mut state = equilibrium::place(&model, &places, 0.0).expect("finite places");
            equilibrium::hang(&model, 0, &mut state, &mut work);
            catenary_network::rest(&model, 0, &mut state, &mut work).expect("an equilibrium");
        });
        let mut simulation = Simulation::new(&scene).expect("an equilibrium");
        simulation.follow_scene().expect("an equilibrium");
        let [before, timed] = STEPS;
        (0..before).for_each(|_| simulation.advance(STEP).expect("a step"));
        let start = simulation.snapshot().clone();
        let (mut steps, mut solves) = (0, 0);
        let step = least(|| {
            simulation.restore(start.clone());
            (steps, solves) = (0, 0);
            for _ in 0..timed {
                simulation.advance(STEP).expect("a step");
                steps += simulation.counters().substeps;
                solves += simulation.counters().solves;
            }
        });
        println!(
            "{:>6} {:>6} {elements:>14.3} {catenary:>14.3} {:>14.4} {steps:>10} {solves:>8}",
            count * count,
            model.lines.len(),
            step / timed as f64
        );
    }
}
