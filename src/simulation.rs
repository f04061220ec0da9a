//! One mooring that a host, the command line, a test or a bench drives: model, state and scratch behind one facade.
//!
//! A scene is made discrete, its static equilibrium solved, and then [`Simulation::advance`] steps from one communication
//! point to the next. Coupled points follow what [`Simulation::set_displacement`] says, or the scene's own motion after
//! [`Simulation::follow_scene`].

pub mod pilot;
mod winches;

use std::cell::Cell;
use std::sync::Arc;

use nalgebra::{Matrix3, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use crate::dynamics::advance::{Counters, Workspace};
use crate::dynamics::beam::{self, BeamView, Momentum};
use crate::dynamics::ledger::{self, Energy, Ledger};
use crate::dynamics::motion::{AxisPath, HostPath, Sample, VesselPath};
use crate::dynamics::{Choice, StepError, reaction};
use crate::math::attitude::angle_rates;
use crate::model::{
    Body, ClosedForm, End, Frame, Kinematics, Line, LineState, Model, PointState, Reel, Role,
    State, joint,
};
use crate::physics::stretch::StretchLaw;
use crate::scene::{InitialShape, Integrator, Scene, SceneError};
use crate::statics::catenary::{self, Bed, Catenary};
use crate::statics::{self, StaticsError, assembly, catenary_network, equilibrium};
use winches::ReelPath;

/// Why a simulation could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// The scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// No static equilibrium was found.
    #[error(transparent)]
    Statics(#[from] StaticsError),
}

/// What a host has said about points and vessels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Inputs {
    points: Vec<PointInput>,
    vessels: Vec<VesselInput>,
    /// Whether each line is to let go.
    releases: Vec<bool>,
    /// What the winches are to have paid out, by line [m].
    length_changes: Vec<f64>,
}

/// What a host has said about a point.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct PointInput {
    /// Displacement from the reference position [m].
    displacement: [f64; 3],
    /// Velocity [m/s]; derived from the displacements where absent.
    velocity: [Option<f64>; 3],
}

/// What a host has said about a vessel.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
struct VesselInput {
    /// Displacement from the reference position [m]; roll, pitch and yaw from the reference attitude [rad].
    pose: [f64; 6],
    /// Velocity [m/s] and angular velocity in global axes [rad/s]; derived from the poses where absent.
    velocity: [Option<f64>; 6],
}

impl VesselInput {
    /// Rates of the pose [m/s, rad/s]. Those of the angles need the whole angular velocity.
    fn rates(&self, attitude: Vector3<f64>) -> [Option<f64>; 6] {
        let [vx, vy, vz, wx, wy, wz] = self.velocity;
        let [_, _, _, roll, pitch, yaw] = self.pose;
        let turning = match (wx, wy, wz) {
            (Some(x), Some(y), Some(z)) => angle_rates(
                attitude + Vector3::new(roll, pitch, yaw),
                Vector3::new(x, y, z),
            ),
            _ => None,
        };
        let angle = |axis: usize| turning.map(|rates| rates[axis]);
        [vx, vy, vz, angle(0), angle(1), angle(2)]
    }
}

/// The paths that points and vessels follow between communication points.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Paths {
    points: Vec<HostPath>,
    vessels: Vec<VesselPath>,
    /// Lengths that the winches pay out, by line; empty where there are none.
    reels: Vec<ReelPath>,
}

impl Clone for Paths {
    fn clone(&self) -> Self {
        Paths {
            points: self.points.clone(),
            vessels: self.vessels.clone(),
            reels: self.reels.clone(),
        }
    }

    fn clone_from(&mut self, source: &Self) {
        self.points.clone_from(&source.points);
        self.vessels.clone_from(&source.vessels);
        self.reels.clone_from(&source.reels);
    }
}

/// All that changes in a simulation. Putting it back replays it bit for bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    state: State,
    inputs: Inputs,
    paths: Paths,
    follows_scene: bool,
    counters: Counters,
    ledger: Ledger,
    start_time: f64,
}

/// A mooring in time.
#[derive(Debug, Clone)]
pub struct Simulation {
    model: Arc<Model>,
    snapshot: Snapshot,
    work: Workspace,
    paths: Paths,
    catenaries: Vec<Option<Catenary>>,
}

/// A node of a line's profile.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ProfileNode {
    /// Unstretched arc length from end A [m].
    pub s: f64,
    /// Position [m].
    pub x: f64,
    /// Position [m].
    pub y: f64,
    /// Position [m].
    pub z: f64,
    /// Effective tension [N].
    pub tension: f64,
    /// How it bends, where the line has bending stiffness.
    pub bending: Option<NodeBending>,
}

