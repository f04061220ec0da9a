//! Fully implicit integration: generalised-α and Bossak's scheme, with full Newton iterations.
//!
//! Newmark's approximations
//!
//!   r' = r + Δt v + Δt² [(½ − β) a + β a'],   v' = v + Δt [(1 − γ) a + γ a']
//!
//! close the balance of weighted forces
//!
//!   (1 − α_f) M' b' + α_f M a = (1 − α_f) f(r', v', t') + α_f f(r, v, t),   (1 − α_f) b' = (1 − α_m) a' + (α_m − α_f) a.
//!
//! With a constant mass the left side is (1 − α_m) M a' + α_m M a, the usual form. a is the acceleration at a time
//! (α_f − α_m) Δt after that of r and v, and b' the acceleration at t'. With M' a' instead of M' b', a mass that turns with
//! its line, or added mass that enters the water, would be evaluated at the wrong time, and the scheme would be of first
//! order.
//!
//! * Generalised-α of spectral radius ρ at infinite frequency: α_m = (2ρ − 1)/(ρ + 1), α_f = ρ/(ρ + 1), γ = ½ − α_m + α_f,
//!   β = ¼ (1 − α_m + α_f)².
//! * Bossak(α, γ): α_m = α ≤ 0, α_f = 0, β = ¼ (1 − α)²; second order for γ = ½ − α.
//!
//! The second correction of a step reuses the factorised tangent stiffness of the first one, if the first is small. Most steps then factorise once.
//!
//! The tangent stiffness is that of [`crate::elements`], with predicted tensions as in [`crate::statics::equilibrium`].
//! The damper of the seabed fades in over two static penetrations above and below the seabed, or over the displacement of
//! the node in a step if that is larger. A damper that switches on at contact would prevent convergence of Newton's
//! method. Nodes at rest on the seabed are not affected.
//!
//! Source: Chung & Hulbert (1993), J. Appl. Mech. 60, 371-375; Wood, Bossak & Zienkiewicz (1980), Int. J. Numer.
//! Meth. Eng. 15, 1562-1566. Valid for ρ from 0 to 1. In its usual form, the method gains energy without bound where
//! slack cables without damping snap taut (a falling dry cable of 20 segments, EA/T = 1e4 and 1e6, Δt = 2 to 10 ms,
//! ρ = 0.5 and more): the forces before and after a step do not determine the energy that a spring absorbs in between.
//! The tension of a segment is therefore the discrete gradient of its energy over a step ([`crate::elements`]). The same
//! cable then never gains energy at any ρ, and conserves it at ρ = 1.

use nalgebra::{Matrix3, Vector3};

use super::energy_balance::implicit::Passed;
use super::{StepError, StepFailure, reaction};
use crate::elements::{Counters, Stretch, Weights, Workspace, copy_network, free_points, place_ends};
use crate::math::block_banded::Pivots;
use crate::model::{Kinematics, Model, Network, State};
use crate::scene::{Integrator, Solver};

/// Default spectral radius at infinite frequency [-].
pub const SPECTRAL_RADIUS: f64 = 0.2;
/// Default of Bossak's α [-].
pub const BOSSAK_ALPHA: f64 = -0.3;
/// Convergence limit of the correction, relative to the shortest segment [-].
const NEWTON_TOLERANCE: f64 = 1e-7;
/// Largest strain and rotation of a segment in the first correction for which the second, about their square, reuses the tangent stiffness [-].
const REUSED_MAX: f64 = 1e-4;
/// Maximum number of Newton iterations of a step, one of which may reuse the tangent stiffness.
const ITERATIONS_MAX: usize = 16;
/// Number of iterations after which corrections that decrease too slowly are taken for a cycle.
const CIRCLING: usize = 6;
/// Maximum number of parts of a step: twelve halvings.
const PARTS_MAX: usize = 4096;

