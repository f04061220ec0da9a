//! The energy ledger: what a network holds, what it was given, and what it lost.
//!
//! Held:  E = Σ ½ vᵀM v + Σ EA·W(ε)·L + Σ ½B(|κb| − k₀)² + Σ w z + Σ C  over free nodes, segments that carry force, joints, free
//!        points and segments out of the water, C being the energy of the buoyancy that these lack, by kind in [`Energy`].
//! Given: the work of the held ends on the line, −∫ (T q + S)·V + M·Ω dt with the shear S of lines that bend and the moment M on
//!        clamps that turn, of point loads, and of moments on the ends of lines that bend; the work Σ f·u dt of the drag f on the way of the water u; the work of the water that
//!        waves accelerate, and of the buoyancy by which a wave exceeds the still water at a free point.
//! Lost:  drag at the velocity through the water, axial, bending and mass damping, and what the seabed takes (its springs give
//!        some of it back). The added mass of a free point or node that dips into the water brings ½ v² of what joins it, which counts
//!        as a negative loss; so does ½ vᵀṀv of nodes whose added mass differs along and across the line, which turns.
//!
//! A held end that jumps, at a communication point, gives what the line has more afterwards, all else being where it was: no time passes, and no damper moves.
//!
//! The springs of viscoelastic segments count as held, what their dampers take as lost. An end that parts from a held point brings the energy of
//! its half node along, which counts as given.
//!
//! Dissipated: what an implicit integrator takes by its own damping, found from how it weighs the forces of a step and those of the past, by
//! a formula for each of them that knows nothing of the balance. What it makes or loses beside that, where joints turn and surfaces are pierced within a
//! step, is no part of it; segments are moved by the discrete gradient of their energy, which makes and loses nothing.
//!
//! E − E₀ − given + lost + dissipated is the error of the time integration.
//!
//! The leapfrogs sum the flows of every internal step, forces at t_n times the mean of the velocities around it; energy is then
//! exact at t − Δt/2, where the velocities live, and so E is taken there. The implicit integrators book the work of the forces by which
//! they make a step ([`passed`]), and so do beams, whose laws are discrete gradients. Quasi-static networks hold no kinetic energy; the work of ends and
//! loads is that of the mean of the forces before and after a step (`at_rest`). Where they are closed-form catenaries, the whole of
//! these counts, held ends included:
//!
//! ∫ T²/(2EA) ds and ∫ w z ds, exact where the line hangs.
//!
//! Source: the discrete energy balance of the leapfrog, e.g. Hairer, Lubich & Wanner (2003), Acta Numerica 12, section 1.

mod at_rest;
pub mod passed;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::beam::{self, BeamView};
use super::creep::Creeping;
use crate::model::{End, Line, LineState, Model, Network, Reel, State, Surface, WaterAlong, joint};
use crate::physics::slender::Slender;

