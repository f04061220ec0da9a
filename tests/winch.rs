//! Winches: lines whose length at the fairlead a host changes.
//!
//!        winch ▣ x_B, prescribed ΔL(t)
//!              │ end segment, 0.4 to 1.5 of its nominal length
//!              ○
//!              │ segments of nominal length
//!              ◆ weight
//!
//! Claims: a weight that is hoisted carries W(1 + a/g); a line at a length change is the line written with that length; what is paid out and hauled in
//! again comes to rest where it was; the ledger closes, at second order in time; a state replays bit for bit.

mod common;

use approx::assert_relative_eq;
use common::*;
use moorline::scene::{Integrator, Rayleigh, Reconstruction, Scene};
use moorline::simulation::Simulation;

const G: f64 = 9.80665;

/// A weight of 2 t on 40 m of rope of 20 kg/m, dry, below a winch, in elements of 2 m.
fn hoist(step: f64) -> Scene {
    let scene = scene(
        r#"
        [line_types.rope]
        mass = 20.0
        axial_stiffness = 2.0e7
        damping_ratio = 0.6 # 0.3 of one of 20 elements
        [[points]]
        name = "weight"
        position = [0.0, 0.0, -40.0]
        kind = "free"
        mass = 2000.0
        [[points]]
        name = "deck"
        position = [0.0, 0.0, 0.0]
        kind = "coupled"
        [[lines]]
        name = "rope"
        from = "weight"
        to = "deck"
        sections = [{ type = "rope", length = 40.0, elements = 20 }]
        winch = { end = "b", length_max = 30.0 }
        "#,
    );
    with_integrator(scene, Integrator::Auto, step)
}

/// A chain of 100 m over a span of 60 m between points 20 m apart in height, over a bed, with these keys of the line.
fn chain(length: f64, elements: usize, keys: &str) -> Scene {
    scene(&format!(
        r#"
        [water]
        density = 1025.0
        [seabed]
        depth = 60.0
        [line_types.chain]
        mass = 20.0
        diameter = 0.05
        axial_stiffness = 1.0e6
        drag_normal = 1.2
        drag_tangential = 0.1
        added_mass_normal = 1.0
        added_mass_tangential = 1.0
        [[points]]
        name = "anchor"
        position = [0.0, 0.0, -60.0]
        kind = "fixed"
        [[points]]
        name = "fairlead"
        position = [60.0, 0.0, -20.0]
        kind = "coupled"
        [[lines]]
        name = "line1"
        from = "anchor"
        to = "fairlead"
        sections = [{{ type = "chain", length = {length}, elements = {elements} }}]
        {keys}
        "#
    ))
}

const WINCH: &str = "winch = { end = \"b\", length_max = 30.0 }";

/// Length paid out [m], its rate [m/s] and acceleration [m/s²] of a winch that takes 8 s to haul in at 0.5 m/s.
fn hauling(t: f64) -> [f64; 3] {
    let (u, speed, time) = ((t / 8.0).min(1.0), 0.5, 8.0);
    let part = u * u * (3.0 - 2.0 * u);
    let gone = time * u * u * u * (1.0 - 0.5 * u) + (t - time).max(0.0);
    let acceleration = 6.0 * u * (1.0 - u) / time;
    [-speed * gone, -speed * part, -speed * acceleration]
}

#[test]
fn a_hoisted_weight_and_its_rope_weigh_what_they_weigh_and_their_inertia() {
    let mut simulation = Simulation::new(&hoist(1e-3)).unwrap();
    assert_relative_eq!(simulation.tension_b(0), 2800.0 * G, max_relative = 1e-9);
    let (mut worst, mut fewest): (f64, usize) = (0.0, 20);
    for step in 0..600 {
        simulation.set_length_change(0, hauling(0.05 * f64::from(step))[0]);
        simulation.advance(0.05).unwrap();
        let [change, rate, acceleration] = hauling(0.05 * f64::from(step + 1));
        let mass = 2000.0 + 20.0 * (40.0 + change);
        // all of it is sped up by −ℓ̈; what passes the winch takes m ℓ̇² off it
        let expected = mass * (G - acceleration) - 20.0 * rate * rate;
        worst = worst.max((simulation.tension_b(0) / expected - 1.0).abs());
        fewest = fewest.min(simulation.model().lines[0].segment_count());
    }
    println!("hoist: {worst:.2e}, {fewest} segments");
    assert!(worst < 1e-3, "{worst}");
    assert_eq!(fewest, 14);
}

