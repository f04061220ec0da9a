//! Lines that pierce the still surface of the water: what is out of it has no buoyancy, no drag and no added mass.

mod common;

use approx::assert_relative_eq;
use common::*;
use moorline::elements::Workspace;
use moorline::model::{End, Model};
use moorline::physics::surface::emerged;
use moorline::scene::{Integrator, Scene};
use moorline::simulation::Simulation;
use moorline::statics::catenary::{self, Section};
use nalgebra::Vector3;

const RHO: f64 = 1025.0; // [kg/m³]
const G: f64 = 9.80665; // [m/s²]
const ALL: [Integrator; 3] = [
    Integrator::Leapfrog,
    Integrator::AxialImplicit,
    Integrator::GeneralisedAlpha,
];

/// A rope of 0.1 m and 25 kg/m: 245.2 N/m in air, 166.2 N/m in water.
const ROPE: &str = "mass = 25.0, diameter = 0.1, axial_stiffness = 2e6, axial_damping = 2e4, drag_normal = 1.2, drag_tangential = 0.1, \
                    added_mass_normal = 1.0, added_mass_tangential = 0.2";

/// ρ g A of a diameter [N/m].
fn displaced(diameter: f64) -> f64 {
    RHO * G * 0.25 * std::f64::consts::PI * diameter * diameter
}

/// A line of `line_type` between end A and end B, with `more` of the scene.
fn line(line_type: &str, ends: [&str; 2], length: f64, elements: usize, more: &str) -> Scene {
    let [a, b] = ends;
    scene(&format!(
        r#"
        water = {{ density = {RHO}, surface = true }}
        line_types.rope = {{ {line_type} }}
        points = [{{ name = "a", {a} }}, {{ name = "b", {b} }}]
        lines = [{{ name = "line", from = "a", to = "b", sections = [{{ type = "rope", length = {length:?}, elements = {elements} }}] }}]
        {more}
        "#
    ))
}

/// A rope from 30 m under the surface to a coupled point 8 m over it, 40 m away.
///
///                   ● b (40, 8)
///      ~~~~~~~~~~~ / ~~~~~
///   a ●___________/
///     (0, −30)
fn oblique(elements: usize) -> Scene {
    oblique_and(elements, "")
}

fn oblique_and(elements: usize, more: &str) -> Scene {
    let ends = [
        "position = [0.0, 0.0, -30.0], kind = \"fixed\"",
        "position = [40.0, 0.0, 8.0], kind = \"coupled\"",
    ];
    line(ROPE, ends, 60.0, elements, more)
}

fn statics(scene: &Scene) -> (Model, moorline::model::State) {
    let model = Model::new(scene).unwrap();
    let state = common::statics(&model);
    (model, state)
}

#[test]
fn a_cable_that_hangs_half_out_of_the_water_weighs_what_it_weighs_in_air_and_in_water() {
    let ends = [
        "position = [0.0, 0.0, -9.7], kind = \"free\", mass = 0.001",
        "position = [0.0, 0.0, 10.3], kind = \"fixed\"",
    ];
    let stiff = ROPE.replace("2e6", "1e11");
    for elements in [7, 20] {
        let simulation = Simulation::new(&line(&stiff, ends, 20.0, elements, "")).unwrap();
        let weight = 25.0 * G * 20.0 - displaced(0.1) * 9.7 + 0.001 * G;
        let [x, y, z] = simulation.end_force(1);
        assert!(x.abs() + y.abs() < 1e-9 * weight);
        assert!((z + weight).abs() < 1e-7 * weight, "{z}, {weight}");
        assert!((simulation.tension_b(0) - weight).abs() < 1e-7 * weight);
    }
}

