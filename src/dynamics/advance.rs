//! One communication step of a whole model: each network is advanced by its integrator, in as many internal steps as it needs.

mod communication;

use serde::{Deserialize, Serialize};

use super::energy_balance::{self, Energy, Flow};
use super::implicit;
use super::motion::AxisPath;
use super::sea::SeaWork;
use super::threads::{ThreadPool, WorkEstimate};
use super::{Choice, StepError};
use crate::elements;
use crate::elements::friction::{drop_anchors, hold_at_rest};
use crate::model::{Kinematics, Model, Role, State};
use crate::physics::airy::Waves;
use crate::scene::{Integrator, Reconstruction};
use communication::{Communication, Scratch, Solver, within_guard};

/// Tolerance for rounding of times, relative to a step [-].
const ROUNDING: f64 = 1e-9;

/// Computational work of a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counters {
    /// Largest number of internal steps of any network.
    pub substeps: usize,
    /// Sum over all networks: force evaluations of the explicit leapfrog, closed-form catenaries of quasi-static networks that have them, and
    /// factorised systems of the other integrators.
    pub solves: usize,
}

/// Result of a communication step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Done {
    /// Computational work of the integrators.
    pub counters: Counters,
    /// Energy flow; zero if the scene has no energy balance.
    pub flow: Flow,
}

/// Integrators of all networks, their workspaces and the state under construction.
#[derive(Debug, Clone)]
pub struct Integrators {
    networks: Vec<NetworkSolver>,
    scratch: Vec<Scratch>,
    sea: SeaWork,
    /// State before a communication step that is integrated in parts.
    before: State,
    /// Paid-out lengths of the winches, by line; empty where there are none.
    winch_paths: Vec<AxisPath>,
    /// Time by which every step is cut short [s]; internal steps and wave samples are laid out for the uncut step.
    cut: f64,
    /// True if the leapfrogs' striped layout still holds the current state.
    holds: bool,
    threads: ThreadPool,
    estimate: WorkEstimate,
}

#[derive(Debug, Clone)]
struct NetworkSolver {
    choice: Choice,
    solver: Solver,
    outcome: Result<Done, StepError>,
}

impl Integrators {
    /// Chooses the integrators and allocates all workspaces for a model that starts from `state`; `tension` returns the
    /// static tension of a line [N].
    pub fn new(model: &Model, state: &State, tension: impl Fn(usize) -> f64) -> Integrators {
        let networks: Vec<NetworkSolver> = model
            .networks
            .iter()
            .map(|network| {
                let choice = Choice::new(model, network, &tension);
                NetworkSolver {
                    solver: Solver::new(model, network, choice.integrator),
                    choice,
                    outcome: Ok(Done::default()),
                }
            })
            .collect();
        let own = Scratch {
            implicit: elements::Workspace::serving(model, |number| networks[number].solver.has_elements()),
            next: state.clone(),
        };
        Integrators {
            threads: ThreadPool::default(),
            estimate: WorkEstimate::new(model, networks.iter().map(|network| &network.choice)),
            scratch: vec![own],
            networks,
            sea: SeaWork::new(),
            before: State::default(),
            winch_paths: Vec::new(),
            cut: 0.0,
            holds: false,
        }
    }

    /// Discards the leapfrogs' copy of the state. Required before a step from a state other than the one that
    /// [`Self::advance`] left.
    pub fn forget(&mut self) {
        self.holds = false;
    }

    /// Sets the paid-out lengths of the winches in the next step, by line.
    pub fn set_winch_paths(&mut self, paths: impl Iterator<Item = AxisPath>) {
        self.winch_paths.clear();
        self.winch_paths.extend(paths);
    }

    /// Cuts all further steps short by `cut` [s]. A cut step keeps the number of internal steps and the wave samples of the uncut one.
    pub fn cut_short(&mut self, cut: f64) {
        self.cut = cut;
    }

    /// Returns the integrators chosen, by network.
    pub fn choices(&self) -> impl Iterator<Item = &Choice> {
        self.networks.iter().map(|network| &network.choice)
    }

    /// Describes the number of threads for communication steps of `length` [s], with the reason.
    pub fn threads_in_words(&self, length: f64) -> String {
        self.estimate.describe(length)
    }

    /// Stored energy of the networks [J]; quasi-static networks have no kinetic energy.
    pub fn energy(&self, model: &Model, state: &State) -> Energy {
        let mut sum = Energy::default();
        for (NetworkSolver { solver, .. }, network) in self.networks.iter().zip(&model.networks) {
            let mut energy = energy_balance::energy(model, network, state);
            if matches!(solver, Solver::QuasiStatic) {
                energy.kinetic = 0.0;
            }
            sum.add(energy);
        }
        sum
    }

