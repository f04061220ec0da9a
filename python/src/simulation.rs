//! Simulation stepped from Python, and its saved state.

use std::collections::HashMap;
use std::ffi::CString;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use moorline::interface::{Binding, Causality, Interface, Kind, Layout, NoValue, Variable};
use moorline::model::{Body, End, Model};
use moorline::output::sealed::{self, Unreadable};
use moorline::scene::{LoadedScene, Note};
use moorline::simulation::{self, Inputs, NO_FLOW, Simulation as Mooring, Watch};
use nalgebra::Vector3;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::aside::aside;
use crate::errors::Failure;
use crate::parameters;
use crate::scene::Scene;

/// Time [s] and inputs of the static solution. Quantities derived from it, such as step limits, are not part of a snapshot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Start {
    time: f64,
    given: Inputs,
}

/// Solves the static equilibrium of a start, always from the same initial guess.
fn begin(loaded: &LoadedScene, start: &Start) -> Result<Mooring, Failure> {
    let fail = |error: simulation::Error| Failure::of_simulation(error, loaded);
    let mut mooring = Mooring::new(&loaded.scene).map_err(fail)?;
    mooring.set_inputs(&start.given);
    mooring.restart(start.time).map_err(fail)?;
    Ok(mooring)
}

const MARK: &[u8] = concat!("moorline python 2 ", env!("CARGO_PKG_VERSION"), "\n").as_bytes();
/// Length of a check sum [bytes].
const SUM: usize = 32;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Saved {
    /// SHA-256 of the scene.
    scene: [u8; SUM],
    start: Start,
    given: Inputs,
    snapshot: simulation::Snapshot,
}

/// Saved state: everything that changes in a simulation.
#[pyclass(frozen, module = "moorline")]
#[derive(Debug, Clone)]
pub(crate) struct State(Arc<Saved>);

#[pymethods]
impl State {
    /// Returns the state as bytes, which only this version of moorline reads.
    fn to_bytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &sealed::seal(MARK, &*self.0))
    }

    /// Reads bytes written by `to_bytes`.
    #[staticmethod]
    fn from_bytes(data: &[u8]) -> PyResult<State> {
        let saved = sealed::open(MARK, data).map_err(|reason| {
            let problem = match reason {
                Unreadable::Mark => "no state that this version of moorline has saved",
                Unreadable::Damaged => "the saved state is cut short or changed",
            };
            Failure::of_argument("data", problem)
        })?;
        Ok(State(Arc::new(saved)))
    }

    /// Supports pickle.
    fn __reduce__<'py>(slf: &Bound<'py, State>) -> PyResult<(Py<PyAny>, (Bound<'py, PyBytes>,))> {
        let read = slf.get_type().getattr("from_bytes")?;
        Ok((read.unbind(), (slf.get().to_bytes(slf.py()),)))
    }
}

/// Constant part of a simulation.
#[derive(Debug)]
struct Table {
    loaded: Arc<LoadedScene>,
    interface: Interface,
    rows: HashMap<String, usize>,
    /// Rows of the inputs, in the order of an input array.
    inputs: Vec<usize>,
    /// Rows of the outputs, in the order of an output array.
    outputs: Vec<usize>,
    /// SHA-256 of the scene.
    sum: [u8; SUM],
}

impl Table {
    fn new(loaded: Arc<LoadedScene>, model: &Model, velocities: bool) -> Result<Table, Failure> {
        let interface = Interface::new(&loaded.scene, model, Layout::Scalars);
        let interface = interface.map_err(|mistake| Failure::of_scene(mistake, &loaded))?;
        let rows = |wanted: &dyn Fn(&Variable) -> bool| {
            let rows = interface.variables().iter().enumerate();
            rows.filter(|(_, variable)| wanted(variable))
                .map(|(row, _)| row)
                .collect::<Vec<_>>()
        };
        let is_input = |variable: &Variable| match variable.binding {
            Binding::Velocity { .. } => velocities,
            Binding::Flow { .. } => false, // set by `set_flow`
            _ => variable.causality == Causality::Input,
        };
        let names = interface.variables().iter().enumerate();
        Ok(Table {
            sum: Sha256::digest(loaded.scene.to_toml()).into(),
            rows: names
                .map(|(row, variable)| (variable.name.clone(), row))
                .collect(),
            inputs: rows(&is_input),
            outputs: rows(&|variable| variable.causality == Causality::Output),
            interface,
            loaded,
        })
    }

