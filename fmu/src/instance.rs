//! FMI state machine over a simulation, for both versions of FMI. Safe code without pointers.
//!
//! Sources: FMI 2.0.4 section 4.2.4 (state machine of co-simulation), FMI 3.0.2 section 4.2. The standard leaves two choices open:
//! here, a refused call leaves everything unchanged, so the instance remains usable; and a failed step returns `Error`, not
//! `Discard`, since the solver has already tried shorter internal steps and a smaller communication step would not help.

mod access;
mod derivatives;
mod parts;

use moorline::interface::{Binding, HostInputs, Interface};
use moorline::output::description::{Description, VERSION, time_reference};
use moorline::scene::{Note, Scene};
use moorline::simulation::{Inputs, Simulation, Watch};
use moorline_host::{FmiVersion, Status};

pub(crate) use parts::Parts;

use crate::log::{Log, Topic};
use crate::resources;
use crate::saved::{Phase, Snapshot};

/// Reason why a call was refused or failed: a message for the host's log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Refusal(pub(crate) String);

impl From<String> for Refusal {
    fn from(message: String) -> Self {
        Refusal(message)
    }
}

impl From<&str> for Refusal {
    fn from(message: &str) -> Self {
        Refusal(message.to_string())
    }
}

type Outcome = Result<(), Refusal>;

/// Difference between the clocks of host and instance that is attributed to rounding, relative to the step [-].
const TIME_TOLERANCE: f64 = 1e-6;
/// Greatest relative change of a step by rounding of the host's clock [-]; a larger one is refused.
const RESOLUTION: f64 = 1e-4;

/// FMU instance.
#[derive(Debug)]
pub(crate) struct Instance {
    packaged: Scene,
    scene: Scene,
    interface: Interface,
    token: String,
    /// Value reference of time; FMI 2.0 has no such variable.
    time_reference: Option<u32>,
    pub(crate) log: Log,
    phase: Phase,
    start_time: f64,
    stop_time: Option<f64>,
    time: f64,
    inputs: HostInputs,
    /// Inputs used in the last solution of the statics.
    start: Inputs,
    /// Statics with the current parameters and inputs, or the state after the last step; `None` until the statics are solved.
    simulation: Option<Simulation>,
    has_warned_of_time: bool,
    /// Notes on the scene that have been logged.
    noted: Vec<Note>,
    /// Produces notes on the steps; present if warnings are logged.
    watch: Option<Watch>,
    step_status: Status,
    /// References of the variables that the host accesses in intermediate updates.
    announced: Vec<u32>,
}

impl Instance {
    /// Reads the scene from the resources and compares the host's token with the scene's.
    pub(crate) fn new(
        version: FmiVersion,
        token: Option<&str>,
        resources: Option<&[u8]>,
        logging: bool,
    ) -> Result<Instance, Refusal> {
        let text = resources::read_scene(resources)?;
        let scene = Scene::from_toml(&text).map_err(|e| e.to_string())?;
        let description = Description::new(&text, &scene, version).map_err(|e| e.to_string())?;
        if token != Some(description.token.as_str()) {
            return Err(Refusal(format!(
                "the token \"{}\" is not that of this scene with moorline {VERSION}, \"{}\": \
                 description, scene and library do not belong together; package the scene again",
                token.unwrap_or_default(),
                description.token
            )));
        }
        let mut instance = Instance {
            inputs: HostInputs::new(description.interface.inputs()),
            start: description.interface.inputs().clone(),
            time_reference: (version == FmiVersion::Three).then(|| time_reference(&description.interface)),
            packaged: scene.clone(),
            scene,
            interface: description.interface,
            token: description.token,
            log: Log::new(logging),
            phase: Phase::Instantiated,
            start_time: 0.0,
            stop_time: None,
            time: 0.0,
            simulation: None,
            has_warned_of_time: false,
            noted: Vec::new(),
            watch: None,
            step_status: Status::Ok,
            announced: Vec::new(),
        };
        instance.log_plausibility();
        Ok(instance)
    }

    /// Logs the notes on the scene with its current parameters, each once.
    fn log_plausibility(&mut self) {
        if !self.log.keeps(Topic::Warning) {
            return;
        }
        for note in self.scene.plausibility() {
            self.warn_once(note);
        }
    }

