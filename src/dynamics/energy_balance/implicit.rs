//! External work, dissipation and algorithmic dissipation of a step of an implicit integrator.
//!
//! The scheme moves a network from r to r' with the forces F = (1 − α_f) f(t') + α_f f(t), which do the work F·(r' − r).
//! The work of each force is evaluated in this form. The work of the inertia (1 − α_m) M'a' + (α_m − α_f) M'a + α_f M a is
//! the change of kinetic energy, except for
//!
//!   ¼ (v'ᵀ(M' − M)v' + vᵀ(M' − M)v),   due to masses that turn with their line or enter the water, and
//!   (r' − r)·inertia − ½ (v + v')·½(M + M')(v' − v),   the dissipation of the scheme.
//!
//! On each joint, and each weight that changes, the scheme dissipates (½ − α_f)(s' − s)·(r' − r), with the resistance s:
//! the difference between the work of the weighted forces and that of their mean. The tension of segments is the
//! discrete gradient of their energy instead of that mean ([`crate::physics::stretch_step`]): its work is stored or
//! dissipated exactly, and (½ − α_f)(N' q' − N q)·(d' − d) is algorithmic dissipation. Summed over a linear system without
//! external work, these terms are not negative; with external work they may have either sign. The difference between the
//! work of the mean force and the stored energy, on joints and at the water surface, is the error of the integration.
//!
//! Source: the discrete balance of Newmark's approximations, as in Krenk (2006), Comput. Methods Appl. Mech. Eng. 195, 6110-6124.

use nalgebra::Vector3;

use super::super::implicit::Scheme;
use super::{Flow, dry_part, tangent};
use crate::dynamics::reaction::tension;
use crate::elements::friction::{resting_node, resting_point};
use crate::elements::{
    Workspace, end_moment, end_moment_power, joint_damping_power, rates, shear, stretch_step, stretched,
};
use crate::model::{End, FreePoint, Line, LineState, Model, Network, State, WaterAlong, joint};
use crate::physics::fading_damper::FadingContact;
use crate::physics::morison::drag;
use crate::physics::slender::Slender;

/// Completed step of an implicit integrator.
#[derive(Clone, Copy)]
pub struct Passed<'a> {
    /// States before and after the step.
    pub states: [&'a State; 2],
    /// Times of the states [s].
    pub times: [f64; 2],
    /// Scheme of the step.
    pub scheme: &'a Scheme,
    /// Workspace of the step; it holds the penetration ranges over which the dampers of the seabed fade in.
    pub work: &'a Workspace,
}

/// Energy flow across the boundary of a network in a step [J].
pub fn flow(model: &Model, network: &Network, passed: &Passed) -> Flow {
    let alpha_f = passed.scheme.alpha_f;
    let mut flow = Flow::default();
    for (side, weight) in [alpha_f, 1.0 - alpha_f].into_iter().enumerate() {
        if weight == 0.0 {
            continue;
        }
        let side = Side {
            model,
            passed,
            state: passed.states[side],
            t: passed.times[side],
            friction: if side == 0 { 0.0 } else { 1.0 / weight },
        };
        flow.add(side.power(network).times(weight * passed.length()));
    }
    for &line in &network.lines {
        flow.add(passed.inertia(model, line));
        flow.add(passed.stretching(model, line));
        flow.algorithmic_dissipation += passed.weight_and_joint_dissipation(model, line);
    }
    for &point in &network.free_points {
        flow.add(passed.point_inertia(model, point));
    }
    flow
}

/// A network at one end of a step.
struct Side<'a> {
    model: &'a Model,
    passed: &'a Passed<'a>,
    state: &'a State,
    t: f64,
    /// Weight of friction relative to that of the other forces [-].
    friction: f64,
}

