//! Error of the path of a host's motion between communication points, and the resulting error of tension.
//!
//! Displacements that a host gives at the start of every communication step h are extrapolated over it. The next sample differs from the path's end by m,
//! and the path must be corrected at a velocity of m/h. With the velocity v of the given motion, the relative error of the motion is
//!
//! e = √(⟨m²/h²⟩/⟨v²⟩)
//!
//! The velocity of the path at the end of a step has an error δ of about the same size at both ends, so that the acceleration of the path jumps there by
//! J = 12 δ/h. An error δ that changes fast compared with the motion of the line changes its tension by Z δ, with the impedance Z = √(EA m_t) of axial
//! waves. The error of tension over its standard deviation σ is estimated as
//!
//! √((2.5 e)² + (A Z ⟨|J|⟩h/12 / σ)²).
//!
//! where A is the amplification by axial modes at the communication frequency ([`super::axial_response`]). The second part is that of the line where
//! it is greatest. It is recorded for every line while the line is tight, relative to σ or to a hundredth of the mean tension, whichever is greater;
//! if a host moves both ends, it is the sum over both. It dominates where the tension is small and follows the acceleration of the end, as on cables
//! and risers. ⟨|J|⟩ is used instead of √⟨J²⟩, so that one jump in the acceleration of the motion itself does not count for ten periods. An
//! interpolated path passes through the samples, m = 0; if the host gives no velocities, those of the path have errors δ too, and δ = J h/12 replaces
//! m/h. A path that jumps has jumps m.
//!
//! With displacements only and 12 to 40 steps per period, the estimate is 1.8 to 15 times the error on `lindahl_fast`, `oc3_catenary` and
//! `taut_polyester`, and 0.95 to 3 times the error on `power_cable` and `lazy_wave`; with velocities, it is up to 26 times the error, where both are
//! small. With interpolated displacements, these factors are 2.5 to 17 and 0.8 to 5. With jumps, on lines other than cables, the factor is 1.1 to 4.
//! The estimate excludes the curvature of interpolated cubics with exact velocities, (ωh)²/12 of an acceleration of frequency ω: 2.3 % with 12 steps
//! per period, 0.2 % with 40. The error falls with h³ or faster, as m/h does.
//!
//! Mean values decay with a time constant of ten periods of the frequency √(⟨a²⟩/⟨v²⟩), with the acceleration a. The first samples do not determine a
//! motion and are not recorded. The fastest part of the motion dominates the measure, as it dominates the error of tension.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::Simulation;
use super::axial_response::MovedLine;
use super::paths::Paths;
use crate::dynamics::motion::AxesPath;
use crate::model::{Model, State};
use crate::scene::Reconstruction;

/// Error of tension over the relative error of velocity [-].
const GAIN: f64 = 2.5;
/// Jump of acceleration over the error of velocity that causes it, per step [-].
const JUMP: f64 = 12.0;
/// Periods of the motion over which mean values decay [-].
const PERIODS: f64 = 10.0;
/// Periods before a warning [-].
const PERIODS_MIN: f64 = 3.0;
/// Number of initial samples that are not recorded [-].
const SAMPLES_MIN: usize = 8;
/// Error below which the motion is taken as exact, relative to the scene's size [-].
const NEGLIGIBLE: f64 = 1e-7;
/// Least standard deviation of a tension to which its errors are related, relative to its mean [-].
pub(crate) const STILL_TENSION: f64 = 0.01;
/// Fraction of the tolerance available for the inputs [-]: the mesh takes 0.7, and squares of the errors add.
const PART: f64 = 0.6;
/// Order at which the error falls with the communication step [-].
const ORDER: f64 = 3.0;

/// Mean squares of the given motion and of the error of its path.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct InputRecord {
    motion: MotionRecord,
    /// Records of the lines that a host moves.
    lines: Vec<LineRecord>,
}

/// Record of the given motion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct MotionRecord {
    /// Number of samples so far, at most [`SAMPLES_MIN`] [-].
    samples: usize,
    /// Time covered by the sums [s].
    time: f64,
    /// Σ m²/h, or Σ δ²h for an interpolated path [m²/s].
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

/// Record of a line.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct LineRecord {
    /// Σ A Z |δ| h [N s].
    excitation: f64,
    /// Σ T h [N s] and Σ T² h [N² s] of its tension.
    tension: [f64; 2],
}

