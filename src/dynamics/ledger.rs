//! The energy ledger: what a network holds, what it was given, and what it lost.
//!
//! Held:  E = Σ ½ vᵀM v + Σ EA·W(ε)·L + Σ ½B(|κb| − k₀)² + Σ w z + Σ C  over free nodes, segments that carry force, joints, free
//!        points and segments out of the water, C being the energy of the buoyancy that these lack, by kind in [`Energy`].
//! Given: the work of the held ends on the line, −∫ (T q + S)·V + M·Ω dt with the shear S of lines that bend and the moment M on
//!        clamps that turn, and of point loads; the work Σ f·u dt of the drag f on the way of the water u; the work of the water that
//!        waves accelerate, and of the buoyancy by which a wave exceeds the still water at a free point.
//! Lost:  drag at the velocity through the water, axial, bending and mass damping, and what the seabed takes (its springs give
//!        some of it back). The added mass of a free point or node that dips into the water brings ½ v² of what joins it, which counts
//!        as a negative loss; so does ½ vᵀṀv of nodes whose added mass differs along and across the line, which turns.
//!
//! The springs of viscoelastic segments count as held, what their dampers take as lost. An end that parts from a held point brings the energy of
//! its half node along, which counts as given.
//!
//! Dissipated: what an implicit integrator takes by its own damping, found from how it weighs the forces of a step and those of the past, by
//! a formula for each of them that knows nothing of the balance. What it makes or loses beside that, where laws have kinks and geometry turns within a
//! step, is no part of it.
//!
//! E − E₀ − given + lost + dissipated is the error of the time integration.
//!
//! The leapfrogs sum the flows of every internal step, forces at t_n times the mean of the velocities around it; energy is then
//! exact at t − Δt/2, where the velocities live, and so E is taken there. The implicit integrators book the work of the forces by which
//! they make a step ([`passed`]). Quasi-static networks hold no kinetic energy; the work of ends and loads is that of the mean of the
//! forces before and after a step. Where they are closed-form catenaries, the whole of these counts, held ends included:
//!
//! ∫ T²/(2EA) ds and ∫ w z ds, exact where the line hangs.
//!
//! Source: the discrete energy balance of the leapfrog, e.g. Hairer, Lubich & Wanner (2003), Acta Numerica 12, section 1.

pub mod passed;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::beam::{self, BeamView};
use super::creep::{Creeping, Stretching};
use super::leapfrog::segment_tension;
use crate::model::{
    ClosedForm, End, Line, LineState, Model, Network, PointState, Reel, State, Surface, WaterAlong,
    joint,
};
use crate::statics::assembly::rubbing::{resting_node, resting_point};
use crate::statics::assembly::{end_moment, end_shear};
use crate::statics::equilibrium::current::drag_at_rest;

/// Energy that crossed the border of a network, or the rate at which it does.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Flow {
    /// Work of held ends and loads [J] or their power [W].
    pub given: f64,
    /// Taken by water, damping and seabed [J] or [W].
    pub lost: f64,
    /// Taken by the damping of the integrator, negative where it brings energy [J] or [W].
    pub numerical: f64,
}

/// Energy held, by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Of motion [J].
    pub kinetic: f64,
    /// Of stretch [J].
    pub axial: f64,
    /// Of bending [J].
    pub bending: f64,
    /// Of shear [J].
    pub shear: f64,
    /// Of torsion [J].
    pub torsion: f64,
    /// Of weight less buoyancy, above z = 0 [J].
    pub gravitational: f64,
}

impl Energy {
    /// The sum of all kinds [J].
    pub fn total(&self) -> f64 {
        self.kinetic + self.axial + self.bending + self.shear + self.torsion + self.gravitational
    }

    /// Adds another energy, kind by kind.
    pub fn add(&mut self, other: Energy) {
        self.kinetic += other.kinetic;
        self.axial += other.axial;
        self.bending += other.bending;
        self.shear += other.shear;
        self.torsion += other.torsion;
        self.gravitational += other.gravitational;
    }
}

