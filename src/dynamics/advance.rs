//! One communication step of a whole model: every network by its integrator, in as many internal steps as it needs.

use std::sync::Mutex;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::axial_implicit::{self, AxialWork};
use super::beam::{self, BeamWork, Driven, Stuck, StuckReason};
use super::crew::{Crew, Hands, Labour, Pace, Queue, lock};
use super::implicit::{self, Scheme};
use super::leapfrog::Step;
use super::ledger::passed::{self, Passed};
use super::ledger::{self, Energy, Flow};
use super::limit::{drag_holds, drag_step};
use super::motion::AxisPath;
use super::network::NetworkWork;
use super::quasi_static::Halving;
use super::sea::SeaWork;
use super::{Choice, StepError, quasi_static};
use crate::model::{End, Kinematics, Model, Network, Role, State};
use crate::physics::airy::Waves;
use crate::scene::{AXIAL_RADIUS_MIN, Integrator, Reconstruction};
use crate::statics::assembly::rubbing::{drop_anchors, hold_at_rest};
use crate::statics::assembly::{self, copy_network};

/// Spectral radius of the axial-implicit leapfrog where the scene gives none [-].
const AXIAL_SPECTRAL_RADIUS: f64 = 0.9;
/// Tension that may arise within a step, over the greatest one before it [-].
const SNAP_GROWTH: f64 = 1.5;
/// Internal steps of a communication step, at most [-].
const SUBSTEPS_MAX: f64 = 1e7;
/// Rounding of times, over a step [-].
const ROUNDING: f64 = 1e-9;
/// A failed step is tried again with half the internal step, at most so often [-].
const RETRIES_MAX: u32 = 6;

/// Work done in a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counters {
    /// Internal steps, of the network with the most.
    pub substeps: usize,
    /// Force evaluations of the explicit leapfrog, closed-form catenaries of quasi-static networks that have them, linear solves of
    /// the other integrators, of all networks.
    pub solves: usize,
}

/// What a communication step did.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Done {
    /// Work of the integrators.
    pub counters: Counters,
    /// Energy given and lost.
    pub flow: Flow,
}

/// Scratch of all networks and the state being built.
#[derive(Debug, Clone)]
pub struct Workspace {
    networks: Vec<(Choice, Solver)>,
    implicit: assembly::Workspace,
    next: State,
    sea: SeaWork,
    /// The state before a step that is made in parts.
    before: State,
    /// How the winches pay out, by line; empty where there are none.
    reels: Vec<AxisPath>,
    /// Whether the leapfrogs still hold the state that they handed back last.
    holds: bool,
    crew: Crew,
    labour: Labour,
    /// How steps go on threads, and how waves are asked on them.
    paces: [Pace; 2],
    /// Scratch of the other threads, once there are some.
    helpers: Helpers,
    /// What became of the networks that threads shared.
    outcomes: Vec<Outcome>,
}

/// What became of a network in a step that threads shared.
type Outcome = Option<Result<Done, StepError>>;

/// Scratch of the threads that help.
#[derive(Debug, Default)]
struct Helpers(Vec<Mutex<Helper>>);

impl Clone for Helpers {
    /// None yet.
    fn clone(&self) -> Helpers {
        Helpers::default()
    }
}

/// Scratch of a thread that helps.
#[derive(Debug)]
struct Helper {
    implicit: assembly::Workspace,
    next: State,
    /// Networks that it brought to the end of the step.
    made: Vec<usize>,
}

#[derive(Debug, Clone)]
enum Solver {
    Leapfrog(NetworkWork),
    AxialImplicit(Box<AxialWork>),
    Implicit(Scheme),
    Beam(Box<BeamWork>),
    QuasiStatic,
}

impl Workspace {
    /// Chooses integrators and allocates all scratch for a model that starts from `state`; `tension` tells the static
    /// tension of a line [N].
    pub fn new(model: &Model, state: &State, tension: impl Fn(usize) -> f64) -> Workspace {
        let networks: Vec<(Choice, Solver)> = model
            .networks
            .iter()
            .map(|network| {
                let choice = Choice::new(model, network, &tension);
                let solver = Solver::new(model, network, choice.integrator);
                (choice, solver)
            })
            .collect();
        Workspace {
            crew: Crew::default(),
            labour: Labour::new(model, networks.iter().map(|(choice, _)| choice)),
            paces: Default::default(),
            helpers: Helpers::default(),
            outcomes: Vec::new(),
            networks,
            implicit: assembly::Workspace::new(model),
            next: state.clone(),
            sea: SeaWork::new(),
            before: State::default(),
            reels: Vec::new(),
            holds: false,
        }
    }

