//! Natural modes of networks: closed forms, and the lowest modes of large networks against the full spectrum.

mod common;
#[path = "common/net.rs"]
mod net;

use std::f64::consts::PI;

use common::*;
use moorline::elements::Workspace;
use moorline::output::modes::{Direction, natural_modes};
use moorline::scene::Scene;
use moorline::simulation::Simulation;
use moorline::statics::modes::{Modes, ModesError};

/// A flat net without gravity or water; its ropes have one element, stretched from 9.5 m to 10 m.
fn taut_net(count: usize) -> Scene {
    let mut scene = net::net(count, 1);
    (scene.gravity, scene.water) = (0.0, None);
    for section in scene.lines.iter_mut().flat_map(|line| &mut line.sections) {
        section.length = 9.5;
    }
    for rope in scene.line_types.values_mut() {
        (rope.drag_normal, rope.drag_tangential, rope.added_mass_normal) = Default::default();
    }
    scene
}

/// Between straight ropes of length a under tension T, masses m vibrate normal to their plane with ω² = T/(m a) (4 − 2 cos p − 2 cos q),
/// p and q multiples of π/(N + 1).
#[test]
fn a_taut_net_has_the_frequencies_of_its_masses_between_springs() {
    const COUNT: usize = 4;
    let simulation = Simulation::new(&taut_net(COUNT)).unwrap();
    let found = natural_modes("", &simulation, 3 * COUNT * COUNT).unwrap();
    let (tension, mass) = (2e6 * 0.5 / 9.5, 2.0 + 2.0 * 5.0 * 9.5); // [N], [kg]
    let part = |i: usize| 2.0 - 2.0 * (PI * (i + 1) as f64 / (COUNT + 1) as f64).cos();
    let square = |i: usize| tension / (mass * 10.0) * (part(i / COUNT) + part(i % COUNT)); // ω² [1/s²]
    let mut exact: Vec<f64> = (0..COUNT * COUNT)
        .map(|i| square(i).sqrt() / (2.0 * PI))
        .collect();
    exact.sort_by(f64::total_cmp);
    let across = found
        .modes
        .iter()
        .filter(|mode| mode.direction == Direction::Transverse);
    let across: Vec<f64> = across.map(|mode| mode.frequency).collect();
    assert_eq!(across.len(), exact.len());
    for (found, exact) in across.iter().zip(&exact) {
        assert!((found / exact - 1.0).abs() < 1e-9, "{found} {exact}");
    }
}

#[test]
fn the_lowest_modes_of_a_large_net_and_of_a_stiff_fine_line_are_those_that_all_modes_begin_with() {
    let line = with_elements(shipped("oc3_catenary"), 150);
    for (scene, count, least, tolerance) in [(net::net(6, 3), 12, 500, 1e-8), (line, 6, 400, 1e-6)] {
        let simulation = Simulation::new(&scene).unwrap();
        let model = simulation.model();
        let mut work = Workspace::new(model);
        let all = Modes::lowest(model, 0, simulation.state(), usize::MAX, &mut work).unwrap();
        let lowest = Modes::lowest(model, 0, simulation.state(), count, &mut work).unwrap();
        assert_eq!(lowest.frequencies.len(), count);
        assert!(all.frequencies.len() > least, "{}", all.frequencies.len());
        for (found, exact) in lowest.frequencies.iter().zip(&all.frequencies) {
            assert!((found / exact - 1.0).abs() < tolerance, "{found} {exact}");
        }
        // modes of unit modal mass with a distinct frequency are equal except for their sign
        if scene.lines.len() > 1 {
            let shapes = [&all, &lowest].map(|modes| modes.shape(0, 30));
            let size = |k: usize| greatest(shapes[k].iter().map(|shape| shape.norm()));
            assert!((size(0) / size(1) - 1.0).abs() < 1e-6, "{} {}", size(0), size(1));
        }
    }
}

#[test]
fn modes_of_several_networks_are_sorted_together() {
    let mut scene = shipped("oc4_chain");
    let found = |scene: &Scene| {
        let simulation = Simulation::new(scene).unwrap().in_equilibrium().unwrap();
        natural_modes("", &simulation, 4).unwrap().modes
    };
    let alone = found(&scene);
    let mut other = scene.lines[0].clone();
    other.name = "other".to_string();
    scene.lines.push(other);
    let both = found(&scene);
    for (k, mode) in both.iter().enumerate() {
        assert!((mode.frequency / alone[k / 2].frequency - 1.0).abs() < 1e-9);
    }
    assert_ne!(both[0].greatest.line, both[1].greatest.line);
}

#[test]
fn beams_have_no_modes_and_the_error_names_one() {
    let simulation = Simulation::new(&shipped("flying_spaghetti")).unwrap();
    let error = natural_modes("", &simulation, 3).unwrap_err();
    assert!(matches!(error, ModesError::Beam { .. }), "{error}");
}
