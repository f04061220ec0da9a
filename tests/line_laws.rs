//! Lines whose tension is no stiffness times strain: tables of tension over strain, and viscoelastic ropes.
//!
//! Claims: a table of a straight line is a stiffness; a line at rest carries what its table says; energy is kept, and what the integrators make or
//! lose of it vanishes with the step. A viscoelastic rope has its static stiffness at rest, its dynamic one in fast motion, and
//! loses in every cycle what the closed form says.

mod common;

use approx::assert_relative_eq;
use common::*;
use moorline::physics::viscoelastic::Viscoelastic;
use moorline::scene::{self, Integrator, Scene};
use moorline::simulation::Simulation;

/// A rope of 200 m drawn out to `span` [m], with these keys for its stretch, and the motion of its fairlead.
fn rope(keys: &str, span: f64, motion: &str) -> Scene {
    scene(&format!(
        r#"
        [line_types.rope]
        mass = 20.0
        weight = 150.0
        {keys}
        [[points]]
        name = "anchor"
        position = [0.0, 0.0, -100.0]
        kind = "fixed"
        [[points]]
        name = "fairlead"
        position = [{span}, 0.0, -100.0]
        kind = "coupled"
        [[lines]]
        name = "rope"
        from = "anchor"
        to = "fairlead"
        sections = [{{ type = "rope", length = 200.0, elements = 20 }}]
        [motion]
        {motion}
        "#
    ))
}

/// A polyester rope: soft at first, stiffer later.
const TABLE: &str = "axial_damping = 0.0
    tension_strain = [[0.0, 0.0], [0.01, 4.0e5], [0.02, 1.0e6], [0.04, 3.0e6], [0.06, 6.0e6]]";
const SWAY: &str = "fairlead = { x = [[1.5, 7.0]], z = [[1.0, 5.0]], ramp = 5.0 }";

#[test]
fn a_table_of_a_straight_line_is_a_stiffness() {
    let damping = "axial_damping = 1.0e5\n";
    let table = format!("{damping}tension_strain = [[0.0, 0.0], [0.01, 4.0e5], [0.03, 1.2e6]]");
    let stiffness = format!("{damping}axial_stiffness = 4.0e7");
    for integrator in [
        Integrator::Leapfrog,
        Integrator::AxialImplicit,
        Integrator::GeneralisedAlpha,
        Integrator::QuasiStatic,
    ] {
        let run = |keys: &str| {
            let scene = with_integrator(rope(keys, 202.0, SWAY), integrator, 0.01);
            History::record(&mut following(&scene), 0.1, 100).tension
        };
        let tolerance = match integrator {
            Integrator::QuasiStatic => 5e-3, // a closed form beside 20 elements
            _ => 1e-7,
        };
        for (a, b) in run(&table).into_iter().zip(run(&stiffness)) {
            assert_relative_eq!(a, b, max_relative = tolerance);
        }
    }
}

#[test]
fn a_light_rope_at_rest_carries_what_its_table_says() {
    for (strain, tension) in [(0.01, 4.0e5), (0.02, 1.0e6), (0.04, 3.0e6), (0.06, 6.0e6)] {
        let mut scene = rope(TABLE, 200.0 * (1.0 + strain), "");
        scene.line_types.get_mut("rope").unwrap().weight = Some(0.0);
        let simulation = Simulation::new(&scene).unwrap();
        assert_relative_eq!(simulation.tension_b(0), tension, max_relative = 1e-9);
    }
}

/// What the integrator has made or lost of the energy after 10 s, over the greatest energy of motion, with steps of `step` [s].
fn energy_error(integrator: Integrator, step: f64) -> f64 {
    let mut scene = with_integrator(rope(TABLE, 203.0, SWAY), integrator, step);
    scene.solver.spectral_radius = (integrator != Integrator::Leapfrog).then_some(1.0);
    let mut simulation = following(&scene);
    let mut greatest: f64 = 0.0;
    for _ in 0..100 {
        simulation.advance(0.1).unwrap();
        greatest = greatest.max(simulation.energy().kinetic);
    }
    simulation.energy_error().abs() / greatest
}

#[test]
fn a_tabulated_rope_keeps_its_energy() {
    for integrator in INTEGRATORS {
        let (coarse, fine) = (energy_error(integrator, 2e-3), energy_error(integrator, 5e-4));
        println!("{integrator:?}: {coarse:.2e} {fine:.2e}");
        assert!(fine < 1e-3, "{integrator:?}: {fine}");
        assert!(
            fine < 0.25 * coarse || fine < 1e-9,
            "{integrator:?}: {coarse} {fine}"
        );
    }
}

