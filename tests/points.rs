//! Free points in the sea: clumps that sink and rest on the bed, buoys that float, heave and hold lines up.

mod common;

use std::f64::consts::PI;

use approx::assert_relative_eq;
use common::*;
use moorline::scene::{InitialShape, Integrator, Scene, Strain};
use moorline::simulation::Simulation;

const RHO: f64 = 1025.0; // [kg/m³]
const G: f64 = 9.80665; // [m/s²]

const BOTH: [Integrator; 2] = [Integrator::Leapfrog, Integrator::GeneralisedAlpha];

/// A body on a weightless thread of 1 g/m, slack from a point 40 m above.
///
///      ● top              thread: 200 m in 4 elements, no diameter
///     / \
///     \  ● body at `z`    mass, volume, CdA, Ca
fn on_a_thread(z: f64, body: &str, bed: &str) -> Scene {
    scene(&format!(
        r#"
        water.density = {RHO}
        {bed}
        line_types.thread = {{ mass = 1e-3, weight = 0.0, diameter = 1e-6, axial_stiffness = 100.0 }}
        points = [
          {{ name = "top", position = [0.0, 0.0, {}], kind = "fixed" }},
          {{ name = "body", position = [0.0, 0.0, {z}], kind = "free", free = ["z"], {body} }},
        ]
        lines = [{{ name = "thread", from = "top", to = "body", initial = "straight", sections = [{{ type = "thread", length = 200.0, elements = 4 }}] }}]
        "#,
        z + 40.0
    ))
}

/// z of the body after every `step` [s], and the simulation.
fn heights(scene: &Scene, step: f64, count: usize) -> (Vec<f64>, Simulation) {
    let mut simulation = Simulation::new(scene).unwrap();
    let body = simulation.model().point_index("body").unwrap();
    let mut heights = vec![simulation.state().points[body].position.z];
    for _ in 0..count {
        simulation.advance(step).unwrap();
        heights.push(simulation.state().points[body].position.z);
    }
    (heights, simulation)
}

#[test]
fn a_sinking_clump_reaches_its_terminal_velocity() {
    let (mass, volume, area) = (500.0, 0.1, 0.3);
    let body = format!("mass = {mass}, volume = {volume}, drag_area = {area}, added_mass = 0.5");
    let terminal = ((mass - RHO * volume) * G / (0.5 * RHO * area)).sqrt();
    for integrator in BOTH {
        let scene = with_integrator(on_a_thread(-50.0, &body, ""), integrator, 0.01);
        let (z, simulation) = heights(&scene, 0.1, 100);
        assert_relative_eq!((z[90] - z[100]) / 1.0, terminal, max_relative = 2e-3);
        let error = simulation.energy_error().abs();
        assert!(error < 1e-3 * simulation.ledger().flow.lost, "{error} J");
    }
}

#[test]
fn a_floating_sphere_heaves_with_the_stiffness_of_its_waterplane() {
    let (volume, ca) = (1.0, 0.5);
    let mass = 0.5 * RHO * volume; // floats half under: ds/dz = 3/(4R)
    let radius = (0.75 * volume / PI).cbrt();
    let omega = (RHO * G * PI * radius * radius / (mass + 0.5 * ca * RHO * volume)).sqrt();
    let body = format!("mass = {mass}, volume = {volume}, added_mass = {ca}");
    for integrator in BOTH {
        let scene = with_integrator(on_a_thread(0.001, &body, ""), integrator, 0.002);
        let (z, simulation) = heights(&scene, 0.02, 500);
        let crossings = zero_crossings(&z, 0.02);
        let half = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64;
        assert_relative_eq!(PI / half, omega, max_relative = 5e-3);
        let start = 0.5 * RHO * G * PI * radius * radius * 1e-6;
        assert!(simulation.energy_error().abs() < 5e-5 * start);
    }
}