/// How a line bends at a node.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct NodeBending {
    /// Curvature [1/m].
    pub curvature: f64,
    /// Bending moment [N m].
    pub moment: f64,
}

impl Simulation {
    /// Makes a scene discrete and solves its static equilibrium at the reference positions. What the scene leaves open of mesh,
    /// integrator and step is tried on its motion ([`pilot::settle`]).
    ///
    /// # Errors
    /// Mistakes in the scene, or an equilibrium that does not exist.
    pub fn new(scene: &Scene) -> Result<Simulation, Error> {
        let settled = pilot::settle(scene);
        Simulation::by_rules(settled.as_ref().map_or(scene, |settled| &settled.scene))
    }

    /// [`Simulation::new`] by rules alone: the mesh is that of [`Model::new`].
    ///
    /// # Errors
    /// As there.
    pub fn by_rules(scene: &Scene) -> Result<Simulation, Error> {
        let model = Arc::new(Model::new(scene)?);
        let inputs = Inputs {
            points: vec![PointInput::default(); model.points.len()],
            vessels: vec![VesselInput::default(); model.vessels.len()],
            releases: vec![false; model.lines.len()],
            length_changes: vec![0.0; model.lines.len()],
        };
        let (snapshot, work) = begin(&model, 0.0, inputs, false)?;
        Ok(Simulation {
            catenaries: model
                .lines
                .iter()
                .map(|line| reference_catenary(&model, line))
                .collect(),
            paths: snapshot.paths.clone(),
            snapshot,
            work,
            model,
        })
    }

    /// Starts again at rest, with coupled points that follow the scene's own motion exactly instead of what a host sets.
    ///
    /// # Errors
    /// As [`Simulation::new`]; the simulation is then as it was.
    pub fn follow_scene(&mut self) -> Result<(), Error> {
        self.begin(self.time(), true)
    }

    /// Starts again at rest, at a start time [s] and the displacements set so far.
    ///
    /// # Errors
    /// As [`Simulation::new`]; the simulation is then as it was.
    pub fn restart(&mut self, start_time: f64) -> Result<(), Error> {
        self.begin(start_time, self.snapshot.follows_scene)
    }

