//! Mesh, integrator and step that keep a stated error, found by trying them on the scene's own motion.
//!
//! No rule from lengths, speeds and periods tells the error of a line that slackens and lands: n times the RMS error of the fairlead's
//! tension lies between 0.45 and 2 for chains of like shape and motion, and falls with n² where nothing slackens. So a scene that says
//! how it moves is run with a ladder of meshes, n_j = 5, 7, 10, 14 …, over a few of its periods. With the relative RMS distance d(j, k)
//! of two runs the error of the mesh n_j is taken to be
//!
//!   e_j = max(c d(j, j+2), d(j+1, j+2)),     c = 2 − min(1, d(j, j+1)/d(j, j+2)),
//!
//! n_{j+2} having twice the elements. Where the errors of the meshes have nothing to do with each other, d(j, j+2) ≈ e_j and
//! c ≈ 1; where they fall with n², d(j, j+2) = ¾ e_j, d(j, j+1) = ½ e_j and c = 4/3. On fifteen scenes and nine meshes d(j, j+2)/e_j was
//! 0.74 to 1.15 wherever the error is 0.5 % or more, but for a chain that snaps at n = 7 (0.65). The mesh is the coarsest whose e_j is
//! below a part of the tolerance, interpolated between the rungs and tried once more there.
//!
//! The axial-implicit leapfrog costs about three times as much a step as the explicit one. On the mesh found it is tried with steps from the
//! longest allowed down, as long as that is cheaper, and taken with the first step that keeps the error against the finest mesh; else
//! steps are explicit.
//!
//! All this is bounded, by a work of the order of a second, and the same on every machine. Beyond that the number of elements is extrapolated
//! from the last one tried, with an error that falls as 1/n. A scene whose motion is not known, whose elements are given or that needs another
//! integrator keeps the rule that elements follow from the tolerance alone. Whatever motion or rule ask for, elements are added until the tension at
//! rest is within the tolerance of the closed-form catenary, where there is one to compare with.

use super::{Error, Simulation};
use crate::dynamics::AXIAL_IMPLICIT_COST;
use crate::model::mesh::line_elements;
use crate::model::{Model, Network, Role};
use crate::scene::{InitialShape, Integrator, MotionPath, Scene, percent};

/// Elements of a line alone that are tried [-].
const LADDER: [usize; 13] = [5, 7, 10, 14, 20, 28, 40, 56, 80, 112, 160, 224, 320];
/// Part of the tolerance that the estimated error is to keep [-].
const AIM: f64 = 0.85;
/// The same where the elements are extrapolated and the steps follow a rule [-].
const AIM_UNTRIED: f64 = 0.7;
/// Most elements that are extrapolated to [-].
const ELEMENTS_MAX: f64 = 400.0;
/// Explicit steps of an element that all trials may take [-].
const WORK_MAX: f64 = 1e8;
/// Tolerance that the steps of the ladder are chosen by, over the scene's [-].
const FINER: f64 = 0.25;
/// Part of the cost below which another step is worth taking [-].
const WORTH: f64 = 0.8;
/// Halvings of the longest axial-implicit step that are tried [-].
const HALVINGS: u32 = 8;
/// Periods of the slowest sine that are tried, after the ramp [-].
const PERIODS: f64 = 20.0;
/// Time that is tried where the motion is a table, or of no period [s].
const DURATION: f64 = 200.0;
/// Samples in a period of the fastest sine, at least [-].
const SAMPLES: f64 = 25.0;
/// Standard deviation of a tension that its errors are told over at least, over its mean [-].
const STILL: f64 = 0.01;
/// Part of an error at rest that the most elements must take away to be worth it, where they do not keep the tolerance [-].
const GAIN: f64 = 0.5;
/// Elements below those of the rung that are worth a trial, over them [-].
const FEWER: f64 = 0.93;

/// A mesh that was tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial {
    /// Elements of a line alone [-].
    pub elements: usize,
    /// Estimated RMS error of the tension at the driven end, over the standard deviation of the line that moves most, or a hundredth of the
    /// mean of the one that pulls most [-].
    pub error: f64,
}

/// What the trials of a scene came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Settled {
    /// The scene with its elements and, where that is cheaper, the axial-implicit leapfrog with its step.
    pub scene: Scene,
    /// The meshes whose error could be estimated.
    pub trials: Vec<Trial>,
    /// Elements of a line alone [-].
    pub elements: usize,
    /// Estimated error with them [-].
    pub error: f64,
    /// Whether that mesh was tried, and not extrapolated to.
    pub tried: bool,
    /// Time of the scene that was tried [s].
    pub duration: f64,
    /// What asked for more elements than motion or rule, if anything did.
    pub rest: Option<Rest>,
}

