//! Surface-piercing lines in still water: the part above the surface has no buoyancy, no drag and no added mass.

use std::f64::consts::PI;

use crate::common::*;
use approx::assert_relative_eq;
use moorline::elements::{Workspace, end_force};
use moorline::model::End;
use moorline::physics::surface::emerged;
use moorline::scene::{Integrator, Scene};
use moorline::statics::catenary::{self, Section};

/// A rope of 0.1 m and 25 kg/m: 245.2 N/m in air, 166.2 N/m in water.
const ROPE: &str = "mass = 25.0, diameter = 0.1, axial_stiffness = 2e6, axial_damping = 2e4, drag_normal = 1.2, drag_tangential = 0.1, \
                    added_mass_normal = 1.0, added_mass_tangential = 0.2";

/// Buoyancy per length ρ g A for a diameter [N/m].
fn displaced(diameter: f64) -> f64 {
    RHO * G * 0.25 * PI * diameter * diameter
}

/// Water with a surface, and a rope type with these keys.
fn afloat(rope: &str) -> Draft {
    draft(format!(
        "water = {{ density = {RHO}, surface = true }}\nline_types.rope = {{ {rope} }}"
    ))
}

/// A rope from 30 m below the surface to a coupled point 8 m above it, 40 m away.
///
///                   ● b (40, 8)
///      ~~~~~~~~~~~ / ~~~~~
///   a ●___________/
///     (0, −30)
fn oblique(elements: usize) -> Draft {
    let ends = afloat(ROPE)
        .fixed("a", [0.0, 0.0, -30.0])
        .coupled("b", [40.0, 0.0, 8.0]);
    ends.line("line", ["a", "b"], "rope", 60.0, elements)
}

/// The same rope 20 m deeper, fully submerged.
fn submerged(elements: usize) -> Scene {
    let mut scene = oblique(elements).scene();
    scene
        .points
        .iter_mut()
        .for_each(|point| point.position[2] -= 20.0);
    scene
}

#[test]
fn a_cable_that_hangs_half_out_of_the_water_weighs_what_it_weighs_in_air_and_in_water() {
    for elements in [7, 20] {
        let simulation = afloat(&ROPE.replace("2e6", "1e11"))
            .free("a", [0.0, 0.0, -9.7])
            .with("mass = 0.001")
            .fixed("b", [0.0, 0.0, 10.3])
            .line("line", ["a", "b"], "rope", 20.0, elements)
            .start();
        let weight = 25.0 * G * 20.0 - displaced(0.1) * 9.7 + 0.001 * G;
        let [x, y, z] = simulation.end_force(1);
        assert!(x.abs() + y.abs() < 1e-9 * weight);
        assert!((z + weight).abs() < 1e-7 * weight, "{z}, {weight}");
        assert!((simulation.tension_b(0) - weight).abs() < 1e-7 * weight);
    }
}

