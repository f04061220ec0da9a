//! Leapfrog with the axial tension implicit: the axial wave no longer limits the step.
//!
//! With geometry q = d/l lagged at t_n and G(x)_i = (x_{i+1} − x_i)/L_i, the tension that drives v_{n−½} -> v_{n+½} is
//!
//! T̄ = [T^{n+1} + (2ρ+b)T^n + (ρ²+2ρb)T^{n−1} + ρ²b T^{n−2}]/N,  b = (1−ρ)/(2ρ),  N = (1+ρ)²(1+b),
//!
//! second order and unconditionally stable with spectral radius ρ at infinite frequency (ρ = 1: ¼, ½, ¼). The new strain is
//! linear in the new velocity, ε^{n+1} = ε^n + κ + Δt q·G(v), κ = Δt²(|G(v⁻)|² − (q·G(v⁻))²)/(2|G(r)|), so that
//!
//! T̄ − k q·G(v) = EA b₁(ε^n + κ) + H + ½BA(1−θ) q·G(v⁻),  k = EA b₁Δt + ½BA(1+θ),  b₁ = 1/N,
//!
//! with the history terms H and θ = 0.2. A row is off where the total would be negative. Eliminating v by the nodes'
//! momentum leaves one scalar tridiagonal system in T̄. Drag is trapezoidal and folded into the node's mass, the seabed
//! too; flags of slack and contact are checked after the solve and the step repeated until they hold.
//!
//! Source: Stern & Grinspun (2009), Implicit-explicit variational integration of highly oscillatory problems, Multiscale
//! Model. Simul. 7, 1779-1794, with controllable dissipation added. The limit left is transverse:
//! [`super::limit::transverse_step`].

use nalgebra::{Matrix3, Vector3};

use super::leapfrog::Step;
use crate::model::{End, Line, LineState};
use crate::physics::stretch::StretchLaw;

/// Passes over slack and contact flags, at most [-].
const PASSES_MAX: usize = 8;
/// Weight of the new strain rate over the old one in the axial damping [-].
const DAMPING_SHIFT: f64 = 0.2; // θ
/// Change of tension by the true stretch, relative to the greatest tension, that asks for another pass [-].
const STRETCH_TOLERANCE: f64 = 1e-3;

/// Weights of T^{n+1}, T^n, T^{n−1}, T^{n−2} in T̄.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights([f64; 4]);

impl Weights {
    /// For the spectral radius ρ [-] at infinite frequency, 0 < ρ ≤ 1.
    pub fn new(rho: f64) -> Weights {
        let b = (1.0 - rho) / (2.0 * rho);
        let n = (1.0 + rho) * (1.0 + rho) * (1.0 + b);
        Weights([1.0, 2.0 * rho + b, rho * (rho + 2.0 * b), rho * rho * b].map(|weight| weight / n))
    }
}

/// A line and its scratch for this integrator.
#[derive(Debug, Clone)]
pub struct AxialWork {
    weights: Weights,
    negative_tension: bool,
    position: Vec<Vector3<f64>>,
    velocity: Vec<Vector3<f64>>,
    velocity_before: Vec<Vector3<f64>>,
    /// Elastic tensions at t_n, t_{n−1}, t_{n−2} [N].
    tension: [Vec<f64>; 3],
    segments: Vec<SegmentWork>,
    nodes: Vec<NodeWork>,
    rows: Rows,
}

/// What a step knows of a segment before it is solved.
#[derive(Debug, Clone, Copy)]
struct SegmentWork {
    /// Unit vector along the segment.
    direction: Vector3<f64>,
    /// EA·b₁·slope and BA, over the unstretched length [N/m, N s/m].
    stiffness: f64,
    damping: f64,
    /// Part of T̄ known beforehand, elastic and total [N].
    elastic: f64,
    known: f64,
    /// Δε of the transverse motion times EA·b₁ [N], replaced by the true one in later passes.
    curvature: f64,
    taut: bool,
}

