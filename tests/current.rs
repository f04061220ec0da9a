//! Lines in a current: the balance of a riser and of a towed cable, invariance under a moving frame, rest, energy, order.
//!
//! ```text
//!      u(z) → ● top            claim: elements at rest -> the cable equation with drag, integrated independently
//!          → ╱                 claim: a line in a current is a line that moves the other way in still water
//!         → │
//!           ● anchor
//! ```

mod common;

use approx::assert_relative_eq;
use common::*;
use moorline::model::{End, State};
use moorline::scene::{Current, Integrator, LineModel, MotionPath, PointKind, Scene};
use moorline::simulation::{Simulation, Snapshot};
use nalgebra::{Matrix3, Rotation3, Vector3};

const INTEGRATORS: [Integrator; 3] = [
    Integrator::Leapfrog,
    Integrator::AxialImplicit,
    Integrator::GeneralisedAlpha,
];

const DENSITY: f64 = 1025.0;
const WEIGHT: f64 = 400.0; // [N/m]
const DIAMETER: f64 = 0.25; // [m]
const STIFFNESS: f64 = 4e7; // EA [N]
const LENGTH: f64 = 206.0; // [m]
const TOP: [f64; 3] = [30.0, -10.0, 0.0];

/// A riser from the bed at z = −200 m to a point near the surface.
fn riser(elements: usize, current: &str) -> Scene {
    scene(&format!(
        r#"
        water = {{ density = {DENSITY}, current = {current} }}
        line_types.riser = {{ mass = 120.0, weight = {WEIGHT}, diameter = {DIAMETER}, axial_stiffness = {STIFFNESS}, damping_ratio = 0.1, drag_normal = 1.1, drag_tangential = 0.05, added_mass_normal = 1.0 }}
        points = [
          {{ name = "well", position = [0.0, 0.0, -200.0], kind = "fixed" }},
          {{ name = "top", position = [{}, {}, {}], kind = "coupled" }},
        ]
        lines = [{{ name = "riser", from = "well", to = "top", sections = [{{ type = "riser", length = {LENGTH}, elements = {elements} }}] }}]
        "#,
        TOP[0], TOP[1], TOP[2]
    ))
}

const SHEARED: &str = "{ profile = [[0.0, 1.1, 0.4], [-50.0, 0.8, 0.1], [-200.0, 0.2, -0.3]], factor = 1.2 }";

/// The same current, written anew.
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
    let half = 0.5 * DENSITY * DIAMETER;
    let drag =
        half * 1.1 * across.norm() * across + half * std::f64::consts::PI * 0.05 * along.abs() * along * q;
    [(1.0 + tension / STIFFNESS) * q, WEIGHT * Vector3::z() - drag]
}

/// The cable from the well under a pull [N] there, at every tenth of its length, by Runge and Kutta's method.
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

