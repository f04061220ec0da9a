//! Lines whose ends are released: by the host, at a tension limit, or at a given time.
//!
//! Claims: a straight line in tension snaps back as a bar does; a hanging chain falls freely, its middle
//! at g; the released point carries no more force; the energy balance closes through the release; a snapshot replays it.

use crate::common::*;
use approx::assert_relative_eq;
use moorline::model::End;
use moorline::scene::{Integrator, Scene};
use moorline::simulation::Simulation;
use nalgebra::Vector3;

/// A chain of 100 m over a horizontal span of 60 m between points 20 m apart in height, with these keys of the line and of the scene.
fn chain(keys: &str, surroundings: &str) -> Scene {
    draft(format!(
        "line_types.chain = {{ mass = 20.0, diameter = 0.05, axial_stiffness = 1.0e6, drag_normal = 1.2, drag_tangential = 0.1 }}
        {surroundings}"
    ))
    .fixed("anchor", [0.0, 0.0, -60.0])
    .coupled("fairlead", [60.0, 0.0, -40.0])
    .line("line1", ["anchor", "fairlead"], "chain", 100.0, 25)
    .with(keys)
    .scene()
}

/// Starts a simulation of this chain with an integrator and steps of at most `step` [s].
fn started(keys: &str, integrator: Integrator, step: f64) -> Simulation {
    start(&balanced(with_integrator(chain(keys, ""), integrator, step)))
}

/// Asserts that the error of the energy balance is below 2 % of the kinetic energy.
fn assert_balanced(simulation: &Simulation) {
    let (error, kinetic) = (balance_error(simulation).abs(), simulation.energy().kinetic);
    assert!(error < 2e-2 * kinetic, "{error} of {kinetic} J");
}

#[test]
fn a_chain_that_is_released_at_both_ends_falls_freely() {
    for integrator in INTEGRATORS {
        let mut simulation = started(
            "release = 'b', break = { at = 'a', time = 0.0 }",
            integrator,
            1e-3,
        );
        let mass = simulation.model().lines[0].nodes.mass.clone();
        let centre = |simulation: &Simulation| {
            let moment: f64 = nodes(simulation).iter().zip(&mass).map(|(r, m)| r.z * m).sum();
            moment / mass.iter().sum::<f64>()
        };
        let first = centre(&simulation);
        simulation.set_release(0, true);
        run(&mut simulation, 0.05, 20);
        assert_eq!(simulation.released(0), [true, true]);
        assert_relative_eq!(first - centre(&simulation), 0.5 * G, max_relative = 4e-3);
        assert_balanced(&simulation);
    }
}

#[test]
fn a_point_feels_nothing_of_a_line_that_was_released() {
    for integrator in INTEGRATORS {
        let mut simulation = started("release = 'b'", integrator, 1e-3);
        assert!(simulation.tension_b(0) > 1e3);
        simulation.advance(0.1).unwrap();
        assert_eq!(simulation.released(0), [false, false]);
        simulation.set_release(0, true);
        simulation.advance(0.1).unwrap();
        assert_eq!(simulation.end_force(1), [0.0; 3]);
        assert!(simulation.line_end_force(0, End::A).norm() > 100.0);
        simulation.set_release(0, false);
        simulation.advance(0.1).unwrap();
        assert_eq!(simulation.released(0), [false, true], "for good");
    }
}

#[test]
fn the_energy_balance_closes_through_a_break() {
    let surroundings = "water = { density = 1025.0 }
        seabed = { depth = 60.0 }
        motion.fairlead = { x = [[2.0, 6.0]], z = [[2.0, 5.0]] }";
    for integrator in INTEGRATORS {
        let scene = chain("break = { at = 'b', time = 2.0 }", surroundings);
        let mut simulation = following(&balanced(with_integrator(scene, integrator, 1e-3)));
        let mut errors = Vec::new();
        for _ in 0..120 {
            simulation.advance(0.05).unwrap();
            errors.push(balance_error(&simulation));
        }
        let lost = flow(&simulation).dissipation;
        let (jump, error) = ((errors[41] - errors[38]).abs(), errors[119].abs());
        println!("{integrator:?}: jump {jump:.3e}, error {error:.3e}, lost {lost:.3e}");
        assert_eq!(simulation.released(0), [false, true]);
        assert!(jump < 5e-3 * lost, "{integrator:?}: {jump} of {lost}");
        assert!(error < 2e-2 * lost, "{integrator:?}: {error} of {lost}");
    }
}

