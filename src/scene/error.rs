//! Mistakes in a scene, with their place and a correction.

use std::ops::Range;
use std::path::PathBuf;

use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode};

use super::path;

/// A mistake in the user's scene.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{problem}", self.prefix())]
pub struct SceneError {
    /// Key path, such as `line_types.chain.diameter` or `lines[2].sections[0].length`; empty for the whole file.
    pub at: String,
    /// The mistake and its correction.
    pub problem: String,
    /// Bytes of the text it concerns, where known.
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

    /// Line and column in the text it came from, both from 1; the first where it concerns the whole text.
    pub fn line_column(&self, text: &str) -> (usize, usize) {
        path::line_column(text, self.span.as_ref().map_or(0, |span| span.start))
    }
}

/// Why a scene file cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// No such file, a folder, no permission.
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
        /// Number of the first byte that is not text, from 0.
        byte: usize,
        /// The mistake and its correction.
        problem: String,
    },
    /// A scene, with something beside it that only decks need.
    #[error("{}: {problem}", path.display())]
    NotADeck {
        /// The file.
        path: PathBuf,
        /// The mistake and its correction.
        problem: &'static str,
    },
    /// Text with mistakes, in the order of the file.
    #[error("{}", place_first(source_text, mistakes))]
    Scene {
        /// The file's name and text.
        source_text: Box<NamedSource<String>>,
        /// The mistakes, at least one.
        mistakes: Vec<SceneError>,
    },
}

impl LoadError {
    /// The mistakes of the scene; none where the file could not be read at all.
    pub fn mistakes(&self) -> &[SceneError] {
        match self {
            LoadError::Scene { mistakes, .. } => mistakes,
            _ => &[],
        }
    }

    /// Every mistake on a line: file, line, column, key, what is wrong.
    pub fn list(&self) -> String {
        match self {
            LoadError::Scene {
                source_text,
                mistakes,
            } => {
                let lines = mistakes.iter().map(|mistake| place(source_text, mistake));
                lines.collect::<Vec<_>>().join("\n")
            }
            other => other.to_string(),
        }
    }
}

fn place(source_text: &NamedSource<String>, mistake: &SceneError) -> String {
    let (line, column) = mistake.line_column(source_text.inner());
    format!("{}:{line}:{column}: {mistake}", source_text.name())
}

fn place_first(source_text: &NamedSource<String>, mistakes: &[SceneError]) -> String {
    let first = mistakes
        .first()
        .map(|mistake| place(source_text, mistake))
        .unwrap_or_default();
    match mistakes.len() {
        0 | 1 => first,
        2 => format!("{first} (and 1 mistake more)"),
        n => format!("{first} (and {} mistakes more)", n - 1),
    }
}

impl Diagnostic for LoadError {
    fn source_code(&self) -> Option<&dyn SourceCode> {
        match self {
            LoadError::Scene { source_text, .. } => Some(source_text.as_ref()),
            _ => None,
        }
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let mistakes = self.mistakes();
        let alone = mistakes.len() == 1;
        Some(Box::new(mistakes.iter().filter_map(move |mistake| {
            let span = mistake.span.clone()?;
            let label = if alone {
                "here".to_string()
            } else {
                mistake.problem.clone()
            };
            Some(LabeledSpan::new_with_span(Some(label), span))
        })))
    }
}
