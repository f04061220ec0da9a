//! Equilibrium of networks whose lines have bending stiffness.
//!
//! The elastic energy of bending is not convex, and a line that can carry compression can buckle, so that there may be many equilibria. The following
//! are tried in this order until one is found that is stable, that is, whose exact tangent is positive definite:
//!
//! 1. Newton's method with the exact tangent from the present shape: the flexible line's catenary, or the previous equilibrium.
//! 2. The same from the equilibrium of the perfectly flexible line.
//! 3. Pseudo-transient relaxation from a small wave across the present shape: anchoring springs as stiff as the exact tangent needs to
//!    be positive definite, so that unstable deflections grow.
//! 4. The same from a smooth curve along the clamps, where the flexible line leaves them at too sharp an angle: a cantilever whose
//!    flexible line hangs straight down starts unbent.
//!
//! A small wave is also used to leave an unstable equilibrium.
//!
//! Source: Kelley & Keyes (1998), SIAM J. Numer. Anal. 35(2), 508-523 (pseudo-transient continuation); the order was found by trial on cantilevers,
//! arches, columns and slack lines in `tests/lines/bending.rs`.

use nalgebra::Vector3;

use super::{Problem, StaticCase};
use crate::elements::{Workspace, place_ends};
use crate::model::{Line, State};
use crate::statics::StaticsError;

/// Maximum number of solves of one Newton iteration with bending.
pub(super) const NEWTON_SOLVES_MAX: usize = 100;
/// Maximum number of indefinite tangents in one Newton iteration.
pub(super) const REFUSALS_MAX: usize = 8;
/// Negative stiffness that does not count as instability, relative to the sum of the loads per length of the longest line [-]: with a mass as heavy
/// as the load, a disturbance grows by a factor e in an hour.
pub(super) const INSTABILITY: f64 = 1e-7;
/// Maximum turn of a segment in one step [rad].
const TURN_MAX: f64 = 0.5;
/// Maximum number of solves of one relaxation.
const RELAX_SOLVES_MAX: usize = 1000;
/// Maximum step of a relaxation, relative to the longest line [-].
const RELAX_STEP_MAX: f64 = 0.05;
/// Ratio of anchoring to forces per length at which a relaxation is stopped [-].
const RELAXATION_MAX: f64 = 1e20;
/// Amplitude of the wave that leaves an unstable equilibrium, relative to the line length [-].
const WAVE: f64 = 1e-3;

/// Largest stiffness of a joint against a zigzag of its nodes [N/m].
pub(super) fn stiffest_joint(line: &Line) -> f64 {
    let Some(bending) = &line.bending else {
        return 0.0;
    };
    let joints = bending.joint.iter().zip(&line.nodes.length);
    let stiffness = |(joint, length): (&f64, &f64)| 16.0 * joint / (length * length);
    joints.map(stiffness).fold(0.0, f64::max)
}