/// What a whole model started with, and what has crossed its border since.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// Energy at the start [J].
    pub start: f64,
    /// All that was given and lost [J].
    pub flow: Flow,
}

impl Flow {
    /// Adds another flow.
    pub fn add(&mut self, other: Flow) {
        self.given += other.given;
        self.lost += other.lost;
        self.numerical += other.numerical;
    }

    /// Whether it can be booked: what grew without bound and came back within a step cannot.
    pub fn is_finite(&self) -> bool {
        self.given.is_finite() && self.lost.is_finite() && self.numerical.is_finite()
    }

    /// This flow times a factor.
    pub fn times(self, factor: f64) -> Flow {
        Flow {
            given: factor * self.given,
            lost: factor * self.lost,
            numerical: factor * self.numerical,
        }
    }
}

impl Ledger {
    /// At rest with an energy [J].
    pub fn new(energy: f64) -> Ledger {
        Ledger {
            start: energy,
            flow: Flow::default(),
        }
    }

    /// Imbalance [J] where the model now holds an energy [J].
    pub fn error(&self, held: f64) -> f64 {
        held - self.start - self.flow.given + self.flow.lost + self.flow.numerical
    }
}

/// Energy held by a network, at the time its velocities belong to.
pub fn energy(model: &Model, network: &Network, state: &State) -> Energy {
    let mut sum = Energy::default();
    for &line in &network.lines {
        let (data, shape) = (&model.lines[line], &state.lines[line]);
        sum.add(match &shape.closed_form {
            Some(closed_form) => catenary_energy(data, shape, closed_form),
            None => line_energy(data, state, line, model),
        });
    }
    for &point in &network.free_points {
        let (free, at) = (model.points[point].free(), &state.points[point]);
        let Some(free) = free else { continue };
        let [velocity, _] = at.half_step;
        let (velocity, lag) = match half_step(state, network) {
            Some(lag) => (velocity, lag),
            None => (at.velocity, 0.0),
        };
        let height = at.position.z - lag * velocity.z;
        let waves = state.waves_at_point(point, state.time - lag);
        let over = height - waves.map_or(0.0, |orbit| orbit.elevation);
        sum.kinetic += 0.5 * free.at(over).mass * velocity.norm_squared();
        sum.gravitational += free.potential(height);
    }
    sum
}

/// Time from the velocities to the positions of a network that a leapfrog serves [s].
fn half_step(state: &State, network: &Network) -> Option<f64> {
    let memory = &state.lines[network.lines[0]].half_step;
    (!memory.velocity.is_empty()).then(|| 0.5 * memory.steps[0])
}

fn line_energy(line: &Line, state: &State, index: usize, model: &Model) -> Energy {
    let (shape, water) = (
        &state.lines[index],
        model.water_along(state, index, state.time),
    );
    let memory = &shape.half_step;
    let (velocity, lag) = match memory.velocity.is_empty() {
        true => (&shape.velocity, 0.0),
        false => (&memory.velocity, 0.5 * memory.steps[0]),
    };
    let then = shape.reel.map(|reel| line_before(line, shape, reel, lag));
    let line = then.as_ref().unwrap_or(line);
    let passing = passing(line, shape, lag);
    let position = |i: usize| {
        let place = shape.position[i] - lag * velocity[i];
        if i + 1 == shape.position.len() {
            place - passing
        } else {
            place
        }
    };
    if let Some(view) = BeamView::of(line, shape) {
        return view.energy(beam::held(model, line));
    }
    let n = line.segment_count();
    let mut energy = Energy::default();
    for i in 0..n {
        let strain = (position(i + 1) - position(i)).norm() / line.segments.length[i] - 1.0;
        energy.axial += match Creeping::of(line, shape, i) {
            None => axial_energy(line, i, strain),
            Some(creep) => {
                let pair = |values: &[Vector3<f64>]| [values[i], values[i + 1]];
                let now = Stretching::of(line, i, pair(&shape.position), pair(&shape.velocity));
                creep.energy(strain, now, lag) * line.segments.length[i]
            }
        };
    }
    let free = |i: usize| match i {
        0 => !line.is_held(model, shape, End::A),
        i if i == n => !line.is_held(model, shape, End::B),
        _ => true,
    };
    for i in (0..=n).filter(|&i| free(i)) {
        let [across, along] = squares(shape, i, velocity[i]);
        let [normal, tangent] = line.nodes.masses(i, dry_part(line, shape, i, water));
        energy.kinetic += 0.5 * (normal * across + tangent * along);
        energy.gravitational += line.nodes.weight[i] * position(i).z;
    }
    if let Some(surface) = &line.surface {
        let places: Vec<_> = (0..=n).map(position).collect();
        energy.gravitational += lacking_energy(surface, &places);
    }
    if let Some(bending) = &line.bending {
        let clamps = line.clamps(&state.points);
        energy.bending = (0..=n)
            .filter(|&i| bending.joint[i] > 0.0)
            .filter_map(|i| Some((i, joint(clamps, &shape.position, i)?)))
            .map(|(i, turn)| turn.energy(bending.joint[i], bending.rest[i]).energy)
            .sum();
    }
    energy
}

