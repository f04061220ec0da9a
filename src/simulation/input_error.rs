//! Error of the extrapolation of a host's motion, and the resulting error of tension.
//!
//! Displacements that a host gives at the start of every communication step h are extrapolated over it. The next
//! sample differs from the path's end by m, and the path has to be bent back at a velocity of m/h. With the velocity
//! v of the given motion the relative error is
//!
//! e = √(⟨m²/h²⟩/⟨v²⟩)
//!
//! of the motion, and 2.5 e is taken as the error of tension, RMS over standard deviation. On `lindahl_fast`, `oc3_catenary` and
//! `taut_polyester` it is 1 to 10 times that error with 12 to 25 steps a period, displacements only, and with 12 with velocities
//! (`tests/systems/host_edge.rs`): their tension follows the velocity of the path, whose error is less than m/h. The tension of light cables and
//! risers follows the acceleration of their hang-off: on `power_cable` 2.5 e is a quarter of the error. The error falls with h³ or faster, as m/h does.
//!
//! Mean values decay with the time of ten periods, of the frequency √(⟨a²⟩/⟨v²⟩) with the acceleration a. The first
//! samples, which do not determine a motion, are not counted. The fastest part of the motion dominates the measure,
//! as it does the error of tension.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::Simulation;
use super::scale::Scale;
use super::{inputs::Inputs, paths::Paths};
use crate::dynamics::motion::AxesPath;
use crate::model::{Model, Role};
use crate::scene::Reconstruction;

/// Error of tension over the relative error of velocity [-].
const GAIN: f64 = 2.5;
/// Periods of the motion over which mean values decay [-].
const PERIODS: f64 = 10.0;
/// Periods before a warning [-].
const PERIODS_MIN: f64 = 3.0;
/// Number of samples from the start that are not counted [-].
const SAMPLES_MIN: usize = 8;
/// Share of the scene's size below which an error has no effect [-].
const NEGLIGIBLE: f64 = 1e-7;
/// Order at which the error falls with the communication step [-].
const ORDER: f64 = 3.0;

/// Mean squares of the motion given and of its extrapolation error.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct InputRecord {
    /// Samples so far, up to the number not counted [-].
    samples: usize,
    /// Time in the sums [s].
    time: f64,
    /// Σ m²/h [m²/s].
    missed: f64,
    /// Σ v² h [m²/s].
    speed: f64,
    /// Σ a² h [m²/s³].
    bend: f64,
    /// Periods since the start [-].
    periods: f64,
    /// The last communication step [s].
    step: f64,
}

/// Squares of one sample, summed over all bodies: those of m, v and a.
type Squares = [f64; 3];

impl InputRecord {
    /// Records the inputs at a time [s], before they continue the paths.
    #[inline(never)]
    pub(super) fn take(&mut self, model: &Model, scale: &Scale, paths: &Paths, inputs: &Inputs, t: f64) {
        let Some(gaps) = paths.gaps(t) else {
            return;
        };
        if self.samples < SAMPLES_MIN {
            self.samples += 1;
            return;
        }
        let mut squares = [0.0; 3];
        let coupled = model.points.iter().zip(&inputs.points);
        let coupled = coupled.filter(|(point, _)| matches!(point.role, Role::Coupled { .. }));
        for ((point, input), path) in coupled.zip(&paths.points) {
            let place = point.reference + Vector3::from(input.displacement);
            add(&mut squares, &path.0, place, gaps, 1.0);
        }
        let vessels = inputs.vessels.iter().zip(&scale.levers);
        for ((input, &lever), path) in vessels.zip(&paths.vessels) {
            let [x, y, z, roll, pitch, yaw] = input.pose;
            let [place, angles] = &path.0;
            add(&mut squares, place, Vector3::new(x, y, z), gaps, 1.0);
            let turned = Vector3::new(roll, pitch, yaw);
            add(&mut squares, angles, turned, gaps, lever);
        }
        self.add(squares, gaps[0]);
    }

