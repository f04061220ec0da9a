//! Coupling of a body with its mooring: mass of the ends, impedance of the next step, derivatives of the forces.

#[path = "../../examples/body_on_spring/host.rs"]
#[expect(dead_code, reason = "the example runs more masters")]
mod host;

use host::{Case, Master, run};
use moorline::model::Body;
use moorline::scene::{ForceOutput, LineEnd, Reconstruction, Scene};
use moorline::simulation::{EndMotion, Simulation};
use nalgebra::{Vector3, Vector6};

const SPRING: f64 = 1e6;

fn oc3() -> Scene {
    Scene::from_toml(include_str!("../../scenes/oc3_catenary.toml")).unwrap()
}

fn case(mass: f64, step: f64) -> Case {
    Case {
        mass,
        spring: SPRING,
        step,
        duration: 40.0,
    }
}

/// RMS of the difference of two runs relative to the RMS of the second, sampled at the steps of the first [-].
fn difference(run: &[Vector3<f64>], truth: &[Vector3<f64>]) -> f64 {
    let each = (truth.len() - 1) / (run.len() - 1);
    let truth: Vec<_> = truth.iter().step_by(each).collect();
    let sum: f64 = run.iter().zip(&truth).map(|(a, b)| (a - *b).norm_squared()).sum();
    let whole: f64 = truth.iter().map(|b| b.norm_squared()).sum();
    (sum / whole).sqrt()
}

/// Error of a body driven by the force of the next step, compared with steps of 1/80 s [-].
fn error_of_one_pass(mass: f64, step: f64) -> f64 {
    let motion = |step: f64| {
        run(&oc3(), "fairlead", Master::Impedance, case(mass, step))
            .unwrap()
            .0
    };
    difference(&motion(step), &motion(0.0125))
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "takes long")]
fn with_the_impedance_of_the_coming_step_bodies_of_any_mass_are_stable_and_accurate() {
    for mass in [10.0, 1e3, 1e5, 1e7] {
        for step in [0.1, 0.05] {
            let error = error_of_one_pass(mass, step);
            assert!(error < 0.01, "{mass} kg, {step} s: {error}");
        }
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "takes long")]
fn with_the_force_of_the_coming_step_the_error_is_of_second_order() {
    for mass in [1e5, 1e7] {
        // compared with steps of 1/80 s: a ratio of (64 − 1)/(16 − 1) = 4.2, or (8 − 1)/(4 − 1) = 2.3 for first order
        let ratio = error_of_one_pass(mass, 0.1) / error_of_one_pass(mass, 0.05);
        assert!((3.7..4.7).contains(&ratio), "{mass} kg: {ratio}");
    }
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "takes long")]
fn newton_with_the_derivatives_takes_three_iterations_where_a_fixed_point_takes_ten() {
    let (by_newton, newton) = run(&oc3(), "fairlead", Master::Newton, case(2e4, 0.1)).unwrap();
    let (by_fixed, fixed) = run(&oc3(), "fairlead", Master::FixedPoint, case(2e4, 0.1)).unwrap();
    assert!(newton <= 3 && fixed >= 10, "{newton} {fixed}");
    assert!(difference(&by_newton, &by_fixed) < 1e-5);
    let (one_pass, _) = run(&oc3(), "fairlead", Master::Impedance, case(2e4, 0.1)).unwrap();
    assert!(difference(&one_pass, &by_newton) < 0.01);
}

/// States of a 33 m chain in 3 m of water: taut, touching down and slack, by the distance of the fairlead [m].
const STATES: [(&str, f64); 3] = [("taut", 32.9), ("touching down", 31.0), ("slack", 24.0)];

fn chain(integrator: &str, span: f64) -> Scene {
    let text = format!(
        "line_types.chain = {{ mass = 0.0818, diameter = 0.0022, axial_stiffness = 1e4, damping_ratio = 0.5, drag_normal = 2.5, drag_tangential = 0.5, added_mass_normal = 3.8 }}
        water = {{ density = 1000.0 }}
        seabed = {{ depth = 3.0 }}
        points = [
            {{ name = 'anchor', position = [0.0, 0.0, -3.0], kind = 'fixed' }},
            {{ name = 'fairlead', position = [{span}, 0.0, 0.0], kind = 'coupled' }},
        ]
        lines = [{{ name = 'line', from = 'anchor', to = 'fairlead', sections = [{{ type = 'chain', length = 33.0, elements = 20 }}] }}]
        solver = {{ integrator = '{integrator}', input_reconstruction = 'interpolate' }}
        output = {{ derivatives = true }}"
    );
    Scene::from_toml(&text).unwrap_or_else(|error| panic!("{error}"))
}

