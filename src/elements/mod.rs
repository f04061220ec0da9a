//! The assembled system of a network of lines: residual, exact tangent, and the solution of one linear system.
//!
//! The unknowns are the positions of the nodes between the ends of every line and of the free points along their free axes. The residual of a node is
//! the force that would have to be added to hold it,
//!
//!   R_i = M_i(t) a_i − f_i,   f_i = T_i q_i − T_{i−1} q_{i−1} − w_i ẑ + drag + contact − (αm)_i v_i,
//!
//! with the segment's direction q, its total tension T = max(0, N(ε) + BA·ε̇) and M_i = M_n I + (M_t − M_n) t tᵀ. End nodes of a line contribute
//! likewise to their points. Free points add their mass, weight, drag, contact and load, and the buoyancy and added mass of their submerged part.
//!
//! The tangent J = c_k ∂R/∂r + c_c ∂R/∂v + c_m ∂R/∂a is exact except that the tangent t of mass and drag is frozen. Per segment,
//! with P = I − q qᵀ and ġ the rate of its end-to-end vector, J = [[A, −A], [−A, A]] with
//!
//!   A = c_k [EA·N'/l₀ q qᵀ + T/l P + BA/(l l₀) q (P ġ)ᵀ] + c_c BA/l₀ q qᵀ.
//!
//! The geometric stiffness T/l P is never negative in a line that carries no compression. A line with bending stiffness has the joints of `bending`
//! at its nodes and carries compression up to the limit of its segments, T ≥ −P; its tangent is exact, or positive semi-definite with `convex`.
//! Statics includes springs, weight and the drag of a current, whose forces are constant during the search. A line that may pierce the water surface
//! loses there the buoyancy given by `surface`.

pub mod beam;
mod contact;
pub mod friction;
mod joint;
mod line;
mod places;
mod point;
mod released;
mod segment;
mod surface;
mod viscoelastic;

use nalgebra::{Matrix3, Vector3};

use crate::math::block_banded::{Ends, Pivots};
use crate::math::sparse_blocks::PointSystem;
use crate::model::{End, Model, Network, PointState, State};
use crate::physics::catenary::Catenary;
use crate::physics::fading_damper::damper_reach;

pub(crate) use joint::{BendingWork, rates};
pub use joint::{end_moment, end_moment_power, joint_damping_power, shear};
pub(crate) use line::{LineWork, node_tangent};
use places::Place;
pub(crate) use places::{copy_network, place_ends};
pub(crate) use point::{PointWork, free_points};
pub(crate) use segment::{stretch_step, stretched};

/// Workspace of the implicit solvers for a whole model; never read before it is written.
#[derive(Debug, Clone)]
pub struct Workspace {
    /// Workspace per line of the model.
    pub(crate) lines: Vec<LineWork>,
    /// Workspace per point of the model.
    pub(crate) points: Vec<PointWork>,
    /// System of the free points per network of the model.
    pub(crate) systems: Vec<PointSystem>,
    /// Per line of the model: its closed form at the last evaluation of a network of catenaries.
    pub(crate) catenaries: Vec<Option<Catenary>>,
    /// Per line of the model: −∂F/∂r of the forces F on ends A and B with respect to their positions r, on the closed form [N/m].
    pub(crate) stiffness: Vec<[[Matrix3<f64>; 2]; 2]>,
    /// State before a step of the caller.
    pub(crate) start: State,
    /// State before a step.
    pub(crate) before: State,
    /// First guess of an equilibrium in a current.
    pub(crate) hung: State,
    /// First guess of an equilibrium.
    pub(crate) saved: State,
    /// Last equilibrium found during a search.
    pub(crate) trial: State,
    /// Counts since they were last cleared.
    pub(crate) counters: Counters,
}

/// Counts of the work of the implicit solvers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Time steps or load steps.
    pub steps: usize,
    /// Factorised linear systems, or closed-form catenaries if a network is solved on those.
    pub solves: usize,
    /// Steps that were halved.
    pub halvings: usize,
}

impl std::ops::AddAssign for Counters {
    fn add_assign(&mut self, other: Counters) {
        self.steps += other.steps;
        self.solves += other.solves;
        self.halvings += other.halvings;
    }
}
impl Workspace {
    /// Workspace for `model`.
    pub fn new(model: &Model) -> Workspace {
        Workspace::serving(model, |_| true)
    }

