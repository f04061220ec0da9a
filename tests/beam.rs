//! The geometrically exact beam against published and closed-form solutions, through scenes as a user writes them.

mod common;

use approx::assert_relative_eq;
use common::{History, following, order_of, random, scene, shipped, with_elements};
use moorline::dynamics::beam::BeamView;
use moorline::scene::{Axis, InitialShape, Integrator, LineModel, PointKind, Scene, TimeFunction};
use moorline::simulation::Simulation;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// The flying rod with n elements and a step [s].
fn spaghetti(elements: usize, step: f64) -> Scene {
    let mut scene = with_elements(shipped("flying_spaghetti"), elements);
    scene.solver.time_step_max = step;
    scene
}

/// Displacements of the tips A and B at the end of `count` steps of `step` [s], then of the next counts.
fn tips(scene: &Scene, step: f64, counts: &[usize]) -> Vec<[Vector3<f64>; 2]> {
    let mut simulation = Simulation::new(scene).unwrap();
    let ends = |simulation: &Simulation| {
        let nodes = &simulation.state().lines[0].position;
        [nodes[0], nodes[nodes.len() - 1]]
    };
    let [a, b] = ends(&simulation);
    let mut done = 0;
    let mut found = Vec::new();
    for &count in counts {
        for _ in done..count {
            simulation.advance(step).unwrap();
        }
        done = count;
        let [now_a, now_b] = ends(&simulation);
        found.push([now_a - a, now_b - b]);
    }
    found
}

/// Energy held [J], by the ledger.
fn energy(simulation: &Simulation) -> f64 {
    let ledger = simulation.ledger();
    simulation.energy_error() + ledger.start + ledger.flow.given - ledger.flow.lost
}

/// A flight of 10 s in steps of 0.1 s: energy and momenta stay after the load, and the impulse is exact.
fn assert_conserves(scene: &Scene) {
    let mut simulation = Simulation::new(scene).unwrap();
    (0..25).for_each(|_| simulation.advance(0.1).unwrap());
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
    assert!(simulation.energy_error().abs() < 1e-9 * start);
}

/// The rod with another bending and torsional stiffness [N m²].
fn stiffened(mut scene: Scene, stiffness: f64) -> Scene {
    for line_type in scene.line_types.values_mut() {
        line_type.bending_stiffness = Some(stiffness);
        line_type.torsional_stiffness = Some(stiffness);
    }
    scene
}

/// The rod under the opposite moment.
fn opposed(mut scene: Scene) -> Scene {
    let moment = scene.points[0].moment.as_mut().unwrap();
    moment.z = Some(TimeFunction::Table(vec![[2.5, 80.0], [2.5, 0.0]]));
    scene
}

#[test]
fn a_flying_rod_keeps_energy_and_momenta_to_rounding() {
    for stiffness in [100.0, 500.0] {
        assert_conserves(&stiffened(shipped("flying_spaghetti"), stiffness));
        assert_conserves(&stiffened(opposed(shipped("flying_spaghetti")), stiffness));
        assert_conserves(&stiffened(shipped("flying_spaghetti_3d"), stiffness));
    }
}

#[test]
fn a_flying_rod_tends_to_the_converged_flight_at_second_order() {
    // Displacements of A and B [m] at 2.5, 5 and 10 s: spectral elements, converged to 5e-6 m; energy [J] after 2.5 s.
    let reference = [
        [[-1.036_913_2, 4.476_005_5], [3.583_146_0, -1.888_104_1]],
        [[3.783_685_3, 8.203_803_1], [8.074_362_2, -6.241_153_4]],
        [[16.970_853_5, 6.411_931_2], [21.324_745_5, -4.390_124_5]],
    ];
    let converged = 379.573_203;
    let mut errors = Vec::new();
    for n in [20, 40, 80, 160] {
        let step = 2.0 / n as f64;
        let count = 5 * n / 4;
        let found = tips(&spaghetti(n, step), step, &[count, 2 * count, 4 * count]);
        let error: Vec<f64> = found
            .iter()
            .zip(reference)
            .map(|(found, reference)| {
                let miss = |end: usize| {
                    let [x, y] = reference[end];
                    (found[end] - Vector3::new(x, y, 0.0)).norm()
                };
                miss(0).max(miss(1))
            })
            .collect();
        if n == 160 {
            assert!(error[0] < 2e-3 && error[1] < 2e-3 && error[2] < 1e-2, "{error:?}");
            let mut simulation = Simulation::new(&spaghetti(n, step)).unwrap();
            (0..count).for_each(|_| simulation.advance(step).unwrap());
            assert_relative_eq!(energy(&simulation), converged, max_relative = 2e-4);
        }
        errors.push((step, error.iter().map(|e| e * e).sum::<f64>().sqrt()));
    }
    let slope = order_of(&errors);
    assert!((slope - 2.0).abs() < 0.1, "order {slope:.3}: {errors:?}");
}