#[test]
fn a_line_afloat_lies_at_the_draught_where_its_weight_is_its_buoyancy() {
    let ends = |span: f64| {
        [
            "position = [0.0, 0.0, 0.0], kind = \"fixed\"".to_string(),
            format!("position = [{span:?}, 0.0, 0.0], kind = \"fixed\""),
        ]
    };
    for (mass, span) in [(2.0, 100.5), (6.0, 100.5), (4.0, 99.0), (6.5, 95.0)] {
        let hose = format!("mass = {mass:?}, diameter = 0.1, axial_stiffness = 1e6");
        let [a, b] = ends(span);
        let (_, state) = statics(&line(&hose, [&a, &b], 100.0, 200, ""));
        let z = state.lines[0].position[100].z;
        let dry = emerged(0.05, [z; 2]).map_or(0.0, |at| at.parts[0]);
        let afloat = 1.0 - mass * G / displaced(0.1);
        assert!((dry - afloat).abs() < 1e-6, "{mass} kg/m: {dry}, {afloat}");
    }
}

#[test]
fn the_static_forces_of_an_oblique_line_are_those_of_a_catenary_of_two_weights_to_second_order() {
    let (wet, air) = (25.0 * G - displaced(0.1), 25.0 * G);
    let section = |length: f64, weight: f64| Section {
        length,
        weight,
        axial_stiffness: 2e6,
    };
    // the length under water, by bisection on the height of its end
    let solve =
        |s: f64| catenary::solve(&[section(s, wet), section(60.0 - s, air)], 40.0, 38.0, None).unwrap();
    let (mut low, mut high) = (20.0, 59.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if solve(middle).at(middle).z < 30.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let exact = solve(low);
    let sizes = [16, 32, 64, 128, 256];
    let errors = sizes.map(|n| {
        let simulation = Simulation::new(&oblique(n)).unwrap();
        let [x, _, z] = simulation.end_force(1);
        (x + exact.horizontal()).hypot(z + exact.vertical_b()) / exact.tension_b()
    });
    assert_order(-2.0, &sizes.map(|n| n as f64), &errors);
    assert!(errors[4] < 2e-5, "{errors:?}");
}

#[test]
fn an_equilibrium_stays_at_rest_for_600_s() {
    for integrator in ALL {
        let scene = with_integrator(oblique(12), integrator, 0.05);
        let mut simulation = Simulation::new(&scene).unwrap();
        let start = simulation.state().lines[0].position.clone();
        for _ in 0..600 {
            simulation.advance(1.0).unwrap();
        }
        let now = &simulation.state().lines[0].position;
        let moved = start.iter().zip(now).map(|(a, b)| (a - b).norm());
        let drift = moved.fold(0.0, f64::max);
        assert!(drift < 1e-9 * 60.0, "{integrator:?}: {drift} m");
    }
}

/// The oblique rope, its upper end on a path that takes it into the water and out; leapfrogs without axial damping, which they take
/// at a velocity that lags.
fn dipping(elements: usize, integrator: Integrator, step: f64) -> Scene {
    let motion = "motion.b = { x = [[3.0, 7.0]], z = [[9.0, 9.0]], ramp = 4.0 }";
    let mut scene = with_integrator(oblique_and(elements, motion), integrator, step);
    if integrator != Integrator::Leapfrog {
        scene.solver.spectral_radius = Some(1.0);
    }
    if integrator != Integrator::GeneralisedAlpha {
        let rope = scene.line_types.get_mut("rope").unwrap();
        rope.axial_damping = Some(0.0);
    }
    scene
}

/// Positions of all inner nodes after 8 s in steps of `step` [s].
fn dipped(integrator: Integrator, step: f64) -> Vec<Vector3<f64>> {
    let mut simulation = following(&dipping(8, integrator, step));
    for _ in 0..16 {
        simulation.advance(0.5).unwrap();
    }
    simulation.state().lines[0].position[1..8].to_vec()
}

#[test]
fn a_line_that_dips_in_and_out_is_followed_to_second_order_in_time() {
    for integrator in ALL {
        let steps = [0.008, 0.004, 0.002, 0.001];
        let exact = dipped(integrator, 0.05 * steps[3]);
        let errors = steps.map(|step| {
            let nodes = dipped(integrator, step);
            let pairs = nodes.iter().zip(&exact);
            pairs.map(|(a, b)| (a - b).norm_squared()).sum::<f64>().sqrt()
        });
        println!("{integrator:?}: {errors:?}");
        assert_order_at_least(2.0, &steps, &errors);
    }
}

#[test]
fn the_ledger_of_a_line_that_dips_in_and_out_closes_with_the_step() {
    for integrator in ALL {
        let error = |step: f64| {
            let mut simulation = following(&dipping(8, integrator, step));
            let mut worst = 0.0_f64;
            for _ in 0..16 {
                simulation.advance(0.5).unwrap();
                worst = worst.max(simulation.energy_error().abs());
            }
            worst / simulation.ledger().flow.lost.abs()
        };
        let [coarse, fine] = [0.008, 0.001].map(error);
        println!("{integrator:?}: {coarse:e}, {fine:e} of what is lost");
        assert!(
            fine < 1e-4 && fine < 0.1 * coarse,
            "{integrator:?}: {coarse}, {fine}"
        );
    }
}

#[test]
fn a_line_that_is_hauled_out_of_the_water_ends_with_its_weight_in_air() {
    let ends = [
        "position = [0.0, 0.0, -28.0], kind = \"free\", mass = 50.0",
        "position = [0.0, 0.0, -8.0], kind = \"coupled\"",
    ];
    for integrator in [Integrator::Leapfrog, Integrator::GeneralisedAlpha] {
        let more =
            "motion.b = { table = [[0.0, 0.0, 0.0, 0.0], [5.0, 0.0, 0.0, 0.0], [35.0, 0.0, 0.0, 40.0]] }";
        let scene = with_integrator(line(ROPE, ends, 20.0, 10, more), integrator, 0.01);
        let (wet, air) = (
            (50.0 + 25.0 * 20.0) * G - displaced(0.1) * 20.0,
            (50.0 + 25.0 * 20.0) * G,
        );
        let force = Simulation::new(&scene).unwrap().end_force(1)[2];
        assert!((force + wet).abs() < 1e-6 * wet, "{force}, {wet}");
        let mut simulation = following(&scene);
        for _ in 0..1200 {
            simulation.advance(0.05).unwrap();
        }
        let force = simulation.end_force(1)[2];
        assert!((force + air).abs() < 1e-3 * air, "{integrator:?}: {force}, {air}");
        let (error, given) = (simulation.energy_error().abs(), simulation.ledger().flow.given);
        assert!(error < 1e-3 * given, "{integrator:?}: {error} J of {given} J");
    }
}

#[test]
fn a_line_afloat_heaves_with_the_stiffness_of_its_waterplane() {
    let (diameter, mass, count) = (0.2, 0.5 * displaced(0.2) / G, 10);
    let hose =
        format!("mass = {mass:?}, diameter = {diameter:?}, axial_stiffness = 1e5, added_mass_normal = 1.0");
    let ends = [
        "position = [0.0, 0.0, 0.0], kind = \"fixed\"",
        "position = [10.01, 0.0, 0.0], kind = \"fixed\"",
    ];
    let simulation = Simulation::new(&line(&hose, ends, 10.0, count, "")).unwrap();
    // the lowest mode of a chain on springs that are lumped by linear shape functions, half of the added mass in the water
    let turn = (std::f64::consts::PI / count as f64).cos();
    let waterplane = RHO * G * diameter * (2.0 + turn) / 3.0;
    let tension = 1e5 * 1e-3 / 1.001 * 2.0 * (1.0 - turn);
    let omega = ((waterplane + tension) / (2.0 * mass)).sqrt();
    let found = modes(&simulation).frequencies;
    let nearest = found.iter().map(|found| (found / omega - 1.0).abs());
    let nearest = nearest.fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-9, "{found:?}, {omega}");
}