    /// Logs a note, unless it has been logged before.
    fn warn_once(&mut self, note: Note) {
        if !self.noted.contains(&note) {
            self.log.push(Topic::Warning, || note.to_string());
            self.noted.push(note);
        }
    }

    /// Logs the notes on the current state of the simulation, each once.
    fn log_watch(&mut self) {
        let simulation = self
            .simulation
            .as_ref()
            .filter(|_| self.log.keeps(Topic::Warning));
        if let Some(simulation) = simulation {
            let watch = self
                .watch
                .get_or_insert_with(|| Watch::new(&self.scene, simulation));
            for note in watch.look(simulation) {
                self.log.push(Topic::Warning, || note.to_string());
            }
        }
    }

    fn expect_phase(&self, allowed: &[Phase]) -> Outcome {
        if allowed.contains(&self.phase) {
            return Ok(());
        }
        let now = match self.phase {
            Phase::Instantiated => "before initialization mode",
            Phase::Initialization => "in initialization mode",
            Phase::Step => "after initialization",
            Phase::Terminated => "after terminate",
            Phase::Intermediate => "in the host's intermediate update",
        };
        Err(Refusal(format!("out of order: not allowed {now}")))
    }

    /// Turns log categories on or off; an empty list means all.
    pub(crate) fn set_debug_logging(&mut self, on: bool, categories: &[&str]) -> Outcome {
        self.log
            .select(on, categories)
            .map_err(|name| Refusal(format!("there is no log category \"{name}\"")))
    }

