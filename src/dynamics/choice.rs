//! Which integrator serves a network, and its largest step.
//!
//! The explicit leapfrog costs least a step. Its axial-implicit variant costs about three times as much and is chosen where
//! the axial limit lies more than three times below the step that accuracy allows; it serves single lines between held ends.
//! Networks joined at free points whose axial limit would need more than 25 steps for one of those are integrated fully
//! implicitly, and so are lines that bend, mix strain measures or have nodes without mass. Beams have an integrator of their own.

use super::limit::{
    axial_accuracy_step, explicit_step, free_point_step, heave_step, transverse_step,
};
use crate::model::{Line, Model, Network};
use crate::scene::Integrator;

/// Cost of an axial-implicit step over that of an explicit one [-].
pub const AXIAL_IMPLICIT_COST: f64 = 3.0;
/// Explicit steps for one that accuracy allows, above which a network is integrated implicitly [-].
const EXPLICIT_STEPS_MAX: f64 = 25.0;
/// Part of the transverse limit that no line needs to go below for accuracy: where axial waves are much faster than that,
/// the line stretches quasi-statically [-].
const AXIAL_RESOLUTION_MIN: f64 = 0.125;
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
    /// Integrator and step, and why.
    pub fn in_words(&self) -> String {
        let milli = |step: f64| format!("{:.3} ms", 1e3 * step);
        let (step, explicit) = (milli(self.step_max), milli(self.explicit_limit));
        match self.integrator {
            Integrator::Leapfrog if self.step_max < self.explicit_limit => {
                format!("explicit steps of at most {step}; axial waves would allow {explicit}")
            }
            Integrator::Leapfrog => {
                format!("explicit steps of at most {step}, which axial waves limit")
            }
            Integrator::AxialImplicit => format!(
                "axial tension implicit, steps of at most {step}: explicit ones, {AXIAL_IMPLICIT_COST} times cheaper, would be limited to \
                 {explicit} by axial waves"
            ),
            Integrator::QuasiStatic => "an equilibrium at every communication point".to_string(),
            _ => format!("fully implicit steps of at most {step}"),
        }
    }

    /// For a network whose lines carry the static tensions that `tension` [N] tells.
    pub fn new(model: &Model, network: &Network, tension: &impl Fn(usize) -> f64) -> Choice {
        let least = |limit: &dyn Fn(&Line) -> f64| {
            let lines = network.lines.iter().map(|&line| limit(&model.lines[line]));
            lines.fold(f64::INFINITY, f64::min)
        };
        let explicit_limit = network
            .free_points
            .iter()
            .map(|&point| free_point_step(model, point))
            .fold(least(&explicit_step), f64::min);
        let transverse_limit = network
            .lines
            .iter()
            .map(|&line| transverse_step(&model.lines[line], SNAP_MARGIN * tension(line)))
            .fold(f64::INFINITY, f64::min);
        let accurate = least(&|line| axial_accuracy_step(line, model.solver.tolerance))
            .max(AXIAL_RESOLUTION_MIN * transverse_limit)
            .min(transverse_limit);
        let longest = model.solver.time_step_max;
        let asked = model.solver.integrator;
        let integrator = match asked {
            Integrator::Auto => choose(model, network, explicit_limit, accurate.min(longest)),
            chosen => chosen,
        };
        let step_max = match integrator {
            Integrator::Leapfrog => explicit_limit,
            Integrator::AxialImplicit if asked == Integrator::Auto => {
                accurate.min(least(&heave_step))
            }
            Integrator::AxialImplicit => transverse_limit.min(least(&heave_step)),
            _ => longest,
        };
        Choice {
            integrator,
            step_max: step_max.min(longest),
            explicit_limit,
            transverse_limit,
        }
    }
}

fn choose(model: &Model, network: &Network, explicit: f64, accurate: f64) -> Integrator {
    let lines = || network.lines.iter().map(|&line| &model.lines[line]);
    if lines().any(|line| line.beam.is_some()) {
        return Integrator::Beam;
    }
    if lines().any(|line| !line.serves_leapfrog()) {
        return Integrator::GeneralisedAlpha;
    }
    if lines().any(|line| line.winch.is_some()) {
        return Integrator::Leapfrog;
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
