//! Functions of time that a scene can write down: loads and motions.

use std::fmt;

use serde::de::{self, Deserialize, Deserializer, MapAccess, Visitor};
use serde::{Serialize, Serializer};

/// A scalar function of time: `20.0`, `{ step = [t0, f0, t1, f1] }`, `{ ramp = [t0, f0, t1, f1] }` or
/// `{ table = [[t, f], …] }`.
#[derive(Debug, Clone, PartialEq)]
pub enum TimeFunction {
    /// The same value always.
    Constant(f64),
    /// Cubic step from f0 before t0 to f1 after t1, with zero slope at both (MotionSolve's STEP).
    Step([f64; 4]),
    /// Straight from f0 before t0 to f1 after t1.
    Ramp([f64; 4]),
    /// Straight between (t, f) pairs of ascending t, constant outside; two pairs at one time are a jump.
    Table(Vec<[f64; 2]>),
}

/// Names of the functions in a scene.
const FUNCTIONS: &[&str] = &["constant", "step", "ramp", "table"];

impl Serialize for TimeFunction {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let name = "TimeFunction";
        match self {
            TimeFunction::Constant(value) => serializer.serialize_f64(*value),
            TimeFunction::Step(v) => serializer.serialize_newtype_variant(name, 1, "step", v),
            TimeFunction::Ramp(v) => serializer.serialize_newtype_variant(name, 2, "ramp", v),
            TimeFunction::Table(v) => serializer.serialize_newtype_variant(name, 3, "table", v),
        }
    }
}

impl<'de> Deserialize<'de> for TimeFunction {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TimeFunctionVisitor)
    }
}

struct TimeFunctionVisitor;

impl<'de> Visitor<'de> for TimeFunctionVisitor {
    type Value = TimeFunction;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(
            "a number, { step = [t0, f0, t1, f1] }, { ramp = [t0, f0, t1, f1] } or { table = [[t, f], …] }",
        )
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<TimeFunction, E> {
        Ok(TimeFunction::Constant(value))
    }

