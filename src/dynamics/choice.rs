//! Which integrator serves a network, and its largest step.
//!
//! The explicit leapfrog costs least a step. Its axial-implicit variant costs about four times as much and is chosen where
//! the axial limit lies more than four times below the step that accuracy allows; it serves single lines between held ends.
//! Networks joined at free points whose axial limit would need more than 25 steps for one of those are integrated fully
//! implicitly, and so are lines that mix strain measures or have nodes without mass.

use super::limit::{explicit_step, transverse_step};
use crate::model::{Line, Model, Network};
use crate::scene::Integrator;

/// Cost of an axial-implicit step over that of an explicit one [-].
const AXIAL_IMPLICIT_COST: f64 = 4.0;
/// Explicit steps for one that accuracy allows, above which a network is integrated implicitly [-].
const EXPLICIT_STEPS_MAX: f64 = 25.0;
/// Margin on the static tension for the transverse limit: snaps exceed it [-].
const SNAP_MARGIN: f64 = 3.0;

/// What was decided for a network, for the log and for `check`.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// Integrator.
    pub integrator: Integrator,
    /// Largest internal step [s].
    pub step_max: f64,
    /// Explicit axial limit [s].
    pub explicit_limit: f64,
    /// Transverse limit at three times the static tension [s].
    pub transverse_limit: f64,
}

impl Choice {
    /// For a network whose lines carry the static tensions that `tension` [N] tells.
    pub fn new(model: &Model, network: &Network, tension: &impl Fn(usize) -> f64) -> Choice {
        let least = |limit: &dyn Fn(usize) -> f64| {
            network.lines.iter().map(|&line| limit(line)).fold(f64::INFINITY, f64::min)
        };
        let explicit_limit = least(&|line| explicit_step(&model.lines[line]));
        let transverse_limit =
            least(&|line| transverse_step(&model.lines[line], SNAP_MARGIN * tension(line)));
        let longest = model.solver.time_step_max;
        let integrator = match model.solver.integrator {
            Integrator::Auto => choose(model, network, explicit_limit, transverse_limit.min(longest)),
            chosen => chosen,
        };
        let step_max = match integrator {
            Integrator::Leapfrog => explicit_limit,
            Integrator::AxialImplicit => transverse_limit,
            _ => longest,
        };
        Choice { integrator, step_max: step_max.min(longest), explicit_limit, transverse_limit }
    }
}

fn choose(model: &Model, network: &Network, explicit: f64, accurate: f64) -> Integrator {
    let lines = || network.lines.iter().map(|&line| &model.lines[line]);
    if lines().any(|line| !serves_kernels(line)) {
        return Integrator::GeneralisedAlpha;
    }
    let steps = accurate / explicit;
    if network.free_points.is_empty() && steps > AXIAL_IMPLICIT_COST {
        Integrator::AxialImplicit
    } else if steps > EXPLICIT_STEPS_MAX {
        Integrator::GeneralisedAlpha
    } else {
        Integrator::Leapfrog
    }
}

/// Whether the leapfrog kernels can take a line: one strain measure, and every node with a mass.
pub fn serves_kernels(line: &Line) -> bool {
    line.uniform_law().is_some() && line.nodes.mass_normal.iter().all(|mass| *mass > 0.0)
}
