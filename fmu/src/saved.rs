//! Saved state of an instance, in memory and as bytes.

use moorline::interface::HostInputs;
use moorline::output::sealed::{self, Unreadable};
use moorline::simulation::{self, Inputs};
use serde::{Deserialize, Serialize};

/// Phase of an instance's life cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Phase {
    /// After instantiation or reset.
    Instantiated,
    /// In initialization mode.
    Initialization,
    /// In step mode.
    Step,
    /// After terminate.
    Terminated,
    /// Between two parts of a communication step, while the host is called.
    Intermediate,
}

/// Everything that changes in an instance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Snapshot {
    pub(crate) phase: Phase,
    /// Start of the simulation [s].
    pub(crate) start_time: f64,
    /// End of the simulation [s].
    pub(crate) stop_time: Option<f64>,
    /// Last communication point [s].
    pub(crate) time: f64,
    /// Parameters in the order of the interface.
    pub(crate) parameters: Vec<f64>,
    pub(crate) inputs: HostInputs,
    /// Inputs used in the static solution. Quantities derived from it, such as step limits, are not part of the solver's state and are computed again.
    pub(crate) start: Inputs,
    /// State of the solver; `None` before the statics are solved.
    pub(crate) solver: Option<simulation::Snapshot>,
}

const MARK: &str = "moorline state 2";

/// Returns the first bytes of the states of the FMU with this token.
fn mark(token: &str) -> Vec<u8> {
    [MARK, token].concat().into_bytes()
}

impl Snapshot {
    /// Serialises the state; only an FMU with the same token accepts the bytes.
    pub(crate) fn to_bytes(&self, token: &str) -> Vec<u8> {
        sealed::seal(&mark(token), self)
    }

    /// Reads bytes written by [`Snapshot::to_bytes`].
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