pub use at_rest::work_at_rest;

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

    /// The sum of all kinds but motion [J].
    pub fn at_rest(&self) -> f64 {
        self.total() - self.kinetic
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
        sum.add(match &state.lines[line].closed_form {
            Some(closed_form) => Energy {
                axial: closed_form.axial_energy,
                gravitational: closed_form.gravitational_energy,
                ..Energy::default()
            },
            None => line_energy(model, state, line, &state.lines[line]),
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
    let shape = &state.lines[network.lines[0]];
    (!shape.half_step.is_unset()).then(|| shape.velocities_before().1)
}

/// Energy held by a line of this shape in the sea of a state.
fn line_energy(model: &Model, state: &State, index: usize, shape: &LineState) -> Energy {
    let line = &model.lines[index];
    if let Some(view) = BeamView::of(line, shape) {
        return view.energy(beam::held(model, line));
    }
    let water = model.water_along(state, index, state.time);
    let (velocity, lag) = shape.velocities_before();
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
    let n = line.segment_count();
    let mut energy = Energy::default();
    for i in 0..n {
        let strain = (position(i + 1) - position(i)).norm() / line.segments.length[i] - 1.0;
        energy.axial += match Creeping::at_velocities(line, shape, i) {
            None => line.spring(i, strain).energy * line.segments.length[i],
            Some(creep) => creep.energy(strain) * line.segments.length[i],
        };
    }
    let free = |i: usize| match i {
        0 => !line.is_held(model, shape, End::A),
        i if i == n => !line.is_held(model, shape, End::B),
        _ => true,
    };
    for i in (0..=n).filter(|&i| free(i)) {
        energy.kinetic += node_motion(line, shape, i, velocity[i], water);
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

/// Energy [J] that a leapfrog's line gets from held ends that jump to `ends`, positions [m] and velocities [m/s] at the time of the other
/// velocities, while its nodes stay where they are. `moved` is room for its shape.
pub fn jump_energy(
    model: &Model,
    state: &State,
    index: usize,
    ends: [[Vector3<f64>; 2]; 2],
    moved: &mut LineState,
) -> f64 {
    let (line, shape) = (&model.lines[index], &state.lines[index]);
    let ((velocities, lag), last) = (shape.velocities_before(), shape.position.len() - 1);
    let places = [0, last].map(|i| [shape.position[i], velocities[i]]);
    let is_held = |end: End| line.is_held(model, shape, end);
    if (0..2).all(|side| places[side] == ends[side] || !is_held([End::A, End::B][side])) {
        return 0.0;
    }
    moved.clone_from(shape);
    for ((end, i), [position, velocity]) in [(End::A, 0), (End::B, last)].into_iter().zip(ends) {
        if !is_held(end) {
            continue;
        }
        moved.position[i] = position;
        if lag > 0.0 {
            moved.half_step.velocity[i] = velocity;
        }
    }
    if let Some(reel) = shape.reel.filter(|_| lag > 0.0) {
        let then = line_before(line, moved, reel, lag);
        let passing = passing(&then, moved, lag) / lag;
        moved.half_step.velocity[last] -= passing;
    }
    let shapes = [&*moved, shape];
    let [after, before] = shapes.map(|shape| line_energy(model, state, index, shape).total());
    after - before
}

/// Energy of the buoyancy that a line lacks whose nodes are at `position` [m] [J].
fn lacking_energy(surface: &Surface, position: &[Vector3<f64>]) -> f64 {
    let segments = position.windows(2).enumerate();
    let energy =
        |(i, ends): (usize, &[Vector3<f64>])| surface.energy(i, [0, 1].map(|end| surface.height(&ends[end])));
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

/// Energy of motion of a node at a velocity [m/s], with what it carries along across and along the line [J].
fn node_motion(line: &Line, shape: &LineState, i: usize, velocity: Vector3<f64>, water: WaterAlong) -> f64 {
    let masses = line.nodes.masses(i, dry_part(line, shape, i, water));
    0.5 * Slender::new(masses).square(velocity, tangent(shape, i))
}

/// Part of a node that is out of the water [-].
fn dry_part(line: &Line, shape: &LineState, i: usize, water: WaterAlong) -> f64 {
    let surface = line.surface.as_ref();
    surface.map_or(0.0, |surface| surface.node_in(water, i, &shape.position).part)
}

/// How many ends of a network's lines have parted from their points.
pub fn parted_ends(network: &Network, state: &State) -> usize {
    let ends = network.lines.iter().flat_map(|&line| state.lines[line].parted);
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

/// Energy of motion and of weight of the half node at an end, at the time its velocity belongs to [J].
fn end_energy(model: &Model, state: &State, index: usize, end: End) -> f64 {
    let (line, shape) = (&model.lines[index], &state.lines[index]);
    let water = model.water_along(state, index, state.time);
    let ((velocity, lag), i) = (shape.velocities_before(), line.end_node(end));
    let velocity = velocity[i];
    node_motion(line, shape, i, velocity, water)
        + line.nodes.weight[i] * (shape.position[i].z - lag * velocity.z)
}

/// Direction of a line at a node [-]: none where its neighbours coincide.
fn tangent(shape: &LineState, i: usize) -> Vector3<f64> {
    let last = shape.position.len() - 1;
    let chord = shape.position[(i + 1).min(last)] - shape.position[i.saturating_sub(1)];
    chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros)
}