    /// Kinetic energy of the networks with a leapfrog [J]. The dissipation in their energy flow contains it.
    pub fn kinetic_energy_of_leapfrogs(&self, model: &Model, state: &State) -> f64 {
        let solvers = self.networks.iter().zip(&model.networks);
        let served = solvers.filter(|(network, _)| network.solver.is_leapfrog());
        served
            .map(|(_, network)| energy_balance::energy(model, network, state).kinetic)
            .sum()
    }

    /// Sets the initial accelerations of the implicit integrators in a state at rest.
    pub fn start(&mut self, model: &Model, state: &mut State, held: &impl Fn(usize, f64) -> Kinematics) {
        let time = state.time;
        drop_anchors(model, state);
        place_held(model, state, held);
        self.sea.start(model, state);
        let Scratch { implicit: work, next } = &mut self.scratch[0];
        for (number, network) in self.networks.iter().enumerate() {
            if matches!(network.solver, Solver::Implicit(_)) {
                hold_at_rest(model, &model.networks[number], state, time, work);
                implicit::start(model, number, state, held, time, work);
            }
        }
        next.clone_from(state);
    }

    /// Advances `state` by `length` [s]; `held` returns the kinematics of a prescribed point at a time [s] within the step.
    ///
    /// # Errors
    /// A network could not be advanced; the state is unchanged.
    pub fn advance(
        &mut self,
        model: &Model,
        state: &mut State,
        length: f64,
        held: &(impl Fn(usize, f64) -> Kinematics + Sync),
    ) -> Result<Done, StepError> {
        match &model.waves {
            None => self.pass(model, state, [length, length + self.cut], held),
            Some(waves) => self.advance_in(waves, model, state, length, held),
        }
    }

    /// [`Self::advance`] in waves. The step is divided into parts where the spans between wave samples do not cover it
    /// ([`SeaWork::reach`]).
    fn advance_in(
        &mut self,
        waves: &Waves,
        model: &Model,
        state: &mut State,
        length: f64,
        held: &(impl Fn(usize, f64) -> Kinematics + Sync),
    ) -> Result<Done, StepError> {
        let whole = length + self.cut;
        let mut part = self.sea.reach(model, waves, state, whole);
        if part == whole {
            let renewed = self.renew_waves(model, waves, state, whole);
            let done = self.pass(model, state, [length, whole], held);
            if done.is_err() && renewed {
                self.sea.undo(model, state);
            }
            return done;
        }
        self.check_length(model, state, [part, whole], held)?;
        let end = state.time + length;
        let mut total = Done::default();
        self.before.clone_from(state);
        loop {
            self.renew_waves(model, waves, state, part);
            let taken = part.min(end - state.time);
            let passed = self.pass(model, state, [taken, part], held).and_then(|done| {
                total.add(done);
                let passed = state.time - (end - length);
                within_guard(model, state.time, [passed, length], total.counters.substeps)
            });
            match passed {
                Ok(()) => {}
                Err(error) => {
                    state.clone_from(&self.before);
                    return Err(error);
                }
            }
            let left = end - state.time;
            if left <= ROUNDING * length {
                state.time = end;
                return Ok(total);
            }
            part = self.sea.reach(model, waves, state, left + self.cut);
        }
    }

    /// Refuses a communication step of `whole` [s] in parts of `part` [s] that would take too many internal steps: the limit
    /// applies to the sum over all parts.
    #[cold]
    #[inline(never)]
    fn check_length(
        &self,
        model: &Model,
        state: &State,
        [part, whole]: [f64; 2],
        held: &(impl Fn(usize, f64) -> Kinematics + Sync),
    ) -> Result<(), StepError> {
        let step = Communication {
            model,
            state,
            start: state.time,
            length: whole,
            laid_out: whole,
            held,
            winch_paths: &self.winch_paths,
            holds: false,
            jumps: false,
        };
        let mut choices = self.choices().enumerate();
        choices.try_for_each(|(number, choice)| step.check_length(number, choice, part))
    }

    /// Samples the waves for all spans that have ended; returns whether there were any.
    fn renew_waves(&mut self, model: &Model, waves: &Waves, state: &mut State, step: f64) -> bool {
        let threads = (&mut self.threads, self.estimate.threads_for_waves());
        self.sea.renew((model, waves), state, step, threads)
    }

