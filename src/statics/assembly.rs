//! The assembled system of a network of lines: residual, exact tangent, and the solution of one linear system.
//!
//! Unknowns are the positions of the nodes between the ends of every line and of the free points on their free axes. The
//! residual of a node is the force that would have to be added to hold it,
//!
//!   R_i = M_i(t) a_i − f_i,   f_i = T_i q_i − T_{i−1} q_{i−1} − w_i ẑ + drag + contact − (αm)_i v_i,
//!
//! with the segment's direction q, its total tension T = max(0, N(ε) + BA·ε̇) and M_i = M_n I + (M_t − M_n) t tᵀ. A line's
//! end nodes contribute the same to their points; free points add their own mass, weight, drag, contact and load, their buoyancy and added
//! mass as far as they are in the water.
//!
//! The tangent J = c_k ∂R/∂r + c_c ∂R/∂v + c_m ∂R/∂a is exact except that the tangent t of mass and drag is frozen. Per segment,
//! with P = I − q qᵀ and ġ the rate of its end-to-end vector, J = [[A, −A], [−A, A]] with
//!
//!   A = c_k [EA·N'/l₀ q qᵀ + T/l P + BA/(l l₀) q (P ġ)ᵀ] + c_c BA/l₀ q qᵀ.
//!
//! The geometric stiffness T/l P is never negative in a line that cannot push. A line with bending stiffness has the joints of
//! `bending` at its nodes and pushes up to what its segments carry, T ≥ −P; its tangent is exact, or made such that it cannot be
//! indefinite where `convex` is asked for. Statics keeps springs, weight and the drag of a current, whose forces are held while the
//! shape is sought.

mod bending;
pub mod rubbing;

use nalgebra::{Matrix3, Vector3};

use crate::math::block_tridiagonal::{Chain, DenseSystem};
use crate::model::{
    End, FreePoint, Line, LineState, Model, Network, Point, PointState, State, Surface,
};
use crate::physics::flow::Stream;
use crate::physics::morison::{DragCoefficients, drag, drag_slope};
use crate::physics::seabed::ContactCoefficients;
use crate::physics::stretch::total_tension;
use crate::statics::catenary::Catenary;

pub(crate) use bending::BendingWork;
use bending::Parts;
pub use bending::{end_moment, end_shear, joint_damping_power};

/// Scratch of the implicit solvers for a whole model. Nothing in it is read before it is written.
#[derive(Debug, Clone)]
pub struct Workspace {
    /// Per line of the model.
    pub(crate) lines: Vec<LineWork>,
    /// Per point of the model.
    pub(crate) points: Vec<PointWork>,
    /// Per network of the model.
    pub(crate) systems: Vec<DenseSystem>,
    /// Per line of the model: its closed form at the last evaluation of a network of catenaries.
    pub(crate) catenaries: Vec<Option<Catenary>>,
    /// The state before a step of the caller's.
    pub(crate) start: State,
    /// The state before a step.
    pub(crate) before: State,
    /// The first guess of an equilibrium.
    pub(crate) saved: State,
    /// The last equilibrium on the way to another.
    pub(crate) trial: State,
    /// Counts since they were last cleared.
    pub(crate) counters: Counters,
}

/// What the implicit solvers did.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Time steps or load steps.
    pub steps: usize,
    /// Linear solves; closed-form catenaries where a network is solved with those.
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

/// Scratch of a line.
#[derive(Debug, Clone)]
pub(crate) struct LineWork {
    /// R of every node, ends included [N].
    pub residual: Vec<Vector3<f64>>,
    /// J of every node on itself.
    pub diagonal: Vec<Matrix3<f64>>,
    /// J of neighbouring nodes on each other, per segment: −A.
    pub coupling: Vec<Matrix3<f64>>,
    /// Tension that the geometric stiffness is taken from, per segment [N]; statics predicts it.
    pub tension: Vec<f64>,
    /// Elastic and damping force of the segment at the last assembly [N], unclipped.
    pub elastic: Vec<f64>,
    /// Its slope dN/dl [N/m].
    pub slope: Vec<f64>,
    /// Its direction q [-].
    pub direction: Vec<Vector3<f64>>,
    /// What the time integrator carries over from the last step, per node [N].
    pub history: Vec<Vector3<f64>>,
    /// Half the range of penetrations over which the seabed damper fades in, per node [m].
    pub reach: Vec<f64>,
    /// Greatest push of the segments [N]; 0 in lines without bending stiffness.
    pub push: Vec<f64>,
    /// Drag of the current that statics holds for a while, per node [N]; empty where none acts.
    pub load: Vec<Vector3<f64>>,
    /// Joints, where the line has bending stiffness.
    pub bending: Option<BendingWork>,
    /// Friction of the bed at the last assembly, per node [N]; empty over a level bed without friction.
    pub rubbed: Vec<Vector3<f64>>,
    /// Elimination where nothing bends.
    chain: Chain,
}

