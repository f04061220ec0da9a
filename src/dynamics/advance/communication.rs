//! What one network does over a communication step: its integrator, in as many internal steps as it needs, and once more in shorter ones
//! where those were too long.

use nalgebra::Vector3;

use super::Counters;
use super::Done;
use crate::dynamics::axial_implicit::AxialWork;
use crate::dynamics::beam::{self, BeamWork, Driven, Stuck, StuckReason};
use crate::dynamics::energy_balance::implicit::{self as implicit_balance, Passed};
use crate::dynamics::energy_balance::{self, Flow};
use crate::dynamics::implicit::{self, Scheme};
use crate::dynamics::motion::AxisPath;
use crate::dynamics::network::NetworkWork;
use crate::dynamics::quasi_static;
use crate::dynamics::step::Step;
use crate::dynamics::{Choice, StepError, StepFailure};
use crate::elements::{self, copy_network};
use crate::model::{End, Kinematics, Model, Network, Role, State};
use crate::scene::{AXIAL_RADIUS_MIN, Integrator};

/// Spectral radius of the axial-implicit leapfrog where the scene gives none [-].
const AXIAL_SPECTRAL_RADIUS: f64 = 0.9;
/// Tension that may arise within a step, over the greatest one before it [-].
const SNAP_GROWTH: f64 = 1.5;
/// Internal steps of a communication step, at most [-].
const SUBSTEPS_MAX: f64 = 1e7;
/// Parts of a communication step in waves, at most [-]: each asks the waves at every node.
const PARTS_MAX: f64 = 1e5;
/// A failed step is tried again with half the internal step, at most so often [-].
const RETRIES_MAX: u32 = 6;

/// Refuses a communication step of `length` [s] that has taken `passed` [s] of it in too many internal steps.
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
    Err(StepError {
        time,
        line: model.lines[0].name.clone(),
        node: 0,
        cause: StepFailure::TooManySteps {
            length,
            step,
            count: length / step,
        },
    })
}

/// An integrator and its scratch.
#[derive(Debug, Clone)]
pub(super) enum Solver {
    Leapfrog(NetworkWork),
    AxialImplicit(Box<AxialWork>),
    Implicit(Scheme),
    Beam(Box<BeamWork>),
    QuasiStatic,
}

impl Solver {
    /// Whether it asks the state being built for what waves do.
    pub(super) fn reads_next(&self) -> bool {
        matches!(self, Solver::Implicit(_))
    }

    /// Whether it is one of the leapfrogs.
    pub(super) fn is_leapfrog(&self) -> bool {
        matches!(self, Solver::Leapfrog(_) | Solver::AxialImplicit(_))
    }

    pub(super) fn new(model: &Model, network: &Network, integrator: Integrator) -> Solver {
        let kernel = |solver: Option<Solver>| solver.expect("the integrator was chosen for these lines");
        match integrator {
            Integrator::QuasiStatic => Solver::QuasiStatic,
            Integrator::Beam => {
                let nodes = model.lines[network.lines[0]].segment_count() + 1;
                Solver::Beam(Box::new(BeamWork::new(nodes)))
            }
            Integrator::AxialImplicit => {
                let work = axial_work(model, network);
                kernel(work.map(|work| Solver::AxialImplicit(Box::new(work))))
            }
            Integrator::Leapfrog => kernel(NetworkWork::new(model, network).map(Solver::Leapfrog)),
            _ => Solver::Implicit(Scheme::new(&model.solver)),
        }
    }
}

/// Scratch of the axial-implicit leapfrog for a network of one line; `None` where it does not serve that.
fn axial_work(model: &Model, network: &Network) -> Option<AxialWork> {
    let rho = model
        .solver
        .spectral_radius
        .unwrap_or(AXIAL_SPECTRAL_RADIUS)
        .max(AXIAL_RADIUS_MIN);
    AxialWork::new(model, &model.lines[network.lines[0]], rho)
}

/// Scratch of a thread.
#[derive(Debug, Clone)]
pub(super) struct Scratch {
    pub(super) implicit: elements::Workspace,
    /// The state at the end of the step, as it is built.
    pub(super) next: State,
}

/// New scratch for one that a motion without bound went through: numbers that are none would stay where no node is, and in masses of nodes
/// that the water's surface seems not to meet.
fn renew<W>(work: &mut W, new: Option<W>) {
    if let Some(new) = new {
        *work = new;
    }
}

/// One communication step: where it starts from, and what moves the held points.
pub(super) struct Communication<'a, K> {
    pub(super) model: &'a Model,
    pub(super) state: &'a State,
    /// [s]
    pub(super) start: f64,
    /// [s]
    pub(super) length: f64,
    pub(super) held: &'a K,
    /// How the winches pay out, by line; empty where there are none.
    pub(super) winch_paths: &'a [AxisPath],
    /// Whether the leapfrogs hold the state.
    pub(super) holds: bool,
    /// Whether held points may set out from elsewhere than where the last step took them.
    pub(super) jumps: bool,
}

