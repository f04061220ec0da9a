//! TOML text -> Scene.

use super::{Scene, SceneError};

impl Scene {
    /// Reads and checks a scene.
    ///
    /// # Errors
    /// The first mistake, with its key path and its bytes in the text.
    pub fn from_toml(text: &str) -> Result<Scene, SceneError> {
        let scene: Scene = toml::from_str(text).map_err(|e| SceneError {
            at: String::new(),
            problem: e.message().to_string(),
            span: e.span(),
        })?;
        scene.check()?;
        Ok(scene)
    }
}