/// What a step knows of a node.
#[derive(Debug, Clone, Copy)]
struct NodeWork {
    /// Inverse mass with drag folded in, without and with contact [1/kg].
    dry: Matrix3<f64>,
    inverse: Matrix3<f64>,
    /// Velocity without tension, without and with contact [m/s].
    fall: Vector3<f64>,
    loose: Vector3<f64>,
    touches: bool,
}

/// The tridiagonal system in T̄.
#[derive(Debug, Clone)]
struct Rows {
    lower: Vec<f64>,
    diagonal: Vec<f64>,
    upper: Vec<f64>,
    tension: Vec<f64>,
}

impl AxialWork {
    /// Scratch for a line.
    pub fn new(line: &Line, rho: f64, negative_tension: bool) -> AxialWork {
        let n = line.segment_count();
        let zero = Vector3::zeros();
        let segment = SegmentWork {
            direction: zero,
            stiffness: 0.0,
            damping: 0.0,
            elastic: 0.0,
            known: 0.0,
            curvature: 0.0,
            taut: true,
        };
        let still = Matrix3::zeros();
        let node = NodeWork {
            dry: still,
            inverse: still,
            fall: zero,
            loose: zero,
            touches: false,
        };
        AxialWork {
            weights: Weights::new(rho),
            negative_tension,
            position: vec![zero; n + 1],
            velocity: vec![zero; n + 1],
            velocity_before: vec![zero; n + 1],
            tension: [vec![0.0; n], vec![0.0; n], vec![0.0; n]],
            segments: vec![segment; n],
            nodes: vec![node; n + 1],
            rows: Rows {
                lower: vec![0.0; n],
                diagonal: vec![0.0; n],
                upper: vec![0.0; n],
                tension: vec![0.0; n],
            },
        }
    }

    /// Takes over the state of a line.
    pub fn load(&mut self, line: &Line, state: &LineState) {
        let memory = &state.half_step;
        self.position.copy_from_slice(&state.position);
        if memory.velocity.is_empty() {
            self.velocity.copy_from_slice(&state.velocity);
            self.velocity_before.copy_from_slice(&state.velocity);
        } else {
            self.velocity.copy_from_slice(&memory.velocity);
            self.velocity_before
                .copy_from_slice(&memory.velocity_before);
        }
        if memory.tension[0].is_empty() {
            for i in 0..self.segments.len() {
                let tension = self.elastic_tension(line, i);
                self.tension
                    .iter_mut()
                    .for_each(|history| history[i] = tension);
            }
        } else {
            self.tension
                .iter_mut()
                .zip(&memory.tension)
                .for_each(|(own, kept)| own.copy_from_slice(kept));
        }
    }

    /// Hands the state back, with velocities extrapolated to the time of the positions.
    pub fn store(&self, state: &mut LineState, steps: [f64; 2]) {
        let extrapolation = Step::after(steps, steps[0]).extrapolation;
        state.position.copy_from_slice(&self.position);
        let pairs = self.velocity.iter().zip(&self.velocity_before);
        for (velocity, (now, before)) in state.velocity.iter_mut().zip(pairs) {
            *velocity = now + extrapolation * (now - before);
        }
        let memory = &mut state.half_step;
        memory.steps = steps;
        memory.velocity.clone_from(&self.velocity);
        memory.velocity_before.clone_from(&self.velocity_before);
        memory
            .tension
            .iter_mut()
            .zip(&self.tension)
            .for_each(|(kept, own)| kept.clone_from(own));
    }

    /// Puts an end where it is at the time of the positions.
    pub fn put_end(&mut self, end: End, position: Vector3<f64>, velocity: Vector3<f64>) {
        let node = match end {
            End::A => 0,
            End::B => self.segments.len(),
        };
        self.position[node] = position;
        self.velocity[node] = velocity;
    }

    /// One step; `ends` are the positions [m] of both ends at its end. Returns the passes it took.
    pub fn step(&mut self, line: &Line, step: Step, ends: [Vector3<f64>; 2]) -> usize {
        self.prepare_segments(line, step);
        self.prepare_nodes(line, step, ends);
        let mut passes = 1;
        while !self.solve(line, step) && passes < PASSES_MAX {
            passes += 1;
        }
        self.finish(line, step, ends);
        passes
    }

