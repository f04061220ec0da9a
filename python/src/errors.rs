//! Errors of the library as exceptions of `moorline.errors`, with their place and advice as attributes.

use moorline::dynamics::{StepError, StepFailure};
use moorline::output::package::PackageError;
use moorline::scene::{LoadError, LoadedScene, SceneError};
use moorline::simulation;
use moorline::statics::StaticsError;
use moorline::statics::modes::ModesError;
use moorline_system::Code;
use pyo3::exceptions::PyNotImplementedError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// Error that becomes an exception; it can be created without the interpreter.
#[derive(Debug)]
pub(crate) enum Failure {
    /// A scene file cannot be read or has mistakes.
    Load(LoadError),
    /// Mistakes in a scene without text; at least one.
    Scene(Vec<SceneError>),
    /// No static equilibrium was found.
    Statics(StaticsError),
    /// No natural modes were found.
    Modes(ModesError),
    /// A step failed.
    Step(StepError),
    /// A result is not a finite number: its name, and the message.
    Result(String, String),
    /// An argument is wrong: its name, and the problem.
    Input(String, String),
    /// A file cannot be written: its name, and the message.
    Output(String, String),
    /// A call to MoorDyn's interface failed.
    MoorDyn(moorline_system::Failure),
    /// The work was abandoned.
    Interrupted,
}

impl Failure {
    /// Returns a mistake at a key path of a scene without text.
    pub(crate) fn of_key(at: &str, problem: String) -> Failure {
        Failure::Scene(vec![SceneError::new(at, problem)])
    }

    /// Returns the failure for a wrong argument.
    pub(crate) fn of_argument(name: &str, problem: impl Into<String>) -> Failure {
        Failure::Input(name.to_string(), problem.into())
    }

    /// Returns a mistake that is found only when the scene is discretised.
    pub(crate) fn of_scene(mistake: SceneError, loaded: &LoadedScene) -> Failure {
        let mistake = loaded.locate(mistake);
        match mistake.span {
            None => Failure::Scene(vec![mistake]),
            Some(_) => Failure::Load(LoadError::Scene {
                path: loaded.path.clone(),
                text: loaded.text.clone(),
                mistakes: vec![mistake],
            }),
        }
    }

    /// Returns the failure of a simulation that cannot be built.
    pub(crate) fn of_simulation(error: simulation::Error, loaded: &LoadedScene) -> Failure {
        match error {
            simulation::Error::Scene(mistake) => Failure::of_scene(mistake, loaded),
            simulation::Error::Statics(error) => Failure::Statics(error),
        }
    }

    /// Returns the failure of an FMU that was not written to a file.
    pub(crate) fn of_package(error: PackageError, loaded: &LoadedScene, target: String) -> Failure {
        match error {
            PackageError::Scene(mistake) => Failure::of_scene(mistake, loaded),
            error => Failure::Output(target, error.to_string()),
        }
    }

    /// Returns the class and message of the exception.
    fn class_and_message(&self) -> (&'static str, String) {
        match self {
            Failure::Load(error) if error.mistakes().len() > 1 => ("SceneError", error.list()),
            Failure::Load(error) => ("SceneError", error.to_string()),
            Failure::Scene(mistakes) => {
                let mistakes: Vec<String> = mistakes.iter().map(ToString::to_string).collect();
                ("SceneError", mistakes.join("\n"))
            }
            Failure::Statics(error) => ("StaticsError", error.to_string()),
            Failure::Modes(error) => ("StaticsError", error.to_string()),
            Failure::Step(error) => ("StepError", error.to_string()),
            Failure::Result(_, problem) => ("StepError", problem.clone()),
            Failure::Input(name, problem) => ("InputError", format!("{name}: {problem}")),
            Failure::Output(_, problem) => ("OutputError", problem.clone()),
            Failure::MoorDyn(failure) => (class_of(failure.code), failure.message.clone()),
            Failure::Interrupted => ("Error", "the work was given up".to_string()),
        }
    }

    /// Sets the attributes of the exception.
    fn set_facts(&self, facts: &Bound<'_, PyDict>) -> PyResult<()> {
        match self {
            Failure::Load(LoadError::Scene { text, mistakes, .. }) => {
                set_mistakes(mistakes, Some(text), facts)
            }
            Failure::Load(
                LoadError::Unreadable { path, problem } | LoadError::NotText { path, problem, .. },
            ) => {
                facts.set_item("place", path)?;
                facts.set_item("problem", problem)
            }
            Failure::Scene(mistakes) => set_mistakes(mistakes, None, facts),
            Failure::Statics(error) => set_statics(error, facts),
            Failure::Modes(error) => facts.set_item("problem", error.to_string()),
            Failure::Step(error) => set_step(error, facts),
            Failure::Result(name, problem)
            | Failure::Input(name, problem)
            | Failure::Output(name, problem) => {
                facts.set_item("place", name)?;
                facts.set_item("problem", problem)
            }
            Failure::MoorDyn(_) | Failure::Interrupted => Ok(()),
        }
    }