    /// Advances `state` by `length` [s], for which the wave kinematics have been sampled, in internal steps for `laid_out` [s].
    fn pass(
        &mut self,
        model: &Model,
        state: &mut State,
        [length, laid_out]: [f64; 2],
        held: &(impl Fn(usize, f64) -> Kinematics + Sync),
    ) -> Result<Done, StepError> {
        let threads = self.estimate.threads_for(length);
        self.prepare_scratch(state, threads);
        let step = Communication {
            model,
            state,
            start: state.time,
            length,
            laid_out,
            held,
            winch_paths: &self.winch_paths,
            holds: std::mem::take(&mut self.holds),
            jumps: model.solver.input_reconstruction == Reconstruction::Jump,
        };
        let work = |first: usize, networks: &mut [NetworkSolver], scratch: &mut Scratch| {
            for (number, network) in networks.iter_mut().enumerate() {
                let solver = (&network.choice, &mut network.solver);
                network.outcome = step.network(first + number, solver, scratch);
            }
        };
        self.threads
            .share(&mut self.networks, &mut self.scratch[..threads], work);
        self.exchange_parts(model, threads);
        let mut total = Done::default();
        for network in &mut self.networks {
            total.join(std::mem::replace(&mut network.outcome, Ok(Done::default()))?);
        }
        let next = &mut self.scratch[0].next;
        next.time = state.time + length;
        place_held(model, next, held);
        // the waves of `state` are kept
        state.time = next.time;
        std::mem::swap(&mut state.points, &mut next.points);
        std::mem::swap(&mut state.lines, &mut next.lines);
        self.holds = true;
        Ok(total)
    }

    fn prepare_scratch(&mut self, state: &State, threads: usize) {
        while self.scratch.len() < threads {
            self.scratch.push(self.scratch[0].clone());
        }
        if state.waves.is_some() && self.networks.iter().any(|network| network.solver.reads_next()) {
            for scratch in &mut self.scratch[..threads] {
                scratch.next.waves.clone_from(&state.waves);
            }
        }
    }

    /// Moves the networks that other threads advanced to the `next` state of the first thread.
    fn exchange_parts(&mut self, model: &Model, threads: usize) {
        let [own, others @ ..] = &mut self.scratch[..threads] else {
            return;
        };
        if others.is_empty() {
            return;
        }
        let size = self.networks.len().div_ceil(threads).max(1);
        for (other, networks) in others.iter_mut().zip(model.networks.chunks(size).skip(1)) {
            for network in networks {
                for &line in &network.lines {
                    std::mem::swap(&mut own.next.lines[line], &mut other.next.lines[line]);
                }
                for &point in &network.free_points {
                    std::mem::swap(&mut own.next.points[point], &mut other.next.points[point]);
                }
            }
        }
    }
}

impl Done {
    /// Adds the result of another network for the same time.
    fn join(&mut self, other: Done) {
        self.counters.substeps = self.counters.substeps.max(other.counters.substeps);
        self.counters.solves += other.counters.solves;
        self.flow.add(other.flow);
    }

    /// Adds the result of a later part of the step.
    fn add(&mut self, other: Done) {
        self.counters.substeps += other.counters.substeps;
        self.counters.solves += other.counters.solves;
        self.flow.add(other.flow);
    }
}

/// Sets the points that follow `held`, and the velocities of the end nodes of all lines except quasi-static ones, to their
/// values at the time of `state`.
fn place_held(model: &Model, state: &mut State, held: &impl Fn(usize, f64) -> Kinematics) {
    for (index, point) in state.points.iter_mut().enumerate() {
        if !matches!(model.points[index].role, Role::Fixed | Role::Free(_)) {
            let k = held(index, state.time);
            (point.position, point.velocity, point.acceleration) = (k.position, k.velocity, k.acceleration);
            if let Role::Carried { .. } = model.points[index].role {
                (point.orientation, point.spin) = (k.orientation, k.spin);
            }
        }
    }
    if model.solver.integrator == Integrator::QuasiStatic {
        return;
    }
    for (line, shape) in model.lines.iter().zip(&mut state.lines) {
        let last = shape.position.len() - 1;
        let ends = [0, last].into_iter().zip(line.ends);
        for ((node, point), released) in ends.zip(shape.released) {
            if !released {
                shape.velocity[node] = state.points[point].velocity;
            }
        }
        if let (Some(winch), Some(winch_state)) = (&line.winch, shape.winch_state) {
            let chord = shape.position[last] - shape.position[last - 1];
            let length = winch.end_length(last, winch_state.change);
            shape.velocity[last] -= winch_state.rate / length * chord; // velocity of the material
        }
    }
}
