//! Viscoelastic segments in the implicit integrators: their memory at the end of a step is a function of the strain there.

use super::line::Geometry;
use crate::model::{Line, LineState};
use crate::physics::viscoelastic::Viscoelastic;

/// What a line knows of its memory in a step.
#[derive(Debug, Clone)]
pub(super) struct CreepWork {
    laws: Vec<Viscoelastic>,
    /// Strain and slow strain of every segment at the start of the step [-].
    start: Vec<[f64; 2]>,
    /// Length of the step [s].
    dt: f64,
}

/// How a segment responds to its strain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Response {
    /// Elastic force [N].
    pub elastic: f64,
    /// Its slope with the strain [N].
    pub tangent: f64,
    /// Damping of the strain rate [N s].
    pub damping: f64,
}

impl CreepWork {
    /// Scratch for a line; `None` where it is not viscoelastic.
    pub fn new(line: &Line) -> Option<CreepWork> {
        let laws = line.segments.viscoelastic.clone()?;
        Some(CreepWork {
            start: vec![[0.0; 2]; laws.len()],
            laws,
            dt: 0.0,
        })
    }

    /// Begins a step of `dt` [s] from a state.
    pub fn begin(&mut self, line: &Line, state: &LineState, dt: f64) {
        self.dt = dt;
        for (i, start) in self.start.iter_mut().enumerate() {
            *start = [strain(line, state, i), memory(state, i)];
        }
    }

    /// Force and slope of segment `i` at a strain [-]: at the end of the step, or of the state as it is.
    #[inline(always)]
    pub fn respond(
        &self,
        line: &Line,
        state: &LineState,
        i: usize,
        strain: f64,
        at_end: bool,
    ) -> Response {
        if state.creep.is_empty() {
            let ea = line.segments.axial_stiffness[i];
            return Response {
                elastic: ea * strain,
                tangent: ea,
                damping: self.laws[i].damping,
            };
        }
        let law = &self.laws[i];
        let (slow, slope) = if at_end {
            let [before, slow] = self.start[i];
            let creep = law.creep([before, strain], slow, self.dt);
            (creep.slow, creep.slope)
        } else {
            (memory(state, i), 0.0)
        };
        Response {
            elastic: law.elastic(strain, slow),
            tangent: law.stiffness + law.memory * slope,
            damping: law.damping,
        }
    }

    /// Puts the memory at the end of the step into the state, whose nodes are there.
    pub fn finish(&self, line: &Line, state: &mut LineState) {
        if state.creep.is_empty() {
            return;
        }
        for (i, law) in self.laws.iter().enumerate() {
            let [before, slow] = self.start[i];
            state.creep[i] = law
                .creep([before, strain(line, state, i)], slow, self.dt)
                .slow;
        }
    }
}

fn strain(line: &Line, state: &LineState, i: usize) -> f64 {
    let [low, high] = [i, i + 1].map(|node| state.position[node]);
    Geometry::new(low, high, line.segments.length[i]).strain
}

fn memory(state: &LineState, i: usize) -> f64 {
    state.creep.get(i).copied().unwrap_or(0.0)
}
