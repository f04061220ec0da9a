//! Replay of the reference results in an FMU, according to the layered standard FMI-LS-REF.

use std::path::Path;

use moorline::output::package::EXPERIMENTS_FILE;
use quick_xml::events::{BytesStart, Event};

use crate::description::{attribute, broken, number, required};
use crate::{Fmu, HostError, Slave, VariableType};

/// Greatest deviation from the reference results.
#[derive(Debug, Clone, PartialEq)]
pub struct Deviation {
    /// The variable.
    pub variable: String,
    /// Time [s].
    pub time: f64,
    /// Deviation relative to the greatest magnitude of the variable in the reference [-].
    pub relative: f64,
}

/// Result of a replayed experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// Number of steps made [-].
    pub steps: usize,
    /// End of the experiment [s].
    pub end: f64,
    /// Number of variables compared [-].
    pub variables: usize,
    /// Greatest relative deviation that the experiment allows [-].
    pub tolerance: f64,
    /// Greatest deviation found; `None` if nothing deviates.
    pub greatest: Option<Deviation>,
}

impl Replay {
    /// Returns whether all results are within the tolerance.
    pub fn agrees(&self) -> bool {
        let greatest = self.greatest.as_ref();
        greatest.is_none_or(|greatest| greatest.relative <= self.tolerance)
    }
}

/// Replays the first experiment of an FMU: the stimuli at t are set before the step from t to the next row of the references.
///
/// # Errors
/// The FMU has no experiment, or the experiment cannot be read or run.
pub fn replay(fmu: &Fmu) -> Result<Replay, HostError> {
    let file = fmu.folder().join(EXPERIMENTS_FILE);
    let experiment = Experiment::read(&file)?;
    let folder = file.parent().unwrap_or(fmu.folder());
    let stimuli = Table::read(&folder.join(&experiment.stimuli))?;
    let references = Table::read(&folder.join(&experiment.references))?;
    let inputs: Vec<u32> = stimuli
        .names
        .iter()
        .map(|name| fmu.reference(name))
        .collect::<Result<_, _>>()?;
    let times = references.rows.iter().map(|row| row[0]);
    if !times.eq(stimuli.rows.iter().map(|row| row[0])) {
        return Err(refuse(&file, "stimuli and references have different times"));
    }
    let mut slave = fmu.instantiate("replay", true)?;
    let mut compared = Compared::new(&references);
    for (index, (given, expected)) in stimuli.rows.iter().zip(&references.rows).enumerate() {
        match index.checked_sub(1).map(|before| references.rows[before][0]) {
            None => {
                slave.enter_initialization(given[0], None)?;
                slave.set_real(&inputs, &given[1..])?;
                slave.exit_initialization()?;
            }
            Some(before) => {
                slave.do_step(before, experiment.step_between(before, expected[0]))?;
            }
        }
        compared.row(&mut slave, expected)?;
        slave.set_real(&inputs, &given[1..])?;
    }
    slave.terminate()?;
    Ok(Replay {
        steps: references.rows.len().saturating_sub(1),
        end: references.rows.last().map_or(0.0, |row| row[0]),
        variables: references.names.len(),
        tolerance: experiment.tolerance,
        greatest: compared.greatest,
    })
}

fn refuse(file: &Path, problem: impl std::fmt::Display) -> HostError {
    HostError::Reference(format!("{}: {problem}", file.display()))
}

/// Row-by-row comparison with the references.
struct Compared<'r> {
    names: &'r [String],
    /// Greatest magnitude of each variable in the references.
    scales: Vec<f64>,
    greatest: Option<Deviation>,
}

impl<'r> Compared<'r> {
    fn new(references: &'r Table) -> Self {
        let scale = |column: usize| {
            let values = references.rows.iter().map(|row| row[column + 1].abs());
            values.fold(0.0, f64::max)
        };
        Compared {
            names: &references.names,
            scales: (0..references.names.len()).map(scale).collect(),
            greatest: None,
        }
    }

