//! Time integration of the discrete lines: which integrator serves which network, and how far it steps.

pub mod advance;
pub mod axial_implicit;
mod layout;
pub mod leapfrog;
pub mod limit;
pub mod motion;
pub mod network;
pub mod reaction;

/// A step that could not be taken. The state is as it was before.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("at t = {time} s, line {line}, node {node}: {reason}; {advice}")]
pub struct StepError {
    /// Time at which it failed [s].
    pub time: f64,
    /// Name of the line.
    pub line: String,
    /// Index of the node from end A.
    pub node: usize,
    /// What happened.
    pub reason: String,
    /// What to try.
    pub advice: String,
}