/// Parameters of the integrator [-].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scheme {
    /// Weight of the inertia before the step.
    pub alpha_m: f64,
    /// Weight of the forces before the step.
    pub alpha_f: f64,
    /// Newmark's β.
    pub beta: f64,
    /// Newmark's γ.
    pub gamma: f64,
}

impl Scheme {
    /// Chung and Hulbert's scheme with the spectral radius `rho` at infinite frequency [-], 0 to 1.
    pub fn generalised_alpha(rho: f64) -> Scheme {
        let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
        let gamma = 0.5 - alpha_m + alpha_f;
        Scheme {
            alpha_m,
            alpha_f,
            beta: 0.25 * (0.5 + gamma).powi(2),
            gamma,
        }
    }

    /// Bossak's scheme; γ = ½ − α if `gamma` is `None`.
    pub fn bossak(alpha: f64, gamma: Option<f64>) -> Scheme {
        Scheme {
            alpha_m: alpha,
            alpha_f: 0.0,
            beta: 0.25 * (1.0 - alpha).powi(2),
            gamma: gamma.unwrap_or(0.5 - alpha),
        }
    }

    /// Weights of the forces before and after a step of `dt` [s], and derivatives of v' [1/s] and b' [1/s²] with r'.
    fn weights(&self, dt: f64) -> ([Weights; 2], [f64; 2]) {
        let Scheme {
            alpha_m,
            alpha_f,
            beta,
            gamma,
        } = *self;
        let (per_velocity, per_acceleration) = (gamma / (beta * dt), 1.0 / (beta * dt * dt));
        let before = Weights {
            force: alpha_f,
            friction: 0.0,
            inertia: alpha_f,
            position: 0.0,
            velocity: 0.0,
            acceleration: 0.0,
            stretch: Stretch::Before,
            convex: false,
            span: dt,
        };
        let after = Weights {
            force: 1.0 - alpha_f,
            friction: 1.0,
            inertia: 1.0 - alpha_f,
            position: 1.0 - alpha_f,
            velocity: (1.0 - alpha_f) * per_velocity,
            acceleration: (1.0 - alpha_m) * per_acceleration,
            stretch: Stretch::OverStep,
            convex: false,
            span: dt,
        };
        let now = (1.0 - alpha_m) / (1.0 - alpha_f) * per_acceleration;
        ([before, after], [per_velocity, now])
    }

    /// Scheme that a scene's solver table selects.
    pub fn new(solver: &Solver) -> Scheme {
        match (solver.integrator, solver.bossak) {
            (Integrator::Bossak, Some(bossak)) => Scheme::bossak(bossak.alpha, bossak.gamma),
            (Integrator::Bossak, None) => Scheme::bossak(BOSSAK_ALPHA, None),
            _ => Scheme::generalised_alpha(solver.spectral_radius.unwrap_or(SPECTRAL_RADIUS)),
        }
    }
}

/// Sets the accelerations of a network to those that satisfy its equation of motion at time `t` [s], for the start of a
/// motion. The prescribed points move according to `held`. Nodes without mass get zero acceleration.
pub fn start<K: Fn(usize, f64) -> Kinematics>(
    model: &Model,
    number: usize,
    state: &mut State,
    held: &K,
    t: f64,
    work: &mut Workspace,
) {
    let network = &model.networks[number];
    hold(model, network, state, held, t);
    let weights = Weights {
        force: 1.0,
        friction: 1.0,
        inertia: 0.0,
        position: 0.0,
        velocity: 0.0,
        acceleration: 1.0,
        stretch: Stretch::Now,
        convex: false,
        span: 0.0,
    };
    work.fade_dampers(model, network, state, 0.0);
    work.assemble_dynamic::<true>(model, network, state, t, &weights);
    for &index in &network.lines {
        let (line, nodes) = (&work.lines[index], &mut state.lines[index]);
        for (i, a) in nodes.acceleration.iter_mut().enumerate() {
            *a = acceleration(line.diagonal[i], line.residual[i]);
        }
    }
    for (index, free) in free_points(model, network) {
        let mut mass = work.points[index].diagonal;
        for &(line, end) in &model.points[index].attached {
            mass += work.lines[line].diagonal[model.lines[line].end_node(end)];
        }
        for axis in (0..3).filter(|&axis| !free.axes[axis]) {
            mass.row_mut(axis).fill(0.0);
            mass.column_mut(axis).fill(0.0);
            mass[(axis, axis)] = 1.0;
        }
        state.points[index].acceleration = acceleration(mass, work.points[index].total);
    }
    place_ends(model, network, state);
}

