//! Mooring that a host drives: a scene, its variables and, after start, a simulation. Safe code without pointers.

use std::ffi::c_int;
use std::path::Path;

use moorline::discretisation;
use moorline::interface::{Binding, Causality, HostInputs, INPUT_MAX, Interface, Layout, NoValue, Variable};
use moorline::model::{Body, Model};
use moorline::output::{collect, json, sealed};
use moorline::scene::{Note, Scene};
use moorline::simulation::{self, BodyInput, Inputs, NO_FLOW, Simulation, Snapshot, Watch};
use moorline_decks::load;
use serde::{Deserialize, Serialize};

use crate::codes::*;

/// Failure: code and message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Failure {
    pub(crate) code: c_int,
    pub(crate) message: String,
}

impl Failure {
    pub(crate) fn new(code: c_int, message: impl Into<String>) -> Failure {
        Failure {
            code,
            message: message.into(),
        }
    }

    pub(crate) fn argument(message: impl Into<String>) -> Failure {
        Failure::new(MOORLINE_INVALID_ARGUMENT, message)
    }
}

pub(crate) type Outcome<T = ()> = Result<T, Failure>;

/// First bytes of a saved state.
const MARK: &[u8] = concat!("moorline c 1 ", env!("CARGO_PKG_VERSION"), "\n").as_bytes();

/// Everything that changes in a session.
#[derive(Debug, Serialize, Deserialize)]
struct Saved {
    scene: String,
    origin: Inputs,
    start_time: f64,
    inputs: HostInputs,
    snapshot: Option<Snapshot>,
}

/// Body moved by the host.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Moved {
    pub(crate) name: String,
    pub(crate) body: Body,
    /// Number of degrees of freedom [-]: 3 or 6.
    pub(crate) size: usize,
}

/// Mooring driven by a host.
#[derive(Debug)]
pub(crate) struct Session {
    scene: Scene,
    interface: Interface,
    moved: Vec<Moved>,
    inputs: HostInputs,
    /// Inputs at the start, with which the equilibrium was solved.
    origin: Inputs,
    start_time: f64,
    simulation: Option<Simulation>,
    watch: Option<Watch>,
    /// Notes on the scene that have been passed to the host.
    noted: Vec<Note>,
    /// Warnings that the host has not read, one per line.
    pub(crate) warnings: String,
}

impl Session {
    pub(crate) fn load(path: &Path) -> Outcome<Session> {
        let loaded = load(path).map_err(|error| Failure::new(MOORLINE_SCENE_ERROR, error.list()))?;
        let mut session = Session::new(loaded.scene)?;
        session.note(&loaded.notes);
        Ok(session)
    }

    pub(crate) fn read(text: &str) -> Outcome<Session> {
        let mut session = Session::new(Scene::from_toml(text).map_err(scene_error)?)?;
        session.note(&session.scene.notes());
        Ok(session)
    }

    fn new(scene: Scene) -> Outcome<Session> {
        let model = Model::new(&scene).map_err(scene_error)?;
        let interface = Interface::new(&scene, &model, Layout::Scalars).map_err(scene_error)?;
        let inputs = HostInputs::new(interface.inputs());
        Ok(Session {
            noted: scene.notes(),
            moved: moved(&scene, &model),
            origin: inputs.given().clone(),
            inputs,
            interface,
            scene,
            start_time: 0.0,
            simulation: None,
            watch: None,
            warnings: String::new(),
        })
    }

    /// Selects by convergence trials the values that the scene leaves open: elements, integrator and time step.
    pub(crate) fn select(&mut self) -> Outcome {
        self.expect_not_started("select")?;
        if let Some(found) = discretisation::select(&self.scene) {
            let notes = found.shortfalls();
            let mut next = Session::new(found.scene)?;
            let flow = next.inputs.given().flow.clone(); // of the nodes of the selected mesh
            next.inputs.clone_from(&self.inputs);
            *next.inputs.flow_mut() = flow;
            next.warnings = std::mem::take(&mut self.warnings);
            *self = next;
            self.note(&notes);
        }
        Ok(())
    }

    fn expect_not_started(&self, what: &str) -> Outcome {
        match self.simulation {
            None => Ok(()),
            Some(_) => Err(Failure::new(
                MOORLINE_WRONG_PHASE,
                format!("{what} comes before start: reset first"),
            )),
        }
    }

