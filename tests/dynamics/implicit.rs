//! Fully implicit dynamics: order, dissipation, references, failed steps.

use std::f64::consts::{PI, TAU};

use crate::common::{agm, assert_order, at_reference, continue_from, draft, gap, greatest, statics};
use moorline::dynamics::implicit::{self, Driving, SPECTRAL_RADIUS, Scheme, Span};
use moorline::dynamics::quasi_static;
use moorline::elements::{Counters, Workspace};
use moorline::model::{Kinematics, Model, State};
use nalgebra::Vector3;

/// All prescribed points stay at their positions in the scene.
fn at_rest(model: &Model) -> impl Fn(usize, f64) -> Kinematics {
    swing(model, Vector3::zeros(), 1.0)
}

/// Point "fairlead" moves by `amplitude`·sin⁴(πt/period) [m], with zero initial velocity and acceleration; all others stay.
fn swing(model: &Model, amplitude: Vector3<f64>, period: f64) -> impl Fn(usize, f64) -> Kinematics {
    let reference = at_reference(model);
    let fairlead = model.point_index("fairlead");
    move |point, t| {
        let moved = if Some(point) == fairlead {
            amplitude
        } else {
            Vector3::zeros()
        };
        let w = PI / period;
        let (s, c) = (w * t).sin_cos();
        Kinematics {
            position: reference[point] + s.powi(4) * moved,
            velocity: 4.0 * w * s.powi(3) * c * moved,
            acceleration: 4.0 * w * w * s * s * (3.0 * c * c - s * s) * moved,
            ..Kinematics::default()
        }
    }
}

/// Starts at rest in `state` and runs to `end` in steps of `step` [s].
fn run(
    model: &Model,
    mut state: State,
    held: &impl Fn(usize, f64) -> Kinematics,
    [end, step]: [f64; 2],
    scheme: Scheme,
) -> (State, Counters) {
    let mut work = Workspace::new(model);
    let mut total = Counters::default();
    let span = Span {
        start: 0.0,
        end,
        steps: (end / step - 1e-9).ceil() as usize,
    };
    for number in 0..model.networks.len() {
        implicit::start(model, number, &mut state, held, 0.0, &mut work);
        let driving = Driving {
            kinematics: held,
            scheme: &scheme,
        };
        total += implicit::advance(model, number, &mut state, driving, span, &mut work, |_| {}).unwrap();
    }
    (state, total)
}

/// Greatest distance between corresponding nodes of two states [m].
fn apart(a: &State, b: &State) -> f64 {
    greatest(
        a.lines
            .iter()
            .zip(&b.lines)
            .map(|(a, b)| gap(&a.position, &b.position)),
    )
}

// ------------------------------------------------------------------ order in time

/// A 902 m chain in water, clear of any seabed, from an anchor to a fairlead.
fn chain() -> Model {
    draft(
        "water.density = 1025.0
        line_types.chain = { mass = 77.7, diameter = 0.09, axial_stiffness = 384.243e6, axial_damping = 3.8e6, drag_normal = 1.6,
          drag_tangential = 0.1, added_mass_normal = 1.0, added_mass_tangential = 0.2 }",
    )
    .fixed("anchor", [853.87, 0.0, -320.0])
    .coupled("fairlead", [5.2, 0.0, -70.0])
    .line("line", ["anchor", "fairlead"], "chain", 902.2, 20)
    .model()
}

#[test]
fn halving_the_time_step_quarters_the_error_of_generalised_alpha_and_bossak() {
    let model = chain();
    let start = statics(&model);
    let held = swing(&model, Vector3::new(8.0, 3.0, 4.0), 10.0);
    let steps = [0.1, 0.05, 0.025, 0.0125];
    for scheme in [
        Scheme::generalised_alpha(SPECTRAL_RADIUS),
        Scheme::generalised_alpha(0.5),
        Scheme::generalised_alpha(0.0),
        Scheme::generalised_alpha(1.0),
        Scheme::bossak(-0.1, None),
        Scheme::bossak(-0.3, None),
    ] {
        let (fine, _) = run(&model, start.clone(), &held, [12.0, 0.1 / 256.0], scheme);
        let errors = steps.map(|dt| {
            let (state, counters) = run(&model, start.clone(), &held, [12.0, dt], scheme);
            let few = counters.halvings == 0 && counters.solves <= 5 * counters.steps / 2;
            assert!(few, "{counters:?}");
            apart(&state, &fine)
        });
        println!("{scheme:?}: {errors:?}");
        assert_order(2.0, &steps, &errors);
    }
}

// ------------------------------------------------------------------ pendulum

