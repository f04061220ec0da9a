//! Winches: lines whose length at the fairlead is changed by a host.
//!
//!        winch ▣ x_B, prescribed ΔL(t)
//!              │ end segment, 0.4 to 1.5 of its nominal length
//!              ○
//!              │ segments of nominal length
//!              ◆ weight
//!
//! Claims: the tension above a hoisted weight is W(1 + a/g); a line with a length change equals a line written with that length; a line that is
//! paid out and hauled in again returns to its rest position; the energy balance closes, at second order in time; a state replays bit for bit.

use crate::common::*;
use approx::assert_relative_eq;
use moorline::scene::{Integrator, Rayleigh, Reconstruction, Scene};
use moorline::simulation::Simulation;

/// A chain of a length [m] over a horizontal span of 60 m between points 40 m apart in height, over a seabed.
fn chain(length: f64, elements: usize) -> Draft {
    draft(
        "water = { density = 1025.0 }
        seabed = { depth = 60.0 }
        line_types.chain = { mass = 20.0, diameter = 0.05, axial_stiffness = 1.0e6, drag_normal = 1.2, drag_tangential = 0.1,
          added_mass_normal = 1.0, added_mass_tangential = 1.0 }",
    )
    .fixed("anchor", [0.0, 0.0, -60.0])
    .coupled("fairlead", [60.0, 0.0, -20.0])
    .line("line1", ["anchor", "fairlead"], "chain", length, elements)
}

/// The 100 m chain in elements of 4 m with a winch at its fairlead, for the leapfrog with steps of at most `step` [s].
fn wound(step: f64) -> Scene {
    with_integrator(chain(100.0, 25).with(WINCH).scene(), Integrator::Leapfrog, step)
}

/// The chain with `elements` elements, whose winch changes its length by a smooth step from `start` to `end` [s].
fn stepped([start, end]: [f64; 2], change: f64, elements: usize, step: f64) -> Scene {
    let path = format!("path = {{ step = [{start}, 0.0, {end}, {change}] }}");
    let line = chain(100.0, elements).with(&format!("winch = {{ end = 'b', length_max = 30.0, {path} }}"));
    with_integrator(line.scene(), Integrator::Leapfrog, step)
}

const WINCH: &str = "winch = { end = 'b', length_max = 30.0 }";
const SWAY: &str = "motion.fairlead = { x = [[1.0, 6.0]], z = [[1.0, 5.0]], ramp = 5.0 }";

/// Length paid out [m], its rate [m/s] and acceleration [m/s²] of a winch that reaches a hauling speed of 0.5 m/s in 8 s.
fn hauling(t: f64) -> [f64; 3] {
    let (u, speed, time) = ((t / 8.0).min(1.0), 0.5, 8.0);
    let part = u * u * (3.0 - 2.0 * u);
    let gone = time * u * u * u * (1.0 - 0.5 * u) + (t - time).max(0.0);
    let acceleration = 6.0 * u * (1.0 - u) / time;
    [-speed * gone, -speed * part, -speed * acceleration]
}

#[test]
fn a_hoisted_weight_and_its_rope_weigh_what_they_weigh_and_their_inertia() {
    // 2 t on 40 m of rope of 20 kg/m, in air, below a winch, in elements of 2 m; the ratio is 0.3 of that of one of 20 elements
    let hoist = draft("line_types.rope = { mass = 20.0, axial_stiffness = 2.0e7, damping_ratio = 0.6 }")
        .free("weight", [0.0, 0.0, -40.0])
        .with("mass = 2000.0")
        .coupled("deck", [0.0; 3])
        .line("rope", ["weight", "deck"], "rope", 40.0, 20)
        .with(WINCH);
    let mut simulation = start(&with_integrator(hoist.scene(), Integrator::Auto, 1e-3));
    assert_relative_eq!(simulation.tension_b(0), 2800.0 * G, max_relative = 1e-9);
    let (mut worst, mut fewest): (f64, usize) = (0.0, 20);
    for step in 0..600 {
        simulation.set_length_change(0, hauling(0.05 * f64::from(step))[0]);
        simulation.advance(0.05).unwrap();
        let [change, rate, acceleration] = hauling(0.05 * f64::from(step + 1));
        let mass = 2000.0 + 20.0 * (40.0 + change);
        // the whole mass is accelerated by −ℓ̈; the material transport through the winch reduces the tension by m ℓ̇²
        let expected = mass * (G - acceleration) - 20.0 * rate * rate;
        worst = worst.max((simulation.tension_b(0) / expected - 1.0).abs());
        fewest = fewest.min(simulation.model().lines[0].segment_count());
    }
    println!("hoist: {worst:.2e}, {fewest} segments");
    assert!(worst < 1e-3, "{worst}");
    assert_eq!(fewest, 14);
}