#[test]
fn a_line_breaks_when_its_end_carries_too_much() {
    for integrator in INTEGRATORS {
        let still = started("", integrator, 2e-3).tension_b(0);
        let keys = format!("break = {{ at = 'b', tension = {} }}", 1.5 * still);
        let mut simulation = started(&keys, integrator, 2e-3);
        let (mut step, mut before) = (0, 0.0);
        while simulation.released(0) == [false; 2] {
            step += 1;
            before = simulation.tension_b(0);
            let t = 0.05 * f64::from(step);
            simulation.set_displacement(1, [0.5 * t * t, 0.0, 0.0]);
            simulation.advance(0.05).unwrap();
            assert!(step < 400);
        }
        assert!(step > 10 && before < 1.6 * still, "{step} {before} {still}");
        assert_eq!(simulation.tension_b(0), 0.0);
        assert_eq!(simulation.released(0), [false, true]);
    }
}

#[test]
fn a_taut_bar_snaps_back_behind_the_front_of_a_wave() {
    // until the front arrives, the wall pulls as before: momentum grows as EA ε t, and the part ahead of the front is at rest
    let bar = draft(
        "gravity = 0.0\nline_types.bar = { mass = 10.0, axial_stiffness = 1.0e6, axial_damping = 0.0 }",
    )
    .fixed("wall", [0.0; 3])
    .coupled("tip", [101.0, 0.0, 0.0])
    .line("bar", ["wall", "tip"], "bar", 100.0, 200)
    .with("release = 'b'");
    let (c, strain) = ((1.0e6_f64 / 10.0).sqrt(), 0.01);
    for integrator in INTEGRATORS {
        let mut simulation = start(&with_integrator(bar.scene(), integrator, 2e-4));
        simulation.set_release(0, true);
        simulation.advance(0.5 * 100.0 / c).unwrap();
        let mass = &simulation.model().lines[0].nodes.mass;
        let velocity = simulation.state().lines[0].velocity.iter();
        let momentum: f64 = velocity.zip(mass).map(|(v, m)| v.x * m).sum();
        assert_relative_eq!(momentum, -1.0e6 * strain * 50.0 / c, max_relative = 5e-3);
        assert_relative_eq!(nodes(&simulation)[40].x, 20.2, epsilon = 1e-3);
    }
}

#[test]
fn one_of_two_lines_at_a_free_point_is_released_and_the_other_carries_on() {
    for integrator in JOINED {
        let scene = draft("line_types.rope = { mass = 5.0, axial_stiffness = 1.0e5 }")
            .fixed("left", [-30.0, 0.0, 0.0])
            .fixed("right", [30.0, 0.0, 0.0])
            .free("clump", [0.0, 0.0, -10.0])
            .with("mass = 200.0")
            .line("l", ["left", "clump"], "rope", 35.0, 8)
            .line("r", ["clump", "right"], "rope", 35.0, 8)
            .with("break = { at = 'a', time = 1.0 }")
            .scene();
        let mut simulation = start(&balanced(with_integrator(scene, integrator, 1e-3)));
        run(&mut simulation, 0.05, 40);
        assert_eq!(simulation.released(1), [true, false]);
        let clump = place(&simulation, "clump");
        let [left, right] = [0, 1].map(|line| &simulation.state().lines[line].position);
        assert!((clump - left[8]).norm() < 1e-9 && (clump - right[0]).norm() > 1.0);
        assert_balanced(&simulation);
    }
}

#[test]
fn an_end_that_could_be_released_and_is_not_moves_as_one_that_cannot() {
    let ways = ["", "break = { at = 'a', time = 1.0 }"];
    let cases = INTEGRATORS
        .into_iter()
        .flat_map(|integrator| ways.map(|way| (integrator, way)));
    for ((integrator, way), elements) in cases.flat_map(|case| [4, 24, 25].map(|elements| (case, elements))) {
        let runs = ["", "release = 'b'"].map(|release| {
            let both = if release.is_empty() || way.is_empty() {
                ""
            } else {
                ", "
            };
            let mut scene = chain(&format!("{release}{both}{way}"), "water = { density = 1025.0 }");
            scene.lines[0].sections[0].elements = Some(elements);
            let mut simulation = start(&balanced(with_integrator(scene, integrator, 1e-3)));
            let mut history = Vec::new();
            for step in 1..=40 {
                let t = 0.05 * f64::from(step);
                simulation.set_displacement(1, [t.sin(), 0.0, 0.5 * t * t]);
                simulation.advance(0.05).unwrap();
                history.push(simulation.tension_b(0));
            }
            assert_eq!(simulation.released(0), [!way.is_empty(), false]);
            (history, simulation.energy().total(), balance_error(&simulation))
        });
        let [(held, energy, error), (may, other_energy, other_error)] = &runs;
        for (held, may) in held.iter().zip(may) {
            assert_relative_eq!(held, may, max_relative = 1e-6);
        }
        assert_relative_eq!(energy, other_energy, max_relative = 1e-9);
        assert!((error - other_error).abs() < 1e-9 * energy.abs());
    }
}

