//! Which integrator serves which network, and how far it steps.
//!
//! The explicit leapfrog costs least a step; its axial-implicit variant costs about four times as much and is chosen where
//! the axial limit is more than four times below the transverse one, which both must keep.

use serde::{Deserialize, Serialize};

use super::StepError;
use super::axial_implicit::AxialWork;
use super::leapfrog::Step;
use super::limit::{explicit_step, transverse_step};
use super::network::NetworkWork;
use crate::model::{End, Kinematics, Model, Network, State};
use crate::scene::Integrator;

/// Cost of an axial-implicit step over that of an explicit one [-].
const AXIAL_IMPLICIT_COST: f64 = 4.0;
/// Spectral radius of the axial-implicit leapfrog where the scene gives none [-].
const AXIAL_SPECTRAL_RADIUS: f64 = 0.9;
/// Margin on the static tension for the transverse limit: snaps exceed it [-].
const SNAP_MARGIN: f64 = 3.0;
/// A failed step is tried again with half the internal step, at most so often [-].
const RETRIES_MAX: u32 = 6;

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

/// Work done in a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counters {
    /// Internal steps, of the network with the most.
    pub substeps: usize,
    /// Passes of implicit solves.
    pub passes: usize,
}

/// Scratch of all networks and the state being built.
#[derive(Debug, Clone)]
pub struct Workspace {
    networks: Vec<(Choice, Solver)>,
    next: State,
}

#[derive(Debug, Clone)]
enum Solver {
    Leapfrog(NetworkWork),
    AxialImplicit(AxialWork),
}

impl Workspace {
    /// Chooses integrators and allocates all scratch for a model that starts from `state`.
    pub fn new(model: &Model, state: &State, tension: impl Fn(usize) -> f64) -> Workspace {
        let networks = model
            .networks
            .iter()
            .map(|network| {
                let choice = choose(model, network, &tension);
                let solver = build(model, network, &choice);
                (choice, solver)
            })
            .collect();
        Workspace {
            networks,
            next: state.clone(),
        }
    }

    /// What was chosen, by network.
    pub fn choices(&self) -> impl Iterator<Item = &Choice> {
        self.networks.iter().map(|(choice, _)| choice)
    }

    /// Advances `state` by `span` [s]; `held` tells the kinematics of held points in that time.
    ///
    /// # Errors
    /// The state is untouched; the error says where and what to try.
    pub fn advance(
        &mut self,
        model: &Model,
        state: &mut State,
        span: f64,
        held: &impl Fn(usize, f64) -> Kinematics,
    ) -> Result<Counters, StepError> {
        self.next.clone_from(state);
        let mut counters = Counters::default();
        for ((choice, solver), network) in self.networks.iter_mut().zip(&model.networks) {
            let done = match solver {
                Solver::Leapfrog(work) => {
                    leapfrog(model, network, work, &mut self.next, span, choice, held)?
                }
                Solver::AxialImplicit(work) => {
                    axial_implicit(model, network, work, &mut self.next, span, choice, held)?
                }
            };
            counters.substeps = counters.substeps.max(done.substeps);
            counters.passes += done.passes;
        }
        self.next.time = state.time + span;
        for (index, point) in self.next.points.iter_mut().enumerate() {
            if model.points[index].free().is_none() {
                let k = held(index, self.next.time);
                (point.position, point.velocity, point.acceleration) =
                    (k.position, k.velocity, k.acceleration);
            }
        }
        for (line, shape) in model.lines.iter().zip(&mut self.next.lines) {
            let last = line.segment_count();
            for (node, point) in [0, last].into_iter().zip(line.ends) {
                shape.velocity[node] = self.next.points[point].velocity;
            }
        }
        std::mem::swap(state, &mut self.next);
        Ok(counters)
    }
}

fn choose(model: &Model, network: &Network, tension: &impl Fn(usize) -> f64) -> Choice {
    let least = |limit: &dyn Fn(usize) -> f64| {
        network
            .lines
            .iter()
            .map(|&line| limit(line))
            .fold(f64::INFINITY, f64::min)
    };
    let explicit_limit = least(&|line| explicit_step(&model.lines[line], 0.0));
    let transverse_limit =
        least(&|line| transverse_step(&model.lines[line], SNAP_MARGIN * tension(line)));
    let held_ends = network.free_points.is_empty();
    let integrator = match model.solver.integrator {
        Integrator::Auto
            if held_ends
                && AXIAL_IMPLICIT_COST * explicit_limit
                    < transverse_limit.min(model.solver.time_step_max) =>
        {
            Integrator::AxialImplicit
        }
        Integrator::Auto => Integrator::Leapfrog,
        chosen => chosen,
    };
    let step_max = match integrator {
        Integrator::Leapfrog => explicit_limit,
        _ => transverse_limit,
    };
    Choice {
        integrator,
        step_max: step_max.min(model.solver.time_step_max),
        explicit_limit,
        transverse_limit,
    }
}