#[test]
fn statics_at_a_length_change_are_those_of_the_line_written_with_that_length() {
    for change in [8.0, -8.0, 28.0, -40.0] {
        let mut simulation = Simulation::new(&chain(100.0, 25, WINCH)).unwrap();
        simulation.set_length_change(0, change);
        simulation.restart(0.0).unwrap();
        let elements = (25.0 + change / 4.0) as usize;
        let written = Simulation::new(&chain(100.0 + change, elements, "")).unwrap();
        assert_relative_eq!(simulation.tension_b(0), written.tension_b(0), max_relative = 1e-9);
        assert_relative_eq!(simulation.laid_length(0), written.laid_length(0), epsilon = 1e-6);
    }
}

#[test]
fn a_line_between_two_numbers_of_segments_is_a_line_with_a_segment_of_that_length() {
    for (change, ends) in [(1.5, "5.5"), (2.5, "2.5"), (-1.0, "3.0")] {
        let mut simulation = Simulation::new(&chain(100.0, 25, WINCH)).unwrap();
        simulation.set_length_change(0, change);
        simulation.restart(0.0).unwrap();
        let mut scene = chain(100.0, 25, "");
        let end: f64 = ends.parse().unwrap();
        let rest = 100.0 + change - end;
        scene.lines[0].sections[0].length = rest;
        scene.lines[0].sections[0].elements = Some((rest / 4.0).round() as usize);
        let mut last = scene.lines[0].sections[0].clone();
        (last.length, last.elements) = (end, Some(1));
        scene.lines[0].sections.push(last);
        let written = Simulation::new(&scene).unwrap();
        assert_relative_eq!(simulation.tension_b(0), written.tension_b(0), max_relative = 1e-9);
    }
}

#[test]
fn what_is_paid_out_and_hauled_in_again_comes_to_rest_where_it_was() {
    let mut scene = with_integrator(chain(100.0, 25, WINCH), Integrator::Leapfrog, 5e-3);
    let kind = scene.line_types.get_mut("chain").unwrap();
    kind.rayleigh = Some(Rayleigh {
        ratios: [0.5, 0.5],
        frequencies: [0.5, 2.0],
    });
    kind.axial_damping = None;
    let mut simulation = Simulation::new(&scene).unwrap();
    let start = (
        simulation.tension_b(0),
        simulation.state().lines[0].position.clone(),
    );
    let mut seen = 0;
    for step in 0..1600 {
        let t = 0.1 * f64::from(step);
        let part = (std::f64::consts::PI * t.min(40.0) / 40.0).sin();
        simulation.set_length_change(0, 10.0 * part * part);
        simulation.advance(0.1).unwrap();
        seen = seen.max(simulation.state().lines[0].position.len());
    }
    assert!(seen > start.1.len() + 1, "{seen}");
    assert_relative_eq!(simulation.tension_b(0), start.0, max_relative = 1e-6);
    let nodes = &simulation.state().lines[0].position;
    assert_eq!(nodes.len(), start.1.len());
    let moved = nodes.iter().zip(&start.1).map(|(a, b)| (a - b).norm());
    let moved = moved.fold(0.0, f64::max);
    assert!(moved < 1e-4, "{moved:e} m");
}

/// Error of the ledger over the energy that was given in 20 s of paying out and hauling in while the fairlead sways, at a step [s].
fn ledger_error(step: f64) -> f64 {
    let keys = "winch = { end = \"b\", length_max = 30.0, path = { step = [1.0, 0.0, 15.0, 9.0] } }\n\
                [motion]\nfairlead = { x = [[1.0, 6.0]], z = [[1.0, 5.0]], ramp = 5.0 }";
    let scene = with_integrator(chain(100.0, 25, keys), Integrator::Leapfrog, step);
    let mut simulation = following(&scene);
    let mut worst: f64 = 0.0;
    for _ in 0..200 {
        simulation.advance(0.1).unwrap();
        worst = worst.max(simulation.energy_error().abs());
    }
    assert!(simulation.state().lines[0].position.len() > 26);
    worst / simulation.ledger().flow.lost
}