    fn begin(&mut self, time: f64, follows_scene: bool) -> Result<(), Error> {
        let inputs = self.snapshot.inputs.clone();
        let mut model = self.model.clone();
        winches::lay_out(
            &mut model,
            &inputs.length_changes,
            follows_scene.then_some(time),
        )?;
        (self.snapshot, self.work) = begin(&model, time, inputs, follows_scene)?;
        self.model = model;
        Ok(())
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Time [s].
    pub fn time(&self) -> f64 {
        self.snapshot.state.time
    }

    /// Positions and velocities.
    pub fn state(&self) -> &State {
        &self.snapshot.state
    }

    /// All that changes.
    pub fn snapshot(&self) -> &Snapshot {
        &self.snapshot
    }

    /// Puts back what [`Simulation::snapshot`] gave.
    pub fn restore(&mut self, snapshot: Snapshot) {
        self.snapshot = snapshot;
        winches::follow(&mut self.model, &self.snapshot.state);
    }

    /// Sets where a coupled point is now, from its reference position [m].
    pub fn set_displacement(&mut self, point: usize, displacement: [f64; 3]) {
        self.snapshot.inputs.points[point].displacement = displacement;
    }

    /// Displacement of a coupled point as set [m].
    pub fn displacement(&self, point: usize) -> [f64; 3] {
        self.snapshot.inputs.points[point].displacement
    }

    /// Sets how a coupled point moves now [m/s]; axes without a velocity are derived from the displacements.
    pub fn set_velocity(&mut self, point: usize, velocity: [Option<f64>; 3]) {
        self.snapshot.inputs.points[point].velocity = velocity;
    }

    /// Velocity of a coupled point as set [m/s].
    pub fn velocity(&self, point: usize) -> [Option<f64>; 3] {
        self.snapshot.inputs.points[point].velocity
    }

    /// Sets where a vessel is now: displacement from its reference position [m]; roll, pitch and yaw added to those of its reference
    /// attitude [rad].
    pub fn set_pose(&mut self, vessel: usize, pose: [f64; 6]) {
        self.snapshot.inputs.vessels[vessel].pose = pose;
    }

    /// Pose of a vessel as set [m, rad].
    pub fn pose(&self, vessel: usize) -> [f64; 6] {
        self.snapshot.inputs.vessels[vessel].pose
    }

    /// Sets where a body is now and how it moves, along its first three axes or all six.
    pub fn set_body(&mut self, body: Body, pose: [f64; 6], velocity: [Option<f64>; 6]) {
        match body {
            Body::Point(point) => {
                let ([x, y, z, ..], [vx, vy, vz, ..]) = (pose, velocity);
                self.set_displacement(point, [x, y, z]);
                self.set_velocity(point, [vx, vy, vz]);
            }
            Body::Vessel(vessel) => {
                self.set_pose(vessel, pose);
                self.set_vessel_velocity(vessel, velocity);
            }
        }
    }

    /// Sets how a vessel moves now: velocity of its origin [m/s] and angular velocity [rad/s], both in global axes. What is absent is
    /// derived from the poses; the rotation needs all three components.
    pub fn set_vessel_velocity(&mut self, vessel: usize, velocity: [Option<f64>; 6]) {
        self.snapshot.inputs.vessels[vessel].velocity = velocity;
    }

    /// Says whether a line is to let go of the point that its scene names; it does so at the next step, and for good.
    pub fn set_release(&mut self, line: usize, release: bool) {
        self.snapshot.inputs.releases[line] = release;
    }

    /// Whether a line is to let go, as set.
    pub fn release(&self, line: usize) -> bool {
        self.snapshot.inputs.releases[line]
    }

    /// Whether ends A and B of a line have parted from their points.
    pub fn parted(&self, line: usize) -> [bool; 2] {
        self.snapshot.state.lines[line].parted
    }

    /// Sets the length that the winch of a line is to have paid out now beyond that of the scene [m], negative where it is to have hauled in.
    pub fn set_length_change(&mut self, line: usize, change: f64) {
        self.snapshot.inputs.length_changes[line] = change;
    }

    /// Length that the winch of a line is to have paid out, as set [m].
    pub fn length_change(&self, line: usize) -> f64 {
        self.snapshot.inputs.length_changes[line]
    }

    /// Parts the lines from their points that are to let go, and books what their ends bring along; returns who was parted before.
    fn let_go(&mut self) -> Option<(State, Ledger)> {
        let model = &*self.model;
        let lines = model.lines.iter().zip(&self.snapshot.inputs.releases);
        let states = self.snapshot.state.lines.iter();
        let released = |((line, release), shape): ((&Line, &bool), &LineState)| {
            let partings = line.parting.filter(|_| *release);
            let lets_go = |side: usize| partings.is_some_and(|p| p[side].on_release);
            (0..2).any(|side| lets_go(side) && !shape.parted[side])
        };
        if !lines.clone().zip(states).any(released) {
            return None;
        }
        let before = (self.snapshot.state.clone(), self.snapshot.ledger);
        for ((line, release), shape) in lines.zip(&mut self.snapshot.state.lines) {
            if let Some(partings) = line.parting.filter(|_| *release) {
                for (parted, parting) in shape.parted.iter_mut().zip(partings) {
                    *parted |= parting.on_release;
                }
            }
        }
        for network in &model.networks {
            let states = [&before.0, &self.snapshot.state];
            self.snapshot.ledger.flow.given += ledger::joined_energy(model, network, states);
        }
        Some(before)
    }

    /// Which integrator serves each network, and its step limits.
    pub fn choices(&self) -> impl Iterator<Item = &Choice> {
        self.work.choices()
    }

    /// Steps from the present time to `step` [s] later. A step of 0 s does nothing.
    ///
    /// # Errors
    /// The state stays as it was.
    pub fn advance(&mut self, step: f64) -> Result<(), StepError> {
        if step <= 0.0 {
            return Ok(());
        }
        self.paths.clone_from(&self.snapshot.paths);
        if !self.snapshot.follows_scene {
            self.extend_paths(step);
        }
        self.extend_reels(step)?;
        let before = self.let_go();
        let model = &*self.model;
        let at = Held::new(model, &self.paths, self.snapshot.follows_scene);
        let held = |point: usize, t: f64| at.point(point, t);
        let advanced = self
            .work
            .advance(model, &mut self.snapshot.state, step, &held);
        if let (Err(_), Some((state, ledger))) = (&advanced, before) {
            (self.snapshot.state, self.snapshot.ledger) = (state, ledger);
        }
        let done = advanced?;
        self.snapshot.counters = done.counters;
        self.snapshot.ledger.flow.add(done.flow);
        self.snapshot.paths.clone_from(&self.paths);
        winches::follow(&mut self.model, &self.snapshot.state);
        Ok(())
    }

    /// Continues the paths of the winches by a communication step [s].
    fn extend_reels(&mut self, step: f64) -> Result<(), StepError> {
        let snapshot = &self.snapshot;
        let (time, changes) = (snapshot.state.time, &snapshot.inputs.length_changes);
        for (index, reel) in self.paths.reels.iter_mut().enumerate() {
            let line = &self.model.lines[index];
            let Some(winch) = &line.winch else { continue };
            match (snapshot.follows_scene, &winch.path) {
                (true, Some(path)) => reel.follow(path, time, step),
                _ => {
                    winches::check(line, changes[index]).map_err(|reason| StepError {
                        time,
                        line: line.name.clone(),
                        node: line.segment_count(),
                        reason,
                        advice: "keep its length_change within the bounds",
                    })?;
                    let reconstruction = self.model.solver.input_reconstruction;
                    reel.extend(
                        winch.speed_max,
                        [time, changes[index]],
                        step,
                        reconstruction,
                    );
                }
            }
        }
        self.work
            .set_reels(self.paths.reels.iter().map(|reel| reel.path));
        Ok(())
    }

    /// Continues the paths of the coupled points and the vessels by a communication step [s].
    fn extend_paths(&mut self, step: f64) {
        let (time, reconstruction) = (self.time(), self.model.solver.input_reconstruction);
        let extend = |path: &mut AxisPath, position: f64, velocity: Option<f64>| {
            let sample = Sample {
                time,
                position,
                velocity,
            };
            path.extend(sample, step, reconstruction);
        };
        let points = self.model.points.iter().zip(&self.snapshot.inputs.points);
        for (path, (point, input)) in self.paths.points.iter_mut().zip(points) {
            if !matches!(point.role, Role::Coupled { .. }) {
                continue;
            }
            for (axis, path) in path.0.iter_mut().enumerate() {
                let position = point.reference[axis] + input.displacement[axis];
                extend(path, position, input.velocity[axis]);
            }
        }
        let vessels = self.model.vessels.iter().zip(&self.snapshot.inputs.vessels);
        for (path, (vessel, input)) in self.paths.vessels.iter_mut().zip(vessels) {
            let rates = input.rates(vessel.attitude);
            for (axis, path) in path.0.iter_mut().enumerate() {
                extend(path, input.pose[axis], rates[axis]);
            }
        }
    }

    /// Force [N] and moment [N m] of the mooring on a vessel, about its origin, in global axes.
    pub fn vessel_force(&self, vessel: usize) -> [f64; 6] {
        let model = &*self.model;
        let origin = self.vessel_origin(vessel);
        let mut sum = Vector6::zeros();
        for (index, point) in model.points.iter().enumerate() {
            if !matches!(point.role, Role::Carried { vessel: carrier, .. } if carrier == vessel) {
                continue;
            }
            let force = Vector3::from(self.end_force(index));
            let arm = self.snapshot.state.points[index].position - origin;
            let moment = arm.cross(&force) + self.end_moment(index);
            sum += Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z);
        }
        sum.into()
    }

