//! The meshes, integrator and step of a scene, by trial runs.

use super::history::History;
use super::{AIM, ELEMENTS_MAX, Mesh, Networks, Trial, elements_of, short_sections};
use crate::dynamics::{IMPLICIT_COST, axial_implicit_cost};
use crate::model::{Line, Model, Role};
use crate::scene::{Integrator, MotionPath, Scene, ToleranceOf};
use crate::simulation::{Error, Simulation};

/// Elements of a line alone that are tried [-].
const LADDER: [usize; 13] = [5, 7, 10, 14, 20, 28, 40, 56, 80, 112, 160, 224, 320];
/// Explicit steps of an element that all trials may take [-].
const WORK_MAX: f64 = 1e8;
/// The same where steps are fully implicit [-].
const IMPLICIT_WORK_MAX: f64 = 4e8;
/// Part of the tolerance for the error of the steps of the ladder [-].
const FINER: f64 = 0.25;
/// Elements of a line alone on which the step of the ladder is sought [-].
const COARSE: usize = 7;
/// Part of the cost below which another step is adopted [-].
const WORTH: f64 = 0.8;
/// Greatest ratio of errors over which a step is extrapolated [-].
const EXCESS_MAX: f64 = 100.0;
/// Halvings of the longest axial-implicit step that are tried [-].
const HALVINGS: u32 = 8;
/// Periods of the slowest sine that are tried, after the ramp [-].
const PERIODS: f64 = 20.0;
/// Time that is tried where the motion is a table, or of no period [s].
const DURATION: f64 = 200.0;
/// Samples in a period of the fastest sine, at least [-].
const SAMPLES: f64 = 25.0;
/// The same for a low-passed tension [-]. With fewer samples, slaps would be aliased to frequencies that pass the filter.
const SAMPLES_TO_FILTER: f64 = 100.0;
/// Samples in a period that are dense enough for a snap at any phase [-]. Fewer samples have other phases in every period.
const PHASES: f64 = 100.0;
/// Fraction of the interval by which the samples move from one period to the next [-]: 1 − 1/golden ratio, which spreads them evenly.
const SHIFT: f64 = 0.381_966;
/// Elements below those of the level that are worth a trial, over them [-].
const FEWER: f64 = 0.93;
/// Greatest number of trials of meshes between two levels [-].
const TRIALS_BETWEEN: usize = 2;
/// Ratio of the expected error to the one allowed, above which an option is not tried [-].
const EXPECTED_MAX: f64 = 1.2;
/// Least ratio of the elements of a finer option to those of the mesh found [-].
const FINER_RATIO: f64 = 1.08;

/// State of the search.
pub(super) struct Search<'a> {
    networks: &'a Networks,
    /// Scene with the duration and the samples of the trials.
    scene: Scene,
    /// First sample that is evaluated.
    from: usize,
    /// Longest step of the trials [s].
    longest_step: f64,
    /// Results of every network.
    ladders: Vec<Ladder>,
    /// True if a line may need fully implicit steps, for example because it bends. All networks are then run with the integrators that the rules choose.
    implicit: bool,
    /// Axial-implicit or fully implicit step whose error is small [s]; none where steps follow from the scene's integrator.
    step: Option<f64>,
    /// Explicit steps of an element so far [-].
    work: f64,
}

/// Trials of a network.
#[derive(Debug, Clone)]
struct Ladder {
    lines: Vec<usize>,
    runs: Vec<Run>,
    trials: Vec<Trial>,
    /// True if a mesh that passes is compared with one more level.
    confirms: bool,
    /// True if the error of the last trial is small enough. A run on the next level may still reject it.
    passed: bool,
    /// Elements whose error is small enough, once there are such [-].
    found: Option<usize>,
}