    /// Sets start and end time [s]. The host's tolerance is not used: it refers to the integration error, whereas `solver.tolerance` refers to
    /// the fairlead tension.
    pub(crate) fn set_up(&mut self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Outcome {
        self.expect_phase(&[Phase::Instantiated])?;
        if !start.is_finite() {
            return Err(Refusal(format!("the start time {start} s is not finite")));
        }
        if let Some(stop) = stop
            && (stop.is_nan() || stop < start)
        {
            return Err(Refusal(format!(
                "the stop time {stop} s is not after the start time {start} s"
            )));
        }
        self.start_time = start;
        self.stop_time = stop;
        self.time = start;
        if let Some(tolerance) = tolerance {
            self.log.push(Topic::Event, || {
                format!("the host's tolerance {tolerance} is not used: set solver.tolerance")
            });
        }
        Ok(())
    }

    pub(crate) fn enter_initialization(&mut self) -> Outcome {
        self.expect_phase(&[Phase::Instantiated])?;
        self.simulation = None;
        self.phase = Phase::Initialization;
        Ok(())
    }

    pub(crate) fn exit_initialization(&mut self) -> Outcome {
        self.expect_phase(&[Phase::Initialization])?;
        self.solve_statics()?;
        self.phase = Phase::Step;
        self.log_choices();
        self.log_plausibility();
        self.watch = None;
        self.log_watch();
        Ok(())
    }

    /// Logs the selected integrators.
    fn log_choices(&mut self) {
        let Some(simulation) = &self.simulation else {
            return;
        };
        for words in simulation.choices_in_words() {
            self.log.push(Topic::Event, || format!("integrator: {words}"));
        }
    }

    pub(crate) fn terminate(&mut self) -> Outcome {
        self.expect_phase(&[Phase::Step])?;
        self.phase = Phase::Terminated;
        Ok(())
    }

    /// Returns to the state after instantiation; the log keeps its settings.
    pub(crate) fn reset(&mut self) -> Outcome {
        self.expect_no_update()?;
        self.scene.clone_from(&self.packaged);
        self.inputs = HostInputs::new(self.interface.inputs());
        self.phase = Phase::Instantiated;
        self.start_time = 0.0;
        self.stop_time = None;
        self.time = 0.0;
        self.simulation = None;
        self.has_warned_of_time = false;
        self.watch = None;
        self.step_status = Status::Ok;
        Ok(())
    }

    /// Solves the static equilibrium with the current parameters and inputs, unless it is already solved. The solution always starts
    /// from the same initial guess, so that it does not depend on earlier inputs.
    fn solve_statics(&mut self) -> Result<&mut Simulation, Refusal> {
        if self.simulation.is_none() {
            self.start.clone_from(self.inputs.given());
            #[cfg(test)]
            tests::count_statics();
            let simulation = statics(&self.scene, &self.interface, self.start_time, &self.start)?;
            self.simulation = Some(simulation);
        }
        Ok(self.simulation.as_mut().expect("was there or was just solved"))
    }

    /// Advances from the host's time `at` to `at + step` [s].
    pub(crate) fn do_step(&mut self, at: f64, step: f64) -> Outcome {
        let outcome = self.advance(at, step);
        self.step_status = match outcome {
            Ok(()) => Status::Ok,
            Err(_) => Status::Error,
        };
        outcome
    }

    /// Returns the status of the last step.
    pub(crate) fn step_status(&self) -> Status {
        self.step_status
    }

    fn advance(&mut self, at: f64, step: f64) -> Outcome {
        self.expect_phase(&[Phase::Step])?;
        if !at.is_finite() || !step.is_finite() || step < 0.0 {
            return Err(Refusal(format!(
                "a step of {step} s from {at} s: both must be finite, the step not negative"
            )));
        }
        if step == 0.0 {
            return Ok(());
        }
        let counted = (at + step) - at;
        if (counted - step).abs() > RESOLUTION * step {
            return Err(Refusal(format!(
                "a step of {step} s from {at} s: floating-point numbers of this size do not resolve it; start from an earlier time"
            )));
        }
        let tolerance = TIME_TOLERANCE * step + 64.0 * f64::EPSILON * self.time.abs();
        let gap = (at - self.time).abs();
        if gap > tolerance {
            return Err(Refusal(format!(
                "the host steps from {at} s, but the last step ended at {} s: restore a state to go back",
                self.time
            )));
        }
        if let Some(stop) = self.stop_time
            && at + step > stop + tolerance
        {
            return Err(Refusal(format!(
                "the step to {} s goes beyond the stop time {stop} s",
                at + step
            )));
        }
        if gap > 0.5 * tolerance && !self.has_warned_of_time {
            self.has_warned_of_time = true;
            let time = self.time;
            self.log.push(Topic::Warning, || {
                format!(
                    "the host's time {at} s differs from {time} s, where the last step ended; reported once"
                )
            });
        }
        let simulation = self
            .simulation
            .as_mut()
            .expect("solved at the end of initialization");
        simulation.set_inputs(self.inputs.given());
        simulation.advance(step).map_err(|e| e.to_string())?;
        self.time = at + step; // the host's clock, so that rounding errors do not accumulate
        self.log_watch();
        Ok(())
    }

    /// Returns the end of the last successful step [s].
    pub(crate) fn time(&self) -> f64 {
        self.time
    }

    /// Returns a copy of everything that changes during a simulation.
    pub(crate) fn snapshot(&self) -> Snapshot {
        Snapshot {
            phase: self.phase,
            start_time: self.start_time,
            stop_time: self.stop_time,
            time: self.time,
            parameters: self.parameters(&self.scene),
            inputs: self.inputs.clone(),
            start: self.start.clone(),
            solver: self.simulation.as_ref().map(|s| s.snapshot().clone()),
        }
    }

    fn parameters(&self, scene: &Scene) -> Vec<f64> {
        self.interface
            .variables()
            .iter()
            .filter_map(|variable| match &variable.binding {
                Binding::Parameter(parameter) => parameter.value(scene),
                _ => None,
            })
            .collect()
    }

    /// Restores a saved state.
    pub(crate) fn restore(&mut self, snapshot: &Snapshot) -> Outcome {
        self.expect_no_update()?;
        let (own, new) = (self.parameters(&self.scene), &snapshot.parameters);
        let same_scene = same_bits(&own, new);
        let same_start = same_scene
            && self.start_time.to_bits() == snapshot.start_time.to_bits()
            && self.start == snapshot.start;
        let mut scene = self.scene.clone();
        if !same_scene {
            let rows = self.interface.variables().iter();
            let rows = rows.filter_map(|variable| match &variable.binding {
                Binding::Parameter(parameter) => Some(parameter),
                _ => None,
            });
            for (parameter, &value) in rows.zip(new) {
                parameter.set(&mut scene, value)?;
            }
        }
        let rebuilt = match &snapshot.solver {
            Some(_) if !same_start || self.simulation.is_none() => {
                let (time, start) = (snapshot.start_time, &snapshot.start);
                Some(statics(&scene, &self.interface, time, start)?)
            }
            _ => None,
        };
        // From here on nothing can fail.
        let simulation = rebuilt.or_else(|| self.simulation.take());
        self.simulation = snapshot
            .solver
            .as_ref()
            .zip(simulation)
            .map(|(state, mut simulation)| {
                simulation.restore(state.clone());
                simulation
            });
        if let (Some(watch), Some(simulation)) = (&mut self.watch, &self.simulation) {
            watch.resume(simulation);
        }
        self.start.clone_from(&snapshot.start);
        self.scene = scene;
        self.phase = snapshot.phase;
        self.start_time = snapshot.start_time;
        self.stop_time = snapshot.stop_time;
        self.time = snapshot.time;
        self.inputs.clone_from(&snapshot.inputs);
        Ok(())
    }

    pub(crate) fn serialize(&self, snapshot: &Snapshot) -> Vec<u8> {
        snapshot.to_bytes(&self.token)
    }

    pub(crate) fn deserialize(&self, bytes: &[u8]) -> Result<Snapshot, Refusal> {
        Ok(Snapshot::from_bytes(bytes, &self.token)?)
    }
}

/// Solves the static equilibrium at a time [s] with the given inputs, always from the same initial guess. The water flow acts from this state on.
/// Refuses a model whose nodes differ from those of the interface.
fn statics(scene: &Scene, interface: &Interface, time: f64, inputs: &Inputs) -> Result<Simulation, Refusal> {
    // values that the packaged scene leaves open are not selected by trials: the interface has the mesh of the rules
    let mut simulation = Simulation::new(scene).map_err(|e| e.to_string())?;
    interface.check_nodes(simulation.model())?;
    simulation.set_inputs(inputs);
    simulation.restart(time).map_err(|e| e.to_string())?;
    Ok(simulation)
}

fn same_bits(these: &[f64], those: &[f64]) -> bool {
    let bits = |value: &f64| value.to_bits();
    these.iter().map(bits).eq(those.iter().map(bits))
}

#[cfg(test)]
pub(crate) mod tests {
    use moorline::interface::Kind;

