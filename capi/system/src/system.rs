//! Life cycle of a system: created from a deck, started at the host's positions, stepped.

use std::path::Path;

use moorline::dynamics::{StepError, StepFailure};
use moorline::model::Body;
use moorline::scene::{AngleOrder, InitialShape, Scene};
use moorline::simulation::{Simulation, Watch};
use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

use crate::channels::Files;
use crate::deck::Deck;
use crate::failure::{Code, Failure, Outcome};
use crate::log::{Log, MESSAGE, WARNING};
use crate::saved::check_sum;
use crate::settings::{Force, Path as HostPath, Settings};

/// Difference between the clocks of the host and the simulation that is attributed to rounding [s].
const CLOCK_TOLERANCE: f64 = 1e-6;

/// Words of the reader's remarks that do not apply to this interface, which has MoorDyn's laws and writes files of single lines.
const OVERRULED: [&str; 2] = ["negative_tension", "no files of single lines"];

/// Scene keys that occur in notes, and the environment variables that take their place in this interface.
const CHOICES: [(&str, &str); 3] = [
    ("solver.tolerance", "MOORLINE_TOLERANCE"),
    (
        "solver.input_reconstruction = \"interpolate\"",
        "MOORLINE_PATH=smooth",
    ),
    ("solver.input_reconstruction = \"smooth\"", "MOORLINE_PATH=smooth"),
];

/// Everything that determines the simulation before its first step, in addition to the scene of the deck.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Start {
    /// Coupled positions [m] and angles [rad].
    pub place: Vec<f64>,
    /// True if lines start as catenaries instead of in equilibrium.
    pub is_approximate: bool,
    /// Line ends that can be released: index of the line in the scene, and true for end B.
    pub loose: Vec<(usize, bool)>,
    /// Time [s].
    pub time: f64,
}

/// Mooring system of a host.
#[derive(Debug)]
pub struct System {
    /// The deck.
    pub deck: Deck,
    /// Messages.
    pub log: Log,
    /// Name of the time scheme set by the deck or the host; it has no effect.
    pub scheme: String,
    /// Courant number set by the deck or the host [-]; it has no effect.
    pub cfl: f64,
    /// Internal time step set by the deck or the host [s].
    pub dt: f64,
    pub(crate) settings: Settings,
    pub(crate) simulation: Option<Simulation>,
    pub(crate) start: Start,
    /// Check sum of the scene that was started.
    pub(crate) scene_sum: [u8; 32],
    /// Coupled positions [m] and angles [rad] at the end of the last step; their rates during it [m/s, rad/s]; and their accelerations, from the difference
    /// between these rates and those of the step before [m/s², rad/s²].
    pub(crate) motion: [Vec<f64>; 3],
    /// Host time minus simulation time [s].
    pub(crate) ahead: f64,
    files: Option<Files>,
    pub(crate) watch: Option<Watch>,
    pub(crate) has_stepped: bool,
    has_warned_of_time: bool,
}

impl System {
    /// Reads a deck, with settings from the environment; messages go to `log`.
    ///
    /// # Errors
    /// The deck cannot be used.
    pub fn create(path: &Path, settings: Settings, log: Log) -> Outcome<System> {
        let deck = Deck::read(path, &settings)?;
        let number = |keys: &[&str]| deck.lists.option(keys).and_then(|text| text.parse::<f64>().ok());
        let mut system = System {
            dt: number(&["DTM", "DT"]).unwrap_or(deck.scene.solver.time_step_max),
            cfl: number(&["CFL"]).unwrap_or(0.5),
            scheme: deck.lists.option(&["TSCHEME"]).unwrap_or("RK2").to_string(),
            log,
            settings,
            simulation: None,
            start: Start::default(),
            scene_sum: [0; 32],
            motion: [Vec::new(), Vec::new(), Vec::new()],
            ahead: 0.0,
            files: None,
            watch: None,
            has_stepped: false,
            has_warned_of_time: false,
            deck,
        };
        let remarks = std::mem::take(&mut system.deck.remarks).into_iter();
        for remark in remarks.filter(|remark| !OVERRULED.iter().any(|words| remark.contains(words))) {
            system.log.write(MESSAGE, &remark);
        }
        Ok(system)
    }