/// Scratch of a point.
#[derive(Debug, Clone)]
pub(crate) struct PointWork {
    /// Index among the free points of its network.
    pub slot: Option<usize>,
    /// R of the point alone, without its lines [N].
    pub residual: Vector3<f64>,
    /// R with its lines [N]; zero along held axes.
    pub total: Vector3<f64>,
    /// J of the point alone.
    pub diagonal: Matrix3<f64>,
    /// Solution of the linear system.
    pub solution: Vector3<f64>,
    /// What the time integrator carries over from the last step [N].
    pub history: Vector3<f64>,
    /// Half the range of penetrations over which its seabed damper fades in [m].
    pub reach: f64,
    /// Friction of the bed at the last assembly [N].
    pub rubbed: Vector3<f64>,
}

impl Workspace {
    /// Scratch for `model`.
    pub fn new(model: &Model) -> Workspace {
        let line = |line: &Line| {
            let n = line.segment_count();
            LineWork {
                residual: vec![Vector3::zeros(); n + 1],
                diagonal: vec![Matrix3::zeros(); n + 1],
                coupling: vec![Matrix3::zeros(); n],
                tension: vec![0.0; n],
                elastic: vec![0.0; n],
                slope: vec![0.0; n],
                direction: vec![Vector3::zeros(); n],
                history: vec![Vector3::zeros(); n + 1],
                reach: vec![0.0; n + 1],
                push: vec![0.0; n],
                load: vec![Vector3::zeros(); if line.drifts(model) { n + 1 } else { 0 }],
                bending: line.bending.as_ref().map(|_| BendingWork::new(n + 1)),
                rubbed: vec![Vector3::zeros(); line.surface().map_or(0, |_| n + 1)],
                chain: Chain::new(n + 1),
            }
        };
        let point = PointWork {
            slot: None,
            residual: Vector3::zeros(),
            total: Vector3::zeros(),
            diagonal: Matrix3::zeros(),
            solution: Vector3::zeros(),
            history: Vector3::zeros(),
            reach: 0.0,
            rubbed: Vector3::zeros(),
        };
        let mut points = vec![point; model.points.len()];
        for network in &model.networks {
            for (slot, &index) in network.free_points.iter().enumerate() {
                points[index].slot = Some(slot);
            }
        }
        let system = |network: &Network| DenseSystem::new(network.free_points.len());
        Workspace {
            lines: model.lines.iter().map(line).collect(),
            points,
            systems: model.networks.iter().map(system).collect(),
            catenaries: vec![None; model.lines.len()],
            start: blank_state(model),
            before: blank_state(model),
            saved: blank_state(model),
            trial: blank_state(model),
            counters: Counters::default(),
        }
    }

    /// What was done since the last call.
    pub fn take_counters(&mut self) -> Counters {
        std::mem::take(&mut self.counters)
    }
}

/// What statics solves for: the full problem, or an easier one on the way to it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StaticCase {
    /// Time of the loads [s].
    pub time: f64,
    /// Part of weight and loads that acts [-].
    pub load: f64,
    /// Upper limit of EA [N].
    pub stiffness_max: f64,
    /// Lower limit of the tension in the geometric stiffness [N].
    pub tension_min: f64,
    /// Pseudo-transient mass over Δτ² on every unknown [N/m].
    pub anchoring: f64,
    /// Whether the geometric stiffness comes from the predicted tension instead of the elastic one.
    pub predicted: bool,
    /// Whether lines with bending stiffness have it, and push.
    pub bends: bool,
    /// Part of the bed's friction that acts, on nodes that have anchors [-].
    pub friction: f64,
}

/// Weights of the parts of residual and tangent in a time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Weights {
    /// Of all forces but inertia in R [-].
    pub force: f64,
    /// Of inertia in R [-].
    pub inertia: f64,
    /// c_k: of ∂R/∂r [-].
    pub position: f64,
    /// c_c: of ∂R/∂v [1/s].
    pub velocity: f64,
    /// c_m: of ∂R/∂a [1/s²].
    pub acceleration: f64,
    /// Whether a segment is taut, and its geometric stiffness, come from the tension that was predicted.
    pub predicted: bool,
    /// Whether the tangent must not be indefinite, rather than exact.
    pub convex: bool,
}

