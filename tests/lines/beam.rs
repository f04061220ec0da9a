//! Geometrically exact beam against published and closed-form solutions, through scenes as a user writes them.

use std::f64::consts::{PI, TAU};

use crate::common::*;
use approx::assert_relative_eq;
use moorline::dynamics::beam::BeamView;
use moorline::scene::{Axis, InitialShape, Integrator, LineModel, PointKind, Scene, TimeFunction};
use moorline::simulation::Simulation;
use nalgebra::Vector3;

/// The flying rod with `elements` elements and a time step [s].
fn spaghetti(elements: usize, step: f64) -> Scene {
    let mut scene = with_elements(shipped("flying_spaghetti"), elements);
    scene.solver.time_step_max = step;
    scene
}

/// Stored energy [J], from the energy balance.
fn energy(simulation: &Simulation) -> f64 {
    let balance = simulation.energy_balance().unwrap();
    balance_error(simulation) + balance.start + balance.flow.external_work - balance.flow.dissipation
}

/// Asserts for a flight of 10 s in steps of 0.1 s that the impulse is exact and energy and momenta are constant after the load.
fn assert_conserves(scene: &Scene) {
    let mut simulation = start(&balanced(scene.clone()));
    run(&mut simulation, 0.1, 25);
    let (start, before) = (energy(&simulation), simulation.momentum());
    assert_relative_eq!(before.linear, Vector3::new(20.0, 0.0, 0.0), epsilon = 1e-11);
    for _ in 25..100 {
        simulation.advance(0.1).unwrap();
        let now = simulation.momentum();
        assert_relative_eq!(energy(&simulation), start, max_relative = 1e-10);
        assert_relative_eq!(now.linear, before.linear, epsilon = 1e-11);
        let turned = (now.angular - before.angular).norm();
        assert!(turned < 1e-10 * before.angular.norm(), "{turned:e}");
        assert_eq!(simulation.substeps(), 1);
    }
    assert!(balance_error(&simulation).abs() < 1e-9 * start);
}

#[test]
fn a_flying_rod_keeps_energy_and_momenta_to_rounding() {
    let mut opposed = shipped("flying_spaghetti");
    let moment = opposed.points[0].moment.as_mut().unwrap();
    moment.z = Some(TimeFunction::Table(vec![[2.5, 80.0], [2.5, 0.0]]));
    for stiffness in [100.0, 500.0] {
        for mut scene in [
            shipped("flying_spaghetti"),
            opposed.clone(),
            shipped("flying_spaghetti_3d"),
        ] {
            for line_type in scene.line_types.values_mut() {
                line_type.bending_stiffness = Some(stiffness);
                line_type.torsional_stiffness = Some(stiffness);
            }
            assert_conserves(&scene);
        }
    }
}

#[test]
fn a_flying_rod_tends_to_the_converged_flight_at_second_order() {
    // Displacements of A and B [m] at 2.5, 5 and 10 s from spectral elements, converged to 5e-6 m; energy [J] after 2.5 s.
    let reference = [
        [[-1.036_913_2, 4.476_005_5], [3.583_146_0, -1.888_104_1]],
        [[3.783_685_3, 8.203_803_1], [8.074_362_2, -6.241_153_4]],
        [[16.970_853_5, 6.411_931_2], [21.324_745_5, -4.390_124_5]],
    ];
    let mut errors = Vec::new();
    for n in [20, 40, 80, 160] {
        let step = 2.0 / n as f64;
        let mut simulation = start(&balanced(spaghetti(n, step)));
        let ends = |simulation: &Simulation| [nodes(simulation)[0], nodes(simulation)[n]];
        let (first, mut held) = (ends(&simulation), Vec::new());
        let error = [5 * n / 4, 5 * n / 4, 5 * n / 2]
            .into_iter()
            .zip(reference)
            .map(|(count, reference)| {
                run(&mut simulation, step, count);
                held.push(energy(&simulation));
                let now = ends(&simulation);
                let miss = |end: usize| {
                    let [x, y] = reference[end];
                    (now[end] - first[end] - Vector3::new(x, y, 0.0)).norm()
                };
                miss(0).max(miss(1))
            });
        let error: Vec<f64> = error.collect();
        if n == 160 {
            assert!(error[0] < 2e-3 && error[1] < 2e-3 && error[2] < 1e-2, "{error:?}");
            assert_relative_eq!(held[0], 379.573_203, max_relative = 2e-4);
        }
        errors.push((step, error.iter().map(|e| e * e).sum::<f64>().sqrt()));
    }
    assert_orders(2.0, &errors);
}

