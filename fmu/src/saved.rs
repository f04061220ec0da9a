//! A saved state of an instance, in memory and as bytes.
//!
//! Bytes: mark, token of the FMU, length and SHA-256 of what follows, then the state in postcard. Bytes of another FMU or version, truncated or changed
//! ones are refused before any part is used.

use moorline::simulation::{self, Inputs};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::inputs::HostInputs;

/// Phase of an instance's life cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Phase {
    /// After instantiation or reset.
    Instantiated,
    /// Between entering and leaving initialization mode.
    Initialization,
    /// Stepping.
    Step,
    /// After terminate.
    Terminated,
    /// Between two parts of a communication step, while the host is called.
    Intermediate,
}

/// All that changes in an instance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Snapshot {
    pub(crate) phase: Phase,
    /// Start of the simulation [s].
    pub(crate) start_time: f64,
    /// End of the simulation [s].
    pub(crate) stop_time: Option<f64>,
    /// The last communication point [s].
    pub(crate) time: f64,
    /// Parameters in the order of the interface.
    pub(crate) parameters: Vec<f64>,
    pub(crate) inputs: HostInputs,
    /// Inputs at which the statics were solved: the solver's choices there, such as its step limits, are not in its state and are made again from them.
    pub(crate) start: Inputs,
    /// The solver's state, once there is one.
    pub(crate) solver: Option<simulation::Snapshot>,
}

const MARK: &[u8; 16] = b"moorline state 1";
const LENGTH_BYTES: usize = 8;
const SUM_BYTES: usize = 32;

impl Snapshot {
    /// As bytes that only an FMU with the same token reads.
    pub(crate) fn to_bytes(&self, token: &str) -> Result<Vec<u8>, String> {
        let body = postcard::to_stdvec(self).map_err(|e| format!("the state cannot be written: {e}"))?;
        let mut bytes = MARK.to_vec();
        bytes.extend_from_slice(token.as_bytes());
        bytes.extend_from_slice(&(body.len() as u64).to_le_bytes());
        bytes.extend_from_slice(&Sha256::digest(&body));
        bytes.extend_from_slice(&body);
        Ok(bytes)
    }

    /// Reads the bytes of [`Snapshot::to_bytes`].
    pub(crate) fn from_bytes(bytes: &[u8], token: &str) -> Result<Snapshot, String> {
        let rest = bytes
            .strip_prefix(MARK)
            .ok_or("these bytes are no saved state of this moorline version")?;
        let rest = rest
            .strip_prefix(token.as_bytes())
            .ok_or("this state was saved by another FMU")?;
        let cut = "the saved state is cut short or has bytes too many";
        let (length, rest) = rest.split_at_checked(LENGTH_BYTES).ok_or(cut)?;
        let (sum, body) = rest.split_at_checked(SUM_BYTES).ok_or(cut)?;
        if length != (body.len() as u64).to_le_bytes() {
            return Err(cut.into());
        }
        if sum != Sha256::digest(body).as_slice() {
            return Err("the saved state was changed: its check sum does not fit".into());
        }
        postcard::from_bytes(body).map_err(|e| format!("the saved state cannot be read: {e}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn snapshot() -> Snapshot {
        Snapshot {
            phase: Phase::Step,
            start_time: 0.1,
            stop_time: None,
            time: 1.0 / 3.0,
            parameters: vec![9.80665, -0.0],
            inputs: HostInputs::default(),
            start: Inputs::default(),
            solver: None,
        }
    }

    #[test]
    fn a_state_survives_its_bytes_to_the_last_bit() {
        let bytes = snapshot().to_bytes("token").unwrap();
        let back = Snapshot::from_bytes(&bytes, "token").unwrap();
        assert_eq!(back, snapshot());
        assert_eq!(back.time.to_bits(), (1.0_f64 / 3.0).to_bits());
        assert_eq!(back.parameters[1].to_bits(), (-0.0_f64).to_bits());
    }

    #[test]
    fn every_truncation_and_every_changed_byte_is_refused() {
        let bytes = snapshot().to_bytes("token").unwrap();
        for length in 0..bytes.len() {
            assert!(Snapshot::from_bytes(&bytes[..length], "token").is_err());
        }
        for index in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[index] ^= 0x10;
            assert!(Snapshot::from_bytes(&changed, "token").is_err(), "{index}");
        }
        let longer = [bytes.as_slice(), b"x"].concat();
        assert!(Snapshot::from_bytes(&longer, "token").is_err());
    }

    #[test]
    fn a_state_of_another_fmu_is_refused_by_name() {
        let bytes = snapshot().to_bytes("token").unwrap();
        let message = Snapshot::from_bytes(&bytes, "other").unwrap_err();
        assert!(message.contains("another FMU"), "{message}");
    }
}