    /// Workspace for `model`; lines have workspace only in networks whose number `serves` accepts.
    pub(crate) fn serving(model: &Model, serves: impl Fn(usize) -> bool) -> Workspace {
        let mut points = vec![PointWork::default(); model.points.len()];
        for network in &model.networks {
            for (slot, &index) in network.free_points.iter().enumerate() {
                points[index].slot = Some(slot);
            }
        }
        let system = |network: &Network| {
            let ends = model.lines_of(network).map(|line| line.ends);
            let pairs = ends.filter_map(|[a, b]| Some((points[a].slot?, points[b].slot?)));
            PointSystem::new(network.free_points.len(), &pairs.collect::<Vec<_>>())
        };
        let count = model.lines.len();
        let mut work = Workspace {
            systems: model.networks.iter().map(system).collect(),
            lines: vec![LineWork::default(); count],
            points,
            catenaries: vec![None; count],
            stiffness: vec![[[Matrix3::zeros(); 2]; 2]; count],
            start: State::default(),
            before: State::default(),
            hung: State::default(),
            saved: State::default(),
            trial: State::default(),
            counters: Counters::default(),
        };
        let served = (0..model.networks.len()).filter(|&number| serves(number));
        served.for_each(|number| work.serve(model, number));
        work
    }

    /// Allocates the workspace of the lines of a network.
    pub(crate) fn serve(&mut self, model: &Model, number: usize) {
        for &line in &model.networks[number].lines {
            self.lines[line] = LineWork::new(model, &model.lines[line]);
        }
    }

    /// Frees the workspace of the lines of a network; its memory is then available to another one.
    pub(crate) fn release(&mut self, model: &Model, number: usize) {
        for &line in &model.networks[number].lines {
            self.lines[line] = LineWork::default();
        }
    }

    /// Returns the counts since the last call.
    pub fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.counters)
    }
}
/// Problem solved by statics: the full one, or an easier intermediate one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StaticCase {
    /// Time of the loads [s].
    pub time: f64,
    /// Fraction of weight and loads that acts [-].
    pub load: f64,
    /// Upper limit of EA [N].
    pub stiffness_max: f64,
    /// Lower limit of the tension in the geometric stiffness [N].
    pub tension_min: f64,
    /// Pseudo-transient mass over Δτ² on every unknown [N/m].
    pub anchoring: f64,
    /// True if the geometric stiffness comes from the predicted tension instead of the elastic one.
    pub predicted: bool,
    /// True if bending stiffness acts and lines with it carry compression.
    pub bends: bool,
    /// Fraction of the stiffness of sticking, on nodes that have anchors [-].
    pub stick: f64,
    /// Fraction of the friction limit in use [-]: [`friction::AT_REST`], or [`friction::SLIDING`] if nodes at rest at that limit are to slide.
    pub limit: f64,
    /// True if friction uses the normal forces of the last assembly that did not keep them.
    pub keeps_pressure: bool,
    /// Minimum radius with which lines pierce the water surface [m].
    pub breadth: f64,
    /// True if every correction is limited to a moderate rotation of each segment, at the cost of more corrections.
    pub cautious: bool,
    /// True if viscoelastic segments have their stiffness in fast motion, about their tension at rest.
    pub vibrates: bool,
    /// Tension of a segment that is shortened to zero length; zero if slack segments carry no tension [N].
    pub slack: f64,
}

impl StaticCase {
    /// Full problem with the loads of time `t` [s].
    pub(crate) fn whole(t: f64) -> StaticCase {
        StaticCase {
            time: t,
            load: 1.0,
            stiffness_max: f64::INFINITY,
            tension_min: 0.0,
            anchoring: 0.0,
            predicted: false,
            bends: true,
            vibrates: false,
            stick: 1.0,
            limit: friction::AT_REST,
            keeps_pressure: false,
            breadth: 0.0,
            cautious: false,
            slack: 0.0,
        }
    }
}

/// Weights of the parts of residual and tangent in a time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Weights {
    /// Weight of all forces except inertia in R [-].
    pub force: f64,
    /// Weight of the seabed friction in R [-]. It acts in full at the end of a step, because forces that jump excite vibrations if old and new ones
    /// are averaged.
    pub friction: f64,
    /// Weight of inertia in R [-].
    pub inertia: f64,
    /// c_k: weight of ∂R/∂r [-].
    pub position: f64,
    /// c_c: weight of ∂R/∂v [1/s].
    pub velocity: f64,
    /// c_m: weight of ∂R/∂a [1/s²].
    pub acceleration: f64,
    /// Time at which the tension of the segments is evaluated.
    pub stretch: Stretch,
    /// True if the tangent must be positive semi-definite, rather than exact.
    pub convex: bool,
    /// Time over which the loads on points are averaged [s]: the step, so that a short pulse is neither missed nor counted twice.
    pub span: f64,
}

