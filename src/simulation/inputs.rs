//! Inputs of a host to a simulation: positions of points and vessels, releases of lines, length changes of winches.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::{Simulation, WaterFlow};
use crate::dynamics::motion::rates;
use crate::math::attitude::angle_rates;
use crate::model::{Body, Model};

/// Inputs of a host for points and vessels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Inputs {
    pub points: Vec<PointInput>,
    pub vessels: Vec<VesselInput>,
    /// Release command of each line.
    pub releases: Vec<bool>,
    /// Length changes of the winches, by line [m].
    pub length_changes: Vec<f64>,
    pub flow: WaterFlow,
}

impl Inputs {
    /// Inputs before any of them is set.
    pub(super) fn new(model: &Model) -> Inputs {
        Inputs {
            points: vec![PointInput::default(); model.points.len()],
            vessels: vec![VesselInput::default(); model.vessels.len()],
            releases: vec![false; model.lines.len()],
            length_changes: vec![0.0; model.lines.len()],
            flow: WaterFlow::still(model),
        }
    }
}

/// Inputs of a host for a point.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct PointInput {
    /// Displacement from the reference position [m].
    pub displacement: [f64; 3],
    /// Velocity [m/s], and the axes along which it is given rather than derived from the displacements, as returned
    /// by [`rates`].
    pub rates: [[f64; 3]; 2],
}

/// Inputs of a host for a vessel.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct VesselInput {
    /// Displacement from the reference position [m]; roll, pitch and yaw from the reference attitude [rad].
    pub pose: [f64; 6],
    /// Velocity [m/s] and angular velocity in global axes [rad/s]; derived from the poses where absent.
    pub velocity: [Option<f64>; 6],
}

impl VesselInput {
    /// Rates of the pose [m/s, rad/s]. Those of the angles need the whole angular velocity.
    pub(super) fn rates(&self, attitude: Vector3<f64>) -> [Option<f64>; 6] {
        let [vx, vy, vz, wx, wy, wz] = self.velocity;
        let [_, _, _, roll, pitch, yaw] = self.pose;
        let turning = match (wx, wy, wz) {
            (Some(x), Some(y), Some(z)) => {
                angle_rates(attitude + Vector3::new(roll, pitch, yaw), Vector3::new(x, y, z))
            }
            _ => None,
        };
        let angle = |axis: usize| turning.map(|rates| rates[axis]);
        [vx, vy, vz, angle(0), angle(1), angle(2)]
    }
}

impl Simulation {
    /// Sets the present displacement of a coupled point from its reference position [m].
    pub fn set_displacement(&mut self, point: usize, displacement: [f64; 3]) {
        self.snapshot.inputs.points[point].displacement = displacement;
    }

    /// Displacement of a coupled point as set [m].
    pub fn displacement(&self, point: usize) -> [f64; 3] {
        self.snapshot.inputs.points[point].displacement
    }

    /// Sets the present velocity of a coupled point [m/s]; axes without a velocity are derived from the
    /// displacements.
    pub fn set_velocity(&mut self, point: usize, velocity: [Option<f64>; 3]) {
        self.snapshot.inputs.points[point].rates = rates(velocity);
    }

    /// Velocity of a coupled point as set [m/s].
    pub fn velocity(&self, point: usize) -> [Option<f64>; 3] {
        let [velocity, given] = self.snapshot.inputs.points[point].rates;
        std::array::from_fn(|axis| (given[axis] > 0.0).then_some(velocity[axis]))
    }

    /// Sets the present pose of a vessel: displacement from its reference position [m]; roll, pitch and yaw added to those of its reference attitude [rad].
    pub fn set_pose(&mut self, vessel: usize, pose: [f64; 6]) {
        self.snapshot.inputs.vessels[vessel].pose = pose;
    }

    /// Pose of a vessel as set [m, rad].
    pub fn pose(&self, vessel: usize) -> [f64; 6] {
        self.snapshot.inputs.vessels[vessel].pose
    }

    /// Sets the present pose and velocity of a body, along its first three axes or all six.
    pub fn set_body(&mut self, body: Body, pose: [f64; 6], velocity: [Option<f64>; 6]) {
        match body {
            Body::Point(point) => {
                let ([x, y, z, ..], [vx, vy, vz, ..]) = (pose, velocity);
                self.set_displacement(point, [x, y, z]);
                self.set_velocity(point, [vx, vy, vz]);
            }
            Body::Vessel(vessel) => {
                self.set_pose(vessel, pose);
                self.set_vessel_velocity(vessel, velocity);
            }
        }
    }

    /// Sets the present motion of a vessel: velocity of its origin [m/s] and angular velocity [rad/s], both in global
    /// axes. Absent components are derived from the poses; the rotation needs all three components.
    pub fn set_vessel_velocity(&mut self, vessel: usize, velocity: [Option<f64>; 6]) {
        self.snapshot.inputs.vessels[vessel].velocity = velocity;
    }

    /// Sets the release command of a line, which detaches it from the point that its scene names; it is permanent
    /// from the next step on.
    pub fn set_release(&mut self, line: usize, release: bool) {
        self.snapshot.inputs.releases[line] = release;
    }

    /// Returns the release command of a line.
    pub fn release(&self, line: usize) -> bool {
        self.snapshot.inputs.releases[line]
    }

    /// Returns whether ends A and B of a line are released from their points.
    pub fn released(&self, line: usize) -> [bool; 2] {
        self.snapshot.state.lines[line].released
    }

    /// Sets the present target length paid out by the winch of a line beyond that of the scene [m], negative for length hauled in.
    pub fn set_length_change(&mut self, line: usize, change: f64) {
        self.snapshot.inputs.length_changes[line] = change;
    }

    /// Target length paid out by the winch of a line, as set [m].
    pub fn length_change(&self, line: usize) -> f64 {
        self.snapshot.inputs.length_changes[line]
    }
}