/// −M⁻¹R, zero without mass [m/s²].
fn acceleration(mass: Matrix3<f64>, residual: Vector3<f64>) -> Vector3<f64> {
    mass.try_inverse()
        .map_or(Vector3::zeros(), |inverse| -(inverse * residual))
}

/// Sets the prescribed points of a network to their motion at time `t` [s].
fn hold<K: Fn(usize, f64) -> Kinematics>(
    model: &Model,
    network: &Network,
    state: &mut State,
    held: &K,
    t: f64,
) {
    for &index in &network.lines {
        for point in model.lines[index].ends {
            if model.points[point].free().is_none() {
                let (at, now) = (held(point, t), &mut state.points[point]);
                (now.position, now.velocity, now.acceleration) = (at.position, at.velocity, at.acceleration);
                (now.orientation, now.spin) = (at.orientation, at.spin);
            }
        }
    }
    place_ends(model, network, state);
}

/// Time span divided into equal steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Start of the span [s].
    pub start: f64,
    /// End of the span [s].
    pub end: f64,
    /// Number of steps.
    pub steps: usize,
}

/// Prescribed motion of a network, and the scheme that integrates it.
#[derive(Debug)]
pub struct Driving<'a, K> {
    /// Kinematics of a prescribed point at a time [s].
    pub kinematics: &'a K,
    /// Integration scheme.
    pub scheme: &'a Scheme,
}

/// [`advance`] with a call of `observe` after every internal step, and an additional call with a step of zero length if
/// ends were released after it.
///
/// # Errors
/// Newton's method failed even in steps 4096 times smaller; the state is then unchanged.
pub fn advance<K: Fn(usize, f64) -> Kinematics>(
    model: &Model,
    number: usize,
    state: &mut State,
    held: Driving<K>,
    span: Span,
    work: &mut Workspace,
    mut observe: impl FnMut(&Passed),
) -> Result<Counters, StepError> {
    if span.end <= span.start {
        return Ok(Counters::default());
    }
    let network = &model.networks[number];
    let mut start = std::mem::take(&mut work.start);
    copy_network(model, network, state, &mut start);
    work.counters = Counters::default();
    let integrator = Integration {
        model,
        network,
        number,
        held: held.kinematics,
        scheme: held.scheme,
    };
    let mut result = Ok(());
    for step in 0..span.steps {
        let at = |step: usize| span.start + (span.end - span.start) * step as f64 / span.steps as f64;
        result = integrator.pass([at(step), at(step + 1)], state, work, &mut observe);
        if result.is_err() {
            copy_network(model, network, &start, state);
            break;
        }
    }
    work.start = start;
    result.map(|()| work.take_counters())
}

struct Integration<'a, K> {
    model: &'a Model,
    network: &'a Network,
    number: usize,
    held: &'a K,
    scheme: &'a Scheme,
}