impl<K: Fn(usize, f64) -> Kinematics + Sync> Communication<'_, K> {
    /// Advances one network over the step, with its new state in `next`.
    pub(super) fn network(
        &self,
        number: usize,
        (choice, solver): (&Choice, &mut Solver),
        Scratch { implicit, next }: &mut Scratch,
    ) -> Result<Done, StepError> {
        let step_max = choice.step_max;
        match solver {
            Solver::AxialImplicit(work) => self.axial_implicit(number, choice, work, next),
            Solver::Leapfrog(work) => self.leapfrog(number, choice, work, next),
            Solver::Implicit(scheme) => self.implicit(number, step_max, scheme, implicit, next),
            Solver::Beam(work) => self.beam(number, step_max, work, next),
            Solver::QuasiStatic => self.quasi_static(number, implicit, next),
        }
    }

    #[inline(never)]
    fn leapfrog(
        &self,
        number: usize,
        choice: &Choice,
        work: &mut NetworkWork,
        next: &mut State,
    ) -> Result<Done, StepError> {
        let (model, network) = (self.model, &self.model.networks[number]);
        let mut broken = (0, 0);
        for retry in 0..=RETRIES_MAX {
            if self.holds && retry == 0 {
                work.resume(network, self.state);
            } else {
                work.load(network, self.state);
            }
            work.set_current(model, self.start);
            let (stiffening, limit) = (work.stiffening(), choice.explicit);
            let limit = limit.stiffened(stiffening);
            let longest = choice.step_max / stiffening.sqrt();
            let longest = longest.min(limit.with_drag(work.drag_rate(model, network, self.start)));
            let count = self.substeps(network.lines[0], longest, retry)?;
            let drift = self.length / count as f64;
            let mut steps = self.state.lines[network.lines[0]].half_step.steps;
            let mut step = Step::after(steps, drift);
            work.put_ends(self.start, steps[0], self.held);
            let mut flow = Flow::default();
            if self.jumps {
                work.set_out_anew(steps[0]);
                for &line in &network.lines {
                    flow.add(self.jump_energy(line, steps[0], next));
                }
            }
            work.start_winches(network, self.state, self.winch_paths, step);
            work.begin();
            for k in 0..count {
                let t = self.start + k as f64 * drift;
                work.step(model, network, t, step, self.held);
                steps = [drift, steps[0]];
                step = Step::after(steps, drift);
            }
            flow.add(work.flow());
            let is_sound = work.is_sound() && flow.is_finite();
            let end = self.start + self.length;
            let holds = limit.holds(work.drag_rate(model, network, end), drift);
            if is_sound && (holds || retry == RETRIES_MAX) {
                work.store(network, next, steps);
                let counters = Counters {
                    substeps: count,
                    solves: count,
                };
                return Ok(Done { counters, flow });
            }
            if !is_sound {
                broken = work.broken_node();
                renew(work, NetworkWork::new(model, network));
            }
        }
        let (line, node) = broken;
        Err(self.diverged(network.lines[line], node))
    }

    /// Longest axial-implicit step [s] of a line under the tensions that it may come to have.
    fn transverse_step(&self, line: usize, work: &AxialWork, longest: f64) -> f64 {
        let tension_now = match self.holds {
            true => work.tension_before(),
            false => {
                let tensions = self.state.lines[line].half_step.tension[0].iter();
                tensions.fold(0.0, |a, &b| if b > a { b } else { a })
            }
        };
        let (transverse, expected) = (work.transverse, SNAP_GROWTH * tension_now);
        // what holds over the whole communication step is told without roots and quotients
        match self.length * self.length * expected <= transverse * transverse {
            true => longest,
            false => longest.min(transverse / expected.sqrt()),
        }
    }

    #[inline(never)]
    fn axial_implicit(
        &self,
        number: usize,
        choice: &Choice,
        work: &mut AxialWork,
        next: &mut State,
    ) -> Result<Done, StepError> {
        let network = &self.model.networks[number];
        let (index, transverse) = (network.lines[0], work.transverse);
        let line = &self.model.lines[index];
        let mut longest = self.transverse_step(index, work, choice.longest);
        let mut stuck = 0;
        for retry in 0..=RETRIES_MAX {
            if retry > 0 {
                longest = longest.min(choice.step_max); // a snap came
            }
            let count = self.substeps(index, longest, retry)?;
            let drift = self.length / count as f64;
            self.set_out(index, drift, work, self.holds && retry == 0);
            let mut flow = self.jump_energy(index, drift, next);
            let mut steps = self.state.lines[index].half_step.steps;
            let mut solves = 0;
            for k in 1..=count {
                let t = self.start + k as f64 * drift;
                if let Some(stream) = self.model.stream(t - drift) {
                    work.set_current(stream.factor);
                }
                work.set_time(t - drift);
                let [a, b] = line.ends;
                let ends = [self.place(a, t), self.place(b, t)];
                if let Some(releases) = &line.release {
                    work.release_ends(releases, t - drift, Step::after(steps, drift));
                }
                solves += work.step(Step::after(steps, drift), ends);
                steps = [drift, steps[0]];
            }
            let is_sound = work.store(&mut next.lines[index], steps);
            flow.add(work.flow());
            let stretch = drift * drift * work.tension_peak();
            let too_long = stretch > transverse * transverse || !work.is_settled();
            let whole = is_sound && flow.is_finite();
            if whole && !(too_long && retry < RETRIES_MAX) {
                let counters = Counters {
                    substeps: count,
                    solves,
                };
                return Ok(Done { counters, flow });
            }
            if !whole {
                let broken = work.broken_node();
                stuck = broken.unwrap_or_else(|| work.fastest_node());
                renew(work, axial_work(self.model, network));
            }
        }
        Err(self.diverged(index, stuck))
    }

    /// Makes a line ready for steps of `drift` [s], of which it may still hold the state.
    fn set_out(&self, index: usize, drift: f64, work: &mut AxialWork, holds: bool) {
        if holds {
            work.resume();
        } else {
            work.load(&self.state.lines[index]);
        }
        if let Some(waves) = &self.state.waves {
            work.load_waves(&waves.lines[index]);
        }
        let ends = [End::A, End::B].into_iter();
        let ends = ends.zip(&self.model.lines[index].ends);
        let places_them = self.jumps || work.starts();
        for (end, &point) in ends.filter(|_| places_them) {
            let k = (self.held)(point, self.start);
            work.put_end(end, k.position, k.velocity - 0.5 * drift * k.acceleration);
        }
        if self.jumps {
            work.set_out_anew(self.state.lines[index].velocities_before().1);
        }
        work.set_time(self.start);
        work.meet_surface();
    }

    /// Flow of energy into a leapfrog's line whose prescribed ends jump at the start of the step, to velocities half a step of `drift` [s] earlier. The line
    /// in `next` is overwritten.
    fn jump_energy(&self, index: usize, drift: f64, next: &mut State) -> Flow {
        if !self.jumps || !self.model.energy_balance {
            return Flow::default();
        }
        let ends = self.model.lines[index].ends.map(|point| {
            let k = (self.held)(point, self.start);
            [k.position, k.velocity - 0.5 * drift * k.acceleration]
        });
        energy_balance::jump_flow(self.model, self.state, index, ends, &mut next.lines[index])
    }

    fn is_fixed(&self, point: usize) -> bool {
        matches!(self.model.points[point].role, Role::Fixed)
    }

    /// Where a held point is at `t` [s].
    fn place(&self, point: usize, t: f64) -> Vector3<f64> {
        match self.is_fixed(point) {
            true => self.model.points[point].reference,
            false => (self.held)(point, t).position,
        }
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
        self.substeps(self.model.networks[number].lines[0], step_max, 0)?;
        copy_network(self.model, &self.model.networks[number], self.state, next);
        let end = self.start + self.length;
        let span = implicit::Span {
            start: self.start,
            end,
            step_max,
        };
        let (model, network) = (self.model, &self.model.networks[number]);
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
        let held = implicit::Held {
            kinematics: self.held,
            scheme,
        };
        let done = implicit::advance_observed(model, number, next, held, span, work, count)?;
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
        Err(StepError {
            time: self.start,
            line: model.lines[index].name.clone(),
            node: stuck.node,
            cause: stuck.reason.into(),
        })
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

    /// Refuses a communication step that would take a network too many internal steps, none longer than `part` [s].
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

    /// Equal steps no longer than `step_max` [s], halved `retry` times, of the network with a line.
    fn substeps(&self, line: usize, step_max: f64, retry: u32) -> Result<usize, StepError> {
        if self.length <= step_max {
            return Ok(1 << retry);
        }
        self.several(line, step_max, retry)
    }

    /// [`Self::substeps`] where one is too long.
    #[inline(never)]
    fn several(&self, line: usize, step_max: f64, retry: u32) -> Result<usize, StepError> {
        // a span of exactly one limit must not become two steps by rounding
        let count = self.length / step_max * (1.0 - 1e-9);
        if count <= SUBSTEPS_MAX {
            let whole = count as usize; // rounded down
            return Ok((whole + usize::from(count > whole as f64)) << retry);
        }
        Err(self.too_many(line, step_max, count.ceil()))
    }

    #[cold]
    fn too_many(&self, line: usize, step_max: f64, count: f64) -> StepError {
        StepError {
            time: self.start,
            line: self.model.lines[line].name.clone(),
            node: 0,
            cause: StepFailure::TooManySteps {
                length: self.length,
                step: step_max,
                count,
            },
        }
    }

    #[cold]
    fn diverged(&self, line: usize, node: usize) -> StepError {
        StepError {
            time: self.start,
            line: self.model.lines[line].name.clone(),
            node,
            cause: StepFailure::Unbounded,
        }
    }
}
