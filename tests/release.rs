//! Lines that let go of a point: by the host's word, under too much tension, or at a time.
//!
//! Claims: a light straight line under tension snaps back as a bar does; a hanging chain falls freely, its middle with g; the point feels nothing of it
//! any more; the ledger balances through it; a snapshot replays it.

mod common;

use approx::assert_relative_eq;
use common::*;
use moorline::model::End;
use moorline::scene::{Integrator, Scene};
use moorline::simulation::Simulation;
use nalgebra::Vector3;

const INTEGRATORS: [Integrator; 3] = [
    Integrator::Leapfrog,
    Integrator::AxialImplicit,
    Integrator::GeneralisedAlpha,
];

/// A chain of 100 m over a span of 60 m between points 20 m apart in height, dry, with these keys of the line.
fn chain(keys: &str, surroundings: &str) -> Scene {
    scene(&format!(
        r#"
        {surroundings}
        [line_types.chain]
        mass = 20.0
        diameter = 0.05
        axial_stiffness = 1.0e6
        drag_normal = 1.2
        drag_tangential = 0.1
        [[points]]
        name = "anchor"
        position = [0.0, 0.0, -60.0]
        kind = "fixed"
        [[points]]
        name = "fairlead"
        position = [60.0, 0.0, -40.0]
        kind = "coupled"
        [[lines]]
        name = "line1"
        from = "anchor"
        to = "fairlead"
        sections = [{{ type = "chain", length = 100.0, elements = 25 }}]
        {keys}
        "#
    ))
}

#[test]
fn a_chain_that_lets_go_at_both_ends_falls_freely() {
    let keys = "release = \"b\"\nbreak = { at = \"a\", time = 0.0 }";
    for integrator in INTEGRATORS {
        let scene = with_integrator(chain(keys, ""), integrator, 1e-3);
        let mut simulation = Simulation::new(&scene).unwrap();
        let model = simulation.model().lines[0].clone();
        let centre = |simulation: &Simulation| {
            let nodes = simulation.state().lines[0].position.iter();
            let moment: f64 = nodes.zip(&model.nodes.mass).map(|(r, m)| r.z * m).sum();
            moment / model.nodes.mass.iter().sum::<f64>()
        };
        let start = centre(&simulation);
        simulation.set_release(0, true);
        for _ in 0..20 {
            simulation.advance(0.05).unwrap();
        }
        assert_eq!(simulation.parted(0), [true, true]);
        let fallen = start - centre(&simulation);
        assert_relative_eq!(fallen, 0.5 * 9.80665, max_relative = 4e-3);
        let error = simulation.energy_error().abs();
        let kinetic = simulation.energy().kinetic;
        assert!(error < 2e-2 * kinetic, "{integrator:?}: {error} of {kinetic}");
    }
}

#[test]
fn a_point_feels_nothing_of_a_line_that_let_go() {
    for integrator in INTEGRATORS {
        let scene = with_integrator(chain("release = \"b\"", ""), integrator, 1e-3);
        let mut simulation = Simulation::new(&scene).unwrap();
        assert!(simulation.tension_b(0) > 1e3);
        simulation.advance(0.1).unwrap();
        assert_eq!(simulation.parted(0), [false, false]);
        simulation.set_release(0, true);
        simulation.advance(0.1).unwrap();
        assert_eq!(simulation.end_force(1), [0.0; 3]);
        assert!(simulation.line_end_force(0, End::A).norm() > 100.0);
        simulation.set_release(0, false);
        simulation.advance(0.1).unwrap();
        assert_eq!(simulation.parted(0), [false, true], "for good");
    }
}

