//! First guess of the shape of a line, before the assembled equilibrium is solved.

use nalgebra::Vector3;

use super::catenary::{self, Catenary, FlatSeabed};
use crate::model::{Line, Model};
use crate::scene::InitialShape;

/// Puts the nodes of a line between its ends at `a` and `b` [m] on its closed-form catenary, with the tensions of its
/// segments [N]. Where there is none, because an end lies under the seabed, the nodes lie on a parabola of about the
/// right length.
pub(crate) fn hang(
    model: &Model,
    line: &Line,
    a: Vector3<f64>,
    b: Vector3<f64>,
    position: &mut [Vector3<f64>],
    tension: &mut [f64],
) {
    let chord = b - a;
    match closed_form(model, line, a, chord.xy().norm(), chord.z) {
        Some(solved) => {
            let arc = &line.nodes.arc;
            draw(&solved, arc, a, chord, position);
            for (i, tension) in tension.iter_mut().enumerate() {
                *tension = solved.at(0.5 * (arc[i] + arc[i + 1])).tension;
            }
        }
        None => hang_parabola(line, a, b, position, tension),
    }
    if let Some(contact) = line.nodes.contact.as_ref().filter(|_| !model.seabed_is_level()) {
        for r in position.iter_mut() {
            r.z = r.z.max(contact.height_under(*r));
        }
    }
    let last = position.len() - 1;
    (position[0], position[last]) = (a, b);
}

/// Nodes [m] of the shape that the scene gives a line at the start, between ends at `a` and `b` [m]; `None` for the static one.
pub(crate) fn start_shape(
    model: &Model,
    line: &Line,
    a: Vector3<f64>,
    b: Vector3<f64>,
) -> Option<Vec<Vector3<f64>>> {
    match line.initial {
        InitialShape::Catenary => Some(catenary_or_chord(model, line, a, b)),
        _ => line.given_shape(a, b),
    }
}

/// Nodes [m] of a line on its closed-form catenary between ends at `a` and `b` [m], on their chord where it has none.
fn catenary_or_chord(model: &Model, line: &Line, a: Vector3<f64>, b: Vector3<f64>) -> Vec<Vector3<f64>> {
    let chord = b - a;
    let (arc, length) = (&line.nodes.arc, line.unstretched_length());
    let mut position: Vec<_> = arc.iter().map(|s| a + s / length * chord).collect();
    if let Some(solved) = closed_form(model, line, a, chord.xy().norm(), chord.z) {
        draw(&solved, arc, a, chord, &mut position);
    }
    let last = position.len() - 1;
    (position[0], position[last]) = (a, b);
    position
}

/// Puts nodes at the lengths `arc` [m] along a catenary that begins at `a` [m], in the plane of its `chord` [m].
fn draw(solved: &Catenary, arc: &[f64], a: Vector3<f64>, chord: Vector3<f64>, position: &mut [Vector3<f64>]) {
    let span = chord.xy().norm();
    let along = if span > 0.0 {
        Vector3::new(chord.x, chord.y, 0.0) / span
    } else {
        Vector3::x()
    };
    for (r, &s) in position.iter_mut().zip(arc) {
        let point = solved.at(s);
        *r = a + point.x * along + point.z * Vector3::z();
    }
}

/// The catenary of a line, from end A at `a` over a span and a rise [m].
pub(crate) fn closed_form(
    model: &Model,
    line: &Line,
    a: Vector3<f64>,
    span: f64,
    rise: f64,
) -> Option<Catenary> {
    let seabed = line.nodes.contact.as_ref().map(|contact| FlatSeabed {
        height: contact.height_under(a) - a.z,
        friction: model.seabed_friction,
    });
    catenary::solve(&line.sections, span, rise, seabed).ok()
}

fn hang_parabola(
    line: &Line,
    a: Vector3<f64>,
    b: Vector3<f64>,
    position: &mut [Vector3<f64>],
    tension: &mut [f64],
) {
    let length = line.unstretched_length();
    let weight: f64 = line.nodes.weight.iter().sum();
    let chord = (b - a).norm();
    let sag = (0.375 * chord.max(0.1 * length) * (length - chord).max(0.0)).sqrt() * weight.signum();
    let seabed = line
        .nodes
        .contact
        .as_ref()
        .map_or(f64::NEG_INFINITY, |contact| contact.height_under(a));
    for (r, arc) in position.iter_mut().zip(&line.nodes.arc) {
        let u = arc / length;
        *r = a + u * (b - a) - 4.0 * sag * u * (1.0 - u) * Vector3::z();
        r.z = r.z.max(seabed.min(a.z).min(b.z));
    }
    tension.fill(if sag == 0.0 {
        0.0
    } else {
        (weight * chord / (8.0 * sag)).abs()
    });
}
