//! What is wrong with a scene, where, and what would be right.

use std::ops::Range;

/// A mistake in the user's scene.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{at}: {problem}")]
pub struct SceneError {
    /// Key path, such as `line_types.chain.diameter` or `lines[2].sections[0].length`.
    pub at: String,
    /// What is wrong, and what would be right.
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
}