#[test]
fn a_rope_that_stands_still_below_a_heaving_winch_has_the_force_of_its_weight() {
    let rope = draft(
        "water = { density = 1025.0 }
        line_types.rope = { mass = 30.0, diameter = 0.15, axial_stiffness = 1.0e7, axial_damping = 1.0e5, drag_tangential = 0.5 }",
    )
    .fixed("anchor", [0.0, 0.0, -60.0])
    .coupled("deck", [0.0, 0.0, -10.0])
    .line("rope", ["anchor", "deck"], "rope", 49.9, 5)
    .with(WINCH);
    let mut scene = with_integrator(rope.scene(), Integrator::Leapfrog, 2e-3);
    scene.solver.input_reconstruction = Reconstruction::Interpolate;
    let mut simulation = start(&scene);
    let (rest, stretch) = (simulation.tension_b(0), 1.0 + simulation.tension_b(0) / 1.0e7);
    let submerged = (30.0 - 1025.0 * std::f64::consts::PI * 0.15 * 0.15 / 4.0) * G;
    let mut worst: f64 = 0.0;
    for step in 1..=240 {
        let heave = 2.0 * (0.04 * f64::from(step)).sin().powi(3);
        simulation.set_displacement(1, [0.0, 0.0, heave]);
        simulation.set_length_change(0, heave / stretch);
        simulation.advance(0.05).unwrap();
        worst = worst.max((simulation.tension_b(0) - rest - submerged * heave).abs());
    }
    // 1600 N with the drag of the half element at the velocity of the deck
    assert!(worst < 0.01 * rest, "{worst} N of {rest} N");
}

/// The chain of 25 elements at rest after a length change [m] by its winch.
fn at_rest_after(change: f64) -> Simulation {
    let mut simulation = chain(100.0, 25).with(WINCH).start();
    simulation.set_length_change(0, change);
    simulation.restart(0.0).unwrap();
    simulation
}

#[test]
fn statics_at_a_length_change_are_those_of_the_line_written_with_that_length() {
    for change in [8.0, -8.0, 28.0, -40.0] {
        let simulation = at_rest_after(change);
        let written = chain(100.0 + change, (25.0 + change / 4.0) as usize).start();
        assert_relative_eq!(simulation.tension_b(0), written.tension_b(0), max_relative = 1e-9);
        assert_relative_eq!(simulation.laid_length(0), written.laid_length(0), epsilon = 1e-6);
    }
}