    /// Starts at the coupled positions `x` [m, rad], which move at `xd` [m/s, rad/s]: in static equilibrium or, if `is_approximate`, on catenaries.
    ///
    /// # Errors
    /// Wrong or non-finite positions, or no equilibrium.
    pub fn start(&mut self, x: &[f64], xd: &[f64], is_approximate: bool) -> Outcome {
        self.check_motion(x, xd)?;
        let start = Start {
            place: x.to_vec(),
            is_approximate,
            loose: Vec::new(),
            time: 0.0,
        };
        self.begin(start)?;
        self.scene_sum = check_sum(&self.deck.scene);
        self.motion = [x.to_vec(), xd.to_vec(), vec![0.0; x.len()]];
        self.files = None;
        self.open_files()?;
        self.write_channels([0.0, f64::INFINITY])?;
        for choice in self.simulation.iter().flat_map(Simulation::choices) {
            let text = format!("integrator {:?}, {}", choice.integrator, choice.in_words());
            self.log.write(MESSAGE, &text);
        }
        Ok(())
    }

    /// Builds the simulation of a start; a failure keeps the current one.
    fn begin(&mut self, start: Start) -> Outcome {
        let simulation = self.simulation_of(&start)?;
        self.watch = Some(Watch::new(&self.deck.scene, &simulation));
        self.simulation = Some(simulation);
        self.start = start;
        self.log_watch();
        self.has_stepped = false;
        self.has_warned_of_time = false;
        self.ahead = 0.0;
        Ok(())
    }

    /// Returns the simulation of a start.
    pub(crate) fn simulation_of(&self, start: &Start) -> Outcome<Simulation> {
        if start.place.len() != self.deck.degrees_of_freedom() {
            return Err(Failure::value(
                "the start has another number of degrees of freedom than the deck",
            ));
        }
        let mut simulation = simulation(&self.scene_of(start))?;
        if start.time != 0.0 {
            let restarted = simulation.restart(start.time);
            restarted.map_err(|error| Failure::value(error.to_string()))?;
        }
        Ok(simulation)
    }

    /// Returns the scene of a start, whose reference positions are the host's positions.
    fn scene_of(&self, start: &Start) -> Scene {
        let mut scene = self.deck.scene.clone();
        for coupled in &self.deck.coupled {
            let place = &start.place[coupled.first..];
            match coupled.body {
                Some(Body::Point(point)) => scene.points[point].position = [place[0], place[1], place[2]],
                Some(Body::Vessel(vessel)) => {
                    let vessel = &mut scene.vessels[vessel];
                    vessel.position = [place[0], place[1], place[2]];
                    let deck_attitude = Vector3::from(vessel.attitude);
                    let (before, now) = (
                        AngleOrder::Zyx.rotation(deck_attitude),
                        host_rotation(&place[3..6]),
                    );
                    vessel.attitude = AngleOrder::Zyx.angles(&now, deck_attitude).into();
                    let name = vessel.name.clone();
                    turn_clamps(&mut scene, &name, &(now * before.inverse()));
                }
                None => {}
            }
        }
        for line in &mut scene.lines {
            if start.is_approximate && line.initial == InitialShape::Static {
                line.initial = InitialShape::Catenary;
            }
        }
        for &(line, at_b) in &start.loose {
            let end = match at_b {
                true => moorline::scene::LineEnd::B,
                false => moorline::scene::LineEnd::A,
            };
            scene.lines[line].release = Some(end);
        }
        scene
    }

    /// Returns the simulation.
    ///
    /// # Errors
    /// The system was not started.
    pub fn simulation(&self) -> Outcome<&Simulation> {
        let missing = || Failure::value("the system was not started: call Init first");
        self.simulation.as_ref().ok_or_else(missing)
    }

