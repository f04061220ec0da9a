//! Checks on a whole scene: values in range, names that exist.

use super::{Scene, SceneError};

impl Scene {
    /// Finds the first mistake.
    ///
    /// # Errors
    /// Names the key path and what would be right.
    pub fn check(&self) -> Result<(), SceneError> {
        Ok(())
    }
}
