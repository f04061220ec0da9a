//! Simulation of one mooring, driven by a host, the command line, a test or a benchmark: model, state and workspaces behind one facade.
//!
//! A scene is discretised, its static equilibrium is solved, and [`Simulation::advance`] then steps from one communication point to the next. Coupled
//! points follow the displacements of [`Simulation::set_displacement`], or the scene's motion after [`Simulation::follow_scene`].

mod axial_response;
mod coupling;
mod flow;
mod input_error;
mod inputs;
mod paths;
mod prescribed;
mod results;
mod scale;
mod start;
mod watch;
mod winches;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::dynamics::advance::{Counters, Integrators};
use crate::dynamics::energy_balance::{self, EnergyBalance};
use crate::dynamics::motion::Extrapolation;
use crate::dynamics::{Choice, StepError};
use crate::model::{Line, LineState, Model, Motion, Role, State, WaveSpans};
use crate::scene::{InitialShape, Scene, SceneError, few};
use crate::statics::StaticsError;
use crate::statics::catenary::Catenary;
use axial_response::MovedLine;
use coupling::StepStart;
use flow::Course;
use input_error::InputRecord;
use paths::Paths;
use prescribed::{MotionSource, PrescribedMotion};
use results::Reactions;
use scale::Scale;
use start::Started;

pub use coupling::{EndMotion, Impedance};
pub use flow::{FLOW_COMPONENTS, NO_FLOW, WaterFlow};
pub(crate) use input_error::STILL_TENSION;
pub use inputs::{BodyInput, Inputs};
pub use results::{NodeBending, ProfileNode};
pub(crate) use start::reference_catenary;
pub use watch::Watch;

/// Shortest step that is integrated [s]. A host that ends its last step at the end of its run may request a step as short as the rounding of its
/// clock, about 1e-14 s. In steps shorter than this limit, rounding of the coordinates would dominate accelerations and strain rates: the fairlead
/// force of a chain 800 m long would be off by thousandths of its value in a step of 1e-7 s and by five times its value in one of 1e-9 s. Such steps
/// are integrated together with the next one.
const STEP_MIN: f64 = 1e-6;

/// Reason why a simulation could not be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// The scene is invalid.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// No static equilibrium was found.
    #[error(transparent)]
    Statics(#[from] StaticsError),
}

/// Everything that changes in a simulation. A run continued from a restored snapshot is identical to the last bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    state: State,
    inputs: Inputs,
    paths: Box<Paths>,
    follows_scene: bool,
    counters: Counters,
    /// Present if the scene requests it.
    balance: Option<EnergyBalance>,
    start_time: f64,
    input_record: InputRecord,
    /// Water flow that a host gave for the last step, stored if the next step needs it.
    flow_before: WaterFlow,
    /// Time by which the host is ahead of the state, less than [`STEP_MIN`] [s].
    ahead: f64,
    /// Length of the last step [s]; 0 before the first.
    last_step: f64,
    /// Start of the last step, stored if the scene requests derivatives.
    begun: Option<Box<StepStart>>,
}

/// Simulation of a mooring in time.
#[derive(Debug, Clone)]
pub struct Simulation {
    model: Arc<Model>,
    snapshot: Snapshot,
    work: Integrators,
    /// Paths of the present step.
    paths: Box<Paths>,
    /// Water flow over the present step, if a host gives it.
    next_flow: Option<WaveSpans>,
    extrapolation: Extrapolation,
    prescribed: PrescribedMotion,
    reactions: Reactions,
    scale: Scale,
    /// Input record including the sample of the present step.
    next_record: InputRecord,
    moved_lines: Vec<MovedLine>,
    catenaries: Vec<Option<Catenary>>,
}

impl Simulation {
    /// Builds the discrete model of a scene and solves its static equilibrium at the reference positions. The mesh is that of [`Model::new`]: no
    /// convergence trials are run (see `discretisation::select`).
    ///
    /// # Errors
    /// The scene is invalid, or no static equilibrium is found.
    pub fn new(scene: &Scene) -> Result<Simulation, Error> {
        Simulation::start(Model::new(scene)?, start::Shapes::AsGiven)
    }

