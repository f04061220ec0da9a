//! State of a system as bytes: sealed in files, and in words of eight bytes for hosts.
//!
//! Words: the number of sealed bytes, then the sealed bytes, padded with zeros. The state contains the SHA-256 of the deck's scene, the start and the
//! snapshot of the simulation, so that a state of another deck is refused.

use std::path::Path;

use moorline::output::sealed;
use moorline::scene::Scene;
use moorline::simulation::{Snapshot, Watch};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::failure::{Code, Failure, Outcome};
use crate::system::{Start, System};

/// Mark of a state: one word.
const MARK: [u8; WORD] = *b"moorlin3";
/// Number of words with the length and the mark of a state.
pub const HEAD: usize = 2;
const WORD: usize = size_of::<u64>();

/// State as it is written and read.
#[derive(Debug, Serialize, Deserialize)]
struct Body {
    version: String,
    scene: [u8; 32],
    start: Start,
    motion: [Vec<f64>; 3],
    ahead: f64,
    snapshot: Snapshot,
}

fn damaged() -> Failure {
    Failure::new(
        Code::InvalidInput,
        "the data are no state of this version of moorline, or damaged: save it anew",
    )
}

/// SHA-256 of a scene.
pub(crate) fn check_sum(scene: &Scene) -> [u8; 32] {
    Sha256::digest(scene.to_toml().as_bytes()).into()
}

/// Returns the number of words of a state from its first [`HEAD`] words.
///
/// # Errors
/// The words do not begin a state of moorline.
pub fn length(head: [u64; HEAD]) -> Outcome<usize> {
    let [bytes, mark] = head;
    let bytes = usize::try_from(bytes).ok().filter(|bytes| *bytes < 1 << 40);
    match bytes.filter(|_| mark.to_le_bytes() == MARK) {
        Some(bytes) => Ok(1 + bytes.div_ceil(WORD)),
        None => Err(damaged()),
    }
}

impl System {
    /// Serialises the state as words.
    ///
    /// # Errors
    /// The system was not started.
    pub fn serialize(&self) -> Outcome<Vec<u64>> {
        let mut bytes = self.sealed()?;
        let mut words = vec![bytes.len() as u64];
        bytes.resize(bytes.len().next_multiple_of(WORD), 0);
        let pieces = bytes.chunks_exact(WORD);
        words.extend(pieces.map(|piece| u64::from_le_bytes(std::array::from_fn(|i| piece[i]))));
        Ok(words)
    }

    fn sealed(&self) -> Outcome<Vec<u8>> {
        let body = Body {
            version: env!("CARGO_PKG_VERSION").to_string(),
            scene: self.scene_sum,
            start: self.start.clone(),
            motion: self.motion.clone(),
            ahead: self.ahead,
            snapshot: self.simulation()?.snapshot().clone(),
        };
        Ok(sealed::seal(&MARK, &body))
    }

    /// Restores a state; starts the system if it has not been started.
    ///
    /// # Errors
    /// The words are not a state of this deck; the system is unchanged.
    pub fn deserialize(&mut self, words: &[u64]) -> Outcome {
        let head = words.first_chunk::<HEAD>().copied().ok_or_else(damaged)?;
        if length(head)? != words.len() {
            return Err(damaged());
        }
        let bytes: Vec<u8> = words[1..].iter().flat_map(|word| word.to_le_bytes()).collect();
        self.unseal(&bytes[..head[0] as usize])
    }

    fn unseal(&mut self, bytes: &[u8]) -> Outcome {
        let body: Body = sealed::open(&MARK, bytes).map_err(|_| damaged())?;
        if body.version != env!("CARGO_PKG_VERSION") {
            return Err(damaged());
        }
        if self.simulation.is_none() {
            self.scene_sum = check_sum(&self.deck.scene);
        }
        if body.scene != self.scene_sum {
            let message = "the state is that of another deck, or of lines with other lengths and stiffnesses";
            return Err(Failure::new(Code::InvalidInput, message));
        }
        self.resume(body)
    }

    fn resume(&mut self, body: Body) -> Outcome {
        if self.simulation.is_none() || self.start != body.start {
            let mut simulation = self.simulation_of(&body.start)?;
            simulation.restore(body.snapshot);
            self.watch = Some(Watch::new(&self.deck.scene, &simulation));
            self.simulation = Some(simulation);
            self.start = body.start;
        } else if let Some(simulation) = &mut self.simulation {
            simulation.restore(body.snapshot);
            if let Some(watch) = &mut self.watch {
                watch.resume(simulation);
            }
        }
        self.motion = body.motion;
        self.ahead = body.ahead;
        self.has_stepped = true;
        self.open_files()
    }

    /// Writes the state to a file.
    ///
    /// # Errors
    /// The system was not started, or the operating system refuses the file.
    pub fn save(&self, path: &Path) -> Outcome {
        std::fs::write(path, self.sealed()?).map_err(|error| {
            let message = format!("cannot write {}: {error}", path.display());
            Failure::new(Code::InvalidOutputFile, message)
        })
    }

    /// Restores the state from a file.
    ///
    /// # Errors
    /// The file cannot be read, or as [`System::deserialize`].
    pub fn load(&mut self, path: &Path) -> Outcome {
        let bytes = std::fs::read(path).map_err(|error| {
            let message = format!("cannot read {}: {error}", path.display());
            Failure::new(Code::InvalidInputFile, message)
        })?;
        self.unseal(&bytes)
    }
}
