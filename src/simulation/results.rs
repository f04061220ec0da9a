//! Results of a simulation: forces, tensions, shapes and energies.

use std::cell::OnceCell;

use nalgebra::{UnitQuaternion, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use super::coupling::{InterfaceValues, distance};
use super::prescribed::MotionSource;
use super::{Simulation, Snapshot, start};
use crate::dynamics::advance::Counters;
use crate::dynamics::beam::{BeamView, Momentum};
use crate::dynamics::energy_balance::{Energy, EnergyBalance};
use crate::dynamics::reaction::{self, LineEnd};
use crate::elements;
use crate::math::attitude::Order;
use crate::model::{Body, ClosedForm, End, Line, LineState, Model, PointState, WaterAlong, joint};
use crate::scene::{ForceOutput, Integrator};
use crate::statics::catenary::Catenary;
use crate::statics::{self, catenary_network};

/// Displacement of a vessel in the difference quotients of its stiffness in a current, relative to the longest line [-].
const ASIDE: f64 = 1e-6;

/// A node of a line's profile.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ProfileNode {
    /// Unstretched arc length from end A [m].
    pub s: f64,
    /// Position along x [m].
    pub x: f64,
    /// Position along y [m].
    pub y: f64,
    /// Height above still water [m].
    pub z: f64,
    /// Effective tension [N].
    pub tension: f64,
    /// Curvature and moment, if the line has bending stiffness.
    #[serde(flatten)]
    pub bending: Option<NodeBending>,
}

/// Curvature and moment of a line at a node.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct NodeBending {
    /// Curvature [1/m].
    pub curvature: f64,
    /// Bending moment [N m].
    pub moment: f64,
}

/// Quantities of the present state that several outputs share, each evaluated when it is first read.
#[derive(Debug, Clone)]
pub(super) struct Reactions {
    /// Stored energy.
    energy: OnceCell<Energy>,
    /// Force [N] and moment [N m] that a host reads on every body.
    pub(super) bodies: Vec<OnceCell<[f64; 6]>>,
    lines: Vec<LineReactions>,
    /// Mass, impedance and stiffness of the bodies.
    pub(super) interface: OnceCell<InterfaceValues>,
}

/// Quantities of a line that several outputs share.
#[derive(Debug, Clone, Default)]
struct LineReactions {
    /// Force on the points at ends A and B [N].
    ends: [OnceCell<Vector3<f64>>; 2],
    /// Effective tension at every node [N].
    tensions: OnceCell<Vec<f64>>,
    bending: OnceCell<Option<Vec<NodeBending>>>,
}

impl Reactions {
    /// Allocates for a model; nothing is evaluated.
    pub(super) fn new(model: &Model) -> Reactions {
        Reactions {
            energy: OnceCell::new(),
            bodies: vec![OnceCell::new(); model.bodies().count()],
            lines: vec![LineReactions::default(); model.lines.len()],
            interface: OnceCell::new(),
        }
    }

    /// Drops all values, for another state.
    pub(super) fn clear(&mut self) {
        self.energy.take();
        for force in &mut self.bodies {
            force.take();
        }
        for line in &mut self.lines {
            line.ends = Default::default();
            line.tensions.take();
            line.bending.take();
        }
        self.forget_interface();
    }

    /// Drops the values that depend on releases and water flow of the coming step.
    pub(super) fn forget_interface(&mut self) {
        self.interface.take();
    }
}

impl Simulation {
    /// Force [N] and moment [N m] of the mooring on a body, with or without the inertia of the line ends as the scene requests. The moment on a point
    /// is zero.
    pub fn host_force(&self, body: Body) -> &[f64; 6] {
        let force = &self.reactions.bodies[self.snapshot.inputs.place(body)];
        force.get_or_init(|| match self.model.force {
            ForceOutput::Total => self.total_force(body),
            ForceOutput::WithoutInertia => self.force_without_inertia(body).into(),
        })
    }

    pub(super) fn total_force(&self, body: Body) -> [f64; 6] {
        match body {
            Body::Point(point) => {
                let [x, y, z] = self.end_force(point);
                [x, y, z, 0.0, 0.0, 0.0]
            }
            Body::Vessel(vessel) => self.vessel_force(vessel),
        }
    }

    /// Force [N] and moment [N m] of the mooring on a vessel, about its origin, in global axes.
    pub fn vessel_force(&self, vessel: usize) -> [f64; 6] {
        self.sum_of_forces(vessel, |point| self.end_force(point))
    }