#[test]
fn the_ledger_closes_through_splits() {
    let errors = [4e-3, 2e-3, 1e-3, 5e-4].map(ledger_error);
    println!("ledger: {errors:?}");
    assert!(
        errors[0] > 2.5 * errors[1] && errors[1] > 2.5 * errors[2],
        "{errors:?}"
    );
    assert!(errors[0] < 1e-5 && errors[3] < 3e-7, "{errors:?}");
}

/// Error of the ledger over what was lost in 10 s of paying out while the fairlead jumps every 0.1 s, at a step [s].
fn jumping_ledger_error(step: f64) -> f64 {
    let mut scene = with_integrator(chain(100.0, 25, WINCH), Integrator::Leapfrog, step);
    scene.solver.input_reconstruction = Reconstruction::Jump;
    let mut simulation = Simulation::new(&scene).unwrap();
    for step in 0..100 {
        let t = 0.1 * f64::from(step);
        simulation.set_displacement(1, [(1.1 * t).sin(), 0.0, (1.3 * t).sin()]);
        simulation.set_length_change(0, 0.9 * t);
        simulation.advance(0.1).unwrap();
    }
    simulation.energy_error().abs() / simulation.ledger().flow.lost
}

#[test]
fn the_ledger_closes_where_a_winch_jumps() {
    let errors = [2e-3, 1e-3, 5e-4, 2.5e-4].map(jumping_ledger_error);
    println!("ledger, jumps: {errors:?}");
    assert!(errors[0] < 0.05 && errors[3] < 2e-3, "{errors:?}");
}

/// Tension at the fairlead [N] every 0.1 s of 20 s in which the fairlead sways above a deep bed and the winch pays out a length [m], at a step [s].
fn paying_out(change: f64, step: f64) -> History {
    let keys = format!(
        "winch = {{ end = \"b\", length_max = 30.0, path = {{ step = [1.0, 0.0, 15.0, {change}] }} }}\n\
         [motion]\nfairlead = {{ x = [[1.0, 6.0]], z = [[1.0, 5.0]], ramp = 5.0 }}"
    );
    let mut scene = with_integrator(chain(100.0, 25, &keys), Integrator::Leapfrog, step);
    scene.seabed = None;
    let kind = scene.line_types.get_mut("chain").unwrap();
    kind.axial_damping = Some(0.0); // it is taken with the velocity before, at first order
    History::record(&mut following(&scene), 0.1, 200)
}

#[test]
fn the_error_of_the_tension_falls_with_the_step_as_it_does_without_a_winch() {
    let steps = [4e-3, 2e-3, 1e-3, 5e-4];
    let orders = [0.0, 1.9, 9.0].map(|change| {
        let reference = paying_out(change, 6.25e-5);
        let errors = steps.map(|step| paying_out(change, step).tension_error(&reference, 200));
        println!("{change} m: order {:.2}, {errors:.7?}", order(&steps, &errors));
        order(&steps, &errors)
    });
    assert!(orders[1] > orders[0] - 0.1, "{orders:?}");
    // splits fall on the grid of the steps, at first order where it is fine
    assert!(orders[2] > 1.3, "through two splits: {orders:?}");
}

/// Greatest change of the tension within 0.02 s, over the tension, of a chain of so many elements that hangs freely while the winch winds a
/// length [m] in 40 s [-].
fn ripple(change: f64, elements: usize) -> f64 {
    let keys = format!(
        "winch = {{ end = \"b\", length_max = 30.0, path = {{ step = [0.0, 0.0, 40.0, {change}] }} }}"
    );
    let mut scene = with_integrator(chain(100.0, elements, &keys), Integrator::Leapfrog, 1e-3);
    scene.seabed = None;
    let mut simulation = following(&scene);
    let (mut before, mut worst) = (simulation.tension_b(0), 0.0_f64);
    for _ in 0..2000 {
        simulation.advance(0.02).unwrap();
        let now = simulation.tension_b(0);
        worst = worst.max((now / before - 1.0).abs());
        before = now;
    }
    worst
}

#[test]
fn what_is_felt_of_splits_and_merges_vanishes_as_elements_get_shorter() {
    for change in [10.0, -10.0] {
        let [coarse, middle, fine] = [20, 40, 80].map(|elements| ripple(change, elements));
        println!("{change} m: ripples of {coarse:.1e}, {middle:.1e}, {fine:.1e}");
        assert!(coarse < 0.06 && middle < 0.03 && fine < 0.01);
    }
}