/// A weightless beam along x from the origin: EI 1 N m², 1 kg/m, EA and GA [N] so great that Euler and Bernoulli hold.
fn slender(elements: usize, stiffness: f64, ends: &str) -> String {
    format!(
        r#"
        gravity = 0.0
        [line_types.rod]
        model = "beam"
        mass = 1.0
        axial_stiffness = {stiffness}
        shear_stiffness = {stiffness}
        bending_stiffness = 1.0
        torsional_stiffness = 1.0
        rotary_inertia = 1.0e-7
        [[lines]]
        name = "rod"
        from = "a"
        to = "b"
        sections = [{{ type = "rod", length = 1.0, elements = {elements} }}]
        {ends}
        "#
    )
}

const ANCHOR: &str = "[[points]]\nname = \"a\"\nposition = [0.0, 0.0, 0.0]\nkind = \"fixed\"\n";

#[test]
fn the_statics_of_a_cantilever_tend_to_the_elastica_at_second_order() {
    // Bisshopp & Drucker (1945), Quart. Appl. Math. 3, 272-275, here to 16 digits: PL²/EI, deflection/L, shortening/L
    for (load, deflection, shortening) in [
        (1.0, 0.301_720_773_799_813_5, 0.056_433_236_283_376_88),
        (10.0, 0.810_609_024_880_296_4, 0.554_995_597_753_751_3),
    ] {
        let error = |n: usize| {
            let tip = format!(
                "[[points]]\nname = \"b\"\nposition = [1.0, 0.0, 0.0]\nkind = \"free\"\nforce = {{ y = {load} }}\n"
            );
            let text = slender(n, 1e6, "clamped_a = [1.0, 0.0, 0.0]") + ANCHOR + &tip;
            let simulation = Simulation::new(&scene(&text)).unwrap();
            let tip = simulation.state().lines[0].position[n];
            (tip - Vector3::new(1.0 - shortening, deflection, 0.0)).norm()
        };
        let errors: Vec<(f64, f64)> = [8, 16, 32, 64].map(|n| (1.0 / n as f64, error(n))).into();
        let slope = order_of(&errors);
        assert!((slope - 2.0).abs() < 0.1, "order {slope:.3}: {errors:?}");
    }
}

#[test]
fn an_end_moment_rolls_a_cantilever_up_to_a_circle() {
    let tip = "[[points]]\nname = \"b\"\nposition = [1.0, 0.0, 0.0]\nkind = \"free\"\nmoment = { z = 6.283185307179586 }\n";
    let text = slender(40, 1e6, "clamped_a = [1.0, 0.0, 0.0]") + ANCHOR + tip;
    let simulation = Simulation::new(&scene(&text)).unwrap();
    assert!(simulation.state().lines[0].position[40].norm() < 1e-5);
}

/// A node's height sampled over time, and the mean time between its zero crossings, from the first to the last [s].
fn half_period(samples: &[f64], step: f64) -> f64 {
    let crossings: Vec<f64> = samples
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| (pair[0] > 0.0) != (pair[1] > 0.0))
        .map(|(i, pair)| step * (i as f64 + pair[0] / (pair[0] - pair[1])))
        .collect();
    (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64
}

