//! Functions of time: loads and motions.

use super::{Bounds, Findings, quantity};
use crate::scene::{HarmonicMotion, MotionPath, MotionRow, TimeFunction};

/// Times of tables and steps, in seconds: thirty years.
const TIME: Bounds = Bounds::Magnitude(1e9);

/// Displacements, in metres.
const DISPLACEMENT: Bounds = Bounds::Magnitude(1e7);

/// Rotations, in radians: many turns.
const ROTATION: Bounds = Bounds::Magnitude(1e4);

/// What acts on a point.
#[derive(Clone, Copy)]
pub(super) struct Load {
    unit: &'static str,
    /// "force along", "moment about".
    pub(super) preposition: &'static str,
}

impl Load {
    pub(super) const FORCE: Load = Load {
        unit: "N",
        preposition: "force along",
    };
    pub(super) const FACTOR: Load = Load {
        unit: "-",
        preposition: "factor of",
    };
    pub(super) const LENGTH: Load = Load {
        unit: "m",
        preposition: "length paid out at",
    };
    pub(super) const MOMENT: Load = Load {
        unit: "N m",
        preposition: "moment about",
    };
}

/// Checks a load.
pub(super) fn check_load_in_time(findings: &mut Findings, at: &str, function: &TimeFunction, load: Load) {
    let (force, unit) = (Bounds::Magnitude(1e15), load.unit);
    match function {
        TimeFunction::Constant(value) => {
            findings.number(at, *value, force, unit);
        }
        TimeFunction::Step(numbers) => check_rise(findings, &format!("{at}.step"), *numbers, unit),
        TimeFunction::Ramp(numbers) => check_rise(findings, &format!("{at}.ramp"), *numbers, unit),
        TimeFunction::Table(pairs) => {
            let at = format!("{at}.table");
            check_times(findings, &at, pairs.iter().map(|pair| pair[0]), true);
            for (row, pair) in pairs.iter().enumerate() {
                findings.number(format!("{at}[{row}][1]"), pair[1], force, unit);
            }
        }
    }
}

/// `[t0, f0, t1, f1]` of a step or ramp.
fn check_rise(findings: &mut Findings, at: &str, [t0, f0, t1, f1]: [f64; 4], unit: &str) {
    let force = Bounds::Magnitude(1e15);
    let mut right = findings.number(format!("{at}[0]"), t0, TIME, "s");
    right &= findings.number(format!("{at}[2]"), t1, TIME, "s");
    findings.number(format!("{at}[1]"), f0, force, unit);
    findings.number(format!("{at}[3]"), f1, force, unit);
    if right && t1 <= t0 {
        let problem = format!(
            "it ends at {}, not after its start at {}: write [t0, f0, t1, f1] with t1 > t0",
            quantity(t1, "s"),
            quantity(t0, "s")
        );
        findings.say(at, problem);
    }
}

/// The first column of a table; where it may jump, two rows may share a time.
fn check_times(findings: &mut Findings, at: &str, times: impl Iterator<Item = f64>, jumps: bool) {
    let mut last: Option<f64> = None;
    for (row, time) in times.enumerate() {
        let here = format!("{at}[{row}][0]");
        if !findings.number(here.clone(), time, TIME, "s") {
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
            return findings.say(here, problem);
        }
        last = Some(time);
    }
    if last.is_none() {
        findings.say(at, "the table has no rows");
    }
}

/// Checks a motion.
pub(super) fn check_motion(findings: &mut Findings, at: &str, motion: &MotionPath) {
    match motion {
        MotionPath::File(file) if file.rows.is_empty() => findings.say(
            format!("{at}.file"),
            "a scene that comes as text cannot read files: write the rows as `table = [[t, x, y, z], …]`",
        ),
        MotionPath::File(file) => check_rows(findings, &format!("{at}.file"), &file.rows, false),
        MotionPath::Table(rows) => check_rows(findings, &format!("{at}.table"), rows, true),
        MotionPath::Harmonic(harmonic) => check_harmonic(findings, at, harmonic),
    }
}

/// Rows of time, displacement and rotation; `in_scene` where the key path can name the row.
fn check_rows(findings: &mut Findings, at: &str, rows: &[MotionRow], in_scene: bool) {
    let mut of_rows = Findings::default();
    check_times(&mut of_rows, at, rows.iter().map(|row| row[0]), false);
    for (i, row) in rows.iter().enumerate() {
        for (column, value) in row.iter().enumerate().skip(1) {
            let (bounds, unit) = if column < 4 {
                (DISPLACEMENT, "m")
            } else {
                (ROTATION, "rad")
            };
            of_rows.number(format!("{at}[{i}][{column}]"), *value, bounds, unit);
        }
    }
    if in_scene {
        findings.mistakes.append(&mut of_rows.mistakes);
    } else if let Some(first) = of_rows.mistakes.first() {
        let row = first.at.strip_prefix(at).unwrap_or_default();
        findings.say(at, format!("row {row} (from 0) of the file: {}", first.problem));
    }
}

fn check_harmonic(findings: &mut Findings, at: &str, harmonic: &HarmonicMotion) {
    for (number, (axis, components)) in harmonic.axes().into_iter().enumerate() {
        let (size, unit) = if number < 3 {
            (DISPLACEMENT, "m")
        } else {
            (ROTATION, "rad")
        };
        for (i, component) in components.iter().enumerate() {
            let at = format!("{at}.{axis}[{i}]");
            let (2 | 3) = component.len() else {
                let problem = format!(
                    "expected [amplitude [{unit}], period [s]] or [amplitude, period, phase [rad]], found {} numbers",
                    component.len()
                );
                findings.say(at, problem);
                continue;
            };
            findings.number(format!("{at}[0]"), component[0], size, unit);
            findings.number(format!("{at}[1]"), component[1], Bounds::Positive(1e9), "s");
            if let Some(phase) = component.get(2) {
                findings.number(format!("{at}[2]"), *phase, Bounds::Magnitude(1e6), "rad");
            }
        }
    }
    let ramp = Bounds::Positive(1e9);
    findings.number_if(format!("{at}.ramp"), harmonic.ramp, ramp, "s");
}
