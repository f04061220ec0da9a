//! Communication step of one network: its integrator takes as many internal steps as it needs, and repeats the
//! communication step with shorter ones if they were too long.

use super::Counters;
use super::Done;
use crate::dynamics::beam::{self, BeamWork, Driven, Stuck, StuckReason};
use crate::dynamics::energy_balance::implicit::{self as implicit_balance, Passed};
use crate::dynamics::energy_balance::{self, Flow};
use crate::dynamics::implicit::{self, Scheme};
use crate::dynamics::leapfrog::step::Step;
use crate::dynamics::leapfrog::{AxialImplicit, Explicit, Kernel, LeapfrogNetwork};
use crate::dynamics::motion::AxisPath;
use crate::dynamics::quasi_static;
use crate::dynamics::{Choice, StepError, StepFailure};
use crate::elements::{self, copy_network};
use crate::model::{Kinematics, Model, Network, State};
use crate::scene::Integrator;

/// Maximum number of internal steps of a communication step [-].
const SUBSTEPS_MAX: f64 = 1e7;
/// Maximum number of parts of a communication step in waves [-]: each part evaluates the waves at every node.
const PARTS_MAX: f64 = 1e5;
/// Maximum number of retries of a failed communication step, each with half the internal step [-].
const RETRIES_MAX: u32 = 6;

/// Refuses a communication step of `length` [s] that needed too many internal steps for the first `passed` [s].
pub(super) fn within_guard(
    model: &Model,
    time: f64,
    [passed, length]: [f64; 2],
    count: usize,
) -> Result<(), StepError> {
    if count as f64 <= SUBSTEPS_MAX {
        return Ok(());
    }
    let step = passed / count as f64;
    let cause = StepFailure::TooManySteps {
        length,
        step,
        count: length / step,
    };
    Err(StepError::new(time, &model.lines[0], 0, cause))
}

#[derive(Debug, Clone)]
pub(super) enum Solver {
    Leapfrog(Box<LeapfrogNetwork<Explicit>>),
    AxialImplicit(Box<LeapfrogNetwork<AxialImplicit>>),
    Implicit(Scheme),
    Beam(Box<BeamWork>),
    QuasiStatic,
}

impl Solver {
    /// Returns whether the integrator reads the waves from the state being built.
    pub(super) fn reads_next(&self) -> bool {
        matches!(self, Solver::Implicit(_))
    }

    /// Returns whether the integrator assembles the elements of its lines.
    pub(super) fn has_elements(&self) -> bool {
        matches!(self, Solver::Implicit(_) | Solver::QuasiStatic)
    }

    pub(super) fn is_leapfrog(&self) -> bool {
        matches!(self, Solver::Leapfrog(_) | Solver::AxialImplicit(_))
    }

    pub(super) fn new(model: &Model, network: &Network, integrator: Integrator) -> Solver {
        match integrator {
            Integrator::QuasiStatic => Solver::QuasiStatic,
            Integrator::Beam => {
                let nodes = model.lines[network.lines[0]].segment_count() + 1;
                Solver::Beam(Box::new(BeamWork::new(nodes)))
            }
            Integrator::AxialImplicit => Solver::AxialImplicit(Box::new(leapfrog(model, network))),
            Integrator::Leapfrog => Solver::Leapfrog(Box::new(leapfrog(model, network))),
            _ => Solver::Implicit(Scheme::new(&model.solver)),
        }
    }
}

fn leapfrog<K: Kernel>(model: &Model, network: &Network) -> LeapfrogNetwork<K> {
    let work = LeapfrogNetwork::new(model, network);
    work.expect("a leapfrog is chosen for lines of one strain measure")
}

/// Workspace of a thread.
#[derive(Debug, Clone)]
pub(super) struct Scratch {
    pub(super) implicit: elements::Workspace,
    /// State at the end of the step, under construction.
    pub(super) next: State,
}

/// One communication step: its initial state, and the motion of the prescribed points.
pub(super) struct Communication<'a, H> {
    pub(super) model: &'a Model,
    pub(super) state: &'a State,
    /// [s]
    pub(super) start: f64,
    /// [s]
    pub(super) length: f64,
    /// Length for which the number of internal steps is chosen; longer than `length` if the step is cut short [s].
    pub(super) laid_out: f64,
    pub(super) held: &'a H,
    /// Paid-out lengths of the winches, by line; empty where there are none.
    pub(super) winch_paths: &'a [AxisPath],
    /// True if the leapfrogs' striped layout holds `state`.
    pub(super) holds: bool,
    /// True if prescribed points may jump at the start of the step.
    pub(super) jumps: bool,
}

