//! Segments over a step of an implicit integrator. The force on their nodes is
//!
//!   F = T̄ q̄ + (½ − α_f) (N' q' − N q) + (1 − α_f) C' q' + α_f C q
//!
//! with the force N of the spring and C of the damper before and after the step. T̄ q̄ conserves the energy of the spring over the step
//! ([`crate::physics::stretch_step`], [`crate::physics::viscoelastic`]). The second term is the effect of the integrator's weights beyond the mean of
//! N, which is its algorithmic dissipation. The last two terms are the weighted damper.
//!
//! The mean of N alone is not sufficient: generalised-α overshoots where springs are not linear, and may gain energy without bound.
//!
//! Source: Erlicher, Bonaventura & Bursi (2002), Comput. Mech. 28, 83-104, on generalised-α in nonlinear problems; the discrete gradient instead of
//! the mean is derived here. Valid where the laws are.

use nalgebra::{Matrix3, Vector3};

use super::Stretch;
use super::line::{Geometry, LineWork};
use crate::model::{Line, LineState};
use crate::physics::stretch_step::{Mean, StretchStep, Stretched};

/// Segment `i` of a line in a state.
pub(crate) fn stretched(line: &Line, state: &LineState, i: usize) -> Stretched {
    let [low, high] = [i, i + 1].map(|node| state.position[node]);
    let g = Geometry::new(low, high, line.segments.length[i]);
    let mut spring = line.spring(i, g.strain);
    let memory = line.segments.viscoelastic.as_ref().zip(state.viscoelastic.get(i));
    if let Some((laws, slow)) = memory {
        let elastic = laws[i].elastic(g.strain, *slow);
        spring.tension = elastic.max(0.0 - line.compression_max(i));
    }
    Stretched {
        chord: high - low,
        length: g.length,
        direction: g.direction.along,
        spring,
    }
}

/// Segment `i` of a line before and after a `step` [s], and its force over the step.
pub(crate) fn stretch_step(
    line: &Line,
    states: [&LineState; 2],
    i: usize,
    step: f64,
) -> ([Stretched; 2], StretchStep) {
    let ends = states.map(|state| stretched(line, state, i));
    let [before, after] = ends.each_ref();
    let memory = line.segments.viscoelastic.as_ref();
    let mean = match memory.zip(states[0].viscoelastic.get(i)) {
        Some((laws, slow)) => {
            let strains = [before.spring.strain, after.spring.strain];
            laws[i].step(strains, *slow, step).mean
        }
        None => Mean::of_spring(&before.spring, &after.spring),
    };
    (ends, StretchStep::new([before, after], mean))
}

/// Response of a segment to its strain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Response {
    /// Elastic force, before any limit [N].
    pub elastic: f64,
    /// Slope with respect to the strain [N].
    pub tangent: f64,
    /// Damping of the strain rate [N s]; zero for a viscoelastic law in a step, which includes it in its mean.
    pub damping: f64,
}

/// Tension of a segment at the end of a step, from the last solution.
#[derive(Debug, Clone, Copy)]
pub(super) struct StepEnd {
    /// True if the segment is taut in the last solution, although its present nodes leave it slack.
    pub keeps: bool,
    /// Excess of the tension in the last solution over that at its present nodes [N].
    pub excess: f64,
}

/// Force of a segment over a step in excess of the weighted force at its end.
pub(super) struct Beyond {
    /// Force [N].
    pub force: Vector3<f64>,
    /// Stiffness [N/m].
    pub stiffness: Matrix3<f64>,
}

impl LineWork {
    /// Begins a step from a state.
    pub(super) fn begin(&mut self, line: &Line, state: &LineState) {
        for (i, start) in self.start.iter_mut().enumerate() {
            *start = stretched(line, state, i);
        }
    }

    /// Response of segment `i` to a strain [-].
    #[inline(always)]
    pub(super) fn respond(
        &self,
        line: &Line,
        state: &LineState,
        i: usize,
        strain: f64,
        when: Stretch,
    ) -> Response {
        match &self.viscoelastic {
            Some(viscoelastic) => viscoelastic.respond(line, state, i, strain, when),
            None => {
                let spring = line.uncut_spring(i, strain);
                Response {
                    elastic: spring.tension,
                    tangent: spring.slope,
                    damping: line.segments.axial_damping[i],
                }
            }
        }
    }

    /// T̄ q̄ − ½ (N q + N' q') of segment `i`, and its tangent.
    #[inline(always)]
    pub(super) fn beyond_mean(
        &self,
        line: &Line,
        i: usize,
        g: &Geometry,
        response: Response,
        end: StepEnd,
    ) -> Beyond {
        let (start, least) = (&self.start[i], 0.0 - self.push[i]);
        let (unstretched, excess) = (line.segments.length[i], end.excess);
        let mut after = Stretched {
            chord: g.length * g.direction.along,
            length: g.length,
            direction: g.direction.along,
            spring: line.spring(i, g.strain),
        };
        let pulls = end.keeps || response.elastic > least;
        after.spring.tension = if pulls { response.elastic } else { least };
        after.spring.slope = if pulls { response.tangent } else { 0.0 };
        let mean = match &self.viscoelastic {
            Some(viscoelastic) if viscoelastic.moves => viscoelastic.mean(i, g.strain, end.keeps),
            _ if end.keeps => Mean::of_tensions(&start.spring, &after.spring),
            _ => Mean::of_spring(&start.spring, &after.spring),
        };
        let step = StretchStep::new([start, &after], mean);
        let force = step.force() - 0.5 * (start.force() + after.force());
        if g.length == 0.0 {
            return Beyond {
                force,
                stiffness: Matrix3::zeros(),
            };
        }
        let pull = (mean.tension + 0.5 * excess).max(least);
        let across = 0.5 * (after.spring.tension + excess) * g.direction.per_length;
        let along = 0.5 * after.spring.slope / unstretched - across;
        Beyond {
            force,
            stiffness: step.stiffness(unstretched, g.direction.along, pull)
                - Matrix3::from_diagonal_element(across)
                - along * g.along(),
        }
    }
}
