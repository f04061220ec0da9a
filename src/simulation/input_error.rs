//! Error of the extrapolation of a host's motion, and the resulting error of tension.
//!
//! Displacements that a host gives at the start of every communication step h are extrapolated over it. The next
//! sample differs from the path's end by m, and the path has to be bent back at a velocity of m/h. With the velocity
//! v of the given motion the relative error is
//!
//! e = √(⟨m²/h²⟩/⟨v²⟩)
//!
//! of the motion. The velocity of the path at the end of a step has an error δ of about the same size at both ends, so that the acceleration of the
//! path jumps there by J = 12 δ/h. An error δ that changes fast compared with the motion of the line changes its tension by Z δ, with the impedance
//! Z = √(EA m_t) of axial waves. The error of tension over its standard deviation σ is estimated as
//!
//! √((2.5 e)² + (Z ⟨|J|⟩h/12 / σ)²).
//!
//! The second part is evaluated for the line with the greatest ratio of impedance to tension at rest, while this line is tight. It dominates where the
//! tension is small and follows the acceleration of the end, as on cables and risers. ⟨|J|⟩ is used in place of √⟨J²⟩, so that one jump in the
//! acceleration of the motion itself does not count for ten periods.
//!
//! With displacements only and 12 to 40 steps in a period, the estimate is 1.8 to 15 times the error on `lindahl_fast`, `oc3_catenary` and `taut_polyester`,
//! and 0.95 to 3 times the error on `power_cable` and `lazy_wave`; with velocities up to 26 times, where both are small. It leaves out the
//! resonance of a line with an axial mode at the frequency of the communication points. The error falls with h³ or faster, as m/h does.
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
use crate::dynamics::reaction;
use crate::model::{End, Line, Model, Role, State};
use crate::scene::{Integrator, Reconstruction};

/// Error of tension over the relative error of velocity [-].
const GAIN: f64 = 2.5;
/// Jump of acceleration over the error of velocity that makes it, per step [-].
const JUMP: f64 = 12.0;
/// Periods of the motion over which mean values decay [-].
const PERIODS: f64 = 10.0;
/// Periods before a warning [-].
const PERIODS_MIN: f64 = 3.0;
/// Number of samples from the start that are not counted [-].
const SAMPLES_MIN: usize = 8;
/// Share of the scene's size below which an error has no effect [-].
const NEGLIGIBLE: f64 = 1e-7;
/// Standard deviation of tension over its mean, below which it does not vary [-].
const CONSTANT: f64 = 1e-6;
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
    /// Σ |δ| h of the light end [m].
    drift: f64,
    /// Σ T h [N s] and Σ T² h [N² s] of its tension.
    tension: [f64; 2],
    /// Periods since the start [-].
    periods: f64,
    /// The last communication step [s].
    step: f64,
}

/// Squares of one sample, summed over all bodies: those of m, v and a.
type Squares = [f64; 3];

impl InputRecord {
    /// Counts a sample; returns whether it is recorded.
    fn counts(&mut self) -> bool {
        let recorded = self.samples >= SAMPLES_MIN;
        self.samples = (self.samples + 1).min(SAMPLES_MIN);
        recorded
    }