#[test]
fn the_ledger_balances_through_a_break() {
    let surroundings = "[water]\ndensity = 1025.0\n[seabed]\ndepth = 60.0\n[motion]\n\
                        fairlead = { x = [[2.0, 6.0]], z = [[2.0, 5.0]] }";
    let keys = "break = { at = \"b\", time = 2.0 }";
    for integrator in INTEGRATORS {
        let scene = with_integrator(chain(keys, surroundings), integrator, 1e-3);
        let mut simulation = following(&scene);
        let mut errors = Vec::new();
        for _ in 0..120 {
            simulation.advance(0.05).unwrap();
            errors.push(simulation.energy_error());
        }
        let lost = simulation.ledger().flow.lost;
        let jump = (errors[41] - errors[38]).abs();
        println!(
            "{integrator:?}: jump {jump:.3e}, error {:.3e}, lost {lost:.3e}",
            errors[119]
        );
        assert_eq!(simulation.parted(0), [false, true]);
        assert!(jump < 5e-3 * lost, "{integrator:?}: {jump} of {lost}");
        assert!(
            errors[119].abs() < 2e-2 * lost,
            "{integrator:?}: {} of {lost}",
            errors[119]
        );
    }
}

#[test]
fn a_line_breaks_when_its_end_carries_too_much() {
    for integrator in INTEGRATORS {
        let whole = with_integrator(chain("", ""), integrator, 2e-3);
        let still = Simulation::new(&whole).unwrap().tension_b(0);
        let keys = format!("break = {{ at = \"b\", tension = {} }}", 1.5 * still);
        let scene = with_integrator(chain(&keys, ""), integrator, 2e-3);
        let mut simulation = Simulation::new(&scene).unwrap();
        let (mut step, mut before) = (0, 0.0);
        while simulation.parted(0) == [false; 2] {
            step += 1;
            before = simulation.tension_b(0);
            let t = 0.05 * f64::from(step);
            simulation.set_displacement(1, [0.5 * t * t, 0.0, 0.0]);
            simulation.advance(0.05).unwrap();
            assert!(step < 400);
        }
        assert!(step > 10 && before < 1.6 * still, "{step} {before} {still}");
        assert_eq!(simulation.tension_b(0), 0.0);
        assert_eq!(simulation.parted(0), [false, true]);
    }
}

#[test]
fn a_taut_bar_snaps_back_behind_the_front_of_a_wave() {
    // until the front arrives, the wall pulls as before: momentum grows by EA ε t, and what lies ahead of the front is at rest
    let scene = scene(
        r#"
        gravity = 0.0
        line_types.bar = { mass = 10.0, axial_stiffness = 1.0e6, axial_damping = 0.0 }
        points = [
          { name = "wall", position = [0.0, 0.0, 0.0], kind = "fixed" },
          { name = "tip", position = [101.0, 0.0, 0.0], kind = "coupled" },
        ]
        lines = [{ name = "bar", from = "wall", to = "tip", release = "b", sections = [{ type = "bar", length = 100.0, elements = 200 }] }]
        "#,
    );
    let (c, strain) = ((1.0e6_f64 / 10.0).sqrt(), 0.01);
    for integrator in INTEGRATORS {
        let scene = with_integrator(scene.clone(), integrator, 2e-4);
        let mut simulation = Simulation::new(&scene).unwrap();
        simulation.set_release(0, true);
        simulation.advance(0.5 * 100.0 / c).unwrap();
        let mass = &simulation.model().lines[0].nodes.mass;
        let nodes = simulation.state().lines[0].velocity.iter().zip(mass);
        let momentum: f64 = nodes.map(|(v, m)| v.x * m).sum();
        assert_relative_eq!(momentum, -1.0e6 * strain * 50.0 / c, max_relative = 5e-3);
        let still = simulation.state().lines[0].position[40].x;
        assert_relative_eq!(still, 20.2, epsilon = 1e-3);
    }
}