    /// [`Simulation::nodal_force`] of all points on a vessel [N], and its moment [N m] about the vessel's origin, in global axes.
    pub fn vessel_nodal_force(&self, vessel: usize) -> [f64; 6] {
        self.sum_of_forces(vessel, |point| self.nodal_force(point))
    }

    fn sum_of_forces(&self, vessel: usize, of_point: impl Fn(usize) -> [f64; 3]) -> [f64; 6] {
        let model = &*self.model;
        let origin = self.vessel_origin(vessel);
        let mut sum = Vector6::zeros();
        for &index in &model.vessels[vessel].points {
            let force = Vector3::from(of_point(index));
            let arm = self.snapshot.state.points[index].position - origin;
            let moment = arm.cross(&force) + self.end_moment(index);
            sum += Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z);
        }
        sum.into()
    }

    /// Stiffness of the mooring on a vessel in its present state: minus the change of the static part of [`Simulation::vessel_force`] with
    /// displacement along and small rotation about the global axes through the vessel's origin. Rows are force [N/m, N] and moment [N, N m]. `None`
    /// if the lines are not stable in this state or one of them is a beam. See [`statics::stiffness`]. If a current drags lines, its force changes as
    /// they move: the stiffness is then that of equilibria on both sides of the pose that is set.
    pub fn vessel_stiffness(&self, vessel: usize) -> Option<[[f64; 6]; 6]> {
        self.stiffness_with(vessel, &mut self.bare_scratch())
    }

    /// Returns [`Simulation::vessel_stiffness`] of every vessel.
    pub fn vessel_stiffnesses(&self) -> Vec<Option<[[f64; 6]; 6]>> {
        let mut work = self.bare_scratch();
        let vessels = 0..self.model.vessels.len();
        vessels
            .map(|vessel| self.stiffness_with(vessel, &mut work))
            .collect()
    }

    /// Workspace without storage for the nodes of lines.
    fn bare_scratch(&self) -> elements::Workspace {
        elements::Workspace::serving(&self.model, |_| false)
    }

    fn stiffness_with(&self, vessel: usize, work: &mut elements::Workspace) -> Option<[[f64; 6]; 6]> {
        let (model, state) = (&*self.model, &self.snapshot.state);
        let origin = self.vessel_origin(vessel);
        let stiffness = statics::stiffness::of_vessel(model, state, vessel, origin, work)?;
        match self.drifts(vessel) {
            true => self.stiffness_in_current(vessel),
            false => Some(stiffness.transpose().into()), // an array of columns
        }
    }

    /// Returns whether a current acts on anything connected to a vessel.
    fn drifts(&self, vessel: usize) -> bool {
        let model = &*self.model;
        let carrier = &model.vessels[vessel];
        let has_drag = |&number: &usize| {
            let network = &model.networks[number];
            let points = network.free_points.iter();
            let mut free = points.filter_map(|&point| model.points[point].free());
            let mut lines = network.lines.iter();
            lines.any(|&line| model.lines[line].drifts(model))
                || model.current.is_some() && free.any(|free| free.sphere.is_some())
        };
        let is_wet = |&point: &usize| {
            let own = model.points[point].own.as_ref();
            own.is_some_and(|own| own.sphere.is_some())
        };
        carrier.networks.iter().any(has_drag) || model.current.is_some() && carrier.points.iter().any(is_wet)
    }

    fn stiffness_in_current(&self, vessel: usize) -> Option<[[f64; 6]; 6]> {
        let mut stiffness = [[0.0; 6]; 6];
        for axis in 0..6 {
            let way = distance(self, Body::Vessel(vessel), axis, ASIDE);
            let aside = |way: f64| Some(self.at_rest_aside(vessel, axis, way)?.vessel_force(vessel));
            let [below, above] = [aside(-way)?, aside(way)?];
            for (row, force) in stiffness.iter_mut().enumerate() {
                force[axis] = (below[row] - above[row]) / (2.0 * way);
            }
        }
        Some(stiffness)
    }

    /// Returns the mooring in equilibrium after a vessel is moved along, or turned about, a global axis from the pose that is set [m, rad].
    fn at_rest_aside(&self, vessel: usize, axis: usize, way: f64) -> Option<Simulation> {
        let (mut aside, Snapshot { state, paths, .. }) = (self.clone(), &self.snapshot);
        let inputs = &mut aside.snapshot.inputs;
        let at = MotionSource::new(&self.model, paths, self.snapshot.follows_scene);
        at.give(state.time, inputs);
        for (change, winch) in inputs.length_changes.iter_mut().zip(&paths.winch_paths) {
            *change = winch.path.at(state.time).value;
        }
        let mut pose = inputs.body(Body::Vessel(vessel)).displacement;
        if axis < 3 {
            pose[axis] += way;
        } else {
            let mut turn = Vector3::zeros();
            turn[axis - 3] = way;
            let attitude = self.model.vessels[vessel].attitude;
            let angles = Vector3::from_row_slice(&pose[3..]) + attitude;
            let turned = UnitQuaternion::from_scaled_axis(turn) * Order::Zyx.rotation(angles);
            pose[3..].copy_from_slice((Order::Zyx.angles(&turned, angles) - attitude).as_slice());
        }
        aside.set_pose(vessel, pose);
        aside.begin(state.time, false, start::Shapes::Equilibrium).ok()?;
        for (line, now) in aside.snapshot.state.lines.iter_mut().zip(&state.lines) {
            line.released = now.released;
        }
        Some(aside)
    }

    /// Returns this mooring at rest in its present state, without waves. Networks with closed-form catenaries are on these, the others on their
    /// elements. The closed form has seabed friction and no discretisation error.
    pub fn on_catenaries(mut self) -> Simulation {
        self.snapshot.state.waves = None;
        self.reactions.clear();
        let (model, state) = (&*self.model, &mut self.snapshot.state);
        let mut work = elements::Workspace::serving(model, |_| false);
        for number in 0..model.networks.len() {
            catenary_network::solve_network(model, number, state, state.time, &mut work);
        }
        self
    }

    /// Present position of a vessel's origin [m].
    pub(super) fn vessel_origin(&self, vessel: usize) -> Vector3<f64> {
        let snapshot = &self.snapshot;
        let at = MotionSource::new(&self.model, &snapshot.paths, snapshot.follows_scene);
        at.frame(vessel, snapshot.state.time).origin.position
    }

    /// Moment [N m] that the lines clamped to a point exert on its support, in global axes.
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
                None => Some(elements::end_moment(
                    data,
                    [&shape.position, &shape.velocity],
                    end,
                    at,
                )),
            }
        };
        let attached = &model.points[point].attached;
        attached.iter().filter_map(moment).sum()
    }

    /// Force of the mooring on a point [N]: the load on its support from the lines and, unless forces move the point, from its mass.
    pub fn end_force(&self, point: usize) -> [f64; 3] {
        let lines = self.model.points[point].attached.iter();
        let of_lines: Vector3<f64> = lines.map(|&(line, end)| self.line_end_force(line, end)).sum();
        (of_lines + self.own_force(point, |state| state)).into()
    }

    /// Force on a point as lumped-mass codes report it [N]: the sum over its lines of [`Simulation::line_nodal_force`], and weight, buoyancy, drag and
    /// seabed contact of the point, without inertia. On a point that is held it tends to [`Simulation::end_force`] as the mesh is refined; on a
    /// free one, which has no support, it is the force that accelerates it.
    pub fn nodal_force(&self, point: usize) -> [f64; 3] {
        let lines = self.model.points[point].attached.iter();
        let of_lines: Vector3<f64> = lines.map(|&(line, end)| self.line_nodal_force(line, end)).sum();
        (of_lines + self.point_force(point, |state| state.without_acceleration())).into()
    }

    /// Force of the end node of a line on its point [N]: see [`LineEnd::nodal_force`].
    pub fn line_nodal_force(&self, line: usize, end: End) -> Vector3<f64> {
        let at = self.point_as_it_acts(self.model.lines[line].ends[end as usize]);
        self.at_end(line, end, &at).nodal_force()
    }

    /// Force of a point itself on its support [N], in the state that `seen` returns for the present one. A free point has none.
    pub(super) fn own_force(&self, point: usize, seen: impl Fn(PointState) -> PointState) -> Vector3<f64> {
        match self.model.points[point].free() {
            Some(_) => Vector3::zeros(),
            None => self.point_force(point, seen),
        }
    }

    fn point_force(&self, point: usize, seen: impl Fn(PointState) -> PointState) -> Vector3<f64> {
        let (model, state) = (&*self.model, &self.snapshot.state);
        let data = &model.points[point];
        if data.body().is_none() && data.load.is_none() {
            return Vector3::zeros();
        }
        let time = state.time;
        let water = (model.stream(time), state.waves_at_point(point, time));
        data.own_force(&seen(self.point_as_it_acts(point)), time, water)
    }

    /// Water along a line and moments on its ends [N m].
    pub(super) fn loads_along(&self, line: usize) -> (WaterAlong<'_>, [Vector3<f64>; 2]) {
        let (model, state) = (&*self.model, &self.snapshot.state);
        let water = model.water_along(state, line, state.time);
        (water, model.end_moments(&model.lines[line], state.time))
    }

    /// State of a point for the evaluation of its forces: at rest in quasi-static runs.
    fn point_as_it_acts(&self, point: usize) -> PointState {
        let state = self.snapshot.state.points[point];
        match self.model.solver.integrator {
            Integrator::QuasiStatic => state.stopped(),
            _ => state,
        }
    }

    /// Force of one line on the point at its end [N].
    pub fn line_end_force(&self, line: usize, end: End) -> Vector3<f64> {
        let force = &self.reactions.lines[line].ends[end as usize];
        *force.get_or_init(|| self.evaluate_end_force(line, end))
    }

    fn evaluate_end_force(&self, line: usize, end: End) -> Vector3<f64> {
        let point = self.point_as_it_acts(self.model.lines[line].ends[end as usize]);
        self.at_end(line, end, &point).force()
    }

    /// A line at one of its ends, with its point in a state.
    pub(super) fn at_end<'a>(&'a self, line: usize, end: End, point: &'a PointState) -> LineEnd<'a> {
        let (model, state) = (&*self.model, &self.snapshot.state);
        let (water, moments) = self.loads_along(line);
        LineEnd {
            line: &model.lines[line],
            state: &state.lines[line],
            end,
            point,
            water,
            moments,
            negative_tension: model.solver.negative_tension,
        }
    }

    /// Magnitude of the force at end A [N].
    pub fn tension_a(&self, line: usize) -> f64 {
        self.tension_at(line, End::A)
    }

    /// Magnitude of the force at end B [N].
    pub fn tension_b(&self, line: usize) -> f64 {
        self.tension_at(line, End::B)
    }

    /// Size of the force at an end [N].
    pub fn tension_at(&self, line: usize, end: End) -> f64 {
        self.line_end_force(line, end).norm()
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

    /// Unstretched length supported by the seabed [m].
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

    /// Closed-form catenary of a quasi-static line in the present state.
    fn closed_form(&self, line: usize) -> Option<&ClosedForm> {
        self.snapshot.state.lines[line].closed_form.as_ref()
    }

    /// Elastic catenary of the reference configuration, if the line's ends are prescribed, its strain is engineering strain, any seabed within reach
    /// is level, and it does not rise out of the water.
    pub fn catenary(&self, line: usize) -> Option<&Catenary> {
        self.catenaries[line].as_ref()
    }

    /// Effective tension at every node [N].
    pub fn tensions(&self, line: usize) -> &[f64] {
        let tensions = &self.reactions.lines[line].tensions;
        tensions.get_or_init(|| self.evaluate_tensions(line))
    }

    fn evaluate_tensions(&self, line: usize) -> Vec<f64> {
        if let Some(closed_form) = self.closed_form(line) {
            return closed_form.tension.clone();
        }
        let (model, state) = (&self.model.lines[line], &self.snapshot.state.lines[line]);
        let segment = |i: usize| reaction::tension(model, state, i, self.model.solver.negative_tension);
        let n = model.segment_count();
        (0..=n)
            .map(|i| match i {
                0 => self.tension_a(line),
                i if i == n => self.tension_b(line),
                i => 0.5 * (segment(i - 1) + segment(i)),
            })
            .collect()
    }

    /// Tension at node `i` of a line from its segments [N], including damping within the line: at an end, the tension of the adjacent segment; at an
    /// inner node, half the magnitude of the vector sum of the tensions of the two adjacent segments, as MoorDyn-C writes it. [`Simulation::tension_a`] and
    /// [`Simulation::tension_b`] are the forces on the points at the ends, with weight, drag and inertia of the half segment.
    pub fn segment_tension(&self, line: usize, i: usize) -> f64 {
        let (model, state) = (&self.model.lines[line], &self.snapshot.state.lines[line]);
        let n = model.segment_count();
        let segment = |i: usize| -> Vector3<f64> {
            let chord = state.position[i + 1] - state.position[i];
            let tension = reaction::tension(model, state, i, self.model.solver.negative_tension);
            chord.try_normalize(0.0).unwrap_or_default() * tension
        };
        match i {
            0 => segment(0).norm(),
            i if i >= n => segment(n - 1).norm(),
            i => (0.5 * (segment(i - 1) + segment(i))).norm(),
        }
    }

    /// Curvature [1/m] and bending moment [N m] at every node, if the line has bending stiffness; zero at hinges and at pinned ends without an
    /// applied moment.
    pub fn bending(&self, line: usize) -> Option<&[NodeBending]> {
        let bending = &self.reactions.lines[line].bending;
        bending.get_or_init(|| self.evaluate_bending(line)).as_deref()
    }

    fn evaluate_bending(&self, line: usize) -> Option<Vec<NodeBending>> {
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
                curvature: bending.curvature(i, bend),
                moment: bending.joint[i] * (bend - bending.rest[i]).abs(),
            })
        };
        let mut found: Vec<_> = (0..nodes.len()).map(at).collect();
        let last = nodes.len() - 1;
        let moments = self.model.end_moments(data, state.time);
        for (moment, (node, segment)) in moments.into_iter().zip([(0, 0), (last, last - 1)]) {
            if moment != Vector3::zeros() {
                let chord = nodes[segment + 1] - nodes[segment];
                let along = chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
                let across = (moment - moment.dot(&along) * along).norm();
                found[node] = NodeBending {
                    curvature: across / bending.stiffness[segment],
                    moment: across,
                };
            }
        }
        Some(found)
    }

    /// Nodes of a line with their tensions, from end A to end B; nodes that a winch has not paid out are placed at the winch.
    pub fn profile(&self, line: usize) -> Vec<ProfileNode> {
        let bending = self.bending(line);
        let arcs = &self.model.lines[line].nodes.arc;
        let nodes = arcs.iter().zip(&self.snapshot.state.lines[line].position);
        let mut profile: Vec<ProfileNode> = nodes
            .zip(self.tensions(line))
            .enumerate()
            .map(|(node, ((s, r), &tension))| ProfileNode {
                s: *s,
                x: r.x,
                y: r.y,
                z: r.z,
                tension,
                bending: bending.map(|nodes| nodes[node]),
            })
            .collect();
        if let Some(&end) = profile.last() {
            profile.resize(self.model.lines[line].nodes_max(), end);
        }
        profile
    }

    /// Total momentum of all beams.
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

    /// Number of internal steps in the last communication step.
    pub fn substeps(&self) -> usize {
        self.snapshot.counters.substeps
    }

    /// Counters of the last communication step.
    pub fn counters(&self) -> Counters {
        self.snapshot.counters
    }

    /// Stored energy, by kind.
    pub fn energy(&self) -> Energy {
        let energy = &self.reactions.energy;
        *energy.get_or_init(|| self.work.energy(&self.model, &self.snapshot.state))
    }

    /// Energy balance since the start, if the scene requests it ([`Output::energy_balance`](crate::scene::Output::energy_balance)).
    pub fn energy_balance(&self) -> Option<EnergyBalance> {
        let mut balance = self.snapshot.balance?;
        balance.now = self.energy().total();
        balance.flow.dissipation -= self
            .work
            .kinetic_energy_of_leapfrogs(&self.model, &self.snapshot.state);
        Some(balance)
    }

    /// Error of the energy balance divided by the time since the start [W].
    pub fn power_residual(&self) -> Option<f64> {
        let elapsed = self.time() - self.snapshot.start_time;
        let error = self.energy_balance()?.error();
        Some(if elapsed > 0.0 { error / elapsed } else { 0.0 })
    }
}

/// Length whose weight the contact springs carry [m].
fn laid_length(line: &Line, state: &LineState) -> f64 {
    let Some(contact) = &line.nodes.contact else {
        return 0.0;
    };
    let segments = line.segments.length.iter().enumerate();
    segments
        .map(|(i, length)| length * contact.laid_part(i, &state.position))
        .sum()
}

/// Greatest vertical distance of the nodes below the chord of the ends, or below the lower end where the chord is vertical or does not reach [m].
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