    pub(crate) fn simulation(&self) -> Outcome<&Simulation> {
        let missing = || {
            Failure::new(
                MOORLINE_WRONG_PHASE,
                "the simulation was not started: call start first",
            )
        };
        self.simulation.as_ref().ok_or_else(missing)
    }

    /// Solves the equilibrium with the current inputs at a time [s].
    pub(crate) fn start(&mut self, time: f64) -> Outcome {
        if !time.is_finite() {
            return Err(Failure::argument(format!(
                "the start time {time} s is not finite"
            )));
        }
        let simulation = equilibrium(&self.scene, time, self.inputs.given())?;
        self.note_scene();
        self.watch = Some(Watch::new(&self.scene, &simulation));
        self.simulation = Some(simulation);
        self.note_state();
        self.origin.clone_from(self.inputs.given());
        self.start_time = time;
        Ok(())
    }

    /// Returns to the state before the start; parameters and inputs are kept.
    pub(crate) fn reset(&mut self) {
        self.simulation = None;
        self.watch = None;
    }

    /// Appends notes to the warnings for the host.
    fn note(&mut self, notes: &[Note]) {
        for note in notes {
            self.warnings += &format!("{note}\n");
        }
    }

    /// Appends the notes on the scene with its current parameters, each once.
    fn note_scene(&mut self) {
        let mut notes = self.scene.notes();
        notes.retain(|note| !self.noted.contains(note));
        self.note(&notes);
        self.noted.extend(notes);
    }

    /// Appends the notes on the current state, each once.
    fn note_state(&mut self) {
        if let (Some(watch), Some(simulation)) = (&mut self.watch, &self.simulation) {
            let notes = watch.look(simulation);
            self.note(&notes);
        }
    }

    /// Steps by a time [s].
    pub(crate) fn step(&mut self, step: f64) -> Outcome {
        if !(step.is_finite() && step >= 0.0) {
            return Err(Failure::argument(format!(
                "a step of {step} s: it must be finite and not negative"
            )));
        }
        self.simulation()?;
        if let Some(simulation) = &mut self.simulation {
            simulation.set_inputs(self.inputs.given());
            let advanced = simulation.advance(step);
            advanced.map_err(|error| Failure::new(MOORLINE_STEP_ERROR, error.to_string()))?;
        }
        self.note_state();
        Ok(())
    }

    pub(crate) fn variables(&self) -> &[Variable] {
        self.interface.variables()
    }

    pub(crate) fn variable(&self, reference: u32) -> Outcome<&Variable> {
        let count = self.variables().len();
        let unknown = || {
            Failure::argument(format!(
                "there is no variable {reference}: 1 to {count} would be right"
            ))
        };
        self.interface.variable(reference).ok_or_else(unknown)
    }

    pub(crate) fn find(&self, name: &str) -> Outcome<u32> {
        let found = self.variables().iter().position(|variable| variable.name == name);
        let unknown = || Failure::argument(format!("there is no variable `{name}`"));
        found.map(Interface::reference).ok_or_else(unknown)
    }

    /// Returns the references of all variables with a causality, in ascending order.
    pub(crate) fn references(&self, causality: Causality) -> Vec<u32> {
        let variables = self.variables().iter().enumerate();
        let wanted = variables.filter(|(_, variable)| variable.causality == causality);
        wanted.map(|(index, _)| Interface::reference(index)).collect()
    }

    pub(crate) fn get(&self, references: &[u32], values: &mut [f64]) -> Outcome {
        check_lengths(references.len(), values.len())?;
        for (&reference, value) in references.iter().zip(values) {
            *value = self.value(self.variable(reference)?)?;
        }
        Ok(())
    }

    /// Computes the derivatives of outputs with respect to an input.
    pub(crate) fn derivatives(&self, outputs: &[u32], input: u32, values: &mut [f64]) -> Outcome {
        let (outputs, input) = (self.variables_of(outputs)?, self.variable(input)?);
        let found = Interface::derivative(&outputs, input, self.simulation()?);
        put_derivatives(found, values)
    }

