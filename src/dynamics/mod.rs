//! Dynamics: how a mooring moves in time.

pub mod implicit;
pub mod quasi_static;

/// Why a step could not be made. The state is as it was before.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("t = {time:.6} s, line \"{line}\", node {node}: {reason}; {advice}")]
pub struct StepError {
    /// Time that could not be passed [s].
    pub time: f64,
    /// Line where the forces are furthest out of balance.
    pub line: String,
    /// Its node, from 0 at end A.
    pub node: usize,
    /// What went wrong.
    pub reason: String,
    /// What to try.
    pub advice: &'static str,
}
