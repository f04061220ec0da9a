//! Line in the assembled system: segments, weight, inertia and drag of its nodes.

use nalgebra::{Matrix3, Vector3};

use super::contact::{Bearing, Stand};
use super::joint::Parts;
use super::released::Released;
use super::segment::StepEnd;
use super::viscoelastic::ViscoelasticWork;
use super::{BendingWork, StaticCase, Stretch, Weights, surface};
use crate::math::block_banded::Chain;
use crate::model::{Dry, Line, LineState, Model, State, WaterAlong};
use crate::physics::bending::Direction;
use crate::physics::morison::{drag, drag_slope};
use crate::physics::slender::Slender;
use crate::physics::stretch::total_tension;
use crate::physics::stretch_step::Stretched;

/// Minimum length for the lateral stiffness of a segment, relative to its unstretched length [-]: a segment folded to zero length has no direction.
const FOLDED: f64 = 0.1;

/// Workspace of a line; without nodes by default.
#[derive(Debug, Clone, Default)]
pub(crate) struct LineWork {
    /// R of every node, including the ends [N].
    pub residual: Vec<Vector3<f64>>,
    /// J of every node: diagonal blocks.
    pub diagonal: Vec<Matrix3<f64>>,
    /// J of neighbouring nodes, per segment: off-diagonal blocks −A.
    pub coupling: Vec<Matrix3<f64>>,
    /// Unit tangent of every node of a moving line at the last assembly [-].
    pub(super) tangent: Vec<Vector3<f64>>,
    /// Tension of the geometric stiffness, per segment [N]; predicted by statics.
    pub tension: Vec<f64>,
    /// Elastic and damping force of the segment at the last assembly [N], unclipped.
    pub elastic: Vec<f64>,
    /// Slope dN/dl [N/m].
    pub slope: Vec<f64>,
    /// Direction q of every segment, and 1/l.
    pub direction: Vec<Direction>,
    /// Segments at the start of the step.
    pub(super) start: Vec<Stretched>,
    /// Terms that the time integrator carries over from the last step, per node [N].
    pub history: Vec<Vector3<f64>>,
    /// Half the range of penetrations over which the seabed damper fades in, per segment [m].
    pub reach: Vec<f64>,
    /// Position of every node relative to the seabed, and the bearing of its adjacent segments, at the last assembly; empty without a seabed.
    pub(super) stand: Vec<Stand>,
    pub(super) bearing: Vec<Bearing>,
    /// Maximum compression of the segments [N]; 0 in lines without bending stiffness.
    pub push: Vec<f64>,
    /// Drag of the current that statics keeps constant, per node [N]; empty if there is none.
    pub load: Vec<Vector3<f64>>,
    /// Effect of the water surface on every node; empty if the line does not reach it.
    pub dry: Vec<Dry>,
    /// Joints, if the line has bending stiffness.
    pub bending: Option<BendingWork>,
    /// Friction of the seabed at the last assembly, per node [N]; empty over a level seabed without friction.
    pub rubbed: Vec<Vector3<f64>>,
    /// Normal force that limits friction at rest, per node [N]; empty like `rubbed`.
    pub pressed: Vec<f64>,
    /// Memory of viscoelastic segments, if the line has any.
    pub(super) viscoelastic: Option<ViscoelasticWork>,
    /// True if ends A and B are released from their points.
    pub(super) released: [bool; 2],
    /// Blocks of the last elimination of released ends.
    pub(super) loose: Option<Released>,
    /// Elimination without bending.
    pub(super) chain: Chain<false>,
}

/// Geometry of a segment.
pub(super) struct Geometry {
    /// Length [m].
    pub(super) length: f64,
    /// Direction q, zero where both nodes coincide, and 1/l.
    pub(super) direction: Direction,
    /// l/l₀ − 1 [-], without the cancellation of the subtraction.
    pub(super) strain: f64,
}

impl Geometry {
    #[inline(always)]
    pub(super) fn new(a: Vector3<f64>, b: Vector3<f64>, unstretched: f64) -> Geometry {
        let d = b - a;
        let square = d.norm_squared();
        let length = square.sqrt();
        Geometry {
            length,
            direction: Direction::new(d, length),
            strain: (square - unstretched * unstretched) / (unstretched * (length + unstretched)),
        }
    }

    /// q qᵀ.
    #[inline(always)]
    pub(super) fn along(&self) -> Matrix3<f64> {
        let q = self.direction.along;
        q * q.transpose()
    }
}

