//! Runs one case, from its input to its row.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use moorline::output::OutputError;
use moorline::output::record::Column;
use moorline::output::recorder::Recorder;
use moorline::output::table::WholeTable;
use moorline::output::times::Times;
use moorline::output::trace::RangeSum;
use moorline::scene::{Format, Scene};
use moorline::simulation::{Simulation, Watch};

use crate::case::Case;
use crate::kind::on_one_thread;
use crate::row::{Quantity, Results, Row};

/// Folder of the series of all cases, within the folder of the sweep.
pub const SERIES: &str = "series";

/// A case that was run.
#[derive(Debug)]
pub(crate) struct Done {
    pub row: Row,
    /// Time spent in steps of the simulation.
    pub stepping: Duration,
}

/// End of a case without results.
enum Ended {
    /// It was stopped.
    Stopped,
    /// It failed, with the reason.
    Failed(String),
    /// Its series could not be written.
    Unwritten(OutputError),
}

impl From<OutputError> for Ended {
    fn from(error: OutputError) -> Self {
        Ended::Unwritten(error)
    }
}

fn failed(error: impl ToString) -> Ended {
    Ended::Failed(error.to_string())
}

/// Runs a case. If it fails, the row holds the reason. The row depends only on the case, to the last bit.
pub fn run_case(case: &Case) -> Row {
    let done = run(case, None, &|| false).ok().flatten();
    done.expect("a case that nothing stops ends, and it writes nothing")
        .row
}

/// Runs a case as [`run_case`], and writes all results in time into the folder `series`, if given; `None` if `stops` returns true.
///
/// # Errors
/// The series cannot be written.
pub fn run_case_until(
    case: &Case,
    series: Option<&Path>,
    stops: &dyn Fn() -> bool,
) -> Result<Option<Row>, OutputError> {
    Ok(run(case, series, stops)?.map(|done| done.row))
}

/// Runs a case as [`run_case_until`], and measures the time of its steps.
pub(crate) fn run(
    case: &Case,
    series: Option<&Path>,
    stops: &dyn Fn() -> bool,
) -> Result<Option<Done>, OutputError> {
    let mut notes = Vec::new();
    let mut stepping = Duration::ZERO;
    let mut work = || -> Result<Results, Ended> {
        let scene = on_one_thread(case.scene().map_err(failed)?);
        notes.extend_from_slice(case.kind.notes());
        let mut run = Run::start(case, &scene, series)?;
        let done = run.finish(stops);
        notes.append(&mut run.notes);
        stepping = run.stepping;
        done?;
        run.results()
    };
    // a panic in one case must not end the others
    let results = catch_unwind(AssertUnwindSafe(&mut work));
    let results = match results.unwrap_or_else(|panic| Err(Ended::Failed(bug(panic.as_ref())))) {
        Ok(results) => Ok(results),
        Err(Ended::Failed(reason)) => Err(reason),
        Err(Ended::Stopped) => return Ok(None),
        Err(Ended::Unwritten(error)) => return Err(error),
    };
    let row = Row::of(case, results, notes);
    Ok(Some(Done { row, stepping }))
}

fn bug(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or(panic.downcast_ref::<&str>().copied());
    format!(
        "a mistake in moorline, please report it: {}",
        text.unwrap_or("without a message")
    )
}

/// State of a case between two rows of its results.
struct Run {
    from: f64,
    times: Times,
    simulation: Simulation,
    recorder: Recorder,
    /// Indices of the outputs in a row.
    places: Vec<usize>,
    sums: Vec<RangeSum>,
    table: Option<WholeTable>,
    watch: Watch,
    notes: Vec<String>,
    stepping: Duration,
}

impl Run {
    fn start(case: &Case, scene: &Scene, series: Option<&Path>) -> Result<Run, Ended> {
        let mut simulation = Simulation::new(scene).map_err(failed)?;
        simulation.follow_scene().map_err(failed)?;
        let outputs = Recorder::of_outputs(scene, simulation.model()).map_err(failed)?;
        // series also contain inputs and the wave elevation
        let recorder = match series {
            Some(_) => Recorder::new(scene, simulation.model()).map_err(failed)?,
            None => outputs.clone(),
        };
        let columns = recorder.columns();
        let place = |output: &Column| columns.iter().position(|column| column.name == output.name);
        let places = outputs.columns()[1..].iter().filter_map(place).collect();
        let table = series.map(|folder| {
            let format = scene.output.format.unwrap_or(Format::Parquet);
            let ending = if format == Format::Csv { "csv" } else { "parquet" };
            let path = folder.join(format!("case-{:06}.{ending}", case.number));
            WholeTable::create(&path, format, columns, scene.output.digits)
        });
        let mut run = Run {
            from: case.from,
            times: Times::new(scene.output.duration, scene.output.interval),
            watch: Watch::new(scene, &simulation),
            simulation,
            recorder,
            places,
            sums: Vec::new(),
            table: table.transpose()?,
            notes: Vec::new(),
            stepping: Duration::ZERO,
        };
        run.row(0)?;
        Ok(run)
    }

    /// Steps to the end.
    fn finish(&mut self, stops: &dyn Fn() -> bool) -> Result<(), Ended> {
        for index in 1..=self.times.count {
            if stops() {
                return Err(Ended::Stopped);
            }
            let before = Instant::now();
            let stepped = self.simulation.advance(self.times.step(index - 1));
            self.stepping += before.elapsed();
            stepped.map_err(failed)?;
            self.row(index)?;
        }
        Ok(())
    }

    /// Adds the values of the present state to the statistics and the series.
    fn row(&mut self, index: usize) -> Result<(), Ended> {
        let time = self.times.at(index);
        let notes = self.watch.look(&self.simulation);
        self.notes.extend(notes.iter().map(ToString::to_string));
        let counts = time >= self.from * (1.0 - 1e-12);
        if !counts && self.table.is_none() {
            return Ok(());
        }
        let row = self.recorder.row(&self.simulation, time).map_err(failed)?;
        if let Some(table) = &mut self.table {
            table.row(row)?;
        }
        let values = self.places.iter().map(|&place| [time, row[place]]);
        if counts && self.sums.is_empty() {
            self.sums = values.map(RangeSum::new).collect();
        } else if counts {
            self.sums
                .iter_mut()
                .zip(values)
                .for_each(|(sum, value)| sum.add(value));
        }
        Ok(())
    }

    /// Returns the statistics; the file of the series gets its final name.
    fn results(mut self) -> Result<Results, Ended> {
        if let Some(table) = self.table.take() {
            table.finish()?;
        }
        let quantities = self.places.iter().map(|&place| {
            let Column { name, unit, .. } = self.recorder.columns()[place].clone();
            Quantity { name, unit }
        });
        let figures = self.sums.iter().map(|sum| {
            let range = sum.range();
            [range.mean, range.deviation, range.min, range.max]
        });
        Ok(Results {
            quantities: Arc::new(quantities.collect()),
            figures: figures.collect(),
        })
    }
}