/// A rope with these keys for its stretch that its fairlead draws taut in every swing; moved by one integrator with steps of at most `step` [s].
fn snapping(stretch: &str, integrator: Integrator, step: f64) -> Simulation {
    let keys = format!(
        "{stretch}
        diameter = 0.12
        drag_normal = 1.2
        drag_tangential = 0.05
        added_mass_normal = 1.0"
    );
    let motion = "fairlead = { x = [[4.0, 8.0]], z = [[3.0, 8.0, 1.57]] }";
    let mut scene = rope(&keys, 219.0, motion);
    scene.line_types.get_mut("rope").unwrap().weight = None;
    scene.water = Some(scene::Water::still(1025.0));
    scene.lines[0].sections[0].length = 222.0;
    following(&with_integrator(scene, integrator, step))
}

#[test]
fn a_rope_that_snaps_taut_is_held_by_the_stiffness_that_it_comes_to() {
    // soft at first, and forty times as stiff when it is drawn taut
    let stretch = "tension_strain = [[0.0, 0.0], [0.01, 1.0e5], [0.02, 8.0e5], [0.04, 4.0e6]]
        damping_ratio = 0.04"; // 0.02 of one of the rope's 20 elements
    let explicit = &mut snapping(stretch, Integrator::Leapfrog, 2e-4);
    let reference = History::record(explicit, 0.1, 400);
    for (integrator, step, steps, bound) in [
        (Integrator::Leapfrog, 0.05, 20_000, 0.01),
        (Integrator::AxialImplicit, 0.05, 1500, 0.09),
        (Integrator::AxialImplicit, 0.01, 5000, 0.045),
        (Integrator::AxialImplicit, 0.002, 25_000, 0.005),
    ] {
        let mut simulation = snapping(stretch, integrator, step);
        let history = History::record(&mut simulation, 0.1, 400);
        let error = history.tension_error(&reference, 300);
        let flow = simulation.ledger().flow;
        let ledger = simulation.energy_error().abs() / (flow.given.abs() + flow.lost);
        println!(
            "{integrator:?}, {step} s: {error:.4}, ledger {ledger:.1e}, {} steps, {} solves",
            history.substeps, history.solves
        );
        assert!(
            error < bound && ledger < 1e-3 && history.substeps < steps,
            "{integrator:?}, {step}"
        );
    }
}