#[test]
fn a_line_under_water_does_not_feel_that_it_knows_the_surface() {
    for integrator in ALL {
        let tensions = [true, false].map(|surface| {
            let mut scene = with_integrator(oblique(12), integrator, 0.004);
            for point in &mut scene.points {
                point.position[2] -= 20.0;
            }
            scene.water.as_mut().unwrap().surface = Some(surface);
            let mut simulation = Simulation::new(&scene).unwrap();
            let mut history = Vec::new();
            for step in 0..40 {
                let t = 0.1 * f64::from(step);
                simulation.set_displacement(1, [t.sin(), 0.2 * t, 0.5 * t.sin()]);
                simulation.advance(0.1).unwrap();
                history.push(simulation.tension_b(0));
            }
            history
        });
        // but for rounding: lines that know it are laid out otherwise
        for (with, without) in tensions[0].iter().zip(&tensions[1]) {
            assert_relative_eq!(with, without, max_relative = 1e-10);
        }
    }
}

#[test]
fn the_vessel_stiffness_is_the_slope_of_the_force_where_lines_pierce_the_surface() {
    let mut text = oblique(12).to_toml();
    text = text.replace("kind = \"coupled\"", "kind = \"coupled\"\non = \"ship\"");
    text += "\n[[vessels]]\nname = \"ship\"\nposition = [0.0, 0.0, 0.0]\n";
    let scene = with_integrator(scene(&text), Integrator::QuasiStatic, 0.05);
    let force = |moved: f64, axis: usize| {
        let mut simulation = Simulation::new(&scene).unwrap();
        let mut pose = [0.0; 6];
        pose[axis] = moved;
        for _ in 0..8 {
            simulation.set_pose(0, pose);
            simulation.advance(1.0).unwrap();
        }
        simulation.vessel_force(0)
    };
    let stiffness = Simulation::new(&scene).unwrap().vessel_stiffness(0).unwrap();
    let h = 1e-4;
    for axis in 0..3 {
        let (high, low) = (force(h, axis), force(-h, axis));
        for row in 0..3 {
            let slope = -(high[row] - low[row]) / (2.0 * h);
            let found = stiffness[row][axis];
            assert!(
                (found - slope).abs() < 1e-4 * stiffness[2][2],
                "{row}, {axis}: {found}, {slope}"
            );
        }
    }
}

