//! Load cases: all of them on this machine, or one by one for another scheduler.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use moorline::output::OutputError;
use moorline::output::folder::ResultsFolder;
use moorline::output::record::{Column, Form};
use moorline_decks::Supplement;
use moorline_sweep::{
    Base, Case, Row, SERIES, SweepError, cases, fingerprint, remarks, run_case_until, shortfalls, table,
};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::aside::aside;
use crate::errors::Failure;

/// The cases of a sweep, and its folder once opened.
#[pyclass(frozen, module = "moorline._moorline")]
#[derive(Debug)]
pub(crate) struct Sweep {
    cases: Arc<[Case]>,
    notes: Vec<String>,
    sweep: Mutex<Option<moorline_sweep::Sweep>>,
}

/// Text of a note on a case.
fn of_case(case: &Case, note: impl std::fmt::Display) -> String {
    format!("case {}: {note}", case.number)
}

fn of_output(error: OutputError) -> Failure {
    Failure::Output("output".to_string(), error.to_string())
}

fn of_sweep(error: SweepError) -> Failure {
    match error {
        SweepError::Output(error) => of_output(error),
        error => Failure::of_argument("output", error.to_string()),
    }
}

impl Sweep {
    fn lock(&self) -> MutexGuard<'_, Option<moorline_sweep::Sweep>> {
        self.sweep.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Calls a function with the open sweep.
    fn opened<T>(
        &self,
        act: impl FnOnce(&mut moorline_sweep::Sweep) -> Result<T, SweepError>,
    ) -> Result<T, Failure> {
        let mut sweep = self.lock();
        let sweep = sweep.as_mut().ok_or_else(|| {
            Failure::of_argument("output", "the sweep is not open: `open` opens its folder")
        })?;
        act(sweep).map_err(of_sweep)
    }
}

#[pymethods]
impl Sweep {
    /// Reads and checks the cases of a file with a base. `start` is the time from which results count [s]; None is the end of the ramps.
    #[new]
    #[pyo3(signature = (base, cases, start=None))]
    fn read(py: Python<'_>, base: PathBuf, cases: PathBuf, start: Option<f64>) -> PyResult<Sweep> {
        if let Some(start) = start.filter(|start| !(start.is_finite() && *start >= 0.0)) {
            return Err(Failure::of_argument("start", format!("{start} s is no time of a run")).into());
        }
        let read = aside(py, None, move |_| -> Result<_, Failure> {
            let base = Base::load(&base, &Supplement::default())?;
            let mut notes: Vec<String> = base.notes().iter().map(ToString::to_string).collect();
            let cases = self::cases(&base, &cases, start)?;
            let of_cases = remarks(&cases).into_iter();
            notes.extend(of_cases.map(|(case, note)| of_case(case, note)));
            Ok((notes, cases))
        })?;
        let (notes, cases) = read?;
        Ok(Sweep {
            cases,
            notes,
            sweep: Mutex::new(None),
        })
    }

    /// Returns the number of cases.
    fn __len__(&self) -> usize {
        self.cases.len()
    }

    /// Returns the fingerprint of the cases and of all files that they refer to.
    fn fingerprint(&self) -> PyResult<String> {
        let sum = fingerprint(&self.cases).map_err(of_output)?;
        Ok(sum.iter().map(|byte| format!("{byte:02x}")).collect())
    }

    /// Opens the folder of the sweep and returns the numbers of the cases that have not been completed there.
    #[pyo3(signature = (folder, series=false))]
    fn open(&self, folder: PathBuf, series: bool) -> PyResult<Vec<usize>> {
        let folder = ResultsFolder::open(&folder).map_err(of_output)?;
        let sweep = moorline_sweep::Sweep::open(&self.cases, folder, series).map_err(of_sweep)?;
        let left = sweep.left();
        *self.lock() = Some(sweep);
        Ok(left)
    }

    /// Closes the folder.
    fn close(&self, py: Python<'_>) {
        py.detach(|| *self.lock() = None); // after the end of a run that was abandoned
    }

    /// Runs a case by its number and returns its row as bytes. `folder` is the folder of a sweep that stores time series.
    #[pyo3(signature = (number, folder=None))]
    fn run_case<'py>(
        &self,
        py: Python<'py>,
        number: usize,
        folder: Option<PathBuf>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let case = number.checked_sub(1).and_then(|index| self.cases.get(index));
        let case = case.cloned().ok_or_else(|| {
            Failure::of_argument(
                "number",
                format!("there is no case {number} of {}", self.cases.len()),
            )
        })?;
        let series = folder.map(|folder| folder.join(SERIES));
        let row = aside(py, None, move |control| {
            run_case_until(&case, series.as_deref(), &|| control.stops())
        })?;
        let row = row.map_err(of_output)?.ok_or(Failure::Interrupted)?;
        Ok(PyBytes::new(py, &row.to_bytes()))
    }

    /// Adds the row of a case that was run elsewhere.
    fn add(&self, row: &[u8]) -> PyResult<()> {
        let row = Row::of_bytes(row, &self.cases);
        let row = row.ok_or_else(|| Failure::of_argument("row", "these bytes are no row of this sweep"))?;
        Ok(self.opened(|sweep| sweep.add(row))?)
    }

    /// Runs the remaining cases on all cores and writes the table. Ctrl-C stops the sweep and leaves the table of the completed cases.
    #[pyo3(signature = (progress=None))]
    fn run(slf: Bound<'_, Self>, progress: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let py = slf.py();
        let own = slf.unbind();
        let done = aside(py, progress, move |control| {
            own.get().opened(|sweep| {
                control.expect(sweep.left().len());
                sweep.run(&|| control.stops(), &|_, _| control.step())
            })
        })?;
        done?;
        Ok(())
    }

    /// Writes the table of the completed cases and returns it.
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let table = self.opened(|sweep| {
            sweep.write_table()?;
            Ok(table(sweep.rows()))
        })?;
        let (columns, units, descriptions) = (PyDict::new(py), PyDict::new(py), PyDict::new(py));
        for (place, column) in table.columns.iter().enumerate() {
            let values = table.rows.iter().map(|row| row[place]);
            units.set_item(&column.name, &column.unit)?;
            descriptions.set_item(&column.name, &column.description)?;
            columns.set_item(&column.name, array(py, column, values)?)?;
        }
        let facts = PyDict::new(py);
        facts.set_item("units", units)?;
        facts.set_item("descriptions", descriptions)?;
        let of_meshes = shortfalls(&self.cases);
        let of_meshes = of_meshes.into_iter().map(|(case, note)| of_case(case, note));
        facts.set_item(
            "notes",
            self.notes.iter().cloned().chain(of_meshes).collect::<Vec<_>>(),
        )?;
        py.import("moorline.results")?
            .getattr("Table")?
            .call((columns,), Some(&facts))
    }
}

/// Returns the values of a column as a numpy array.
fn array<'py>(
    py: Python<'py>,
    column: &Column,
    values: impl Iterator<Item = f64>,
) -> PyResult<Bound<'py, PyAny>> {
    Ok(match &column.form {
        Form::Whole => PyArray1::from_iter(py, values.map(|value| value as i64)).into_any(),
        Form::Name(names) => {
            let texts: Vec<&str> = values.map(|place| names[place as usize].as_str()).collect();
            py.import("numpy")?.getattr("array")?.call1((texts, "object"))?
        }
        Form::Real | Form::Exact | Form::Sparse => PyArray1::from_iter(py, values).into_any(),
    })
}