/// Squares of one sample, summed over all bodies: those of m, v and a.
type Squares = [f64; 3];

impl MotionRecord {
    /// Counts a sample; returns whether it is recorded.
    fn counts(&mut self) -> bool {
        let recorded = self.samples >= SAMPLES_MIN;
        self.samples = (self.samples + 1).min(SAMPLES_MIN);
        recorded
    }

    /// Records the newest sample of the paths `after`, which continue the paths `before`. `gaps` are the latest two intervals between samples, newest
    /// first [s]. Returns the fraction of the earlier sums that is kept.
    #[inline(never)]
    fn take(
        &mut self,
        levers: &[f64],
        [before, after]: [&Paths; 2],
        gaps: [f64; 2],
        interpolates: bool,
    ) -> f64 {
        let mut squares = [0.0; 3];
        let mut add = |before: &AxesPath, after: &AxesPath, lever: f64| {
            let missed = match interpolates {
                true => gaps[0] * gaps[0] / JUMP * before.jump(after),
                false => (after.newest()[0] - before.end()[0].xyz()).norm(),
            };
            let [velocity, acceleration] = rates(after.newest(), gaps);
            let norms = [missed, velocity.norm(), acceleration.norm()];
            for (sum, norm) in squares.iter_mut().zip(norms) {
                *sum += (lever * norm).powi(2);
            }
        };
        for (before, after) in before.points.iter().zip(&after.points) {
            add(&before.0, &after.0, 1.0);
        }
        for ((before, after), &lever) in before.vessels.iter().zip(&after.vessels).zip(levers) {
            add(&before.0[0], &after.0[0], 1.0);
            add(&before.0[1], &after.0[1], lever);
        }
        self.add(squares, gaps[0])
    }

    /// Adds the squares of a sample after a step [s]; returns the fraction of the earlier sums that is kept.
    fn add(&mut self, [missed, speed, bend]: Squares, step: f64) -> f64 {
        let turned = step * self.frequency() / TAU;
        let kept = (1.0 - turned / PERIODS).max(0.5);
        self.time = kept * self.time + step;
        self.missed = kept * self.missed + missed / step;
        self.speed = kept * self.speed + step * speed;
        self.bend = kept * self.bend + step * bend;
        self.periods += turned;
        self.step = step;
        kept
    }

    /// Frequency of the motion [rad/s].
    fn frequency(&self) -> f64 {
        match self.speed > 0.0 {
            true => (self.bend / self.speed).sqrt(),
            false => 0.0,
        }
    }

    /// Estimated relative error of the motion [-]; 0 if the error is negligible compared with a size [m].
    fn error(&self, size: f64) -> f64 {
        let negligible = NEGLIGIBLE * size / self.step;
        match self.speed <= 0.0 || self.missed <= negligible * negligible * self.time {
            true => 0.0,
            false => (self.missed / self.speed).sqrt(),
        }
    }
}

impl LineRecord {
    /// Records the tension of a line in a state and its excitation between the paths before and after it; `kept` is the fraction of the earlier sums
    /// that is kept.
    fn take(
        &mut self,
        line: &mut MovedLine,
        (model, state): (&Model, &State),
        paths: [&Paths; 2],
        (step, kept): (f64, f64),
    ) {
        let tension = line.tension(model, state);
        let excitation = match tension > 0.0 {
            true => line.excitation(paths, step),
            false => 0.0,
        };
        self.excitation = kept * self.excitation + step * step / JUMP * excitation;
        self.tension[0] = kept * self.tension[0] + step * tension;
        self.tension[1] = kept * self.tension[1] + step * tension * tension;
    }

    /// Estimated error of tension due to axial waves over its variation [-]; `time` is the time covered by the sums [s].
    fn error(&self, time: f64) -> f64 {
        let [mean, square] = self.tension.map(|sum| sum / time);
        let deviation = (square - mean * mean).max(0.0).sqrt();
        let scale = deviation.max(STILL_TENSION * mean.abs());
        match scale > 0.0 {
            true => self.excitation / time / scale,
            false => 0.0,
        }
    }
}

impl InputRecord {
    /// Empty record of lines.
    pub(super) fn of(lines: &[MovedLine]) -> InputRecord {
        InputRecord {
            motion: MotionRecord::default(),
            lines: vec![LineRecord::default(); lines.len()],
        }
    }

