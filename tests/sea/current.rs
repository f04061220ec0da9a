//! Lines in a current: equilibrium of a riser and of a towed cable, invariance in a moving frame, rest, energy, order.
//!
//! ```text
//!      u(z) → ● top            claim: elements at rest -> the cable equation with drag, integrated independently
//!          → ╱                 claim: a line in a current is a line that moves the other way in still water
//!         → │
//!           ● anchor
//! ```

use std::f64::consts::PI;

use crate::common::*;
use approx::assert_relative_eq;
use moorline::model::{End, State};
use moorline::scene::{Current, Integrator, LineModel, MotionPath, PointKind, Scene};
use moorline::simulation::Snapshot;
use nalgebra::{Matrix3, Rotation3, Vector3};

const WEIGHT: f64 = 400.0; // [N/m]
const DIAMETER: f64 = 0.25; // [m]
const STIFFNESS: f64 = 4e7; // EA [N]
const LENGTH: f64 = 206.0; // [m]
const TOP: [f64; 3] = [30.0, -10.0, 0.0];

/// A riser from the seabed at z = −200 m to a point near the surface.
fn riser(elements: usize, current: &str) -> Scene {
    draft(format!(
        "water = {{ density = {RHO}, current = {current} }}
        line_types.riser = {{ mass = 120.0, weight = {WEIGHT}, diameter = {DIAMETER}, axial_stiffness = {STIFFNESS},
          damping_ratio = 0.1, drag_normal = 1.1, drag_tangential = 0.05, added_mass_normal = 1.0 }}"
    ))
    .fixed("well", [0.0, 0.0, -200.0])
    .coupled("top", TOP)
    .line("riser", ["well", "top"], "riser", LENGTH, elements)
    .scene()
}

const SHEARED: &str = "{ profile = [[0.0, 1.1, 0.4], [-50.0, 0.8, 0.1], [-200.0, 0.2, -0.3]], factor = 1.2 }";

/// The same current, programmed independently.
fn sheared(z: f64) -> Vector3<f64> {
    let rows = [[-200.0, 0.2, -0.3], [-50.0, 0.8, 0.1], [0.0, 1.1, 0.4]];
    let pair = rows.windows(2).find(|pair| z <= pair[1][0]);
    let [[z0, x0, y0], [z1, x1, y1]] = pair.map_or([rows[1], rows[2]], |p| [p[0], p[1]]);
    let u = ((z - z0) / (z1 - z0)).clamp(0.0, 1.0);
    1.2 * Vector3::new(x0 + u * (x1 - x0), y0 + u * (y1 - y0), 0.0)
}

