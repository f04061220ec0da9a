//! Orders of convergence, agreement of the integrators with each other, and the motion between communication points.

use crate::common::*;
use moorline::model::Motion;
use moorline::scene::{Integrator, MotionPath, Scene};

const LEAPFROGS: [Integrator; 2] = [Integrator::Leapfrog, Integrator::AxialImplicit];

/// Sampling interval [s].
const SAMPLE: f64 = 0.05;

/// Runs a scene with its own motion for `duration` [s], sampled every [`SAMPLE`].
fn recorded(scene: &Scene, duration: f64) -> History {
    History::record(&mut following(scene), SAMPLE, samples(duration))
}

/// Number of samples in a window of `duration` [s].
fn samples(duration: f64) -> usize {
    (duration / SAMPLE).round() as usize
}

/// A taut line without axial damping, which the leapfrogs evaluate with lagged velocities.
fn undamped(integrator: Integrator, n: usize, step: f64) -> Scene {
    let mut scene = with_integrator(with_elements(shipped("taut_polyester"), n), integrator, step);
    for line_type in scene.line_types.values_mut() {
        line_type.axial_damping = Some(0.0);
    }
    if integrator == Integrator::GeneralisedAlpha {
        scene.solver.spectral_radius = Some(0.5); // less dissipation than the default: second order already at coarser steps
    }
    scene
}

/// Errors of the tension and of the middle node's position over the last third of 30 s.
fn errors(histories: &[History], reference: &History) -> [Vec<f64>; 2] {
    let window = samples(10.0);
    let tension = histories
        .iter()
        .map(|history| history.tension_error(reference, window));
    let middle = histories
        .iter()
        .map(|history| history.middle_error(reference, window));
    [tension.collect(), middle.collect()]
}

#[test]
fn halving_the_time_step_quarters_the_error() {
    let steps = [0.025, 0.0125, 0.00625, 0.003125];
    for integrator in INTEGRATORS {
        let scene = |step| undamped(integrator, 10, step);
        let reference = recorded(&scene(SAMPLE / 256.0), 30.0);
        let found = steps.map(|step| recorded(&scene(step), 30.0));
        for errors in errors(&found, &reference) {
            assert_order(2.0, &steps, &errors);
        }
    }
}

#[test]
fn five_elements_keep_all_but_seven_thousandths_of_the_tension_of_a_taut_rope() {
    let taut = |n| {
        let scene = with_elements(shipped("taut_polyester"), n);
        recorded(&with_integrator(scene, Integrator::AxialImplicit, SAMPLE), 90.0)
    };
    // 0.025 if the load on the end's half element is that at the end, 0.009 if the load is linear
    let error = taut(5).tension_error(&taut(160), samples(60.0));
    assert!(error < 0.007, "{error}");
}

/// The OC3 line with a fifth of its motion, so that it stays taut while nodes touch down and lift off.
fn calm(step: f64) -> Scene {
    let mut scene = with_integrator(shipped("oc3_catenary"), Integrator::AxialImplicit, step);
    if let Some(MotionPath::Harmonic(motion)) = scene.motion.get_mut("fairlead") {
        for sine in motion.x.iter_mut().chain(&mut motion.z) {
            sine[0] *= 0.2;
        }
    }
    scene
}

#[test]
fn halving_the_axial_implicit_step_of_a_line_that_lands_quarters_the_error_at_least() {
    let steps = [0.05, 0.025, 0.0125, 0.00625];
    let reference = recorded(&calm(SAMPLE / 256.0), 60.0);
    let found = steps.map(|step| recorded(&calm(step), 60.0));
    for errors in errors(&found, &reference) {
        assert_order_at_least(2.0, &steps, &errors); // higher, since a decreasing share of the tension is averaged
    }
}