    /// EA·N(ε), never negative [N].
    fn elastic_tension(&self, line: &Line, i: usize) -> f64 {
        let segments = &line.segments;
        let strain = (self.position[i + 1] - self.position[i]).norm() / segments.length[i] - 1.0;
        (segments.axial_stiffness[i] * segments.law[i].at(strain).force).max(0.0)
    }

    fn prepare_segments(&mut self, line: &Line, step: Step) {
        let Weights([b1, h0, h1, h2]) = self.weights;
        let [now, last, before] = &self.tension;
        let data = &line.segments;
        for (i, segment) in self.segments.iter_mut().enumerate() {
            let length = data.length[i];
            let chord = self.position[i + 1] - self.position[i];
            let l = chord.norm();
            let direction = if l > 0.0 { chord / l } else { Vector3::zeros() };
            let rate = (self.velocity[i + 1] - self.velocity[i]) / length; // G(v⁻) [1/s]
            let along = direction.dot(&rate);
            let stretch = l / length;
            let (force, slope) = match data.law[i] {
                StretchLaw::Engineering => (stretch - 1.0, 1.0),
                law => {
                    let at = law.at(stretch - 1.0);
                    (at.force, at.slope)
                }
            };
            let ea = b1 * data.axial_stiffness[i];
            let bend = rate.norm_squared() - along * along;
            segment.curvature = if l > 0.0 {
                0.5 * ea * slope * step.drift * step.drift * bend / stretch
            } else {
                0.0
            };
            let history = h0 * now[i] + h1 * last[i] + h2 * before[i];
            let damping = 0.5 * data.axial_damping[i];
            segment.elastic = ea * force + history;
            segment.known = segment.elastic + damping * (1.0 - DAMPING_SHIFT) * along;
            segment.stiffness = ea * slope * step.drift / length;
            segment.damping = damping * (1.0 + DAMPING_SHIFT) / length;
            segment.direction = direction;
            segment.taut = segment.known + segment.curvature > 0.0;
        }
    }

    fn prepare_nodes(&mut self, line: &Line, step: Step, ends: [Vector3<f64>; 2]) {
        let n = self.segments.len();
        for (node, end) in [0, n].into_iter().zip(ends) {
            let secant = (end - self.position[node]) / step.drift;
            let zero = Matrix3::zeros();
            self.nodes[node] = NodeWork {
                dry: zero,
                inverse: zero,
                fall: secant,
                loose: secant,
                touches: false,
            };
        }
        for i in 1..n {
            let (dry, fall) = self.free_node(line, step, i);
            let touches = self.touches(line, step, i, self.velocity[i].z);
            self.nodes[i] = NodeWork {
                dry,
                inverse: dry,
                fall,
                loose: fall,
                touches,
            };
            self.settle_node(line, step, i);
        }
    }

    /// Inverse mass with trapezoidal drag, and velocity without tension and contact.
    fn free_node(&self, line: &Line, step: Step, i: usize) -> (Matrix3<f64>, Vector3<f64>) {
        let nodes = &line.nodes;
        let (kick, velocity) = (step.kick, self.velocity[i]);
        let chord = self.position[i + 1] - self.position[i - 1];
        let tangent = chord.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let (mut mass_normal, mut mass_tangent) = (nodes.mass_normal[i], nodes.mass_tangent[i]);
        let mut impulse = -kick * nodes.weight[i] * Vector3::z();
        if let Some(drag) = &nodes.drag {
            let now = velocity + step.extrapolation * (velocity - self.velocity_before[i]);
            let speed_along = now.dot(&tangent);
            let speed_across = (now - speed_along * tangent).norm();
            let (normal, along) = (
                drag.normal[i] * speed_across,
                drag.tangent[i] * speed_along.abs(),
            );
            mass_normal += 0.5 * kick * normal;
            mass_tangent += 0.5 * kick * along;
            impulse -=
                kick * (normal * velocity + (along - normal) * velocity.dot(&tangent) * tangent);
        }
        if let Some(damping) = &nodes.mass_damping {
            mass_normal += 0.5 * kick * damping[i];
            mass_tangent += 0.5 * kick * damping[i];
            impulse -= kick * damping[i] * velocity;
        }
        let (normal, along) = (1.0 / mass_normal, 1.0 / mass_tangent);
        let inverse = Matrix3::from_diagonal_element(normal)
            + (along - normal) * tangent * tangent.transpose();
        (inverse, velocity + inverse * impulse)
    }