    /// Stiffness of the mooring on a vessel as it is now: minus the change of the static part of [`Simulation::vessel_force`], in [N/m]
    /// and [N], and moment, in [N] and [N m], with displacement along and small rotation about the global axes through the vessel's
    /// origin; rows of force. `None` where the lines are not stable as they are, or one of them is a beam. See
    /// [`statics::stiffness`].
    pub fn vessel_stiffness(&self, vessel: usize) -> Option<[[f64; 6]; 6]> {
        let (model, state) = (&*self.model, &self.snapshot.state);
        let mut work = assembly::Workspace::new(model);
        let origin = self.vessel_origin(vessel);
        let stiffness = statics::stiffness::of_vessel(model, state, vessel, origin, &mut work)?;
        Some(stiffness.transpose().into()) // an array of columns
    }

    /// Force [N, N m] and stiffness [N/m, N, N m] of the mooring on a vessel were it at rest as it is now, every network that has one on
    /// its closed-form catenaries and the others on their elements. The closed form has bed friction and no error of a mesh; of a network
    /// on its elements this is the present force and stiffness.
    pub fn vessel_at_rest(&self, vessel: usize) -> ([f64; 6], Option<[[f64; 6]; 6]>) {
        let mut hung = self.clone();
        hung.snapshot.state.waves = None;
        let (model, time) = (&*self.model, self.time());
        let mut work = assembly::Workspace::new(model);
        for number in 0..model.networks.len() {
            let state = &mut hung.snapshot.state;
            catenary_network::solve_network(model, number, state, time, &mut work);
        }
        (hung.vessel_force(vessel), hung.vessel_stiffness(vessel))
    }

