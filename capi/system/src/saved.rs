//! The state of a system as bytes: in words of eight bytes for hosts, and in files.
//!
//! Words: mark, number of bytes of the body, FNV-1a of the words of the body; then the body, filled up with zeros. The body holds the SHA-256 of
//! the deck's scene, the start and the snapshot of the simulation, so that a state of another deck is refused.
//!
//! Source of the check sum, which detects damage but not tampering: Fowler, Noll & Vo, 64 bits, here over words.

use std::path::Path;

use moorline::scene::Scene;
use moorline::simulation::{Snapshot, Watch};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::failure::{Code, Failure, Outcome};
use crate::system::{Start, System};

/// First word: `moorlin2` in bytes.
const MARK: u64 = u64::from_le_bytes(*b"moorlin2");
/// Words before the body.
pub const HEAD: usize = 3;
const WORD: usize = size_of::<u64>();

/// A state as it is read.
#[derive(Debug, Deserialize)]
struct Body {
    version: String,
    scene: [u8; 32],
    start: Start,
    motion: [Vec<f64>; 3],
    ahead: f64,
    snapshot: Snapshot,
}

/// A state as it is written: as [`Body`], without copies.
#[derive(Debug, Serialize)]
struct BodyView<'a> {
    version: &'a str,
    scene: [u8; 32],
    start: &'a Start,
    motion: &'a [Vec<f64>; 3],
    ahead: f64,
    snapshot: &'a Snapshot,
}

fn damaged() -> Failure {
    Failure::new(
        Code::InvalidInput,
        "the data are no state of this version of moorline, or damaged: save it anew",
    )
}

/// Check sum of a state, without its own word.
fn sum(words: &[u64]) -> u64 {
    let mix = |sum: u64, word: &u64| (sum ^ word).wrapping_mul(0x0100_0000_01b3);
    std::iter::once(&words[1])
        .chain(&words[HEAD..])
        .fold(0xcbf2_9ce4_8422_2325, mix)
}

/// SHA-256 of a scene.
pub(crate) fn check_sum(scene: &Scene) -> [u8; 32] {
    Sha256::digest(scene.to_toml().as_bytes()).into()
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
    /// The state as words.
    ///
    /// # Errors
    /// A system that was not started.
    pub fn serialize(&self) -> Outcome<Vec<u64>> {
        let body = BodyView {
            version: env!("CARGO_PKG_VERSION"),
            scene: self.scene_sum,
            start: &self.start,
            motion: &self.motion,
            ahead: self.ahead,
            snapshot: self.simulation()?.snapshot(),
        };
        let mut bytes = postcard::to_stdvec(&body).map_err(|error| {
            Failure::new(Code::Unhandled, format!("the state cannot be written: {error}"))
        })?;
        let mut words = vec![MARK, bytes.len() as u64, 0];
        bytes.resize(bytes.len().next_multiple_of(WORD), 0);
        let pieces = bytes.chunks_exact(WORD);
        words.extend(pieces.map(|piece| u64::from_le_bytes(std::array::from_fn(|i| piece[i]))));
        words[2] = sum(&words);
        Ok(words)
    }

    /// Goes back to a state; a system that was not started then is.
    ///
    /// # Errors
    /// The words are no state of this deck; the system is unchanged.
    pub fn deserialize(&mut self, words: &[u64]) -> Outcome {
        let head = words.first_chunk::<HEAD>().copied().ok_or_else(damaged)?;
        if length(head)? != words.len() || sum(words) != head[2] {
            return Err(damaged());
        }
        let bytes: Vec<u8> = words[HEAD..].iter().flat_map(|word| word.to_le_bytes()).collect();
        let body: Body = postcard::from_bytes(&bytes).map_err(|_| damaged())?;
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