    /// Computes the time derivatives of outputs [per second].
    pub(crate) fn rates(&self, outputs: &[u32], values: &mut [f64]) -> Outcome {
        let found = Interface::rates(&self.variables_of(outputs)?, self.simulation()?);
        put_derivatives(found, values)
    }

    fn variables_of(&self, references: &[u32]) -> Outcome<Vec<&Variable>> {
        let variables = references.iter().map(|&reference| self.variable(reference));
        variables.collect()
    }

    fn value(&self, variable: &Variable) -> Outcome<f64> {
        let mut value = [0.0];
        match &variable.binding {
            _ if self.inputs.read(variable, &mut value) => Ok(value[0]),
            Binding::Parameter(parameter) => parameter.value(&self.scene).ok_or_else(|| {
                Failure::new(MOORLINE_NOT_AVAILABLE, format!("{} has no value", variable.name))
            }),
            _ => {
                let read = Interface::read(variable, self.simulation()?, &mut value);
                read.map(|()| value[0]).map_err(|reason| match reason {
                    NoValue::Undefined(problem) => Failure::new(MOORLINE_NOT_AVAILABLE, problem),
                    NoValue::NotFinite(problem) => Failure::new(MOORLINE_STEP_ERROR, problem),
                })
            }
        }
    }

    /// Sets inputs, and before the start parameters: all of them, or none if one is refused.
    pub(crate) fn set(&mut self, references: &[u32], values: &[f64]) -> Outcome {
        check_lengths(references.len(), values.len())?;
        let (mut scene, mut inputs, steps) = (None, self.inputs.clone(), self.simulation.is_some());
        for (&reference, &value) in references.iter().zip(values) {
            let variable = self.variable(reference)?;
            if !value.is_finite() || value.abs() > INPUT_MAX && variable.causality == Causality::Input {
                return Err(Failure::argument(format!(
                    "{}: {value} cannot be used; nothing was set",
                    variable.name
                )));
            }
            match &variable.binding {
                Binding::Parameter(parameter) => {
                    self.expect_not_started("a parameter")?;
                    let scene = scene.get_or_insert_with(|| self.scene.clone());
                    let set = parameter.set(scene, value);
                    set.map_err(|problem| Failure::argument(format!("{}: {problem}", variable.name)))?;
                }
                _ if variable.causality == Causality::Input => inputs.write(variable, &[value], steps),
                _ => {
                    return Err(Failure::argument(format!(
                        "{} is a result and not to be set",
                        variable.name
                    )));
                }
            }
        }
        if let Some(scene) = scene {
            let model = Model::new(&scene).map_err(scene_error)?;
            self.interface.check_nodes(&model).map_err(Failure::argument)?;
            self.scene = scene;
        }
        self.inputs = inputs;
        Ok(())
    }

    pub(crate) fn moved(&self) -> &[Moved] {
        &self.moved
    }

    pub(crate) fn body(&self, index: usize) -> Outcome<&Moved> {
        let count = self.moved.len();
        let unknown = || Failure::argument(format!("there is no body {index}: there are {count}, from 0"));
        self.moved.get(index).ok_or_else(unknown)
    }

    /// Sets the current pose of a body, and its velocity if given.
    pub(crate) fn move_body(&mut self, index: usize, place: &[f64], velocity: Option<&[f64]>) -> Outcome {
        let body = self.body(index)?.clone();
        check_lengths(body.size, place.len())?;
        check_numbers(&body.name, place.iter().chain(velocity.unwrap_or(&[])))?;
        let mut input = BodyInput {
            velocity: std::array::from_fn(|axis| velocity?.get(axis).copied()),
            ..BodyInput::default()
        };
        input.displacement[..body.size].copy_from_slice(place);
        self.inputs.set_body(body.body, input);
        Ok(())
    }

    /// Returns the force on a body [N] and, for a vessel, the moment [N m].
    pub(crate) fn force(&self, index: usize) -> Outcome<Vec<f64>> {
        let (body, simulation) = (self.body(index)?, self.simulation()?);
        Ok(simulation.host_force(body.body)[..body.size].to_vec())
    }