/// Time at which the tension of the segments of a moving line is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stretch {
    /// At the present state.
    Now,
    /// Terms carried over to a step from the state before it.
    Before,
    /// Over the step to the present nodes: their tautness and geometric stiffness follow from the predicted tension.
    OverStep,
}

/// Compressive strain that counts as rounding [-].
const PUSH_STRAIN: f64 = 1e-12;
impl Workspace {
    /// Assembles residual and tangent of a network at rest.
    pub(crate) fn assemble_static(
        &mut self,
        model: &Model,
        network: &Network,
        state: &State,
        case: &StaticCase,
    ) {
        for &index in &network.lines {
            self.lines[index].assemble_static(model, state, index, case);
        }
        let stream = model.stream(case.time);
        for (index, free) in free_points(model, network) {
            let point = &mut self.points[index];
            let (data, state) = (&model.points[index], &state.points[index]);
            point.assemble_static(data, free, state, stream, case);
            match model.seabed.as_deref() {
                Some(seabed) => point.add_static_seabed(free, seabed, state, case),
                None => point.add_seabed_at_rest(free, state.position.z),
            }
        }
        self.gather(model, network);
    }

    /// Assembles the residual and, if TANGENT, the tangent of a moving network at time `t` [s].
    pub(crate) fn assemble_dynamic<const TANGENT: bool>(
        &mut self,
        model: &Model,
        network: &Network,
        state: &State,
        t: f64,
        weights: &Weights,
    ) {
        let stream = model.stream(t);
        for &index in &network.lines {
            self.lines[index].assemble_dynamic::<TANGENT>(model, state, index, t, weights);
        }
        for (index, free) in free_points(model, network) {
            let point = &mut self.points[index];
            let load = model.points[index].load_about(t, weights.span);
            let (seabed, state_of) = (model.seabed.as_deref(), &state.points[index]);
            let water = (stream, state.waves_at_point(index, t));
            point.assemble_dynamic::<TANGENT>(free, seabed, state_of, load, water, weights);
        }
        self.gather(model, network);
    }

    /// Adds the contributions of lines to the residual of the free points.
    pub(crate) fn gather(&mut self, model: &Model, network: &Network) {
        for (index, free) in free_points(model, network) {
            let mut total = self.points[index].residual;
            for &(line, end) in &model.points[index].attached {
                if self.lines[line].released[usize::from(end == End::B)] {
                    continue;
                }
                total += self.lines[line].residual[model.lines[line].end_node(end)];
            }
            for axis in 0..3 {
                if !free.axes[axis] {
                    total[axis] = 0.0;
                }
            }
            self.points[index].total = total;
        }
    }

    /// Solves J x = R for the nodes of all lines, including the ends, and the free points; returns false if J is not positive definite. The
    /// correction of the positions is −x.
    pub(crate) fn solve(&mut self, model: &Model, number: usize) -> bool {
        self.solve_with(model, number, Pivots::Positive)
    }

    /// Solves like [`Self::solve`], with these `pivots`; returns false if one of them is not accepted.
    pub(crate) fn solve_with(&mut self, model: &Model, number: usize, pivots: Pivots) -> bool {
        let network = &model.networks[number];
        self.counters.solves += 1;
        self.systems[number].clear();
        for &index in &network.lines {
            let [a, _] = self.end_slots(model, index);
            let work = &mut self.lines[index];
            let ends = work.eliminate(a.is_some() || work.released[0], pivots);
            let Some(ends) = ends.and_then(|ends| work.eliminate_released(ends)) else {
                return false;
            };
            self.add_condensed(model, number, index, &ends);
        }
        if !self.solve_points(model, number, pivots) {
            return false;
        }
        self.substitute(model, network);
        true
    }

    /// Computes the solution at all nodes from that of the system of the free points.
    fn substitute(&mut self, model: &Model, network: &Network) {
        for &index in &network.lines {
            let [a, b] = model.lines[index].ends.map(|point| self.solution_at(point));
            self.lines[index].substitute_all(a, b);
        }
    }

