//! Free points in the sea: clumps that sink and rest on the seabed, buoys that float, heave and support lines; mass of driven points.

use std::f64::consts::PI;

use crate::common::*;
use approx::assert_relative_eq;
use moorline::scene::{InitialShape, Integrator, Scene, Strain};
use moorline::simulation::Simulation;

/// A body on a weightless thread of 1 g/m, slack, from a point 40 m above.
///
///      ● top              thread: 200 m in 4 elements, no diameter
///     / \
///     \  ● body at `z`    mass, volume, CdA, Ca
fn on_a_thread(z: f64, body: &str, seabed: &str) -> Scene {
    draft(format!(
        "water.density = {RHO}
        {seabed}
        line_types.thread = {{ mass = 1e-3, weight = 0.0, diameter = 1e-6, axial_stiffness = 100.0 }}"
    ))
    .fixed("top", [0.0, 0.0, z + 40.0])
    .free("body", [0.0, 0.0, z])
    .with(&format!("free = ['z'], {body}"))
    .line("thread", ["top", "body"], "thread", 200.0, 4)
    .with("initial = 'straight'")
    .scene()
}

/// z of the body after every `step` [s], and the simulation.
fn heights(scene: &Scene, step: f64, count: usize) -> (Vec<f64>, Simulation) {
    let mut simulation = start(&balanced(scene.clone()));
    let mut heights = vec![place(&simulation, "body").z];
    for _ in 0..count {
        simulation.advance(step).unwrap();
        heights.push(place(&simulation, "body").z);
    }
    (heights, simulation)
}

#[test]
fn a_sinking_clump_reaches_its_terminal_velocity() {
    let (mass, volume, area) = (500.0, 0.1, 0.3);
    let body = format!("mass = {mass}, volume = {volume}, drag_area = {area}, added_mass = 0.5");
    let terminal = ((mass - RHO * volume) * G / (0.5 * RHO * area)).sqrt();
    for integrator in JOINED {
        let scene = with_integrator(on_a_thread(-50.0, &body, ""), integrator, 0.01);
        let (z, simulation) = heights(&scene, 0.1, 100);
        assert_relative_eq!((z[90] - z[100]) / 1.0, terminal, max_relative = 2e-3);
        let error = error_of_lost(&simulation);
        assert!(error < 1e-3, "{error:e}");
    }
}

/// Radius of a sphere with a volume of 1 m³ [m].
fn radius() -> f64 {
    (0.75 / PI).cbrt()
}

#[test]
fn a_floating_sphere_heaves_with_the_stiffness_of_its_waterplane() {
    let mass = 0.5 * RHO; // floats half submerged: ds/dz = 3/(4R)
    let waterplane = RHO * G * PI * radius() * radius();
    let omega = (waterplane / (mass + 0.25 * RHO)).sqrt();
    let body = format!("mass = {mass}, volume = 1.0, added_mass = 0.5");
    for integrator in JOINED {
        let scene = with_integrator(on_a_thread(0.001, &body, ""), integrator, 0.002);
        let (z, simulation) = heights(&scene, 0.02, 500);
        assert_relative_eq!(PI / half_period(&z, 0.02), omega, max_relative = 5e-3);
        assert!(balance_error(&simulation).abs() < 5e-5 * 0.5 * waterplane * 1e-6);
    }
}

#[test]
fn place_and_energy_balance_of_a_sphere_that_heaves_by_most_of_its_radius_are_of_second_order() {
    let amplitude = 0.5;
    let body = format!("mass = {}, volume = 1.0, added_mass = 0.5", 0.5 * RHO);
    for integrator in JOINED {
        let steps = [2.5e-3, 1.25e-3, 6.25e-4, 3.125e-4, 7.8125e-5];
        let runs = steps.map(|step| {
            let scene = with_integrator(on_a_thread(amplitude, &body, ""), integrator, step);
            let (z, simulation) = heights(&scene, 0.02, 250);
            (z[250], balance_error(&simulation).abs())
        });
        let gaps = [0, 1, 2, 3].map(|i| (runs[i].0 - runs[4].0).abs());
        assert_order(2.0, &steps[..4], &gaps);
        let start = 0.5 * RHO * G * PI * radius() * radius() * amplitude * amplitude;
        assert!(runs[4].1 < 1e-6 * start, "{runs:?}");
        let errors = [0, 1, 2, 3].map(|i| runs[i].1);
        assert_order(2.0, &steps[..4], &errors);
    }
}