    fn check_motion(&self, x: &[f64], xd: &[f64]) -> Outcome {
        let count = self.deck.degrees_of_freedom();
        if [x, xd].iter().any(|values| values.len() != count) {
            return Err(Failure::value(format!(
                "the system has {count} coupled degrees of freedom, but {} positions and {} velocities are given",
                x.len(),
                xd.len()
            )));
        }
        match x.iter().chain(xd).position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(index) => Err(Failure::new(
                Code::InvalidValue,
                format!(
                    "a {} is not finite, at coupled degree of freedom {}",
                    if index < count { "position" } else { "velocity" },
                    index % count
                ),
            )),
        }
    }

    /// Steps from the host's time `t` to `t + dt` [s] with the coupled positions `x` [m, rad] at its start, which move at `xd` [m/s, rad/s]
    /// throughout. A step of 0 s changes nothing.
    ///
    /// # Errors
    /// Arguments that cannot be used, a step that fails (the simulation then keeps its state), or a channel file that cannot be written.
    pub fn step(&mut self, x: &[f64], xd: &[f64], t: f64, dt: f64) -> Outcome<f64> {
        self.check_motion(x, xd)?;
        if !t.is_finite() || !dt.is_finite() || dt < 0.0 {
            return Err(Failure::value(format!(
                "a step of {dt} s from {t} s: both must be finite, the step not negative"
            )));
        }
        self.simulation()?;
        if dt == 0.0 {
            return Ok(t);
        }
        self.follow_clock(t)?;
        self.set_motion(x, xd, dt);
        let advanced = self.simulation.as_mut().map(|simulation| simulation.advance(dt));
        if let Some(Err(error)) = advanced {
            return Err(step_failure(&error));
        }
        self.has_stepped = true;
        let [place, rate, acceleration] = &mut self.motion;
        place.clear();
        place.extend(x.iter().zip(xd).map(|(x, v)| x + v * dt));
        acceleration.clear();
        acceleration.extend(xd.iter().zip(&*rate).map(|(v, before)| (v - before) / dt));
        rate.clear();
        rate.extend_from_slice(xd);
        self.log_watch();
        let time = t + dt;
        self.write_channels([time, dt])?;
        Ok(time)
    }

    /// Logs notes on the current state, each once, with environment variables instead of scene keys.
    fn log_watch(&mut self) {
        if let (Some(watch), Some(simulation)) = (&mut self.watch, &self.simulation) {
            for note in watch.look(simulation) {
                let text = CHOICES
                    .iter()
                    .fold(note.to_string(), |text, (key, here)| text.replace(key, here));
                self.log.write(WARNING, &text);
            }
        }
    }

    /// Adopts the host's clock at the first step. Afterwards the host's time may differ only if no load depends on time.
    fn follow_clock(&mut self, t: f64) -> Outcome {
        let gap = t - self.simulation()?.time() - self.ahead;
        if gap.abs() <= CLOCK_TOLERANCE * t.abs().max(1.0) {
            return Ok(());
        }
        let moves = self.simulation()?.model().waves.is_some();
        if !self.has_stepped && moves {
            let start = Start {
                time: t,
                ..self.start.clone()
            };
            let inputs = self.simulation()?.inputs().clone();
            self.begin(start)?;
            if let Some(simulation) = &mut self.simulation {
                simulation.set_inputs(&inputs); // lines that were broken off before
            }
            return Ok(());
        }
        if moves {
            return Err(Failure::value(format!(
                "the host steps from {t} s, but the last step ended at {} s: waves depend on time, restore a state to go back",
                t - gap
            )));
        }
        if self.has_stepped && !self.has_warned_of_time {
            self.has_warned_of_time = true;
            let text = format!(
                "the host steps from {t} s, but the last step ended at {} s; reported once",
                t - gap
            );
            self.log.write(WARNING, &text);
        }
        self.ahead += gap;
        Ok(())
    }

    /// Passes the motion over a step of `dt` [s] to the simulation, in the form that the selected path needs.
    fn set_motion(&mut self, x: &[f64], xd: &[f64], dt: f64) {
        let Some(simulation) = &mut self.simulation else {
            return;
        };
        let (reach, is_given) = match self.settings.path {
            HostPath::Smooth => (dt, false),
            HostPath::Jump | HostPath::Predict => (0.0, true),
        };
        for coupled in &self.deck.coupled {
            let Some(body) = coupled.body else { continue };
            let [place, motion] = [x, xd].map(|values| &values[coupled.first..coupled.first + coupled.size]);
            let at = |index: usize| place[index] + reach * motion[index];
            let rate = |index: usize| is_given.then(|| motion[index]);
            let model = simulation.model();
            match body {
                Body::Point(point) => {
                    let from = model.points[point].reference;
                    let displacement = [0, 1, 2].map(|axis| at(axis) - from[axis]);
                    simulation.set_displacement(point, displacement);
                    simulation.set_velocity(point, [0, 1, 2].map(rate));
                }
                Body::Vessel(vessel) => {
                    let (origin, attitude) = (model.vessels[vessel].position, model.vessels[vessel].attitude);
                    let [.., roll, pitch, yaw] = simulation.inputs().body(body).displacement;
                    let near = attitude + Vector3::new(roll, pitch, yaw);
                    let turn =
                        UnitQuaternion::from_scaled_axis(reach * Vector3::from_row_slice(&motion[3..6]));
                    let turned =
                        AngleOrder::Zyx.angles(&(turn * host_rotation(&place[3..6])), near) - attitude;
                    let moved = [0, 1, 2].map(|axis| at(axis) - origin[axis]);
                    let pose = [moved[0], moved[1], moved[2], turned.x, turned.y, turned.z];
                    simulation.set_body(body, pose, [0, 1, 2, 3, 4, 5].map(rate));
                }
            }
        }
    }

    /// Computes the forces on the coupled objects [N, N m], in the order of the degrees of freedom. As in MoorDyn, nodal forces on a body contain −M a and
    /// the centrifugal force of the nodes that it carries, without the moment of the latter, and those on a point do not.
    ///
    /// # Errors
    /// A wrong number of forces, the system was not started, or a force is not finite.
    pub fn forces(&self, forces: &mut [f64]) -> Outcome {
        let simulation = self.simulation()?;
        if forces.len() != self.deck.degrees_of_freedom() {
            return Err(Failure::value(format!(
                "room for {} forces, but the system has {} coupled degrees of freedom",
                forces.len(),
                self.deck.degrees_of_freedom()
            )));
        }
        for coupled in &self.deck.coupled {
            let force = match (coupled.body, self.settings.force) {
                (Some(Body::Point(point)), Force::Nodal) => &simulation.nodal_force(point)[..],
                (Some(Body::Point(point)), Force::Reaction) => &simulation.end_force(point)[..],
                (Some(Body::Vessel(vessel)), Force::Nodal) => &simulation.vessel_nodal_force(vessel)[..],
                (Some(Body::Vessel(vessel)), Force::Reaction) => &simulation.vessel_force(vessel)[..],
                (None, _) => &[0.0; 6][..],
            };
            if force.iter().any(|value| !value.is_finite()) {
                return Err(Failure::new(Code::NotFinite, "a force is not finite"));
            }
            let on_coupled = &mut forces[coupled.first..coupled.first + coupled.size];
            on_coupled.copy_from_slice(force);
            if let (Some(Body::Vessel(_)), Force::Nodal) = (coupled.body, self.settings.force) {
                let acceleration = &self.motion[2][coupled.first..coupled.first + coupled.size];
                let mass = self.carried_mass(coupled)?;
                for (force, row) in on_coupled.iter_mut().zip(mass) {
                    *force -= row.iter().zip(acceleration).map(|(m, a)| m * a).sum::<f64>();
                }
                let centrifugal = self.centrifugal_force(coupled)?;
                (0..3).for_each(|axis| on_coupled[axis] += centrifugal[axis]);
            }
        }
        Ok(())
    }

    /// Returns the host's time [s].
    ///
    /// # Errors
    /// The system was not started.
    pub fn time(&self) -> Outcome<f64> {
        Ok(self.simulation()?.time() + self.ahead)
    }

    /// Creates the channel files, unless they are open.
    pub(crate) fn open_files(&mut self) -> Outcome {
        if self.files.is_none()
            && let Some(simulation) = &self.simulation
        {
            self.files = Files::create(&self.deck, simulation, &mut self.log)?;
        }
        Ok(())
    }

    fn write_channels(&mut self, [time, step]: [f64; 2]) -> Outcome {
        match (&mut self.files, &self.simulation) {
            (Some(files), Some(simulation)) => files.row([time, step], simulation),
            _ => Ok(()),
        }
    }
}