    /// Solves J x = R for the present residual with the tangent of the last solution; returns false if ends are released.
    pub(crate) fn solve_again(&mut self, model: &Model, number: usize) -> bool {
        let network = &model.networks[number];
        self.systems[number].clear_right();
        for &index in &network.lines {
            let slots = self.end_slots(model, index);
            let work = &mut self.lines[index];
            if work.released != [false; 2] {
                return false;
            }
            for (slot, right) in slots.into_iter().zip(work.eliminate_right()) {
                if let Some(slot) = slot {
                    self.systems[number].add_right(slot, right);
                }
            }
        }
        for (slot, &index) in network.free_points.iter().enumerate() {
            self.systems[number].add_right(slot, self.points[index].residual);
        }
        self.systems[number].solve_again();
        self.take_solution(network, number);
        self.substitute(model, network);
        true
    }

    /// Indices, in the system of the free points, of the end points of a line; `None` for a held or released end.
    fn end_slots(&self, model: &Model, line: usize) -> [Option<usize>; 2] {
        let released = self.lines[line].released;
        let slot = |side: usize| {
            self.points[model.lines[line].ends[side]]
                .slot
                .filter(|_| !released[side])
        };
        [slot(0), slot(1)]
    }

    /// Adds a line that is condensed on its ends to the system of the free points of its network.
    pub(crate) fn add_condensed(&mut self, model: &Model, number: usize, line: usize, ends: &Ends) {
        let ([a, b], system) = (self.end_slots(model, line), &mut self.systems[number]);
        if let Some(a) = a {
            system.add_block(a, a, &ends.aa);
            system.add_right(a, ends.a);
        }
        if let Some(b) = b {
            system.add_block(b, b, &ends.bb);
            system.add_right(b, ends.b);
        }
        if let (Some(a), Some(b)) = (a, b) {
            system.add_block(a, b, &ends.ab);
            system.add_block(b, a, &ends.ba);
        }
    }

    /// Solves for the free points of a network whose lines were all added to their system; returns false if one of the `pivots` is not accepted.
    pub(crate) fn solve_points(&mut self, model: &Model, number: usize, pivots: Pivots) -> bool {
        let (network, system) = (&model.networks[number], &mut self.systems[number]);
        for (slot, (index, free)) in free_points(model, network).enumerate() {
            system.add_block(slot, slot, &self.points[index].diagonal);
            system.add_right(slot, self.points[index].residual);
            for axis in (0..3).filter(|&axis| !free.axes[axis]) {
                system.hold(slot, axis);
            }
        }
        let solved = system.solve(pivots);
        self.take_solution(network, number);
        solved
    }

    /// Copies the solution at the free points from their system.
    pub(crate) fn take_solution(&mut self, network: &Network, number: usize) {
        for (slot, &index) in network.free_points.iter().enumerate() {
            self.points[index].solution = self.systems[number].solution(slot);
        }
    }

    /// Predicts the tensions after a `part` of the correction from the linear system. Returns false if a segment treated as taut is in compression
    /// beyond rounding.
    pub(crate) fn predict_tensions(&mut self, model: &Model, network: &Network, part: f64) -> bool {
        let mut consistent = true;
        for &index in &network.lines {
            let (line, stiffness) = (
                &mut self.lines[index],
                &model.lines[index].segments.axial_stiffness,
            );
            for i in 0..line.tension.len() {
                let x = line.solution();
                let growth = -line.direction[i].along.dot(&(x[i + 1] - x[i])); // of the segment's length [m]
                let predicted = line.elastic[i] + line.slope[i] * growth;
                let least = 0.0 - line.push[i];
                consistent &=
                    line.tension[i] <= least || line.elastic[i] >= least - PUSH_STRAIN * stiffness[i];
                line.tension[i] += part * (predicted - line.tension[i]);
            }
        }
        consistent
    }

