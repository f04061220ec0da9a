//! Paths of points, vessels and winches between communication points.

use pulp::NullaryFnOnce;
use serde::{Deserialize, Serialize};

use super::inputs::{BodyInput, Inputs};
use super::prescribed::HostEnds;
use super::winches::{self, WinchPath};
use super::{Simulation, Snapshot};
use crate::dynamics::motion::{
    AxesPath, Clock, EASE, EASE_OF_ANGLES, Extrapolation, Fading, HostPath, InputSample, VesselPath,
};
use crate::dynamics::{StepError, StepFailure};
use crate::math::unit::VectorUnit;
use crate::model::{Model, Point, Role};
use crate::scene::Reconstruction;

/// Paths of everything that a host moves, sampled at the same times.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Paths {
    clock: Clock,
    /// Paths of the coupled points, in the order of the model.
    pub points: Vec<HostPath>,
    /// Paths of the vessels, in the order of the model.
    pub vessels: Vec<VesselPath>,
    /// Paths of the lengths that the winches pay out, by line; empty if there are no winches.
    pub winch_paths: Vec<WinchPath>,
    /// Filters of the coupled points, then of displacement and angles of the vessels; empty unless [`Reconstruction::Filtered`] is set.
    filters: Vec<Fading>,
}

impl Clone for Paths {
    fn clone(&self) -> Self {
        Paths {
            clock: self.clock,
            points: self.points.clone(),
            vessels: self.vessels.clone(),
            winch_paths: self.winch_paths.clone(),
            filters: self.filters.clone(),
        }
    }

    fn clone_from(&mut self, source: &Self) {
        self.clock = source.clock;
        self.points.clone_from(&source.points);
        self.vessels.clone_from(&source.vessels);
        self.winch_paths.clone_from(&source.winch_paths);
        self.filters.clone_from(&source.filters);
    }
}

/// Returns whether a host moves a point.
pub(super) fn is_coupled(point: &Point) -> bool {
    matches!(point.role, Role::Coupled { .. })
}

impl Paths {
    /// Paths at rest from a time [s] at the positions of the inputs.
    pub(super) fn at_rest(model: &Model, time: f64, inputs: &Inputs, follows_scene: bool) -> Paths {
        let points = model.points.iter().zip(inputs.of_points());
        let coupled = points.filter(|(point, _)| is_coupled(point));
        let place =
            |(point, input): (&Point, &BodyInput)| HostPath::at_rest(point.reference + input.of_point().0);
        let vessels = inputs.of_vessels().iter();
        let mut paths = Paths {
            clock: Clock::new(time),
            points: coupled.map(place).collect(),
            vessels: vessels
                .map(|input| VesselPath::at_rest(input.displacement))
                .collect(),
            winch_paths: winches::paths(model, &inputs.length_changes, time, follows_scene),
            filters: Vec::new(),
        };
        if model.solver.input_reconstruction == Reconstruction::Filtered {
            let at_rest = |path: &AxesPath| Fading::at_rest(time, path.end()[0]);
            paths.filters = paths.axes().map(at_rest).collect();
        }
        paths
    }

    /// Paths of the coupled points, then of displacement and angles of the vessels.
    fn axes(&self) -> impl Iterator<Item = &AxesPath> {
        let vessels = self.vessels.iter().flat_map(|path| &path.0);
        self.points.iter().map(|path| &path.0).chain(vessels)
    }

    /// Paths as in [`Paths::axes`], to be written.
    fn axes_mut(&mut self) -> impl Iterator<Item = &mut AxesPath> {
        let vessels = self.vessels.iter_mut().flat_map(|path| &mut path.0);
        self.points.iter_mut().map(|path| &mut path.0).chain(vessels)
    }

    /// Returns whether the host gives any motion without velocities.
    pub(super) fn lack_velocities(&self) -> bool {
        self.axes().any(|path| path.unrated().is_some())
    }

    /// Leads the paths of motions given without velocities from the paths `before` to the predictions of their filters, over a step from a time [s] of a
    /// length [s].
    fn filter(&mut self, before: &Paths, extrapolation: &Extrapolation, [time, length]: [f64; 2]) {
        let mut filters = std::mem::take(&mut self.filters);
        filters.clone_from(&before.filters);
        let of_points = before.points.iter().map(|_| EASE);
        let eases = of_points.chain(before.vessels.iter().flat_map(|_| [EASE, EASE_OF_ANGLES]));
        let paths = self.axes_mut().zip(before.axes()).zip(&mut filters);
        for (((path, before), filter), ease) in paths.zip(eases) {
            if let Some(sample) = path.unrated() {
                let motion = filter.predict(time, sample, length);
                path.lead(before, extrapolation, motion, ease);
            }
        }
        self.filters = filters;
    }