    /// Reads all variables and compares them with a row of the references.
    fn row(&mut self, slave: &mut Slave, expected: &[f64]) -> Result<(), HostError> {
        for ((name, scale), expected_value) in self.names.iter().zip(&self.scales).zip(&expected[1..]) {
            let found = match slave.fmu().variable(name)?.kind {
                VariableType::Integer => f64::from(slave.integer(name)?),
                _ => slave.real(name)?,
            };
            let deviation = (found - expected_value).abs();
            let relative = if *scale > 0.0 {
                deviation / scale
            } else {
                deviation
            };
            let before = self.greatest.as_ref().map_or(0.0, |greatest| greatest.relative);
            if relative > before || relative.is_nan() {
                self.greatest = Some(Deviation {
                    variable: name.clone(),
                    time: expected[0],
                    relative,
                });
            }
        }
        Ok(())
    }
}

/// Experiment of the layered standard.
struct Experiment {
    stimuli: String,
    references: String,
    tolerance: f64,
    /// Communication step [s].
    step: Option<f64>,
}

/// Greatest difference between a step of the table and the step of the experiment that is attributed to rounding, relative to the step [-].
const ROUNDING: f64 = 1e-6;

impl Experiment {
    /// Returns the step between two times [s]: the step of the experiment if it matches, otherwise the difference (a shorter last step).
    fn step_between(&self, start: f64, end: f64) -> f64 {
        let step = end - start;
        let same = self.step.filter(|same| (same - step).abs() < ROUNDING * step);
        same.unwrap_or(step)
    }

    fn read(file: &Path) -> Result<Experiment, HostError> {
        let text = std::fs::read_to_string(file).map_err(|error| {
            refuse(
                Path::new(EXPERIMENTS_FILE),
                format!("the FMU has no such file: {error}"),
            )
        })?;
        let mut reader = quick_xml::Reader::from_str(&text);
        let (mut stimuli, mut references, mut tolerance, mut step) = (None, None, None, None);
        loop {
            match reader.read_event().map_err(broken)? {
                Event::Start(tag) | Event::Empty(tag) => match tag.name().as_ref() {
                    "Experiment" => {
                        (tolerance, step) = (number(&tag, "tolerance")?, number(&tag, "stepSize")?)
                    }
                    "Stimuli" => stimuli = Some(table_of(&tag)?),
                    "References" => references = Some(table_of(&tag)?),
                    _ => {}
                },
                // the end of the first experiment
                Event::End(tag) if tag.name().as_ref() == "Experiment" => break,
                Event::Eof => break,
                _ => {}
            }
        }
        let missing = |name: &str| refuse(file, format!("the experiment has no {name}"));
        Ok(Experiment {
            stimuli: stimuli.ok_or_else(|| missing("Stimuli"))?,
            references: references.ok_or_else(|| missing("References"))?,
            tolerance: tolerance.ok_or_else(|| missing("tolerance"))?,
            step,
        })
    }
}

/// Returns the file name of the table that an element refers to.
fn table_of(tag: &BytesStart<'_>) -> Result<String, HostError> {
    let source = required(tag, "source")?;
    match attribute(tag, "type")?.as_deref() {
        None | Some("text/csv") => Ok(source),
        Some(other) => Err(HostError::Reference(format!(
            "{source} is of type {other}, not text/csv"
        ))),
    }
}

/// Table of numbers against time.
struct Table {
    /// Names of the columns after the time.
    names: Vec<String>,
    /// Time [s] and values.
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn read(file: &Path) -> Result<Table, HostError> {
        let mut reader = csv::Reader::from_path(file).map_err(|error| refuse(file, error))?;
        let names = reader.headers().map_err(|error| refuse(file, error))?;
        let names = names.iter().skip(1).map(str::to_string).collect();
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|error| refuse(file, error))?;
            let numbers = record.iter().map(|text| {
                let number = text.parse::<f64>();
                number.map_err(|_| refuse(file, format!("\"{text}\" is not a number")))
            });
            let row: Vec<f64> = numbers.collect::<Result<_, _>>()?;
            if row.is_empty() {
                return Err(refuse(file, "a row is empty"));
            }
            rows.push(row);
        }
        Ok(Table { names, rows })
    }
}
