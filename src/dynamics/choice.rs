//! Choice of a network's integrator and its longest step.
//!
//! The choice is the integrator that can handle the network and costs least per second of motion. The explicit leapfrog
//! costs least per step, and its steps are limited by axial waves. A step of its axial-implicit variant costs two to
//! three times as much. The length of these steps follows from accuracy: they resolve the axial waves of single lines and
//! the elastic oscillation of free points. If the scene selects this variant, its steps are the longest that transverse
//! waves allow under the current tensions: on lindahl_slow it takes 0.7 times as many steps as under three times the
//! static tension throughout, with the same errors. A step of generalised-α costs about fifty times as much as an explicit
//! one. It is considered for networks joined at free points, and for single lines whose slowest wave passes through them
//! within the longest step allowed, such as a taut line of almost no mass: they are at rest in every step, at any step size.
//!
//! Where axial waves are much faster than transverse ones, the line stretches quasi-statically, and longer steps suffice. A host whose positions jump
//! by ½aΔt² at communication points (`input_reconstruction = "jump"`) starts axial waves there. The steps then resolve these waves: otherwise they
//! persist until the host reads the force, which was off by 6 % on average on a cable of 30 elements in steps of 10 ms.
//!
//! Fully implicit steps may also cost least for lines that bend: the joints of short elements are as stiff as a tension of 4EI/l². Their steps,
//! axial-implicit or fully implicit, are as long as stability allows; convergence trials judge the error of these steps ([`crate::discretisation`]).
//! Lines that mix strain measures, have nodes without mass or have damped joints are always integrated fully implicitly. Beams have a separate
//! integrator.

use super::cost::{AXIAL_IMPLICIT_COST, IMPLICIT_COST};
use super::limit::{
    ExplicitLimit, axial_accuracy_step, end_shares, explicit_limit, free_point_limit, heave_step,
    jump_accuracy_step, point_accuracy_step, point_heave_step, transverse_period, transverse_step,
};
use crate::model::{Line, Model, Network, Role};
use crate::scene::{Integrator, Reconstruction};

/// Shortest accurate step relative to the transverse limit [-]: axial waves that would need shorter steps are so fast
/// that the line stretches quasi-statically.
const AXIAL_RESOLUTION_MIN: f64 = 0.125;
/// Factor on the static tension for the transverse limit [-]: snaps exceed the static tension.
const SNAP_MARGIN: f64 = 3.0;

/// Integrator and step limits chosen for a network.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// Integrator.
    pub integrator: Integrator,
    /// Longest internal step [s]; where [`Self::longest`] is greater, the limit at three times the static tension.
    pub step_max: f64,
    /// Longest internal step under lower tensions [s].
    pub longest: f64,
    /// Limit on explicit steps.
    pub explicit: ExplicitLimit,
}

impl Choice {
    /// Describes the integrator and its steps, with the reason.
    pub fn in_words(&self) -> String {
        let (step, explicit) = (seconds(self.step_max), seconds(self.explicit.step));
        match self.integrator {
            Integrator::Leapfrog if self.step_max < self.explicit.step => {
                format!("explicit, steps up to {step} (axial waves and dampers would allow {explicit})")
            }
            Integrator::Leapfrog => {
                format!("explicit, steps up to {step}, limited by axial waves and dampers")
            }
            Integrator::AxialImplicit => {
                let steps = match self.longest > self.step_max {
                    true => format!(
                        "{} ({step} at three times the static tension)",
                        seconds(self.longest)
                    ),
                    false => step,
                };
                format!(
                    "axial-implicit, steps up to {steps}; explicit steps would cost less each but axial waves would limit them to {explicit}"
                )
            }
            Integrator::GeneralisedAlpha if IMPLICIT_COST * self.explicit.step < self.step_max => {
                format!(
                    "implicit, steps up to {step}; explicit steps would cost {IMPLICIT_COST} times less but be limited to {explicit}"
                )
            }
            Integrator::QuasiStatic => "equilibrium at every communication point".to_string(),
            _ => format!("implicit, steps up to {step}"),
        }
    }