    /// Must be told when the state is another than the one that [`Self::advance`] left.
    pub fn forget(&mut self) {
        self.holds = false;
    }

    /// Sets how the winches pay out in the next step, by line.
    pub fn set_reels(&mut self, paths: impl Iterator<Item = AxisPath>) {
        self.reels.clear();
        self.reels.extend(paths);
    }

    /// What was chosen, by network.
    pub fn choices(&self) -> impl Iterator<Item = &Choice> {
        self.networks.iter().map(|(choice, _)| choice)
    }

    /// How many threads share steps of a length [s], and why.
    pub fn threads_in_words(&self, length: f64) -> String {
        self.labour.in_words(length)
    }

    /// Energy that the networks hold; none of motion where they are quasi-static.
    pub fn energy(&self, model: &Model, state: &State) -> Energy {
        let mut sum = Energy::default();
        for ((_, solver), network) in self.networks.iter().zip(&model.networks) {
            let mut energy = ledger::energy(model, network, state);
            if matches!(solver, Solver::QuasiStatic) {
                energy.kinetic = 0.0;
            }
            sum.add(energy);
        }
        sum
    }

    /// What the books of the networks leave out until they are read, to be taken off what was lost [J]: see
    /// [`AxialWork::defers_turning`].
    pub fn turning_energy(&self, model: &Model, state: &State) -> f64 {
        let mut sum = 0.0;
        for ((_, solver), network) in self.networks.iter().zip(&model.networks) {
            if let Solver::AxialImplicit(work) = solver
                && work.defers_turning()
            {
                let index = network.lines[0];
                let (line, shape) = (&model.lines[index], &state.lines[index]);
                sum += axial_implicit::turning_energy(model, line, shape);
            }
        }
        sum
    }

    /// Gives a state at rest the accelerations that the implicit integrators start from.
    pub fn start(
        &mut self,
        model: &Model,
        state: &mut State,
        held: &impl Fn(usize, f64) -> Kinematics,
    ) {
        let time = state.time;
        drop_anchors(model, state);
        place_held(model, state, held);
        let mut hands = Hands {
            crew: &mut self.crew,
            threads: 1,
        };
        self.sea.start(model, state, &mut hands);
        for (number, (_, solver)) in self.networks.iter().enumerate() {
            if matches!(solver, Solver::Implicit(_)) {
                let network = &model.networks[number];
                hold_at_rest(model, network, state, time, &mut self.implicit);
                implicit::start(model, number, state, held, time, &mut self.implicit);
            }
        }
        self.next.clone_from(state);
    }

    /// Advances `state` by `length` [s]; `held` tells the kinematics of held points in that time.
    ///
    /// # Errors
    /// The state is untouched; the error says where and what to try.
    pub fn advance(
        &mut self,
        model: &Model,
        state: &mut State,
        length: f64,
        held: &(impl Fn(usize, f64) -> Kinematics + Sync),
    ) -> Result<Done, StepError> {
        match &model.waves {
            None => self.pass(model, state, length, held),
            Some(waves) => self.advance_in(waves, model, state, length, held),
        }
    }