/// A weightless beam along x from the origin: EI 1 N m², 1 kg/m, EA and GA [N] high enough for Euler-Bernoulli theory; `tip` adds its end.
fn slender(elements: usize, stiffness: f64, clamps: &str, tip: impl Fn(Draft) -> Draft) -> Scene {
    let beam = draft(format!(
        "gravity = 0.0
        line_types.rod = {{ model = 'beam', mass = 1.0, axial_stiffness = {stiffness}, shear_stiffness = {stiffness},
          bending_stiffness = 1.0, torsional_stiffness = 1.0, rotary_inertia = 1.0e-7 }}"
    ));
    let beam = tip(beam.fixed("a", [0.0; 3])).line("rod", ["a", "b"], "rod", 1.0, elements);
    beam.with(clamps).scene()
}

/// A cantilever with these keys of its tip.
fn cantilever(elements: usize, keys: &str) -> Simulation {
    let tip = |beam: Draft| beam.free("b", [1.0, 0.0, 0.0]).with(keys);
    start(&slender(elements, 1e6, CLAMP, tip))
}

const CLAMP: &str = "clamped_a = [1.0, 0.0, 0.0]";

#[test]
fn the_statics_of_a_cantilever_tend_to_the_elastica_at_second_order() {
    // Bisshopp & Drucker (1945), Quart. Appl. Math. 3, 272-275, here to 16 digits: PL²/EI, deflection/L, shortening/L
    for (load, deflection, shortening) in [
        (1.0, 0.301_720_773_799_813_5, 0.056_433_236_283_376_88),
        (10.0, 0.810_609_024_880_296_4, 0.554_995_597_753_751_3),
    ] {
        let exact = Vector3::new(1.0 - shortening, deflection, 0.0);
        assert_orders(
            2.0,
            &[8, 16, 32, 64].map(|n| {
                let rod = cantilever(n, &format!("force = {{ y = {load} }}"));
                (1.0 / n as f64, (nodes(&rod)[n] - exact).norm())
            }),
        );
    }
}

#[test]
fn an_end_moment_rolls_a_cantilever_up_to_a_circle() {
    assert!(nodes(&cantilever(40, "moment = { z = 6.283185307179586 }"))[40].norm() < 1e-5);
}

/// Asserts that the first natural frequency converges to a closed form [rad/s] at second order, over meshes of 8 to 64 elements with
/// proportional steps, for a slender beam with an initial displacement of 1e-6 m times `shape` of x/L.
fn assert_frequency(exact: f64, shape: impl Fn(f64) -> f64, beam: impl Fn(usize) -> Scene) {
    assert_orders(
        2.0,
        &[8, 16, 32, 64].map(|n| {
            let steps = 10 * n; // of a period
            let mut scene = beam(n);
            let chord = scene.points[1].position[0];
            let parts: Vec<f64> = (0..=n).map(|i| i as f64 / n as f64).collect();
            let nodes_at = parts.iter().map(|x| [x * chord, 0.0, 1e-6 * shape(*x)]);
            scene.lines[0].initial = InitialShape::Nodes(nodes_at.collect());
            let step = TAU / exact / steps as f64;
            scene.solver.time_step_max = step;
            let mut simulation = start(&scene);
            // projected onto the mode, which removes other components of the initial displacement
            let sample = |_| {
                simulation.advance(step).unwrap();
                nodes(&simulation)
                    .iter()
                    .zip(&parts)
                    .map(|(r, x)| r.z * shape(*x))
                    .sum()
            };
            let samples: Vec<f64> = (0..21 * steps / 4).map(sample).collect();
            (
                1.0 / n as f64,
                (PI / half_period(&samples, step) / exact - 1.0).abs(),
            )
        }),
    );
}