#[test]
fn a_release_replays_bit_for_bit_from_a_snapshot() {
    for integrator in INTEGRATORS {
        let scene = chain("release = 'b', break = { at = 'a', time = 0.6 }", "");
        let scene = with_integrator(scene, integrator, 5e-3);
        let mut simulation = start(&scene);
        simulation.advance(0.1).unwrap();
        simulation.set_release(0, true);
        run(&mut simulation, 0.1, 4);
        assert_replays(simulation, start(&scene), |simulation| run(simulation, 0.1, 5));
    }
}

#[test]
fn a_simulation_goes_on_from_a_snapshot_after_a_step_that_grew_without_bound() {
    for integrator in INTEGRATORS {
        let mut simulation = started("break = { at = 'b', time = 0.0 }", integrator, 1e-3);
        let sound = simulation.snapshot().clone();
        simulation.advance(0.1).unwrap();
        let should = simulation.snapshot().clone();
        simulation.restore(sound.clone());
        let count = nodes(&simulation).len();
        let mad: Vec<_> = (0..count).map(|i| Vector3::repeat(1e300 * i as f64)).collect();
        set_node_velocities(&mut simulation, &mad);
        assert!(simulation.advance(0.1).is_err(), "{integrator:?}");
        simulation.restore(sound);
        simulation.advance(0.1).unwrap();
        assert!(*simulation.snapshot() == should, "{integrator:?}");
    }
}

#[test]
fn an_end_that_was_released_moves_at_second_order() {
    // the free end of a hanging line of two elements whose top moves up and down; its lower point carries no force
    let shaken = |step: f64| {
        let rope = draft(
            "line_types.rope = { mass = 20.0, diameter = 0.05, axial_stiffness = 1.0e5 }
            motion.top = { z = [[0.01, 1.0]], ramp = 1.0 }",
        )
        .coupled("top", [0.0; 3])
        .fixed("hand", [0.0, 0.0, -10.0980665])
        .line("line1", ["top", "hand"], "rope", 10.0, 2)
        .with("release = 'b'");
        let mut simulation = following(&with_integrator(rope.scene(), Integrator::GeneralisedAlpha, step));
        simulation.set_release(0, true);
        let end = |_| {
            simulation.advance(0.1).unwrap();
            nodes(&simulation)[2]
        };
        (0..20).map(end).collect::<Vec<Vector3<f64>>>()
    };
    let steps = [0.01, 0.005, 0.0025, 0.00125];
    let exact = shaken(2e-4);
    let errors = steps.map(|step| relative_rms(&shaken(step), &exact));
    assert_order(2.0, &steps, &errors);
}

#[test]
fn an_end_that_may_be_released_limits_the_step_as_the_half_node_that_it_becomes() {
    let limit = |keys: &str| {
        let mut scene = with_integrator(chain(keys, ""), Integrator::Leapfrog, 1.0);
        scene.line_types.get_mut("chain").unwrap().axial_damping = Some(0.0);
        let sections = &mut scene.lines[0].sections;
        let mut short = sections[0].clone();
        (short.length, short.elements) = (1.0, Some(1));
        (sections[0].length, sections[0].elements) = (100.0, Some(10));
        sections.push(short);
        start(&scene).choices().next().unwrap().explicit.step
    };
    // 0.38 · 2/ω, with ω² = 2 Σk/M
    let inner = (2.0 * (1.0e5 + 1.0e6) / (20.0 * 5.5_f64)).sqrt();
    let end = (2.0 * 1.0e6 / (20.0 * 0.5_f64)).sqrt();
    for (keys, omega) in [("", inner), ("release = 'a'", inner), ("release = 'b'", end)] {
        assert_relative_eq!(limit(keys), 0.76 / omega, max_relative = 1e-9);
    }
}