#[test]
fn place_and_ledger_of_a_sphere_that_heaves_by_most_of_its_radius_are_of_second_order() {
    let (volume, amplitude) = (1.0, 0.5);
    let body = format!("mass = {}, volume = {volume}, added_mass = 0.5", 0.5 * RHO);
    for integrator in BOTH {
        let steps = [2.5e-3, 1.25e-3, 6.25e-4, 3.125e-4, 7.8125e-5];
        let runs = steps.map(|step| {
            let scene = with_integrator(on_a_thread(amplitude, &body, ""), integrator, step);
            let (z, simulation) = heights(&scene, 0.02, 250);
            (z[250], simulation.energy_error().abs())
        });
        let gaps = [0, 1, 2, 3].map(|i| (runs[i].0 - runs[4].0).abs());
        assert_order(2.0, &steps[..4], &gaps);
        let radius = (0.75 * volume / PI).cbrt();
        let start = 0.5 * RHO * G * PI * radius * radius * amplitude * amplitude;
        assert!(runs[4].1 < 1e-6 * start, "{runs:?}");
        let errors = [0, 1, 2, 3].map(|i| runs[i].1);
        assert_order(2.0, &steps[..4], &errors);
    }
}

#[test]
fn a_buoy_dropped_on_the_water_settles_at_its_draught() {
    let (mass, volume) = (300.0, 1.0);
    let radius = (0.75 * volume / PI).cbrt();
    // Archimedes: 1025 u²(3 − 2u) = 300, z = R(1 − 2u)
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let u: f64 = 0.5 * (low + high);
        if RHO * volume * u * u * (3.0 - 2.0 * u) < mass {
            low = u;
        } else {
            high = u;
        }
    }
    let draught = radius * (1.0 - 2.0 * low);
    let body = format!("mass = {mass}, volume = {volume}, drag_area = 3.0, added_mass = 0.5");
    for integrator in BOTH {
        let scene = with_integrator(on_a_thread(3.0, &body, ""), integrator, 0.005);
        let (z, simulation) = heights(&scene, 0.1, 6000);
        let fall = (2.0 * (3.0 - radius) / G).sqrt(); // to the first touch of the water
        let before = (fall / 0.1) as usize;
        let t = 0.1 * before as f64;
        assert_relative_eq!(z[before], 3.0 - 0.5 * G * t * t, max_relative = 2e-3);
        assert!(z.iter().all(|z| *z > -3.0));
        let last = &z[5900..];
        let mean = last.iter().sum::<f64>() / last.len() as f64;
        assert_relative_eq!(mean, draught, epsilon = 1e-4);
        // quadratic drag lets the swing fade as 1/t
        assert!(last.iter().all(|z| (z - draught).abs() < 3e-3));
        let drop = mass * G * 3.0;
        assert!(simulation.energy_error().abs() < 1e-3 * drop);
    }
}

#[test]
fn a_clump_that_lands_rests_on_the_bed() {
    let bed = "seabed = { depth = 60.0, stiffness = 1e6, damping = 1e5 }";
    let body = "mass = 500.0, volume = 0.1, drag_area = 0.3, added_mass = 0.5";
    for integrator in BOTH {
        let scene = with_integrator(on_a_thread(-58.0, body, bed), integrator, 0.01);
        let (z, _) = heights(&scene, 0.1, 200);
        assert!((z[200] + 60.0).abs() < 1e-4, "{}", z[200]);
    }
}

#[test]
fn a_buoy_on_a_slack_line_floats_where_its_weight_is_its_buoyancy_and_stays_there() {
    let mut scene = on_a_thread(
        0.1,
        "mass = 400.0, volume = 1.0, drag_area = 1.0, added_mass = 0.5",
        "",
    );
    scene.lines[0].initial = InitialShape::Static;
    scene.line_types.get_mut("thread").unwrap().weight = Some(0.01);
    for integrator in BOTH {
        let scene = with_integrator(scene.clone(), integrator, 0.05);
        let (z, simulation) = heights(&scene, 0.5, 1200);
        let body = simulation.model().point_index("body").unwrap();
        let free = simulation.model().points[body].free().unwrap();
        assert!(free.at(z[0]).weight.abs() < 5.0, "{}", free.at(z[0]).weight); // what hangs of the thread
        assert!((z[1200] - z[0]).abs() < 1e-9 * 200.0, "{}", z[1200] - z[0]);
    }
}

