//! Equilibrium of lines that float.
//!
//! The buoyancy of a line grows from nothing to all of it over its diameter, which is little beside its length, so that Newton's method
//! may throw a slack line from above the water to below it and back. The potential energy is convex all the same, and the wider
//! the surface is taken, the smoother. A line is therefore brought to rest with a surface as wide as a tenth of its length, and from there with
//! narrower and narrower ones down to its own radius. Where Newton's method does not even find the first of these, because a fine mesh
//! turns its short segments by much at once, the energy of the widest surface is minimised with a soft line first, and no correction turns
//! a segment by more than is sensible.
//!
//! Source: continuation in a smoothing parameter, e.g. Nocedal & Wright (2006), Numerical Optimization, section 11.3; the
//! factors are found by trial on the slack hoses in `tests/surface.rs`.

use super::{Problem, StaticCase};
use crate::model::State;
use crate::statics::assembly::Workspace;

/// Radius that lines are given at first, over the length of the longest [-].
const BREADTH: f64 = 0.1;
/// Radius over the next [-].
const THINNING: f64 = 1.0 / 0.3;

impl Problem<'_> {
    /// Whether any line may pierce the water's surface.
    pub(super) fn meets_surface(&self) -> bool {
        let mut lines = self.network.lines.iter();
        lines.any(|&line| self.model.lines[line].surface.is_some())
    }

    /// Newton's method from a guess, with lines that become thinner and thinner at the surface; whether it came to what they are.
    pub(super) fn thin_gradually(
        &self,
        guess: &State,
        state: &mut State,
        work: &mut Workspace,
    ) -> bool {
        let lines = self.network.lines.iter();
        let surfaces = lines.filter_map(|&line| self.model.lines[line].surface.as_ref());
        let radii = surfaces.flat_map(|surface| surface.radius.iter().copied());
        let thinnest = radii.fold(f64::INFINITY, f64::min);
        let first = (thinnest / (BREADTH * self.length)).min(1.0);
        let case = |part: f64| StaticCase {
            breadth: thinnest / part,
            ..self.case(f64::INFINITY)
        };
        let wide = StaticCase {
            cautious: true,
            ..case(first)
        };
        if self.raise(state, work, [first, THINNING], case) {
            return true;
        }
        self.restart(guess, state, work);
        self.stiffen_gradually(state, work, wide)
            && self.raise(state, work, [first, THINNING], case)
    }
}