/// First natural frequency [rad/s] of a slender beam that starts as 1e-6 m times `shape` of x/L, with so many steps a period.
fn natural_frequency(
    elements: usize,
    steps: usize,
    stiffness: f64,
    [ends, points]: [&str; 2],
    expected: f64,
    shape: impl Fn(f64) -> f64,
) -> f64 {
    let mut scene = scene(&(slender(elements, stiffness, ends) + points));
    let chord = scene.points[1].position[0];
    let nodes: Vec<[f64; 3]> = (0..=elements)
        .map(|i| i as f64 / elements as f64)
        .map(|x| [x * chord, 0.0, 1e-6 * shape(x)])
        .collect();
    scene.lines[0].initial = InitialShape::Nodes(nodes);
    let period = TAU / expected;
    let step = period / steps as f64;
    scene.solver.time_step_max = step;
    let mut simulation = Simulation::new(&scene).unwrap();
    // onto the mode, so that what else the start excites falls out
    let weights: Vec<f64> = (0..=elements)
        .map(|i| shape(i as f64 / elements as f64))
        .collect();
    let mut samples = Vec::new();
    for _ in 0..(21 * steps / 4) {
        simulation.advance(step).unwrap();
        let nodes = &simulation.state().lines[0].position;
        samples.push(nodes.iter().zip(&weights).map(|(r, w)| r.z * w).sum());
    }
    PI / half_period(&samples, step)
}

/// Fits the order of a frequency over meshes of 8 to 64 elements, with steps in proportion.
fn assert_frequency(stiffness: f64, ends: [&str; 2], exact: f64, shape: impl Fn(f64) -> f64) {
    let errors: Vec<(f64, f64)> = [8, 16, 32, 64]
        .map(|n| {
            let found = natural_frequency(n, 10 * n, stiffness, ends, exact, &shape);
            (1.0 / n as f64, (found / exact - 1.0).abs())
        })
        .into();
    let slope = order_of(&errors);
    assert!((slope - 2.0).abs() < 0.1, "order {slope:.3}: {errors:?}");
}

/// Euler and Bernoulli's mode of a beam clamped at x = 0, with the coefficient of its sines [-].
fn clamped_mode(beta: f64, sigma: f64) -> impl Fn(f64) -> f64 {
    move |x: f64| {
        let u = beta * x;
        u.cosh() - u.cos() - sigma * (u.sinh() - u.sin())
    }
}

#[test]
fn the_frequency_of_a_cantilever_tends_to_the_closed_form_at_second_order() {
    let beta: f64 = 1.875_104_068_711_961_2; // cos βL cosh βL = −1
    let sigma = (beta.cosh() + beta.cos()) / (beta.sinh() + beta.sin());
    let mode = clamped_mode(beta, sigma);
    let tip = mode(1.0);
    let free = format!(
        "[[points]]\nname = \"b\"\nposition = [1.0, 0.0, {}]\nkind = \"free\"\n",
        1e-6 * tip
    );
    let ends = ["clamped_a = [1.0, 0.0, 0.0]", &(ANCHOR.to_string() + &free)];
    assert_frequency(1e6, ends, beta * beta, mode);
}

#[test]
fn the_frequency_of_a_beam_clamped_at_both_ends_tends_to_the_closed_form_at_second_order() {
    let beta: f64 = 4.730_040_744_862_704; // cos βL cosh βL = 1
    let sigma = (beta.cosh() - beta.cos()) / (beta.sinh() - beta.sin());
    let far = "[[points]]\nname = \"b\"\nposition = [1.0, 0.0, 0.0]\nkind = \"fixed\"\n";
    let clamps = "clamped_a = [1.0, 0.0, 0.0]\nclamped_b = [1.0, 0.0, 0.0]";
    let ends = [clamps, &(ANCHOR.to_string() + far)];
    assert_frequency(1e6, ends, beta * beta, clamped_mode(beta, sigma));
}

#[test]
fn the_frequency_of_a_tensioned_beam_tends_to_the_closed_form_at_second_order() {
    // pinned ends: ω² = (π/L)⁴ EI/m + (π/L)² T/m; the stretch of 1e-6 that makes T = 10 N shows in L and m only by itself
    let (stiffness, stretch) = (1e7, 1e-6);
    let far = format!(
        "[[points]]\nname = \"b\"\nposition = [{}, 0.0, 0.0]\nkind = \"fixed\"\n",
        1.0 + stretch
    );
    let exact = (PI.powi(4) + PI.powi(2) * stiffness * stretch).sqrt();
    let ends = ["", &(ANCHOR.to_string() + &far)];
    assert_frequency(stiffness, ends, exact, |x| (PI * x).sin());
}

