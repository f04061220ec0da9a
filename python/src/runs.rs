//! Runs of scenes with their own motion: one, or many on all cores. The rows are those of `moorline run`.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use moorline::output::collect;
use moorline::output::record::{Column, Form, Frame};
use moorline::output::recorder::Recorder;
use moorline::output::times::Times;
use moorline::scene::{LoadedScene, Note, Threads};
use moorline::simulation::{Simulation, Watch};
use numpy::{PyArray1, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::aside::{Control, aside};
use crate::errors::Failure;
use crate::parameters;
use crate::scene::Scene;

/// Parts of a run to be stored.
#[derive(Debug, Clone, Default)]
struct Kept {
    /// Columns in addition to the time; `None` stores all.
    columns: Option<Vec<String>>,
    /// Interval of line shapes [s]; `None` stores no shapes.
    shapes: Option<f64>,
}

/// Rows of a run, column by column.
#[derive(Debug, Default)]
struct Rows {
    columns: Vec<(Column, Vec<f64>)>,
    /// Names of the lines and their shapes over time.
    shapes: Option<(Vec<String>, Vec<Frame>)>,
    notes: Vec<String>,
    substeps: u64,
    wall: Duration,
}

/// Run between two rows.
struct Run<'r> {
    loaded: &'r LoadedScene,
    times: Times,
    simulation: Simulation,
    recorder: Recorder,
    /// Indices of the stored columns in a row.
    kept: Vec<usize>,
    /// Number of rows from one shape to the next [-].
    stride: Option<usize>,
    watch: Watch,
    rows: Rows,
}

impl<'r> Run<'r> {
    fn start(loaded: &'r LoadedScene, kept: &Kept) -> Result<Run<'r>, Failure> {
        let scene = &loaded.scene;
        let fail = |error| Failure::of_simulation(error, loaded);
        let mut simulation = Simulation::new(scene).map_err(fail)?;
        simulation.follow_scene().map_err(fail)?;
        let recorder = Recorder::new(scene, simulation.model());
        let recorder = recorder.map_err(|mistake| Failure::of_scene(mistake, loaded))?;
        let all = recorder.columns();
        let places = match &kept.columns {
            None => (0..all.len()).collect(),
            Some(names) => places(all, names)?,
        };
        let times = Times::new(scene.output.duration, scene.output.interval);
        let stride = kept
            .shapes
            .map(|interval| (interval / times.interval).round().max(1.0) as usize);
        let lines = || {
            simulation
                .model()
                .lines
                .iter()
                .map(|line| line.name.clone())
                .collect()
        };
        let mut rows = Rows {
            columns: places
                .iter()
                .map(|&place| (all[place].clone(), Vec::new()))
                .collect(),
            shapes: stride.map(|_| (lines(), Vec::new())),
            notes: loaded.notes.iter().map(ToString::to_string).collect(),
            ..Rows::default()
        };
        let mut watch = Watch::new(scene, &simulation);
        rows.note(loaded, scene.without_host().into_iter().collect());
        rows.note(loaded, watch.look(&simulation));
        Ok(Run {
            loaded,
            times,
            simulation,
            recorder,
            kept: places,
            stride,
            watch,
            rows,
        })
    }

    fn steps(&mut self, control: &Control) -> Result<(), Failure> {
        let begun = Instant::now();
        self.add(0)?;
        for index in 1..=self.times.count {
            if control.stops() {
                return Err(Failure::Interrupted);
            }
            self.simulation.advance(self.times.step(index - 1))?;
            self.rows.substeps += self.simulation.substeps() as u64;
            self.add(index)?;
            let notes = self.watch.look(&self.simulation);
            self.rows.note(self.loaded, notes);
            control.step();
        }
        self.rows.wall = begun.elapsed();
        Ok(())
    }

    /// Adds a row with the current state.
    fn add(&mut self, index: usize) -> Result<(), Failure> {
        let now = self.times.at(index);
        let no_result = |problem| Failure::Result("the run".to_string(), problem);
        let row = self.recorder.row(&self.simulation, now).map_err(no_result)?;
        for ((_, values), &place) in self.rows.columns.iter_mut().zip(&self.kept) {
            values.push(row[place]);
        }
        let is_due = |stride: usize| index.is_multiple_of(stride) || index == self.times.count;
        if let (Some((_, frames)), true) = (&mut self.rows.shapes, self.stride.is_some_and(is_due)) {
            frames.push(collect::frame(&self.simulation, now));
        }
        Ok(())
    }
}

impl Rows {
    fn note(&mut self, loaded: &LoadedScene, notes: Vec<Note>) {
        let notes = notes.into_iter().map(|note| loaded.locate_note(note).to_string());
        self.notes.extend(notes);
    }