#[test]
fn an_end_force_is_that_of_all_nodes_in_every_way_of_telling_it() {
    let scene = oblique(12);
    let simulation = Simulation::new(&scene).unwrap();
    let model = simulation.model();
    let of_end = simulation.line_end_force(0, End::B);
    let assembled =
        moorline::elements::end_force(model, simulation.state(), 0, End::B, &mut Workspace::new(model));
    assert!((of_end - assembled).norm() < 1e-9 * of_end.norm());
    let weight: f64 = model.lines[0].nodes.weight.iter().sum();
    let lack: f64 = (0..=12)
        .map(|i| {
            let surface = model.lines[0].surface.as_ref().unwrap();
            surface.node(i, &simulation.state().lines[0].position).weight
        })
        .sum();
    let both = of_end + simulation.line_end_force(0, End::A);
    assert!((both.z + weight + lack).abs() < 1e-6 * weight, "{both}");
}

#[test]
fn lindahls_chain_with_its_fairlead_over_the_water_differs_little_from_the_chain_under_water() {
    let submerged = shipped("lindahl_slow");
    let mut raised = submerged.clone();
    for point in &mut raised.points {
        point.position[2] += 0.3;
    }
    raised.seabed.as_mut().unwrap().depth -= 0.3;
    assert!(raised.meets_surface(&raised.lines[0]));
    assert!(!submerged.meets_surface(&submerged.lines[0]));
    let [wet, air] = [submerged, raised].map(|scene| {
        let mut simulation = following(&scene);
        History::record(&mut simulation, 0.05, 300)
    });
    let error = air.tension_error(&wet, 150);
    println!("RMS tension {error}");
    assert!((1e-4..0.03).contains(&error), "{error}");
}

#[test]
fn a_line_out_of_the_water_has_no_closed_form_and_says_what_it_lacks_there() {
    let piercing = oblique(12);
    let mut submerged = piercing.clone();
    for point in &mut submerged.points {
        point.position[2] -= 20.0;
    }
    assert!(Simulation::new(&piercing).unwrap().catenary(0).is_none());
    assert!(Simulation::new(&submerged).unwrap().catenary(0).is_some());
    let words = piercing.in_words().replace("\n      ", " ");
    let said = "with its surface at z = 0: above it line has no buoyancy, drag and added mass";
    assert!(words.contains(said), "{words}");
    let absent = words.split("not modelled").nth(1).unwrap();
    assert!(absent.contains("current and waves;"), "{words}");
}