/// Displacement [m] and velocity [m/s] of the fairlead, with a smooth start.
fn motion(t: f64) -> [[f64; 3]; 2] {
    let (sin, cos) = (2.0 * t).sin_cos();
    [
        [0.04, 0.06, 0.08].map(|part| part * (1.0 - cos)),
        [0.08, 0.12, 0.16].map(|part| part * sin),
    ]
}

fn give(simulation: &mut Simulation, [place, velocity]: [[f64; 3]; 2]) {
    simulation.set_displacement(1, place);
    simulation.set_velocity(1, velocity.map(Some));
}

#[test]
fn derivatives_are_those_of_differences_by_save_perturb_step_and_restore() {
    let step = 0.02;
    for integrator in [
        "leapfrog",
        "axial_implicit",
        "generalised_alpha",
        "bossak",
        "quasi_static",
    ] {
        for (state, span) in STATES {
            let mut simulation = Simulation::new(&chain(integrator, span)).unwrap();
            for k in 1..=20 {
                give(&mut simulation, motion(f64::from(k) * step));
                simulation.advance(step).unwrap();
            }
            let start = simulation.snapshot().clone();
            let end = motion(21.0 * step);
            let mut force = |motion| {
                simulation.restore(start.clone());
                give(&mut simulation, motion);
                simulation.advance(step).unwrap();
                Vector3::from(simulation.end_force(1))
            };
            let mut by_hand = Vec::new();
            for (part, by) in [(0, 2e-7), (1, 2e-7 / step)] {
                for axis in 0..3 {
                    let mut at = |by: f64| {
                        let mut moved = end;
                        moved[part][axis] += by;
                        force(moved)
                    };
                    by_hand.push((at(by) - at(-by)) / (2.0 * by));
                }
            }
            force(end);
            let read = |s: &Simulation| Ok(s.end_force(1).to_vec());
            let greatest = [&by_hand[..3], &by_hand[3..]]
                .map(|columns| columns.iter().map(|column| column.norm()).fold(0.0, f64::max));
            for (number, by_hand) in by_hand.iter().enumerate() {
                let motion = EndMotion {
                    body: Body::Point(1),
                    axis: number % 3,
                    is_velocity: number >= 3,
                };
                let found = simulation.derivative(motion, read).unwrap();
                let error = (Vector3::from_column_slice(&found) - by_hand).norm();
                let error = error / greatest[number / 3].max(f64::MIN_POSITIVE);
                assert!(error < 1e-6, "{integrator}, {state}, {number}: {error}");
            }
        }
    }
}

#[test]
fn derivatives_leave_a_run_as_it_is_to_the_last_bit() {
    let mut scene = chain("leapfrog", 31.0);
    let ends = [false, true].map(|derivatives| {
        scene.output.derivatives = derivatives;
        let mut simulation = Simulation::new(&scene).unwrap();
        for k in 1..=20 {
            give(&mut simulation, motion(f64::from(k) * 0.02));
            simulation.advance(0.02).unwrap();
            if derivatives {
                let motion = EndMotion {
                    body: Body::Point(1),
                    axis: 0,
                    is_velocity: false,
                };
                simulation
                    .derivative(motion, |s| Ok(s.end_force(1).to_vec()))
                    .unwrap();
                simulation.impedance(Body::Point(1)).unwrap();
            }
        }
        simulation.end_force(1)
    });
    assert_eq!(ends[0], ends[1]);
}

#[test]
fn the_mass_of_the_end_is_what_its_acceleration_costs() {
    // without waves in the line, the force of a short line is its inertia: F' does not depend on the acceleration
    let mut scene = chain("leapfrog", 31.0);
    scene.output.force = ForceOutput::WithoutInertia;
    let mut simulation = Simulation::new(&scene).unwrap();
    for k in 1..=20 {
        give(&mut simulation, motion(f64::from(k) * 0.02));
        simulation.advance(0.02).unwrap();
    }
    let body = Body::Point(1);
    let mass = simulation.end_mass(body);
    let acceleration = simulation.state().points[1].acceleration;
    let total = Vector3::from(simulation.end_force(1));
    let without: Vector3<f64> = simulation.force_without_inertia(body).fixed_rows::<3>(0).into();
    let inertia = mass.fixed_view::<3, 3>(0, 0) * acceleration;
    assert!((without - total - inertia).norm() < 1e-12 * total.norm());
    assert_eq!(simulation.host_force(body)[..3], without.as_slice()[..]);
    // half an element of chain with normal added mass, at least two thirds of it
    let half = 0.5 * 33.0 / 20.0 * 0.0818;
    assert!(mass[(0, 0)] > 0.6 * half && mass[(1, 1)] < 4.0 * half, "{mass}");
    assert!((mass - mass.transpose()).norm() < 1e-15 * mass.norm());
}

