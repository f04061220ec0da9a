//! First guess of the shape of a line, before the assembled equilibrium is solved.

use nalgebra::Vector3;

use super::catenary::{self, Catenary, FlatSeabed};
use crate::model::{Line, Model};
use crate::scene::InitialShape;

/// Ends of a line in the vertical plane through them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    /// End A [m].
    pub a: Vector3<f64>,
    /// Horizontal direction from A to B [-].
    pub along: Vector3<f64>,
    /// Horizontal distance [m].
    pub span: f64,
    /// Height of B above A [m].
    pub rise: f64,
}

impl Plane {
    /// Plane through ends A and B [m].
    pub(crate) fn new([a, b]: [Vector3<f64>; 2]) -> Plane {
        let across = Vector3::new(b.x - a.x, b.y - a.y, 0.0);
        let span = across.norm();
        let along = if span > 0.0 { across / span } else { Vector3::x() };
        Plane {
            a,
            along,
            span,
            rise: b.z - a.z,
        }
    }

    /// Position of a point of a catenary between the ends [m].
    pub(crate) fn place(&self, point: &catenary::Point) -> Vector3<f64> {
        self.a + point.x * self.along + point.z * Vector3::z()
    }

    /// Positions of the nodes of a line on its catenary [m].
    fn nodes(&self, line: &Line, solved: &Catenary) -> Vec<Vector3<f64>> {
        let arc = line.nodes.arc.iter();
        arc.map(|&s| self.place(&solved.at(s))).collect()
    }

    /// Forces of a line on the points at its ends [N].
    pub(crate) fn end_forces(&self, solved: &Catenary) -> [Vector3<f64>; 2] {
        let force = |h: f64, v: f64| h * self.along + v * Vector3::z();
        let a = force(solved.horizontal_a(), solved.vertical_a());
        [a, -force(solved.horizontal(), solved.vertical_b())]
    }
}

/// Nodes of a line between its ends [m] on its closed-form catenary, with the tensions of its segments [N]. If there is none because an end lies
/// under the seabed, the nodes lie on a parabola of about the right length.
pub(crate) fn hang(
    model: &Model,
    line: &Line,
    ends: [Vector3<f64>; 2],
    tension: &mut [f64],
) -> Vec<Vector3<f64>> {
    let plane = Plane::new(ends);
    let mut nodes = match closed_form(model, line, &plane) {
        Some(solved) => {
            for (tension, arc) in tension.iter_mut().zip(line.nodes.arc.windows(2)) {
                *tension = solved.at(0.5 * (arc[0] + arc[1])).tension;
            }
            plane.nodes(line, &solved)
        }
        None => hang_parabola(line, ends, tension),
    };
    if let Some(contact) = line.nodes.contact.as_ref().filter(|_| !model.seabed_is_level()) {
        for r in &mut nodes {
            r.z = r.z.max(contact.height_under(*r));
        }
    }
    ending_at(ends, nodes)
}

/// Nodes [m] of the initial shape of a line in the scene, between its ends [m]; `None` for the static shape.
pub(crate) fn start_shape(model: &Model, line: &Line, ends: [Vector3<f64>; 2]) -> Option<Vec<Vector3<f64>>> {
    if line.initial != InitialShape::Catenary {
        return line.given_shape(ends);
    }
    let plane = Plane::new(ends);
    let nodes = closed_form(model, line, &plane).map(|solved| plane.nodes(line, &solved));
    Some(ending_at(
        ends,
        nodes.unwrap_or_else(|| line.parabola(ends, 0.0).collect()),
    ))
}

/// Nodes [m] with the first and the last exactly at the ends.
fn ending_at([a, b]: [Vector3<f64>; 2], mut nodes: Vec<Vector3<f64>>) -> Vec<Vector3<f64>> {
    let last = nodes.len() - 1;
    (nodes[0], nodes[last]) = (a, b);
    nodes
}

pub(crate) fn closed_form(model: &Model, line: &Line, plane: &Plane) -> Option<Catenary> {
    let seabed = line.nodes.contact.as_ref().map(|contact| FlatSeabed {
        height: contact.height_under(plane.a) - plane.a.z,
        friction: model.seabed_friction,
    });
    catenary::solve(&line.sections, plane.span, plane.rise, seabed).ok()
}

/// Returns whether a line on a catenary from end A at `a` [m] comes out of the water, which the closed form does not model.
pub(crate) fn is_pierced(line: &Line, solved: &Catenary, a: Vector3<f64>) -> bool {
    let height = |&s: &f64| (a.z + solved.at(s).z) * Vector3::z();
    let heights = || line.nodes.arc.iter().map(height).collect::<Vec<_>>();
    line.surface
        .as_ref()
        .is_some_and(|surface| surface.is_pierced(&heights()))
}

fn hang_parabola(line: &Line, [a, b]: [Vector3<f64>; 2], tension: &mut [f64]) -> Vec<Vector3<f64>> {
    let length = line.unstretched_length();
    let weight: f64 = line.nodes.weight.iter().sum();
    let chord = (b - a).norm();
    let sag = (0.375 * chord.max(0.1 * length) * (length - chord).max(0.0)).sqrt() * weight.signum();
    let contact = line.nodes.contact.as_ref();
    let seabed = contact.map_or(f64::NEG_INFINITY, |contact| contact.height_under(a));
    tension.fill(match sag == 0.0 {
        true => 0.0,
        false => (weight * chord / (8.0 * sag)).abs(),
    });
    let mut nodes: Vec<_> = line.parabola([a, b], sag).collect();
    for r in &mut nodes {
        r.z = r.z.max(seabed.min(a.z).min(b.z));
    }
    nodes
}