/// A clamped rod whose end B is turned about its axis by `turns` in 10 s and then drawn in by half of its length in 20 s.
fn hockle(elements: usize, turns: f64) -> Scene {
    scene(&format!(
        r#"
        gravity = 9.81
        [line_types.rod]
        model = "beam"
        mass = 1.0
        axial_stiffness = 1.0e5
        shear_stiffness = 4.0e4
        bending_stiffness = 100.0
        torsional_stiffness = 80.0
        rotary_inertia = 0.01
        rayleigh = {{ ratios = [0.02, 0.02], frequencies = [2.0, 20.0] }}
        [[vessels]]
        name = "winch"
        position = [10.0, 0.0, 0.0]
        [[points]]
        name = "a"
        position = [0.0, 0.0, 0.0]
        kind = "fixed"
        [[points]]
        name = "b"
        position = [0.0, 0.0, 0.0]
        kind = "coupled"
        on = "winch"
        [[lines]]
        name = "rod"
        from = "a"
        to = "b"
        clamped_a = [1.0, 0.0, 0.0]
        clamped_b = [1.0, 0.0, 0.0]
        sections = [{{ type = "rod", length = 10.0, elements = {elements} }}]
        [solver]
        time_step_max = 0.02
        [motion]
        winch = {{ table = [[0.0, 0, 0, 0, 0, 0, 0], [10.0, 0, 0, 0, {angle}, 0, 0], [30.0, -5.0, 0, 0, {angle}, 0, 0], [35.0, -5.0, 0, 0, {angle}, 0, 0]] }}
        "#,
        angle = TAU * turns
    ))
}

/// Follows a hockle to the end, finite throughout; the simulation there, or the message that ended it.
fn twist_and_slacken(scene: &Scene) -> Result<Simulation, String> {
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.follow_scene().unwrap();
    for _ in 0..350 {
        simulation.advance(0.1).map_err(|error| error.to_string())?;
        let nodes = &simulation.state().lines[0].position;
        assert!(nodes.iter().all(|r| r.iter().all(|x| x.is_finite())));
    }
    Ok(simulation)
}

#[test]
fn a_twisted_rod_drawn_in_leaves_its_plane_and_its_ledger_closes() {
    for (elements, turns) in [(40, 2.0), (80, 4.0)] {
        let end = twist_and_slacken(&hockle(elements, turns)).unwrap();
        assert!(end.energy_error().abs() < 1e-8);
    }
    let mut flat = Simulation::new(&hockle(40, 0.0)).unwrap();
    let mut twisted = Simulation::new(&hockle(40, 2.0)).unwrap();
    let aside = |simulation: &mut Simulation| {
        simulation.follow_scene().unwrap();
        (0..250).for_each(|_| simulation.advance(0.1).unwrap());
        let nodes = simulation.state().lines[0].position.iter();
        nodes.map(|r| r.y.abs()).fold(0.0, f64::max)
    };
    assert!(aside(&mut flat) < 1e-6);
    assert!(aside(&mut twisted) > 0.5);
}

#[test]
fn a_hockle_too_tight_for_its_elements_is_refused_in_words() {
    let message = twist_and_slacken(&hockle(40, 4.0)).unwrap_err();
    assert!(message.contains("more than 60 degrees") && message.contains("use more elements"));
}

#[test]
fn the_moments_of_a_cantilever_under_an_end_load_grow_straight_to_its_clamp() {
    let tip =
        "[[points]]\nname = \"b\"\nposition = [1.0, 0.0, 0.0]\nkind = \"free\"\nforce = { z = 0.001 }\n";
    let text = slender(10, 1e6, "clamped_a = [1.0, 0.0, 0.0]") + ANCHOR + tip;
    let simulation = Simulation::new(&scene(&text)).unwrap();
    let line = &simulation.model().lines[0];
    let view = BeamView::of(line, &simulation.state().lines[0]).unwrap();
    for node in 0..=10 {
        let moment = 0.001 * (1.0 - 0.1 * node as f64);
        assert_relative_eq!(view.bending_moment(node), moment, epsilon = 1e-9);
        assert_relative_eq!(view.curvature(node), moment, epsilon = 1e-9); // EI is 1 N m²
    }
    let [x, y, z] = simulation.end_force(0);
    assert_relative_eq!(Vector3::new(x, y, z), 0.001 * Vector3::z(), epsilon = 1e-10);
    let moment = simulation.end_moment(0);
    assert_relative_eq!(moment, -0.001 * Vector3::y(), epsilon = 1e-9);
}