/// A weight that swings on a line, whose short element at the fairlead has a stiff damper, below a fairlead that moves to and fro.
fn swinging(step: f64) -> Scene {
    draft("line_types.rope = { mass = 10.0, axial_stiffness = 5e6, axial_damping = 2e5 }")
        .and("motion.fairlead = { x = [[1.0, 3.0]], ramp = 1.5 }")
        .free("weight", [0.0, 0.0, -5.0])
        .with("mass = 100.0")
        .coupled("fairlead", [0.0; 3])
        .sections(
            "line",
            ["weight", "fairlead"],
            &[("rope", 4.5, Some(5)), ("rope", 0.5, Some(1))],
        )
        .and(&format!(
            "[solver]\nintegrator = 'axial_implicit'\ntime_step_max = {step}"
        ))
        .scene()
}

#[test]
fn halving_the_axial_implicit_step_of_a_damped_element_that_turns_quarters_the_error_of_its_tension() {
    let steps = [0.01, 0.005, 0.0025, 0.00125];
    let reference = recorded(&swinging(SAMPLE / 512.0), 6.0);
    let errors = steps.map(|step| recorded(&swinging(step), 6.0).tension_error(&reference, samples(5.0)));
    assert_order(2.0, &steps, &errors);
}

#[test]
fn a_pendulum_on_a_stiffly_damped_rope_has_the_tension_of_its_height() {
    // T = m g (3 cos θ − 2 cos θ₀), on one element whose damper would turn an error of 1 mm/s along it into 100 N: with projected velocities 330 N
    let (mass, length, start) = (1000.0, 10.0, 0.5_f64);
    let at = [length * start.sin(), 0.0, -length * start.cos()];
    let mut pendulum = draft(
        "line_types.rope = { mass = 0.1, axial_stiffness = 1e8, axial_damping = 1e6 }
        solver = { integrator = 'axial_implicit', time_step_max = 0.05 }",
    )
    .fixed("pivot", [0.0; 3])
    .free("bob", at)
    .with("mass = 1000.0")
    .line("rope", ["pivot", "bob"], "rope", length, 1)
    .with("initial = 'straight'")
    .start();
    let mut square = 0.0;
    for step in 0..220 {
        pendulum.advance(0.05).unwrap();
        let height = -pendulum.state().points[1].position.z / length;
        let expected = mass * 9.80665 * (3.0 * height - 2.0 * start.cos());
        // the first steps follow the unstretched start
        if step >= 20 {
            square += (pendulum.tension_b(0) - expected).powi(2) / 200.0;
        }
    }
    assert!(square.sqrt() < 40.0, "{}", square.sqrt());
}

