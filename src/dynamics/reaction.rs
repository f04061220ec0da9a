//! Forces that a line applies to the points at its ends, and tensions along it.
//!
//! The end's half node belongs to the line, so that what the vessel feels is
//!
//! F = T q + S − [M(t) a + w ẑ − f_drag − f_waves − f_bed],
//!
//! T q pointing into the line, S the shear of a line with bending stiffness, v and a those of the point. Leaving the half node out would make the end force first order in
//! the segment length. A line on its closed-form catenary brings the forces of that.
//!
//! Source: the node's own equation of motion, as for the interior nodes.

use nalgebra::Vector3;

use super::beam::BeamView;
use super::creep::{Creeping, Stretching};
use super::leapfrog::segment_tension;
use crate::model::{Dry, End, Line, LineState, PointState, Reel, WaterAlong};
use crate::physics::morison::{self, DragCoefficients};
use crate::statics::assembly::end_shear;

/// Tension of segment `i` [N]; on a closed-form catenary the mean of its ends'.
pub fn tension(line: &Line, state: &LineState, i: usize, negative_tension: bool) -> f64 {
    if let Some(view) = BeamView::of(line, state) {
        return view.tension(i);
    }
    if let Some(closed_form) = &state.closed_form {
        return 0.5 * (closed_form.tension[i] + closed_form.tension[i + 1]);
    }
    let pair = |values: &[Vector3<f64>]| [values[i], values[i + 1]];
    if let Some(creep) = Creeping::of(line, state, i) {
        let strain = Stretching::of(line, i, pair(&state.position), pair(&state.velocity));
        return creep.tension(strain, line.compression_max(i), negative_tension);
    }
    segment_tension(
        line,
        i,
        pair(&state.position),
        pair(&state.velocity),
        negative_tension,
    )
}

/// What the winch feels of the material that it speeds up and that its half node holds, over −λq [N]: m ℓ̇² + M ℓ̈.
fn passing(line: &Line, reel: Reel) -> f64 {
    let (node, nodes) = (line.segment_count(), &line.nodes);
    let density = nodes.mass[node] / nodes.length[node]; // [kg/m]
    density * reel.rate.powi(2) + nodes.mass_tangent[node] * reel.acceleration
}

/// Force [N] of the line on the point at one of its ends, in water that moves or rests.
pub fn end_force(
    line: &Line,
    state: &LineState,
    end: End,
    point: &PointState,
    water: WaterAlong,
    negative_tension: bool,
) -> Vector3<f64> {
    if state.parted[usize::from(end == End::B)] {
        return Vector3::zeros();
    }
    if let Some(view) = BeamView::of(line, state) {
        return view.end_action(end, point).0;
    }
    if let Some(closed_form) = &state.closed_form {
        let [a, b] = closed_form.end_force;
        return match end {
            End::A => a,
            End::B => b,
        };
    }
    let node = line.end_node(end);
    let (segment, other) = match end {
        End::A => (0, 1),
        End::B => (node - 1, node - 1),
    };
    let chord = state.position[other] - state.position[node];
    let inward = chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
    let nodes = &line.nodes;
    let (velocity, acceleration) = (point.velocity, point.acceleration);
    let surface = line.surface.as_ref();
    let dry = surface.map_or(Dry::default(), |surface| {
        surface.node_in(water, node, &state.position)
    });
    let along = acceleration.dot(&inward) * inward;
    let [mass_normal, mass_tangent] = nodes.masses(node, dry.part);
    let inertia = mass_normal * (acceleration - along) + mass_tangent * along;
    let mut force = tension(line, state, segment, negative_tension) * inward - inertia;
    if let (Some(reel), End::B) = (state.reel, end) {
        force -= passing(line, reel) * chord / line.segments.length[segment];
    }
    force.z -= nodes.weight[node] + dry.weight;
    if line.bending.is_some() {
        force += end_shear(line, [&state.position, &state.velocity], end, point);
    }
    if let Some(drag) = &nodes.drag {
        let coefficients = DragCoefficients {
            normal: drag.normal[node],
            tangent: drag.tangent[node],
        }
        .times(1.0 - dry.part);
        let flow = water.velocity(node, state.position[node].z);
        force += morison::drag(coefficients, velocity - flow, inward);
    }
    if let (Some(pressed), Some(waves)) = (&nodes.pressed, &water.waves) {
        let wet = 1.0 - dry.part;
        force += wet * pressed.force(node, waves.at(node).acceleration, inward);
    }
    if let Some(damping) = &nodes.mass_damping {
        force -= damping[node] * velocity;
    }
    if let Some(contact) = &nodes.contact {
        force += contact.push(node, state.position[node], velocity);
    }
    force
}
