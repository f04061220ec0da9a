//! Forces that a line applies to the points at its ends, and tensions along it.
//!
//! The half node at the end belongs to the line, so that the force on the vessel is
//!
//! F = T q + S − [M(t) a + w ẑ − f_drag − f_waves − f_seabed],
//!
//! where T q points into the line, S is the shear of a line with bending stiffness, and v and a are those of the point.
//! Without the half node, the error of the end force would be of first order in the segment length. A line on its
//! closed-form catenary uses the forces of the catenary.
//!
//! The bracket assumes that the load per length p on the half node is constant at its end value, p_e. A better assumption
//! for the last element is a load that is linear to the p_k of the next node, which follows from its two segments:
//! p_k h_k = T₁q₁ − T₂q₂ − (own weight). The load on the half node is then h(⅜p_e + ⅛p_k). T q is the force in the middle
//! of the chord except for (h²/24)p', which adds (h/24)(p_k − p_e). Together they replace (h/2)p_e by
//!
//! h(⅓p_e + ⅙p_k),
//!
//! the reaction of consistent loads. p excludes the weight, whose share is exact, and p_e uses the tangent at the end,
//! along 3q₁ − q₂. Drag is proportional to the square of a velocity that decreases along the line, and is not a linear load
//! even if the velocity is linear. With the drag d_m in the middle of the element, and d_e and d_k at its ends, Simpson's
//! rule for the consistent load adds
//!
//! (h/3)(d_m − ½(d_e + d_k)).
//!
//! The velocities in d are relative to the water, and the one in the middle is the mean of both ends, so that a line in a
//! current has the end forces of one that is towed in still water. If the line bends, S adds to T q on both sides of the
//! next node. The contact force of the seabed is given at both nodes and is treated like their weight.
//!
//! The whole correction is scaled by min(1, (|p_e|/|p_k − p_e|)⁴), and at the water surface also by |p_e|²/(|p_e|² + 16 |Δ|²). Δ is the part of the
//! load, including buoyancy, that p_e would gain or lose if the end were as far out of the water as the next node.
//!
//! On a taut rope that follows its fairlead (`taut_polyester`), the correction multiplies the error of the tension by 0.18 with 3 elements,
//! 0.2 with 4, 0.3 with 6 and 0.5 with 10. With 20 and more, where the error is below 0.2 % either way, it is 1.1 to 1.4 times as large: the
//! error of the uniform load then compensates that of the waves along the line. A load that changes by more than its value, for example
//! towards a next node that snaps or lands, is not linear: the error of chains that slacken in every cycle grows by up to 6 % without
//! scaling, and by 2 % at most with it. The correction requires a uniform line on both sides of the next node: it is omitted where sections
//! meet there, and where the line is on a winch.
//!
//! Source: equation of motion of the end node, as for interior nodes; the loads are derived here from the Taylor series of T q.

use nalgebra::{Matrix3, Vector3};

use super::beam::BeamView;
use super::leapfrog::{segment_tension, step::Step};
use super::viscoelastic::{Stretching, ViscoelasticSegment};
use crate::elements::shear;
use crate::model::{Dry, End, Line, LineState, PointState, WaterAlong, WinchState};
use crate::physics::morison;
use crate::physics::slender::Slender;

/// Factor on |Δ|² in the scale of the correction at the water surface [-].
const ABRUPT: f64 = 16.0;

/// Tension of segment `i` [N]; on a closed-form catenary the mean of the tensions at its ends.
pub fn tension(line: &Line, state: &LineState, i: usize, negative_tension: bool) -> f64 {
    if let Some(view) = BeamView::of(line, state) {
        return view.tension(i);
    }
    if let Some(closed_form) = &state.closed_form {
        return 0.5 * (closed_form.tension[i] + closed_form.tension[i + 1]);
    }
    let stretching = stretching(line, state, i);
    match ViscoelasticSegment::of(line, state, i) {
        Some(viscoelastic) => viscoelastic.tension(stretching, line.compression_max(i), negative_tension),
        None => segment_tension(line, i, stretching, negative_tension),
    }
}

/// Strain of segment `i`, and its rate as the integrator takes it.
fn stretching(line: &Line, state: &LineState, i: usize) -> Stretching {
    let (chord, memory) = (state.position[i + 1] - state.position[i], &state.half_step);
    if memory.tension[0].is_empty() || memory.steps[1] == 0.0 {
        let [low, high] = [i, i + 1].map(|node| velocity_of_stretching(line, state, node));
        return Stretching::of(line, i, chord, high - low);
    }
    let velocities = [&memory.velocity, &memory.velocity_before].map(|of| of[i + 1] - of[i]);
    let unstretched = line.segments.length[i];
    Stretching {
        strain: chord.norm() / unstretched - 1.0,
        rate: implicit_rate(chord, velocities, memory.steps) / unstretched,
    }
}