impl LineWork {
    /// Workspace for a line of `model`.
    pub(super) fn new(model: &Model, line: &Line) -> LineWork {
        let n = line.segment_count();
        LineWork {
            residual: vec![Vector3::zeros(); n + 1],
            diagonal: vec![Matrix3::zeros(); n + 1],
            coupling: vec![Matrix3::zeros(); n],
            tangent: vec![Vector3::zeros(); n + 1],
            tension: vec![0.0; n],
            elastic: vec![0.0; n],
            slope: vec![0.0; n],
            direction: vec![Direction::default(); n],
            start: vec![Stretched::default(); n],
            history: vec![Vector3::zeros(); n + 1],
            reach: vec![0.0; n],
            stand: vec![Stand::default(); line.nodes.contact.as_ref().map_or(0, |_| n + 1)],
            bearing: vec![Bearing::default(); line.nodes.contact.as_ref().map_or(0, |_| n + 1)],
            push: vec![0.0; n],
            load: vec![Vector3::zeros(); if line.drifts(model) { n + 1 } else { 0 }],
            dry: vec![Dry::default(); if line.surface.is_some() { n + 1 } else { 0 }],
            bending: line.bending.as_ref().map(|_| BendingWork::new(n + 1)),
            rubbed: vec![Vector3::zeros(); line.seabed().map_or(0, |_| n + 1)],
            pressed: vec![0.0; line.seabed().map_or(0, |_| n + 1)],
            viscoelastic: ViscoelasticWork::new(line),
            released: [false; 2],
            loose: None,
            chain: Chain::new(n + 1),
        }
    }

    /// Sets the maximum compression of the segments: zero unless the line `bends`.
    fn set_push(&mut self, line: &Line, bends: bool) {
        if let (Some(bending), Some(work)) = (&line.bending, &mut self.bending) {
            work.active = bends;
            for (push, most) in self.push.iter_mut().zip(&bending.compression_max) {
                *push = if bends { *most } else { 0.0 };
            }
        }
    }

    #[inline(always)]
    fn clear(&mut self, tangent: bool) {
        self.residual.fill(Vector3::zeros());
        if tangent {
            self.diagonal.fill(Matrix3::zeros());
        }
    }

    #[inline(always)]
    fn add_segment<const TANGENT: bool>(&mut self, i: usize, force: Vector3<f64>, stiffness: Matrix3<f64>) {
        self.residual[i] -= force;
        self.residual[i + 1] += force;
        if !TANGENT {
            return;
        }
        self.diagonal[i] += stiffness;
        self.diagonal[i + 1] += stiffness;
        self.coupling[i] = -stiffness;
    }

    /// Assembles residual and tangent of a line at rest.
    pub(super) fn assemble_static(&mut self, model: &Model, state: &State, index: usize, case: &StaticCase) {
        let (line, shape) = (&model.lines[index], &state.lines[index]);
        let position = &shape.position;
        self.clear(true);
        self.set_push(line, case.bends);
        for i in 0..line.segment_count() {
            self.add_static_segment(line, position, case, i);
        }
        if let (Some(bending), true) = (&line.bending, case.bends) {
            let clamps = line.clamps(&state.points);
            self.add_bending(bending, (clamps, [Vector3::zeros(); 2]), &[], &Parts::AT_REST);
        }
        for (residual, load) in self.residual.iter_mut().zip(&self.load) {
            *residual -= case.load * load;
        }
        self.add_surface(
            line,
            position,
            WaterAlong::default(),
            [case.load; 2],
            case.breadth,
        );
        for i in 0..position.len() {
            self.residual[i].z += case.load * line.nodes.weight[i];
            for axis in 0..3 {
                self.diagonal[i][(axis, axis)] += case.anchoring;
            }
        }
        self.add_contact_at_rest(line, shape, case);
        if case.bends {
            let parts = Parts {
                force: case.load,
                position: case.load,
                ..Parts::AT_REST
            };
            self.add_end_moments(position, model.end_moments(line, case.time), &parts);
        }
    }