/// Compression that is taken for rounding [-], as a strain.
const PUSH_STRAIN: f64 = 1e-12;

/// A segment as it lies.
struct Geometry {
    /// Length [m].
    length: f64,
    /// Direction [-]; zero where both nodes coincide.
    direction: Vector3<f64>,
    /// l/l₀ − 1 [-], without the cancellation of the subtraction.
    strain: f64,
}

impl Geometry {
    #[inline(always)]
    fn new(a: Vector3<f64>, b: Vector3<f64>, unstretched: f64) -> Geometry {
        let d = b - a;
        let square = d.norm_squared();
        let length = square.sqrt();
        Geometry {
            length,
            direction: if length > 0.0 { d / length } else { d },
            strain: (square - unstretched * unstretched) / (unstretched * (length + unstretched)),
        }
    }

    /// q qᵀ.
    #[inline(always)]
    fn along(&self) -> Matrix3<f64> {
        self.direction * self.direction.transpose()
    }
}

impl LineWork {
    /// How much the segments push: nothing unless the line `bends`.
    fn set_push(&mut self, line: &Line, bends: bool) {
        if let (Some(bending), Some(work)) = (&line.bending, &mut self.bending) {
            work.active = bends;
            for (push, most) in self.push.iter_mut().zip(&bending.compression_max) {
                *push = if bends { *most } else { 0.0 };
            }
        }
    }

    #[inline(always)]
    fn clear(&mut self) {
        self.residual.fill(Vector3::zeros());
        self.diagonal.fill(Matrix3::zeros());
    }

    #[inline(always)]
    fn add_segment(&mut self, i: usize, force: Vector3<f64>, stiffness: Matrix3<f64>) {
        self.residual[i] -= force;
        self.residual[i + 1] += force;
        self.diagonal[i] += stiffness;
        self.diagonal[i + 1] += stiffness;
        self.coupling[i] = -stiffness;
    }

    /// Residual and tangent of a line at rest.
    fn assemble_static(
        &mut self,
        line: &Line,
        state: &LineState,
        clamps: [Option<Vector3<f64>>; 2],
        case: &StaticCase,
    ) {
        let position = &state.position;
        self.clear();
        self.set_push(line, case.bends);
        for i in 0..line.segment_count() {
            self.add_static_segment(line, position, case, i);
        }
        if let (Some(bending), true) = (&line.bending, case.bends) {
            let parts = Parts::AT_REST;
            self.add_bending(bending, clamps, [position, &[]], &parts);
        }
        if line.surface().is_some() {
            self.add_static_surface(line, state, case);
        }
        for (residual, load) in self.residual.iter_mut().zip(&self.load) {
            *residual -= case.load * load;
        }
        for (i, r) in position.iter().enumerate() {
            self.residual[i].z += case.load * line.nodes.weight[i];
            for axis in 0..3 {
                self.diagonal[i][(axis, axis)] += case.anchoring;
            }
            if let Some(contact) = line.level_bed() {
                let penetration = contact.level[i] - r.z;
                if penetration > 0.0 {
                    self.residual[i].z -= contact.stiffness[i] * penetration;
                    self.diagonal[i][(2, 2)] += contact.stiffness[i];
                }
            }
        }
    }

    #[inline(always)]
    fn add_static_segment(
        &mut self,
        line: &Line,
        position: &[Vector3<f64>],
        case: &StaticCase,
        i: usize,
    ) {
        let unstretched = line.segments.length[i];
        let g = Geometry::new(position[i], position[i + 1], unstretched);
        let stretch = line.segments.law[i].at(g.strain);
        let ea = line.segments.axial_stiffness[i].min(case.stiffness_max);
        let (elastic, slope) = (ea * stretch.force, ea * stretch.slope / unstretched);
        (self.elastic[i], self.slope[i], self.direction[i]) = (elastic, slope, g.direction);
        let predicted = if case.predicted {
            self.tension[i]
        } else {
            elastic
        };
        let least = 0.0 - self.push[i];
        let (tension, slope) = if predicted > least || elastic > least {
            (elastic, slope)
        } else {
            (least, 0.0)
        };
        // A segment folded to nothing has no direction to be stiff across.
        let across = predicted.max(least + case.tension_min) / g.length.max(0.1 * unstretched);
        let stiffness = Matrix3::from_diagonal_element(across) + (slope - across) * g.along();
        self.add_segment(i, tension * g.direction, stiffness);
    }

