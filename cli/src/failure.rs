//! Why a command ended without its result: what is said, and the exit code.

use std::io::{self, ErrorKind, IsTerminal, Write};
use std::process::ExitCode;

use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceCode};
use moorline::dynamics::StepError;
use moorline::output::OutputError;
use moorline::output::package::PackageError;
use moorline::scene::{LoadError, LoadedScene, SceneError};
use moorline::simulation;

/// The input is wrong, or a path that is to be read or written.
const INPUT: u8 = 2;
/// The computation failed.
const COMPUTATION: u8 = 1;
/// Width of a message that does not go to a terminal [characters].
const WIDTH: usize = 110;

/// Why a command ended without its result.
#[derive(Debug)]
pub enum Failure {
    /// The scene cannot be read, or is wrong.
    Scene(LoadError),
    /// An argument is wrong.
    Argument(String),
    /// The computation failed, or its result could not be written.
    Computation(String),
    /// Standard output did not take the text.
    Print(io::Error),
}

impl Failure {
    /// A mistake that shows only when the scene is made discrete or brought to equilibrium.
    pub fn of_simulation(error: simulation::Error, loaded: &LoadedScene) -> Failure {
        match error {
            simulation::Error::Scene(mistake) => Failure::of_scene(mistake, loaded),
            simulation::Error::Statics(error) => Failure::Computation(error.to_string()),
        }
    }

    /// A mistake in a scene that has been read.
    pub fn of_scene(mistake: SceneError, loaded: &LoadedScene) -> Failure {
        Failure::Scene(LoadError::Scene {
            path: loaded.path.clone(),
            text: loaded.text.clone(),
            mistakes: vec![loaded.locate(mistake)],
        })
    }

    /// A package that was not written.
    pub fn of_package(error: PackageError, loaded: &LoadedScene) -> Failure {
        match error {
            PackageError::Scene(mistake) => Failure::of_scene(mistake, loaded),
            PackageError::Output(error) => error.into(),
            error => Failure::Computation(error.to_string()),
        }
    }

    /// A file that was not written: its path is wrong, or the disk is full or broken.
    pub fn of_file(kind: ErrorKind, text: String) -> Failure {
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

    /// Says on standard error what went wrong, and returns the exit code. Who closed the pipe has read enough.
    pub fn tell(self) -> ExitCode {
        let (code, text) = match self {
            Failure::Print(error) if error.kind() == ErrorKind::BrokenPipe => {
                return ExitCode::SUCCESS;
            }
            Failure::Scene(error) => (INPUT, rendered(&error)),
            Failure::Argument(text) => (INPUT, format!("error: {text}\n")),
            Failure::Computation(text) => (COMPUTATION, format!("error: {text}\n")),
            Failure::Print(error) => (
                COMPUTATION,
                format!("error: cannot write to standard output: {error}\n"),
            ),
        };
        // Nothing is left to say it to.
        let _ = io::stderr().write_all(text.as_bytes());
        ExitCode::from(code)
    }
}

/// The message with the lines of the scene that it is about.
fn rendered(error: &LoadError) -> String {
    let plain = !io::stderr().is_terminal() || std::env::var_os("NO_COLOR").is_some();
    let theme = if plain {
        GraphicalTheme::unicode_nocolor()
    } else {
        GraphicalTheme::unicode()
    };
    let mut text = String::new();
    let handler = GraphicalReportHandler::new_themed(theme)
        .with_width(WIDTH)
        .with_links(false);
    match handler.render_report(&mut text, &Shown::new(error)) {
        Ok(()) => text,
        Err(_) => format!("error: {}\n", error.list()),
    }
}

/// Mistakes in a file beside its lines.
#[derive(Debug, thiserror::Error)]
#[error("{error}")]
struct Shown<'e> {
    error: &'e LoadError,
    source_text: Option<NamedSource<String>>,
}

impl Shown<'_> {
    fn new(error: &LoadError) -> Shown<'_> {
        let source_text = match error {
            LoadError::Scene { path, text, .. } => {
                Some(NamedSource::new(path.display().to_string(), text.clone()))
            }
            LoadError::Unreadable { .. } | LoadError::NotText { .. } => None,
        };
        Shown { error, source_text }
    }
}

impl Diagnostic for Shown<'_> {
    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.source_text.as_ref().map(|text| text as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let mistakes = self.error.mistakes();
        let alone = mistakes.len() == 1;
        Some(Box::new(mistakes.iter().filter_map(move |mistake| {
            let label = if alone { "here" } else { &mistake.problem };
            Some(LabeledSpan::new_with_span(
                Some(label.to_string()),
                mistake.span.clone()?,
            ))
        })))
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
            OutputError::Folder { .. } | OutputError::Closed { .. } | OutputError::NotAFolder { .. } => {
                Failure::Argument(error.to_string())
            }
        }
    }
}
