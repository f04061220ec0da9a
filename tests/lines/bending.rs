//! Cables with bending stiffness against closed forms, published figures and each other.

use std::f64::consts::{PI, TAU};

use crate::common::*;
use moorline::interface::{Interface, Layout};
use moorline::model::Model;
use moorline::scene::{
    FibreLaw, InitialShape, Integrator, LineType, Rayleigh, RestShape, Scene, Section, SolidSection, Strain,
};
use moorline::simulation::Simulation;
use nalgebra::Vector3;

// ------------------------------------------------------------------ MotionSolve's collar

/// The shipped collar scene with another axial stiffness EA [N], gravity [m/s²] and mesh.
fn collar_scene(axial_stiffness: f64, gravity: f64, elements: usize) -> Scene {
    let mut collar = with_elements(shipped("collar"), elements);
    collar.gravity = gravity;
    collar.line_types.get_mut("wire").unwrap().axial_stiffness = Some(axial_stiffness);
    collar
}

/// Span and sag [m] of the nearly inextensible collar with a bending stiffness EI [N m²] at the end of its pull.
fn collar(bending_stiffness: f64, gravity: f64, elements: usize) -> [f64; 2] {
    let mut collar = collar_scene(1e10, gravity, elements);
    collar.line_types.get_mut("wire").unwrap().bending_stiffness = Some(bending_stiffness);
    drawn_out(&collar)
}

fn drawn_out(collar: &Scene) -> [f64; 2] {
    let mut simulation = start(collar);
    run(&mut simulation, 1.0, 10);
    [place(&simulation, "collar").x, simulation.sag(0)]
}

fn assert_close(found: [f64; 2], wanted: [f64; 2], tolerance: f64) {
    for (found, wanted) in found.into_iter().zip(wanted) {
        assert!((found - wanted).abs() <= tolerance, "{found} is not {wanted}");
    }
}

/// Span and sag with two decimals.
fn digits([span, sag]: [f64; 2]) -> [String; 2] {
    [format!("{span:.2}"), format!("{sag:.2}")]
}

/// EI [N m²], span [m] and sag [m] of the inextensible wire with moment-free ends, g = 9.81, from a boundary-value solution of the heavy
/// elastica.
const COLLAR: [(f64, [f64; 2]); 3] = [
    (10.85, [17.7404, 4.0520]),
    (1.0, [17.69804, 4.08295]),
    (0.1, [17.69411, 4.08576]),
];

#[test]
fn the_collar_slides_to_the_heavy_elastica() {
    for (bending_stiffness, wanted) in COLLAR {
        assert_close(collar(bending_stiffness, 9.81, 200), wanted, 5e-5);
    }
}

#[test]
fn fifty_elements_meet_the_heavy_elastica_within_half_a_millimetre() {
    for (bending_stiffness, wanted) in COLLAR {
        let error = |elements| {
            let found = collar(bending_stiffness, 9.81, elements);
            (found[0] - wanted[0]).abs().max((found[1] - wanted[1]).abs())
        };
        assert!(error(50) <= 5e-4 && error(40) > 5e-4);
    }
}

#[test]
fn twenty_elements_give_the_published_digits_of_one_fibre() {
    assert_eq!(digits(collar(10.85, 9.81, 20)), ["17.74", "4.05"]);
}

/// Published: 17.70 and 4.09 for twenty fibres of a solid steel rod of 5.6955 mm, g = 9.80665.
#[test]
fn the_published_twenty_fibres_are_the_squared_reading() {
    let strands = |law: FibreLaw| {
        let mut collar = collar_scene(1e10, G, 400);
        let wire = collar.line_types.get_mut("wire").unwrap();
        let section = SolidSection {
            diameter: 5.6955e-3,
            youngs_modulus: 2.1e11,
            poisson: 0.3,
        };
        wire.solid_section = Some(section);
        (wire.fibres, wire.fibre_law) = (Some(20), law);
        drawn_out(&collar)
    };
    assert_close(strands(FibreLaw::Squared), [17.69503, 4.08500], 1e-4);
    let linear = strands(FibreLaw::Linear);
    assert_close(linear, [17.6972, 4.0834], 1e-4);
    assert_eq!(digits(linear)[1], "4.08");
    // 4.08500 is halfway between 4.08 and 4.09: the mesh of twenty elements rounds to the published value
    for bending_stiffness in [10.85 / 400.0, 10.85 / 20.0] {
        assert_eq!(digits(collar(bending_stiffness, G, 20)), ["17.70", "4.09"]);
    }
}

#[test]
fn words_say_the_stiffness_and_where_it_comes_from() {
    let mut collar = shipped("collar");
    let wire = collar.line_types.get_mut("wire").unwrap();
    (wire.bending_stiffness, wire.fibres) = (Some(10.0), Some(20));
    let shared = "bending stiffness 0.5 N m²: EI 10 N m² as given, divided among 20 fibres (EI/20";
    assert_says(
        &in_words(&collar),
        &[shared, "not modelled torsion and shear of lines"],
    );
    collar.line_types.get_mut("wire").unwrap().fibre_law = FibreLaw::Squared;
    assert_says(&in_words(&collar), &["0.025 N m²: EI 10 N m² as given"]);
    let simulation = start(&collar);
    let joints = simulation.model().lines[0].bending.as_ref().unwrap();
    assert_eq!(joints.stiffness[0], 0.025);
    assert_says(
        &in_words(&shipped("power_cable")),
        &["clamped at end A along (-1, 0, 0)"],
    );
}