    /// Residual and, if TANGENT, tangent of a moving line.
    fn assemble_dynamic<const TANGENT: bool>(
        &mut self,
        line: &Line,
        state: &LineState,
        clamps: [Option<Vector3<f64>>; 2],
        stream: Option<Stream>,
        weights: &Weights,
        negative_tension: bool,
    ) {
        self.clear();
        self.set_push(line, true);
        for i in 0..line.segment_count() {
            self.add_dynamic_segment::<TANGENT>(line, state, weights, negative_tension, i);
        }
        if let Some(bending) = &line.bending {
            let parts = Parts::of_step(weights, TANGENT);
            self.add_bending(bending, clamps, [&state.position, &state.velocity], &parts);
        }
        self.add_weight_and_inertia::<TANGENT>(line, state, weights);
        if line.nodes.drag.is_some() {
            self.add_drag::<TANGENT>(line, state, stream, weights);
        }
        if line.nodes.contact.is_some() {
            self.add_contact::<TANGENT>(line, state, weights);
        }
        if let Some(damping) = &line.nodes.mass_damping {
            for (i, damping) in damping.iter().enumerate() {
                self.residual[i] += weights.force * damping * state.velocity[i];
                if TANGENT {
                    self.diagonal[i] += Matrix3::from_diagonal_element(weights.velocity * damping);
                }
            }
        }
    }

    #[inline(always)]
    fn add_dynamic_segment<const TANGENT: bool>(
        &mut self,
        line: &Line,
        state: &LineState,
        weights: &Weights,
        negative_tension: bool,
        i: usize,
    ) {
        let unstretched = line.segments.length[i];
        let (ea, ba) = (
            line.segments.axial_stiffness[i],
            line.segments.axial_damping[i],
        );
        let g = Geometry::new(state.position[i], state.position[i + 1], unstretched);
        let rate = state.velocity[i + 1] - state.velocity[i]; // ġ [m/s]
        let stretch = line.segments.law[i].at(g.strain);
        let elastic = ea * stretch.force;
        let total = elastic + ba * g.direction.dot(&rate) / unstretched;
        let predicted = weights.predicted && !negative_tension;
        let least = 0.0 - self.push[i];
        let taut = match (negative_tension, predicted) {
            (true, _) => elastic > least,
            (_, true) => total > least || self.tension[i] > least,
            _ => total > least,
        };
        let tension = match negative_tension {
            true => total_tension(elastic, total - elastic, least, true),
            false if taut => total,
            false => least,
        };
        let mut stiffness = Matrix3::zeros();
        if TANGENT && g.length > 0.0 {
            let damps = taut || negative_tension;
            let spring = if taut {
                ea * stretch.slope / unstretched
            } else {
                0.0
            };
            let damper = if damps { ba / unstretched } else { 0.0 };
            let along = weights.position * spring + weights.velocity * damper;
            let pull = if predicted { self.tension[i] } else { tension };
            let least = if weights.convex { 0.0 } else { least };
            let across = weights.position * pull.max(least) / g.length;
            stiffness = Matrix3::from_diagonal_element(across) + (along - across) * g.along();
            if damps && ba > 0.0 {
                let turning = rate - rate.dot(&g.direction) * g.direction; // P ġ
                let coefficient = weights.position * damper / g.length;
                stiffness += g.direction * (coefficient * turning).transpose();
            }
            self.slope[i] = along / weights.position;
        } else {
            self.tension[i] = tension;
        }
        (self.elastic[i], self.direction[i]) = (total, g.direction);
        let force = weights.force * tension * g.direction;
        self.add_segment(i, force, stiffness);
    }

    #[inline(always)]
    fn add_weight_and_inertia<const TANGENT: bool>(
        &mut self,
        line: &Line,
        state: &LineState,
        weights: &Weights,
    ) {
        let nodes = &line.nodes;
        for i in 0..nodes.weight.len() {
            self.residual[i].z += weights.force * nodes.weight[i];
            let (normal, tangent) = (nodes.mass_normal[i], nodes.mass_tangent[i]);
            let a = state.acceleration[i];
            let mut inertia = normal * a;
            if TANGENT {
                self.diagonal[i] += Matrix3::from_diagonal_element(weights.acceleration * normal);
            }
            if normal != tangent {
                let t = node_tangent(&state.position, i);
                inertia += (tangent - normal) * t.dot(&a) * t;
                if TANGENT {
                    self.diagonal[i] +=
                        weights.acceleration * (tangent - normal) * t * t.transpose();
                }
            }
            self.residual[i] += weights.inertia * inertia;
        }
    }

