//! Steps that are repeated, or made in advance, along a path whose end is shifted.

use nalgebra::{Vector3, Vector6};
use serde::{Deserialize, Serialize};

use super::{EndMotion, NO_RATES, joined};
use crate::dynamics::motion::AxesPath;
use crate::math::attitude::{Attitude, Order, angle_rates};
use crate::math::lanes::Lanes;
use crate::model::{Body, Role};
use crate::simulation::flow::Course;
use crate::simulation::paths::{Paths, is_coupled};
use crate::simulation::prescribed::MotionSource;
use crate::simulation::{Simulation, Snapshot};

/// Displacement in a difference quotient, relative to the longest line [-].
const ASIDE: f64 = 1e-8;
/// Least displacement in a difference quotient, relative to the coordinates, which are rounded [-].
const ROUNDING: f64 = 5e-11;
/// Least lever arm of rotations, relative to the longest line [-].
const LEVER_MIN: f64 = 1e-3;

/// Start of the last step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(in crate::simulation) struct StepStart {
    pub snapshot: Snapshot,
    /// Length of the step [s].
    pub step: f64,
}

/// Values below and above a component of motion, and the distance between the two [m, rad, m/s, rad/s].
pub(super) struct Sides<T> {
    pub values: [T; 2],
    pub apart: f64,
}

/// A step from a start along given paths.
pub(super) struct Trial {
    simulation: Simulation,
    start: Snapshot,
    paths: Box<Paths>,
    /// Water flow over the step, if a host gives it.
    flow: Course,
    /// Length of the step [s].
    pub length: f64,
}

impl Trial {
    /// Returns a trial that repeats the last step; `None` before the first step.
    pub(super) fn of_last_step(simulation: &Simulation) -> Result<Option<Trial>, String> {
        if !simulation.model.derivatives {
            return Err("derivatives are off: set `derivatives` in [output] to true".into());
        }
        if simulation.snapshot.follows_scene {
            return Err(
                "there are no derivatives along the scene's own motion: the host must move the bodies".into(),
            );
        }
        let Some(begun) = &simulation.snapshot.begun else {
            return Ok(None);
        };
        Ok(Some(Trial {
            simulation: simulation.clone(),
            start: begun.snapshot.clone(),
            paths: simulation.snapshot.paths.clone(),
            flow: Course::Given,
            length: begun.step,
        }))
    }

    /// Returns a trial of the coming step, as long as the last one. All bodies continue from their present velocities with their mean accelerations
    /// over the last step. `None` if a vessel has no unique rates.
    pub(super) fn of_coming_step(simulation: &Simulation) -> Option<Trial> {
        let (model, snapshot) = (&*simulation.model, &simulation.snapshot);
        let length = match snapshot.last_step {
            0.0 => model.interval,
            step => step,
        };
        let (time, lanes) = (snapshot.state.time, |v: Vector3<f64>| {
            Lanes::new([v.x, v.y, v.z, v.z])
        });
        let mut paths = snapshot.paths.clone();
        let coupled = model.points.iter().zip(&snapshot.state.points);
        let coupled = coupled.filter(|(point, _)| is_coupled(point));
        let given = snapshot.last_step > 0.0 && !snapshot.follows_scene;
        let go_on = |path: &mut AxesPath, from: [Vector3<f64>; 2]| {
            let acceleration = match given {
                true => path.mean_acceleration(length),
                false => Lanes::splat(0.0),
            };
            path.glide([time, length], from.map(lanes), acceleration);
        };
        for (path, (_, at)) in paths.points.iter_mut().zip(coupled) {
            go_on(&mut path.0, [at.position, at.velocity]);
        }
        let at = MotionSource::new(model, &snapshot.paths, snapshot.follows_scene);
        for (vessel, path) in paths.vessels.iter_mut().enumerate() {
            let (data, frame) = (&model.vessels[vessel], at.frame(vessel, time));
            let pose = data.pose_for_host(&at.pose(vessel, time), &frame);
            let angles = Vector3::new(pose[3], pose[4], pose[5]);
            let rates = angle_rates(data.attitude + angles, frame.attitude.spin)?;
            let place = Vector3::new(pose[0], pose[1], pose[2]);
            let [shift, turn] = &mut path.0;
            go_on(shift, [place, frame.origin.velocity]);
            go_on(turn, [angles, rates]);
        }
        let mut start = snapshot.clone();
        (start.follows_scene, start.begun) = (false, None);
        Some(Trial {
            simulation: simulation.clone(),
            start,
            paths,
            flow: Course::Continued,
            length,
        })
    }

    /// Displacement and velocity that a body reaches at the end of the step, as inputs.
    pub(super) fn end_of(&self, body: Body) -> [Vector6<f64>; 2] {
        let model = &self.simulation.model;
        match body {
            Body::Point(point) => {
                let [position, velocity] = self.paths.points[place_of_path(&self.simulation, point)].0.end();
                let moved = position.xyz() - model.points[point].reference;
                [moved, velocity.xyz()].map(|three| joined(three, Vector3::zeros()))
            }
            Body::Vessel(vessel) => {
                let [shift, turn] = self.paths.vessels[vessel].0.each_ref().map(|path| path.end());
                let spin = spin(model.vessels[vessel].attitude + turn[0].xyz(), turn[1].xyz());
                [
                    joined(shift[0].xyz(), turn[0].xyz()),
                    joined(shift[1].xyz(), spin),
                ]
            }
        }
    }

