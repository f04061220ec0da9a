//! Energy balance of the networks: stored energy, external work, dissipation. It does not change the motion.
//!
//! Stored:  E = Σ ½ vᵀM v + Σ EA·W(ε)·L + Σ ½B(|κb| − k₀)² + Σ w z + Σ C  over free nodes, segments, joints, free points and dry segments, with
//!        C the energy of the buoyancy that dry segments lose; by kind in [`Energy`].
//! External work: of prescribed ends on the line, −∫ (T q + S)·V + M·Ω dt with the shear S of lines that bend and the moment M of clamps that
//!        turn; of point loads and end moments; Σ f·u dt of the drag f in water of velocity u; of the Froude-Krylov force, and of the
//!        difference between the buoyancy under a wave and that in still water.
//! Dissipation: drag at the velocity relative to the water; axial, bending and mass damping; the seabed, whose springs return some of it. Added mass
//!        that enters the water, or turns with its line (½ vᵀṀ v), counts as negative dissipation.
//!
//! The work of a prescribed end that jumps at a communication point is the increase of the stored energy with all other
//! nodes in place: the jump takes no time, and dampers do not act.
//!
//! The springs of viscoelastic segments store energy, and their dampers dissipate it. When an end is released from a prescribed point, the energy of its
//! half node is added as external work.
//!
//! Algorithmic dissipation: dissipation of an implicit integrator, due to its weights of the forces before and after a step. It is evaluated by a
//! formula that is independent of the balance. The tension of segments is the discrete gradient of their energy, which neither produces nor
//! dissipates energy. The error on joints that turn, and at the water surface where it is pierced within a step, is not part of it.
//!
//! E − E₀ − external work + dissipation + algorithmic dissipation is the error of the time integration.
//!
//! In every internal step, the leapfrogs add the work of springs, weight and water on the free nodes: forces at t_n times the mean of the
//! velocities at t_{n−½} and t_{n+½} (`leapfrog/balance`, `axial_implicit/balance`). The part of this work that is not kinetic energy when the balance
//! is evaluated has been dissipated. Energy is exact at t − Δt/2, the time of the velocities, and E is evaluated there. The implicit integrators sum
//! the work of the forces of each step ([`implicit`]), and so do beams, whose laws are discrete gradients. Quasi-static networks have no kinetic
//! energy; the work of ends and loads is that of the mean of the forces before and after a step (`at_rest`). Closed-form catenaries are evaluated as a
//! whole, including the half segments at prescribed ends:
//!
//! ∫ T²/(2EA) ds and ∫ w z ds, exact where the line hangs.
//!
//! Source: the discrete energy balance of the leapfrog, e.g. Hairer, Lubich & Wanner (2003), Acta Numerica 12, section 1.

mod at_rest;
pub mod implicit;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::beam::{self, BeamView};
use super::viscoelastic::ViscoelasticSegment;
use crate::model::{
    End, Line, LineState, Model, Network, State, Surface, WaterAlong, WinchState, joint_of_segments,
};
use crate::physics::bending::Direction;
use crate::physics::slender::Slender;

pub use at_rest::work_at_rest;

/// Energy flow into and out of a network [J], or its rate [W].
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Flow {
    /// Work of prescribed ends, loads and moving water.
    pub external_work: f64,
    /// Dissipation by water, damping and seabed.
    pub dissipation: f64,
    /// Dissipation by the integrator, negative if it produces energy.
    pub algorithmic_dissipation: f64,
}

/// Stored energy, by kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Kinetic energy [J].
    pub kinetic: f64,
    /// Strain energy of stretch [J].
    pub axial: f64,
    /// Strain energy of bending [J].
    pub bending: f64,
    /// Strain energy of shear [J].
    pub shear: f64,
    /// Strain energy of torsion [J].
    pub torsion: f64,
    /// Potential energy of weight less buoyancy, relative to z = 0 [J].
    pub gravitational: f64,
}

impl Energy {
    /// Sum of all kinds [J].
    pub fn total(&self) -> f64 {
        self.kinetic + self.axial + self.bending + self.shear + self.torsion + self.gravitational
    }

