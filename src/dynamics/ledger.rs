//! The energy ledger: what a network holds, what it was given, and what it lost.
//!
//! Held:  E = Σ ½ vᵀM v + Σ EA·W(ε)·L + Σ w z  over free nodes, taut segments and free points.
//! Given: the work of the held ends on the line, −∫ T q·V dt, and of point loads.
//! Lost:  drag, axial and mass damping, and what the seabed takes (its springs give some of it back).
//!
//! E − E₀ − given + lost is the error of the time integration: numerical dissipation shows up as a negative one.
//!
//! The leapfrogs sum the flows of every internal step, forces at t_n times the mean of the velocities around it; energy is then
//! exact at t − Δt/2, where the velocities live, and so E is taken there. The implicit integrators use the trapezoidal
//! rule over communication steps. Quasi-static networks have no ledger.
//!
//! Source: the discrete energy balance of the leapfrog, e.g. Hairer, Lubich & Wanner (2003), Acta Numerica 12, section 1.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::beam::{self, BeamView};
use super::leapfrog::segment_tension;
use crate::model::{Line, LineState, Model, Network, State};
use crate::physics::morison::{DragCoefficients, drag};
use crate::physics::seabed::{ContactCoefficients, normal_force};

/// Energy that crossed the border of a network, or the rate at which it does.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Flow {
    /// Work of held ends and loads [J] or their power [W].
    pub given: f64,
    /// Taken by water, damping and seabed [J] or [W].
    pub lost: f64,
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
    }

    /// This flow times a factor.
    pub fn times(self, factor: f64) -> Flow {
        Flow {
            given: factor * self.given,
            lost: factor * self.lost,
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
        held - self.start - self.flow.given + self.flow.lost
    }
}

/// Energy held by a network [J], at the time its velocities belong to.
pub fn energy(model: &Model, network: &Network, state: &State) -> f64 {
    let lines: f64 = network
        .lines
        .iter()
        .map(|&line| line_energy(&model.lines[line], &state.lines[line], model))
        .sum();
    let points: f64 = network
        .free_points
        .iter()
        .map(|&point| {
            let (free, at) = (model.points[point].free(), &state.points[point]);
            let Some(free) = free else { return 0.0 };
            let [velocity, _] = at.half_step;
            let (velocity, lag) = match half_step(state, network) {
                Some(lag) => (velocity, lag),
                None => (at.velocity, 0.0),
            };
            let height = at.position.z - lag * velocity.z;
            0.5 * free.mass * velocity.norm_squared() + free.weight * height
        })
        .sum();
    lines + points
}

/// Time from the velocities to the positions of a network that a leapfrog serves [s].
fn half_step(state: &State, network: &Network) -> Option<f64> {
    let memory = &state.lines[network.lines[0]].half_step;
    (!memory.velocity.is_empty()).then(|| 0.5 * memory.steps[0])
}

fn line_energy(line: &Line, shape: &LineState, model: &Model) -> f64 {
    let memory = &shape.half_step;
    let (velocity, lag) = match memory.velocity.is_empty() {
        true => (&shape.velocity, 0.0),
        false => (&memory.velocity, 0.5 * memory.steps[0]),
    };
    let position = |i: usize| shape.position[i] - lag * velocity[i];
    if let Some(view) = BeamView::of(line, shape) {
        return view.energy(beam::held(model, line)).total();
    }
    let n = line.segment_count();
    let mut energy = 0.0;
    for i in 0..n {
        let data = &line.segments;
        let strain = (position(i + 1) - position(i)).norm() / data.length[i] - 1.0;
        if strain > 0.0 {
            energy += data.axial_stiffness[i] * data.law[i].at(strain).energy * data.length[i];
        }
    }
    let free = |i: usize| match i {
        0 => model.points[line.ends[0]].free().is_some(),
        i if i == n => model.points[line.ends[1]].free().is_some(),
        _ => true,
    };
    for i in (0..=n).filter(|&i| free(i)) {
        let tangent = tangent(shape, i);
        let along = velocity[i].dot(&tangent);
        let across = velocity[i].norm_squared() - along * along;
        let nodes = &line.nodes;
        energy += 0.5 * (nodes.mass_normal[i] * across + nodes.mass_tangent[i] * along * along);
        energy += nodes.weight[i] * position(i).z;
    }
    energy
}

/// Power given to and lost by a network at time `t` [s], in [W], from the velocities at the time of the positions.
pub fn power(model: &Model, network: &Network, state: &State, t: f64) -> Flow {
    let mut flow = Flow::default();
    for &index in &network.lines {
        flow.add(line_power(&model.lines[index], &state.lines[index], model));
    }
    for &point in &network.free_points {
        flow.given += model.points[point]
            .load_at(t)
            .dot(&state.points[point].velocity);
    }
    flow
}

fn line_power(line: &Line, shape: &LineState, model: &Model) -> Flow {
    let (n, negative) = (line.segment_count(), model.solver.negative_tension);
    let mut flow = Flow::default();
    for i in 0..n {
        let pair = |values: &[Vector3<f64>]| [values[i], values[i + 1]];
        let tension = segment_tension(
            line,
            i,
            pair(&shape.position),
            pair(&shape.velocity),
            negative,
        );
        let chord = shape.position[i + 1] - shape.position[i];
        let Some(direction) = chord.try_normalize(0.0) else {
            continue;
        };
        let strain = chord.norm() / line.segments.length[i] - 1.0;
        let elastic = line.segments.axial_stiffness[i] * line.segments.law[i].at(strain).force;
        let stretching = direction.dot(&(shape.velocity[i + 1] - shape.velocity[i]));
        flow.lost += (tension - elastic.max(0.0)) * stretching;
        let end = |node: usize, sign: f64| {
            let held = model.points[line.ends[usize::from(node > 0)]]
                .free()
                .is_none();
            if held {
                sign * tension * direction.dot(&shape.velocity[node])
            } else {
                0.0
            }
        };
        flow.given += if i == 0 { end(0, -1.0) } else { 0.0 };
        flow.given += if i + 1 == n { end(n, 1.0) } else { 0.0 };
    }
    let first = usize::from(model.points[line.ends[0]].free().is_none());
    let last = n - usize::from(model.points[line.ends[1]].free().is_none());
    for i in first..=last {
        flow.lost += node_loss(line, shape, i);
    }
    flow
}

/// Power that water, mass damping and seabed take from a node [W].
fn node_loss(line: &Line, shape: &LineState, i: usize) -> f64 {
    let (nodes, velocity) = (&line.nodes, shape.velocity[i]);
    let mut lost = 0.0;
    if let Some(coefficients) = &nodes.drag {
        let k = DragCoefficients {
            normal: coefficients.normal[i],
            tangent: coefficients.tangent[i],
        };
        lost -= drag(k, velocity, tangent(shape, i)).dot(&velocity);
    }
    if let Some(damping) = &nodes.mass_damping {
        lost += damping[i] * velocity.norm_squared();
    }
    if let Some(contact) = &nodes.contact {
        let k = ContactCoefficients {
            stiffness: contact.stiffness[i],
            damping: contact.damping[i],
        };
        lost -= normal_force(k, contact.level[i] - shape.position[i].z, velocity.z) * velocity.z;
    }
    lost
}

fn tangent(shape: &LineState, i: usize) -> Vector3<f64> {
    let last = shape.position.len() - 1;
    let chord = shape.position[(i + 1).min(last)] - shape.position[i.saturating_sub(1)];
    chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros)
}