/// Result of one run for the lines of a network.
#[derive(Debug, Clone)]
pub(super) struct Run {
    elements: usize,
    /// Lengths of the elements of every line [m].
    pub(super) lengths: Vec<Vec<f64>>,
    /// History of every line after the start.
    histories: Vec<History>,
    /// Longest step of any network [s].
    step: f64,
}

/// Result of one run for all lines.
struct Record {
    /// Lengths of the elements of every line [m].
    lengths: Vec<Vec<f64>>,
    /// History of every line after the start.
    histories: Vec<History>,
    /// Longest step of any network [s].
    step: f64,
    /// Cost in explicit steps of an element [-].
    work: f64,
}

impl Ladder {
    fn new(lines: &[usize], confirms: bool) -> Ladder {
        Ladder {
            lines: lines.to_vec(),
            runs: Vec::new(),
            trials: Vec::new(),
            confirms,
            passed: false,
            found: None,
        }
    }

    /// Part of a run that belongs to this network.
    fn part(&self, elements: usize, record: &Record) -> Run {
        let lines = || self.lines.iter();
        Run {
            elements,
            lengths: lines().map(|&line| record.lengths[line].clone()).collect(),
            histories: lines().map(|&line| record.histories[line].clone()).collect(),
            step: record.step,
        }
    }