    /// Sum of all kinds except kinetic energy [J].
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

/// Energy balance of a model since the start.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyBalance {
    /// Stored energy at the start [J].
    pub start: f64,
    /// Stored energy now [J].
    pub now: f64,
    /// External work and dissipation since the start [J].
    pub flow: Flow,
}

impl Flow {
    /// Adds another flow.
    pub fn add(&mut self, other: Flow) {
        self.external_work += other.external_work;
        self.dissipation += other.dissipation;
        self.algorithmic_dissipation += other.algorithmic_dissipation;
    }

    /// Returns false if the motion grew without bound.
    pub fn is_finite(&self) -> bool {
        self.external_work.is_finite()
            && self.dissipation.is_finite()
            && self.algorithmic_dissipation.is_finite()
    }

    /// Returns this flow times a factor.
    pub fn times(self, factor: f64) -> Flow {
        Flow {
            external_work: factor * self.external_work,
            dissipation: factor * self.dissipation,
            algorithmic_dissipation: factor * self.algorithmic_dissipation,
        }
    }
}

impl EnergyBalance {
    /// Error of the time integration [J], positive if it has produced energy.
    pub fn error(&self) -> f64 {
        let Flow {
            external_work,
            dissipation,
            algorithmic_dissipation,
        } = self.flow;
        self.now - self.start - external_work + dissipation + algorithmic_dissipation
    }
}

/// Stored energy of a network [J], at the time of its velocities.
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

/// Time from the velocities to the positions of a network with a leapfrog [s]; `None` for other integrators.
fn half_step(state: &State, network: &Network) -> Option<f64> {
    let shape = &state.lines[network.lines[0]];
    (!shape.half_step.is_unset()).then(|| shape.velocities_before().1)
}