    use super::*;

    const SCENE: &str = include_str!("../../tests/scenes/hand.toml");

    thread_local! {
        /// Number of static solutions on this thread [-].
        static STATICS: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
    }

    pub(super) fn count_statics() {
        STATICS.set(STATICS.get() + 1);
    }

    #[test]
    fn parameters_set_one_by_one_are_solved_for_once() {
        let mut instance = instance(FmiVersion::Two);
        instance.enter_initialization().unwrap();
        let before = STATICS.get();
        for name in ["rope.mass", "rope.length", "gravity"] {
            let value = real(&mut instance, name);
            for factor in [1.1, 1.2, 1.05] {
                set(&mut instance, name, factor * value).unwrap();
            }
        }
        assert_eq!(STATICS.get(), before);
        let tension = real(&mut instance, "rope.tension_b");
        instance.exit_initialization().unwrap();
        assert_eq!(STATICS.get(), before + 1);
        assert_eq!(real(&mut instance, "rope.tension_b"), tension);
    }

    #[test]
    fn a_parameter_out_of_range_is_refused_where_it_is_set() {
        let mut instance = instance(FmiVersion::Two);
        let mass = real(&mut instance, "rope.mass");
        assert!(set(&mut instance, "rope.mass", -1.0).is_err());
        assert_eq!(real(&mut instance, "rope.mass"), mass);
    }

    pub(crate) fn instance(version: FmiVersion) -> Instance {
        instance_of(SCENE, version)
    }

    fn instance_of(text: &str, version: FmiVersion) -> Instance {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("scene.toml"), text).unwrap();
        let scene = Scene::from_toml(text).unwrap();
        let token = Description::new(text, &scene, version).unwrap().token;
        let path = folder.path().to_str().map(str::as_bytes);
        Instance::new(version, Some(&token), path, true).unwrap()
    }

