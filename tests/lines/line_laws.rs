//! Lines whose tension is not a constant stiffness times strain: tables of tension against strain, and viscoelastic
//! ropes.
//!
//! Claims: a table with a straight line is equivalent to a stiffness; a line at rest has the tension of its table; energy is
//! conserved, and the energy error of the integrators vanishes with the step. A viscoelastic rope has its static
//! stiffness at rest and its dynamic stiffness in fast motion, and dissipates in every cycle the energy of the closed form.

use std::f64::consts::PI;

use crate::common::*;
use approx::assert_relative_eq;
use moorline::model::End;
use moorline::physics::viscoelastic::Viscoelastic;
use moorline::scene::{Integrator, Scene, Water};
use moorline::simulation::Simulation;

/// A 200 m rope stretched to `span` [m], with these keys for its axial law and the motion of its fairlead.
fn rope(keys: &str, span: f64, motion: &str) -> Scene {
    draft(format!(
        "[line_types.rope]
        mass = 20.0
        weight = 150.0
        {keys}
        [motion]
        {motion}"
    ))
    .fixed("anchor", [0.0, 0.0, -100.0])
    .coupled("fairlead", [span, 0.0, -100.0])
    .line("rope", ["anchor", "fairlead"], "rope", 200.0, 20)
    .scene()
}

/// Table of a polyester rope: soft at first, then stiffer.
const TABLE: &str = "axial_damping = 0.0
    tension_strain = [[0.0, 0.0], [0.01, 4.0e5], [0.02, 1.0e6], [0.04, 3.0e6], [0.06, 6.0e6]]";
const SWAY: &str = "fairlead = { x = [[1.5, 7.0]], z = [[1.0, 5.0]], ramp = 5.0 }";

#[test]
fn a_table_of_a_straight_line_is_a_stiffness() {
    let table = "axial_damping = 1.0e5\ntension_strain = [[0.0, 0.0], [0.01, 4.0e5], [0.03, 1.2e6]]";
    let stiffness = "axial_damping = 1.0e5\naxial_stiffness = 4.0e7";
    for integrator in INTEGRATORS.into_iter().chain([Integrator::QuasiStatic]) {
        let [of_table, of_stiffness] = [table, stiffness].map(|keys| {
            let scene = with_integrator(rope(keys, 202.0, SWAY), integrator, 0.01);
            History::record(&mut following(&scene), 0.1, 100).tension
        });
        let tolerance = match integrator {
            Integrator::QuasiStatic => 5e-3, // closed form against 20 elements
            _ => 1e-7,
        };
        for (a, b) in of_table.into_iter().zip(of_stiffness) {
            assert_relative_eq!(a, b, max_relative = tolerance);
        }
    }
}

#[test]
fn a_light_rope_at_rest_carries_what_its_table_says() {
    for (strain, tension) in [(0.01, 4.0e5), (0.02, 1.0e6), (0.04, 3.0e6), (0.06, 6.0e6)] {
        let mut scene = rope(TABLE, 200.0 * (1.0 + strain), "");
        scene.line_types.get_mut("rope").unwrap().weight = Some(0.0);
        assert_relative_eq!(start(&scene).tension_b(0), tension, max_relative = 1e-9);
    }
}

/// The scene with an integrator without algorithmic dissipation.
fn undissipated(scene: Scene, integrator: Integrator, step: f64) -> Scene {
    let mut scene = with_integrator(scene, integrator, step);
    scene.solver.spectral_radius = (integrator != Integrator::Leapfrog).then_some(1.0);
    scene
}

#[test]
fn a_tabulated_rope_keeps_its_energy() {
    for integrator in INTEGRATORS {
        // energy error of the integrator after 10 s, relative to the greatest kinetic energy
        let [coarse, fine] = [2e-3, 5e-4].map(|step| {
            let mut simulation = following(&balanced(undissipated(
                rope(TABLE, 203.0, SWAY),
                integrator,
                step,
            )));
            let kinetic = |_| {
                simulation.advance(0.1).unwrap();
                simulation.energy().kinetic
            };
            let kinetic = greatest((0..100).map(kinetic));
            balance_error(&simulation).abs() / kinetic
        });
        println!("{integrator:?}: {coarse:.2e} {fine:.2e}");
        assert!(fine < 1e-3, "{integrator:?}: {fine}");
        assert!(
            fine < 0.25 * coarse || fine < 1e-9,
            "{integrator:?}: {coarse} {fine}"
        );
    }
}

/// A rope with these keys for its axial law, pulled taut by its fairlead in every cycle, with steps of at most `step` [s].
fn snapping(stretch: &str, integrator: Integrator, step: f64) -> Simulation {
    let sea = "diameter = 0.12\ndrag_normal = 1.2\ndrag_tangential = 0.05\nadded_mass_normal = 1.0";
    let motion = "fairlead = { x = [[4.0, 8.0]], z = [[3.0, 8.0, 1.57]] }";
    let mut scene = rope(&format!("{stretch}\n{sea}"), 219.0, motion);
    scene.line_types.get_mut("rope").unwrap().weight = None;
    scene.water = Some(Water::still(1025.0));
    scene.lines[0].sections[0].length = 222.0;
    following(&balanced(with_integrator(scene, integrator, step)))
}