/// Euler-Bernoulli mode of a beam clamped at x = 0, with the coefficient of its sines [-].
fn clamped_mode(beta: f64, sigma: f64) -> impl Fn(f64) -> f64 {
    move |x: f64| {
        let u = beta * x;
        u.cosh() - u.cos() - sigma * (u.sinh() - u.sin())
    }
}

#[test]
fn the_frequency_of_a_cantilever_tends_to_the_closed_form_at_second_order() {
    let beta: f64 = 1.875_104_068_711_961_2; // cos βL cosh βL = −1
    let mode = clamped_mode(beta, (beta.cosh() + beta.cos()) / (beta.sinh() + beta.sin()));
    let tip = |beam: Draft| beam.free("b", [1.0, 0.0, 1e-6 * mode(1.0)]);
    assert_frequency(beta * beta, &mode, |n| slender(n, 1e6, CLAMP, tip));
}

#[test]
fn the_frequency_of_a_beam_clamped_at_both_ends_tends_to_the_closed_form_at_second_order() {
    let beta: f64 = 4.730_040_744_862_704; // cos βL cosh βL = 1
    let mode = clamped_mode(beta, (beta.cosh() - beta.cos()) / (beta.sinh() - beta.sin()));
    let clamps = "clamped_a = [1.0, 0.0, 0.0], clamped_b = [1.0, 0.0, 0.0]";
    let far = |beam: Draft| beam.fixed("b", [1.0, 0.0, 0.0]);
    assert_frequency(beta * beta, mode, |n| slender(n, 1e6, clamps, far));
}

#[test]
fn the_frequency_of_a_tensioned_beam_tends_to_the_closed_form_at_second_order() {
    // pinned ends: ω² = (π/L)⁴ EI/m + (π/L)² T/m; the stretch for T = 10 N changes L and m only by 1e-6
    let (stiffness, stretch) = (1e7, 1e-6);
    let exact = (PI.powi(4) + PI.powi(2) * stiffness * stretch).sqrt();
    let far = |beam: Draft| beam.fixed("b", [1.0 + stretch, 0.0, 0.0]);
    assert_frequency(exact, |x| (PI * x).sin(), |n| slender(n, stiffness, "", far));
}

/// A clamped rod whose end B is twisted about its axis by `turns` revolutions in 10 s and then moved in by half the length in 20 s.
fn hockle(elements: usize, turns: f64) -> Scene {
    let angle = TAU * turns;
    draft(format!(
        "gravity = 9.81
        line_types.rod = {{ model = 'beam', mass = 1.0, axial_stiffness = 1.0e5, shear_stiffness = 4.0e4, bending_stiffness = 100.0,
          torsional_stiffness = 80.0, rotary_inertia = 0.01, rayleigh = {{ ratios = [0.02, 0.02], frequencies = [2.0, 20.0] }} }}
        vessels = [{{ name = 'winch', position = [10.0, 0.0, 0.0] }}]
        solver.time_step_max = 0.02
        motion.winch = {{ table = [[0.0, 0, 0, 0, 0, 0, 0], [10.0, 0, 0, 0, {angle}, 0, 0], [30.0, -5.0, 0, 0, {angle}, 0, 0],
          [35.0, -5.0, 0, 0, {angle}, 0, 0]] }}"
    ))
    .fixed("a", [0.0; 3])
    .coupled("b", [0.0; 3])
    .with("on = 'winch'")
    .line("rod", ["a", "b"], "rod", 10.0, elements)
    .with("clamped_a = [1.0, 0.0, 0.0], clamped_b = [1.0, 0.0, 0.0]")
    .scene()
}