/// Stored energy of a line with the state `shape` [J], in the waves of `state`.
fn line_energy(model: &Model, state: &State, index: usize, shape: &LineState) -> Energy {
    let line = &model.lines[index];
    if let Some(view) = BeamView::of(line, shape) {
        return view.energy(beam::held(model, line));
    }
    let water = model.water_along(state, index, state.time);
    let (velocity, lag) = shape.velocities_before();
    let then = shape
        .winch_state
        .map(|winch_state| line_before(line, shape, winch_state, lag));
    let line = then.as_ref().unwrap_or(line);
    let transport = material_transport(line, shape, lag);
    let position = |i: usize| {
        let place = shape.position[i] - lag * velocity[i];
        if i + 1 == shape.position.len() {
            place - transport
        } else {
            place
        }
    };
    let n = line.segment_count();
    let mut energy = Energy::default();
    for i in 0..n {
        let strain = (position(i + 1) - position(i)).norm() / line.segments.length[i] - 1.0;
        energy.axial += match ViscoelasticSegment::at_velocities(line, shape, i) {
            None => line.spring(i, strain).energy * line.segments.length[i],
            Some(viscoelastic) => viscoelastic.energy(strain) * line.segments.length[i],
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
        let clamps = line.ends.map(|point| state.points[point].before(lag));
        let clamps = [line.clamp(End::A, &clamps[0]), line.clamp(End::B, &clamps[1])];
        let segment = |i: usize| {
            let chord = position(i + 1) - position(i);
            Direction::new(chord, chord.norm())
        };
        energy.bending = (0..=n)
            .filter(|&i| bending.joint[i] > 0.0)
            .filter_map(|i| Some((i, joint_of_segments(clamps, [i, n], segment)?)))
            .map(|(i, turn)| turn.energy(bending.joint[i], bending.rest[i]).energy)
            .sum();
    }
    energy
}

/// Energy flow into a line of a leapfrog whose prescribed ends jump to `ends` while its other nodes stay in place [J]. `ends` holds positions [m], and
/// velocities [m/s] at the time of the other velocities. The change of kinetic energy due to the rotation of the segments counts as dissipation, as in
/// the energy flow of a leapfrog. `moved` is overwritten with the state of the line after the jump.
pub fn jump_flow(
    model: &Model,
    state: &State,
    index: usize,
    ends: [[Vector3<f64>; 2]; 2],
    moved: &mut LineState,
) -> Flow {
    let (line, shape) = (&model.lines[index], &state.lines[index]);
    let ((velocities, lag), last) = (shape.velocities_before(), shape.position.len() - 1);
    let places = [0, last].map(|i| [shape.position[i], velocities[i]]);
    let is_held = |end: End| line.is_held(model, shape, end);
    if (0..2).all(|side| places[side] == ends[side] || !is_held([End::A, End::B][side])) {
        return Flow::default();
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
    if let Some(winch_state) = shape.winch_state.filter(|_| lag > 0.0) {
        let then = line_before(line, moved, winch_state, lag);
        let transport = material_transport(&then, moved, lag) / lag;
        moved.half_step.velocity[last] -= transport;
    }
    let shapes = [&*moved, shape];
    let [after, before] = shapes.map(|shape| line_energy(model, state, index, shape));
    Flow {
        external_work: after.total() - before.total(),
        dissipation: after.kinetic - before.kinetic,
        algorithmic_dissipation: 0.0,
    }
}

/// Energy of the buoyancy that is missing from the dry parts of a line whose nodes are at `position` [m] [J].
fn lacking_energy(surface: &Surface, position: &[Vector3<f64>]) -> f64 {
    let segments = position.windows(2).enumerate();
    let energy =
        |(i, ends): (usize, &[Vector3<f64>])| surface.energy(i, [0, 1].map(|end| surface.height(&ends[end])));
    segments.map(energy).sum()
}

/// Line on a winch with the length `lag` [s] ago, at the time of the leapfrog's velocities.
fn line_before(line: &Line, shape: &LineState, winch_state: WinchState, lag: f64) -> Line {
    let mut then = line.clone();
    if lag > 0.0 {
        then.pay_out(shape.position.len() - 1, winch_state.half_step[0]);
    }
    then
}

/// Displacement of the material at a winch relative to the winch in `lag` [s], by which a step with the material velocity
/// misses the winch [m].
fn material_transport(line: &Line, shape: &LineState, lag: f64) -> Vector3<f64> {
    let Some(winch_state) = shape.winch_state else {
        return Vector3::zeros();
    };
    let last = line.segment_count();
    let chord = shape.position[last] - shape.position[last - 1];
    lag * winch_state.half_step[1] / line.segments.length[last - 1] * chord
}

/// Kinetic energy of a node with a velocity [m/s], from its masses across and along the line [J].
fn node_motion(line: &Line, shape: &LineState, i: usize, velocity: Vector3<f64>, water: WaterAlong) -> f64 {
    let masses = line.nodes.masses(i, dry_part(line, shape, i, water));
    0.5 * Slender::new(masses).square(velocity, tangent(shape, i))
}

/// Fraction of a node that is out of the water [-].
fn dry_part(line: &Line, shape: &LineState, i: usize, water: WaterAlong) -> f64 {
    let surface = line.surface.as_ref();
    surface.map_or(0.0, |surface| surface.node_in(water, i, &shape.position).part)
}

/// Number of ends of a network's lines that are released from their points.
pub fn released_ends(network: &Network, state: &State) -> usize {
    let ends = network.lines.iter().flat_map(|&line| state.lines[line].released);
    ends.filter(|released| *released).count()
}

/// Energy [J] of the half nodes at ends that were released from prescribed points between two states.
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

/// Kinetic and gravitational energy of the half node at an end, at the time of its velocity [J].
fn end_energy(model: &Model, state: &State, index: usize, end: End) -> f64 {
    let (line, shape) = (&model.lines[index], &state.lines[index]);
    let water = model.water_along(state, index, state.time);
    let ((velocity, lag), i) = (shape.velocities_before(), line.end_node(end));
    let velocity = velocity[i];
    node_motion(line, shape, i, velocity, water)
        + line.nodes.weight[i] * (shape.position[i].z - lag * velocity.z)
}

/// Direction of a line at a node [-], along the chord of its neighbours; zero if they coincide.
fn tangent(shape: &LineState, i: usize) -> Vector3<f64> {
    let last = shape.position.len() - 1;
    let chord = shape.position[(i + 1).min(last)] - shape.position[i.saturating_sub(1)];
    chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros)
}