    fn reference(instance: &Instance, name: &str) -> u32 {
        let variables = instance.interface.variables();
        let index = variables.iter().position(|v| v.name == name);
        Interface::reference(index.unwrap())
    }

    fn real(instance: &mut Instance, name: &str) -> f64 {
        let reference = reference(instance, name);
        let mut value = [0.0];
        instance.get(Kind::Float64, &[reference], &mut value).unwrap();
        value[0]
    }

    fn set(instance: &mut Instance, name: &str, value: f64) -> Outcome {
        let reference = reference(instance, name);
        instance.set(Kind::Float64, &[reference], &[value])
    }

    fn started() -> Instance {
        let mut instance = instance(FmiVersion::Two);
        instance.enter_initialization().unwrap();
        instance.exit_initialization().unwrap();
        instance
    }

    #[test]
    fn the_host_clock_is_kept_so_that_rounding_does_not_add_up() {
        let mut instance = started();
        for k in 0..1000 {
            instance.do_step(0.1 * f64::from(k), 0.1).unwrap();
        }
        assert_eq!(instance.time(), 0.1 * 999.0 + 0.1);
        assert!(
            instance
                .log
                .take()
                .iter()
                .all(|(topic, _)| *topic == Topic::Event)
        );
    }

    /// Removes and returns the warnings in the log.
    fn warnings(instance: &mut Instance) -> Vec<String> {
        let messages = instance.log.take().into_iter();
        let warnings = messages.filter(|(topic, _)| *topic == Topic::Warning);
        warnings.map(|(_, text)| text).collect()
    }

    #[test]
    fn slips_of_units_jumps_and_strained_lines_are_each_logged_once() {
        let text = format!("gravity = 32.2\n{SCENE}");
        let mut instance = instance_of(&text, FmiVersion::Two);
        let said = warnings(&mut instance);
        assert!(
            said.len() == 1 && said[0].starts_with("gravity: 32.2 m/s²"),
            "{said:?}"
        );
        instance.enter_initialization().unwrap();
        instance.exit_initialization().unwrap();
        assert_eq!(warnings(&mut instance), [""; 0]);
        let start = instance.snapshot();
        for (step, x) in [-1.5, 0.0, 1.8, 1.8].into_iter().enumerate() {
            set(&mut instance, "hand.x", x).unwrap();
            instance.do_step(step as f64, 1.0).unwrap();
        }
        let said = warnings(&mut instance);
        assert_eq!(said.len(), 2, "{said:?}");
        assert!(said[0].contains("hand has moved by 1.5"), "{said:?}");
        assert!(said[1].contains("rope is strained by"), "{said:?}");
        instance.restore(&start).unwrap();
        instance.do_step(0.0, 1.0).unwrap();
        assert_eq!(warnings(&mut instance), [""; 0]);
    }

    #[test]
    fn a_refused_step_leaves_everything_as_it_was() {
        let mut instance = started();
        instance.do_step(0.0, 0.1).unwrap();
        let before = instance.snapshot();
        for (at, step) in [(0.2, 0.1), (0.1, -0.1), (f64::NAN, 0.1), (0.1, f64::INFINITY)] {
            assert!(instance.do_step(at, step).is_err());
            assert_eq!(instance.snapshot(), before);
            assert_eq!(instance.step_status(), Status::Error);
        }
        instance.do_step(0.1, 0.0).unwrap();
        assert_eq!(instance.snapshot(), before);
    }

    #[test]
    fn values_of_one_call_are_set_together_or_not_at_all() {
        let mut instance = started();
        let references = ["hand.x", "hand.y"].map(|name| reference(&instance, name));
        let refusal = instance.set(Kind::Float64, &references, &[0.1, f64::NAN]);
        assert!(refusal.unwrap_err().0.contains("hand.y"));
        assert_eq!(real(&mut instance, "hand.x"), 0.0);
    }

    /// Returns an instance, started, of the scene in water whose flow the host sets.
    fn hosted(version: FmiVersion) -> Instance {
        let water = "[water]\ndensity = 1025.0\nflow = \"host\"\n[line_types.rope]\ndiameter = 0.01\ndrag_normal = 1.2\n";
        let mut instance = instance_of(&SCENE.replace("[line_types.rope]\n", water), version);
        instance.enter_initialization().unwrap();
        instance.exit_initialization().unwrap();
        instance
    }

