//! Viscoelastic segments in the implicit integrators: their memory at the end of a step is a function of the strain there.

use super::Stretch;
use super::line::Geometry;
use super::segment::Response;
use crate::model::{Line, LineState};
use crate::physics::stretch_step::Mean;
use crate::physics::viscoelastic::Viscoelastic;

/// Viscoelastic internal variables of a line in a step.
#[derive(Debug, Clone)]
pub(super) struct ViscoelasticWork {
    laws: Vec<Viscoelastic>,
    /// Strain and slow strain of every segment at the start of the step [-].
    start: Vec<[f64; 2]>,
    /// Length of the step [s].
    dt: f64,
    /// True if the line moves: at rest it has no internal variables.
    pub moves: bool,
}

impl ViscoelasticWork {
    /// Workspace for a line; `None` if it is not viscoelastic.
    pub(super) fn new(line: &Line) -> Option<ViscoelasticWork> {
        let laws = line.segments.viscoelastic.clone()?;
        Some(ViscoelasticWork {
            start: vec![[0.0; 2]; laws.len()],
            laws,
            dt: 0.0,
            moves: false,
        })
    }

    /// Begins a step of `dt` [s] from a state.
    pub(super) fn begin(&mut self, line: &Line, state: &LineState, dt: f64) {
        self.dt = dt;
        self.moves = !state.viscoelastic.is_empty();
        for (i, start) in self.start.iter_mut().enumerate() {
            *start = [strain(line, state, i), memory(state, i)];
        }
    }

    /// Force and slope of segment `i` at a strain [-], at the end of the step or in the present state.
    #[inline(always)]
    pub(super) fn respond(
        &self,
        line: &Line,
        state: &LineState,
        i: usize,
        strain: f64,
        when: Stretch,
    ) -> Response {
        if state.viscoelastic.is_empty() {
            let ea = line.segments.axial_stiffness[i];
            return Response {
                elastic: ea * strain,
                tangent: ea,
                damping: self.laws[i].damping,
            };
        }
        let law = &self.laws[i];
        let (slow, slope) = if when == Stretch::OverStep {
            let [before, slow] = self.start[i];
            let viscoelastic = law.step([before, strain], slow, self.dt);
            (viscoelastic.slow, viscoelastic.slow_slope)
        } else {
            (memory(state, i), 0.0)
        };
        Response {
            elastic: law.elastic(strain, slow),
            tangent: law.stiffness + law.memory * slope,
            damping: if when == Stretch::Now { law.damping } else { 0.0 },
        }
    }

    /// Tension of segment `i` over the step to a strain [-]; if it `keeps` pulling in the last solution, it is computed as if it could push.
    #[inline(always)]
    pub(super) fn mean(&self, i: usize, strain: f64, keeps: bool) -> Mean {
        let ([before, slow], law) = (self.start[i], &self.laws[i]);
        let strains = [before, strain];
        match keeps {
            true => law.held(strains, slow, self.dt).mean,
            false => law.step(strains, slow, self.dt).mean,
        }
    }

    /// Stores the memory at the end of the step in `state`, whose nodes are at the end of the step.
    pub(super) fn finish(&self, line: &Line, state: &mut LineState) {
        if state.viscoelastic.is_empty() {
            return;
        }
        for (i, law) in self.laws.iter().enumerate() {
            let [before, slow] = self.start[i];
            state.viscoelastic[i] = law.step([before, strain(line, state, i)], slow, self.dt).slow;
        }
    }
}

fn strain(line: &Line, state: &LineState, i: usize) -> f64 {
    let [low, high] = [i, i + 1].map(|node| state.position[node]);
    Geometry::new(low, high, line.segments.length[i]).strain
}

fn memory(state: &LineState, i: usize) -> f64 {
    state.viscoelastic.get(i).copied().unwrap_or(0.0)
}