    // TOML's and JSON's whole numbers arrive here.
    fn visit_i64<E: de::Error>(self, value: i64) -> Result<TimeFunction, E> {
        Ok(TimeFunction::Constant(value as f64))
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<TimeFunction, E> {
        Ok(TimeFunction::Constant(value as f64))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<TimeFunction, A::Error> {
        let Some(name) = map.next_key::<String>()? else {
            return Err(de::Error::invalid_type(
                de::Unexpected::Other("an empty table"),
                &self,
            ));
        };
        let function = match name.as_str() {
            "constant" => TimeFunction::Constant(map.next_value()?),
            "step" => TimeFunction::Step(map.next_value()?),
            "ramp" => TimeFunction::Ramp(map.next_value()?),
            "table" => TimeFunction::Table(map.next_value()?),
            unknown => return Err(de::Error::unknown_field(unknown, FUNCTIONS)),
        };
        match map.next_key::<String>()? {
            None => Ok(function),
            Some(second) => Err(de::Error::custom(format!(
                "`{name}` and `{second}` cannot both be given: a load has one function of time"
            ))),
        }
    }
}

impl TimeFunction {
    /// Value at time `t` [s], in the unit of its numbers.
    pub fn at(&self, t: f64) -> f64 {
        match self {
            TimeFunction::Constant(value) => *value,
            TimeFunction::Step([t0, f0, t1, f1]) => {
                let u = ((t - t0) / (t1 - t0)).clamp(0.0, 1.0);
                f0 + (f1 - f0) * u * u * (3.0 - 2.0 * u)
            }
            TimeFunction::Ramp([t0, f0, t1, f1]) => f0 + (f1 - f0) * ((t - t0) / (t1 - t0)).clamp(0.0, 1.0),
            TimeFunction::Table(pairs) => interpolate(pairs, t),
        }
    }

    /// Values at its corners, in the unit of its numbers, such as [m] of a length: it has no greater and no smaller ones.
    pub fn corners(&self) -> Vec<f64> {
        match self {
            TimeFunction::Constant(value) => vec![*value],
            TimeFunction::Step([_, f0, _, f1]) | TimeFunction::Ramp([_, f0, _, f1]) => {
                vec![*f0, *f1]
            }
            TimeFunction::Table(pairs) => pairs.iter().map(|[_, f]| *f).collect(),
        }
    }

    /// Greatest rate, in the unit of its numbers per second, such as [m/s] of a length; infinite where it jumps.
    pub fn rate_max(&self) -> f64 {
        let rise = |f0: f64, f1: f64, time: f64| match f1 - f0 {
            0.0 => 0.0,
            rise => (rise / time).abs(),
        };
        match self {
            TimeFunction::Constant(_) => 0.0,
            TimeFunction::Step([t0, f0, t1, f1]) => 1.5 * rise(*f0, *f1, t1 - t0),
            TimeFunction::Ramp([t0, f0, t1, f1]) => rise(*f0, *f1, t1 - t0),
            TimeFunction::Table(pairs) => {
                let rises = pairs
                    .windows(2)
                    .map(|pair| rise(pair[0][1], pair[1][1], pair[1][0] - pair[0][0]));
                rises.fold(0.0, f64::max)
            }
        }
    }

    /// Mean from `from` to `to` [s], in the unit of its numbers; exact, jumps and kinks included.
    pub fn mean(&self, from: f64, to: f64) -> f64 {
        if to <= from {
            return self.at(from);
        }
        match self {
            TimeFunction::Constant(value) => *value,
            TimeFunction::Step([t0, _, t1, _]) | TimeFunction::Ramp([t0, _, t1, _]) => {
                self.mean_over([*t0, *t1].into_iter(), from, to)
            }
            TimeFunction::Table(pairs) => self.mean_over(pairs.iter().map(|[time, _]| *time), from, to),
        }
    }

    /// Two points of Gauss are exact for the cubics between the ascending `breaks` [s].
    fn mean_over(&self, breaks: impl Iterator<Item = f64>, from: f64, to: f64) -> f64 {
        let inside = breaks.filter(|t| (from..to).contains(t));
        let (mut start, mut mean) = (from, 0.0);
        for end in inside.chain(std::iter::once(to)) {
            let (middle, half) = (0.5 * (start + end), 0.5 * (end - start));
            let reach = half / 3.0_f64.sqrt();
            let both = self.at(middle - reach) + self.at(middle + reach);
            mean += both * (half / (to - from));
            start = end;
        }
        mean
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

/// A row of a motion table: time [s], displacement x, y, z [m], then roll, pitch and yaw [rad], which are 0 for points.
pub type MotionRow = [f64; 7];

/// A prescribed displacement from the reference position, and of vessels a rotation from the reference attitude.
#[derive(Debug, Clone, PartialEq, serde::Deserialize)]
#[serde(try_from = "MotionText")]
pub enum MotionPath {
    /// Read from a table in a CSV file.
    File(MotionFile),
    /// A table in the scene.
    Table(Vec<MotionRow>),
    /// A sum of sines per axis.
    Harmonic(HarmonicMotion),
}

/// `file = "motion.csv"`: columns time, x, y, z [s, m] and for vessels roll, pitch, yaw [rad], a header row, relative to the scene's
/// folder.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionFile {
    /// Path of the file.
    pub file: String,
    /// Its rows, filled in by the reader.
    pub rows: Vec<MotionRow>,
    /// Its columns, separators and units, filled in by the reader.
    pub columns: String,
}

/// x(t) = ramp(t)·Σ amplitude·sin(2π t/period + phase), per axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct HarmonicMotion {
    /// Components along x: [amplitude [m], period [s]] or [amplitude, period, phase [rad]].
    pub x: Vec<Vec<f64>>,
    /// Components along y: [amplitude [m], period [s]] or [amplitude, period, phase [rad]].
    pub y: Vec<Vec<f64>>,
    /// Components along z: [amplitude [m], period [s]] or [amplitude, period, phase [rad]].
    pub z: Vec<Vec<f64>>,
    /// Components of roll: [amplitude [rad], period [s]] or [amplitude, period, phase [rad]]; vessels only.
    pub roll: Vec<Vec<f64>>,
    /// Components of pitch: [amplitude [rad], period [s]] or [amplitude, period, phase [rad]]; vessels only.
    pub pitch: Vec<Vec<f64>>,
    /// Components of yaw: [amplitude [rad], period [s]] or [amplitude, period, phase [rad]]; vessels only.
    pub yaw: Vec<Vec<f64>>,
    /// Duration of the cosine ramp ½(1 − cos(πt/ramp)) [s]; none where absent.
    pub ramp: Option<f64>,
}

impl HarmonicMotion {
    /// The six axes by name, with their components: amplitudes [m] of x, y, z and [rad] of roll, pitch, yaw.
    pub fn axes(&self) -> [(&'static str, &Vec<Vec<f64>>); 6] {
        [
            ("x", &self.x),
            ("y", &self.y),
            ("z", &self.z),
            ("roll", &self.roll),
            ("pitch", &self.pitch),
            ("yaw", &self.yaw),
        ]
    }
}

impl MotionPath {
    /// Rows where the motion is a table or was read from a file.
    pub fn rows(&self) -> Option<&[MotionRow]> {
        match self {
            MotionPath::File(file) => Some(&file.rows),
            MotionPath::Table(rows) => Some(rows),
            MotionPath::Harmonic(_) => None,
        }
    }

    /// Greatest displacements [m], if any is above 0, and sizes of rotations [rad], all sines being taken to be in phase.
    pub fn greatest(&self) -> [f64; 6] {
        match self {
            MotionPath::Harmonic(motion) => motion.axes().map(|(_, sines)| {
                let amplitudes = sines.iter().filter_map(|sine| sine.first());
                amplitudes.map(|amplitude| amplitude.abs()).sum()
            }),
            MotionPath::File(MotionFile { rows, .. }) | MotionPath::Table(rows) => {
                std::array::from_fn(|axis| {
                    let values = rows.iter().map(|row| row[1 + axis]);
                    match axis {
                        0..3 => values.fold(0.0, f64::max),
                        _ => values.map(f64::abs).fold(0.0, f64::max),
                    }
                })
            }
        }
    }

    /// Whether it rotates.
    pub fn turns(&self) -> bool {
        match self {
            MotionPath::Harmonic(h) => h.axes()[3..].iter().any(|(_, axis)| !axis.is_empty()),
            _ => self.rows().is_some_and(turning),
        }
    }
}

fn turning(rows: &[MotionRow]) -> bool {
    rows.iter().any(|row| row[4..] != [0.0; 3])
}

/// The keys that TOML may give a [`MotionPath`].
#[derive(Default, serde::Serialize, serde::Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "{ x = [[amplitude, period], …], z = …, ramp = … }, { table = [[t, x, y, z], …] } or { file = \"motion.csv\" }"
)]
pub(super) struct MotionText {
    file: Option<String>,
    table: Option<Vec<TableRow>>,
    x: Option<Vec<Vec<f64>>>,
    y: Option<Vec<Vec<f64>>>,
    z: Option<Vec<Vec<f64>>>,
    roll: Option<Vec<Vec<f64>>>,
    pitch: Option<Vec<Vec<f64>>>,
    yaw: Option<Vec<Vec<f64>>>,
    ramp: Option<f64>,
}

impl TryFrom<MotionText> for MotionPath {
    type Error = String;