/// Energy of the buoyancy that a line lacks whose nodes are at `position` [m] [J].
fn lacking_energy(surface: &Surface, position: &[Vector3<f64>]) -> f64 {
    let segments = position.windows(2).enumerate();
    let energy = |(i, ends): (usize, &[Vector3<f64>])| {
        surface.energy(i, [0, 1].map(|end| surface.height(&ends[end])))
    };
    segments.map(energy).sum()
}

/// A line on a winch as it was laid out `lag` [s] ago, when the leapfrog has its velocities.
fn line_before(line: &Line, shape: &LineState, reel: Reel, lag: f64) -> Line {
    let mut then = line.clone();
    if lag > 0.0 {
        then.pay_out(shape.position.len() - 1, reel.half_step[0]);
    }
    then
}

/// How far the material at a winch has gone beyond the winch in `lag` [s], by which its velocity misses the winch's own place [m].
fn passing(line: &Line, shape: &LineState, lag: f64) -> Vector3<f64> {
    let Some(reel) = shape.reel else {
        return Vector3::zeros();
    };
    let last = line.segment_count();
    let chord = shape.position[last] - shape.position[last - 1];
    lag * reel.half_step[1] / line.segments.length[last - 1] * chord
}

/// Squares of a velocity [m/s] of a node across and along the line [m²/s²].
fn squares(shape: &LineState, i: usize, velocity: Vector3<f64>) -> [f64; 2] {
    let along = velocity.dot(&tangent(shape, i));
    [velocity.norm_squared() - along * along, along * along]
}

/// Part of a node that is out of the water [-].
fn dry_part(line: &Line, shape: &LineState, i: usize, water: WaterAlong) -> f64 {
    let surface = line.surface.as_ref();
    surface.map_or(0.0, |surface| {
        surface.node_in(water, i, &shape.position).part
    })
}

/// Energy [J] of a segment at a strain [-]: that of its law while it pulls, and pushes no more than it can.
pub(super) fn axial_energy(line: &Line, i: usize, strain: f64) -> f64 {
    let data = &line.segments;
    let (ea, length, push) = (
        data.axial_stiffness[i],
        data.length[i],
        line.compression_max(i),
    );
    let law = data.law[i].at(strain);
    if strain > 0.0 || ea * law.force > -push {
        ea * law.energy * length
    } else {
        let ea = ea * data.law[i].at(0.0).slope; // the push stops growing by the slope at no strain
        let limit = -push / ea;
        (0.5 * push * push / ea + push * (limit - strain)) * length
    }
}

/// How many ends of a network's lines have parted from their points.
pub fn parted_ends(network: &Network, state: &State) -> usize {
    let ends = network
        .lines
        .iter()
        .flat_map(|&line| state.lines[line].parted);
    ends.filter(|parted| *parted).count()
}