/// Why a line at rest needs more elements than its motion, or a rule, asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest {
    /// Elements that motion or rule ask for [-].
    pub fewer: usize,
    /// Errors of the tension at the driven end with those and with the ones that are taken, over that of the catenary [-].
    pub errors: [f64; 2],
}

impl Settled {
    /// What was found, in words: one sentence each.
    pub fn in_words(&self) -> Vec<String> {
        let rounded = |part: f64| format!("{:.2} %", 100.0 * part);
        let tried = self.trials.iter().rev().take(4).rev();
        let tried: Vec<String> = tried
            .map(|trial| format!("{} with {}", rounded(trial.error), trial.elements))
            .collect();
        let solver = &self.scene.solver;
        let target = format!("for the target error of {}", percent(solver.tolerance));
        let mut said = Vec::new();
        if !tried.is_empty() {
            said.push(format!(
                "{} elements a line alone {target}, tried on {:.0} s of the scene's motion: errors of {}",
                self.rest.map_or(self.elements, |rest| rest.fewer),
                self.duration,
                tried.join(", ")
            ));
        }
        if let Some(rest) = self.rest {
            let [before, after] = rest.errors.map(rounded);
            said.push(format!(
                "{} elements a line alone {target}: at rest the tension would miss that of the catenary by {before} with {}, and misses it by {after}",
                self.elements, rest.fewer
            ));
        }
        if !self.tried {
            said.push(format!(
                "that is extrapolated, trials being bounded: about {} is expected",
                rounded(self.error)
            ));
        }
        if solver.integrator == Integrator::AxialImplicit {
            said.push(format!(
                "steps up to {} s with the axial tension implicit are cheaper than explicit ones, and as near; the limit that holds stands below",
                solver.time_step_max
            ));
        }
        said
    }
}

/// Tries a scene; none where there is nothing to choose or all is as rules say.
pub fn settle(scene: &Scene) -> Option<Settled> {
    tried_in_motion(scene).or_else(|| tried_at_rest(scene))
}

fn tried_in_motion(scene: &Scene) -> Option<Settled> {
    let mut search = Search::new(scene)?;
    let (moving, error, tried) = search.mesh()?;
    let (elements, rest) = elements_at_rest(scene, moving);
    let settled = if tried {
        search.with_integrator(elements)
    } else {
        search.with(elements)
    };
    Some(Settled {
        scene: Scene {
            output: scene.output.clone(),
            ..settled
        },
        trials: search.trials,
        elements,
        error,
        tried,
        duration: search.scene.output.duration,
        rest,
    })
}

/// The scene with more elements than the rule gives, where it needs them at rest.
fn tried_at_rest(scene: &Scene) -> Option<Settled> {
    if !is_open(scene) || scene.solver.integrator == Integrator::QuasiStatic {
        return None;
    }
    let by_rule = line_elements(scene.solver.tolerance).round() as usize;
    let (elements, rest) = elements_at_rest(scene, by_rule);
    let rest = rest?;
    Some(Settled {
        scene: with_elements(scene, elements),
        trials: Vec::new(),
        elements,
        error: rest.errors[1],
        tried: true,
        duration: 0.0,
        rest: Some(rest),
    })
}

/// Elements of a line alone, no fewer than `least`, whose tension at rest keeps the tolerance, and why where they are more. As `least` where
/// more do not help.
fn elements_at_rest(scene: &Scene, least: usize) -> (usize, Option<Rest>) {
    let aim = AIM * scene.solver.tolerance;
    let Some(first) = error_at_rest(&with_elements(scene, least)) else {
        return (least, None);
    };
    let (mut elements, mut error) = (least, first);
    while error > aim && (elements as f64) < ELEMENTS_MAX {
        let more = (2.0 * elements as f64).min(ELEMENTS_MAX) as usize;
        let Some(now) = error_at_rest(&with_elements(scene, more)) else {
            return (least, None);
        };
        (elements, error) = (more, now);
    }
    if error > aim && error > (1.0 - GAIN) * first {
        return (least, None);
    }
    let rest = Rest {
        fewer: least,
        errors: [first, error],
    };
    (elements, (elements > least).then_some(rest))
}