    /// Whether the bed pushes a node that moves at `rise` [m/s]: it would be below the bed, and not leave it faster
    /// than the damper lets go.
    fn touches(&self, line: &Line, step: Step, i: usize, rise: f64) -> bool {
        line.nodes.contact.as_ref().is_some_and(|contact| {
            let penetration = contact.bed - self.position[i].z;
            let next = penetration - step.drift * rise;
            let damper = (next - penetration.max(0.0)) / step.drift;
            next > 0.0 && contact.stiffness[i] * next + contact.damping[i] * damper > 0.0
        })
    }

    /// Adds the bed to a node that touches it: a rank-one update of the inverse mass.
    fn settle_node(&mut self, line: &Line, step: Step, i: usize) {
        let node = &mut self.nodes[i];
        (node.inverse, node.loose) = (node.dry, node.fall);
        let Some(contact) = line.nodes.contact.as_ref().filter(|_| node.touches) else {
            return;
        };
        let penetration = contact.bed - self.position[i].z;
        let (stiffness, damping) = (contact.stiffness[i], contact.damping[i]);
        let landing = damping / step.drift * penetration.min(0.0); // the damper acts below the bed only
        let resistance = step.kick * (stiffness * step.drift + damping);
        let response = node.dry.column(2).into_owned();
        let share = 1.0 / (1.0 + resistance * response.z);
        node.inverse -= response * response.transpose() * (resistance * share);
        let impulse = step.kick * (stiffness * penetration + landing) - resistance * node.fall.z;
        node.loose += response * (impulse * share);
    }

    /// Solves for T̄ and the new velocities; false if a flag changed and the step must be solved again.
    fn solve(&mut self, line: &Line, step: Step) -> bool {
        self.assemble_rows(step);
        self.rows.solve();
        let n = self.segments.len();
        let mut settled = true;
        for i in 1..n {
            let pull = self.rows.tension[i] * self.segments[i].direction
                - self.rows.tension[i - 1] * self.segments[i - 1].direction;
            let velocity = self.nodes[i].loose + step.kick * (self.nodes[i].inverse * pull);
            if line.nodes.contact.is_some() {
                let touches = self.touches(line, step, i, velocity.z);
                if touches != self.nodes[i].touches {
                    self.nodes[i].touches = touches;
                    self.settle_node(line, step, i);
                    settled = false;
                }
            }
            self.velocity_before[i] = velocity;
        }
        self.velocity_before[0] = self.nodes[0].loose;
        self.velocity_before[n] = self.nodes[n].loose;
        self.check_segments(line, step) && settled
    }

    fn assemble_rows(&mut self, step: Step) {
        let n = self.segments.len();
        let (nodes, segments, rows) = (&self.nodes, &self.segments, &mut self.rows);
        for i in 0..n {
            let segment = &segments[i];
            let stretches = segment.taut || self.negative_tension;
            if !stretches {
                (
                    rows.lower[i],
                    rows.diagonal[i],
                    rows.upper[i],
                    rows.tension[i],
                ) = (0.0, 1.0, 0.0, 0.0);
                continue;
            }
            let elastic = if segment.taut { segment.stiffness } else { 0.0 };
            let k = (elastic + segment.damping) * step.kick;
            let q = segment.direction;
            let (low, high) = (nodes[i].inverse * q, nodes[i + 1].inverse * q);
            rows.diagonal[i] = 1.0 + k * q.dot(&(low + high));
            rows.lower[i] = if i > 0 {
                -k * low.dot(&segments[i - 1].direction)
            } else {
                0.0
            };
            rows.upper[i] = if i + 1 < n {
                -k * high.dot(&segments[i + 1].direction)
            } else {
                0.0
            };
            let stretching = q.dot(&(nodes[i + 1].loose - nodes[i].loose));
            let known = if segment.taut {
                segment.known + segment.curvature
            } else {
                segment.known - segment.elastic
            };
            rows.tension[i] = known + (elastic + segment.damping) * stretching;
        }
    }

