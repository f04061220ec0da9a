//! Runs of a scene's networks on other meshes and with other steps.

use std::f64::consts::TAU;
use std::rc::Rc;

use super::Networks;
use super::history::History;
use super::ladder::LEVELS;
use super::times::MotionTimes;
use crate::dynamics::{IMPLICIT_COST, axial_implicit_cost};
use crate::model::Model;
use crate::scene::{Integrator, Scene};
use crate::simulation::{Error, Simulation};

/// Greatest work of all trials, in explicit steps of an element [-].
const WORK_MAX: f64 = 1e8;
/// Greatest work of all trials if steps are fully implicit, in explicit steps of an element [-].
const IMPLICIT_WORK_MAX: f64 = 4e8;

/// Integrator and steps of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Steps {
    pub(super) integrator: Integrator,
    /// Longest step [s].
    pub(super) longest: f64,
    /// Tolerance of the steps, if they follow from one [-].
    pub(super) tolerance: f64,
}

impl Steps {
    /// Returns the scene with these steps.
    pub(super) fn of(self, mut scene: Scene) -> Scene {
        scene.solver.integrator = self.integrator;
        scene.solver.time_step_max = self.longest;
        scene.solver.tolerance = self.tolerance;
        scene
    }
}

/// Result of a run for the lines of a network.
#[derive(Debug)]
pub(super) struct Run {
    /// Elements of an isolated line [-].
    pub(super) elements: usize,
    steps: Steps,
    /// Lengths of the elements of every line [m].
    pub(super) lengths: Vec<Vec<f64>>,
    /// History of every line after the initial part.
    pub(super) histories: Vec<History>,
    /// Longest step of any network [s].
    pub(super) step: f64,
    /// Cost in explicit steps of an element [-].
    pub(super) work: f64,
}

/// All runs of a scene so far.
pub(super) struct Trials<'a> {
    networks: &'a Networks,
    /// Scene with the duration and the samples of the trials.
    scene: Scene,
    /// Index of the first sample that is evaluated.
    from: usize,
    /// Longest step of the trials [s].
    pub(super) longest_step: f64,
    /// True if a line may need fully implicit steps, for example because it bends. All networks are then run with the integrators that the rules
    /// choose.
    pub(super) implicit: bool,
    /// Runs of every network.
    runs: Vec<Vec<Rc<Run>>>,
    /// Work so far, in explicit steps of an element [-].
    work: f64,
}