    /// Where the origin of a vessel is now [m].
    fn vessel_origin(&self, vessel: usize) -> Vector3<f64> {
        let snapshot = &self.snapshot;
        let at = Held::new(&self.model, &snapshot.paths, snapshot.follows_scene);
        at.frame(vessel, self.time()).origin.position
    }

    /// Moment [N m] of the lines that are clamped to a point on what holds it, in global axes.
    pub fn end_moment(&self, point: usize) -> Vector3<f64> {
        let (model, state) = (&*self.model, &self.snapshot.state);
        let at = &state.points[point];
        let moment = |&(line, end): &(usize, End)| {
            let (data, shape) = (&model.lines[line], &state.lines[line]);
            match BeamView::of(data, shape) {
                Some(view) => {
                    let clamped = view.beam.clamped[usize::from(end == End::B)].is_some();
                    clamped.then(|| view.end_action(end, at).1)
                }
                None => Some(assembly::end_moment(data, &shape.position, end, at)),
            }
        };
        let attached = &model.points[point].attached;
        attached.iter().filter_map(moment).sum()
    }

    /// Force of the mooring on a point [N]: what a vessel feels there.
    pub fn end_force(&self, point: usize) -> [f64; 3] {
        let attached = &self.model.points[point].attached;
        attached
            .iter()
            .map(|&(line, end)| self.line_end_force(line, end))
            .sum::<Vector3<f64>>()
            .into()
    }

    /// Force of one line on the point at its end [N].
    pub fn line_end_force(&self, line: usize, end: End) -> Vector3<f64> {
        let (model, state) = (&self.model, &self.snapshot.state);
        let point = match end {
            End::A => model.lines[line].ends[0],
            End::B => model.lines[line].ends[1],
        };
        let negative = model.solver.negative_tension;
        reaction::end_force(
            &model.lines[line],
            &state.lines[line],
            end,
            &state.points[point],
            model.water_along(state, line, state.time),
            negative,
        )
    }

    /// Axial tension at end A [N].
    pub fn tension_a(&self, line: usize) -> f64 {
        self.line_end_force(line, End::A).norm()
    }

    /// Axial tension at end B [N].
    pub fn tension_b(&self, line: usize) -> f64 {
        self.line_end_force(line, End::B).norm()
    }

    /// Greatest tension along a line [N].
    pub fn tension_max(&self, line: usize) -> f64 {
        if let Some(closed_form) = self.closed_form(line) {
            return closed_form.tension.iter().copied().fold(0.0, f64::max);
        }
        let (model, state) = (&self.model.lines[line], &self.snapshot.state.lines[line]);
        (0..model.segment_count())
            .map(|i| reaction::tension(model, state, i, self.model.solver.negative_tension))
            .fold(self.tension_a(line).max(self.tension_b(line)), f64::max)
    }

    /// Unstretched length that the seabed carries [m].
    pub fn laid_length(&self, line: usize) -> f64 {
        self.closed_form(line).map_or_else(
            || laid_length(&self.model.lines[line], &self.snapshot.state.lines[line]),
            |closed_form| closed_form.laid_length,
        )
    }

    /// Greatest vertical distance below the chord between the ends [m].
    pub fn sag(&self, line: usize) -> f64 {
        let nodes = &self.snapshot.state.lines[line].position;
        self.closed_form(line)
            .map_or_else(|| sag(nodes), |closed_form| closed_form.sag)
    }

    /// Stretched length [m].
    pub fn stretched_length(&self, line: usize) -> f64 {
        let nodes = &self.snapshot.state.lines[line].position;
        let chords = nodes.windows(2).map(|pair| (pair[1] - pair[0]).norm());
        self.closed_form(line)
            .map_or_else(|| chords.sum(), |closed_form| closed_form.stretched_length)
    }

    /// What the closed-form catenary of a quasi-static line says of it now.
    fn closed_form(&self, line: usize) -> Option<&ClosedForm> {
        self.snapshot.state.lines[line].closed_form.as_ref()
    }

    /// Elastic catenary of the reference configuration, where the line's ends are held and its strain is small or
    /// engineering strain.
    pub fn catenary(&self, line: usize) -> Option<&Catenary> {
        self.catenaries[line].as_ref()
    }

