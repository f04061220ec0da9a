//! Mistakes and remarks on a deck, with their bytes in the file.

use std::ops::Range;

use moorline::scene::path::line_column;
use moorline::scene::{Note, SceneError};

/// Greatest number of mistakes that are listed for one file.
pub(crate) const MISTAKES_MAX: usize = 50;

/// A value and the bytes it was read from.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Placed<T> {
    pub value: T,
    pub span: Range<usize>,
}

impl<T> Placed<T> {
    /// Another value read from the same bytes.
    pub(crate) fn with<U>(&self, value: U) -> Placed<U> {
        let span = self.span.clone();
        Placed { value, span }
    }
}

/// Mistakes and remarks found so far.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    pub mistakes: Vec<SceneError>,
    /// Mistakes in the supplement of the file.
    pub of_supplement: Vec<String>,
    remarks: Vec<Remark>,
}

/// A remark on a part of the file.
#[derive(Debug, Clone)]
struct Remark {
    /// First byte of the part; `None` for the whole file.
    byte: Option<usize>,
    text: String,
}

impl Findings {
    /// Adds a mistake: what it is about, where, what would be right.
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

    /// Adds a remark on the text at a byte.
    pub(crate) fn remark_at(&mut self, byte: usize, text: impl Into<String>) {
        let (byte, text) = (Some(byte), text.into());
        self.remarks.push(Remark { byte, text });
    }

    /// Adds a remark on the whole file.
    pub(crate) fn remark_on_all(&mut self, text: impl Into<String>) {
        let (byte, text) = (None, text.into());
        self.remarks.push(Remark { byte, text });
    }

    /// The remarks with the numbers of their lines, in the order of the file; those on the whole file first.
    pub(crate) fn notes(mut self, source: &str) -> Vec<Note> {
        self.remarks.sort_by_key(|remark| remark.byte);
        let at = |byte: usize| format!("file line {}", line_column(source, byte).0);
        let note = |remark: Remark| Note::new(remark.byte.map_or("file".to_string(), at), remark.text);
        self.remarks.into_iter().map(note).collect()
    }
}