    #[inline(always)]
    fn add_static_segment(&mut self, line: &Line, position: &[Vector3<f64>], case: &StaticCase, i: usize) {
        let unstretched = line.segments.length[i];
        let g = Geometry::new(position[i], position[i + 1], unstretched);
        let stretch = line.segments.law[i].at(g.strain);
        let ea = line.segments.axial_stiffness[i].min(case.stiffness_max);
        let stiffness = if case.vibrates {
            line.segments.in_motion(i).0
        } else {
            ea
        };
        let (elastic, slope) = (ea * stretch.force, stiffness * stretch.slope / unstretched);
        (self.elastic[i], self.slope[i], self.direction[i]) = (elastic, slope, g.direction);
        if case.slack > 0.0 {
            return self.add_taut_segment(&g, case, [ea, unstretched], i);
        }
        let predicted = if case.predicted { self.tension[i] } else { elastic };
        let least = 0.0 - self.push[i];
        let (tension, slope) = if predicted > least || elastic > least {
            (elastic, slope)
        } else {
            (least, 0.0)
        };
        let across = predicted.max(least + case.tension_min) / g.length.max(FOLDED * unstretched);
        let stiffness = Matrix3::from_diagonal_element(across) + (slope - across) * g.along();
        self.add_segment::<true>(i, tension * g.direction.along, stiffness);
    }

    /// Adds a segment whose tension T is complementary to the excess of T over the elastic force N except for m = `case.slack`: T (T − N) = m EA.
    /// Newton's method on T and the nodes together, from the predicted tension t, gives
    ///
    ///   T ← (t² + m EA)/(2t − N) + t/(2t − N) dN.
    ///
    /// If t is less than N, t is replaced by the solution for N alone.
    fn add_taut_segment(&mut self, g: &Geometry, case: &StaticCase, [ea, unstretched]: [f64; 2], i: usize) {
        let (elastic, product) = (self.elastic[i], case.slack * ea);
        let root = elastic.hypot(2.0 * product.sqrt());
        let own = if elastic > 0.0 {
            0.5 * (elastic + root)
        } else {
            2.0 * product / (root - elastic)
        };
        let predicted = if case.predicted { self.tension[i] } else { own };
        let t = if predicted > elastic { predicted } else { own };
        let sum = 2.0 * t - elastic;
        self.elastic[i] = (t * t + product) / sum;
        self.slope[i] *= t / sum;
        let across = predicted / g.length.max(FOLDED * unstretched);
        let stiffness = Matrix3::from_diagonal_element(across) + (self.slope[i] - across) * g.along();
        self.add_segment::<true>(i, self.elastic[i] * g.direction.along, stiffness);
    }