// ------------------------------------------------------------------ cantilevers

const EI: f64 = 3.0; // [N m²]
const LENGTH: f64 = 2.0; // [m]
const MASS: f64 = 0.7; // [kg/m]

/// A weightless rod type, with these keys of the scene.
fn rod(axial_stiffness: f64, keys: &str) -> Draft {
    draft(format!(
        "gravity = 0.0
        line_types.rod = {{ mass = {MASS}, axial_stiffness = {axial_stiffness}, bending_stiffness = {EI} }}
        output.energy_balance = true
        {keys}"
    ))
}

/// A cantilever along x, clamped in a direction, with these keys of its tip and of the scene's solver table.
fn cantilever(elements: usize, clamp: [f64; 3], tip: &str, solver: &str) -> Scene {
    rod(1e7, &format!("solver = {{ time_step_max = 0.05, {solver} }}"))
        .fixed("root", [0.0; 3])
        .free("tip", [LENGTH, 0.0, 0.0])
        .with(tip)
        .line("rod", ["root", "tip"], "rod", LENGTH, elements)
        .with(&format!("clamped_a = {clamp:?}"))
        .scene()
}

const LEVEL: [f64; 3] = [1.0, 0.0, 0.0];

/// A cantilever at rest under a transverse tip load of α EI/L².
fn bent_down(alpha: f64, elements: usize, clamp: [f64; 3]) -> Simulation {
    let load = alpha * EI / (LENGTH * LENGTH);
    start(&cantilever(
        elements,
        clamp,
        &format!("force = {{ z = {} }}", -load),
        "",
    ))
}

fn tip(simulation: &Simulation) -> [f64; 3] {
    simulation.state().points[1].position.into()
}

/// PL²/EI [-], deflection/L [-], shortening/L [-]: inextensible elastica with a transverse dead load at its tip, from elliptic
/// integrals in high precision.
const ELASTICA: [(f64, f64, f64); 4] = [
    (0.5, 0.16214357565836962, 0.015918962470837496),
    (1.0, 0.30172077379981355, 0.05643323628337688),
    (5.0, 0.7137915236119128, 0.38762836072442985),
    (10.0, 0.8106090248802964, 0.5549955977537513),
];

#[test]
fn a_loaded_cantilever_tends_to_the_elastica_at_second_order() {
    for (alpha, deflection, shortening) in ELASTICA {
        let errors = [40, 80, 160, 320].map(|elements| {
            let [x, _, z] = tip(&bent_down(alpha, elements, LEVEL));
            let error = (-z / LENGTH - deflection).hypot(1.0 - x / LENGTH - shortening);
            (1.0 / elements as f64, error)
        });
        assert_orders(2.0, &errors);
        assert!(errors[3].1 < 1e-4);
    }
}

#[test]
fn the_root_of_a_cantilever_feels_the_load_and_its_moment() {
    let rod = bent_down(5.0, 30, LEVEL);
    let load = 5.0 * EI / (LENGTH * LENGTH);
    let [x, y, z] = rod.end_force(0);
    assert!(x.abs() < 1e-6 && y.abs() < 1e-6 && (z + load).abs() < 1e-6 * load);
    let moments = rod.bending(0).unwrap();
    let root = moments[0].moment;
    assert!((root / (load * tip(&rod)[0]) - 1.0).abs() < 0.02, "{root}");
    assert_eq!(moments.last().unwrap().moment, 0.0);
    assert!((moments[0].curvature * EI / root - 1.0).abs() < 1e-12);
}

// ------------------------------------------------------------------ moments on free ends

/// A cantilever along x with a moment about y [N m] at its tip, as a function of time.
fn turned(moment: &str, elements: usize, solver: &str) -> Simulation {
    start(&cantilever(
        elements,
        LEVEL,
        &format!("moment = {{ y = {moment} }}"),
        solver,
    ))
}

#[test]
fn a_moment_on_the_free_end_bends_a_cable_to_a_circle_at_second_order() {
    // at large angles, an end without torsional stiffness rotates out of the plane, towards the axis of its moment
    for angle in [0.3, 0.9, 1.5] {
        let curvature = angle / LENGTH;
        let errors = [10, 20, 40, 80].map(|elements| {
            let rod = turned(&(curvature * EI).to_string(), elements, "");
            let nodes = rod.bending(0).unwrap();
            let step = angle / elements as f64;
            for node in nodes {
                let error = node.curvature / curvature - 1.0;
                assert!(error.abs() <= 0.3 * step * step, "{angle}: {error}");
            }
            let free = nodes.last().unwrap();
            assert!((free.moment / (curvature * EI) - 1.0).abs() < 1e-9);
            let [x, _, z] = tip(&rod);
            let exact = [angle.sin() / curvature, (angle.cos() - 1.0) / curvature];
            (1.0 / elements as f64, (x - exact[0]).hypot(z - exact[1]))
        });
        assert_orders(2.0, &errors);
    }
}

#[test]
fn the_root_of_a_cantilever_feels_the_moment_on_its_tip_and_no_force() {
    let rod = turned("2.0", 40, "");
    let moment = rod.end_moment(0);
    assert!((moment.y - 2.0).abs() < 2e-9, "{moment}");
    for force in [0, 1].map(|point| rod.end_force(point)).concat() {
        assert!(force.abs() < 1e-8, "{force} N");
    }
}