    fn try_from(text: MotionText) -> Result<Self, Self::Error> {
        let axes = [&text.x, &text.y, &text.z, &text.roll, &text.pitch, &text.yaw];
        let swings = axes.iter().any(|axis| axis.is_some());
        match (text.file, text.table) {
            (Some(_), Some(_)) => Err("`file` and `table` cannot both be given".into()),
            (Some(_), _) | (_, Some(_)) if swings || text.ramp.is_some() => Err(
                "`x`, `y`, `z`, `roll`, `pitch`, `yaw` and `ramp` cannot be given beside `file` or `table`".into(),
            ),
            (Some(file), None) => Ok(MotionPath::File(MotionFile {
                file,
                rows: Vec::new(),
                columns: String::new(),
            })),
            (None, Some(rows)) => Ok(MotionPath::Table(rows.iter().map(|row| row.0).collect())),
            (None, None) if !swings => {
                Err("a motion needs `x`, `y` or `z`, or `table`, or `file`; vessels also `roll`, `pitch` or `yaw`".into())
            }
            (None, None) => Ok(MotionPath::Harmonic(HarmonicMotion {
                x: text.x.unwrap_or_default(),
                y: text.y.unwrap_or_default(),
                z: text.z.unwrap_or_default(),
                roll: text.roll.unwrap_or_default(),
                pitch: text.pitch.unwrap_or_default(),
                yaw: text.yaw.unwrap_or_default(),
                ramp: text.ramp,
            })),
        }
    }
}

/// A row of 4 numbers, or of 7 with the rotations.
#[derive(Clone, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "Vec<f64>", into = "Vec<f64>")]
struct TableRow(MotionRow);

impl TryFrom<Vec<f64>> for TableRow {
    type Error = String;