/// Greatest error of the tension at the driven ends of lines at rest against their closed-form catenaries [-]; none where no line has one.
fn error_at_rest(scene: &Scene) -> Option<f64> {
    let simulation = Simulation::by_rules(scene).ok()?;
    let model = simulation.model();
    let errors = scene.lines.iter().enumerate().filter_map(|(line, said)| {
        let (built, exact) = (&model.lines[line], simulation.catenary(line)?);
        if built.bends() || built.drifts(model) || said.initial != InitialShape::Static {
            return None;
        }
        let [found, exact] = match driven(model, line) {
            0 => [simulation.tension_a(line), exact.tension_a()],
            _ => [simulation.tension_b(line), exact.tension_b()],
        };
        Some((found - exact).abs() / exact)
    });
    errors.reduce(f64::max).filter(|error| error.is_finite())
}

fn with_elements(scene: &Scene, elements: usize) -> Scene {
    let mut scene = scene.clone();
    scene.solver.elements = Some(elements);
    scene
}

/// The scene with the mesh that it has now, whatever is set of it later: as [`settle`] finds it, or by rule. None where all elements are
/// given.
pub fn frozen(scene: &Scene) -> Option<Scene> {
    if let Some(settled) = settle(scene) {
        return Some(settled.scene);
    }
    if !is_open(scene) {
        return None;
    }
    let mut scene = scene.clone();
    let elements = line_elements(scene.solver.tolerance);
    scene.solver.elements = Some(elements.round() as usize);
    Some(scene)
}

/// Whether the number of elements of any section is left open.
fn is_open(scene: &Scene) -> bool {
    let mut sections = scene.lines.iter().flat_map(|line| &line.sections);
    scene.solver.elements.is_none() && sections.any(|section| section.elements.is_none())
}

/// The state of the search.
struct Search {
    /// The scene, as long and with such samples as is tried.
    scene: Scene,
    /// First sample that counts.
    from: usize,
    /// Runs of the ladder so far.
    runs: Vec<Run>,
    trials: Vec<Trial>,
    /// Explicit steps of an element so far [-].
    work: f64,
}

/// One run.
struct Run {
    elements: usize,
    /// Tension at the driven end of every line after the start [N].
    tension: Vec<Vec<f64>>,
    /// Its cost in explicit steps of an element [-].
    work: f64,
}

impl Search {
    fn new(scene: &Scene) -> Option<Search> {
        let leapfrog = matches!(
            scene.solver.integrator,
            Integrator::Auto | Integrator::Leapfrog | Integrator::AxialImplicit
        );
        if !leapfrog || !is_open(scene) {
            return None;
        }
        let pace = Pace::of(scene)?;
        let output = &scene.output;
        let mut scene = scene.clone();
        scene.output.duration = output.duration.min(pace.duration);
        scene.output.interval = output.interval.min(pace.shortest / SAMPLES);
        let start = (0.5 * scene.output.duration).max(pace.ramp.min(0.75 * scene.output.duration));
        Some(Search {
            from: (start / scene.output.interval) as usize,
            scene,
            runs: Vec::new(),
            trials: Vec::new(),
            work: 0.0,
        })
    }

    /// The scene with so many elements.
    fn with(&self, elements: usize) -> Scene {
        with_elements(&self.scene, elements)
    }

    /// The same with steps that add little to the error of the mesh.
    fn rung(&self, elements: usize) -> Scene {
        let mut scene = self.with(elements);
        scene.solver.tolerance *= FINER;
        scene
    }

    /// Elements, their error [-], and whether they were tried.
    fn mesh(&mut self) -> Option<(usize, f64, bool)> {
        let aim = AIM * self.scene.solver.tolerance;
        for elements in LADDER {
            let growing = self.runs.last().map_or(0.0, |run| 2.0 * run.work);
            if self.work + growing > WORK_MAX {
                break;
            }
            match self.run(&self.rung(elements), elements) {
                Ok(run) => self.runs.push(run?),
                Err(_) => self.runs.clear(), // too coarse to be solved
            }
            let [.., coarse, middle, fine] = &self.runs[..] else {
                continue;
            };
            let error = estimated(coarse, middle, fine);
            let before = self.trials.last().copied();
            let found = Trial {
                elements: coarse.elements,
                error,
            };
            self.trials.push(found);
            if error <= aim {
                return Some(self.between(before, found, aim));
            }
        }
        let last = self.trials.last()?;
        let aim = AIM_UNTRIED * self.scene.solver.tolerance;
        let wanted = (last.elements as f64 * last.error / aim).min(ELEMENTS_MAX);
        let error = last.error * last.elements as f64 / wanted;
        Some((wanted.ceil() as usize, error, false))
    }