#[test]
fn a_drogue_in_a_current_pulls_by_its_drag_whatever_the_step() {
    let (area, speed) = (1.0, 2.0);
    let drag = 0.5 * RHO * area * speed * speed;
    for integrator in BOTH {
        for step in [0.01, 0.1] {
            let drogue = scene(&format!(
                r#"
                water = {{ density = {RHO}, current = {{ velocity = [{speed}, 0.0, 0.0] }} }}
                line_types.rope = {{ mass = 0.1, weight = 0.0, diameter = 1e-6, axial_stiffness = 1.0e5, axial_damping = 100.0 }}
                points = [{{ name = "top", position = [0.0, 0.0, -20.0], kind = "fixed" }},
                          {{ name = "drogue", position = [20.0, 0.0, -20.0], kind = "free", mass = 1.0, volume = {}, drag_area = {area} }}]
                lines = [{{ name = "rope", from = "top", to = "drogue", initial = "straight", sections = [{{ type = "rope", length = 20.0, elements = 4 }}] }}]
                "#,
                1.0 / RHO
            ));
            let mut simulation = Simulation::new(&with_integrator(drogue, integrator, step)).unwrap();
            for _ in 0..100 {
                simulation.advance(0.1).unwrap();
            }
            assert_relative_eq!(simulation.tension_b(0), drag, max_relative = 1e-3);
        }
    }
}

/// A free point between two straight ropes, and a third rope 5 km away that starts as `far` says.
fn beside(near: &str, far: &str) -> Scene {
    scene(&format!(
        r#"
        line_types.rope = {{ mass = 10.0, axial_stiffness = 1e6, axial_damping = 1e4 }}
        points = [
          {{ name = "a", position = [0.0, 0.0, 0.0], kind = "fixed" }},
          {{ name = "b", position = [100.0, 0.0, 0.0], kind = "fixed" }},
          {{ name = "p", position = [50.0, 0.0, -10.0], kind = "free", mass = 100.0 }},
          {{ name = "fa", position = [5000.0, 0.0, 0.0], kind = "fixed" }},
          {{ name = "fb", position = [5100.0, 0.0, 0.0], kind = "fixed" }},
        ]
        lines = [
          {{ name = "la", from = "a", to = "p", sections = [{{ type = "rope", length = 60.0, elements = 8 }}], initial = {near} }},
          {{ name = "lb", from = "p", to = "b", sections = [{{ type = "rope", length = 60.0, elements = 8 }}], initial = "straight" }},
          {{ name = "far", from = "fa", to = "fb", sections = [{{ type = "rope", length = 110.0, elements = 8 }}], initial = {far} }},
        ]
        "#
    ))
}

#[test]
fn a_line_of_another_network_does_not_decide_where_a_free_point_starts() {
    for integrator in [Integrator::Auto, Integrator::QuasiStatic] {
        for near in [r#""straight""#, r#""static""#] {
            let [alone, beside] = [r#""straight""#, r#""static""#].map(|far| {
                let mut scene = beside(near, far);
                scene.solver.integrator = integrator;
                let mut simulation = Simulation::new(&scene).unwrap();
                let start = simulation.state().points[2].position;
                let rests = near.contains("static");
                assert_eq!(start.z != -10.0, rests, "{near}: z = {} m", start.z);
                for _ in 0..20 {
                    simulation.advance(0.1).unwrap();
                }
                (start, simulation.state().lines[..2].to_vec())
            });
            assert!(alone == beside, "{integrator:?}, {near}");
        }
    }
}