    fn variable(&self, row: usize) -> &Variable {
        &self.interface.variables()[row]
    }

    fn names(&self, rows: &[usize]) -> Vec<&str> {
        rows.iter().map(|&row| self.variable(row).name.as_str()).collect()
    }

    /// Returns the input with a name.
    fn input(&self, name: &str) -> Result<&Variable, Failure> {
        let variable = self.rows.get(name).map(|&row| self.variable(row));
        let is_input = |variable: &&Variable| variable.causality == Causality::Input;
        variable.filter(is_input).ok_or_else(|| match variable {
            Some(_) => Failure::of_argument(
                name,
                "no input: outputs follow from a step, and parameters belong to the scene",
            ),
            None => {
                let inputs = self.interface.variables().iter().filter(is_input);
                parameters::unknown(name, "input", inputs.map(|variable| variable.name.as_str()))
            }
        })
    }

    /// Returns the variable with a name.
    fn named(&self, name: &str) -> Result<&Variable, Failure> {
        let row = self.rows.get(name).map(|&row| self.variable(row));
        let names = || {
            self.interface
                .variables()
                .iter()
                .map(|variable| variable.name.as_str())
        };
        row.ok_or_else(|| parameters::unknown(name, "variable", names()))
    }

    /// Returns the variables with these names.
    fn all_named(&self, names: &[String]) -> Result<Vec<&Variable>, Failure> {
        names.iter().map(|name| self.named(name)).collect()
    }

    /// Sets an input; a velocity of `None` is derived.
    fn set(&self, given: &mut Inputs, variable: &Variable, value: Option<f64>) -> Result<(), Failure> {
        if let Some(value) = value {
            check(variable, value)?;
        }
        match (&variable.binding, value) {
            (Binding::Velocity { body, axis }, None) => given.body_mut(*body).velocity[*axis] = None,
            (_, None) => {
                let problem = "None is no value: only velocities can be left to be derived".to_string();
                return Err(Failure::Input(variable.name.clone(), problem));
            }
            (_, Some(value)) => {
                variable.set_input(given, &[value]);
            }
        }
        Ok(())
    }

    /// Sets the inputs from Python: None, an array in the order of the inputs, or a dict.
    fn set_all(&self, given: &mut Inputs, inputs: &Bound<'_, PyAny>) -> PyResult<()> {
        if inputs.is_none() {
            return Ok(());
        }
        if let Ok(dict) = inputs.cast::<PyDict>() {
            for (name, value) in dict {
                let name = name.to_string();
                let number = value.extract::<Option<f64>>();
                let number =
                    number.map_err(|_| Failure::of_argument(&name, format!("{value} is no number")))?;
                self.set(given, self.input(&name)?, number)?;
            }
            return Ok(());
        }
        if let Ok(array) = inputs.extract::<PyReadonlyArray1<'_, f64>>() {
            if let Ok(values) = array.as_slice() {
                return Ok(self.set_array(given, values)?);
            }
            return Ok(self.set_array(given, &array.as_array().to_vec())?);
        }
        let wanted = "must be a dict by names, or numbers in the order of `input_names`";
        let values = inputs.extract::<Vec<f64>>();
        let values = values.map_err(|_| Failure::of_argument("inputs", wanted))?;
        Ok(self.set_array(given, &values)?)
    }

    fn set_array(&self, given: &mut Inputs, values: &[f64]) -> Result<(), Failure> {
        if values.len() != self.inputs.len() {
            let problem = format!(
                "{} numbers, but the simulation has {} inputs: {}",
                values.len(),
                self.inputs.len(),
                self.names(&self.inputs).join(", ")
            );
            return Err(Failure::of_argument("inputs", problem));
        }
        for (&row, &value) in self.inputs.iter().zip(values) {
            check(self.variable(row), value)?;
        }
        for (&row, &value) in self.inputs.iter().zip(values) {
            self.set(given, self.variable(row), Some(value))?;
        }
        Ok(())
    }
}