impl Problem<'_> {
    /// Fraction of the last correction that turns no segment by more than [`TURN_MAX`] [-].
    pub(super) fn turning_part(&self, state: &State, work: &Workspace) -> f64 {
        let mut turn = 0.0_f64;
        for &index in &self.network.lines {
            let lengths = &self.model.lines[index].segments.length;
            let (nodes, x) = (&state.lines[index].position, work.lines[index].solution());
            for (i, unstretched) in lengths.iter().enumerate() {
                let length = (nodes[i + 1] - nodes[i]).norm().min(*unstretched);
                turn = turn.max((x[i + 1] - x[i]).norm() / length);
            }
        }
        if turn > TURN_MAX { TURN_MAX / turn } else { 1.0 }
    }

    pub(super) fn solve_bent(
        &self,
        guess: &State,
        state: &mut State,
        work: &mut Workspace,
    ) -> Result<(), StaticsError> {
        let start = work.counters.solves;
        if self.newton(state, work, self.full_case()) && self.settle(state, work) {
            return Ok(());
        }
        let flexible = Problem {
            bends: false,
            ..*self
        };
        self.restart(guess, state, work);
        let hangs = flexible.solve_from(guess, state, work);
        if let Err(limit @ StaticsError::LimitLoad { .. }) = hangs {
            return Err(limit);
        }
        if hangs.is_ok() && self.newton(state, work, self.full_case()) && self.settle(state, work) {
            return Ok(());
        }
        self.restart(guess, state, work);
        if self.relax(state, work) && self.settle(state, work) {
            return Ok(());
        }
        self.restart(guess, state, work);
        if self.follow_clamps(state) && self.relax(state, work) && self.settle(state, work) {
            return Ok(());
        }
        Err(self.not_converged(state, work, start))
    }

    /// Returns whether an equilibrium, or another one found from it after a small wave, is stable and within the limits of its strain measures.
    fn settle(&self, state: &mut State, work: &mut Workspace) -> bool {
        let full = self.full_case();
        let found =
            self.stable(state, work, full) || (self.relax(state, work) && self.stable(state, work, full));
        found && self.strain_over_limit(state).0 <= 1.0
    }

    /// Relaxes the lines from a small wave on their shape: Newton's method with predicted tensions, whose anchoring
    /// springs follow the nodes and fade only as fast as the exact tangent stays positive definite, so that unstable
    /// deflections grow.
    fn relax(&self, state: &mut State, work: &mut Workspace) -> bool {
        self.wave(state);
        self.remember_shape(state, work);
        let mut case = StaticCase {
            predicted: true,
            ..self.full_case()
        };
        let (mut relaxation, mut balanced) = (1.0_f64, 0);
        for _ in 0..RELAX_SOLVES_MAX {
            let springs = relaxation * self.force / self.length;
            case.anchoring = springs + self.rounding_stiffness(&case);
            work.assemble_static(self.model, self.network, state, &case);
            balanced = self.count_balanced(balanced, state, work, &case);
            if balanced >= 3 {
                return true;
            }
            if self.is_spent(work) {
                return false;
            }
            if !work.solve(self.model, self.number) {
                relaxation *= 3.0;
                continue;
            }
            let step = work.greatest_solution(self.network);
            if !step.is_finite() || relaxation > RELAXATION_MAX {
                return false;
            }
            let part = (RELAX_STEP_MAX * self.length / step)
                .min(self.turning_part(state, work))
                .min(1.0);
            work.predict_tensions(self.model, self.network, part);
            self.advance(state, work, part);
            relaxation *= if part < 0.3 { 2.0 } else { 0.5 };
            relaxation = relaxation.max(1e-12);
        }
        false
    }

    /// Puts a small wave on every line, mainly across it in its vertical plane, if it has one.
    fn wave(&self, state: &mut State) {
        for &index in &self.network.lines {
            let line = &self.model.lines[index];
            let (length, nodes) = (line.unstretched_length(), &mut state.lines[index].position);
            let last = nodes.len() - 1;
            let chord = nodes[last] - nodes[0];
            let level = Vector3::z().cross(&chord);
            let across = if level.norm() > 1e-6 * length {
                level.cross(&chord).normalize() + 0.3 * level.normalize()
            } else {
                Vector3::new(-1.0, 0.3, 0.0)
            };
            let inner = nodes.iter_mut().zip(&line.nodes.arc).take(last).skip(1);
            for (r, arc) in inner {
                let u = arc / length;
                let shape = (std::f64::consts::PI * u).sin() + 0.4 * (5.0 * u).sin();
                *r -= WAVE * length * shape * across;
            }
        }
    }

    /// Lays every clamped line on a smooth curve along its clamps; returns whether there was one. A free point at the other end moves along with it
    /// if no other line ends there.
    fn follow_clamps(&self, state: &mut State) -> bool {
        let mut any = false;
        for &index in &self.network.lines {
            let line = &self.model.lines[index];
            let clamps = line.clamps(&state.points);
            if clamps == [None, None] {
                continue;
            }
            any = true;
            let length = line.unstretched_length();
            let lone = line.ends.map(|point| {
                let point = &self.model.points[point];
                point.attached.len() == 1 && point.free().is_some_and(|free| free.axes == [true; 3])
            });
            match (clamps, lone) {
                ([Some(along), None], [_, true]) => {
                    state.points[line.ends[1]].position =
                        state.points[line.ends[0]].position + length * along;
                }
                ([None, Some(along)], [true, _]) => {
                    state.points[line.ends[0]].position =
                        state.points[line.ends[1]].position - length * along;
                }
                _ => {}
            }
            let [a, b] = line.ends.map(|point| state.points[point].position);
            let chord = (b - a).try_normalize(0.0).unwrap_or_else(Vector3::x);
            let slopes = clamps.map(|clamp| length * clamp.unwrap_or(chord));
            let nodes = state.lines[index].position.iter_mut();
            for (r, arc) in nodes.zip(&line.nodes.arc) {
                *r = cubic([a, b], slopes, arc / length);
            }
        }
        place_ends(self.model, self.network, state);
        any
    }
}

/// Cubic between two ends with their slopes, at u from 0 to 1.
fn cubic([a, b]: [Vector3<f64>; 2], [p, q]: [Vector3<f64>; 2], u: f64) -> Vector3<f64> {
    let w = 1.0 - u;
    w * w * (1.0 + 2.0 * u) * a + u * u * (1.0 + 2.0 * w) * b + u * w * (w * p - u * q)
}