    /// [`Self::advance`] in waves: in parts where the step is longer than what waves do can be foretold for.
    fn advance_in(
        &mut self,
        waves: &Waves,
        model: &Model,
        state: &mut State,
        length: f64,
        held: &(impl Fn(usize, f64) -> Kinematics + Sync),
    ) -> Result<Done, StepError> {
        let mut part = self.sea.reach(model, waves, state, length);
        if part == length {
            let renewed = self.renew_waves(model, waves, state, length);
            let done = self.pass(model, state, length, held);
            if done.is_err() && renewed {
                self.sea.undo(state);
            }
            return done;
        }
        let end = state.time + length;
        let mut total = Done::default();
        self.before.clone_from(state);
        loop {
            self.renew_waves(model, waves, state, part);
            match self.pass(model, state, part, held) {
                Ok(done) => total.add(done),
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
            part = self.sea.reach(model, waves, state, left);
        }
    }

    /// Asks the waves anew where a span of theirs is over; whether it was.
    fn renew_waves(&mut self, model: &Model, waves: &Waves, state: &mut State, step: f64) -> bool {
        let (labour, [_, pace]) = (&self.labour, &mut self.paces);
        let expected = labour.at_sea();
        self.crew.call(expected - 1);
        let turn = pace.turn(expected, labour.is_given());
        let mut hands = Hands {
            crew: &mut self.crew,
            threads: turn.threads,
        };
        let renewed = self.sea.renew(model, waves, state, step, &mut hands);
        if renewed {
            pace.note(turn, 1.0);
        }
        renewed
    }

    /// Advances `state` by `length` [s], over which it knows what waves do.
    fn pass(
        &mut self,
        model: &Model,
        state: &mut State,
        length: f64,
        held: &(impl Fn(usize, f64) -> Kinematics + Sync),
    ) -> Result<Done, StepError> {
        let reads_next = |(_, solver): &(Choice, Solver)| solver.reads_next();
        if state.waves.is_some() && self.networks.iter().any(reads_next) {
            self.next.waves.clone_from(&state.waves);
        }
        let step = Communication {
            model,
            state,
            start: state.time,
            length,
            held,
            reels: &self.reels,
            holds: std::mem::take(&mut self.holds),
            jumps: model.solver.input_reconstruction == Reconstruction::Jump,
        };
        let expected = self.labour.over(length);
        self.crew.call(expected - 1);
        let turn = self.paces[0].turn(expected, self.labour.is_given());
        let mut total = Done::default();
        if turn.threads > 1 {
            let helpers = self.helpers.of(turn.threads - 1, &step, &self.next);
            let own = (&mut self.implicit, &mut self.next);
            let networks = (&mut self.networks[..], &mut self.outcomes);
            step.on_threads(&mut self.crew, helpers, networks, own);
            for done in self.outcomes.drain(..).flatten() {
                total.join(done?);
            }
        } else {
            for (number, network) in self.networks.iter_mut().enumerate() {
                let (implicit, next) = (&mut self.implicit, &mut self.next);
                step.network(number, network, implicit, next, &mut total)?;
            }
        }
        self.next.time = state.time + length;
        place_held(model, &mut self.next, held);
        // all but the waves, which stay as they are
        state.time = self.next.time;
        std::mem::swap(&mut state.points, &mut self.next.points);
        std::mem::swap(&mut state.lines, &mut self.next.lines);
        self.holds = true;
        self.paces[0].note(turn, length);
        Ok(total)
    }
}

impl Helpers {
    /// So many, ready for a step whose state is built in `next`.
    fn of<K>(&mut self, count: usize, step: &Communication<K>, next: &State) -> &[Mutex<Helper>] {
        while self.0.len() < count {
            self.0.push(Mutex::new(Helper {
                implicit: assembly::Workspace::new(step.model),
                next: next.clone(),
                made: Vec::with_capacity(step.model.networks.len()),
            }));
        }
        for helper in &self.0[..count] {
            lock(helper).next.waves.clone_from(&next.waves);
        }
        &self.0[..count]
    }
}

impl Done {
    /// Adds what another network did in the same time.
    fn join(&mut self, other: Done) {
        self.counters.substeps = self.counters.substeps.max(other.counters.substeps);
        self.counters.solves += other.counters.solves;
        self.flow.add(other.flow);
    }

    /// Adds what a later part of the step did.
    fn add(&mut self, other: Done) {
        self.counters.substeps += other.counters.substeps;
        self.counters.solves += other.counters.solves;
        self.flow.add(other.flow);
    }
}

impl Solver {
    /// Whether it asks the state being built for what waves do.
    fn reads_next(&self) -> bool {
        matches!(self, Solver::Implicit(_))
    }