#[test]
fn a_line_afloat_lies_at_the_draught_where_its_weight_is_its_buoyancy() {
    for (mass, span) in [(2.0, 100.5), (6.0, 100.5), (4.0, 99.0), (6.5, 95.0)] {
        let hose = afloat(&format!("mass = {mass:?}, diameter = 0.1, axial_stiffness = 1e6"));
        let hose = hose.fixed("a", [0.0; 3]).fixed("b", [span, 0.0, 0.0]);
        let state = statics(&hose.line("line", ["a", "b"], "rope", 100.0, 200).model());
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
    let solve =
        |s: f64| catenary::solve(&[section(s, wet), section(60.0 - s, air)], 40.0, 38.0, None).unwrap();
    // submerged length, from the height of its end
    let exact = solve(bisect([20.0, 59.0], |s| solve(s).at(s).z - 30.0));
    let sizes = [16, 32, 64, 128, 256];
    let errors = sizes.map(|n| {
        let [x, _, z] = oblique(n).start().end_force(1);
        (x + exact.horizontal()).hypot(z + exact.vertical_b()) / exact.tension_b()
    });
    assert_order(-2.0, &sizes.map(|n| n as f64), &errors);
    assert!(errors[4] < 2e-5, "{errors:?}");
}

#[test]
fn an_equilibrium_stays_at_rest_for_600_s() {
    for integrator in INTEGRATORS {
        let drift = relative_drift(&with_integrator(oblique(12).scene(), integrator, 0.05), 600);
        assert!(drift < 1e-9, "{integrator:?}: {drift:e}");
    }
}

/// The oblique rope with an upper end that moves into the water and out; leapfrogs without axial damping, which they evaluate
/// at a lagged velocity.
fn dipping(elements: usize, integrator: Integrator, step: f64) -> Scene {
    let moved = oblique(elements).and("motion.b = { x = [[3.0, 7.0]], z = [[9.0, 9.0]], ramp = 4.0 }");
    let mut scene = with_integrator(moved.scene(), integrator, step);
    if integrator != Integrator::Leapfrog {
        scene.solver.spectral_radius = Some(1.0);
    }
    if integrator != Integrator::GeneralisedAlpha {
        scene.line_types.get_mut("rope").unwrap().axial_damping = Some(0.0);
    }
    scene
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "takes long")]
fn a_line_that_dips_in_and_out_is_followed_to_second_order_in_time() {
    let dipped = |integrator: Integrator, step: f64| {
        let mut simulation = following(&balanced(dipping(8, integrator, step)));
        run(&mut simulation, 0.5, 16);
        nodes(&simulation)[1..8].to_vec()
    };
    for integrator in INTEGRATORS {
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
fn the_energy_balance_of_a_line_that_dips_in_and_out_closes_with_the_step() {
    for integrator in INTEGRATORS {
        let [coarse, fine] = [0.008, 0.001].map(|step| {
            let mut simulation = following(&balanced(dipping(8, integrator, step)));
            let mut worst = 0.0_f64;
            for _ in 0..16 {
                simulation.advance(0.5).unwrap();
                worst = worst.max(balance_error(&simulation).abs());
            }
            worst / flow(&simulation).dissipation.abs()
        });
        println!("{integrator:?}: {coarse:e}, {fine:e} of the energy lost");
        assert!(fine < 1e-4 && fine < 0.1 * coarse, "{integrator:?}");
    }
}

#[test]
fn a_line_that_is_hauled_out_of_the_water_ends_with_its_weight_in_air() {
    let air = (50.0 + 25.0 * 20.0) * G;
    let wet = air - displaced(0.1) * 20.0;
    let hauled = afloat(ROPE)
        .and("motion.b = { table = [[0.0, 0.0, 0.0, 0.0], [5.0, 0.0, 0.0, 0.0], [35.0, 0.0, 0.0, 40.0]] }")
        .free("a", [0.0, 0.0, -28.0])
        .with("mass = 50.0")
        .coupled("b", [0.0, 0.0, -8.0])
        .line("line", ["a", "b"], "rope", 20.0, 10)
        .scene();
    for integrator in JOINED {
        let scene = with_integrator(hauled.clone(), integrator, 0.01);
        let force = start(&scene).end_force(1)[2];
        assert!((force + wet).abs() < 1e-6 * wet, "{force}, {wet}");
        let mut simulation = following(&balanced(scene));
        run(&mut simulation, 0.05, 1200);
        let force = simulation.end_force(1)[2];
        assert!((force + air).abs() < 1e-3 * air, "{integrator:?}: {force}, {air}");
        let error = error_of_given(&simulation);
        assert!(error < 1e-3, "{integrator:?}: {error:e} of the work given");
    }
}

#[test]
fn a_line_afloat_heaves_with_the_stiffness_of_its_waterplane() {
    let (diameter, mass, count) = (0.2, 0.5 * displaced(0.2) / G, 10);
    let hose = format!("mass = {mass:?}, diameter = 0.2, axial_stiffness = 1e5, added_mass_normal = 1.0");
    let hose = afloat(&hose).fixed("a", [0.0; 3]).fixed("b", [10.01, 0.0, 0.0]);
    let simulation = hose.line("line", ["a", "b"], "rope", 10.0, count).start();
    // lowest mode of a chain on springs that are lumped by linear shape functions, with half of the added mass submerged
    let turn = (PI / count as f64).cos();
    let waterplane = RHO * G * diameter * (2.0 + turn) / 3.0;
    let tension = 1e5 * 1e-3 / 1.001 * 2.0 * (1.0 - turn);
    let omega = ((waterplane + tension) / (2.0 * mass)).sqrt();
    let found = modes(&simulation).frequencies;
    let nearest = found.iter().map(|found| (found / omega - 1.0).abs());
    let nearest = nearest.fold(f64::INFINITY, f64::min);
    assert!(nearest < 1e-9, "{found:?}, {omega}");
}

#[test]
fn a_line_under_water_moves_alike_with_and_without_a_surface() {
    for integrator in INTEGRATORS {
        let tensions = [true, false].map(|surface| {
            let mut scene = with_integrator(submerged(12), integrator, 0.004);
            scene.water.as_mut().unwrap().surface = Some(surface);
            let mut simulation = start(&scene);
            let tension = |step| {
                let t = 0.1 * f64::from(step);
                simulation.set_displacement(1, [t.sin(), 0.2 * t, 0.5 * t.sin()]);
                simulation.advance(0.1).unwrap();
                simulation.tension_b(0)
            };
            (0..40).map(tension).collect::<Vec<f64>>()
        });
        // except for rounding: lines that may pierce the surface are computed differently
        for (with, without) in tensions[0].iter().zip(&tensions[1]) {
            assert_relative_eq!(with, without, max_relative = 1e-10);
        }
    }
}

#[test]
fn the_vessel_stiffness_is_the_slope_of_the_force_where_lines_pierce_the_surface() {
    let mut text = oblique(12).scene().to_toml();
    text = text.replace("kind = \"coupled\"", "kind = \"coupled\"\non = \"ship\"");
    text += "\n[[vessels]]\nname = \"ship\"\nposition = [0.0, 0.0, 0.0]\n";
    let scene = with_integrator(scene(&text), Integrator::QuasiStatic, 0.05);
    let force = |moved: f64, axis: usize| {
        let mut simulation = start(&scene);
        let mut pose = [0.0; 6];
        pose[axis] = moved;
        for _ in 0..8 {
            simulation.set_pose(0, pose);
            simulation.advance(1.0).unwrap();
        }
        simulation.vessel_force(0)
    };
    let stiffness = start(&scene).vessel_stiffness(0).unwrap();
    let h = 1e-4;
    for axis in 0..3 {
        let (high, low) = (force(h, axis), force(-h, axis));
        for row in 0..3 {
            let slope = -(high[row] - low[row]) / (2.0 * h);
            let error = (stiffness[row][axis] - slope).abs();
            assert!(error < 1e-4 * stiffness[2][2], "{row}, {axis}: {error}, {slope}");
        }
    }
}

#[test]
fn an_end_force_is_the_sum_over_all_nodes_by_every_accessor() {
    let simulation = oblique(12).start();
    let model = simulation.model();
    let of_end = simulation.line_end_force(0, End::B);
    let assembled = end_force(model, simulation.state(), 0, End::B, &mut Workspace::new(model));
    assert!((of_end - assembled).norm() < 1e-9 * of_end.norm());
    let weight: f64 = model.lines[0].nodes.weight.iter().sum();
    let surface = model.lines[0].surface.as_ref().unwrap();
    let lack: f64 = (0..=12).map(|i| surface.node(i, nodes(&simulation)).weight).sum();
    let both = of_end + simulation.line_end_force(0, End::A);
    assert!((both.z + weight + lack).abs() < 1e-6 * weight, "{both}");
}

#[test]
fn lindahls_chain_with_its_fairlead_over_the_water_differs_little_from_the_chain_under_water() {
    let submerged = shipped("lindahl_slow");
    let mut raised = submerged.clone();
    raised
        .points
        .iter_mut()
        .for_each(|point| point.position[2] += 0.3);
    raised.seabed.as_mut().unwrap().depth -= 0.3;
    assert!(raised.meets_surface(&raised.lines[0]));
    assert!(!submerged.meets_surface(&submerged.lines[0]));
    let [wet, air] = [submerged, raised].map(|scene| History::record(&mut following(&scene), 0.05, 300));
    let error = air.tension_error(&wet, 150);
    println!("RMS tension {error}");
    assert!((1e-4..0.03).contains(&error), "{error}");
}

#[test]
fn a_line_out_of_the_water_has_no_closed_form_and_check_says_what_it_lacks_there() {
    let piercing = oblique(12).scene();
    assert!(start(&piercing).catenary(0).is_none());
    assert!(start(&submerged(12)).catenary(0).is_some());
    let words = in_words(&piercing);
    assert_says(
        &words,
        &["with a free surface at z = 0, above which line has no buoyancy, drag or added mass"],
    );
    let absent = words.split("not modelled").nth(1).unwrap();
    assert_says(absent, &["current and waves;"]);
}