    /// Returns the stiffness of the mooring on a vessel, row by row [N/m, N, N m].
    pub(crate) fn stiffness(&self, index: usize) -> Outcome<[[f64; 6]; 6]> {
        let (body, simulation) = (self.body(index)?, self.simulation()?);
        let Body::Vessel(vessel) = body.body else {
            return Err(Failure::new(
                MOORLINE_NOT_AVAILABLE,
                format!("{} is a point: the stiffness is that on a vessel", body.name),
            ));
        };
        simulation.vessel_stiffness(vessel).ok_or_else(|| {
            Failure::new(
                MOORLINE_NOT_AVAILABLE,
                format!(
                    "{}: no stiffness, for a beam holds it or its lines are not stable as they are",
                    body.name
                ),
            )
        })
    }

    /// Name of a line.
    pub(crate) fn line(&self, index: usize) -> Outcome<&str> {
        let lines = &self.scene.lines;
        let unknown = || {
            Failure::argument(format!(
                "there is no line {index}: there are {}, from 0",
                lines.len()
            ))
        };
        lines
            .get(index)
            .map(|line| line.name.as_str())
            .ok_or_else(unknown)
    }

    pub(crate) fn line_count(&self) -> usize {
        self.scene.lines.len()
    }

    /// Returns the positions [m] and tensions [N] of the nodes of a line, from end A to end B.
    pub(crate) fn nodes(&self, index: usize) -> Outcome<Vec<([f64; 3], f64)>> {
        self.line(index)?;
        let profile = self.simulation()?.profile(index).into_iter();
        Ok(profile
            .map(|node| ([node.x, node.y, node.z], node.tension))
            .collect())
    }

    /// Returns the positions at which the water flow is required next, for the nodes of a line from end A to end B [m].
    pub(crate) fn flow_places(&self, index: usize) -> Outcome<Vec<[f64; 3]>> {
        let count = self.flow_count(index)?;
        let simulation = self.simulation()?;
        let place = |node| simulation.flow_place(index, node).into();
        Ok((0..count).map(place).collect())
    }

    /// Sets velocity [m/s] and acceleration [m/s²] of the water at the nodes of a line from end A to end B, three values per node.
    pub(crate) fn set_flow(&mut self, index: usize, velocities: &[f64], accelerations: &[f64]) -> Outcome {
        let count = self.flow_count(index)?;
        check_lengths(3 * count, velocities.len())?;
        check_numbers(self.line(index)?, velocities.iter().chain(accelerations))?;
        let (velocities, _) = velocities.as_chunks();
        let (accelerations, _) = accelerations.as_chunks();
        for (node, (&velocity, &acceleration)) in velocities.iter().zip(accelerations).enumerate() {
            self.inputs.flow_mut().set(index, node, velocity, acceleration);
        }
        Ok(())
    }

    /// Returns the number of nodes of a line at which the host sets the water flow.
    fn flow_count(&self, index: usize) -> Outcome<usize> {
        let line = self.line(index)?;
        match self.interface.inputs().flow.node_count(index) {
            0 => Err(Failure::new(MOORLINE_NOT_AVAILABLE, format!("{line}: {NO_FLOW}"))),
            count => Ok(count),
        }
    }

    /// Returns the equilibrium in the format of `moorline statics --json`.
    pub(crate) fn statics(&self) -> Outcome<String> {
        let mut scene = self.scene.clone();
        if let Some(water) = &mut scene.water {
            water.waves = None; // the equilibrium is that in still water
        }
        let simulation = Simulation::at_rest(&scene).map_err(building_error)?;
        Ok(json::text(&collect::statics(&scene, simulation)))
    }

    /// Returns the scene with its current parameters as TOML.
    pub(crate) fn scene(&self) -> String {
        self.scene.to_toml()
    }

    /// Serialises everything that changes in the session.
    pub(crate) fn save(&self) -> Vec<u8> {
        let saved = Saved {
            scene: self.scene.to_toml(),
            origin: self.origin.clone(),
            start_time: self.start_time,
            inputs: self.inputs.clone(),
            snapshot: self
                .simulation
                .as_ref()
                .map(|simulation| simulation.snapshot().clone()),
        };
        sealed::seal(MARK, &saved)
    }

