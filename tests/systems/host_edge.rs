//! Hosts with extreme inputs: excessive steps, displacements beyond the scene, too few samples per period.

use std::time::Instant;

use crate::common::{assert_says, scene, set_motion, shipped, start};
use moorline::model::Body;
use moorline::scene::Reconstruction;
use moorline::simulation::{Error, Simulation};

fn by_rules(name: &str) -> Simulation {
    start(&shipped(name))
}

#[test]
fn a_communication_step_without_end_is_refused_at_once_in_waves_as_in_still_water() {
    for name in ["storm_moored_semi", "oc3_catenary"] {
        let mut simulation = by_rules(name);
        let before = simulation.snapshot().clone();
        for step in [1e6, 1e7, 1e9, 1e15] {
            if name == "oc3_catenary" && step < 1e9 {
                continue; // in still water, some of these steps are feasible
            }
            let begun = Instant::now();
            assert_says(
                &simulation.advance(step).unwrap_err().to_string(),
                &["internal steps of"],
            );
            assert!(begun.elapsed().as_secs_f64() < 1.0, "{name}, {step} s");
            assert!(*simulation.snapshot() == before, "{name}, {step} s");
        }
        simulation.advance(0.05).unwrap();
    }
}

#[test]
fn displacements_beyond_a_thousand_times_the_scene_are_refused_before_anything_is_solved() {
    for (name, body) in [("oc3_catenary", "fairlead"), ("storm_moored_semi", "semi")] {
        let mut simulation = by_rules(name);
        simulation.advance(0.05).unwrap();
        let moved = simulation.model().moving(0.0)[0].body;
        let before = simulation.clone();
        for value in [1e7, 1e11, 1e300, f64::INFINITY, f64::NAN] {
            for axis in 0..3 {
                let mut pose = [0.0; 6];
                pose[axis] = value;
                let begun = Instant::now();
                simulation.set_body(moved, pose, [None; 6]);
                let step = simulation.advance(0.05).unwrap_err().to_string();
                let Err(Error::Scene(start)) = simulation.restart(0.0) else {
                    panic!("{name} starts at {value} m");
                };
                let named = format!("{body}.{} = {value:e} m is beyond", ["x", "y", "z"][axis]);
                assert_says(&step, &[&named]);
                assert_says(&start.to_string(), &[&named]);
                assert!(begun.elapsed().as_secs_f64() < 0.5, "{name}, {value} m");
            }
        }
        simulation.set_body(moved, [0.0; 6], [Some(1e12); 6]);
        assert_says(
            &simulation.advance(0.05).unwrap_err().to_string(),
            &["leads beyond"],
        );
        simulation.restore(before.snapshot().clone());
        assert!(simulation.snapshot() == before.snapshot());
    }
}

#[test]
fn angles_beyond_a_thousand_turns_are_refused() {
    let mut simulation = by_rules("storm_moored_semi");
    simulation.set_body(Body::Vessel(0), [0.0, 0.0, 0.0, 0.0, 0.0, 1e5], [None; 6]);
    assert_says(
        &simulation.advance(0.05).unwrap_err().to_string(),
        &["semi.yaw = 1e5 rad is beyond"],
    );
}

/// Result of a host that sets displacements several times per period.
struct Hosted {
    /// Error of the tension relative to its variation [-].
    error: f64,
    /// Greatest value of `solver.input_error` in the second half [-].
    estimate: f64,
    warning: Option<String>,
}