/// Velocity of a node [m/s] that gives the rate of strain of its segments.
///
/// With the explicit leapfrog, the velocity of an end is extrapolated from half steps like those of the nodes. The velocity of its point differs from
/// that by O(Δt²), which a stiff damper on a short segment would turn into a false tension.
fn velocity_of_stretching(line: &Line, state: &LineState, node: usize) -> Vector3<f64> {
    let memory = &state.half_step;
    let is_end = node == 0 || node == line.segment_count();
    if !is_end || memory.is_unset() || line.winch.is_some() {
        return state.velocity[node];
    }
    let [last, before] = [memory.velocity[node], memory.velocity_before[node]];
    last + Step::after(memory.steps, memory.steps[0]).extrapolation * (last - before)
}

/// Rate of a segment's length [m/s] as the axial-implicit leapfrog takes it: the mean of the velocities along the segment at t_n, of which the
/// coming one is extrapolated. While the segment turns, these differ by ± κ/Δt from the rates r of its length (`leapfrog/axial_implicit.rs`), and the
/// lengths that the scheme finds compensate for that. With a the velocity of a step along the segment at the end of that step,
///
///   rate = r + ½ (2 (r − r₋) − (a − a₋)).
fn implicit_rate(chord: Vector3<f64>, [last, earlier]: [Vector3<f64>; 2], steps: [f64; 2]) -> f64 {
    let before = chord - steps[0] * last;
    let first = before - steps[1] * earlier;
    let rates = |start: Vector3<f64>, end: Vector3<f64>, velocity: Vector3<f64>| {
        let lengths = [start.norm(), end.norm()];
        let along = |direction: Vector3<f64>, length: f64| match length > 0.0 {
            true => direction.dot(&velocity) / length,
            false => 0.0,
        };
        [
            along(start + end, lengths[0] + lengths[1]),
            along(end, lengths[1]),
        ]
    };
    let [now, then] = [rates(before, chord, last), rates(first, before, earlier)];
    now[0] + Step::after(steps, steps[0]).extrapolation * (2.0 * (now[0] - then[0]) - (now[1] - then[1]))
}

/// Inertia force of the material transport at a winch, divided by −λq [N]: m ℓ̇² + M ℓ̈.
fn transport_force(line: &Line, winch_state: WinchState) -> f64 {
    let (node, nodes) = (line.segment_count(), &line.nodes);
    let density = nodes.mass[node] / nodes.length[node]; // [kg/m]
    density * winch_state.rate.powi(2) + nodes.mass_tangent[node] * winch_state.acceleration
}

/// An end of a line, with everything on which its force depends.
#[derive(Debug, Clone, Copy)]
pub struct LineEnd<'a> {
    /// The line.
    pub line: &'a Line,
    /// State of the line.
    pub state: &'a LineState,
    /// The end.
    pub end: End,
    /// State of the point at the end.
    pub point: &'a PointState,
    /// Water along the line.
    pub water: WaterAlong<'a>,
    /// Moments on the ends of the line [N m].
    pub moments: [Vector3<f64>; 2],
    /// Whether slack segments of the line carry negative tension.
    pub negative_tension: bool,
}

impl<'a> LineEnd<'a> {
    /// Force [N] of the line on the point.
    pub fn force(&self) -> Vector3<f64> {
        let is_linear = self.line.linear_load[self.end as usize];
        let of_line = self.without_half_node(self.point);
        of_line.unwrap_or_else(|| HalfNode::new(*self).force(is_linear))
    }

    /// Force [N] of the end node on its point as lumped-mass codes report it: pull of the end segment, and weight, drag and contact of the half
    /// node, all lumped at the node, without inertia. Beams and closed-form catenaries have no such node and use [`LineEnd::force`].
    pub fn nodal_force(&self) -> Vector3<f64> {
        let of_line = self.without_half_node(self.point);
        of_line.unwrap_or_else(|| {
            let point = &self.point.without_acceleration();
            HalfNode::new(LineEnd { point, ..*self }).force(false)
        })
    }

