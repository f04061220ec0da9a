//! Start of a simulation: at rest, at the initial shapes of the scene or in its static equilibrium.

use std::sync::Arc;

use nalgebra::Matrix3;

use super::flow;
use super::input_error::InputRecord;
use super::inputs::Inputs;
use super::paths::Paths;
use super::prescribed::MotionSource;
use super::{Error, Snapshot};
use crate::dynamics::advance::{Counters, Integrators};
use crate::dynamics::energy_balance::{EnergyBalance, Flow};
use crate::dynamics::{beam, reaction};
use crate::elements;
use crate::model::{End, Line, LineState, Model, PointState, State, WinchState};
use crate::physics::ground::Ground;
use crate::scene::{InitialShape, Integrator};
use crate::statics::catenary::Catenary;
use crate::statics::guess::{self, Plane};
use crate::statics::{self, StaticsError, catenary_network, equilibrium};

/// A simulation at rest and its integrators.
pub(super) type Started = Result<(Snapshot, Integrators), Error>;

/// Treatment of lines with an initial shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shapes {
    /// Lines start in their initial shapes.
    AsGiven,
    /// Lines move from their initial shapes to equilibrium.
    Equilibrium,
}

/// Returns the snapshot of a simulation at rest at a time [s], and its integrators.
pub(super) fn begin(
    model: &Model,
    time: f64,
    inputs: Inputs,
    follows_scene: bool,
    shapes: Shapes,
) -> Result<(Snapshot, Integrators), Error> {
    let paths = Paths::at_rest(model, time, &inputs, follows_scene);
    let at = MotionSource::new(model, &paths, follows_scene);
    let held = |point: usize, t: f64| at.point(point, t);
    let places: Vec<PointState> = (0..model.points.len())
        .map(|point| PointState::held(&held(point, time)))
        .collect();
    let mut state = at_rest(model, time, &places, shapes)?;
    for ((line, shape), winch_state) in model.lines.iter().zip(&mut state.lines).zip(&paths.winch_paths) {
        let change = winch_state.path.at(time).value;
        shape.winch_state = line.winch.as_ref().map(|_| WinchState::at_rest(change));
    }
    if model.solver.integrator != Integrator::QuasiStatic {
        for (line, shape) in model.lines.iter().zip(&mut state.lines) {
            shape.become_viscoelastic(line);
        }
    }
    rest_beams(model, &mut state, time, shapes, |point| {
        beam::attitude(&held(point, time))
    })?;
    state.waves = flow::begin(model, &state, &inputs.flow);
    let mut work = Integrators::new(model, &state, |line| static_tension(model, &state, line));
    work.start(model, &mut state, &held);
    let counters = Counters::default();
    let balance = model.energy_balance.then(|| EnergyBalance {
        start: work.energy(model, &state).total(),
        now: 0.0,
        flow: Flow {
            dissipation: work.kinetic_energy_of_leapfrogs(model, &state),
            ..Flow::default()
        },
    });
    Ok((
        Snapshot {
            state,
            flow_before: inputs.flow.clone(),
            inputs,
            paths: Box::new(paths),
            follows_scene,
            counters,
            balance,
            start_time: time,
            input_record: InputRecord::default(),
            ahead: 0.0,
            last_step: 0.0,
            begun: None,
        },
        work,
    ))
}

/// Greatest number of times that an equilibrium is solved anew for contact adapted to it [-].
const ADAPTATIONS_MAX: usize = 8;

/// Solves the start of a model with `begin`, and again with the clamps of the lines that `clamps` selects and the contact with soundings adapted to the
/// equilibrium. If no equilibrium is found with adapted contact, the last one that was found is kept.
///
/// # Errors
/// No equilibrium is found.
pub(super) fn settle(
    model: &mut Arc<Model>,
    shapes: Shapes,
    clamps: impl Fn(usize, &Line) -> bool,
    begin: impl Fn(&Model) -> Started,
) -> Started {
    let mut found = begin(model)?;
    let bends = model.lines.iter().any(|line| line.bending.is_some());
    if bends && stiffen_clamps(Arc::make_mut(model), &found.0.state, clamps) {
        found = begin(model)?;
    }
    let ground = model.seabed.as_ref().map(|seabed| &seabed.ground);
    if !matches!(ground, Some(Ground::Grid(_))) {
        return Ok(found);
    }
    let rests = |line: &Line| shapes == Shapes::Equilibrium || line.initial == InitialShape::Static;
    for _ in 0..ADAPTATIONS_MAX {
        let before = model.clone();
        if !adapt_contact(Arc::make_mut(model), &found.0.state, rests) {
            break;
        }
        match begin(model) {
            Ok(adapted) => found = adapted,
            Err(_) => {
                *model = before;
                break;
            }
        }
    }
    Ok(found)
}