    fn add_drag<const TANGENT: bool>(
        &mut self,
        line: &Line,
        state: &LineState,
        stream: Option<Stream>,
        weights: &Weights,
    ) {
        let Some(coefficients) = &line.nodes.drag else {
            return;
        };
        for i in 0..coefficients.normal.len() {
            let k = DragCoefficients {
                normal: coefficients.normal[i],
                tangent: coefficients.tangent[i],
            };
            let (t, z) = (node_tangent(&state.position, i), state.position[i].z);
            let flow = stream.map_or(Vector3::zeros(), |stream| stream.velocity(z));
            let v = state.velocity[i] - flow;
            self.residual[i] -= weights.force * drag(k, v, t);
            if TANGENT {
                let slope = drag_slope(k, v, t);
                self.diagonal[i] += weights.velocity * slope;
                if let Some(stream) = stream {
                    let mut by_height = self.diagonal[i].column_mut(2);
                    by_height -= weights.position * slope * stream.shear(z);
                }
            }
        }
    }

    /// Dampers fade over what a node moves in a step of `dt` [s], at least over the range of a resting node.
    fn fade_dampers(&mut self, line: &Line, state: &LineState, dt: f64) {
        let Some(contact) = &line.nodes.contact else {
            return;
        };
        for (i, reach) in self.reach.iter_mut().enumerate() {
            let resting = damper_reach(contact.stiffness[i], line.nodes.weight[i]);
            let rise = match &contact.surface {
                None => state.velocity[i].z,
                Some(surface) => surface.rise(state.position[i], state.velocity[i]),
            };
            *reach = resting.max(rise.abs() * dt);
        }
    }

    fn add_contact<const TANGENT: bool>(
        &mut self,
        line: &Line,
        state: &LineState,
        weights: &Weights,
    ) {
        if line.surface().is_some() {
            return self.add_surface::<TANGENT>(line, state, weights);
        }
        let Some(contact) = &line.nodes.contact else {
            return;
        };
        for i in 0..contact.stiffness.len() {
            let k = ContactCoefficients {
                stiffness: contact.stiffness[i],
                damping: contact.damping[i],
            };
            let penetration = contact.level[i] - state.position[i].z;
            let velocity = state.velocity[i].z;
            let Some(bed) = SmoothContact::new(k, penetration, velocity, self.reach[i]) else {
                continue;
            };
            self.residual[i].z -= weights.force * bed.force;
            if TANGENT {
                self.diagonal[i][(2, 2)] +=
                    weights.position * bed.stiffness + weights.velocity * bed.damping;
            }
        }
    }
}

impl PointWork {
    /// Residual and tangent of a point at rest, without its lines.
    fn assemble_static(
        &mut self,
        point: &Point,
        free: &FreePoint,
        state: &PointState,
        stream: Option<Stream>,
        case: &StaticCase,
    ) {
        let (z, at) = (state.position.z, free.at(state.position.z));
        let mut force = point.load_at(case.time) - at.weight * Vector3::z();
        self.diagonal = Matrix3::from_diagonal_element(case.anchoring);
        self.diagonal[(2, 2)] += case.load * at.weight_slope;
        if let (Some(sphere), Some(stream)) = (&free.sphere, stream) {
            let past = -stream.velocity(z);
            force += sphere.drag(at.wetted, past);
            let by_height = sphere.drag_slope_with_height(at.wetted, past)
                - sphere.drag_slope(at.wetted, past) * stream.shear(z);
            self.diagonal
                .set_column(2, &(self.diagonal.column(2) + case.load * by_height));
        }
        self.residual = -case.load * force;
    }

    /// Residual and, if TANGENT, tangent of a moving point under a `load` [N], without its lines.
    fn assemble_dynamic<const TANGENT: bool>(
        &mut self,
        free: &FreePoint,
        surface: Option<&Surface>,
        state: &PointState,
        load: Vector3<f64>,
        stream: Option<Stream>,
        weights: &Weights,
    ) {
        let (z, a) = (state.position.z, state.acceleration);
        let v = state.velocity;
        let past = v - stream.map_or(Vector3::zeros(), |stream| stream.velocity(z));
        let at = free.at(z);
        let mut force = load - at.weight * Vector3::z();
        self.diagonal = Matrix3::from_diagonal_element(weights.acceleration * at.mass);
        if let Some(sphere) = &free.sphere {
            force += sphere.drag(at.wetted, past);
            if TANGENT {
                let slope = sphere.drag_slope(at.wetted, past);
                self.diagonal += weights.velocity * slope;
                let mut by_height = sphere.drag_slope_with_height(at.wetted, past);
                by_height -= stream.map_or(Vector3::zeros(), |stream| slope * stream.shear(z));
                by_height.z += at.weight_slope;
                let by_height = weights.position * by_height + weights.inertia * at.mass_slope * a;
                self.diagonal
                    .set_column(2, &(self.diagonal.column(2) + by_height));
            }
        }
        if let (Some(contact), None) = (&free.contact, surface)
            && let Some(bed) =
                SmoothContact::new(contact.coefficients, contact.level - z, v.z, self.reach)
        {
            force.z += bed.force;
            if TANGENT {
                self.diagonal[(2, 2)] +=
                    weights.position * bed.stiffness + weights.velocity * bed.damping;
            }
        }
        self.residual = weights.inertia * at.mass * a - weights.force * force;
        if let Some(surface) = surface {
            self.add_surface::<TANGENT>(free, surface, state, weights);
        }
    }
}