impl<K: Fn(usize, f64) -> Kinematics> Integration<'_, K> {
    /// Takes the step from `t0` to `t1` [s], halved where Newton's method fails.
    fn pass(
        &self,
        [t0, t1]: [f64; 2],
        state: &mut State,
        work: &mut Workspace,
        observe: &mut impl FnMut(&Passed),
    ) -> Result<(), StepError> {
        let at = |parts: usize| t0 + (t1 - t0) * parts as f64 / PARTS_MAX as f64;
        let mut before = std::mem::take(&mut work.before);
        let (mut done, mut parts) = (0, PARTS_MAX);
        let mut result = Ok(());
        while done < PARTS_MAX {
            copy_network(self.model, self.network, state, &mut before);
            let span = [at(done), at(done + parts)];
            if self.step(span, &before, state, work) {
                observe(&self.passed([&before, state], span, work));
                if self.release_ends(state, span[1]) {
                    observe(&self.passed([&before, state], [span[1]; 2], work));
                }
                work.counters.steps += 1;
                done += parts;
                if done % (2 * parts) == 0 && parts < PARTS_MAX {
                    parts *= 2;
                }
                continue;
            }
            if parts == 1 {
                result = Err(self.failure(span, work));
                break;
            }
            copy_network(self.model, self.network, &before, state);
            work.counters.halvings += 1;
            parts /= 2;
        }
        work.before = before;
        result
    }

    fn passed<'a>(&'a self, states: [&'a State; 2], times: [f64; 2], work: &'a Workspace) -> Passed<'a> {
        Passed {
            states,
            times,
            scheme: self.scheme,
            work,
        }
    }

    /// Releases the ends that have reached their release tension or time at `t` [s]; returns whether there were any.
    fn release_ends(&self, state: &mut State, t: f64) -> bool {
        let mut any = false;
        for &index in &self.network.lines {
            let (line, shape) = (&self.model.lines[index], &mut state.lines[index]);
            let Some(releases) = &line.release else {
                continue;
            };
            for (side, segment) in [0, line.segment_count() - 1].into_iter().enumerate() {
                let negative = self.model.solver.negative_tension;
                let tension = reaction::tension(line, shape, segment, negative);
                if !shape.released[side] && releases[side].is_due(tension, t) {
                    shape.released[side] = true;
                    any = true;
                }
            }
        }
        any
    }

    fn failure(&self, [t0, t1]: [f64; 2], work: &Workspace) -> StepError {
        let (residual, place) = work.greatest_residual(self.network);
        let (line, node) = place.node(self.model);
        let step = t1 - t0;
        let cause = StepFailure::NotConverged { step, residual };
        StepError::new(t0, &self.model.lines[line], node, cause)
    }

    /// Takes one step from the state `before`; returns whether Newton's method converged. If not, the state is
    /// undefined.
    fn step(&self, [t0, t1]: [f64; 2], before: &State, state: &mut State, work: &mut Workspace) -> bool {
        let dt = t1 - t0;
        let ([old, new], rates) = self.scheme.weights(dt);
        work.fade_dampers(self.model, self.network, state, dt);
        work.assemble_dynamic::<false>(self.model, self.network, state, t0, &old);
        work.remember(self.network);
        work.move_anchors(self.model, self.network, state);
        self.predict(state, dt);
        hold(self.model, self.network, state, self.held, t1);
        let tolerance = NEWTON_TOLERANCE * self.shortest_segment();
        let (mut last, mut part) = (f64::INFINITY, 1.0);
        let mut again = false;
        for iteration in 0..ITERATIONS_MAX {
            again = again && self.solve_again(state, t1, &new, work);
            if !again && !self.solve(state, t1, &new, work) {
                return false;
            }
            let correction = work.greatest_solution(self.network);
            if !correction.is_finite() {
                return false;
            }
            // Where forces are smooth, a fraction p of Newton's step leaves a correction of 1 − p times the last; a
            // correction above the mean of that and the last one indicates a cycle.
            let left_over = (1.0 - 0.5 * part) * last;
            let circles = iteration >= CIRCLING && correction > left_over.max(tolerance);
            part = if circles { 0.5 } else { 1.0 };
            last = correction;
            self.correct(state, work, part, rates);
            let consistent = work.predict_tensions(self.model, self.network, part);
            if correction <= tolerance && consistent {
                work.relax_segments(self.model, self.network, state);
                self.shift_accelerations(state, before);
                return true;
            }
            // In a smooth step the second correction is small even with the last tangent stiffness; all later ones use the exact one.
            again = iteration == 0 && consistent && work.greatest_strain(self.network) <= REUSED_MAX;
        }
        false
    }

    fn solve(&self, state: &State, t: f64, weights: &Weights, work: &mut Workspace) -> bool {
        work.assemble_dynamic::<true>(self.model, self.network, state, t, weights);
        work.add_remembered(self.model, self.network);
        work.solve(self.model, self.number) || self.solve_indefinite(state, t, weights, work)
    }

    fn solve_again(&self, state: &State, t: f64, weights: &Weights, work: &mut Workspace) -> bool {
        work.assemble_dynamic::<false>(self.model, self.network, state, t, weights);
        work.add_remembered(self.model, self.network);
        work.solve_again(self.model, self.number)
    }

    /// Solves again if the exact tangent stiffness is not positive definite: with row exchanges, since stiff segments that turn
    /// within the step make it unsymmetric, and with positive semi-definite joints of lines that bend.
    fn solve_indefinite(&self, state: &State, t: f64, weights: &Weights, work: &mut Workspace) -> bool {
        let mut lines = self.model.lines_of(self.network);
        if lines.any(|line| line.bending.is_some()) {
            let convex = Weights {
                convex: true,
                ..*weights
            };
            work.assemble_dynamic::<true>(self.model, self.network, state, t, &convex);
            work.add_remembered(self.model, self.network);
        }
        work.solve_with(self.model, self.number, Pivots::Any)
    }

    fn shortest_segment(&self) -> f64 {
        let lines = self.model.lines_of(self.network);
        let lengths = lines.flat_map(|line| &line.segments.length);
        lengths.copied().fold(f64::INFINITY, f64::min)
    }

    /// Predicts the state after the step with constant accelerations.
    fn predict(&self, state: &mut State, dt: f64) {
        for &index in &self.network.lines {
            let nodes = &mut state.lines[index];
            for ((r, v), a) in nodes
                .position
                .iter_mut()
                .zip(&mut nodes.velocity)
                .zip(&nodes.acceleration)
            {
                *r += dt * (*v + 0.5 * dt * a);
                *v += dt * a;
            }
        }
        for &index in &self.network.free_points {
            let point = &mut state.points[index];
            point.position += dt * (point.velocity + 0.5 * dt * point.acceleration);
            point.velocity += dt * point.acceleration;
        }
    }

    /// Converts b' to a' = [(1 − α_f) b' + (α_f − α_m) a] / (1 − α_m) for all nodes and free points.
    fn shift_accelerations(&self, state: &mut State, before: &State) {
        let Scheme { alpha_m, alpha_f, .. } = *self.scheme;
        let of_new = (1.0 - alpha_f) / (1.0 - alpha_m);
        let shifted = |new: Vector3<f64>, old: Vector3<f64>| of_new * new + (1.0 - of_new) * old;
        for &index in &self.network.lines {
            let (new, old) = (&mut state.lines[index], &before.lines[index]);
            for (new, old) in new.acceleration.iter_mut().zip(&old.acceleration) {
                *new = shifted(*new, *old);
            }
        }
        for &index in &self.network.free_points {
            let new = &mut state.points[index].acceleration;
            *new = shifted(*new, before.points[index].acceleration);
        }
        place_ends(self.model, self.network, state);
    }

    fn correct(
        &self,
        state: &mut State,
        work: &Workspace,
        part: f64,
        [per_velocity, per_acceleration]: [f64; 2],
    ) {
        for &index in &self.network.lines {
            let nodes = &mut state.lines[index];
            for (i, x) in work.lines[index].solution().iter().enumerate() {
                let x = part * x;
                nodes.position[i] -= x;
                nodes.velocity[i] -= per_velocity * x;
                nodes.acceleration[i] -= per_acceleration * x;
            }
        }
        for &index in &self.network.free_points {
            let (point, x) = (&mut state.points[index], part * work.points[index].solution);
            point.position -= x;
            point.velocity -= per_velocity * x;
            point.acceleration -= per_acceleration * x;
        }
    }
}