    /// Returns the table of `moorline.results`.
    fn table<'py>(self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let (columns, units, descriptions) = (PyDict::new(py), PyDict::new(py), PyDict::new(py));
        for (column, values) in self.columns {
            units.set_item(&column.name, &column.unit)?;
            descriptions.set_item(&column.name, &column.description)?;
            if column.form == Form::Whole && values.iter().all(|value| value.is_finite()) {
                let whole = values.iter().map(|&value| value as i64);
                columns.set_item(&column.name, PyArray1::from_iter(py, whole))?;
            } else {
                columns.set_item(&column.name, PyArray1::from_vec(py, values))?;
            }
        }
        let facts = PyDict::new(py);
        facts.set_item("units", units)?;
        facts.set_item("descriptions", descriptions)?;
        facts.set_item("notes", self.notes)?;
        facts.set_item("substeps", self.substeps)?;
        facts.set_item("wall", self.wall.as_secs_f64())?;
        let module = py.import("moorline.results")?;
        if let Some((names, frames)) = self.shapes {
            let time = frames.iter().map(|frame| frame.time);
            let time = PyArray1::from_iter(py, time);
            let lines = names.into_iter().enumerate().map(|(line, name)| {
                let (positions, tensions) = shapes_of(py, &frames, line)?;
                Ok((name, positions, tensions))
            });
            let lines = PyList::new(py, lines.collect::<PyResult<Vec<_>>>()?)?;
            facts.set_item("shapes", module.getattr("shapes")?.call1((time, lines))?)?;
        }
        module.getattr("Table")?.call((columns,), Some(&facts))
    }
}

type Shapes<'py> = (Bound<'py, PyArray3<f64>>, Bound<'py, numpy::PyArray2<f64>>);

/// Returns positions and tensions of the nodes of a line over time; nodes that a winch has not paid out are at the winch.
fn shapes_of<'py>(py: Python<'py>, frames: &[Frame], line: usize) -> PyResult<Shapes<'py>> {
    let nodes = frames
        .iter()
        .map(|frame| frame.lines[line].len())
        .max()
        .unwrap_or(0);
    let node = |frame: &Frame, node: usize| {
        let shape = &frame.lines[line];
        shape[node.min(shape.len() - 1)]
    };
    let all = || {
        frames
            .iter()
            .flat_map(|frame| (0..nodes).map(move |number| node(frame, number)))
    };
    let positions = PyArray1::from_iter(py, all().flat_map(|node| node.position));
    let tensions = PyArray1::from_iter(py, all().map(|node| node.tension));
    Ok((
        positions.reshape([frames.len(), nodes, 3])?,
        tensions.reshape([frames.len(), nodes])?,
    ))
}

/// Returns the indices of the named columns, after the index of the time.
fn places(all: &[Column], names: &[String]) -> Result<Vec<usize>, Failure> {
    let known = all.iter().map(|column| column.name.as_str());
    let place = |name: &String| {
        let place = all.iter().position(|column| column.name == *name);
        place.ok_or_else(|| parameters::unknown(name, "column", known.clone()))
    };
    let mut places = vec![0];
    for name in names {
        let place = place(name)?;
        if !places.contains(&place) {
            places.push(place);
        }
    }
    Ok(places)
}

/// Result of a run.
#[derive(Debug)]
struct Outcome {
    /// Rows up to the end; `None` if the run did not start.
    rows: Option<Rows>,
    failure: Option<Failure>,
}

impl Outcome {
    fn of_failure(failure: Failure) -> Outcome {
        Outcome {
            rows: None,
            failure: Some(failure),
        }
    }

