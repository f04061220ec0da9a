//! Functions of time in a scene: loads and motions.

use toml::Value as Toml;

use super::SceneError;
use super::check::{Bounds, Findings, quantity, rules};
use super::document::Node;
use super::table::{Key, Kind, MIXED, Table, Value, magnitude, positive, table};
use super::value::{decimal_commas, entry};
use super::words::motion_in_words;

/// A scalar function of time: `20.0`, `{ step = [t0, f0, t1, f1] }`, `{ ramp = [t0, f0, t1, f1] }` or
/// `{ table = [[t, f], …] }`.
#[derive(Debug, Clone, PartialEq)]
pub enum TimeFunction {
    /// Constant value.
    Constant(f64),
    /// Cubic step from f0 before t0 to f1 after t1, with zero slope at both (MotionSolve's STEP).
    Step([f64; 4]),
    /// Linear from f0 before t0 to f1 after t1.
    Ramp([f64; 4]),
    /// Linear between (t, f) pairs in ascending t, constant outside; two pairs at the same t are a jump.
    Table(Vec<[f64; 2]>),
}

table! {
    /// The keys of a function of time, of which one is given.
    struct FunctionText, "a function of time" {
        /// Constant value, equivalent to a plain number.
        constant: Option<f64> => MIXED,
        /// `[t0, f0, t1, f1]`: a cubic step from f0 before t0 to f1 after t1, with zero slope at both.
        step: Option<[f64; 4]> => MIXED,
        /// `[t0, f0, t1, f1]`: linear from f0 before t0 to f1 after t1.
        ramp: Option<[f64; 4]> => MIXED,
        /// Rows `[t, f]` of ascending time, linear between rows and constant outside; two rows at the same time are a jump.
        table: Option<Vec<[f64; 2]>> => MIXED,
    }
}

impl Default for TimeFunction {
    fn default() -> TimeFunction {
        TimeFunction::Constant(0.0)
    }
}

impl Value for TimeFunction {
    fn kind() -> Kind {
        Kind::NumberOrTable(FunctionText::SCHEMA)
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        let expected =
            "a number, { step = [t0, f0, t1, f1] }, { ramp = [t0, f0, t1, f1] } or { table = [[t, f], …] }";
        if node.entries().is_none_or(|entries| entries.is_empty()) {
            *self = TimeFunction::Constant(node.number(expected)?);
            return Ok(());
        }
        let text: FunctionText = node.read()?;
        let given = text.entries().filter(|(_, value)| !value.is_absent());
        let given: Vec<&str> = given.map(|(key, _)| key.name()).collect();
        if let [first, second, ..] = given[..] {
            return Err(node.refuse(format!(
                "`{first}` and `{second}` cannot both be given: a load has one function of time"
            )));
        }
        *self = match (text.step, text.ramp, text.table) {
            (Some(numbers), ..) => TimeFunction::Step(numbers),
            (_, Some(numbers), _) => TimeFunction::Ramp(numbers),
            (.., Some(rows)) => TimeFunction::Table(rows),
            _ => TimeFunction::Constant(text.constant.unwrap_or_default()),
        };
        Ok(())
    }

    fn write(&self) -> Option<Toml> {
        match self {
            TimeFunction::Constant(value) => value.write(),
            TimeFunction::Step(numbers) => Some(entry("step", numbers.write()?)),
            TimeFunction::Ramp(numbers) => Some(entry("ramp", numbers.write()?)),
            TimeFunction::Table(rows) => Some(entry("table", rows.write()?)),
        }
    }

    fn check(&self, key: &Key, findings: &mut Findings) {
        let (limits, unit) = (magnitude(1e15).bounds, key.unit().unwrap_or("-"));
        match self {
            TimeFunction::Constant(value) => _ = findings.number("", *value, limits, unit),
            TimeFunction::Step(numbers) => check_rise(findings, "step", *numbers, unit),
            TimeFunction::Ramp(numbers) => check_rise(findings, "ramp", *numbers, unit),
            TimeFunction::Table(rows) => {
                check_times(findings, "table", rows.iter().map(|row| row[0]), true);
                for (i, row) in rows.iter().enumerate() {
                    findings.number(format!("table[{i}][1]"), row[1], limits, unit);
                }
            }
        }
    }

    fn in_words(&self, key: &Key) -> Option<String> {
        let unit = key.unit().unwrap_or("-");
        let rise = |how: &str, [t0, f0, t1, f1]: [f64; 4]| {
            let [f0, f1] = [f0, f1].map(|f| quantity(f, unit));
            format!(
                "{how} from {f0} at {} to {f1} at {}",
                quantity(t0, "s"),
                quantity(t1, "s")
            )
        };
        Some(match self {
            TimeFunction::Constant(value) => quantity(*value, unit),
            TimeFunction::Step(numbers) => rise("rising smoothly", *numbers),
            TimeFunction::Ramp(numbers) => rise("rising straight", *numbers),
            TimeFunction::Table(rows) => format!("from a table of {} rows", rows.len()),
        })
    }
}

