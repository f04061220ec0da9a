//! Cost of a step of beams of different kinds: free flight in a plane and in space, a driven power cable in water with a part on the seabed, and
//! a short stiff arm. All are without the energy balance.
//!
//! `cargo bench --bench beam` prints time and factorised tangents. `-- KIND STEPS` runs this number of steps of one kind and prints nothing, for a
//! profiler or to count instructions.

mod common;

use std::env;
use std::time::Instant;

use moorline::scene::{LineModel, Scene};
use moorline::simulation::Simulation;

const KINDS: [&str; 4] = ["flight", "flight in space", "power cable", "stiff arm"];
/// Steps before the timed ones, and timed ones [-].
const STEPS: [usize; 2] = [25, 75];
/// Number of repetitions; the fastest counts.
const REPETITIONS: usize = 40;

/// Steel rod of 2 m, clamped to a point that shakes it, with a clump at its end.
const STIFF_ARM: &str = r#"
title = "stiff arm"

[line_types.rod]
model = "beam"
mass = 15.4
axial_stiffness = 4.12e8
shear_stiffness = 1.5e8
bending_stiffness = 6.44e4
torsional_stiffness = 4.95e4
rotary_inertia = 2.4e-3

[[points]]
name = "base"
position = [0.0, 0.0, 0.0]
kind = "coupled"

[[points]]
name = "tip"
position = [2.0, 0.0, 0.0]
kind = "free"
mass = 5.0

[[lines]]
name = "rod"
from = "base"
to = "tip"
sections = [{ type = "rod", length = 2.0, elements = 16 }]
clamped_a = [1.0, 0.0, 0.0]
initial = "straight"

[motion]
base = { y = [[0.05, 0.5]], z = [[0.1, 0.8]] }

[solver]
time_step_max = 0.005

[output]
duration = 4.0
interval = 0.005
"#;

fn scene(kind: &str) -> Scene {
    let mut scene = match kind {
        "flight" => common::scene("flying_spaghetti"),
        "flight in space" => common::scene("flying_spaghetti_3d"),
        "power cable" => power_cable(),
        _ => Scene::from_toml(STIFF_ARM).expect("a scene that passes its checks"),
    };
    scene.output.energy_balance = false;
    scene
}

/// The scene `power_cable` as a beam that is nearly rigid in shear.
fn power_cable() -> Scene {
    let mut scene = common::scene("power_cable");
    for line_type in scene.line_types.values_mut() {
        line_type.model = LineModel::Beam;
        line_type.shear_stiffness = Some(1e8);
        line_type.torsional_stiffness = Some(1e4);
        line_type.rotary_inertia = Some(0.05);
    }
    scene
}

fn start(kind: &str) -> (Simulation, f64) {
    let scene = scene(kind);
    let mut simulation = Simulation::new(&scene).expect("an equilibrium");
    simulation.follow_scene().expect("an equilibrium");
    (simulation, scene.output.interval)
}

fn measure(kind: &str) {
    let (mut simulation, interval) = start(kind);
    let [before, timed] = STEPS;
    (0..before).for_each(|_| simulation.advance(interval).expect("a step"));
    let saved = simulation.snapshot().clone();
    let nodes = simulation.model().lines[0].segment_count() + 1;
    let (mut best, mut substeps, mut solves) = (f64::INFINITY, 0, 0);
    for _ in 0..REPETITIONS {
        simulation.restore(saved.clone());
        (substeps, solves) = (0, 0);
        let clock = Instant::now();
        for _ in 0..timed {
            simulation.advance(interval).expect("a step");
            substeps += simulation.substeps();
            solves += simulation.counters().solves;
        }
        best = best.min(clock.elapsed().as_secs_f64());
    }
    println!(
        "{kind:<16} {nodes:>6} {:>14.3} {:>20.2}",
        1e6 * best / (nodes * substeps) as f64,
        solves as f64 / substeps as f64
    );
}

fn main() {
    let words: Vec<String> = env::args().skip(1).filter(|word| word != "--bench").collect();
    if let [kind, steps] = &words[..] {
        let (mut simulation, interval) = start(kind);
        let steps: usize = steps.parse().expect("a number of steps");
        (0..steps).for_each(|_| simulation.advance(interval).expect("a step"));
        return;
    }
    println!(
        "{:<16} {:>6} {:>14} {:>20}",
        "beam", "nodes", "us/node/step", "tangents/step"
    );
    KINDS.into_iter().for_each(measure);
}