/// Half the range of penetrations over which the seabed damper fades in, in static penetrations of the node [-].
const DAMPER_FADE: f64 = 2.0;

/// Half the range of penetrations over which the damper of a resting node fades in [m].
fn damper_reach(stiffness: f64, weight: f64) -> f64 {
    if stiffness > 0.0 {
        DAMPER_FADE * weight.abs() / stiffness
    } else {
        0.0
    }
}

/// The contact of `physics::seabed` with a damper that fades in over ± `reach` of penetration instead of switching on at
/// touch: f = max(0, k max(p, 0) − c s(p) ż), s the cubic step. A switching damper breaks Newton; where nothing moves the
/// force is the same.
struct SmoothContact {
    /// Upward force [N].
    force: f64,
    /// Its slope with penetration [N/m].
    stiffness: f64,
    /// Minus its slope with ż [N s/m].
    damping: f64,
}

impl SmoothContact {
    /// `None` where the bed does not act.
    #[inline(always)]
    fn new(
        k: ContactCoefficients,
        penetration: f64,
        velocity: f64,
        reach: f64,
    ) -> Option<SmoothContact> {
        if penetration <= -reach {
            return None;
        }
        let u = if reach > 0.0 {
            (0.5 * (penetration / reach + 1.0)).min(1.0)
        } else {
            1.0
        };
        let (fade, slope) = (
            u * u * (3.0 - 2.0 * u),
            6.0 * u * (1.0 - u) / (2.0 * reach.max(f64::MIN_POSITIVE)),
        );
        let spring = if penetration > 0.0 { k.stiffness } else { 0.0 };
        let force = spring * penetration - k.damping * fade * velocity;
        (force > 0.0).then_some(SmoothContact {
            force,
            stiffness: spring - k.damping * slope * velocity,
            damping: k.damping * fade,
        })
    }
}

/// Unit tangent of a node: along its two neighbours, at an end along the segment.
#[inline(always)]
pub(crate) fn node_tangent(position: &[Vector3<f64>], i: usize) -> Vector3<f64> {
    let (before, after) = (i.saturating_sub(1), (i + 1).min(position.len() - 1));
    let chord = position[after] - position[before];
    let length = chord.norm();
    if length > 0.0 { chord / length } else { chord }
}

impl Workspace {
    /// Residual and tangent of a network at rest.
    pub(crate) fn assemble_static(
        &mut self,
        model: &Model,
        network: &Network,
        state: &State,
        case: &StaticCase,
    ) {
        for &index in &network.lines {
            let (line, shape) = (&model.lines[index], &state.lines[index]);
            self.lines[index].assemble_static(line, shape, line.clamps(&state.points), case);
        }
        let stream = model.stream(case.time);
        for_free_points(model, network, |index, free| {
            let point = &mut self.points[index];
            let (data, state) = (&model.points[index], &state.points[index]);
            point.assemble_static(data, free, state, stream, case);
            if let Some(surface) = model.surface.as_deref() {
                point.add_static_surface(free, surface, state, case);
            } else if let Some((stiffness, push)) = free.bed_at_rest(state.position.z) {
                point.residual.z -= push;
                point.diagonal[(2, 2)] += stiffness;
            }
        });
        self.gather(model, network);
    }

    /// Residual and, if TANGENT, tangent of a moving network at time `t` [s].
    pub(crate) fn assemble_dynamic<const TANGENT: bool>(
        &mut self,
        model: &Model,
        network: &Network,
        state: &State,
        t: f64,
        weights: &Weights,
    ) {
        let negative_tension = model.solver.negative_tension;
        let stream = model.stream(t);
        for &index in &network.lines {
            let (line, line_state) = (&model.lines[index], &state.lines[index]);
            self.lines[index].assemble_dynamic::<TANGENT>(
                line,
                line_state,
                line.clamps(&state.points),
                stream,
                weights,
                negative_tension,
            );
        }
        for_free_points(model, network, |index, free| {
            let point = &mut self.points[index];
            let load = model.points[index].load_at(t);
            let (surface, state) = (model.surface.as_deref(), &state.points[index]);
            point.assemble_dynamic::<TANGENT>(free, surface, state, load, stream, weights);
        });
        self.gather(model, network);
    }