/// Energy [J] that the half nodes bring to their lines which have parted from held points between two states.
pub fn joined_energy(model: &Model, network: &Network, [before, after]: [&State; 2]) -> f64 {
    let mut sum = 0.0;
    for &index in &network.lines {
        let (line, [old, new]) = (
            &model.lines[index],
            [before, after].map(|state| &state.lines[index]),
        );
        for end in [End::A, End::B] {
            if line.is_held(model, old, end) && !line.is_held(model, new, end) {
                sum += end_energy(model, after, index, end);
            }
        }
    }
    sum
}

/// Energy of motion and of weight of the half node at an end [J], when its velocity belongs to.
fn end_energy(model: &Model, state: &State, index: usize, end: End) -> f64 {
    let (line, shape) = (&model.lines[index], &state.lines[index]);
    let water = model.water_along(state, index, state.time);
    let (memory, i) = (&shape.half_step, line.end_node(end));
    let (velocity, lag) = match memory.velocity.is_empty() {
        true => (shape.velocity[i], 0.0),
        false => (memory.velocity[i], 0.5 * memory.steps[0]),
    };
    let [across, along] = squares(shape, i, velocity);
    let [normal, tangent] = line.nodes.masses(i, dry_part(line, shape, i, water));
    0.5 * (normal * across + tangent * along)
        + line.nodes.weight[i] * (shape.position[i].z - lag * velocity.z)
}

/// Energy of a whole line on its closed form.
fn catenary_energy(line: &Line, shape: &LineState, closed_form: &ClosedForm) -> Energy {
    let (segments, n) = (&line.segments, line.segment_count());
    let mut section_end = 0.0;
    let mut ends = line.sections.iter().map(|section| {
        section_end += section.length;
        (section_end, section.weight)
    });
    let (mut end, mut weight) = ends.next().unwrap_or((0.0, 0.0));
    let pull = closed_form.end_force[0];
    let horizontal = pull.xy().norm();
    let mut vertical = pull.z; // upward part of the tension from A to B [N]
    let mut energy = Energy::default();
    for i in 0..n {
        let (h, ea) = (segments.length[i], segments.axial_stiffness[i]);
        while line.nodes.arc[i] + 0.5 * h > end {
            (end, weight) = ends.next().unwrap_or((f64::INFINITY, weight));
        }
        let [low, high] = [i, i + 1].map(|node| {
            let contact = line.nodes.contact.as_ref();
            let height = shape.position[node].z;
            let lies = contact.is_some_and(|contact| height <= contact.bed);
            (height, closed_form.tension[node], lies)
        });
        let rising = (high.1 * high.1 - horizontal * horizontal).max(0.0).sqrt();
        let hanging = match (low.2, high.2) {
            (true, true) => 0.0,
            (true, false) => rising / weight,
            (false, true) => -vertical / weight,
            (false, false) => h,
        };
        let part = Hanging {
            length: if weight == 0.0 {
                0.0
            } else {
                hanging.clamp(0.0, h)
            },
            weight,
            axial_stiffness: ea,
            horizontal,
            vertical: if low.2 { 0.0 } else { vertical },
        };
        let rest = h - part.length;
        let squares = part.squared_tension() + 0.5 * rest * (low.1 * low.1 + high.1 * high.1);
        energy.axial += squares / (2.0 * ea);
        let mean = if weight == 0.0 || low.2 {
            low.0
        } else {
            high.0
        };
        energy.gravitational += weight * (part.height(low.0) + rest * mean);
        vertical = part.vertical + weight * part.length;
    }
    energy
}

/// A piece of an elastic catenary that hangs free.
struct Hanging {
    /// Unstretched length [m].
    length: f64,
    /// Weight [N/m], not 0 unless there is no length.
    weight: f64,
    /// EA [N].
    axial_stiffness: f64,
    /// Horizontal tension [N].
    horizontal: f64,
    /// Upward part of the tension at its start [N].
    vertical: f64,
}

impl Hanging {
    fn end(&self) -> f64 {
        self.vertical + self.weight * self.length
    }