#[test]
fn a_pendulum_of_large_amplitude_has_its_period() {
    // a mass of 10 kg on a massless line of 1 m: T = 2π √(l/g) / agm(1, cos(θ₀/2))
    let model = draft("gravity = 9.81\nline_types.rod = { mass = 0.0, axial_stiffness = 1.0e9 }")
        .fixed("pivot", [0.0; 3])
        .free("bob", [0.0, 0.0, -1.0])
        .with("mass = 10.0")
        .line("rod", ["pivot", "bob"], "rod", 1.0, 1)
        .model();
    let angle: f64 = 1.0;
    let period = TAU * (1.0 / 9.81_f64).sqrt() / agm(1.0, (0.5 * angle).cos());
    let held = at_rest(&model);
    let mut state = statics(&model);
    state.points[1].position = Vector3::new(angle.sin(), 0.0, -angle.cos());
    state.lines[0].position[1] = state.points[1].position;
    let top_speed = (2.0 * 9.81 * (1.0 - angle.cos())).sqrt();
    let steps = [100.0, 200.0, 400.0, 800.0].map(|n| 0.25 * period / n);
    let errors = steps.map(|dt| {
        let scheme = Scheme::generalised_alpha(0.5);
        let (state, _) = run(&model, state.clone(), &held, [0.25 * period, dt], scheme);
        (state.points[1].position.x / top_speed).abs() / period // error of the period [-]
    });
    assert_order(2.0, &steps, &errors);
    assert!(errors[3] < 1e-6, "{errors:?}");
}

// ------------------------------------------------------------------ snapping and slack

/// A 33 m model chain over a seabed; the motion of its fairlead slackens and snaps it.
fn snapping(axial_stiffness: f64, contact: &str) -> Model {
    draft(format!(
        "water.density = 1000.0
        seabed = {{ depth = 3.0, stiffness = 3.0e8, damping = 1.0e6, contact = '{contact}' }}
        line_types.chain = {{ mass = 0.0818, diameter = 0.0037, axial_stiffness = {axial_stiffness:e}, drag_normal = 2.5,
          drag_tangential = 0.5, added_mass_normal = 3.8 }}"
    ))
    .fixed("anchor", [0.0, 0.0, -3.0])
    .coupled("fairlead", [32.554, 0.0, -0.02])
    .line("line", ["anchor", "fairlead"], "chain", 33.0, 40)
    .model()
}

#[test]
fn a_snapping_chain_stays_bounded_also_a_hundred_times_stiffer() {
    for (axial_stiffness, contact, solves) in [
        (1e4, "regularised", 2.5),
        (1e6, "regularised", 4.0),
        (1e4, "as_given", 10.0),
    ] {
        let model = snapping(axial_stiffness, contact);
        let held = swing(&model, Vector3::new(-0.4, 0.0, 0.4), 1.25);
        let scheme = Scheme::generalised_alpha(SPECTRAL_RADIUS);
        let (state, counters) = run(&model, statics(&model), &held, [20.0, 0.01], scheme);
        let fastest = greatest(state.lines[0].velocity.iter().map(|v| v.norm()));
        assert!(fastest < 2.0, "EA {axial_stiffness}: {fastest} m/s");
        assert!(state.lines[0].position.iter().all(|r| r.z > -3.1 && r.z < 0.5));
        let few = counters.solves as f64 <= solves * 2000.0 && counters.halvings <= 70;
        assert!(few, "EA {axial_stiffness}, {contact}: {counters:?}");
    }
}

/// An undamped cable in air, longer than its span, that falls from a straight line between its ends.
fn falling(axial_stiffness: f64) -> Model {
    draft(format!(
        "line_types.cable = {{ mass = 1.0, axial_stiffness = {axial_stiffness:e} }}"
    ))
    .fixed("left", [0.0; 3])
    .fixed("right", [9.5, 0.0, 0.0])
    .line("cable", ["left", "right"], "cable", 10.0, 20)
    .with("initial = 'straight'")
    .model()
}

/// Kinetic, elastic and potential energy of the only line [J].
fn energy(model: &Model, state: &State) -> f64 {
    let (line, nodes) = (&model.lines[0], &state.lines[0]);
    let (r, v) = (&nodes.position, &nodes.velocity);
    let of_nodes: f64 = (0..r.len())
        .map(|i| 0.5 * line.nodes.mass[i] * v[i].norm_squared() + line.nodes.weight[i] * r[i].z)
        .sum();
    let of_segments: f64 = (0..line.segment_count())
        .map(|i| {
            let (ea, length) = (line.segments.axial_stiffness[i], line.segments.length[i]);
            let strain = ((r[i + 1] - r[i]).norm() / length - 1.0).max(0.0);
            ea * length * line.segments.law[i].at(strain).energy
        })
        .sum();
    of_nodes + of_segments
}