    /// Adds what lines contribute to the residual of the free points.
    pub(crate) fn gather(&mut self, model: &Model, network: &Network) {
        for_free_points(model, network, |index, free| {
            let mut total = self.points[index].residual;
            for &(line, end) in &model.points[index].attached {
                total += self.lines[line].residual[model.lines[line].end_node(end)];
            }
            for axis in 0..3 {
                if !free.axes[axis] {
                    total[axis] = 0.0;
                }
            }
            self.points[index].total = total;
        });
    }

    /// Solves J x = R for the nodes of all lines, ends included, and the free points; false if J is not positive definite.
    /// The correction of the positions is −x.
    pub(crate) fn solve(&mut self, model: &Model, network: &Network, number: usize) -> bool {
        self.counters.solves += 1;
        let system = &mut self.systems[number];
        system.clear();
        for &index in &network.lines {
            let work = &mut self.lines[index];
            let [a, b] = model.lines[index].ends.map(|point| self.points[point].slot);
            let Some(ends) = work.eliminate(a.is_some()) else {
                return false;
            };
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
        for (slot, &index) in network.free_points.iter().enumerate() {
            system.add_block(slot, slot, &self.points[index].diagonal);
            system.add_right(slot, self.points[index].residual);
        }
        for_free_points(model, network, |index, free| {
            for axis in (0..3).filter(|&axis| !free.axes[axis]) {
                system.hold(self.points[index].slot.unwrap_or(0), axis);
            }
        });
        if !system.solve() {
            return false;
        }
        for (slot, &index) in network.free_points.iter().enumerate() {
            self.points[index].solution = system.solution(slot);
        }
        for &index in &network.lines {
            let [a, b] = model.lines[index].ends.map(|point| self.solution_at(point));
            self.lines[index].substitute(a, b);
        }
        true
    }

    /// Tensions after a `part` of the correction, by the linear system. False if a segment that was taken as taut pushes by more
    /// than rounding.
    pub(crate) fn predict_tensions(&mut self, model: &Model, network: &Network, part: f64) -> bool {
        let mut consistent = true;
        for &index in &network.lines {
            let (line, stiffness) = (
                &mut self.lines[index],
                &model.lines[index].segments.axial_stiffness,
            );
            for i in 0..line.tension.len() {
                let x = line.solution();
                let growth = -line.direction[i].dot(&(x[i + 1] - x[i])); // of the segment's length [m]
                let predicted = line.elastic[i] + line.slope[i] * growth;
                let least = 0.0 - line.push[i];
                consistent &= line.tension[i] <= least
                    || line.elastic[i] >= least - PUSH_STRAIN * stiffness[i];
                line.tension[i] += part * (predicted - line.tension[i]);
            }
        }
        consistent
    }

    /// Sets how far the seabed dampers of a network fade for a step of `dt` [s] from `state`.
    pub(crate) fn fade_dampers(
        &mut self,
        model: &Model,
        network: &Network,
        state: &State,
        dt: f64,
    ) {
        for &index in &network.lines {
            self.lines[index].fade_dampers(&model.lines[index], &state.lines[index], dt);
        }
        for_free_points(model, network, |index, free| {
            if let Some(contact) = &free.contact {
                let resting = damper_reach(contact.coefficients.stiffness, free.weight);
                let PointState { position, velocity, .. } = state.points[index];
                let rise = match &model.surface {
                    None => velocity.z,
                    Some(surface) => surface.rise(position, velocity),
                };
                let moved = rise.abs() * dt;
                self.points[index].reach = resting.max(moved);
            }
        });
    }

    /// Moves the anchors of nodes that slid along the bed, after an assembly of the state.
    pub(crate) fn move_anchors(&self, model: &Model, network: &Network, state: &mut State) {
        if model.friction().is_some() {
            rubbing::move_anchors(model, network, state, self);
        }
    }

    /// Keeps the residual of the last assembly for the next step.
    pub(crate) fn remember(&mut self, network: &Network) {
        for &index in &network.lines {
            let line = &mut self.lines[index];
            line.history.copy_from_slice(&line.residual);
        }
        for &index in &network.free_points {
            self.points[index].history = self.points[index].residual;
        }
    }

    /// Adds what was remembered to the residual.
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

    fn solution_at(&self, point: usize) -> Vector3<f64> {
        let point = &self.points[point];
        point.slot.map_or(Vector3::zeros(), |_| point.solution)
    }

    /// Longest entry of the last solution [m]; not a number if one of them is not.
    pub(crate) fn greatest_solution(&self, network: &Network) -> f64 {
        let longer = |a: f64, b: f64| if a.is_nan() || a >= b { a } else { b };
        let lines = network
            .lines
            .iter()
            .flat_map(|&line| self.lines[line].solution());
        lines.map(|x| x.norm_squared()).fold(0.0, longer).sqrt()
    }

    /// Greatest force out of balance [N] and where it is.
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

/// A node between the ends of a line, or a free point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// Node of a line, by their indices.
    Node {
        /// Index of the line.
        line: usize,
        /// Index of the node.
        node: usize,
    },
    /// Free point, by its index.
    Point(usize),
}

impl Place {
    /// A line and a node there.
    pub(crate) fn node(self, model: &Model) -> (usize, usize) {
        match self {
            Place::Node { line, node } => (line, node),
            Place::Point(point) => {
                let (line, end) = model.points[point].attached[0];
                (line, model.lines[line].end_node(end))
            }
        }
    }