#[test]
fn one_of_two_lines_at_a_free_point_lets_go_and_the_other_carries_on() {
    for integrator in [Integrator::Leapfrog, Integrator::GeneralisedAlpha] {
        let scene = scene(
            r#"
            line_types.rope = { mass = 5.0, axial_stiffness = 1.0e5 }
            points = [
              { name = "left", position = [-30.0, 0.0, 0.0], kind = "fixed" },
              { name = "right", position = [30.0, 0.0, 0.0], kind = "fixed" },
              { name = "clump", position = [0.0, 0.0, -10.0], kind = "free", mass = 200.0 },
            ]
            lines = [
              { name = "l", from = "left", to = "clump", sections = [{ type = "rope", length = 35.0, elements = 8 }] },
              { name = "r", from = "clump", to = "right", break = { at = "a", time = 1.0 }, sections = [{ type = "rope", length = 35.0, elements = 8 }] },
            ]
            "#,
        );
        let mut simulation = Simulation::new(&with_integrator(scene, integrator, 1e-3)).unwrap();
        (0..40).for_each(|_| simulation.advance(0.05).unwrap());
        assert_eq!(simulation.parted(1), [true, false]);
        let clump = simulation.state().points[2].position;
        let (of_left, of_right) = (
            simulation.state().lines[0].position[8],
            simulation.state().lines[1].position[0],
        );
        assert!((clump - of_left).norm() < 1e-9 && (clump - of_right).norm() > 1.0);
        let (error, kinetic) = (simulation.energy_error().abs(), simulation.energy().kinetic);
        assert!(error < 2e-2 * kinetic, "{integrator:?}: {error} of {kinetic}");
    }
}

#[test]
fn an_end_that_could_let_go_and_does_not_moves_as_one_that_cannot() {
    let water = "[water]\ndensity = 1025.0";
    let ways = ["", "break = { at = \"a\", time = 1.0 }"];
    for (integrator, way, elements) in INTEGRATORS
        .into_iter()
        .flat_map(|integrator| ways.map(|way| (integrator, way)))
        .flat_map(|(integrator, way)| [4, 24, 25].map(|elements| (integrator, way, elements)))
    {
        let runs = ["", "release = \"b\"\n"].map(|release| {
            let mut scene = chain(&format!("{release}{way}"), water);
            scene.lines[0].sections[0].elements = Some(elements);
            let mut simulation = Simulation::new(&with_integrator(scene, integrator, 1e-3)).unwrap();
            let mut history = Vec::new();
            for step in 1..=40 {
                let t = 0.05 * f64::from(step);
                simulation.set_displacement(1, [t.sin(), 0.0, 0.5 * t * t]);
                simulation.advance(0.05).unwrap();
                history.push(simulation.tension_b(0));
            }
            assert_eq!(simulation.parted(0), [!way.is_empty(), false]);
            (history, simulation.energy().total(), simulation.energy_error())
        });
        let [(held, energy, error), (may, other_energy, other_error)] = &runs;
        for (held, may) in held.iter().zip(may) {
            assert_relative_eq!(held, may, max_relative = 1e-6);
        }
        assert_relative_eq!(energy, other_energy, max_relative = 1e-9);
        assert!((error - other_error).abs() < 1e-9 * energy.abs());
    }
}

#[test]
fn a_release_replays_bit_for_bit_from_a_snapshot() {
    for integrator in INTEGRATORS {
        let keys = "release = \"b\"\nbreak = { at = \"a\", time = 0.6 }";
        let scene = with_integrator(chain(keys, ""), integrator, 5e-3);
        let mut simulation = Simulation::new(&scene).unwrap();
        simulation.advance(0.1).unwrap();
        simulation.set_release(0, true);
        (0..4).for_each(|_| simulation.advance(0.1).unwrap());
        let bytes = postcard::to_stdvec(simulation.snapshot()).unwrap();
        let run = |simulation: &mut Simulation| {
            (0..5).for_each(|_| simulation.advance(0.1).unwrap());
            simulation.state().clone()
        };
        let first = run(&mut simulation);
        simulation.restore(postcard::from_bytes(&bytes).unwrap());
        assert_eq!(run(&mut simulation), first);
    }
}