/// Refuses an input that is not finite.
fn check(variable: &Variable, value: f64) -> Result<(), Failure> {
    match value.is_finite() {
        true => Ok(()),
        false => Err(Failure::Input(
            variable.name.clone(),
            format!("{value} is not a finite number"),
        )),
    }
}

/// Copies nodal vectors into the rows of an array; a new array if none is given.
fn rows<'py>(
    py: Python<'py>,
    nodes: &[Vector3<f64>],
    out: Option<Bound<'py, PyArray2<f64>>>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let out = out.unwrap_or_else(|| PyArray2::zeros(py, [nodes.len(), 3], false));
    let mut writable = out.try_readwrite()?;
    let mut values = writable.as_array_mut();
    if values.dim() != (nodes.len(), 3) {
        let problem = format!(
            "room for {:?} numbers, but there are {} nodes of 3",
            values.dim(),
            nodes.len()
        );
        return Err(Failure::of_argument("out", problem).into());
    }
    for (value, number) in values.iter_mut().zip(nodes.iter().flat_map(|node| node.iter())) {
        *value = *number;
    }
    drop(writable);
    Ok(out)
}

/// Mooring for access by one thread at a time, since reading forces computes them.
#[derive(Debug)]
struct Held(Mutex<Mooring>);

impl Held {
    fn new(mooring: Mooring) -> Held {
        Held(Mutex::new(mooring))
    }

    fn read(&self) -> MutexGuard<'_, Mooring> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn change(&mut self) -> &mut Mooring {
        self.0.get_mut().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Clone for Held {
    fn clone(&self) -> Held {
        Held::new(self.read().clone())
    }
}

/// A mooring that a host steps in time.
///
/// It starts in static equilibrium with the inputs of the start. Inputs refer to the current time; the path of a fairlead is
/// extrapolated smoothly from them over the next step.
#[pyclass(module = "moorline")]
#[derive(Debug, Clone)]
pub(crate) struct Simulation {
    table: Arc<Table>,
    start: Arc<Start>,
    given: Inputs,
    mooring: Held,
    watch: Watch,
}

/// Issues a Python warning.
fn warn_of(py: Python<'_>, note: &Note) -> PyResult<()> {
    PyErr::warn(
        py,
        &py.get_type::<PyUserWarning>(),
        &CString::new(note.to_string())?,
        1,
    )
}

impl Simulation {
    /// Issues Python warnings on the current state, each once.
    fn warn(&mut self, py: Python<'_>) -> PyResult<()> {
        let mut notes = self.watch.look(self.mooring.change()).into_iter();
        notes.try_for_each(|note| warn_of(py, &self.table.loaded.locate_note(note)))
    }

    /// Returns the current value of a scalar output.
    fn output(&self, mooring: &Mooring, variable: &Variable) -> Result<f64, Failure> {
        let mut value = [f64::NAN];
        let read = Interface::read(variable, mooring, &mut value);
        read.map(|()| value[0]).map_err(|reason| match reason {
            NoValue::Undefined(problem) => Failure::Input(variable.name.clone(), problem),
            NoValue::NotFinite(problem) => Failure::Result(variable.name.clone(), problem),
        })
    }

    /// Returns the index of a line whose water flow the host sets.
    fn line_in_flow(&self, name: &str) -> Result<usize, Failure> {
        let line = Self::line(&self.mooring.read(), name)?;
        match self.given.flow.node_count(line) {
            0 => Err(Failure::of_argument(name, NO_FLOW)),
            _ => Ok(line),
        }
    }