/// RMS error of the tension at B of the first line, over its standard deviation, and its estimate, with displacements set `points` times per `period` [s].
fn hosted(model: &Simulation, period: f64, points: f64, velocities: bool) -> Hosted {
    let (step, end) = (period / points, 12.0 * period + 20.0);
    let [mut exact, mut host] = [model.clone(), model.clone()];
    exact.follow_scene().unwrap();
    set_motion(&mut host, 0.0, velocities);
    host.restart(0.0).unwrap();
    let ahead = match model.model().solver.input_reconstruction {
        Reconstruction::Interpolate => step,
        _ => 0.0,
    };
    let (mut sums, mut estimate, mut warning) = ([0.0; 4], 0.0_f64, None);
    for k in 0..(end / step) as usize {
        set_motion(&mut host, k as f64 * step + ahead, velocities);
        for simulation in [&mut exact, &mut host] {
            simulation.advance(step).unwrap();
        }
        warning = warning.or_else(|| host.input_warning());
        if host.time() > 20.0 + 2.0 * period {
            let tension = exact.tension_b(0);
            let error = host.tension_b(0) - tension;
            let terms = [1.0, tension, tension * tension, error * error];
            (0..4).for_each(|i| sums[i] += terms[i]);
            estimate = estimate.max(host.input_error());
        }
    }
    let [count, sum, squares, errors] = sums;
    let variance = squares / count - (sum / count).powi(2);
    Hosted {
        error: (errors / count / variance).sqrt(),
        estimate,
        warning,
    }
}

/// Error of inputs above which a warning is given [-]: 0.6 of the tolerance of 2 %.
const ALLOWED: f64 = 0.012;

/// Scenes with the shortest period of their motion [s].
const SAMPLED: [(&str, f64); 3] = [
    ("lindahl_fast", 1.25),
    ("oc3_catenary", 9.0),
    ("taut_polyester", 8.0),
];

/// Light lines, whose tension follows the acceleration of their ends. With 21 points the sampling frequency equals that of the lowest axial mode of
/// `lazy_wave`, 2.4 Hz, and with 17 points that of `hanging_riser`, 1.9 Hz: the error of the tension is then as large as its variation.
const LIGHT: [(&str, f64); 3] = [("power_cable", 9.0), ("lazy_wave", 9.0), ("hanging_riser", 9.0)];

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "takes long")]
fn the_estimated_error_of_inputs_is_a_bound_of_that_of_tension() {
    for (name, period) in SAMPLED.into_iter().chain(LIGHT) {
        let model = by_rules(name);
        let cases = [12.0, 17.0, 21.0, 25.0].map(|points| (points, false));
        for (points, velocities) in cases.into_iter().chain([(12.0, true)]) {
            let Hosted {
                error,
                estimate,
                warning,
            } = hosted(&model, period, points, velocities);
            // the estimate is relative to the variation of a tension that includes the error
            let ratio = estimate * error.hypot(1.0) / error;
            println!("{name}, {points} points, velocities {velocities}: {error:.4} estimated {estimate:.4}");
            let what = format!("{name}, {points} points, velocities {velocities}");
            assert!(
                ratio > 0.9 && ratio < 12.0,
                "{what}: {error} estimated {estimate}"
            );
            assert_eq!(warning.is_some(), estimate > ALLOWED, "{what}: {estimate}");
            if let Some(text) = warning {
                assert_eq!(text.contains("or velocities"), !velocities, "{text}");
            }
        }
    }
}

/// A light hose next to the riser of `lazy_wave`, from its hang-off to another floater at rest.
const HOSE: &str = "
    [line_types.hose]
    mass = 60.0
    diameter = 0.25
    axial_stiffness = 1.0e8
    damping_ratio = 0.05
    drag_normal = 1.1
    [[points]]
    name = 'tanker'
    position = [-120.0, 0.0, -20.0]
    kind = 'fixed'
    [[lines]]
    name = 'hose'
    from = 'tanker'
    to = 'hang_off'
    sections = [{ type = 'hose', length = 150.0, elements = 10 }]";