    /// Restores a saved state of this scene; its parameters may differ.
    pub(crate) fn restore(&mut self, bytes: &[u8]) -> Outcome {
        let damaged = || Failure::argument("the bytes are no state of this version of moorline, or damaged");
        let saved: Saved = sealed::open(MARK, bytes).map_err(|_| damaged())?;
        let same_start = self.simulation.is_some()
            && saved.scene == self.scene.to_toml()
            && saved.origin == self.origin
            && saved.start_time.to_bits() == self.start_time.to_bits();
        let mut next = match same_start {
            true => None,
            false => Some(self.sibling(&saved)?),
        };
        let target = next.as_mut().unwrap_or(self);
        match (saved.snapshot, &mut target.simulation) {
            (Some(snapshot), Some(simulation)) => {
                simulation.restore(snapshot);
                if let Some(watch) = &mut target.watch {
                    watch.resume(simulation);
                }
            }
            (None, simulation) => *simulation = None,
            (Some(_), None) => return Err(damaged()),
        }
        target.inputs = saved.inputs;
        if let Some(next) = next {
            *self = next;
        }
        Ok(())
    }

    /// Returns a session with the scene and start of a saved state; refuses a state with other variables.
    fn sibling(&self, saved: &Saved) -> Outcome<Session> {
        let mut other = Session::read(&saved.scene)?;
        let names = |session: &Session| -> Vec<String> {
            session
                .variables()
                .iter()
                .map(|variable| variable.name.clone())
                .collect()
        };
        if names(&other) != names(self) {
            return Err(Failure::argument(
                "the state is that of another scene, or of another mesh: moorline_select gives this simulation the mesh of the trials",
            ));
        }
        other.inputs = HostInputs::new(&saved.origin);
        if saved.snapshot.is_some() {
            other.start(saved.start_time)?;
        }
        other.warnings.clone_from(&self.warnings);
        Ok(other)
    }
}

/// Bodies that a host moves, in the order of the variables: coupled points, then vessels.
fn moved(scene: &Scene, model: &Model) -> Vec<Moved> {
    let bodies = model.bodies().map(|body| match body {
        Body::Point(point) => Moved {
            name: scene.points[point].name.clone(),
            body,
            size: 3,
        },
        Body::Vessel(vessel) => Moved {
            name: scene.vessels[vessel].name.clone(),
            body,
            size: 6,
        },
    });
    let is_moved = |body: &Moved| match body.body {
        Body::Point(point) => matches!(model.points[point].role, moorline::model::Role::Coupled { .. }),
        Body::Vessel(_) => true,
    };
    bodies.filter(is_moved).collect()
}

/// Copies derivatives to an array of the same length.
fn put_derivatives(found: Result<Vec<f64>, String>, values: &mut [f64]) -> Outcome {
    let found = found.map_err(|problem| Failure::new(MOORLINE_NOT_AVAILABLE, problem))?;
    check_lengths(found.len(), values.len())?;
    values.copy_from_slice(&found);
    Ok(())
}

fn check_lengths(wanted: usize, given: usize) -> Outcome {
    match wanted == given {
        true => Ok(()),
        false => Err(Failure::argument(format!(
            "{wanted} values are wanted, and there is room for {given}"
        ))),
    }
}

/// Refuses numbers that are not valid inputs.
fn check_numbers<'v>(name: &str, values: impl IntoIterator<Item = &'v f64>) -> Outcome {
    let mut values = values.into_iter();
    match values.find(|value| value.is_nan() || value.abs() > INPUT_MAX) {
        None => Ok(()),
        Some(value) => Err(Failure::argument(format!(
            "{name}: {value} cannot be used; nothing was set"
        ))),
    }
}

fn scene_error(error: moorline::scene::SceneError) -> Failure {
    Failure::new(MOORLINE_SCENE_ERROR, error.to_string())
}

fn building_error(error: simulation::Error) -> Failure {
    let code = match &error {
        simulation::Error::Scene(_) => MOORLINE_SCENE_ERROR,
        simulation::Error::Statics(_) => MOORLINE_STATICS_ERROR,
    };
    Failure::new(code, error.to_string())
}

fn equilibrium(scene: &Scene, time: f64, inputs: &Inputs) -> Outcome<Simulation> {
    let mut simulation = Simulation::new(scene).map_err(building_error)?;
    simulation.set_inputs(inputs);
    simulation.restart(time).map_err(building_error)?;
    Ok(simulation)
}