    /// Returns the table, or an exception that contains the table up to the failure.
    fn into_python(self, py: Python<'_>) -> PyResult<Result<Bound<'_, PyAny>, PyErr>> {
        let table = self.rows.map(|rows| rows.table(py)).transpose()?;
        let table = table.unwrap_or_else(|| py.None().into_bound(py));
        let Some(failure) = self.failure else {
            return Ok(Ok(table));
        };
        let exception = failure.raised(py);
        exception.value(py).setattr("partial", table)?;
        Ok(Err(exception))
    }
}

/// Runs a scene.
fn run_one(loaded: &LoadedScene, kept: &Kept, control: &Control) -> Outcome {
    let mut run = match Run::start(loaded, kept) {
        Ok(run) => run,
        Err(failure) => return Outcome::of_failure(failure),
    };
    let failure = run.steps(control).err();
    Outcome {
        rows: Some(run.rows),
        failure,
    }
}

/// Number of steps of a run [-].
fn count(loaded: &LoadedScene) -> usize {
    let output = &loaded.scene.output;
    Times::new(output.duration, output.interval).count
}

/// Runs a scene with its motion: see `moorline.run`.
#[pyfunction]
#[pyo3(signature = (scene, *, columns=None, shapes=None, progress=None))]
pub(crate) fn run<'py>(
    py: Python<'py>,
    scene: &Scene,
    columns: Option<Vec<String>>,
    shapes: Option<f64>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let (scene, kept) = (scene.clone(), Kept { columns, shapes });
    let done = aside(py, progress, move |control| {
        control.expect(count(&scene.loaded));
        run_one(&scene.discretise(), &kept, control)
    })?;
    done.into_python(py)?
}

/// Runs scenes on several threads: see `moorline.batch`.
#[pyfunction]
#[pyo3(signature = (scenes, *, columns=None, shapes=None, threads=None, progress=None))]
pub(crate) fn batch<'py>(
    py: Python<'py>,
    scenes: Vec<PyRef<'py, Scene>>,
    columns: Option<Vec<String>>,
    shapes: Option<f64>,
    threads: Option<usize>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyList>> {
    let scenes: Vec<Scene> = scenes.iter().map(|scene| (**scene).clone()).collect();
    let threads = match threads {
        Some(0) => {
            return Err(
                Failure::of_argument("threads", "0 threads run nothing: at least 1 is needed").into(),
            );
        }
        Some(threads) => threads,
        None => thread::available_parallelism().map_or(1, usize::from),
    };
    let kept = Kept { columns, shapes };
    let done = aside(py, progress, move |control| {
        run_all(&scenes, &kept, threads, control)
    })?;
    let list = PyList::empty(py);
    for one in done {
        match one.into_python(py)? {
            Ok(table) => list.append(table)?,
            Err(exception) => list.append(exception.value(py))?,
        }
    }
    Ok(list)
}

/// Runs all scenes and returns the results in the same order: an idle thread takes the next scene.
fn run_all(scenes: &[Scene], kept: &Kept, threads: usize, control: &Control) -> Vec<Outcome> {
    let next = AtomicUsize::new(0);
    let done: Vec<Mutex<Option<Outcome>>> = scenes.iter().map(|_| Mutex::default()).collect();
    scenes
        .iter()
        .for_each(|scene| control.expect(count(&scene.loaded)));
    thread::scope(|scope| {
        let work = || {
            loop {
                let place = next.fetch_add(1, Ordering::Relaxed);
                let Some(scene) = scenes.get(place) else { break };
                let outcome = match control.stops() {
                    true => Outcome::of_failure(Failure::Interrupted),
                    false => run_one(&alone(scene.discretise()), kept, control),
                };
                *done[place].lock().unwrap_or_else(PoisonError::into_inner) = Some(outcome);
            }
        };
        for _ in 0..threads.min(scenes.len()) {
            scope.spawn(work);
        }
    });
    let taken = done
        .into_iter()
        .map(|one| one.into_inner().unwrap_or_else(PoisonError::into_inner));
    taken
        .map(|one| one.unwrap_or_else(|| Outcome::of_failure(Failure::Interrupted)))
        .collect()
}

/// Returns the scene set to one thread, since the cores are shared among the scenes. Results do not depend on it.
fn alone(loaded: Arc<LoadedScene>) -> Arc<LoadedScene> {
    let mut alone = (*loaded).clone();
    alone.scene.solver.threads = Threads::Number(1);
    Arc::new(alone)
}
