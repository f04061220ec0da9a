//! Communication steps whose internal steps are too long for the motion are repeated with shorter ones; a failed
//! attempt leaves no trace.

use crate::common::*;
use moorline::model::Body;
use moorline::scene::{Integrator, Scene};
use moorline::simulation::Simulation;

/// A light rope in water over a sloping seabed, from an anchor to a buoy at the surface.
fn light_rope(integrator: Integrator) -> Simulation {
    let rope = draft(
        "water.density = 1025.0
        seabed = { depth = 60.0, slope = [0.02, 0.01] }
        line_types.rope = { mass = 0.6, diameter = 0.03, axial_stiffness = 2.0e4, axial_damping = 20.0, drag_normal = 1.6,
          drag_tangential = 0.05 }",
    )
    .fixed("anchor", [60.0, 0.0, -58.0])
    .coupled("buoy", [0.0; 3])
    .line("rope", ["anchor", "buoy"], "rope", 95.0, 20);
    start(&with_integrator(rope.scene(), integrator, 0.05))
}

/// Moves the buoy to a height [m] with a vertical velocity [m/s].
fn put_buoy(simulation: &mut Simulation, height: f64, rise: f64) {
    let rates = [0.0, 0.0, rise, 0.0, 0.0, 0.0].map(Some);
    simulation.set_body(Body::Point(1), [0.0, 0.0, height, 0.0, 0.0, 0.0], rates);
}

/// Greatest nodal speed [m/s] of the rope if the buoy is accelerated abruptly to 40 m/s, over three communication steps of `step` [s].
fn fastest(step: f64) -> f64 {
    let mut simulation = light_rope(Integrator::Leapfrog);
    put_buoy(&mut simulation, 0.0, 0.0);
    simulation.advance(0.01).unwrap();
    let mut greatest: f64 = 0.0;
    for number in 1..=3 {
        put_buoy(&mut simulation, 40.0 * step * f64::from(number), 40.0);
        simulation.advance(step).unwrap();
        let nodes = simulation.state().lines[0].velocity.iter();
        greatest = nodes.map(|node| node.norm()).fold(greatest, f64::max);
    }
    greatest
}

/// The path of the buoy overshoots, and the rope with it: in steps 16 times shorter, the greatest speed is 119 m/s. If only the drag at the start
/// of a communication step limits the internal steps, 700 to 6000 m/s remain at the end of some.
#[test]
fn a_jerked_rope_does_not_outrun_its_drag_whatever_the_communication_step() {
    for number in 0..40 {
        let step = 0.1 * 1.03_f64.powi(number);
        let speed = fastest(step);
        assert!(speed < 150.0, "{speed} m/s in steps of {step} s");
    }
}

#[test]
fn a_step_that_failed_leaves_nothing_to_those_after_it() {
    for integrator in [Integrator::Leapfrog, Integrator::AxialImplicit] {
        let forces = [false, true].map(|fails| {
            let mut simulation = light_rope(integrator);
            put_buoy(&mut simulation, 0.0, 0.0);
            simulation.advance(0.1).unwrap();
            let before = simulation.snapshot().clone();
            if fails {
                put_buoy(&mut simulation, 1e9, 1e9);
                simulation.advance(0.1).unwrap_err();
            }
            simulation.restore(before);
            for _ in 0..5 {
                put_buoy(&mut simulation, 0.0, 0.0);
                simulation.advance(0.1).unwrap();
            }
            simulation.end_force(1)
        });
        assert_eq!(forces[0], forces[1], "{integrator:?}");
    }
}

/// A thick light hose, vertical in the water, that is moved up and down along its axis.
fn hose(integrator: Integrator) -> Scene {
    let hose = draft(
        "water = { density = 1025.0, surface = false }
        line_types.hose = { mass = 1.0, diameter = 0.1, axial_stiffness = 1.0e5, drag_normal = 1.2, drag_tangential = 0.4,
          added_mass_normal = 1.0 }
        motion = { low = { z = [[4.0, 6.0]] }, high = { z = [[4.0, 6.0]] } }",
    )
    .coupled("low", [0.0, 0.0, -150.0])
    .coupled("high", [0.0, 0.0, -49.0])
    .line("hose", ["low", "high"], "hose", 100.0, 10);
    with_integrator(hose.scene(), integrator, 0.05)
}

#[test]
fn drag_along_a_line_that_is_light_beside_the_water_it_displaces_shortens_the_steps() {
    let tensions = |integrator| {
        let history = History::record(&mut following(&hose(integrator)), 0.1, 200);
        history.tension[1..].to_vec()
    };
    let [found, .., reference] = JOINED.map(tensions);
    let mean = reference.iter().sum::<f64>() / 200.0;
    let rms = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / 200.0).sqrt();
    let swing: Vec<f64> = reference.iter().map(|v| v - mean).collect();
    let error: Vec<f64> = found.iter().zip(&reference).map(|(a, b)| a - b).collect();
    assert!(rms(&error) < 0.02 * rms(&swing), "{} N", rms(&error));
}

/// Internal steps per communication step of a light rope in deep water, over a level or sloping seabed, with a heaving buoy.
fn steps_of_a_heave(seabed: &str, ends: [&str; 2]) -> Vec<usize> {
    let rope = draft(format!(
        "water = {{ density = 1025.0, surface = false }}
        seabed = {seabed}
        motion.buoy = {{ z = [[2.0, 4.0]] }}
        line_types.rope = {{ mass = 0.6, diameter = 0.03, axial_stiffness = 2.0e4, axial_damping = 20.0, drag_normal = 1.6 }}",
    ))
    .fixed("anchor", [60.0, 0.0, -58.0])
    .coupled("buoy", [0.0; 3])
    .line("rope", ends, "rope", 95.0, 4);
    let mut simulation = following(&with_integrator(rope.scene(), Integrator::Leapfrog, 0.05));
    let steps = (0..40).map(|_| {
        simulation.advance(0.1).unwrap();
        simulation.substeps()
    });
    steps.collect()
}

#[test]
fn drag_at_an_end_that_is_held_shortens_no_step_whatever_lies_below_and_wherever_the_line_starts() {
    let ends = ["anchor", "buoy"];
    let level = steps_of_a_heave("{ depth = 600.0 }", ends);
    assert_eq!(
        level,
        steps_of_a_heave("{ depth = 600.0, slope = [0.02, 0.01] }", ends)
    );
    assert_eq!(level, steps_of_a_heave("{ depth = 600.0 }", ["buoy", "anchor"]));
}