    fn add(&mut self, [missed, speed, bend]: Squares, step: f64) {
        let turned = step * self.frequency() / TAU;
        let kept = (1.0 - turned / PERIODS).max(0.5);
        self.time = kept * self.time + step;
        self.missed = kept * self.missed + missed / step;
        self.speed = kept * self.speed + step * speed;
        self.bend = kept * self.bend + step * bend;
        self.periods += turned;
        self.step = step;
    }

    /// Frequency of the motion [rad/s].
    fn frequency(&self) -> f64 {
        match self.speed > 0.0 {
            true => (self.bend / self.speed).sqrt(),
            false => 0.0,
        }
    }

    /// Estimated error of tension over its variation [-]; 0 where the error is negligible compared with a size [m].
    fn error(&self, size: f64) -> f64 {
        let negligible = NEGLIGIBLE * size / self.step;
        if self.speed <= 0.0 || self.missed <= negligible * negligible * self.time {
            return 0.0;
        }
        GAIN * (self.missed / self.speed).sqrt()
    }
}

/// Adds the squares of one path's sample, in metres at a lever [m].
fn add(squares: &mut Squares, path: &AxesPath, place: Vector3<f64>, gaps: [f64; 2], lever: f64) {
    let ([last, second], end) = path.newest();
    let velocity = (place - last) / gaps[0];
    let before = (last - second) / gaps[1];
    let acceleration = (velocity - before) / (0.5 * (gaps[0] + gaps[1]));
    let vectors = [place - end, velocity, acceleration];
    for (sum, vector) in squares.iter_mut().zip(vectors) {
        *sum += lever * lever * vector.norm_squared();
    }
}

impl Simulation {
    /// Record including the inputs at the start of the next step, where these are extrapolated.
    pub(super) fn record_inputs(&self) -> InputRecord {
        let snapshot = &self.snapshot;
        let mut record = snapshot.input_record;
        let extrapolates = self.model.solver.input_reconstruction != Reconstruction::Interpolate;
        if extrapolates && !snapshot.follows_scene {
            let (model, time) = (&*self.model, snapshot.state.time);
            let (paths, inputs) = (&snapshot.paths, &snapshot.inputs);
            record.take(model, &self.scale, paths, inputs, time);
        }
        record
    }

    /// Estimated error of tension, RMS over its standard deviation, from the extrapolation of the host's inputs over
    /// the last ten periods of the motion [-]; 0 where nothing is extrapolated.
    pub fn input_error(&self) -> f64 {
        self.snapshot.input_record.error(self.scale.size)
    }

    /// Warning on the inputs of a host whose extrapolation costs more than the tolerance allows.
    pub fn input_warning(&self) -> Option<String> {
        let record = &self.snapshot.input_record;
        let (error, tolerance) = (self.input_error(), self.model.solver.tolerance);
        if error <= tolerance || record.periods < PERIODS_MIN {
            return None;
        }
        let points = TAU / (record.frequency() * record.step);
        let step = record.step * (tolerance / error).powf(1.0 / ORDER);
        let time = self.time();
        Some(format!(
            "at t = {time:.6} s, about {points:.0} communication steps a period of the motion are too few for its extrapolation: tension is off \
             by about {:.2} % of its variation (solver.input_error), {:.2} % are allowed (solver.tolerance); communication steps of {} s or \
             velocities beside the displacements would do, or solver.input_reconstruction = \"interpolate\"; said once",
            100.0 * error,
            100.0 * tolerance,
            rounded_down(step),
        ))
    }
}

/// Positive number with one digit, rounded down.
fn rounded_down(number: f64) -> f64 {
    let unit = 10.0_f64.powi(number.log10().floor() as i32);
    let digits = (number / unit).floor().max(1.0);
    if unit < 1.0 {
        digits / (1.0 / unit).round()
    } else {
        digits * unit
    }
}
