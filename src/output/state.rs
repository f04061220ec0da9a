//! Saved state of a run that is to be continued.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::files::Marks;
use super::record::Course;
use super::sealed::{self, Unreadable};
use super::{OutputError, write_file};
use crate::simulation::Snapshot;

/// Name of the file in the folder of the run.
pub const FILE: &str = "run.state";

const MARK: &str = concat!("moorline run 3 ", env!("CARGO_PKG_VERSION"), "\n");

/// State of a run between two rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunState {
    /// The scene as given, with the motion of the command line, as TOML.
    pub scene: String,
    /// Coupling of the motion, in words.
    pub coupling: String,
    /// The simulated scene, with elements, integrator and step.
    pub discretised: String,
    /// The simulation.
    pub snapshot: Snapshot,
    /// Ranges and histories of the rows so far.
    pub course: Course,
    /// Positions in the files.
    pub marks: Marks,
}

impl RunState {
    /// Writes the state into the folder of the run; it replaces an older one when it is complete.
    ///
    /// # Errors
    /// The operating system refuses.
    pub fn write(&self, folder: &Path) -> Result<(), OutputError> {
        let bytes = sealed::seal(MARK.as_bytes(), self);
        write_file(&folder.join(FILE), |w| w.write_all(&bytes))
    }

    /// Reads the state from the folder of a run.
    ///
    /// # Errors
    /// There is no state, it is damaged, or another version wrote it.
    pub fn read(folder: &Path) -> Result<RunState, OutputError> {
        let path = folder.join(FILE);
        let refuse = |problem: &str| OutputError::State {
            path: path.clone(),
            problem: problem.to_string(),
        };
        let bytes = fs::read(&path).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => {
                refuse("not found: no run was interrupted in this folder, or the run is complete")
            }
            _ => refuse(&error.to_string()),
        })?;
        sealed::open(MARK.as_bytes(), &bytes).map_err(|reason| match reason {
            Unreadable::Mark => {
                refuse("not a state of this version of moorline: run the scene from the start")
            }
            Unreadable::Damaged => refuse("damaged: run the scene from the start"),
        })
    }

    /// Removes the state from the folder of a completed run.
    pub fn remove(folder: &Path) {
        // a state that cannot be removed is refused when it is read: the files have changed
        let _ = fs::remove_file(folder.join(FILE));
    }
}
