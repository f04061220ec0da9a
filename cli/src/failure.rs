//! Failures of commands: the message and the exit code.

use std::io::{self, ErrorKind, IsTerminal, Write};

use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, NamedSource, Report};
use moorline::dynamics::StepError;
use moorline::output::OutputError;
use moorline::output::package::PackageError;
use moorline::scene::{LoadError, LoadedScene, SceneError};
use moorline::simulation;

use crate::folder::INTERRUPTED;

/// The input is wrong, or a path cannot be read or written.
const INPUT: u8 = 2;
/// The computation failed.
const COMPUTATION: u8 = 1;
/// Width of a message that is not written to a terminal [characters].
const WIDTH: usize = 110;

/// Failure of a command.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The scene cannot be read, or is wrong.
    Scene(LoadError),
    /// An argument is wrong.
    Argument(String),
    /// The computation failed, or its result could not be written.
    Computation(String),
    /// The command was interrupted, and its results are kept.
    Interrupted(String),
    /// The text could not be written to standard output.
    Print(io::Error),
}

impl Failure {
    /// Failure due to a mistake that appears only when the scene is discretised or brought to equilibrium.
    pub(crate) fn of_simulation(error: simulation::Error, loaded: &LoadedScene) -> Failure {
        match error {
            simulation::Error::Scene(mistake) => Failure::of_scene(mistake, loaded),
            simulation::Error::Statics(error) => Failure::Computation(error.to_string()),
        }
    }

    /// Failure due to a mistake in a scene that has been read.
    pub(crate) fn of_scene(mistake: SceneError, loaded: &LoadedScene) -> Failure {
        Failure::Scene(LoadError::Scene {
            path: loaded.path.clone(),
            text: loaded.text.clone(),
            mistakes: vec![loaded.locate(mistake)],
        })
    }

    /// Failure due to a package that was not written.
    pub(crate) fn of_package(error: PackageError, loaded: &LoadedScene) -> Failure {
        match error {
            PackageError::Scene(mistake) => Failure::of_scene(mistake, loaded),
            PackageError::Output(error) => error.into(),
            error => Failure::Computation(error.to_string()),
        }
    }

    /// Failure due to a file that was not written: its path is wrong, or the disk is full or broken.
    pub(crate) fn of_file(kind: ErrorKind, text: String) -> Failure {
        match kind {
            ErrorKind::NotFound
            | ErrorKind::PermissionDenied
            | ErrorKind::ReadOnlyFilesystem
            | ErrorKind::IsADirectory
            | ErrorKind::NotADirectory
            | ErrorKind::InvalidFilename
            | ErrorKind::InvalidInput => Failure::Argument(text),
            _ => Failure::Computation(text),
        }
    }

    /// Reports the failure on standard error, and returns the exit code. A pipe that the reader closed is not a failure.
    pub(crate) fn report(self) -> u8 {
        let (code, text) = match self {
            Failure::Print(error) if error.kind() == ErrorKind::BrokenPipe => {
                return 0;
            }
            Failure::Scene(error) => (INPUT, rendered(&error)),
            Failure::Argument(text) => (INPUT, format!("error: {text}\n")),
            Failure::Computation(text) => (COMPUTATION, format!("error: {text}\n")),
            Failure::Interrupted(text) => (INTERRUPTED, format!("interrupted {text}\n")),
            Failure::Print(error) => (
                COMPUTATION,
                format!("error: cannot write to standard output: {error}\n"),
            ),
        };
        // A failure to write the message is ignored.
        let _ = io::stderr().write_all(text.as_bytes());
        code
    }
}

/// Message with the lines of the scene to which it refers.
fn rendered(error: &LoadError) -> String {
    let mistakes = error.mistakes();
    let labels = mistakes.iter().filter_map(|mistake| {
        let label = if mistakes.len() == 1 {
            "here"
        } else {
            &mistake.problem
        };
        let span = mistake.span.clone()?;
        Some(LabeledSpan::new_with_span(Some(label.to_string()), span))
    });
    let mut report = Report::new(MietteDiagnostic::new(error.to_string()).with_labels(labels));
    if let LoadError::Scene { path, text, .. } = error {
        report = report.with_source_code(NamedSource::new(path.display().to_string(), text.clone()));
    }
    let plain = !io::stderr().is_terminal() || std::env::var_os("NO_COLOR").is_some();
    let theme = match plain {
        true => GraphicalTheme::unicode_nocolor(),
        false => GraphicalTheme::unicode(),
    };
    let handler = GraphicalReportHandler::new_themed(theme)
        .with_width(WIDTH)
        .with_links(false);
    let mut text = String::new();
    match handler.render_report(&mut text, report.as_ref()) {
        Ok(()) => text,
        Err(_) => format!("error: {}\n", error.list()),
    }
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        Failure::Scene(error)
    }
}

impl From<StepError> for Failure {
    fn from(error: StepError) -> Self {
        Failure::Computation(error.to_string())
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        match &error {
            OutputError::File { source, .. } => Failure::of_file(source.kind(), error.to_string()),
            _ => Failure::Argument(error.to_string()),
        }
    }
}
