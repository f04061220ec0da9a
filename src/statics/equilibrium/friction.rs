//! Equilibrium with the friction of the seabed.
//!
//! The friction of a line at rest depends on how it was laid. As in the closed-form catenary, every line is assumed to be laid from end A without
//! tension and hauled at end B, or from B if only B lies on the seabed. The equilibrium without friction is found first. Every node there gets an
//! anchor, its position on the same path if the line lay there without stretch,
//!
//!   a_0 = r_0,   a_{i+1} = a_i + min(l_i, |r_{i+1} − r_i|) q_i.
//!
//! Where end A hangs above the seabed, a line without tension hangs straight down to it, and the rest lies from there: nodes that do not touch the
//! seabed have a_{i+1} = a_i + l_i t_i, with t_i along the seabed and without the length that hangs. Friction then pulls every node
//! towards its anchor: fully where the line slid, T falling by μw per metre towards A, and not at all beyond the point
//! where no tension is left. The stiffness of sticking is raised in small steps. The anchors of free points are their positions of rest without
//! friction.
//!
//! Newton's method may cycle between nodes that stick and nodes that slide: a change of one node's normal force changes the forces of its neighbours.
//! In that case the normal forces that limit friction are kept constant for several steps. Friction then has the potential ∫ |f| d|r − a|, which is
//! convex like that of springs, weight and seabed, and their sum is minimised with steps along which it falls. The springs of sticking nodes are
//! stiffened in steps: at their full stiffness from the start, the minimisation stalls on about one ordinary line in ten thousand. The normal forces
//! are then updated, and Newton's method ends the search.
//!
//! Source: derived here; the path is that of Jonkman (2007), NREL/TP-500-41958, section 2.5; the problem with kept normal forces is that of
//! Tresca's friction, Wriggers (2006), Computational Contact Mechanics, 2nd ed., chapter 5.

use nalgebra::Vector3;

use super::{Problem, StaticCase};
use crate::elements::{Workspace, copy_network, free_points};
use crate::model::{LineState, Seabed, State};
use crate::physics::catenary::is_laid_from_b;
use crate::statics::StaticsError;

/// Initial part of the stiffness of sticking, and the factor by which it is raised [-]. Friction then grows from nothing to the value that the
/// displacement mobilises, and every sliding node has a taut neighbour that holds it.
const SOFTEST: f64 = 1e-6;
const GROWTH: f64 = 3.0;
/// Height of an end above the seabed, relative to the length of the line, above which the line hangs from it [-].
const HANGS: f64 = 1e-6;
/// Maximum number of rounds of normal forces and friction.
const ROUNDS_MAX: usize = 20;

impl Problem<'_> {
    /// Returns whether the seabed may resist by friction.
    pub(super) fn has_friction(&self) -> bool {
        let mut lines = self.model.lines_of(self.network);
        lines.any(|line| line.friction().is_some())
    }

    /// Finds the equilibrium with friction from that without it.
    pub(super) fn add_friction(&self, state: &mut State, work: &mut Workspace) -> Result<(), StaticsError> {
        let start = work.counters.solves;
        self.lay(state);
        let case = |stick| StaticCase {
            stick,
            ..self.full_case()
        };
        let raised = self.raise(state, work, [SOFTEST, GROWTH], case);
        if !raised && !self.settle_pressure(state, work) {
            return Err(self.not_converged(state, work, start));
        }
        Ok(())
    }

    /// Minimises the potential energy of the network under constant normal forces and updates them from the result, until Newton's method finds the
    /// equilibrium from there; returns whether it did.
    fn settle_pressure(&self, state: &mut State, work: &mut Workspace) -> bool {
        let full = self.full_case();
        let kept = |stick| StaticCase {
            keeps_pressure: true,
            stick,
            ..full
        };
        let mut found = std::mem::take(&mut work.trial);
        let settled = (0..ROUNDS_MAX).any(|_| {
            work.assemble_static(self.model, self.network, state, &full);
            let mut stick = SOFTEST;
            while stick < 1.0 {
                self.descend(state, work, kept(stick));
                stick *= GROWTH;
            }
            self.descend(state, work, kept(1.0));
            if self.is_balanced(state, work) {
                return true;
            }
            copy_network(self.model, self.network, state, &mut found);
            self.restart(&found, state, work);
            let settled = self.newton(state, work, full);
            if !settled {
                self.restart(&found, state, work);
            }
            settled
        });
        work.trial = found;
        settled
    }

    /// Sets the anchors as if the lines were laid on their present path.
    fn lay(&self, state: &mut State) {
        for &index in &self.network.lines {
            let line = &self.model.lines[index];
            let Some((_, seabed)) = line.friction().and(line.seabed()) else {
                continue;
            };
            let LineState { position, anchor, .. } = &mut state.lines[index];
            let last = position.len() - 1;
            let heights = [0, last].map(|end| -seabed.touch(position[end], 0.0).penetration);
            let from_b = is_laid_from_b(heights, line.unstretched_length());
            anchor.clone_from(position);
            let mut hanging = heights[usize::from(from_b)]; // length that is not laid yet [m]
            let mut flies = hanging > HANGS * line.unstretched_length();
            for k in 0..last {
                let (segment, from, to) = match from_b {
                    true => (last - 1 - k, last - k, last - 1 - k),
                    false => (k, k, k + 1),
                };
                let (length, step) = (line.segments.length[segment], position[to] - position[from]);
                flies &= seabed.touch(position[from], 0.0).penetration <= 0.0;
                anchor[to] = anchor[from];
                if flies {
                    let laid = (length - hanging).max(0.0);
                    hanging -= length - laid;
                    anchor[to] += laid * along_seabed(seabed, position[to], step);
                } else {
                    anchor[to] += step * (length / step.norm()).min(1.0);
                }
            }
        }
        for (index, free) in free_points(self.model, self.network) {
            let point = &mut state.points[index];
            point.anchor = free.contact.map(|_| point.position);
        }
    }
}

/// Direction along the seabed of a step [m] at a place [m]; zero if the step is along the normal [-].
fn along_seabed(seabed: &Seabed, place: Vector3<f64>, step: Vector3<f64>) -> Vector3<f64> {
    let normal = seabed.touch(place, 0.0).normal;
    let along = step - normal * normal.dot(&step);
    along
        .try_normalize(f64::EPSILON * step.norm())
        .unwrap_or_else(Vector3::zeros)
}