    fn new(model: &Model, network: &Network, integrator: Integrator) -> Solver {
        let kernel =
            |solver: Option<Solver>| solver.expect("the integrator was chosen for these lines");
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

/// New scratch for one that a motion without bound went through: numbers that are none would stay where no node is, and in masses of nodes
/// that the water's surface seems not to meet.
fn renew<W>(work: &mut W, new: Option<W>) {
    if let Some(new) = new {
        *work = new;
    }
}

/// One communication step: where it starts from, and what moves the held points.
struct Communication<'a, K> {
    model: &'a Model,
    state: &'a State,
    /// [s]
    start: f64,
    /// [s]
    length: f64,
    held: &'a K,
    /// How the winches pay out, by line; empty where there are none.
    reels: &'a [AxisPath],
    /// Whether the leapfrogs hold the state.
    holds: bool,
    /// Whether held points may set out from elsewhere than where the last step took them.
    jumps: bool,
}

impl<K: Fn(usize, f64) -> Kinematics + Sync> Communication<'_, K> {
    /// All networks, each on the thread that takes it; `next` becomes what it would be on one thread.
    fn on_threads(
        &self,
        crew: &mut Crew,
        helpers: &[Mutex<Helper>],
        (networks, outcomes): (&mut [(Choice, Solver)], &mut Vec<Outcome>),
        (implicit, next): (&mut assembly::Workspace, &mut State),
    ) {
        let count = networks.len();
        outcomes.clear();
        outcomes.resize_with(count, || None);
        let size = count.div_ceil(helpers.len() + 1);
        for (number, helper) in helpers.iter().enumerate() {
            let first = ((number + 1) * size).min(count);
            self.exchange(
                first..(first + size).min(count),
                next,
                &mut lock(helper).next,
            );
        }
        let parts = networks.chunks_mut(size).zip(outcomes.chunks_mut(size));
        let queue = Queue::new(parts.enumerate().map(|(part, (networks, outcomes))| {
            let numbers = part * size..part * size + networks.len();
            numbers.zip(networks.iter_mut().zip(outcomes))
        }));
        let help = |number: usize, helper: &mut Helper| {
            helper.made.clear();
            while let Some((network, (solver, outcome))) = queue.take(number + 1) {
                let (implicit, next) = (&mut helper.implicit, &mut helper.next);
                *outcome = Some(self.network_alone(network, solver, implicit, next));
                helper.made.push(network);
            }
        };
        let lead = || {
            while let Some((network, (solver, outcome))) = queue.take(0) {
                *outcome = Some(self.network_alone(network, solver, implicit, next));
            }
        };
        crew.run(helpers, help, lead);
        for helper in helpers {
            let helper = &mut *lock(helper);
            self.exchange(helper.made.drain(..), next, &mut helper.next);
        }
    }

    /// Exchanges networks between two states.
    fn exchange(&self, networks: impl Iterator<Item = usize>, one: &mut State, other: &mut State) {
        for number in networks {
            let network = &self.model.networks[number];
            for &line in &network.lines {
                std::mem::swap(&mut one.lines[line], &mut other.lines[line]);
            }
            for &point in &network.free_points {
                std::mem::swap(&mut one.points[point], &mut other.points[point]);
            }
        }
    }

    /// What one network does over the step.
    fn network_alone(
        &self,
        number: usize,
        network: &mut (Choice, Solver),
        implicit: &mut assembly::Workspace,
        next: &mut State,
    ) -> Result<Done, StepError> {
        let mut done = Done::default();
        self.network(number, network, implicit, next, &mut done)?;
        Ok(done)
    }

    /// One network over the step; joins what it does to `total`.
    fn network(
        &self,
        number: usize,
        (choice, solver): &mut (Choice, Solver),
        implicit: &mut assembly::Workspace,
        next: &mut State,
        total: &mut Done,
    ) -> Result<(), StepError> {
        let step_max = choice.step_max;
        total.join(match solver {
            Solver::AxialImplicit(work) => {
                return self.axial_implicit(number, step_max, work, next, total);
            }
            Solver::Leapfrog(work) => self.leapfrog(number, step_max, work, next)?,
            Solver::Implicit(scheme) => self.implicit(number, step_max, scheme, implicit, next)?,
            Solver::Beam(work) => self.beam(number, step_max, work, next)?,
            Solver::QuasiStatic => self.quasi_static(number, implicit, next)?,
        });
        Ok(())
    }

    #[inline(never)]
    fn leapfrog(
        &self,
        number: usize,
        step_max: f64,
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
            let longest = step_max / work.stiffening().sqrt();
            let quick = drag_step(work.drag_rate(model, network, self.start));
            let count = self.substeps(network.lines[0], longest.min(quick), retry)?;
            let drift = self.length / count as f64;
            let mut steps = self.state.lines[network.lines[0]].half_step.steps;
            let mut step = Step::after(steps, drift);
            work.put_ends(self.start, steps[0], self.held);
            work.start_reels(network, self.state, self.reels, step);
            work.begin();
            for k in 0..count {
                let t = self.start + k as f64 * drift;
                work.step(model, network, t, step, self.held);
                steps = [drift, steps[0]];
                step = Step::after(steps, drift);
            }
            let flow = work.flow();
            let is_sound = work.is_sound() && flow.is_finite();
            let holds = drag_holds(
                work.drag_rate(model, network, self.start + self.length),
                drift,
            );
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
    fn transverse_step(&self, line: usize, work: &AxialWork, step_max: f64) -> f64 {
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
            true => step_max,
            false => step_max.min(transverse / expected.sqrt()),
        }
    }