impl Passed<'_> {
    fn length(&self) -> f64 {
        self.times[1] - self.times[0]
    }

    /// State with the waves at both times: the state before the step is a copy of the network alone.
    fn sea(&self) -> &State {
        self.states[1]
    }

    /// Mean velocity of a node of a line over the step [m/s].
    fn velocity_mean(&self, line: usize, node: usize) -> Vector3<f64> {
        let [before, after] = self.states.map(|state| state.lines[line].position[node]);
        (after - before) / self.length()
    }

    fn point_velocity_mean(&self, point: usize) -> Vector3<f64> {
        let [before, after] = self.states.map(|state| state.points[point].position);
        (after - before) / self.length()
    }

    /// Mean angular velocity of a prescribed point over the step [rad/s].
    fn spin_mean(&self, point: usize) -> Vector3<f64> {
        let [before, after] = self.states.map(|state| state.points[point].orientation);
        (after * before.inverse()).scaled_axis() / self.length()
    }

    /// Energy due to changing masses of a line, as negative dissipation, and algorithmic dissipation of its inertia [J].
    fn inertia(&self, model: &Model, index: usize) -> Flow {
        let line = &model.lines[index];
        let shapes = self.states.map(|state| &state.lines[index]);
        let held = [End::A, End::B].map(|end| line.is_held(model, shapes[1], end));
        let waters = self.times.map(|t| model.water_along(self.sea(), index, t));
        let mut flow = Flow::default();
        for i in usize::from(held[0])..=line.segment_count() - usize::from(held[1]) {
            let masses = [0, 1].map(|side| Mass::of(line, shapes[side], i, waters[side]));
            let [v, a] = [
                shapes.map(|shape| shape.velocity[i]),
                shapes.map(|shape| shape.acceleration[i]),
            ];
            flow.add(self.inertia_of(masses, v, a, self.velocity_mean(index, i)));
        }
        flow
    }

    /// The same for a free point, including the algorithmic dissipation of its weight.
    fn point_inertia(&self, model: &Model, point: usize) -> Flow {
        let Some(free) = model.points[point].free() else {
            return Flow::default();
        };
        let mass = |side: usize| {
            let waves = self.sea().waves_at_point(point, self.times[side]);
            let surface = waves.map_or(0.0, |orbit| orbit.elevation);
            free.at(self.states[side].points[point].position.z - surface).mass
        };
        let masses = [0, 1].map(|side| Mass(Slender::new([mass(side); 2]), Vector3::zeros()));
        let points = self.states.map(|state| &state.points[point]);
        let [v, a] = [
            points.map(|point| point.velocity),
            points.map(|point| point.acceleration),
        ];
        let mut flow = self.inertia_of(masses, v, a, self.point_velocity_mean(point));
        let heights = points.map(|point| point.position.z);
        let weights = heights.map(|z| free.at(z).weight);
        flow.algorithmic_dissipation += self.beyond_mean(weights) * (heights[1] - heights[0]);
        flow
    }

    /// Energy due to a changing mass, as negative dissipation, and algorithmic dissipation of its inertia [J], from velocities
    /// [m/s] and accelerations [m/s²] before and after the step, and the mean velocity over the step [m/s].
    fn inertia_of(
        &self,
        [old, new]: [Mass; 2],
        [v0, v1]: [Vector3<f64>; 2],
        [a0, a1]: [Vector3<f64>; 2],
        mean: Vector3<f64>,
    ) -> Flow {
        let Scheme { alpha_m, alpha_f, .. } = *self.scheme;
        let changed = |v: &Vector3<f64>| v.dot(&(new.times(v) - old.times(v)));
        let inertia =
            new.times(&((1.0 - alpha_m) * a1 + (alpha_m - alpha_f) * a0)) + alpha_f * old.times(&a0);
        let change = v1 - v0;
        let gained = 0.25 * (v0 + v1).dot(&(old.times(&change) + new.times(&change)));
        Flow {
            external_work: 0.0,
            dissipation: -0.25 * (changed(&v0) + changed(&v1)),
            algorithmic_dissipation: self.length() * mean.dot(&inertia) - gained,
        }
    }

    /// Difference between the weighted value of the scheme and the mean of the values before and after the step.
    fn beyond_mean(&self, [old, new]: [f64; 2]) -> f64 {
        (0.5 - self.scheme.alpha_f) * (new - old)
    }

    /// Work of the prescribed ends of a line on its springs, dissipation of its segments, and algorithmic dissipation on the
    /// springs [J].
    fn stretching(&self, model: &Model, index: usize) -> Flow {
        let line = &model.lines[index];
        let shapes = self.states.map(|state| &state.lines[index]);
        let n = line.segment_count();
        let [a, b] = [End::A, End::B].map(|end| line.is_held(model, shapes[1], end));
        let way = |node: usize| shapes[1].position[node] - shapes[0].position[node];
        let mut flow = Flow::default();
        for i in 0..n {
            let (ends, step) = stretch_step(line, shapes, i, self.length());
            let change = ends[1].force() - ends[0].force();
            let beyond = (0.5 - self.scheme.alpha_f) * change;
            let stretched = way(i + 1) - way(i);
            flow.algorithmic_dissipation += beyond.dot(&stretched);
            flow.dissipation += step.mean.taken * line.segments.length[i];
            let force = step.force() + beyond;
            if i == 0 && a {
                flow.external_work -= force.dot(&way(0));
            }
            if i + 1 == n && b {
                flow.external_work += force.dot(&way(n));
            }
        }
        flow
    }

    /// Algorithmic dissipation on the joints of a line, and on the buoyancy lost out of the water [J].
    fn weight_and_joint_dissipation(&self, model: &Model, index: usize) -> f64 {
        let line = &model.lines[index];
        let shapes = self.states.map(|state| &state.lines[index]);
        let way = |i: usize| shapes[1].position[i] - shapes[0].position[i];
        let mut sum = 0.0;
        if let Some(surface) = &line.surface {
            for i in 0..=line.segment_count() {
                let weights = shapes.map(|shape| surface.node(i, &shape.position).weight);
                sum += self.beyond_mean(weights) * way(i).z;
            }
        }
        sum + self.joint_dissipation(line, index)
    }

    /// Algorithmic dissipation on the joints of a line; zero unless the line bends [J].
    fn joint_dissipation(&self, line: &Line, index: usize) -> f64 {
        let Some(bending) = &line.bending else {
            return 0.0;
        };
        let shapes = self.states.map(|state| &state.lines[index].position);
        let clamps = self.states.map(|state| line.clamps(&state.points));
        let (last, way) = (line.segment_count(), |i| shapes[1][i] - shapes[0][i]);
        let mut sum = 0.0;
        for i in (0..=last).filter(|&i| bending.joint[i] > 0.0) {
            let turned = rates(i, last, way);
            let works = [0, 1].map(|side| {
                let turn = joint(clamps[side], shapes[side], i);
                turn.map_or(0.0, |turn| {
                    let [first, second] = turn.energy(bending.joint[i], bending.rest[i]).slope;
                    first.dot(&turned[0]) + second.dot(&turned[1])
                })
            });
            sum += self.beyond_mean(works);
        }
        for (end, point) in [End::A, End::B].into_iter().zip(line.ends) {
            let turned = self.length() * self.spin_mean(point);
            let works = [0, 1].map(|side| {
                let at = &self.states[side].points[point];
                0.0 - end_moment(line, [shapes[side], &[]], end, at).dot(&turned)
            });
            sum += self.beyond_mean(works);
        }
        sum
    }
}