    /// Assembles the residual and, if TANGENT, the tangent of a moving line.
    pub(super) fn assemble_dynamic<const TANGENT: bool>(
        &mut self,
        model: &Model,
        state: &State,
        index: usize,
        t: f64,
        weights: &Weights,
    ) {
        let (line, shape) = (&model.lines[index], &state.lines[index]);
        let (water, parts) = (
            model.water_along(state, index, t),
            Parts::of_step(weights, TANGENT),
        );
        self.clear(TANGENT);
        self.set_push(line, true);
        for (i, tangent) in self.tangent.iter_mut().enumerate() {
            *tangent = node_tangent(&shape.position, i);
        }
        for i in 0..line.segment_count() {
            self.add_dynamic_segment::<TANGENT>(line, shape, weights, model.solver.negative_tension, i);
        }
        if let Some(bending) = &line.bending {
            let spins = line.ends.map(|point| state.points[point].spin);
            let clamps = (line.clamps(&state.points), spins);
            self.add_bending(bending, clamps, &shape.velocity, &parts);
        }
        let surface = [weights.force, weights.position];
        self.add_surface(line, &shape.position, water, surface, 0.0);
        self.add_weight_and_inertia::<TANGENT>(line, shape, weights);
        self.add_drag::<TANGENT>(line, shape, water, weights);
        self.add_froude_krylov(line, water, weights);
        self.add_contact::<TANGENT>(line, shape, weights);
        if let Some(damping) = &line.nodes.mass_damping {
            for (i, damping) in damping.iter().enumerate() {
                self.residual[i] += weights.force * damping * shape.velocity[i];
                if TANGENT {
                    self.diagonal[i] += Matrix3::from_diagonal_element(weights.velocity * damping);
                }
            }
        }
        self.add_end_moments(&shape.position, model.end_moments(line, t), &parts);
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
        let per_unstretched = 1.0 / unstretched;
        let g = Geometry::new(state.position[i], state.position[i + 1], unstretched);
        let rate = state.velocity[i + 1] - state.velocity[i]; // ġ [m/s]
        let response = self.respond(line, state, i, g.strain, weights.stretch);
        let (elastic, ba) = (response.elastic, response.damping);
        let total = elastic + ba * g.direction.along.dot(&rate) * per_unstretched;
        let predicted = weights.stretch == Stretch::OverStep && !negative_tension;
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
        let pull = if predicted { self.tension[i] } else { tension };
        let mut stiffness = Matrix3::zeros();
        if TANGENT && g.length > 0.0 {
            let damps = taut || negative_tension;
            let spring = if taut {
                response.tangent * per_unstretched
            } else {
                0.0
            };
            let damper = if damps { ba * per_unstretched } else { 0.0 };
            let along = weights.position * spring + weights.velocity * damper;
            let least = if weights.convex { 0.0 } else { least };
            let across = weights.position * pull.max(least) * g.direction.per_length;
            stiffness = Matrix3::from_diagonal_element(across) + (along - across) * g.along();
            if damps && ba > 0.0 {
                let turning = rate - rate.dot(&g.direction.along) * g.direction.along; // P ġ
                let coefficient = weights.position * damper * g.direction.per_length;
                stiffness += g.direction.along * (coefficient * turning).transpose();
            }
            self.slope[i] = spring + weights.velocity / weights.position * damper;
        } else if weights.stretch != Stretch::OverStep {
            self.tension[i] = tension;
        }
        (self.elastic[i], self.direction[i]) = (total, g.direction);
        let mut force = weights.force * tension * g.direction.along;
        if weights.stretch == Stretch::OverStep {
            let end = StepEnd {
                keeps: taut && total <= least,
                excess: pull.max(least) - tension,
            };
            let beyond = self.beyond_mean(line, i, &g, response, end);
            force += beyond.force;
            stiffness += beyond.stiffness;
        }
        self.add_segment::<TANGENT>(i, force, stiffness);
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
            let dry = self.dry(i);
            let mass = Slender::new(nodes.masses(i, dry.part));
            let a = state.acceleration[i];
            let along = self.tangent[i];
            let inertia = mass.times(a, along);
            if TANGENT {
                self.diagonal[i] += weights.acceleration * mass.matrix(along);
            }
            if TANGENT && weights.position > 0.0 && dry.slope > 0.0 {
                let added_mass =
                    [nodes.mass_normal[i], nodes.mass_tangent[i]].map(|mass| mass - nodes.mass[i]);
                let added = Slender::new(added_mass).times(a, along);
                self.diagonal[i] += weights.inertia * surface::by_height(&dry, added);
            }
            self.residual[i] += weights.inertia * inertia;
        }
    }

    /// Adds the force of water accelerated by waves; it depends on the state only through the tangent, which is frozen.
    fn add_froude_krylov(&mut self, line: &Line, water: WaterAlong, weights: &Weights) {
        let (Some(pressed), Some(waves)) = (&line.nodes.froude_krylov, &water.waves) else {
            return;
        };
        for i in 0..self.residual.len() {
            let wet = 1.0 - self.dry(i).part;
            let force = pressed.force(i, waves.at(i).acceleration, self.tangent[i]);
            self.residual[i] -= weights.force * wet * force;
        }
    }

    fn add_drag<const TANGENT: bool>(
        &mut self,
        line: &Line,
        state: &LineState,
        water: WaterAlong,
        weights: &Weights,
    ) {
        let Some(coefficients) = &line.nodes.drag else {
            return;
        };
        for i in 0..coefficients.normal.len() {
            let dry = self.dry(i);
            let k = coefficients.at(i);
            let (t, z) = (self.tangent[i], state.position[i].z);
            let v = state.velocity[i] - water.velocity(i, z);
            if TANGENT && dry.slope > 0.0 {
                self.diagonal[i] -= weights.position * surface::by_height(&dry, drag(k, v, t));
            }
            let k = k.times(1.0 - dry.part);
            self.residual[i] -= weights.force * drag(k, v, t);
            if TANGENT {
                let slope = drag_slope(k, v, t);
                self.diagonal[i] += weights.velocity * slope;
                if let Some(stream) = water.stream {
                    let mut by_height = self.diagonal[i].column_mut(2);
                    by_height -= weights.position * slope * stream.shear(z);
                }
            }
        }
    }
}

/// Unit tangent of a node: along the chord of its two neighbours, at an end along the segment.
#[inline(always)]
pub(crate) fn node_tangent(position: &[Vector3<f64>], i: usize) -> Vector3<f64> {
    let (before, after) = (i.saturating_sub(1), (i + 1).min(position.len() - 1));
    let chord = position[after] - position[before];
    let length = chord.norm();
    if length > 0.0 {
        (1.0 / length) * chord
    } else {
        chord
    }
}