/// d(r, Tq)/ds of an elastic cable in the current: r' = (1 + T/EA) q, (T q)' = w ẑ − f.
fn slope([r, pull]: [Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
    let tension = pull.norm();
    let q = pull / tension;
    let u = sheared(r.z);
    let along = u.dot(&q);
    let across = u - along * q;
    let half = 0.5 * RHO * DIAMETER;
    let drag = half * 1.1 * across.norm() * across + half * PI * 0.05 * along.abs() * along * q;
    [(1.0 + tension / STIFFNESS) * q, WEIGHT * Vector3::z() - drag]
}

/// The cable from the well with a given end force [N] there, at every tenth of its length, by the Runge-Kutta method.
fn integrate(pull: Vector3<f64>) -> Vec<[Vector3<f64>; 2]> {
    let count = 20_000;
    let h = LENGTH / f64::from(count);
    let mut y = [Vector3::new(0.0, 0.0, -200.0), pull];
    let mut samples = vec![y];
    let add = |y: [Vector3<f64>; 2], k: [Vector3<f64>; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
    for step in 1..=count {
        let k1 = slope(y);
        let k2 = slope(add(y, k1, 0.5 * h));
        let k3 = slope(add(y, k2, 0.5 * h));
        let k4 = slope(add(y, k3, h));
        for (k, part) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            y = add(y, k, part * h / 6.0);
        }
        if step % (count / 10) == 0 {
            samples.push(y);
        }
    }
    samples
}

/// The cable whose end force at the well makes it end at the top, by Newton's method.
fn shoot() -> Vec<[Vector3<f64>; 2]> {
    let miss = |pull: Vector3<f64>| integrate(pull)[10][0] - Vector3::from(TOP);
    let mut pull = Vector3::new(1e4, 0.0, 6e4);
    for _ in 0..50 {
        let now = miss(pull);
        if now.norm() < 1e-10 {
            break;
        }
        let column = |axis: usize| {
            let mut moved = pull;
            moved[axis] += 0.1;
            (miss(moved) - now) / 0.1
        };
        let jacobian = Matrix3::from_columns(&[column(0), column(1), column(2)]);
        let step = jacobian.lu().solve(&now).unwrap();
        pull -= step * (0.5 * pull.norm() / step.norm()).min(1.0);
    }
    assert!(miss(pull).norm() < 1e-8);
    integrate(pull)
}

/// Positions at every tenth of the length [m], and the force on the well [N].
fn at_rest(elements: usize) -> Vec<Vector3<f64>> {
    let simulation = start(&riser(elements, SHEARED));
    let tenths = (0..=10).map(|i| nodes(&simulation)[i * elements / 10]);
    tenths.chain([simulation.line_end_force(0, End::A)]).collect()
}

#[test]
fn a_riser_in_a_sheared_current_lies_where_the_cable_equation_says() {
    let exact = shoot();
    let expected: Vec<Vector3<f64>> = exact.iter().map(|y| y[0]).chain([exact[0][1]]).collect();
    let error = |found: &[Vector3<f64>]| {
        let scale = |i: usize| if i < 11 { LENGTH } else { expected[i].norm() };
        greatest((0..12).map(|i| (found[i] - expected[i]).norm() / scale(i)))
    };
    let resolutions = [20, 40, 80, 160];
    let errors = resolutions.map(|elements| error(&at_rest(elements)));
    assert_order(-2.0, &resolutions.map(|n| n as f64), &errors);
    let pairs = at_rest(640).into_iter().zip(at_rest(320));
    let extrapolated: Vec<Vector3<f64>> = pairs.map(|(fine, coarse)| fine + (fine - coarse) / 3.0).collect();
    assert!(error(&extrapolated) < 1e-6, "{:e}", error(&extrapolated));
}

#[test]
fn a_cable_with_a_free_end_streams_at_the_angle_of_balance() {
    for (w, d, cdn, cdt, speed) in [
        (10.0, 0.05, 1.2, 0.02, 2.0),
        (50.0, 0.1, 1.0, 0.05, 1.0),
        (0.5, 0.1, 1.0, 0.05, 3.0),
    ] {
        let [cos, sin, pull] = streaming_cable([w, d, cdn, cdt], speed);
        let simulation = draft(format!(
            "water = {{ density = {RHO}, current = {{ velocity = [0.0, -{speed}, 0.0] }} }}
            line_types.rope = {{ mass = 12.0, weight = {w}, diameter = {d}, axial_stiffness = 1e6, axial_damping = 1e4,
              drag_normal = {cdn}, drag_tangential = {cdt} }}"
        ))
        .free("end", [0.0, 0.0, -20.0])
        .coupled("ship", [0.0; 3])
        .line("rope", ["end", "ship"], "rope", 20.0, 10)
        .start();
        for pair in nodes(&simulation).windows(2) {
            let q = (pair[1] - pair[0]).normalize();
            assert_relative_eq!(q.y, cos, epsilon = 1e-9);
            assert_relative_eq!(q.z, sin, epsilon = 1e-9);
        }
        assert_relative_eq!(simulation.tension_b(0), 20.0 * pull, max_relative = 1e-9);
    }
}

const FLOW: [f64; 3] = [0.8, -0.3, 0.2];

/// A sagging line whose top swings, in a current or, towed against the current's direction, in still water.
fn swinging(integrator: Integrator, towed: bool) -> Scene {
    let [x, y, z] = FLOW;
    let mut scene = riser(16, &format!("{{ velocity = [{x}, {y}, {z}] }}"));
    scene = with_integrator(scene, integrator, 0.02);
    // the tables begin early, since their initial slope is zero
    let rows = |swing: f64| {
        let drawn = if towed { 1.0 } else { 0.0 };
        let row = |k: i32| {
            let t = 0.5 * f64::from(k);
            let sway = swing * (0.7 * t).sin();
            let [x, y, z] = [sway - drawn * x * t, -drawn * y * t, 0.5 * sway - drawn * z * t];
            [t, x, y, z, 0.0, 0.0, 0.0]
        };
        MotionPath::Table((-10..=80).map(row).collect())
    };
    scene.points[0].kind = PointKind::Coupled;
    scene.motion.insert("well".into(), rows(0.0));
    scene.motion.insert("top".into(), rows(2.0));
    if towed && let Some(water) = &mut scene.water {
        water.current = None;
    }
    scene
}

/// The state of the first simulation, relative to the water, for the second.
fn boosted(from: &Snapshot, to: &Snapshot) -> Snapshot {
    let flow = Vector3::from(FLOW);
    let [source, mut target] = [from, to].map(|snapshot| serde_json::to_value(snapshot).unwrap());
    let mut state: State = serde_json::from_value(source["state"].clone()).unwrap();
    state.lines[0].velocity.iter_mut().for_each(|v| *v -= flow);
    state.points.iter_mut().for_each(|point| point.velocity -= flow);
    target["state"] = serde_json::to_value(&state).unwrap();
    serde_json::from_value(target).unwrap()
}

#[test]
fn a_line_in_a_current_is_a_line_towed_the_other_way_in_still_water() {
    for integrator in INTEGRATORS {
        let mut anchored = following(&swinging(integrator, false));
        let mut towed = following(&swinging(integrator, true));
        towed.restore(boosted(anchored.snapshot(), towed.snapshot()));
        run(&mut anchored, 0.05, 300);
        run(&mut towed, 0.05, 300);
        let way = Vector3::from(FLOW) * anchored.time();
        let seen: Vec<Vector3<f64>> = nodes(&towed).iter().map(|node| node + way).collect();
        let apart = gap(nodes(&anchored), &seen);
        assert!(apart < 1e-9 * LENGTH, "{integrator:?}: {apart:e} m");
        let [tensions, others] = [&anchored, &towed].map(|simulation| simulation.tensions(0));
        for i in 1..tensions.len() - 1 {
            assert_relative_eq!(tensions[i], others[i], max_relative = 1e-7);
        }
        assert_relative_eq!(anchored.tension_b(0), towed.tension_b(0), max_relative = 1e-7);
    }
}

#[test]
fn a_current_of_no_speed_is_still_water_bit_for_bit() {
    for integrator in INTEGRATORS {
        let mut moving = swinging(integrator, true);
        let mut still = following(&moving);
        let none = Current {
            velocity: Some([0.0; 3]),
            ..Current::default()
        };
        moving.water.as_mut().unwrap().current = Some(none);
        let mut slack = following(&moving);
        for _ in 0..60 {
            still.advance(0.05).unwrap();
            slack.advance(0.05).unwrap();
            for end in [End::A, End::B] {
                assert_eq!(
                    still.line_end_force(0, end),
                    slack.line_end_force(0, end),
                    "{integrator:?}"
                );
            }
        }
        assert_eq!(still.state(), slack.state(), "{integrator:?}");
    }
}

/// A chain on a seabed, two legs of a bridle and a clump at their free point, in a sheared current.
fn system(integrator: Integrator) -> Scene {
    let scene = draft(
        "water = { density = 1025.0, current = { profile = [[0.0, 0.9, 0.5], [-100.0, 0.3, 0.0]] } }
        seabed = { depth = 100.0 }
        line_types.chain = { mass = 120.0, diameter = 0.12, axial_stiffness = 2e8, drag_normal = 1.6, drag_tangential = 0.4,
          added_mass_normal = 1.0, added_mass_tangential = 0.5 }
        line_types.rope = { mass = 20.0, diameter = 0.15, axial_stiffness = 3e7, drag_normal = 1.2, drag_tangential = 0.02,
          added_mass_normal = 1.0 }",
    )
    .fixed("anchor", [-260.0, 0.0, -100.0])
    .free("knot", [-30.0, 0.0, -40.0])
    .with("mass = 800.0, volume = 0.1")
    .coupled("left", [0.0, 15.0, -10.0])
    .coupled("right", [0.0, -15.0, -10.0])
    .line("chain", ["anchor", "knot"], "chain", 250.0, 24)
    .line("one", ["knot", "left"], "rope", 42.0, 8)
    .line("two", ["knot", "right"], "rope", 42.0, 8)
    .scene();
    with_integrator(scene, integrator, 0.02)
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn lines_at_rest_in_a_current_stay_at_rest_for_ten_minutes() {
    let risers = INTEGRATORS.map(|integrator| with_integrator(riser(16, SHEARED), integrator, 0.02));
    for scene in risers.into_iter().chain(JOINED.map(system)) {
        let drift = relative_drift(&scene, 600);
        assert!(drift < 1e-9, "{:?}: {drift:e}", scene.solver.integrator);
    }
}

/// A riser in a current that varies with time.
fn tidal(integrator: Integrator, step: f64) -> Scene {
    let current = "{ profile = [[0.0, 1.4, 0.5], [-50.0, 0.8, 0.1], [-200.0, 0.2, -0.3]], factor = { step = [0.0, 0.2, 8.0, 1.3] } }";
    let mut scene = with_integrator(riser(16, current), integrator, step);
    // the energy of an isotropic added mass does not depend on the orientation of the line
    scene
        .line_types
        .values_mut()
        .for_each(|kind| kind.added_mass_tangential = Some(1.0));
    scene
}

#[test]
fn the_energy_balance_of_a_line_in_a_changing_current_closes_at_second_order_or_at_any_step() {
    for (integrator, coarse) in COARSE_STEPS {
        // the explicit leapfrog closes to 4e-8 at its largest step, limited by the rounding of a hundred thousand sums
        assert_balance_order(integrator, coarse, 1e-6, |step| {
            let mut simulation = start(&balanced(tidal(integrator, step)));
            run(&mut simulation, 0.4, 20);
            let flow = flow(&simulation);
            assert!(flow.external_work > 1e4 && flow.dissipation > 1e4, "{flow:?}");
            error_of_given(&simulation)
        });
    }
}

#[test]
fn halving_the_time_step_quarters_the_error_in_a_changing_current() {
    for (integrator, coarse) in COARSE_STEPS {
        assert_second_order_in_time(coarse, |step| {
            let mut simulation = start(&tidal(integrator, step));
            run(&mut simulation, 0.8, 10);
            nodes(&simulation)[8]
        });
    }
}

#[test]
fn a_quasi_static_line_in_a_current_is_in_the_equilibrium_of_its_elements() {
    let mut scene = riser(16, SHEARED);
    let dynamic = start(&scene);
    scene.solver.integrator = Integrator::QuasiStatic;
    let mut simulation = start(&scene);
    assert_eq!(nodes(&simulation), nodes(&dynamic));
    simulation.set_displacement(1, [4.0, 2.0, 1.0]);
    simulation.advance(1.0).unwrap();
    simulation.set_displacement(1, [0.0; 3]);
    run(&mut simulation, 1.0, 10);
    assert!(gap(nodes(&simulation), nodes(&dynamic)) < 1e-9 * LENGTH);
}

/// A line between two points, slack to taut, over a seabed if requested.
fn span(ratio: f64, weight: f64, seabed: bool, velocity: [f64; 3]) -> Draft {
    let seabed = if seabed { "seabed = { depth = 80.0 }" } else { "" };
    draft(format!(
        "water = {{ density = 1025.0, current = {{ velocity = {velocity:?} }} }}
        {seabed}
        line_types.line = {{ mass = 30.0, weight = {weight}, diameter = 0.12, axial_stiffness = 2e7, drag_normal = 1.2,
          drag_tangential = 0.1 }}"
    ))
    .fixed("low", [0.0, 0.0, -80.0])
    .coupled("high", [100.0, 0.0, 0.0])
    .line("line", ["low", "high"], "line", 128.0 / ratio, 20)
}

#[test]
fn lines_of_every_kind_find_rest_in_every_current() {
    let mut failures = Vec::new();
    let directions = [
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.1, 1.0, 0.0],
        [0.0, -0.6, 0.3],
    ];
    let speeds = [0.05, 0.5, 1.5, 4.0];
    let velocities = speeds
        .iter()
        .flat_map(|speed| directions.map(|axes| axes.map(|c| speed * c)));
    let velocities: Vec<[f64; 3]> = velocities.collect();
    for ratio in [0.6, 0.85, 0.97, 0.999, 1.01] {
        for weight in [800.0, 60.0, 2.0, 0.0, -50.0] {
            for (velocity, seabed) in velocities.iter().flat_map(|v| [(*v, true), (*v, false)]) {
                let scene = span(ratio, weight, seabed, velocity).scene();
                if let Err(error) = moorline::simulation::Simulation::new(&scene) {
                    failures.push(format!("{:?}: {error}", (ratio, weight, seabed, velocity)));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn a_scene_turned_about_the_vertical_with_its_current_rests_alike() {
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.7);
    let mut scene = riser(16, "{ velocity = [0.9, -0.4, 0.1] }");
    let original = start(&scene);
    for point in &mut scene.points {
        point.position = (turn * Vector3::from(point.position)).into();
    }
    let velocity = Some((turn * Vector3::new(0.9, -0.4, 0.1)).into());
    scene.water.as_mut().unwrap().current = Some(Current {
        velocity,
        ..Current::default()
    });
    let image: Vec<Vector3<f64>> = nodes(&original).iter().map(|node| turn * node).collect();
    assert!(gap(&image, nodes(&start(&scene))) < 1e-9 * LENGTH);
}

#[test]
fn a_scene_with_a_current_survives_being_written_and_read() {
    for current in [
        SHEARED,
        "{ velocity = [1.0, 0.0, -0.1], factor = { ramp = [0.0, 0.0, 60.0, 1.0] } }",
    ] {
        let original = riser(4, current);
        let text = original.to_toml();
        assert_eq!(Scene::from_toml(&text).unwrap(), original, "{text}");
    }
}

#[test]
fn a_current_does_not_act_on_beams_and_says_so() {
    let mut by_type = riser(8, SHEARED);
    by_type
        .line_types
        .values_mut()
        .for_each(|kind| kind.model = LineModel::Beam);
    let mut by_integrator = riser(8, SHEARED);
    by_integrator.solver.integrator = Integrator::Beam;
    for scene in [by_type, by_integrator] {
        let mistakes = scene.mistakes();
        let found = mistakes
            .iter()
            .find(|mistake| mistake.at == "water.current")
            .unwrap();
        assert_says(&found.problem, &["beams are modelled in still water only"]);
    }
}

#[test]
fn check_says_which_current_there_is_and_what_is_not_modelled() {
    let words = in_words(&riser(8, SHEARED));
    assert_says(
        &words,
        &[
            "current from (0.2, -0.3) m/s at z = -200 m to (1.1, 0.4) m/s at z = 0 m, linear between 3 depths",
            "with a factor of 1.2",
            "waves and the free surface",
        ],
    );
    assert!(!words.contains("still water"), "{words}");
}

/// A taut rope along a current of 3 m/s, its top moved by a centimetre: drag is stiff compared with axial waves in
/// steps at their stability limit.
fn streaming(water: &str, drag: &str, [amplitude, period]: [f64; 2]) -> Scene {
    draft(format!(
        "water = {{ density = 1025.0{water} }}
        line_types.rope = {{ mass = 16.0, diameter = 0.14, axial_stiffness = 5e6, axial_damping = 4e4, drag_normal = 1.2,
          added_mass_normal = 1.0, {drag} }}
        motion.top = {{ x = [[{amplitude}, {period}]] }}"
    ))
    .fixed("low", [0.0, 0.0, -60.0])
    .coupled("top", [121.0, 0.0, -50.0])
    .line("rope", ["low", "top"], "rope", 120.0, 10)
    .scene()
}

#[test]
fn explicit_steps_stay_stable_where_drag_or_damping_by_mass_is_hard_beside_axial_waves() {
    let current = ", current = { velocity = [3.0, 0.0, 0.0] }";
    let rayleigh = "rayleigh = { ratios = [2.0, 0.5], frequencies = [20.0, 80.0] }";
    let cases = [
        (current, "drag_tangential = 0.3", [0.01, 5.0]),
        ("", rayleigh, [0.05, 2.0]),
    ];
    for (water, drag, move_by) in cases {
        let record = |integrator| {
            let scene = with_integrator(streaming(water, drag, move_by), integrator, 0.05);
            History::record(&mut following(&scene), 0.05, 1000)
        };
        let [explicit, .., implicit] = JOINED.map(record);
        let error = explicit.tension_error(&implicit, 200);
        println!("{drag}: {error:.2e}");
        assert!(error < 0.02, "{drag}: {error}");
    }
}