/// Integrators of lines with bending stiffness, as keys of the solver table.
const BENDING: [&str; 5] = [
    "integrator = 'generalised_alpha'",
    "integrator = 'bossak'",
    "integrator = 'quasi_static'",
    "integrator = 'leapfrog'",
    "integrator = 'axial_implicit'",
];

#[test]
fn a_cable_at_rest_under_an_end_moment_stays_there_in_every_integrator_that_bends_lines() {
    for solver in BENDING.into_iter().chain([""]) {
        let mut rod = turned("2.0", 20, solver);
        let first = Vector3::from(tip(&rod));
        assert!(first.z < -0.3 * LENGTH);
        run(&mut rod, 0.05, 20);
        let moved = (Vector3::from(tip(&rod)) - first).amax();
        assert!(moved < 1e-8, "{solver}: {moved} m");
    }
}

#[test]
fn the_work_of_an_end_moment_is_in_the_energy_balance() {
    for (solver, tolerance) in BENDING.into_iter().zip([2e-3, 2e-3, 1e-3, 2e-3, 2e-3]) {
        let mut rod = turned("{ ramp = [0.0, 0.0, 2.0, 2.0] }", 20, solver);
        run(&mut rod, 0.005, 400);
        let (given, error) = (flow(&rod).external_work, balance_error(&rod));
        let bent = rod.energy().bending;
        assert!(bent > 0.5 * 2.0 * 2.0 * LENGTH / EI * 0.8, "{solver}: {bent} J");
        assert!(given > 0.9 * bent, "{solver}: {given} of {bent} J");
        assert!(error.abs() < tolerance * given, "{solver}: {error} of {given} J");
    }
}

#[test]
fn the_energy_error_of_explicit_steps_under_a_sudden_moment_on_a_heavy_end_falls_with_their_square() {
    let errors = [4e-5, 2e-5, 1e-5, 5e-6].map(|step| {
        let tip = "mass = 5.0, moment = { y = { ramp = [0.0, 0.0, 0.02, 2.0] } }";
        let mut scene = cantilever(10, LEVEL, tip, "integrator = 'leapfrog'");
        scene.solver.time_step_max = step;
        let mut rod = start(&scene);
        run(&mut rod, 0.02, 25);
        (step, balance_error(&rod).abs())
    });
    println!("{errors:?}");
    assert_orders(2.0, &errors);
}

#[test]
fn the_part_of_a_moment_along_a_cable_does_nothing_and_check_says_so() {
    let rod = cantilever(10, LEVEL, "moment = { x = 2.0 }", "");
    assert_says(&in_words(&rod), &["no torsion"]);
    let rod = start(&rod);
    let moved = (Vector3::from(tip(&rod)) - LENGTH * Vector3::x()).amax();
    assert!(moved < 1e-9, "{moved} m");
    assert_eq!(rod.bending(0).unwrap().last().unwrap().moment, 0.0);
}

/// A column clamped at its foot buckles at π²EI/(4L²).
#[test]
fn a_column_stands_below_its_euler_load_and_bends_above() {
    let column = |alpha: f64| tip(&bent_down(alpha, 40, [0.0, 0.0, 1.0]));
    let [x, y, z] = column(2.4);
    assert!(x.hypot(y) < 1e-6 && (z - LENGTH).abs() < 1e-5);
    let [x, y, _] = column(2.6);
    assert!(x.hypot(y) > 0.3 * LENGTH);
}

/// A cantilever on a vessel, along x in its reference attitude, with a load at its tip.
fn carried(solver: &str, load: f64) -> Simulation {
    let vessel = "vessels = [{ name = 'floater', position = [0.0, 0.0, 0.0] }]";
    rod(1e7, &format!("{vessel}\nsolver = {{ {solver} }}"))
        .coupled("root", [3.0, 0.0, 0.0])
        .with("on = 'floater'")
        .free("tip", [3.0 + LENGTH, 0.0, 0.0])
        .with(&format!("force = {{ z = {load} }}"))
        .line("rod", ["root", "tip"], "rod", LENGTH, 20)
        .with("clamped_a = [1.0, 0.0, 0.0]")
        .start()
}

#[test]
fn a_clamp_turns_with_its_vessel() {
    let mut rod = carried("integrator = 'quasi_static'", 0.0);
    for i in 1..=20 {
        rod.set_pose(0, [0.0, 0.0, 0.0, 0.0, 0.0, 0.05 * f64::from(i)]);
        rod.advance(1.0).unwrap();
    }
    let root = rod.state().points[0].position;
    let [x, y, z] = tip(&rod);
    assert!(root.y > 2.0 && z.abs() < 1e-9);
    let ratio = (3.0 + LENGTH) / 3.0;
    assert!((x - ratio * root.x).hypot(y - ratio * root.y) < 1e-5, "{x} {y}");
    assert!(rod.energy().bending < 1e-9);
}

#[test]
fn a_vessel_feels_the_moment_of_a_line_that_is_clamped_to_it() {
    let rod = carried("", -2.0);
    let [fx, fy, fz, mx, my, mz] = rod.vessel_force(0);
    let [x, ..] = tip(&rod);
    assert!(fx.abs() < 1e-6 && fy.abs() < 1e-6 && (fz + 2.0).abs() < 1e-6);
    assert!((my - 2.0 * x).abs() < 1e-6, "{my} is not {}", 2.0 * x);
    assert!(mx.abs() < 1e-6 && mz.abs() < 1e-6);
}

