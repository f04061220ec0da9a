//! Inputs of a host to a simulation: positions of points and vessels, releases of lines, length changes of winches, water flow.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::{Simulation, WaterFlow};
use crate::math::attitude::angle_rates;
use crate::model::{Body, Model};

/// Inputs of a host.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// Number of points [-].
    points: usize,
    /// Inputs of all points, then of all vessels.
    bodies: Vec<BodyInput>,
    /// Release command of each line: detaches the line permanently from the point named in the scene.
    pub releases: Vec<bool>,
    /// Target length change of the winch of each line, relative to the scene [m]; negative for length hauled in.
    pub length_changes: Vec<f64>,
    /// Water flow: at the end of the coming step if the scene has `input_reconstruction = "interpolate"`, else at the present time.
    pub flow: WaterFlow,
}

impl Inputs {
    /// Inputs before the host sets any.
    pub fn new(model: &Model) -> Inputs {
        Inputs {
            points: model.points.len(),
            bodies: vec![BodyInput::default(); model.bodies().count()],
            releases: vec![false; model.lines.len()],
            length_changes: vec![0.0; model.lines.len()],
            flow: WaterFlow::still(model),
        }
    }

    /// Index of a body in lists of all points, then all vessels.
    #[inline]
    pub fn place(&self, body: Body) -> usize {
        match body {
            Body::Point(point) => point,
            Body::Vessel(vessel) => self.points + vessel,
        }
    }

    /// Inputs of all points, then of all vessels.
    pub fn bodies(&self) -> &[BodyInput] {
        &self.bodies
    }

    /// Input for a body.
    #[inline]
    pub fn body(&self, body: Body) -> &BodyInput {
        &self.bodies[self.place(body)]
    }

    /// Input for a body, to be set.
    #[inline]
    pub fn body_mut(&mut self, body: Body) -> &mut BodyInput {
        let place = self.place(body);
        &mut self.bodies[place]
    }

    /// Inputs of the points.
    #[inline]
    pub(super) fn of_points(&self) -> &[BodyInput] {
        &self.bodies[..self.points]
    }

    /// Inputs of the vessels.
    #[inline]
    pub(super) fn of_vessels(&self) -> &[BodyInput] {
        &self.bodies[self.points..]
    }
}

/// Input of a host for a vessel, or for a point, which uses the first three axes only.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyInput {
    /// Displacement from the reference position [m]; roll, pitch and yaw, added to those of the reference attitude [rad].
    pub displacement: [f64; 6],
    /// Velocity of the origin [m/s] and angular velocity [rad/s], both in global axes. Absent components are derived from the displacements; the
    /// angular velocity is used only if all three components are given.
    pub velocity: [Option<f64>; 6],
}

impl BodyInput {
    /// Displacement of a point and its velocity.
    #[inline(always)]
    pub(super) fn of_point(&self) -> (Vector3<f64>, [Option<f64>; 3]) {
        let ([x, y, z, ..], [vx, vy, vz, ..]) = (self.displacement, self.velocity);
        (Vector3::new(x, y, z), [vx, vy, vz])
    }

    /// Rates of the displacement and the angles of a vessel [m/s, rad/s]. Rates of the angles need all three components of the angular velocity.
    pub(super) fn rates(&self, attitude: Vector3<f64>) -> [Option<f64>; 6] {
        let [vx, vy, vz, w @ ..] = self.velocity;
        let [_, _, _, roll, pitch, yaw] = self.displacement;
        let is_given = w.iter().any(Option::is_some);
        let spin = Vector3::from(w.map(|component| component.unwrap_or(0.0)));
        let turning = is_given.then(|| angle_rates(attitude + Vector3::new(roll, pitch, yaw), spin));
        let turning = turning.flatten();
        let angle = |axis: usize| turning.map(|rates| rates[axis]);
        [vx, vy, vz, angle(0), angle(1), angle(2)]
    }
}

impl Simulation {
    /// Inputs as set.
    pub fn inputs(&self) -> &Inputs {
        &self.snapshot.inputs
    }

    /// Inputs, to be set.
    pub fn inputs_mut(&mut self) -> &mut Inputs {
        self.reactions.forget_interface();
        &mut self.snapshot.inputs
    }

    /// Sets all inputs.
    ///
    /// # Panics
    /// If the inputs are those of another model.
    pub fn set_inputs(&mut self, inputs: &Inputs) {
        let own = self.inputs_mut();
        own.bodies.copy_from_slice(&inputs.bodies);
        own.releases.copy_from_slice(&inputs.releases);
        own.length_changes.copy_from_slice(&inputs.length_changes);
        own.flow.clone_from(&inputs.flow);
    }

    /// Sets the present displacement of a coupled point from its reference position [m].
    pub fn set_displacement(&mut self, point: usize, displacement: [f64; 3]) {
        self.snapshot.inputs.bodies[point].displacement[..3].copy_from_slice(&displacement);
    }

    /// Sets the present velocity of a coupled point [m/s]; on axes without one, the velocity is derived from the displacements.
    pub fn set_velocity(&mut self, point: usize, velocity: [Option<f64>; 3]) {
        self.snapshot.inputs.bodies[point].velocity[..3].copy_from_slice(&velocity);
    }

    /// Sets the present pose of a vessel: displacement from its reference position [m]; roll, pitch and yaw added to those of its reference attitude [rad].
    pub fn set_pose(&mut self, vessel: usize, pose: [f64; 6]) {
        self.snapshot.inputs.body_mut(Body::Vessel(vessel)).displacement = pose;
    }

    /// Sets the present pose and velocity of a body on its axes: three for a point, six for a vessel.
    pub fn set_body(&mut self, body: Body, displacement: [f64; 6], velocity: [Option<f64>; 6]) {
        *self.snapshot.inputs.body_mut(body) = BodyInput {
            displacement,
            velocity,
        };
    }

    /// Sets the release command of a line, which detaches it from the point named in the scene. The release becomes permanent in the next step.
    pub fn set_release(&mut self, line: usize, release: bool) {
        self.inputs_mut().releases[line] = release;
    }

    /// Returns whether ends A and B of a line are released from their points.
    pub fn released(&self, line: usize) -> [bool; 2] {
        self.snapshot.state.lines[line].released
    }

    /// Sets the present target length change of the winch of a line, relative to the scene [m]; negative for length hauled in.
    pub fn set_length_change(&mut self, line: usize, change: f64) {
        self.snapshot.inputs.length_changes[line] = change;
    }
}