    /// Records the inputs at the end of the first of two `gaps` between samples [s], before they continue the paths.
    #[inline(never)]
    fn take(&mut self, model: &Model, scale: &Scale, paths: &Paths, inputs: &Inputs, gaps: [f64; 2]) {
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

    /// Records the light end with its tension in a state, from the paths before and after it.
    fn watch(&mut self, end: &LightEnd, model: &Model, state: &State, paths: [&Paths; 2], step: f64) {
        let tension = end.tension(model, state);
        if tension > 0.0 {
            self.drift += step * step / JUMP * end.jump(paths);
        }
        self.tension[0] += step * tension;
        self.tension[1] += step * tension * tension;
    }

    fn add(&mut self, [missed, speed, bend]: Squares, step: f64) {
        let turned = step * self.frequency() / TAU;
        let kept = (1.0 - turned / PERIODS).max(0.5);
        self.time = kept * self.time + step;
        self.missed = kept * self.missed + missed / step;
        self.speed = kept * self.speed + step * speed;
        self.bend = kept * self.bend + step * bend;
        self.drift *= kept;
        self.tension = self.tension.map(|sum| kept * sum);
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
    fn error(&self, size: f64, light: Option<&LightEnd>) -> f64 {
        let negligible = NEGLIGIBLE * size / self.step;
        if self.speed <= 0.0 || self.missed <= negligible * negligible * self.time {
            return 0.0;
        }
        let [mean, square] = self.tension.map(|sum| sum / self.time);
        let variance = square - mean * mean;
        let of_waves = match light {
            Some(end) if variance > (CONSTANT * mean).powi(2) => {
                end.impedance * self.drift / self.time / variance.sqrt()
            }
            _ => 0.0,
        };
        (GAIN * (self.missed / self.speed).sqrt()).hypot(of_waves)
    }
}

/// End with the greatest ratio of impedance to tension at rest among the ends that a host moves.
#[derive(Debug, Clone, Copy)]
pub(super) struct LightEnd {
    line: usize,
    end: End,
    /// Impedance of axial waves, √(EA m_t) [N s/m].
    impedance: f64,
    mover: Mover,
}

/// What moves the end of a line.
#[derive(Debug, Clone, Copy)]
enum Mover {
    /// Coupled point, by its number among these.
    Point(usize),
    /// Vessel by its index, with the distance of the end from its origin [m].
    Vessel(usize, f64),
}

impl LightEnd {
    /// Returns the light end of a model at rest; `None` if a host moves no line with axial waves.
    pub(super) fn new(model: &Model, at_rest: &State) -> Option<LightEnd> {
        if model.solver.integrator == Integrator::QuasiStatic {
            return None;
        }
        let (mut coupled, mut ends) = (0, Vec::new());
        for point in &model.points {
            let mover = match &point.role {
                Role::Coupled { .. } => Mover::Point(coupled),
                Role::Carried { vessel, arm } => Mover::Vessel(*vessel, arm.norm()),
                _ => continue,
            };
            coupled += usize::from(matches!(mover, Mover::Point(_)));
            let attached = point.attached.iter();
            let attached = attached.filter(|(line, _)| model.lines[*line].beam.is_none());
            ends.extend(attached.map(|&(line, end)| LightEnd::of(model, line, end, mover)));
        }
        let ratio = |end: &LightEnd| end.impedance / end.tension(model, at_rest).max(f64::MIN_POSITIVE);
        ends.into_iter().max_by(|a, b| ratio(a).total_cmp(&ratio(b)))
    }

    fn of(model: &Model, index: usize, end: End, mover: Mover) -> LightEnd {
        let line = &model.lines[index];
        let (node, segment) = at(line, end);
        let mass = line.nodes.mass_tangent[node] / line.nodes.length[node]; // m_t [kg/m]
        LightEnd {
            line: index,
            end,
            impedance: (line.segments.axial_stiffness[segment] * mass).sqrt(),
            mover,
        }
    }

    /// Tension of its segment [N].
    fn tension(&self, model: &Model, state: &State) -> f64 {
        let (line, state) = (&model.lines[self.line], &state.lines[self.line]);
        reaction::tension(line, state, at(line, self.end).1, model.solver.negative_tension)
    }

    /// Jump of its acceleration between two paths [m/s²].
    fn jump(&self, [before, after]: [&Paths; 2]) -> f64 {
        match self.mover {
            Mover::Point(index) => jump(&before.points[index].0, &after.points[index].0),
            Mover::Vessel(index, lever) => {
                let [before, after] = [before, after].map(|paths| &paths.vessels[index].0);
                jump(&before[0], &after[0]).hypot(lever * jump(&before[1], &after[1]))
            }
        }
    }
}

/// Node at the end of a line, and the segment there.
fn at(line: &Line, end: End) -> (usize, usize) {
    let node = line.end_node(end);
    (node, node.min(line.segment_count() - 1))
}

/// Jump of the acceleration between two paths [m/s², rad/s²].
fn jump(before: &AxesPath, after: &AxesPath) -> f64 {
    let ([_, [.., last]], [[.., first], _]) = (before.ends(), after.ends());
    (first - last).xyz().norm()
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
            let (model, state) = (&*self.model, &snapshot.state);
            let (paths, inputs) = (&snapshot.paths, &snapshot.inputs);
            if let Some(gaps) = paths.gaps(state.time)
                && record.counts()
            {
                record.take(model, &self.scale, paths, inputs, gaps);
                if let Some(end) = &self.light_end {
                    record.watch(end, model, state, [paths, &self.paths], gaps[0]);
                }
            }
        }
        record
    }

    /// Estimated error of tension, RMS over its standard deviation, from the extrapolation of the host's inputs over
    /// the last ten periods of the motion [-]; 0 where nothing is extrapolated.
    pub fn input_error(&self) -> f64 {
        let light = self.light_end.as_ref();
        self.snapshot.input_record.error(self.scale.size, light)
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
             by about {:.2} % of its variation, {:.2} % are allowed (solver.tolerance); communication steps of {} s or \
             velocities as well as displacements would do, or solver.input_reconstruction = \"interpolate\"; said once",
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
