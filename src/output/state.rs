//! The saved state of a run that is to be continued.
//!
//! Bytes: mark with the version, SHA-256 of what follows, then the state in postcard. Bytes of another version, truncated or changed ones are refused.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::files::Marks;
use super::record::Course;
use super::{OutputError, write_file};
use crate::simulation::Snapshot;

/// Name of the file in the folder of the run.
pub const FILE: &str = "run.state";

const MARK: &str = concat!("moorline run 2 ", env!("CARGO_PKG_VERSION"), "\n");
/// Bytes of the check sum.
const SUM: usize = 32;

/// State of a run between two rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunState {
    /// The scene as given, with the motion of the command line, as TOML.
    pub scene: String,
    /// Coupling of the motion, in words.
    pub coupling: String,
    /// The scene that is simulated: with elements, integrator and step.
    pub discretised: String,
    /// The simulation.
    pub snapshot: Snapshot,
    /// Ranges and histories of the rows so far.
    pub course: Course,
    /// Positions in the files.
    pub marks: Marks,
}

impl RunState {
    /// Writes the state into the folder of the run, in place of an older one once it is complete.
    ///
    /// # Errors
    /// The operating system refuses.
    pub fn write(&self, folder: &Path) -> Result<(), OutputError> {
        let body = postcard::to_stdvec(self).expect("every state can be written");
        write_file(&folder.join(FILE), |w| {
            w.write_all(MARK.as_bytes())?;
            w.write_all(&Sha256::digest(&body))?;
            w.write_all(&body)
        })
    }

    /// Reads the state from the folder of a run.
    ///
    /// # Errors
    /// No state, or one that this version did not write.
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
        let rest = bytes.strip_prefix(MARK.as_bytes());
        let rest = rest
            .ok_or_else(|| refuse("not a state of this version of moorline: run the scene from the start"))?;
        let damaged = || refuse("damaged: run the scene from the start");
        let (sum, body) = rest.split_at_checked(SUM).ok_or_else(damaged)?;
        if sum != Sha256::digest(body).as_slice() {
            return Err(damaged());
        }
        postcard::from_bytes(body).map_err(|_| damaged())
    }

    /// Removes the state from the folder of a run that is complete.
    pub fn remove(folder: &Path) {
        // one that cannot be removed is refused when it is read: the files have changed
        let _ = fs::remove_file(folder.join(FILE));
    }
}