/// Bounds of times in tables and steps [s]: about thirty years.
const TIME: Bounds = Bounds::Magnitude(1e9);

/// Checks `[t0, f0, t1, f1]` of a step or ramp.
fn check_rise(findings: &mut Findings, at: &str, [t0, f0, t1, f1]: [f64; 4], unit: &str) {
    let load = (Bounds::Magnitude(1e15), unit);
    findings.row(at, &[t0, f0, t1, f1], &[(TIME, "s"), load, (TIME, "s"), load]);
    let [start, end] = [t0, t1].map(|time| quantity(time, "s"));
    rules! { findings, at;
        "" if TIME.accepts(t0) && TIME.accepts(t1) && t1 <= t0 =>
            "it ends at {end}, not after its start at {start}: write [t0, f0, t1, f1] with t1 > t0";
    }
}

/// Checks the times in the first column of a table; two rows may have the same time only if `jumps` is true.
fn check_times(findings: &mut Findings, at: &str, times: impl Iterator<Item = f64>, jumps: bool) {
    let mut last: Option<f64> = None;
    for (row, time) in times.enumerate() {
        let here = || format!("{at}[{row}][0]");
        if !TIME.accepts(time) {
            findings.number(here(), time, TIME, "s");
            return;
        }
        if let Some(last) = last
            && (time < last || (time == last && !jumps))
        {
            let problem = format!(
                "time {} does not come after {}: write the rows in ascending time",
                quantity(time, "s"),
                quantity(last, "s")
            );
            return findings.say(here(), problem);
        }
        last = Some(time);
    }
    if last.is_none() {
        findings.say(at, "the table has no rows");
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

    /// Values at its corners, in the unit of its numbers, such as [m] for a length; they include its minimum and maximum.
    pub fn corners(&self) -> Vec<f64> {
        match self {
            TimeFunction::Constant(value) => vec![*value],
            TimeFunction::Step([_, f0, _, f1]) | TimeFunction::Ramp([_, f0, _, f1]) => {
                vec![*f0, *f1]
            }
            TimeFunction::Table(pairs) => pairs.iter().map(|[_, f]| *f).collect(),
        }
    }

    /// Maximum rate, in the unit of its numbers per second, such as [m/s] for a length; infinite if it jumps.
    pub(crate) fn rate_max(&self) -> f64 {
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

    /// Mean from `from` to `to` [s], in the unit of its numbers; exact, also across jumps and kinks.
    pub fn mean(&self, from: f64, to: f64) -> f64 {
        if to <= from {
            return self.at(from);
        }
        match self {
            TimeFunction::Constant(value) => *value,
            TimeFunction::Step([t0, _, t1, _]) | TimeFunction::Ramp([t0, _, t1, _]) => {
                self.mean_over([*t0, *t1].into_iter(), from, to)
            }
            TimeFunction::Table(pairs) => {
                let first = pairs.partition_point(|[time, _]| *time < from);
                let inside = pairs[first..].iter().map(|[time, _]| *time);
                self.mean_over(inside.take_while(|time| *time < to), from, to)
            }
        }
    }

    /// Mean from `from` to `to` [s]: two-point Gauss quadrature is exact for the cubics between the ascending `breaks` [s].
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

/// Prescribed displacement from the reference position and, for vessels, rotation from the reference attitude.
#[derive(Debug, Clone, PartialEq)]
pub enum MotionPath {
    /// Table in a CSV file.
    File(MotionFile),
    /// A table in the scene.
    Table(Vec<MotionRow>),
    /// A sum of sines per axis.
    Harmonic(HarmonicMotion),
}

/// `file = "motion.csv"`, relative to the scene's folder: a header row, then columns time [s], x, y, z [m] and for vessels roll, pitch, yaw
/// [rad].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MotionFile {
    /// Path of the file.
    pub file: String,
    /// Rows of the file, filled in by the reader.
    pub rows: Vec<MotionRow>,
    /// Columns, separators and units of the file, filled in by the reader.
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
    /// Duration of the cosine ramp ½(1 − cos(πt/ramp)) [s]; no ramp if absent.
    pub ramp: Option<f64>,
}

impl HarmonicMotion {
    /// Motion from the sines of its axes x, y, z, roll, pitch and yaw, with a ramp [s].
    pub(super) fn of([x, y, z, roll, pitch, yaw]: [Vec<Vec<f64>>; 6], ramp: Option<f64>) -> HarmonicMotion {
        HarmonicMotion {
            x,
            y,
            z,
            roll,
            pitch,
            yaw,
            ramp,
        }
    }

    /// The six axes by name, with their sines: amplitudes [m] of x, y, z and [rad] of roll, pitch, yaw.
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
    /// Rows of a motion that is a table or was read from a file.
    pub fn rows(&self) -> Option<&[MotionRow]> {
        match self {
            MotionPath::File(file) => Some(&file.rows),
            MotionPath::Table(rows) => Some(rows),
            MotionPath::Harmonic(_) => None,
        }
    }

    /// Maximum displacements [m], at least 0, and maximum absolute rotations [rad]; sines are assumed to be in phase.
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

    /// Returns whether it rotates.
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

table! {
    /// The keys of a motion: a `file`, a `table`, or sines along and about the axes.
    struct MotionText, "a motion" {
        /// File with columns of time [s], x, y, z [m] and of vessels roll, pitch, yaw [rad], relative to the scene.
        file: Option<String>,
        /// Rows of time [s], x, y, z [m] and of vessels roll, pitch, yaw [rad].
        table: Option<Vec<TableRow>> => MIXED.in_units("s, m, rad"),
        /// Sines along x: [amplitude [m], period [s]] or [amplitude, period, phase [rad]].
        x: Option<Vec<Vec<f64>>> => MIXED.in_units("m, s, rad"),
        /// Sines along y: [amplitude [m], period [s]] or [amplitude, period, phase [rad]].
        y: Option<Vec<Vec<f64>>> => MIXED.in_units("m, s, rad"),
        /// Sines along z: [amplitude [m], period [s]] or [amplitude, period, phase [rad]].
        z: Option<Vec<Vec<f64>>> => MIXED.in_units("m, s, rad"),
        /// Sines of roll: [amplitude [rad], period [s]] or [amplitude, period, phase [rad]]; vessels only.
        roll: Option<Vec<Vec<f64>>> => MIXED.in_units("rad, s, rad"),
        /// Sines of pitch: [amplitude [rad], period [s]] or [amplitude, period, phase [rad]]; vessels only.
        pitch: Option<Vec<Vec<f64>>> => MIXED.in_units("rad, s, rad"),
        /// Sines of yaw: [amplitude [rad], period [s]] or [amplitude, period, phase [rad]]; vessels only.
        yaw: Option<Vec<Vec<f64>>> => MIXED.in_units("rad, s, rad"),
        /// Duration of the cosine ramp ½(1 − cos(πt/ramp)) of the sines [s]; by default none.
        ramp: Option<f64> => positive(1e9),
    }
}

impl MotionText {
    /// Returns the motion, or an error if the keys do not form one.
    fn path(self) -> Result<MotionPath, String> {
        let axes = [self.x, self.y, self.z, self.roll, self.pitch, self.yaw];
        let swings = axes.iter().any(|axis| axis.is_some());
        match (self.file, self.table) {
            (Some(_), Some(_)) => Err("`file` and `table` cannot both be given".into()),
            (Some(_), _) | (_, Some(_)) if swings || self.ramp.is_some() => Err(
                "`x`, `y`, `z`, `roll`, `pitch`, `yaw` and `ramp` cannot be given with `file` or `table`".into(),
            ),
            (Some(file), None) => Ok(MotionPath::File(MotionFile {
                file,
                ..MotionFile::default()
            })),
            (None, Some(rows)) => Ok(MotionPath::Table(rows.iter().map(|row| row.0).collect())),
            (None, None) if !swings => {
                Err("a motion needs `x`, `y` or `z`, or `table`, or `file`; vessels also `roll`, `pitch` or `yaw`".into())
            }
            (None, None) => {
                let axes = axes.map(Option::unwrap_or_default);
                Ok(MotionPath::Harmonic(HarmonicMotion::of(axes, self.ramp)))
            }
        }
    }
}

/// A row of 4 numbers, or of 7 with the rotations.
#[derive(Debug, Clone, Default, PartialEq)]
struct TableRow(MotionRow);

impl Value for TableRow {
    fn kind() -> Kind {
        Kind::Numbers
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        let numbers: Vec<f64> = node.read()?;
        let count = numbers.len();
        if ![4, 7].contains(&count) {
            let expected = "an array of 4 numbers (t, x, y, z), or of 7 (with roll, pitch, yaw of a vessel)";
            let commas = decimal_commas(&numbers, &[4, 7]);
            return Err(node.expected_instead_of(expected, &format!("an array of {count}{commas}")));
        }
        self.0[..count].copy_from_slice(&numbers);
        Ok(())
    }

    fn write(&self) -> Option<Toml> {
        let width = if turning(&[self.0]) { 7 } else { 4 };
        self.0[..width].to_vec().write()
    }
}

impl Default for MotionPath {
    fn default() -> MotionPath {
        MotionPath::Harmonic(HarmonicMotion::default())
    }
}

impl Value for MotionPath {
    fn kind() -> Kind {
        Kind::Table(MotionText::SCHEMA)
    }

    fn read(&mut self, node: &Node<'_>) -> Result<(), SceneError> {
        if node.entries().is_none() {
            return Err(node.expected(
                "{ x = [[amplitude, period], …], z = …, ramp = … }, { table = [[t, x, y, z], …] } or { file = \"motion.csv\" }",
            ));
        }
        let text: MotionText = node.read()?;
        *self = text.path().map_err(|problem| node.refuse(problem))?;
        Ok(())
    }

    /// Rows that were read from a file are written instead of its path, so that the scene needs no other file.
    fn write(&self) -> Option<Toml> {
        let rows = match self {
            MotionPath::File(file) if file.rows.is_empty() => return Some(entry("file", file.file.clone())),
            MotionPath::File(MotionFile { rows, .. }) | MotionPath::Table(rows) => rows,
            MotionPath::Harmonic(harmonic) => {
                let axes = harmonic.axes().into_iter();
                let axes = axes.filter_map(|(name, sines)| Some((name.to_string(), sines.write()?)));
                let ramp = harmonic.ramp.map(|ramp| ("ramp".to_string(), Toml::Float(ramp)));
                let mut table: toml::Table = axes.chain(ramp).collect();
                if !table.keys().any(|key| key != "ramp") {
                    table.insert("x".into(), Toml::Array(Vec::new()));
                }
                return Some(Toml::Table(table));
            }
        };
        let rows: Vec<TableRow> = rows.iter().copied().map(TableRow).collect();
        Some(entry("table", rows.write()?))
    }

    fn check(&self, key: &Key, findings: &mut Findings) {
        match self {
            MotionPath::File(file) if file.rows.is_empty() => findings.say(
                "file",
                "a scene that comes as text cannot read files: write the rows as `table = [[t, x, y, z], …]`",
            ),
            MotionPath::File(file) => {
                let mut of_rows = Findings::default();
                check_rows(&mut of_rows, "", &file.rows);
                if let Some(SceneError { at, problem, .. }) = of_rows.mistakes.first() {
                    findings.say("file", format!("row {at} (from 0) of the file: {problem}"));
                }
            }
            MotionPath::Table(rows) => check_rows(findings, "table", rows),
            MotionPath::Harmonic(harmonic) => check_harmonic(findings, key, harmonic),
        }
    }

    fn in_words(&self, _: &Key) -> Option<String> {
        Some(motion_in_words(self))
    }
}

/// Displacements [m].
const DISPLACEMENT: Bounds = Bounds::Magnitude(1e7);
/// Rotations [rad]: many turns.
const ROTATION: Bounds = Bounds::Magnitude(1e4);

/// Bounds and units of the columns of a motion table; times are checked by their order.
const COLUMNS: [(Bounds, &str); 7] = [
    (Bounds::Elsewhere, "s"),
    (DISPLACEMENT, "m"),
    (DISPLACEMENT, "m"),
    (DISPLACEMENT, "m"),
    (ROTATION, "rad"),
    (ROTATION, "rad"),
    (ROTATION, "rad"),
];

/// Checks rows of time, displacement and rotation.
fn check_rows(findings: &mut Findings, at: &str, rows: &[MotionRow]) {
    check_times(findings, at, rows.iter().map(|row| row[0]), false);
    for (i, row) in rows.iter().enumerate() {
        findings.row(&format!("{at}[{i}]"), row, &COLUMNS);
    }
}

fn check_harmonic(findings: &mut Findings, key: &Key, harmonic: &HarmonicMotion) {
    for ((axis, sines), size) in harmonic.axes().into_iter().zip(&COLUMNS[1..]) {
        let (unit, period, phase) = (size.1, Bounds::Positive(1e9), Bounds::Magnitude(1e6));
        for (i, sine) in sines.iter().enumerate() {
            let (at, count) = (format!("{axis}[{i}]"), sine.len());
            let commas = decimal_commas(sine, &[2, 3]);
            rules! { findings, &at;
                "" if ![2, 3].contains(&count) =>
                    "expected [amplitude [{unit}], period [s]] or [amplitude, period, phase [rad]], found {count} numbers{commas}";
            }
            if [2, 3].contains(&count) {
                findings.row(&at, sine, &[*size, (period, "s"), (phase, "rad")]);
            }
        }
    }
    let text = MotionText {
        ramp: harmonic.ramp,
        ..MotionText::default()
    };
    text.check(key, findings);
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
    fn a_mean_over_a_span_is_that_of_many_samples_also_where_a_load_jumps() {
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