#[test]
fn the_resonance_of_a_line_is_estimated_beside_a_lighter_one_too() {
    let text = include_str!("../../scenes/lazy_wave.toml");
    let both = text.replace("[motion]", &format!("{HOSE}\n[motion]"));
    let [alone, both] = [text, &both[..]].map(|text| hosted(&start(&scene(text)), 9.0, 21.0, false));
    assert!(
        both.error > 1.0 && both.estimate > 0.9 * both.error,
        "{} estimated {}",
        both.error,
        both.estimate
    );
    assert!(
        (both.estimate / alone.estimate - 1.0).abs() < 0.05,
        "{} beside, {} alone",
        both.estimate,
        alone.estimate
    );
}

#[test]
fn a_host_that_samples_finely_or_gives_velocities_is_not_warned() {
    for (name, period) in SAMPLED {
        let model = by_rules(name);
        for (points, velocities) in [(45.0, false), (25.0, true)] {
            let Hosted {
                estimate, warning, ..
            } = hosted(&model, period, points, velocities);
            assert!(estimate < ALLOWED, "{name}, {points} points: {estimate}");
            assert_eq!(warning, None, "{name}");
        }
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "takes long")]
fn the_estimated_error_of_interpolated_displacements_is_a_bound_of_that_of_tension() {
    for (name, period) in SAMPLED.into_iter().chain(LIGHT) {
        let mut scene = shipped(name);
        scene.solver.input_reconstruction = Reconstruction::Interpolate;
        let model = start(&scene);
        for points in [12.0, 17.0, 25.0] {
            let hosted = hosted(&model, period, points, false);
            let (error, estimate) = (hosted.error, hosted.estimate);
            let what = format!("{name}, {points} points: {error} estimated {estimate}");
            println!("{what}");
            assert!(estimate > 0.8 * error && estimate < 20.0 * error, "{what}");
            assert_eq!(hosted.warning.is_some(), estimate > ALLOWED, "{what}");
            if let Some(text) = hosted.warning {
                assert_says(&text, &["too few for the velocities derived from them"]);
                assert!(!text.contains("input_reconstruction"), "{text}");
            }
        }
    }
}

#[test]
fn a_path_that_jumps_has_an_estimated_error_with_a_smooth_path_as_its_cure() {
    for (name, period) in SAMPLED {
        let mut scene = shipped(name);
        scene.solver.input_reconstruction = Reconstruction::Jump;
        let hosted = hosted(&start(&scene), period, 25.0, true);
        let (error, estimate) = (hosted.error, hosted.estimate);
        assert!(
            estimate > error && estimate < 6.0 * error,
            "{name}: {error} estimated {estimate}"
        );
        let cure = "or set solver.input_reconstruction = \"smooth\"";
        assert_says(
            &hosted.warning.unwrap(),
            &["a path that jumps at each of them", cure],
        );
    }
}

#[test]
fn interpolated_motion_with_velocities_is_off_by_the_curvature_of_cubics_at_most() {
    for (name, period) in SAMPLED.into_iter().chain([LIGHT[0]]) {
        let mut scene = shipped(name);
        scene.solver.input_reconstruction = Reconstruction::Interpolate;
        let model = start(&scene);
        for points in [12.0, 17.0] {
            let error = hosted(&model, period, points, true).error;
            let curvature = (std::f64::consts::TAU / points).powi(2) / 12.0;
            let most = 1.2 * curvature; // undamped axial modes add to it
            assert!(error < most, "{name}, {points} points: {error}, {curvature}");
        }
    }
}

#[test]
fn a_body_at_rest_has_no_error_of_inputs() {
    for reconstruction in [Reconstruction::Smooth, Reconstruction::Interpolate] {
        let mut scene = shipped("oc3_catenary");
        scene.solver.input_reconstruction = reconstruction;
        let mut still = start(&scene);
        for k in 0..200 {
            let noise = 1e-9 * f64::from(k * 7919 % 101);
            still.set_displacement(1, [noise, 0.0, 0.0]);
            still.advance(0.1).unwrap();
        }
        assert_eq!(still.input_error(), 0.0, "{reconstruction:?}");
    }
}
