//! Mistakes in a scene, with their place and a correction.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::path;

/// A mistake in the user's scene.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{problem}", self.prefix())]
pub struct SceneError {
    /// Key path, such as `line_types.chain.diameter` or `lines[2].sections[0].length`; empty for the whole file.
    pub at: String,
    /// The mistake and its correction.
    pub problem: String,
    /// Bytes of the text it concerns, if known.
    pub span: Option<Range<usize>>,
}

impl SceneError {
    /// A mistake at a key path.
    pub fn new(at: impl Into<String>, problem: impl Into<String>) -> Self {
        SceneError {
            at: at.into(),
            problem: problem.into(),
            span: None,
        }
    }

    fn prefix(&self) -> String {
        if self.at.is_empty() {
            String::new()
        } else {
            format!("{}: ", self.at)
        }
    }

    /// Line and column in the text it came from, both from 1; (1, 1) if it concerns the whole text.
    pub fn line_column(&self, text: &str) -> (usize, usize) {
        path::line_column(text, self.span.as_ref().map_or(0, |span| span.start))
    }
}

/// Reason why a scene file cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The file as a whole cannot be used: it does not exist, is a folder, or is of another kind than expected.
    #[error("{}: {problem}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The mistake and its correction.
        problem: String,
    },
    /// Not UTF-8 text.
    #[error("{}: {problem}", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// Index of the first byte that is not text, from 0.
        byte: usize,
        /// The mistake and its correction.
        problem: String,
    },
    /// Text with mistakes, in the order of the file.
    #[error("{}", place_first(path, text, mistakes))]
    Scene {
        /// The file.
        path: PathBuf,
        /// Its text; the spans of the mistakes are bytes of it.
        text: String,
        /// The mistakes, at least one.
        mistakes: Vec<SceneError>,
    },
}

impl LoadError {
    /// The mistakes of the scene; empty if the file could not be read.
    pub fn mistakes(&self) -> &[SceneError] {
        match self {
            LoadError::Scene { mistakes, .. } => mistakes,
            _ => &[],
        }
    }

    /// Lists the mistakes, one on a line: file, line, column, key, problem.
    pub fn list(&self) -> String {
        match self {
            LoadError::Scene { path, text, mistakes } => {
                let lines = mistakes.iter().map(|mistake| place(path, text, mistake));
                lines.collect::<Vec<_>>().join("\n")
            }
            other => other.to_string(),
        }
    }
}

fn place(path: &Path, text: &str, mistake: &SceneError) -> String {
    let (line, column) = mistake.line_column(text);
    format!("{}:{line}:{column}: {mistake}", path.display())
}

fn place_first(path: &Path, text: &str, mistakes: &[SceneError]) -> String {
    let first = mistakes.first().map(|mistake| place(path, text, mistake));
    let first = first.unwrap_or_default();
    match mistakes.len() {
        0 | 1 => first,
        2 => format!("{first} (and 1 mistake more)"),
        n => format!("{first} (and {} mistakes more)", n - 1),
    }
}
