//! The paths that points, vessels and winches follow between communication points.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::inputs::Inputs;
use super::winches::{self, ReelPath};
use super::{Simulation, Snapshot};
use crate::dynamics::StepError;
use crate::dynamics::motion::{Clock, Foresight, HostPath, VesselPath};
use crate::model::{Line, Model, Point, Role};

/// The paths of everything that a host moves, told at the same times.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Paths {
    clock: Clock,
    /// Of the coupled points, in the order of the model.
    pub points: Vec<HostPath>,
    /// Of the vessels, in the order of the model.
    pub vessels: Vec<VesselPath>,
    /// Lengths that the winches pay out, by line; empty where there are none.
    pub reels: Vec<ReelPath>,
}

impl Clone for Paths {
    fn clone(&self) -> Self {
        Paths {
            clock: self.clock,
            points: self.points.clone(),
            vessels: self.vessels.clone(),
            reels: self.reels.clone(),
        }
    }

    fn clone_from(&mut self, source: &Self) {
        self.clock = source.clock;
        self.points.clone_from(&source.points);
        self.vessels.clone_from(&source.vessels);
        self.reels.clone_from(&source.reels);
    }
}

/// Whether a host moves a point.
pub(super) fn is_coupled(point: &Point) -> bool {
    matches!(point.role, Role::Coupled { .. })
}

impl Paths {
    /// At rest at a time [s] where the inputs say.
    pub fn at_rest(model: &Model, time: f64, inputs: &Inputs, follows_scene: bool) -> Paths {
        let points = model.points.iter().zip(&inputs.points);
        let coupled = points.filter(|(point, _)| is_coupled(point));
        let place = |(point, input): (&Point, &super::inputs::PointInput)| {
            HostPath::at_rest(point.reference + Vector3::from(input.displacement))
        };
        let vessels = inputs.vessels.iter();
        Paths {
            clock: Clock::new(time),
            points: coupled.map(place).collect(),
            vessels: vessels
                .map(|input| VesselPath::at_rest(input.pose))
                .collect(),
            reels: winches::paths(model, &inputs.length_changes, time, follows_scene),
        }
    }

    /// Continues the paths of the coupled points and the vessels.
    fn extend(&mut self, model: &Model, inputs: &Inputs, foresight: &Foresight) {
        let points = model.points.iter().zip(&inputs.points);
        let coupled = points.filter(|(point, _)| is_coupled(point));
        for (path, (point, input)) in self.points.iter_mut().zip(coupled) {
            for (axis, path) in path.0.iter_mut().enumerate() {
                let position = point.reference[axis] + input.displacement[axis];
                path.extend(foresight, position, input.velocity[axis]);
            }
        }
        let vessels = model.vessels.iter().zip(&inputs.vessels);
        for (path, (vessel, input)) in self.vessels.iter_mut().zip(vessels) {
            let rates = input.rates(vessel.attitude);
            for (axis, path) in path.0.iter_mut().enumerate() {
                path.extend(foresight, input.pose[axis], rates[axis]);
            }
        }
    }

    /// Continues the paths of the winches by a step [s].
    fn extend_reels(
        &mut self,
        model: &Model,
        snapshot: &Snapshot,
        foresight: &Foresight,
        step: f64,
    ) -> Result<(), StepError> {
        let (time, changes) = (snapshot.state.time, &snapshot.inputs.length_changes);
        for (index, reel) in self.reels.iter_mut().enumerate() {
            let line = &model.lines[index];
            let Some(winch) = &line.winch else { continue };
            match (snapshot.follows_scene, &winch.path) {
                (true, Some(path)) => reel.follow(path, time, step),
                _ => {
                    winches::check(line, changes[index])
                        .map_err(|reason| out_of_bounds(line, time, reason))?;
                    reel.extend(winch.speed_max, [time, changes[index]], foresight);
                }
            }
        }
        Ok(())
    }
}

fn out_of_bounds(line: &Line, time: f64, reason: String) -> StepError {
    StepError {
        time,
        line: line.name.clone(),
        node: line.segment_count(),
        reason,
        advice: "keep its length_change within the bounds",
    }
}

impl Simulation {
    /// Lays out the paths of the next communication step [s]; those of the snapshot stay as they are.
    pub(super) fn extend_paths(&mut self, step: f64) -> Result<(), StepError> {
        let (model, snapshot, paths) = (&*self.model, &self.snapshot, &mut self.paths);
        paths.clone_from(&snapshot.paths);
        if snapshot.follows_scene && paths.reels.is_empty() {
            return Ok(());
        }
        let reconstruction = model.solver.input_reconstruction;
        let foresight = &mut self.foresight;
        paths
            .clock
            .tell(snapshot.state.time, step, reconstruction, foresight);
        if !snapshot.follows_scene {
            paths.extend(model, &snapshot.inputs, foresight);
        }
        if !paths.reels.is_empty() {
            paths.extend_reels(model, snapshot, foresight, step)?;
            let reels = paths.reels.iter().map(|reel| reel.path);
            self.work.set_reels(reels);
        }
        Ok(())
    }
}