#[test]
fn a_rope_that_snaps_taut_is_held_by_the_stiffness_that_it_comes_to() {
    // soft at first, and forty times as stiff when taut; the ratio is 0.02 of that of one of the rope's 20 elements
    let stretch = "tension_strain = [[0.0, 0.0], [0.01, 1.0e5], [0.02, 8.0e5], [0.04, 4.0e6]]
        damping_ratio = 0.04";
    let reference = History::record(&mut snapping(stretch, Integrator::Leapfrog, 2e-4), 0.1, 400);
    for (integrator, step, steps, bound) in [
        (Integrator::Leapfrog, 0.05, 20_000, 0.01),
        (Integrator::AxialImplicit, 0.05, 1500, 0.09),
        (Integrator::AxialImplicit, 0.01, 5000, 0.045),
        (Integrator::AxialImplicit, 0.002, 25_000, 0.005),
    ] {
        let mut simulation = snapping(stretch, integrator, step);
        let history = History::record(&mut simulation, 0.1, 400);
        let error = history.tension_error(&reference, 300);
        let flow = flow(&simulation);
        let balance = balance_error(&simulation).abs() / (flow.external_work.abs() + flow.dissipation);
        let found = format!(
            "{integrator:?}, {step} s: {error:.4}, balance {balance:.1e}, {} steps",
            history.substeps
        );
        println!("{found}, {} solves", history.solves);
        assert!(
            error < bound && balance < 1e-3 && history.substeps < steps,
            "{found}"
        );
    }
}

/// Dampers of slack segments pull when these are about to become taut: the averaging transmits the tension of spring and damper.
#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "takes long")]
fn a_rope_that_dampers_draw_before_it_is_taut_converges_to_the_motion_of_explicit_steps() {
    for (damping, bounds) in [
        (4.0e5, [0.09, 0.013]),
        (4.0e6, [0.022, 0.002]),
        (4.0e7, [0.12, 0.017]),
    ] {
        let stretch = format!("axial_stiffness = 4.0e7\n axial_damping = {damping}");
        let record = |integrator, step| History::record(&mut snapping(&stretch, integrator, step), 0.1, 400);
        let reference = record(Integrator::Leapfrog, 2e-4);
        for (step, bound) in [0.05, 0.005].into_iter().zip(bounds) {
            let history = record(Integrator::AxialImplicit, step);
            let error = history.tension_error(&reference, 200);
            println!(
                "BA = {damping:e} N s, {step} s: {error:.4}, {} solves",
                history.solves
            );
            assert!(error < bound, "{damping}, {step}: {error}");
        }
    }
}

#[test]
fn a_scene_with_a_table_is_written_and_read_back_to_the_same() {
    assert_written_and_read(&rope(TABLE, 203.0, SWAY));
}

/// A viscoelastic rope.
const VISCOELASTIC: &str = "static_stiffness = 4.0e7
    dynamic_stiffness = 9.0e7
    static_damping = 2.0e8
    dynamic_damping = 2.0e6";

#[test]
fn a_viscoelastic_rope_rests_as_one_of_its_static_stiffness_does_and_stays_there() {
    for integrator in INTEGRATORS {
        let build = |keys: &str| {
            start(&balanced(with_integrator(
                rope(keys, 203.0, ""),
                integrator,
                0.05,
            )))
        };
        let mut simulation = build(VISCOELASTIC);
        let still = build("axial_stiffness = 4.0e7").tension_b(0);
        assert_relative_eq!(simulation.tension_b(0), still, max_relative = 1e-9);
        run(&mut simulation, 0.2, 100);
        assert_relative_eq!(simulation.tension_b(0), still, max_relative = 1e-6);
        assert!(
            balance_error(&simulation).abs() < 1e-2,
            "{}",
            balance_error(&simulation)
        );
    }
}

/// A line that bends, 0.1 m longer than the distance between its clamps, and stands as an arch under 0.1 kN/m.
fn arch(keys: &str) -> Scene {
    draft(format!(
        "water.density = 1025.0
        line_types.pipe = {{ {}, bending_stiffness = 1e4, mass = 20.0, diameter = 0.15, drag_normal = 1.2, added_mass_normal = 1.0 }}",
        keys.replace('\n', ", ")
    ))
    .fixed("a", [0.0, 0.0, -50.0])
    .coupled("b", [9.9, 0.0, -50.0])
    .line("pipe", ["a", "b"], "pipe", 10.0, 20)
    .with("clamped_a = [1.0, 0.0, 0.0], clamped_b = [1.0, 0.0, 0.0]")
    .scene()
}

