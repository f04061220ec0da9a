//! Lines whose tension is no stiffness times strain: tables of tension over strain.
//!
//! Claims: a table of a straight line is a stiffness; a line at rest carries what its table says; energy is kept, and what the integrators make or
//! lose of it vanishes with the square of the step.

mod common;

use approx::assert_relative_eq;
use common::*;
use moorline::scene::{Integrator, Scene};
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
    for integrator in [
        Integrator::Leapfrog,
        Integrator::AxialImplicit,
        Integrator::GeneralisedAlpha,
    ] {
        let (coarse, fine) = (
            energy_error(integrator, 4e-3),
            energy_error(integrator, 1e-3),
        );
        println!("{integrator:?}: {coarse:.2e} {fine:.2e}");
        assert!(fine < 1e-3, "{integrator:?}: {fine}");
        assert!(
            fine < 0.1 * coarse || fine < 1e-9,
            "{integrator:?}: {coarse} {fine}"
        );
    }
}

#[test]
fn a_table_that_does_not_rise_is_refused_with_its_row() {
    let mistake = |table: &str| {
        let text = rope("axial_stiffness = 1.0", 200.0, "").to_toml();
        let text = text.replace(
            "axial_stiffness = 1.0",
            &format!("tension_strain = {table}"),
        );
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