    fn line(mooring: &Mooring, name: &str) -> Result<usize, Failure> {
        let model = mooring.model();
        let lines = model.lines.iter().map(|line| line.name.as_str());
        model
            .line_index(name)
            .ok_or_else(|| parameters::unknown(name, "line", lines))
    }
}

#[pymethods]
impl Simulation {
    /// Solves the static equilibrium. With `velocities`, input arrays include velocities; otherwise velocities are derived.
    #[new]
    #[pyo3(signature = (scene, *, inputs=None, start_time=0.0, velocities=false))]
    fn new(
        py: Python<'_>,
        scene: &Scene,
        inputs: Option<&Bound<'_, PyAny>>,
        start_time: f64,
        velocities: bool,
    ) -> PyResult<Simulation> {
        if !start_time.is_finite() {
            let problem = format!("{start_time} s is not a finite number");
            return Err(Failure::of_argument("start_time", problem).into());
        }
        let (scene, known) = (scene.clone(), scene.loaded.notes.len());
        let made = aside(py, None, move |_| {
            let loaded = scene.discretise();
            let model = Model::new(&loaded.scene).map_err(|mistake| Failure::of_scene(mistake, &loaded))?;
            Ok::<_, Failure>((Inputs::new(&model), Table::new(loaded, &model, velocities)?))
        });
        let (mut given, table) = made??;
        if let Some(inputs) = inputs {
            table.set_all(&mut given, inputs)?;
        }
        let start = Arc::new(Start {
            time: start_time,
            given: given.clone(),
        });
        let (loaded, begun) = (table.loaded.clone(), start.clone());
        let mooring = aside(py, None, move |_| begin(&loaded, &begun))??;
        let mut simulation = Simulation {
            watch: Watch::new(&table.loaded.scene, &mooring),
            table: Arc::new(table),
            start,
            given,
            mooring: Held::new(mooring),
        };
        let mut of_discretisation = simulation.table.loaded.notes.iter().skip(known);
        of_discretisation.try_for_each(|note| warn_of(py, note))?;
        simulation.warn(py)?;
        Ok(simulation)
    }

    /// The scene with its discretisation.
    #[getter]
    fn scene(&self) -> Scene {
        Scene::of_discretised(self.table.loaded.clone())
    }

    /// Time [s].
    #[getter]
    fn time(&self) -> f64 {
        self.mooring.read().time()
    }

    /// Names of the inputs, in the order of an input array.
    #[getter]
    fn input_names(&self) -> Vec<&str> {
        self.table.names(&self.table.inputs)
    }

    /// Names of the outputs, in the order of an output array.
    #[getter]
    fn output_names(&self) -> Vec<&str> {
        self.table.names(&self.table.outputs)
    }

    /// Units of all inputs, outputs and parameters, by name.
    #[getter]
    fn units(&self) -> HashMap<&str, &str> {
        let variables = self.table.interface.variables().iter();
        variables
            .map(|variable| (variable.name.as_str(), variable.unit.name))
            .collect()
    }

    /// Sets inputs, by name or as an array in the order of `input_names`, and steps by `h` [s] from the current time. An input
    /// that is not named keeps its value; a velocity of None is derived from the displacements. Warns once of likely mistakes.
    fn advance(&mut self, py: Python<'_>, inputs: &Bound<'_, PyAny>, h: f64) -> PyResult<()> {
        if !(h.is_finite() && h >= 0.0) {
            return Err(
                Failure::of_argument("h", format!("a step of {h} s is not finite and not negative")).into(),
            );
        }
        let mut given = self.given.clone();
        self.table.set_all(&mut given, inputs)?;
        let mooring = self.mooring.change();
        let before = mooring.inputs().clone();
        let advanced = py.detach(|| {
            mooring.set_inputs(&given);
            mooring.advance(h)
        });
        if let Err(error) = advanced {
            mooring.set_inputs(&before);
            return Err(Failure::Step(error).into());
        }
        self.given = given;
        self.warn(py)
    }

    /// An input, output or parameter by name.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let variable = self.table.named(name)?;
        let mut given = [0.0];
        let value = match &variable.binding {
            Binding::Velocity { body, axis } => {
                return Ok(self.given.body(*body).velocity[*axis].into_pyobject(py)?);
            }
            _ if variable.read_input(&self.given, &mut given) => given[0],
            Binding::Parameter(parameter) => {
                let value = parameter.value(&self.table.loaded.scene);
                value.expect("the table has only parameters of the scene")
            }
            _ => self.output(&self.mooring.read(), variable)?,
        };
        Ok(match variable.kind {
            Kind::Float64 => value.into_pyobject(py)?.into_any(),
            Kind::Int32 => (value as i64).into_pyobject(py)?.into_any(),
            Kind::Boolean => (value != 0.0).into_pyobject(py)?.to_owned().into_any(),
        })
    }

