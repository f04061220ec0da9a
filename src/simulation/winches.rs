//! Paid-out lengths of the winches: their paths between communication points, and the layout of lines at these lengths.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::dynamics::motion::{AxisPath, Extrapolation};
use crate::model::{Line, Model, State, Winch};
use crate::scene::{SceneError, TimeFunction};

/// Path of the length that a winch pays out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct WinchPath {
    /// Length change [m] in time.
    pub path: AxisPath,
    /// Time of the winch's last input [s], and its length change within the speed limit [m].
    given: [f64; 2],
}

impl WinchPath {
    /// Continues by a communication step to a host's length change [m] at a time [s]; a winch with a speed limit [m/s] lags behind faster inputs.
    pub(super) fn extend(
        &mut self,
        speed_max: Option<f64>,
        [time, wanted]: [f64; 2],
        extrapolation: &Extrapolation,
    ) {
        let [last, before] = self.given;
        let reach = speed_max.map_or(f64::INFINITY, |speed| speed * (time - last).max(0.0));
        let position = wanted.clamp(before - reach, before + reach);
        self.given = [time, position];
        self.path.extend(extrapolation, position, None);
    }

    /// Continues along the scene's own path from a time [s] by a communication step [s]: to its value at the end, with its mean rate over this step
    /// and the next.
    pub(super) fn follow(&mut self, path: &TimeFunction, time: f64, step: f64) {
        let end = time + step;
        let velocity = (path.at(end + step) - path.at(time)) / (2.0 * step);
        self.path.follow([time, end], [path.at(end), velocity]);
    }
}

/// Length change [m] of a winch at the start: that of the scene's motion at a time [s] if it is followed, else as given.
fn start(winch: &Winch, given: f64, follows: Option<f64>) -> f64 {
    match (follows, &winch.path) {
        (Some(time), Some(path)) => path.at(time),
        _ => given,
    }
}

/// Winch paths at rest from a time [s], by line; empty if there is no winch.
pub(super) fn paths(model: &Model, given: &[f64], time: f64, follows_scene: bool) -> Vec<WinchPath> {
    if model.lines.iter().all(|line| line.winch.is_none()) {
        return Vec::new();
    }
    let lines = model.lines.iter().zip(given);
    let path = |(line, given): (&Line, &f64)| {
        let winch = line.winch.as_ref();
        let change = winch.map_or(0.0, |winch| start(winch, *given, follows_scene.then_some(time)));
        WinchPath {
            path: AxisPath::at_rest(change),
            given: [time, change],
        }
    };
    lines.map(path).collect()
}

/// Lays out the lines on winches at their initial lengths.
///
/// # Errors
/// A winch cannot pay out its length.
pub(super) fn lay_out(model: &mut Arc<Model>, given: &[f64], follows: Option<f64>) -> Result<(), SceneError> {
    for (index, &given) in given.iter().enumerate() {
        let Some(winch) = &model.lines[index].winch else {
            continue;
        };
        let change = start(winch, given, follows);
        let checked = winch.check(change);
        checked.map_err(|problem| SceneError::new(format!("lines[{index}].winch"), problem))?;
        let count = winch.segments_at(change);
        Arc::make_mut(model).lines[index].pay_out(count, change);
    }
    Ok(())
}

/// Lays out the lines on winches at the lengths of a state.
pub(super) fn follow(model: &mut Arc<Model>, state: &State) {
    for (index, shape) in state.lines.iter().enumerate() {
        if let (Some(winch_state), Some(_)) = (shape.winch_state, &model.lines[index].winch) {
            let line = &mut Arc::make_mut(model).lines[index];
            line.pay_out(shape.position.len() - 1, winch_state.change);
        }
    }
}
