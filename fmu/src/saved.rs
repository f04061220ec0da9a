//! A saved state of an instance, in memory and as bytes.

use moorline::interface::HostInputs;
use moorline::output::sealed::{self, Unreadable};
use moorline::simulation::{self, Inputs};
use serde::{Deserialize, Serialize};

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

const MARK: &str = "moorline state 2";

/// Beginning of the states of the FMU with a token.
fn mark(token: &str) -> Vec<u8> {
    [MARK, token].concat().into_bytes()
}

impl Snapshot {
    /// As bytes that only an FMU with the same token reads.
    pub(crate) fn to_bytes(&self, token: &str) -> Vec<u8> {
        sealed::seal(&mark(token), self)
    }

    /// Reads the bytes of [`Snapshot::to_bytes`].
    pub(crate) fn from_bytes(bytes: &[u8], token: &str) -> Result<Snapshot, String> {
        sealed::open(&mark(token), bytes).map_err(|reason| {
            let reason = match reason {
                Unreadable::Mark if bytes.starts_with(MARK.as_bytes()) => {
                    "this state was saved by another FMU"
                }
                Unreadable::Mark => "these bytes are no saved state of this moorline version",
                Unreadable::Damaged => "the saved state is cut short or was changed",
            };
            reason.to_string()
        })
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
        let bytes = snapshot().to_bytes("token");
        let back = Snapshot::from_bytes(&bytes, "token").unwrap();
        assert_eq!(back, snapshot());
        assert_eq!(back.time.to_bits(), (1.0_f64 / 3.0).to_bits());
        assert_eq!(back.parameters[1].to_bits(), (-0.0_f64).to_bits());
    }

    #[test]
    fn a_state_of_another_fmu_and_a_damaged_one_are_refused_with_the_reason() {
        let bytes = snapshot().to_bytes("token");
        let message = Snapshot::from_bytes(&bytes, "other").unwrap_err();
        assert!(message.contains("another FMU"), "{message}");
        let message = Snapshot::from_bytes(&bytes[1..], "token").unwrap_err();
        assert!(message.contains("no saved state"), "{message}");
        let message = Snapshot::from_bytes(&bytes[..bytes.len() - 1], "token").unwrap_err();
        assert!(message.contains("cut short"), "{message}");
    }
}