/// The OC3 line as a beam of a bending stiffness [N m²].
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
    let (mut line, mut beam) = (following(&shipped("oc3_catenary")), following(&mooring_beam(1.0)));
    assert_relative_eq!(beam.tension_b(0), line.tension_b(0), max_relative = 1e-4);
    let (line, beam) = (
        History::record(&mut line, 0.05, 800),
        History::record(&mut beam, 0.05, 800),
    );
    let moved = beam.middle_error(&line, 400);
    assert!(moved < 0.01, "{moved}");
    let tension = beam.tension_error(&line, 400);
    assert!(tension < 0.05, "{tension}");
}

#[test]
fn bending_stiffness_from_a_hair_to_a_girder_finds_its_rest_on_the_bed() {
    let mut last = f64::INFINITY;
    for bending in [1e-6, 1.0, 1e3, 1e5, 1e7, 1e9, 1e11] {
        let rest = Simulation::new(&mooring_beam(bending)).unwrap();
        let tension = rest.tension_b(0);
        assert!(tension < last * (1.0 + 1e-6), "{bending}: {tension}");
        last = tension;
    }
}

#[test]
fn a_beam_in_water_over_a_bed_has_a_ledger_that_closes() {
    let mut beam = following(&mooring_beam(1e5));
    let start = beam.ledger().start.abs();
    (0..400).for_each(|_| beam.advance(0.05).unwrap());
    let flow = beam.ledger().flow;
    assert!(flow.lost > 1e3);
    assert!(
        beam.energy_error().abs() < 1e-9 * start,
        "{:e}",
        beam.energy_error()
    );
}

/// A line of 20 m from a point at z = `anchor` [m] to a free point, as a cable or as a supple beam.
fn tethered(model: &str, anchor: f64, point: &str) -> Scene {
    let beam = "shear_stiffness = 1e6\ntorsional_stiffness = 500.0\nrotary_inertia = 0.01";
    scene(&format!(
        r#"
        [water]
        density = 1025.0
        [seabed]
        depth = 30.0
        stiffness = 1e5
        damping = 1e4
        friction = 0.0
        [line_types.tether]
        model = "{model}"
        mass = 2.0
        diameter = 0.03
        axial_stiffness = 1e6
        axial_damping = 1e3
        bending_stiffness = 500.0
        drag_normal = 1.2
        added_mass_normal = 1.0
        {}
        [[points]]
        name = "anchor"
        position = [0.0, 0.0, {anchor}]
        kind = "fixed"
        [[points]]
        name = "free"
        kind = "free"
        {point}
        [[lines]]
        name = "tether"
        from = "anchor"
        to = "free"
        sections = [{{ type = "tether", length = 20.0, elements = 20 }}]
        [solver]
        time_step_max = 0.005
        "#,
        if model == "beam" { beam } else { "" }
    ))
}

#[test]
fn a_buoy_on_a_beam_heaves_as_it_does_on_a_cable() {
    let buoy = "position = [14.0, 0.0, 0.0]\nmass = 300.0\nvolume = 1.0\ndrag_area = 0.5\nadded_mass = 0.5
        force = { x = 500.0, z = { table = [[1.0, 0.0], [1.0, -3000.0]] } }";
    let [beam, cable] = ["beam", "cable"].map(|model| {
        let mut simulation = Simulation::new(&tethered(model, -12.0, buoy)).unwrap();
        let places: Vec<Vector3<f64>> = (0..160)
            .map(|_| {
                simulation.advance(0.05).unwrap();
                simulation.state().points[1].position
            })
            .collect();
        (places, simulation)
    });
    let heights = beam.0.iter().map(|place| place.z);
    let heave = heights.clone().fold(0.0, f64::max) - heights.fold(0.0, f64::min);
    assert!(heave > 0.3, "{heave} m");
    for (of_beam, of_cable) in beam.0.iter().zip(&cable.0) {
        assert_relative_eq!(of_beam, of_cable, epsilon = 5e-3);
    }
    let ledger = beam.1.ledger().flow;
    assert!(beam.1.energy_error().abs() < 1e-9 * (ledger.given.abs() + ledger.lost));
}

#[test]
fn a_clump_at_the_end_of_a_beam_rests_on_the_bed() {
    let clump = "position = [15.0, 0.0, -29.5]\nmass = 500.0\nvolume = 0.1\nforce = { x = 300.0 }";
    let mut simulation = Simulation::new(&tethered("beam", -20.0, clump)).unwrap();
    let at = |simulation: &Simulation| simulation.state().points[1].position;
    let rest = at(&simulation);
    assert_relative_eq!(rest.z, -30.0, epsilon = 0.02);
    (0..20).for_each(|_| simulation.advance(0.1).unwrap());
    assert_relative_eq!(at(&simulation), rest, epsilon = 1e-6);
}