/// Energies of a falling cable [J].
struct Fall {
    /// At rest at the end.
    lowest: f64,
    /// In the straight initial shape.
    first: f64,
    /// After every step.
    then: Vec<f64>,
}

/// Lets a cable fall for `steps` steps of 10 ms.
fn fall(model: &Model, scheme: Scheme, steps: usize) -> Fall {
    let held = at_rest(model);
    let mut state = statics(model);
    let lowest = energy(model, &state);
    state.lines[0].position = model.lines[0]
        .given_shape([Vector3::zeros(), Vector3::new(9.5, 0.0, 0.0)])
        .unwrap();
    let first = energy(model, &state);
    let mut work = Workspace::new(model);
    implicit::start(model, 0, &mut state, &held, 0.0, &mut work);
    let freely = (state.lines[0].acceleration[7].z + model.gravity).abs() < 1e-9;
    assert!(freely, "it falls freely at first");
    let step = |number: usize| {
        let [start, end] = [number, number + 1].map(|n| 0.01 * n as f64);
        let span = Span { start, end, steps: 1 };
        let driving = Driving {
            kinematics: &held,
            scheme: &scheme,
        };
        implicit::advance(model, 0, &mut state, driving, span, &mut work, |_| {}).unwrap();
        energy(model, &state)
    };
    Fall {
        lowest,
        first,
        then: (0..steps).map(step).collect(),
    }
}

#[test]
fn a_falling_cable_that_snaps_taut_gains_less_than_a_thousandth_of_the_energy_of_its_drop() {
    for axial_stiffness in [1e4, 1e6, 1e8] {
        let model = falling(axial_stiffness);
        let fall = fall(&model, Scheme::generalised_alpha(SPECTRAL_RADIUS), 1000);
        let drop = fall.first - fall.lowest;
        let gain = fall.then.iter().copied().fold(f64::MIN, f64::max) - fall.first;
        assert!(
            gain < 1e-3 * drop,
            "EA {axial_stiffness}: {} J grew by {gain} J",
            fall.first
        );
        let left = fall.then[999] - fall.lowest;
        assert!(left < 0.9 * drop, "EA {axial_stiffness}: nothing was lost");
    }
}

#[test]
fn no_snap_makes_a_thousandth_of_energy_by_any_dissipation_and_without_it_none_is_lost() {
    for axial_stiffness in [1e4, 1e6] {
        let mut model = falling(axial_stiffness);
        model.lines[0].segments.axial_damping.fill(0.0);
        for scheme in [
            Scheme::generalised_alpha(0.5),
            Scheme::generalised_alpha(0.8),
            Scheme::generalised_alpha(1.0),
            Scheme::bossak(-0.1, None),
            Scheme::bossak(-0.3, None),
        ] {
            let lossless = scheme == Scheme::generalised_alpha(1.0);
            let case = format!("EA {axial_stiffness}, {scheme:?}");
            let fall = fall(&model, scheme, 500);
            for energy in fall.then {
                let kept = (energy - fall.lowest) / (fall.first - fall.lowest);
                assert!(kept < 1.001, "{case}: {kept} of the energy");
                assert!(!lossless || kept > 0.999, "{case}: {kept} of the energy");
            }
        }
    }
}

#[test]
fn released_from_a_straight_line_a_damped_cable_tends_to_its_equilibrium() {
    let model = draft(
        "line_types.cable = { weight = 0.49, axial_stiffness = 2505.0, rayleigh = { ratios = [0.5, 0.5], frequencies = [3.0, 30.0] } }",
    )
    .fixed("a", [0.0; 3])
    .fixed("b", [14.1421, 0.0, 0.0])
    .line("cable", ["a", "b"], "cable", 14.1421, 22)
    .with("initial = 'straight'")
    .model();
    let mut state = statics(&model);
    let end = Vector3::new(14.1421, 0.0, 0.0);
    state.lines[0].position = model.lines[0].given_shape([Vector3::zeros(), end]).unwrap();
    let held = at_rest(&model);
    let (state, counters) = run(&model, state, &held, [40.0, 0.02], Scheme::generalised_alpha(0.5));
    let sag = -state.lines[0].position[11].z;
    assert!((sag - 0.718_274_162_1).abs() < 1e-6, "{sag}");
    assert!(
        counters.halvings == 0 && counters.solves <= 3 * counters.steps,
        "{counters:?}"
    );
}

// ------------------------------------------------------------------ networks

