//! Size of a scene, and the limits of inputs that follow from it.
//!
//! Beyond some thousand times the size of a scene, the equations still have solutions, but rounding dominates them. Such inputs come from a wrong
//! unit or an unstable host, and are refused before anything is solved.

use nalgebra::Vector3;

use super::inputs::{BodyInput, Inputs};
use crate::dynamics::{StepError, StepFailure};
use crate::model::{Body, End, Model, Role};
use crate::scene::SceneError;

/// Greatest displacement over the size of the scene [-].
const REACH: f64 = 1000.0;
/// Greatest angle [rad]: a thousand turns.
const TURNS_MAX: f64 = 6283.0;
const AXES: [&str; 6] = ["x", "y", "z", "roll", "pitch", "yaw"];
const RATES: [&str; 6] = ["vx", "vy", "vz", "wx", "wy", "wz"];

/// Lengths of a scene with which inputs are compared.
#[derive(Debug, Clone)]
pub(super) struct Scale {
    /// Greatest length of a line or distance between two points [m].
    pub size: f64,
    /// Greatest distance of a line's end from the origin of each vessel [m].
    pub levers: Vec<f64>,
}

impl Scale {
    /// Scale of a model.
    pub(super) fn new(model: &Model) -> Scale {
        let lengths = model.lines.iter().map(|line| {
            let sections = line.sections.iter();
            sections.map(|section| section.length).sum::<f64>()
        });
        let places = || model.points.iter().map(|point| point.reference);
        let least = places().fold(Vector3::repeat(f64::INFINITY), |a, b| a.inf(&b));
        let most = places().fold(Vector3::repeat(f64::NEG_INFINITY), |a, b| a.sup(&b));
        let extent = if model.points.is_empty() {
            0.0
        } else {
            (most - least).norm()
        };
        let mut levers = vec![0.0_f64; model.vessels.len()];
        for point in &model.points {
            if let Role::Carried { vessel, arm } = &point.role {
                levers[*vessel] = levers[*vessel].max(arm.norm());
            }
        }
        Scale {
            size: lengths.fold(extent, f64::max),
            levers,
        }
    }

    /// Refuses inputs that exceed the limits of a step of `length` [s], before anything is solved. The error is the body and a message.
    fn check(&self, model: &Model, inputs: &Inputs, length: f64) -> Result<(), (Body, String)> {
        let reach = REACH * self.size;
        let check = |name: &str, body: Body| {
            let input = inputs.body(body);
            check_axes(name, input, body.axes(), length, reach).map_err(|problem| (body, problem))
        };
        for (index, point) in model.points.iter().enumerate() {
            if let Role::Coupled { .. } = point.role {
                check(&point.name, Body::Point(index))?;
            }
        }
        let mut vessels = model.vessels.iter().enumerate();
        vessels.try_for_each(|(index, vessel)| check(&vessel.name, Body::Vessel(index)))
    }

    /// Refuses the inputs of a start.
    pub(super) fn check_start(&self, model: &Model, inputs: &Inputs) -> Result<(), SceneError> {
        self.check(model, inputs, 0.0)
            .map_err(|(_, problem)| SceneError::new("", problem))
    }

    /// Refuses the inputs of a step of `length` [s] from a time [s].
    pub(super) fn check_step(
        &self,
        model: &Model,
        inputs: &Inputs,
        time: f64,
        length: f64,
    ) -> Result<(), StepError> {
        let refused = |(body, reason): (Body, String)| {
            let mut points = (0..model.points.len()).filter(|&point| model.moves_with(point, body));
            let ends = points.find_map(|point| model.points[point].attached.first().copied());
            let (line, end) = ends.unwrap_or((0, End::A));
            let line = &model.lines[line];
            StepError::new(time, line, line.end_node(end), StepFailure::Input(reason))
        };
        self.check(model, inputs, length).map_err(refused)
    }
}

/// Refuses displacements along some axes [m, rad] beyond `reach` [m], and velocities [m/s, rad/s] that lead beyond it in a step of `length` [s].
#[inline]
fn check_axes(name: &str, input: &BodyInput, axes: usize, length: f64, reach: f64) -> Result<(), String> {
    for axis in 0..axes {
        let (value, rate) = (input.displacement[axis], input.velocity[axis].unwrap_or(0.0));
        let limit = if axis < 3 { reach } else { TURNS_MAX };
        // NaN is not within any limit
        let (is_near, is_slow) = (value.abs() <= limit, (rate * length).abs() <= limit);
        if !(is_near && is_slow && rate.is_finite()) {
            return Err(beyond(name, axis, [value, rate, length], limit, is_near));
        }
    }
    Ok(())
}

#[cold]
fn beyond(name: &str, axis: usize, [value, rate, length]: [f64; 3], limit: f64, is_near: bool) -> String {
    let (unit, why) = match axis < 3 {
        true => ("m", format!("{REACH} times the size of the scene")),
        false => ("rad", "a thousand turns".to_string()),
    };
    match is_near {
        false => format!(
            "{name}.{} = {value:e} {unit} is beyond {limit:.4e} {unit}, {why}",
            AXES[axis]
        ),
        true => format!(
            "{name}.{} = {rate:e} {unit}/s leads beyond {limit:.4e} {unit}, {why}, in a step of {length} s",
            RATES[axis]
        ),
    }
}