#[test]
fn a_viscoelastic_line_that_bends_pushes_at_rest_as_one_of_its_static_stiffness_does() {
    let force = |simulation: &Simulation| simulation.line_end_force(0, End::B);
    let still = force(&start(&arch("axial_stiffness = 4.0e7")));
    let mut simulation = start(&balanced(arch(VISCOELASTIC)));
    assert!((force(&simulation) - still).norm() < 1e-6 * still.norm());
    run(&mut simulation, 0.2, 50);
    let after = force(&simulation);
    assert!((after - still).norm() < 1e-5 * still.norm(), "{after} {still}");
    let error = balance_error(&simulation);
    assert!(error.abs() < 1e-3, "{error} J");
}

#[test]
fn a_viscoelastic_rope_that_should_push_in_implicit_steps_is_refused() {
    for integrator in INTEGRATORS {
        let mut scene = with_integrator(rope(VISCOELASTIC, 203.0, ""), integrator, 0.05);
        scene.solver.negative_tension = true;
        let implicit = [Integrator::GeneralisedAlpha, Integrator::Bossak].contains(&integrator);
        let problem = scene.check().err().map(|error| error.to_string());
        assert_eq!(problem.is_some(), implicit, "{integrator:?}: {problem:?}");
    }
}

/// A light rope that is stretched cyclically at a circular frequency [rad/s] about a strain of 2 %.
fn stretched(integrator: Integrator, omega: f64, step: f64) -> Simulation {
    let sway = format!("fairlead = {{ x = [[0.4, {}]] }}", 2.0 * PI / omega);
    let mut scene = with_integrator(rope(VISCOELASTIC, 204.0, &sway), integrator, step);
    let rope = scene.line_types.get_mut("rope").unwrap();
    (rope.mass, rope.weight) = (Some(1.0), Some(0.0));
    scene.lines[0].sections[0].elements = Some(4);
    following(&balanced(scene))
}

/// Storage and loss modulus [N] of the rope at a circular frequency [rad/s].
fn modulus(omega: f64) -> [f64; 2] {
    let law = Viscoelastic::new([4.0e7, 9.0e7], [2.0e8, 2.0e6]);
    let compliance = |ea: f64, ba: f64| {
        let (imaginary, square) = (omega * ba, ea * ea + omega * omega * ba * ba);
        (ea / square, -imaginary / square)
    };
    let ((a, b), (c, d)) = (compliance(law.slow, 2.0e8), compliance(law.fast, 2.0e6));
    let square = (a + c) * (a + c) + (b + d) * (b + d);
    [(a + c) / square, -(b + d) / square]
}

#[test]
fn the_loops_of_a_viscoelastic_rope_are_those_of_the_closed_form() {
    let count = 400;
    for (integrator, omega) in INTEGRATORS
        .into_iter()
        .flat_map(|i| [0.1, 0.4, 1.2].map(|omega| (i, omega)))
    {
        let period = 2.0 * PI / omega;
        let interval = period / count as f64;
        let step = if integrator == Integrator::Leapfrog {
            0.05
        } else {
            0.01
        };
        let mut simulation = stretched(integrator, omega, step);
        run(&mut simulation, interval, (15.0 / period).ceil() as usize * count);
        let (before, [mut storage, mut loop_area]) = (flow(&simulation), [0.0; 2]);
        for k in 0..count {
            let phase = 2.0 * PI * k as f64 / count as f64;
            let tension = simulation.tension_b(0);
            storage += 2.0 / count as f64 * tension * phase.sin() / 0.002;
            loop_area += tension * 0.4 * omega * phase.cos() * interval;
            simulation.advance(interval).unwrap();
        }
        let exact = modulus(omega);
        let area = PI * exact[1] * 0.002 * 0.002 * 200.0;
        let after = flow(&simulation);
        let lost = after.dissipation - before.dissipation;
        // includes the algorithmic dissipation of the integrator
        let given = after.external_work
            - before.external_work
            - (after.algorithmic_dissipation - before.algorithmic_dissipation);
        for (found, exact) in [
            (storage, exact[0]),
            (loop_area, area),
            (lost, area),
            (given, area),
        ] {
            assert_relative_eq!(found, exact, max_relative = 3e-3);
        }
    }
}

#[test]
fn the_energy_balance_of_a_viscoelastic_rope_that_slackens_closes() {
    let sway = "fairlead = { x = [[3.0, 7.0]], z = [[1.0, 5.0]], ramp = 5.0 }";
    for integrator in INTEGRATORS {
        let errors = [8e-3, 1e-3].map(|step| {
            let mut simulation = following(&balanced(undissipated(
                rope(VISCOELASTIC, 200.5, sway),
                integrator,
                step,
            )));
            run(&mut simulation, 0.1, 200);
            error_of_lost(&simulation)
        });
        println!("{integrator:?}: {errors:?}");
        assert!(errors[1] < 1e-2, "{integrator:?}: {errors:?}");
    }
}

#[test]
fn a_viscoelastic_rope_replays_bit_for_bit_from_its_snapshot() {
    for integrator in INTEGRATORS {
        let scene = with_integrator(rope(VISCOELASTIC, 202.0, SWAY), integrator, 0.02);
        let mut simulation = following(&scene);
        run(&mut simulation, 0.1, 50);
        assert_replays(simulation, following(&scene), |simulation| {
            run(simulation, 0.1, 50)
        });
    }
}