fn build(model: &Model, network: &Network, choice: &Choice) -> Solver {
    match choice.integrator {
        Integrator::AxialImplicit => {
            let rho = model
                .solver
                .spectral_radius
                .unwrap_or(AXIAL_SPECTRAL_RADIUS);
            let line = &model.lines[network.lines[0]];
            Solver::AxialImplicit(AxialWork::new(line, rho, model.solver.negative_tension).expect("one strain measure a line"))
        }
        _ => Solver::Leapfrog(NetworkWork::new(model, network).expect("one strain measure a line")),
    }
}

/// Equal steps no longer than `step_max` over `span`, halved `retry` times.
fn substeps(span: f64, step_max: f64, retry: u32) -> usize {
    // a span of exactly one limit must not become two steps by rounding
    ((span / step_max * (1.0 - 1e-9)).ceil().max(1.0) as usize) << retry
}

fn leapfrog(
    model: &Model,
    network: &Network,
    work: &mut NetworkWork,
    state: &mut State,
    span: f64,
    choice: &Choice,
    held: &impl Fn(usize, f64) -> Kinematics,
) -> Result<Counters, StepError> {
    let t0 = state.time;
    for retry in 0..=RETRIES_MAX {
        work.load(network, state);
        let drag_rate = work.drag_rate(model, network);
        let count = substeps(span, choice.step_max.min(1.0 / drag_rate), retry);
        let drift = span / count as f64;
        let mut steps = state.lines[network.lines[0]].half_step.steps;
        work.put_ends(model, network, t0, drift, held);
        for k in 0..count {
            work.step(
                model,
                network,
                t0 + k as f64 * drift,
                Step::after(steps, drift),
                held,
            );
            steps = [drift, steps[0]];
        }
        if work.lines.iter().all(|line| line.broken_node().is_none()) {
            work.store(network, state, steps);
            return Ok(Counters {
                substeps: count,
                passes: count,
            });
        }
    }
    let broken = work
        .lines
        .iter()
        .zip(&network.lines)
        .find_map(|(work, line)| Some((*line, work.broken_node()?)));
    let (line, node) = broken.unwrap_or((network.lines[0], 0));
    Err(diverged(model, line, node, t0))
}

fn axial_implicit(
    model: &Model,
    network: &Network,
    work: &mut AxialWork,
    state: &mut State,
    span: f64,
    choice: &Choice,
    held: &impl Fn(usize, f64) -> Kinematics,
) -> Result<Counters, StepError> {
    let index = network.lines[0];
    let line = &model.lines[index];
    let t0 = state.time;
    for retry in 0..=RETRIES_MAX {
        work.load(&state.lines[index]);
        let count = substeps(span, choice.step_max, retry);
        let drift = span / count as f64;
        let mut steps = state.lines[index].half_step.steps;
        let mut passes = 0;
        for (end, &point) in [End::A, End::B].into_iter().zip(&line.ends) {
            let k = held(point, t0);
            work.put_end(end, k.position, k.velocity - 0.5 * drift * k.acceleration);
        }
        for k in 0..count {
            let t = t0 + (k + 1) as f64 * drift;
            let ends = line.ends.map(|point| held(point, t).position);
            passes += work.step(Step::after(steps, drift), ends);
            steps = [drift, steps[0]];
        }
        if work.broken_node().is_none() {
            work.store(&mut state.lines[index], steps);
            return Ok(Counters {
                substeps: count,
                passes,
            });
        }
    }
    Err(diverged(model, index, work.broken_node().unwrap_or(0), t0))
}

fn diverged(model: &Model, line: usize, node: usize, time: f64) -> StepError {
    StepError {
        time,
        line: model.lines[line].name.clone(),
        node,
        reason: "the motion grew without bound".into(),
        advice: "try a smaller solver.time_step_max or integrator = \"generalised_alpha\"".into(),
    }
}