#[test]
fn the_rate_of_a_force_is_that_of_its_history() {
    let mut simulation = Simulation::new(&chain("quasi_static", 31.0)).unwrap();
    let mut history = Vec::new();
    for k in 1..=22 {
        give(&mut simulation, motion(f64::from(k) * 0.01));
        simulation.advance(0.01).unwrap();
        let rate = simulation.rates(|s| Ok(s.end_force(1).to_vec())).unwrap();
        history.push((simulation.end_force(1)[0], rate[0]));
    }
    let [(a, _), (_, rate), (c, _)] = [19, 20, 21].map(|k| history[k]);
    let central = (c - a) / 0.02;
    assert!((rate - central).abs() < 0.01 * central.abs(), "{rate} {central}");
}

#[test]
fn a_rate_does_not_depend_on_the_step_limit_where_the_motion_does_not() {
    for integrator in ["leapfrog", "axial_implicit", "generalised_alpha"] {
        let rate = |time_step_max: f64| {
            let mut scene = chain(integrator, 31.0);
            scene.solver.time_step_max = time_step_max;
            let mut simulation = Simulation::new(&scene).unwrap();
            for k in 1..=20 {
                give(&mut simulation, motion(f64::from(k) * 0.01));
                simulation.advance(0.01).unwrap();
            }
            let force = simulation.end_force(1).to_vec();
            (force, simulation.rates(|s| Ok(s.end_force(1).to_vec())).unwrap())
        };
        // a step shorter by a thousandth would need 10 internal steps instead of 11
        assert_eq!(rate(0.9995e-3), rate(0.95e-3), "{integrator}");
    }
}

#[test]
fn the_force_of_the_coming_step_is_that_after_a_release_even_if_it_was_read_before() {
    let mut scene = chain("leapfrog", 31.0);
    scene.lines[0].release = Some(LineEnd::B);
    let mut simulation = Simulation::new(&scene).unwrap();
    give(&mut simulation, motion(0.02));
    simulation.advance(0.02).unwrap();
    let coming = |simulation: &Simulation| simulation.impedance(Body::Point(1)).unwrap().free.norm();
    assert!(coming(&simulation) > 0.1);
    simulation.set_release(0, true);
    assert_eq!(coming(&simulation), 0.0);
}

/// A vessel with two chains, at a rotated attitude.
fn barge() -> Scene {
    let mut scene = chain("leapfrog", 31.0);
    let text = "line_types.chain = { mass = 0.0818, diameter = 0.0022, axial_stiffness = 1e4, damping_ratio = 0.5, drag_normal = 2.5, added_mass_normal = 3.8 }
        water = { density = 1000.0 }
        seabed = { depth = 3.0 }
        vessels = [{ name = 'barge', position = [0.0, 0.0, 0.0], attitude = [0.1, 0.2, 0.3] }]
        points = [
            { name = 'left', position = [-32.0, 0.0, -3.0], kind = 'fixed' },
            { name = 'right', position = [32.0, 3.0, -3.0], kind = 'fixed' },
            { name = 'port', kind = 'coupled', on = 'barge', position = [-1.0, 0.2, -0.3] },
            { name = 'starboard', kind = 'coupled', on = 'barge', position = [1.0, 0.3, -0.1] },
        ]
        lines = [
            { name = 'one', from = 'left', to = 'port', sections = [{ type = 'chain', length = 33.0, elements = 20 }] },
            { name = 'two', from = 'right', to = 'starboard', sections = [{ type = 'chain', length = 33.0, elements = 20 }] },
        ]";
    let other = Scene::from_toml(text).unwrap_or_else(|error| panic!("{error}"));
    (scene.vessels, scene.points, scene.lines) = (other.vessels, other.points, other.lines);
    scene
}

#[test]
fn one_component_of_the_angular_velocity_is_enough() {
    let turned = |rates: [Option<f64>; 3]| {
        let mut simulation = Simulation::new(&barge()).unwrap();
        for k in 0..10 {
            let yaw = 0.02 * (1.0 - (0.3 * f64::from(k)).cos());
            let [x, y, z] = rates.map(|rate| rate.map(|rate| rate * 0.06 * (0.3 * f64::from(k)).sin()));
            let body = Body::Vessel(0);
            simulation.set_body(body, [0.0, 0.0, 0.0, 0.0, 0.0, yaw], [None, None, None, x, y, z]);
            simulation.advance(0.1).unwrap();
        }
        simulation.vessel_force(0)
    };
    let alone = turned([None, None, Some(1.0)]);
    assert_eq!(alone, turned([Some(0.0), Some(0.0), Some(1.0)]));
    assert_ne!(alone, turned([None; 3]));
}