    fn set_all(instance: &mut Instance, names: &[String], values: &[f64]) -> Outcome {
        let references: Vec<u32> = names.iter().map(|name| reference(instance, name)).collect();
        instance.set(Kind::Float64, &references, values)
    }

    #[test]
    fn arrays_of_the_flow_are_its_scalars_and_are_set_whole_among_other_inputs() {
        let (mut two, mut three) = (hosted(FmiVersion::Two), hosted(FmiVersion::Three));
        let flow: Vec<f64> = (0..7).map(|node| 0.1 * f64::from(node)).collect();
        let values = [&[0.02], &flow[..], &[0.01]].concat();
        let scalars = (1..=7).map(|node| format!("rope.flow.vy[{node}]"));
        let [x, z] = ["hand.x", "hand.z"].map(String::from);
        let scalars: Vec<String> = [x.clone()]
            .into_iter()
            .chain(scalars)
            .chain([z.clone()])
            .collect();
        let arrays = [x, "rope.flow.vy".to_string(), z];
        set_all(&mut two, &scalars, &values).unwrap();
        set_all(&mut three, &arrays, &values).unwrap();
        for wrong in [&values[..8], &values[..1], &[&values[..], &[0.0]].concat()] {
            let refusal = set_all(&mut three, &arrays, wrong).unwrap_err();
            assert!(refusal.0.contains("9 values"), "{}", refusal.0);
        }
        let mut broken = values.clone();
        broken[4] = f64::NAN;
        assert!(
            set_all(&mut three, &arrays, &broken)
                .unwrap_err()
                .0
                .starts_with("rope.flow.vy: NaN")
        );
        let (mut found, array) = ([0.0; 7], reference(&three, "rope.flow.vy"));
        three.get(Kind::Float64, &[array], &mut found).unwrap();
        assert_eq!(found[..], flow);
        let saved = three.snapshot();
        let mut tensions = Vec::new();
        for instance in [&mut two, &mut three] {
            instance.do_step(0.0, 0.1).unwrap();
            tensions.push(real(instance, "rope.tension_b"));
        }
        three.reset().unwrap();
        three.get(Kind::Float64, &[array], &mut found).unwrap();
        assert_eq!(found, [0.0; 7]);
        three.restore(&saved).unwrap();
        three.do_step(0.0, 0.1).unwrap();
        assert_eq!(tensions, [real(&mut three, "rope.tension_b"); 2]);
    }

    #[test]
    fn a_parameter_set_in_initialization_shows_in_the_outputs() {
        let mut instance = instance(FmiVersion::Three);
        instance.enter_initialization().unwrap();
        let light = real(&mut instance, "rope.tension_b");
        set(&mut instance, "rope.mass", 0.4).unwrap();
        let heavy = real(&mut instance, "rope.tension_b");
        assert!(heavy > 1.5 * light, "{light} {heavy}");
        instance.reset().unwrap();
        instance.enter_initialization().unwrap();
        assert_eq!(real(&mut instance, "rope.tension_b"), light);
    }

    #[test]
    fn fmi2_has_no_time_variable() {
        let mut two = instance(FmiVersion::Two);
        let time = time_reference(&two.interface);
        assert!(two.get(Kind::Float64, &[time], &mut [0.0]).is_err());
        let mut three = instance(FmiVersion::Three);
        three.set_up(None, 5.0, None).unwrap();
        let mut value = [0.0];
        three.get(Kind::Float64, &[time], &mut value).unwrap();
        assert_eq!(value, [5.0]);
        assert!(three.set(Kind::Float64, &[time], &[1.0]).is_err());
    }

    #[test]
    fn start_and_stop_times_must_make_sense() {
        let mut instance = instance(FmiVersion::Two);
        assert!(instance.set_up(None, f64::NAN, None).is_err());
        assert!(instance.set_up(None, 1.0, Some(0.0)).is_err());
        instance.set_up(Some(1e-6), 1.0, Some(1.2)).unwrap();
        instance.enter_initialization().unwrap();
        instance.exit_initialization().unwrap();
        instance.do_step(1.0, 0.1).unwrap();
        instance.do_step(1.1, 0.1).unwrap();
        let refusal = instance.do_step(1.2, 0.1).unwrap_err();
        assert!(refusal.0.contains("stop time 1.2 s"), "{}", refusal.0);
    }