    #[inline(never)]
    fn axial_implicit(
        &self,
        number: usize,
        step_max: f64,
        work: &mut AxialWork,
        next: &mut State,
        total: &mut Done,
    ) -> Result<(), StepError> {
        let network = &self.model.networks[number];
        let (index, transverse) = (network.lines[0], work.transverse);
        let line = &self.model.lines[index];
        let step_max = self.transverse_step(index, work, step_max);
        let mut stuck = 0;
        for retry in 0..=RETRIES_MAX {
            let count = self.substeps(index, step_max, retry)?;
            let drift = self.length / count as f64;
            self.set_out(index, drift, work, self.holds && retry == 0);
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
                if let Some(partings) = &line.parting {
                    work.part_ends(partings, t - drift, Step::after(steps, drift));
                }
                solves += work.step(Step::after(steps, drift), ends);
                steps = [drift, steps[0]];
            }
            let (is_sound, flow) = (work.store(&mut next.lines[index], steps), work.flow());
            let stretch = drift * drift * work.tension_peak();
            let too_long = stretch > transverse * transverse || !work.is_settled();
            let whole = is_sound && flow.is_finite();
            if whole && !(too_long && retry < RETRIES_MAX) {
                let counters = Counters {
                    substeps: count,
                    solves,
                };
                total.join(Done { counters, flow });
                return Ok(());
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
        if self.state.waves.is_some() {
            work.load_waves(self.state.waves.as_ref(), index);
        }
        let ends = [End::A, End::B].into_iter();
        let ends = ends.zip(&self.model.lines[index].ends);
        let places_them = self.jumps || work.starts();
        for (end, &point) in ends.filter(|_| places_them) {
            let k = (self.held)(point, self.start);
            work.put_end(end, k.position, k.velocity - 0.5 * drift * k.acceleration);
        }
        work.set_time(self.start);
        work.meet_surface(None);
        work.open_books();
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
        work: &mut assembly::Workspace,
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
        let mut parted = ledger::parted_ends(network, self.state);
        let books = model.solver.energy_ledger;
        let count = |passed: &Passed| {
            if !books {
                return;
            }
            let [before, after] = passed.states;
            let now_parted = ledger::parted_ends(network, after);
            if now_parted != parted {
                flow.given += ledger::joined_energy(model, network, [before, after]);
                parted = now_parted;
            } else {
                flow.add(passed::flow(model, network, passed));
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
            reason: stuck.reason.to_string(),
            advice: stuck.reason.advice(),
        })
    }

    #[inline(never)]
    fn quasi_static(
        &self,
        number: usize,
        work: &mut assembly::Workspace,
        next: &mut State,
    ) -> Result<Done, StepError> {
        let (model, times) = (self.model, [self.start, self.start + self.length]);
        let mut attempt = |halving| {
            copy_network(model, &model.networks[number], self.state, next);
            quasi_static::advance(model, number, next, self.held, times, halving, work)
        };
        let (done, flow) =
            attempt(Halving::ForcesAndEnergy).or_else(|_| attempt(Halving::Forces))?;
        let counters = Counters {
            substeps: done.steps,
            solves: done.solves,
        };
        Ok(Done { counters, flow })
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
            reason: format!("steps of {step_max:.1e} s would be needed, {count:.0e} of them"),
            advice: "check solver.time_step_max, masses, lengths and stiffnesses, or use solver.integrator = \"generalised_alpha\"",
        }
    }

    #[cold]
    fn diverged(&self, line: usize, node: usize) -> StepError {
        StepError {
            time: self.start,
            line: self.model.lines[line].name.clone(),
            node,
            reason: "the motion grew without bound".into(),
            advice: "try a smaller solver.time_step_max, or solver.integrator = \"generalised_alpha\"",
        }
    }
}

/// Puts held points, and the velocities of the nodes at all lines' ends but quasi-static ones, where they are at the time of `state`.
fn place_held(model: &Model, state: &mut State, held: &impl Fn(usize, f64) -> Kinematics) {
    for (index, point) in state.points.iter_mut().enumerate() {
        if !matches!(model.points[index].role, Role::Fixed | Role::Free(_)) {
            let k = held(index, state.time);
            (point.position, point.velocity, point.acceleration) =
                (k.position, k.velocity, k.acceleration);
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
        for ((node, point), parted) in ends.zip(shape.parted) {
            if !parted {
                shape.velocity[node] = state.points[point].velocity;
            }
        }
        if let (Some(winch), Some(reel)) = (&line.winch, shape.reel) {
            let chord = shape.position[last] - shape.position[last - 1];
            let length = winch.end_length(last, reel.change);
            shape.velocity[last] -= reel.rate / length * chord; // that of the material
        }
    }
}