#[derive(Clone, Copy)]
struct Mass(Slender<f64>, Vector3<f64>);

impl Mass {
    fn of(line: &Line, shape: &LineState, i: usize, water: WaterAlong) -> Mass {
        let masses = line.nodes.masses(i, dry_part(line, shape, i, water));
        Mass(Slender::new(masses), tangent(shape, i))
    }

    fn times(&self, v: &Vector3<f64>) -> Vector3<f64> {
        self.0.times(*v, self.1)
    }
}

impl Side<'_> {
    /// Power of the forces at this end on the mean velocities of the step [W].
    fn power(&self, network: &Network) -> Flow {
        let mut flow = Flow::default();
        for &index in &network.lines {
            let water = self.model.water_along(self.passed.sea(), index, self.t);
            flow.add(self.line_power(index, water));
            if self.model.lines[index].bending.is_some() {
                flow.add(self.bending_power(index));
            }
        }
        for &point in &network.free_points {
            let load = self.model.points[point].load_about(self.t, self.passed.length());
            flow.external_work += load.dot(&self.passed.point_velocity_mean(point));
            if let Some(free) = self.model.points[point].free() {
                flow.add(self.point_power(free, point));
            }
        }
        flow
    }

    fn line_power(&self, index: usize, water: WaterAlong) -> Flow {
        let (model, line, shape) = (self.model, &self.model.lines[index], &self.state.lines[index]);
        let (n, negative) = (line.segment_count(), model.solver.negative_tension);
        let after = &self.passed.states[1].lines[index];
        let [a, b] = [End::A, End::B].map(|end| line.is_held(model, after, end));
        let mut flow = Flow::default();
        let damped = if shape.viscoelastic.is_empty() { n } else { 0 }; // `stretching` includes the dissipation of viscoelastic dampers
        for i in 0..damped {
            let segment = stretched(line, shape, i);
            let damping = tension(line, shape, i, negative) - segment.spring.tension;
            let force = damping * segment.direction;
            let [low, high] = [i, i + 1].map(|node| self.passed.velocity_mean(index, node));
            flow.dissipation += force.dot(&(high - low));
            if i == 0 && a {
                flow.external_work -= force.dot(&low);
            }
            if i + 1 == n && b {
                flow.external_work += force.dot(&high);
            }
        }
        for i in usize::from(a)..=n - usize::from(b) {
            flow.add(self.node_power(index, i, water));
        }
        flow.external_work += self.surface_power(index, [a, b], water);
        flow
    }

    /// Power dissipated by water, mass damping and seabed at a node, and power of the moving water on it [W].
    fn node_power(&self, index: usize, i: usize, water: WaterAlong) -> Flow {
        let (line, shape) = (&self.model.lines[index], &self.state.lines[index]);
        let (nodes, velocity, mean) = (
            &line.nodes,
            shape.velocity[i],
            self.passed.velocity_mean(index, i),
        );
        let mut flow = Flow::default();
        let wet = 1.0 - dry_part(line, shape, i, water);
        if let Some(coefficients) = &nodes.drag {
            let k = coefficients.at(i);
            let past = match water.is_still() {
                true => Vector3::zeros(),
                false => water.velocity(i, shape.position[i].z),
            };
            let force = drag(k.times(wet), velocity - past, tangent(shape, i));
            flow.external_work += force.dot(&past);
            flow.dissipation -= force.dot(&(mean - past));
        }
        if let (Some(froude_krylov), Some(waves)) = (&nodes.froude_krylov, &water.waves) {
            let force = froude_krylov.force(i, waves.at(i).acceleration, tangent(shape, i));
            flow.external_work += wet * force.dot(&mean);
        }
        if let Some(damping) = &nodes.mass_damping {
            flow.dissipation += damping[i] * velocity.dot(&mean);
        }
        let reach = &self.passed.work.lines[index].reach[..];
        if let Some(node) = resting_node(line, shape, i, Some(reach)) {
            let push = node.push();
            let force = push.force + (self.friction - 1.0) * push.friction;
            flow.dissipation -= force.dot(&mean);
        }
        flow
    }

    /// Power of the prescribed ends due to buoyancy lost in still water, and power of the additional buoyancy in waves on the
    /// other nodes [W].
    fn surface_power(&self, index: usize, held: [bool; 2], water: WaterAlong) -> f64 {
        let (line, shape) = (&self.model.lines[index], &self.state.lines[index]);
        let Some(surface) = &line.surface else {
            return 0.0;
        };
        let n = line.segment_count();
        let rise = |i: usize| self.passed.velocity_mean(index, i).z;
        let calm = |i: usize| surface.node(i, &shape.position).weight;
        let ends = [0, n].into_iter().zip(held).filter(|(_, held)| *held);
        let mut power: f64 = ends.map(|(i, _)| calm(i) * rise(i)).sum();
        if water.waves.is_some() {
            for i in usize::from(held[0])..=n - usize::from(held[1]) {
                let now = surface.node_in(water, i, &shape.position);
                power += (calm(i) - now.weight) * rise(i);
            }
        }
        power
    }

    /// Power of shear and clamp moments at prescribed ends, of the moments on the ends, and of the joint dampers [W].
    fn bending_power(&self, index: usize) -> Flow {
        let (model, line) = (self.model, &self.model.lines[index]);
        let shape = &self.state.lines[index];
        let moments = model.end_moments(line, self.t);
        let given = |(end, point): (End, usize)| {
            let at = &self.state.points[point];
            match model.points[point].free() {
                Some(_) => 0.0,
                None => {
                    let motion = [&shape.position[..], &shape.velocity];
                    let node = line.end_node(end);
                    let segment = node.min(line.segment_count() - 1);
                    let shear = shear(line, motion, segment, (end, at), moments);
                    let moment = end_moment(line, motion, end, at);
                    let mean = self.passed.velocity_mean(index, node);
                    -shear.dot(&mean) - moment.dot(&self.passed.spin_mean(point))
                }
            }
        };
        let passing = |node| self.passed.velocity_mean(index, node);
        let turning = line.ends.map(|point| self.passed.spin_mean(point));
        let ends = [End::A, End::B].into_iter().zip(line.ends);
        Flow {
            external_work: ends.map(given).sum::<f64>() + end_moment_power(&shape.position, moments, passing),
            dissipation: joint_damping_power(line, shape, &self.state.points, passing, turning),
            algorithmic_dissipation: 0.0,
        }
    }

    /// Power of the moving water on a free point, and power dissipated by water and seabed there [W].
    fn point_power(&self, free: &FreePoint, point: usize) -> Flow {
        let (model, state) = (self.model, &self.state.points[point]);
        let (z, velocity, mean) = (
            state.position.z,
            state.velocity,
            self.passed.point_velocity_mean(point),
        );
        let stream = model.stream(self.t);
        let mut water = stream.map_or(Vector3::zeros(), |stream| stream.velocity(z));
        let (mut at, mut flow) = (free.at(z), Flow::default());
        if let Some(orbit) = &self.passed.sea().waves_at_point(point, self.t) {
            let still = at.weight;
            at = free.at(z - orbit.elevation);
            water += orbit.velocity;
            flow.external_work += free.froude_krylov(at.wetted, orbit).dot(&mean);
            flow.external_work += (still - at.weight) * mean.z;
        }
        let drag = free.drag(at.wetted, velocity - water);
        flow.external_work += drag.dot(&water);
        flow.dissipation -= drag.dot(&(mean - water));
        let reach = self.passed.work.points[point].reach;
        if let Some(seabed) = model.seabed.as_deref() {
            let push = resting_point(free, seabed, state, Some(reach));
            let push = push.map(|point| point.push());
            let force = push.map(|push| push.force + (self.friction - 1.0) * push.friction);
            flow.dissipation -= force.map_or(0.0, |force| force.dot(&mean));
        } else if let Some(contact) = &free.contact {
            let (k, penetration) = (contact.coefficients, contact.level - z);
            let seabed = FadingContact::new(k, penetration, velocity.z, reach);
            flow.dissipation -= seabed.map_or(0.0, |seabed| seabed.force) * mean.z;
        }
        flow
    }
}