/// The pull at the well for which the cable ends at the top, by Newton's method.
fn shoot() -> Vec<[Vector3<f64>; 2]> {
    let top = Vector3::from(TOP);
    let mut pull = Vector3::new(1e4, 0.0, 6e4);
    for _ in 0..50 {
        let miss = |pull: Vector3<f64>| integrate(pull)[10][0] - top;
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
    let found = integrate(pull);
    assert!((found[10][0] - top).norm() < 1e-8);
    found
}

/// Positions at every tenth of the length, and the force on the well.
fn at_rest(elements: usize) -> Vec<Vector3<f64>> {
    let simulation = Simulation::new(&riser(elements, SHEARED)).unwrap();
    let nodes = &simulation.state().lines[0].position;
    let mut found: Vec<Vector3<f64>> = (0..=10).map(|i| nodes[i * elements / 10]).collect();
    found.push(simulation.line_end_force(0, End::A));
    found
}

#[test]
fn a_riser_in_a_sheared_current_lies_where_the_cable_equation_says() {
    let exact = shoot();
    let mut expected: Vec<Vector3<f64>> = exact.iter().map(|y| y[0]).collect();
    expected.push(exact[0][1]);
    let gap = |found: &[Vector3<f64>]| {
        let gaps = found.iter().zip(&expected);
        gaps.enumerate()
            .map(|(i, (a, b))| (a - b).norm() / if i < 11 { LENGTH } else { b.norm() })
            .fold(0.0, f64::max)
    };
    let resolutions = [20, 40, 80, 160];
    let shapes = resolutions.map(at_rest);
    let errors: Vec<f64> = shapes.iter().map(|shape| gap(shape)).collect();
    assert_order(-2.0, &resolutions.map(|n| n as f64), &errors);
    let extrapolated: Vec<Vector3<f64>> = at_rest(640)
        .iter()
        .zip(&at_rest(320))
        .map(|(fine, coarse)| fine + (fine - coarse) / 3.0)
        .collect();
    assert!(gap(&extrapolated) < 1e-6, "{:e}", gap(&extrapolated));
}

#[test]
fn a_cable_with_a_free_end_streams_at_the_angle_of_balance() {
    // w cos φ = R_n sin²φ: cos φ = ½(√(a² + 4) − a), a = w/R_n; dT/ds = w sin φ + R_t cos²φ, φ from the horizontal
    for (w, d, cdn, cdt, speed) in [
        (10.0, 0.05, 1.2, 0.02, 2.0),
        (50.0, 0.1, 1.0, 0.05, 1.0),
        (0.5, 0.1, 1.0, 0.05, 3.0),
    ] {
        let a = w / (0.5 * DENSITY * d * cdn * speed * speed);
        let cos = 0.5 * (f64::sqrt(a * a + 4.0) - a);
        let sin = (1.0 - cos * cos).sqrt();
        let along = 0.5 * DENSITY * std::f64::consts::PI * d * cdt * speed * speed * cos * cos;
        let length = 20.0;
        let scene = scene(&format!(
            r#"
            water = {{ density = {DENSITY}, current = {{ velocity = [0.0, -{speed}, 0.0] }} }}
            line_types.rope = {{ mass = 12.0, weight = {w}, diameter = {d}, axial_stiffness = 1e6, axial_damping = 1e4, drag_normal = {cdn}, drag_tangential = {cdt} }}
            points = [
              {{ name = "end", position = [0.0, 0.0, -20.0], kind = "free" }},
              {{ name = "ship", position = [0.0, 0.0, 0.0], kind = "coupled" }},
            ]
            lines = [{{ name = "rope", from = "end", to = "ship", sections = [{{ type = "rope", length = {length}, elements = 10 }}] }}]
            "#
        ));
        let simulation = Simulation::new(&scene).unwrap();
        for pair in simulation.state().lines[0].position.windows(2) {
            let q = (pair[1] - pair[0]).normalize();
            assert_relative_eq!(q.y, cos, epsilon = 1e-9);
            assert_relative_eq!(q.z, sin, epsilon = 1e-9);
        }
        assert_relative_eq!(
            simulation.tension_b(0),
            length * (w * sin + along),
            max_relative = 1e-9
        );
    }
}

const FLOW: [f64; 3] = [0.8, -0.3, 0.2];

/// A sagging line whose top swings, in a current or, towed against it, in still water.
fn swinging(integrator: Integrator, towed: bool) -> Scene {
    let [x, y, z] = FLOW;
    let mut scene = riser(16, &format!("{{ velocity = [{x}, {y}, {z}] }}"));
    scene = with_integrator(scene, integrator, 0.02);
    // the tables begin early: their first slope is none
    let rows = |swing: f64| {
        let drawn = if towed { 1.0 } else { 0.0 };
        let row = |k: i32| {
            let t = 0.5 * f64::from(k);
            let sway = swing * (0.7 * t).sin();
            [
                t,
                sway - drawn * x * t,
                -drawn * y * t,
                0.5 * sway - drawn * z * t,
                0.0,
                0.0,
                0.0,
            ]
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

/// The state of the first simulation, seen from the water, for the second.
fn boosted(from: &Snapshot, to: &Snapshot) -> Snapshot {
    let flow = Vector3::from(FLOW);
    let (source, mut target) = (
        serde_json::to_value(from).unwrap(),
        serde_json::to_value(to).unwrap(),
    );
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
        for _ in 0..300 {
            anchored.advance(0.05).unwrap();
            towed.advance(0.05).unwrap();
        }
        let way = Vector3::from(FLOW) * anchored.time();
        let pairs = anchored.state().lines[0]
            .position
            .iter()
            .zip(&towed.state().lines[0].position);
        let apart = pairs.map(|(a, b)| (a - b - way).norm()).fold(0.0, f64::max);
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
        moving.water.as_mut().unwrap().current = Some(Current {
            velocity: Some([0.0; 3]),
            ..Current::default()
        });
        let mut slack = following(&moving);
        for _ in 0..60 {
            still.advance(0.05).unwrap();
            slack.advance(0.05).unwrap();
            for end in [End::A, End::B] {
                let forces = [&still, &slack].map(|run| run.line_end_force(0, end));
                assert_eq!(forces[0], forces[1], "{integrator:?}");
            }
        }
        assert_eq!(still.state(), slack.state(), "{integrator:?}");
    }
}

/// A chain on a bed, two legs of a bridle and a clump at their free point, in a sheared current.
fn system(integrator: Integrator) -> Scene {
    let text = r#"
        water = { density = 1025.0, current = { profile = [[0.0, 0.9, 0.5], [-100.0, 0.3, 0.0]] } }
        seabed = { depth = 100.0 }
        line_types.chain = { mass = 120.0, diameter = 0.12, axial_stiffness = 2e8, drag_normal = 1.6, drag_tangential = 0.4, added_mass_normal = 1.0, added_mass_tangential = 0.5 }
        line_types.rope = { mass = 20.0, diameter = 0.15, axial_stiffness = 3e7, drag_normal = 1.2, drag_tangential = 0.02, added_mass_normal = 1.0 }
        points = [
          { name = "anchor", position = [-260.0, 0.0, -100.0], kind = "fixed" },
          { name = "knot", position = [-30.0, 0.0, -40.0], kind = "free", mass = 800.0, volume = 0.1 },
          { name = "left", position = [0.0, 15.0, -10.0], kind = "coupled" },
          { name = "right", position = [0.0, -15.0, -10.0], kind = "coupled" },
        ]
        lines = [
          { name = "chain", from = "anchor", to = "knot", sections = [{ type = "chain", length = 250.0, elements = 24 }] },
          { name = "one", from = "knot", to = "left", sections = [{ type = "rope", length = 42.0, elements = 8 }] },
          { name = "two", from = "knot", to = "right", sections = [{ type = "rope", length = 42.0, elements = 8 }] },
        ]
    "#;
    with_integrator(scene(text), integrator, 0.02)
}

#[test]
fn lines_at_rest_in_a_current_stay_at_rest_for_ten_minutes() {
    let riser = |integrator| with_integrator(riser(16, SHEARED), integrator, 0.02);
    let cases = [
        (riser(Integrator::Leapfrog), 1.0),
        (riser(Integrator::AxialImplicit), 1.0),
        (riser(Integrator::GeneralisedAlpha), 1.0),
        (system(Integrator::Leapfrog), 1.0),
        (system(Integrator::GeneralisedAlpha), 1.0),
    ];
    for (scene, step) in cases {
        let mut simulation = Simulation::new(&scene).unwrap();
        let start = simulation.state().clone();
        while simulation.time() < 600.0 - 0.5 * step {
            simulation.advance(step).unwrap();
        }
        for (line, shape) in simulation.state().lines.iter().enumerate() {
            let length = simulation.model().lines[line].unstretched_length();
            let pairs = shape.position.iter().zip(&start.lines[line].position);
            let drift = pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            assert!(
                drift < 1e-9 * length,
                "{:?}, line {line}: {drift:e} m",
                scene.solver.integrator
            );
        }
    }
}

/// A riser in a current that comes and goes.
fn tidal(integrator: Integrator, step: f64) -> Scene {
    let current = "{ profile = [[0.0, 1.4, 0.5], [-50.0, 0.8, 0.1], [-200.0, 0.2, -0.3]], factor = { step = [0.0, 0.2, 8.0, 1.3] } }";
    let mut scene = with_integrator(riser(16, current), integrator, step);
    // an added mass alike in all directions has the same energy however the line turns
    scene
        .line_types
        .values_mut()
        .for_each(|line_type| line_type.added_mass_tangential = Some(1.0));
    scene
}

#[test]
fn the_ledger_of_a_line_in_a_changing_current_closes_at_second_order_or_at_any_step() {
    for (integrator, coarse) in [
        (Integrator::Leapfrog, 4e-3),
        (Integrator::AxialImplicit, 4e-2),
        (Integrator::GeneralisedAlpha, 4e-2),
    ] {
        let steps = [1.0, 0.5, 0.25, 0.125].map(|part| part * coarse);
        let errors = steps.map(|step| {
            let mut simulation = Simulation::new(&tidal(integrator, step)).unwrap();
            for _ in 0..20 {
                simulation.advance(0.4).unwrap();
            }
            let flow = &simulation.ledger().flow;
            assert!(flow.given > 1e4 && flow.lost > 1e4, "{flow:?}");
            simulation.energy_error().abs() / flow.given
        });
        assert!(errors[3] < 1e-6, "{integrator:?}: {errors:?}");
        // the explicit leapfrog closes to 4e-8 at its largest step, where the rounding of a hundred thousand sums shows
        match integrator {
            Integrator::AxialImplicit => assert_order(2.0, &steps, &errors),
            Integrator::GeneralisedAlpha => assert!(errors[0] < 1e-8, "{errors:?}"), // what Newton's method leaves
            _ => {}
        }
    }
}

#[test]
fn halving_the_time_step_quarters_the_error_in_a_changing_current() {
    for (integrator, coarse) in [
        (Integrator::Leapfrog, 4e-3),
        (Integrator::AxialImplicit, 4e-2),
        (Integrator::GeneralisedAlpha, 4e-2),
    ] {
        let steps = [1.0, 0.5, 0.25, 0.125, 1.0 / 32.0].map(|part| part * coarse);
        let middles = steps.map(|step| {
            let mut simulation = Simulation::new(&tidal(integrator, step)).unwrap();
            for _ in 0..10 {
                simulation.advance(0.8).unwrap();
            }
            simulation.state().lines[0].position[8]
        });
        let errors: Vec<f64> = middles[..4].iter().map(|m| (m - middles[4]).norm()).collect();
        assert_order(2.0, &steps[..4], &errors);
    }
}

#[test]
fn a_quasi_static_line_in_a_current_is_in_the_equilibrium_of_its_elements() {
    let mut scene = riser(16, SHEARED);
    let dynamic = Simulation::new(&scene).unwrap();
    scene.solver.integrator = Integrator::QuasiStatic;
    let mut simulation = Simulation::new(&scene).unwrap();
    assert_eq!(
        simulation.state().lines[0].position,
        dynamic.state().lines[0].position
    );
    simulation.set_displacement(1, [4.0, 2.0, 1.0]);
    simulation.advance(1.0).unwrap();
    simulation.set_displacement(1, [0.0; 3]);
    for _ in 0..10 {
        simulation.advance(1.0).unwrap();
    }
    let pairs = simulation.state().lines[0]
        .position
        .iter()
        .zip(&dynamic.state().lines[0].position);
    assert!(pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max) < 1e-9 * LENGTH);
}

/// A line between two points, slack to taut, on a bed where there is one.
fn span(ratio: f64, weight: f64, bed: bool, velocity: [f64; 3]) -> Scene {
    let seabed = if bed { "seabed = { depth = 80.0 }" } else { "" };
    let (length, [x, y, z]) = (128.0 / ratio, velocity);
    scene(&format!(
        r#"
        water = {{ density = 1025.0, current = {{ velocity = [{x}, {y}, {z}] }} }}
        {seabed}
        line_types.line = {{ mass = 30.0, weight = {weight}, diameter = 0.12, axial_stiffness = 2e7, drag_normal = 1.2, drag_tangential = 0.1 }}
        points = [
          {{ name = "low", position = [0.0, 0.0, -80.0], kind = "fixed" }},
          {{ name = "high", position = [100.0, 0.0, 0.0], kind = "coupled" }},
        ]
        lines = [{{ name = "line", from = "low", to = "high", sections = [{{ type = "line", length = {length}, elements = 20 }}] }}]
        "#
    ))
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
    for ratio in [0.6, 0.85, 0.97, 0.999, 1.01] {
        for weight in [800.0, 60.0, 2.0, 0.0, -50.0] {
            for speed in [0.05, 0.5, 1.5, 4.0] {
                for direction in directions {
                    for bed in [true, false] {
                        let velocity = direction.map(|c| speed * c);
                        if let Err(error) = Simulation::new(&span(ratio, weight, bed, velocity)) {
                            let case = (ratio, weight, bed, velocity);
                            failures.push(format!("{case:?}: {error}"));
                        }
                    }
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
    let original = Simulation::new(&scene).unwrap();
    for point in &mut scene.points {
        point.position = (turn * Vector3::from(point.position)).into();
    }
    scene.water.as_mut().unwrap().current = Some(Current {
        velocity: Some((turn * Vector3::new(0.9, -0.4, 0.1)).into()),
        ..Current::default()
    });
    let turned = Simulation::new(&scene).unwrap();
    let (old, new) = (
        &original.state().lines[0].position,
        &turned.state().lines[0].position,
    );
    let apart = old.iter().zip(new).map(|(a, b)| (turn * a - b).norm());
    assert!(apart.fold(0.0, f64::max) < 1e-9 * LENGTH);
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
fn every_mistake_in_a_current_is_refused_with_its_place() {
    let refused = |current: &str, place: &str, problem: &str| {
        let text = format!(
            r#"
            water = {{ density = 1025.0, current = {current} }}
            line_types.rope = {{ mass = 12.0, diameter = 0.1, axial_stiffness = 1e6, drag_normal = 1.0 }}
            points = [
              {{ name = "a", position = [0.0, 0.0, -10.0], kind = "fixed" }},
              {{ name = "b", position = [0.0, 0.0, 0.0], kind = "coupled" }},
            ]
            lines = [{{ name = "rope", from = "a", to = "b", sections = [{{ type = "rope", length = 11.0 }}] }}]
            "#
        );
        let message = Scene::from_toml(&text).unwrap_err().to_string();
        assert!(message.contains(place) && message.contains(problem), "{message}");
    };
    refused("{}", "water.current", "a current needs");
    refused(
        "{ velocity = [1.0, 0.0, 0.0], profile = [[0.0, 1.0, 0.0]] }",
        "water.current",
        "cannot both",
    );
    refused(
        "{ velocity = [300.0, 0.0, 0.0] }",
        "water.current.velocity[0]",
        "beyond the limit of 100 m/s",
    );
    refused(
        "{ velocity = [0.0, nan, 0.0] }",
        "water.current.velocity[1]",
        "not a finite number",
    );
    refused("{ profile = [] }", "water.current.profile", "no rows");
    refused(
        "{ profile = [[0.0, 1.0, 0.0], [0.0, 2.0, 0.0]] }",
        "water.current.profile[1][0]",
        "row 0 is at 0 m too",
    );
    refused(
        "{ profile = [[inf, 1.0, 0.0]] }",
        "water.current.profile[0][0]",
        "not a finite number",
    );
    refused(
        "{ velocity = [1.0, 0.0, 0.0], factor = { ramp = [5.0, 0.0, 1.0, 1.0] } }",
        "water.current.factor.ramp",
        "not after its start",
    );
    refused("{ speed = 1.0 }", "speed", "");
}

#[test]
fn a_current_does_not_act_on_beams_and_says_so() {
    let mut by_type = riser(8, SHEARED);
    for line_type in by_type.line_types.values_mut() {
        line_type.model = LineModel::Beam;
    }
    let mut by_integrator = riser(8, SHEARED);
    by_integrator.solver.integrator = Integrator::Beam;
    for scene in [by_type, by_integrator] {
        let mistakes = scene.mistakes();
        let found = mistakes.iter().find(|mistake| mistake.at == "water.current");
        assert!(
            found.is_some_and(|mistake| {
                mistake.problem.contains("beams are modelled in still water only")
            })
        );
    }
}

#[test]
fn check_tells_the_current_and_what_is_left_out() {
    let words = riser(8, SHEARED).in_words().replace('\n', " ");
    let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
    for said in [
        "with a current: from (0.2, -0.3) m/s at z = -200 m to (1.1, 0.4) m/s at z = 0 m, straight between 3 heights",
        "times 1.2",
        "waves and the water's surface",
    ] {
        assert!(words.contains(said), "{words}");
    }
    assert!(!words.contains("still water of"), "{words}");
}

/// A taut rope along a current of 3 m/s, its top moved by a centimetre: drag is hard beside axial waves in steps as long as these allow.
fn streaming(water: &str, drag: &str, move_by: [f64; 2]) -> Scene {
    let [amplitude, period] = move_by;
    scene(&format!(
        r#"
        water = {{ density = 1025.0{water} }}
        line_types.rope = {{ mass = 16.0, diameter = 0.14, axial_stiffness = 5e6, axial_damping = 4e4, drag_normal = 1.2, added_mass_normal = 1.0, {drag} }}
        points = [
          {{ name = "low", position = [0.0, 0.0, -60.0], kind = "fixed" }},
          {{ name = "top", position = [121.0, 0.0, -50.0], kind = "coupled" }},
        ]
        lines = [{{ name = "rope", from = "low", to = "top", sections = [{{ type = "rope", length = 120.0, elements = 10 }}] }}]
        motion.top = {{ x = [[{amplitude}, {period}]] }}
        "#
    ))
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
        let [explicit, implicit] = [Integrator::Leapfrog, Integrator::GeneralisedAlpha].map(record);
        let error = explicit.tension_error(&implicit, 200);
        println!("{drag}: {error:.2e}");
        assert!(error < 0.02, "{drag}: {error}");
    }
}