#[test]
fn a_network_whose_lines_have_shapes_of_their_own_needs_no_equilibrium_to_start() {
    // a softening measure that cannot carry the clump: no equilibrium exists
    let mut scene = beside(r#""straight""#, r#""static""#);
    let mut weak = scene.line_types["rope"].clone();
    (weak.strain, weak.axial_stiffness) = (Strain::Logarithmic(0.5), Some(2e3));
    scene.line_types.insert("weak".into(), weak);
    for line in &mut scene.lines[..2] {
        line.sections[0].line_type = "weak".into();
    }
    let simulation = Simulation::new(&scene).unwrap();
    assert!(simulation.in_equilibrium().is_err());
    assert_eq!(simulation.state().points[2].position.z, -10.0);
    scene.lines[0].initial = InitialShape::Static;
    assert!(Simulation::new(&scene).is_err());
}

#[test]
fn check_tells_where_each_free_point_starts() {
    for (near, words) in [
        (r#""static""#, "starts in static equilibrium"),
        (
            r#""straight""#,
            "starts at its position, as no line of its network is `static`",
        ),
    ] {
        let said = beside(near, r#""static""#).in_words();
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(said.contains(&format!("mass 100 kg, {words}")), "{said}");
    }
}

const BODY: &str = "mass = 9000.0, volume = 1.2, drag_area = 2.5, added_mass = 0.7";

/// A rope from the ground to a fairlead that heaves by 0.8 m in 5 s, driven as `fairlead` says beside its name.
fn heaving_fairlead(fairlead: &str, rest: &str) -> Scene {
    scene(&format!(
        r#"
        water.density = {RHO}
        line_types.rope = {{ mass = 30.0, diameter = 0.12, axial_stiffness = 2e7, axial_damping = 1e5, drag_normal = 1.2 }}
        points = [
          {{ name = "anchor", position = [80.0, 0.0, -90.0], kind = "fixed" }},
          {{ name = "fairlead", {fairlead} }},
        ]
        lines = [{{ name = "rope", from = "anchor", to = "fairlead", sections = [{{ type = "rope", length = 118.0, elements = 6 }}] }}]
        {rest}
        "#
    ))
}

/// Force of the fairlead with a body over that without one, 3.7 s after the start, along z [N].
fn own_force(fairlead: &str, rest: &str) -> [f64; 3] {
    let force = |body: &str| {
        let mut simulation = following(&heaving_fairlead(&format!("{fairlead}{body}"), rest));
        for _ in 0..37 {
            simulation.advance(0.1).unwrap();
        }
        simulation.end_force(1)
    };
    let [with, without] = [force(&format!(", {BODY}")), force("")];
    std::array::from_fn(|axis| with[axis] - without[axis])
}

/// −(m − ρV)g − ½ρ CdA |v|v − (m + ρV Ca)a of the heave after a time [s], in [N].
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

#[test]
fn mass_of_a_driven_point_is_part_of_the_force_on_what_drives_it() {
    let place = "position = [0.0, 0.0, -10.0]";
    let motion = "{ z = [[0.8, 5.0]] }";
    let vessel = "vessels = [{ name = 'ship', position = [-3.0, 0.0, -4.0] }]";
    let solver = "solver.integrator = 'quasi_static'";
    let coupled = format!("{place}, kind = 'coupled'");
    let run = format!("motion.fairlead = {motion}");
    let cases = [
        (coupled.clone(), run.clone(), true),
        (
            format!("{place}, kind = 'prescribed', motion = {motion}"),
            String::new(),
            true,
        ),
        (
            "position = [3.0, 0.0, -6.0], kind = 'coupled', on = 'ship'".to_string(),
            format!("{vessel}\nmotion.ship = {motion}"),
            true,
        ),
        (coupled, format!("{run}\n{solver}"), false),
    ];
    for (fairlead, rest, moves) in cases {
        let [x, y, z] = own_force(&fairlead, &rest);
        assert!(x.abs() < 1e-6 && y.abs() < 1e-6, "{fairlead}: {x} {y} N");
        assert_relative_eq!(z, own_law(3.7, moves), max_relative = 1e-9);
    }
}

#[test]
fn mass_on_a_vessel_has_a_moment_and_a_stiffness_about_its_origin() {
    let on = "position = [3.0, 2.0, -6.0], kind = 'coupled', on = 'ship'";
    let vessel = "vessels = [{ name = 'ship', position = [-3.0, 0.0, -4.0] }]";
    let of = |body: &str| {
        let simulation = Simulation::new(&heaving_fairlead(&format!("{on}{body}"), vessel)).unwrap();
        (
            simulation.vessel_force(0),
            simulation.vessel_stiffness(0).unwrap(),
        )
    };
    let ([force, stiffness], [bare, soft]) = {
        let (with, without) = (of(&format!(", {BODY}")), of(""));
        (
            [vec![with.0.to_vec()], with.1.map(Vec::from).to_vec()],
            [vec![without.0.to_vec()], without.1.map(Vec::from).to_vec()],
        )
    };
    let w = (9000.0 - RHO * 1.2) * G;
    let expected = [0.0, 0.0, -w, -2.0 * w, 3.0 * w, 0.0];
    for axis in 0..6 {
        assert_relative_eq!(force[0][axis] - bare[0][axis], expected[axis], epsilon = 1e-6 * w);
    }
    // it hangs 6 m under the origin, as a pendulum
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
