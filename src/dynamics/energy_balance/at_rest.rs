//! External work and dissipation of a network between two states at rest, from the mean of the forces before and after a
//! step.
//!
//! Valid for steps over which the slopes of the forces change little: the mean is exact for forces that are linear in the
//! displacement.

use nalgebra::Vector3;

use super::Flow;
use crate::dynamics::leapfrog::segment_tension;
use crate::dynamics::viscoelastic::Stretching;
use crate::elements::friction::{resting_node, resting_point};
use crate::elements::{end_moment, end_moment_power, shear};
use crate::model::{ClosedForm, End, FreePoint, Line, LineState, Model, Network, PointState, State};
use crate::statics::equilibrium::current::drag_at_rest;

/// External work and dissipation [J] of a network at rest before and after a step between two times [s].
pub fn work_at_rest(model: &Model, network: &Network, states: [&State; 2], times: [f64; 2]) -> Flow {
    let mut flow = Flow::default();
    for &index in &network.lines {
        flow.external_work +=
            end_work(model, index, states, times) + current_work(model, index, states, times);
        flow.dissipation -= seabed_work(&model.lines[index], states.map(|state| &state.lines[index]));
    }
    for &index in &network.free_points {
        let (point, at) = (&model.points[index], states.map(|state| &state.points[index]));
        let Some(free) = point.free() else { continue };
        let force = |k: usize| {
            let stream = model.stream(times[k]);
            let drag = stream.map(|stream| free.drag_at_rest(at[k].position.z, stream));
            point.load_at(times[k]) + drag.unwrap_or_default()
        };
        flow.external_work += work([0, 1].map(force), at.map(|at| at.position));
        let (line, _) = point.attached[0];
        if states[1].lines[line].closed_form.is_none() {
            flow.dissipation -= point_seabed_work(model, free, at);
        }
    }
    flow
}

/// Work [J] of the mean of two forces [N] on the path between two positions [m].
fn work(forces: [Vector3<f64>; 2], [from, to]: [Vector3<f64>; 2]) -> f64 {
    0.5 * (forces[0] + forces[1]).dot(&(to - from))
}

/// Work [J] of the prescribed points at the ends of a line on the line, and of the moments on its ends.
fn end_work(model: &Model, index: usize, states: [&State; 2], times: [f64; 2]) -> f64 {
    let line = &model.lines[index];
    let moments = times.map(|t| model.end_moments(line, t));
    let shapes = states.map(|state| &state.lines[index].position);
    let way = |i: usize| shapes[1][i] - shapes[0][i];
    let mean = |k: usize| 0.5 * end_moment_power(shapes[k], moments[k], way);
    let mut given = mean(0) + mean(1);
    for (end, point) in [End::A, End::B].into_iter().zip(line.ends) {
        if model.points[point].free().is_some() {
            continue;
        }
        let points = states.map(|state| &state.points[point]);
        let force = |k: usize| {
            let state = states[k];
            force_of_line(line, &state.lines[index], end, &state.points[point], moments[k])
        };
        given -= work([0, 1].map(force), points.map(|at| at.position));
        if line.bending.is_some() {
            let moment = |state: &State| {
                end_moment(
                    line,
                    [&state.lines[index].position, &[]],
                    end,
                    &state.points[point],
                )
            };
            let moments = states.map(moment);
            let turned = points[1].orientation * points[0].orientation.inverse();
            given -= 0.5 * (moments[0] + moments[1]).dot(&turned.scaled_axis());
        }
    }
    given
}

/// Work [J] of current drag on the nodes of a line.
fn current_work(model: &Model, index: usize, states: [&State; 2], times: [f64; 2]) -> f64 {
    let line = &model.lines[index];
    let (Some(before), Some(after)) = (model.stream(times[0]), model.stream(times[1])) else {
        return 0.0;
    };
    let free = |end: usize| model.points[line.ends[end]].free().is_some();
    let [old, new] = states.map(|state| &state.lines[index].position);
    let nodes = usize::from(!free(0))..=line.segment_count() - usize::from(!free(1));
    let on_node = |i: usize| {
        let drags = [
            drag_at_rest(line, old, i, before),
            drag_at_rest(line, new, i, after),
        ];
        work(drags, [old[i], new[i]])
    };
    nodes.map(on_node).sum()
}