    /// In words.
    pub(crate) fn name(self, model: &Model) -> String {
        match self {
            Place::Node { line, node } => {
                format!("line \"{}\", node {node}", model.lines[line].name)
            }
            Place::Point(point) => format!("point \"{}\"", model.points[point].name),
        }
    }
}

/// Visits the free points of a network.
pub(crate) fn for_free_points(
    model: &Model,
    network: &Network,
    mut visit: impl FnMut(usize, &FreePoint),
) {
    for &index in &network.free_points {
        if let Some(free) = model.points[index].free() {
            visit(index, free);
        }
    }
}

/// Puts the end nodes of a network's lines where their points are, and moves them alike.
pub(crate) fn place_ends(model: &Model, network: &Network, state: &mut State) {
    for &index in &network.lines {
        let line = &model.lines[index];
        for (point, node) in line.ends.into_iter().zip([0, line.segment_count()]) {
            let (point, nodes) = (&state.points[point], &mut state.lines[index]);
            nodes.position[node] = point.position;
            nodes.velocity[node] = point.velocity;
            nodes.acceleration[node] = point.acceleration;
        }
    }
}

/// Copies a network's points and nodes from one state to another, without allocating.
pub(crate) fn copy_network(model: &Model, network: &Network, from: &State, to: &mut State) {
    for &index in &network.lines {
        let (from_line, to_line) = (&from.lines[index], &mut to.lines[index]);
        to_line.position.copy_from_slice(&from_line.position);
        to_line.velocity.copy_from_slice(&from_line.velocity);
        to_line
            .acceleration
            .copy_from_slice(&from_line.acceleration);
        to_line.beam.clone_from(&from_line.beam);
        to_line.anchor.clone_from(&from_line.anchor);
        for point in model.lines[index].ends {
            to.points[point] = from.points[point];
        }
    }
}

/// A state of `model` with room for everything and nothing in place.
fn blank_state(model: &Model) -> State {
    let line = |line: &Line| {
        let count = line.segment_count() + 1;
        LineState {
            anchor: Vec::with_capacity(line.friction().map_or(0, |_| count)),
            ..LineState::at_rest(vec![Vector3::zeros(); count])
        }
    };
    State {
        time: 0.0,
        points: model
            .points
            .iter()
            .map(|point| PointState::at_rest(point.reference))
            .collect(),
        lines: model.lines.iter().map(line).collect(),
    }
}

/// Force [N] that a line applies to the point at one of its ends, inertia and drag of its end node included.
pub fn end_force(
    model: &Model,
    state: &State,
    line: usize,
    end: End,
    work: &mut Workspace,
) -> Vector3<f64> {
    let weights = Weights {
        force: 1.0,
        inertia: 1.0,
        position: 0.0,
        velocity: 0.0,
        acceleration: 0.0,
        predicted: false,
        convex: false,
    };
    let negative_tension = model.solver.negative_tension;
    let clamps = model.lines[line].clamps(&state.points);
    let (line_model, line_state, line_work) = (
        &model.lines[line],
        &state.lines[line],
        &mut work.lines[line],
    );
    line_work.fade_dampers(line_model, line_state, 0.0);
    let stream = model.stream(state.time);
    line_work.assemble_dynamic::<false>(
        line_model,
        line_state,
        clamps,
        stream,
        &weights,
        negative_tension,
    );
    -line_work.residual[line_model.end_node(end)]
}

#[cfg(test)]
mod tests;
