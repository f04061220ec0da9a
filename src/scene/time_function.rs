//! Functions of time that a scene can write down: loads and motions.

use serde::{Deserialize, Serialize};

/// A scalar function of time: `20.0`, `{ step = [t0, f0, t1, f1] }`, `{ ramp = [t0, f0, t1, f1] }` or
/// `{ table = [[t, f], …] }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "TimeFunctionText", into = "TimeFunctionText")]
pub enum TimeFunction {
    /// The same value always.
    Constant(f64),
    /// Cubic step from f0 before t0 to f1 after t1, with zero slope at both (MotionSolve's STEP).
    Step([f64; 4]),
    /// Straight from f0 before t0 to f1 after t1.
    Ramp([f64; 4]),
    /// Straight between (t, f) pairs of ascending t, constant outside.
    Table(Vec<[f64; 2]>),
}

/// The shapes in which TOML may hold a [`TimeFunction`].
#[derive(Clone, Serialize, Deserialize)]
#[serde(untagged)]
enum TimeFunctionText {
    Constant(f64),
    Named(NamedTimeFunction),
}

#[derive(Clone, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum NamedTimeFunction {
    Constant(f64),
    Step([f64; 4]),
    Ramp([f64; 4]),
    Table(Vec<[f64; 2]>),
}

impl From<TimeFunctionText> for TimeFunction {
    fn from(text: TimeFunctionText) -> Self {
        match text {
            TimeFunctionText::Constant(value)
            | TimeFunctionText::Named(NamedTimeFunction::Constant(value)) => {
                TimeFunction::Constant(value)
            }
            TimeFunctionText::Named(NamedTimeFunction::Step(v)) => TimeFunction::Step(v),
            TimeFunctionText::Named(NamedTimeFunction::Ramp(v)) => TimeFunction::Ramp(v),
            TimeFunctionText::Named(NamedTimeFunction::Table(v)) => TimeFunction::Table(v),
        }
    }
}

impl From<TimeFunction> for TimeFunctionText {
    fn from(function: TimeFunction) -> Self {
        match function {
            TimeFunction::Constant(value) => TimeFunctionText::Constant(value),
            TimeFunction::Step(v) => TimeFunctionText::Named(NamedTimeFunction::Step(v)),
            TimeFunction::Ramp(v) => TimeFunctionText::Named(NamedTimeFunction::Ramp(v)),
            TimeFunction::Table(v) => TimeFunctionText::Named(NamedTimeFunction::Table(v)),
        }
    }
}

impl TimeFunction {
    /// Value at time `t` [s].
    pub fn at(&self, t: f64) -> f64 {
        match self {
            TimeFunction::Constant(value) => *value,
            TimeFunction::Step([t0, f0, t1, f1]) => {
                let u = ((t - t0) / (t1 - t0)).clamp(0.0, 1.0);
                f0 + (f1 - f0) * u * u * (3.0 - 2.0 * u)
            }
            TimeFunction::Ramp([t0, f0, t1, f1]) => {
                f0 + (f1 - f0) * ((t - t0) / (t1 - t0)).clamp(0.0, 1.0)
            }
            TimeFunction::Table(pairs) => interpolate(pairs, t),
        }
    }
}

fn interpolate(pairs: &[[f64; 2]], t: f64) -> f64 {
    let after = pairs.partition_point(|[time, _]| *time <= t);
    if after == 0 {
        return pairs.first().map_or(0.0, |[_, f]| *f);
    }
    let Some([t1, f1]) = pairs.get(after) else {
        return pairs[after - 1][1];
    };
    let [t0, f0] = pairs[after - 1];
    f0 + (f1 - f0) * (t - t0) / (t1 - t0)
}

/// A prescribed displacement from the reference position.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum MotionPath {
    /// Read from a table in a CSV file.
    File(MotionFile),
    /// A sum of sines per axis.
    Harmonic(HarmonicMotion),
}

/// `file = "motion.csv"`: columns time, x, y, z [s, m], a header row, relative to the scene's folder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotionFile {
    /// Path of the file.
    pub file: String,
    /// Its rows, filled in by the reader: time [s], then displacement x, y, z [m].
    #[serde(skip)]
    pub rows: Vec<[f64; 4]>,
}

/// x(t) = ramp(t)·Σ amplitude·sin(2π t/period + phase), per axis.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HarmonicMotion {
    /// Components along x: [amplitude [m], period [s]] or [amplitude, period, phase [rad]].
    #[serde(default)]
    pub x: Vec<Vec<f64>>,
    /// Components along y.
    #[serde(default)]
    pub y: Vec<Vec<f64>>,
    /// Components along z.
    #[serde(default)]
    pub z: Vec<Vec<f64>>,
    /// Duration of the cosine ramp ½(1 − cos(πt/ramp)) [s]; none where absent.
    pub ramp: Option<f64>,
}
