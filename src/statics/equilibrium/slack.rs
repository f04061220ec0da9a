//! Equilibrium of slack lines.
//!
//! A slack segment exerts no force, so that a line with little or no tension in part of it has no lateral stiffness
//! there. Newton's method then moves its nodes far, and more of them on finer meshes. The equilibrium is therefore
//! found as the limit of networks that are taut everywhere: the tension T of a segment and its excess over the
//! tension of its strain are complementary, and their product is set to a small force m,
//!
//!   T ≥ 0,  T − N(ε) ≥ 0,  T (T − N(ε)) = m EA,
//!
//! which makes T(ε) smooth and the energy of the network convex with a single minimum. m is the tension of a segment that is shortened to zero
//! length. With m as large as all loads together the lines are pulled straight. From there m is reduced to zero, at the rate that Newton's method on
//! positions and tensions together allows, along with the breadth of the water surface, over which a floating line gains its buoyancy. Where the
//! equilibrium is not unique, the result is the one whose segments are shortened most evenly.
//!
//! Source: the primal-dual interior point method, Nocedal & Wright (2006), Numerical Optimization, 2nd ed., sections 16.6 and 19.1, with the
//! segments' tensions as multipliers; the elimination of the tensions is derived in `elements/line.rs`.

use super::{Problem, StaticCase};
use crate::elements::{Workspace, copy_network};
use crate::model::State;

/// First m, relative to the sum of the loads [-].
const TAUTEST: f64 = 1.0;
/// Last m, relative to the sum of the loads: the search fails if no equilibrium is accepted by then [-].
const SLACKEST: f64 = 1e-26;
/// Ratio of successive m: the first, the minimum, and the value close to one at which the method stops [-].
const FALL: f64 = 0.3;
const FALL_MIN: f64 = 0.01;
const FALL_MAX: f64 = 0.9;
/// Maximum number of solves for one m, and the number below which the next m falls by more.
const SOLVES_MAX: usize = 25;
const SOLVES_FEW: usize = 8;
/// Out-of-balance force that is left at one m, relative to the sum of the loads [-]; never more than m.
const SHARE: f64 = 1e-3;
/// Minimum tension relative to m [-].
const TENSION_MIN: f64 = 0.01;
/// Breadth of the water surface at the first m, relative to the longest line; it falls with the square root of m [-].
const BREADTH: f64 = 0.1;

impl Problem<'_> {
    /// Returns whether any line may pierce the water surface.
    pub(super) fn meets_surface(&self) -> bool {
        let mut lines = self.model.lines_of(self.network);
        lines.any(|line| line.surface.is_some())
    }

    /// Follows the equilibrium from taut straight lines between their points to the actual slack ones; returns whether it converged.
    pub(super) fn slacken(&self, state: &mut State, work: &mut Workspace) -> bool {
        self.pull_straight(state, work);
        let mut found = std::mem::take(&mut work.trial);
        let (mut reached, mut fall) = (TAUTEST / FALL, FALL);
        let mut balanced = false;
        while !balanced && reached > SLACKEST && fall < FALL_MAX {
            let part = fall * reached;
            let before = work.counters.solves;
            if self.newton_taut(state, work, self.taut(part)) {
                reached = part;
                if work.counters.solves - before < SOLVES_FEW {
                    fall = fall.powf(1.5).max(FALL_MIN);
                }
                copy_network(self.model, self.network, state, &mut found);
                balanced = self.is_balanced(state, work);
            } else if reached > TAUTEST {
                break;
            } else {
                fall = fall.sqrt();
                copy_network(self.model, self.network, &found, state);
            }
            work.assemble_static(self.model, self.network, state, &self.taut(reached));
            self.remember_tensions(work);
        }
        if balanced && !self.newton(state, work, self.full_case()) {
            self.restart(&found, state, work);
        }
        work.trial = found;
        balanced
    }

    /// Reduces the breadth of the water surface to that of thin lines, from a soft network whose energy is minimised; returns whether it converged.
    /// If the end of a floating line is free and nearly weightless, no m gives its last segment a direction, and this method finds the equilibrium.
    pub(super) fn thin_gradually(&self, state: &mut State, work: &mut Workspace) -> bool {
        let lines = self.model.lines_of(self.network);
        let radii = lines.filter_map(|line| Some(&line.surface.as_ref()?.radius));
        let thinnest = radii.flatten().copied().fold(f64::INFINITY, f64::min);
        if !thinnest.is_finite() {
            return false;
        }
        let first = (thinnest / (BREADTH * self.length)).min(1.0);
        let case = |part: f64| StaticCase {
            breadth: thinnest / part,
            ..self.full_case()
        };
        let wide = StaticCase {
            cautious: true,
            ..case(first)
        };
        self.stiffen_gradually(state, work, wide) && self.raise(state, work, [first, 1.0 / FALL], case)
    }

    /// Case with this m, relative to the sum of the loads [-].
    fn taut(&self, part: f64) -> StaticCase {
        StaticCase {
            slack: part * self.force,
            breadth: BREADTH * self.length * part.sqrt(),
            ..self.full_case()
        }
    }

    fn pull_straight(&self, state: &mut State, work: &mut Workspace) {
        for &index in &self.network.lines {
            let line = &self.model.lines[index];
            let ends = line.ends.map(|point| state.points[point].position);
            for (r, straight) in state.lines[index]
                .position
                .iter_mut()
                .zip(line.parabola(ends, 0.0))
            {
                *r = straight;
            }
            work.lines[index].tension.fill(self.force);
        }
    }

    /// Newton's method on positions and tensions of taut segments; returns whether it converged.
    fn newton_taut(&self, state: &mut State, work: &mut Workspace, mut case: StaticCase) -> bool {
        case.predicted = true;
        case.anchoring = self.rounding_stiffness(&case);
        let mut part = 0.0;
        for _ in 0..SOLVES_MAX {
            work.assemble_static(self.model, self.network, state, &case);
            let (residual, _) = work.greatest_residual(self.network);
            let accepted = case.slack.min(SHARE * self.force);
            let least = self.tolerance(state, work, f64::INFINITY);
            if part >= 1.0 && residual <= accepted.max(least) {
                return true;
            }
            if self.is_spent(work) {
                return false;
            }
            if !work.solve(self.model, self.number) {
                case.anchoring *= 10.0;
                continue;
            }
            if !work.greatest_solution(self.network).is_finite() {
                return false;
            }
            part = self.turning_part(state, work);
            work.predict_tensions(self.model, self.network, part);
            for &index in &self.network.lines {
                for tension in &mut work.lines[index].tension {
                    *tension = tension.max(TENSION_MIN * case.slack);
                }
            }
            self.advance(state, work, part);
        }
        false
    }
}