    /// Intervals between the latest three samples, newest first [s], if all are known and in order.
    pub(super) fn gaps(&self) -> Option<[f64; 2]> {
        self.clock.gaps()
    }

    /// Continues the paths of the winches by a step [s].
    fn extend_winch_paths(
        &mut self,
        model: &Model,
        snapshot: &Snapshot,
        extrapolation: &Extrapolation,
        step: f64,
    ) -> Result<(), StepError> {
        let (time, changes) = (snapshot.state.time, &snapshot.inputs.length_changes);
        let sample_time = match model.solver.input_reconstruction {
            Reconstruction::Interpolate => time + step,
            _ => time,
        };
        for (index, winch_state) in self.winch_paths.iter_mut().enumerate() {
            let line = &model.lines[index];
            let Some(winch) = &line.winch else { continue };
            match (snapshot.follows_scene, &winch.path) {
                (true, Some(path)) => winch_state.follow(path, time, step),
                _ => {
                    let wrong =
                        |reason| StepError::new(time, line, line.segment_count(), StepFailure::Winch(reason));
                    winch.check(changes[index]).map_err(wrong)?;
                    winch_state.extend(winch.speed_max, [sample_time, changes[index]], extrapolation);
                }
            }
        }
        Ok(())
    }
}

/// Extends the paths `before` by a host's samples of the coupled points and the vessels, compiled for the vector unit of the machine.
struct Extend<'a> {
    paths: &'a mut Paths,
    before: &'a Paths,
    model: &'a Model,
    inputs: &'a Inputs,
    extrapolation: &'a Extrapolation,
    /// Motion of the points at both ends of the step, to be filled in.
    ends: &'a mut [HostEnds],
}

impl NullaryFnOnce for Extend<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        // loops, not closures, which would not be compiled for the vector unit
        let paths = self.paths.points.iter_mut().zip(&self.before.points);
        let mut paths = paths.zip(self.ends);
        for (point, input) in self.model.points.iter().zip(self.inputs.of_points()) {
            if !is_coupled(point) {
                continue;
            }
            let Some(((path, before), ends)) = paths.next() else {
                break;
            };
            let (displacement, velocity) = input.of_point();
            let sample = InputSample::new((point.reference + displacement).into(), velocity);
            *ends = path.0.extend(&before.0, self.extrapolation, &sample);
        }
        let paths = self.paths.vessels.iter_mut().zip(&self.before.vessels);
        let vessels = self.model.vessels.iter().zip(self.inputs.of_vessels());
        for ((path, before), (vessel, input)) in paths.zip(vessels) {
            let rates = input.rates(vessel.attitude);
            path.extend(before, self.extrapolation, input.displacement, rates);
        }
    }
}

impl Simulation {
    /// Lays out the paths of the next communication step [s]; the paths in the snapshot do not change.
    pub(super) fn extend_paths(&mut self, step: f64) -> Result<(), StepError> {
        let (model, snapshot, paths) = (&*self.model, &self.snapshot, &mut self.paths);
        let before = &snapshot.paths;
        if snapshot.follows_scene && before.winch_paths.is_empty() {
            return Ok(());
        }
        let (time, extrapolation) = (snapshot.state.time, &mut self.extrapolation);
        paths.clock = before.clock;
        let reconstruction = model.solver.input_reconstruction;
        paths.clock.add_sample(time, step, reconstruction, extrapolation);
        if !snapshot.follows_scene {
            let inputs = &snapshot.inputs;
            VectorUnit::best().dispatch(Extend {
                paths,
                before,
                model,
                inputs,
                extrapolation,
                ends: self.prescribed.hosted(),
            });
            if model.solver.input_reconstruction == Reconstruction::Filtered {
                paths.filter(before, extrapolation, [time, step]);
                for (ends, path) in self.prescribed.hosted().iter_mut().zip(&paths.points) {
                    *ends = path.0.ends();
                }
            }
        }
        if !before.winch_paths.is_empty() {
            paths.winch_paths.clone_from(&before.winch_paths);
            paths.extend_winch_paths(model, snapshot, extrapolation, step)?;
            let winch_paths = paths.winch_paths.iter().map(|winch_state| winch_state.path);
            self.work.set_winch_paths(winch_paths);
        }
        Ok(())
    }

    /// Applies the laid-out paths up to a length [s] of the step.
    pub(super) fn take_paths(&mut self, length: f64) {
        let end = self.snapshot.state.time + length;
        for (ends, path) in self.prescribed.hosted().iter_mut().zip(&self.paths.points) {
            let [start, _] = path.0.ends();
            *ends = [start, path.0.at(end)];
        }
        if !self.paths.winch_paths.is_empty() {
            let winch_paths = self.paths.winch_paths.iter().map(|winch_state| winch_state.path);
            self.work.set_winch_paths(winch_paths);
        }
    }
}