#[test]
fn a_saved_beam_replays_bit_for_bit() {
    let mut simulation = Simulation::new(&shipped("flying_spaghetti_3d")).unwrap();
    (0..30).for_each(|_| simulation.advance(0.1).unwrap());
    let saved = simulation.snapshot().clone();
    (0..30).for_each(|_| simulation.advance(0.1).unwrap());
    let first = simulation.snapshot().clone();
    simulation.restore(saved);
    (0..30).for_each(|_| simulation.advance(0.1).unwrap());
    assert_eq!(*simulation.snapshot(), first);
}

#[test]
fn a_clamped_end_that_its_vessel_turns_takes_the_beam_along() {
    let mut simulation = Simulation::new(&hockle(20, 0.0)).unwrap();
    let pose = [0.0, 0.0, 0.0, 0.0, 0.3, 0.0];
    simulation.set_pose(0, pose);
    simulation.restart(0.0).unwrap();
    let direction = |simulation: &Simulation| {
        let shape = simulation.state().lines[0].beam.as_ref().unwrap();
        shape.frames[20].column(2).into_owned()
    };
    let pitched = Vector3::new(0.3_f64.cos(), 0.0, -(0.3_f64.sin()));
    assert_relative_eq!(direction(&simulation), pitched, epsilon = 1e-12);
    for step in 1..=50 {
        simulation.set_pose(0, [0.0, 0.0, 0.0, 0.0, 0.3 - 0.01 * f64::from(step), 0.0]);
        simulation.advance(0.1).unwrap();
    }
    (0..3).for_each(|_| simulation.advance(0.1).unwrap());
    let end = Vector3::new(0.2_f64.cos(), 0.0, 0.2_f64.sin());
    assert_relative_eq!(direction(&simulation), end, epsilon = 1e-3);
    let [_, _, _, _, moment, _] = simulation.vessel_force(0);
    assert!(moment.abs() > 1.0);
}

#[test]
fn what_beams_cannot_do_is_refused_with_its_place() {
    let refused = |change: &dyn Fn(&mut Scene)| {
        let mut scene = mooring_beam(1e5);
        change(&mut scene);
        Simulation::new(&scene).err().map(|error| error.to_string())
    };
    let message = refused(&|scene| scene.solver.integrator = Integrator::Leapfrog).unwrap();
    assert!(
        message.contains("solver.integrator") && message.contains("\"beam\""),
        "{message}"
    );
    let message = refused(&|scene| scene.solver.integrator = Integrator::QuasiStatic).unwrap();
    assert!(message.contains("solver.integrator"), "{message}");
    let message = refused(&|scene| {
        let mut second = scene.lines[0].clone();
        second.name = "line2".into();
        scene.lines.push(second);
        scene.points[1].kind = PointKind::Free;
        scene.motion.clear();
    });
    assert!(message.unwrap().contains("meets another line at the free point"));
    assert_eq!(refused(&|_| {}), None);
}

/// MotionSolve's wire and collar as a beam of EI 10.85 N m².
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
fn a_heavy_collar_that_slides_has_a_ledger_that_closes() {
    let mut scene = collar(20);
    scene.points[1].mass = Some(3.0);
    for free in [Some(vec![Axis::X]), Some(vec![Axis::X, Axis::Z])] {
        scene.points[1].free = free;
        let mut simulation = Simulation::new(&scene).unwrap();
        (0..160).for_each(|_| simulation.advance(0.05).unwrap());
        assert!(simulation.ledger().flow.given > 1.0);
        assert!(simulation.energy_error().abs() < 1e-8);
    }
}

