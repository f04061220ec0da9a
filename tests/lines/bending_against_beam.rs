//! Cable with bending stiffness against the geometrically exact beam: a power cable in a lazy wave, partly on the seabed.
//!
//!          ● hang-off, clamped and driven          EI = 10 kN m², EA = 400 MN
//!          ╲      ___                              beam: GA = 100 MN, GJ = 10 kN m²
//!           ╲___╱     ╲
//!                       ╲══════● seabed end, clamped
//!
//! The bending at a clamped end extends over √(EI/T), 0.8 m at the hang-off. The last 10 m there have elements a quarter as long as the others.

use crate::common::*;
use moorline::scene::{LineModel, Scene, Section};
use moorline::simulation::Simulation;

/// Length with short elements at the hang-off [m].
const BEND_LENGTH: f64 = 10.0;

/// The shipped cable with `per_metre` elements per metre, and four times as many at the hang-off.
fn cable(per_metre: f64) -> Scene {
    let mut scene = shipped("power_cable");
    let sections = &mut scene.lines[0].sections;
    sections.last_mut().unwrap().length -= BEND_LENGTH;
    for section in sections.iter_mut() {
        section.elements = Some((per_metre * section.length) as usize);
    }
    let elements = Some((4.0 * per_metre * BEND_LENGTH) as usize);
    let last = sections.last().unwrap().clone();
    sections.push(Section {
        length: BEND_LENGTH,
        elements,
        ..last
    });
    scene
}

/// The same line as a beam with high shear stiffness.
fn beam(per_metre: f64) -> Scene {
    let mut scene = cable(per_metre);
    for line_type in scene.line_types.values_mut() {
        line_type.model = LineModel::Beam;
        line_type.shear_stiffness = Some(1e8);
        line_type.torsional_stiffness = Some(1e4);
        line_type.rotary_inertia = Some(0.05);
    }
    scene
}

/// Curvature at every node [1/m].
fn curvature(simulation: &Simulation) -> Vec<f64> {
    simulation
        .bending(0)
        .unwrap()
        .iter()
        .map(|node| node.curvature)
        .collect()
}

/// Greatest difference of two sequences, relative to the greatest value of the second [-].
fn greatest_difference(values: &[f64], reference: &[f64]) -> f64 {
    assert_eq!(values.len(), reference.len());
    let pairs = values.iter().zip(reference);
    greatest(pairs.map(|(a, b)| (a - b).abs())) / greatest(reference.iter().copied())
}

#[test]
fn a_cable_rests_with_the_curvature_of_the_beam_at_second_order() {
    let meshes = [0.5, 1.0, 2.0, 4.0];
    let differences = meshes.map(|per_metre| {
        let [cable, beam] = [cable(per_metre), beam(per_metre)].map(|scene| start(&scene));
        assert!(beam.laid_length(0) > 10.0);
        greatest_difference(&curvature(&cable), &curvature(&beam))
    });
    println!("difference along the line {differences:?} at {meshes:?} elements a metre");
    assert!(differences[2] < 0.01 && differences[3] < 0.0025);
    assert_order(-2.0, &meshes, &differences);
}

#[test]
#[cfg_attr(not(feature = "slow-tests"), ignore = "slow")]
fn a_driven_cable_has_the_greatest_curvature_of_the_beam_at_all_times() {
    let [cable, beam] = [cable(2.0), beam(2.0)].map(|scene| {
        let mut simulation = following(&scene);
        let mut history = vec![greatest(curvature(&simulation))];
        for _ in 0..1200 {
            simulation.advance(0.05).unwrap();
            history.push(greatest(curvature(&simulation)));
        }
        history
    });
    let [found, wanted] = [&cable, &beam].map(|history| greatest(history.iter().copied()));
    let difference = greatest_difference(&cable, &beam);
    println!("greatest {found} 1/m, beam {wanted} 1/m; at any time within {difference}");
    assert!(wanted > 2.0 * beam[0], "the motion bends the line");
    assert!((found / wanted - 1.0).abs() < 0.01, "{found}, {wanted}");
    assert!(difference < 0.01, "{difference}");
}