    /// Effective tension at every node [N].
    pub fn tensions(&self, line: usize) -> Vec<f64> {
        if let Some(closed_form) = self.closed_form(line) {
            return closed_form.tension.clone();
        }
        let (model, state) = (&self.model.lines[line], &self.snapshot.state.lines[line]);
        let segment =
            |i: usize| reaction::tension(model, state, i, self.model.solver.negative_tension);
        let n = model.segment_count();
        (0..=n)
            .map(|i| match i {
                0 => self.tension_a(line),
                i if i == n => self.tension_b(line),
                i => 0.5 * (segment(i - 1) + segment(i)),
            })
            .collect()
    }

    /// Curvature [1/m] and bending moment [N m] at every node, where the line has bending stiffness; zero at hinges and pinned ends.
    pub fn bending(&self, line: usize) -> Option<Vec<NodeBending>> {
        let (data, state) = (&self.model.lines[line], &self.snapshot.state);
        if let Some(view) = BeamView::of(data, &state.lines[line]) {
            let at = |node| NodeBending {
                curvature: view.curvature(node),
                moment: view.bending_moment(node),
            };
            return Some((0..=data.segment_count()).map(at).collect());
        }
        let bending = data.bending.as_ref()?;
        let clamps = data.clamps(&state.points);
        let nodes = &state.lines[line].position;
        let at = |i: usize| {
            let turn = (bending.joint[i] > 0.0).then(|| joint(clamps, nodes, i));
            let bend = turn.flatten().map(|turn| turn.bend());
            bend.map_or(NodeBending::default(), |bend| NodeBending {
                curvature: bend / bending.length[i],
                moment: bending.joint[i] * (bend - bending.rest[i]).abs(),
            })
        };
        Some((0..nodes.len()).map(at).collect())
    }

    /// Nodes of a line with their tensions, from end A to end B; those that a winch has not paid out are at the winch.
    pub fn profile(&self, line: usize) -> Vec<ProfileNode> {
        let bending = self.bending(line);
        let arcs = &self.model.lines[line].nodes.arc;
        let nodes = arcs.iter().zip(&self.snapshot.state.lines[line].position);
        let mut profile: Vec<ProfileNode> = nodes
            .zip(self.tensions(line))
            .enumerate()
            .map(|(node, ((s, r), tension))| ProfileNode {
                s: *s,
                x: r.x,
                y: r.y,
                z: r.z,
                tension,
                bending: bending.as_ref().map(|nodes| nodes[node]),
            })
            .collect();
        if let Some(&end) = profile.last() {
            profile.resize(self.model.lines[line].nodes_max(), end);
        }
        profile
    }

    /// Momenta of all beams.
    pub fn momentum(&self) -> Momentum {
        let lines = self.model.lines.iter().zip(&self.snapshot.state.lines);
        lines
            .filter_map(|(line, shape)| BeamView::of(line, shape))
            .fold(Momentum::default(), |sum, view| {
                let own = view.momentum();
                Momentum {
                    linear: sum.linear + own.linear,
                    angular: sum.angular + own.angular,
                }
            })
    }

    /// Internal steps of the last communication step.
    pub fn substeps(&self) -> usize {
        self.snapshot.counters.substeps
    }

    /// Work of the last communication step.
    pub fn counters(&self) -> Counters {
        self.snapshot.counters
    }

    /// Energy held, by kind.
    pub fn energy(&self) -> Energy {
        self.work.energy(&self.model, &self.snapshot.state)
    }

    /// Imbalance of the energy ledger since the start [J].
    pub fn energy_error(&self) -> f64 {
        self.snapshot.ledger.error(self.energy().total())
    }

    /// The energy ledger.
    pub fn ledger(&self) -> &Ledger {
        &self.snapshot.ledger
    }

    /// Imbalance of the energy ledger since the start, over the time since then [W].
    pub fn power_residual(&self) -> f64 {
        let elapsed = self.time() - self.snapshot.start_time;
        if elapsed > 0.0 {
            self.energy_error() / elapsed
        } else {
            0.0
        }
    }
}

/// Where everything that forces do not move is in time.
struct Held<'a> {
    model: &'a Model,
    paths: &'a Paths,
    follows_scene: bool,
    /// Vessels at times that were asked for: one line after the other asks for the same.
    found: [Cell<Option<(usize, f64, Frame)>>; FOUND],
}

/// Times that are kept; a power of two.
const FOUND: usize = 64;

