//! The state of a system as bytes: in words of eight bytes for hosts, and in files.
//!
//! Words: mark, number of bytes of the body, first eight bytes of the SHA-256 of the body; then the body, filled up with zeros. The body holds
//! a check sum of the deck's scene, the start and the snapshot of the simulation, so that a state of another deck is refused.

use std::path::Path;

use moorline::simulation::Snapshot;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::failure::{Code, Failure, Outcome};
use crate::system::{Start, System};

/// First word: `moorlin1` in bytes.
const MARK: u64 = u64::from_le_bytes(*b"moorlin1");
/// Words before the body.
pub const HEAD: usize = 3;
const WORD: usize = size_of::<u64>();

#[derive(Debug, Serialize, Deserialize)]
struct Body {
    version: String,
    scene: [u8; 32],
    start: Start,
    place: [Vec<f64>; 2],
    ahead: f64,
    snapshot: Snapshot,
}

fn damaged() -> Failure {
    Failure::new(
        Code::InvalidInput,
        "the data are no state of this version of moorline, or damaged: save it anew",
    )
}

fn sum(body: &[u8]) -> u64 {
    let digest = Sha256::digest(body);
    u64::from_le_bytes(std::array::from_fn(|i| digest[i]))
}

/// Number of words of a state by its first [`HEAD`] words.
///
/// # Errors
/// The words do not begin a state of moorline.
pub fn length(head: [u64; HEAD]) -> Outcome<usize> {
    let [mark, bytes, _] = head;
    let bytes = usize::try_from(bytes).ok().filter(|bytes| *bytes < 1 << 40);
    match bytes.filter(|_| mark == MARK) {
        Some(bytes) => Ok(HEAD + bytes.div_ceil(WORD)),
        None => Err(damaged()),
    }
}

impl System {
    fn check_sum_of_scene(&self) -> [u8; 32] {
        Sha256::digest(self.deck.scene.to_toml().as_bytes()).into()
    }

    /// The state as words.
    ///
    /// # Errors
    /// A system that was not started.
    pub fn serialize(&self) -> Outcome<Vec<u64>> {
        let body = Body {
            version: env!("CARGO_PKG_VERSION").to_string(),
            scene: self.check_sum_of_scene(),
            start: self.start.clone(),
            place: self.place.clone(),
            ahead: self.ahead,
            snapshot: self.simulation()?.snapshot().clone(),
        };
        let mut bytes = postcard::to_stdvec(&body).map_err(|error| {
            Failure::new(Code::Unhandled, format!("the state cannot be written: {error}"))
        })?;
        let mut words = vec![MARK, bytes.len() as u64, sum(&bytes)];
        bytes.resize(bytes.len().next_multiple_of(WORD), 0);
        let pieces = bytes.chunks_exact(WORD);
        words.extend(pieces.map(|piece| u64::from_le_bytes(std::array::from_fn(|i| piece[i]))));
        Ok(words)
    }

    /// Goes back to a state; a system that was not started then is.
    ///
    /// # Errors
    /// The words are no state of this deck; the system is unchanged.
    pub fn deserialize(&mut self, words: &[u64]) -> Outcome {
        let head = words.first_chunk::<HEAD>().copied().ok_or_else(damaged)?;
        let bytes: Vec<u8> = words[HEAD..].iter().flat_map(|word| word.to_le_bytes()).collect();
        let count = usize::try_from(head[1]).map_err(|_| damaged())?;
        let is_whole = length(head)? == words.len();
        let body = bytes.get(..count).filter(|_| is_whole).ok_or_else(damaged)?;
        if sum(body) != head[2] {
            return Err(damaged());
        }
        let body: Body = postcard::from_bytes(body).map_err(|_| damaged())?;
        if body.version != env!("CARGO_PKG_VERSION") {
            return Err(damaged());
        }
        if body.scene != self.check_sum_of_scene() {
            let message = "the state is that of another deck, or of lines with other lengths and stiffnesses";
            return Err(Failure::new(Code::InvalidInput, message));
        }
        self.resume(body)
    }

    fn resume(&mut self, body: Body) -> Outcome {
        if self.simulation.is_none() || self.start != body.start {
            let mut simulation = self.simulation_of(&body.start)?;
            simulation.restore(body.snapshot);
            self.simulation = Some(simulation);
            self.start = body.start;
        } else if let Some(simulation) = &mut self.simulation {
            simulation.restore(body.snapshot);
        }
        self.place = body.place;
        self.ahead = body.ahead;
        self.has_stepped = true;
        self.open_files()
    }

    /// Writes the state to a file.
    ///
    /// # Errors
    /// A system that was not started, or a file that the operating system refuses.
    pub fn save(&self, path: &Path) -> Outcome {
        let words = self.serialize()?;
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        std::fs::write(path, bytes).map_err(|error| {
            let message = format!("cannot write {}: {error}", path.display());
            Failure::new(Code::InvalidOutputFile, message)
        })
    }

    /// Goes back to the state of a file.
    ///
    /// # Errors
    /// The file cannot be read, or as [`System::deserialize`].
    pub fn load(&mut self, path: &Path) -> Outcome {
        let bytes = std::fs::read(path).map_err(|error| {
            let message = format!("cannot read {}: {error}", path.display());
            Failure::new(Code::InvalidInputFile, message)
        })?;
        if bytes.len() % WORD != 0 {
            return Err(damaged());
        }
        let pieces = bytes.chunks_exact(WORD);
        let words: Vec<u64> = pieces
            .map(|piece| u64::from_le_bytes(std::array::from_fn(|i| piece[i])))
            .collect();
        self.deserialize(&words)
    }
}
