//! Mesh levels of a network, and the errors of its runs.

use std::rc::Rc;

use super::history::History;
use super::trials::Run;
use super::{AIM, ELEMENTS_MAX, Mesh, Trial, short_sections};
use crate::scene::Scene;

/// Mesh levels, by the elements of an isolated line [-].
pub(super) const LEVELS: [usize; 13] = [5, 7, 10, 14, 20, 28, 40, 56, 80, 112, 160, 224, 320];
/// Greatest ratio of a number of elements between levels to that of the level for which a trial is worthwhile [-].
const FEWER: f64 = 0.93;
/// Least ratio of the elements of a finer option to those of the mesh found [-].
const FINER_RATIO: f64 = 1.08;

/// Runs of a network on increasingly fine meshes.
#[derive(Debug)]
pub(super) struct Ladder {
    lines: Vec<usize>,
    /// True if the elements of any line are left open. Other networks have a given mesh and are run once, as a reference for other steps.
    open: bool,
    /// True if a mesh that passes is compared with one more level.
    confirms: bool,
    /// Elements of the coarsest level that is run [-].
    coarsest: usize,
    runs: Vec<Rc<Run>>,
    trials: Vec<Trial>,
    /// True if the error of the last trial is small enough. A run on the next level may reject it.
    passed: bool,
    /// Number of elements whose error is small enough, once found [-].
    found: Option<usize>,
    /// True if no run carries waves across the line with the shortest period of the motion.
    pub(super) lacks_waves: bool,
}

impl Ladder {
    pub(super) fn new(lines: &[usize], open: bool, confirms: bool) -> Ladder {
        Ladder {
            lines: lines.to_vec(),
            open,
            confirms,
            coarsest: LEVELS[0],
            runs: Vec::new(),
            trials: Vec::new(),
            passed: false,
            found: None,
            lacks_waves: false,
        }
    }

    /// Restarts with shorter steps, a level below the mesh found or the last one assessed. The errors of coarser meshes are kept.
    pub(super) fn restart(&mut self) {
        let below = self.trials.len().saturating_sub(2);
        self.coarsest = self.trials.get(below).map_or(LEVELS[0], |trial| trial.elements);
        self.trials.truncate(below);
        self.runs.clear();
        (self.passed, self.found) = (false, None);
    }

    /// Returns the finest run, if a mesh was found by it.
    pub(super) fn finest(&self) -> Option<&Rc<Run>> {
        self.runs.last().filter(|_| self.open && self.found.is_some())
    }

    /// Rejects the mesh found if its distance to a much finer run exceeds `aim`, and restarts at half the elements of that run.
    pub(super) fn reject(&mut self, finer: &Run, aim: f64) {
        let Some(error) = self
            .assessed()
            .map(|run| distance(run, finer))
            .filter(|error| *error > aim)
        else {
            return;
        };
        let halved = LEVELS.into_iter().rfind(|level| 2 * level <= finer.elements);
        self.coarsest = halved.unwrap_or(LEVELS[0]);
        if let Some(trial) = self.trials.last_mut() {
            trial.error = error;
        }
        self.runs.clear();
        (self.passed, self.found) = (false, None);
    }

    /// Returns whether a run with this number of elements [-] is needed.
    pub(super) fn needs(&self, elements: usize) -> bool {
        self.found.is_none() && elements >= self.coarsest
    }

    /// Returns whether finer runs are needed to reach a small enough error.
    pub(super) fn is_open(&self) -> bool {
        self.open && self.found.is_none()
    }

    /// Adds a finer run. Confirms the mesh that passed before it, or assesses the mesh with half the elements. A run on the same mesh as the previous
    /// one adds no information: short elements at clamps, touchdowns and ends of sections can make the meshes of several levels equal.
    pub(super) fn climb(&mut self, run: Rc<Run>, aim: f64) {
        if self.runs.last().is_some_and(|last| last.lengths == run.lengths) {
            return;
        }
        if !self.open {
            self.found = Some(run.elements);
        }
        self.runs.push(run);
        if self.is_confirmed(aim) {
            return self.settle();
        }
        let [.., coarse, middle, fine] = &self.runs[..] else {
            return;
        };
        let trial = Trial {
            elements: coarse.elements,
            error: estimated(coarse, middle, fine),
        };
        self.passed = trial.error <= aim;
        self.trials.push(trial);
        if !self.confirms {
            self.settle();
        }
    }

    /// Drops all runs after a finer mesh could not be solved.
    pub(super) fn drop_runs(&mut self) {
        self.runs.clear();
    }

    /// Compares the mesh that passed with the last run; returns whether its error remains small enough.
    fn is_confirmed(&mut self, aim: f64) -> bool {
        let ([.., passed, _, _, fine], Some(trial)) = (&self.runs[..], self.trials.last_mut()) else {
            return false;
        };
        if !self.passed || passed.elements != trial.elements {
            return false;
        }
        trial.error = trial.error.max(distance(passed, fine));
        trial.error <= aim
    }

    /// Adopts the mesh of the last trial if it passed.
    pub(super) fn settle(&mut self) {
        let last = self.trials.last().filter(|_| self.passed);
        self.found = self.found.or(last.map(|trial| trial.elements));
    }

    /// Returns the run on the mesh found, or else on the last one assessed.
    pub(super) fn assessed(&self) -> Option<&Run> {
        let elements = self.trials.last()?.elements;
        let run = self.runs.iter().find(|run| run.elements == elements)?;
        Some(run)
    }