impl<'a> Held<'a> {
    fn new(model: &'a Model, paths: &'a Paths, follows_scene: bool) -> Held<'a> {
        Held {
            model,
            paths,
            follows_scene,
            found: [const { Cell::new(None) }; FOUND],
        }
    }

    /// A point at time `t` [s].
    fn point(&self, point: usize, t: f64) -> Kinematics {
        let reference = self.model.points[point].reference;
        let moved = |k: Kinematics| Kinematics {
            position: reference + k.position,
            ..k
        };
        match &self.model.points[point].role {
            Role::Prescribed(motion) => moved(motion.at(t)),
            Role::Coupled {
                motion: Some(motion),
            } if self.follows_scene => moved(motion.at(t)),
            Role::Coupled { .. } => self.paths.points[point].at(t),
            Role::Carried { vessel, arm } => {
                self.model.vessels[*vessel].carry(&self.frame(*vessel, t), *arm)
            }
            Role::Fixed | Role::Free(_) => moved(Kinematics::default()),
        }
    }

    /// A vessel at time `t` [s].
    fn frame(&self, vessel: usize, t: f64) -> Frame {
        // the upper bits of a product with an odd number tell neighbouring times apart
        let mixed = (t.to_bits() ^ vessel as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let place = &self.found[(mixed >> 32) as usize % FOUND];
        match place.get() {
            Some((known, time, frame)) if known == vessel && time == t => frame,
            _ => {
                let frame = self.frame_anew(vessel, t);
                place.set(Some((vessel, t, frame)));
                frame
            }
        }
    }

    fn frame_anew(&self, vessel: usize, t: f64) -> Frame {
        let body = &self.model.vessels[vessel];
        let pose = match &body.motion {
            Some(motion) if self.follows_scene => motion.pose(t),
            _ => self.paths.vessels[vessel].at(t),
        };
        body.frame(&pose)
    }
}

/// A simulation at rest at a time [s], with its scratch.
fn begin(
    model: &Model,
    time: f64,
    inputs: Inputs,
    follows_scene: bool,
) -> Result<(Snapshot, Workspace), Error> {
    let placed = model.points.iter().zip(&inputs.points);
    let points = placed.map(|(point, input)| {
        HostPath::at_rest(time, point.reference + Vector3::from(input.displacement))
    });
    let vessels = inputs.vessels.iter();
    let paths = Paths {
        points: points.collect(),
        vessels: vessels
            .map(|input| VesselPath::at_rest(time, input.pose))
            .collect(),
        reels: winches::paths(model, &inputs.length_changes, time, follows_scene),
    };
    let at = Held::new(model, &paths, follows_scene);
    let held = |point: usize, t: f64| at.point(point, t);
    let places: Vec<PointState> = (0..model.points.len())
        .map(|point| PointState::held(&held(point, time)))
        .collect();
    let mut state = at_rest(model, time, &places)?;
    for ((line, shape), reel) in model.lines.iter().zip(&mut state.lines).zip(&paths.reels) {
        let change = reel.path.at(time).value;
        shape.reel = line.winch.as_ref().map(|_| Reel::at_rest(change));
    }
    if model.solver.integrator != Integrator::QuasiStatic {
        for (line, shape) in model.lines.iter().zip(&mut state.lines) {
            shape.become_viscoelastic(line);
        }
    }
    rest_beams(model, &mut state, time, |point| {
        beam::attitude(&held(point, time))
    })?;
    let mut work = Workspace::new(model, &state, |line| static_tension(model, &state, line));
    work.start(model, &mut state, &held);
    let counters = Counters::default();
    let ledger = Ledger::new(work.energy(model, &state).total());
    Ok((
        Snapshot {
            state,
            inputs,
            paths,
            follows_scene,
            counters,
            ledger,
            start_time: time,
        },
        work,
    ))
}

/// In static equilibrium, or on the shapes the scene gives. Quasi-static lines start on their catenaries; those that will move
/// start where their elements are at rest.
fn at_rest(model: &Model, time: f64, places: &[PointState]) -> Result<State, StaticsError> {
    let given = |line: &Line| {
        let [a, b] = line.ends.map(|point| places[point].position);
        line.given_shape(a, b)
    };
    if let Some(shapes) = model.lines.iter().map(given).collect::<Option<Vec<_>>>() {
        return Ok(State {
            time,
            points: places.to_vec(),
            lines: shapes.into_iter().map(LineState::at_rest).collect(),
            waves: None,
        });
    }
    let mut work = assembly::Workspace::new(model);
    let mut state = match model.solver.integrator {
        Integrator::QuasiStatic => catenary_network::solve_posed(model, places, time, &mut work)?,
        _ => equilibrium::solve_posed(model, places, time, &mut work)?,
    };
    for (line, shape) in model.lines.iter().zip(&mut state.lines) {
        if let Some(nodes) = given(line) {
            *shape = LineState::at_rest(nodes);
        }
    }
    Ok(state)
}