    /// Elements between a rung that is too coarse and the next, which is not.
    fn between(&mut self, before: Option<Trial>, found: Trial, aim: f64) -> (usize, f64, bool) {
        let kept = (found.elements, found.error, true);
        let Some(before) = before else { return kept };
        let order = (before.error / found.error).ln()
            / (found.elements as f64 / before.elements as f64).ln();
        let wanted = before.elements as f64 * (before.error / aim).powf(1.0 / order);
        let elements = wanted.ceil() as usize;
        if elements as f64 > FEWER * found.elements as f64 {
            return kept;
        }
        let Ok(Some(run)) = self.run(&self.rung(elements), elements) else {
            return kept;
        };
        let [.., coarse, _, fine] = &self.runs[..] else {
            return kept;
        };
        let error = distance(&run, fine) * found.error / distance(coarse, fine);
        if error <= aim {
            (elements, error, true)
        } else {
            kept
        }
    }

    /// The scene with so many elements, tried ones, and the cheapest leapfrog that keeps the error with them.
    fn with_integrator(&mut self, elements: usize) -> Scene {
        let mut scene = self.with(elements);
        if scene.solver.integrator != Integrator::Auto {
            return scene;
        }
        if let Some(step) = self.axial_implicit_step(elements) {
            scene.solver.integrator = Integrator::AxialImplicit;
            scene.solver.time_step_max = step;
        } else {
            scene.solver.integrator = Integrator::Leapfrog;
        }
        scene
    }

    /// The longest step of the axial-implicit leapfrog [s] that keeps the error, where that costs less than explicit steps.
    fn axial_implicit_step(&mut self, elements: usize) -> Option<f64> {
        let mut scene = self.with(elements);
        let explicit = self.explicit_work(&scene)?;
        let [.., coarse, middle, fine] = &self.runs[..] else {
            return None;
        };
        let smooth = estimated(coarse, middle, fine) / distance(coarse, fine);
        let segments = explicit.segments as f64 * scene.output.duration;
        scene.solver.integrator = Integrator::AxialImplicit;
        scene.solver.time_step_max = scene.solver.time_step_max.min(scene.output.interval);
        for _ in 0..=HALVINGS {
            let step = scene.solver.time_step_max;
            let least = AXIAL_IMPLICIT_COST * segments / step;
            if least > WORTH * explicit.work {
                return None;
            }
            let run = self.run(&scene, elements).ok()??;
            let fine = self.runs.last()?;
            let kept = smooth * distance(&run, fine) <= AIM * scene.solver.tolerance;
            if kept && run.work <= WORTH * explicit.work {
                return Some(step);
            }
            scene.solver.time_step_max = 0.5 * step;
        }
        None
    }

    /// What explicit steps cost; none where the axial-implicit leapfrog does not serve.
    fn explicit_work(&self, scene: &Scene) -> Option<Explicit> {
        let simulation = Simulation::by_rules(scene).ok()?;
        let model = simulation.model();
        let free = |network: &Network| !network.free_points.is_empty();
        if model.networks.iter().any(free) || model.lines.iter().any(|line| line.winch.is_some()) {
            return None;
        }
        let limits = simulation.choices().map(|choice| choice.explicit.step);
        let limit = limits.fold(scene.solver.time_step_max, f64::min);
        let output = &scene.output;
        let steps = (output.interval / limit).ceil() * output.duration / output.interval;
        let segments = model.lines.iter().map(|line| line.segment_count()).sum();
        Some(Explicit {
            segments,
            work: steps * segments as f64,
        })
    }

