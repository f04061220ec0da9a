//! Time integration of the discrete lines: which integrator serves which network, and how far it steps.

pub mod advance;
pub mod axial_implicit;
pub mod beam;
mod choice;
mod cost;
mod creep;
pub mod implicit;
mod layout;
pub mod leapfrog;
pub mod ledger;
pub mod limit;
pub mod motion;
pub mod network;
pub mod quasi_static;
pub mod reaction;
mod sea;
pub mod step;
mod surface;
mod threads;

pub use choice::Choice;
pub use cost::AXIAL_IMPLICIT_COST;
pub use threads::{Aside, as_worker, is_worker, make_threads_aside};

/// Why a step could not be made. The state is as it was before.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("t = {time:.6} s, line \"{line}\", node {node}: {reason}; {advice}")]
pub struct StepError {
    /// Time that could not be passed [s].
    pub time: f64,
    /// Line where it went wrong.
    pub line: String,
    /// Its node, from 0 at end A.
    pub node: usize,
    /// What went wrong.
    pub reason: String,
    /// What to try.
    pub advice: &'static str,
}