    /// Chooses the integrator of a network; `tension` returns the static tension of a line [N].
    pub fn new(model: &Model, network: &Network, tension: &impl Fn(usize) -> f64) -> Choice {
        let least = |limit: &dyn Fn(&Line) -> f64| {
            let lines = network.lines.iter().map(|&line| limit(&model.lines[line]));
            lines.fold(f64::INFINITY, f64::min)
        };
        let lines = network.lines.iter();
        let of_lines = lines.map(|&line| explicit_limit(&model.lines[line]));
        let points = network.free_points.iter();
        let of_points = points.map(|&point| free_point_limit(model, point));
        let explicit = of_lines
            .chain(of_points)
            .fold(ExplicitLimit::none(), ExplicitLimit::or);
        let transverse_limit = network
            .lines
            .iter()
            .map(|&line| {
                let (own, tension) = (&model.lines[line], SNAP_MARGIN * tension(line));
                transverse_step(own, tension + own.greatest_push(), end_shares(model, own))
            })
            .fold(f64::INFINITY, f64::min);
        let tolerance = model.solver.tolerance;
        let least_of_points = |limit: &dyn Fn(usize) -> f64| {
            let points = network.free_points.iter().map(|&point| limit(point));
            points.fold(f64::INFINITY, f64::min)
        };
        let accurate = match network.free_points.is_empty() {
            true => least(&|line| axial_accuracy_step(line, tolerance)),
            false => least_of_points(&|point| point_accuracy_step(model, point, tolerance)),
        };
        let of_jumps = jump_step(model, network);
        let accurate = match bends(model, network) {
            true => transverse_limit,
            false => accurate
                .max(AXIAL_RESOLUTION_MIN * transverse_limit)
                .min(transverse_limit),
        };
        let accurate = accurate.min(of_jumps);
        let longest = model.solver.time_step_max;
        let longest_axial = least(&heave_step)
            .min(least_of_points(&|point| point_heave_step(model, point)))
            .min(longest);
        let asked = model.solver.integrator;
        let steps = Steps {
            explicit: explicit.step.min(longest),
            axial: accurate.min(longest_axial),
            implicit: implicit_step(model, network).min(of_jumps),
        };
        let integrator = match asked {
            Integrator::Auto => choose(model, network, &steps, tension),
            chosen => chosen,
        };
        let step_max = match integrator {
            Integrator::Leapfrog => steps.explicit,
            Integrator::AxialImplicit if asked == Integrator::Auto => steps.axial,
            Integrator::AxialImplicit => transverse_limit.min(longest_axial),
            Integrator::GeneralisedAlpha if asked == Integrator::Auto => steps.implicit,
            _ => longest,
        };
        let step_max = step_max.min(longest);
        Choice {
            integrator,
            step_max,
            longest: match asked {
                Integrator::AxialImplicit => longest_axial,
                _ => step_max,
            },
            explicit,
        }
    }
}

/// Formats a time [s] in a suitable multiple of the second, with four digits.
fn seconds(time: f64) -> String {
    let (scale, unit) = match time {
        t if t >= 1.0 => (1.0, "s"),
        t if t >= 1e-3 => (1e3, "ms"),
        t if t >= 1e-6 => (1e6, "µs"),
        _ => (1e9, "ns"),
    };
    let rounded = format!("{:.3e}", scale * time);
    format!("{} {unit}", rounded.parse().unwrap_or(scale * time))
}

/// Longest steps of a network with each integrator [s].
struct Steps {
    explicit: f64,
    axial: f64,
    implicit: f64,
}

/// Step that resolves the axial waves from jumps of the ends that a host moves [s]; infinite without jumps.
fn jump_step(model: &Model, network: &Network) -> f64 {
    let lines = || network.lines.iter().map(|&line| &model.lines[line]);
    let follows = |end: usize| {
        matches!(
            model.points[end].role,
            Role::Coupled { .. } | Role::Carried { .. }
        )
    };
    let jumps = model.solver.input_reconstruction == Reconstruction::Jump;
    if !jumps || !lines().flat_map(|line| line.ends).any(follows) {
        return f64::INFINITY;
    }
    let steps = lines().map(|line| jump_accuracy_step(line, model.solver.tolerance));
    steps.fold(f64::INFINITY, f64::min)
}

/// Step of generalised-α without jumps of the ends [s]. Where other integrators could also be chosen, it resolves the oscillation of free points.
fn implicit_step(model: &Model, network: &Network) -> f64 {
    let mut lines = network.lines.iter().map(|&line| &model.lines[line]);
    let choosy = lines.all(|line| line.serves_leapfrog() && line.bending.is_none());
    let points = network.free_points.iter().filter(|_| choosy);
    points
        .map(|&point| point_accuracy_step(model, point, model.solver.tolerance))
        .fold(model.solver.time_step_max, f64::min)
}

fn bends(model: &Model, network: &Network) -> bool {
    let mut lines = network.lines.iter();
    lines.any(|&line| model.lines[line].bending.is_some())
}

fn choose(model: &Model, network: &Network, steps: &Steps, tension: &impl Fn(usize) -> f64) -> Integrator {
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
    let joined = !network.free_points.is_empty();
    let at_rest =
        |&line: &usize| transverse_period(&model.lines[line], tension(line)) < model.solver.time_step_max;
    let quick = network.lines.iter().all(at_rest);
    let rates = [
        (Integrator::Leapfrog, 1.0 / steps.explicit, true),
        (Integrator::AxialImplicit, AXIAL_IMPLICIT_COST / steps.axial, true),
        (
            Integrator::GeneralisedAlpha,
            IMPLICIT_COST / steps.implicit,
            joined || quick || bends(model, network),
        ),
    ];
    let serving = rates.into_iter().filter(|&(_, _, serves)| serves);
    let cheapest = serving.min_by(|a, b| a.1.total_cmp(&b.1));
    cheapest.map_or(Integrator::Leapfrog, |(integrator, ..)| integrator)
}