    /// Runs the first part of the step, of a given length [s], with as many internal steps as the whole.
    pub(super) fn run(&mut self, length: f64) -> Result<&Simulation, String> {
        self.step_with(length, None)
    }

    fn step_with(&mut self, length: f64, change: Option<(EndMotion, f64)>) -> Result<&Simulation, String> {
        let simulation = &mut self.simulation;
        simulation.restore(self.start.clone());
        let mut paths = self.paths.clone();
        if let Some((motion, by)) = change {
            let span = [self.start.state.time, self.length];
            shift_end(&mut paths, simulation, motion, span, by)?;
        }
        simulation.paths = paths;
        simulation.take_paths(length);
        simulation.extend_flow(self.length, self.flow);
        simulation.work.cut_short(self.length - length);
        simulation.integrate(length).map_err(|e| e.to_string())?;
        Ok(simulation)
    }

    /// Reads values after two steps in which a component of the end motion is below and above that of the paths.
    pub(super) fn both_sides<T>(
        &mut self,
        motion: EndMotion,
        read: impl Fn(&Simulation) -> T,
    ) -> Result<Sides<T>, String> {
        let mut by = distance(&self.simulation, motion.body, motion.axis, ASIDE);
        if motion.is_velocity {
            by /= self.length;
        }
        let mut side = |by: f64| {
            let length = self.length;
            self.step_with(length, Some((motion, by))).map(&read)
        };
        Ok(Sides {
            values: [side(-by)?, side(by)?],
            apart: 2.0 * by,
        })
    }
}

/// Reads values in static equilibrium with a displacement below and above the input.
pub(super) fn both_sides_of_statics<T>(
    simulation: &Simulation,
    motion: EndMotion,
    read: impl Fn(&Simulation) -> T,
) -> Result<Sides<T>, String> {
    let by = distance(simulation, motion.body, motion.axis, ASIDE);
    let side = |by: f64| {
        let mut moved = simulation.clone();
        moved.inputs_mut().body_mut(motion.body).displacement[motion.axis] += by;
        moved.restart(simulation.time()).map_err(|e| e.to_string())?;
        Ok::<T, String>(read(&moved))
    };
    Ok(Sides {
        values: [side(-by)?, side(by)?],
        apart: 2.0 * by,
    })
}

/// Displacement of a body along an axis [m], or its rotation about one [rad], in a difference quotient: `part` of the longest line, but enough for
/// coordinates far from the origin.
pub(in crate::simulation) fn distance(simulation: &Simulation, body: Body, axis: usize, part: f64) -> f64 {
    let lines = simulation.model.lines.iter();
    let lengths = lines.filter_map(|line| line.nodes.arc.last().copied());
    let longest = lengths.fold(0.0, f64::max);
    let points = simulation.model.points.iter();
    let farthest = points.map(|point| point.reference.amax()).fold(0.0, f64::max);
    let way = (part * longest).max(ROUNDING * farthest);
    match body {
        Body::Vessel(vessel) if axis >= 3 => way / simulation.scale.levers[vessel].max(LEVER_MIN * longest),
        _ => way,
    }
}

/// Index of a coupled point among the paths.
fn place_of_path(simulation: &Simulation, point: usize) -> usize {
    let before = simulation.model.points[..point].iter();
    before.filter(|point| is_coupled(point)).count()
}

/// Shifts the end of a body's path by `by` [m, rad, m/s, rad/s]; `span` is the start and the length of the step [s].
fn shift_end(
    paths: &mut Paths,
    simulation: &Simulation,
    motion: EndMotion,
    span: [f64; 2],
    by: f64,
) -> Result<(), String> {
    let axis = Lanes::new(std::array::from_fn(|lane| {
        if lane == motion.axis % 3 { by } else { 0.0 }
    }));
    let zero = Lanes::splat(0.0);
    let along = match motion.is_velocity {
        true => [zero, axis],
        false => [axis, zero],
    };
    match motion.body {
        Body::Point(point) => {
            let coupled = matches!(simulation.model.points[point].role, Role::Coupled { .. });
            assert!(coupled, "a host moves coupled points only");
            paths.points[place_of_path(simulation, point)]
                .0
                .shift_end(span, along);
        }
        Body::Vessel(vessel) if motion.axis < 3 => paths.vessels[vessel].0[0].shift_end(span, along),
        Body::Vessel(vessel) => {
            // a change of an angle keeps the angular velocity, and a change of the angular velocity keeps the angles
            let path = &mut paths.vessels[vessel].0[1];
            let [angles, rates] = path.end().map(|lanes| lanes.xyz());
            let angles = simulation.model.vessels[vessel].attitude + angles;
            let [turned, spun] = along.map(|lanes| lanes.xyz());
            let to = angle_rates(angles + turned, spin(angles, rates) + spun).ok_or(NO_RATES)?;
            let change = to - rates;
            let change = Lanes::new([change.x, change.y, change.z, 0.0]);
            path.shift_end(span, [along[0], change]);
        }
    }
    Ok(())
}

/// Angular velocity [rad/s] of roll, pitch and yaw [rad] at their rates [rad/s].
fn spin(angles: Vector3<f64>, rates: Vector3<f64>) -> Vector3<f64> {
    Attitude::new(Order::Zyx, angles, rates, Vector3::zeros()).spin
}