/// Rotation by roll, pitch and yaw of a host [rad].
fn host_rotation(angles: &[f64]) -> UnitQuaternion<f64> {
    AngleOrder::Xyz.rotation(Vector3::from_row_slice(angles))
}

/// Turns the clamps of the lines on a vessel, whose directions are global.
fn turn_clamps(scene: &mut Scene, vessel: &str, turn: &UnitQuaternion<f64>) {
    let Scene { points, lines, .. } = scene;
    let is_on_vessel = |name: &str| {
        let mut points = points.iter();
        points.any(|point| point.name == name && point.on.as_deref() == Some(vessel))
    };
    for line in lines {
        for (point, clamp) in [(&line.from, &mut line.clamped_a), (&line.to, &mut line.clamped_b)] {
            if let Some(along) = clamp.as_mut().filter(|_| is_on_vessel(point)) {
                *along = (turn * Vector3::from(*along)).into();
            }
        }
    }
}

fn simulation(scene: &Scene) -> Outcome<Simulation> {
    Simulation::new(scene).map_err(|error| match &error {
        moorline::simulation::Error::Scene(_) => Failure::new(Code::InvalidInputFile, error.to_string()),
        moorline::simulation::Error::Statics(_) => Failure::value(error.to_string()),
    })
}

fn step_failure(error: &StepError) -> Failure {
    let code = match error.cause {
        StepFailure::Input(_) | StepFailure::Winch(_) | StepFailure::TooManySteps { .. } => {
            Code::InvalidValue
        }
        _ => Code::NotFinite,
    };
    Failure::new(code, error.to_string())
}