impl<'a> Trials<'a> {
    /// Prepares the trials; `None` for a scene without a motion.
    pub(super) fn new(scene: &Scene, model: &Model, networks: &'a Networks) -> Option<Trials<'a>> {
        let times = MotionTimes::of(scene)?;
        let mut scene = scene.clone();
        let output = &mut scene.output;
        output.duration = output.duration.min(times.duration);
        let interval = times.sample_interval(output.interval, scene.solver.tolerance_of);
        output.interval = times.spread(interval);
        let start = (0.5 * output.duration).max(times.ramp.min(0.75 * output.duration));
        Some(Trials {
            from: (start / output.interval) as usize,
            longest_step: scene.solver.time_step_max.min(interval),
            scene,
            networks,
            implicit: may_need_implicit_steps(model),
            runs: vec![Vec::new(); networks.lines.len()],
            work: 0.0,
        })
    }

    /// Scene with the duration and the samples of the trials.
    pub(super) fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Replaces the scene and drops the runs of the previous one, which is returned.
    pub(super) fn replace_scene(&mut self, scene: Scene) -> Scene {
        self.runs.iter_mut().for_each(Vec::clear);
        std::mem::replace(&mut self.scene, scene)
    }

    /// Returns the scene with these elements in every network [-].
    pub(super) fn with(&self, elements: &[usize]) -> Scene {
        self.networks.with_elements(&self.scene, elements)
    }

    /// Work so far, in explicit steps of an element [-].
    pub(super) fn work(&self) -> f64 {
        self.work
    }

    /// Returns whether the trials may take this further work, in explicit steps of an element [-].
    pub(super) fn allow(&self, work: f64) -> bool {
        self.work + work <= self.work_max()
    }

    fn work_max(&self) -> f64 {
        if self.implicit {
            IMPLICIT_WORK_MAX
        } else {
            WORK_MAX
        }
    }

    /// Least number of elements with which a network has been run [-].
    pub(super) fn coarsest(&self, network: usize) -> usize {
        let elements = self.runs[network].iter().map(|run| run.elements);
        elements.min().unwrap_or(LEVELS[0])
    }

    /// Largest ωl/c of a network's lines at a period [s], with c = √(T/m) the speed of waves across a line where its tension is greatest, and l the length
    /// of the element there [-]. Elements carry such waves up to 2 and resolve them up to about 1.
    pub(super) fn steepness(&self, simulation: &Simulation, network: usize, period: f64) -> f64 {
        let of_line = |&line: &usize| {
            let tensions = simulation.tensions(line).iter().copied().enumerate();
            let (node, tension) = tensions.max_by(|a, b| a.1.total_cmp(&b.1))?;
            let of = &simulation.model().lines[line];
            let segment = node.min(of.segment_count() - 1);
            let mass = of.nodes.mass_normal[segment].max(of.nodes.mass_normal[segment + 1]);
            (tension > 0.0).then(|| TAU / period * (of.segments.length[segment] * mass / tension).sqrt())
        };
        let lines = self.networks.lines[network].iter();
        lines.filter_map(of_line).fold(0.0, f64::max)
    }

    /// Returns runs of all networks with these elements [-]; `None` if a line needs an integrator that is not tried. Networks do not affect each
    /// other, so a network whose run is known takes the least number of elements with which it has been run.
    pub(super) fn run(&mut self, elements: &[usize], steps: Steps) -> Result<Option<Vec<Rc<Run>>>, Error> {
        let known = |trials: &Trials, network: usize| {
            let given = !trials.networks.open[network];
            let same_mesh = |run: &Run| given || run.elements == elements[network];
            let mut runs = trials.runs[network].iter();
            runs.find(|run| run.steps == steps && same_mesh(run)).cloned()
        };
        let networks = 0..elements.len();
        if networks.clone().any(|network| known(self, network).is_none()) {
            let needed = networks.clone().map(|network| match known(self, network) {
                Some(_) => self.coarsest(network),
                None => elements[network],
            });
            let needed: Vec<usize> = needed.collect();
            let Some(made) = self.make(&needed, steps)? else {
                return Ok(None);
            };
            let runs = self.runs.iter_mut().zip(made);
            runs.for_each(|(runs, run)| runs.push(Rc::new(run)));
        }
        Ok(networks.map(|network| known(self, network)).collect())
    }

    fn make(&mut self, elements: &[usize], steps: Steps) -> Result<Option<Vec<Run>>, Error> {
        let scene = steps.of(self.with(elements));
        let mut simulation = Simulation::new(&scene)?;
        simulation.follow_scene()?;
        let Some(weight) = self.weight(&simulation) else {
            return Ok(None);
        };
        let model = simulation.model();
        let segments: usize = model.lines.iter().map(|line| line.segment_count()).sum();
        let histories = (0..model.lines.len()).map(|line| History::of(&scene, model, line));
        let mut histories: Vec<History> = histories.collect();
        let (output, mut substeps) = (&scene.output, 0);
        for sample in 0..(output.duration / output.interval).round() as usize {
            let broken = simulation.advance(output.interval).is_err();
            let work = weight * (substeps * segments) as f64;
            if broken || self.work + work > 2.0 * self.work_max() {
                return Ok(None);
            }
            substeps += simulation.substeps();
            if sample >= self.from {
                let histories = histories.iter_mut().enumerate();
                histories.for_each(|(line, history)| history.add(&simulation, line));
            }
        }
        histories.iter_mut().for_each(History::complete);
        let cost = weight * substeps as f64;
        self.work += cost * segments as f64;
        Ok(Some(self.of_networks(
            elements,
            steps,
            &simulation,
            &histories,
            cost,
        )))
    }

    /// Cost of a step of the costliest integrator, in explicit steps [-]; `None` if one is not tried.
    fn weight(&self, simulation: &Simulation) -> Option<f64> {
        let weight = |integrator| match integrator {
            Integrator::Leapfrog => Some(1.0),
            Integrator::AxialImplicit => Some(axial_implicit_cost(simulation.model().lines.iter())),
            Integrator::GeneralisedAlpha if self.implicit => Some(IMPLICIT_COST),
            _ => None,
        };
        let mut choices = simulation.choices();
        choices.try_fold(0.0, |most: f64, choice| {
            Some(most.max(weight(choice.integrator)?))
        })
    }

    /// Results of a run by network; `cost` is that of all its steps, in explicit steps [-].
    fn of_networks(
        &self,
        elements: &[usize],
        steps: Steps,
        simulation: &Simulation,
        histories: &[History],
        cost: f64,
    ) -> Vec<Run> {
        let longest = simulation.choices().map(|choice| choice.longest);
        let step = longest.fold(0.0, f64::max);
        let model = simulation.model();
        let networks = self.networks.lines.iter().zip(elements);
        let of_network = |(lines, &elements): (&Vec<usize>, &usize)| {
            let lengths = lines
                .iter()
                .map(|&line| model.lines[line].segments.length.clone());
            let lengths: Vec<Vec<f64>> = lengths.collect();
            Run {
                elements,
                steps,
                histories: lines.iter().map(|&line| histories[line].clone()).collect(),
                step,
                work: cost * lengths.iter().map(Vec::len).sum::<usize>() as f64,
                lengths,
            }
        };
        networks.map(of_network).collect()
    }
}

/// Returns whether a line other than a beam bends or cannot take the steps of a leapfrog: with short elements, fully implicit steps then cost less.
fn may_need_implicit_steps(model: &Model) -> bool {
    let mut lines = model.lines.iter();
    lines.any(|line| line.beam.is_none() && (line.bending.is_some() || !line.serves_leapfrog()))
}