/// Asserts that the error of the energy balance decreases with the step for a rotating clamp.
fn assert_balance_of_a_turning_clamp(integrator: &str, steps: [f64; 4]) {
    let errors = steps.map(|step| {
        let solver = format!("integrator = '{integrator}', time_step_max = {step}");
        let mut rod = carried(&solver, 0.0);
        for i in 0..100 {
            let angle = |t: f64| 0.2 * (1.5 * t).sin().powi(3);
            rod.set_pose(0, [0.0, 0.0, 0.0, 0.0, angle(0.04 * f64::from(i)), 0.0]);
            rod.advance(0.04).unwrap();
        }
        assert!(flow(&rod).external_work > 0.05);
        (step, balance_error(&rod).abs())
    });
    println!("{integrator} {errors:?}");
    assert!(order_of(&errors) > 1.5, "{integrator}: {errors:?}");
}

#[test]
fn the_work_of_a_clamp_that_turns_is_in_the_energy_balance() {
    assert_balance_of_a_turning_clamp("generalised_alpha", [0.02, 0.01, 0.005, 0.0025]);
    assert_balance_of_a_turning_clamp("axial_implicit", [4e-4, 2e-4, 1e-4, 5e-5]);
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn the_work_of_a_clamp_that_turns_is_in_the_energy_balance_of_explicit_steps() {
    assert_balance_of_a_turning_clamp("leapfrog", [8e-6, 4e-6, 2e-6, 1e-6]);
}

// ------------------------------------------------------------------ vibration

/// Asserts that the first three (βL)², the circular frequencies over √(EI/mL⁴), of a beam along x with this kind of
/// end converge to exact values at second order.
fn assert_frequencies(exact: [f64; 3], end: &str, clamps: &str, tension: f64) {
    let stiffness = 1e9; // [N]
    let scale = (EI / MASS / LENGTH.powi(4)).sqrt();
    let meshes = [20, 40, 80, 160];
    let found = meshes.map(|elements| {
        let beam = rod(stiffness, "")
            .fixed("a", [0.0; 3])
            .point(end, "b", [LENGTH * (1.0 + tension / stiffness), 0.0, 0.0])
            .line("rod", ["a", "b"], "rod", LENGTH, elements)
            .with(clamps);
        modes(&beam.start()).frequencies
    });
    for mode in 0..3 {
        // each frequency occurs in two planes
        let errors = [0, 1, 2, 3].map(|i| (found[i][2 * mode] / scale / exact[mode] - 1.0).abs());
        assert_order(2.0, &meshes.map(|n| 1.0 / n as f64), &errors);
        assert!(errors[3] < 1e-3);
    }
}

/// βL: roots of cos βL cosh βL = −1, of cos βL cosh βL = 1, and multiples of π.
#[test]
fn frequencies_of_beams_have_second_order() {
    let held = "clamped_a = [1.0, 0.0, 0.0]";
    let both = "clamped_a = [1.0, 0.0, 0.0], clamped_b = [1.0, 0.0, 0.0]";
    for (roots, end, clamps) in [
        (
            [1.8751040687119611, 4.694091132974175, 7.854757438237613],
            "free",
            held,
        ),
        (
            [4.730040744862704, 7.853204624095838, 10.995607838001671],
            "fixed",
            both,
        ),
        ([PI, 2.0 * PI, 3.0 * PI], "fixed", ""),
    ] {
        assert_frequencies(roots.map(|root| root * root), end, clamps, 0.0);
    }
}

/// ω² = (EI k⁴ + T k²)/m with k = iπ/L between pinned ends.
#[test]
fn frequencies_of_a_tensioned_beam_have_second_order() {
    let tension = 7.0;
    let exact = [1.0, 2.0, 3.0].map(|i: f64| {
        let k = i * PI;
        (k.powi(4) + tension * LENGTH * LENGTH / EI * k * k).sqrt()
    });
    assert_frequencies(exact, "fixed", "", tension);
}

/// A cantilever released from a small load, which is removed at t = 0.
fn released(solver: &str) -> Simulation {
    let load = "force = { z = { table = [[0.0, -0.05], [1e-9, 0.0]] } }";
    start(&cantilever(30, LEVEL, load, solver))
}

#[test]
fn a_cantilever_that_is_released_swings_with_its_first_natural_period() {
    let exact = 1.8751040687119611_f64.powi(2) * (EI / MASS / LENGTH.powi(4)).sqrt();
    for solver in [
        "integrator = 'generalised_alpha', spectral_radius = 0.8",
        "integrator = 'axial_implicit'",
    ] {
        let mut rod = released(solver);
        let (step, mut crossings, mut last) = (0.01, Vec::new(), tip(&rod)[2]);
        for i in 1..=2000 {
            rod.advance(step).unwrap();
            let now = tip(&rod)[2];
            if last < 0.0 && now >= 0.0 {
                crossings.push(step * (f64::from(i) - now / (now - last)));
            }
            last = now;
        }
        let periods = crossings.len() - 1;
        let found = TAU / ((crossings[periods] - crossings[0]) / periods as f64);
        assert!(
            (found / exact - 1.0).abs() < 5e-3,
            "{solver}: {found} is not {exact}"
        );
    }
}

// ------------------------------------------------------------------ energy

#[test]
fn the_energy_of_a_swinging_cantilever_stays_and_moves_between_its_kinds() {
    for solver in [
        "generalised_alpha', spectral_radius = 1.0",
        "axial_implicit', spectral_radius = 1.0",
        "leapfrog'",
    ] {
        let mut rod = released(&format!("integrator = '{solver}"));
        let start = rod.energy();
        assert!(start.bending > 0.0 && start.kinetic == 0.0 && start.gravitational == 0.0);
        let (mut worst, mut fastest) = (0.0_f64, 0.0_f64);
        for _ in 0..500 {
            rod.advance(0.005).unwrap();
            worst = worst.max(balance_error(&rod).abs());
            fastest = fastest.max(rod.energy().kinetic);
        }
        println!("{solver}: {worst} of {}", start.bending);
        assert!(
            worst < 2e-3 * start.bending,
            "{solver}: {worst} of {}",
            start.bending
        );
        assert!(fastest > 0.9 * start.bending);
    }
}

#[test]
fn the_energy_balance_of_a_driven_cable_closes_at_any_step() {
    for step in [0.04, 0.02, 0.01] {
        let cable = with_elements(shipped("power_cable"), 12);
        let mut cable = with_integrator(cable, Integrator::GeneralisedAlpha, step);
        cable.seabed = None;
        let mut simulation = following(&balanced(cable));
        run(&mut simulation, 0.2, 100);
        let error = error_of_given(&simulation).abs();
        assert!(error < 1e-7, "{step}: {error:e}");
    }
}

#[test]
fn a_quasi_static_pull_balances_its_energy() {
    for bending_stiffness in [None, Some(10.85)] {
        let mut scene = shipped("collar");
        scene.line_types.get_mut("wire").unwrap().bending_stiffness = bending_stiffness;
        let mut simulation = start(&balanced(scene));
        run(&mut simulation, 0.05, 200);
        assert!(flow(&simulation).external_work > 50.0);
        let error = error_of_given(&simulation);
        assert!(error < 2e-3, "{error:e}");
    }
}

// ------------------------------------------------------------------ hard cases

#[test]
fn stiffness_from_a_millionth_to_a_hundred_million_times_a_wires_finds_rest() {
    for exponent in -6..=8 {
        let bending_stiffness = 10.85 * 10.0_f64.powi(exponent);
        for elements in [2, 20, 200] {
            let mut collar = with_elements(shipped("collar"), elements);
            let wire = collar.line_types.get_mut("wire").unwrap();
            // limits the radius of gyration to 0.1 m
            wire.axial_stiffness = wire.axial_stiffness.map(|ea| ea.max(100.0 * bending_stiffness));
            wire.bending_stiffness = Some(bending_stiffness);
            let [span, sag] = drawn_out(&collar);
            let found = format!("{bending_stiffness}, {elements}: {span}, {sag}");
            assert!(
                span > 17.6 && span < 20.001 && (0.0..4.5).contains(&sag),
                "{found}"
            );
        }
    }
}

/// 100 m of cable on the seabed between ends 95 m apart, which are moved together by 3 m and back within 20 s.
fn slack(bending_stiffness: f64, elements: usize) -> Scene {
    draft(format!(
        "water.density = 1025.0
        seabed = {{ depth = 50.0, stiffness = 1e5, damping = 1e4 }}
        line_types.cable = {{ mass = 30.0, diameter = 0.12, axial_stiffness = 5e7, bending_stiffness = {bending_stiffness:e},
          drag_normal = 1.2, added_mass_normal = 1.0 }}"
    ))
    .fixed("a", [0.0, 0.0, -50.0])
    .point("prescribed", "b", [95.0, 0.0, -49.9])
    .with("motion = { x = [[-3.0, 20.0]], ramp = 5.0 }")
    .line("cable", ["a", "b"], "cable", 100.0, elements)
    .with("clamped_a = [1.0, 0.0, 0.0]")
    .scene()
}

#[test]
fn a_slack_cable_on_the_seabed_buckles_and_goes_on() {
    for exponent in [-3, 0, 2, 4, 6, 9] {
        for elements in [10, 100] {
            let mut cable = start(&balanced(slack(10.0_f64.powi(exponent), elements)));
            run(&mut cable, 0.2, 100);
            assert!(nodes(&cable).iter().all(|r| r.amax() < 150.0));
            assert!(balance_error(&cable).is_finite());
        }
    }
}

#[test]
fn a_line_that_hardly_bends_rests_on_the_seabed_like_one_that_does_not_bend() {
    let rest = |bending_stiffness: Option<f64>| {
        let mut cable = slack(1.0, 10);
        (cable.lines[0].clamped_a, cable.points[1].position) = (None, [70.0, 0.0, -20.0]);
        cable.line_types.get_mut("cable").unwrap().bending_stiffness = bending_stiffness;
        nodes(&start(&cable)).to_vec()
    };
    let flexible = rest(None);
    for stiffness in [0.0, 1e-9, 1e-3] {
        let most = gap(&flexible, &rest(Some(stiffness)));
        // EI/(lH) with elements of 10 m and a horizontal tension of some 100 N
        assert!(
            most <= 1e-9 + 1e-3 * stiffness,
            "EI = {stiffness} N m²: {most:.1e} m"
        );
    }
}

/// A heavy rod clamped at one end and free at the other.
fn heavy_rod(bending_stiffness: f64, elements: usize, clamp: [f64; 3]) -> Scene {
    draft(format!(
        "solver.time_step_max = 0.02
        line_types.rod = {{ mass = 1.0, axial_stiffness = 1e7, bending_stiffness = {bending_stiffness:e} }}"
    ))
    .fixed("root", [0.0; 3])
    .free("tip", [5.0, 0.0, 0.0])
    .line("rod", ["root", "tip"], "rod", 5.0, elements)
    .with(&format!("clamped_a = {clamp:?}"))
    .scene()
}

/// Without bending stiffness all these rods would hang straight down, some of them folded back at the clamp.
#[test]
fn a_heavy_cantilever_comes_to_rest_whichever_way_it_is_clamped() {
    for clamp in [
        [1.0, 0.0, 0.0],
        [0.3, 0.2, 1.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ] {
        for exponent in [-4, -2, 0, 2, 4, 6] {
            for elements in [5, 50] {
                let mut rod = start(&heavy_rod(10.0_f64.powi(exponent), elements, clamp));
                let before = Vector3::from(tip(&rod));
                run(&mut rod, 0.1, 20);
                let drift = (Vector3::from(tip(&rod)) - before).norm();
                assert!(drift < 1e-6, "1e{exponent}, {clamp:?}: {drift} m");
            }
        }
    }
}

#[test]
fn a_section_without_bending_stiffness_is_a_hinge() {
    let mut chain = shipped("power_cable");
    chain.line_types.get_mut("buoyant").unwrap().bending_stiffness = None;
    let nodes = start(&chain).bending(0).unwrap().to_vec();
    assert!(nodes[100..=150].iter().all(|node| node.moment == 0.0));
    assert!(nodes[151..].iter().any(|node| node.moment > 0.0));
}

#[test]
fn a_line_split_into_sections_of_one_type_is_the_same_line() {
    let mut whole = shipped("power_cable");
    whole.line_types.get_mut("buoyant").unwrap().mass = Some(70.0);
    let mut parts = whole.clone();
    let first = parts.lines[0].sections[0].clone();
    let part = |length, elements| Section {
        length,
        elements: Some(elements),
        ..first.clone()
    };
    parts.lines[0]
        .sections
        .splice(0..1, [part(30.0, 30), part(70.0, 70)]);
    let [whole, parts] = [whole, parts].map(|scene| start(&scene).bending(0).unwrap().to_vec());
    for (a, b) in whole.into_iter().zip(parts) {
        assert!((a.moment - b.moment).abs() < 1e-6);
    }
}

/// A weightless rod that lies on an arc of radius 4 m and 1.25 rad, unstressed when straight.
fn arched_rod(elements: u16) -> Scene {
    let mut rod = heavy_rod(40.0, usize::from(elements), LEVEL);
    rod.gravity = 0.0;
    let count = f64::from(elements);
    let angles = (0..=elements).map(|i| 1.25 * f64::from(i) / count);
    let arc = |angle: f64| [4.0 * angle.sin(), 4.0 * (1.0 - angle.cos()), 0.0];
    rod.lines[0].initial = InitialShape::Nodes(angles.map(arc).collect());
    rod.lines[0].sections[0].length = count * 8.0 * (0.5 * 1.25 / count).sin(); // the chords
    rod.points[1].position = arc(1.25);
    rod
}

/// On finer meshes rounding hides that the shape is stable, and another unstressed one is found: its curvature has no direction.
#[test]
fn a_line_that_is_unstressed_as_it_lies_is_at_rest_there() {
    for elements in [10, 20, 40, 80] {
        let mut rod = arched_rod(elements);
        rod.lines[0].rest_shape = RestShape::Initial;
        let rest = Simulation::at_rest(&rod).unwrap_or_else(|error| panic!("{elements}: {error}"));
        let (tip, there) = (Vector3::from(tip(&rest)), Vector3::from(rod.points[1].position));
        assert!((tip - there).amax() < 1e-6, "{elements}: {tip}");
    }
}

#[test]
fn a_line_that_is_unstressed_as_it_lies_stays_there() {
    let mut rod = arched_rod(20);
    let moments = |scene: &Scene| start(scene).bending(0).unwrap().to_vec();
    let straight = moments(&rod);
    assert!((straight[10].moment / (40.0 / 4.0) - 1.0).abs() < 0.01);
    rod.lines[0].rest_shape = RestShape::Initial;
    assert!(moments(&rod).iter().all(|node| node.moment == 0.0));
    let mut rod = start(&rod);
    let before = Vector3::from(tip(&rod));
    run(&mut rod, 0.1, 20);
    let moved = (Vector3::from(tip(&rod)) - before).amax();
    assert!(moved < 1e-6, "{moved} m");
}

/// A light rod of 10 m and EI = 10 kN m² under an end moment of 100 N m, of which the half at the clamp is ten times as stiff.
const STEPPED: &str = "
    gravity = 0.0
    line_types.soft = { mass = 1.0, axial_stiffness = 1e7, bending_stiffness = 1e4 }
    line_types.stiff = { mass = 1.0, axial_stiffness = 1e7, bending_stiffness = 1e5 }
    points = [{ name = 'root', position = [0, 0, 0], kind = 'fixed' },
      { name = 'tip', position = [10, 0, 0], kind = 'free', moment = { y = { table = [[0.0, -100.0], [1.0, -100.0]] } } }]
    lines = [{ name = 'rod', from = 'root', to = 'tip', clamped_a = [1, 0, 0],
      sections = [{ type = 'stiff', length = 5, elements = 10 }, { type = 'soft', length = 5, elements = 10 }] }]";

#[test]
fn where_the_stiffness_changes_the_curvature_is_that_of_the_softer_side() {
    let rod = start(&Scene::from_toml(STEPPED).unwrap());
    let nodes = rod.bending(0).unwrap();
    for (node, stiffness) in [(5, 1e5), (9, 1e5), (10, 1e4), (11, 1e4), (15, 1e4)] {
        let curvature = 100.0 / stiffness;
        assert!(
            (nodes[node].curvature / curvature - 1.0).abs() < 1e-3,
            "{node}: {:?}",
            nodes[node]
        );
    }
}

/// A light rod of 10 m, pinned at end A, whose end B is clamped to a vessel that pitches by 0.02 rad at 2 rad/s. Rayleigh damping makes its stiffness
/// EI (1 + iωβ) with β = 0.5 s.
const ON_A_PITCHING_VESSEL: &str = "
    gravity = 0.0
    line_types.rod = { mass = 0.1, axial_stiffness = 1e6, bending_stiffness = 1e4, rayleigh = { ratios = [0.25, 0.5], frequencies = [1.0, 2.0] } }
    points = [{ name = 'pin', position = [0, 0, 0], kind = 'free', free = ['x'], mass = 1.0 },
      { name = 'clamp', position = [0, 0, 0], kind = 'coupled', on = 'ship' }]
    lines = [{ name = 'rod', from = 'pin', to = 'clamp', clamped_b = [1, 0, 0], sections = [{ type = 'rod', length = 10 }] }]
    vessels = [{ name = 'ship', position = [10, 0, 0] }]
    motion.ship = { pitch = [[0.02, 3.141592653589793]], ramp = 8.0 }
    solver = { integrator = 'generalised_alpha', time_step_max = 0.005 }";

#[test]
fn a_damped_rod_resists_the_rotation_of_its_clamp_by_its_complex_stiffness() {
    let stiffness = 3.0 * 1e4 / 10.0;
    let wanted = stiffness * 0.02 * 1.0_f64.hypot(2.0 * 0.5);
    for elements in [20, 40, 80] {
        let scene = with_elements(Scene::from_toml(ON_A_PITCHING_VESSEL).unwrap(), elements);
        let mut rod = following(&balanced(scene));
        run(&mut rod, 0.1, 160);
        let mut most = 0.0_f64;
        for _ in 0..160 {
            rod.advance(0.02).unwrap();
            let [_, _, fz, _, my, _] = rod.vessel_force(0);
            most = most.max(my.abs());
            // about the clamp, the only other force on the light rod is that of the pin
            assert!(
                (my.abs() - 10.0 * fz.abs()).abs() < 0.02 * wanted,
                "{elements}: {my} {fz}"
            );
        }
        println!("{elements}: {most} {wanted} {}", balance_error(&rod));
        assert!((most / wanted - 1.0).abs() < 0.02, "{elements}: {most} {wanted}");
        assert!(
            balance_error(&rod).abs() < 1e-3,
            "{elements}: {}",
            balance_error(&rod)
        );
    }
}

#[test]
fn a_line_that_bends_needs_two_elements() {
    let message = Simulation::new(&heavy_rod(1.0, 1, LEVEL)).unwrap_err();
    assert!(message.to_string().starts_with("lines[0].sections"), "{message}");
}

#[test]
fn a_leapfrog_is_refused_where_joints_are_damped_or_springs_curved() {
    let with = |change: fn(&mut LineType)| {
        let mut cable = shipped("power_cable");
        cable.line_types.values_mut().for_each(change);
        cable
    };
    let damped: fn(&mut LineType) = |kind| {
        kind.rayleigh = Some(Rayleigh {
            ratios: [0.01, 0.01],
            frequencies: [1.0, 10.0],
        });
    };
    for change in [damped, |kind| kind.strain = Strain::Green] {
        let cable = with(change);
        assert_eq!(chosen(&cable), Integrator::GeneralisedAlpha);
        for integrator in [Integrator::Leapfrog, Integrator::AxialImplicit] {
            let mut cable = cable.clone();
            cable.solver.integrator = integrator;
            let message = Simulation::new(&cable).unwrap_err().to_string();
            assert!(message.starts_with("solver.integrator"), "{message}");
            assert_says(&message, &["where the line bends"]);
        }
    }
}

/// Integrator of the only network of a scene.
fn chosen(scene: &Scene) -> Integrator {
    start(scene).choices().next().unwrap().integrator
}

#[test]
fn a_cable_takes_fully_implicit_steps_where_its_elements_are_short() {
    assert_eq!(chosen(&shipped("power_cable")), Integrator::AxialImplicit);
    let short = with_elements(shipped("power_cable"), 600);
    assert_eq!(chosen(&short), Integrator::GeneralisedAlpha);
}

/// Tension at the hang-off [N] and greatest curvature [1/m] of the power cable with three times 80 elements from 20 to 30 s, each as vectors along x.
/// At 15 s a kink of the ramp starts undamped axial waves.
fn driven(integrator: Integrator, step: f64) -> [Vec<Vector3<f64>>; 2] {
    let cable = with_elements(shipped("power_cable"), 80);
    let mut simulation = following(&with_integrator(cable, integrator, step));
    let mut history = [Vec::new(), Vec::new()];
    run(&mut simulation, 0.05, 400);
    for _ in 0..200 {
        simulation.advance(0.05).unwrap();
        let curvatures = simulation.bending(0).unwrap().iter().map(|node| node.curvature);
        history[0].push(simulation.tension_b(0) * Vector3::x());
        history[1].push(greatest(curvatures) * Vector3::x());
    }
    history
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_driven_cable_moves_alike_in_all_integrators() {
    let implicit = driven(Integrator::GeneralisedAlpha, 0.01);
    for integrator in [Integrator::AxialImplicit, Integrator::Leapfrog] {
        let explicit = driven(integrator, 0.05);
        let errors = [0, 1].map(|i| relative_rms(&explicit[i], &implicit[i]));
        println!(
            "{integrator:?}: tension {:e}, curvature {:e}",
            errors[0], errors[1]
        );
        assert!(errors[0] < 5e-3 && errors[1] < 1e-3, "{integrator:?}: {errors:?}");
    }
}

// ------------------------------------------------------------------ power cable

#[test]
fn the_power_cable_rests_in_a_lazy_wave_and_stays_there() {
    let mut cable = start(&shipped("power_cable"));
    let weight: f64 = cable.model().lines[0].nodes.weight.iter().sum();
    let nodes = nodes(&cable);
    let (arch, sag) = (nodes[150].z, -greatest(nodes[170..].iter().map(|r| -r.z)));
    assert!(arch > sag + 2.0, "arch {arch}, sag {sag}");
    assert!(cable.laid_length(0) > 10.0);
    let [_, _, lift] = cable.end_force(1);
    assert!(-lift < weight, "{lift} of {weight}");
    let curvature = greatest(cable.bending(0).unwrap().iter().map(|node| node.curvature));
    assert!((0.01..1.0).contains(&curvature));
    let drift = drift(&mut cable, 1.0, 60);
    assert!(drift < 1e-7, "{drift} m");
}

#[test]
fn a_clamp_is_as_stiff_in_the_equilibrium_of_a_run_from_a_given_shape_as_in_statics() {
    let mut scene = draft(
        "line_types.cable = { mass = 20.0, diameter = 0.1, axial_stiffness = 1.0e7, bending_stiffness = 1.0e3 }",
    )
    .fixed("wall", [0.0, 0.0, 0.0])
    .fixed("post", [9.9, 0.0, 0.0])
    .line("cable", ["wall", "post"], "cable", 10.0, Some(10))
    .scene();
    scene.lines[0].clamped_a = Some([1.0, 0.0, 0.3]);
    let moment = |simulation: &Simulation| simulation.bending(0).unwrap()[0].moment;
    let hung = moment(&Simulation::at_rest(&scene).unwrap());
    scene.lines[0].initial = InitialShape::Straight;
    let laid = moment(&Simulation::at_rest(&scene).unwrap());
    let settled = moment(&Simulation::new(&scene).unwrap().in_equilibrium().unwrap());
    for found in [laid, settled] {
        assert!((found / hung - 1.0).abs() < 1e-9, "{found}, {hung}");
    }
}

/// Moment at the hang-off of the power cable with `elements` elements in the last 90 m [N m]: at rest, and the greatest from 15 to 30 s.
fn hang_off_moments(elements: usize) -> [f64; 2] {
    let mut scene = shipped("power_cable");
    scene.lines[0].sections[2].elements = Some(elements);
    let mut cable = start(&scene);
    let moment = |cable: &Simulation| cable.bending(0).unwrap().last().unwrap().moment;
    let at_rest = moment(&cable);
    cable.follow_scene().unwrap();
    cable.advance(15.0).unwrap();
    let moments = (0..300).map(|_| {
        cable.advance(0.05).unwrap();
        moment(&cable)
    });
    [at_rest, greatest(moments)]
}

#[test]
fn the_moment_at_a_clamp_is_that_of_a_fine_mesh_with_elements_that_do_not_resolve_the_bend() {
    let exact = hang_off_moments(900); // eight elements over the bend
    for (elements, bounds) in [(180, [0.005, 0.005]), (90, [0.015, 0.005]), (45, [0.04, 0.01])] {
        let moments = hang_off_moments(elements);
        let errors = [0, 1].map(|which| moments[which] / exact[which] - 1.0);
        assert!(
            errors[0].abs() < bounds[0] && errors[1].abs() < bounds[1],
            "{elements}: {errors:?}"
        );
    }
}

#[test]
fn curvature_and_moment_are_outputs_of_lines_that_bend() {
    let scene = shipped("power_cable");
    let cable = start(&scene);
    let table = Interface::new(&scene, cable.model(), Layout::Arrays).unwrap();
    let read = |name: &str| {
        let mut rows = table.variables().iter();
        let row = rows.find(|row| row.name == name).unwrap();
        let mut values = vec![f64::NAN; row.size()];
        Interface::read(row, &cable, &mut values).unwrap();
        values
    };
    let moments = read("cable.profile.moment");
    let most = greatest(moments.iter().copied());
    assert_eq!(read("cable.moment_max"), [most]);
    assert_eq!(read("cable.moment_b"), [moments[240]]);
    assert_eq!(read("cable.moment_a"), [moments[0]]);
    let stiffness = most / read("cable.curvature_max")[0];
    assert!((stiffness / 1e4 - 1.0).abs() < 1e-9, "{stiffness}");
    let plain = shipped("collar");
    let table = Interface::new(&plain, &Model::new(&plain).unwrap(), Layout::Scalars).unwrap();
    let bends = |name: &str| name.contains("moment") || name.contains("curvature");
    assert!(!table.variables().iter().any(|row| bends(&row.name)));
}