#[test]
fn a_simulation_goes_on_from_a_snapshot_after_a_step_that_grew_without_bound() {
    let keys = "break = { at = \"b\", time = 0.0 }";
    for integrator in INTEGRATORS {
        let scene = with_integrator(chain(keys, ""), integrator, 1e-3);
        let mut simulation = Simulation::new(&scene).unwrap();
        let sound = simulation.snapshot().clone();
        simulation.advance(0.1).unwrap();
        let should = simulation.snapshot().clone();
        simulation.restore(sound.clone());
        let count = simulation.state().lines[0].position.len();
        let mad: Vec<_> = (0..count).map(|i| Vector3::repeat(1e300 * i as f64)).collect();
        set_node_velocities(&mut simulation, &mad);
        assert!(simulation.advance(0.1).is_err(), "{integrator:?}");
        simulation.restore(sound);
        simulation.advance(0.1).unwrap();
        assert!(*simulation.snapshot() == should, "{integrator:?}");
    }
}

/// Heights of the free end of a hanging line of two elements whose top moves up and down, every 0.1 s [m].
fn shaken(step: f64) -> Vec<Vector3<f64>> {
    let text = r#"
        [line_types.rope]
        mass = 20.0
        diameter = 0.05
        axial_stiffness = 1.0e5
        [[points]]
        name = "top"
        position = [0.0, 0.0, 0.0]
        kind = "coupled"
        [[points]]
        name = "hand"
        position = [0.0, 0.0, -10.0980665] # carries nothing
        kind = "fixed"
        [[lines]]
        name = "line1"
        from = "top"
        to = "hand"
        release = "b"
        sections = [{ type = "rope", length = 10.0, elements = 2 }]
        [motion]
        top = { z = [[0.01, 1.0]], ramp = 1.0 }
        "#;
    let mut simulation = following(&with_integrator(scene(text), Integrator::GeneralisedAlpha, step));
    simulation.set_release(0, true);
    let mut heights = Vec::new();
    for _ in 0..20 {
        simulation.advance(0.1).unwrap();
        heights.push(simulation.state().lines[0].position[2]);
    }
    heights
}

#[test]
fn an_end_that_has_let_go_moves_at_second_order() {
    let steps = [0.01, 0.005, 0.0025, 0.00125];
    let exact = shaken(2e-4);
    let errors = steps.map(|step| relative_rms(&shaken(step), &exact));
    assert_order(2.0, &steps, &errors);
}

#[test]
fn an_end_that_may_let_go_limits_the_step_as_the_half_node_that_it_becomes() {
    let limit = |keys: &str| {
        let mut scene = with_integrator(chain(keys, ""), Integrator::Leapfrog, 1.0);
        let chain = scene.line_types.get_mut("chain").unwrap();
        chain.axial_damping = Some(0.0);
        let sections = &mut scene.lines[0].sections;
        let mut short = sections[0].clone();
        (short.length, short.elements) = (1.0, Some(1));
        (sections[0].length, sections[0].elements) = (100.0, Some(10));
        sections.push(short);
        let simulation = Simulation::new(&scene).unwrap();
        simulation.choices().next().unwrap().explicit.step
    };
    // 0.38 of 2/ω, with ω² = 2 Σk/M
    let inner = (2.0 * (1.0e5 + 1.0e6) / (20.0 * 5.5_f64)).sqrt();
    let end = (2.0 * 1.0e6 / (20.0 * 0.5_f64)).sqrt();
    assert_relative_eq!(limit(""), 0.76 / inner, max_relative = 1e-9);
    assert_relative_eq!(limit("release = \"a\""), 0.76 / inner, max_relative = 1e-9);
    assert_relative_eq!(limit("release = \"b\""), 0.76 / end, max_relative = 1e-9);
}

#[test]
fn lines_that_cannot_let_go_are_refused() {
    let refused = |text: &str, said: &str| {
        let mistake = Scene::from_toml(text).unwrap_err();
        assert!(mistake.problem.contains(said), "{mistake}");
    };
    let text = chain("release = \"b\"", "").to_toml();
    refused(
        &text.replace("mass = 20.0", "mass = 20.0\nbending_stiffness = 10.0"),
        "bending",
    );
    let quasi_static = format!("{text}\n").replace("integrator = \"auto\"", "integrator = \"quasi_static\"");
    refused(&quasi_static, "falls");
    refused(
        &chain("break = { at = \"a\", time = 1.0 }", "")
            .to_toml()
            .replace("time = 1.0\n", ""),
        "nothing breaks",
    );
}