#[test]
fn a_buoy_dropped_on_the_water_settles_at_its_draught() {
    let mass = 300.0;
    // Archimedes: 1025 u²(3 − 2u) = 300, z = R(1 − 2u)
    let under = bisect([0.0, 1.0], |u| RHO * u * u * (3.0 - 2.0 * u) - mass);
    let draught = radius() * (1.0 - 2.0 * under);
    let body = format!("mass = {mass}, volume = 1.0, drag_area = 3.0, added_mass = 0.5");
    for integrator in JOINED {
        let scene = with_integrator(on_a_thread(3.0, &body, ""), integrator, 0.005);
        let (z, simulation) = heights(&scene, 0.1, 6000);
        let fall = (2.0 * (3.0 - radius()) / G).sqrt(); // until it touches the water
        let before = (fall / 0.1) as usize;
        let t = 0.1 * before as f64;
        assert_relative_eq!(z[before], 3.0 - 0.5 * G * t * t, max_relative = 2e-3);
        assert!(z.iter().all(|z| *z > -3.0));
        let last = &z[5900..];
        let mean = last.iter().sum::<f64>() / last.len() as f64;
        assert_relative_eq!(mean, draught, epsilon = 1e-4);
        // with quadratic drag the oscillation decays as 1/t
        assert!(last.iter().all(|z| (z - draught).abs() < 3e-3));
        assert!(balance_error(&simulation).abs() < 1e-3 * mass * G * 3.0);
    }
}

#[test]
fn a_clump_that_lands_rests_on_the_seabed() {
    let seabed = "seabed = { depth = 60.0, stiffness = 1e6, damping = 1e5 }";
    let body = "mass = 500.0, volume = 0.1, drag_area = 0.3, added_mass = 0.5";
    for integrator in JOINED {
        let scene = with_integrator(on_a_thread(-58.0, body, seabed), integrator, 0.01);
        let (z, _) = heights(&scene, 0.1, 200);
        assert!((z[200] + 60.0).abs() < 1e-4, "{}", z[200]);
    }
}

#[test]
fn a_buoy_on_a_slack_line_floats_where_its_weight_is_its_buoyancy_and_stays_there() {
    let buoy = "mass = 400.0, volume = 1.0, drag_area = 1.0, added_mass = 0.5";
    let mut scene = on_a_thread(0.1, buoy, "");
    scene.lines[0].initial = InitialShape::Static;
    scene.line_types.get_mut("thread").unwrap().weight = Some(0.01);
    for integrator in JOINED {
        let scene = with_integrator(scene.clone(), integrator, 0.05);
        let (z, simulation) = heights(&scene, 0.5, 1200);
        let body = simulation.model().point_index("body").unwrap();
        let excess = simulation.model().points[body].free().unwrap().at(z[0]).weight;
        assert!(excess.abs() < 5.0, "{excess}"); // part of the thread hangs from it
        assert!((z[1200] - z[0]).abs() < 1e-9 * 200.0, "{}", z[1200] - z[0]);
    }
}