    /// Builds the discrete model of a scene and solves its static equilibrium without initial shapes, motion and waves. The result equals that of
    /// [`Simulation::new`] followed by [`Simulation::in_equilibrium`].
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn at_rest(scene: &Scene) -> Result<Simulation, Error> {
        let mut model = Model::new(scene)?;
        make_still(&mut model);
        Simulation::start(model, start::Shapes::Equilibrium)
    }

    fn start(model: Model, shapes: start::Shapes) -> Result<Simulation, Error> {
        let mut model = Arc::new(model);
        let rests = |_: usize, line: &Line| line.initial == InitialShape::Static;
        let begin = |model: &Model| start::begin(model, 0.0, Inputs::new(model), false, shapes);
        let (mut snapshot, work) = start::settle(&mut model, shapes, rests, begin)?;
        let moved_lines = MovedLine::all(&model, &snapshot.state);
        snapshot.input_record = InputRecord::of(&moved_lines);
        let lines = model.lines.iter();
        Ok(Simulation {
            catenaries: lines.map(|line| reference_catenary(&model, line)).collect(),
            paths: snapshot.paths.clone(),
            next_flow: None,
            extrapolation: Extrapolation::none(),
            prescribed: PrescribedMotion::new(&model, false, work.choices()),
            reactions: Reactions::new(&model),
            scale: Scale::new(&model),
            next_record: InputRecord::of(&moved_lines),
            moved_lines,
            snapshot,
            work,
            model,
        })
    }

    /// Returns this mooring in static equilibrium at its reference positions, without initial shapes, motion and waves.
    ///
    /// # Errors
    /// No static equilibrium is found.
    pub fn in_equilibrium(&self) -> Result<Simulation, Error> {
        let mut still = self.clone();
        still.snapshot.inputs = Inputs::new(&self.model);
        make_still(Arc::make_mut(&mut still.model));
        let had_shape = |index: usize, _: &Line| self.model.lines[index].initial != InitialShape::Static;
        let shapes = start::Shapes::Equilibrium;
        still.begin_with(0.0, false, shapes, |model, begin| {
            start::settle(model, shapes, had_shape, begin)
        })?;
        Ok(still)
    }

    /// Restarts at rest, with coupled points that follow the scene's motion exactly instead of the inputs of a host.
    ///
    /// # Errors
    /// As for [`Simulation::new`]; the simulation is then unchanged.
    pub fn follow_scene(&mut self) -> Result<(), Error> {
        self.begin(self.time(), true, start::Shapes::AsGiven)
    }

    /// Restarts at rest at a start time [s], with the displacements set so far.
    ///
    /// # Errors
    /// As for [`Simulation::new`]; the simulation is then unchanged.
    pub fn restart(&mut self, start_time: f64) -> Result<(), Error> {
        let follows_scene = self.snapshot.follows_scene;
        self.begin(start_time, follows_scene, start::Shapes::AsGiven)
    }

    fn begin(&mut self, time: f64, follows_scene: bool, shapes: start::Shapes) -> Result<(), Error> {
        // the model remains that of the reference positions, so that a state can be restored in another simulation
        self.begin_with(time, follows_scene, shapes, |model, begin| begin(model))
    }

    /// Begins at rest as `solve` finds it, from the model and the function that solves the start of a model.
    fn begin_with(
        &mut self,
        time: f64,
        follows_scene: bool,
        shapes: start::Shapes,
        solve: impl FnOnce(&mut Arc<Model>, &dyn Fn(&Model) -> Started) -> Started,
    ) -> Result<(), Error> {
        let inputs = &self.snapshot.inputs;
        self.scale.check_start(&self.model, inputs)?;
        inputs.flow.check_start(&self.model)?;
        let mut model = self.model.clone();
        winches::lay_out(&mut model, &inputs.length_changes, follows_scene.then_some(time))?;
        let begin = |model: &Model| start::begin(model, time, inputs.clone(), follows_scene, shapes);
        (self.snapshot, self.work) = solve(&mut model, &begin)?;
        self.snapshot.input_record = InputRecord::of(&self.moved_lines);
        self.paths.clone_from(&self.snapshot.paths);
        self.model = model;
        self.prescribed = PrescribedMotion::new(&self.model, follows_scene, self.work.choices());
        self.reactions.clear();
        Ok(())
    }

    /// Model of the mooring.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Time [s].
    pub fn time(&self) -> f64 {
        self.snapshot.state.time + self.snapshot.ahead
    }

    /// Positions and velocities.
    pub fn state(&self) -> &State {
        &self.snapshot.state
    }