/// Dampers of segments that are slack pull as these come near to being taut: what the averaging remembers of a tension is that of spring and damper.
#[test]
fn a_rope_that_dampers_draw_before_it_is_taut_converges_to_the_motion_of_explicit_steps() {
    for (damping, bounds) in [
        (4.0e5, [0.09, 0.013]),
        (4.0e6, [0.022, 0.002]),
        (4.0e7, [0.12, 0.017]),
    ] {
        let stretch = format!("axial_stiffness = 4.0e7\n axial_damping = {damping}");
        let record = |integrator, step| {
            let mut simulation = snapping(&stretch, integrator, step);
            History::record(&mut simulation, 0.1, 400)
        };
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
fn a_table_that_does_not_rise_is_refused_with_its_row() {
    let mistake = |table: &str| {
        let text = rope("axial_stiffness = 1.0", 200.0, "").to_toml();
        let text = text.replace("axial_stiffness = 1.0", &format!("tension_strain = {table}"));
        Scene::from_toml(&text).unwrap_err()
    };
    for (table, at, said) in [
        (
            "[[0.0, 0.0], [0.01, 5.0], [0.02, 5.0]]",
            "[2]",
            "tension must rise",
        ),
        (
            "[[0.0, 0.0], [0.01, 5.0], [0.01, 6.0]]",
            "[2]",
            "strain must rise",
        ),
        ("[[0.0, 10.0], [0.01, 50.0]]", "[0]", "[0.0, 0.0]"),
        ("[[0.0, 0.0]]", "", "two rows"),
        ("{ file = \"rope.txt\" }", "", "rope.txt"),
    ] {
        let mistake = mistake(table);
        assert_eq!(mistake.at, format!("line_types.rope.tension_strain{at}"));
        assert!(mistake.problem.contains(said), "{}", mistake.problem);
    }
}

#[test]
fn a_scene_with_a_table_is_written_and_read_back_to_the_same() {
    let scene = rope(TABLE, 203.0, SWAY);
    assert_eq!(Scene::from_toml(&scene.to_toml()).unwrap(), scene);
}

const INTEGRATORS: [Integrator; 3] = [
    Integrator::Leapfrog,
    Integrator::AxialImplicit,
    Integrator::GeneralisedAlpha,
];

/// A viscoelastic rope.
const VISCOELASTIC: &str = "static_stiffness = 4.0e7
    dynamic_stiffness = 9.0e7
    static_damping = 2.0e8
    dynamic_damping = 2.0e6";

#[test]
fn a_viscoelastic_rope_rests_as_one_of_its_static_stiffness_does_and_stays_there() {
    for integrator in INTEGRATORS {
        let build = |keys: &str| {
            let scene = with_integrator(rope(keys, 203.0, ""), integrator, 0.05);
            Simulation::new(&scene).unwrap()
        };
        let mut simulation = build(VISCOELASTIC);
        let still = build("axial_stiffness = 4.0e7").tension_b(0);
        assert_relative_eq!(simulation.tension_b(0), still, max_relative = 1e-9);
        for _ in 0..100 {
            simulation.advance(0.2).unwrap();
        }
        assert_relative_eq!(simulation.tension_b(0), still, max_relative = 1e-6);
        assert!(
            simulation.energy_error().abs() < 1e-2,
            "{}",
            simulation.energy_error()
        );
    }
}

/// A light rope that is stretched to and fro at a circular frequency [rad/s] about a strain of 2 %.
fn stretched(integrator: Integrator, omega: f64, step: f64) -> Simulation {
    let period = 2.0 * std::f64::consts::PI / omega;
    let sway = format!("fairlead = {{ x = [[0.4, {period}]] }}");
    let mut scene = with_integrator(rope(VISCOELASTIC, 204.0, &sway), integrator, step);
    let rope = scene.line_types.get_mut("rope").unwrap();
    (rope.mass, rope.weight) = (Some(1.0), Some(0.0));
    scene.lines[0].sections[0].elements = Some(4);
    following(&scene)
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
    for integrator in INTEGRATORS {
        for omega in [0.1, 0.4, 1.2] {
            let period = 2.0 * std::f64::consts::PI / omega;
            let (count, step) = (
                400,
                if integrator == Integrator::Leapfrog {
                    0.05
                } else {
                    0.01
                },
            );
            let mut simulation = stretched(integrator, omega, step);
            let settling = (15.0 / period).ceil() as usize;
            for _ in 0..settling * count {
                simulation.advance(period / count as f64).unwrap();
            }
            let (before, [mut storage, mut loop_area]) = (simulation.ledger().flow, [0.0; 2]);
            for k in 0..count {
                let phase = 2.0 * std::f64::consts::PI * k as f64 / count as f64;
                let tension = simulation.tension_b(0);
                storage += 2.0 / count as f64 * tension * phase.sin() / 0.002;
                loop_area += tension * 0.4 * omega * phase.cos() * period / count as f64;
                simulation.advance(period / count as f64).unwrap();
            }
            let exact = modulus(omega);
            let area = std::f64::consts::PI * exact[1] * 0.002 * 0.002 * 200.0;
            let after = simulation.ledger().flow;
            let tolerance = 3e-3;
            assert_relative_eq!(storage, exact[0], max_relative = tolerance);
            assert_relative_eq!(loop_area, area, max_relative = tolerance);
            assert_relative_eq!(after.lost - before.lost, area, max_relative = tolerance);
            // the damping of the integrator is given too
            let given = after.given - before.given - (after.numerical - before.numerical);
            assert_relative_eq!(given, area, max_relative = tolerance);
        }
    }
}

#[test]
fn the_ledger_of_a_viscoelastic_rope_that_slackens_balances() {
    for integrator in INTEGRATORS {
        let errors = [8e-3, 1e-3].map(|step| {
            let sway = "fairlead = { x = [[3.0, 7.0]], z = [[1.0, 5.0]], ramp = 5.0 }";
            let mut scene = with_integrator(rope(VISCOELASTIC, 200.5, sway), integrator, step);
            scene.solver.spectral_radius = (integrator != Integrator::Leapfrog).then_some(1.0);
            let mut simulation = following(&scene);
            for _ in 0..200 {
                simulation.advance(0.1).unwrap();
            }
            simulation.energy_error().abs() / simulation.ledger().flow.lost
        });
        println!("{integrator:?}: {errors:?}");
        assert!(errors[1] < 1e-2, "{integrator:?}: {errors:?}");
    }
}

#[test]
fn a_viscoelastic_rope_replays_bit_for_bit_from_its_snapshot() {
    for integrator in INTEGRATORS {
        let mut simulation = following(&with_integrator(
            rope(VISCOELASTIC, 202.0, SWAY),
            integrator,
            0.02,
        ));
        let run = |simulation: &mut Simulation| {
            (0..50).for_each(|_| simulation.advance(0.1).unwrap());
            simulation.snapshot().clone()
        };
        run(&mut simulation);
        let bytes = postcard::to_stdvec(simulation.snapshot()).unwrap();
        let first = run(&mut simulation);
        simulation.restore(postcard::from_bytes(&bytes).unwrap());
        assert!(run(&mut simulation) == first, "{integrator:?}");
    }
}