    #[test]
    fn directional_and_adjoint_derivatives_are_those_of_steps_from_a_saved_state() {
        let asked = "[output]\nderivatives = true\n[solver]\ninput_reconstruction = \"interpolate\"\n";
        assert!(!SCENE.contains("[output]") && !SCENE.contains("[solver]"));
        let mut instance = instance_of(&format!("{SCENE}\n{asked}"), FmiVersion::Three);
        instance.enter_initialization().unwrap();
        let inputs = ["hand.x", "hand.z", "hand.vx", "hand.vz"].map(|name| reference(&instance, name));
        let forces = ["hand.fx", "hand.fz"].map(|name| reference(&instance, name));
        let mut at_rest = [0.0; 2];
        let still = [1.0, 0.0, 0.0, 0.0];
        instance
            .directional_derivative(&forces, &inputs, &still, &mut at_rest)
            .unwrap();
        assert!(at_rest[0] < 0.0, "{at_rest:?}");
        instance.exit_initialization().unwrap();
        let (start, values, seed) = (instance.snapshot(), [0.01, 0.0, 0.3, -0.2], [0.5, -0.3, 2.0, 1.0]);
        let mut stepped = |by: f64| {
            instance.restore(&start).unwrap();
            let moved: Vec<f64> = values
                .iter()
                .zip(seed)
                .map(|(value, part)| value + by * part)
                .collect();
            instance.set(Kind::Float64, &inputs, &moved).unwrap();
            instance.do_step(0.0, 0.01).unwrap();
            forces.map(|reference| {
                let mut value = [0.0];
                instance.get(Kind::Float64, &[reference], &mut value).unwrap();
                value[0]
            })
        };
        let [below, above] = [stepped(-1e-6), stepped(1e-6)];
        stepped(0.0);
        let mut found = [0.0; 2];
        instance
            .directional_derivative(&forces, &inputs, &seed, &mut found)
            .unwrap();
        let mut by_input = [0.0; 4];
        instance
            .adjoint_derivative(&forces, &inputs, &[1.0, 0.0], &mut by_input)
            .unwrap();
        let adjoint: f64 = by_input.iter().zip(seed).map(|(a, b)| a * b).sum();
        assert!((adjoint - found[0]).abs() < 1e-12 * found[0].abs());
        for axis in 0..2 {
            let by_hand = (above[axis] - below[axis]) / 2e-6;
            let error = (found[axis] - by_hand).abs() / by_hand.abs();
            assert!(error < 1e-5, "{axis}: {} {by_hand}", found[axis]);
        }
        assert!(instance.output_derivatives(&forces, &[2, 2], &mut found).is_err());
        instance.output_derivatives(&forces, &[1, 1], &mut found).unwrap();
        let parameter = reference(&instance, "rope.mass");
        let refusal = instance.directional_derivative(&forces, &[parameter], &[1.0], &mut found);
        assert!(
            refusal
                .unwrap_err()
                .0
                .starts_with("rope.mass: derivatives are with respect to displacements")
        );
    }

    #[test]
    fn without_its_key_a_scene_has_no_derivatives() {
        let mut instance = started();
        let [force, place] = ["hand.fx", "hand.x"].map(|name| reference(&instance, name));
        let refusal = instance.directional_derivative(&[force], &[place], &[1.0], &mut [0.0]);
        assert!(refusal.unwrap_err().0.contains("`derivatives` in [output]"));
    }

    #[test]
    fn a_clock_that_does_not_resolve_the_step_is_refused() {
        for (start, is_resolved) in [(1e9, true), (1e12, false), (1e15, false)] {
            let mut instance = instance(FmiVersion::Two);
            instance.set_up(None, start, None).unwrap();
            instance.enter_initialization().unwrap();
            instance.exit_initialization().unwrap();
            assert_eq!(instance.do_step(start, 0.05).is_ok(), is_resolved, "{start} s");
        }
    }
}