    /// Everything that changes in the simulation.
    pub fn snapshot(&self) -> &Snapshot {
        &self.snapshot
    }

    /// Restores a snapshot of [`Simulation::snapshot`].
    pub fn restore(&mut self, snapshot: Snapshot) {
        self.snapshot = snapshot;
        self.paths.clone_from(&self.snapshot.paths);
        self.work.forget();
        self.prescribed =
            PrescribedMotion::new(&self.model, self.snapshot.follows_scene, self.work.choices());
        self.reactions.clear();
        winches::follow(&mut self.model, &self.snapshot.state);
    }

    /// Integrator of each network, with its step limits.
    pub fn choices(&self) -> impl Iterator<Item = &Choice> {
        self.work.choices()
    }

    /// Describes the integrators and their step limits in sentences, with the names of the lines where networks differ.
    pub fn choices_in_words(&self) -> Vec<String> {
        let mut kinds: Vec<(String, Vec<&str>)> = Vec::new();
        for (choice, network) in self.choices().zip(&self.model.networks) {
            let words = choice.in_words();
            let names = network
                .lines
                .iter()
                .map(|&line| self.model.lines[line].name.as_str());
            match kinds.iter_mut().find(|(known, _)| *known == words) {
                Some((_, lines)) => lines.extend(names),
                None => kinds.push((words, names.collect())),
            }
        }
        if let [(words, _)] = &mut kinds[..] {
            return vec![std::mem::take(words)];
        }
        let kinds = kinds.iter();
        kinds
            .map(|(words, names)| format!("{}: {words}", few(names)))
            .collect()
    }

    /// Number of threads used in communication steps of a given length [s], in words with the reason.
    pub fn threads_in_words(&self, length: f64) -> String {
        self.work.threads_in_words(length)
    }

    /// Steps from the present time to `step` [s] later. A step of 0 s does nothing. Steps shorter than a microsecond leave the state unchanged until
    /// they add up to a microsecond.
    ///
    /// # Errors
    /// The step fails or an input exceeds its limits; the state is then unchanged.
    pub fn advance(&mut self, step: f64) -> Result<(), StepError> {
        if step <= 0.0 {
            return Ok(());
        }
        let step = self.snapshot.ahead + step;
        if step < STEP_MIN {
            self.snapshot.ahead = step;
            self.snapshot.counters = Counters::default();
            return Ok(());
        }
        self.check_inputs(step)?;
        self.extend_paths(step)?;
        self.extend_flow(step, Course::Given);
        if !self.model.derivatives {
            return self.integrate(step);
        }
        let earlier = self.snapshot.begun.take();
        let snapshot = self.snapshot.clone();
        let done = self.integrate(step);
        self.snapshot.begun = match done {
            Ok(()) => Some(Box::new(StepStart { snapshot, step })),
            Err(_) => earlier,
        };
        done
    }

    /// Integrates along the paths laid out for a step [s].
    fn integrate(&mut self, step: f64) -> Result<(), StepError> {
        let before = self.release_lines();
        self.record_inputs();
        self.swap_flow();
        let model = &*self.model;
        let follows_scene = self.snapshot.follows_scene;
        let at = MotionSource::new(model, &self.paths, follows_scene);
        let time = self.snapshot.state.time;
        self.prescribed.prepare(&at, [time, time + step]);
        let held = |point: usize, t: f64| self.prescribed.point(&at, point, t);
        let state = &mut self.snapshot.state;
        let advanced = self.work.advance(model, state, step, &held);
        if advanced.is_err() {
            self.swap_flow();
            if let Some((state, balance)) = before {
                (self.snapshot.state, self.snapshot.balance) = (state, balance);
            }
        }
        let done = advanced?;
        self.snapshot.counters = done.counters;
        std::mem::swap(&mut self.snapshot.input_record, &mut self.next_record);
        self.snapshot.ahead = 0.0;
        self.snapshot.last_step = step;
        self.keep_flow();
        if let Some(balance) = &mut self.snapshot.balance {
            balance.flow.add(done.flow);
        }
        std::mem::swap(&mut self.snapshot.paths, &mut self.paths);
        self.reactions.clear();
        if !self.paths.winch_paths.is_empty() {
            winches::follow(&mut self.model, &self.snapshot.state);
        }
        Ok(())
    }