    /// ∫ T² ds [N² m].
    fn squared_tension(&self) -> f64 {
        let (v0, v1) = (self.vertical, self.end());
        self.length * (self.horizontal.powi(2) + (v0 * v0 + v0 * v1 + v1 * v1) / 3.0)
    }

    /// ∫ z ds [m²] from a height [m] at its start: z = z₀ + (T − T₀)/w + (V² − V₀²)/(2 EA w).
    fn height(&self, start: f64) -> f64 {
        if self.length == 0.0 {
            return 0.0;
        }
        let (h, w, v0, v1) = (self.length, self.weight, self.vertical, self.end());
        let tension = |v: f64| self.horizontal.hypot(v);
        let turned = |v: f64| match self.horizontal > 0.0 {
            true => self.horizontal.powi(2) * (v / self.horizontal).asinh(),
            false => 0.0,
        };
        let area = |v: f64| v * tension(v) + turned(v);
        let tensions = (area(v1) - area(v0)) / (2.0 * w); // ∫ T ds
        let squares = h * (v0 * v0 + v0 * v1 + v1 * v1) / 3.0; // ∫ V² ds
        let stretched = (squares - v0 * v0 * h) / (2.0 * self.axial_stiffness * w);
        start * h + (tensions - tension(v0) * h) / w + stretched
    }
}

/// Work given to and lost by a network at rest before and after a step from `t0` to `t1` [s].
pub fn work_at_rest(
    model: &Model,
    network: &Network,
    [before, after]: [&State; 2],
    [t0, t1]: [f64; 2],
) -> Flow {
    let mut flow = Flow::default();
    for &index in &network.lines {
        let line = &model.lines[index];
        for end in [End::A, End::B] {
            let point = line.ends[usize::from(end == End::B)];
            if model.points[point].free().is_some() {
                continue;
            }
            let force =
                |state: &State| force_at_rest(line, &state.lines[index], end, &state.points[point]);
            let moved = after.points[point].position - before.points[point].position;
            flow.given -= 0.5 * (force(before) + force(after)).dot(&moved);
            if line.bending.is_some() {
                flow.given -= clamp_work(line, index, end, [before, after]);
            }
        }
        flow.given += current_work(model, index, [before, after], [t0, t1]);
        let shapes = [before, after].map(|state| &state.lines[index]);
        if let (Some(contact), true) = (
            &line.nodes.contact,
            shapes.iter().any(|shape| shape.closed_form.is_none()),
        ) {
            let level = line.bottom().is_none();
            for i in (1..line.segment_count()).filter(|_| !level) {
                let [low, high] = shapes.map(|shape| {
                    let node = resting_node(line, shape, i, 0.0, 1.0).and_then(|node| node.push());
                    node.map_or(Vector3::zeros(), |push| push.force)
                });
                let moved = shapes[1].position[i] - shapes[0].position[i];
                flow.lost -= 0.5 * (low + high).dot(&moved);
            }
            for i in (1..line.segment_count()).filter(|_| level) {
                let [z0, z1] = shapes.map(|shape| shape.position[i].z);
                let push = |z: f64| contact.stiffness[i] * (contact.level[i] - z).max(0.0);
                flow.lost -= 0.5 * (push(z0) + push(z1)) * (z1 - z0);
            }
        }
    }
    for &point in &network.free_points {
        let loads = model.points[point].load_at(t0) + model.points[point].load_at(t1);
        let moved = after.points[point].position - before.points[point].position;
        flow.given += 0.5 * loads.dot(&moved);
        let (line, _) = model.points[point].attached[0];
        if after.lines[line].closed_form.is_none()
            && let Some(free) = model.points[point].free()
        {
            let push = |state: &State| match model.bottom.as_deref() {
                None => {
                    let spring = free.bed_at_rest(state.points[point].position.z);
                    spring.map_or(Vector3::zeros(), |(_, force)| force * Vector3::z())
                }
                Some(bottom) => {
                    let resting = resting_point(free, bottom, &state.points[point], 0.0, 1.0);
                    let push = resting.and_then(|point| point.push());
                    push.map_or(Vector3::zeros(), |push| push.force)
                }
            };
            flow.lost -= 0.5 * (push(before) + push(after)).dot(&moved);
        }
    }
    flow
}

