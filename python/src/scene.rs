//! Scenes: reading, modification, statics, modes, FMUs.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use moorline::discretisation;
use moorline::output::fmi::FmiVersion;
use moorline::output::package::write_fmu;
use moorline::output::{check_file, collect, modes};
use moorline::scene::{Integrator, LoadError, LoadedScene, load_text};
use moorline::simulation::Simulation;
use moorline_cli::Library;
use moorline_decks::{Supplement, load_with};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::aside::aside;
use crate::convert;
use crate::errors::Failure;
use crate::{motion, package_folder, parameters};

/// Name of a scene text in messages.
const TEXT: &str = "<text>";

/// A mooring as described by the user. A scene does not change: methods return new scenes.
#[pyclass(frozen, module = "moorline")]
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    pub(crate) loaded: Arc<LoadedScene>,
    /// The scene with its discretisation, once selected.
    discretised: Arc<OnceLock<Arc<LoadedScene>>>,
}

impl From<LoadedScene> for Scene {
    fn from(loaded: LoadedScene) -> Scene {
        Scene {
            loaded: Arc::new(loaded),
            discretised: Arc::default(),
        }
    }
}

impl Scene {
    /// Reads a text; its file names are relative to a folder.
    fn of_text(text: String, folder: Option<PathBuf>) -> Result<Scene, Failure> {
        let path = folder.unwrap_or_default().join(TEXT);
        Ok(load_text(&path, text)?.into())
    }

    /// Returns a scene that already has its discretisation.
    pub(crate) fn of_discretised(loaded: Arc<LoadedScene>) -> Scene {
        Scene {
            loaded: loaded.clone(),
            discretised: Arc::new(OnceLock::from(loaded)),
        }
    }

    /// Returns a copy with other content, which no longer corresponds to the text.
    fn with(&self, scene: moorline::scene::Scene) -> Scene {
        let mut changed = (*self.loaded).clone();
        let notes = changed.change(scene);
        changed.notes.extend(notes);
        changed.into()
    }

    /// Returns the scene with elements, integrator and time step, selected on first use.
    pub(crate) fn discretise(&self) -> Arc<LoadedScene> {
        let select = || match discretisation::select(&self.loaded.scene) {
            None => self.loaded.clone(),
            Some(found) => {
                let notes = found.shortfalls().into_iter();
                let notes = notes.map(|note| self.loaded.locate_note(note));
                Arc::new(LoadedScene {
                    notes: self.loaded.notes.iter().cloned().chain(notes).collect(),
                    scene: found.scene,
                    ..(*self.loaded).clone()
                })
            }
        };
        self.discretised.get_or_init(select).clone()
    }

    /// Returns the scene at rest and its simulation: the equilibrium is that in still water, without waves.
    fn at_rest(&self, elements: bool) -> Result<(LoadedScene, Simulation), Failure> {
        let mut loaded = (*self.loaded).clone();
        let scene = &mut loaded.scene;
        if let Some(water) = &mut scene.water {
            water.waves = None;
        }
        if elements && scene.solver.integrator == Integrator::QuasiStatic {
            scene.solver.integrator = Integrator::Leapfrog;
        }
        let found = discretisation::at_rest(&loaded.scene);
        let (found, simulation) = found.map_err(|error| Failure::of_simulation(error, &loaded))?;
        if let Some(found) = found {
            loaded.scene = found.scene;
        }
        Ok((loaded, simulation))
    }
}

/// Calls a function of `moorline.results` with a JSON value.
fn result<'py>(py: Python<'py>, function: &str, value: &serde_json::Value) -> PyResult<Bound<'py, PyAny>> {
    let module = py.import("moorline.results")?;
    module.getattr(function)?.call1((convert::json(py, value)?,))
}

/// Converts a DataFrame or a dict of arrays to columns, by `moorline.motion`.
fn columns(motion: &Bound<'_, PyAny>) -> PyResult<Vec<(String, Vec<f64>)>> {
    let columns = motion
        .py()
        .import("moorline.motion")?
        .getattr("columns")?
        .call1((motion,))?;
    let columns = columns.cast_into::<PyDict>()?;
    let columns = columns.iter().map(|(name, values)| {
        let values: PyReadonlyArray1<'_, f64> = values.extract()?;
        Ok((name.extract()?, values.as_slice()?.to_vec()))
    });
    columns.collect()
}