#[test]
fn a_drogue_in_a_current_pulls_by_its_drag_whatever_the_step() {
    let (area, speed) = (1.0, 2.0);
    let drag = 0.5 * RHO * area * speed * speed;
    let drogue = draft(format!(
        "water = {{ density = {RHO}, current = {{ velocity = [{speed}, 0.0, 0.0] }} }}
        line_types.rope = {{ mass = 0.1, weight = 0.0, diameter = 1e-6, axial_stiffness = 1.0e5, axial_damping = 100.0 }}"
    ))
    .fixed("top", [0.0, 0.0, -20.0])
    .free("drogue", [20.0, 0.0, -20.0])
    .with(&format!("mass = 1.0, volume = {}, drag_area = {area}", 1.0 / RHO))
    .line("rope", ["top", "drogue"], "rope", 20.0, 4)
    .with("initial = 'straight'")
    .scene();
    for integrator in JOINED {
        for step in [0.01, 0.1] {
            let mut simulation = start(&with_integrator(drogue.clone(), integrator, step));
            run(&mut simulation, 0.1, 100);
            assert_relative_eq!(simulation.tension_b(0), drag, max_relative = 1e-3);
        }
    }
}

/// Free point between two straight ropes, the first of which starts with the shape `near`, and a third rope 5 km away that
/// starts with the shape `far`.
fn beside(near: &str, far: &str) -> Scene {
    draft("line_types.rope = { mass = 10.0, axial_stiffness = 1e6, axial_damping = 1e4 }")
        .fixed("a", [0.0; 3])
        .fixed("b", [100.0, 0.0, 0.0])
        .free("p", [50.0, 0.0, -10.0])
        .with("mass = 100.0")
        .fixed("fa", [5000.0, 0.0, 0.0])
        .fixed("fb", [5100.0, 0.0, 0.0])
        .line("la", ["a", "p"], "rope", 60.0, 8)
        .with(&format!("initial = '{near}'"))
        .line("lb", ["p", "b"], "rope", 60.0, 8)
        .with("initial = 'straight'")
        .line("far", ["fa", "fb"], "rope", 110.0, 8)
        .with(&format!("initial = '{far}'"))
        .scene()
}

#[test]
fn a_line_of_another_network_does_not_decide_where_a_free_point_starts() {
    for integrator in [Integrator::Auto, Integrator::QuasiStatic] {
        for near in ["straight", "static"] {
            let [alone, beside] = ["straight", "static"].map(|far| {
                let mut scene = beside(near, far);
                scene.solver.integrator = integrator;
                let mut simulation = start(&scene);
                let first = place(&simulation, "p");
                // quasi-static lines are in equilibrium from the start
                let rests = near == "static" || integrator == Integrator::QuasiStatic;
                assert_eq!(first.z != -10.0, rests, "{near}: z = {} m", first.z);
                run(&mut simulation, 0.1, 20);
                (first, simulation.state().lines[..2].to_vec())
            });
            assert!(alone == beside, "{integrator:?}, {near}");
        }
    }
}

#[test]
fn a_network_whose_lines_have_shapes_of_their_own_needs_no_equilibrium_to_start() {
    // a softening strain measure that cannot carry the clump: no equilibrium exists
    let mut scene = beside("straight", "static");
    let mut weak = scene.line_types["rope"].clone();
    (weak.strain, weak.axial_stiffness) = (Strain::Logarithmic(0.5), Some(2e3));
    scene.line_types.insert("weak".into(), weak);
    for line in &mut scene.lines[..2] {
        line.sections[0].line_type = "weak".into();
    }
    let simulation = start(&scene);
    assert!(simulation.in_equilibrium().is_err());
    assert_eq!(place(&simulation, "p").z, -10.0);
    scene.lines[0].initial = InitialShape::Static;
    assert!(Simulation::new(&scene).is_err());
}

#[test]
fn check_says_where_each_free_point_starts() {
    let resting = "mass 100 kg, starts in static equilibrium";
    let placed = "mass 100 kg, starts at the given position, since no line of its network is `static`";
    for (near, words) in [("static", resting), ("straight", placed)] {
        assert_says(&in_words(&beside(near, "static")), &[words]);
    }
}

const BODY: &str = "mass = 9000.0, volume = 1.2, drag_area = 2.5, added_mass = 0.7";

