//! Search for the meshes, integrator and step of a scene by trial runs.

use std::rc::Rc;

use super::ladder::{LEVELS, Ladder, distance, smooth_error};
use super::trials::{Run, Steps, Trials};
use super::{AIM, Mesh, Networks, Trial, elements_of, short_sections};
use crate::dynamics::axial_implicit_cost;
use crate::model::Model;
use crate::scene::{Integrator, Scene};
use crate::simulation::Simulation;

/// Fraction of the tolerance allowed for the error of the steps in the runs of the mesh levels [-].
const FINER: f64 = 0.25;
/// Elements of an isolated line on which the step for the mesh levels is determined [-].
const COARSE: usize = 7;
/// Fraction of the cost below which another step is adopted [-].
const WORTH: f64 = 0.8;
/// Greatest ratio of errors over which a step is extrapolated [-].
const EXCESS_MAX: f64 = 100.0;
/// Greatest number of halvings of the longest axial-implicit step [-].
const HALVINGS: u32 = 8;
/// Fraction of the tolerance allowed for the error of axial-implicit steps on a mesh that was not tried [-].
const UNTRIED: f64 = 0.5;
/// Number of axial-implicit steps that are compared with explicit ones for a mesh that was not tried [-].
const STEPS_UNTRIED: u32 = 6;
/// Ratio of each of these steps to the one before [-].
const SHORTER: f64 = 0.7;
/// Greatest number of trials between two mesh levels [-].
const TRIALS_BETWEEN: usize = 2;
/// Ratio of the expected to the allowed error above which an option is not tried [-].
const EXPECTED_MAX: f64 = 1.2;