    /// Updates slack flags and the true stretch; false if either asks for another pass.
    fn check_segments(&mut self, line: &Line, step: Step) -> bool {
        let mut settled = true;
        let greatest = self
            .rows
            .tension
            .iter()
            .fold(0.0_f64, |greatest, tension| greatest.max(*tension));
        let b1 = self.weights.0[0];
        for (i, segment) in self.segments.iter_mut().enumerate() {
            let rate = self.velocity_before[i + 1] - self.velocity_before[i];
            let along = segment.direction.dot(&rate);
            let elastic = segment.stiffness * along + segment.curvature;
            let total = segment.known + elastic + segment.damping * along;
            let taut = if self.negative_tension {
                segment.elastic + elastic > 0.0
            } else {
                total > 0.0
            };
            if taut != segment.taut {
                segment.taut = taut;
                settled = false;
            }
            if !taut {
                continue;
            }
            let chord = self.position[i + 1] - self.position[i];
            let moved = chord + step.drift * rate;
            let (l0, l1) = (chord.norm(), moved.norm());
            let stretching = step.drift * rate.dot(&(chord + moved)) / (l0 + l1); // l1 − l0
            let transverse = stretching - step.drift * along;
            let stiffness = b1 * line.segments.axial_stiffness[i] / line.segments.length[i];
            let curvature = stiffness * transverse;
            if (curvature - segment.curvature).abs() > STRETCH_TOLERANCE * greatest {
                segment.curvature = curvature;
                settled = false;
            }
        }
        settled
    }

    /// Moves the nodes and shifts the histories; `velocity_before` holds the new velocities.
    fn finish(&mut self, line: &Line, step: Step, ends: [Vector3<f64>; 2]) {
        std::mem::swap(&mut self.velocity, &mut self.velocity_before);
        for (position, velocity) in self.position.iter_mut().zip(&self.velocity) {
            *position += step.drift * velocity;
        }
        let n = self.segments.len();
        (self.position[0], self.position[n]) = (ends[0], ends[1]);
        self.tension.rotate_right(1);
        for i in 0..n {
            self.tension[0][i] = self.elastic_tension(line, i);
        }
    }

    /// Greatest tension [N] of the last step.
    pub fn tension_max(&self) -> f64 {
        self.rows
            .tension
            .iter()
            .fold(0.0, |greatest, tension| greatest.max(*tension))
    }

    /// Index of the first node whose position or velocity is not finite.
    pub fn broken_node(&self) -> Option<usize> {
        let nodes = self.position.iter().zip(&self.velocity);
        nodes
            .map(|(r, v)| r + v)
            .position(|sum| !sum.iter().all(|value| value.is_finite()))
    }
}

impl Rows {
    /// Thomas's elimination; the matrix is diagonally dominant, so that no pivoting is needed.
    fn solve(&mut self) {
        let n = self.diagonal.len();
        for i in 1..n {
            let factor = self.lower[i] / self.diagonal[i - 1];
            self.diagonal[i] -= factor * self.upper[i - 1];
            self.tension[i] -= factor * self.tension[i - 1];
        }
        self.tension[n - 1] /= self.diagonal[n - 1];
        for i in (0..n - 1).rev() {
            self.tension[i] =
                (self.tension[i] - self.upper[i] * self.tension[i + 1]) / self.diagonal[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_weights_sum_to_one_and_are_centred_at_the_present() {
        for rho in [0.5, 0.9, 1.0] {
            let Weights([new, now, last, before]) = Weights::new(rho);
            assert_relative_eq!(new + now + last + before, 1.0, max_relative = 1e-15);
            assert_relative_eq!(new - last - 2.0 * before, 0.0, epsilon = 1e-15);
        }
        assert_eq!(Weights::new(1.0), Weights([0.25, 0.5, 0.25, 0.0]));
    }
}