    /// Copies another record of the same lines.
    fn follow(&mut self, other: &InputRecord) {
        self.motion = other.motion;
        self.lines.clone_from(&other.lines);
    }

    /// Estimated error of tension over its variation [-]; 0 if the error of the motion is negligible compared with a size [m].
    fn error(&self, size: f64) -> f64 {
        match self.motion.error(size) {
            0.0 => 0.0,
            of_motion => {
                let of_lines = self.lines.iter().map(|line| line.error(self.motion.time));
                (GAIN * of_motion).hypot(of_lines.fold(0.0, f64::max))
            }
        }
    }
}

/// Velocity [m/s, rad/s] and acceleration [m/s², rad/s²] of three samples, newest first, with the `gaps` between them [s].
fn rates([newest, last, second]: [Vector3<f64>; 3], gaps: [f64; 2]) -> [Vector3<f64>; 2] {
    let velocity = (newest - last) / gaps[0];
    let before = (last - second) / gaps[1];
    [velocity, (velocity - before) / (0.5 * (gaps[0] + gaps[1]))]
}

impl Simulation {
    /// Updates the next record with the sample of the coming step, whose paths are laid out.
    pub(super) fn record_inputs(&mut self) {
        let (snapshot, paths) = (&self.snapshot, [&*self.snapshot.paths, &*self.paths]);
        let record = &mut self.next_record;
        record.follow(&snapshot.input_record);
        if snapshot.follows_scene {
            return;
        }
        if let Some(gaps) = paths[1].gaps()
            && record.motion.counts()
        {
            let interpolates = self.model.solver.input_reconstruction == Reconstruction::Interpolate;
            let kept = record.motion.take(&self.scale.levers, paths, gaps, interpolates);
            let at = (&*self.model, &snapshot.state);
            for (record, line) in record.lines.iter_mut().zip(&mut self.moved_lines) {
                record.take(line, at, paths, (gaps[0], kept));
            }
        }
    }

    /// Estimated RMS error of tension over its standard deviation [-], caused by the path between the host's samples over the last ten periods of the
    /// motion.
    pub fn input_error(&self) -> f64 {
        self.snapshot.input_record.error(self.scale.size)
    }

    /// Warning on a host's inputs if the error of the path between them exceeds the limit that follows from the tolerance.
    pub fn input_warning(&self) -> Option<String> {
        let record = &self.snapshot.input_record.motion;
        let (error, allowed) = (self.input_error(), PART * self.model.solver.tolerance);
        if error <= allowed || record.periods < PERIODS_MIN {
            return None;
        }
        let points = TAU / (record.frequency() * record.step);
        let step = record.step * (allowed / error).powf(1.0 / ORDER);
        let (fault, cure) = match (
            self.model.solver.input_reconstruction,
            self.paths.lack_velocities(),
        ) {
            (Reconstruction::Jump, _) => (
                "a path that jumps at each of them",
                " or set solver.input_reconstruction = \"smooth\"",
            ),
            (Reconstruction::Interpolate, true) => ("the velocities derived from them", " or velocities"),
            (Reconstruction::Interpolate, false) => ("the cubics between them", ""),
            (Reconstruction::Smooth | Reconstruction::Filtered, true) => (
                "its extrapolation",
                " or velocities, or set solver.input_reconstruction = \"interpolate\"",
            ),
            (Reconstruction::Smooth | Reconstruction::Filtered, false) => (
                "its extrapolation",
                " or set solver.input_reconstruction = \"interpolate\"",
            ),
        };
        let time = self.time();
        Some(format!(
            "at t = {time:.6} s, about {points:.0} communication steps per period of the motion are too few for {fault}: the estimated error of \
             tension is {:.2} % of its standard deviation, above the {:.2} % that solver.tolerance leaves beside the error of the mesh; give \
             communication steps of {} s{cure}; reported once",
            100.0 * error,
            100.0 * allowed,
            rounded_down(step),
        ))
    }
}

/// Rounds a positive number down to one significant digit.
fn rounded_down(number: f64) -> f64 {
    let unit = 10.0_f64.powi(number.log10().floor() as i32);
    let digits = (number / unit).floor().max(1.0);
    if unit < 1.0 {
        digits / (1.0 / unit).round()
    } else {
        digits * unit
    }
}
