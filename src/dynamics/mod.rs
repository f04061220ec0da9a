//! Time integration of the discrete lines: choice of the integrator of each network, and its steps.

pub mod advance;
pub mod beam;
mod choice;
mod cost;
pub mod energy_balance;
pub mod implicit;
pub mod leapfrog;
pub mod limit;
pub mod motion;
pub mod quasi_static;
pub mod reaction;
mod sea;
mod threads;
mod viscoelastic;

use crate::model::Line;
use crate::statics::StaticsError;

pub use choice::Choice;
pub use cost::{IMPLICIT_COST, axial_implicit_cost, node_time};
pub use threads::{Aside, as_worker, is_worker, make_threads_aside};

/// Failed step, with its time, line and node. The state is unchanged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("t = {time:.6} s, line \"{line}\", node {node}: {cause}; {}", cause.advice())]
pub struct StepError {
    /// Time at which the step starts [s].
    pub time: f64,
    /// Name of the line.
    pub line: String,
    /// Node, from 0 at end A.
    pub node: usize,
    /// Cause.
    pub cause: StepFailure,
}

impl StepError {
    /// Failure of a step that starts at a time [s], at a node of a line.
    #[cold]
    pub(crate) fn new(time: f64, line: &Line, node: usize, cause: impl Into<StepFailure>) -> StepError {
        StepError {
            time,
            line: line.name.clone(),
            node,
            cause: cause.into(),
        }
    }
}

/// Cause of a failed step.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StepFailure {
    /// An input exceeds the bounds of the scene.
    #[error("{0}")]
    Input(String),
    /// A winch would leave the bounds of its line.
    #[error("{0}")]
    Winch(String),
    /// The communication step needs too many internal steps.
    #[error("the communication step of {length} s needs {count:.0e} internal steps of {step:.1e} s")]
    TooManySteps {
        /// Communication step [s].
        length: f64,
        /// Longest internal step [s].
        step: f64,
        /// Internal steps needed [-].
        count: f64,
    },
    /// Positions or velocities grew without bound, even in shorter steps.
    #[error("the motion grew without bound")]
    Unbounded,
    /// Newton's method of an implicit step did not converge.
    #[error(
        "Newton's method did not converge with a step of {step:.3e} s, {residual:.3e} N are out of balance"
    )]
    NotConverged {
        /// Shortest step tried [s].
        step: f64,
        /// Largest residual force [N].
        residual: f64,
    },
    /// A step of a beam failed.
    #[error(transparent)]
    Beam(#[from] beam::StuckReason),
    /// A quasi-static step has no equilibrium.
    #[error(transparent)]
    Statics(#[from] StaticsError),
}

impl StepFailure {
    /// Returns a remedy.
    pub fn advice(&self) -> &'static str {
        match self {
            StepFailure::Input(_) => "check the units of the motion, and whether the host is stable",
            StepFailure::Winch(_) => "keep its length_change within the bounds",
            StepFailure::TooManySteps { .. } => {
                "use shorter communication steps; if the internal steps are too short, check solver.time_step_max, masses, lengths and stiffnesses"
            }
            StepFailure::Unbounded => {
                "try a smaller solver.time_step_max, or solver.integrator = \"generalised_alpha\""
            }
            StepFailure::NotConverged { .. } => {
                "look for jumps in the motion of the driven points, give every line a mass, or lower solver.time_step_max"
            }
            StepFailure::Beam(reason) => reason.advice(),
            StepFailure::Statics(_) => {
                "communicate more often, or use a dynamic integrator if the lines lose their hold here"
            }
        }
    }
}
