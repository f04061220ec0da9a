//! Run of a hard case, with its measures.

use std::cell::RefCell;

use moorline::math::low_pass::low_pass;
use moorline::scene::{Integrator, Scene};
use moorline::simulation::Simulation;

/// Result of a run, sampled at every communication point, including the start.
#[derive(Debug, Clone)]
pub struct Run {
    /// Time [s].
    pub time: Vec<f64>,
    /// Tension at end B of the first line [N].
    pub tension: Vec<f64>,
    /// Error of the energy balance [J].
    pub error: Vec<f64>,
    /// Energy in excess of the initial energy and the external work since then [J]; without a gain it is minus the dissipation.
    pub gained: Vec<f64>,
    /// Maximum of external work, dissipation and kinetic energy [J], to which errors of energy refer.
    pub flowed: f64,
    /// Integrator of the first network.
    pub chosen: Integrator,
    /// Number of internal steps in all communication steps.
    pub substeps: usize,
    /// Number of force evaluations or linear solves in all communication steps.
    pub solves: usize,
    /// The simulation at the end.
    pub end: Simulation,
}

impl Run {
    /// Runs a scene whose coupled points follow the motion of the scene, for a duration [s] in communication steps [s].
    pub fn of(scene: &Scene, duration: f64, step: f64) -> Run {
        let count = (duration / step).round() as usize;
        Run::of_steps(scene, std::iter::repeat_n(step, count))
    }

    /// The same in communication steps of any size [s].
    pub fn of_steps(scene: &Scene, steps: impl Iterator<Item = f64>) -> Run {
        let mut simulation = begun(scene);
        simulation
            .follow_scene()
            .unwrap_or_else(|error| panic!("{error}"));
        Run::driven(simulation, steps, |_| ())
    }

    /// Runs a scene driven by a host: `say` sets the positions of its points before each communication step [s].
    pub fn hosted(scene: &Scene, steps: impl Iterator<Item = f64>, say: impl Fn(&mut Simulation)) -> Run {
        Run::driven(begun(scene), steps, say)
    }

    /// Runs a scene to these times [s], with one communication step to each, and returns the samples taken there.
    pub fn watched(scene: &Scene, times: &[f64], see: impl Fn(&Simulation) -> f64) -> (Run, Vec<f64>) {
        let starts = std::iter::once(0.0).chain(times.iter().copied());
        let steps = starts.zip(times).map(|(from, to)| to - from);
        let seen = RefCell::new(Vec::new());
        let run = Run::hosted(scene, steps, |now| seen.borrow_mut().push(see(now)));
        let mut seen = seen.into_inner();
        seen.push(see(&run.end));
        seen.remove(0); // the start
        (run, seen)
    }

    fn driven(
        simulation: Simulation,
        steps: impl Iterator<Item = f64>,
        say: impl Fn(&mut Simulation),
    ) -> Run {
        let chosen = simulation.choices().next().expect("a line").integrator;
        let mut run = Run {
            time: Vec::new(),
            tension: Vec::new(),
            error: Vec::new(),
            gained: Vec::new(),
            flowed: 0.0,
            chosen,
            substeps: 0,
            solves: 0,
            end: simulation,
        };
        run.sample();
        for step in steps {
            say(&mut run.end);
            run.end.advance(step).unwrap_or_else(|error| panic!("{error}"));
            run.substeps += run.end.counters().substeps;
            run.solves += run.end.counters().solves;
            run.sample();
        }
        run
    }

    fn sample(&mut self) {
        let now = &self.end;
        let (balance, energy) = (now.energy_balance().expect("the scene asks for it"), now.energy());
        let flow = balance.flow;
        let most = energy
            .kinetic
            .max(flow.external_work.abs())
            .max(flow.dissipation.abs())
            .max(self.flowed);
        self.gained
            .push(energy.total() - balance.start - flow.external_work);
        self.flowed = most;
        self.time.push(now.time());
        self.tension.push(now.tension_b(0));
        self.error.push(balance.error());
    }

    /// Returns whether the positions of all nodes and all tensions are finite.
    pub fn is_finite(&self) -> bool {
        let nodes = self.end.state().lines.iter().flat_map(|line| &line.position);
        self.tension.iter().all(|tension| tension.is_finite())
            && nodes.flat_map(|r| r.iter()).all(|x| x.is_finite())
    }

    /// Maximum tension at end B [N].
    pub fn peak(&self) -> f64 {
        self.peak_between(0.0, f64::INFINITY)
    }

    /// Maximum tension at end B between two times [s] [N].
    pub fn peak_between(&self, from: f64, to: f64) -> f64 {
        let samples = self.time.iter().zip(&self.tension);
        let inside = samples.filter(|(t, _)| (from..to).contains(*t));
        inside.map(|(_, tension)| *tension).fold(0.0, f64::max)
    }

    /// Maximum magnitude of the energy balance error, relative to the energy that flowed [-].
    pub fn ledger_error(&self) -> f64 {
        self.error.iter().fold(0.0, |a: f64, b| a.max(b.abs())) / self.flowed
    }

    /// Maximum energy in excess of the external work, relative to the energy that flowed [-].
    pub fn energy_gain(&self) -> f64 {
        self.gained.iter().copied().fold(0.0, f64::max) / self.flowed
    }

    /// Half of the range of tension over the last 400 samples [N].
    pub fn last_amplitude(&self) -> f64 {
        let last = &self.tension[self.tension.len() - 400..];
        let greatest = last.iter().copied().fold(0.0, f64::max);
        let least = last.iter().copied().fold(f64::INFINITY, f64::min);
        0.5 * (greatest - least)
    }

    /// Internal steps per second [1/s].
    pub fn substeps_per_second(&self) -> f64 {
        self.substeps as f64 / (self.time[self.time.len() - 1] - self.time[0])
    }

    /// RMS difference of the tension from that of another run, relative to the standard deviation of the latter, from a time [s] on [-].
    pub fn tension_error(&self, reference: &Run, from: f64) -> f64 {
        let first = reference.time.partition_point(|t| *t < from);
        relative_rms(&self.tension[first..], &reference.tension[first..])
    }

    /// The same for tensions low-passed at `cut_off` [Hz].
    pub fn slow_tension_error(&self, reference: &Run, from: f64, cut_off: f64) -> f64 {
        let first = reference.time.partition_point(|t| *t < from);
        let slow = |run: &Run| low_pass(&run.tension, run.time[1] - run.time[0], cut_off);
        relative_rms(&slow(self)[first..], &slow(reference)[first..])
    }
}

fn begun(scene: &Scene) -> Simulation {
    let mut scene = scene.clone();
    scene.output.energy_balance = true;
    Simulation::new(&scene).unwrap_or_else(|error| panic!("{error}"))
}

/// RMS of the difference relative to the standard deviation of the reference [-].
fn relative_rms(values: &[f64], reference: &[f64]) -> f64 {
    let mean = reference.iter().sum::<f64>() / reference.len() as f64;
    let spread: f64 = reference.iter().map(|r| (r - mean).powi(2)).sum();
    let pairs = values.iter().zip(reference);
    let error: f64 = pairs.map(|(v, r)| (v - r).powi(2)).sum();
    (error / spread).sqrt()
}