/// State of the search.
pub(super) struct Search<'a> {
    trials: Trials<'a>,
    /// Mesh levels of every network.
    ladders: Vec<Ladder>,
    /// Axial-implicit or fully implicit step whose error is small [s]; `None` if steps follow from the scene's integrator.
    step: Option<f64>,
    /// True if the error of the steps found could not be tried.
    pub(super) untried_steps: bool,
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
        let trials = Trials::new(scene, model, networks)?;
        let lines = networks.lines.iter().zip(&networks.open);
        let ladders = lines.map(|(lines, &open)| Ladder::new(lines, open, trials.implicit));
        Some(Search {
            ladders: ladders.collect(),
            trials,
            step: None,
            untried_steps: false,
        })
    }

    /// Scene with the duration and the samples of the trials.
    pub(super) fn scene(&self) -> &Scene {
        self.trials.scene()
    }

    fn tolerance(&self) -> f64 {
        self.scene().solver.tolerance
    }

    /// Steps of the scene's integrator by rule, with a small error.
    fn by_rule(&self) -> Steps {
        Steps {
            integrator: self.scene().solver.integrator,
            longest: self.scene().solver.time_step_max,
            tolerance: FINER * self.tolerance(),
        }
    }

    /// Axial-implicit steps [s], or fully implicit ones if these are needed.
    fn implicit(&self, step: f64) -> Steps {
        Steps {
            integrator: match self.trials.implicit {
                true => self.scene().solver.integrator,
                false => Integrator::AxialImplicit,
            },
            longest: step,
            tolerance: self.tolerance(),
        }
    }

    /// Steps that add little to the error of a mesh: explicit if these cost less.
    fn at_level(&self, elements: &[usize]) -> Steps {
        match self.step {
            Some(step) if self.trials.implicit || self.saves(elements, step) => self.implicit(step),
            _ => self.by_rule(),
        }
    }

    /// Returns whether axial-implicit steps [s] cost considerably less than explicit ones.
    fn saves(&self, elements: &[usize], step: f64) -> bool {
        let explicit = self.explicit_cost(elements);
        explicit.is_some_and(|explicit| explicit.axial_implicit_work(step) < WORTH * explicit.work)
    }

    /// Returns the mesh of every network; `None` if the trials give no result.
    pub(super) fn meshes(&mut self) -> Option<Vec<Mesh>> {
        let tolerance = self.tolerance();
        self.step = self.coarse_step();
        self.find_meshes(AIM * tolerance);
        if self.rejects_without_short_waves(AIM * tolerance) {
            self.find_meshes(AIM * tolerance);
        }
        let between = self.between(AIM * tolerance);
        let ladders = self.ladders.iter().zip(between);
        ladders
            .map(|(ladder, between)| ladder.mesh(between, tolerance))
            .collect()
    }

    /// Refines the meshes until their errors are small enough, and shortens implicit steps until theirs are on these meshes.
    fn find_meshes(&mut self, aim: f64) {
        let mut spent = self.climb(aim);
        while let Some(step) = self.step {
            let (excess, step) = self.excess(step);
            if excess <= 1.0 {
                break;
            }
            let shorter = 0.5_f64.powf((0.5 * excess.log2()).ceil()); // at best second order
            if !self.trials.allow(spent / shorter) {
                let part = 1.0 / excess.min(EXCESS_MAX);
                self.step = Some(part * step); // landing nodes leave the error at first order
                break;
            }
            self.step = Some(shorter * step);
            self.ladders.iter_mut().for_each(Ladder::restart);
            spent = self.climb(aim);
        }
    }

    /// Doubles the elements of sections that are one element on all levels, until their error together with that of the mesh is within the tolerance.
    /// Meshes that still exceed the tolerance are marked as not tried.
    pub(super) fn refine_short_sections(&mut self, meshes: &mut [Mesh]) {
        let ladders = self.ladders.iter();
        let short = ladders.flat_map(|ladder| ladder.short_sections(self.scene()));
        let short: Vec<(usize, usize)> = short.collect();
        if short.is_empty() {
            return;
        }
        let has_short = |mesh: &&mut Mesh| short.iter().any(|(line, _)| mesh.lines.contains(line));
        let tolerance = self.tolerance();
        let mut errors = vec![f64::INFINITY; meshes.len()];
        let mut runs = self.run_on(meshes);
        for doubling in 1..=short_sections::DOUBLINGS {
            let finer = short_sections::with_elements(self.scene(), &short, 1 << doubling);
            let scene = self.trials.replace_scene(finer);
            let finer = self.run_on(meshes);
            let (Some(coarse), Some(fine)) = (&runs, &finer) else {
                self.trials.replace_scene(scene);
                break;
            };
            let parts = coarse
                .iter()
                .zip(fine)
                .map(|(coarse, fine)| smooth_error(coarse, fine));
            let of_levels = meshes
                .iter()
                .map(|mesh| if mesh.tried { mesh.error } else { 0.0 });
            let pairs: Vec<(f64, f64)> = of_levels.zip(parts).collect();
            if pairs.iter().all(|(error, part)| error.hypot(*part) <= tolerance) {
                self.trials.replace_scene(scene);
                return;
            }
            errors = pairs
                .iter()
                .map(|(error, part)| error.hypot(0.25 * part))
                .collect();
            runs = finer;
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

    /// Runs on these meshes; `None` if they give no result.
    fn run_on(&mut self, meshes: &[Mesh]) -> Option<Vec<Rc<Run>>> {
        let elements = elements_of(meshes);
        self.trials.run(&elements, self.at_level(&elements)).ok()?
    }

    /// Longest axial-implicit step whose error on a coarse mesh is small [s], `None` if explicit steps cost less; the longest step allowed if steps
    /// are fully implicit.
    fn coarse_step(&mut self) -> Option<f64> {
        if self.scene().solver.integrator != Integrator::Auto {
            return None;
        }
        let mut step = self.trials.longest_step;
        if self.trials.implicit {
            return Some(step);
        }
        let elements = vec![COARSE; self.ladders.len()];
        let explicit = self.explicit_cost(&elements)?;
        let mut runs = self.trials.run(&elements, self.implicit(step)).ok()??;
        for _ in 0..HALVINGS {
            let finer = self.trials.run(&elements, self.implicit(0.5 * step)).ok()??;
            let errors = runs
                .iter()
                .zip(&finer)
                .map(|(run, finer)| smooth_error(run, finer));
            if errors.fold(0.0, f64::max) <= FINER * self.tolerance() {
                return Some(step);
            }
            if work(&finer) > WORTH * explicit.work {
                return None;
            }
            (step, runs) = (0.5 * step, finer);
        }
        None
    }

    /// Ratio of the error of implicit steps of at most `step` [s] to the part of the tolerance allowed for it [-], on the meshes found or else the
    /// last ones assessed, and the longest of these steps [s]. The ratio is 0 if the error cannot be determined.
    fn excess(&mut self, step: f64) -> (f64, f64) {
        let elements = self.assessed();
        let steps = self.at_level(&elements);
        if !self.trials.implicit && steps.integrator != Integrator::AxialImplicit {
            return (0.0, step);
        }
        let taken = self
            .ladders
            .iter()
            .filter_map(|ladder| Some(ladder.assessed()?.step));
        let step = taken.reduce(f64::max).unwrap_or(step);
        let Ok(Some(halved)) = self.trials.run(&elements, self.implicit(0.5 * step)) else {
            return (0.0, step);
        };
        let most = FINER * self.tolerance();
        let ladders = self.ladders.iter().zip(&halved);
        let errors = ladders.filter_map(|(ladder, halved)| Some(smooth_error(ladder.assessed()?, halved)));
        (errors.fold(0.0, f64::max) / most, step)
    }

    /// Compares the meshes found with finer ones if none of their runs carries waves across the lines with the shortest period of the motion: meshes
    /// without these waves agree with one another. Returns whether a mesh was rejected. Meshes without such a run are marked.
    fn rejects_without_short_waves(&mut self, aim: f64) -> bool {
        let needed = self.needed_for_short_waves();
        if needed.is_empty() {
            return false;
        }
        let mut elements: Vec<usize> = (0..needed.len())
            .map(|network| self.trials.coarsest(network))
            .collect();
        let mut work = 0.0;
        for (network, needed) in needed.iter().enumerate() {
            let Some(finest) = self.ladders[network].finest() else {
                continue;
            };
            let mut levels = LEVELS.into_iter().filter(|level| *level > finest.elements);
            let level = levels.find(|level| *level as f64 >= *needed);
            if let (true, Some(level)) = (*needed > finest.elements as f64, level) {
                elements[network] = level;
                work += finest.work * (level as f64 / finest.elements as f64).powi(2);
            }
        }
        let runs = match work > 0.0 && self.trials.allow(work) {
            true => self
                .trials
                .run(&elements, self.at_level(&elements))
                .ok()
                .flatten(),
            false => None,
        };
        let runs = runs.as_deref().unwrap_or_default();
        for (network, ladder) in self.ladders.iter_mut().enumerate() {
            let Some(finest) = ladder.finest().map(|run| run.elements) else {
                continue;
            };
            match runs.get(network).filter(|run| run.elements > finest) {
                Some(finer) => ladder.reject(finer, aim),
                None => {
                    ladder.lacks_waves = needed[network] > finest as f64;
                }
            }
        }
        self.ladders.iter().any(Ladder::is_open)
    }

    /// Elements of each network that carry waves across its lines with the shortest period of the motion [-]; empty if a mesh is not found or the motion
    /// has no period.
    fn needed_for_short_waves(&self) -> Vec<f64> {
        let period = self.scene().periods().reduce(f64::min);
        let Some(period) = period.filter(|_| !self.ladders.iter().any(Ladder::is_open)) else {
            return Vec::new();
        };
        let found = self.assessed();
        let Ok(simulation) = Simulation::new(&self.trials.with(&found)) else {
            return Vec::new();
        };
        let of_network = |(network, found): (usize, &usize)| {
            *found as f64 * self.trials.steepness(&simulation, network, period)
        };
        found.iter().enumerate().map(of_network).collect()
    }

    /// Elements of the meshes found, or else of the last ones assessed.
    fn assessed(&self) -> Vec<usize> {
        let runs = self.ladders.iter().map(Ladder::assessed);
        runs.map(|run| run.map_or(LEVELS[0], |run| run.elements))
            .collect()
    }

    /// Runs the scene with increasing numbers of elements in the networks that need them. Returns the cost in explicit steps of an element [-].
    fn climb(&mut self, aim: f64) -> f64 {
        let before = self.trials.work();
        let mut last = 0.0;
        for level in LEVELS {
            if !self.ladders.iter().any(Ladder::is_open) || !self.trials.allow(2.0 * last) {
                break;
            }
            if !self.ladders.iter().any(|ladder| ladder.needs(level)) {
                continue;
            }
            let ladders = self.ladders.iter().enumerate();
            let elements = ladders.map(|(i, ladder)| match ladder.needs(level) {
                true => level,
                false => self.trials.coarsest(i),
            });
            let elements: Vec<usize> = elements.collect();
            let spent = self.trials.work();
            let runs = match self.trials.run(&elements, self.at_level(&elements)) {
                Ok(Some(runs)) => Some(runs),
                Ok(None) => break,
                Err(_) => None, // too coarse to be solved
            };
            last = self.trials.work() - spent;
            for (i, ladder) in self.ladders.iter_mut().enumerate() {
                match &runs {
                    _ if !ladder.needs(level) => {}
                    Some(runs) => ladder.climb(Rc::clone(&runs[i]), aim),
                    None => ladder.drop_runs(),
                }
            }
        }
        self.ladders.iter_mut().for_each(Ladder::settle);
        self.trials.work() - before
    }

    /// Runs the scene up to twice with numbers of elements between mesh levels if they are worth a trial; returns the trials that keep the error.
    fn between(&mut self, aim: f64) -> Vec<Option<Trial>> {
        let mut wanted: Vec<Option<usize>> = self.ladders.iter().map(|ladder| ladder.between(aim)).collect();
        let mut trials = vec![None; wanted.len()];
        for _ in 0..TRIALS_BETWEEN {
            if wanted.iter().all(Option::is_none) {
                break;
            }
            let networks = wanted.iter().enumerate();
            let elements = networks.map(|(i, wanted)| wanted.unwrap_or_else(|| self.trials.coarsest(i)));
            let elements: Vec<usize> = elements.collect();
            let Ok(Some(runs)) = self.trials.run(&elements, self.at_level(&elements)) else {
                break;
            };
            let ladders = self.ladders.iter().zip(&runs);
            for (((ladder, run), wanted), kept) in ladders.zip(&mut wanted).zip(&mut trials) {
                let Some(elements) = wanted.take() else { continue };
                match ladder.error(run).filter(|error| *error <= aim) {
                    Some(error) => *kept = Some(Trial { elements, error }),
                    None => *wanted = ladder.halfway(elements),
                }
            }
        }
        trials
    }

    /// Returns the scene with a mesh for every network and, if these meshes were `tried`, the cheapest integrator and step that keep the error. If
    /// longer steps on finer meshes are cheaper, the finer meshes replace `meshes`.
    pub(super) fn settled(&mut self, meshes: &mut [Mesh], tried: bool) -> Scene {
        let mut scene = self.trials.with(&elements_of(meshes));
        if scene.solver.integrator != Integrator::Auto {
            return scene;
        }
        if self.trials.implicit {
            let step = self.step.unwrap_or(scene.solver.time_step_max);
            return self.implicit(step).of(scene);
        }
        if !tried {
            // steps are not worth a trial on meshes that miss the tolerance
            let misses = meshes.iter().any(|mesh| mesh.error > self.tolerance());
            let found = (!misses).then(|| self.with_compared_steps(&scene)).flatten();
            self.untried_steps = found.is_none();
            return found.unwrap_or(scene);
        }
        let Some((step, trials)) = self.axial_implicit(meshes) else {
            scene.solver.integrator = Integrator::Leapfrog;
            return scene;
        };
        for (mesh, trial) in meshes.iter_mut().zip(trials) {
            (mesh.elements, mesh.error) = (trial.elements, trial.error);
        }
        self.implicit(step).of(self.trials.with(&elements_of(meshes)))
    }

    /// Chooses the steps of a scene whose meshes were not tried: those of the rules, or else shorter axial-implicit ones whose error is small on the finest
    /// meshes assessed, by comparison with explicit steps there, or else explicit steps. `None` if these runs fail or cost too much.
    fn with_compared_steps(&mut self, scene: &Scene) -> Option<Scene> {
        let simulation = Simulation::new(scene).ok()?;
        let choices = simulation.choices();
        let axial_implicit = choices.filter(|choice| choice.integrator == Integrator::AxialImplicit);
        let Some(longest) = axial_implicit.map(|choice| choice.step_max).reduce(f64::max) else {
            return Some(scene.clone());
        };
        let elements = self.assessed();
        if !self.trials.allow(self.explicit_cost(&elements)?.work) {
            return None;
        }
        let explicit = Steps {
            integrator: Integrator::Leapfrog,
            ..self.implicit(scene.solver.time_step_max)
        };
        let right = self.trials.run(&elements, explicit).ok()??;
        let mut step = longest;
        for shortening in 0..STEPS_UNTRIED {
            let steps = self.implicit(step);
            let runs = self.trials.run(&elements, steps).ok()??;
            let errors = runs.iter().zip(&right).map(|(run, right)| distance(run, right));
            if errors.fold(0.0, f64::max) <= UNTRIED * self.tolerance() {
                return Some(match shortening {
                    0 => scene.clone(),
                    _ => steps.of(scene.clone()),
                });
            }
            step = rounded_down(SHORTER * step);
        }
        Some(explicit.of(scene.clone()))
    }

    /// Returns the cheapest axial-implicit steps [s] that keep the error on these meshes or finer ones, with the trials of the meshes; `None` if they
    /// do not cost less than explicit ones. Errors of meshes and steps add as squares, so that a failed trial gives the error of its step; options
    /// expected to fail because of it are skipped.
    fn axial_implicit(&mut self, meshes: &[Mesh]) -> Option<(f64, Vec<Trial>)> {
        let explicit = self.explicit_cost(&elements_of(meshes))?;
        let (most, aim) = (WORTH * explicit.work, AIM * self.tolerance());
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

    /// Returns axial-implicit steps [s] and meshes with their errors, in order of cost up to `most`: the meshes found, and the levels between them
    /// and the finest.
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
                let step = 0.5_f64.powi(halving as i32) * self.trials.longest_step;
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

    /// Errors of meshes with axial-implicit steps [s], infinite if the steps cost more than `most` or the error is unknown; `None` if the run fails.
    fn trials_with(&mut self, meshes: &[Trial], step: f64, most: f64) -> Option<Vec<Trial>> {
        let elements: Vec<usize> = meshes.iter().map(|mesh| mesh.elements).collect();
        let runs = self.trials.run(&elements, self.implicit(step)).ok()??;
        let trial = |(ladder, run): (&Ladder, &Rc<Run>)| {
            let error = ladder.error(run).filter(|_| work(&runs) <= most);
            Trial {
                elements: run.elements,
                error: error.unwrap_or(f64::INFINITY),
            }
        };
        Some(self.ladders.iter().zip(&runs).map(trial).collect())
    }

    /// Cost of explicit steps; `None` if the axial-implicit leapfrog is not applicable.
    fn explicit_cost(&self, elements: &[usize]) -> Option<Explicit> {
        let simulation = Simulation::new(&self.trials.with(elements)).ok()?;
        let model = simulation.model();
        if model.lines.iter().any(|line| line.winch.is_some()) {
            return None;
        }
        let limits = simulation.choices().map(|choice| choice.explicit.step);
        let limit = limits.fold(self.scene().solver.time_step_max, f64::min);
        let output = &self.scene().output;
        let count = (output.interval / limit).ceil() * output.duration / output.interval;
        let segments: usize = model.lines.iter().map(|line| line.segment_count()).sum();
        Some(Explicit {
            work: count * segments as f64,
            axial_work: axial_implicit_cost(model.lines.iter()) * segments as f64 * output.duration,
        })
    }
}

/// Rounds a step [s] down to two significant digits.
fn rounded_down(step: f64) -> f64 {
    let per_unit = 10_f64.powf(1.0 - step.log10().floor());
    (per_unit * step).floor() / per_unit
}

/// Cost of the runs of all networks, in explicit steps of an element [-].
fn work(runs: &[Rc<Run>]) -> f64 {
    runs.iter().map(|run| run.work).sum()
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