    fn try_from(numbers: Vec<f64>) -> Result<Self, Self::Error> {
        let mut row = [0.0; 7];
        match numbers.len() {
            n @ (4 | 7) => row[..n].copy_from_slice(&numbers),
            n => {
                return Err(format!(
                    "expected an array of 4 numbers (t, x, y, z), or of 7 (with roll, pitch, yaw of a vessel), found an array of {n}"
                ));
            }
        }
        Ok(TableRow(row))
    }
}

impl From<TableRow> for Vec<f64> {
    fn from(TableRow(row): TableRow) -> Vec<f64> {
        let width = if turning(&[row]) { 7 } else { 4 };
        row[..width].to_vec()
    }
}

impl Serialize for MotionPath {
    /// Rows that were read from a file are written in its place, so that the scene needs no other file.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut text = MotionText::default();
        match self {
            MotionPath::File(file) if file.rows.is_empty() => text.file = Some(file.file.clone()),
            MotionPath::File(MotionFile { rows, .. }) | MotionPath::Table(rows) => {
                text.table = Some(rows.iter().copied().map(TableRow).collect());
            }
            MotionPath::Harmonic(harmonic) => {
                let turn = |axis: &Vec<Vec<f64>>| (!axis.is_empty()).then(|| axis.clone());
                text.x = Some(harmonic.x.clone());
                text.y = Some(harmonic.y.clone());
                text.z = Some(harmonic.z.clone());
                text.roll = turn(&harmonic.roll);
                text.pitch = turn(&harmonic.pitch);
                text.yaw = turn(&harmonic.yaw);
                text.ramp = harmonic.ramp;
            }
        }
        text.serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_flat_at_both_ends_and_half_way_in_the_middle() {
        let step = TimeFunction::Step([1.0, 2.0, 3.0, 6.0]);
        assert_eq!(step.at(0.0), 2.0);
        assert_eq!(step.at(2.0), 4.0);
        assert_eq!(step.at(9.0), 6.0);
        let slope = (step.at(1.0 + 1e-6) - step.at(1.0)) / 1e-6;
        assert!(slope.abs() < 1e-5);
    }

    #[test]
    fn a_table_is_straight_between_its_rows_and_constant_outside() {
        let table = TimeFunction::Table(vec![[0.0, 1.0], [2.0, 5.0]]);
        assert_eq!(table.at(-1.0), 1.0);
        assert_eq!(table.at(0.5), 2.0);
        assert_eq!(table.at(2.0), 5.0);
        assert_eq!(table.at(3.0), 5.0);
    }

    #[test]
    fn a_mean_over_a_span_is_that_of_many_samples_and_knows_where_a_load_jumps() {
        let functions = [
            TimeFunction::Constant(3.0),
            TimeFunction::Step([1.0, 2.0, 3.0, 6.0]),
            TimeFunction::Ramp([1.0, 2.0, 3.0, 6.0]),
            TimeFunction::Table(vec![[0.5, 1.0], [2.0, 5.0], [2.0, -1.0], [4.0, 0.0]]),
        ];
        for function in functions {
            let (from, to, n) = (0.2, 4.7, 1_000_000);
            let sample = |i: i32| function.at(from + (to - from) * (f64::from(i) + 0.5) / f64::from(n));
            let mean = (0..n).map(sample).sum::<f64>() / f64::from(n);
            assert!((function.mean(from, to) - mean).abs() < 1e-5, "{function:?}");
        }
        let load = TimeFunction::Table(vec![[2.5, 8.0], [2.5, 0.0]]);
        assert_eq!(load.mean(2.4, 2.5), 8.0);
        assert!((load.mean(2.0, 3.0) - 4.0).abs() < 1e-15);
        assert_eq!(load.mean(2.5, 2.6), 0.0);
        assert_eq!(load.mean(1.0, 1.0), 8.0);
    }
}