    /// Runs a scene of so many elements; none where its lines need another integrator than a leapfrog.
    fn run(&mut self, scene: &Scene, elements: usize) -> Result<Option<Run>, Error> {
        let mut simulation = Simulation::by_rules(scene)?;
        simulation.follow_scene()?;
        let mut weight = 0.0_f64;
        for choice in simulation.choices() {
            weight = weight.max(match choice.integrator {
                Integrator::Leapfrog => 1.0,
                Integrator::AxialImplicit => AXIAL_IMPLICIT_COST,
                _ => return Ok(None),
            });
        }
        let model = simulation.model();
        let segments: usize = model.lines.iter().map(|line| line.segment_count()).sum();
        let ends: Vec<usize> = (0..model.lines.len())
            .map(|line| driven(model, line))
            .collect();
        let mut run = Run {
            elements,
            tension: vec![Vec::new(); ends.len()],
            work: 0.0,
        };
        let output = &scene.output;
        for sample in 0..(output.duration / output.interval).round() as usize {
            let broken = simulation.advance(output.interval).is_err();
            if broken || self.work + run.work > 2.0 * WORK_MAX {
                return Ok(None);
            }
            run.work += weight * (simulation.substeps() * segments) as f64;
            if sample < self.from {
                continue;
            }
            for (line, &end) in ends.iter().enumerate() {
                run.tension[line].push(match end {
                    0 => simulation.tension_a(line),
                    _ => simulation.tension_b(line),
                });
            }
        }
        self.work += run.work;
        Ok(Some(run))
    }
}

/// What explicit steps of a scene would cost.
struct Explicit {
    /// Elements of all lines [-].
    segments: usize,
    /// Explicit steps of an element [-].
    work: f64,
}

/// How fast and how long a scene moves.
struct Pace {
    /// Shortest period [s].
    shortest: f64,
    /// Time after which all is in swing [s].
    ramp: f64,
    /// Time that tells the errors [s].
    duration: f64,
}

impl Pace {
    /// None for a scene that does not say how it moves.
    fn of(scene: &Scene) -> Option<Pace> {
        let own = scene
            .points
            .iter()
            .filter_map(|point| point.motion.as_ref());
        let paths: Vec<&MotionPath> = scene.motion.values().chain(own).collect();
        let (mut shortest, mut longest, mut ramp) = (f64::INFINITY, 0.0_f64, 0.0_f64);
        let mut tables = scene
            .water
            .as_ref()
            .is_some_and(|water| water.waves.is_some());
        for path in &paths {
            let MotionPath::Harmonic(motion) = path else {
                tables = true;
                continue;
            };
            ramp = ramp.max(motion.ramp.unwrap_or(0.0));
            for sine in motion.axes().iter().flat_map(|(_, sines)| sines.iter()) {
                (shortest, longest) = (shortest.min(sine[1]), longest.max(sine[1]));
            }
        }
        let duration = if tables || longest == 0.0 {
            DURATION
        } else {
            PERIODS * longest
        };
        (!paths.is_empty()).then_some(Pace {
            shortest,
            ramp,
            duration: ramp + duration,
        })
    }
}

/// The end of a line that is moved, 0 for A: B where both or none are.
fn driven(model: &Model, line: usize) -> usize {
    let moved = |end: usize| {
        let role = &model.points[model.lines[line].ends[end]].role;
        matches!(
            role,
            Role::Coupled { .. } | Role::Carried { .. } | Role::Prescribed(_)
        )
    };
    usize::from(!moved(0) || moved(1))
}

/// Error of the coarse one of three runs whose elements grow by √2 [-].
fn estimated(coarse: &Run, middle: &Run, fine: &Run) -> f64 {
    let whole = distance(coarse, fine);
    if whole == 0.0 {
        return 0.0;
    }
    let smooth = 2.0 - (distance(coarse, middle) / whole).min(1.0);
    (smooth * whole).max(distance(middle, fine))
}

/// RMS of the difference of two runs, of the line where it is greatest, over the greatest standard deviation of a line's tension in the
/// second, or a hundredth of its mean if that is more [-]: lines that hardly move need not be right to a part of what little they do.
fn distance(run: &Run, reference: &Run) -> f64 {
    let spread = |tension: &Vec<f64>| {
        let mean = tension.iter().sum::<f64>() / tension.len() as f64;
        let wave: Vec<f64> = tension.iter().map(|value| value - mean).collect();
        rms(wave.iter().copied()).max(STILL * mean.abs())
    };
    let scale = reference.tension.iter().map(spread).fold(0.0, f64::max);
    if scale == 0.0 {
        return 0.0;
    }
    let lines = run.tension.iter().zip(&reference.tension);
    let wrong = lines.map(|(own, right)| rms(own.iter().zip(right).map(|(a, b)| a - b)));
    wrong.fold(0.0, f64::max) / scale
}

fn rms(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    (values.map(|value| value * value).sum::<f64>() / count).sqrt()
}