/// Gives beams their frames at time `t` [s], and rest where no shape is given; `attitude` tells how a point has turned.
fn rest_beams(
    model: &Model,
    state: &mut State,
    t: f64,
    attitude: impl Fn(usize) -> Matrix3<f64>,
) -> Result<(), StaticsError> {
    for (index, line) in model.lines.iter().enumerate() {
        if line.beam.is_some() {
            state.lines[index].become_beam(line, line.ends.map(&attitude));
            if line.initial == InitialShape::Static {
                statics::beam::rest(model, index, state, t)?;
            }
        }
    }
    Ok(())
}

fn static_tension(model: &Model, state: &State, line: usize) -> f64 {
    let (data, shape) = (&model.lines[line], &state.lines[line]);
    (0..data.segment_count())
        .map(|i| reaction::tension(data, shape, i, false))
        .fold(0.0, f64::max)
}

/// The closed-form catenary between two places, where it applies: engineering strain, and a level bed if any is in reach.
fn solve_catenary(
    model: &Model,
    line: &Line,
    a: Vector3<f64>,
    b: Vector3<f64>,
) -> Option<Catenary> {
    if line
        .sections
        .iter()
        .any(|section| section.law != StretchLaw::Engineering)
    {
        return None;
    }
    if line.nodes.contact.is_some() && !model.bed_is_level() {
        return None;
    }
    let sections: Vec<catenary::Section> = line
        .sections
        .iter()
        .map(|section| catenary::Section {
            length: section.length,
            weight: section.weight,
            axial_stiffness: section.axial_stiffness,
        })
        .collect();
    let bed = line.nodes.contact.as_ref().map(|contact| Bed {
        height: contact.bed - a.z,
        friction: model.bed_friction,
    });
    let span = (b.x - a.x).hypot(b.y - a.y);
    catenary::solve(&sections, span, b.z - a.z, bed).ok()
}

/// The closed-form catenary of a line in its reference configuration; none where an end is free, or where it would come out of the
/// water, of which the closed form knows nothing.
pub(crate) fn reference_catenary(model: &Model, line: &Line) -> Option<Catenary> {
    let ends = line.ends.map(|point| &model.points[point]);
    if ends.iter().any(|point| point.free().is_some()) {
        return None;
    }
    let [a, b] = ends.map(|point| point.reference);
    let solved = solve_catenary(model, line, a, b)?;
    let height = |&s: &f64| Vector3::new(0.0, 0.0, a.z + solved.at(s).z);
    let shape = || line.nodes.arc.iter().map(height).collect::<Vec<_>>();
    let surface = line.surface.as_ref();
    (!surface.is_some_and(|surface| surface.is_pierced(&shape()))).then_some(solved)
}

/// Length whose weight the contact springs carry [m].
fn laid_length(line: &Line, state: &LineState) -> f64 {
    let Some(contact) = &line.nodes.contact else {
        return 0.0;
    };
    let carried = |i: usize| {
        let penetration = match &contact.bottom {
            None => contact.level[i] - state.position[i].z,
            Some(bottom) => bottom.touch(state.position[i], contact.lift(i)).penetration,
        };
        let weight = line.nodes.weight[i];
        if weight <= 0.0 {
            0.0
        } else {
            (contact.stiffness[i] * penetration / weight).clamp(0.0, 1.0)
        }
    };
    let n = line.segment_count();
    let share = |i: usize| match i {
        0 => carried(1),
        i if i == n => carried(n - 1),
        i => carried(i),
    };
    if n < 2 {
        return 0.0;
    }
    (0..=n).map(|i| share(i) * line.nodes.length[i]).sum()
}

/// Greatest vertical distance of the nodes below the chord of the ends, or below the lower end where that is vertical [m].
fn sag(nodes: &[Vector3<f64>]) -> f64 {
    let (a, b) = (nodes[0], nodes[nodes.len() - 1]);
    let across = Vector3::new(b.x - a.x, b.y - a.y, 0.0);
    let span2 = across.norm_squared();
    let below = |r: &Vector3<f64>| {
        let share = if span2 > 0.0 {
            (r - a).dot(&across) / span2
        } else {
            0.0
        };
        let chord = if (0.0..=1.0).contains(&share) && span2 > 0.0 {
            a.z + share * (b.z - a.z)
        } else {
            a.z.min(b.z)
        };
        chord - r.z
    };
    nodes.iter().map(below).fold(0.0, f64::max)
}