/// Rope from the ground to a fairlead that heaves by 0.8 m in 5 s, with the kind and position [m] of the fairlead, and additional
/// keys of the fairlead and of the scene.
fn heaving_fairlead(kind: &str, position: [f64; 3], [keys, rest]: [&str; 2], body: &str) -> Scene {
    draft(format!(
        "water.density = {RHO}
        line_types.rope = {{ mass = 30.0, diameter = 0.12, axial_stiffness = 2e7, axial_damping = 1e5, drag_normal = 1.2 }}
        {rest}"
    ))
    .fixed("anchor", [80.0, 0.0, -90.0])
    .point(kind, "fairlead", position)
    .with(keys)
    .with(body)
    .line("rope", ["anchor", "fairlead"], "rope", 118.0, 6)
    .scene()
}

/// Vertical force of the heaving body after a time [s], −(m − ρV)g − ½ρ CdA |v|v − (m + ρV Ca)a [N].
fn own_law(t: f64, moves: bool) -> f64 {
    let omega = 2.0 * PI / 5.0;
    let (v, a) = (
        0.8 * omega * (omega * t).cos(),
        -0.8 * omega * omega * (omega * t).sin(),
    );
    let still = -(9000.0 - RHO * 1.2) * G;
    match moves {
        true => still - 0.5 * RHO * 2.5 * v.abs() * v - (9000.0 + 0.7 * RHO * 1.2) * a,
        false => still,
    }
}

const SHIP: &str = "vessels = [{ name = 'ship', position = [-3.0, 0.0, -4.0] }]";

#[test]
fn mass_of_a_driven_point_is_part_of_the_force_on_what_drives_it() {
    let at = [0.0, 0.0, -10.0];
    let motion = "{ z = [[0.8, 5.0]] }";
    let moved = &format!("motion.fairlead = {motion}");
    for (kind, position, keys, moves) in [
        ("coupled", at, ["", moved], true),
        ("prescribed", at, [&format!("motion = {motion}"), ""], true),
        (
            "coupled",
            [3.0, 0.0, -6.0],
            ["on = 'ship'", &format!("{SHIP}\nmotion.ship = {motion}")],
            true,
        ),
        (
            "coupled",
            at,
            ["", &format!("{moved}\nsolver.integrator = 'quasi_static'")],
            false,
        ),
    ] {
        let [with, without] = [BODY, ""].map(|body| {
            let mut simulation = following(&heaving_fairlead(kind, position, keys, body));
            run(&mut simulation, 0.1, 37);
            simulation.end_force(1)
        });
        let [x, y, z] = [0, 1, 2].map(|axis| with[axis] - without[axis]);
        assert!(x.abs() < 1e-6 && y.abs() < 1e-6, "{kind} {keys:?}: {x} {y} N");
        assert_relative_eq!(z, own_law(3.7, moves), max_relative = 1e-9);
    }
}

#[test]
fn mass_on_a_vessel_has_a_moment_and_a_stiffness_about_its_origin() {
    let [(force, stiffness), (bare, soft)] = [BODY, ""].map(|body| {
        let keys = ["on = 'ship'", SHIP];
        let simulation = start(&heaving_fairlead("coupled", [3.0, 2.0, -6.0], keys, body));
        (
            simulation.vessel_force(0),
            simulation.vessel_stiffness(0).unwrap(),
        )
    });
    let w = (9000.0 - RHO * 1.2) * G;
    let expected = [0.0, 0.0, -w, -2.0 * w, 3.0 * w, 0.0];
    for axis in 0..6 {
        assert_relative_eq!(force[axis] - bare[axis], expected[axis], epsilon = 1e-6 * w);
    }
    // it hangs 6 m below the origin, as a pendulum
    let turning = [
        (3, 3, 6.0),
        (4, 4, 6.0),
        (3, 5, 3.0),
        (4, 5, 2.0),
        (2, 2, 0.0),
        (5, 5, 0.0),
    ];
    for (row, column, arm) in turning {
        let change = stiffness[row][column] - soft[row][column];
        assert_relative_eq!(change, arm * w, epsilon = 1e-6 * w);
    }
}