/// Work [J] of the drag of a current on the nodes of a line that moves from rest to rest.
fn current_work(model: &Model, index: usize, states: [&State; 2], times: [f64; 2]) -> f64 {
    let line = &model.lines[index];
    let (Some(before), Some(after)) = (model.stream(times[0]), model.stream(times[1])) else {
        return 0.0;
    };
    let free = |end: usize| model.points[line.ends[end]].free().is_some();
    let [old, new] = states.map(|state| &state.lines[index].position);
    let first = usize::from(!free(0));
    let last = line.segment_count() - usize::from(!free(1));
    let work = |i: usize| {
        let force = drag_at_rest(line, old, i, before) + drag_at_rest(line, new, i, after);
        0.5 * force.dot(&(new[i] - old[i]))
    };
    (first..=last).map(work).sum()
}

/// Work [J] of a line on the clamp at one of its ends, which turned between two states.
fn clamp_work(line: &Line, index: usize, end: End, states: [&State; 2]) -> f64 {
    let points = states.map(|state| &state.points[line.ends[usize::from(end == End::B)]]);
    let shapes = states.map(|state| &state.lines[index].position);
    let moment = |i: usize| end_moment(line, shapes[i], end, points[i]);
    let turned = points[1].orientation * points[0].orientation.inverse();
    0.5 * (moment(0) + moment(1)).dot(&turned.scaled_axis())
}

/// Force [N] of a line at rest on a held point, without the weight of its own half node, whose energy is not held, unless the line
/// is a closed-form catenary.
fn force_at_rest(line: &Line, shape: &LineState, end: End, point: &PointState) -> Vector3<f64> {
    if let Some(closed_form) = &shape.closed_form {
        return closed_form.end_force[usize::from(end == End::B)];
    }
    let (segment, sign) = match end {
        End::A => (0, 1.0),
        End::B => (line.segment_count() - 1, -1.0),
    };
    let ends = [shape.position[segment], shape.position[segment + 1]];
    let still = [Vector3::zeros(); 2];
    let tension = segment_tension(line, segment, ends, still, false);
    let chord = (ends[1] - ends[0]).try_normalize(0.0);
    let mut force = sign * tension * chord.unwrap_or_else(Vector3::zeros);
    if let Some(surface) = &line.surface {
        force.z -= surface.node(line.end_node(end), &shape.position).weight;
    }
    if line.bending.is_some() {
        force += end_shear(line, [&shape.position, &[]], end, point);
    }
    force
}

fn tangent(shape: &LineState, i: usize) -> Vector3<f64> {
    let last = shape.position.len() - 1;
    let chord = shape.position[(i + 1).min(last)] - shape.position[i.saturating_sub(1)];
    chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_integrals_of_a_hanging_piece_are_those_of_its_shape() {
        for weight in [3.0, -2.0] {
            let piece = Hanging {
                length: 8.0,
                weight,
                axial_stiffness: 400.0,
                horizontal: 5.0,
                vertical: -7.0,
            };
            let count = 200_000;
            let step = piece.length / f64::from(count);
            let (mut height, mut squares, mut heights) = (1.5, 0.0, 0.0);
            for i in 0..count {
                let v = piece.vertical + weight * step * (f64::from(i) + 0.5);
                let tension = piece.horizontal.hypot(v);
                let rise = step * (1.0 + tension / piece.axial_stiffness) * v / tension;
                squares += step * tension * tension;
                heights += step * (height + 0.5 * rise);
                height += rise;
            }
            assert_relative_eq!(piece.squared_tension(), squares, max_relative = 1e-8);
            assert_relative_eq!(piece.height(1.5), heights, max_relative = 1e-8);
        }
    }
}