    /// Mass matrix [kg] of the line at this end, −∂F/∂a of [`LineEnd::force`] at the current positions and velocities.
    ///
    /// With a uniform load over the half node, it is the mass M(t) of the half node, including added mass. With a load that is linear to the next node,
    /// it is ⅔ M(t₀), where t₀ is the tangent at the end: F contains ⅔ of the load at the end, and the rest is that of the next node, whose acceleration
    /// is a state of the line. The share of the linear load is taken as constant. The force of a beam is linear in a, so that its mass follows from unit
    /// accelerations. The mass of a closed-form catenary and of a released end is zero.
    pub fn mass(&self) -> Matrix3<f64> {
        let still = self.point.without_acceleration();
        if let Some(force) = self.without_half_node(&still) {
            return Matrix3::from_columns(&[Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| {
                let moved = PointState {
                    acceleration: axis,
                    ..still
                };
                force - self.without_half_node(&moved).unwrap_or(force)
            }));
        }
        HalfNode::new(*self).mass(self.line.linear_load[self.end as usize])
    }

    /// Force [N] at an end that has no half node, of a released end, a beam or a closed-form catenary, with its point in a state.
    fn without_half_node(&self, point: &PointState) -> Option<Vector3<f64>> {
        if self.state.released[self.end as usize] {
            return Some(Vector3::zeros());
        }
        if let Some(view) = BeamView::of(self.line, self.state) {
            return Some(view.end_action(self.end, point).0);
        }
        let closed_form = self.state.closed_form.as_ref()?;
        Some(closed_form.end_force[self.end as usize])
    }
}

struct HalfNode<'a> {
    at: LineEnd<'a>,
    node: usize,
    /// Velocity of the water at the end [m/s].
    flow: Vector3<f64>,
    dry: Dry,
}