    /// Sections that are one element on the finest mesh, by line and section.
    pub(super) fn short_sections(&self, scene: &Scene) -> Vec<(usize, usize)> {
        let of_run = |run: &Rc<Run>| short_sections::in_run(scene, &self.lines, run);
        self.runs.last().map_or(Vec::new(), of_run)
    }

    /// Estimated error of a run [-]: its distance to the finest run, with the factor given by the last three runs, or 1 where this is undefined. If
    /// the mesh is given, the error of the steps alone. `None` with too few runs.
    pub(super) fn error(&self, run: &Run) -> Option<f64> {
        let (coarse, middle, fine) = match &self.runs[..] {
            [.., coarse, middle, fine] => (coarse, middle, fine),
            [reference] if !self.open => return Some(distance(run, reference)),
            _ => return None,
        };
        let smooth = estimated(coarse, middle, fine) / distance(coarse, fine);
        Some(distance(run, fine) * if smooth.is_finite() { smooth } else { 1.0 })
    }

    /// Number of elements between the last level that is too coarse and the next one, if it is worth a trial.
    pub(super) fn between(&self, aim: f64) -> Option<usize> {
        let [.., before, found] = &self.trials[..] else {
            return None;
        };
        self.found?;
        let order = (before.error / found.error).ln() / (found.elements as f64 / before.elements as f64).ln();
        worthwhile(
            before.elements as f64 * (before.error / aim).powf(1.0 / order),
            found.elements,
        )
    }

    /// Number of elements halfway from a mesh that is too coarse to the one found, if it is worth a trial.
    pub(super) fn halfway(&self, coarse: usize) -> Option<usize> {
        let found = self.found?;
        worthwhile(((coarse * found) as f64).sqrt(), found)
    }

    /// A mesh that was tried and the levels between it and the finest, with their errors: as tried, or extrapolated at first order.
    pub(super) fn above(&self, mesh: &Mesh) -> Vec<Trial> {
        let least = FINER_RATIO * mesh.elements as f64;
        let finest = self.runs.last().map_or(0, |run| run.elements);
        let own = Trial {
            elements: mesh.elements,
            error: mesh.error,
        };
        let mut levels = vec![own];
        for elements in LEVELS {
            if (elements as f64) < least || elements >= finest {
                continue;
            }
            let known = self.trials.iter().find(|trial| trial.elements == elements);
            let coarser = levels[levels.len() - 1];
            let error = coarser.error * coarser.elements as f64 / elements as f64;
            levels.push(known.copied().unwrap_or(Trial { elements, error }));
        }
        levels
    }

    /// Returns the mesh that follows from the trials, with the error of a trial between levels if there is one; `None` before the first trial. The
    /// error of a given mesh is unknown and stated as 0.
    pub(super) fn mesh(&self, between: Option<Trial>, tolerance: f64) -> Option<Mesh> {
        if !self.open {
            return Some(Mesh::by_rule(self.lines.clone(), tolerance));
        }
        let last = self.trials.last()?;
        let (elements, error) = match (self.found, between) {
            (Some(_), Some(trial)) => (trial.elements, trial.error),
            (Some(_), None) => (last.elements, last.error),
            (None, _) => {
                let wanted = last.elements as f64 * last.error / (AIM * tolerance);
                let wanted = wanted.min(ELEMENTS_MAX);
                // as slow as the RMS of jumps whose instants are off by the time of an element
                let error = last.error * (last.elements as f64 / wanted).sqrt();
                (wanted.ceil() as usize, error)
            }
        };
        Some(Mesh {
            lines: self.lines.clone(),
            trials: self.trials.clone(),
            elements,
            error,
            tried: self.found.is_some(),
            still: self
                .runs
                .last()
                .is_some_and(|run| run.histories.iter().any(History::is_still)),
            lacks_waves: self.lacks_waves,
            short_sections: Some(1),
            rest: None,
        })
    }
}

/// Returns a number of elements, rounded up, if it is well below that of the mesh found.
fn worthwhile(elements: f64, found: usize) -> Option<usize> {
    let elements = elements.ceil() as usize;
    (elements as f64 <= FEWER * found as f64).then_some(elements)
}

/// Error of a run [-] that falls with the square of its steps or elements, from its distance to a run with half the step or twice the elements.
pub(super) fn smooth_error(run: &Run, halved: &Run) -> f64 {
    4.0 / 3.0 * distance(run, halved)
}

/// Error of the coarsest of three runs whose numbers of elements grow by √2 [-].
fn estimated(coarse: &Run, middle: &Run, fine: &Run) -> f64 {
    let whole = distance(coarse, fine);
    if whole == 0.0 {
        return 0.0;
    }
    let smooth = 2.0 - (distance(coarse, middle) / whole).min(1.0);
    (smooth * whole).max(distance(middle, fine))
}

/// RMS difference of two runs over the deviation of the second, or over the least deviation used, for the line where this ratio is greatest [-]: the
/// small variation of lines that hardly move needs no relative accuracy.
pub(super) fn distance(run: &Run, reference: &Run) -> f64 {
    let lines = run.histories.iter().zip(&reference.histories);
    let of_line = |(own, right): (&History, &History)| match right.deviation() {
        0.0 => 0.0,
        scale => own.difference(right) / scale,
    };
    lines.map(of_line).fold(0.0, f64::max)
}