#[pymethods]
impl Scene {
    /// Reads a scene, or a deck of MoorDyn or MAP++. For a deck: depth of the water [m]; name of the only vessel, which carries its coupled
    /// points; reference positions of vessels by name [m].
    #[staticmethod]
    #[pyo3(signature = (path, *, depth=None, vessel=None, positions=None))]
    fn load(
        path: PathBuf,
        depth: Option<f64>,
        vessel: Option<String>,
        positions: Option<BTreeMap<String, [f64; 3]>>,
    ) -> PyResult<Scene> {
        let supplement = Supplement {
            depth,
            vessel,
            positions: positions.unwrap_or_default(),
        };
        Ok(load_with(&path, &supplement).map_err(Failure::Load)?.into())
    }

    /// Reads a scene from TOML. File names in it are relative to the folder.
    #[staticmethod]
    #[pyo3(signature = (text, *, folder=None))]
    fn from_toml(text: String, folder: Option<PathBuf>) -> PyResult<Scene> {
        Ok(Scene::of_text(text, folder)?)
    }

    /// Reads a scene from a dict with the keys of the scene format. Numpy arrays and numbers are accepted as lists and numbers.
    #[staticmethod]
    #[pyo3(signature = (scene, *, folder=None))]
    fn from_dict(scene: &Bound<'_, PyDict>, folder: Option<PathBuf>) -> PyResult<Scene> {
        let table = convert::table(scene, "")?;
        let text = toml::to_string(&table).map_err(|error| Failure::of_key("", error.to_string()))?;
        Ok(Scene::of_text(text, folder).map_err(without_lines)?)
    }

    /// Returns the scene as TOML that refers to no other file and is read back to the same numbers, bit for bit.
    fn to_toml(&self) -> String {
        self.loaded.scene.to_toml()
    }

    /// Returns the scene as a dict, with the keys of `to_toml`.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        py.import("tomllib")?.getattr("loads")?.call1((self.to_toml(),))
    }

    /// Title.
    #[getter]
    fn title(&self) -> &str {
        &self.loaded.scene.title
    }

    /// Names of the lines.
    #[getter]
    fn lines(&self) -> Vec<&str> {
        let lines = self.loaded.scene.lines.iter();
        lines.map(|line| line.name.as_str()).collect()
    }

    /// Names of the points.
    #[getter]
    fn points(&self) -> Vec<&str> {
        let points = self.loaded.scene.points.iter();
        points.map(|point| point.name.as_str()).collect()
    }

    /// Names of the vessels.
    #[getter]
    fn vessels(&self) -> Vec<&str> {
        let vessels = self.loaded.scene.vessels.iter();
        vessels.map(|vessel| vessel.name.as_str()).collect()
    }

    /// Remarks on a valid scene.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.loaded.notes.iter().map(ToString::to_string).collect()
    }

    /// Describes in sentences which effects the scene models and which it does not.
    fn in_words(&self) -> String {
        self.loaded.scene.in_words()
    }

    /// Parameters and their values, by the names of the FMU.
    #[getter]
    fn parameters(&self) -> PyResult<BTreeMap<String, f64>> {
        Ok(parameters::values(&self.loaded)?.into_iter().collect())
    }

    /// Returns the scene with other values of some parameters, such as `chain.drag_normal`.
    fn with_parameters(&self, values: &Bound<'_, PyDict>) -> PyResult<Scene> {
        let values = values
            .iter()
            .map(|(name, value)| Ok((name.extract()?, value.extract()?)));
        let values: Vec<(String, f64)> = values.collect::<PyResult<_>>()?;
        Ok(self.with(parameters::with_values(&self.loaded, &values)?))
    }

    /// Returns the scene with the motion in columns, whose length sets the duration unless `duration` [s] is given; `interval` is the output
    /// interval [s].
    #[pyo3(signature = (motion=None, *, duration=None, interval=None))]
    fn with_motion(
        &self,
        motion: Option<&Bound<'_, PyAny>>,
        duration: Option<f64>,
        interval: Option<f64>,
    ) -> PyResult<Scene> {
        let mut scene = self.loaded.scene.clone();
        scene.output.interval = interval.unwrap_or(scene.output.interval);
        let scene = match motion {
            Some(motion) => motion::with_columns(scene, &columns(motion)?, duration)?,
            None => {
                scene.output.duration = duration.unwrap_or(scene.output.duration);
                parameters::check(scene)?
            }
        };
        Ok(self.with(scene))
    }

    /// Returns the scene with its discretisation: elements, integrator and time step. Values that the scene leaves open are selected by
    /// convergence trials, which take about a second.
    fn discretised(&self, py: Python<'_>) -> PyResult<Scene> {
        let scene = self.clone();
        let loaded = aside(py, None, move |_| scene.discretise())?;
        Ok(Scene::of_discretised(loaded))
    }

    /// Returns the static equilibrium without waves.
    fn statics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let scene = self.clone();
        let solved = aside(py, None, move |_| {
            let (loaded, simulation) = scene.at_rest(false)?;
            let statics = collect::statics(&loaded.scene, simulation);
            Ok::<_, Failure>(serde_json::to_value(statics).expect("statics are numbers and names"))
        });
        result(py, "statics", &solved??)
    }

    /// Returns the lowest natural modes about the static equilibrium.
    #[pyo3(signature = (count=10))]
    fn modes<'py>(&self, py: Python<'py>, count: usize) -> PyResult<Bound<'py, PyAny>> {
        let scene = self.clone();
        let solved = aside(py, None, move |_| {
            let (loaded, simulation) = scene.at_rest(true)?;
            let found = modes::natural_modes(&loaded.scene.title, &simulation, count);
            let found = found.map_err(Failure::Modes)?;
            Ok::<_, Failure>(serde_json::to_value(found).expect("modes are numbers and names"))
        });
        result(py, "modes", &solved??)
    }

    fn __eq__(&self, other: &Scene) -> bool {
        self.loaded.scene == other.loaded.scene
    }

    fn __repr__(&self) -> String {
        let count = |number: usize, one: &str| match number {
            1 => format!("1 {one}"),
            _ => format!("{number} {one}s"),
        };
        let scene = &self.loaded.scene;
        let lines = count(scene.lines.len(), "line");
        let points = count(scene.points.len(), "point");
        let vessels = count(scene.vessels.len(), "vessel");
        format!("<moorline.Scene {:?}: {lines}, {points}, {vessels}>", scene.title)
    }

    /// Supports pickle: the scene as TOML that refers to no other file.
    fn __reduce__(slf: &Bound<'_, Scene>) -> PyResult<(Py<PyAny>, (String,))> {
        let read = slf.get_type().getattr("from_toml")?;
        Ok((read.unbind(), (slf.get().to_toml(),)))
    }
}