#[test]
fn a_sliding_collar_draws_a_bending_wire_to_its_published_span_at_second_order() {
    // MotionSolve's wire of 20 m and 0.2 kg/m under 20 N as a solid rod: span and sag [m] of the inextensible limit
    let reference = [17.7404, 4.0520];
    let rest = |elements: usize| {
        let mut scene = collar(elements);
        scene.points[1].force.as_mut().unwrap().x = Some(TimeFunction::Constant(20.0));
        let rest = Simulation::new(&scene).unwrap();
        [rest.state().points[1].position.x, rest.sag(0)]
    };
    let meshes = [20, 40, 80, 160].map(rest);
    for (found, published) in meshes[3].iter().zip(reference) {
        assert!((found - published).abs() < 2e-4, "{found}");
    }
    let changes = [0, 1, 2].map(|i| (meshes[i][0] - meshes[i + 1][0]).abs());
    for pair in changes.windows(2) {
        assert!(((pair[0] / pair[1]).log2() - 2.0).abs() < 0.1, "{changes:?}");
    }
}

/// A repeatable number in 0 … 1.
/// A beam over a bed in water, with a fairlead that moves; stiffnesses, lengths, ends and motions as the seed has them.
fn any_beam(seed: &mut u64) -> Scene {
    let mut decades = |low: f64, high: f64| 10.0_f64.powf(low + (high - low) * random(seed));
    let (ea, ei) = (decades(6.0, 9.0), decades(0.0, 6.0));
    let (ga, gj) = (decades(6.0, 8.0), ei * decades(-0.5, 0.5));
    let (inertia, slack) = (decades(-5.0, 0.0), decades(-3.0, -0.9) + 0.99);
    let (period, amplitude) = (decades(0.5, 1.3), decades(-1.0, 0.0));
    let elements = decades(1.2, 1.9) as usize;
    let clamp = |key: &str, given: bool, seed: &mut u64| match given {
        true => format!(
            "{key} = [{}, {}, {}]",
            0.5 + random(seed),
            random(seed) - 0.5,
            random(seed) - 0.5
        ),
        false => String::new(),
    };
    let stiff = ei > 1e4; // a bend at a clamp is √(EI/T) long, and elements must be shorter
    let given = [0, 1].map(|_| random(seed) < 0.5 && stiff);
    let clamps = [
        clamp("clamped_a", given[0], seed),
        clamp("clamped_b", given[1], seed),
    ];
    let b = [10.0 + 40.0 * random(seed), 5.0 * random(seed), -5.0];
    let chord = (b[0] * b[0] + b[1] * b[1] + 15.0 * 15.0_f64).sqrt();
    scene(&format!(
        r#"
        [water]
        density = 1025.0
        [seabed]
        depth = 20.0
        [line_types.rod]
        model = "beam"
        mass = 20.0
        diameter = 0.1
        drag_normal = 1.2
        added_mass_normal = 1.0
        axial_stiffness = {ea}
        shear_stiffness = {ga}
        bending_stiffness = {ei}
        torsional_stiffness = {gj}
        rotary_inertia = {inertia}
        rayleigh = {{ ratios = [0.05, 0.05], frequencies = [1.0, 50.0] }}
        [[points]]
        name = "a"
        position = [0.0, 0.0, -20.0]
        kind = "fixed"
        [[points]]
        name = "b"
        position = {b:?}
        kind = "coupled"
        [[lines]]
        name = "rod"
        from = "a"
        to = "b"
        {}
        {}
        sections = [{{ type = "rod", length = {}, elements = {elements} }}]
        [motion]
        b = {{ x = [[{amplitude}, {period}]], z = [[{amplitude}, {}]] }}
        "#,
        clamps[0],
        clamps[1],
        slack * chord,
        0.7 * period
    ))
}

#[test]
fn any_beam_runs_or_says_why_not() {
    let mut seed = 1;
    let (mut ran, mut refused) = (0, 0);
    let mut refuse = |message: String| {
        let advised = ["use more elements", "solver.time_step_max"];
        assert!(advised.iter().any(|advice| message.contains(advice)), "{message}");
        refused += 1;
    };
    for _ in 0..60 {
        let mut simulation = match Simulation::new(&any_beam(&mut seed)) {
            Ok(simulation) => simulation,
            Err(error) => {
                refuse(error.to_string());
                continue;
            }
        };
        simulation.follow_scene().unwrap();
        let result = (0..60).try_for_each(|_| simulation.advance(0.05));
        let nodes = &simulation.state().lines[0].position;
        assert!(nodes.iter().all(|r| r.iter().all(|x| x.is_finite())));
        assert!(simulation.tension_b(0).is_finite() && simulation.energy_error().is_finite());
        match result {
            Ok(()) => ran += 1,
            Err(error) => refuse(error.to_string()),
        }
    }
    assert!(ran >= 45, "{ran} ran, {refused} were refused");
}