#[test]
fn a_line_between_two_numbers_of_segments_is_a_line_with_a_segment_of_that_length() {
    for (change, end) in [(1.5, 5.5), (2.5, 2.5), (-1.0, 3.0)] {
        let rest = 100.0 + change - end;
        let mut scene = chain(rest, (rest / 4.0_f64).round() as usize).scene();
        let mut last = scene.lines[0].sections[0].clone();
        (last.length, last.elements) = (end, Some(1));
        scene.lines[0].sections.push(last);
        let (tension, written) = (at_rest_after(change).tension_b(0), start(&scene).tension_b(0));
        assert_relative_eq!(tension, written, max_relative = 1e-9);
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "takes long")]
fn a_line_that_is_paid_out_and_hauled_in_again_comes_to_rest_where_it_was() {
    let mut scene = wound(5e-3);
    let kind = scene.line_types.get_mut("chain").unwrap();
    kind.rayleigh = Some(Rayleigh {
        ratios: [0.5, 0.5],
        frequencies: [0.5, 2.0],
    });
    kind.axial_damping = None;
    let mut simulation = start(&scene);
    let (tension, first) = (simulation.tension_b(0), nodes(&simulation).to_vec());
    let mut seen = 0;
    for step in 0..1600 {
        let t = 0.1 * f64::from(step);
        let part = (std::f64::consts::PI * t.min(40.0) / 40.0).sin();
        simulation.set_length_change(0, 10.0 * part * part);
        simulation.advance(0.1).unwrap();
        seen = seen.max(nodes(&simulation).len());
    }
    assert!(seen > first.len() + 1, "{seen}");
    assert_relative_eq!(simulation.tension_b(0), tension, max_relative = 1e-6);
    let moved = gap(nodes(&simulation), &first);
    assert!(moved < 1e-4, "{moved:e} m");
}

#[test]
fn the_energy_balance_closes_through_splits() {
    // relative to the energy dissipated in 20 s of paying out while the fairlead sways
    let errors = [4e-3, 2e-3, 1e-3, 5e-4].map(|step| {
        let mut simulation = following(&balanced(swaying(stepped([1.0, 15.0], 9.0, 25, step))));
        let mut worst: f64 = 0.0;
        for _ in 0..200 {
            simulation.advance(0.1).unwrap();
            worst = worst.max(balance_error(&simulation).abs());
        }
        assert!(nodes(&simulation).len() > 26);
        worst / flow(&simulation).dissipation
    });
    println!("balance: {errors:?}");
    // second order, but parts of elements that touch down in one step or the next make it irregular
    assert!(
        errors[0] > 12.0 * errors[2] && errors[1] > 12.0 * errors[3],
        "{errors:?}"
    );
    assert!(errors[0] < 4e-5 && errors[3] < 3e-7, "{errors:?}");
}

/// The scene with a fairlead that sways.
fn swaying(mut scene: Scene) -> Scene {
    scene.motion = chain(100.0, 25).and(SWAY).scene().motion;
    scene
}

#[test]
fn the_energy_balance_closes_where_a_winch_jumps() {
    // relative to the energy dissipated in 10 s of paying out while the fairlead jumps every 0.1 s
    let errors = [2e-3, 1e-3, 5e-4, 2.5e-4].map(|step| {
        let mut scene = wound(step);
        scene.solver.input_reconstruction = Reconstruction::Jump;
        let mut simulation = start(&balanced(scene));
        for step in 0..100 {
            let t = 0.1 * f64::from(step);
            simulation.set_displacement(1, [(1.1 * t).sin(), 0.0, (1.3 * t).sin()]);
            simulation.set_length_change(0, 0.9 * t);
            simulation.advance(0.1).unwrap();
        }
        error_of_lost(&simulation)
    });
    println!("balance, jumps: {errors:?}");
    assert!(errors[0] < 0.05 && errors[3] < 2e-3, "{errors:?}");
}

/// Tension at the fairlead [N] every 0.1 s for 20 s, in which the fairlead sways without a seabed and the winch pays out a length [m], at a step [s].
fn paying_out(change: f64, step: f64) -> History {
    let mut scene = swaying(stepped([1.0, 15.0], change, 25, step));
    scene.seabed = None;
    let kind = scene.line_types.get_mut("chain").unwrap();
    kind.axial_damping = Some(0.0); // it is evaluated with the previous velocity, at first order
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
    // splits occur at multiples of the step, which gives first order for short steps
    assert!(orders[2] > 1.3, "through two splits: {orders:?}");
}