/// Removes line numbers from mistakes in a dict: they would refer to an intermediate text. The key path remains.
fn without_lines(failure: Failure) -> Failure {
    match failure {
        Failure::Load(LoadError::Scene { mut mistakes, .. }) => {
            mistakes.iter_mut().for_each(|mistake| mistake.span = None);
            Failure::Scene(mistakes)
        }
        other => other,
    }
}

/// Packages a scene as an FMU for FMI 2.0 or 3.0.
#[pyfunction]
#[pyo3(signature = (scene, path, fmi=2))]
pub(crate) fn fmu(py: Python<'_>, scene: &Scene, path: PathBuf, fmi: u8) -> PyResult<()> {
    let version = match fmi {
        2 => FmiVersion::Two,
        3 => FmiVersion::Three,
        other => {
            let problem = format!("{other} is no version of FMI that moorline has: 2 or 3");
            return Err(Failure::of_argument("fmi", problem).into());
        }
    };
    let folder = package_folder(py)?;
    let scene = scene.clone();
    let packed = aside(py, None, move |_| package(&scene, &path, version, &folder));
    Ok(packed??)
}

fn package(scene: &Scene, target: &Path, version: FmiVersion, folder: &Path) -> Result<(), Failure> {
    let name = target.display().to_string();
    check_file(target).map_err(|error| Failure::Output(name.clone(), error.to_string()))?;
    let loaded = scene.discretise();
    // An FMU of a scene without an equilibrium could not be started by any host.
    Simulation::new(&loaded.scene).map_err(|error| Failure::of_simulation(error, &loaded))?;
    let binaries = Library::In(folder).find();
    let written =
        binaries.and_then(|binaries| write_fmu(&loaded.scene, &loaded.text, version, &binaries, target));
    written.map_err(|error| Failure::of_package(error, &loaded, name))
}