    /// Adds a finer run, and confirms the mesh that passed before it, or assesses the mesh of half its elements. A run on the same mesh as
    /// the one before adds no information: short elements at clamps, touchdowns and ends of sections can make the meshes of several levels equal.
    fn climb(&mut self, run: Run, aim: f64) {
        if self.runs.last().is_some_and(|last| last.lengths == run.lengths) {
            return;
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

    /// Compares the mesh that passed with the last run; returns whether its error is still small enough.
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

    /// Takes the mesh of the last trial if that passed.
    fn settle(&mut self) {
        let last = self.trials.last().filter(|_| self.passed);
        self.found = self.found.or(last.map(|trial| trial.elements));
    }

    /// Error of a run [-], of the order of the last three runs, 1 where it is unknown.
    fn error(&self, run: &Run) -> Option<f64> {
        let [.., coarse, middle, fine] = &self.runs[..] else {
            return None;
        };
        let smooth = estimated(coarse, middle, fine) / distance(coarse, fine);
        Some(distance(run, fine) * if smooth.is_finite() { smooth } else { 1.0 })
    }

    /// Elements of the coarsest run: networks do not affect each other, so one that needs no further run costs least with these.
    fn coarsest(&self) -> usize {
        self.runs.first().map_or(LADDER[0], |run| run.elements)
    }

    /// Elements between a level that is too coarse and the next, which is not, where they are worth a trial.
    fn between(&self, aim: f64) -> Option<usize> {
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

    /// A mesh that was tried, and the levels between it and the finest, with their errors: as tried, or extrapolated at the first order.
    fn above(&self, mesh: &Mesh) -> Vec<Trial> {
        let least = FINER_RATIO * mesh.elements as f64;
        let finest = self.runs.last().map_or(0, |run| run.elements);
        let own = Trial {
            elements: mesh.elements,
            error: mesh.error,
        };
        let mut levels = vec![own];
        for elements in LADDER {
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

    /// Elements half-way from a mesh that is too coarse to the one found, where they are worth a trial.
    fn halfway(&self, coarse: usize) -> Option<usize> {
        let found = self.found?;
        worthwhile(((coarse * found) as f64).sqrt(), found)
    }

    /// Mesh that follows from the trials, with the error where it was tried between mesh levels; none before the
    /// first trial.
    fn mesh(&self, between: Option<Trial>, tolerance: f64) -> Option<Mesh> {
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
            short_sections: Some(1),
            rest: None,
        })
    }
}

impl<'a> Search<'a> {
    pub(super) fn new(scene: &Scene, model: &Model, networks: &'a Networks) -> Option<Search<'a>> {
        let leapfrog = matches!(
            scene.solver.integrator,
            Integrator::Auto | Integrator::Leapfrog | Integrator::AxialImplicit
        );
        if !leapfrog {
            return None;
        }
        let times = MotionTimes::of(scene)?;
        let implicit = may_need_implicit_steps(model);
        let output = &scene.output;
        let mut scene = scene.clone();
        scene.output.duration = output.duration.min(times.duration);
        let samples = match scene.solver.tolerance_of {
            ToleranceOf::LowPassedTension => SAMPLES_TO_FILTER,
            ToleranceOf::Tension | ToleranceOf::Position => SAMPLES,
        };
        let interval = output.interval.min(times.shortest / samples);
        scene.output.interval = spread(interval, times.shortest);
        let start = (0.5 * scene.output.duration).max(times.ramp.min(0.75 * scene.output.duration));
        Some(Search {
            from: (start / scene.output.interval) as usize,
            longest_step: scene.solver.time_step_max.min(interval),
            scene,
            ladders: ladders(networks, implicit),
            implicit,
            networks,
            step: None,
            work: 0.0,
        })
    }

    /// Explicit steps of an element that all trials may take [-].
    fn work_max(&self) -> f64 {
        if self.implicit {
            IMPLICIT_WORK_MAX
        } else {
            WORK_MAX
        }
    }

    /// Scene with the duration and the samples of the trials.
    pub(super) fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Scene with `elements` elements in every network.
    fn with(&self, elements: &[usize]) -> Scene {
        self.networks.with_elements(&self.scene, elements)
    }

    /// The same with axial-implicit steps [s], or fully implicit ones where these are needed.
    fn with_step(&self, elements: &[usize], step: f64) -> Scene {
        let mut scene = self.with(elements);
        if !self.implicit {
            scene.solver.integrator = Integrator::AxialImplicit;
        }
        scene.solver.time_step_max = step;
        scene
    }

    /// The same with steps that add little to the error of the mesh, explicit ones where they cost less.
    fn at_level(&self, elements: &[usize]) -> Scene {
        let mut scene = self.with(elements);
        if let Some(step) = self.step {
            if self.implicit {
                return self.with_step(elements, step);
            }
            let explicit = self.explicit_work(&scene);
            if explicit.is_some_and(|explicit| explicit.axial_implicit_work(step) < WORTH * explicit.work) {
                return self.with_step(elements, step);
            }
        }
        scene.solver.tolerance *= FINER;
        scene
    }

    /// Mesh of every network; none where the trials give no result.
    pub(super) fn meshes(&mut self) -> Option<Vec<Mesh>> {
        let tolerance = self.scene.solver.tolerance;
        self.step = self.coarse_step();
        let mut spent = self.climb(AIM * tolerance);
        while let Some(step) = self.step {
            let (excess, step) = self.excess(step);
            if excess <= 1.0 {
                break;
            }
            let shorter = 0.5_f64.powf((0.5 * excess.log2()).ceil()); // of second order at best
            if self.work + spent / shorter > self.work_max() {
                let part = 1.0 / excess.min(EXCESS_MAX);
                self.step = Some(part * step); // nodes that land leave the first order
                break;
            }
            self.step = Some(shorter * step);
            self.ladders = ladders(self.networks, self.implicit);
            spent = self.climb(AIM * tolerance);
        }
        let between = self.between(AIM * tolerance);
        let ladders = self.ladders.iter().zip(between);
        ladders
            .map(|(ladder, between)| ladder.mesh(between, tolerance))
            .collect()
    }

    /// Doubles the elements of sections that are one element on all levels, until their error and that of the mesh are within the tolerance together. Meshes
    /// on which they are not in the end count as not tried.
    pub(super) fn refine_short_sections(&mut self, meshes: &mut [Mesh]) {
        let ladders = self.ladders.iter();
        let runs = ladders.filter_map(|ladder| Some((&ladder.lines[..], ladder.runs.last()?)));
        let short = runs.flat_map(|(lines, run)| short_sections::in_run(&self.scene, lines, run));
        let short: Vec<(usize, usize)> = short.collect();
        if short.is_empty() {
            return;
        }
        let has_short = |mesh: &&mut Mesh| short.iter().any(|(line, _)| mesh.lines.contains(line));
        let tolerance = self.scene.solver.tolerance;
        let elements = elements_of(meshes);
        let mut errors = vec![f64::INFINITY; meshes.len()];
        let mut run = self.run(&self.at_level(&elements));
        for doubling in 1..=short_sections::DOUBLINGS {
            let finer = short_sections::with_elements(&self.scene, &short, 1 << doubling);
            let scene = std::mem::replace(&mut self.scene, finer);
            let finer = self.run(&self.at_level(&elements));
            let (Ok(Some(coarse)), Ok(Some(fine))) = (&run, &finer) else {
                self.scene = scene;
                break;
            };
            let parts = self.errors_of_short_sections(meshes, [coarse, fine]);
            let of_levels = meshes
                .iter()
                .map(|mesh| if mesh.tried { mesh.error } else { 0.0 });
            let pairs: Vec<(f64, f64)> = of_levels.zip(parts).collect();
            if pairs.iter().all(|(error, part)| error.hypot(*part) <= tolerance) {
                self.scene = scene;
                return;
            }
            errors = pairs
                .iter()
                .map(|(error, part)| error.hypot(0.25 * part))
                .collect();
            run = finer;
            for mesh in meshes.iter_mut().filter(has_short) {
                mesh.short_sections = Some(1 << doubling);
            }
        }
        for (mesh, error) in meshes.iter_mut().zip(errors) {
            if error.is_infinite() && has_short(&mesh) {
                mesh.short_sections = None;
            } else if error.is_finite() && error > tolerance {
                (mesh.error, mesh.tried) = (error.max(mesh.error), false);
            }
        }
    }

    /// Error of the first of two runs for the lines of every mesh, the second having twice the elements in some sections [-].
    fn errors_of_short_sections(&self, meshes: &[Mesh], runs: [&Record; 2]) -> Vec<f64> {
        let ladders = self.ladders.iter().zip(meshes);
        let error = |(ladder, mesh): (&Ladder, &Mesh)| {
            let [coarse, fine] = runs.map(|record| ladder.part(mesh.elements, record));
            smooth_error(&coarse, &fine)
        };
        ladders.map(error).collect()
    }

    /// Longest axial-implicit step whose error on a coarse mesh is small [s], none where explicit steps cost less; the longest step allowed where steps
    /// are fully implicit.
    fn coarse_step(&mut self) -> Option<f64> {
        if self.scene.solver.integrator != Integrator::Auto {
            return None;
        }
        if self.implicit {
            return Some(self.longest_step);
        }
        let elements = vec![COARSE; self.ladders.len()];
        let explicit = self.explicit_work(&self.with(&elements))?;
        let mut step = self.longest_step;
        let mut run = self.run(&self.with_step(&elements, step)).ok()??;
        for _ in 0..HALVINGS {
            let finer = self.run(&self.with_step(&elements, 0.5 * step)).ok()??;
            let errors = self.ladders.iter().map(|ladder| {
                let [run, finer] = [&run, &finer].map(|record| ladder.part(COARSE, record));
                smooth_error(&run, &finer)
            });
            if errors.fold(0.0, f64::max) <= FINER * self.scene.solver.tolerance {
                return Some(step);
            }
            if finer.work > WORTH * explicit.work {
                return None;
            }
            (step, run) = (0.5 * step, finer);
        }
        None
    }

    /// Ratio of the error of implicit steps of at most `step` [s] to the part of the tolerance that it may take [-], on the meshes found, or else on the
    /// last ones assessed, and the longest of these steps [s]; 0 where the error cannot be determined.
    fn excess(&mut self, step: f64) -> (f64, f64) {
        let assessed = |ladder: &Ladder| ladder.trials.last().map(|trial| trial.elements);
        let elements = self
            .ladders
            .iter()
            .map(|ladder| assessed(ladder).unwrap_or(LADDER[0]));
        let elements: Vec<usize> = elements.collect();
        let mut scene = self.at_level(&elements);
        if !self.implicit && scene.solver.integrator != Integrator::AxialImplicit {
            return (0.0, step);
        }
        let same =
            |ladder: &Ladder, elements: usize| ladder.runs.iter().position(|run| run.elements == elements);
        let taken = self.ladders.iter().zip(&elements);
        let taken = taken.filter_map(|(ladder, &elements)| Some(ladder.runs[same(ladder, elements)?].step));
        let step = taken.reduce(f64::max).unwrap_or(step);
        scene.solver.time_step_max = 0.5 * step;
        let Ok(Some(record)) = self.run(&scene) else {
            return (0.0, step);
        };
        let most = FINER * self.scene.solver.tolerance;
        let errors = self
            .ladders
            .iter()
            .zip(elements)
            .filter_map(|(ladder, elements)| {
                let same = &ladder.runs[same(ladder, elements)?];
                Some(smooth_error(same, &ladder.part(elements, &record)))
            });
        (errors.fold(0.0, f64::max) / most, step)
    }

    /// Runs the scene with more and more elements in those networks that need them. Returns the cost in explicit steps of an element [-].
    fn climb(&mut self, aim: f64) -> f64 {
        let before = self.work;
        let mut last = 0.0;
        for level in LADDER {
            let open = self.ladders.iter().any(|ladder| ladder.found.is_none());
            if !open || self.work + 2.0 * last > self.work_max() {
                break;
            }
            let elements = self.ladders.iter().map(|ladder| match ladder.found {
                Some(_) => ladder.coarsest(),
                None => level,
            });
            let elements: Vec<usize> = elements.collect();
            let record = match self.run(&self.at_level(&elements)) {
                Ok(Some(record)) => Some(record),
                Ok(None) => break,
                Err(_) => None, // too coarse to be solved
            };
            last = record.as_ref().map_or(0.0, |record| record.work);
            for ladder in self.ladders.iter_mut().filter(|ladder| ladder.found.is_none()) {
                match &record {
                    Some(record) => ladder.climb(ladder.part(level, record), aim),
                    None => ladder.runs.clear(),
                }
            }
        }
        self.ladders.iter_mut().for_each(Ladder::settle);
        self.work - before
    }

    /// Runs the scene up to twice with elements between mesh levels where they are worth a trial; the trials that keep the error.
    fn between(&mut self, aim: f64) -> Vec<Option<Trial>> {
        let mut wanted: Vec<Option<usize>> = self.ladders.iter().map(|ladder| ladder.between(aim)).collect();
        let mut trials = vec![None; wanted.len()];
        for _ in 0..TRIALS_BETWEEN {
            if wanted.iter().all(Option::is_none) {
                break;
            }
            let ladders = self.ladders.iter().zip(&wanted);
            let elements = ladders.map(|(ladder, wanted)| wanted.unwrap_or_else(|| ladder.coarsest()));
            let elements: Vec<usize> = elements.collect();
            let Ok(Some(record)) = self.run(&self.at_level(&elements)) else {
                break;
            };
            for ((ladder, wanted), kept) in self.ladders.iter().zip(&mut wanted).zip(&mut trials) {
                let Some(elements) = wanted.take() else { continue };
                let error = ladder.error(&ladder.part(elements, &record));
                match error.filter(|error| *error <= aim) {
                    Some(error) => *kept = Some(Trial { elements, error }),
                    None => *wanted = ladder.halfway(elements),
                }
            }
        }
        trials
    }

    /// The scene with a mesh for every network, and the cheapest integrator and step that keep the error, where these meshes were `tried`; longer steps on finer
    /// meshes may be cheaper, which then replace them.
    pub(super) fn settled(&mut self, meshes: &mut [Mesh], tried: bool) -> Scene {
        let elements = &elements_of(meshes)[..];
        let mut scene = self.with(elements);
        if scene.solver.integrator != Integrator::Auto {
            return scene;
        }
        if self.implicit {
            let step = self.step.unwrap_or(scene.solver.time_step_max);
            return self.with_step(elements, step);
        }
        if !tried {
            return scene;
        }
        let Some((step, trials)) = self.axial_implicit(meshes) else {
            scene.solver.integrator = Integrator::Leapfrog;
            return scene;
        };
        for (mesh, trial) in meshes.iter_mut().zip(trials) {
            (mesh.elements, mesh.error) = (trial.elements, trial.error);
        }
        scene = self.with(&elements_of(meshes));
        scene.solver.integrator = Integrator::AxialImplicit;
        scene.solver.time_step_max = step;
        scene
    }

    /// The cheapest axial-implicit steps [s] that keep the error, on these meshes or on finer ones, where they cost less than explicit ones, with the trials of the
    /// meshes. Errors of meshes and steps add as squares, so that a failed trial gives the error of its step; options that are expected to fail by it
    /// are left out.
    fn axial_implicit(&mut self, meshes: &[Mesh]) -> Option<(f64, Vec<Trial>)> {
        let explicit = self.explicit_work(&self.with(&elements_of(meshes)))?;
        let (most, aim) = (WORTH * explicit.work, AIM * self.scene.solver.tolerance);
        let mut parts: Vec<(f64, Vec<f64>)> = Vec::new();
        for (step, expected) in self.options(meshes, &explicit, most) {
            let fails = |(mesh, part): (&Trial, &f64)| mesh.error.hypot(*part) > EXPECTED_MAX * aim;
            let fails = |(_, part): &(f64, Vec<f64>)| expected.iter().zip(part).any(fails);
            if parts.iter().filter(|(tried, _)| *tried <= step).any(fails) {
                continue;
            }
            let trials = self.trials_with(&expected, step, most)?;
            if trials.iter().all(|trial| trial.error <= aim) {
                return Some((step, trials));
            }
            let part = |(trial, mesh): (&Trial, &Trial)| {
                let square = trial.error.powi(2) - mesh.error.powi(2);
                square.max(0.0).sqrt()
            };
            parts.push((step, trials.iter().zip(&expected).map(part).collect()));
        }
        None
    }

    /// Axial-implicit steps [s] and meshes, with the errors of the meshes, in the order of their cost up to `most`: the meshes found, and those of the levels
    /// between them and the finest.
    fn options(&self, meshes: &[Mesh], explicit: &Explicit, most: f64) -> Vec<(f64, Vec<Trial>)> {
        let of_ladder = |(ladder, mesh): (&Ladder, &Mesh)| ladder.above(mesh);
        let levels: Vec<Vec<Trial>> = self.ladders.iter().zip(meshes).map(of_ladder).collect();
        let segments: usize = meshes.iter().map(|mesh| mesh.elements).sum();
        let mut options = Vec::new();
        for k in 0..levels.iter().map(Vec::len).max().unwrap_or(0) {
            let at = |levels: &Vec<Trial>| levels[k.min(levels.len() - 1)];
            let trials: Vec<Trial> = levels.iter().map(at).collect();
            let finer: usize = trials.iter().map(|trial| trial.elements).sum();
            let ratio = finer as f64 / segments as f64;
            for halving in 0..=HALVINGS {
                let step = 0.5_f64.powi(halving as i32) * self.longest_step;
                options.push((ratio * explicit.axial_implicit_work(step), step, trials.clone()));
            }
        }
        options.retain(|(work, ..)| *work <= most);
        options.sort_by(|a, b| a.0.total_cmp(&b.0));
        options
            .into_iter()
            .map(|(_, step, trials)| (step, trials))
            .collect()
    }

    /// Errors of meshes with axial-implicit steps [s], infinite where they cost more than `most` or are unknown; none where the run fails.
    fn trials_with(&mut self, meshes: &[Trial], step: f64, most: f64) -> Option<Vec<Trial>> {
        let elements: Vec<usize> = meshes.iter().map(|mesh| mesh.elements).collect();
        let record = self.run(&self.with_step(&elements, step)).ok()??;
        let trial = |(ladder, elements): (&Ladder, usize)| {
            let error = ladder.error(&ladder.part(elements, &record));
            let error = error.filter(|_| record.work <= most).unwrap_or(f64::INFINITY);
            Trial { elements, error }
        };
        Some(self.ladders.iter().zip(elements).map(trial).collect())
    }

    /// Cost of explicit steps; none where the axial-implicit leapfrog is not applicable.
    fn explicit_work(&self, scene: &Scene) -> Option<Explicit> {
        let simulation = Simulation::new(scene).ok()?;
        let model = simulation.model();
        if model.lines.iter().any(|line| line.winch.is_some()) {
            return None;
        }
        let limits = simulation.choices().map(|choice| choice.explicit.step);
        let limit = limits.fold(scene.solver.time_step_max, f64::min);
        let output = &scene.output;
        let steps = (output.interval / limit).ceil() * output.duration / output.interval;
        let segments: usize = model.lines.iter().map(|line| line.segment_count()).sum();
        Some(Explicit {
            work: steps * segments as f64,
            axial_work: axial_implicit_cost(model.lines.iter()) * segments as f64 * output.duration,
        })
    }

    /// Runs a scene; none where its lines need an integrator that is not tried.
    fn run(&mut self, scene: &Scene) -> Result<Option<Record>, Error> {
        let mut simulation = Simulation::new(scene)?;
        simulation.follow_scene()?;
        let mut weight = 0.0_f64;
        for choice in simulation.choices() {
            weight = weight.max(match choice.integrator {
                Integrator::Leapfrog => 1.0,
                Integrator::AxialImplicit => axial_implicit_cost(simulation.model().lines.iter()),
                Integrator::GeneralisedAlpha if self.implicit => IMPLICIT_COST,
                _ => return Ok(None),
            });
        }
        let model = simulation.model();
        let segments: usize = model.lines.iter().map(|line| line.segment_count()).sum();
        let lengths = |line: &Line| line.segments.length.clone();
        let mut record = Record {
            lengths: model.lines.iter().map(lengths).collect(),
            histories: (0..model.lines.len())
                .map(|line| History::of(scene, model, line))
                .collect(),
            step: simulation
                .choices()
                .map(|choice| choice.longest)
                .fold(0.0, f64::max),
            work: 0.0,
        };
        let output = &scene.output;
        for sample in 0..(output.duration / output.interval).round() as usize {
            let broken = simulation.advance(output.interval).is_err();
            if broken || self.work + record.work > 2.0 * self.work_max() {
                return Ok(None);
            }
            record.work += weight * (simulation.substeps() * segments) as f64;
            if sample < self.from {
                continue;
            }
            let histories = record.histories.iter_mut().enumerate();
            histories.for_each(|(line, history)| history.add(&simulation, line));
        }
        record.histories.iter_mut().for_each(History::complete);
        self.work += record.work;
        Ok(Some(record))
    }
}

/// A number of elements, rounded up, where it is well below those of the mesh found.
fn worthwhile(elements: f64, found: usize) -> Option<usize> {
    let elements = elements.ceil() as usize;
    (elements as f64 <= FEWER * found as f64).then_some(elements)
}

/// Cost of explicit steps of a scene.
struct Explicit {
    /// Explicit steps of an element [-].
    work: f64,
    /// Cost of axial-implicit steps times their length [s].
    axial_work: f64,
}

impl Explicit {
    /// Cost of axial-implicit steps of a length [s], in explicit steps of an element [-].
    fn axial_implicit_work(&self, step: f64) -> f64 {
        self.axial_work / step
    }
}

/// Speed and duration of a scene's motion.
struct MotionTimes {
    /// Shortest period [s].
    shortest: f64,
    /// Time after which the motion is fully developed [s].
    ramp: f64,
    /// Time over which errors are evaluated [s].
    duration: f64,
}

impl MotionTimes {
    /// None for a scene that gives no motion.
    fn of(scene: &Scene) -> Option<MotionTimes> {
        scene.motions().next()?;
        let in_waves = scene.water.as_ref().is_some_and(|water| water.waves.is_some());
        let ramps = scene.motions().map(|path| match path {
            MotionPath::Harmonic(motion) => Some(motion.ramp.unwrap_or(0.0)),
            MotionPath::File(_) | MotionPath::Table(_) => None,
        });
        let ramps: Vec<Option<f64>> = ramps.collect();
        let ramp = ramps.iter().flatten().copied().fold(0.0, f64::max);
        let slowest = scene.periods().reduce(f64::max);
        let duration = match slowest {
            Some(period) if !in_waves && ramps.iter().all(Option::is_some) => PERIODS * period,
            _ => DURATION,
        };
        Some(MotionTimes {
            shortest: scene.periods().fold(f64::INFINITY, f64::min),
            ramp,
            duration: ramp + duration,
        })
    }
}

/// Returns an interval of samples [s] for a motion of a period [s], a little shorter where so few samples would miss the same snap in every period.
fn spread(interval: f64, period: f64) -> f64 {
    let samples = period / interval;
    if samples < PHASES {
        period / (samples.ceil() + SHIFT)
    } else {
        interval
    }
}

/// Ladders of all networks before their first run.
fn ladders(networks: &Networks, confirms: bool) -> Vec<Ladder> {
    let lines = networks.lines.iter();
    lines.map(|lines| Ladder::new(lines, confirms)).collect()
}

/// Returns whether a line, though no beam, cannot take the steps of a leapfrog, or bends: short elements then cost less in fully implicit steps.
fn may_need_implicit_steps(model: &Model) -> bool {
    let mut lines = model.lines.iter();
    lines.any(|line| line.beam.is_none() && (line.bending.is_some() || !line.serves_leapfrog()))
}

/// End of a line that is moved, 0 for A; B where both or none are.
pub(super) fn driven(model: &Model, line: usize) -> usize {
    let moved = |end: usize| {
        let role = &model.points[model.lines[line].ends[end]].role;
        matches!(
            role,
            Role::Coupled { .. } | Role::Carried { .. } | Role::Prescribed(_)
        )
    };
    usize::from(!moved(0) || moved(1))
}

/// Error of a run [-] that falls with the square of its steps or elements, by comparison with one with half of them.
fn smooth_error(run: &Run, halved: &Run) -> f64 {
    4.0 / 3.0 * distance(run, halved)
}

/// Error of the coarsest of three runs whose elements grow by √2 [-].
fn estimated(coarse: &Run, middle: &Run, fine: &Run) -> f64 {
    let whole = distance(coarse, fine);
    if whole == 0.0 {
        return 0.0;
    }
    let smooth = 2.0 - (distance(coarse, middle) / whole).min(1.0);
    (smooth * whole).max(distance(middle, fine))
}

/// RMS of the difference of two runs over the deviation of the second, or the least that counts if that is more [-], of the line where it is
/// greatest: lines that hardly move need no relative accuracy of their small variation.
fn distance(run: &Run, reference: &Run) -> f64 {
    let lines = run.histories.iter().zip(&reference.histories);
    let of_line = |(own, right): (&History, &History)| match right.deviation() {
        0.0 => 0.0,
        scale => own.difference(right) / scale,
    };
    lines.map(of_line).fold(0.0, f64::max)
}
