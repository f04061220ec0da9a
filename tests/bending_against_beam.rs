//! The cable with bending against the geometrically exact beam: a power cable in a lazy wave, with part of it on the seabed.
//!
//!          ● hang-off, clamped and driven          EI = 10 kN m², EA = 400 MN
//!          ╲      ___                              beam: GA = 100 MN, GJ = 10 kN m²
//!           ╲___╱     ╲
//!                       ╲══════● seabed end, clamped
//!
//! A clamped end bends over √(EI/T), 0.8 m under the hang-off. The last 10 m there have elements a quarter as long as the others.

mod common;

use common::{following, order, shipped};
use moorline::scene::{LineModel, Scene, Section};
use moorline::simulation::Simulation;

/// Length at the hang-off with short elements [m].
const BEND_LENGTH: f64 = 10.0;

/// The shipped cable with so many elements a metre, four times as many at the hang-off.
fn cable(per_metre: f64) -> Scene {
    let mut scene = shipped("power_cable");
    let sections = &mut scene.lines[0].sections;
    let last = sections.last_mut().unwrap();
    last.length -= BEND_LENGTH;
    let bend = Section {
        length: BEND_LENGTH,
        ..last.clone()
    };
    for section in sections.iter_mut() {
        section.elements = Some((per_metre * section.length) as usize);
    }
    sections.push(Section {
        elements: Some((4.0 * per_metre * BEND_LENGTH) as usize),
        ..bend
    });
    scene
}

/// The same line as a beam, all but stiff against shear.
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
    let nodes = simulation.bending(0).unwrap();
    nodes.iter().map(|node| node.curvature).collect()
}

fn greatest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// Greatest difference of two sequences over the greatest value of the second [-].
fn greatest_difference(values: &[f64], reference: &[f64]) -> f64 {
    assert_eq!(values.len(), reference.len());
    let pairs = values.iter().zip(reference);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / greatest(reference)
}

#[test]
fn a_cable_rests_with_the_curvature_of_the_beam_at_second_order() {
    let meshes = [0.5, 1.0, 2.0, 4.0];
    let differences = meshes.map(|per_metre| {
        let [cable, beam] = [cable(per_metre), beam(per_metre)];
        let [cable, beam] = [cable, beam].map(|scene| Simulation::new(&scene).unwrap());
        assert!(beam.laid_length(0) > 10.0);
        greatest_difference(&curvature(&cable), &curvature(&beam))
    });
    println!("difference along the line {differences:?} at {meshes:?} elements a metre");
    assert!(differences[2] < 0.01 && differences[3] < 0.0025);
    let slope = order(&meshes, &differences);
    assert!((slope + 2.0).abs() < 0.1, "order {slope}: {differences:?}");
}

/// Greatest curvature along the line at the end of every communication step of the shipped run [1/m].
fn curvature_in_time(scene: &Scene) -> Vec<f64> {
    let mut simulation = following(scene);
    let sample = |simulation: &Simulation| greatest(&curvature(simulation));
    let mut history = vec![sample(&simulation)];
    for _ in 0..1200 {
        simulation.advance(0.05).unwrap();
        history.push(sample(&simulation));
    }
    history
}

#[test]
fn a_driven_cable_has_the_greatest_curvature_of_the_beam_at_all_times() {
    let [cable, beam] = [cable(2.0), beam(2.0)].map(|scene| curvature_in_time(&scene));
    let (found, wanted) = (greatest(&cable), greatest(&beam));
    let difference = greatest_difference(&cable, &beam);
    println!("greatest {found} 1/m, beam {wanted} 1/m; at any time within {difference}");
    assert!(wanted > 2.0 * beam[0], "the motion bends the line");
    assert!((found / wanted - 1.0).abs() < 0.01, "{found}, {wanted}");
    assert!(difference < 0.01, "{difference}");
}