impl<H: Fn(usize, f64) -> Kinematics + Sync> Communication<'_, H> {
    /// Advances one network over the step and stores its new state in `next`.
    pub(super) fn network(
        &self,
        number: usize,
        (choice, solver): (&Choice, &mut Solver),
        Scratch { implicit, next }: &mut Scratch,
    ) -> Result<Done, StepError> {
        let step_max = choice.step_max;
        match solver {
            Solver::AxialImplicit(work) => self.leapfrog(number, choice, work, next),
            Solver::Leapfrog(work) => self.leapfrog(number, choice, work, next),
            Solver::Implicit(scheme) => self.implicit(number, step_max, scheme, implicit, next),
            Solver::Beam(work) => self.beam(number, step_max, work, next),
            Solver::QuasiStatic => self.quasi_static(number, implicit, next),
        }
    }

    #[inline(never)]
    fn leapfrog<K: Kernel>(
        &self,
        number: usize,
        choice: &Choice,
        work: &mut LeapfrogNetwork<K>,
        next: &mut State,
    ) -> Result<Done, StepError> {
        let (model, network) = (self.model, &self.model.networks[number]);
        let end = self.start + self.length;
        let mut broken = (0, 0);
        for retry in 0..=RETRIES_MAX {
            match self.holds && retry == 0 {
                true => work.resume(self.state),
                false => work.load(self.state),
            }
            work.set_water(model, self.start);
            let (mut longest, bound) = K::longest_step(work, model, choice, [self.start, self.length]);
            if retry > 0 {
                longest = longest.min(choice.step_max); // a snap occurred
            }
            let count = self.substeps(network.lines[0], longest, retry)?;
            let drift = self.length / count as f64;
            let mut steps = self.state.lines[network.lines[0]].half_step.steps;
            let mut flow = self.set_out(network, drift, work, next);
            let mut solves = 0;
            for k in 0..count {
                let times = [k, k + 1].map(|k| self.start + k as f64 * drift);
                solves += work.step(model, times, Step::after(steps, drift), self.held);
                steps = [drift, steps[0]];
            }
            let is_sound = work.store(next, steps);
            flow.add(work.flow());
            let is_whole = is_sound && flow.is_finite();
            if is_whole && (K::were_short(work, model, &bound, [end, drift]) || retry == RETRIES_MAX) {
                let counters = Counters {
                    substeps: count,
                    solves,
                };
                return Ok(Done { counters, flow });
            }
            if !is_whole {
                // NaN would remain in the padding, and in the masses of nodes that the water surface does not reach
                broken = work.broken_node();
                *work = leapfrog(model, network);
            }
        }
        let (line, node) = broken;
        Err(self.diverged(network.lines[line], node))
    }

    /// Prepares a leapfrog for steps of `drift` [s] of a network. Returns the energy flow into lines whose prescribed ends
    /// jump; these lines in `next` are overwritten.
    fn set_out<K: Kernel>(
        &self,
        network: &Network,
        drift: f64,
        work: &mut LeapfrogNetwork<K>,
        next: &mut State,
    ) -> Flow {
        let steps = self.state.lines[network.lines[0]].half_step.steps;
        let last = if K::SECANTS { drift } else { steps[0] };
        work.set_out(self.start, last, self.jumps, self.held);
        let mut flow = Flow::default();
        if self.jumps {
            work.set_out_anew(steps[0]);
            for &line in &network.lines {
                flow.add(self.jump_energy(line, last, next));
            }
        }
        work.start_winches(self.state, self.winch_paths, Step::after(steps, drift));
        work.meet_surface();
        flow
    }

    /// Energy flow into a line of a leapfrog whose prescribed ends jump at the start of the step. The velocities after the jump are those half a step of
    /// `last` [s] earlier. The line in `next` is overwritten.
    fn jump_energy(&self, index: usize, last: f64, next: &mut State) -> Flow {
        if !self.model.energy_balance {
            return Flow::default();
        }
        let ends = self.model.lines[index].ends.map(|point| {
            let k = (self.held)(point, self.start);
            [k.position, k.velocity - 0.5 * last * k.acceleration]
        });
        energy_balance::jump_flow(self.model, self.state, index, ends, &mut next.lines[index])
    }

    #[inline(never)]
    fn implicit(
        &self,
        number: usize,
        step_max: f64,
        scheme: &Scheme,
        work: &mut elements::Workspace,
        next: &mut State,
    ) -> Result<Done, StepError> {
        let (model, network) = (self.model, &self.model.networks[number]);
        let span = implicit::Span {
            start: self.start,
            end: self.start + self.length,
            steps: self.substeps(network.lines[0], step_max, 0)?,
        };
        copy_network(model, network, self.state, next);
        let mut flow = Flow::default();
        let mut released = energy_balance::released_ends(network, self.state);
        let count = |passed: &Passed| {
            if !model.energy_balance {
                return;
            }
            let [before, after] = passed.states;
            let now_released = energy_balance::released_ends(network, after);
            if now_released != released {
                flow.external_work += energy_balance::joined_energy(model, network, [before, after]);
                released = now_released;
            } else {
                flow.add(implicit_balance::flow(model, network, passed));
            }
        };
        let held = implicit::Driving {
            kinematics: self.held,
            scheme,
        };
        let done = implicit::advance(model, number, next, held, span, work, count)?;
        let counters = Counters {
            substeps: done.steps,
            solves: done.solves,
        };
        Ok(Done { counters, flow })
    }

    #[inline(never)]
    fn beam(
        &self,
        number: usize,
        step_max: f64,
        work: &mut BeamWork,
        next: &mut State,
    ) -> Result<Done, StepError> {
        let (model, network) = (self.model, &self.model.networks[number]);
        let (index, span) = (network.lines[0], [self.start, self.start + self.length]);
        let mut stuck = Stuck {
            node: 0,
            reason: StuckReason::Diverged,
        };
        for retry in 0..=RETRIES_MAX {
            let count = self.substeps(index, step_max, retry)?;
            copy_network(model, network, self.state, next);
            match beam::drive(model, index, next, self.held, span, count, work) {
                Ok(Driven { solves, flow }) => {
                    let counters = Counters {
                        substeps: count,
                        solves,
                    };
                    return Ok(Done { counters, flow });
                }
                Err(failure) => stuck = failure,
            }
        }
        Err(StepError::new(
            self.start,
            &model.lines[index],
            stuck.node,
            stuck.reason,
        ))
    }

    #[inline(never)]
    fn quasi_static(
        &self,
        number: usize,
        work: &mut elements::Workspace,
        next: &mut State,
    ) -> Result<Done, StepError> {
        let (model, times) = (self.model, [self.start, self.start + self.length]);
        copy_network(model, &model.networks[number], self.state, next);
        let (done, flow) = quasi_static::advance(model, number, next, self.held, times, work)?;
        let counters = Counters {
            substeps: done.steps,
            solves: done.solves,
        };
        Ok(Done { counters, flow })
    }

    /// Refuses a communication step for which a network needs too many internal steps, none longer than `part` [s].
    pub(super) fn check_length(&self, number: usize, choice: &Choice, part: f64) -> Result<(), StepError> {
        let longest = match choice.integrator {
            Integrator::QuasiStatic => part,
            Integrator::AxialImplicit => part.min(choice.longest),
            _ => part.min(choice.step_max),
        };
        let line = self.model.networks[number].lines[0];
        let parts = self.length / part;
        if parts > PARTS_MAX {
            return Err(self.too_many(line, part, parts.ceil()));
        }
        self.substeps(line, longest, 0).map(drop)
    }

    /// Number of equal steps no longer than `step_max` [s], halved `retry` times. An error names `line`.
    fn substeps(&self, line: usize, step_max: f64, retry: u32) -> Result<usize, StepError> {
        if self.laid_out <= step_max {
            return Ok(1 << retry);
        }
        self.several(line, step_max, retry)
    }

    /// [`Self::substeps`] where a single step would be too long.
    #[inline(never)]
    fn several(&self, line: usize, step_max: f64, retry: u32) -> Result<usize, StepError> {
        // a step equal to the limit must not be split in two by rounding
        let count = self.laid_out / step_max * (1.0 - 1e-9);
        if count <= SUBSTEPS_MAX {
            let whole = count as usize; // rounded down
            return Ok((whole + usize::from(count > whole as f64)) << retry);
        }
        Err(self.too_many(line, step_max, count.ceil()))
    }

    #[cold]
    fn too_many(&self, line: usize, step_max: f64, count: f64) -> StepError {
        let cause = StepFailure::TooManySteps {
            length: self.length,
            step: step_max,
            count,
        };
        StepError::new(self.start, &self.model.lines[line], 0, cause)
    }

    #[cold]
    fn diverged(&self, line: usize, node: usize) -> StepError {
        StepError::new(self.start, &self.model.lines[line], node, StepFailure::Unbounded)
    }
}
