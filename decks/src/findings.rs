//! Mistakes and remarks on a deck, with their bytes in the file.

use std::ops::Range;

use moorline::scene::path::line_column;
use moorline::scene::{Note, SceneError};

/// Maximum number of mistakes listed for one file [-].
pub(crate) const MISTAKES_MAX: usize = 50;

/// Value with the byte range from which it was read.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Placed<T> {
    pub value: T,
    pub span: Range<usize>,
}

impl<T> Placed<T> {
    /// Returns another value with the same byte range.
    pub(crate) fn with<U>(&self, value: U) -> Placed<U> {
        let span = self.span.clone();
        Placed { value, span }
    }
}

/// Mistakes and remarks collected while reading.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    pub mistakes: Vec<SceneError>,
    /// Mistakes in the supplement of the file.
    pub of_supplement: Vec<String>,
    remarks: Vec<Remark>,
}

/// Remark on a part of the file.
#[derive(Debug, Clone)]
struct Remark {
    /// First byte of the part; `None` for the whole file.
    byte: Option<usize>,
    text: String,
}

impl Findings {
    /// Adds a mistake: its subject, its byte range, and the problem with a correction.
    pub(crate) fn mistake(&mut self, at: impl Into<String>, span: Range<usize>, problem: impl Into<String>) {
        if self.mistakes.len() < MISTAKES_MAX {
            self.mistakes.push(SceneError {
                at: at.into(),
                problem: problem.into(),
                span: Some(span),
            });
        }
    }

    /// Adds a mistake in a value.
    pub(crate) fn wrong<T>(&mut self, at: impl Into<String>, placed: &Placed<T>, problem: impl Into<String>) {
        self.mistake(at, placed.span.clone(), problem);
    }

    /// Adds a remark on a value.
    pub(crate) fn remark<T>(&mut self, placed: &Placed<T>, text: impl Into<String>) {
        self.remark_at(placed.span.start, text);
    }

    /// Adds a remark on the text from a byte on.
    pub(crate) fn remark_at(&mut self, byte: usize, text: impl Into<String>) {
        let (byte, text) = (Some(byte), text.into());
        self.remarks.push(Remark { byte, text });
    }

    /// Adds a remark on the whole file.
    pub(crate) fn remark_on_all(&mut self, text: impl Into<String>) {
        let (byte, text) = (None, text.into());
        self.remarks.push(Remark { byte, text });
    }

    /// Returns the remarks with their line numbers, in the order of the file; those on the whole file come first.
    pub(crate) fn notes(mut self, source: &str) -> Vec<Note> {
        self.remarks.sort_by_key(|remark| remark.byte);
        let at = |byte: usize| format!("file line {}", line_column(source, byte).0);
        let note = |remark: Remark| Note::new(remark.byte.map_or("file".to_string(), at), remark.text);
        self.remarks.into_iter().map(note).collect()
    }
}