#[test]
fn the_ripple_of_splits_and_merges_vanishes_as_elements_get_shorter() {
    // greatest change of the tension within 0.02 s, relative to the tension, of a freely hanging chain
    let ripple = |change: f64, elements: usize| {
        let mut scene = stepped([0.0, 40.0], change, elements, 1e-3);
        scene.seabed = None;
        let tension = History::record(&mut following(&scene), 0.02, 2000).tension;
        greatest(tension.windows(2).map(|pair| (pair[1] / pair[0] - 1.0).abs()))
    };
    for change in [10.0, -10.0] {
        let [coarse, middle, fine] = [20, 40, 80].map(|elements| ripple(change, elements));
        println!("{change} m: ripples of {coarse:.1e}, {middle:.1e}, {fine:.1e}");
        assert!(coarse < 0.06 && middle < 0.03 && fine < 0.01);
    }
}

#[test]
fn a_winch_replays_bit_for_bit_from_a_snapshot() {
    let scene = wound(5e-3);
    let mut simulation = start(&scene);
    let pay_out = |simulation: &mut Simulation, steps: std::ops::Range<i32>| {
        for step in steps {
            simulation.set_length_change(0, 0.1 * f64::from(step));
            simulation.advance(0.1).unwrap();
        }
    };
    pay_out(&mut simulation, 0..17);
    assert_replays(simulation, start(&scene), |simulation| {
        pay_out(simulation, 17..60)
    });
}

#[test]
fn a_winch_that_is_given_a_sudden_length_goes_at_its_own_speed() {
    let line = chain(100.0, 25).with("winch = { end = 'b', length_max = 30.0, speed_max = 0.5 }");
    let mut simulation = start(&with_integrator(line.scene(), Integrator::Leapfrog, 5e-3));
    simulation.set_length_change(0, 10.0);
    run(&mut simulation, 0.1, 100);
    let out = simulation.state().lines[0].winch_state.unwrap();
    assert_relative_eq!(out.change, 5.0, epsilon = 0.06);
    assert_relative_eq!(out.rate, 0.5, epsilon = 1e-6);
}

#[test]
fn a_length_that_the_winch_does_not_have_is_refused_and_leaves_the_state() {
    let mut simulation = start(&wound(5e-3));
    let before = simulation.state().clone();
    for wrong in [31.0, -95.0, f64::NAN] {
        simulation.set_length_change(0, wrong);
        assert_says(&simulation.advance(0.1).unwrap_err().to_string(), &["winch"]);
    }
    simulation.set_length_change(0, 0.0);
    assert_eq!(*simulation.state(), before);
}

#[test]
fn a_path_of_the_scene_beyond_what_the_winch_can_haul_in_is_refused() {
    let hauled = |change: f64| Simulation::new(&stepped([1.0, 2.0], change, 10, 0.01)).map(|_| ());
    let refusal = hauled(-87.0).unwrap_err().to_string();
    assert!(
        refusal.contains("winch.path") && refusal.contains("between -86 m"),
        "{refusal}"
    );
    hauled(-85.0).unwrap();
}

#[test]
fn a_line_on_a_rough_seabed_stays_at_rest_and_pays_out_as_on_a_smooth_one() {
    let text = chain(100.0, 25).with(WINCH).scene().to_toml();
    let text = text.replace("\nfriction = 0.0", "");
    let rough = Scene::from_toml(&text.replace("[seabed]", "[seabed]\nfriction = 0.5")).unwrap();
    let mut simulation = start(&with_integrator(rough, Integrator::Leapfrog, 2e-3));
    let first = simulation.tension_b(0);
    run(&mut simulation, 0.1, 50);
    assert_relative_eq!(simulation.tension_b(0), first, max_relative = 1e-9);
    for step in 0..300 {
        simulation.set_length_change(0, 0.02 * f64::from(step));
        simulation.advance(0.1).unwrap();
    }
    let shape = &simulation.state().lines[0];
    assert_eq!(shape.anchor.len(), shape.position.len());
    assert_relative_eq!(simulation.tension_b(0), first, max_relative = 0.1);
}