/// Follows a hockle to the end and checks for finite values; returns the simulation there, or the message of a failed step.
fn twist_and_slacken(scene: &Scene) -> Result<Simulation, String> {
    let mut simulation = following(scene);
    for _ in 0..350 {
        simulation.advance(0.1).map_err(|error| error.to_string())?;
        assert!(nodes(&simulation).iter().flatten().all(|x| x.is_finite()));
    }
    Ok(simulation)
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_twisted_rod_drawn_in_leaves_its_plane_and_its_energy_balance_closes() {
    for (elements, turns) in [(40, 2.0), (80, 4.0)] {
        let end = twist_and_slacken(&balanced(hockle(elements, turns))).unwrap();
        assert!(balance_error(&end).abs() < 1e-8);
    }
    let [flat, twisted] = [0.0, 2.0].map(|turns| {
        let mut simulation = following(&hockle(40, turns));
        run(&mut simulation, 0.1, 250);
        greatest(nodes(&simulation).iter().map(|r| r.y.abs()))
    });
    assert!(flat < 1e-6 && twisted > 0.5, "{flat} m, {twisted} m");
}

#[test]
fn a_hockle_too_tight_for_its_elements_is_refused_in_words() {
    let message = twist_and_slacken(&hockle(40, 4.0)).unwrap_err();
    assert_says(&message, &["more than 60 degrees", "use more elements"]);
}

#[test]
fn the_moments_of_a_cantilever_under_an_end_load_grow_straight_to_its_clamp() {
    let simulation = cantilever(10, "force = { z = 0.001 }");
    let line = &simulation.model().lines[0];
    let view = BeamView::of(line, &simulation.state().lines[0]).unwrap();
    for node in 0..=10 {
        let moment = 0.001 * (1.0 - 0.1 * node as f64);
        assert_relative_eq!(view.bending_moment(node), moment, epsilon = 1e-9);
        assert_relative_eq!(view.curvature(node), moment, epsilon = 1e-9); // EI is 1 N m²
    }
    let force = Vector3::from(simulation.end_force(0));
    assert_relative_eq!(force, 0.001 * Vector3::z(), epsilon = 1e-10);
    assert_relative_eq!(simulation.end_moment(0), -0.001 * Vector3::y(), epsilon = 1e-9);
}

/// The OC3 line as a beam with a bending stiffness [N m²].
fn mooring_beam(bending: f64) -> Scene {
    let mut scene = shipped("oc3_catenary");
    for line_type in scene.line_types.values_mut() {
        line_type.model = LineModel::Beam;
        line_type.bending_stiffness = Some(bending);
        line_type.torsional_stiffness = Some(bending);
        line_type.shear_stiffness = Some(1e8);
        line_type.rotary_inertia = Some(0.04);
    }
    scene
}

#[test]
fn a_mooring_line_as_a_supple_beam_hangs_and_moves_as_the_line_does() {
    let [mut line, mut beam] = [shipped("oc3_catenary"), mooring_beam(1.0)].map(|scene| following(&scene));
    assert_relative_eq!(beam.tension_b(0), line.tension_b(0), max_relative = 1e-4);
    let [line, beam] = [&mut line, &mut beam].map(|simulation| History::record(simulation, 0.05, 800));
    let (moved, tension) = (beam.middle_error(&line, 400), beam.tension_error(&line, 400));
    assert!(moved < 0.01 && tension < 0.05, "{moved}, {tension}");
}

#[test]
fn bending_stiffness_from_a_hair_to_a_girder_finds_its_rest_on_the_seabed() {
    let mut last = f64::INFINITY;
    for bending in [1e-6, 1.0, 1e3, 1e5, 1e7, 1e9, 1e11] {
        let tension = start(&mooring_beam(bending)).tension_b(0);
        assert!(tension < last * (1.0 + 1e-6), "{bending}: {tension}");
        last = tension;
    }
}

/// Tip [m] at rest of a 100 m cable that is clamped along a seabed; its free end starts 55 m above the seabed.
fn dropped(elements: usize, keys: &str) -> Vector3<f64> {
    let cable = draft(
        "water.density = 1025.0
        seabed.depth = 60.0
        line_types.cable = { model = 'beam', mass = 30.0, diameter = 0.15, axial_stiffness = 4e8, bending_stiffness = 1e4,
          shear_stiffness = 1e8, torsional_stiffness = 1e4, rotary_inertia = 0.1 }",
    );
    let ends = cable.fixed("a", [0.0, 0.0, -60.0]).free("b", [60.0, 0.0, -5.0]);
    let line = ends.with(keys).line("l", ["a", "b"], "cable", 100.0, elements);
    place(&line.with(CLAMP).start(), "b")
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_beam_that_drops_to_the_seabed_finds_the_same_rest_on_every_mesh() {
    let turned = "mass = 10.0, free = ['x', 'z'], moment = { z = -80.0 }";
    for keys in [turned, "mass = 10.0, moment = { z = -80.0 }", "mass = 10.0"] {
        let finest = dropped(20_000, keys);
        for elements in [8, 10, 13, 20, 31, 40, 64, 100, 160, 320, 640, 1500, 5000] {
            let tip = dropped(elements, keys);
            let far = (tip - finest).xy().norm();
            assert!(
                far < 1.5 / (elements * elements) as f64 + 1e-6,
                "{elements}: {tip}"
            );
        }
    }
}

/// The end is slightly higher than the cable at rest, so that the moment about the vertical has a component along the cable.
#[test]
fn a_moment_along_a_beam_that_no_end_holds_is_why_there_is_no_equilibrium() {
    let scene = |moment: &str, keys: &str| {
        draft(
            "seabed = { depth = 60.0 }
            line_types.cable = { mass = 30.0, weight = 117.0, diameter = 0.15, axial_stiffness = 4e8, model = 'beam', \
            bending_stiffness = 1e4, shear_stiffness = 1e8, torsional_stiffness = 1e4, rotary_inertia = 0.1 }",
        )
        .fixed("a", [0.0, 0.0, -60.0])
        .free("b", [60.0, 0.0, -5.0])
        .with("free = ['x', 'z'], mass = 10.0")
        .with(moment)
        .line("l", ["a", "b"], "cable", 100.0, 20)
        .with(keys)
        .scene()
    };
    let about_z = "moment = { z = -80.0 }";
    let error = Simulation::new(&scene(about_z, "")).unwrap_err().to_string();
    assert!(
        error.contains("N m along the beam, which turns it about its axis"),
        "{error}"
    );
    for (moment, keys) in [
        ("moment = { y = -80.0 }", ""),
        (about_z, "clamped_a = [1.0, 0.0, 0.0]"),
    ] {
        start(&scene(moment, keys));
    }
}

#[test]
fn a_beam_in_water_over_a_seabed_has_an_energy_balance_that_closes() {
    let mut beam = following(&balanced(mooring_beam(1e5)));
    let start = beam.energy_balance().unwrap().start.abs();
    run(&mut beam, 0.05, 400);
    assert!(flow(&beam).dissipation > 1e3);
    let error = balance_error(&beam).abs();
    assert!(error < 1e-9 * start, "{error:e}");
}

/// A 20 m line from a point at z = `anchor` [m] to a free point, as a cable or as a flexible beam.
fn tethered(model: &str, anchor: f64, position: [f64; 3], keys: &str) -> Simulation {
    let beam = ", shear_stiffness = 1e6, torsional_stiffness = 500.0, rotary_inertia = 0.01";
    let beam = if model == "beam" { beam } else { "" };
    draft(format!(
        "water.density = 1025.0
        seabed = {{ depth = 30.0, stiffness = 1e5, damping = 1e4, friction = 0.0 }}
        line_types.tether = {{ model = '{model}', mass = 2.0, diameter = 0.03, axial_stiffness = 1e6, axial_damping = 1e3,
          bending_stiffness = 500.0, drag_normal = 1.2, added_mass_normal = 1.0{beam} }}
        solver.time_step_max = 0.005
        output.energy_balance = true"
    ))
    .fixed("anchor", [0.0, 0.0, anchor])
    .free("free", position)
    .with(keys)
    .line("tether", ["anchor", "free"], "tether", 20.0, 20)
    .start()
}

#[test]
fn a_buoy_on_a_beam_heaves_as_it_does_on_a_cable() {
    let buoy = "mass = 300.0, volume = 1.0, drag_area = 0.5, added_mass = 0.5,
        force = { x = 500.0, z = { table = [[1.0, 0.0], [1.0, -3000.0]] } }";
    let [beam, cable] = ["beam", "cable"].map(|model| {
        let mut simulation = tethered(model, -12.0, [14.0, 0.0, 0.0], buoy);
        let moved = |_| {
            simulation.advance(0.05).unwrap();
            place(&simulation, "free")
        };
        let places: Vec<Vector3<f64>> = (0..160).map(moved).collect();
        (places, simulation)
    });
    let heights = beam.0.iter().map(|place| place.z);
    let heave = greatest(heights.clone()) + greatest(heights.map(|z| -z));
    assert!(heave > 0.3, "{heave} m");
    for (of_beam, of_cable) in beam.0.iter().zip(&cable.0) {
        assert_relative_eq!(of_beam, of_cable, epsilon = 5e-3);
    }
    let flow = flow(&beam.1);
    assert!(balance_error(&beam.1).abs() < 1e-9 * (flow.external_work.abs() + flow.dissipation));
}

#[test]
fn a_clump_at_the_end_of_a_beam_rests_on_the_seabed() {
    let clump = "mass = 500.0, volume = 0.1, force = { x = 300.0 }";
    let mut simulation = tethered("beam", -20.0, [15.0, 0.0, -29.5], clump);
    let rest = place(&simulation, "free");
    assert_relative_eq!(rest.z, -30.0, epsilon = 0.02);
    run(&mut simulation, 0.1, 20);
    assert_relative_eq!(place(&simulation, "free"), rest, epsilon = 1e-6);
}

#[test]
fn a_saved_beam_replays_bit_for_bit() {
    let scene = shipped("flying_spaghetti_3d");
    let mut simulation = start(&scene);
    run(&mut simulation, 0.1, 30);
    assert_replays(simulation, start(&scene), |simulation| run(simulation, 0.1, 30));
}

#[test]
fn a_clamped_end_that_its_vessel_turns_takes_the_beam_along() {
    let mut simulation = start(&hockle(20, 0.0));
    simulation.set_pose(0, [0.0, 0.0, 0.0, 0.0, 0.3, 0.0]);
    simulation.restart(0.0).unwrap();
    let direction = |simulation: &Simulation| {
        let shape = simulation.state().lines[0].beam.as_ref().unwrap();
        shape.frames[20].column(2).into_owned()
    };
    let pitched = |angle: f64| Vector3::new(angle.cos(), 0.0, -angle.sin());
    assert_relative_eq!(direction(&simulation), pitched(0.3), epsilon = 1e-12);
    for step in 1..=50 {
        simulation.set_pose(0, [0.0, 0.0, 0.0, 0.0, 0.3 - 0.01 * f64::from(step), 0.0]);
        simulation.advance(0.1).unwrap();
    }
    run(&mut simulation, 0.1, 3);
    assert_relative_eq!(direction(&simulation), pitched(-0.2), epsilon = 1e-3);
    let [_, _, _, _, moment, _] = simulation.vessel_force(0);
    assert!(moment.abs() > 1.0);
}

#[test]
fn scenes_that_beams_cannot_serve_are_refused_with_their_place() {
    let refused = |change: &dyn Fn(&mut Scene)| {
        let mut scene = mooring_beam(1e5);
        change(&mut scene);
        Simulation::new(&scene)
            .err()
            .map_or(String::new(), |error| error.to_string())
    };
    let message = refused(&|scene| scene.solver.integrator = Integrator::Leapfrog);
    assert_says(&message, &["solver.integrator", "\"beam\""]);
    let message = refused(&|scene| scene.solver.integrator = Integrator::QuasiStatic);
    assert_says(&message, &["solver.integrator"]);
    let message = refused(&|scene| {
        let mut second = scene.lines[0].clone();
        second.name = "line2".into();
        scene.lines.push(second);
        scene.points[1].kind = PointKind::Free;
        scene.motion.clear();
    });
    assert_says(&message, &["meets another line at the free point"]);
    assert_eq!(refused(&|_| {}), "");
}

/// MotionSolve's wire and collar as a beam with EI 10.85 N m².
fn collar(elements: usize) -> Scene {
    let mut scene = with_elements(shipped("collar"), elements);
    let wire = scene.line_types.get_mut("wire").unwrap();
    wire.model = LineModel::Beam;
    wire.bending_stiffness = Some(10.85);
    wire.torsional_stiffness = Some(8.0);
    wire.shear_stiffness = Some(1e8);
    wire.rotary_inertia = Some(1e-5);
    wire.axial_stiffness = Some(1e9);
    scene.solver.integrator = Integrator::Beam;
    scene
}

#[test]
fn a_heavy_collar_that_slides_has_an_energy_balance_that_closes() {
    let mut scene = collar(20);
    scene.points[1].mass = Some(3.0);
    for free in [vec![Axis::X], vec![Axis::X, Axis::Z]] {
        scene.points[1].free = Some(free);
        let mut simulation = start(&balanced(scene.clone()));
        run(&mut simulation, 0.05, 160);
        assert!(flow(&simulation).external_work > 1.0);
        assert!(balance_error(&simulation).abs() < 1e-8);
    }
}

#[test]
fn a_sliding_collar_draws_a_bending_wire_to_its_published_span_at_second_order() {
    // MotionSolve's wire, 20 m and 0.2 kg/m under 20 N, as a solid rod: span and sag [m] of the inextensible limit
    let reference = [17.7404, 4.0520];
    let meshes = [20, 40, 80, 160].map(|elements| {
        let mut scene = collar(elements);
        scene.points[1].force.as_mut().unwrap().x = Some(TimeFunction::Constant(20.0));
        let rest = start(&scene);
        [rest.state().points[1].position.x, rest.sag(0)]
    });
    for (found, published) in meshes[3].iter().zip(reference) {
        assert!((found - published).abs() < 2e-4, "{found}");
    }
    let changes = [0, 1, 2].map(|i| (meshes[i][0] - meshes[i + 1][0]).abs());
    for pair in changes.windows(2) {
        assert!(((pair[0] / pair[1]).log2() - 2.0).abs() < 0.1, "{changes:?}");
    }
}

/// A beam in water over a seabed, with a moving fairlead; the seed determines stiffnesses, lengths, ends and motions.
fn any_beam(seed: &mut u64) -> Scene {
    let mut decades = |low: f64, high: f64| 10.0_f64.powf(low + (high - low) * random(seed));
    let (ea, ei) = (decades(6.0, 9.0), decades(0.0, 6.0));
    let (ga, gj) = (decades(6.0, 8.0), ei * decades(-0.5, 0.5));
    let (inertia, slack) = (decades(-5.0, 0.0), decades(-3.0, -0.9) + 0.99);
    let (period, amplitude) = (decades(0.5, 1.3), decades(-1.0, 0.0));
    let elements = decades(1.2, 1.9) as usize;
    let stiff = ei > 1e4; // the bend at a clamp is √(EI/T) long, and elements must be shorter
    let given = [0, 1].map(|_| random(seed) < 0.5 && stiff);
    let clamps: Vec<String> = ["clamped_a", "clamped_b"]
        .iter()
        .zip(given)
        .filter(|(_, given)| *given)
        .map(|(key, _)| {
            format!(
                "{key} = {:?}",
                [0.5 + random(seed), random(seed) - 0.5, random(seed) - 0.5]
            )
        })
        .collect();
    let b = [10.0 + 40.0 * random(seed), 5.0 * random(seed), -5.0];
    let chord = (b[0] * b[0] + b[1] * b[1] + 15.0 * 15.0_f64).sqrt();
    draft(format!(
        "water.density = 1025.0
        seabed.depth = 20.0
        line_types.rod = {{ model = 'beam', mass = 20.0, diameter = 0.1, drag_normal = 1.2, added_mass_normal = 1.0,
          axial_stiffness = {ea}, shear_stiffness = {ga}, bending_stiffness = {ei}, torsional_stiffness = {gj},
          rotary_inertia = {inertia}, rayleigh = {{ ratios = [0.05, 0.05], frequencies = [1.0, 50.0] }} }}
        motion.b = {{ x = [[{amplitude}, {period}]], z = [[{amplitude}, {}]] }}",
        0.7 * period
    ))
    .fixed("a", [0.0, 0.0, -20.0])
    .coupled("b", b)
    .line("rod", ["a", "b"], "rod", slack * chord, elements)
    .with(&clamps.join(", "))
    .scene()
}

#[test]
fn axial_damping_hardly_changes_the_end_force_of_a_beam_that_swings_without_stretching() {
    let forces = |damping: f64| {
        let mut simulation = start(
            &draft(format!(
                "line_types.rod = {{ model = 'beam', mass = 60.0, diameter = 0.2, axial_stiffness = 1e8, axial_damping = {damping},
                  bending_stiffness = 5e4, shear_stiffness = 4e7, torsional_stiffness = 4e4, rotary_inertia = 0.3 }}
                solver.time_step_max = 0.005
                motion.hand = {{ x = [[1.5, 3.0]], ramp = 3.0 }}"
            ))
            .free("tip", [2.0, 0.0, -9.0])
            .coupled("hand", [0.0; 3])
            .line("rod", ["tip", "hand"], "rod", 10.0, 10)
            .with("clamped_b = [-1.0, 0.0, 0.0]")
            .scene(),
        );
        simulation.follow_scene().unwrap();
        let mut force = |_| {
            simulation.advance(0.01).unwrap();
            Vector3::from(simulation.end_force(1))
        };
        (0..600).map(&mut force).collect::<Vec<_>>()
    };
    let [free, damped] = [0.0, 1e6].map(forces);
    let off = free.iter().zip(&damped).map(|(a, b)| (a - b).norm_squared());
    let mean = Vector3::z() * 60.0 * 9.80665 * 10.0; // N, weight
    let swing = free.iter().map(|a| (a - mean).norm_squared()).sum::<f64>();
    let ratio = (off.sum::<f64>() / swing).sqrt();
    assert!(ratio < 0.02, "{ratio}");
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn any_beam_runs_or_says_why_not() {
    let mut seed = 1;
    let (mut ran, mut refused) = (0, 0);
    for _ in 0..240 {
        let result = Simulation::new(&balanced(any_beam(&mut seed))).map_err(|error| error.to_string());
        let result = result.and_then(|mut simulation| {
            simulation.follow_scene().unwrap();
            let result = (0..60).try_for_each(|_| simulation.advance(0.05));
            assert!(nodes(&simulation).iter().flatten().all(|x| x.is_finite()));
            assert!(simulation.tension_b(0).is_finite() && balance_error(&simulation).is_finite());
            result.map_err(|error| error.to_string())
        });
        match result {
            Ok(()) => ran += 1,
            Err(message) => {
                let advised = ["use more elements", "solver.time_step_max"];
                assert!(advised.iter().any(|advice| message.contains(advice)), "{message}");
                refused += 1;
            }
        }
    }
    assert!(ran >= 190, "{ran} ran, {refused} were refused");
}