#[test]
fn splitting_a_line_at_a_free_point_changes_nothing() {
    // a line in air above a seabed, in one piece or in two joined at a free point
    let ends = draft(
        "seabed = { depth = 3.0, stiffness = 2.0e5, damping = 4.0e4, contact = 'as_given' }
        line_types.cable = { mass = 30.0, diameter = 0.05, axial_stiffness = 1.0e6, axial_damping = 1.0e4 }",
    )
    .fixed("anchor", [0.0, 0.0, -3.0])
    .coupled("fairlead", [10.0, 0.0, 0.0]);
    let whole = ends
        .clone()
        .line("whole", ["anchor", "fairlead"], "cable", 12.0, 12);
    let split = ends
        .free("joint", [5.0, 0.0, -2.0])
        .line("upper", ["joint", "fairlead"], "cable", 4.0, 4)
        .line("lower", ["anchor", "joint"], "cable", 8.0, 8);
    let [one, two] = [whole, split].map(|draft| {
        let model = draft.model();
        let held = swing(&model, Vector3::new(0.3, 0.2, 0.4), 3.0);
        run(
            &model,
            statics(&model),
            &held,
            [5.0, 0.01],
            Scheme::generalised_alpha(0.5),
        )
        .0
    });
    let nodes = &one.lines[0].position;
    assert!(gap(&nodes[..9], &two.lines[1].position) < 1e-6);
    assert!(gap(&nodes[8..], &two.lines[0].position) < 1e-6);
}

// ------------------------------------------------------------------ failure, bookkeeping, quasi-statics

#[test]
fn a_step_that_fails_leaves_the_state_as_it_was_and_says_where() {
    let model = chain();
    let mut work = Workspace::new(&model);
    let mut state = statics(&model);
    let held = swing(&model, Vector3::zeros(), 1.0);
    let broken = |point: usize, t: f64| {
        let mut k = held(point, t);
        if t > 0.55 {
            k.position.x = f64::NAN;
        }
        k
    };
    implicit::start(&model, 0, &mut state, &broken, 0.0, &mut work);
    let before = state.clone();
    let scheme = Scheme::generalised_alpha(0.5);
    let span = Span {
        start: 0.0,
        end: 1.0,
        steps: 10,
    };
    let driving = Driving {
        kinematics: &broken,
        scheme: &scheme,
    };
    let error = implicit::advance(&model, 0, &mut state, driving, span, &mut work, |_| {}).unwrap_err();
    assert_eq!(state, before);
    assert!((error.time - 0.55).abs() < 1e-3, "{error}");
    assert!(error.to_string().contains("line \"line\""), "{error}");
}

#[test]
fn a_span_is_cut_into_equal_steps_of_at_most_the_given_size() {
    let model = chain();
    let held = at_rest(&model);
    for (span, dt, steps) in [(1.0, 0.1, 10), (1.0, 0.3, 4), (0.3, 0.1, 3), (0.05, 1.0, 1)] {
        let scheme = Scheme::generalised_alpha(0.5);
        let (_, counters) = run(&model, statics(&model), &held, [span, dt], scheme);
        assert_eq!(counters.steps, steps);
    }
}

#[test]
fn a_line_in_equilibrium_stays_there_with_one_solve_a_step() {
    let model = chain();
    let start = statics(&model);
    let scheme = Scheme::generalised_alpha(0.5);
    let (state, counters) = run(&model, start.clone(), &at_rest(&model), [10.0, 0.1], scheme);
    assert!(apart(&state, &start) < 1e-7);
    assert_eq!(
        (counters.steps, counters.solves, counters.halvings),
        (100, 100, 0)
    );
}

#[test]
fn slow_motion_is_quasi_static() {
    let model = chain();
    let held = swing(&model, Vector3::new(5.0, 0.0, 2.0), 4000.0);
    let scheme = Scheme::generalised_alpha(0.5);
    let (moving, _) = run(&model, statics(&model), &held, [1000.0, 0.5], scheme);
    let mut work = Workspace::new(&model);
    let mut resting = statics(&model);
    for step in 0..20 {
        let span = [50.0 * step as f64, 50.0 * (step + 1) as f64];
        quasi_static::advance(&model, 0, &mut resting, &held, span, &mut work).unwrap();
    }
    let fairlead = held(1, 1000.0);
    let mut elements = statics(&model);
    let places = [model.points[0].reference, fairlead.position];
    continue_from(&model, &mut elements, &places, 1000.0, &mut work).unwrap();
    assert!(apart(&moving, &elements) < 1e-3, "{}", apart(&moving, &elements));
    // quasi-static lines are catenaries, from which elements of 45 m differ by 0.1 m
    assert!(apart(&moving, &resting) < 0.15, "{}", apart(&moving, &resting));
    assert!(resting.lines[0].velocity.iter().all(|v| v.norm() == 0.0));
}