#[test]
fn lagged_axial_damping_costs_less_than_a_ten_thousandth() {
    // first order in the step, in addition to the second order of all other terms
    let fine = with_elements(shipped("taut_polyester"), 10);
    for integrator in LEAPFROGS {
        let reference = recorded(&with_integrator(fine.clone(), integrator, SAMPLE / 256.0), 30.0);
        let found = recorded(&with_integrator(fine.clone(), integrator, 0.025), 30.0);
        for errors in errors(&[found], &reference) {
            assert!(errors[0] < 1e-4, "{integrator:?}: {errors:?}");
        }
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn halving_the_elements_quarters_the_error() {
    let resolutions = [40, 80, 160, 320]; // coarser meshes do not resolve the second transverse mode
    let sizes = resolutions.map(|n| 1.0 / n as f64);
    let scene = |n| undamped(Integrator::Leapfrog, n, 5e-4);
    let reference = recorded(&scene(1280), 30.0);
    let found = resolutions.map(|n| recorded(&scene(n), 30.0));
    for errors in errors(&found, &reference) {
        assert_order(2.0, &sizes, &errors);
    }
}

#[test]
fn the_public_scenes_run_at_default_settings() {
    for (name, window) in PUBLIC_SCENES {
        let scene = shipped(name);
        let history = recorded(&scene, scene.output.duration);
        let fine = recorded(&with_elements(scene.clone(), 160), scene.output.duration);
        let peak = |of: &History| greatest(last(&of.tension, samples(window)).iter().copied());
        let (found, reference) = (peak(&history), peak(&fine));
        assert!(
            (found / reference - 1.0).abs() < 0.05,
            "{name}: peak {found} N, {reference} N"
        );
    }
}

/// Errors of tension and of the middle node's position [-] over a window [s], for one integrator and step [s] against the explicit leapfrog.
fn apart(scene: &Scene, other: (Integrator, f64), explicit: f64, [duration, window]: [f64; 2]) -> [f64; 2] {
    let [other, explicit] = [other, (Integrator::Leapfrog, explicit)]
        .map(|(integrator, step)| recorded(&with_integrator(scene.clone(), integrator, step), duration));
    [
        other.tension_error(&explicit, samples(window)),
        other.middle_error(&explicit, samples(window)),
    ]
}

#[test]
fn the_implicit_integrator_agrees_with_the_leapfrog_on_a_taut_line_and_on_a_chain_that_lands() {
    for (name, step, bounds) in [
        ("taut_polyester", 0.02, [1e-3, 1e-3]),
        ("oc3_catenary", 0.005, [1e-2, 5e-3]),
    ] {
        let mut scene = with_elements(shipped(name), 20);
        scene.solver.negative_tension = name == "oc3_catenary";
        let [tension, middle] = apart(&scene, (Integrator::GeneralisedAlpha, step), 0.002, [40.0, 20.0]);
        assert!(
            tension < bounds[0] && middle < bounds[1],
            "{name}: {tension} {middle}"
        );
    }
}

/// With the law of other codes, in which damping acts in compression too, on fine meshes.
fn leapfrogs_agree(scenes: &[(&str, f64)], implicit_step: f64) {
    for (name, window) in scenes {
        let mut scene = with_elements(shipped(name), 160);
        scene.solver.negative_tension = true;
        let span = [scene.output.duration, *window];
        let [tension, middle] = apart(&scene, (Integrator::AxialImplicit, implicit_step), 0.05, span);
        assert!(
            tension < 0.01 && middle < 0.005,
            "{name}: {tension:.4} {middle:.4}"
        );
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn the_leapfrogs_agree_on_full_scale_scenes_under_the_peers_law() {
    leapfrogs_agree(&PUBLIC_SCENES[..3], 5e-3);
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn the_leapfrogs_agree_on_snapping_chains_under_the_peers_law() {
    leapfrogs_agree(&PUBLIC_SCENES[3..], 5e-4);
}

/// Inputs set by a host.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Gives {
    Displacements,
    VelocitiesToo,
}

/// RMS error of tension [-] for a host that moves the fairlead every `step` [s], against exact motion with the same internal step.
fn host_error(step: f64, gives: Gives) -> f64 {
    let scene = with_integrator(shipped("oc3_catenary"), Integrator::Leapfrog, 0.00625);
    let sampled = 0.4; // a multiple of all communication steps
    let (count, every) = ((120.0 / sampled) as usize, (sampled / step).round() as usize);
    let motion = Motion::new(&scene.motion["fairlead"]);
    let mut host = start(&scene);
    let fairlead = host.model().point_index("fairlead").unwrap();
    let exact = History::record(&mut following(&scene), sampled, count);
    let mut found = History::default();
    found.sample(&host);
    for sample in 0..count {
        for k in 0..every {
            let place = motion.at((sample * every + k) as f64 * step);
            host.set_displacement(fairlead, place.position.into());
            if gives == Gives::VelocitiesToo {
                host.set_velocity(fairlead, <[f64; 3]>::from(place.velocity).map(Some));
            }
            host.advance(step).unwrap();
        }
        found.sample(&host);
    }
    found.tension_error(&exact, (60.0 / sampled) as usize)
}

#[test]
fn a_host_disturbs_tension_by_less_than_two_per_mille_and_with_velocities_by_half_a_per_mille() {
    for (gives, bound) in [(Gives::Displacements, 0.002), (Gives::VelocitiesToo, 0.0005)] {
        let error = host_error(0.05, gives);
        assert!(error < bound, "{error}");
    }
}

#[test]
fn the_error_of_the_host_motion_falls_at_more_than_second_order() {
    let steps = [0.4, 0.2, 0.1, 0.05];
    for gives in [Gives::Displacements, Gives::VelocitiesToo] {
        let errors = steps.map(|step| host_error(step, gives));
        let found = order(&steps, &errors);
        assert!(found > 2.0, "{gives:?}: order {found}, {errors:?}");
    }
}
