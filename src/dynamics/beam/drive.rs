//! A beam of a model over a time span: the motion of its ends, and the loads and bodies of its points on them.

use nalgebra::{Matrix3, Vector3};

use super::{BeamStep, BeamWork, Body, Stuck, beam_state};
use crate::dynamics::energy_balance::Flow;
use crate::elements::beam::{BeamEnd, end_hold};
use crate::model::{Beam, Kinematics, Line, Model, State};
use crate::physics::section::{Section, join};

/// Number of factorised tangents, and energy flow across the boundary of the beam.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Driven {
    /// Number of factorised tangents.
    pub solves: usize,
    /// External work and dissipation [J].
    pub flow: Flow,
}

/// Advances the beam `index` of `state` from `start` to `end` [s] in `count` equal steps; `held` returns the kinematics of
/// prescribed points. The caller sets `state.time` and the prescribed points.
///
/// # Errors
/// A step did not converge; the state is then that before the failed step.
pub fn drive<K: Fn(usize, f64) -> Kinematics>(
    model: &Model,
    index: usize,
    state: &mut State,
    held: &K,
    [start, end]: [f64; 2],
    count: usize,
    work: &mut BeamWork,
) -> Result<Driven, Stuck> {
    let line = &model.lines[index];
    let (Some(beam), Some(_)) = (&line.beam, &state.lines[index].beam) else {
        return Ok(Driven::default());
    };
    let step = (end - start) / count as f64;
    let mut driven = Driven::default();
    for k in 0..count {
        let times = [k, k + 1].map(|k| start + k as f64 * step);
        let ends = [0, 1].map(|e| end_of_step(model, beam, index, state, held, e, times));
        let case = BeamStep {
            beam,
            nodes: &line.nodes,
            ends: ends.map(|end| end.hold),
            targets: ends.map(|end| end.target),
            bodies: ends.map(|end| end.body),
            length: step,
            energy_balance: model.energy_balance,
        };
        let (solves, flow) = work.step(&case, &mut state.lines[index])?;
        driven.solves += solves;
        driven.flow.add(flow);
        carry_free_points(model, index, state);
    }
    Ok(driven)
}

#[derive(Clone, Copy)]
struct EndOfStep<'a> {
    hold: BeamEnd,
    target: Section,
    body: Option<Body<'a>>,
}

fn end_of_step<'a, K: Fn(usize, f64) -> Kinematics>(
    model: &'a Model,
    beam: &Beam,
    index: usize,
    state: &State,
    held: &K,
    end: usize,
    [from, to]: [f64; 2],
) -> EndOfStep<'a> {
    let number = model.lines[index].ends[end];
    let point = &model.points[number];
    let load = join(point.load_mean(from, to), point.moment_mean(from, to));
    let hold = BeamEnd {
        load,
        ..end_hold(point, beam.clamped[end].is_some())
    };
    let shape = beam_state(&state.lines[index]);
    let frame = |attitude: Matrix3<f64>| attitude * shape.carried[end];
    match point.free() {
        Some(free) => {
            let position = state.points[number].position;
            let stream = model.stream(0.5 * (from + to));
            let water = stream.map_or(Vector3::zeros(), |stream| stream.velocity(position.z));
            EndOfStep {
                hold,
                target: Section {
                    position,
                    frame: frame(Matrix3::identity()),
                },
                body: Some(Body { point: free, water }),
            }
        }
        None => {
            let k = held(number, to);
            EndOfStep {
                hold,
                target: Section {
                    position: k.position,
                    frame: frame(attitude(&k)),
                },
                body: None,
            }
        }
    }
}

/// Returns which unknowns of a beam's ends A and B are prescribed.
pub fn held(model: &Model, line: &Line) -> [[bool; 6]; 2] {
    [0, 1].map(|end| {
        let clamped = line.beam.as_ref().is_some_and(|beam| beam.clamped[end].is_some());
        end_hold(&model.points[line.ends[end]], clamped).held
    })
}

/// Rotation of a prescribed point from its reference attitude [-].
pub fn attitude(k: &Kinematics) -> Matrix3<f64> {
    k.orientation.to_rotation_matrix().into_inner()
}

/// Sets the free points at the ends of a beam to the state of its end nodes.
fn carry_free_points(model: &Model, index: usize, state: &mut State) {
    let line = &model.lines[index];
    let shape = &state.lines[index];
    for (point, node) in line.ends.into_iter().zip([0, line.segment_count()]) {
        if model.points[point].free().is_some() {
            let at = &mut state.points[point];
            at.position = shape.position[node];
            at.velocity = shape.velocity[node];
            at.acceleration = shape.acceleration[node];
            at.half_step = [Vector3::zeros(); 2];
        }
    }
}