    /// Returns the exception, to be raised or returned.
    pub(crate) fn raised(&self, py: Python<'_>) -> PyErr {
        if let Failure::MoorDyn(failure) = self
            && failure.code == Code::NotImplemented
        {
            return PyNotImplementedError::new_err(failure.message.clone());
        }
        let (class, message) = self.class_and_message();
        let make = || {
            let facts = PyDict::new(py);
            self.set_facts(&facts)?;
            let class = py.import("moorline.errors")?.getattr(class)?;
            class.call((message,), Some(&facts))
        };
        make().map_or_else(|error| error, PyErr::from_value)
    }
}

/// Returns the class of the exception for a code of MoorDyn's interface.
fn class_of(code: Code) -> &'static str {
    match code {
        Code::InvalidInputFile => "SceneError",
        Code::InvalidOutputFile => "OutputError",
        Code::InvalidInput | Code::InvalidValue | Code::NotImplemented => "InputError",
        Code::NotFinite => "StepError",
        Code::Success | Code::Memory | Code::Unhandled => "Error",
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> PyErr {
        Python::attach(|py| failure.raised(py))
    }
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Failure {
        Failure::Load(error)
    }
}

impl From<StepError> for Failure {
    fn from(error: StepError) -> Failure {
        Failure::Step(error)
    }
}

/// Sets place, problem, line and column of the first mistake, and a list with those of all mistakes.
fn set_mistakes(mistakes: &[SceneError], text: Option<&str>, facts: &Bound<'_, PyDict>) -> PyResult<()> {
    let list = PyList::empty(facts.py());
    for mistake in mistakes {
        let place = text.filter(|_| mistake.span.is_some());
        let place = place.map(|text| mistake.line_column(text)).unzip();
        list.append((&mistake.at, &mistake.problem, place.0, place.1))?;
    }
    if let Some(first) = mistakes.first() {
        facts.set_item("place", &first.at)?;
        facts.set_item("problem", &first.problem)?;
    }
    facts.set_item("mistakes", list)
}

/// Splits a message at its first semicolon into the problem and the advice.
fn split_advice(message: &str) -> (&str, Option<&str>) {
    match message.split_once("; ") {
        Some((problem, advice)) => (problem, Some(advice)),
        None => (message, None),
    }
}

fn set_statics(error: &StaticsError, facts: &Bound<'_, PyDict>) -> PyResult<()> {
    let message = error.to_string();
    let (problem, advice) = split_advice(&message);
    let at_node = |line: &str, node: usize| format!("line \"{line}\", node {node}");
    let (place, line, residual) = match error {
        StaticsError::LimitLoad { line, segment, .. } => {
            (format!("line \"{line}\", segment {segment}"), Some(line), None)
        }
        StaticsError::NotConverged { place, residual, .. } => (place.clone(), None, Some(*residual)),
        StaticsError::BeamNotConverged {
            line, node, residual, ..
        } => (at_node(line, *node), Some(line), Some(*residual)),
        StaticsError::BeamFlies { line, residual } => {
            (format!("line \"{line}\""), Some(line), Some(*residual))
        }
        StaticsError::Unstable { line, .. } | StaticsError::BeamSpins { line, .. } => {
            (format!("line \"{line}\""), Some(line), None)
        }
        StaticsError::BeamFolded { line, node } => (at_node(line, *node), Some(line), None),
        StaticsError::NotFinite { place, .. } => (place.clone(), None, None),
    };
    facts.set_item(
        "problem",
        problem.strip_prefix(&format!("{place}: ")).unwrap_or(problem),
    )?;
    facts.set_item("place", place)?;
    facts.set_item("advice", advice)?;
    facts.set_item("line", line)?;
    facts.set_item("residual", residual)
}

fn set_step(error: &StepError, facts: &Bound<'_, PyDict>) -> PyResult<()> {
    let StepError {
        time,
        line,
        node,
        cause,
    } = error;
    facts.set_item("place", format!("line \"{line}\", node {node}"))?;
    facts.set_item("problem", cause.to_string())?;
    facts.set_item("advice", cause.advice())?;
    facts.set_item("time", time)?;
    facts.set_item("line", line)?;
    facts.set_item("node", node)?;
    if let StepFailure::NotConverged { residual, .. } = cause {
        facts.set_item("residual", residual)?;
    }
    Ok(())
}