    /// Returns all outputs in the order of `output_names`, in `out` if given.
    #[pyo3(signature = (out=None))]
    fn outputs<'py>(
        &self,
        py: Python<'py>,
        out: Option<Bound<'py, PyArray1<f64>>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let rows = &self.table.outputs;
        let out = out.unwrap_or_else(|| PyArray1::zeros(py, rows.len(), false));
        let mut writable = out.try_readwrite()?;
        let mut values = writable.as_array_mut();
        if values.len() != rows.len() {
            let problem = format!(
                "room for {} numbers, but there are {} outputs",
                values.len(),
                rows.len()
            );
            return Err(Failure::of_argument("out", problem).into());
        }
        let mooring = self.mooring.read();
        for (value, &row) in values.iter_mut().zip(rows) {
            *value = self.output(&mooring, self.table.variable(row))?;
        }
        drop(writable);
        Ok(out)
    }

    /// Returns the derivatives of outputs with respect to inputs, displacements and velocities, at the end of the last step: one row per output, one
    /// column per input. Requires `derivatives = true` in `[output]` of the scene.
    fn derivatives<'py>(
        &self,
        py: Python<'py>,
        outputs: Vec<String>,
        inputs: Vec<String>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (rows, knowns) = (self.table.all_named(&outputs)?, self.table.all_named(&inputs)?);
        let columns = py.detach(|| {
            let mooring = self.mooring.read();
            let columns = knowns
                .iter()
                .map(|known| Interface::derivative(&rows, known, &mooring));
            columns.collect::<Result<Vec<_>, String>>()
        });
        let columns = columns.map_err(|problem| Failure::of_argument("derivatives", problem))?;
        let matrix = PyArray2::zeros(py, [outputs.len(), inputs.len()], false);
        for (index, value) in matrix.try_readwrite()?.as_array_mut().indexed_iter_mut() {
            *value = columns[index.1][index.0];
        }
        Ok(matrix)
    }

    /// Returns the time derivatives of outputs [per second] at the end of the last step. Requires `derivatives = true` in `[output]` of the scene.
    fn rates<'py>(&self, py: Python<'py>, outputs: Vec<String>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let rows = self.table.all_named(&outputs)?;
        let rates = py.detach(|| Interface::rates(&rows, &self.mooring.read()));
        let rates = rates.map_err(|problem| Failure::of_argument("rates", problem))?;
        Ok(PyArray1::from_vec(py, rates))
    }

    /// Returns the positions of the nodes of a line from end A to end B [m], one row per node, in `out` if given.
    #[pyo3(signature = (line, out=None))]
    fn positions<'py>(
        &self,
        py: Python<'py>,
        line: &str,
        out: Option<Bound<'py, PyArray2<f64>>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mooring = self.mooring.read();
        let nodes = &mooring.state().lines[Self::line(&mooring, line)?].position;
        rows(py, nodes, out)
    }

    /// Returns the velocities of the nodes of a line from end A to end B [m/s], one row per node, in `out` if given.
    #[pyo3(signature = (line, out=None))]
    fn velocities<'py>(
        &self,
        py: Python<'py>,
        line: &str,
        out: Option<Bound<'py, PyArray2<f64>>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mooring = self.mooring.read();
        let nodes = &mooring.state().lines[Self::line(&mooring, line)?].velocity;
        rows(py, nodes, out)
    }

    /// Returns the positions at which the water flow is required next, for the nodes of a line from end A to end B [m], one row per node, in `out`
    /// if given.
    #[pyo3(signature = (line, out=None))]
    fn flow_places<'py>(
        &self,
        py: Python<'py>,
        line: &str,
        out: Option<Bound<'py, PyArray2<f64>>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let line = self.line_in_flow(line)?;
        let mooring = self.mooring.read();
        let nodes = 0..self.given.flow.node_count(line);
        let places: Vec<_> = nodes.map(|node| mooring.flow_place(line, node)).collect();
        rows(py, &places, out)
    }

    /// Sets velocities [m/s] and accelerations [m/s²] of the water at these positions, one row per node, for the following steps.
    fn set_flow(
        &mut self,
        line: &str,
        velocities: PyReadonlyArray2<'_, f64>,
        accelerations: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<()> {
        let number = self.line_in_flow(line)?;
        let count = self.given.flow.node_count(number);
        let given = [("velocities", &velocities), ("accelerations", &accelerations)];
        for (name, values) in given {
            let values = values.as_array();
            if values.dim() != (count, 3) {
                let problem = format!("{:?} numbers, but {line} has {count} nodes of 3", values.dim());
                return Err(Failure::of_argument(name, problem).into());
            }
            if let Some(value) = values.iter().find(|value| !value.is_finite()) {
                return Err(Failure::Input(name.into(), format!("{value} is not a finite number")).into());
            }
        }
        let [velocities, accelerations] = given.map(|(_, values)| values.as_array());
        for node in 0..count {
            let [velocity, acceleration] =
                [velocities, accelerations].map(|values| std::array::from_fn(|axis| values[[node, axis]]));
            self.given.flow.set(number, node, velocity, acceleration);
        }
        Ok(())
    }

    /// Returns position, velocity and force of a point.
    fn point<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let mooring = self.mooring.read();
        let points = mooring.model().points.iter().map(|point| point.name.as_str());
        let point = mooring.model().point_index(name);
        let point = point.ok_or_else(|| parameters::unknown(name, "point", points))?;
        let state = &mooring.state().points[point];
        let vector = |vector: [f64; 3]| PyArray1::from_slice(py, &vector);
        let (position, velocity) = (vector(state.position.into()), vector(state.velocity.into()));
        let force = match mooring.model().points[point].free() {
            None => mooring.host_force(Body::Point(point))[..3].to_vec(),
            Some(_) => mooring.end_force(point).to_vec(),
        };
        let results = py.import("moorline.results")?;
        results
            .getattr("PointState")?
            .call1((position, velocity, PyArray1::from_vec(py, force)))
    }

    /// Returns the forces of a line on its supports at end A and end B [N], one row per end.
    fn end_forces<'py>(&self, py: Python<'py>, line: &str) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mooring = self.mooring.read();
        let line = Self::line(&mooring, line)?;
        let forces = [End::A, End::B].map(|end| mooring.line_end_force(line, end));
        rows(py, &forces, None)
    }

    /// Returns the effective tensions at the nodes of a line [N]; at the ends, the magnitude of the force.
    fn tensions<'py>(&self, py: Python<'py>, line: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mooring = self.mooring.read();
        Ok(PyArray1::from_slice(
            py,
            mooring.tensions(Self::line(&mooring, line)?),
        ))
    }

    /// Returns the segment tensions at the nodes of a line [N]: of the end segment at an end, otherwise the mean of the two adjacent segments,
    /// as in MoorDyn.
    fn segment_tensions<'py>(&self, py: Python<'py>, line: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mooring = self.mooring.read();
        let line = Self::line(&mooring, line)?;
        let nodes = 0..mooring.state().lines[line].position.len();
        Ok(PyArray1::from_iter(
            py,
            nodes.map(|node| mooring.segment_tension(line, node)),
        ))
    }

    /// Saves the state. A simulation restored to it continues bit for bit.
    fn save(&self) -> State {
        State(Arc::new(Saved {
            scene: self.table.sum,
            start: (*self.start).clone(),
            given: self.given.clone(),
            snapshot: self.mooring.read().snapshot().clone(),
        }))
    }

    /// Restores a state saved by this or another simulation of the same scene.
    fn restore(&mut self, py: Python<'_>, state: &State) -> PyResult<()> {
        let saved = state.0.clone();
        if saved.scene != self.table.sum {
            let problem = "it was saved by a simulation of another scene, or of other parameters";
            return Err(Failure::of_argument("state", problem).into());
        }
        if *self.start != saved.start {
            let (loaded, start) = (self.table.loaded.clone(), saved.start.clone());
            self.mooring = Held::new(aside(py, None, move |_| begin(&loaded, &start))??);
            self.start = Arc::new(saved.start.clone());
        }
        let mooring = self.mooring.change();
        mooring.restore(saved.snapshot.clone());
        self.watch.resume(mooring);
        self.given.clone_from(&saved.given);
        Ok(())
    }

    /// Returns a second simulation in the same state.
    fn copy(&self) -> Simulation {
        self.clone()
    }

    fn __copy__(&self) -> Simulation {
        self.clone()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Simulation {
        self.clone()
    }

    fn __repr__(&self) -> String {
        let title = &self.table.loaded.scene.title;
        format!(
            "<moorline.Simulation {title:?} at t = {} s>",
            self.mooring.read().time()
        )
    }
}