    /// Sets the range over which the seabed dampers of a network fade for a step of `dt` [s] from `state`.
    pub(crate) fn fade_dampers(&mut self, model: &Model, network: &Network, state: &State, dt: f64) {
        for &index in &network.lines {
            self.lines[index].fade_dampers(&model.lines[index], &state.lines[index], dt);
            self.lines[index].released = state.lines[index].released;
            self.lines[index].begin(&model.lines[index], &state.lines[index]);
            if let Some(viscoelastic) = &mut self.lines[index].viscoelastic {
                viscoelastic.begin(&model.lines[index], &state.lines[index], dt);
            }
        }
        for (index, free) in free_points(model, network) {
            if let Some(contact) = &free.contact {
                let resting = damper_reach(contact.coefficients.stiffness, free.weight);
                let PointState {
                    position, velocity, ..
                } = state.points[index];
                let rise = match &model.seabed {
                    None => velocity.z,
                    Some(seabed) => seabed.rise(position, velocity),
                };
                let moved = rise.abs() * dt;
                self.points[index].reach = resting.max(moved);
            }
        }
    }

    /// Moves the anchors of nodes that slid along the seabed, after an assembly of the state.
    pub(crate) fn move_anchors(&self, model: &Model, network: &Network, state: &mut State) {
        if model.friction().is_some() {
            friction::move_anchors(model, network, state, self);
        }
    }

    /// Advances the memory of viscoelastic lines to the end of a step, at the present nodes.
    pub(crate) fn relax_segments(&self, model: &Model, network: &Network, state: &mut State) {
        for &index in &network.lines {
            if let Some(viscoelastic) = &self.lines[index].viscoelastic {
                viscoelastic.finish(&model.lines[index], &mut state.lines[index]);
            }
        }
    }

    /// Stores the residual of the last assembly for the next step.
    pub(crate) fn remember(&mut self, network: &Network) {
        for &index in &network.lines {
            let line = &mut self.lines[index];
            line.history.copy_from_slice(&line.residual);
        }
        for &index in &network.free_points {
            self.points[index].history = self.points[index].residual;
        }
    }

    /// Adds the stored terms to the residual.
    pub(crate) fn add_remembered(&mut self, model: &Model, network: &Network) {
        for &index in &network.lines {
            let line = &mut self.lines[index];
            for (residual, history) in line.residual.iter_mut().zip(&line.history) {
                *residual += history;
            }
        }
        for &index in &network.free_points {
            let point = &mut self.points[index];
            point.residual += point.history;
        }
        self.gather(model, network);
    }

    /// Solution at a point; zero if the point is not free.
    pub(crate) fn solution_at(&self, point: usize) -> Vector3<f64> {
        let point = &self.points[point];
        point.slot.map_or(Vector3::zeros(), |_| point.solution)
    }

    /// Largest displacement of a node in the last solution [m]; NaN if any is NaN.
    pub(crate) fn greatest_solution(&self, network: &Network) -> f64 {
        let longer = |a: f64, b: f64| if a.is_nan() || a >= b { a } else { b };
        let lines = network.lines.iter().flat_map(|&line| self.lines[line].solution());
        lines.map(|x| x.norm_squared()).fold(0.0, longer).sqrt()
    }

    /// Largest change of a segment vector by the last solution, relative to the segment length [-].
    pub(crate) fn greatest_strain(&self, network: &Network) -> f64 {
        let of_line = |&line: &usize| {
            let line = &self.lines[line];
            let pairs = line.solution().windows(2).zip(&line.direction);
            pairs.map(|(x, direction)| direction.per_length * (x[1] - x[0]).norm())
        };
        network.lines.iter().flat_map(of_line).fold(0.0, f64::max)
    }

    /// Largest out-of-balance force [N], with its location.
    pub(crate) fn greatest_residual(&self, network: &Network) -> (f64, Place) {
        let mut greatest = (
            0.0,
            Place::Node {
                line: network.lines[0],
                node: 0,
            },
        );
        let mut compare = |residual: &Vector3<f64>, place| {
            let norm = residual.norm();
            if norm > greatest.0 || norm.is_nan() {
                greatest = (norm, place);
            }
        };
        for &line in &network.lines {
            let residual = &self.lines[line].residual;
            for (node, r) in residual.iter().enumerate().take(residual.len() - 1).skip(1) {
                compare(r, Place::Node { line, node });
            }
        }
        for &point in &network.free_points {
            compare(&self.points[point].total, Place::Point(point));
        }
        greatest
    }
}
/// Force [N] that a line at rest applies to the point at one of its ends.
pub fn end_force(model: &Model, state: &State, line: usize, end: End, work: &mut Workspace) -> Vector3<f64> {
    work.lines[line].assemble_static(model, state, line, &StaticCase::whole(state.time));
    -work.lines[line].residual[model.lines[line].end_node(end)]
}

#[cfg(test)]
mod tests;