    /// Refuses inputs that exceed the limits of a step [s].
    fn check_inputs(&self, step: f64) -> Result<(), StepError> {
        let (snapshot, time) = (&self.snapshot, self.snapshot.state.time);
        match snapshot.follows_scene {
            true => Ok(()),
            false => {
                snapshot.inputs.flow.check_step(&self.model, time)?;
                self.scale.check_step(&self.model, &snapshot.inputs, time, step)
            }
        }
    }

    /// Releases the lines from their points as commanded; returns the state before.
    fn release_lines(&mut self) -> Option<(State, Option<EnergyBalance>)> {
        if !self.snapshot.inputs.releases.contains(&true) {
            return None;
        }
        let model = &*self.model;
        let lines = model.lines.iter().zip(&self.snapshot.inputs.releases);
        let states = self.snapshot.state.lines.iter();
        let released = |((line, release), shape): ((&Line, &bool), &LineState)| {
            let releases = line.release.filter(|_| *release);
            let lets_go = |side: usize| releases.is_some_and(|p| p[side].on_release);
            (0..2).any(|side| lets_go(side) && !shape.released[side])
        };
        if !lines.clone().zip(states).any(released) {
            return None;
        }
        self.work.forget();
        let before = (self.snapshot.state.clone(), self.snapshot.balance);
        for ((line, release), shape) in lines.zip(&mut self.snapshot.state.lines) {
            if let Some(releases) = line.release.filter(|_| *release) {
                for (released, release) in shape.released.iter_mut().zip(releases) {
                    *released |= release.on_release;
                }
            }
        }
        if let Some(balance) = &mut self.snapshot.balance {
            let states = [&before.0, &self.snapshot.state];
            for network in &model.networks {
                balance.flow.external_work += energy_balance::joined_energy(model, network, states);
            }
            let [held, free] = states.map(|state| self.work.kinetic_energy_of_leapfrogs(model, state));
            balance.flow.dissipation += free - held;
        }
        Some(before)
    }
}

/// Removes waves, a host's water flow and initial shapes before an equilibrium is solved.
fn make_still(model: &mut Model) {
    (model.waves, model.host_flow) = (None, false);
    for point in &mut model.points {
        if let Role::Prescribed(motion) = &mut point.role {
            *motion = Motion::none();
        }
    }
    // the initial shape of a beam or cable may be its moment-free shape, and its equilibrium iteration starts from it
    for line in model.lines.iter_mut().filter(|line| !line.may_rest_bent()) {
        line.initial = InitialShape::Static;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Drives a line for one second in steps of a given length [s].
    fn driven(simulation: &mut Simulation, step: f64) {
        let count = (1.0 / step).round() as usize;
        for _ in 0..count {
            let x = 0.3 * simulation.time().sin();
            simulation.set_displacement(1, [x, 0.0, 0.0]);
            simulation.advance(step).unwrap();
        }
    }

    #[test]
    fn steps_shorter_than_rounding_allows_wait_for_the_next_one() {
        let scene = include_str!("../scenes/oc3_catenary.toml");
        let scene = Scene::from_toml(scene).unwrap();
        let mut simulation = Simulation::new(&scene).unwrap();
        let point = simulation.model().point_index("fairlead");
        assert_eq!(point, Some(1));
        driven(&mut simulation, 0.05);
        let before = simulation.clone();
        for step in [1e-14, 1e-9, 0.4e-6] {
            simulation.advance(step).unwrap();
            assert_eq!(simulation.end_force(1), before.end_force(1), "{step} s");
            assert_eq!(simulation.substeps(), 0);
        }
        assert!(simulation.time() > before.time());
        let mut saved = before.clone();
        saved.restore(simulation.snapshot().clone());
        for continued in [&mut simulation, &mut saved] {
            continued.advance(0.05).unwrap();
            let gone = continued.time() - before.time();
            assert!((gone - (0.05 + 1e-14 + 1e-9 + 0.4e-6)).abs() < 1e-15 + f64::EPSILON);
            assert_eq!(continued.time(), continued.state().time);
        }
        assert_eq!(simulation.snapshot(), saved.snapshot());
        let mut smooth = before.clone();
        smooth.advance(0.05).unwrap();
        let (force, other) = (simulation.tension_b(0), smooth.tension_b(0));
        assert!((force / other - 1.0).abs() < 1e-5, "{force} {other}");
    }
}