/// Adapts the clamp joints of the lines that `rests` selects to their tension in a state of rest; returns whether any joint is adapted.
fn stiffen_clamps(model: &mut Model, state: &State, rests: impl Fn(usize, &Line) -> bool) -> bool {
    let mut any = false;
    for (index, (line, shape)) in model.lines.iter_mut().zip(&state.lines).enumerate() {
        if line.bending.is_none() || !rests(index, line) {
            continue;
        }
        for (end, segment) in [(End::A, 0), (End::B, line.segment_count() - 1)] {
            let tension = reaction::tension(line, shape, segment, false).max(0.0);
            let length = line.segments.length[segment];
            let bending = line.bending.as_mut();
            any |= bending.is_some_and(|bending| bending.stiffen_clamp(end, tension, length));
        }
    }
    any
}

/// Adapts the regularised contact of the lines that `rests` selects to the loads in a state of rest; returns whether any changed.
fn adapt_contact(model: &mut Model, state: &State, rests: impl Fn(&Line) -> bool) -> bool {
    let Model { lines, points, .. } = model;
    let mut any = false;
    for (line, shape) in lines.iter_mut().zip(&state.lines) {
        if rests(line) {
            let tension = |i: usize| reaction::tension(line, shape, i, false);
            let tension: Vec<f64> = (0..line.segment_count()).map(tension).collect();
            any |= line.adapt_contact(points, &shape.position, &tension);
        }
    }
    any
}

/// Returns the state with every network in static equilibrium or, if all its lines have given shapes, in these shapes with its free points at their
/// positions in the scene. Quasi-static lines start on their catenaries; lines that will move start in the equilibrium of their elements.
fn at_rest(model: &Model, time: f64, places: &[PointState], shapes: Shapes) -> Result<State, StaticsError> {
    let mut work = elements::Workspace::serving(model, |_| false);
    let mut state = equilibrium::place(model, places, time)?;
    for number in 0..model.networks.len() {
        work.serve(model, number);
        equilibrium::hang(model, number, &mut state, &mut work);
        if shapes == Shapes::Equilibrium || model.starts_at_rest(number) {
            match model.solver.integrator {
                Integrator::QuasiStatic => catenary_network::rest(model, number, &mut state, &mut work)?,
                _ => equilibrium::rest(model, number, &mut state, &mut work)?,
            }
            if shapes == Shapes::AsGiven {
                take_shapes(model, number, &mut state);
            }
        }
        work.release(model, number);
    }
    Ok(state)
}

/// Restores the given shapes of the lines of a network, between the present positions of its points.
fn take_shapes(model: &Model, number: usize, state: &mut State) {
    for &index in &model.networks[number].lines {
        let line = &model.lines[index];
        let ends = line.ends.map(|point| state.points[point].position);
        let Some(mut nodes) = guess::start_shape(model, line, ends) else {
            continue;
        };
        // free points are at their equilibrium positions, not at those of the scene
        for end in [End::A, End::B] {
            let point = line.ends[usize::from(end == End::B)];
            if model.points[point].free().is_some() {
                nodes[line.end_node(end)] = state.points[point].position;
            }
        }
        state.lines[index] = LineState::at_rest(nodes);
    }
}

/// Sets the frames of beams at time `t` [s], and solves their equilibrium if no shape is given or all start at rest; `attitude` returns the rotation
/// of a point.
fn rest_beams(
    model: &Model,
    state: &mut State,
    t: f64,
    shapes: Shapes,
    attitude: impl Fn(usize) -> Matrix3<f64>,
) -> Result<(), StaticsError> {
    for (index, line) in model.lines.iter().enumerate() {
        if line.beam.is_some() {
            state.lines[index].become_beam(line, line.ends.map(&attitude));
            if line.initial == InitialShape::Static || shapes == Shapes::Equilibrium {
                statics::beam::rest(model, index, state, t)?;
            }
        }
    }
    Ok(())
}

fn static_tension(model: &Model, state: &State, line: usize) -> f64 {
    let (data, shape) = (&model.lines[line], &state.lines[line]);
    (0..data.segment_count())
        .map(|i| reaction::tension(data, shape, i, false))
        .fold(0.0, f64::max)
}

/// Closed-form catenary of a line in its reference configuration. `None` if an end is free, or if the line would rise out of the water, which the
/// closed form does not model.
pub(crate) fn reference_catenary(model: &Model, line: &Line) -> Option<Catenary> {
    let ends = line.ends.map(|point| &model.points[point]);
    if ends.iter().any(|point| point.free().is_some()) {
        return None;
    }
    let plane = Plane::new(ends.map(|point| point.reference));
    let solved = line
        .has_catenary(model)
        .then(|| guess::closed_form(model, line, &plane))??;
    (!guess::is_pierced(line, &solved, plane.a)).then_some(solved)
}