impl<'a> HalfNode<'a> {
    fn new(at: LineEnd<'a>) -> HalfNode<'a> {
        let (node, position) = (at.line.end_node(at.end), &at.state.position);
        let surface = at.line.surface.as_ref();
        HalfNode {
            at,
            node,
            flow: at.water.velocity(node, position[node].z),
            dry: surface.map_or(Dry::default(), |surface| {
                surface.node_in(at.water, node, position)
            }),
        }
    }

    /// Force on the point [N], with a load that is linear to the next node, or uniform over the half node.
    fn force(&self, is_linear: bool) -> Vector3<f64> {
        let LineEnd { line, state, end, .. } = self.at;
        let (node, nodes) = (self.node, &line.nodes);
        let (chord, inward, pull) = self.pull();
        let load = match is_linear {
            true => self.linear_load([inward, pull]),
            false => self.load(inward, self.dry.part)[0],
        };
        let mut force = pull + load;
        if let (Some(winch_state), End::B) = (state.winch_state, end) {
            force -= transport_force(line, winch_state) * chord / line.segments.length[node - 1];
        }
        force.z -= nodes.weight[node] + self.dry.weight;
        if let Some(contact) = &nodes.contact {
            let velocity = |i: usize| {
                if i == node {
                    self.at.point.velocity
                } else {
                    state.velocity[i]
                }
            };
            force += contact.push(node, &state.position, velocity);
        }
        force
    }

    /// Segment at the end, and its chord from the end to the next node [m].
    fn chord(&self) -> (usize, Vector3<f64>) {
        let position = &self.at.state.position;
        let (segment, other) = match self.at.end {
            End::A => (0, 1),
            End::B => (self.node - 1, self.node - 1),
        };
        (segment, position[other] - position[self.node])
    }

    /// Chord from the end to the next node [m], its direction [-], and the pull of the end segment including shear [N].
    fn pull(&self) -> (Vector3<f64>, Vector3<f64>, Vector3<f64>) {
        let (segment, chord) = self.chord();
        let inward = chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        (chord, inward, self.along(segment, inward))
    }

    /// Mass matrix [kg] that multiplies the acceleration of the end in the force, see [`LineEnd::mass`].
    fn mass(&self, is_linear: bool) -> Matrix3<f64> {
        let (_, inward, pull) = self.pull();
        let masses = Slender::new(self.at.line.nodes.masses(self.node, self.dry.part));
        let uniform = masses.matrix(inward);
        if !is_linear {
            return uniform;
        }
        let (_, share, tangent) = self.linear_part([inward, pull]);
        uniform + share * (masses.matrix(tangent) * (2.0 / 3.0) - uniform)
    }

    /// Tension of a segment in its direction, and its shear force on its node towards this end [N].
    fn along(&self, segment: usize, direction: Vector3<f64>) -> Vector3<f64> {
        let LineEnd { line, state, .. } = self.at;
        let pull = tension(line, state, segment, self.at.negative_tension) * direction;
        if line.bending.is_none() {
            return pull;
        }
        let nodes = [&*state.position, &*state.velocity];
        let at = (self.at.end, self.at.point);
        pull + shear(line, nodes, segment, at, self.at.moments)
    }

    /// Velocity of the material at the end [m/s], which on a winch is that of the line as it passes.
    fn velocity(&self) -> Vector3<f64> {
        let LineEnd {
            line,
            state,
            end,
            point,
            ..
        } = self.at;
        match (state.winch_state, end) {
            (Some(winch_state), End::B) => {
                let (segment, chord) = self.chord();
                point.velocity + winch_state.rate / line.segments.length[segment] * chord
            }
            _ => point.velocity,
        }
    }

    /// Load without weight and seabed [N] of a half node of which a fraction `dry` [-] is out of the water: inertia, water and mass damping. The
    /// second vector is the drag alone.
    fn load(&self, inward: Vector3<f64>, dry: f64) -> [Vector3<f64>; 2] {
        let (nodes, node) = (&self.at.line.nodes, self.node);
        let (velocity, acceleration) = (self.velocity(), self.at.point.acceleration);
        let mut load = -Slender::new(nodes.masses(node, dry)).times(acceleration, inward);
        let drag = self.drag(velocity - self.flow, inward, dry);
        load += drag;
        if let (Some(froude_krylov), Some(waves)) = (&nodes.froude_krylov, &self.at.water.waves) {
            load += (1.0 - dry) * froude_krylov.force(node, waves.at(node).acceleration, inward);
        }
        if let Some(damping) = &nodes.mass_damping {
            load -= damping[node] * velocity;
        }
        [load, drag]
    }

    /// Load without weight and seabed [N] of a half node, with the scaled correction for a linear load; the pull of its segment
    /// is `pull` [N], in the direction `inward`.
    fn linear_load(&self, [inward, pull]: [Vector3<f64>; 2]) -> Vector3<f64> {
        let (linear, share, _) = self.linear_part([inward, pull]);
        if share == 1.0 {
            return linear;
        }
        let [uniform, _] = self.load(inward, self.dry.part);
        uniform + share * (linear - uniform)
    }

    /// Load that is linear to the next node [N], its share in the load of the half node [-], and the tangent at the end [-].
    fn linear_part(&self, [inward, pull]: [Vector3<f64>; 2]) -> (Vector3<f64>, f64, Vector3<f64>) {
        let LineEnd { line, state, .. } = self.at;
        let [next, after] = match self.at.end {
            End::A => [1, 2],
            End::B => [self.node - 1, self.node - 2],
        };
        let nodes = &line.nodes;
        let chord = state.position[after] - state.position[next];
        let onward = chord.try_normalize(0.0).unwrap_or(inward);
        let segment = next.min(after);
        let passed_on = self.along(segment, onward);
        let tangents = [3.0 * inward - onward, inward, inward + onward]
            .map(|along| along.try_normalize(0.0).unwrap_or(inward));
        let [own, drag] = self.load(tangents[0], self.dry.part);
        let mut borne = nodes.weight[next] * Vector3::z();
        if let Some(contact) = &nodes.contact {
            borne -= contact.push(next, &state.position, |i| state.velocity[i]);
        }
        let share = nodes.length[self.node] / nodes.length[next];
        let mut at_surface = 1.0;
        if let Some(surface) = &line.surface {
            let dry = surface.node_in(self.at.water, next, &state.position);
            borne.z += dry.weight;
            let lack = (share * dry.weight - self.dry.weight).abs();
            let jump = (self.load(tangents[0], dry.part)[0] - own).norm() + lack;
            let square = own.norm_squared();
            at_surface = square / (square + ABRUPT * jump * jump).max(f64::MIN_POSITIVE);
        }
        let change = share * (pull - passed_on + borne) - own;
        let ratio = own.norm_squared() / change.norm_squared().max(f64::MIN_POSITIVE);
        let bulge = self.bulge(next, tangents, drag);
        let linear = own + change / 3.0 + bulge;
        (linear, at_surface * ratio.powi(2).min(1.0), tangents[0])
    }

    /// Correction for quadratic drag [N]: ⅔ of the difference between the drag in the middle of the last element and the mean of its ends. `tangents` are
    /// those at the end, in the middle and at the `next` node; `end` is the drag at the end [N].
    fn bulge(&self, next: usize, tangents: [Vector3<f64>; 3], end: Vector3<f64>) -> Vector3<f64> {
        let state = self.at.state;
        let flow = self.at.water.velocity(next, state.position[next].z);
        let (past, last) = (self.at.point.velocity - self.flow, state.velocity[next] - flow);
        let [half_way, next] = [(1, 0.5 * (past + last)), (2, last)]
            .map(|(place, velocity)| self.drag(velocity, tangents[place], self.dry.part));
        (2.0 * half_way - end - next) / 3.0
    }

    /// Drag of the half node [N] at a velocity [m/s] relative to the water, with a fraction `dry` [-] out of the water.
    fn drag(&self, velocity: Vector3<f64>, tangent: Vector3<f64>, dry: f64) -> Vector3<f64> {
        let Some(drag) = &self.at.line.nodes.drag else {
            return Vector3::zeros();
        };
        morison::drag(drag.at(self.node).times(1.0 - dry), velocity, tangent)
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::draft::draft;
    use crate::model::Model;

    const LENGTH: f64 = 100.0;
    const STIFFNESS: f64 = 1e6;
    const MASS: f64 = 10.0;
    const STRAIN: f64 = 0.01;

    /// Weightless line along x whose first section has a mass of `other` [kg/m].
    fn model(elements: usize, other: f64) -> Model {
        let (half, each) = (0.5 * LENGTH, elements / 2);
        let like = format!("weight = 0.0, axial_stiffness = {STIFFNESS}, axial_damping = 0.0");
        let sections = [("other", half, Some(each)), ("rope", half, Some(each))];
        draft(format!(
            "line_types.rope = {{ mass = {MASS}, {like} }}
            line_types.other = {{ mass = {other}, {like} }}"
        ))
        .fixed("a", [0.0; 3])
        .coupled("b", [LENGTH, 0.0, 0.0])
        .sections("line", ["a", "b"], &sections)
        .model()
    }

    /// State of the line at the turning point of a harmonic axial motion of end B, u = U sin(ks)/sin(kL), where all velocities are zero.
    fn turning(elements: usize, wave_number: f64) -> (LineState, PointState) {
        let u = |s: f64| (wave_number * s).sin() / (wave_number * LENGTH).sin();
        let place = |i: usize| {
            let s = LENGTH * i as f64 / elements as f64;
            Vector3::x() * ((1.0 + STRAIN) * s + u(s))
        };
        let nodes: Vec<_> = (0..=elements).map(place).collect();
        let mut point = PointState::at_rest(nodes[elements]);
        point.acceleration.x = -wave_number.powi(2) * STIFFNESS / MASS; // −ω²U
        (LineState::at_rest(nodes), point)
    }

    fn pull(model: &Model, state: &LineState, point: &PointState) -> Vector3<f64> {
        let end = LineEnd {
            line: &model.lines[0],
            state,
            end: End::B,
            point,
            water: WaterAlong::default(),
            moments: [Vector3::zeros(); 2],
            negative_tension: false,
        };
        -end.force()
    }

    #[test]
    fn the_error_of_the_force_on_the_end_of_a_swinging_rope_falls_with_the_cube_of_the_elements() {
        let k = 1.0 / LENGTH;
        let slope = k / (k * LENGTH).tan(); // u'
        for n in [8, 16, 32, 64] {
            let (state, point) = turning(n, k);
            let error = pull(&model(n, MASS), &state, &point).x - STIFFNESS * (STRAIN + slope);
            let phase = k * LENGTH / n as f64;
            // −⅙ phase² with a uniform load
            assert!(
                error.abs() < 0.25 * STIFFNESS * slope * phase.powi(3),
                "{error} N"
            );
        }
    }

    #[test]
    fn beside_another_section_and_beside_a_jerk_the_load_is_taken_as_it_is_at_the_end() {
        let k = 1.0 / LENGTH;
        let (mut state, point) = turning(2, k);
        let stretch = |state: &LineState| (state.position[2] - state.position[1]).norm();
        let half_node = |state: &LineState, n: f64| {
            let strain = stretch(state) * n / LENGTH - 1.0;
            STIFFNESS * strain + MASS * 0.5 * LENGTH / n * point.acceleration.x
        };
        let found = pull(&model(2, 2.0 * MASS), &state, &point).x;
        assert_relative_eq!(found, half_node(&state, 2.0), max_relative = 1e-12);
        state.position[1].x -= 0.05 * LENGTH;
        let found = pull(&model(2, MASS), &state, &point).x;
        let load = MASS * 0.25 * LENGTH * point.acceleration.x.abs();
        assert!((found - half_node(&state, 2.0)).abs() < 0.01 * load);
    }

    #[test]
    fn an_end_at_rest_feels_the_tension_of_its_element_and_half_of_its_weight() {
        let (state, mut point) = turning(8, 1.0 / LENGTH);
        point.acceleration = Vector3::zeros();
        let model = model(8, MASS);
        let tension = tension(&model.lines[0], &state, 7, false);
        let force = pull(&model, &state, &point);
        assert_relative_eq!(force, tension * Vector3::x(), max_relative = 1e-12);
    }
}