/// Work [J] of the seabed on a line: on the inner nodes, or along the part of a closed-form catenary that lies on it.
fn seabed_work(line: &Line, shapes: [&LineState; 2]) -> f64 {
    let Some(contact) = &line.nodes.contact else {
        return 0.0;
    };
    if let [Some(before), Some(after)] = shapes.map(|shape| shape.closed_form.as_ref()) {
        let positions = shapes.map(|shape| &shape.position[..]);
        return friction_work(contact.seabed_level, positions, [before, after]);
    }
    let push = |shape: &LineState, i: usize| {
        let node = resting_node(line, shape, i, None);
        node.map_or(Vector3::zeros(), |node| node.push().force)
    };
    let on_node = |i: usize| {
        work(
            shapes.map(|shape| push(shape, i)),
            shapes.map(|shape| shape.position[i]),
        )
    };
    (1..line.segment_count()).map(on_node).sum()
}

/// Work [J] of friction on a seabed at a height [m], from the growth of the horizontal tension of closed-form catenaries.
/// The friction of a segment acts on the one of its nodes that is on the seabed, or on both.
fn friction_work(seabed: f64, positions: [&[Vector3<f64>]; 2], shapes: [&ClosedForm; 2]) -> f64 {
    let on_segment = |i: usize| {
        let force = |k: usize| {
            let [low, high] = [shapes[k].horizontal[i], shapes[k].horizontal[i + 1]];
            let along = (positions[k][i + 1] - positions[k][i]).try_normalize(0.0);
            (low - high) * along.unwrap_or_else(Vector3::zeros)
        };
        let forces = [0, 1].map(force);
        let lies = |&node: &usize| positions.iter().all(|at| at[node].z <= seabed);
        let laid = [i, i + 1].into_iter().filter(lies);
        let works = laid.map(|node| work(forces, [0, 1].map(|k| positions[k][node])));
        let (count, sum) = works.fold((0.0, 0.0), |(count, sum), work| (count + 1.0, sum + work));
        if count > 0.0 { sum / count } else { 0.0 }
    };
    (0..positions[0].len() - 1).map(on_segment).sum()
}

/// Work [J] of the seabed on a free point.
fn point_seabed_work(model: &Model, free: &FreePoint, points: [&PointState; 2]) -> f64 {
    let push = |at: &PointState| match model.seabed.as_deref() {
        None => {
            let spring = free.seabed_at_rest(at.position.z);
            spring.map_or(Vector3::zeros(), |(_, force)| force * Vector3::z())
        }
        Some(seabed) => {
            let point = resting_point(free, seabed, at, None);
            point.map_or(Vector3::zeros(), |point| point.push().force)
        }
    };
    work(points.map(push), points.map(|at| at.position))
}

/// Force [N] of a line on a prescribed point. It excludes the weight of the half node there, whose energy is excluded as
/// well, unless the line is a closed-form catenary.
fn force_of_line(
    line: &Line,
    shape: &LineState,
    end: End,
    point: &PointState,
    moments: [Vector3<f64>; 2],
) -> Vector3<f64> {
    if let Some(closed_form) = &shape.closed_form {
        return closed_form.end_force[usize::from(end == End::B)];
    }
    let (segment, sign) = match end {
        End::A => (0, 1.0),
        End::B => (line.segment_count() - 1, -1.0),
    };
    let chord = shape.position[segment + 1] - shape.position[segment];
    let still = Stretching::of(line, segment, chord, Vector3::zeros());
    let tension = segment_tension(line, segment, still, false);
    let mut force = sign * tension * chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
    if let Some(surface) = &line.surface {
        force.z -= surface.node(line.end_node(end), &shape.position).weight;
    }
    if line.bending.is_some() {
        force += shear(line, [&shape.position, &[]], segment, (end, point), moments);
    }
    force
}