#[test]
fn a_winch_replays_bit_for_bit_from_a_snapshot() {
    let scene = with_integrator(chain(100.0, 25, WINCH), Integrator::Leapfrog, 5e-3);
    let mut simulation = Simulation::new(&scene).unwrap();
    let run = |simulation: &mut Simulation, from: i32, to: i32| {
        for step in from..to {
            simulation.set_length_change(0, 0.1 * f64::from(step));
            simulation.advance(0.1).unwrap();
        }
    };
    run(&mut simulation, 0, 17);
    let bytes = postcard::to_stdvec(simulation.snapshot()).unwrap();
    run(&mut simulation, 17, 60);
    let first = (simulation.state().clone(), simulation.tension_b(0));
    let mut other = Simulation::new(&scene).unwrap();
    other.restore(postcard::from_bytes(&bytes).unwrap());
    run(&mut other, 17, 60);
    assert_eq!((other.state().clone(), other.tension_b(0)), first);
}

#[test]
fn a_winch_that_is_told_to_hurry_goes_at_its_own_speed() {
    let keys = "winch = { end = \"b\", length_max = 30.0, speed_max = 0.5 }";
    let scene = with_integrator(chain(100.0, 25, keys), Integrator::Leapfrog, 5e-3);
    let mut simulation = Simulation::new(&scene).unwrap();
    simulation.set_length_change(0, 10.0);
    (0..100).for_each(|_| simulation.advance(0.1).unwrap());
    let out = simulation.state().lines[0].reel.unwrap();
    assert_relative_eq!(out.change, 5.0, epsilon = 0.06);
    assert_relative_eq!(out.rate, 0.5, epsilon = 1e-6);
}

#[test]
fn a_length_that_the_winch_does_not_have_is_refused_and_leaves_the_state() {
    let scene = with_integrator(chain(100.0, 25, WINCH), Integrator::Leapfrog, 5e-3);
    let mut simulation = Simulation::new(&scene).unwrap();
    let before = simulation.state().clone();
    for wrong in [31.0, -95.0, f64::NAN] {
        simulation.set_length_change(0, wrong);
        let error = simulation.advance(0.1).unwrap_err().to_string();
        assert!(error.contains("winch"), "{error}");
    }
    simulation.set_length_change(0, 0.0);
    assert_eq!(*simulation.state(), before);
}

#[test]
fn what_a_winch_cannot_serve_is_refused() {
    let refused = |text: &str, said: &str| {
        let mistake = Scene::from_toml(text).unwrap_err();
        assert!(mistake.problem.contains(said), "{mistake}");
    };
    let text = chain(100.0, 25, WINCH).to_toml();
    refused(&text.replace("end = \"b\"", "end = \"a\""), "the other way round");
    refused(
        &text.replace("length_max = 30.0", "length_max = -1.0"),
        "not positive",
    );
    refused(
        &text.replace("mass = 20.0", "mass = 20.0\nbending_stiffness = 10.0"),
        "bending",
    );
    let implicit = text.replace("integrator = \"auto\"", "integrator = \"generalised_alpha\"");
    refused(&implicit, "leapfrog");
}

#[test]
fn a_line_on_a_rough_bed_stays_at_rest_and_pays_out_as_on_a_smooth_one() {
    let text = chain(100.0, 25, WINCH).to_toml();
    let text = text.replace("\nfriction = 0.0", "");
    let rough = Scene::from_toml(&text.replace("[seabed]", "[seabed]\nfriction = 0.5")).unwrap();
    let mut simulation = Simulation::new(&with_integrator(rough, Integrator::Leapfrog, 2e-3)).unwrap();
    let start = simulation.tension_b(0);
    (0..50).for_each(|_| simulation.advance(0.1).unwrap());
    assert_relative_eq!(simulation.tension_b(0), start, max_relative = 1e-9);
    for step in 0..300 {
        simulation.set_length_change(0, 0.02 * f64::from(step));
        simulation.advance(0.1).unwrap();
    }
    let nodes = &simulation.state().lines[0];
    assert_eq!(nodes.anchor.len(), nodes.position.len());
    assert_relative_eq!(simulation.tension_b(0), start, max_relative = 0.1);
}