#[test]
fn the_derivatives_of_a_vessel_are_those_of_its_inputs() {
    let step = 0.02;
    let mut simulation = Simulation::new(&barge()).unwrap();
    let pose = |t: f64| [0.02, -0.03, 0.05, 0.1, -0.15, 0.2].map(|part| part * (2.0 * t).sin());
    let rate = |t: f64| [0.04, -0.06, 0.1, 0.2, -0.3, 0.4].map(|part| part * (2.0 * t).cos());
    for k in 1..=20 {
        let t = f64::from(k) * step;
        simulation.set_body(Body::Vessel(0), pose(t), rate(t).map(Some));
        simulation.advance(step).unwrap();
    }
    let start = simulation.snapshot().clone();
    let end = [pose(0.42), rate(0.42)];
    let mut force = |[pose, rate]: [[f64; 6]; 2]| {
        simulation.restore(start.clone());
        simulation.set_body(Body::Vessel(0), pose, rate.map(Some));
        simulation.advance(step).unwrap();
        Vector6::from(simulation.vessel_force(0))
    };
    let mut by_hand = Vec::new();
    for part in 0..2 {
        let by = [1e-5, 1e-5 / step][part];
        for axis in 0..6 {
            let [below, above] = [-by, by].map(|by| {
                let mut moved = end;
                moved[part][axis] += by;
                force(moved)
            });
            by_hand.push((above - below) / (2.0 * by));
        }
    }
    force(end);
    for (number, by_hand) in by_hand.iter().enumerate() {
        let motion = EndMotion {
            body: Body::Vessel(0),
            axis: number % 6,
            is_velocity: number >= 6,
        };
        let found = simulation
            .derivative(motion, |s| Ok(s.vessel_force(0).to_vec()))
            .unwrap();
        let error = (Vector6::from_column_slice(&found) - by_hand).norm() / by_hand.norm();
        assert!(error < 1e-5, "{number}: {error}");
    }
}

/// Force range and RMS error of the force [N] in the last 60 s, with noise of an amplitude [m] in the displacements every 0.05 s.
fn noise_of_force(reconstruction: Reconstruction, noise: f64) -> [f64; 2] {
    let text = "line_types.chain = { mass = 685.0, diameter = 0.333, axial_stiffness = 3.27e9, damping_ratio = 0.8, drag_normal = 1.1, drag_tangential = 0.2, added_mass_normal = 0.82, added_mass_tangential = 0.27 }
        water = { density = 1025.0 }
        seabed = { depth = 200.0 }
        points = [
            { name = 'anchor', position = [837.6, 0.0, -200.0], kind = 'fixed' },
            { name = 'fairlead', position = [58.0, 0.0, -14.0], kind = 'coupled' },
        ]
        lines = [{ name = 'line', from = 'anchor', to = 'fairlead', sections = [{ type = 'chain', length = 850.0, elements = 40 }] }]";
    let mut scene = Scene::from_toml(text).unwrap_or_else(|error| panic!("{error}"));
    scene.solver.input_reconstruction = reconstruction;
    let step = 0.05;
    let mut runs = [0.0, noise].map(|amplitude| {
        let mut simulation = Simulation::new(&scene).unwrap();
        let mut seed = 1_u64;
        let mut scatter = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            amplitude * 12.0_f64.sqrt() * ((seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5)
        };
        let history = (0..2400).map(|k| {
            let t = f64::from(k) * step;
            let ramp = 0.5 * (1.0 - (std::f64::consts::PI * (t / 20.0).min(1.0)).cos());
            let x = ramp * 3.0 * (std::f64::consts::TAU * t / 11.0).sin();
            let z = ramp * 1.5 * (std::f64::consts::TAU * t / 9.0).sin();
            simulation.set_displacement(1, [x + scatter(), scatter(), z + scatter()]);
            simulation.advance(step).unwrap();
            Vector3::from(simulation.end_force(1))
        });
        history.skip(1200).collect::<Vec<_>>()
    });
    let [quiet, noisy] = &mut runs;
    let sizes = quiet.iter().map(|force| force.norm());
    let range = sizes.clone().fold(0.0, f64::max) - sizes.fold(f64::INFINITY, f64::min);
    let square: f64 = quiet
        .iter()
        .zip(noisy)
        .map(|(a, b)| (a - *b).norm_squared())
        .sum();
    [range, (square / 1200.0).sqrt()]
}

#[test]
fn noise_of_displacements_is_filtered_to_two_hundredths_of_the_range_of_the_force() {
    let [range, plain] = noise_of_force(Reconstruction::Smooth, 1e-4);
    let [filtered_range, filtered] = noise_of_force(Reconstruction::Filtered, 1e-4);
    assert!(filtered < 0.01 * range, "{filtered} of {range}");
    assert!(filtered < 0.5 * plain, "{filtered} {plain}");
    assert!((filtered_range / range - 1.0).abs() < 0.01);
}
